//! Trials in words and numbers: measures in ship lengths, criteria, notes, and the track as CSV.
//! It converts units and computes nothing else.

use crate::evaluate::maneuver::imo::{Criterion, SHORTEST};
use crate::evaluate::maneuver::{Ended, Measured, PullOut, Spiral, Stopping, Track, Trial, Turning, Zigzag};
use crate::numerals::{DASH, fixed, sig};
use crate::report::table::Table;
use crate::ship::Ship;

/// The unit in which a measure is printed.
#[derive(Clone, Copy)]
pub enum PrintedUnit {
    /// Ship lengths.
    Lengths,
    /// Per cent.
    Percent,
    /// Degrees.
    Degrees,
    /// Seconds.
    Seconds,
    /// Per second.
    PerSecond,
    /// Degrees per second.
    DegreesPerSecond,
}

impl PrintedUnit {
    /// The SI unit that it is converted from.
    pub fn si(self) -> &'static str {
        match self {
            Self::Lengths => "m",
            Self::Percent => "-",
            Self::Degrees => "rad",
            Self::Seconds => "s",
            Self::PerSecond => "1/s",
            Self::DegreesPerSecond => "rad/s",
        }
    }

    /// Unit, factor from SI for a ship of that length \[m\], and decimals.
    pub(super) fn scale(self, length: f64) -> (&'static str, f64, usize) {
        match self {
            Self::Lengths => ("L", 1.0 / length, 2),
            Self::Percent => ("%", 100.0, 0),
            Self::Degrees => ("deg", 1f64.to_degrees(), 1),
            Self::Seconds => ("s", 1.0, 1),
            Self::PerSecond => ("1/s", 1.0, 4),
            Self::DegreesPerSecond => ("deg/s", 1f64.to_degrees(), 3),
        }
    }
}

/// Trials whose measures make a table.
pub trait Listed: Measured {
    /// Name of each measure, in words, and its printed unit, in the order of [`Measured::QUANTITIES`].
    const ROWS: &'static [(&'static str, &'static str, PrintedUnit)];
}

impl Listed for Turning {
    const ROWS: &'static [(&'static str, &'static str, PrintedUnit)] = &[
        ("advance", "advance", PrintedUnit::Lengths),
        ("transfer", "transfer", PrintedUnit::Lengths),
        ("tactical_diameter", "tactical diameter", PrintedUnit::Lengths),
        ("steady_diameter", "steady diameter", PrintedUnit::Lengths),
        ("speed_loss", "speed loss", PrintedUnit::Percent),
        ("drift", "drift", PrintedUnit::Degrees),
        ("time_90", "time to 90 deg", PrintedUnit::Seconds),
        ("time_180", "time to 180 deg", PrintedUnit::Seconds),
        ("nomoto_gain", "Nomoto K", PrintedUnit::PerSecond),
        ("nomoto_time", "Nomoto T", PrintedUnit::Seconds),
    ];
}

impl Listed for Zigzag {
    const ROWS: &'static [(&'static str, &'static str, PrintedUnit)] = &[
        ("overshoot_1", "overshoot 1", PrintedUnit::Degrees),
        ("overshoot_2", "overshoot 2", PrintedUnit::Degrees),
        ("overshoot_3", "overshoot 3", PrintedUnit::Degrees),
        ("initial_turning", "initial turning", PrintedUnit::Lengths),
        ("execute_2", "second execute", PrintedUnit::Seconds),
        ("execute_3", "third execute", PrintedUnit::Seconds),
        ("reach", "reach", PrintedUnit::Seconds),
        ("period", "period", PrintedUnit::Seconds),
        ("nomoto_gain", "Nomoto K", PrintedUnit::PerSecond),
        ("nomoto_time", "Nomoto T", PrintedUnit::Seconds),
    ];
}

impl Listed for PullOut {
    const ROWS: &'static [(&'static str, &'static str, PrintedUnit)] = &[
        ("turning_rate", "yaw rate of the turn", PrintedUnit::DegreesPerSecond),
        ("residual_rate", "yaw rate left", PrintedUnit::DegreesPerSecond),
        ("decay_time", "time to 1/e", PrintedUnit::Seconds),
    ];
}

impl Listed for Spiral {
    const ROWS: &'static [(&'static str, &'static str, PrintedUnit)] = &[
        ("loop_width", "width of the loop", PrintedUnit::Degrees),
        ("loop_height", "height of the loop", PrintedUnit::DegreesPerSecond),
        ("neutral", "rudder in its middle", PrintedUnit::Degrees),
    ];
}

impl Listed for Stopping {
    const ROWS: &'static [(&'static str, &'static str, PrintedUnit)] = &[
        ("track_reach", "track reach", PrintedUnit::Lengths),
        ("head_reach", "head reach", PrintedUnit::Lengths),
        ("lateral_deviation", "lateral deviation", PrintedUnit::Lengths),
        ("heading_change", "heading change", PrintedUnit::Degrees),
        ("time", "time", PrintedUnit::Seconds),
    ];
}

/// The measures, a row a measure and a column a trial, each with its 95 % interval where it has one: `2.97 [2.85, 3.09]`.
pub fn measures_table<M: Listed>(ship: &Ship, trials: &[Trial<M>]) -> Table {
    let mut table = Table::new(["measure".to_owned()].into_iter().chain(trials.iter().map(|t| t.name.clone())));
    for (key, words, printed) in M::ROWS {
        let (unit, factor, decimals) = printed.scale(ship.hull.lpp);
        let value = |x: f64| fixed(x * factor, decimals);
        let cell = |t: &Trial<M>| match (t.measures.quantity(key), t.intervals.get(key)) {
            (None, _) => "not reached".to_owned(),
            (Some(x), None) => value(x),
            (Some(x), Some([low, high])) => format!("{} [{}, {}]", value(x), value(*low), value(*high)),
        };
        table.row([format!("{words} [{unit}]")].into_iter().chain(trials.iter().map(cell)));
    }
    table
}

/// The measures as a tidy table, a row a trial and a measure, in SI units and radians; a cell without a value is empty.
pub fn measures_csv<M: Listed>(trials: &[Trial<M>]) -> Table {
    let mut table = Table::new(["trial", "side", "measure", "unit", "value", "low95", "high95"]);
    let number = |x: Option<f64>| x.filter(|x| x.is_finite()).map_or(String::new(), |x| x.to_string());
    for t in trials {
        for (key, _, printed) in M::ROWS {
            let unit = printed.si();
            let [low, high] = t.intervals.get(key).map_or([None, None], |ends| ends.map(Some));
            let value = number(t.measures.quantity(key));
            let cells = [&t.name, t.side.word(), key, unit, &value, &number(low), &number(high)];
            table.row(cells);
        }
    }
    table
}

/// The IMO criteria beside the measures, a row a criterion.
pub fn criteria_table<'a>(trials: impl IntoIterator<Item = (&'a str, &'a [Criterion])>) -> Table {
    let mut table = Table::new(["trial", "IMO MSC.137(76)", "measured", "limit", "unit", "verdict"]);
    for (name, criteria) in trials {
        for c in criteria {
            let number = |x: Option<f64>| x.map_or(DASH.into(), |x| fixed(x, 2));
            let interval =
                c.interval.map_or(String::new(), |[low, high]| format!(" [{}, {}]", fixed(low, 2), fixed(high, 2)));
            table.row([
                name.to_owned(),
                c.name.clone(),
                number(c.measured) + &interval,
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
            Some(format!("{}: not complete after {after:.0} s, the longest that this trial is sailed.", trial.name))
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
