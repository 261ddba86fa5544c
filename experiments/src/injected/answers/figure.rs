//! The figure of the campaign on real recordings: names by strength, nulls, invariances, sizes and faults of sensors.
//! It only counts and draws.

use trimtab::numbers::statistics::Share;
use trimtab::report::plot::{Axis, BLUE, Color, Figure, GREEN, LIMIT, Layer, ORANGE, PURPLE, Panel};

use super::row::Row;
use super::score::Score;
use super::summary::{Scored, changes, scored, strong, unchanged};
use crate::injected::set::{SETS, Set};

/// Strengths of single effects.
const STEPS: [f64; 4] = [0.25, 0.5, 1.0, 2.0];

fn color(set: Set) -> Color {
    match set {
        Set::Marin => BLUE,
        Set::Hsva => ORANGE,
        Set::Esso => GREEN,
    }
}

fn words(set: Set) -> &'static str {
    match set {
        Set::Marin => "KVLCC2, MARIN",
        Set::Hsva => "KVLCC2, HSVA",
        Set::Esso => "Esso Osaka",
    }
}

fn strength() -> Axis {
    Axis::new("strength (1: a current of a tenth of the speed)").log().range(0.2, 2.5)
}

fn shares() -> Axis {
    Axis::new("share of cases").range(0.0, 1.0)
}

type Question = fn(&Score) -> Option<bool>;

fn share(all: &[Scored], takes: impl Fn(&Row) -> bool, of: Question) -> Option<Share> {
    Share::of(all.iter().filter(|(r, _)| takes(r)).map(|(_, s)| of(s)))
}

/// A share as a bar with its interval; nothing without a case.
fn bar(share: Option<Share>) -> (f64, f64, f64) {
    share.map_or((f64::NAN, f64::NAN, f64::NAN), |s| (s.value(), s.low, s.high))
}

fn by_strength(all: &[Scored], title: &str, aim: f64, of: Question) -> Panel {
    let mut panel = Panel::new(title, strength(), shares());
    for set in SETS {
        let at = |x: f64| {
            let s = share(all, |r| r.kind == "single" && r.set == set.name() && r.strength == Some(x), of)?;
            Some((x, s.value(), s.low, s.high))
        };
        let points = STEPS.into_iter().filter_map(at).collect();
        panel = panel.with_all(Layer::line_with_intervals(words(set), color(set), points));
    }
    panel.with(Layer::h_line("aim", LIMIT, aim))
}

fn nulls(all: &[Scored]) -> Panel {
    let turned = [("no", "as recorded"), ("together", "turned together"), ("each", "each turned")];
    let axis = Axis::categories("", turned.iter().map(|t| t.1));
    let mut panel = Panel::new("nothing injected: weather named in a basin", axis, shares());
    for set in SETS.into_iter().filter(|s| s.facts().calm) {
        let of = |t: &(&str, &str)| bar(share(all, |r| r.set == set.name() && r.turned == t.0, |s| s.weather));
        panel =
            panel.with(Layer::bars_with_intervals(words(set), color(set), turned.iter().map(of).collect::<Vec<_>>()));
    }
    panel.with(Layer::h_line("aim", LIMIT, 0.02))
}

fn invariances(all: &[Scored]) -> Panel {
    let changes = changes(all);
    let bars: Vec<_> = changes.iter().map(|c| bar(unchanged(all, c))).collect();
    let axis = Axis::categories("", changes.iter().map(|c| c.replace('_', " ")));
    Panel::new("same answer under a change that changes nothing", axis, shares())
        .with(Layer::bars_with_intervals("all sets", PURPLE, bars))
        .with(Layer::h_line("aim", LIMIT, 0.95))
}

fn sizes(all: &[Scored]) -> Panel {
    let axis = Axis::new("found with less found without, over injected").range(-1.0, 3.0);
    let mut panel = Panel::new("sizes as differences", strength(), axis);
    for (i, set) in SETS.into_iter().enumerate() {
        // Side by side, so that the sets do not hide each other.
        let beside = 1.0 + 0.06 * (i as f64 - 1.0);
        let point = |(r, s): &Scored| Some((beside * r.strength?, s.ratio?.clamp(-1.0, 3.0)));
        let here = all.iter().filter(|(r, _)| r.kind == "single" && r.set == set.name());
        panel = panel.with(Layer::scatter(words(set), color(set), here.filter_map(point)));
    }
    panel.with(Layer::h_line("injected", LIMIT, 1.0))
}

fn sensors(all: &[Scored]) -> Panel {
    let faulty = |r: &Row| r.sensor && (r.kind == "single" || r.kind == "logger") && strong(r);
    let mut effects: Vec<&str> = all.iter().filter(|(r, _)| faulty(r)).map(|(r, _)| r.injected.as_str()).collect();
    effects.sort_unstable();
    effects.dedup();
    let of = |effect: &&str| bar(share(all, |r| faulty(r) && r.injected == *effect, |s| s.miscalled));
    let axis = Axis::categories("", effects.iter().map(|e| e.replace('_', " ")));
    Panel::new("faults of sensors called ship or weather, strength 1 and 2", axis, shares())
        .with(Layer::bars_with_intervals("all sets", PURPLE, effects.iter().map(of).collect::<Vec<_>>()))
        .with(Layer::h_line("aim", LIMIT, 0.02))
}

/// The whole figure.
pub fn figure(rows: &[Row]) -> Figure {
    let all = scored(rows);
    Figure::new("Exact injections into recordings of real ships")
        .columns(2)
        .panel_size(1300, 700)
        .with(by_strength(&all, "named alone or in its class", 0.9, |s| s.right))
        .with(by_strength(&all, "wrong name in confidence", 0.02, |s| s.wrong))
        .with(sizes(&all))
        .with(nulls(&all))
        .with(invariances(&all))
        .with(sensors(&all))
}
