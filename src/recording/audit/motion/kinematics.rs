//! How well the channels of a recording agree with one another, in numbers: gains, angles, lags, a lever.
//! What a number says about units, signs or clocks is decided where it is computed.

use serde::Serialize;

/// How well position, velocity, heading and yaw rate agree with one another. A gain is what the derivative of the first is, as a
/// multiple of the second: 1 when all is well, -1 for a sign, 57.3 for degrees, 1.94 for knots.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Kinematics {
    /// Length of the local quadratic fits that differentiate position and heading \[s\].
    pub span: f64,
    /// Root mean square of d(position)/dt less the velocity turned by the heading \[m/s\].
    pub velocity_rms: Option<f64>,
    /// Gain of the track's velocity on the recorded one.
    pub velocity_gain: Option<f64>,
    /// Angle by which the track's velocity is turned clockwise from the recorded one \[rad\].
    pub track_angle: Option<f64>,
    /// Cosine of similarity of the two, 0 to 1.
    pub velocity_coherence: Option<f64>,
    /// Time by which velocity lags behind the track \[s\].
    pub velocity_lag: Option<f64>,
    /// Position of the recorded point forward of the point whose velocity is recorded \[m\], estimated from sway in turns.
    pub lever: Option<f64>,
    /// Root mean square of d(psi)/dt less r \[rad/s\].
    pub yaw_rate_rms: Option<f64>,
    /// Gain of d(psi)/dt on r.
    pub yaw_rate_gain: Option<f64>,
    /// Time by which r lags behind d(psi)/dt \[s\].
    pub yaw_rate_lag: Option<f64>,
}

/// `a` as a multiple of `b`, least squares without offset, from sums over any number of stretches.
#[derive(Clone, Copy, Debug, Default)]
pub struct Proportion {
    aa: f64,
    ab: f64,
    bb: f64,
    difference: f64,
    count: f64,
}

impl Proportion {
    /// Adds pairs; those with a missing value do not count.
    pub fn add(&mut self, a: &[f64], b: &[f64]) {
        for (a, b) in a.iter().zip(b).filter(|(a, b)| a.is_finite() && b.is_finite()) {
            self.aa += a * a;
            self.ab += a * b;
            self.bb += b * b;
            self.difference += (a - b) * (a - b);
            self.count += 1.0;
        }
    }

    /// True once both have a value other than 0.
    pub fn known(&self) -> bool {
        self.aa > 0.0 && self.bb > 0.0
    }

    /// `sum a b / sum b^2`.
    pub fn gain(&self) -> f64 {
        self.ab / self.bb
    }

    /// Whether the gain differs from 1 by more than a share, whichever of the two has the noise: noise in `b` pulls `sum a b / sum b^2`
    /// towards zero, noise in `a` pulls `sum a^2 / sum a b` away from it, and the gain lies between the two (Frisch's bounds; positive
    /// gains).
    pub fn is_off(&self, share: f64) -> bool {
        let (low, high) = (self.ab / self.bb, self.aa / self.ab);
        low > 1.0 + share || high < 1.0 - share
    }

    /// Cosine of similarity, -1 to 1.
    pub fn coherence(&self) -> f64 {
        self.ab / (self.aa * self.bb).sqrt()
    }

    /// Root mean square of `a - b`.
    pub fn rms(&self) -> f64 {
        (self.difference / self.count).sqrt()
    }

    /// Root mean square of `a`.
    pub fn rms_a(&self) -> f64 {
        (self.aa / self.count).sqrt()
    }

    /// Root mean square of `b`.
    pub fn rms_b(&self) -> f64 {
        (self.bb / self.count).sqrt()
    }

    /// Root mean square of `a + b`.
    pub fn rms_sum(&self) -> f64 {
        ((self.aa + 2.0 * self.ab + self.bb).max(0.0) / self.count).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_in_one_of_two_equal_series_is_no_gain_and_a_gain_is_found_through_it() {
        let motion: Vec<f64> = (0..400).map(|i| (0.05 * f64::from(i)).sin()).collect();
        let noise = |i: usize| if i.is_multiple_of(2) { 0.3 } else { -0.3 };
        let noisy: Vec<f64> = motion.iter().enumerate().map(|(i, m)| m + noise(i)).collect();
        let of = |a: &[f64], b: &[f64]| {
            let mut p = Proportion::default();
            p.add(a, b);
            p
        };
        assert!(of(&motion, &noisy).gain() < 0.9 && !of(&motion, &noisy).is_off(0.1));
        assert!(of(&noisy, &motion).aa / of(&noisy, &motion).ab > 1.1 && !of(&noisy, &motion).is_off(0.1));
        let twice: Vec<f64> = noisy.iter().map(|m| 1.3 * m).collect();
        assert!(of(&twice, &motion).is_off(0.1) && of(&motion, &twice).is_off(0.1));
    }
}
