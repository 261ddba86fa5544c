//! Sensor noise of real logs: white and first-order coloured parts, dropouts and outliers.
//! It changes the reported states only; sensor defects are effects (`effects::sensor`).

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use serde::Serialize;

use super::track::PERIOD;

/// Noise of the six channels `[x, y, psi, u, v, r]` of one data set.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Noise {
    /// Standard deviation of all noise, SI.
    pub sigma: [f64; 6],
    /// Share of its variance that is coloured.
    pub coloured: [f64; 6],
    /// Correlation times \[s\].
    pub time: [f64; 6],
    /// Chance of an outlier in a row, for position and for heading.
    pub outliers: f64,
    /// Expected dropouts in a run, of one to three rows each.
    pub dropouts: f64,
}

/// Reported rows with noise; a dropped row is missing.
pub type Rows = Vec<Option<[f64; 6]>>;

impl Noise {
    /// Ordinary sensors: 0.5 m, 0.1 deg, 0.04 m/s, 0.02 deg/s, 64 % of the variance coloured with times of 5 to 20 s that `rng`
    /// draws, and a dropout in every tenth run.
    pub fn ordinary(rng: &mut ChaCha8Rng) -> Self {
        let degree = std::f64::consts::PI / 180.0;
        Self {
            sigma: [0.5, 0.5, 0.1 * degree, 0.04, 0.04, 0.02 * degree],
            coloured: [0.64; 6],
            time: std::array::from_fn(|_| rng.random_range(5.0..20.0)),
            outliers: 0.0,
            dropouts: 0.1,
        }
    }

    /// The reported states of a run with noise, from a stream of the run's own.
    pub fn apply(&self, reported: &[[f64; 6]], rng: &mut ChaCha8Rng) -> Rows {
        let mut draw = || -> f64 { StandardNormal.sample(rng) };
        let mut slow: [f64; 6] = std::array::from_fn(|_| draw());
        let mut rows: Rows = Vec::with_capacity(reported.len());
        for y in reported {
            let mut y = *y;
            for i in 0..6 {
                let white = (1.0 - self.coloured[i]).sqrt() * draw();
                y[i] += self.sigma[i] * (self.coloured[i].sqrt() * slow[i] + white);
                let keep = (-PERIOD / self.time[i]).exp();
                slow[i] = keep * slow[i] + (1.0 - keep * keep).sqrt() * draw();
            }
            rows.push(Some(y));
        }
        // Drawn after the noise, from a stream of their own, so that dropouts change no other value.
        let mut extra = ChaCha8Rng::seed_from_u64(rng.random());
        self.outliers(&mut rows, &mut extra);
        self.dropouts(&mut rows, &mut extra);
        rows
    }

    fn outliers(&self, rows: &mut Rows, rng: &mut ChaCha8Rng) {
        for y in rows.iter_mut().flatten() {
            if rng.random_range(0.0..1.0) < self.outliers {
                let (far, bearing) = (rng.random_range(10.0..50.0), rng.random_range(0.0..std::f64::consts::TAU));
                y[0] += far * f64::cos(bearing);
                y[1] += far * f64::sin(bearing);
            }
            if rng.random_range(0.0..1.0) < self.outliers {
                y[2] += rng.random_range(-0.15..0.15);
            }
        }
    }

    fn dropouts(&self, rows: &mut Rows, rng: &mut ChaCha8Rng) {
        let mut left = self.dropouts;
        while left > 0.0 {
            if rng.random_range(0.0..1.0) < left {
                // Never the first or last rows: a run starts and ends with a measurement.
                let first = rng.random_range(5..rows.len().saturating_sub(10).max(6));
                for row in rows.iter_mut().skip(first).take(rng.random_range(1..=3)) {
                    *row = None;
                }
            }
            left -= 1.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(noise: &Noise, rows: usize) -> Rows {
        let mut rng = ChaCha8Rng::seed_from_u64(11);
        noise.apply(&vec![[0.0; 6]; rows], &mut rng)
    }

    #[test]
    fn ordinary_noise_has_its_standard_deviations_and_correlation() {
        let mut noise = Noise::ordinary(&mut ChaCha8Rng::seed_from_u64(1));
        (noise.time, noise.dropouts) = ([10.0; 6], 0.0);
        let rows: Vec<[f64; 6]> = sample(&noise, 100_000).into_iter().flatten().collect();
        for i in 0..6 {
            let n = rows.len() as f64;
            let variance = rows.iter().map(|y| y[i] * y[i]).sum::<f64>() / n;
            assert!((variance.sqrt() / noise.sigma[i] - 1.0).abs() < 0.03, "channel {i}");
            for lag in [1, 5] {
                let found = rows.windows(lag + 1).map(|w| w[0][i] * w[lag][i]).sum::<f64>() / n / variance;
                let expected = 0.64 * (-(lag as f64) * PERIOD / 10.0).exp();
                assert!((found - expected).abs() < 0.03, "channel {i} lag {lag}: {found} not {expected}");
            }
        }
    }

    #[test]
    fn correlation_times_lie_between_5_and_20_seconds() {
        let noise = Noise::ordinary(&mut ChaCha8Rng::seed_from_u64(2));
        assert!(noise.time.iter().all(|t| (5.0..20.0).contains(t)));
    }

    #[test]
    fn dropouts_and_outliers_have_the_rates_asked_for_and_change_no_other_row() {
        let mut noise = Noise::ordinary(&mut ChaCha8Rng::seed_from_u64(3));
        noise.dropouts = 0.0;
        let clean = sample(&noise, 10_000);
        noise.dropouts = 30.0;
        let holes = sample(&noise, 10_000);
        let missing = holes.iter().filter(|r| r.is_none()).count();
        assert!((30..=90).contains(&missing), "{missing}");
        assert!(holes.iter().zip(&clean).all(|(a, b)| a.is_none() || a == b));
        (noise.dropouts, noise.outliers) = (0.0, 0.01);
        let wild = sample(&noise, 10_000);
        let far = wild.iter().zip(&clean).filter(|(a, b)| a.map(|y| y[0]) != b.map(|y| y[0])).count();
        assert!((60..=140).contains(&far), "{far}");
    }
}
