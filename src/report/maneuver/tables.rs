//! Tables and notes of trials: measures in ship lengths beside the criteria, how a trial ended, and its track as CSV.
//! Nothing is computed here beyond units.

use crate::maneuver::imo::{Criterion, SHORTEST};
use crate::maneuver::{Ended, Stopping, Track, Trial, Turning, Zigzag};
use crate::numerals::fixed;
use crate::report::table::Table;
use crate::ship::Ship;

/// Tables of measures are this wide in a terminal.
const WIDTH: u16 = 110;

fn optional(x: Option<f64>, scale: f64, decimals: usize) -> String {
    x.map_or_else(|| "not reached".into(), |x| fixed(x * scale, decimals))
}

/// Turning circles, a row a trial.
pub fn turning_table(ship: &Ship, trials: &[Trial<Turning>]) -> Table {
    let l = 1.0 / ship.hull.lpp;
    let mut table = Table::new([
        "trial",
        "advance [L]",
        "transfer [L]",
        "tactical diameter [L]",
        "steady diameter [L]",
        "speed loss [%]",
        "drift [deg]",
        "time to 90 [s]",
        "time to 180 [s]",
    ]);
    for t in trials {
        let m = &t.measures;
        table.row([
            t.name.clone(),
            optional(m.advance, l, 2),
            optional(m.transfer, l, 2),
            optional(m.tactical_diameter, l, 2),
            optional(m.steady.map(|s| s.diameter), l, 2),
            optional(m.steady.map(|s| s.speed_loss), 100.0, 0),
            optional(m.steady.map(|s| s.drift.to_degrees()), 1.0, 1),
            optional(m.time_90, 1.0, 1),
            optional(m.time_180, 1.0, 1),
        ]);
    }
    table.wrapped(WIDTH)
}

/// Zigzags, a row a trial.
pub fn zigzag_table(ship: &Ship, trials: &[Trial<Zigzag>]) -> Table {
    let mut table = Table::new([
        "trial",
        "overshoot 1 [deg]",
        "overshoot 2 [deg]",
        "overshoot 3 [deg]",
        "initial turning [L]",
        "reach [s]",
        "period [s]",
    ]);
    for t in trials {
        let m = &t.measures;
        let overshoot = |i: usize| optional(m.overshoots.get(i).map(|o| o.to_degrees()), 1.0, 1);
        table.row([
            t.name.clone(),
            overshoot(0),
            overshoot(1),
            overshoot(2),
            optional(m.initial_turning, 1.0 / ship.hull.lpp, 2),
            optional(m.reach, 1.0, 1),
            optional(m.period, 1.0, 1),
        ]);
    }
    table.wrapped(WIDTH)
}

/// A crash stop as a table of one row.
pub fn stopping_table(ship: &Ship, trial: &Trial<Stopping>) -> Table {
    let (m, l) = (&trial.measures, 1.0 / ship.hull.lpp);
    let mut table = Table::new([
        "trial",
        "track reach [L]",
        "head reach [L]",
        "lateral deviation [L]",
        "heading change [deg]",
        "time [s]",
    ]);
    table.row([
        trial.name.clone(),
        optional(m.track_reach, l, 2),
        optional(m.head_reach, l, 2),
        optional(m.lateral_deviation, l, 2),
        optional(m.heading_change.map(f64::to_degrees), 1.0, 1),
        optional(m.time, 1.0, 1),
    ]);
    table.wrapped(WIDTH)
}

/// The IMO criteria beside the measures, a row a criterion.
pub fn criteria_table<'a>(trials: impl IntoIterator<Item = (&'a str, &'a [Criterion])>) -> Table {
    let mut table = Table::new(["trial", "IMO MSC.137(76)", "measured", "limit", "unit", "verdict"]);
    for (name, criteria) in trials {
        for c in criteria {
            let number = |x: Option<f64>| x.map_or_else(|| crate::numerals::DASH.into(), |x| fixed(x, 2));
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
            crate::numerals::sig(ship.hull.lpp, 3)
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
