//! The third part of a diagnosis: what was added to the model, and what that did to the parameters it had.
//! How sure the findings are is in the verdict, and what they gain in the proof.

use super::law::law;
use super::names::about;
use super::phrases::{adequacy_words, amplitude, p_value};
use crate::diagnose::Diagnosis;
use crate::diagnose::law::sides::Sides;
use crate::diagnose::proof::finding::Amplitude;
use crate::numerals::sig;
use crate::report::units::Units;

/// What was added to the model, and how its own parameters moved.
pub(super) fn model(d: &Diagnosis) -> Vec<String> {
    let units = Units::of(&d.base.ship);
    let mut lines = Vec::new();
    for f in &d.findings {
        lines.extend(f.parameters.iter().map(|a| {
            let about = about(&d.model, &a.name).map_or(String::new(), |words| format!(", {words}"));
            format!("{} = {}{about}", a.name, amplitude(a, units))
        }));
    }
    let further: Vec<String> =
        d.model.to_file().terms.into_iter().filter(|t| !d.findings.iter().any(|f| f.mechanism == *t)).collect();
    if !d.findings.is_empty() && !further.is_empty() {
        let list = further.join(", ");
        lines.push(format!("beside the findings improved.toml has {list}: terms of the study's model, and the ship's own kept near their priors"));
    }
    lines.extend(d.law.iter().flat_map(law));
    let mut moved: Vec<_> = d.moves.iter().filter(|m| m.moved.abs() >= 1.0).collect();
    moved.sort_by(|a, b| b.moved.abs().total_cmp(&a.moved.abs()));
    lines.push(if !d.adds() {
        "nothing was added; the improved model is the base model, refitted".to_owned()
    } else if moved.is_empty() {
        "none of the model's own parameters moved by more than its standard error".to_owned()
    } else {
        let list: Vec<String> = moved
            .iter()
            .map(|m| format!("{} {:+.1} s.e. ({} to {})", m.name, m.moved, sig(m.before, 3), sig(m.after, 3)))
            .collect();
        format!("parameters that had absorbed the effect: {}", list.join(", "))
    });
    let slope = d.model.index("rudder.lift1").map(|i| d.model.parameters[i].value);
    lines.extend(d.sides.as_ref().map(|s| own_sides(s, units, slope)));
    lines.push(d.validity.line());
    lines
}

/// Whether the ship's own two sides differ, and by what; a lift at no rudder angle also as the angle that has it, by the slope of the lift.
fn own_sides(s: &Sides, units: Units, slope: Option<f64>) -> String {
    let differ = adequacy_words(s.p);
    let as_angle = |a: &Amplitude| {
        let slope = slope.filter(|slope| a.name == "rudder.lift0" && *slope > 0.0);
        slope.map_or(String::new(), |slope| {
            format!(" (as a rudder that is off by {} deg)", sig((a.value / slope).to_degrees(), 2))
        })
    };
    let one = |a: &Amplitude| format!("{} = {}{}", a.name, amplitude(a, units), as_angle(a));
    let by: Vec<String> = s.clear().take(3).map(one).collect();
    let by = if by.is_empty() { String::new() } else { format!(": {}", by.join(", ")) };
    let p = p_value(s.p);
    format!("port and starboard of the ship itself differ, as with a single screw: {differ} ({p}){by}")
}
