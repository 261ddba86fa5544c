//! The fourth part of a diagnosis: base model against improved model on test runs.
//! It repeats the numbers of the proof and draws no conclusion beyond them.

use super::phrases::percent;
use crate::diagnose::Diagnosis;
use crate::numerals::{DASH, fixed, sig};

/// A cVDM in words.
fn percentage(cvdm: Option<f64>) -> String {
    cvdm.map_or(DASH.to_owned(), |v| sig(v, 3))
}

/// What the findings gain on the test runs.
pub(super) fn proof(d: &Diagnosis) -> Vec<String> {
    let Some(h) = &d.held_out else {
        return vec!["there are no test runs, so nothing is proven; mark some with `split = \"test\"`".to_owned()];
    };
    if d.findings.is_empty() {
        return vec![format!(
            "no finding to prove; base model, refitted, on {} test runs: cVDM {} %",
            h.runs,
            percentage(h.before)
        )];
    }
    let gain = h.improvement.map_or(DASH.to_owned(), percent);
    let interval = h.ci95.map_or("no interval with fewer than three recordings".to_owned(), |[low, high]| {
        format!("95 % {} to {}", percent(low), percent(high))
    });
    let mut lines = vec![format!(
        "{} test runs: cVDM {} % before, {} % after (improvement {gain}, {interval}); {} better, {} worse",
        h.runs,
        percentage(h.before),
        percentage(h.after),
        h.better,
        h.worse
    )];
    if h.ci95.is_some_and(|[low, _]| low <= 0.0) {
        lines.push("the interval reaches zero: these test runs do not confirm the gain".to_owned());
    }
    if let (Some(run), Some(change)) = (&h.worst_run, h.worst_improvement) {
        let word = if change < 0.0 { "worse" } else { "better" };
        lines.push(format!("worst run: {run}, {} {word}", percent(change.abs())));
    }
    if let Some(g) = h.generic {
        lines.push(format!("with a generic force law in place of the findings: cVDM {} %", sig(g, 3)));
    }
    lines.push(format!(
        "log-likelihood gained: {}; mean square of standardised innovations (1 agrees with the noise model): {} before, {} after",
        fixed(h.log_likelihood_gain, 1),
        sig(h.whiteness[0], 3),
        sig(h.whiteness[1], 3)
    ));
    lines
}
