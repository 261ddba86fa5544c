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
    /// Position of the recorded point forward of the point whose velocity is recorded \[m\], as sway in turns tells it.
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
