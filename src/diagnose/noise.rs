//! The noise model behind every statement of the diagnosis: what sensors add, and the force nobody modelled.
//! It says nothing of the ship; its numbers are estimated by maximum likelihood in `fit_noise`.

use super::covariance::{Discrete, Z, initial, predict};
use super::filter::{GATE, Run, Tangent};
use crate::model::Model;
use crate::state::STATES;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use serde::Serialize;
use trimtab_ad::{Lanes, Scalar};

/// Measured channels share their noise in groups: position, heading, speed, yaw rate.
pub const GROUPS: [&str; 4] = ["position", "heading", "speed", "yaw rate"];

/// The group of each of the channels x, y, psi, u, v, r.
pub const GROUP_OF: [usize; 6] = [0, 0, 1, 2, 2, 3];

/// Number of noise parameters.
pub const NOISE_PARAMETERS: usize = 16;

/// Noise of one sensor group: white noise plus first-order coloured noise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SensorNoise {
    /// Standard deviation of the white part \[unit of the channel\].
    pub white: f64,
    /// Standard deviation of the coloured part \[unit of the channel\].
    pub coloured: f64,
    /// Correlation time of the coloured part \[s\].
    pub time: f64,
}

/// Sensor noise by group, and an unknown force as a first-order Gauss-Markov (Ornstein-Uhlenbeck) process an equation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
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

/// Bounds and weak beliefs that keep the estimation of noise from wandering where the data say nothing.
#[derive(Clone, Copy, Debug)]
pub struct NoisePrior {
    centre: [f64; NOISE_PARAMETERS],
    spread: [f64; NOISE_PARAMETERS],
}

impl NoisePrior {
    /// Centred on a first guess, wide: a factor of about 4 (one standard deviation) on sizes, 3 on times.
    pub fn around(guess: &Noise) -> Self {
        let mut spread = [1.4; NOISE_PARAMETERS];
        for g in 0..4 {
            spread[3 * g + 2] = 0.7;
        }
        spread[12..15].fill(2.5);
        spread[15] = 0.7;
        Self { centre: guess.to_log(), spread }
    }

    fn log_density(&self, v: &[f64; NOISE_PARAMETERS]) -> f64 {
        (0..NOISE_PARAMETERS)
            .map(|i| {
                // The scatter of a channel is all of its white noise, or the floor below which it is exact: a filtered channel
                // (a smoothed gyro) must not become infinitely exact.
                let white = i < 12 && i % 3 == 0 && v[i] < self.centre[i];
                let spread = if white { 0.05 } else { self.spread[i] };
                -0.5 * ((v[i] - self.centre[i]) / spread).powi(2)
            })
            .sum()
    }
}

/// Log-likelihood of one run under the linearised step maps, for a noise or for eight at once: a Kalman filter without
/// sensitivities.
fn log_likelihood<S: Scalar>(run: &Run, tangent: &Tangent, noise: &Discrete<S>, model: &Model) -> S {
    let mut z = [S::zero(); Z];
    (0..STATES).for_each(|i| z[i] = S::from_f64(run.initial[i]));
    let mut p = initial(noise, model);
    let mut total = S::zero();
    for k in 0..run.measured.len() {
        for j in 0..STATES {
            let y = run.measured[k][j];
            if !run.channels[j] || !y.is_finite() {
                continue;
            }
            let mut e = -(z[j] + z[9 + j]) + (y - tangent.offset[k][j]);
            if j == 2 {
                e = trimtab_ad::smooth::wrap_angle(e);
            }
            let ph: [S; Z] = std::array::from_fn(|i| p[j][i] + p[9 + j][i]);
            let s = noise.white[j] + ph[j] + ph[9 + j];
            // An outlier counts as if it were at the gate, and teaches nothing.
            let square = e * e / s;
            let gate = S::from_f64(GATE * GATE);
            let outlier = gate.less(square);
            total -= (S::select(outlier, gate, square) + s.ln()) * 0.5;
            let inverse = S::select(outlier, S::zero(), S::one() / s);
            for i in 0..Z {
                let gain = ph[i] * inverse;
                z[i] += gain * e;
                for l in 0..=i {
                    p[i][l] -= gain * ph[l];
                    p[l][i] = p[i][l];
                }
            }
        }
        if k + 1 == run.measured.len() {
            break;
        }
        z = move_mean(&z, tangent, k, noise);
        predict(&mut p, &tangent.a[k], &tangent.gamma[k], noise, run.boost(k));
    }
    total
}

/// The mean one sample later under the linearised step map.
fn move_mean<S: Scalar>(z: &[S; Z], tangent: &Tangent, k: usize, noise: &Discrete<S>) -> [S; Z] {
    let mut next = [S::zero(); Z];
    for i in 0..STATES {
        next[i] = S::from_f64(tangent.image[k][i]);
        for l in 0..STATES {
            next[i] += (z[l] - tangent.state[k][l]) * tangent.a[k][i][l];
        }
        for l in 0..3 {
            next[i] += z[6 + l] * tangent.gamma[k][i][l];
        }
    }
    for i in 0..3 {
        next[6 + i] = noise.fade * z[6 + i];
    }
    for j in 0..STATES {
        next[9 + j] = noise.rho[j] * z[9 + j];
    }
    next
}

/// Maximises the log-likelihood over the noise, by BFGS on the logarithms with differences for gradients.
///
/// The sums over runs are taken in order, so that the result does not depend on the number of threads.
pub fn fit_noise(
    runs: &[&Run],
    tangents: &[&Tangent],
    model: &Model,
    start: &Noise,
    prior: &NoisePrior,
    iterations: usize,
) -> Noise {
    const STEP: f64 = 0.02;
    const N: usize = NOISE_PARAMETERS;
    let objective = |v: &[f64; N]| -> f64 {
        let noise = Noise::from_log(v);
        let part = |(r, t): (&&Run, &&Tangent)| log_likelihood(r, t, &Discrete::new(&noise, r.dt), model);
        let parts: Vec<f64> = runs.par_iter().zip(tangents.par_iter()).map(part).collect();
        -(parts.iter().sum::<f64>() + prior.log_density(v))
    };
    let gradient = |v: &[f64; N], f: f64| -> [f64; N] {
        let nudged: [[f64; N]; N] = std::array::from_fn(|i| {
            let mut w = *v;
            w[i] += STEP;
            w
        });
        let noises = nudged.map(|w| Noise::from_log(&w));
        let part = |(r, t): (&&Run, &&Tangent)| -> [Lanes; N / Lanes::LANES] {
            std::array::from_fn(|block| {
                let some = std::array::from_fn(|lane| Discrete::new(&noises[block * Lanes::LANES + lane], r.dt));
                log_likelihood(r, t, &Discrete::side_by_side(&some), model)
            })
        };
        let parts: Vec<_> = runs.par_iter().zip(tangents.par_iter()).map(part).collect();
        std::array::from_fn(|i| {
            let likelihood: f64 = parts.iter().map(|p| p[i / Lanes::LANES].lane(i % Lanes::LANES)).sum();
            (-(likelihood + prior.log_density(&nudged[i])) - f) / STEP
        })
    };
    let mut v = start.to_log();
    let mut f = objective(&v);
    let mut g = DVector::from_column_slice(&gradient(&v, f));
    let mut inverse = DMatrix::<f64>::identity(N, N) * (0.5 / g.amax().max(1.0));
    for _ in 0..iterations {
        let mut direction = -(&inverse * &g);
        let longest = direction.amax();
        if longest > 1.5 {
            direction *= 1.5 / longest;
        }
        let slope = direction.dot(&g);
        if slope > -0.05 {
            break;
        }
        let mut length = 1.0;
        let mut accepted = None;
        for _ in 0..6 {
            let w: [f64; N] = std::array::from_fn(|i| v[i] + length * direction[i]);
            let value = objective(&w);
            if value.is_finite() && value <= f + 1e-4 * length * slope {
                accepted = Some((w, value));
                break;
            }
            length *= 0.35;
        }
        let Some((w, value)) = accepted else { break };
        let next = DVector::from_column_slice(&gradient(&w, value));
        let (s, y) = (&direction * length, &next - &g);
        let sy = s.dot(&y);
        if sy > 1e-10 {
            let rho = 1.0 / sy;
            let hy = &inverse * &y;
            let yhy = y.dot(&hy);
            inverse +=
                (&s * s.transpose()) * (rho * (1.0 + rho * yhy)) - (&hy * s.transpose() + &s * hy.transpose()) * rho;
        }
        let gain = f - value;
        (v, f, g) = (w, value, next);
        if gain < 0.05 {
            break;
        }
    }
    Noise::from_log(&v)
}

/// A first guess of the noise from the recordings alone: high-frequency scatter of each channel, and a force that would
/// move the ship by a tenth of its typical accelerations.
pub fn guess(runs: &[Run], model: &Model) -> Noise {
    let scatter = |channels: &[usize]| {
        let mut sizes: Vec<f64> = runs
            .iter()
            .flat_map(|r| {
                r.measured.windows(4).flat_map(move |w| {
                    channels
                        .iter()
                        .map(move |&j| (w[3][j] - 3.0 * w[2][j] + 3.0 * w[1][j] - w[0][j]).abs() / 20f64.sqrt())
                })
            })
            .filter(|v| v.is_finite())
            .collect();
        sizes.sort_by(f64::total_cmp);
        // Median absolute third difference, which a smooth motion hardly has.
        sizes.get(sizes.len() / 2).map_or(0.0, |m| m / 0.6745)
    };
    let l = model.ship.hull.lpp;
    let speed = (9.80665 * l).sqrt();
    // Below these floors a sensor is exact for every purpose of a manoeuvring model.
    let floors = [1e-4 * l, 2e-4, 1e-4 * speed, 1e-4 * speed / l];
    let dt = runs.iter().map(|r| r.dt).fold(f64::INFINITY, f64::min).clamp(1e-3, 60.0);
    let sensors = std::array::from_fn(|g| {
        let channels: Vec<usize> = (0..STATES).filter(|j| GROUP_OF[*j] == g).collect();
        let white = scatter(&channels).max(floors[g]);
        SensorNoise { white, coloured: 0.7 * white, time: 4.0 * dt }
    });
    let mass = model.ship.hull.mass;
    let acceleration = 0.01 * 0.04 * speed * speed / l;
    Noise {
        sensors,
        force: [mass * acceleration, 2.0 * mass * acceleration, 0.3 * mass * acceleration * l],
        force_time: 0.5 * l / (0.2 * speed) + 3.0 * dt,
    }
}
