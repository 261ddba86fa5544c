//! Trials in words and numbers: measures in ship lengths, criteria, notes, and the track as CSV.
//! It converts units and computes nothing else.

use crate::maneuver::imo::{Criterion, SHORTEST};
use crate::maneuver::{Ended, Stopping, Track, Trial, Turning, Zigzag};
use crate::numerals::{DASH, fixed, sig};
use crate::report::table::Table;
use crate::ship::Ship;

/// Tables of measures are this wide in a terminal.
const WIDTH: u16 = 110;

fn optional(x: Option<f64>, scale: f64, decimals: usize) -> String {
    x.map_or_else(|| "not reached".into(), |x| fixed(x * scale, decimals))
}

/// A column of a table of measures: its heading, and its cell from the measures and the reciprocal ship length \[1/m\].
type Column<M> = (&'static str, fn(&M, f64) -> String);

/// Measures of trials, a row a trial.
fn measures<M>(ship: &Ship, trials: &[Trial<M>], columns: &[Column<M>]) -> Table {
    let per_length = 1.0 / ship.hull.lpp;
    let mut table = Table::new(["trial"].into_iter().chain(columns.iter().map(|c| c.0)));
    for t in trials {
        let cells = columns.iter().map(|(_, cell)| cell(&t.measures, per_length));
        table.row([t.name.clone()].into_iter().chain(cells));
    }
    table.wrapped(WIDTH)
}

/// Turning circles, a row a trial.
pub fn turning_table(ship: &Ship, trials: &[Trial<Turning>]) -> Table {
    let columns: [Column<Turning>; 8] = [
        ("advance [L]", |m, l| optional(m.advance, l, 2)),
        ("transfer [L]", |m, l| optional(m.transfer, l, 2)),
        ("tactical diameter [L]", |m, l| optional(m.tactical_diameter, l, 2)),
        ("steady diameter [L]", |m, l| optional(m.steady.map(|s| s.diameter), l, 2)),
        ("speed loss [%]", |m, _| optional(m.steady.map(|s| s.speed_loss), 100.0, 0)),
        ("drift [deg]", |m, _| optional(m.steady.map(|s| s.drift.to_degrees()), 1.0, 1)),
        ("time to 90 [s]", |m, _| optional(m.time_90, 1.0, 1)),
        ("time to 180 [s]", |m, _| optional(m.time_180, 1.0, 1)),
    ];
    measures(ship, trials, &columns)
}

/// The `i`-th overshoot of a zigzag \[deg\].
fn overshoot(m: &Zigzag, i: usize) -> String {
    optional(m.overshoots.get(i).map(|o| o.to_degrees()), 1.0, 1)
}

/// Zigzags, a row a trial.
pub fn zigzag_table(ship: &Ship, trials: &[Trial<Zigzag>]) -> Table {
    let columns: [Column<Zigzag>; 6] = [
        ("overshoot 1 [deg]", |m, _| overshoot(m, 0)),
        ("overshoot 2 [deg]", |m, _| overshoot(m, 1)),
        ("overshoot 3 [deg]", |m, _| overshoot(m, 2)),
        ("initial turning [L]", |m, l| optional(m.initial_turning, l, 2)),
        ("reach [s]", |m, _| optional(m.reach, 1.0, 1)),
        ("period [s]", |m, _| optional(m.period, 1.0, 1)),
    ];
    measures(ship, trials, &columns)
}

/// A crash stop as a table of one row.
pub fn stopping_table(ship: &Ship, trial: &Trial<Stopping>) -> Table {
    let columns: [Column<Stopping>; 5] = [
        ("track reach [L]", |m, l| optional(m.track_reach, l, 2)),
        ("head reach [L]", |m, l| optional(m.head_reach, l, 2)),
        ("lateral deviation [L]", |m, l| optional(m.lateral_deviation, l, 2)),
        ("heading change [deg]", |m, _| optional(m.heading_change.map(f64::to_degrees), 1.0, 1)),
        ("time [s]", |m, _| optional(m.time, 1.0, 1)),
    ];
    measures(ship, std::slice::from_ref(trial), &columns)
}

/// The IMO criteria beside the measures, a row a criterion.
pub fn criteria_table<'a>(trials: impl IntoIterator<Item = (&'a str, &'a [Criterion])>) -> Table {
    let mut table = Table::new(["trial", "IMO MSC.137(76)", "measured", "limit", "unit", "verdict"]);
    for (name, criteria) in trials {
        for c in criteria {
            let number = |x: Option<f64>| x.map_or(DASH.into(), |x| fixed(x, 2));
            table.row([
                name.to_owned(),
                c.name.clone(),
                number(c.measured),
                number(c.limit),
                c.unit.to_owned(),
                c.verdict.word().to_owned(),
            ]);
        }
    }
    table
}

/// A note on the criteria for a ship that the standard does not bind.
pub fn criteria_note(ship: &Ship) -> Option<String> {
    (ship.hull.lpp < SHORTEST).then(|| {
        format!(
            "The standard binds ships of {SHORTEST:.0} m and more; for L = {} m its limits are shown for comparison.",
            sig(ship.hull.lpp, 3)
        )
    })
}

/// How a trial ended, if it is not complete.
pub fn ended_note<M>(trial: &Trial<M>) -> Option<String> {
    match trial.ended {
        Ended::Complete => None,
        Ended::TimeOut { after } => {
            Some(format!("{}: not complete after {after:.0} s (200 ship lengths at approach speed).", trial.name))
        }
        Ended::Diverged { after } => Some(format!(
            "{}: the simulation diverged after {after:.1} s; the model is not usable there (set `step` in [maneuver] to rule out the integration).",
            trial.name
        )),
    }
}

/// The sailed track as CSV, SI units and radians, in the layout of a recording.
pub fn track_csv(track: &Track) -> String {
    let mut text = String::from("t [s],x [m],y [m],psi [rad],u [m/s],v [m/s],r [rad/s],n [rps],delta [rad]\n");
    for k in 0..track.len() {
        let [x, y, psi, u, v, r] = track.states[k];
        text.push_str(&format!("{},{x},{y},{psi},{u},{v},{r},{},{}\n", track.t[k], track.n[k], track.delta[k]));
    }
    text
}
