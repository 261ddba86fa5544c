//! The figure of a campaign: detection, names, sets, false alarms and errors of unseen runs.
//! It only counts and draws; the selections are in `arms`.

use std::collections::BTreeSet;

use trimtab::report::plot::{Axis, BLUE, Color, Figure, GREEN, LIMIT, Layer, ORANGE, Panel};

use super::arms::{LOPSIDED, MODELS, Question, SHOWN, WAYS, arm, lopsided, named_right, reached, single};
use super::plan::OTHER_HULLS;
use crate::conceal::judge::score::Score;
use trimtab::numbers::statistics::{Share, median};

/// Strengths of the single effects.
const STEPS: [f64; 4] = [3.0, 6.0, 12.0, 24.0];

fn strength() -> Axis {
    Axis::new("signal-to-noise ratio").log().range(2.5, 30.0)
}

fn share_axis() -> Axis {
    Axis::new("share of cases").range(0.0, 1.0)
}

/// Shares of single effects over their strength, with intervals; no points without a case.
fn curve(name: &str, color: Color, scores: &[Score], family: Option<&str>, of: Question) -> [Layer; 2] {
    let point = |snr: f64| {
        let s = Share::of(single(scores, family, snr).map(of))?;
        Some((snr, s.value(), s.low, s.high))
    };
    Layer::line_with_intervals(name, color, STEPS.into_iter().filter_map(point).collect())
}

/// A share as a bar with its interval; nothing without a case.
fn bar(cases: impl IntoIterator<Item = Option<bool>>) -> (f64, f64, f64) {
    Share::of(cases).map_or((f64::NAN, f64::NAN, f64::NAN), |s| (s.value(), s.low, s.high))
}

fn by_strength(scores: &[Score], title: &str, of: Question) -> Panel {
    let mut panel = Panel::new(title, strength(), share_axis());
    for (name, color, family) in [("HD truth", BLUE, "hd"), ("MMG truth", ORANGE, "mmg")] {
        panel = panel.with_all(curve(name, color, scores, Some(family), of));
    }
    panel
}

fn alarms(scores: &[Score]) -> Panel {
    let names: BTreeSet<&str> = arm(scores, "null").map(|s| s.background.as_str()).collect();
    let bars = |family: Option<&str>, right: Question| -> Vec<(f64, f64, f64)> {
        let share = |name: &&str| {
            let here = arm(scores, "null").filter(|s| s.background == *name);
            let here = here.filter(|s| family.is_none_or(|f| s.family == f));
            bar(here.map(|s| right(s).map(|r| !r)))
        };
        names.iter().map(share).collect()
    };
    let mut panel =
        Panel::new("false alarms on nulls", Axis::categories("background", names.iter().copied()), share_axis())
            .with(Layer::bars_with_intervals("HD truth", BLUE, bars(Some("hd"), named_right)))
            .with(Layer::bars_with_intervals("MMG truth", ORANGE, bars(Some("mmg"), named_right)));
    for way in &WAYS[1..] {
        let wrong = bars(None, way.right);
        if wrong.iter().any(|b| b.0.is_finite()) {
            panel = panel.with(Layer::bars_with_intervals(format!("{}, both", way.name), way.color, wrong));
        }
    }
    panel.with(Layer::h_line("target", LIMIT, 0.05))
}

fn hulls(scores: &[Score]) -> Panel {
    let strong = |s: &Score| {
        s.arm == OTHER_HULLS || (matches!(s.arm.as_str(), "null" | "single") && s.snr_asked.is_none_or(|r| r == 12.0))
    };
    let here: Vec<&Score> = scores.iter().filter(|s| strong(s) && reached(s) && s.background != "euler").collect();
    let counted: [(&str, Question); 4] = [
        ("false alarm", |s| s.false_alarm),
        ("detected", |s| s.detected),
        ("first right", |s| s.first_right),
        ("in the set", |s| s.in_set),
    ];
    let axis = Axis::categories("", counted.iter().map(|c| c.0));
    let mut panel = Panel::new("ship A and other hulls, SNR 12", axis, share_axis());
    for (name, color, family) in SHOWN {
        let of_hull =
            |(_, of): &(&str, Question)| bar(here.iter().filter(|s| s.family == family.name()).map(|s| of(s)));
        panel = panel.with(Layer::bars_with_intervals(name, color, counted.iter().map(of_hull).collect::<Vec<_>>()));
    }
    panel
}

fn wrong_names(scores: &[Score]) -> Panel {
    let silent: [(&str, &str, Question); 4] = [
        ("not in the catalogue", "withheld", |s| s.wrong_confident),
        ("absorbed", "absorbed", |s| s.absorbed_named),
        ("no reference", "pooled", |s| s.wrong_confident),
        ("poor design", "design", |s| s.wrong_confident),
    ];
    let wrong = silent.map(|(_, name, of)| bar(arm(scores, name).map(of)));
    let axis = Axis::categories("", silent.iter().map(|c| c.0));
    Panel::new("not identifiable: wrong name given", axis, share_axis())
        .with(Layer::bars_with_intervals("both families", GREEN, wrong.to_vec()))
        .with(Layer::h_line("target", LIMIT, 0.1))
}

fn methods(scores: &[Score]) -> Panel {
    let mut panel = Panel::new("right name, detected or not, both families", strength(), share_axis());
    for way in &WAYS {
        if STEPS.into_iter().any(|snr| Share::of(single(scores, None, snr).map(way.right)).is_some()) {
            panel = panel.with_all(curve(way.name, way.color, scores, None, way.right));
        }
    }
    panel
}

fn errors(scores: &[Score]) -> Panel {
    let mut panel = Panel::new("error on unseen runs, median", strength(), Axis::new("cVDM [%]").including(0.0));
    for model in &MODELS {
        // One set of cases for all models: those with an oracle.
        let at = |snr: f64| {
            let cases = single(scores, None, snr).filter(|s| s.oracle_held_out.is_some());
            median(cases.filter_map(model.score)).map(|value| (snr, value))
        };
        panel = panel.with(Layer::line(model.name, model.color, STEPS.into_iter().filter_map(at)));
    }
    panel
}

/// The asymmetry of the flow at the rudder, found against true.
fn sides(scores: &[Score]) -> Panel {
    let ends = [-0.18, 0.06];
    let mut panel = Panel::new(
        "single screw: asymmetry at the rudder",
        Axis::new("true [-]").range(ends[0], ends[1]),
        Axis::new("found [-]"),
    )
    .with(Layer::line("found is true", LIMIT, ends.map(|v| (v, v))));
    for (name, color, family) in SHOWN.into_iter().filter(|shown| LOPSIDED.contains(&shown.2)) {
        let points = lopsided(scores, family).filter_map(|s| Some((s.asymmetry?, s.asymmetry_found?)));
        panel = panel.with(Layer::scatter(name, color, points));
    }
    panel
}

/// The whole figure; without an oracle it has no panel of errors.
pub fn figure(scores: &[Score]) -> Figure {
    let set = Panel::new("truth in the confidence set", strength(), share_axis()).with_all(curve(
        "both families",
        GREEN,
        scores,
        None,
        |s| s.in_set,
    ));
    let figure = Figure::new("Concealed effects: results of the campaign")
        .columns(3)
        .with(by_strength(scores, "missing physics: detected", |s| s.detected))
        .with(by_strength(scores, "first name right, given detection", |s| s.first_right))
        .with(set)
        .with(alarms(scores))
        .with(hulls(scores))
        .with(wrong_names(scores))
        .with(methods(scores));
    let figure = if scores.iter().any(|s| s.oracle_held_out.is_some()) { figure.with(errors(scores)) } else { figure };
    figure.with(sides(scores))
}
