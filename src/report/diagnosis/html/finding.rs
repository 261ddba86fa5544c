//! One finding of the page: how well it is supported, how large it is, where it acts, what proves it, and what else it could be.
//! All of it is in the document; nothing is concluded here.

use crate::diagnose::proof::finding::Amplitude;
use crate::diagnose::proof::unseen::FindingProof;
use crate::diagnose::{Diagnosis, Finding};
use crate::numerals::{fixed, plural, sig};
use crate::physics::Kind;
use crate::report::diagnosis::names::{about, title_of};
use crate::report::diagnosis::phrases::{equations, p_value, window};
use crate::report::diagnosis::quantity::{count, quantity};
use crate::report::diagnosis::verdict::{grade_label, size, withdrawn};
use crate::report::html::Section;
use crate::report::units::Units;
use maud::{Markup, html};

/// Windows of a finding written in full.
const WINDOWS: usize = 6;

/// The section of the `i`-th finding.
pub(in crate::report::diagnosis) fn section(d: &Diagnosis, i: usize) -> Option<Section> {
    let f = d.findings.get(i)?;
    let units = Units::of(&d.base.ship);
    let (words, class) = grade_label(f.grade);
    let mut section = Section::new(capitalised(&f.title)).badge(words, class).markup(html! {
        p { (capitalised(&f.title)) (size(f, units)) " is " (grade_sentence(f)) "." }
    });
    section = section.markup(parameters(d, f, i, units));
    section = section.markup(html! { h3 { "Where it acts" } }).list(places(d, f, units));
    section = section.markup(html! { h3 { "Proof on unseen recordings" } }).markup(proof(f, i));
    section.markup(html! { h3 { "What else it could be" } }).text(&rivals(d, f)).into()
}

/// What the grade of a finding means for it.
fn grade_sentence(f: &Finding) -> String {
    let tested = format!("{} after correction for the number of mechanisms tested", p_value(f.p));
    match grade_label(f.grade).0 {
        "confirmed" => {
            format!("confirmed: unseen recordings are better with it, and no repetition misses it ({tested})")
        }
        _ => format!(
            "suspected: the training runs support it ({tested}), and unseen recordings do not decide or are missing"
        ),
    }
}

/// The parameters with their intervals.
fn parameters(d: &Diagnosis, f: &Finding, i: usize, units: Units) -> Markup {
    let row = |k: usize, a: &Amplitude| {
        let (factor, unit) = units.human(&a.unit);
        let key = |part: &str| format!("findings[{i}].parameters[{k}].{part}");
        let number = |part: &str, v: f64| quantity(&key(part), v, factor, &sig(v * factor, 3));
        let words = about(&d.model, &a.name).unwrap_or_default();
        html! {
            tr {
                td { code { (a.name) } } td.number { (number("value", a.value)) }
                td.number { (number("ci95[0]", a.ci95[0])) " to " (number("ci95[1]", a.ci95[1])) }
                td { (unit) } td.wide { (words) }
            }
        }
    };
    html! {
        @if !f.parameters.is_empty() {
            div.scroll { table {
                thead { tr { th { "parameter" } th.number { "estimate" } th.number { "95 % interval" } th { "unit" } th { "meaning" } } }
                tbody { @for (k, a) in f.parameters.iter().enumerate() { (row(k, a)) } }
            } }
        }
    }
}

/// Equations, sessions, region, windows and signature.
fn places(d: &Diagnosis, f: &Finding, units: Units) -> Vec<String> {
    let mut lines = Vec::new();
    if f.kind != Kind::Sensor {
        let e = &f.equations;
        lines.push(format!(
            "share of its force by equation (root mean square): {}",
            equations([&e.x, &e.y, &e.n], units)
        ));
    }
    lines.push(if f.sessions.is_empty() {
        "sessions: all".to_owned()
    } else {
        format!(
            "sessions: {}{}",
            f.sessions.join(", "),
            if f.by_session { ", each with a size of its own" } else { "" }
        )
    });
    if let Some(region) = &f.region {
        lines.push(format!("strongest where: {region}"));
    }
    lines.extend(f.windows.iter().take(WINDOWS).map(|w| window(w, units)));
    if f.windows.len() > WINDOWS {
        lines.push(format!("{WINDOWS} of {} windows are listed; all are in diagnosis.json", f.windows.len()));
    }
    lines.push(format!("signature: {}", f.signature));
    if let Some(region) = d.location.place.as_ref().filter(|p| p.p < 1e-4 && f.kind == Kind::Environment) {
        lines.push(format!("it differs between parts of the water ({})", p_value(region.p)));
    }
    lines
}

/// Errors on unseen recordings without and with the finding.
fn proof(f: &Finding, i: usize) -> Markup {
    let Some(h) = &f.held_out else {
        return html! { p { "There is no unseen recording to prove it." } };
    };
    let rows: [(&str, &str, Option<[f64; 2]>, f64, &str); 3] = [
        ("position", "position", h.position, 1.0, "m"),
        ("heading", "heading", h.heading, 1f64.to_degrees(), "deg"),
        ("speed", "surge speed", h.speed, 1.0, "m/s"),
    ];
    let number = |key: String, v: f64, factor: f64| quantity(&key, v, factor, &sig(v * factor, 3));
    let one = |name: &str, words: &str, [before, after]: [f64; 2], factor: f64, unit: &str| {
        let key = |k: usize| format!("findings[{i}].held_out.{name}[{k}]");
        html! {
            tr { td { "mean error of " (words) } td.number { (number(key(0), before, factor)) } td.number { (number(key(1), after, factor)) } td { (unit) } }
        }
    };
    let mean = h.before.zip(h.after);
    let is_simulated = mean.is_some() || rows.iter().any(|r| r.2.is_some());
    html! {
        @if is_simulated { div.scroll { table {
            caption { "Free simulation of " (count(&format!("findings[{i}].held_out.recordings"), h.recordings)) " " (plural(h.recordings, "unseen recording")) ", everything else refitted without the finding." }
            thead { tr { th { "measure" } th.number { "without" } th.number { "with" } th { "unit" } } }
            tbody {
                @for (name, words, pair, factor, unit) in rows { @if let Some(pair) = pair { (one(name, words, pair, factor, unit)) } }
                @if let Some((before, after)) = mean {
                    tr {
                        td { "cVDM" }
                        td.number { (number(format!("findings[{i}].held_out.before"), before, 1.0)) }
                        td.number { (number(format!("findings[{i}].held_out.after"), after, 1.0)) }
                        td { "%" }
                    }
                }
            }
        } } } @else {
            p { "The sensors of " (count(&format!("findings[{i}].held_out.recordings"), h.recordings)) " " (plural(h.recordings, "unseen recording")) " show it themselves, whatever the ship does." }
        }
        p { (gains(h, i)) }
    }
}

/// Improvement and gains in log-likelihood with their intervals.
fn gains(h: &FindingProof, i: usize) -> Markup {
    let number = |part: &str, v: f64, factor: f64| {
        quantity(&format!("findings[{i}].held_out.{part}"), v, factor, &fixed(v * factor, 0))
    };
    let one = |of: &str, keys: [&str; 2], gain: Option<f64>, ci: Option<[f64; 2]>, factor: f64, unit: &str| {
        let end = |k: usize, v: f64| number(&format!("{}[{k}]", keys[1]), v, factor);
        gain.map(|gain| {
            html! {
                (of) " " (number(keys[0], gain, factor)) (unit)
                @if let Some([low, high]) = ci { " (95 % interval " (end(0, low)) (unit) " to " (end(1, high)) (unit) ")" }
            }
        })
    };
    let agreement = "Gain in log-likelihood of their sensors' kinematic consistency";
    let keys = ["log_likelihood_gain", "log_likelihood_ci95"];
    let all = [
        one(agreement, ["agreement_gain", "agreement_ci95"], h.agreement_gain, h.agreement_ci95, 1.0, ""),
        one("Improvement of cVDM", ["improvement", "improvement_ci95"], h.improvement, h.improvement_ci95, 100.0, " %"),
        one("Gain in log-likelihood", keys, h.log_likelihood_gain, h.log_likelihood_ci95, 1.0, ""),
    ];
    html! { @for gain in all.into_iter().flatten() { (gain) ". " } }
}

/// The class of mechanisms that these data allow, and the trial that distinguishes them.
fn rivals(d: &Diagnosis, f: &Finding) -> String {
    if f.confidence_set.len() < 2 {
        return format!("No other mechanism of the catalogue explains these data as well: {}.", f.why);
    }
    let all: Vec<&str> = f.confidence_set.iter().map(|m| title_of(&d.model, m)).collect();
    let trial = d
        .next_trial
        .as_ref()
        .map_or(String::new(), |t| format!(" A trial that distinguishes them: {}; {}.", t.trial, t.why));
    format!("These data allow {}: {}.{trial}", all.join(", or "), f.why)
}

/// What was tried and is not named, each with its reason; nothing where nothing was withdrawn.
pub(in crate::report::diagnosis) fn withdrawn_section(d: &Diagnosis) -> Option<Section> {
    let units = Units::of(&d.base.ship);
    let one = |f| {
        let text = withdrawn(f, units);
        capitalised(text.strip_prefix("tried and not named: ").unwrap_or(&text)) + "."
    };
    let lines: Vec<String> = d.withdrawn.iter().map(one).collect();
    (!lines.is_empty()).then(|| Section::new("Tried and not named").list(lines))
}

/// Words with a capital at their start.
pub(in crate::report::diagnosis) fn capitalised(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}
