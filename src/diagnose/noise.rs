//! The noise model behind every statement of the diagnosis: what sensors add, and the force nobody modelled.
//! It says nothing of the ship; its numbers are estimated by maximum likelihood in `fit_noise`.

use super::covariance::{Discrete, Z, initial, predict};
use super::filter::{Tangent, boost};
use crate::model::Model;
use crate::recording::{Run, or_nan};
use crate::state::STATES;
use nalgebra::{SMatrix, SVector};
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

    /// Distance of a logarithm from its belief, and the spread of that belief.
    ///
    /// The scatter of a channel is all of its white noise, or the floor below which it is exact: a filtered channel (a smoothed
    /// gyro) must not become infinitely exact.
    fn away(&self, v: &[f64; NOISE_PARAMETERS], i: usize) -> (f64, f64) {
        let away = v[i] - self.centre[i];
        let white = i < 12 && i.is_multiple_of(3) && away < 0.0;
        (away, if white { 0.05 } else { self.spread[i] })
    }

    fn log_density(&self, v: &[f64; NOISE_PARAMETERS]) -> f64 {
        let of = |i: usize| {
            let (away, spread) = self.away(v, i);
            -0.5 * (away / spread).powi(2)
        };
        (0..NOISE_PARAMETERS).map(of).sum()
    }

    /// Its slope, and its precision as a diagonal matrix.
    fn score(&self, v: &[f64; N]) -> (SVector<f64, N>, SMatrix<f64, N, N>) {
        let precision = SVector::from_fn(|i, _| self.away(v, i).1.powi(-2));
        (SVector::from_fn(|i, _| -self.away(v, i).0 * precision[i]), SMatrix::from_diagonal(&precision))
    }
}

/// An innovation with its variance.
#[derive(Clone, Copy)]
struct Innovation<S> {
    error: S,
    variance: S,
}

/// Innovations of one run under the linearised step maps, for a noise or for eight at once: a Kalman filter without
/// sensitivities. What lies beyond `gate` standard deviations is an outlier, from which the filter learns nothing.
fn innovations<S: Scalar>(
    run: &Run,
    tangent: &Tangent,
    noise: &Discrete<S>,
    model: &Model,
    gate: f64,
) -> Vec<Innovation<S>> {
    let mut out = Vec::with_capacity(run.measured.len() * STATES);
    let gate = S::from_f64(gate * gate);
    let mut z = [S::zero(); Z];
    (0..STATES).for_each(|i| z[i] = S::from_f64(run.initial[i]));
    let mut p = initial(noise, model);
    for k in 0..run.measured.len() {
        for j in 0..STATES {
            let Some(y) = run.measured[k][j] else { continue };
            let mut error = -(z[j] + z[9 + j]) + (y - tangent.offset[k][j]);
            if j == 2 {
                error = trimtab_ad::smooth::wrap_angle(error);
            }
            let ph: [S; Z] = std::array::from_fn(|i| p[j][i] + p[9 + j][i]);
            let variance = noise.white[j] + ph[j] + ph[9 + j];
            let outlier = (gate * variance).less(error * error);
            let inverse = S::select(outlier, S::zero(), S::one() / variance);
            for i in 0..Z {
                let gain = ph[i] * inverse;
                z[i] += gain * error;
                for l in 0..=i {
                    p[i][l] -= gain * ph[l];
                    p[l][i] = p[i][l];
                }
            }
            out.push(Innovation { error, variance });
        }
        if k + 1 == run.measured.len() {
            break;
        }
        z = move_mean(&z, tangent, k, noise);
        predict(&mut p, &tangent.a[k], &tangent.gamma[k], noise, boost(run, k));
    }
    out
}

/// Log-likelihood of innovations: an outlier counts as if it were at the gate.
fn log_likelihood(innovations: &[Innovation<f64>], gate: f64) -> f64 {
    let one = |i: &Innovation<f64>| (i.error * i.error / i.variance).min(gate * gate) + i.variance.ln();
    -0.5 * innovations.iter().map(one).sum::<f64>()
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

/// Score and information of the noise's logarithms in one run, from innovations at a noise and at noises nudged by [`NUDGE`]:
/// `g_i = sum (e^2/s - 1) s_i / (2 s) - e e_i / s`, `H_ij = sum s_i s_j / (2 s^2) + e_i e_j / s`, with `e_i`, `s_i` the
/// derivatives of innovation and variance (Gupta & Mehra 1974, IEEE Trans. Autom. Control 19). Outliers have no part in it.
fn noise_score(
    at: &[Innovation<f64>],
    nudged: &[Vec<Innovation<Lanes>>; BLOCKS],
    gate: f64,
) -> (SVector<f64, N>, SMatrix<f64, N, N>) {
    let (mut score, mut information) = (SVector::<f64, N>::zeros(), SMatrix::<f64, N, N>::zeros());
    for (m, Innovation { error, variance }) in at.iter().enumerate() {
        let square = error * error / variance;
        if square > gate * gate {
            continue;
        }
        let slope = |of: fn(&Innovation<Lanes>) -> Lanes, from: f64, unit: f64| {
            let blocks: [[f64; Lanes::LANES]; BLOCKS] =
                std::array::from_fn(|b| ((of(&nudged[b][m]) - from) * (unit / NUDGE)).to_array());
            SVector::<f64, N>::from_fn(|i, _| blocks[i / Lanes::LANES][i % Lanes::LANES])
        };
        // In units of the standard deviation, and of the variance times the square root of 2.
        let errors = slope(|i| i.error, *error, 1.0 / variance.sqrt());
        let variances = slope(|i| i.variance, *variance, std::f64::consts::FRAC_1_SQRT_2 / variance);
        score += variances * ((square - 1.0) * std::f64::consts::FRAC_1_SQRT_2) - errors * (error / variance.sqrt());
        information.ger(1.0, &errors, &errors, 1.0);
        information.ger(1.0, &variances, &variances, 1.0);
    }
    (score, information)
}

/// How far the logarithms are nudged for derivatives.
const NUDGE: f64 = 0.01;
const N: usize = NOISE_PARAMETERS;
const BLOCKS: usize = N / Lanes::LANES;
/// The furthest that a logarithm moves in one step.
const LONGEST: f64 = 1.5;
/// A noise that promises less than this in log-likelihood is as good.
const ENOUGH: f64 = 0.05;

/// Maximises the log-likelihood over the noise, by Fisher scoring on the logarithms, damped where a step does not hold what it
/// promises. Innovations beyond `gate` standard deviations are outliers.
///
/// The sums over runs are taken in order, so that the result does not depend on the number of threads.
pub fn fit_noise(
    runs: &[&Run],
    tangents: &[&Tangent],
    model: &Model,
    start: &Noise,
    prior: &NoisePrior,
    gate: f64,
    iterations: usize,
) -> Noise {
    let of = |v: &[f64; N]| -> Vec<Vec<Innovation<f64>>> {
        let noise = Noise::from_log(v);
        let one = |(r, t): (&&Run, &&Tangent)| innovations(r, t, &Discrete::new(&noise, r.dt), model, gate);
        runs.par_iter().zip(tangents.par_iter()).map(one).collect()
    };
    let posterior = |v: &[f64; N], innovations: &[Vec<Innovation<f64>>]| -> f64 {
        innovations.iter().map(|i| log_likelihood(i, gate)).sum::<f64>() + prior.log_density(v)
    };
    let mut v = start.to_log();
    let mut at = of(&v);
    let mut value = posterior(&v, &at);
    let mut damping = 0.0;
    for _ in 0..iterations {
        let nudged: [Noise; N] = std::array::from_fn(|i| {
            let mut w = v;
            w[i] += NUDGE;
            Noise::from_log(&w)
        });
        let one = |((r, t), i): ((&&Run, &&Tangent), &Vec<Innovation<f64>>)| {
            let blocks = std::array::from_fn(|block| {
                let some = std::array::from_fn(|lane| Discrete::new(&nudged[block * Lanes::LANES + lane], r.dt));
                innovations(r, t, &Discrete::side_by_side(&some), model, gate)
            });
            noise_score(i, &blocks, gate)
        };
        let parts: Vec<_> = runs.par_iter().zip(tangents.par_iter()).zip(at.par_iter()).map(one).collect();
        let (mut score, mut information) = prior.score(&v);
        for (s, h) in &parts {
            score += s;
            information += h;
        }
        let mut moved = false;
        for _ in 0..6 {
            let mut damped = information;
            (0..N).for_each(|i| damped[(i, i)] *= 1.0 + damping);
            let Some(mut step) = damped.cholesky().map(|c| c.solve(&score)) else { break };
            if 0.5 * score.dot(&step) < ENOUGH {
                break;
            }
            let longest = step.amax();
            if longest > LONGEST {
                step *= LONGEST / longest;
            }
            let w: [f64; N] = std::array::from_fn(|i| v[i] + step[i]);
            let trial = of(&w);
            let reached = posterior(&w, &trial);
            if reached.is_finite() && reached > value {
                (v, at, value) = (w, trial, reached);
                damping = if damping > 0.1 { 0.1 * damping } else { 0.0 };
                moved = true;
                break;
            }
            damping = f64::max(0.1, 10.0 * damping);
        }
        if !moved {
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
                    let w: Vec<[f64; STATES]> = w.iter().map(or_nan).collect();
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
