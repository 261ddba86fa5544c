//! Rates of signals and how two of them compare: the evidence from which units, signs and senses are determined.
//! It uses no units; what a ratio means is decided by the caller.

use super::signal::{Signal, size_below};
use crate::recording::local;
use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::Range;

/// Steps over which a rate is taken.
const SPAN_STEPS: f64 = 8.0;

impl Signal {
    /// Stretches of samples without a gap.
    pub fn stretches(&self) -> Vec<Range<usize>> {
        let longest = self.longest_step();
        let mut stretches = Vec::new();
        let mut start = 0;
        for i in 1..=self.t.len() {
            if i == self.t.len() || self.t[i] - self.t[i - 1] > longest {
                stretches.push(start..i);
                start = i;
            }
        }
        stretches
    }

    /// Length of the local fits that differentiate it \[s\].
    pub fn span(&self) -> f64 {
        SPAN_STEPS * self.step
    }

    /// Value (0) or rate (1) from local quadratic fits over `span` seconds, within unbroken stretches of five samples and more.
    fn fitted(&self, span: f64, which: usize) -> Self {
        let mut fitted = self.without_samples();
        for stretch in self.stretches().into_iter().filter(|s| s.len() >= 5) {
            let values = local(&self.t, &self.v, stretch.clone(), span);
            for (row, value) in stretch.zip(values).filter(|(_, value)| value[which].is_finite()) {
                fitted.t.push(self.t[row]);
                fitted.v.push(value[which]);
            }
        }
        fitted
    }

    /// Its rate of change.
    pub fn rate(&self, span: f64) -> Self {
        self.fitted(span, 1)
    }

    /// The same without what is faster than the span.
    pub fn smooth(&self, span: f64) -> Self {
        self.fitted(span, 0)
    }

    /// Pairs of its values with those of another at its times.
    pub fn pairs(&self, other: &Self) -> Vec<[f64; 2]> {
        let both = self.t.iter().zip(&self.v).map(|(t, v)| [*v, other.at(*t, self.step)]);
        both.filter(|pair| pair[1].is_finite()).collect()
    }
}

/// How one series is proportional to another.
#[derive(Clone, Copy, Debug)]
pub struct Ratio {
    /// The first as a multiple of the second, with its sign.
    pub gain: f64,
    /// Cosine of similarity, 0 to 1.
    pub coherence: f64,
}

/// Coherence from which a ratio means something.
pub const COHERENT: f64 = 0.6;

/// The first of pairs as a multiple of the second: the ratio of their sizes with the sign of their product; `None` of fewer than ten,
/// or of noughts.
pub fn ratio(pairs: &[[f64; 2]]) -> Option<Ratio> {
    let sum = |f: &dyn Fn(&[f64; 2]) -> f64| pairs.iter().map(f).sum::<f64>();
    let (aa, ab, bb) = (sum(&|p| p[0] * p[0]), sum(&|p| p[0] * p[1]), sum(&|p| p[1] * p[1]));
    let known = pairs.len() >= 10 && aa > 0.0 && bb > 0.0 && ab != 0.0;
    known.then(|| Ratio { gain: (aa / bb).sqrt().copysign(ab), coherence: ab.abs() / (aa * bb).sqrt() })
}

/// The track of a ship: its velocity to the north and east.
pub struct Track {
    /// North velocity \[m/s\].
    pub north: Signal,
    /// East velocity \[m/s\].
    pub east: Signal,
    /// Speed \[m/s\].
    pub speed: Signal,
    /// Speed that is not exceeded in nineteen of twenty samples \[m/s\].
    pub fast: f64,
}

impl Track {
    /// From positions \[m\] with the same times.
    pub fn of(x: &Signal, y: &Signal) -> Option<Self> {
        let (north, east) = (x.rate(x.span()), y.rate(y.span()));
        if north.t.len() < 10 || north.t.len() != east.t.len() {
            return None;
        }
        let speed = Signal { v: north.v.iter().zip(&east.v).map(|(n, e)| n.hypot(*e)).collect(), ..north.clone() };
        let fast = size_below(&speed.v, 0.95);
        (fast > 0.0).then_some(Self { north, east, speed, fast })
    }

    /// How directions \[rad\] agree with that of the track where the ship is under way: length and angle \[rad\] of the mean of
    /// `exp(i (course - sense * direction))`; sense is 1 or -1.
    pub fn agreement(&self, direction: &Signal, sense: f64) -> Option<[f64; 2]> {
        let (mut cos, mut sin, mut count) = (0.0, 0.0, 0.0);
        for i in (0..self.speed.t.len()).filter(|i| self.speed.v[*i] > 0.4 * self.fast) {
            let at = direction.at(self.speed.t[i], self.speed.step);
            if at.is_finite() {
                let apart = self.east.v[i].atan2(self.north.v[i]) - sense * at;
                cos += apart.cos();
                sin += apart.sin();
                count += 1.0;
            }
        }
        (count >= 10.0).then(|| [sin.hypot(cos) / count, sin.atan2(cos)])
    }
}

/// A direction is no course from this mean of one minus the cosine of its angle to the track on: 11 deg (root mean square), more than fixes
/// of some metres make of a ship under way.
pub const NO_COURSE: f64 = 0.02;
/// That mean in one sense as a share of the same in the other from which the sense is determined; so of the angles.
const OTHER_SENSE: f64 = 0.5;
/// A ship under way goes ahead: drift and current bring her bow no further from the track than this \[rad\].
const DRIFT: f64 = 0.35;

impl Track {
    /// Clockwise of north, where a direction \[rad\] begins to count that is counted anticlockwise, as the track goes; `None` where it is not.
    /// It is, where it turns against the track, and where clockwise the ship would go sideways, and anticlockwise from east or west ahead.
    pub fn anticlockwise(&self, direction: &Signal) -> Option<f64> {
        let [[right, off], [mirrored, turned]] = [self.agreement(direction, 1.0)?, self.agreement(direction, -1.0)?];
        let turns_against = 1.0 - right > NO_COURSE && 1.0 - mirrored < OTHER_SENSE * (1.0 - right);
        let across = right > AGREE && (DRIFT..PI - DRIFT).contains(&off.abs());
        let from_quarter = (turned.abs() - FRAC_PI_2).abs();
        let quarter = from_quarter < DRIFT && from_quarter < OTHER_SENSE * off.abs().min(PI - off.abs());
        (mirrored > AGREE && (turns_against || across && quarter)).then_some(turned)
    }

    /// How a sway velocity, in any unit, agrees with that of the track under headings \[rad\]: from -1, where it is to the other side, to 1.
    pub fn sways(&self, heading: &Signal, sway: &Signal) -> f64 {
        let (mut own, mut both, mut other) = (0.0, 0.0, 0.0);
        for (i, t) in self.north.t.iter().enumerate() {
            let (sin, cos) = heading.at(*t, self.north.step).sin_cos();
            let (across, recorded) = (self.east.v[i] * cos - self.north.v[i] * sin, sway.at(*t, self.north.step));
            if across.is_finite() && recorded.is_finite() {
                own += across * across;
                both += across * recorded;
                other += recorded * recorded;
            }
        }
        if own * other > 0.0 { both / (own * other).sqrt() } else { 0.0 }
    }
}

/// Parts of a log by which the error of a steady angle is measured.
const PARTS: usize = 20;
/// Standard errors by which a steady angle differs from none.
const SURE: f64 = 4.0;
/// The share of the velocity ahead that a current and turning must leave for the angle to be known apart from them: about one heading, or on
/// two that are square, a current across the heading is the same as an angle.
const APART: f64 = 0.2;
/// Columns of its regression.
const COLUMNS: usize = 5;

impl Track {
    /// The one of these factors with which a direction surely goes with the course, as it does with none of the others: a heading that counts
    /// on through full turns has large values in radians, too. `None` where the track does not show it.
    pub fn unit_of_direction(&self, raw: impl Fn(f64) -> Signal, factors: &[f64]) -> Option<f64> {
        let of = |factor: f64| {
            let signal = raw(factor);
            let both = [1.0, -1.0].map(|sense| self.agreement(&signal, sense));
            let length = both.iter().flatten().map(|a| a[0]).fold(0.0, f64::max);
            let along = both[0].is_some_and(|[length, off]| length > AGREE && off.abs() < ALONG);
            (length, along || self.anticlockwise(&signal).is_some())
        };
        let all: Vec<(f64, (f64, bool))> = factors.iter().map(|factor| (*factor, of(*factor))).collect();
        let sure = |a: (f64, bool), b: (f64, bool)| (a.0 > AGREE && a.0 > b.0 + 0.1) || (a.1 && !b.1);
        let best = all.iter().find(|(own, a)| all.iter().all(|(other, b)| own == other || sure(*a, *b)));
        best.map(|(factor, _)| *factor)
    }

    /// The angle from a heading \[rad\] to the course that neither a current nor turning explains; `None` where it is not four standard
    /// errors from nought, and where the headings do not distinguish it from a current.
    ///
    /// The velocity of the track to starboard of the heading is regressed on the velocity ahead (its coefficient is the angle), on yaw rate
    /// and its signed square (drift in turns), and on the starboard components of north and east (a current). The errors are those of
    /// twenty parts of the log against each other, within which what is left over is alike.
    pub fn steady_angle(&self, heading: &Signal) -> Option<f64> {
        use nalgebra::{SMatrix, SVector};
        type Columns = SVector<f64, COLUMNS>;
        let rate = heading.rate(heading.span());
        let mut rows: Vec<(Columns, f64)> = Vec::new();
        for (i, t) in self.speed.t.iter().enumerate().filter(|(i, _)| self.speed.v[*i] > 0.4 * self.fast) {
            let (sin, cos) = heading.at(*t, self.speed.step).sin_cos();
            let turning = rate.at(*t, self.speed.step);
            let (north, east) = (self.north.v[i], self.east.v[i]);
            let (ahead, across) = (north * cos + east * sin, east * cos - north * sin);
            let columns = Columns::from([ahead, turning, turning * turning.abs(), cos, -sin]);
            if across.is_finite() && columns.iter().all(|c| c.is_finite()) {
                rows.push((columns, across));
            }
        }
        let per_part = rows.len() / PARTS;
        if per_part == 0 {
            return None;
        }
        // Each column in units of its size, so that what is small is not taken for what is not there.
        let size = rows.iter().fold(Columns::zeros(), |sum, (c, _)| sum + c.component_mul(c));
        let scale = size.map(|s| if s > 0.0 { (rows.len() as f64 / s).sqrt() } else { 0.0 });
        let mut normal = SMatrix::<f64, COLUMNS, COLUMNS>::zeros();
        let mut right = Columns::zeros();
        for (columns, across) in &rows {
            let columns = columns.component_mul(&scale);
            normal += columns * columns.transpose();
            right += columns * *across;
        }
        let inverse = normal.try_inverse()?;
        if 1.0 < APART * normal[(0, 0)] * inverse[(0, 0)] {
            return None;
        }
        let found = inverse * right;
        let mut spread = SMatrix::<f64, COLUMNS, COLUMNS>::zeros();
        for part in rows.chunks(per_part) {
            let score = part.iter().fold(Columns::zeros(), |sum, (columns, across)| {
                let columns = columns.component_mul(&scale);
                sum + columns * (across - columns.dot(&found))
            });
            spread += score * score.transpose();
        }
        let few = PARTS as f64 / (PARTS - COLUMNS) as f64;
        let error = (few * (inverse * spread * inverse)[(0, 0)]).sqrt() * scale[0];
        let angle = found[0] * scale[0];
        (angle.is_finite() && angle.abs() > SURE * error).then_some(angle)
    }
}

/// Directions agree where the mean of their difference is this long, of 1.
pub const AGREE: f64 = 0.8;
/// A heading goes with the course within this angle on the mean of a log \[rad\]: 14 deg, more than drift, current and variation mostly make.
const ALONG: f64 = 0.25;
/// Which way a ship turns when its rudder is put over: the coefficient b of
/// `r(t + h) - r(t) = a r(t) + b mean(delta over t to t + h) + c`, over its standard error; `None` where it cannot be determined.
pub fn rudder_effect(r: &Signal, delta: &Signal) -> Option<f64> {
    let fast = size_below(&r.v, 0.95);
    if fast <= 0.0 {
        return None;
    }
    // The time in which the ship turns ten degrees.
    let h = (0.17 / fast).clamp(4.0 * r.step, 40.0 * r.step.max(1.0));
    let hop = (0.5 * h / r.step).ceil().max(1.0) as usize;
    let mut rows: Vec<[f64; 4]> = Vec::new();
    for i in (0..r.t.len()).step_by(hop) {
        let later = r.at(r.t[i] + h, r.step);
        let mean = (0..5).map(|k| delta.at(r.t[i] + h * f64::from(k) / 4.0, r.step)).sum::<f64>() / 5.0;
        if later.is_finite() && mean.is_finite() {
            rows.push([r.v[i], mean, 1.0, later - r.v[i]]);
        }
    }
    if rows.len() < 12 {
        return None;
    }
    let mut normal = nalgebra::Matrix3::<f64>::zeros();
    let mut right = nalgebra::Vector3::<f64>::zeros();
    for row in &rows {
        let x = nalgebra::Vector3::new(row[0], row[1], row[2]);
        normal += x * x.transpose();
        right += x * row[3];
    }
    let inverse = normal.try_inverse()?;
    let c = inverse * right;
    let left: f64 = rows.iter().map(|row| (row[3] - c[0] * row[0] - c[1] * row[1] - c[2]).powi(2)).sum();
    let error = (left / (rows.len() - 3) as f64 * inverse[(1, 1)]).sqrt();
    Some(c[1] / error).filter(|t| t.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A zigzag of a first-order ship that turns with the sign of its rudder.
    fn zigzag(sign: f64) -> (Signal, Signal) {
        let (mut r, mut psi, mut side) = (0.0, 0.0_f64, 1.0);
        let mut signals = (Signal { step: 1.0, ..Signal::default() }, Signal { step: 1.0, ..Signal::default() });
        for i in 0..600 {
            if psi * side > 0.35 {
                side = -side;
            }
            r += (0.05 * 0.35 * side - r) / 12.0;
            psi += r;
            for (signal, v) in [(&mut signals.0, r), (&mut signals.1, sign * 0.35 * side)] {
                signal.t.push(f64::from(i));
                signal.v.push(v);
            }
        }
        signals
    }

    #[test]
    fn a_zigzag_shows_the_sign_of_its_rudder() {
        let (r, delta) = zigzag(1.0);
        assert!(rudder_effect(&r, &delta).unwrap() > 10.0);
        let (r, delta) = zigzag(-1.0);
        assert!(rudder_effect(&r, &delta).unwrap() < -10.0);
    }

    /// A ship that weaves about a course, and how her heading \[rad\] is counted; whether that is seen, and from where.
    fn counted(course: f64, weave: f64, count: impl Fn(f64) -> f64) -> Option<f64> {
        let heading: Vec<f64> = (0..200).map(|i| course + weave * (0.05 * f64::from(i)).sin()).collect();
        let t: Vec<f64> = (0..200).map(f64::from).collect();
        let (mut x, mut y) = (vec![0.0], vec![0.0]);
        for (i, psi) in heading.iter().enumerate().take(199) {
            x.push(x[i] + 4.0 * psi.cos());
            y.push(y[i] + 4.0 * psi.sin());
        }
        let signal = |v: Vec<f64>| Signal { t: t.clone(), v, step: 1.0, jitter: 0.0 };
        let track = Track::of(&signal(x), &signal(y)).unwrap();
        track.anticlockwise(&signal(heading.into_iter().map(count).collect()))
    }

    #[test]
    fn a_heading_that_counts_from_east_is_seen_in_small_turns_and_none_and_one_from_north_is_left() {
        for (course, weave) in [(3.3, 0.3), (3.3, 0.0), (0.8, 0.3), (0.2, 0.6), (-2.0, 0.2)] {
            let from_east = counted(course, weave, |psi| FRAC_PI_2 - psi);
            assert!(from_east.is_some_and(|a| (a - FRAC_PI_2).abs() < 0.1), "{course} {weave} {from_east:?}");
            for off in [0.0, 0.3, -0.4] {
                assert_eq!(counted(course, weave, |psi| psi + off), None, "{course} {weave} {off}");
            }
        }
        // From the south, with a turn.
        assert!(counted(1.0, 0.8, |psi| PI - psi).is_some_and(|a| (a.abs() - PI).abs() < 0.1));
    }

    #[test]
    fn rates_do_not_reach_across_gaps() {
        let t: Vec<f64> = (0..20).map(f64::from).chain((100..120).map(f64::from)).collect();
        let s = Signal { v: t.iter().map(|t| if *t < 50.0 { *t } else { -*t }).collect(), t, step: 1.0, jitter: 0.0 };
        let rate = s.rate(8.0);
        assert!(
            rate.v[..20].iter().all(|v| (v - 1.0).abs() < 1e-9) && rate.v[20..].iter().all(|v| (v + 1.0).abs() < 1e-9)
        );
        assert!(ratio(&rate.pairs(&s)).is_some());
    }
}
