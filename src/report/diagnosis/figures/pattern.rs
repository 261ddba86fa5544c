//! Figures of the mean unknown force: against state and inputs, by heading, and by region.
//! Means are over the samples of a bin in each run, then over runs, whose scatter gives the intervals.

use super::picture::Picture;
use super::stages::{Series, stages, to_earth};
use crate::diagnose::Diagnosis;
use crate::diagnose::answer::diagnosis::Trace;
use crate::numerals::sig;
use crate::report::plot::{Axis, BASELINE, Color, Figure, GREY, Layer, Legend, Marker, Panel, nice_step};
use crate::report::units::Units;
use crate::units::GRAVITY;
use std::collections::BTreeMap;

/// Something by which samples are sorted; `None` where it has no meaning.
type Abscissa<'a> = &'a dyn Fn(&Trace, usize) -> Option<f64>;
/// A part of the force on a sample.
type Component<'a> = &'a dyn Fn(&Trace, usize, &[f64; 3]) -> f64;

/// Fewest samples of a run in a bin; a few on the way through say nothing.
const FEWEST: f64 = 5.0;

/// Mean of a force in bins of something, run by run, then over runs: (middle of bin, mean, lo, hi).
fn binned(d: &Diagnosis, force: Series, of: Abscissa<'_>, component: Component<'_>, width: f64) -> Vec<[f64; 4]> {
    let mut bins: BTreeMap<i64, Vec<f64>> = BTreeMap::new();
    for t in &d.traces {
        let mut own: BTreeMap<i64, (f64, f64)> = BTreeMap::new();
        for (k, f) in force(t).iter().enumerate() {
            if let Some(x) = of(t, k).filter(|x| x.is_finite()) {
                let entry = own.entry((x / width).floor() as i64).or_default();
                entry.0 += component(t, k, f);
                entry.1 += 1.0;
            }
        }
        for (bin, (sum, count)) in own.into_iter().filter(|(_, (_, count))| *count >= FEWEST) {
            bins.entry(bin).or_default().push(sum / count);
        }
    }
    let summary = |(bin, means): (i64, Vec<f64>)| {
        let n = means.len() as f64;
        let mean = means.iter().sum::<f64>() / n;
        let half = if means.len() > 1 {
            let variance = means.iter().map(|m| (m - mean).powi(2)).sum::<f64>() / (n - 1.0);
            1.96 * (variance / n).sqrt()
        } else {
            f64::NAN
        };
        [(bin as f64 + 0.5) * width, mean, mean - half, mean + half]
    };
    bins.into_iter().map(summary).collect()
}

/// Width of a bin of headings \[deg\].
const SECTOR: f64 = 30.0;

fn heading(t: &Trace, k: usize) -> Option<f64> {
    Some(t.state[k][2].to_degrees().rem_euclid(360.0))
}

/// Mean unknown force against heading, propeller, rudder and drift, a row for each equation.
pub(in crate::report::diagnosis) fn pattern(d: &Diagnosis) -> Option<Picture> {
    if d.traces.is_empty() {
        return None;
    }
    let units = Units::of(&d.base.ship);
    let slow = 0.01 * (GRAVITY * d.base.ship.hull.lpp).sqrt();
    let rate = |t: &Trace, k: usize| Some(t.inputs[k][0]);
    let rudder = |t: &Trace, k: usize| Some(t.inputs[k][1].to_degrees());
    let drift = move |t: &Trace, k: usize| {
        let [_, _, _, u, v, _] = t.state[k];
        (u.hypot(v) > slow).then(|| (-v).atan2(u.abs()).to_degrees())
    };
    let all: [(Axis, Abscissa<'_>, Option<f64>); 4] = [
        (Axis::new("heading psi [deg]").range(0.0, 360.0).every(90.0), &heading, Some(SECTOR)),
        (Axis::new("propeller rate n [1/s]"), &rate, tenth(d, &rate)),
        (Axis::new("rudder angle delta [deg]"), &rudder, tenth(d, &rudder)),
        (Axis::new("drift angle (bow to starboard of course) [deg]"), &drift, tenth(d, &drift)),
    ];
    let all: Vec<(Axis, Abscissa<'_>, f64)> = all.into_iter().filter_map(|(x, of, w)| Some((x, of, w?))).collect();
    let columns = all.len();
    let mut figure = Figure::new("Mean unknown force against state and inputs").columns(columns).panel_size(520, 400);
    for e in 0..3 {
        let (factor, label) = units.axis(e);
        for (x, of, width) in &all {
            let mut panel = Panel::new("", x.clone(), Axis::new(&label).including(0.0))
                .with(Layer::h_line("zero", GREY, 0.0).unlisted());
            for (i, (stage, color, force)) in stages(d).into_iter().enumerate() {
                // Side by side, so that intervals do not cover each other.
                let aside = (i as f64 - 0.5) * 0.12 * width;
                let shape = if i == 0 { Marker::Circle } else { Marker::Diamond };
                let points = binned(d, force, of, &|_, _, f| f[e] * factor, *width);
                panel = panel
                    .with(Layer::line(stage, color, points.iter().map(|p| (p[0] + aside, p[1]))).unlisted().width(1.5))
                    .with(
                        Layer::errors(stage, color, points.iter().map(|p| (p[0] + aside, p[1], p[2], p[3])))
                            .marker(shape),
                    );
            }
            figure = figure.with(panel);
        }
    }
    Some(Picture {
        stem: "pattern",
        part: "WHERE",
        caption:
            "Mean unknown force against what varies of heading, propeller, rudder and drift, with 95 % intervals from the scatter \
                  between runs. A sine in heading is fixed on the earth; a slope in the others moves with the ship."
                .to_owned(),
        figure,
    })
}

/// A round number near a tenth of the range of something over all samples; `None` where it does not vary.
fn tenth(d: &Diagnosis, of: Abscissa<'_>) -> Option<f64> {
    let values = d.traces.iter().flat_map(|t| (0..t.state.len()).filter_map(|k| of(t, k))).filter(|v| v.is_finite());
    let (lo, hi) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |a, v| (a.0.min(v), a.1.max(v)));
    (hi - lo > 1e-6 * lo.abs().max(hi.abs())).then(|| nice_step((hi - lo) / 10.0))
}

/// Mean horizontal force by heading of the ship, as arrows in earth axes.
pub(in crate::report::diagnosis) fn compass(d: &Diagnosis) -> Option<Picture> {
    if d.traces.is_empty() {
        return None;
    }
    let (factor, unit) = Units::of(&d.base.ship).human("N");
    // Heading, and force to north and east, of each sector.
    let mean = |force: Series| -> Vec<[f64; 3]> {
        let towards = |axis: usize| {
            binned(d, force, &heading, &|t: &Trace, k, f: &[f64; 3]| to_earth(t.state[k][2], f)[axis] * factor, SECTOR)
        };
        towards(0).into_iter().zip(towards(1)).map(|(north, east)| [north[0], north[1], east[1]]).collect()
    };
    let large = stages(d).into_iter().flat_map(|s| mean(s.2)).map(|[_, n, e]| n.hypot(e)).fold(0.0, f64::max);
    let length = if large > 0.0 { 0.7 / large } else { 0.0 };
    let title = format!("Force by heading of the ship; the longest arrow is {} {unit}", sig(large, 2));
    let mut figure = Figure::new(title).columns(2).panel_size(700, 700).legend(Legend::Off);
    for (stage, color, force) in stages(d) {
        let arrows = mean(force).into_iter().map(|[heading, north, east]| {
            let at = (heading.to_radians().sin(), heading.to_radians().cos());
            [at, (at.0 + length * east, at.1 + length * north)]
        });
        figure = figure.with(rose(stage, color, arrows));
    }
    Some(Picture {
        stem: "compass",
        part: "WHERE",
        caption: "Mean horizontal force by heading of the ship, in earth axes. Arrows that all point the same way are fixed on \
                  the earth; arrows that turn with the position on the circle move with the ship.".to_owned(),
        figure,
    })
}

/// A circle of headings with arrows on it.
fn rose(stage: &str, color: Color, arrows: impl Iterator<Item = [(f64, f64); 2]>) -> Panel {
    let axis = |label: &str| Axis::new(label).range(-1.4, 1.4).every(10.0);
    let circle = (0..=72).map(|i| f64::from(5 * i).to_radians().sin_cos());
    let mut panel = Panel::new(stage, axis("east"), axis("north"));
    panel.equal_aspect = true;
    panel = panel.with(Layer::line("headings", GREY, circle).width(1.5));
    for (text, at) in [("N", (0.0, 0.78)), ("E", (0.78, 0.0)), ("S", (0.0, -0.78)), ("W", (-0.78, 0.0))] {
        panel = panel.with(Layer::text(text, GREY, at));
    }
    panel.with(Layer::arrows("mean force", color, arrows).width(3.0))
}

/// Mean unexplained force in each region of state and inputs.
pub(in crate::report::diagnosis) fn regions(d: &Diagnosis) -> Option<Picture> {
    if d.location.regions.is_empty() {
        return None;
    }
    let units = Units::of(&d.base.ship);
    let names: Vec<String> = d.location.regions.iter().map(|r| r.region.clone()).collect();
    let mut figure = Figure::new("Mean unexplained force by region").columns(3).legend(Legend::Off);
    figure = figure.panel_size(840, 130 + 46 * names.len() as u32);
    for e in 0..3 {
        let (factor, label) = units.axis(e);
        let bars = d.location.regions.iter().map(|r| {
            let (f, half) = (r.force[e] * factor, 1.96 * r.error[e] * factor);
            (f, f - half, f + half)
        });
        figure = figure.with(
            Panel::new("", Axis::new(label).including(0.0), Axis::categories("", names.iter().cloned()))
                .with(Layer::bars_with_intervals("mean force", BASELINE.faded(0.7), bars)),
        );
    }
    Some(Picture {
        stem: "regions",
        part: "WHERE",
        caption:
            "Constant force that each region of state and inputs would need beyond the base model, with 95 % intervals."
                .to_owned(),
        figure,
    })
}
