//! The crash stop: its simulation, and track reach, head reach, lateral deviation and time read from any track.
//! The IMO criteria are in `imo`, not here.

use crate::evaluate::maneuver::approach::Approach;
use crate::evaluate::maneuver::imo;
use crate::evaluate::maneuver::measures::Stopping;
use crate::evaluate::maneuver::sail::{Orders, sail};
use crate::evaluate::maneuver::track::Track;
use crate::evaluate::maneuver::trial::{Intervals, Side, Trial};
use crate::model::Model;

/// Measures a stop on a track whose engine was ordered astern at sample `order`.
pub fn stopping(track: &Track, order: usize) -> Stopping {
    let Some(start) = track.states.get(order) else {
        return Stopping::default();
    };
    let course = start[2];
    let approach_speed = track.speed(order);
    let Some(stop) = track.first_above(order, 0.0, |s| -s[3]) else {
        return Stopping { approach_speed, ..Stopping::default() };
    };
    let s = track.state(stop);
    let [ahead, abeam] = track.ahead_abeam(order, course, [s[0], s[1]]);
    let [x, y, ..] = track.states[stop.sample];
    Stopping {
        approach_speed,
        track_reach: Some(track.distance(order, stop.sample) + (s[0] - x).hypot(s[1] - y)),
        head_reach: Some(ahead),
        lateral_deviation: Some(abeam),
        heading_change: Some(s[2] - course),
        time: Some(track.time(stop) - track.t[order]),
    }
}

/// Simulates a crash stop: engine to the approach's astern rate, rudder amidships, until the ship makes no more way ahead.
pub fn stopping_trial(model: &Model, theta: &[f64], approach: &Approach) -> Trial<Stopping> {
    let orders = Orders::at_once(0.0, approach.astern);
    let (track, ended) = sail(model, theta, approach, |track| {
        // `first_above` needs the sample after the last one with way ahead.
        track.states.last().is_none_or(|s| s[3] > 0.0).then_some(orders)
    });
    let measures = stopping(&track, 0);
    Trial {
        name: format!("crash stop, propeller {:.0} rpm", approach.astern * 60.0),
        side: Side::of(measures.lateral_deviation.unwrap_or(0.0)),
        approach: *approach,
        ended,
        measures,
        criteria: imo::stopping(&model.ship, &measures),
        intervals: Intervals::new(),
        track,
    }
}
