//! The diagnoses of the experiments on real hulls, and their tables of findings and of the ship's two sides.
//! The diagnosis itself is the library's.

use trimtab::diagnose::proof::finding::Amplitude;
use trimtab::diagnose::proof::prove::HeldOut;
use trimtab::diagnose::{Diagnosis, Settings, diagnose};
use trimtab::model::Model;
use trimtab::numbers::numerals::{fixed, sig};
use trimtab::recording::Run;
use trimtab::report::Table;

use super::error::RealError;

/// One diagnosis with its name.
pub struct Case {
    /// Recordings and model, in words.
    pub name: String,
    /// The diagnosis.
    pub diagnosis: Diagnosis,
}

impl Case {
    /// Diagnoses.
    ///
    /// # Errors
    /// [`RealError::Model`].
    pub fn new(
        name: &str,
        model: &Model,
        train: &[Run],
        held_out: &[Run],
        settings: &Settings,
    ) -> Result<Self, RealError> {
        let progress = |step: &str| eprintln!("{name}: {step}");
        Ok(Self { name: name.into(), diagnosis: diagnose(model, train, held_out, settings, &progress)? })
    }
}

/// Mean errors of held-out runs before and after, with the gain: the last columns of a table. Blank where there is no number.
pub fn held_out_columns(h: &HeldOut) -> [String; 6] {
    let number = |value: Option<f64>, factor: f64| value.map_or_else(String::new, |v| fixed(factor * v, 1));
    let interval = |[low, high]: [f64; 2]| format!("[{}, {}]", fixed(100.0 * low, 1), fixed(100.0 * high, 1));
    [
        number(h.before, 1.0),
        number(h.after, 1.0),
        number(h.improvement, 100.0),
        h.ci95.map_or_else(String::new, interval),
        format!("{} / {}", h.better, h.worse),
        fixed(h.log_likelihood_gain, 0),
    ]
}

/// A parameter with its 95 % interval and unit.
fn amplitude(a: &Amplitude, digits: usize) -> String {
    format!("{} {} ({} to {}) {}", a.name, sig(a.value, digits), sig(a.ci95[0], digits), sig(a.ci95[1], digits), a.unit)
}

/// A row a finding, with its effect on held-out runs.
pub fn findings_table(cases: &[Case]) -> Table {
    let mut table = Table::new([
        "case",
        "verdict",
        "finding",
        "confidence set",
        "sessions",
        "statistic",
        "parameters (95 % interval)",
        "held-out cVDM before [%]",
        "after [%]",
        "improvement [%]",
        "95 % interval",
        "better / worse",
        "held-out log-likelihood gained",
    ]);
    for c in cases {
        let d = &c.diagnosis;
        let start = [c.name.clone(), format!("{:?}", d.verdict)];
        let mut held = d.held_out.as_ref().map(held_out_columns);
        let mut rows: Vec<[String; 5]> = d
            .findings
            .iter()
            .map(|f| {
                let parameters: Vec<String> = f.parameters.iter().map(|p| amplitude(p, 3)).collect();
                [
                    f.mechanism.clone(),
                    f.confidence_set.join(" or "),
                    if f.sessions.is_empty() { "all".into() } else { f.sessions.join(" and ") },
                    fixed(f.statistic, 0),
                    parameters.join("; "),
                ]
            })
            .collect();
        if rows.is_empty() {
            rows.push(Default::default());
        }
        for row in rows {
            // The columns of the whole diagnosis are in its first row.
            table.row(start.iter().cloned().chain(row).chain(held.take().unwrap_or_default()));
        }
    }
    table
}

/// A row a case: whether port and starboard of the ship differ, and in which parameters.
pub fn sides_table(cases: &[Case]) -> Table {
    let mut table = Table::new([
        "case",
        "statistic",
        "degrees of freedom",
        "p",
        "parameters that differ between the sides (95 % interval)",
    ]);
    for c in cases {
        let Some(sides) = &c.diagnosis.sides else { continue };
        table.row([
            c.name.clone(),
            fixed(sides.statistic, 1),
            sides.degrees.to_string(),
            sig(sides.p, 2),
            sides.parameters.iter().map(|a| amplitude(a, 2)).collect::<Vec<_>>().join("; "),
        ]);
    }
    table
}
