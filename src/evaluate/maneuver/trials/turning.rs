//! The turning circle: its simulation, and advance, transfer, tactical diameter and steady turn read from any track.
//! The IMO criteria are in `imo`, not here.

use crate::evaluate::maneuver::approach::Approach;
use crate::evaluate::maneuver::imo;
use crate::evaluate::maneuver::measures::{Steady, Turning};
use crate::evaluate::maneuver::nomoto::nomoto_of_step;
use crate::evaluate::maneuver::sail::{Orders, sail};
use crate::evaluate::maneuver::track::Track;
use crate::evaluate::maneuver::trial::{Intervals, Side, Trial};
use crate::model::Model;
use std::f64::consts::PI;

/// Measures a turning circle on a track whose rudder began to move at sample `execute`.
pub fn turning(track: &Track, execute: usize) -> Turning {
    let Some(start) = track.states.get(execute) else {
        return Turning::default();
    };
    let rudder = held(&track.delta[execute..]);
    let side = Side::of(rudder).sign();
    let course = start[2];
    let turned = |s: &[f64; 6]| side * (s[2] - course);
    let passage = |angle: f64| {
        let instant = track.first_above(execute, angle, turned)?;
        let s = track.state(instant);
        let [ahead, abeam] = track.ahead_abeam(execute, course, [s[0], s[1]]);
        Some((ahead, side * abeam, track.time(instant) - track.t[execute]))
    };
    let (quarter, half) = (passage(0.5 * PI), passage(PI));
    let approach_speed = track.speed(execute);

    // The last sample with the rudder still held, and the part of the turn 90 deg of heading before it.
    let last = (execute..track.len()).rev().find(|&k| (track.delta[k] - rudder).abs() < 0.05 * rudder.abs());
    let steady = last.filter(|&k| turned(&track.states[k]) >= 1.5 * PI).map(|end| {
        let from = turned(&track.states[end]) - 0.5 * PI;
        let part: Vec<usize> = (execute..=end).filter(|&k| turned(&track.states[k]) >= from).collect();
        let mean = |f: &dyn Fn(usize) -> f64| part.iter().map(|&k| f(k)).sum::<f64>() / part.len() as f64;
        let (speed, yaw_rate) = (mean(&|k| track.speed(k)), mean(&|k| track.states[k][5]));
        Steady {
            diameter: 2.0 * speed / yaw_rate.abs(),
            speed,
            speed_loss: 1.0 - speed / approach_speed,
            drift: (-mean(&|k| track.states[k][4])).atan2(mean(&|k| track.states[k][3])),
            yaw_rate,
        }
    });
    Turning {
        rudder,
        approach_speed,
        advance: quarter.map(|q| q.0),
        transfer: quarter.map(|q| q.1),
        tactical_diameter: half.map(|h| h.1),
        time_90: quarter.map(|q| q.2),
        time_180: half.map(|h| h.2),
        steady: steady.filter(|s| s.diameter.is_finite()),
        nomoto: track.first_above(execute, 0.5 * PI, turned).and_then(|end| nomoto_of_step(track, execute, end.sample)),
    }
}

/// The rudder angle held for longest: the median of the angles beyond half the largest.
fn held(delta: &[f64]) -> f64 {
    let largest = delta.iter().copied().max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0);
    let mut beyond: Vec<f64> = delta.iter().copied().filter(|d| d * largest.signum() > 0.5 * largest.abs()).collect();
    beyond.sort_by(f64::total_cmp);
    beyond.get(beyond.len() / 2).copied().unwrap_or(0.0)
}

/// The sample at which the rudder begins to move to the side of a recorded turning circle: the last one, before half the
/// angle held is reached, at which it was still within a twentieth of that angle of where it was at first.
///
/// `None` when the rudder was hard over from the first sample or never moved.
pub fn turning_execute(track: &Track) -> Option<usize> {
    let angle = held(&track.delta);
    let side = angle.signum();
    let over = track.delta.iter().position(|d| side * d > 0.5 * angle.abs())?;
    let approach = *track.delta.first()?;
    (0..over).rev().find(|&k| side * (track.delta[k] - approach) <= 0.05 * angle.abs())
}

/// Simulates a turning circle through 720 deg with the rudder at `angle` \[rad\] to one side.
pub fn turning_trial(model: &Model, theta: &[f64], approach: &Approach, side: Side, angle: f64) -> Trial<Turning> {
    let orders = Orders::at_once(side.sign() * angle, approach.n);
    let (track, ended) = sail(model, theta, approach, |track| {
        let turned = track.states.last().map_or(0.0, |s| side.sign() * s[2]);
        (turned < 4.0 * PI).then_some(orders)
    });
    let mut measures = turning(&track, 0);
    measures.rudder = orders.delta;
    Trial {
        name: format!("turning {:.0} deg {}", angle.to_degrees(), side.word()),
        side,
        approach: *approach,
        ended,
        measures,
        criteria: imo::turning(&model.ship, &measures),
        intervals: Intervals::new(),
        track,
    }
}
