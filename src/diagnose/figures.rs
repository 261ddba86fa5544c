//! The pictures of a diagnosis: where the unknown force acts, what could be behind it, and what naming it gains.
//! They show what is in [`Diagnosis`] and compute nothing beyond means in bins.

use super::conclude::{Diagnosis, Ranked, Trace};
use super::report::{Units, title_of};
use crate::report::{
    Axis, BASELINE, Color, FITTED, Figure, FigureError, GREEN, GREY, LIMIT, Layer, Legend, Marker, ORANGE, PURPLE,
    Panel, RECORDED, SKY, east_north,
};
use crate::ship::Ship;
use rayon::prelude::*;
use statrs::distribution::{ContinuousCDF, Normal};
use std::collections::BTreeMap;

/// A figure, drawn, with its file name and the part of the report it belongs to.
#[derive(Clone, Debug)]
pub struct Picture {
    /// File name without extension.
    pub stem: &'static str,
    /// Title of the figure.
    pub title: String,
    /// What is to be seen, in one or two sentences.
    pub caption: &'static str,
    /// Heading of the part of the report, as in [`super::report::parts`].
    pub part: &'static str,
    /// As [`Figure::png`].
    pub png: Vec<u8>,
    /// As [`Figure::csv`].
    pub csv: String,
}

struct Sketch {
    stem: &'static str,
    part: &'static str,
    caption: &'static str,
    figure: Figure,
}

/// Every picture that the diagnosis gives cause to.
///
/// # Errors
/// When a figure cannot be drawn.
pub fn all(d: &Diagnosis) -> Result<Vec<Picture>, FigureError> {
    let draw = |s: Sketch| {
        let Sketch { stem, part, caption, figure } = s;
        Ok(Picture { stem, caption, part, png: figure.png()?, csv: figure.csv()?, title: figure.title })
    };
    sketches(d).into_par_iter().map(draw).collect()
}

fn sketches(d: &Diagnosis) -> Vec<Sketch> {
    let picture = |stem, part, caption, figure| Sketch { stem, part, caption, figure };
    let telling = telling(d);
    let mut out = Vec::new();
    if !d.ranking.is_empty() {
        out.push(picture(
            "ranking",
            "VERDICT",
            "Evidence for each mechanism, tested one at a time in the base model and corrected for how many were tested. \
             Only what is beyond the dashed line can be named.",
            ranking(d),
        ));
    }
    if !d.confusable.is_empty() {
        out.push(picture(
            "confusability",
            "VERDICT",
            "Mechanisms that look alike on these data: 1 cannot be told apart, below 0.7 (blank) easily.",
            confusability(d),
        ));
    }
    if !telling.is_empty() {
        out.push(picture(
            "tracks",
            "WHERE",
            "Tracks of the most telling runs with the force that the model does not explain. Grey arrows are within what \
             the filter cannot resolve.",
            tracks(d, &telling),
        ));
        out.push(picture(
            "forces",
            "WHERE",
            "The unknown force over time in the same runs, as the filter estimates it, with its 95 % band under the base \
             model. A complete model leaves it about zero.",
            forces(d, &telling),
        ));
        out.push(picture(
            "pattern",
            "WHERE",
            "Mean unknown force against heading, propeller, rudder and drift, with 95 % intervals from the scatter \
             between runs. A sine in heading is fixed on the earth; a slope in the others goes with the ship.",
            pattern(d),
        ));
        out.push(picture(
            "compass",
            "WHERE",
            "Mean horizontal force by heading of the ship, in earth axes. Arrows that all point the same way are fixed on \
             the earth; arrows that turn with the position on the circle go with the ship.",
            compass(d),
        ));
    }
    if !d.location.regions.is_empty() {
        out.push(picture(
            "regions",
            "WHERE",
            "Constant force that each region of state and inputs would need beyond the base model, with 95 % intervals.",
            regions(d),
        ));
    }
    if !d.moves.is_empty() && !d.findings.is_empty() {
        out.push(picture(
            "moves",
            "MODEL",
            "How far the model's own parameters moved when the findings were added: those beyond 2 had been hiding them.",
            levels("Moves of the model's own parameters", "moved [standard errors]", d.moves.iter().map(|m| (m.name.clone(), m.moved))),
        ));
    }
    if let Some(figure) = held_out(d) {
        out.push(picture(
            "held_out",
            "PROOF",
            "Each run that was kept aside, simulated freely by the base model refitted and by the improved model.",
            figure,
        ));
    }
    let mut budget: Vec<(String, f64)> = d.hull_budget.iter().map(|b| (b.name.clone(), b.used)).collect();
    budget.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    budget.truncate(20);
    if !budget.is_empty() {
        out.push(picture(
            "hull_budget",
            "STILL OPEN",
            "How much of what was allowed for in the ship's own coefficients these data used; the twenty furthest. They \
             are an error budget, not findings.",
            levels("Hull error budget", "distance from the expected value [standard deviations allowed]", budget),
        ));
    }
    out
}

/// Runs on which the unknown force is largest in its own standard deviations, above all where the findings remove it.
fn telling(d: &Diagnosis) -> Vec<&Trace> {
    let size = |force: &[[f64; 3]], sd: &[[f64; 3]]| {
        let terms = force.iter().zip(sd).flat_map(|(f, s)| (0..3).map(move |e| (f[e] / s[e]).powi(2)));
        let finite: Vec<f64> = terms.filter(|v| v.is_finite()).collect();
        finite.iter().sum::<f64>() / (finite.len().max(1)) as f64
    };
    let mut ranked: Vec<(f64, &Trace)> = d
        .traces
        .iter()
        .map(|t| {
            let removed = if d.location_after.is_some() { size(&t.after, &t.sd) } else { 0.0 };
            (size(&t.before, &t.sd) - removed, t)
        })
        .collect();
    ranked.sort_by(|a, b| b.0.total_cmp(&a.0));
    ranked.into_iter().take(3).map(|r| r.1).collect()
}

/// What the two states of the model are called.
const BEFORE: &str = "base model";
const AFTER: &str = "with the findings";

/// The unknown force along a run, at one stage of the diagnosis.
type Series = fn(&Trace) -> &[[f64; 3]];
/// Name, colour and force of a stage.
type Stage = (&'static str, Color, Series);
/// Something by which samples are sorted; `None` where it has no meaning.
type Abscissa<'a> = &'a dyn Fn(&Trace, usize) -> Option<f64>;

/// The force series that there are: before, and after where something was found.
fn stages(d: &Diagnosis) -> Vec<Stage> {
    let mut out: Vec<Stage> = vec![(BEFORE, BASELINE, |t| &t.before)];
    if d.location_after.is_some() {
        out.push((AFTER, FITTED, |t| &t.after));
    }
    out
}

fn to_earth(psi: f64, force: &[f64; 3]) -> [f64; 2] {
    let (s, c) = psi.sin_cos();
    [c * force[0] - s * force[1], s * force[0] + c * force[1]]
}

/// The value below which 95 % of the positive values lie.
fn nearly_largest(mut values: Vec<f64>) -> f64 {
    values.retain(|v| v.is_finite());
    values.sort_by(f64::total_cmp);
    values.get((0.95 * values.len() as f64) as usize).or(values.last()).copied().unwrap_or(0.0)
}

fn tracks(d: &Diagnosis, runs: &[&Trace]) -> Figure {
    let units = Units::of(&d.base.ship);
    let (factor, unit) = units.human("N");
    let Ship { hull, .. } = &d.base.ship;
    let length = hull.lpp;
    // A large force is drawn as long as a fifth of the shortest extent of a track.
    let extent = |t: &Trace| {
        let (mut lo, mut hi) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for s in &t.state {
            for j in 0..2 {
                lo[j] = lo[j].min(s[j]);
                hi[j] = hi[j].max(s[j]);
            }
        }
        (hi[0] - lo[0]).hypot(hi[1] - lo[1])
    };
    let widest = runs.iter().map(|t| extent(t)).fold(length, f64::max);
    let large = nearly_largest(runs.iter().flat_map(|t| &t.before).map(|f| f[0].hypot(f[1])).collect());
    let metres = if large > 0.0 { 0.2 * widest / large } else { 0.0 };
    let title = if large > 0.0 {
        format!(
            "Force the model does not explain; an arrow of {} m is {} {unit}",
            crate::report::sig(0.1 * widest, 2),
            crate::report::sig(0.5 * large * factor, 2)
        )
    } else {
        "Tracks".to_owned()
    };
    let mut figure = Figure::new(title).columns(runs.len()).panel_size(640, 620);
    for (stage, color, force) in stages(d) {
        for t in runs {
            let stride = (t.state.len() / 40).max(1);
            let (mut clear, mut faint) = (Vec::new(), Vec::new());
            for k in (0..t.state.len()).step_by(stride) {
                let (s, f, sd) = (&t.state[k], &force(t)[k], &t.sd[k]);
                let earth = to_earth(s[2], f);
                let arrow = [east_north(s[0], s[1]), east_north(s[0] + metres * earth[0], s[1] + metres * earth[1])];
                let seen = (f[0] / sd[0]).powi(2) + (f[1] / sd[1]).powi(2) > 5.99;
                if seen { clear.push(arrow) } else { faint.push(arrow) }
            }
            let poses: Vec<[f64; 3]> =
                t.state.iter().step_by((t.state.len() / 5).max(1)).map(|s| [s[0], s[1], s[2]]).collect();
            figure = figure.with(
                Panel::track(format!("{}, {stage}", t.run))
                    .with(Layer::line("track", RECORDED, t.state.iter().map(|s| east_north(s[0], s[1]))).width(2.0))
                    .with(Layer::hulls("ship", RECORDED, poses, length, hull.breadth).unlisted().width(1.5))
                    .with(Layer::arrows("not resolved", GREY.faded(0.6), faint).width(1.5))
                    .with(Layer::arrows(format!("unknown force, {stage}"), color, clear).width(2.0)),
            );
        }
    }
    figure
}

const EQUATIONS: [(&str, &str, &str); 3] = [("X", "N", "surge"), ("Y", "N", "sway"), ("N", "N m", "yaw")];

fn forces(d: &Diagnosis, runs: &[&Trace]) -> Figure {
    let units = Units::of(&d.base.ship);
    let mut figure = Figure::new("Unknown force over time").columns(runs.len()).panel_size(640, 420);
    for (e, (name, unit, word)) in EQUATIONS.iter().enumerate() {
        let (factor, unit) = units.human(unit);
        for t in runs {
            let title = if e == 0 { t.run.clone() } else { String::new() };
            let at = |k: usize| (t.time[k], t.before[k][e] * factor, 1.96 * t.sd[k][e] * factor);
            let label = format!("{word} {name} [{unit}]");
            let mut panel = Panel::new(title, Axis::new("time [s]"), Axis::new(label).including(0.0));
            for w in d.location.windows.iter().filter(|w| w.index == t.index) {
                panel = panel.with(Layer::v_span("window that stands out", SKY, w.start, w.end));
            }
            panel = panel.with(Layer::h_line("zero", GREY, 0.0).unlisted()).with(Layer::band(
                "95 % band, base model",
                BASELINE,
                (0..t.time.len()).map(|k| {
                    let (time, f, half) = at(k);
                    (time, f - half, f + half)
                }),
            ));
            for (stage, color, force) in stages(d) {
                let points = t.time.iter().zip(force(t)).map(|(time, f)| (*time, f[e] * factor));
                panel = panel.with(Layer::line(stage, color, points).width(2.5));
            }
            figure = figure.with(panel);
        }
    }
    figure
}

/// Mean of a force in bins of something, run by run, then over runs: (middle of bin, mean, lo, hi).
fn binned(
    d: &Diagnosis,
    force: Series,
    of: Abscissa,
    component: &dyn Fn(&Trace, usize, &[f64; 3]) -> f64,
    width: f64,
) -> Vec<(f64, f64, f64, f64)> {
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
        for (bin, (sum, count)) in own {
            // A few samples on the way through a bin say nothing.
            if count >= 5.0 {
                bins.entry(bin).or_default().push(sum / count);
            }
        }
    }
    bins.into_iter()
        .map(|(bin, means)| {
            let n = means.len() as f64;
            let mean = means.iter().sum::<f64>() / n;
            let half = if means.len() > 1 {
                let variance = means.iter().map(|m| (m - mean).powi(2)).sum::<f64>() / (n - 1.0);
                1.96 * (variance / n).sqrt()
            } else {
                f64::NAN
            };
            ((bin as f64 + 0.5) * width, mean, mean - half, mean + half)
        })
        .collect()
}

/// A round number near `span / count`.
fn round_step(span: f64, count: f64) -> f64 {
    let raw = (span / count).max(1e-9);
    let power = 10f64.powf(raw.log10().floor());
    [1.0, 2.0, 5.0, 10.0].iter().map(|m| m * power).find(|s| *s >= raw).unwrap_or(10.0 * power)
}

fn pattern(d: &Diagnosis) -> Figure {
    let units = Units::of(&d.base.ship);
    let slow = 0.01 * (9.80665 * d.base.ship.hull.lpp).sqrt();
    let heading = |t: &Trace, k: usize| Some(t.state[k][2].to_degrees().rem_euclid(360.0));
    let rate = |t: &Trace, k: usize| Some(t.inputs[k][0]);
    let rudder = |t: &Trace, k: usize| Some(t.inputs[k][1].to_degrees());
    let drift = move |t: &Trace, k: usize| {
        let [_, _, _, u, v, _] = t.state[k];
        (u.hypot(v) > slow).then(|| (-v).atan2(u.abs()).to_degrees())
    };
    let all: [(&str, Abscissa); 4] = [
        ("heading psi [deg]", &heading),
        ("propeller rate n [1/s]", &rate),
        ("rudder angle delta [deg]", &rudder),
        ("drift angle (bow to starboard of course) [deg]", &drift),
    ];
    let mut figure = Figure::new("Mean unknown force against state and inputs").columns(4).panel_size(520, 400);
    for (e, (name, unit, word)) in EQUATIONS.iter().enumerate() {
        let (factor, unit) = units.human(unit);
        for (j, (label, of)) in all.iter().enumerate() {
            let values: Vec<f64> = d
                .traces
                .iter()
                .flat_map(|t| (0..t.state.len()).filter_map(|k| of(t, k)))
                .filter(|v| v.is_finite())
                .collect();
            let (lo, hi) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |a, v| (a.0.min(*v), a.1.max(*v)));
            let width = if j == 0 { 30.0 } else { round_step(hi - lo, 10.0) };
            let mut x = Axis::new(*label);
            if j == 0 {
                x = x.range(0.0, 360.0).every(90.0);
            }
            let mut panel = Panel::new("", x, Axis::new(format!("{word} {name} [{unit}]")).including(0.0))
                .with(Layer::h_line("zero", GREY, 0.0).unlisted());
            for (i, (stage, color, force)) in stages(d).into_iter().enumerate() {
                // Side by side, so that intervals do not cover each other.
                let aside = (i as f64 - 0.5) * 0.12 * width;
                let points = binned(d, force, of, &|_, _, f| f[e] * factor, width);
                panel = panel
                    .with(Layer::line(stage, color, points.iter().map(|p| (p.0 + aside, p.1))).unlisted().width(1.5))
                    .with(Layer::errors(stage, color, points.into_iter().map(|p| (p.0 + aside, p.1, p.2, p.3))));
            }
            figure = figure.with(panel);
        }
    }
    figure
}

fn compass(d: &Diagnosis) -> Figure {
    let units = Units::of(&d.base.ship);
    let (factor, unit) = units.human("N");
    let heading = |t: &Trace, k: usize| Some(t.state[k][2].to_degrees().rem_euclid(360.0));
    let mean = |force, axis: usize| {
        binned(d, force, &heading, &|t: &Trace, k, f: &[f64; 3]| to_earth(t.state[k][2], f)[axis] * factor, 30.0)
    };
    let large = stages(d)
        .into_iter()
        .flat_map(|(_, _, force)| {
            mean(force, 0).into_iter().zip(mean(force, 1)).map(|(n, e)| n.1.hypot(e.1)).collect::<Vec<f64>>()
        })
        .fold(0.0, f64::max);
    let length = if large > 0.0 { 0.7 / large } else { 0.0 };
    let title = format!("Force by heading of the ship; the longest arrow is {} {unit}", crate::report::sig(large, 2));
    let mut figure = Figure::new(title).columns(2).panel_size(700, 700).legend(Legend::Off);
    for (stage, color, force) in stages(d) {
        let arrows: Vec<[(f64, f64); 2]> = mean(force, 0)
            .into_iter()
            .zip(mean(force, 1))
            .map(|(n, e)| {
                let at = (n.0.to_radians().sin(), n.0.to_radians().cos());
                [at, (at.0 + length * e.1, at.1 + length * n.1)]
            })
            .collect();
        let circle = (0..=72).map(|i| f64::from(5 * i).to_radians().sin_cos());
        let mut panel = Panel::new(
            stage,
            Axis::new("east").range(-1.4, 1.4).every(10.0),
            Axis::new("north").range(-1.4, 1.4).every(10.0),
        );
        panel.equal_aspect = true;
        panel = panel.with(Layer::line("headings", GREY, circle).width(1.5));
        for (text, at) in [("N", (0.0, 0.78)), ("E", (0.78, 0.0)), ("S", (0.0, -0.78)), ("W", (-0.78, 0.0))] {
            panel = panel.with(Layer::text(text, GREY, at));
        }
        figure = figure.with(panel.with(Layer::arrows("mean force", color, arrows).width(3.0)));
    }
    figure
}

fn regions(d: &Diagnosis) -> Figure {
    let units = Units::of(&d.base.ship);
    let names: Vec<String> = d.location.regions.iter().map(|r| r.region.clone()).collect();
    let mut figure = Figure::new("Mean unexplained force by region").columns(3).legend(Legend::Off);
    figure = figure.panel_size(840, 130 + 46 * names.len() as u32);
    for (e, (name, unit, word)) in EQUATIONS.iter().enumerate() {
        let (factor, unit) = units.human(unit);
        let bars = d.location.regions.iter().map(|r| {
            let (f, half) = (r.force[e] * factor, 1.96 * r.error[e] * factor);
            (f, f - half, f + half)
        });
        let labels = Axis::categories("", names.iter().cloned());
        figure = figure.with(
            Panel::new("", Axis::new(format!("{word} {name} [{unit}]")).including(0.0), labels)
                .with(Layer::bars_with_intervals("mean force", BASELINE.faded(0.7), bars)),
        );
    }
    figure
}

/// Evidence in standard errors: the two-sided normal quantile of a corrected p-value.
fn evidence(r: &Ranked) -> f64 {
    match Normal::new(0.0, 1.0) {
        Ok(normal) if r.p > 1e-300 => -normal.inverse_cdf((0.5 * r.p).min(0.5)),
        // Beyond the smallest number the root of the statistic is as good.
        _ => r.statistic.max(0.0).sqrt(),
    }
}

fn ranking(d: &Diagnosis) -> Figure {
    let mut rows: Vec<&Ranked> = d.ranking.iter().collect();
    rows.sort_by(|a, b| evidence(b).total_cmp(&evidence(a)));
    rows.truncate(18);
    let named = |m: &str| d.findings.iter().any(|f| f.mechanism == m);
    let rival = |m: &str| d.findings.iter().any(|f| f.confidence_set.iter().any(|c| c == m));
    let class = |r: &Ranked| -> usize {
        if named(&r.mechanism) {
            0
        } else if rival(&r.mechanism) {
            1
        } else if r.p >= d.settings.alpha {
            5
        } else if !r.admissible || r.size < 1.0 {
            2
        } else if r.second_opinion >= 0.01 {
            3
        } else {
            4
        }
    };
    let classes = [
        ("found", FITTED),
        ("cannot be told from it", SKY),
        ("impossible sign, or too small to matter", ORANGE),
        ("the ship's own forces can explain it", PURPLE),
        ("explains something, but worse", GREEN),
        ("not seen", GREY),
    ];
    let threshold = Normal::new(0.0, 1.0).map_or(1.96, |n| -n.inverse_cdf(0.5 * d.settings.alpha));
    let labels = rows.iter().map(|r| match r.sessions.len() {
        0 => r.title.clone(),
        _ if r.by_session => format!("{} (each session its own)", r.title),
        _ => format!("{} ({})", r.title, r.sessions.join(", ")),
    });
    let mut panel = Panel::new(
        "",
        Axis::new("evidence, corrected for all that was tested [standard errors]").including(0.0),
        Axis::categories("", labels),
    );
    for (i, (name, color)) in classes.into_iter().enumerate() {
        let own: Vec<(f64, f64)> = rows
            .iter()
            .enumerate()
            .filter(|(_, r)| class(r) == i)
            .map(|(row, r)| (evidence(r).max(0.0), row as f64))
            .collect();
        if own.is_empty() {
            continue;
        }
        let stems = own.iter().flat_map(|(x, y)| [(0.0, *y), (*x, *y), (f64::NAN, f64::NAN)]);
        panel = panel.with(Layer::line(name, color, stems).unlisted().width(7.0)).with(Layer::scatter(
            name,
            color,
            own.iter().copied(),
        ));
    }
    let limit = format!("can be named (alpha {})", d.settings.alpha);
    Figure::new("Which mechanism explains the data?")
        .panel_size(1240, 150 + 42 * rows.len() as u32)
        .with(panel.with(Layer::v_line(limit, LIMIT, threshold).dashed()))
}

fn confusability(d: &Diagnosis) -> Figure {
    // The mechanisms with the strongest evidence first, as far as they are in a pair at all.
    let paired = |m: &str| d.confusable.iter().any(|c| c.a == m || c.b == m);
    let mut names: Vec<&str> = d.ranking.iter().map(|r| r.mechanism.as_str()).filter(|m| paired(m)).collect();
    names.truncate(14);
    let between = |a: &str, b: &str| {
        if a == b {
            return 1.0;
        }
        let pair = d.confusable.iter().find(|c| (c.a == a && c.b == b) || (c.a == b && c.b == a));
        pair.map_or(f64::NAN, |c| (c.cosine * 100.0).round() / 100.0)
    };
    let values: Vec<Vec<f64>> = names.iter().map(|a| names.iter().map(|b| between(a, b)).collect()).collect();
    let map = crate::report::Mark::Heatmap { values, range: Some((0.5, 1.0)), annotate: true };
    let axis = |short: bool| {
        let labels = names.iter().map(|m| if short { (*m).to_owned() } else { title_of(m).to_owned() });
        Axis::categories("", labels)
    };
    let side = 60 * names.len() as u32;
    Figure::new("What looks alike on these data")
        .panel_size(560 + side, 260 + side)
        .with(Panel::new("", axis(true), axis(false)).with(Layer::new("likeness (cosine)", RECORDED, map)))
}

fn held_out(d: &Diagnosis) -> Option<Figure> {
    let h = d.held_out.as_ref()?;
    let mut pairs: Vec<(&str, f64, f64)> = h
        .runs_before
        .iter()
        .zip(&h.runs_after)
        .map(|(b, a)| (b.run.as_str(), b.cvdm.unwrap_or(f64::NAN), a.cvdm.unwrap_or(f64::NAN)))
        .collect();
    pairs.sort_by(|a, b| b.1.total_cmp(&a.1));
    pairs.truncate(40);
    if pairs.is_empty() || d.findings.is_empty() {
        return None;
    }
    let rows = || pairs.iter().enumerate().map(|(i, p)| (i as f64, p));
    let joined = rows().flat_map(|(i, p)| [(p.1, i), (p.2, i), (f64::NAN, f64::NAN)]);
    let dots = Panel::new("", Axis::new("cVDM [%]").log(), Axis::categories("", pairs.iter().map(|p| p.0.to_owned())))
        .with(Layer::line("change", GREY, joined).unlisted().width(2.0))
        .with(Layer::scatter("base model, refitted", BASELINE, rows().map(|(i, p)| (p.1, i))))
        .with(Layer::scatter("improved model", FITTED, rows().map(|(i, p)| (p.2, i))).marker(Marker::Diamond))
        .with(Layer::v_line("mean, base", BASELINE, h.before.unwrap_or(f64::NAN)).dotted().unlisted())
        .with(Layer::v_line("mean, improved", FITTED, h.after.unwrap_or(f64::NAN)).dotted().unlisted());
    let dots = match h.generic {
        Some(g) => dots.with(Layer::v_line("mean with a generic force law", GREY, g).dashed()),
        None => dots,
    };
    Some(
        Figure::new("Runs kept aside, before and after (dotted: means)")
            .panel_size(1240, 150 + 40 * pairs.len() as u32)
            .with(dots),
    )
}

/// Signed sizes in standard units, one a row, with the range of chance shaded.
fn levels(title: &str, label: &str, rows: impl IntoIterator<Item = (String, f64)>) -> Figure {
    let (names, values): (Vec<String>, Vec<f64>) = rows.into_iter().unzip();
    let height = 150 + 40 * names.len() as u32;
    let mut panel = Panel::new("", Axis::new(label).including(-2.5).including(2.5), Axis::categories("", names));
    panel = panel.with(Layer::v_span("within 2", GREY, -2.0, 2.0)).with(Layer::bars("value", FITTED, values));
    Figure::new(title).panel_size(1100, height).legend(Legend::Off).with(panel)
}
