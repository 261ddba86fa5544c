//! One measured quantity with its own times, and its values at the times of others.
//! A value is never carried across a drop-out: between samples further apart than one and a half of the quantity's own steps it is missing.

use super::log::Column;
use std::f64::consts::{PI, TAU};

/// Steps longer than this many usual ones are gaps, as in a recording.
pub const GAP_IN_STEPS: f64 = 1.5;
/// Uneven steps are gaps from one and this many times the share by which a quarter of them differs: where each time is off by up to half
/// a step that share is a half, and the longest step is two.
const OF_JITTER: f64 = 2.5;
/// No step of more usual ones than this is even enough: between is at least one sample that is missing.
const MOST_IN_STEPS: f64 = 2.5;
/// Times closer than this are one \[s\].
const SAME_TIME: f64 = 1e-6;

/// A quantity over time.
#[derive(Clone, Debug, Default)]
pub struct Signal {
    /// Times, rising \[s\].
    pub t: Vec<f64>,
    /// Values, finite; an angle is unwrapped.
    pub v: Vec<f64>,
    /// Usual step: the median \[s\].
    pub step: f64,
    /// How uneven the steps are: a quarter of them differs from the usual one by more than this share.
    pub jitter: f64,
}

/// What was put in order to make a signal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tidied {
    /// Samples that came before an earlier one.
    pub out_of_order: usize,
    /// Samples with the time of another, which are left out.
    pub repeated: usize,
}

impl Signal {
    /// The samples of columns in the order of their times, each as `factor * value + offset`; `wraps` for an angle \[rad\].
    pub fn new(columns: &[&Column], factor: f64, offset: f64, wraps: bool) -> (Self, Tidied) {
        let mut samples: Vec<[f64; 2]> = Vec::new();
        for column in columns {
            samples.extend(column.t.iter().zip(&column.v).map(|(t, v)| [*t, factor * v + offset]));
        }
        let out_of_order = samples.windows(2).filter(|s| s[1][0] < s[0][0] - SAME_TIME).count();
        samples.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let before = samples.len();
        samples.dedup_by(|later, first| later[0] - first[0] < SAME_TIME);
        let (t, mut v): (Vec<f64>, Vec<f64>) = samples.iter().map(|s| (s[0], s[1])).unzip();
        if wraps {
            unwrap(&mut v);
        }
        let steps: Vec<f64> = t.windows(2).map(|t| t[1] - t[0]).collect();
        let step = median(steps.clone()).unwrap_or(0.0);
        let off: Vec<f64> = steps.iter().map(|s| s / step - 1.0).collect();
        (Self { step, jitter: size_below(&off, 0.75), t, v }, Tidied { out_of_order, repeated: before - samples.len() })
    }

    /// A longer step is a gap \[s\].
    pub fn longest_step(&self) -> f64 {
        self.step * (1.0 + OF_JITTER * self.jitter).clamp(GAP_IN_STEPS, MOST_IN_STEPS) + SAME_TIME
    }

    /// Whether its times are so uneven that a step of one and a half is no gap.
    pub fn is_uneven(&self) -> bool {
        1.0 + OF_JITTER * self.jitter > GAP_IN_STEPS + 0.01
    }

    /// One of the same steps that has no samples.
    pub fn without_samples(&self) -> Self {
        Self { t: Vec::new(), v: Vec::new(), ..*self }
    }

    /// The value at a time: that of a sample, the mean over `width` seconds of samples that are closer together than that, or a
    /// straight line between two successive samples; NaN in a drop-out and outside.
    pub fn at(&self, t: f64, width: f64) -> f64 {
        let after = self.t.partition_point(|s| *s < t - SAME_TIME);
        if self.step < 0.7 * width
            && let Some(mean) = self.mean(t, width, after)
        {
            return mean;
        }
        match (self.t.get(after), after.checked_sub(1)) {
            (Some(next), _) if (next - t).abs() <= SAME_TIME => self.v[after],
            (Some(next), Some(before)) if next - self.t[before] <= self.longest_step() => {
                let share = (t - self.t[before]) / (next - self.t[before]);
                self.v[before] + share * (self.v[after] - self.v[before])
            }
            _ => f64::NAN,
        }
    }

    /// The mean over an interval that has a sample near each of its ends and no gap.
    fn mean(&self, t: f64, width: f64, near: usize) -> Option<f64> {
        let (mut from, mut to) = (near, near);
        while from > 0 && self.t[from - 1] >= t - 0.5 * width - SAME_TIME {
            from -= 1;
        }
        while to < self.t.len() && self.t[to] < t + 0.5 * width - SAME_TIME {
            to += 1;
        }
        let inside = self.t.get(from..to)?;
        let unbroken = inside.windows(2).all(|s| s[1] - s[0] <= self.longest_step());
        let centred = inside.first()? + inside.last()?;
        if inside.len() < 2 || !unbroken || (0.5 * centred - t).abs() > 0.6 * self.step {
            return None;
        }
        Some(self.v[from..to].iter().sum::<f64>() / inside.len() as f64)
    }

    /// Whether a sample is closer than `distance` to a time.
    pub fn has_near(&self, t: f64, distance: f64) -> bool {
        let after = self.t.partition_point(|s| *s < t);
        let near = |i: usize| self.t.get(i).is_some_and(|s| (s - t).abs() < distance);
        near(after) || after.checked_sub(1).is_some_and(near)
    }
}

/// Takes the jumps of whole turns out of an angle \[rad\].
pub fn unwrap(v: &mut [f64]) {
    for i in 1..v.len() {
        v[i] = v[i - 1] + nearest(v[i] - v[i - 1]);
    }
}

/// The same angle within half a turn either way \[rad\].
pub fn nearest(angle: f64) -> f64 {
    let turned = (angle + PI).rem_euclid(TAU) - PI;
    if turned.is_finite() { turned } else { 0.0 }
}

/// The middle value; `None` of nothing.
pub fn median(mut values: Vec<f64>) -> Option<f64> {
    if values.is_empty() {
        return None;
    }
    let middle = values.len() / 2;
    Some(*values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// The value below which a share of the sizes lies.
pub fn size_below(values: &[f64], share: f64) -> f64 {
    let mut sizes: Vec<f64> = values.iter().map(|v| v.abs()).filter(|v| v.is_finite()).collect();
    if sizes.is_empty() {
        return 0.0;
    }
    let at = ((sizes.len() - 1) as f64 * share) as usize;
    *sizes.select_nth_unstable_by(at, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn signal(samples: &[(f64, f64)], wraps: bool) -> Signal {
        let (t, v) = samples.iter().copied().unzip();
        Signal::new(&[&Column { t, v, ..Column::default() }], 1.0, 0.0, wraps).0
    }

    #[test]
    fn values_are_given_between_samples_and_not_across_a_drop_out() {
        let s = signal(&[(0.0, 0.0), (1.0, 1.0), (2.0, 2.0), (3.0, 3.0), (6.0, 6.0), (7.0, 7.0)], false);
        assert_eq!((s.step, s.at(2.0, 1.0), s.at(1.25, 1.0)), (1.0, 2.0, 1.25));
        assert!(s.at(4.0, 1.0).is_nan() && s.at(-0.5, 1.0).is_nan() && s.at(7.5, 1.0).is_nan());
        assert_eq!(s.at(6.0, 1.0), 6.0);
    }

    #[test]
    fn fast_samples_become_their_mean_over_a_step() {
        let samples: Vec<(f64, f64)> =
            (0..40).map(|i| (0.1 * f64::from(i), 0.1 * f64::from(i) + f64::from(i % 2))).collect();
        let s = signal(&samples, false);
        assert!((s.at(2.0, 1.0) - 2.45).abs() < 0.01, "{}", s.at(2.0, 1.0));
    }

    #[test]
    fn samples_are_put_in_order_and_repeats_left_out() {
        let column = Column { t: vec![1.0, 0.0, 2.0, 2.0], v: vec![6.2, 6.1, 0.1, 0.3], ..Column::default() };
        let (s, tidied) = Signal::new(&[&column], 1.0, 0.0, true);
        assert_eq!(tidied, Tidied { out_of_order: 1, repeated: 1 });
        assert_eq!(s.t, [0.0, 1.0, 2.0]);
        assert!((s.v[2] - 0.1 - TAU).abs() < 1e-12);
    }
}
