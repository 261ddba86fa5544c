//! The pull-out test: a steady turn, then the rudder amidships; the yaw rate that is left shows whether the ship is stable on its course.
//! There is no IMO criterion for it.

use crate::evaluate::maneuver::approach::Approach;
use crate::evaluate::maneuver::measures::PullOut;
use crate::evaluate::maneuver::sail::{Orders, sail_for};
use crate::evaluate::maneuver::track::Track;
use crate::evaluate::maneuver::trial::{Intervals, Side, Trial};
use crate::model::Model;
use std::f64::consts::TAU;

/// A yaw rate that moves by less than this share of U0/L over four ship lengths at approach speed is steady. A rate that falls by 1/e in a
/// hundred ship lengths is then a hundredth of that of a turn, below the limit for an unstable ship.
const STEADY: f64 = 1e-4;
/// Ship lengths at approach speed after which a pull-out ends, steady or not.
const LONGEST: f64 = 600.0;
/// Ship lengths at approach speed over which a rate must be steady.
const LENGTHS: f64 = 4.0;

/// Whether the yaw rate has been steady since a sample, and for four ship lengths at least. `length` is the ship's \[m\].
pub(super) fn steady(track: &Track, since: usize, length: f64, speed: f64) -> bool {
    let (Some(&now), Some(&start)) = (track.t.last(), track.t.get(since)) else { return false };
    let from = now - LENGTHS * length / speed;
    if start > from {
        return false;
    }
    let first = track.t.partition_point(|t| *t < from);
    let rates = track.states[first..].iter().map(|s| s[5]);
    let (low, high) = rates.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), r| (a.min(r), b.max(r)));
    high - low < STEADY * speed / length
}

/// Measures a pull-out on a track that begins with the approach and whose rudder was put amidships at sample `release`; the last sample
/// is taken as the end.
pub fn pull_out(track: &Track, release: usize) -> PullOut {
    let (Some(start), Some(end), Some(approach)) =
        (track.states.get(release), track.states.last(), track.states.first())
    else {
        return PullOut::default();
    };
    let (turning, residual) = (start[5], end[5]);
    let side = Side::of(turning).sign();
    let level = residual + (turning - residual) * (-1f64).exp();
    let fallen = track.first_above(release, 0.0, |s| side * (level - s[5]));
    PullOut {
        rudder: track.delta[release],
        approach_speed: approach[3].hypot(approach[4]),
        turning_rate: turning,
        residual_rate: Some(residual),
        decay_time: fallen.map(|i| track.time(i) - track.t[release]),
    }
}

/// Share of the rate of the turn that is none: less than what a gyro of a trial can measure.
const STILL: f64 = 0.01;

/// Whether the yaw rates left after turns to both sides are one: then the ship is stable on its course. `None` without both sides.
pub fn course_stable(trials: &[Trial<PullOut>]) -> Option<bool> {
    let rate = |side| trials.iter().find(|t| t.side == side)?.measures.residual_rate;
    let turning = trials.iter().map(|t| t.measures.turning_rate.abs()).fold(0.0, f64::max);
    Some((rate(Side::Starboard)? - rate(Side::Port)?).abs() < STILL * turning)
}

/// Whether the intervals of the rates that are left contain a stable and an unstable ship.
pub fn is_stability_open(trials: &[Trial<PullOut>]) -> bool {
    let turning = trials.iter().map(|t| t.measures.turning_rate.abs()).fold(0.0, f64::max);
    let is_open = |t: &Trial<PullOut>| {
        t.intervals.get("residual_rate").is_some_and(|[low, high]| {
            let nearest = if *low <= 0.0 && *high >= 0.0 { 0.0 } else { low.abs().min(high.abs()) };
            nearest < STILL * turning && low.abs().max(high.abs()) >= STILL * turning
        })
    };
    trials.iter().any(is_open)
}

/// Simulates a pull-out: a turn of 360 deg or more with the rudder at `angle` \[rad\] to one side until the rate is steady, then the rudder
/// amidships until it is steady again.
pub fn pull_out_trial(model: &Model, theta: &[f64], approach: &Approach, side: Side, angle: f64) -> Trial<PullOut> {
    let length = model.ship.hull.lpp;
    let mut release = None;
    let (track, ended) = sail_for(model, theta, approach, LONGEST, |track| {
        let turned = track.states.last().map_or(0.0, |s| s[2].abs());
        let since = release.unwrap_or(0);
        let still = steady(track, since, length, approach.speed);
        match release {
            None if turned >= TAU && still => release = Some(track.len() - 1),
            Some(_) if still => return None,
            _ => {}
        }
        let delta = if release.is_none() { side.sign() * angle } else { 0.0 };
        Some(Orders::at_once(delta, approach.n))
    });
    let rudder = side.sign() * angle;
    let measures = match release {
        Some(release) => PullOut { rudder, ..pull_out(&track, release) },
        None => PullOut { rudder, approach_speed: approach.speed, ..PullOut::default() },
    };
    Trial {
        name: format!("pull-out from {:.0} deg {}", angle.to_degrees(), side.word()),
        side,
        approach: *approach,
        ended,
        measures,
        criteria: Vec::new(),
        intervals: Intervals::new(),
        track,
    }
}
