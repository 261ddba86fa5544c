//! The unknown force along runs, before and after the findings: what the figures of forces have in common.
//! It draws nothing.

use crate::diagnose::Diagnosis;
use crate::diagnose::answer::diagnosis::Trace;
use crate::report::plot::{BASELINE, Color, FITTED};

/// The unknown force along a run, at one stage of the diagnosis \[N, N, N m\].
pub(in crate::report::diagnosis) type Series = fn(&Trace) -> &[[f64; 3]];
/// Name, colour and force of a stage.
pub(in crate::report::diagnosis) type Stage = (&'static str, Color, Series);

/// The stages that there are: before, and after where something was found.
pub(in crate::report::diagnosis) fn stages(d: &Diagnosis) -> Vec<Stage> {
    let mut out: Vec<Stage> = vec![("base model", BASELINE, |t| &t.before)];
    if d.location_after.is_some() {
        out.push(("with the findings", FITTED, |t| &t.after));
    }
    out
}

/// The three runs on which the unknown force is largest in its own standard deviations, above all where the findings remove it.
pub(in crate::report::diagnosis) fn telling(d: &Diagnosis) -> Vec<&Trace> {
    let size = |force: &[[f64; 3]], sd: &[[f64; 3]]| {
        let terms = force.iter().zip(sd).flat_map(|(f, s)| (0..3).map(move |e| (f[e] / s[e]).powi(2)));
        let finite: Vec<f64> = terms.filter(|v| v.is_finite()).collect();
        finite.iter().sum::<f64>() / (finite.len().max(1)) as f64
    };
    let removed = |t: &Trace| if d.location_after.is_some() { size(&t.after, &t.sd) } else { 0.0 };
    let mut ranked: Vec<(f64, &Trace)> = d.traces.iter().map(|t| (size(&t.before, &t.sd) - removed(t), t)).collect();
    ranked.sort_by(|a, b| b.0.total_cmp(&a.0));
    ranked.into_iter().take(3).map(|r| r.1).collect()
}

/// The horizontal part of a force on the body, to north and east, at heading `psi` \[rad\].
pub(in crate::report::diagnosis) fn to_earth(psi: f64, force: &[f64; 3]) -> [f64; 2] {
    let (s, c) = psi.sin_cos();
    [c * force[0] - s * force[1], s * force[0] + c * force[1]]
}
