//! The last parts of a diagnosis: what is still unexplained, what these data cannot show, and which trial would help.
//! None of it changes the verdict.

use super::names::title_of;
use super::phrases::{adequacy_words, p_value};
use crate::diagnose::Diagnosis;
use crate::numerals::{fixed, sig};
use crate::report::units::{EQUATIONS, Units};

/// What the improved model leaves unexplained.
pub(super) fn still_open(d: &Diagnosis) -> Vec<String> {
    let further = |which: &str, p: f64| format!("further forces {which}: {} ({})", adequacy_words(p), p_value(p));
    let mut lines = vec![
        further("with port-starboard symmetry (the ship's own, in another form)", d.adequacy_after.symmetric),
        further("without that symmetry, or fixed on the earth", d.adequacy_after.asymmetric),
        unexplained(d),
    ];
    lines.extend(coefficients(d));
    lines
}

/// The unknown force in the noise model, before and after.
fn unexplained(d: &Diagnosis) -> String {
    let units = Units::of(&d.base.ship);
    let forces = d.noise_before.force.iter().zip(&d.noise_after.force);
    let change: Vec<String> = forces
        .zip(EQUATIONS)
        .map(|((before, after), (name, unit, _))| {
            let (factor, unit) = units.human(unit);
            format!("{name} {} before, {} {unit} after", sig(before * factor, 3), sig(after * factor, 3))
        })
        .collect();
    let time = fixed(d.noise_after.force_time, 0);
    format!("unexplained force (standard deviation; correlation time {time} s): {}", change.join("; "))
}

/// The ship's own coefficients against their priors.
fn coefficients(d: &Diagnosis) -> Option<String> {
    let mut used: Vec<_> = d.hull_budget.iter().filter(|b| b.used.is_finite()).collect();
    used.sort_by(|a, b| b.used.abs().total_cmp(&a.used.abs()));
    let beyond = used.iter().filter(|b| b.used.abs() > 2.0).count();
    let furthest: Vec<String> = used.iter().take(3).map(|b| format!("{} {:+.1}", b.name, b.used)).collect();
    (!used.is_empty()).then(|| {
        format!(
            "the ship's own coefficients: {beyond} of {} further than 2 prior standard deviations from their priors; \
             furthest {}",
            used.len(),
            furthest.join(", ")
        )
    })
}

/// What these data could not have shown, and from which size on they would have shown the rest.
pub(super) fn limits(d: &Diagnosis) -> Vec<String> {
    let units = Units::of(&d.base.ship);
    let mut lines = Vec::new();
    let mut reasons: Vec<&str> = d.absorbed.iter().map(|a| a.by.as_str()).collect();
    reasons.sort_unstable();
    reasons.dedup();
    for reason in reasons {
        let names: Vec<&str> =
            d.absorbed.iter().filter(|a| a.by == reason).map(|a| title_of(&d.model, &a.mechanism)).collect();
        lines.push(format!("not identifiable: {} (absorbed by {reason})", names.join(", ")));
    }
    let sizes: Vec<String> = d
        .detectable
        .iter()
        .filter(|s| s.size.is_finite())
        .map(|s| {
            let of = if s.of_change { " between sessions" } else { "" };
            format!("{} {}{of}", s.mechanism, units.text(s.size, &s.unit))
        })
        .collect();
    if !sizes.is_empty() {
        lines.push(format!("detected with a probability of 80 % from: {}", sizes.join("; ")));
    }
    if lines.is_empty() {
        lines.push("every mechanism of the catalogue is identifiable".to_owned());
    }
    lines
}

/// The trial that would help most.
pub(super) fn next_trial(d: &Diagnosis) -> Vec<String> {
    d.next_trial
        .as_ref()
        .map_or_else(|| vec!["none is needed for this verdict".to_owned()], |t| vec![format!("{}: {}", t.trial, t.why)])
}
