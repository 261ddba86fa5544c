//! The last parts of a diagnosis: what is still unexplained, what these data cannot show, and which trial would help.
//! None of it changes the verdict.

use super::names::title_of;
use super::phrases::{adequacy_words, p_value};
use crate::diagnose::Diagnosis;
use crate::numerals::{fixed, sig};
use crate::report::units::{EQUATIONS, Units};

pub(super) fn still_open(d: &Diagnosis) -> Vec<String> {
    let units = Units::of(&d.base.ship);
    let a = d.adequacy_after;
    let mut lines = vec![
        format!(
            "further forces with port-starboard symmetry (the ship's own, in another form): {} ({})",
            adequacy_words(a.symmetric),
            p_value(a.symmetric)
        ),
        format!(
            "further forces without that symmetry, or fixed on the earth: {} ({})",
            adequacy_words(a.asymmetric),
            p_value(a.asymmetric)
        ),
    ];
    let change: Vec<String> = EQUATIONS
        .iter()
        .enumerate()
        .map(|(e, (name, unit, _))| {
            let (factor, unit) = units.human(unit);
            let (before, after) = (d.noise_before.force[e] * factor, d.noise_after.force[e] * factor);
            format!("{name} {} before, {} {unit} after", sig(before, 3), sig(after, 3))
        })
        .collect();
    lines.push(format!(
        "unexplained force (standard deviation; correlation time {} s): {}",
        fixed(d.noise_after.force_time, 0),
        change.join("; ")
    ));
    let mut used: Vec<_> = d.hull_budget.iter().filter(|b| b.used.is_finite()).collect();
    used.sort_by(|a, b| b.used.abs().total_cmp(&a.used.abs()));
    let beyond = used.iter().filter(|b| b.used.abs() > 2.0).count();
    if !used.is_empty() {
        let furthest: Vec<String> = used.iter().take(3).map(|b| format!("{} {:+.1}", b.name, b.used)).collect();
        lines.push(format!(
            "the ship's own coefficients: {beyond} of {} further than 2 prior standard deviations from their priors; furthest {}",
            used.len(),
            furthest.join(", ")
        ));
    }
    lines
}

pub(super) fn blind(d: &Diagnosis) -> Vec<String> {
    let units = Units::of(&d.base.ship);
    let mut lines = Vec::new();
    let mut reasons: Vec<&str> = d.absorbed.iter().map(|a| a.by.as_str()).collect();
    reasons.sort_unstable();
    reasons.dedup();
    for reason in reasons {
        let names: Vec<&str> = d.absorbed.iter().filter(|a| a.by == reason).map(|a| title_of(&a.mechanism)).collect();
        lines.push(format!("not identifiable: {} (absorbed by {reason})", names.join(", ")));
    }
    let sizes: Vec<String> = d
        .detectable
        .iter()
        .filter(|s| s.size.is_finite())
        .map(|s| format!("{} {}", s.mechanism, units.text(s.size, &s.unit)))
        .collect();
    if !sizes.is_empty() {
        lines.push(format!("detected with a probability of 80 % from: {}", sizes.join("; ")));
    }
    if lines.is_empty() {
        lines.push("every mechanism of the catalogue is identifiable".to_owned());
    }
    lines
}

pub(super) fn next_trial(d: &Diagnosis) -> Vec<String> {
    d.next_trial
        .as_ref()
        .map_or_else(|| vec!["none is needed for this verdict".to_owned()], |t| vec![format!("{}: {}", t.trial, t.why)])
}
