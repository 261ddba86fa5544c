//! The fourth part of a diagnosis: base model against improved model on test runs.
//! It repeats the numbers of the proof and draws no conclusion beyond them.

use super::phrases::percent;
use crate::diagnose::Diagnosis;
use crate::diagnose::answer::models::{OnUnseen, Whose};
use crate::diagnose::proof::unseen::FindingProof;
use crate::numerals::{DASH, fixed, number_of, sig};

/// A cVDM in words.
fn percentage(cvdm: Option<f64>) -> String {
    cvdm.map_or(DASH.to_owned(), |v| sig(v, 3))
}

/// The gains of a finding on unseen runs with their intervals.
pub(super) fn gains(h: &FindingProof) -> Vec<String> {
    let gain = |of: &str, gain: Option<f64>, ci: Option<[f64; 2]>, say: &dyn Fn(f64) -> String| {
        let interval = ci.map_or(String::new(), |[low, high]| format!(" [{}, {}]", say(low), say(high)));
        gain.map(|gain| format!("{of} {}{interval}", say(gain)))
    };
    let whole = |v: f64| fixed(v, 0);
    let agreement = "log-likelihood of their sensors' kinematic consistency by";
    [
        gain(agreement, h.agreement_gain, h.agreement_ci95, &whole),
        gain("cVDM better by", h.improvement, h.improvement_ci95, &percent),
        gain("log-likelihood by", h.log_likelihood_gain, h.log_likelihood_ci95, &whole),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// What one finding or law by itself does on the test runs.
pub(super) fn alone(title: &str, h: &FindingProof) -> String {
    let mut parts = gains(h);
    let distance = |pair: Option<[f64; 2]>, factor: f64, what: &str, unit: &str| {
        pair.map(|[b, a]| format!("{what} {} to {} {unit}", sig(b * factor, 3), sig(a * factor, 3)))
    };
    parts.extend(distance(h.position, 1.0, "position error", "m"));
    parts.extend(distance(h.heading, 1f64.to_degrees(), "heading error", "deg"));
    parts.extend(distance(h.speed, 1.0, "speed error", "m/s"));
    format!("{title} by itself, on {}: {}", number_of(h.recordings, "recording"), parts.join(", "))
}

/// The study's own model, the base model and the improved one side by side on unseen runs, and which of them is in the files.
fn models(d: &Diagnosis) -> Vec<String> {
    let name = |whose: Whose| match whose {
        Whose::Own => "the study's own model",
        Whose::Base => "the base model, refitted",
        Whose::Improved => "the improved model",
    };
    let line = |s: &OnUnseen| {
        let distance = |value: Option<f64>, factor: f64, what: &str, unit: &str| {
            value.map(|v| format!("{what} {} {unit}", sig(v * factor, 3)))
        };
        let errors = [
            distance(s.position, 1.0, "position", "m"),
            distance(s.heading, 1f64.to_degrees(), "heading", "deg"),
            distance(s.speed, 1.0, "speed", "m/s"),
        ];
        let errors: Vec<String> = errors.into_iter().flatten().collect();
        let errors = s.cvdm.map(|cvdm| format!("mean error {}; cVDM {} %", errors.join(", "), sig(cvdm, 3)));
        let diverged = (s.diverged > 0).then(|| format!("diverges on {}", number_of(s.diverged, "test run")));
        let parts: Vec<String> = errors.into_iter().chain(diverged).collect();
        format!(
            "{}: {}",
            name(s.model),
            if parts.is_empty() { "another model diverges on every test run".to_owned() } else { parts.join("; ") }
        )
    };
    let mut lines: Vec<String> = d.models.iter().map(line).collect();
    if d.written == Whose::Own {
        lines.push("improved.toml is the study's own model: it simulates the test runs better".to_owned());
    }
    lines
}

/// What the findings gain on the test runs.
pub(super) fn proof(d: &Diagnosis) -> Vec<String> {
    let Some(h) = &d.held_out else {
        return vec![
            "there are no test runs and too few recordings to set some aside, so nothing is confirmed; mark some with `split = \"test\"`"
                .to_owned(),
        ];
    };
    let alone_of_law = d.law.as_ref().and_then(|l| Some(alone("the law", l.held_out.as_ref()?)));
    if !d.adds() {
        let base = format!(
            "no finding to prove; base model, refitted, on {}: cVDM {} %",
            number_of(h.runs, "test run"),
            percentage(h.before)
        );
        return std::iter::once(base).chain(alone_of_law).chain(models(d)).collect();
    }
    let gain = h.improvement.map_or(DASH.to_owned(), percent);
    let interval = h.ci95.map_or("no interval with fewer than three recordings".to_owned(), |[low, high]| {
        format!("95 % {} to {}", percent(low), percent(high))
    });
    let mut lines = vec![format!(
        "{}: cVDM {} % before, {} % after (improvement {gain}, {interval}); {} better, {} worse",
        number_of(h.runs, "test run"),
        percentage(h.before),
        percentage(h.after),
        h.better,
        h.worse
    )];
    if h.ci95.is_some_and(|[low, _]| low <= 0.0) {
        lines.push("the interval reaches zero: whether simulations of such runs become better is open".to_owned());
    }
    if let (Some(run), Some(change)) = (&h.worst_run, h.worst_improvement) {
        let word = if change < 0.0 { "worse" } else { "better" };
        lines.push(format!("worst run: {run}, {} {word}", percent(change.abs())));
    }
    lines.extend(d.findings.iter().filter_map(|f| Some(alone(&f.title, f.held_out.as_ref()?))));
    lines.extend(alone_of_law);
    lines.extend(models(d));
    if d.written == Whose::Base {
        lines.push(
            "improved.toml is the base model, refitted: with the findings unseen runs are simulated worse".to_owned(),
        );
    }
    if let Some(g) = h.generic {
        let what = if d.findings.is_empty() { "law" } else { "findings" };
        lines.push(format!("with a generic force law in place of the {what}: cVDM {} %", sig(g, 3)));
    }
    lines.push(format!(
        "log-likelihood gained: {}; mean square of standardised innovations (1 agrees with the noise model): {} before, {} after",
        fixed(h.log_likelihood_gain, 1),
        sig(h.whiteness[0], 3),
        sig(h.whiteness[1], 3)
    ));
    lines
}
