//! At what speed and rudder rate the recordings of a study were sailed, for trials that are to be sailed as they were.
//! It reads these two numbers alone; whether a recording is sound is checked by the audit.

use super::approach::{ManeuverSettings, Recorded};
use crate::recording::{Channel, Driven, Recording};
use crate::ship::Ship;
use crate::state::Inputs;
use crate::statistics::{median, quantile};
use crate::study::{Listed, Study};
use rayon::prelude::*;
use std::borrow::Cow;

/// The share of its rows at which a run is slower than its approach: trials lose speed, and noise adds some.
const APPROACH: f64 = 0.9;
/// Smallest change of rudder angle \[rad\], 10 deg, that is a move from one order to another and not one of a helmsman who holds a course.
const MOVE: f64 = 10.0 * std::f64::consts::PI / 180.0;
/// The share of the moves that are slower than the gear turns: it cannot turn faster, but a rudder may follow a slow order.
const GEAR: f64 = 0.75;

impl ManeuverSettings {
    /// With what the recordings of a study show of the approach; they are read where the settings leave a part of it to them.
    pub fn of_recordings(self, study: &Study, ship: &Ship) -> Self {
        let is_set = (self.speed.is_some() || self.n_rpm.is_some()) && self.rudder_rate_deg_s.is_some();
        if is_set { self } else { Self { recorded: recorded(study, ship), ..self } }
    }
}

/// Speed and rudder rate of the recordings of a study; those that cannot be read are left out.
fn recorded(study: &Study, ship: &Ship) -> Recorded {
    let read = |run: &Listed| Some(study.recording(run).ok()?.part(run.from, run.to));
    let seen: Vec<(Option<f64>, Vec<f64>)> =
        study.runs.par_iter().with_max_len(1).filter_map(read).map(|r| (fastest(&r), rates(&r, ship))).collect();
    let speeds = seen.iter().filter_map(|(speed, _)| *speed);
    let mut rates: Vec<f64> = seen.iter().flat_map(|(_, rates)| rates.iter().copied()).collect();
    rates.sort_by(f64::total_cmp);
    let positive = |x: &f64| *x > 0.0;
    Recorded {
        speed: median(speeds).filter(positive),
        rudder_rate: quantile(&rates, GEAR).filter(positive),
        recordings: seen.len(),
    }
}

/// The speed of a run before it loses some.
fn fastest(recording: &Recording) -> Option<f64> {
    let (u, v) = (recording.get(Channel::U)?, recording.get(Channel::V));
    let speed = |i: usize| u[i].hypot(v.map_or(0.0, |v| v[i]));
    let mut speeds: Vec<f64> = (0..u.len()).map(speed).filter(|s| s.is_finite()).collect();
    speeds.sort_by(f64::total_cmp);
    quantile(&speeds, APPROACH)
}

/// The rudder angle, or the angle of the named actuators that steer.
fn helm<'a>(recording: &'a Recording, ship: &Ship) -> Option<Cow<'a, [f64]>> {
    if ship.has_rudder() {
        return recording.get(Channel::Delta).map(Cow::Borrowed);
    }
    let commands: Vec<&[f64]> = Driven::of(ship).commands.iter().map(|c| recording.get(*c)).collect::<Option<_>>()?;
    let at = |row: usize| {
        let mut inputs = Inputs::actuators(0.0, 0.0, 0.0);
        inputs.commands.iter_mut().zip(&commands).for_each(|(command, values)| *command = values[row]);
        ship.helm_and_shaft(&inputs)[0]
    };
    ship.is_steered().then(|| (0..recording.time().len()).map(at).collect())
}

/// The rate of each move of the rudder from one order to another \[rad/s\]. The first and the last step of a move begin before it or
/// end after it; of a move without a step between them the rate is not known.
fn rates(recording: &Recording, ship: &Ship) -> Vec<f64> {
    helm(recording, ship).map_or(Vec::new(), |delta| moves(recording.time(), &delta))
}

/// See [`rates`].
fn moves(t: &[f64], delta: &[f64]) -> Vec<f64> {
    let mut rates = Vec::new();
    let mut from = 0;
    for i in 1..=t.len() {
        let on = i < t.len() && i > from && {
            let step = delta[i] - delta[i - 1];
            step != 0.0 && (i - 1 == from || step * (delta[i - 1] - delta[from]) > 0.0)
        };
        if on {
            continue;
        }
        let to = i - 1;
        if (delta[to] - delta[from]).abs() >= MOVE {
            let inside = (from + 2..to).map(|k| ((delta[k] - delta[k - 1]) / (t[k] - t[k - 1])).abs());
            rates.extend(full_rate(inside.collect()));
        }
        // The step that ended a move may begin the next one.
        from = if i < t.len() && to > from { to } else { i };
    }
    rates
}

/// The rate of a move from the rates of its steps: the middle one of those that are no noise of the rudder at rest before it.
fn full_rate(mut steps: Vec<f64>) -> Option<f64> {
    let largest = steps.iter().copied().fold(0.0, f64::max);
    steps.retain(|rate| *rate >= 0.5 * largest);
    median(steps)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rudder that is put over from side to side at a rate \[rad/s\] every 40 s.
    fn run(rate: f64, step: f64) -> Recording {
        let t: Vec<f64> = (0..(400.0 / step) as usize).map(|i| i as f64 * step).collect();
        let delta = t
            .iter()
            .map(|t| {
                let (turn, since) = ((t / 40.0).floor(), t % 40.0);
                let (from, to) = if turn % 2.0 == 0.0 { (-0.3, 0.3) } else { (0.3, -0.3) };
                from + (to - from) * (since * rate / 0.6).min(1.0)
            })
            .collect();
        let u = t.iter().map(|t| 5.0 + 2.0 * (-t / 50.0).exp()).collect();
        Recording::from_channels("run", vec![(Channel::T, t), (Channel::Delta, delta), (Channel::U, u)]).unwrap()
    }

    fn rates_of(run: &Recording) -> Vec<f64> {
        moves(run.time(), run.get(Channel::Delta).unwrap())
    }

    #[test]
    fn the_rate_of_the_gear_is_read_from_moves_between_orders() {
        for (rate, step) in [(0.04, 0.5), (0.04, 2.0), (0.1, 1.0)] {
            let found = rates_of(&run(rate, step));
            assert!(found.len() >= 8, "{found:?}");
            assert!(found.iter().all(|r| (r / rate - 1.0).abs() < 0.02), "{rate} every {step} s: {found:?}");
        }
        assert!(rates_of(&run(10.0, 2.0)).is_empty(), "a rudder that is over within one step shows no rate");
    }

    #[test]
    fn the_approach_of_a_run_is_its_speed_before_it_loses_some() {
        let speed = fastest(&run(0.04, 0.5)).unwrap();
        assert!((5.8..7.0).contains(&speed), "{speed}");
    }
}
