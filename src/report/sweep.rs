//! A sweep for people: profiles and sensitivities as tables, and their figures.
//! The fits behind them are [`crate::evaluate::sweep`]'s.

use crate::evaluate::sweep::{Pair, Profile, Sensitivity};
use crate::numerals::{DASH, interval, sig};
use crate::report::table::Table;

#[cfg(feature = "plot")]
use crate::report::plot::{Axis, FITTED, Figure, GREY, Layer, Mark, Panel, RECORDED};

/// What a profile says of a parameter, in a word or two.
fn shape(p: &Profile) -> &'static str {
    match (p.better_elsewhere, p.interval) {
        (true, _) => "better elsewhere: fit again from there",
        (_, [Some(_), Some(_)]) => "determined",
        (_, [None, Some(_)]) => "open below",
        (_, [Some(_), None]) => "open above",
        (_, [None, None]) => "open on both sides",
    }
}

/// A row a parameter: estimate, standard error, the interval of the profile and what it says.
pub fn profiles_table(profiles: &[Profile]) -> Table {
    let mut table =
        Table::new(["parameter", "unit", "estimate", "std. error", "95 % of the profile", "these data leave it"]);
    for p in profiles {
        let range = match p.interval {
            [Some(low), Some(high)] => interval(low, high, 3),
            [Some(low), None] => format!("above {}", sig(low, 3)),
            [None, Some(high)] => format!("below {}", sig(high, 3)),
            [None, None] => DASH.to_owned(),
        };
        table.row([
            p.parameter.clone(),
            p.unit.to_owned(),
            sig(p.estimate, 4),
            sig(p.standard_error, 3),
            range,
            shape(p).to_owned(),
        ]);
    }
    table
}

/// A row a parameter: what one standard error of it moves.
pub fn sensitivities_table(all: &[Sensitivity]) -> Table {
    let mut names: Vec<&'static str> = Vec::new();
    for (name, _) in all.iter().flat_map(|s| &s.trials) {
        if !names.contains(name) {
            names.push(name);
        }
    }
    // People read angles in degrees; the library has them in radians.
    let degrees = |name: &str| name.replace("[rad]", "[deg]");
    let header = ["parameter", "std. error", "position [m]", "heading [deg]"].map(str::to_owned);
    let mut table = Table::new(header.into_iter().chain(names.iter().map(|name| degrees(name))));
    let number = |x: Option<f64>| x.map_or_else(|| DASH.to_owned(), |x| sig(x, 3));
    for s in all {
        let shown = |name: &str, v: f64| if name.ends_with("[rad]") { v.to_degrees() } else { v };
        let trial = |name: &&str| s.trials.iter().find(|(n, _)| n == name).map(|(n, v)| shown(n, *v));
        let heading = s.heading.map(f64::to_degrees);
        let own = [s.parameter.clone(), sig(s.standard_error, 3), number(s.position), number(heading)];
        table.row(own.into_iter().chain(names.iter().map(|name| number(trial(name)))));
    }
    table
}

/// Every value of every profile, a row each.
pub fn points_table(profiles: &[Profile]) -> Table {
    let mut table = Table::new(["parameter", "value", "fall"]);
    for p in profiles {
        for point in &p.points {
            let fall = point.fall.map_or(String::new(), |f| f.to_string());
            table.row([p.parameter.clone(), point.value.to_string(), fall]);
        }
    }
    table
}

/// Every value of every pair, a row each.
pub fn pairs_table(pairs: &[Pair]) -> Table {
    let mut table = Table::new(["first", "second", "value_first", "value_second", "fall"]);
    for pair in pairs {
        for (a, row) in pair.values[0].iter().zip(&pair.fall) {
            for (b, fall) in pair.values[1].iter().zip(row) {
                let [first, second] = pair.parameters.clone();
                table.row([first, second, a.to_string(), b.to_string(), fall.map_or(String::new(), |f| f.to_string())]);
            }
        }
    }
    table
}

/// The profiles, a panel each, with the fall at which their 95 % intervals end.
#[cfg(feature = "plot")]
pub fn profiles_figure(profiles: &[Profile], limit: f64) -> Figure {
    let panel = |p: &Profile| {
        let points: Vec<(f64, f64)> = p.points.iter().filter_map(|q| Some((q.value, q.fall?))).collect();
        let quadratic = |v: f64| ((v - p.estimate) / p.standard_error).powi(2);
        let (low, high) =
            (p.points.first().map_or(p.estimate, |q| q.value), p.points.last().map_or(p.estimate, |q| q.value));
        let normal = (0..=40).map(|i| low + (high - low) * f64::from(i) / 40.0).map(|v| (v, quadratic(v)));
        // A value that a constraint refuses costs any amount: the panel shows the fall as far as the standard error predicts it.
        let least = points.iter().map(|(_, fall)| *fall).fold(0.0_f64, f64::min);
        let top = quadratic(low).max(quadratic(high)).max(1.3 * limit);
        let label = if p.unit == "-" { p.parameter.clone() } else { format!("{} [{}]", p.parameter, p.unit) };
        Panel::new("", Axis::new(label), Axis::new("2 x fall of log-likelihood").range(least - 0.05 * top, 1.1 * top))
            .with(Layer::line("profile", FITTED, points.clone()))
            .with(Layer::scatter("fits", FITTED, points).unlisted())
            .with(Layer::line("standard error", RECORDED, normal).dashed())
            .with(Layer::h_line("95 %", GREY, limit))
    };
    Figure::new("Profiles of the likelihood")
        .columns(3)
        .panel_size(660, 520)
        .caption(
            "Twice the fall of the log-likelihood with a parameter fixed at a value and all others fitted again; dashed: what its standard \
             error alone says. The 95 % interval lies below the horizontal line. A profile that leaves its panel, or has no point, is at \
             values that constraints or the other parameters refuse.",
        )
        .with_all(profiles.iter().map(panel))
}

/// The pairs, a panel each.
#[cfg(feature = "plot")]
pub fn pairs_figure(pairs: &[Pair]) -> Figure {
    let panel = |pair: &Pair| {
        let labels = |i: usize| pair.values[i].iter().map(|v| sig(*v, 3)).collect::<Vec<String>>();
        let axis = |i: usize| Axis::categories(pair.parameters[i].clone(), labels(i));
        let values = pair.fall.iter().map(|row| row.iter().map(|f| f.unwrap_or(f64::NAN)).collect()).collect();
        let map = Mark::Heatmap { values, range: Some((0.0, 12.0)), annotate: true };
        Panel::new("", axis(1), axis(0)).with(Layer::new("2 x fall of log-likelihood", FITTED, map))
    };
    Figure::new("Profiles of the likelihood by pair")
        .columns(2)
        .panel_size(960, 820)
        .caption(
            "Twice the fall of the log-likelihood with two parameters fixed and all others fitted again; 95 % of both lie where it is below \
             about 6.",
        )
        .with_all(pairs.iter().map(panel))
}
