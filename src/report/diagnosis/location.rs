//! The second part of a diagnosis: in which equation, when, and in which region of state and inputs the unexplained force acts.
//! Nothing is named here that the verdict does not name.

use super::phrases::{equations, forces, p_value, percent, window};
use crate::diagnose::Diagnosis;
use crate::diagnose::evidence::place::Place;
use crate::diagnose::evidence::push::Window;
use crate::numerals::fixed;
use crate::physics::Kind;
use crate::report::units::Units;
use std::collections::BTreeSet;

/// Where the unexplained force acts, and how it behaves.
pub(super) fn location(d: &Diagnosis) -> Vec<String> {
    let units = Units::of(&d.base.ship);
    let [x, y, n] = &d.location.equations;
    let mut lines = vec![format!("unexplained force by equation (rms): {}", equations([x, y, n], units))];
    for f in d.findings.iter().filter(|f| f.kind != Kind::Sensor) {
        let e = &f.equations;
        lines.push(format!("force of {} (rms): {}", f.title, equations([&e.x, &e.y, &e.n], units)));
    }
    lines.extend(in_time(d, units));
    lines.extend(in_regions(d, units));
    lines.extend(d.location.place.as_ref().filter(|p| p.p < 1e-4).map(|p| by_place(p, units)));
    let mut signatures: Vec<&str> = Vec::new();
    for f in &d.findings {
        if !signatures.contains(&f.signature.as_str()) {
            lines.push(format!("signature: {}", f.signature));
            signatures.push(&f.signature);
        }
    }
    lines
}

/// The windows of the findings, or else those with a significant force; the first three in full.
fn in_time(d: &Diagnosis, units: Units) -> Vec<String> {
    let pushes: Vec<&Window> = d.findings.iter().flat_map(|f| &f.windows).collect();
    let windows: Vec<&Window> = if pushes.is_empty() { d.location.windows.iter().collect() } else { pushes };
    if windows.is_empty() {
        return vec!["in time: no window with a significant force".to_owned()];
    }
    let runs: BTreeSet<usize> = windows.iter().map(|w| w.index).collect();
    let (count, with, all) = (windows.len(), runs.len(), d.traces.len());
    let mut lines = vec![format!("in time: a significant force in {count} windows, in {with} of {all} runs")];
    lines.extend(windows.iter().take(3).map(|w| window(w, units)));
    lines
}

/// The three regions of state and inputs with the most significant force.
fn in_regions(d: &Diagnosis, units: Units) -> Vec<String> {
    let clear = d.location.regions.iter().filter(|r| r.p < 0.01 && r.samples > 0.005);
    let mut lines: Vec<String> = clear
        .take(3)
        .map(|r| {
            let (samples, force) = (percent(r.samples), forces(&r.force, &r.error, units));
            format!("{} ({samples} of samples): {force} ({})", r.region, p_value(r.p))
        })
        .collect();
    if lines.is_empty() {
        lines.push("in state and inputs: no region with a significant force".to_owned());
    }
    lines
}

/// The part of the water with the strongest force.
fn by_place(p: &Place, units: Units) -> String {
    let [[south, north], [west, east]] = [p.north, p.east].map(|limits| limits.map(|v| fixed(v, 0)));
    let [to_north, to_east] = p.force.map(|f| units.text(f, "N"));
    format!(
        "by place: strongest from {south} to {north} m north and {west} to {east} m east, {to_north} to north and {to_east} \
         to east beyond the force that acts everywhere ({})",
        p_value(p.p)
    )
}
