//! Turning circles and zigzags found in a recorded track by the rudder alone, each with its executes, angles and rudder rate.
//! Nothing is simulated here, and no label of a recording is read.

use super::track::Track;
use super::trial::Side;
use super::trials::zigzag::zigzag_executes;
use crate::statistics::median;
use serde::Serialize;
use std::f64::consts::PI;
use std::ops::RangeInclusive;

/// A trial found in a track.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Which trial.
    pub kind: Kind,
    /// First rudder.
    pub side: Side,
    /// Samples of the trial, from the start of its approach.
    pub samples: RangeInclusive<usize>,
    /// Samples at which the rudder begins to move: the first execute, and in a zigzag the later ones.
    pub executes: Vec<usize>,
    /// Rudder angle held \[rad\], positive; in a zigzag the mean of the sides.
    pub rudder: f64,
    /// Rate at which the rudder moved \[rad/s\]; `None` where it is over within one sample, as an order is.
    pub rudder_rate: Option<f64>,
}

/// Which trial was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// A rudder step held until heading changed by 90 deg or more.
    Turning,
    /// Rudder to alternating sides at equal changes of heading \[rad\].
    Zigzag {
        /// The change of heading, to the whole degree.
        heading: f64,
    },
}

/// What looked like a trial and is none, with the reason.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PassedOver {
    /// Time at which the rudder was put over \[s\].
    pub at: f64,
    /// Why it is no trial.
    pub why: String,
}

/// A rudder within this of amidships is at rest \[rad\]: helmsmen and autopilots steer a course with less.
const REST: f64 = 4.0 * PI / 180.0;
/// A rudder is held where it stays within this share of its angle, and no less than [`LOOSE`].
const HELD: f64 = 0.15;
/// Least deviation from an angle that is held \[rad\].
const LOOSE: f64 = 1.5 * PI / 180.0;
/// Share of the samples of a rudder put over in which it must be held.
const HELD_SHARE: f64 = 0.8;
/// Least change of heading of a turning circle \[rad\].
const TURNED: f64 = 0.5 * PI;
/// Most change of heading over the last ship length of an approach \[rad\]: a ship at 3 % of the yaw rate of a tight turn.
const STRAIGHT: f64 = 4.0 * PI / 180.0;
/// Least length of a recorded approach, in ship lengths.
const SHORTEST: f64 = 0.1;
/// Largest difference of the headings at which the rudder of one zigzag is put over \[rad\].
const THRESHOLD: f64 = 4.0 * PI / 180.0;

const NO_APPROACH: &str = "it does not begin with the rudder at rest";
const NO_STRAIGHT: &str =
    "the heading is not within 4 deg over the last ship length before, or a tenth of that was recorded";
const UNEQUAL: &str = "the rudder is put over to alternating sides, but not at equal changes of heading";

/// A stretch of samples with the rudder over to one side.
struct Over {
    side: f64,
    first: usize,
    last: usize,
    held: f64,
    steady: bool,
}

/// The trials in a track, in order of time, and what was passed over. `length` is the ship's \[m\].
pub fn find(track: &Track, length: f64) -> (Vec<Found>, Vec<PassedOver>) {
    let all = stretches(track);
    let (mut found, mut passed) = (Vec::new(), Vec::new());
    let mut i = 0;
    while i < all.len() {
        let count = alternating(track, &all[i..]);
        let zigzag = zigzag_within(track, length, &all, i, count);
        let taken = if zigzag.is_some() { count } else { 1 };
        match zigzag.or_else(|| as_turning(track, length, &all, i)) {
            Some(Ok(trial)) => found.push(trial),
            Some(Err(why)) => passed.push(PassedOver { at: track.t[all[i].first], why: why.to_owned() }),
            None => {}
        }
        i += taken.max(1);
    }
    (found, passed)
}

/// The zigzag of `count` stretches, or of the last ones of them: a helmsman may have steered the course before with as much rudder. The
/// reason of all of them where there is none; `None` for fewer than three stretches, as three executes have two changes of heading between
/// them that can be equal.
fn zigzag_within(
    track: &Track,
    length: f64,
    all: &[Over],
    first: usize,
    count: usize,
) -> Option<Result<Found, &'static str>> {
    let left_out = 0..=count.checked_sub(3)?;
    let mut attempts = left_out.map(|skip| as_zigzag(track, length, all, first + skip, count - skip));
    let whole = attempts.next()?;
    if whole.is_ok() {
        return Some(whole);
    }
    Some(attempts.find(Result::is_ok).unwrap_or(whole))
}

/// The stretches with the rudder over to one side.
fn stretches(track: &Track) -> Vec<Over> {
    let side = |delta: f64| if delta.abs() > REST { delta.signum() } else { 0.0 };
    let mut all = Vec::new();
    let mut first = 0;
    for last in 0..track.len() {
        let here = side(track.delta[last]);
        if here != 0.0 && track.delta.get(last + 1).map(|d| side(*d)) != Some(here) {
            all.push(over(track, first, last, here));
        }
        if track.delta.get(last + 1).map(|d| side(*d)) != Some(here) {
            first = last + 1;
        }
    }
    all
}

/// One stretch: the angle held is the median beyond half the largest.
fn over(track: &Track, first: usize, last: usize, side: f64) -> Over {
    let angles: Vec<f64> = track.delta[first..=last].iter().map(|d| side * d).collect();
    let largest = angles.iter().copied().fold(0.0, f64::max);
    let beyond: Vec<f64> = angles.iter().copied().filter(|d| *d > 0.5 * largest).collect();
    let held = median(beyond).unwrap_or(0.0);
    let near = |d: f64| (d - held).abs() <= (HELD * held).max(LOOSE);
    let inside = angles.iter().position(|d| near(*d)).zip(angles.iter().rposition(|d| near(*d)));
    let steady = inside.is_some_and(|(a, b)| {
        let within = angles[a..=b].iter().filter(|d| near(**d)).count();
        within as f64 >= HELD_SHARE * (b + 1 - a) as f64 && 2 * (b + 1 - a) >= angles.len()
    });
    Over { side, first, last, held, steady }
}

/// How many stretches from the first on have the rudder at one angle to alternating sides, put over from one to the other at once.
fn alternating(track: &Track, all: &[Over]) -> usize {
    let Some(one) = all.first().filter(|one| one.steady) else { return 0 };
    let follows = |pair: &[Over]| {
        let [before, after] = pair else { return false };
        let alike = (after.held - one.held).abs() <= (HELD * one.held).max(LOOSE);
        let across = track.t[after.first] - track.t[before.last];
        after.steady
            && alike
            && after.side == -before.side
            && across <= 0.5 * (track.t[before.last] - track.t[before.first])
    };
    1 + all.windows(2).take_while(|pair| follows(pair)).count()
}

/// The zigzag of `count` stretches, if the rudder was put over at equal changes of heading, from a straight course.
fn as_zigzag(track: &Track, length: f64, all: &[Over], first: usize, count: usize) -> Result<Found, &'static str> {
    let chain = &all[first..first + count];
    let from = if first == 0 { 0 } else { all[first - 1].last + 1 };
    // The trial ends where the rudder is eased for good.
    let to = chain[count - 1].last;
    let part = track.part(from..=to);
    let executes: Vec<usize> = zigzag_executes(&part).iter().map(|k| k + from).collect();
    let (&execute, later) = executes.split_first().filter(|_| executes.len() == count).ok_or(NO_APPROACH)?;
    straight(track, length, execute).ok_or(NO_STRAIGHT)?;
    let headings: Vec<f64> = later.iter().map(|&k| track.states[k][2]).collect();
    // Half of what lies between one execute and the next: the steered course drops out.
    let halves: Vec<f64> = headings.windows(2).map(|h| 0.5 * (h[1] - h[0]).abs()).collect();
    let angle = median(halves.iter().copied()).ok_or(UNEQUAL)?;
    let alike = halves.iter().all(|h| (h - angle).abs() <= 0.5 * THRESHOLD);
    if !alike || !(2f64.to_radians()..0.5 * PI).contains(&angle) {
        return Err(UNEQUAL);
    }
    let heading = angle.to_degrees();
    let five = 5.0 * (heading / 5.0).round();
    let heading = if five > 0.0 && (heading - five).abs() <= 1.5 { five } else { heading.round() };
    let rudder = chain.iter().map(|o| o.held).sum::<f64>() / count as f64;
    let sides = [chain[0].side, -chain[0].side].into_iter().cycle();
    let rates: Vec<f64> =
        executes.iter().zip(sides).filter_map(|(&k, side)| rate(track, k, to, side * rudder)).collect();
    Ok(Found {
        kind: Kind::Zigzag { heading: heading.to_radians() },
        side: Side::of(chain[0].side),
        samples: from..=to,
        executes,
        rudder,
        rudder_rate: median(rates),
    })
}

/// The turning circle of one stretch; `None` where the ship hardly turned, and the reason where a turn is no trial.
fn as_turning(track: &Track, length: f64, all: &[Over], i: usize) -> Option<Result<Found, &'static str>> {
    let one = &all[i];
    let turned = one.side * (track.states[one.last][2] - track.states[one.first][2]);
    if turned.is_nan() || turned < TURNED {
        return None;
    }
    if !one.steady {
        return Some(Err("the rudder is not held at one angle"));
    }
    if one.first == 0 {
        return Some(Err(NO_APPROACH));
    }
    // Where a helmsman steered the course with rudder to the other side, the last sample of that is where the rudder begins to move.
    let from = if i == 0 { 0 } else { (all[i - 1].last + 1).min(one.first - 1) };
    let half = (one.first..=one.last).find(|&k| one.side * track.delta[k] > 0.5 * one.held)?;
    let before = approach_start(track, length, one.first).unwrap_or(0).max(from);
    let rest = median(track.delta[before..one.first].iter().copied()).unwrap_or(0.0);
    let still = |k: &usize| one.side * (track.delta[*k] - rest) <= 0.05 * one.held;
    let execute = (from..half).rev().find(still)?;
    if straight(track, length, execute).is_none() {
        return Some(Err(NO_STRAIGHT));
    }
    Some(Ok(Found {
        kind: Kind::Turning,
        side: Side::of(one.side),
        samples: from..=one.last,
        executes: vec![execute],
        rudder: one.held,
        rudder_rate: rate(track, execute, one.last, one.side * one.held),
    }))
}

/// Whether the ship sails straight, within 4 deg, over the last ship length before an execute, or over what the recording has of it, which
/// must be a tenth of a length.
fn straight(track: &Track, length: f64, execute: usize) -> Option<()> {
    let start = approach_start(track, length, execute)
        .or_else(|| approach_start(track, SHORTEST * length, execute).map(|_| 0))?;
    let headings = track.states[start..=execute].iter().map(|s| s[2]).filter(|psi| psi.is_finite());
    let (low, high) = headings.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), h| (a.min(h), b.max(h)));
    (high - low <= STRAIGHT).then_some(())
}

/// The sample from which the ship sails its length until an execute; `None` where the track does not reach so far back.
fn approach_start(track: &Track, length: f64, execute: usize) -> Option<usize> {
    let mut sailed = 0.0;
    for k in (0..execute).rev() {
        sailed += track.speed(k) * (track.t[k + 1] - track.t[k]);
        if sailed >= length {
            return Some(k);
        }
    }
    None
}

/// Mean speed over the last ship length before an execute \[m/s\].
pub fn approach_speed(track: &Track, length: f64, execute: usize) -> f64 {
    let start = approach_start(track, length, execute).unwrap_or(0);
    let speeds: Vec<f64> = (start..=execute).map(|k| track.speed(k)).filter(|v| v.is_finite()).collect();
    speeds.iter().sum::<f64>() / speeds.len() as f64
}

/// By which share of its mean the speed changed over the last ship length before an execute, from the first to the last third of it.
pub(super) fn approach_change(track: &Track, length: f64, execute: usize) -> f64 {
    let start = approach_start(track, length, execute).unwrap_or(0);
    let third = (execute - start) / 3;
    let mean = |from: usize, to: usize| (from..=to).map(|k| track.speed(k)).sum::<f64>() / (to + 1 - from) as f64;
    (mean(execute - third, execute) - mean(start, start + third)) / mean(start, execute)
}

/// Rate of the rudder after an execute \[rad/s\]: from a fifth to four fifths of the way to where it is held; `None` where that is within
/// one sample.
fn rate(track: &Track, execute: usize, to: usize, held: f64) -> Option<f64> {
    let rest = track.delta[execute];
    let way = held - rest;
    let passed = |share: f64| {
        let left = |k: usize| (track.delta[k] - rest) / way - share;
        (execute..to).find_map(|k| {
            let (a, b) = (left(k), left(k + 1));
            (a < 0.0 && b >= 0.0).then(|| track.t[k] + a / (a - b) * (track.t[k + 1] - track.t[k]))
        })
    };
    let (early, late) = (passed(0.2)?, passed(0.8)?);
    let sample = track.t[execute + 1] - track.t[execute];
    (late - early >= sample).then(|| 0.6 * way.abs() / (late - early))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ship of 10 m that turns at K delta at once, under a rudder angle of time, sampled every 0.1 s for 400 s.
    fn sailed(mut rudder: impl FnMut(f64, f64) -> f64) -> Track {
        let mut track = Track::default();
        let (mut x, mut y, mut psi, mut delta) = (0.0, 0.0, 0.0, 0.0);
        for k in 0..4000 {
            let t = k as f64 * 0.1;
            let r = 0.1 * delta;
            track.t.push(t);
            track.states.push([x, y, psi, 2.0, 0.0, r]);
            track.delta.push(delta);
            track.n.push(1.0);
            delta += (rudder(t, psi) - delta).clamp(-0.005, 0.005);
            (x, y, psi) = (x + 0.2 * psi.cos(), y + 0.2 * psi.sin(), psi + 0.1 * r);
        }
        track
    }

    /// The helm of a zigzag that begins at 50 s and ends at 300 s.
    fn zigzag_helm(rudder: f64, heading: f64) -> impl FnMut(f64, f64) -> f64 {
        let mut to = 1.0;
        move |t, psi| {
            if to * psi >= heading {
                to = -to;
            }
            if (50.0..300.0).contains(&t) { to * rudder } else { 0.0 }
        }
    }

    #[test]
    fn a_held_rudder_step_is_a_turning_circle_with_its_angle_and_rate() {
        for side in [1.0, -1.0] {
            let track = sailed(|t, _| if (60.0..300.0).contains(&t) { side * 0.5 } else { 0.0 });
            let (found, passed) = find(&track, 10.0);
            assert!(passed.is_empty() && found.len() == 1, "{found:?} {passed:?}");
            let one = &found[0];
            assert_eq!((one.kind, one.side), (Kind::Turning, Side::of(side)));
            assert!((one.rudder - 0.5).abs() < 1e-6 && (one.rudder_rate.unwrap() - 0.05).abs() < 1e-6, "{one:?}");
            assert!(one.executes[0].abs_diff(600) <= 6, "{one:?}");
            assert!((approach_speed(&track, 10.0, one.executes[0]) - 2.0).abs() < 1e-9);
        }
    }

    #[test]
    fn alternating_rudder_at_equal_headings_is_a_zigzag_with_its_executes() {
        let (rudder, heading) = (15f64.to_radians(), 20f64.to_radians());
        let track = sailed(zigzag_helm(rudder, heading));
        let (found, _) = find(&track, 10.0);
        let one = found.iter().find(|f| f.kind != Kind::Turning).unwrap();
        let Kind::Zigzag { heading: threshold } = one.kind else { unreachable!() };
        assert!((threshold.to_degrees() - 20.0).abs() < 1e-9, "{one:?}");
        assert!((one.rudder.to_degrees() - 15.0).abs() < 0.2, "{one:?}");
        assert!(one.executes.len() >= 5 && one.side == Side::Starboard, "{one:?}");
        let later = &one.executes[1..];
        assert!(later.iter().all(|&k| (track.states[k][2].abs() - heading).abs() < 0.03), "{one:?}");
    }

    #[test]
    fn a_turn_without_a_straight_approach_or_with_a_moving_rudder_is_passed_over_with_the_reason() {
        let bent = sailed(|t, _| if t < 50.0 { 0.06 } else { 0.5 });
        let (found, passed) = find(&bent, 40.0);
        assert!(found.is_empty() && passed[0].why.contains("within 4 deg"), "{found:?} {passed:?}");
        let mut over = sailed(|_, _| 0.5);
        over.delta.iter_mut().for_each(|d| *d = 0.5);
        let (found, passed) = find(&over, 10.0);
        assert!(found.is_empty() && passed[0].why.contains("rudder at rest"), "{found:?} {passed:?}");
        let moving = sailed(|t, _| if t > 50.0 { 0.35 + 0.25 * (t / 8.0).sin() } else { 0.0 });
        let (found, passed) = find(&moving, 10.0);
        assert!(found.is_empty() && passed[0].why.contains("not held"), "{found:?} {passed:?}");
    }

    #[test]
    fn an_order_that_is_over_within_a_sample_has_no_rate() {
        let mut track = sailed(|t, _| if (60.0..300.0).contains(&t) { 0.5 } else { 0.0 });
        for (t, delta) in track.t.iter().zip(&mut track.delta) {
            *delta = if (60.0..300.0).contains(t) { 0.5 } else { 0.0 };
        }
        let (found, _) = find(&track, 10.0);
        assert_eq!(found[0].rudder_rate, None);
    }

    #[test]
    fn steering_a_course_contains_no_trial() {
        let track = sailed(|t, psi| -0.5 * psi + 0.05 * (t / 5.0).sin());
        assert_eq!(find(&track, 10.0), (Vec::new(), Vec::new()));
    }
}
