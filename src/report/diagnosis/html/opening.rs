//! What a reader of the page sees first: the verdict in a sentence, three numbers, and one picture with the runs to choose.
//! The numbers are those of the document; which three are shown is decided here.

use crate::diagnose::{Diagnosis, Finding};
use crate::numerals::{fixed, plural, sig};
use crate::report::diagnosis::names::title_of;
use crate::report::diagnosis::quantity::{count, quantity};
use crate::report::diagnosis::verdict::{grade_label, subject, title};
use maud::{Markup, html};

/// A number to be seen first: what it is, and in words what it means.
struct Number {
    value: Markup,
    meaning: Markup,
}

/// Verdict, sentence, what was diagnosed, and the three numbers.
pub(in crate::report::diagnosis) fn opening(d: &Diagnosis, study: &str) -> Markup {
    html! {
        p.subject {
            (title(d))
            @if let Some(f) = d.findings.first() {
                @let (words, class) = grade_label(f.grade);
                " " span class={ "grade " (class) } { (words) }
            }
        }
        p.verdict { (d.headline) }
        div.numbers { @for n in numbers(d) { div { strong { (n.value) } span { (n.meaning) } } } }
        p.subject { (subject(d, study)) }
    }
}

/// The three numbers: what the findings gain on unseen runs, or how the base model does where nothing is named.
fn numbers(d: &Diagnosis) -> Vec<Number> {
    let mut all: Vec<Number> = Vec::new();
    all.extend(d.findings.iter().enumerate().find_map(|(i, f)| nearer(d, i, f)));
    all.extend(cvdm(d));
    all.extend(stable(d));
    all.extend(better(d));
    if d.findings.is_empty() {
        all.extend(followed(d));
        all.push(Number {
            value: html! { (d.ranking.len()) },
            meaning: html! { "mechanisms of the catalogue tested, none of them named" },
        });
    }
    all.truncate(3);
    all
}

/// How much nearer to unseen recordings a model with the finding sails.
fn nearer(d: &Diagnosis, i: usize, f: &Finding) -> Option<Number> {
    let h = f.held_out.as_ref()?;
    let kinds = [
        ("position", h.position, 1.0, "m", "mean position error"),
        ("heading", h.heading, 1f64.to_degrees(), "deg", "mean heading error"),
        ("speed", h.speed, 1.0, "m/s", "mean speed error"),
    ];
    let (name, [before, after], factor, unit, words) =
        kinds.into_iter().find_map(|(name, pair, factor, unit, words)| Some((name, pair?, factor, unit, words)))?;
    let part =
        |k: usize, v: f64| quantity(&format!("findings[{i}].held_out.{name}[{k}]"), v, factor, &sig(v * factor, 3));
    let title = title_of(&d.model, &f.mechanism);
    Some(Number {
        value: html! { (part(0, before)) " → " (part(1, after)) "\u{a0}" (unit) },
        meaning: html! {
            (words) " on " (count(&format!("findings[{i}].held_out.recordings"), h.recordings))
            " " (plural(h.recordings, "unseen recording")) ", without and with " (title)
        },
    })
}

/// The error of all findings together on test runs, with the interval of the improvement.
fn cvdm(d: &Diagnosis) -> Option<Number> {
    let h = d.held_out.as_ref()?;
    let percent = |key: &str, v: f64| quantity(&format!("held_out.{key}"), v, 100.0, &fixed(100.0 * v, 0));
    let mean = |key: &str, v: f64| quantity(&format!("held_out.{key}"), v, 1.0, &sig(v, 3));
    let before = h.before?;
    let (Some(after), Some(gain), false) = (h.after, h.improvement, !d.adds()) else {
        return Some(Number {
            value: html! { (mean("before", before)) "\u{a0}%" },
            meaning: html! { "error (cVDM) of the base model, refitted, on " (count("held_out.runs", h.runs)) " " (plural(h.runs, "test run")) },
        });
    };
    Some(Number {
        value: html! { (percent("improvement", gain)) "\u{a0}%" },
        meaning: html! {
            "smaller error (cVDM " (mean("before", before)) "\u{a0}% → " (mean("after", after)) "\u{a0}%) on "
            (count("held_out.runs", h.runs)) " " (plural(h.runs, "test run"))
            @if let Some([low, high]) = h.ci95 {
                "; 95 % interval " (percent("ci95[0]", low)) "\u{a0}% to " (percent("ci95[1]", high)) "\u{a0}%"
            }
        },
    })
}

/// How many repetitions give the same answer.
fn stable(d: &Diagnosis) -> Option<Number> {
    let s = d.stability.as_ref()?;
    Some(Number {
        value: html! { (count("stability.same", s.same)) " of " (count("stability.of", s.of)) },
        meaning: html! { "repetitions of the analysis on changed recordings give the same answer" },
    })
}

/// How many test runs are simulated better.
fn better(d: &Diagnosis) -> Option<Number> {
    let h = d.held_out.as_ref().filter(|_| d.adds())?;
    Some(Number {
        value: html! { (count("held_out.better", h.better)) " of " (count("held_out.runs", h.runs)) },
        meaning: html! { "test runs are simulated better with " @if d.findings.is_empty() { "the law" } @else { "the findings" } },
    })
}

/// How the base model follows the training runs.
fn followed(d: &Diagnosis) -> Option<Number> {
    let f = &d.following;
    (f.runs > 0).then(|| Number {
        value: html! { (count("following.better_than_steady", f.better_than_steady)) " of " (count("following.runs", f.runs)) },
        meaning: html! { "training runs are simulated better by the model than by steady motion" },
    })
}
