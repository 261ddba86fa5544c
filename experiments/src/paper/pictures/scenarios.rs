//! Figures 3 to 6 of the paper: single test runs, truth beside baselines and fit, one excellent and one moderate run for each ship.
//! A rule picks the runs; none is chosen by hand.
//!
//! The rule: the test runs in order of their cVDM improvement over the published baseline; *excellent* is the run at the 90th
//! percentile, *moderate* the one at the 50th, by nearest rank.

use crate::paper::artefact::Artefact;
use crate::paper::case::Case;
use crate::paper::error::PaperError;
use crate::paper::sheet::{Sheet, cell};
use crate::paper::target::Target;
use std::fmt::Write;
use trimtab::evaluate::{Comparison, predict};
use trimtab::numbers::numerals::{DASH, fixed, sig};
use trimtab::recording::{Run, Split, or_nan};
use trimtab::report::Table;
use trimtab::report::plot::{Axis, BASELINE, Color, FITTED, Figure, Layer, ORANGE, Panel, TRUTH, east_north};
use trimtab::ship::state::{STATE_NAMES, STATES};

/// Figures 3 to 6.
pub static SCENARIOS: Artefact = Artefact {
    name: "figures3to6",
    about: "Figures 3 to 6: an excellent and a moderate test run of each ship: truth, baselines and fit",
    make,
};

/// Which run is which, by percentile of the improvement over the published baseline.
const RULES: [(&str, f64); 2] = [("excellent", 90.0), ("moderate", 50.0)];
/// Ship outlines along a track.
const OUTLINES: usize = 6;

/// Names of the six dimensions with units for the table, and factors from SI.
pub const SHOWN: [(&str, f64); STATES] = [
    ("x [m]", 1.0),
    ("y [m]", 1.0),
    ("psi [deg]", 180.0 / std::f64::consts::PI),
    ("u [m/s]", 1.0),
    ("v [m/s]", 1.0),
    ("r [deg/s]", 180.0 / std::f64::consts::PI),
];

fn make(cases: &[Case], to: &Target) -> Result<String, PaperError> {
    let mut text = String::new();
    let header = [
        "ship",
        "grade",
        "run",
        "quantity",
        "published_p~",
        "captive_p~",
        "fitted",
        "gain_on_published",
        "gain_on_captive",
    ];
    let mut sheet = Sheet::new("figures3to6_values", header);
    for (i, case) in cases.iter().enumerate() {
        let [published, captive] = case.baselines().map(|(model, _)| case.evaluate(model).trajectories);
        for (j, (grade, percentile)) in RULES.into_iter().enumerate() {
            let empty = PaperError::Empty { ship: case.ship.name(), what: "test run that both models can sail" };
            let index = pick(&published, percentile).ok_or(empty)?;
            let (before, other) = (&published[index], &captive[index]);
            let name = format!("figure{}_{}_{grade}", 3 + 2 * i + j, case.ship.name());
            let title = format!(
                "{}, {grade} run ({} percentile): {} ({})",
                case.label(),
                ordinal(percentile),
                before.run,
                before.manoeuvre
            );
            to.figure(&name, figure(case, &case.windows[index], &title, before, other))?;
            let _ = writeln!(text, "{title}\n{}\n", table(before, other));
            numbers(case, grade, before, other).into_iter().for_each(|row| sheet.row(row));
        }
    }
    sheet.save(&to.folder)?;
    Ok(text)
}

fn ordinal(percentile: f64) -> String {
    format!("{percentile:.0}th")
}

/// Index of the test run at a percentile of the improvement, by nearest rank.
fn pick(comparisons: &[Comparison], percentile: f64) -> Option<usize> {
    let mut ranked: Vec<(usize, f64)> = comparisons
        .iter()
        .enumerate()
        .filter(|(_, c)| c.split == Split::Test)
        .filter_map(|(i, c)| Some((i, c.improvement()?)))
        .collect();
    ranked.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
    let rank = (percentile / 100.0 * ranked.len() as f64).ceil().max(1.0) as usize;
    ranked.get(rank.min(ranked.len()).checked_sub(1)?).map(|(i, _)| *i)
}

/// MD of a dimension in the units of the table, and cVDM last: published baseline, captive baseline, fit.
fn deviations(before: &Comparison, other: &Comparison) -> Vec<(&'static str, [Option<f64>; 3])> {
    let outcomes = [before.baseline.deviation(), other.baseline.deviation(), before.fitted.deviation()];
    let md = (0..STATES).map(|i| (SHOWN[i].0, outcomes.map(|o| Some(o?.md[i]? * SHOWN[i].1))));
    md.chain([("cVDM [%]", outcomes.map(|o| Some(o?.cvdm)))]).collect()
}

fn gain(before: Option<f64>, after: Option<f64>) -> Option<f64> {
    let (before, after) = (before?, after?);
    (before > 0.0).then(|| 1.0 - after / before)
}

fn table(before: &Comparison, other: &Comparison) -> Table {
    let mut table =
        Table::new(["mean deviation", "published p~", "captive p~", "fitted", "gain on p~ [%]", "on captive [%]"]);
    for (name, [published, captive, fitted]) in deviations(before, other) {
        let show = |v: Option<f64>| v.map_or(DASH.into(), |v| sig(v, 3));
        let share = |v: Option<f64>| v.map_or(DASH.into(), |v| fixed(100.0 * v, 1));
        table.row([
            name.to_owned(),
            show(published),
            show(captive),
            show(fitted),
            share(gain(published, fitted)),
            share(gain(captive, fitted)),
        ]);
    }
    table
}

fn numbers(case: &Case, grade: &str, before: &Comparison, other: &Comparison) -> Vec<[String; 9]> {
    let row = |(name, [published, captive, fitted]): (&str, [Option<f64>; 3])| {
        [
            case.ship.name().to_owned(),
            grade.to_owned(),
            before.run.clone(),
            if name.starts_with("cVDM") { name.to_owned() } else { format!("MD of {name}") },
            cell(published),
            cell(captive),
            cell(fitted),
            cell(gain(published, fitted)),
            cell(gain(captive, fitted)),
        ]
    };
    deviations(before, other).into_iter().map(row).collect()
}

/// A line of the figures: name, colour, states, dashed.
type Series<'a> = (&'a str, Color, &'a [[f64; STATES]], bool);

fn line((name, color, _, dashed): Series<'_>, points: Vec<(f64, f64)>) -> Layer {
    let layer = Layer::line(name, color, points);
    if dashed { layer.dashed() } else { layer }
}

/// The tracks with ship outlines.
fn track(case: &Case, series: &[Series<'_>]) -> Panel {
    let hull = &case.fit.model.ship.hull;
    let mut panel = Panel::track("track");
    for &s in series {
        let (name, color, states, _) = s;
        let points = states.iter().map(|s| east_north(s[0], s[1])).collect();
        let poses =
            (0..=OUTLINES).filter_map(|i| states.get(i * (states.len() - 1) / OUTLINES)).map(|s| [s[0], s[1], s[2]]);
        let outlines = Layer::hulls(format!("{name}, outline"), color, poses, hull.lpp, hull.breadth);
        panel = panel.with(line(s, points)).with(outlines.unlisted());
    }
    panel
}

fn figure(case: &Case, window: &Run, title: &str, before: &Comparison, other: &Comparison) -> Figure {
    let sail = |model| predict(model, window, case.setup.fit.integration).states;
    let (published, captive, fitted) =
        (sail(&case.published_baseline), sail(&case.captive_baseline), sail(&case.fit.model));
    let measured: Vec<[f64; STATES]> = window.measured.iter().map(or_nan).collect();
    // In the order of drawing: the truth lies below the models.
    let series: [Series<'_>; 4] = [
        ("truth", TRUTH, &measured, false),
        ("baseline, published p~", BASELINE, &published, true),
        ("baseline, captive tests", ORANGE, &captive, false),
        ("fitted", FITTED, &fitted, false),
    ];
    let time = || Axis::new("time t [s]");
    let over_time = |(i, label): (usize, &str)| {
        let points = |states: &[[f64; STATES]]| {
            states.iter().enumerate().map(|(k, s)| (k as f64 * window.dt, s[i] * SHOWN[i].1)).collect()
        };
        Panel::new("", time(), Axis::new(label)).with_all(series.map(|s| line(s, points(s.2))))
    };
    let input = |label: &str, value: &dyn Fn(usize) -> f64| {
        let points = (0..window.inputs.len()).map(|k| (k as f64 * window.dt, value(k)));
        Panel::new("", time(), Axis::new(label).including(0.0)).with(Layer::line("truth", TRUTH, points))
    };
    let states = [(2, "heading psi [deg]"), (3, "surge u [m/s]"), (4, "sway v [m/s]"), (5, "yaw rate r [deg/s]")];
    Figure::new(title)
        .columns(4)
        .panel_size(700, 600)
        .with(track(case, &series))
        .with_all(states.map(over_time))
        .with(input("propeller n [rpm]", &|k| 60.0 * window.inputs[k].n))
        .with(input("rudder delta [deg]", &|k| window.inputs[k].delta.to_degrees()))
        .with(gains(before, other))
}

/// Gains in each mean deviation and in cVDM on both baselines.
fn gains(before: &Comparison, other: &Comparison) -> Panel {
    let names: Vec<String> = STATE_NAMES.iter().map(|n| (*n).to_owned()).chain(["cVDM".to_owned()]).collect();
    let gains = |which: usize| -> Vec<f64> {
        let all = deviations(before, other);
        all.iter().map(|(_, d)| gain(d[which], d[2]).map_or(f64::NAN, |g| 100.0 * g)).collect()
    };
    Panel::new("gain in MD and cVDM", Axis::categories("", names), Axis::new("[%]"))
        .with(Layer::bars("gain on published p~", BASELINE, gains(0)))
        .with(Layer::bars("gain on captive tests", ORANGE, gains(1)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use trimtab::evaluate::{Deviation, Outcome};

    fn comparison(split: Split, improvement: f64) -> Comparison {
        let outcome = |cvdm: f64| Outcome::Simulated(Deviation { md: [Some(cvdm); STATES], cvdm });
        Comparison {
            run: String::new(),
            session: String::new(),
            manoeuvre: String::new(),
            split,
            start_time: 0.0,
            duration: 1.0,
            baseline: outcome(10.0),
            steady: outcome(20.0),
            fitted: outcome(10.0 * (1.0 - improvement)),
        }
    }

    #[test]
    fn the_rule_ranks_test_runs_only_and_takes_the_nearest_rank() {
        let mut comparisons: Vec<Comparison> = (1..=10).map(|i| comparison(Split::Test, 0.09 * f64::from(i))).collect();
        comparisons.reverse();
        comparisons.push(comparison(Split::Train, 0.99));
        // The ninth and the fifth of ten, counted from the least improved.
        assert_eq!(pick(&comparisons, 90.0), Some(1));
        assert_eq!(pick(&comparisons, 50.0), Some(5));
        assert_eq!(pick(&comparisons[10..], 50.0), None);
    }

    #[test]
    fn a_gain_on_an_exact_baseline_is_absent() {
        assert_eq!(gain(Some(0.0), Some(1.0)), None);
        assert_eq!(gain(Some(4.0), Some(1.0)), Some(0.75));
    }
}
