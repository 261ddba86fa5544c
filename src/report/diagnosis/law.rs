//! A law for what is not in the catalogue, in words: the equation, its symbols, every coefficient, and where it was recorded.
//! Whether it is confirmed is in its grade; nothing is concluded here.

use super::phrases::p_value;
#[cfg(feature = "plot")]
use super::quantity::quantity;
#[cfg(feature = "plot")]
use crate::diagnose::Diagnosis;
use crate::diagnose::law::{Law, LawTerm, Visited};
use crate::diagnose::proof::grade::LawGrade;
use crate::numerals::{interval, sig};
#[cfg(feature = "plot")]
use crate::report::html::Section;
#[cfg(feature = "plot")]
use maud::html;

/// What a grade says of a law.
fn grade_words(grade: LawGrade) -> &'static str {
    match grade {
        LawGrade::Confirmed => "confirmed on unseen runs",
        LawGrade::Exploratory => "exploratory, not confirmed on unseen runs",
        LawGrade::Refuted => "refuted by unseen runs",
    }
}

/// Symbols that stand in monomials, with their meaning.
const SYMBOLS: [(&str, &str); 7] = [
    ("u", "u surge speed [m/s]"),
    ("v", "v sway speed [m/s]"),
    ("r", "r yaw rate [rad/s]"),
    ("n", "n propeller rate [1/s]"),
    ("delta", "delta rudder angle [rad]"),
    ("psi", "psi heading [rad]"),
    ("W", "W = u_R|u_R| with u_R the flow past the rudder [m/s]"),
];

/// The section of the page on the law; nothing without one.
#[cfg(feature = "plot")]
pub(super) fn section(d: &Diagnosis) -> Option<Section> {
    let law = d.law.as_ref()?;
    let key = |i: usize, part: &str| format!("law.terms[{i}].{part}");
    let number = |i: usize, part: &str, v: f64| quantity(&key(i, part), v, 1.0, &sig(v, 3));
    let row = |i: usize, t: &LawTerm| {
        html! {
            tr {
                td { code { (t.name) } } td { (t.axis) } td { (t.symbol) } td.number { (number(i, "value", t.value)) }
                td.number { (number(i, "ci95[0]", t.ci95[0])) " to " (number(i, "ci95[1]", t.ci95[1])) }
                td { (t.unit) } td { (mirror_words(t.mirror)) }
            }
        }
    };
    let style = if law.is_confirmed() { "confirmed" } else { "suspected" };
    let section = Section::new("A law for what is not in the catalogue").badge(badge(law.grade), style).markup(html! {
        p { "It describes the force where it was recorded and names no cause. It is " (grade_words(law.grade)) "." }
        @for line in &law.equation { p { code { (line) } } }
        div.scroll { table {
            thead { tr { th { "parameter" } th { "in" } th { "monomial" } th.number { "coefficient" } th.number { "95 % interval" } th { "unit" } th { "mirror" } } }
            tbody { @for (i, t) in law.terms.iter().enumerate() { (row(i, t)) } }
        } }
    });
    let mut lines: Vec<String> = symbols(law).into_iter().collect();
    lines.extend(range(law));
    lines.extend(law.held_out.as_ref().map(|h| super::proof::alone("the law", h)));
    Some(section.list(lines))
}

/// A grade as a word.
#[cfg(feature = "plot")]
fn badge(grade: LawGrade) -> &'static str {
    match grade {
        LawGrade::Confirmed => "confirmed",
        LawGrade::Exploratory => "exploratory",
        LawGrade::Refuted => "refuted",
    }
}

/// What the symbols of a law stand for; nothing for constants.
fn symbols(law: &Law) -> Option<String> {
    let all: Vec<&str> = SYMBOLS.iter().filter(|(s, _)| law.uses(s)).map(|(_, words)| *words).collect();
    (!all.is_empty()).then(|| format!("in it {}", all.join(", ")))
}

/// The law: equation, symbols, coefficients and range.
pub(super) fn law(law: &Law) -> Vec<String> {
    let mut lines: Vec<String> = law
        .equation
        .iter()
        .map(|e| format!("law (a description, not physics), {}: {e}", grade_words(law.grade)))
        .collect();
    lines.extend(symbols(law));
    lines.extend(law.terms.iter().map(coefficient));
    lines.extend(range(law));
    lines
}

/// A coefficient with its interval and what it is mirrored to.
fn coefficient(t: &LawTerm) -> String {
    let monomial = if t.symbol == "1" { "constant".to_owned() } else { t.symbol.clone() };
    format!(
        "{}, {monomial} in {}: {} {} (95 % {}), {} after correction for the monomials tried, {}",
        t.name,
        t.axis,
        sig(t.value, 3),
        t.unit,
        interval(t.ci95[0], t.ci95[1], 3),
        p_value(t.p),
        mirror_words(t.mirror)
    )
}

/// How a force behaves when the motion is mirrored port to starboard.
fn mirror_words(mirror: &str) -> &'static str {
    if mirror == "even" { "mirrored with the motion" } else { "not mirrored with the motion" }
}

/// Where the recordings were that the law was fitted to.
fn range(law: &Law) -> Option<String> {
    let one = |v: &Visited| format!("{} from {} to {} {}", v.symbol, sig(v.low, 3), sig(v.high, 3), v.unit);
    let all: Vec<String> = law.range.iter().map(one).collect();
    (!all.is_empty()).then(|| format!("it is valid where it was recorded, and nowhere else: {}", all.join(", ")))
}
