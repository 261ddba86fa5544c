//! The direct spiral test (Dieudonne 1953): the steady yaw rate at each rudder angle, from one side to the other and back.
//! There is no IMO criterion for it.

use super::pullout::steady;
use crate::evaluate::maneuver::approach::Approach;
use crate::evaluate::maneuver::measures::Spiral;
use crate::evaluate::maneuver::sail::{Orders, sail_for};
use crate::evaluate::maneuver::trial::{Intervals, Side, Trial};
use crate::model::Model;

/// Rudder angles of ten degrees and less at which the rate is taken \[deg\]: a degree apart near amidships, where a loop is.
const NEAR: [f64; 8] = [10.0, 7.0, 5.0, 4.0, 3.0, 2.0, 1.0, 0.0];
/// Ship lengths at approach speed after which the next angle is taken, steady or not.
const HELD: f64 = 150.0;

/// The rudder angles of a spiral in their order \[rad\]: from `largest` to the other side and back.
pub fn spiral_angles(largest: f64) -> Vec<f64> {
    let degrees = largest.to_degrees();
    let mut half: Vec<f64> = vec![degrees];
    half.extend(Some(0.5 * (degrees + NEAR[0])).filter(|a| *a > NEAR[0] + 1.0));
    half.extend(NEAR.iter().copied().filter(|a| *a < degrees));
    let down: Vec<f64> = half.iter().copied().chain(half.iter().rev().skip(1).map(|a| -a)).collect();
    down.iter().chain(down.iter().rev().skip(1)).map(|a| a.to_radians()).collect()
}

/// Measures a spiral from its points (rudder angle \[rad\], steady yaw rate \[rad/s\]), from the largest angle to starboard to that to port and
/// back.
pub fn spiral(points: &[[f64; 2]]) -> Spiral {
    let lowest = (0..points.len()).min_by(|a, b| points[*a][0].total_cmp(&points[*b][0]));
    let mut measures = Spiral { points: points.to_vec(), ..Spiral::default() };
    let Some(lowest) = lowest else { return measures };
    let (down, up) = (&points[..=lowest], &points[lowest..]);
    let at = |pass: &[[f64; 2]]| pass.iter().find(|p| p[0].abs() < 1e-9).map(|p| p[1]);
    measures.loop_height = at(down).zip(at(up)).map(|(a, b)| (a - b).abs());
    // On the way down the rate falls through zero, on the way up it rises through it.
    let (first, second) = (crossing(down), crossing(up));
    measures.loop_width = first.zip(second).map(|(a, b)| (b - a).max(0.0));
    measures.neutral = first.zip(second).map(|(a, b)| 0.5 * (a + b));
    measures
}

/// The rudder angle at which the yaw rate changes side, linear between points.
fn crossing(pass: &[[f64; 2]]) -> Option<f64> {
    pass.windows(2).find_map(|pair| {
        let [[d0, r0], [d1, r1]] = [pair[0], pair[1]];
        (r0 * r1 <= 0.0 && r0 != r1).then(|| d0 + (d1 - d0) * r0 / (r0 - r1))
    })
}

/// Simulates a spiral that begins with the rudder at `largest` \[rad\] to starboard; each angle is held until the yaw rate is steady.
pub fn spiral_trial(model: &Model, theta: &[f64], approach: &Approach, largest: f64) -> Trial<Spiral> {
    let length = model.ship.hull.lpp;
    let angles = spiral_angles(largest);
    let (mut points, mut since) = (Vec::new(), 0);
    let lengths = HELD * (angles.len() + 1) as f64;
    let (track, ended) = sail_for(model, theta, approach, lengths, |track| {
        let now = track.len() - 1;
        let held = (track.t[now] - track.t[since]) * approach.speed / length;
        if now > since && (steady(track, since, length, approach.speed) || held >= HELD) {
            points.push([angles[points.len()], track.states[now][5]]);
            since = now;
        }
        angles.get(points.len()).map(|delta| Orders::at_once(*delta, approach.n))
    });
    let mut measures = spiral(&points);
    (measures.rudder, measures.approach_speed) = (largest, approach.speed);
    Trial {
        name: format!("spiral from {:.0} deg", largest.to_degrees()),
        side: Side::Starboard,
        approach: *approach,
        ended,
        measures,
        criteria: Vec::new(),
        intervals: Intervals::new(),
        track,
    }
}
