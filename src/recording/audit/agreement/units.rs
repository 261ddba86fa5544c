//! Units: actuators too small for their unit, and the gains that a wrong unit or sign causes between two channels of the same motion.
//! Here heading is compared with yaw rate; the track is compared with velocity in `signs`.

use crate::recording::audit::issue::{Issue, Severity};
use crate::recording::audit::limits::{
    AGAINST_TURN, APART, CALIBRATED, COHERENT, SAME_GAIN, SMALL_RATE, SMALL_RUDDER, SMALL_RUDDER_TURNS, STILL_RUDDER,
};
use crate::recording::audit::motion::clocks::Pair;
use crate::recording::audit::motion::kinematics::{Kinematics, Proportion};
use crate::recording::audit::motion::series::Series;
use crate::recording::{Channel, Recording};

/// Actuators too small for their unit.
pub fn magnitudes(recording: &Recording, issues: &mut Vec<Issue>) {
    // Radians read as degrees, or rps as rpm.
    let least = [(Channel::Delta, SMALL_RUDDER, "rad"), (Channel::N, SMALL_RATE, "rps")];
    for (channel, limit, unit) in least {
        let Some(values) = recording.get(channel) else { continue };
        let largest = values.iter().copied().filter(|v| v.is_finite()).fold(0.0, |m: f64, v| m.max(v.abs()));
        // A ship that is steered straight needs no more rudder than that.
        let straight = channel == Channel::Delta && turned(recording).is_some_and(|t| t < SMALL_RUDDER_TURNS * largest);
        // What is in radians already may have been converted twice; only the turn of the ship shows that.
        let twice = channel == Channel::Delta && recording.unit(channel) == unit && turned(recording).is_some();
        if largest > 0.0 && largest < limit && (recording.unit(channel) != unit || twice) && !straight {
            let factor = channel.info().quantity.factor(recording.unit(channel)).unwrap_or(1.0);
            let text =
                format!("{} never exceeds {:.3} {}", channel.info().words, largest / factor, recording.unit(channel));
            let next = if twice {
                format!(
                    "was it converted to {unit} twice? `scale = 57.3` for `{channel}` in a column map takes it back"
                )
            } else {
                format!("is the column in {unit}? set `unit` for `{channel}` in a column map")
            };
            issues.push(Issue::new(Severity::Warning, "unit_error", text, next).of(channel));
        }
    }
}

/// A rudder that never moves while the ship turns: its column may not have been recorded.
pub fn still(recording: &Recording, issues: &mut Vec<Issue>) {
    let (Some(delta), Some(turned)) = (recording.get(Channel::Delta), turned(recording)) else { return };
    let still = delta.iter().filter(|d| d.is_finite()).all(|d| d.abs() < STILL_RUDDER);
    if still && turned > AGAINST_TURN {
        let text = format!("the rudder is never moved, and the ship turns by {:.0} deg", turned.to_degrees());
        let next = "is it the column of the rudder's angle, and was it recorded? A ship that turns by other means needs them recorded (`trimtab help channels`)";
        issues.push(Issue::new(Severity::Warning, "still", text, next).of(Channel::Delta));
    }
}

/// Largest less smallest heading of a run \[rad\]; `None` without a heading.
fn turned(recording: &Recording) -> Option<f64> {
    let finite = || recording.get(Channel::Psi).into_iter().flatten().copied().filter(|p| p.is_finite());
    Some(finite().reduce(f64::max)? - finite().reduce(f64::min)?)
}

/// Known wrong units and signs by the gain they cause on a speed, and what each means.
pub const SPEED_GAINS: [(f64, &str); 11] = [
    (1e-3, "the position is in km and was declared m"),
    (1e3, "the position is in m and was declared km"),
    (-1.0, "the sign is turned"),
    (1852.0 / 3600.0, "the column is in knots and was declared m/s"),
    (3600.0 / 1852.0, "the column is in m/s and was declared kn"),
    (1.0 / 3.6, "the column is in km/h and was declared m/s"),
    (3.6, "the column is in m/s and was declared km/h"),
    (0.3048, "the column is in ft/s and was declared m/s, or the position is in m and was declared ft"),
    (1.0 / 0.3048, "the position is in ft and was declared m"),
    (1.0 / 1852.0, "the position is in nautical miles and was declared m"),
    (-1852.0 / 3600.0, "the column is in knots, was declared m/s, and its sign is turned"),
];

/// The same on a yaw rate.
pub const TURN_GAINS: [(f64, &str); 7] = [
    (-1.0, "the sign is turned"),
    (1.0 / 57.295_779_5, "the yaw rate is in deg/s and was declared rad/s, or the heading in rad and declared deg"),
    (57.295_779_5, "the yaw rate is in rad/s and was declared deg/s, or the heading in deg and declared rad"),
    (1.0 / 60.0, "the yaw rate is in deg/min and was declared deg/s"),
    (60.0, "the yaw rate is in deg/s and was declared deg/min"),
    (-1.0 / 57.295_779_5, "the yaw rate is in deg/s, was declared rad/s, and its sign is turned"),
    (-57.295_779_5, "the yaw rate is in rad/s, was declared deg/s, and its sign is turned"),
];

/// The same on whatever is differentiated, speed and turn alike.
const TIME_GAINS: [(f64, &str); 6] = [
    (1e-3, "the time is in ms and was declared s"),
    (1e3, "the time is in s and was declared ms"),
    (60.0, "the time is in min and was declared s"),
    (1.0 / 60.0, "the time is in s and was declared min"),
    (3600.0, "the time is in h and was declared s"),
    (1.0 / 3600.0, "the time is in s and was declared h"),
];

/// What a gain means: the fault, its description, and what to do.
pub struct Meaning {
    pub fault: &'static str,
    pub text: String,
    pub next: &'static str,
}

/// What a gain on a speed or on a turn means, given the gain on the other of the two, if it is known; `None` for a gain that is none of the
/// known ones. A time in another unit changes both alike. `next` says what mends the units of the channels.
pub fn known_gain(gain: f64, other: Option<f64>, known: &[(f64, &'static str)], next: &'static str) -> Option<Meaning> {
    let of = |known: &[(f64, &'static str)]| {
        let off = |g: &f64| (gain / g - 1.0).abs();
        let nearest = known.iter().min_by(|a, b| off(&a.0).total_cmp(&off(&b.0))).copied();
        nearest.filter(|(g, _)| off(g) < SAME_GAIN)
    };
    let (time, own) = (of(&TIME_GAINS), of(known));
    let alike = other.is_none_or(|other| (gain / other - 1.0).abs() < SAME_GAIN);
    let unit = |text: String, next| Meaning { fault: "unit_error", text, next };
    const OF_TIME: &str = "correct `unit` of t in a column map";
    match (time.filter(|_| alike), own) {
        (Some((_, time)), Some((_, own))) if other.is_none() => Some(unit(format!("{time}, or {own}"), next)),
        (Some((_, time)), _) => Some(unit(time.to_owned(), OF_TIME)),
        (None, Some((gain, own))) if gain < 0.0 => Some(Meaning { fault: "sign_error", text: own.to_owned(), next }),
        (None, Some((_, own))) => Some(unit(own.to_owned(), next)),
        (None, None) => None,
    }
}

/// Root mean square differences of a heading and the integral of a yaw rate \[rad\].
#[derive(Clone, Copy, Default)]
struct Apart {
    /// Less an unknown first heading.
    all: f64,
    /// Less also what drifts evenly: a zero offset of the gyro.
    but_drift: f64,
}

impl Apart {
    fn new(t: &[f64], psi: &[f64], r: &[f64]) -> Self {
        let (mut turned, mut last): (f64, Option<(f64, f64)>) = (0.0, None);
        let mut points: Vec<[f64; 2]> = Vec::with_capacity(t.len());
        for ((&t, &psi), &r) in t.iter().zip(psi).zip(r).filter(|((_, psi), r)| psi.is_finite() && r.is_finite()) {
            if let Some((before, rate)) = last {
                turned += 0.5 * (rate + r) * (t - before);
            }
            last = Some((t, r));
            points.push([t, psi - turned]);
        }
        let count = points.len().max(1) as f64;
        let mean = [0, 1].map(|i: usize| points.iter().map(|p| p[i]).sum::<f64>() / count);
        let of = |i: usize, j: usize| points.iter().map(|p| (p[i] - mean[i]) * (p[j] - mean[j])).sum::<f64>();
        let (times, drift, squares) = (of(0, 0), of(0, 1), of(1, 1));
        let line = if times > 0.0 { drift * drift / times } else { 0.0 };
        Self { all: (squares / count).sqrt(), but_drift: ((squares - line).max(0.0) / count).sqrt() }
    }

    fn larger(self, other: Self) -> Self {
        Self { all: self.all.max(other.all), but_drift: self.but_drift.max(other.but_drift) }
    }
}

/// Heading against yaw rate.
#[derive(Default)]
pub struct Turning {
    sums: Proportion,
    longest: Pair,
    /// Of the stretches that differ most.
    apart: Apart,
}

impl Turning {
    /// Adds some rows.
    pub fn add(&mut self, series: &Series<'_>) {
        let both = series.get(Channel::Psi).zip(series.recorded(Channel::R));
        let Some((psi, r)) = both else { return };
        for stretch in &series.stretches {
            let (turning, smooth) = (series.slope(psi, stretch), series.smooth(r, stretch));
            self.sums.add(&turning, &smooth);
            self.longest.offer(turning, smooth, series.step);
            let [t, psi, r] = [&series.t, psi, r].map(|all| &all[stretch.clone()]);
            self.apart = self.apart.larger(Apart::new(t, psi, r));
        }
    }

    /// Turn of the heading as a multiple of the yaw rate, where the two move together.
    pub fn gain(&self) -> Option<f64> {
        (self.sums.known() && self.sums.coherence().abs() > COHERENT).then(|| self.sums.gain())
    }

    /// Reports what all rows show; `speed` is the gain of the track on the velocity.
    pub fn tell(&self, kinematics: &mut Kinematics, speed: Option<f64>, issues: &mut Vec<Issue>) {
        if !self.sums.known() {
            return;
        }
        let (gain, coherence) = (self.sums.gain(), self.sums.coherence());
        kinematics.yaw_rate_rms = Some(self.sums.rms());
        kinematics.yaw_rate_gain = Some(gain);
        let mut push = |severity, fault, text: String, next: &str| {
            issues.push(Issue::new(severity, fault, text, next).of(Channel::R));
        };
        if coherence.abs() > COHERENT {
            let next = "correct `unit` or `sign` of `r` or `psi` in a column map";
            if let Some(meaning) = known_gain(gain, speed, &TURN_GAINS, next) {
                let text = format!("heading turns {gain:.4} times as fast as r says: {}", meaning.text);
                push(Severity::Error, meaning.fault, text, meaning.next);
                return;
            }
            if self.sums.is_off(CALIBRATED) && self.apart.all > APART {
                let text = format!("heading turns {gain:.3} times as fast as r says");
                let next = "check unit and calibration of yaw rate and heading; `scale` in a column map corrects one";
                push(Severity::Warning, "calibration", text, next);
            }
        } else if self.sums.rms() > self.sums.rms_a() && self.apart.but_drift > APART {
            let text = format!("heading and r do not move together (coherence {coherence:.2})");
            push(Severity::Warning, "disagreement", text, "check that both columns are what the map says");
        }
        kinematics.yaw_rate_lag = self.longest.lag();
        self.longest.tell(kinematics.yaw_rate_lag, Channel::R, "the heading", issues);
    }
}
