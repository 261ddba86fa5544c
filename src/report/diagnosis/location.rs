//! The second part of a diagnosis: in which equation, when, and in which region of state and inputs the unexplained force acts.
//! Nothing is named here that the verdict does not name.

use super::phrases::{equations, forces, p_value, percent, window};
use crate::diagnose::Diagnosis;
use crate::diagnose::push::Window;
use crate::numerals::fixed;
use crate::physics::Kind;
use crate::report::units::Units;
use std::collections::BTreeSet;

pub(super) fn location(d: &Diagnosis) -> Vec<String> {
    let units = Units::of(&d.base.ship);
    let [x, y, n] = &d.location.equations;
    let mut lines = vec![format!("unexplained force by equation (rms): {}", equations([x, y, n], units))];
    for f in d.findings.iter().filter(|f| f.kind != Kind::Sensor) {
        let e = &f.equations;
        lines.push(format!("force of {} (rms): {}", f.title, equations([&e.x, &e.y, &e.n], units)));
    }
    let pushes: Vec<&Window> = d.findings.iter().flat_map(|f| &f.windows).collect();
    let windows: Vec<&Window> = if pushes.is_empty() { d.location.windows.iter().collect() } else { pushes };
    let sailed: BTreeSet<usize> = windows.iter().map(|w| w.index).collect();
    if windows.is_empty() {
        lines.push("in time: no window with a significant force".to_owned());
    } else {
        lines.push(format!(
            "in time: a significant force in {} windows of {} of {} runs",
            windows.len(),
            sailed.len(),
            d.traces.len()
        ));
        lines.extend(windows.iter().take(3).map(|w| window(w, units)));
    }
    let regions: Vec<_> = d.location.regions.iter().filter(|r| r.p < 0.01 && r.samples > 0.005).collect();
    if regions.is_empty() {
        lines.push("in state and inputs: no region with a significant force".to_owned());
    }
    for r in regions.iter().take(3) {
        lines.push(format!(
            "{} ({} of samples): {} ({})",
            r.region,
            percent(r.samples),
            forces(&r.force, &r.error, units),
            p_value(r.p)
        ));
    }
    lines.extend(d.location.place.as_ref().filter(|p| p.p < 1e-4).map(|p| {
        format!(
            "by place: strongest from {} to {} m north and {} to {} m east, {} to north and {} to east beyond the \
             force that acts everywhere ({})",
            fixed(p.north[0], 0),
            fixed(p.north[1], 0),
            fixed(p.east[0], 0),
            fixed(p.east[1], 0),
            units.text(p.force[0], "N"),
            units.text(p.force[1], "N"),
            p_value(p.p)
        )
    }));
    let mut signatures: Vec<&str> = Vec::new();
    for f in &d.findings {
        if !signatures.contains(&f.signature.as_str()) {
            lines.push(format!("signature: {}", f.signature));
            signatures.push(&f.signature);
        }
    }
    lines
}
