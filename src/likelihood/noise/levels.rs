//! The noise behind every statement of the diagnosis: what sensors add, the force that is not modelled, and a prior of both.
//! It says nothing of the ship; its numbers are estimated in [`super::fit`].

use crate::likelihood::settings::{NOISE_FORCE_SPREAD, NOISE_SIZE_SPREAD, NOISE_TIME_SPREAD, NOISE_WHITE_SPREAD};
use nalgebra::{SMatrix, SVector};
use serde::{Deserialize, Serialize};

/// Measured channels share their noise in groups: position, heading, speed, yaw rate.
pub const GROUPS: [&str; 4] = ["position", "heading", "speed", "yaw rate"];

/// The group of each of the channels x, y, psi, u, v, r.
pub const GROUP_OF: [usize; 6] = [0, 0, 1, 2, 2, 3];

/// Number of noise parameters.
pub const NOISE_PARAMETERS: usize = 16;

/// Noise of one sensor group: white noise plus first-order coloured noise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SensorNoise {
    /// Standard deviation of the white part \[unit of the channel\].
    pub white: f64,
    /// Standard deviation of the coloured part \[unit of the channel\].
    pub coloured: f64,
    /// Correlation time of the coloured part \[s\].
    pub time: f64,
}

/// Sensor noise by group, and an unknown force as a first-order Gauss-Markov (Ornstein-Uhlenbeck) process an equation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Noise {
    /// Sensor noise of the groups in [`GROUPS`].
    pub sensors: [SensorNoise; 4],
    /// Standard deviation of the unknown force in X, Y \[N\] and N \[N m\].
    pub force: [f64; 3],
    /// Its correlation time \[s\].
    pub force_time: f64,
}

impl Noise {
    /// The logarithms that are estimated.
    pub fn to_log(&self) -> [f64; NOISE_PARAMETERS] {
        let mut v = [0.0; NOISE_PARAMETERS];
        for (g, s) in self.sensors.iter().enumerate() {
            v[3 * g] = s.white.ln();
            v[3 * g + 1] = s.coloured.ln();
            v[3 * g + 2] = s.time.ln();
        }
        for (i, f) in self.force.iter().enumerate() {
            v[12 + i] = f.ln();
        }
        v[15] = self.force_time.ln();
        v
    }

    /// Standard deviation of the mean of the unknown force over a time `t` \[s\], in X, Y \[N\] and N \[N m\]: `s sqrt(2 x (1 - x (1 -
    /// exp(-1 / x))))` where its correlation time is `x t`, the integral of its correlation.
    pub fn mean_force(&self, t: f64) -> [f64; 3] {
        let x = self.force_time / t;
        // What is left of two large numbers is all rounding.
        let share = if x < 1e4 { 2.0 * x * (1.0 - x * (1.0 - (-x.recip()).exp())) } else { 1.0 };
        self.force.map(|f| f * share.sqrt())
    }

    /// Back from logarithms.
    pub fn from_log(v: &[f64; NOISE_PARAMETERS]) -> Self {
        Self {
            sensors: std::array::from_fn(|g| SensorNoise {
                white: v[3 * g].exp(),
                coloured: v[3 * g + 1].exp(),
                time: v[3 * g + 2].exp(),
            }),
            force: std::array::from_fn(|i| v[12 + i].exp()),
            force_time: v[15].exp(),
        }
    }
}

/// Score and information of the noise's logarithms.
pub type NoiseScore = (SVector<f64, NOISE_PARAMETERS>, SMatrix<f64, NOISE_PARAMETERS, NOISE_PARAMETERS>);

/// A weak prior of the noise's logarithms, normal in each, for where the data say little.
#[derive(Clone, Copy, Debug)]
pub struct NoisePrior {
    centre: [f64; NOISE_PARAMETERS],
    spread: [f64; NOISE_PARAMETERS],
}

impl NoisePrior {
    /// Centred on a first guess, wide in sizes and times.
    pub fn around(guess: &Noise) -> Self {
        let mut spread = [NOISE_SIZE_SPREAD; NOISE_PARAMETERS];
        for g in 0..4 {
            spread[3 * g + 2] = NOISE_TIME_SPREAD;
        }
        spread[12..15].fill(NOISE_FORCE_SPREAD);
        spread[15] = NOISE_TIME_SPREAD;
        Self { centre: guess.to_log(), spread }
    }

    /// Distance of a logarithm from its prior mean, and the prior's standard deviation.
    ///
    /// The scatter of a channel is all of its white noise, or the floor below which it is exact: a filtered channel (a smoothed
    /// gyro) must not become infinitely exact.
    fn away(&self, v: &[f64; NOISE_PARAMETERS], i: usize) -> (f64, f64) {
        let away = v[i] - self.centre[i];
        let white = i < 12 && i.is_multiple_of(3) && away < 0.0;
        (away, if white { NOISE_WHITE_SPREAD } else { self.spread[i] })
    }

    /// Its logarithm at the logarithms of a noise, up to a constant.
    pub fn log_density(&self, v: &[f64; NOISE_PARAMETERS]) -> f64 {
        let of = |i: usize| {
            let (away, spread) = self.away(v, i);
            -0.5 * (away / spread).powi(2)
        };
        (0..NOISE_PARAMETERS).map(of).sum()
    }

    /// Its slope, and its precision as a diagonal matrix.
    pub fn score(&self, v: &[f64; NOISE_PARAMETERS]) -> NoiseScore {
        let precision = SVector::from_fn(|i, _| self.away(v, i).1.powi(-2));
        (SVector::from_fn(|i, _| -self.away(v, i).0 * precision[i]), SMatrix::from_diagonal(&precision))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise() -> Noise {
        let sensor = |size: f64| SensorNoise { white: size, coloured: 0.7 * size, time: 4.0 };
        Noise { sensors: [1.0, 0.01, 0.1, 0.001].map(sensor), force: [1e3, 2e3, 1e5], force_time: 20.0 }
    }

    #[test]
    fn a_force_that_changes_fast_is_small_in_the_mean_and_a_lasting_one_is_not() {
        let of = |force_time: f64, t: f64| Noise { force_time, ..noise() }.mean_force(t)[1] / 2e3;
        // A white force of the same spectrum is one mean, whatever its correlation time: s sqrt(2 x).
        for x in [1e-4_f64, 1e-3] {
            assert!((of(x * 40.0, 40.0) / (2.0 * x).sqrt() - 1.0).abs() < x);
        }
        assert!((of(40.0, 40.0) - (2.0 * (-1.0_f64).exp()).sqrt()).abs() < 1e-12);
        for x in [9.9e3, 1e5, 1e12] {
            assert!((of(x, 1.0) - 1.0).abs() < 1e-4);
        }
        assert!(of(20.0, f64::INFINITY) < 1e-12);
    }

    #[test]
    fn logarithms_give_the_noise_back() {
        let (there, back) = (noise(), Noise::from_log(&noise().to_log()));
        let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-14;
        assert!(near(there.sensors[1].coloured, back.sensors[1].coloured) && near(there.force[2], back.force[2]));
        assert!(near(there.force_time, back.force_time));
    }

    #[test]
    fn the_prior_has_its_maximum_at_the_guess_and_its_score_is_its_slope() {
        let prior = NoisePrior::around(&noise());
        let centre = noise().to_log();
        assert_eq!((prior.log_density(&centre), prior.score(&centre).0.amax()), (0.0, 0.0));
        let mut v = centre;
        v[1] += 0.3;
        v[14] -= 1.0;
        let (score, information) = prior.score(&v);
        for i in 0..NOISE_PARAMETERS {
            let at = |d: f64| {
                let mut w = v;
                w[i] += d;
                prior.log_density(&w)
            };
            // Above the guess for the white parts, whose prior is another below it.
            let d = 1e-4;
            let slope = if v[i] == centre[i] { 0.0 } else { (at(d) - at(-d)) / (2.0 * d) };
            assert!((score[i] - slope).abs() < 1e-8, "{i}");
            assert!(information[(i, i)] > 0.0);
        }
    }

    #[test]
    fn white_noise_is_kept_near_its_guess_from_below() {
        let prior = NoisePrior::around(&noise());
        let at = |d: f64| {
            let mut v = noise().to_log();
            v[0] += d;
            prior.log_density(&v)
        };
        assert!(at(-0.5) < -40.0 && at(0.5) > -0.1);
    }
}
