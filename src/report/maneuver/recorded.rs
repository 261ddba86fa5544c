//! Measures of recorded trials in words and numbers: over ground, through the water, and with the model.
//! It converts units and computes nothing else.

use super::tables::{Listed, PrintedUnit, criteria_table};
use crate::evaluate::maneuver::{Measured, MeasuredTrial, Measures, Turning, Zigzag};
use crate::numerals::{DASH, fixed, sig};
use crate::report::table::Table;
use crate::ship::Ship;

/// A measure of one trial: its key, words, printed unit, and its values over ground, through the water and with the model.
type Row = (&'static str, &'static str, PrintedUnit, [Option<f64>; 3]);

fn rows(trial: &MeasuredTrial) -> Vec<Row> {
    let all = [
        Some(&trial.recorded.measures),
        trial.through_water.as_ref().map(|t| &t.measures),
        trial.simulated.as_ref().map(|s| &s.taken.measures),
    ];
    let listed = match trial.recorded.measures {
        Measures::Turning(_) => Turning::ROWS,
        Measures::Zigzag(_) => Zigzag::ROWS,
    };
    listed.iter().map(|(key, words, printed)| (*key, *words, *printed, all.map(|m| value(m?, key)))).collect()
}

fn value(measures: &Measures, key: &str) -> Option<f64> {
    match measures {
        Measures::Turning(m) => m.quantity(key),
        Measures::Zigzag(m) => m.quantity(key),
    }
}

/// The measures of one trial, a row a measure: over ground, through the water where a current is known, and with the model.
pub fn recorded_table(ship: &Ship, trial: &MeasuredTrial) -> Table {
    let water = trial.through_water.is_some();
    let columns = |cells: [String; 4]| {
        let [name, ground, through, model] = cells;
        [Some(name), Some(ground), water.then_some(through), Some(model)].into_iter().flatten()
    };
    let mut table = Table::new(columns(["measure", "over ground", "through water", "model"].map(str::to_owned)));
    for (_, words, printed, values) in rows(trial) {
        let (unit, factor, decimals) = printed.scale(ship.hull.lpp);
        let [ground, through, model] = values.map(|x| x.map_or(DASH.to_owned(), |x| fixed(x * factor, decimals)));
        table.row(columns([format!("{words} [{unit}]"), ground, through, model]));
    }
    table
}

/// Change of speed over an approach from which on it is said not to be steady: the measures of a turn go by the speed at its start.
const UNSTEADY: f64 = 0.1;

/// A heading of one trial: recording, trial, when, from which speed and with which rudder rate.
pub fn recorded_heading(trial: &MeasuredTrial) -> String {
    let speed = |m: &Measures| match m {
        Measures::Turning(m) => m.approach_speed,
        Measures::Zigzag(m) => m.approach_speed,
    };
    let mut text = format!(
        "{}: {}, at {} s from {} m/s over ground, {}",
        trial.run,
        trial.name,
        sig(trial.at, 4),
        sig(speed(&trial.recorded.measures), 3),
        trial.rudder_rate.map_or_else(
            || "rudder over within one sample, as an order is".to_owned(),
            |rate| format!("rudder rate {} deg/s", sig(rate.to_degrees(), 3))
        ),
    );
    if trial.approach_change.abs() > UNSTEADY {
        text += &format!(
            "; speed changed by {:+.0} % over the approach, which was not steady",
            100.0 * trial.approach_change
        );
    }
    if let (Some([north, east]), Some(water)) = (trial.current, &trial.through_water) {
        let to = east.atan2(north).to_degrees().rem_euclid(360.0);
        text += &format!(
            "; current {} m/s to {to:.0} deg, {} m/s through the water",
            sig(north.hypot(east), 2),
            sig(speed(&water.measures), 3)
        );
    }
    if let Some(why) = &trial.not_simulated {
        text += &format!("; not sailed with the model: {why}");
    }
    text
}

/// All measures as a tidy table in SI units and radians, a row a trial and a measure; a cell without a value is empty.
pub fn recorded_csv(trials: &[MeasuredTrial]) -> Table {
    let header = ["run", "trial", "side", "at", "measure", "unit", "over_ground", "through_water", "model"];
    let mut table = Table::new(header);
    let number = |x: Option<f64>| x.filter(|x| x.is_finite()).map_or(String::new(), |x| x.to_string());
    for t in trials {
        for (key, _, printed, values) in rows(t) {
            let [ground, through, model] = values.map(number);
            let (at, side) = (t.at.to_string(), t.side.word());
            table.row([&t.run, &t.name, side, &at, key, printed.si(), &ground, &through, &model]);
        }
    }
    table
}

/// The IMO criteria beside what was measured on each trial, through the water where a current is known.
pub fn recorded_criteria(trials: &[MeasuredTrial]) -> Table {
    let names: Vec<String> = trials.iter().map(|t| format!("{}: {}", t.run, t.name)).collect();
    let taken = |t: &'_ MeasuredTrial| t.through_water.clone().unwrap_or_else(|| t.recorded.clone()).criteria;
    let all: Vec<_> = trials.iter().map(taken).collect();
    criteria_table(names.iter().map(String::as_str).zip(all.iter().map(Vec::as_slice)))
}
