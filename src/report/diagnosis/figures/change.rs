//! Figures of what the findings change: test runs before and after, parameters that moved, coefficients far from their priors.
//! They show the numbers of the diagnosis in order of size.

use super::picture::{Picture, shown};
use crate::diagnose::Diagnosis;
use crate::report::plot::{Axis, BASELINE, FITTED, Figure, GREY, Layer, Legend, Marker, Panel};

/// Runs and coefficients shown at most.
const RUNS: usize = 40;
const COEFFICIENTS: usize = 20;

/// cVDM of each test run before and after, the worst before first.
pub(in crate::report::diagnosis) fn held_out(d: &Diagnosis) -> Option<Picture> {
    let h = d.held_out.as_ref()?;
    let cvdm = |v: Option<f64>| v.unwrap_or(f64::NAN);
    let both = h.runs_before.iter().zip(&h.runs_after);
    let mut pairs: Vec<(&str, f64, f64)> = both.map(|(b, a)| (b.run.as_str(), cvdm(b.cvdm), cvdm(a.cvdm))).collect();
    pairs.sort_by(|a, b| b.1.total_cmp(&a.1));
    let all = pairs.len();
    pairs.truncate(RUNS);
    if pairs.is_empty() || d.findings.is_empty() {
        return None;
    }
    let rows = || pairs.iter().enumerate().map(|(i, p)| (i as f64, p));
    let joined = rows().flat_map(|(i, p)| [(p.1, i), (p.2, i), (f64::NAN, f64::NAN)]);
    let labels = Axis::categories("", pairs.iter().map(|p| p.0));
    let dots = Panel::new("", Axis::new("cVDM [%]").log(), labels)
        .with(Layer::line("change", GREY, joined).unlisted().width(2.0))
        .with(Layer::scatter("base model, refitted", BASELINE, rows().map(|(i, p)| (p.1, i))))
        .with(Layer::scatter("improved model", FITTED, rows().map(|(i, p)| (p.2, i))).marker(Marker::Diamond))
        .with(Layer::v_line("mean, base", BASELINE, h.before.unwrap_or(f64::NAN)).dotted().unlisted())
        .with(Layer::v_line("mean, improved", FITTED, h.after.unwrap_or(f64::NAN)).dotted().unlisted())
        .with_all(h.generic.map(|g| Layer::v_line("mean with a generic force law", GREY, g).dashed()));
    Some(Picture {
        stem: "held_out",
        part: "PROOF",
        caption: "Test runs, simulated freely by the base model, refitted, and by the improved model, the largest error of the base model first."
            .to_owned()
            + &shown(pairs.len(), all, "test runs, those with the largest errors of the base model,"),
        figure: Figure::new("Test runs, before and after (dotted: means)")
            .panel_size(1240, 150 + 40 * pairs.len() as u32)
            .with(dots),
    })
}

/// How far the model's own parameters moved when the findings were added.
pub(in crate::report::diagnosis) fn moves(d: &Diagnosis) -> Option<Picture> {
    if d.moves.is_empty() || d.findings.is_empty() {
        return None;
    }
    let rows = d.moves.iter().map(|m| (m.name.as_str(), m.moved));
    Some(Picture {
        stem: "moves",
        part: "MODEL",
        caption: "How far the model's own parameters moved when the findings were added: those beyond 2 had absorbed part of the effect.".to_owned(),
        figure: levels("Moves of the model's own parameters", "moved [standard errors]", rows),
    })
}

/// The hull coefficients furthest from their priors.
pub(in crate::report::diagnosis) fn hull_budget(d: &Diagnosis) -> Option<Picture> {
    let mut budget: Vec<(&str, f64)> = d.hull_budget.iter().map(|b| (b.name.as_str(), b.used)).collect();
    budget.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    let all = budget.len();
    budget.truncate(COEFFICIENTS);
    if budget.is_empty() {
        return None;
    }
    Some(Picture {
        stem: "hull_budget",
        part: "STILL OPEN",
        caption: "Distance of the ship's own coefficients from their priors, the furthest first. They are an error budget, not findings."
            .to_owned()
            + &shown(budget.len(), all, "coefficients, those furthest from their priors,"),
        figure: levels("Hull error budget", "distance from the prior value [prior standard deviations]", budget),
    })
}

/// Signed sizes in standard units, one a row, with the range of chance shaded.
fn levels<'a>(title: &str, label: &str, rows: impl IntoIterator<Item = (&'a str, f64)>) -> Figure {
    let (names, values): (Vec<&str>, Vec<f64>) = rows.into_iter().unzip();
    let height = 150 + 40 * names.len() as u32;
    let panel = Panel::new("", Axis::new(label).including(-2.5).including(2.5), Axis::categories("", names))
        .with(Layer::v_span("within 2", GREY, -2.0, 2.0))
        .with(Layer::bars("value", FITTED, values));
    Figure::new(title).panel_size(1100, height).legend(Legend::Off).with(panel)
}
