//! Figures of the unknown force along the runs where it is most significant: on their tracks, and over time.
//! Its mean against state and inputs is in `pattern`.

use super::picture::{Picture, shown};
use super::stages::{Series, stages, to_earth};
use crate::diagnose::Diagnosis;
use crate::diagnose::answer::diagnosis::Trace;
use crate::numerals::sig;
use crate::report::plot::{Axis, BASELINE, Figure, GREY, Layer, Panel, RECORDED, SKY, east_north};
use crate::report::units::Units;

/// Squared length beyond which a horizontal force is resolved, in its standard deviations: 95 % of chi-squared with two degrees
/// of freedom.
const RESOLVED: f64 = 5.99;

/// Tracks with the unknown force as arrows, a row for each stage.
pub(in crate::report::diagnosis) fn tracks(d: &Diagnosis, runs: &[&Trace]) -> Option<Picture> {
    if runs.is_empty() {
        return None;
    }
    let (factor, unit) = Units::of(&d.base.ship).human("N");
    let hull = &d.base.ship.hull;
    // A large force is drawn as long as a fifth of the longest extent of a track.
    let widest = runs.iter().map(|t| extent(t)).fold(hull.lpp, f64::max);
    let large = nearly_largest(runs.iter().flat_map(|t| &t.before).map(|f| f[0].hypot(f[1])).collect());
    let (metres, title) = if large > 0.0 {
        let (arrow, force) = (sig(0.1 * widest, 2), sig(0.5 * large * factor, 2));
        let title = format!("Force the model does not explain; an arrow of {arrow} m is {force} {unit}");
        (0.2 * widest / large, title)
    } else {
        (0.0, "Tracks".to_owned())
    };
    let mut figure = Figure::new(title).columns(runs.len()).panel_size(640, 620);
    for (stage, color, force) in stages(d) {
        for t in runs {
            let (clear, faint) = arrows(t, force, metres);
            let poses = t.state.iter().step_by((t.state.len() / 5).max(1)).map(|s| [s[0], s[1], s[2]]);
            let track = t.state.iter().map(|s| east_north(s[0], s[1]));
            figure = figure.with(
                Panel::track(format!("{}, {stage}", t.run))
                    .with(Layer::line("track", RECORDED, track).width(2.0))
                    .with(Layer::hulls("ship", RECORDED, poses, hull.lpp, hull.breadth).unlisted().width(1.5))
                    .with(Layer::arrows("not resolved", GREY.faded(0.6), faint).width(1.5))
                    .with(Layer::arrows(format!("unknown force, {stage}"), color, clear).width(2.0)),
            );
        }
    }
    Some(Picture {
        stem: "tracks",
        part: "WHERE",
        caption: "Tracks of the runs with the most significant force that the model does not explain. Grey arrows are smaller than the \
                  filter resolves.".to_owned()
            + &shown(runs.len(), d.traces.len(), "training runs, those on which the force is largest in standard deviations,"),
        figure,
    })
}

/// The diagonal of the rectangle around a track \[m\].
fn extent(t: &Trace) -> f64 {
    let (mut lo, mut hi) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for s in &t.state {
        for j in 0..2 {
            lo[j] = lo[j].min(s[j]);
            hi[j] = hi[j].max(s[j]);
        }
    }
    (hi[0] - lo[0]).hypot(hi[1] - lo[1])
}

/// The value below which 95 % of the finite values lie.
fn nearly_largest(mut values: Vec<f64>) -> f64 {
    values.retain(|v| v.is_finite());
    values.sort_by(f64::total_cmp);
    values.get((0.95 * values.len() as f64) as usize).or(values.last()).copied().unwrap_or(0.0)
}

type Arrow = [(f64, f64); 2];

/// The force along a run as arrows, those that the filter resolves and those that it does not; `metres` to a newton.
fn arrows(t: &Trace, force: Series, metres: f64) -> (Vec<Arrow>, Vec<Arrow>) {
    let (mut clear, mut faint) = (Vec::new(), Vec::new());
    for k in (0..t.state.len()).step_by((t.state.len() / 40).max(1)) {
        let (s, f, sd) = (&t.state[k], &force(t)[k], &t.sd[k]);
        let earth = to_earth(s[2], f);
        let arrow = [east_north(s[0], s[1]), east_north(s[0] + metres * earth[0], s[1] + metres * earth[1])];
        let seen = (f[0] / sd[0]).powi(2) + (f[1] / sd[1]).powi(2) > RESOLVED;
        if seen { clear.push(arrow) } else { faint.push(arrow) }
    }
    (clear, faint)
}

/// The unknown force over time, a row for each equation.
pub(in crate::report::diagnosis) fn forces(d: &Diagnosis, runs: &[&Trace]) -> Option<Picture> {
    if runs.is_empty() {
        return None;
    }
    let units = Units::of(&d.base.ship);
    let mut figure = Figure::new("Unknown force over time").columns(runs.len()).panel_size(640, 420);
    for e in 0..3 {
        let (factor, label) = units.axis(e);
        for t in runs {
            let title = if e == 0 { t.run.clone() } else { String::new() };
            let mut panel = Panel::new(title, Axis::new("time [s]"), Axis::new(&label).including(0.0));
            for w in d.location.windows.iter().filter(|w| w.index == t.index) {
                panel = panel.with(Layer::v_span("window with a significant force", SKY, w.start, w.end));
            }
            let band = (0..t.time.len()).map(|k| {
                let (f, half) = (t.before[k][e] * factor, 1.96 * t.sd[k][e] * factor);
                (t.time[k], f - half, f + half)
            });
            panel = panel.with(Layer::h_line("zero", GREY, 0.0).unlisted()).with(Layer::band(
                "95 % band, base model",
                BASELINE,
                band,
            ));
            for (stage, color, force) in stages(d) {
                let points = t.time.iter().zip(force(t)).map(|(time, f)| (*time, f[e] * factor));
                let line = Layer::line(stage, color, points).width(2.5);
                panel = panel.with(if color == BASELINE { line.dashed() } else { line });
            }
            figure = figure.with(panel);
        }
    }
    Some(Picture {
        stem: "forces",
        part: "WHERE",
        caption: "The unknown force over time in the same runs, as the filter estimates it, with its 95 % band under the base \
                  model. With a complete model it is about zero.".to_owned()
            + &shown(runs.len(), d.traces.len(), "training runs, those on which the force is largest in standard deviations,"),
        figure,
    })
}
