//! The zigzag: its simulation, and executes, overshoots, initial turning and period read from any track.
//! The IMO criteria are in `imo`, not here.

use crate::evaluate::maneuver::approach::Approach;
use crate::evaluate::maneuver::imo;
use crate::evaluate::maneuver::measures::Zigzag;
use crate::evaluate::maneuver::nomoto::nomoto;
use crate::evaluate::maneuver::sail::{Orders, sail};
use crate::evaluate::maneuver::track::Track;
use crate::evaluate::maneuver::trial::{Intervals, Side, Trial};
use crate::model::Model;
use nalgebra::{DMatrix, DVector};

/// Samples that a mean heading or a parabola of headings takes at least.
const FEWEST: usize = 5;

/// Measures a zigzag of `heading` \[rad\] on a track whose rudder was put over at the samples `executes`.
pub fn zigzag(track: &Track, executes: &[usize], heading: f64) -> Zigzag {
    about(track, executes, heading, steered(track, executes))
}

/// As [`zigzag`], to either side of a course \[rad\] that is known.
fn about(track: &Track, executes: &[usize], heading: f64, steered: f64) -> Zigzag {
    let Some((&first, later)) = executes.split_first() else {
        return Zigzag::default();
    };
    let course = track.states[first][2];
    let end = *later.first().unwrap_or(&(track.len() - 1));
    let moved = track.delta[first..end.max(first + 1)].iter().map(|d| d - track.delta[first]);
    let rudder = moved.max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0);
    let side = Side::of(rudder).sign();

    let turned = |s: &[f64; 6]| side * (s[2] - course);
    let answered = track.first_above(first, heading, turned);
    // An overshoot is complete once the ship has turned back: at the next execute, or past a peak within the track.
    let overshoots = later.iter().enumerate().filter_map(|(i, &from)| {
        let towards = if i % 2 == 0 { side } else { -side };
        let to = later.get(i + 1).copied().unwrap_or(track.len() - 1);
        farthest(track, from, to, towards).map(|psi| (towards * (psi - steered) - heading).max(0.0))
    });
    let back = later.first().and_then(|&second| track.first_above(second, 0.0, |s| -turned(s)));
    Zigzag {
        rudder,
        heading,
        approach_speed: track.speed(first),
        executes: executes.iter().map(|&k| track.t[k] - track.t[first]).collect(),
        overshoots: overshoots.collect(),
        initial_turning: answered.map(|a| {
            let [x, y, ..] = track.states[a.sample];
            let [x1, y1, ..] = track.state(a);
            track.distance(first, a.sample) + (x1 - x).hypot(y1 - y)
        }),
        initial_turning_time: answered.map(|a| track.time(a) - track.t[first]),
        reach: back.map(|b| track.time(b) - track.t[first]),
        period: (executes.len() > 3).then(|| track.t[executes[3]] - track.t[executes[1]]),
        nomoto: later.last().filter(|_| later.len() > 1).and_then(|&last| nomoto(track, first, last)),
    }
}

/// The course to either side of which the rudder is put over \[rad\]. It lies midway between the headings of the second and the third
/// execute, also for a ship that was slightly off it at the first: a heading is known there to within what the ship turns between two samples,
/// q, so that the middle has the standard error `q / sqrt(24)`. It is the mean heading of the approach where that varied by less.
fn steered(track: &Track, executes: &[usize]) -> f64 {
    let first = executes.first().copied().unwrap_or(0);
    let approach: Vec<f64> = track.states[..=first].iter().map(|s| s[2]).filter(|psi| psi.is_finite()).collect();
    let mean = approach.iter().sum::<f64>() / approach.len() as f64;
    let [_, second, third, ..] = *executes else {
        return track.states[first][2];
    };
    let midway = 0.5 * (track.states[second][2] + track.states[third][2]);
    let between = |k: usize| (track.states[k][2] - track.states[k - 1][2]).powi(2);
    let error = (0.5 * (between(second) + between(third)) / 24.0).sqrt();
    let variance = approach.iter().map(|psi| (psi - mean).powi(2)).sum::<f64>() / (approach.len() - 1).max(1) as f64;
    if approach.len() >= FEWEST && (variance.sqrt() < error || error.is_nan()) { mean } else { midway }
}

/// The heading farthest to one side between two executes \[rad\]: the top of the parabola of least squares through the samples that are no
/// farther from the farthest one than half the time since the execute, so that noise of a sample does not count; `None` where the ship has not
/// turned back.
fn farthest(track: &Track, from: usize, to: usize, towards: f64) -> Option<f64> {
    let heading = |k: usize| towards * track.states[k][2];
    let finite = || (from..=to).filter(|k| heading(*k).is_finite());
    let peak = finite().max_by(|&a, &b| heading(a).total_cmp(&heading(b))).filter(|peak| *peak < to)?;
    let reach = 0.5 * (track.t[peak] - track.t[from]);
    let near: Vec<usize> = finite().filter(|k| (track.t[*k] - track.t[peak]).abs() <= reach).collect();
    let powers = DMatrix::from_fn(near.len(), 3, |i, j| ((track.t[near[i]] - track.t[peak]) / reach).powi(j as i32));
    let values = DVector::from_iterator(near.len(), near.iter().map(|k| heading(*k) - heading(peak)));
    let fitted = || (&powers.transpose() * &powers).cholesky().map(|c| c.solve(&(powers.transpose() * values)));
    // A parabola that bends the other way, or whose top lies outside the samples, is none of a ship that turns back.
    let top = (near.len() >= FEWEST).then(fitted).flatten().and_then(|c| {
        let at = -0.5 * c[1] / c[2];
        (c[2] < 0.0 && at.abs() <= 1.0).then(|| c[0] + 0.5 * c[1] * at)
    });
    Some(towards * (heading(peak) + top.unwrap_or(0.0)))
}

/// The samples at which the rudder of a recorded zigzag begins to move to the other side: for each passage beyond half the
/// largest angle on the other side than before, the last sample before it at which the rudder was still within a tenth of
/// that angle of where it had been held.
pub fn zigzag_executes(track: &Track) -> Vec<usize> {
    let largest = track.delta.iter().fold(0.0_f64, |m, d| m.max(d.abs()));
    let mut executes = Vec::new();
    let (mut side, mut held, mut from) = (0.0, track.delta.first().copied().unwrap_or(0.0), 0);
    for (k, &delta) in track.delta.iter().enumerate() {
        if delta.abs() > 0.5 * largest && delta.signum() != side {
            side = delta.signum();
            let still = (from..k).rev().find(|&i| (track.delta[i] - held).abs() <= 0.1 * largest);
            executes.extend(still);
            (held, from) = (delta, k);
        } else if side * delta > side * held {
            (held, from) = (delta, k);
        }
    }
    executes
}

/// Simulates a zigzag with the rudder at `angles[0]` and heading at `angles[1]` \[rad\], the first rudder to one side, until
/// the fifth execute.
pub fn zigzag_trial(model: &Model, theta: &[f64], approach: &Approach, side: Side, angles: [f64; 2]) -> Trial<Zigzag> {
    const EXECUTES: usize = 5;
    let [rudder, heading] = angles;
    let mut executes = vec![0];
    let mut to = side.sign();
    let (track, ended) = sail(model, theta, approach, |track| {
        let (mut late, k) = (0.0, track.len() - 1);
        let beyond = |k: usize| to * track.states[k][2] - heading;
        if beyond(k) >= 0.0 {
            // The heading passed the angle of the zigzag within the last step.
            late = if k > 0 { (beyond(k) / (beyond(k) - beyond(k - 1))).clamp(0.0, 1.0) } else { 0.0 };
            executes.push(k);
            to = -to;
        }
        (executes.len() < EXECUTES).then_some(Orders { delta: to * rudder, n: approach.n, late })
    });
    let mut measures = about(&track, &executes, heading, 0.0);
    measures.rudder = side.sign() * rudder;
    Trial {
        name: format!("zigzag {:.0}/{:.0}, {} first", rudder.to_degrees(), heading.to_degrees(), side.word()),
        side,
        approach: *approach,
        ended,
        criteria: imo::zigzag(&model.ship, &measures),
        measures,
        intervals: Intervals::new(),
        track,
    }
}
