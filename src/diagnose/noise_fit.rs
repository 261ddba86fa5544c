//! The estimate of the noise by maximum likelihood on linearised runs, and a first guess of it from the recordings alone.
//! The ship's parameters are held: they are estimated elsewhere, in turn with the noise.

use super::covariance::{Discrete, Z, initial, predict};
use super::filter::{Tangent, boost};
use super::noise::{GROUP_OF, NOISE_PARAMETERS, Noise, NoisePrior, NoiseScore, SensorNoise};
use super::optimise::{Damping, Outcome, Proposal};
use super::settings::{NOISE_STEP_GAIN, NOISE_STEP_LONGEST};
use crate::model::Model;
use crate::recording::{Run, or_nan};
use crate::state::STATES;
use nalgebra::{SMatrix, SVector};
use rayon::prelude::*;
use trimtab_ad::{Lanes, Scalar};

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
fn noise_score(at: &[Innovation<f64>], nudged: &[Vec<Innovation<Lanes>>; BLOCKS], gate: f64) -> NoiseScore {
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
/// How a step of the logarithms is damped, in units of the information's diagonal.
const DAMPING: Damping = Damping {
    attempts: 6,
    least_promise: NOISE_STEP_GAIN,
    loss: 0.0,
    first: 0.1,
    most: f64::INFINITY,
    shrink: 0.1,
    off: 0.05,
    trusted: 0.0,
};

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
    let fit = NoiseFit { runs, tangents, model, prior, gate };
    let mut v = start.to_log();
    let mut at = fit.innovations(&v);
    let mut value = fit.posterior(&v, &at);
    let mut damping = 0.0;
    for _ in 0..iterations {
        let (score, information) = fit.score(&v, &at);
        let propose = |damping: f64| {
            let mut damped = information;
            (0..N).for_each(|i| damped[(i, i)] *= 1.0 + damping);
            let mut step = damped.cholesky()?.solve(&score);
            let promise = 0.5 * score.dot(&step);
            let longest = step.amax();
            if longest > NOISE_STEP_LONGEST {
                step *= NOISE_STEP_LONGEST / longest;
            }
            Some(Proposal { step, promise })
        };
        let evaluate = |step: &SVector<f64, N>| {
            let w: [f64; N] = std::array::from_fn(|i| v[i] + step[i]);
            let trial = fit.innovations(&w);
            let reached = fit.posterior(&w, &trial);
            ((w, trial), reached)
        };
        let Outcome { taken, .. } = DAMPING.search(value, &mut damping, propose, evaluate);
        let Some(((w, trial), reached)) = taken else { break };
        (v, at, value) = (w, trial, reached);
    }
    Noise::from_log(&v)
}

/// The likelihood of noises on some linearised runs.
struct NoiseFit<'a> {
    runs: &'a [&'a Run],
    tangents: &'a [&'a Tangent],
    model: &'a Model,
    prior: &'a NoisePrior,
    gate: f64,
}

impl NoiseFit<'_> {
    /// Innovations of every run.
    fn innovations(&self, v: &[f64; N]) -> Vec<Vec<Innovation<f64>>> {
        let noise = Noise::from_log(v);
        let one = |(r, t): (&&Run, &&Tangent)| innovations(r, t, &Discrete::new(&noise, r.dt), self.model, self.gate);
        self.runs.par_iter().zip(self.tangents.par_iter()).map(one).collect()
    }

    /// Log-likelihood of innovations plus log-prior.
    fn posterior(&self, v: &[f64; N], innovations: &[Vec<Innovation<f64>>]) -> f64 {
        innovations.iter().map(|i| log_likelihood(i, self.gate)).sum::<f64>() + self.prior.log_density(v)
    }

    /// Score and information of the logarithms, the prior included, by noises nudged eight at a time.
    fn score(&self, v: &[f64; N], at: &[Vec<Innovation<f64>>]) -> NoiseScore {
        let nudged: [Noise; N] = std::array::from_fn(|i| {
            let mut w = *v;
            w[i] += NUDGE;
            Noise::from_log(&w)
        });
        let one = |((r, t), i): ((&&Run, &&Tangent), &Vec<Innovation<f64>>)| {
            let blocks = std::array::from_fn(|block| {
                let some = std::array::from_fn(|lane| Discrete::new(&nudged[block * Lanes::LANES + lane], r.dt));
                innovations(r, t, &Discrete::side_by_side(&some), self.model, self.gate)
            });
            noise_score(i, &blocks, self.gate)
        };
        let parts: Vec<_> = self.runs.par_iter().zip(self.tangents.par_iter()).zip(at.par_iter()).map(one).collect();
        let (mut score, mut information) = self.prior.score(v);
        for (s, h) in &parts {
            score += s;
            information += h;
        }
        (score, information)
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::estimate::passes;
    use crate::diagnose::example::{RK4, model, noise, runs};
    use crate::diagnose::filter::{GATE, Pass};
    use crate::diagnose::settings::FIRST;

    #[test]
    fn the_first_guess_of_a_sensor_is_its_white_scatter() {
        let model = model();
        let found = guess(&runs(&model, 12), &model);
        for (sensor, white) in found.sensors.iter().zip([0.3, 0.002, 0.02, 0.0005]) {
            assert!((sensor.white / white).ln().abs() < 0.15, "{sensor:?} for {white}");
        }
    }

    fn linearised(runs: &[Run]) -> Vec<Pass> {
        passes(&model(), RK4, &[], runs, &noise(), true)
    }

    #[test]
    fn the_score_of_the_logarithms_is_the_slope_of_the_likelihood() {
        let (model, runs, prior) = (model(), runs(&model(), 2), NoisePrior::around(&noise()));
        let passes = linearised(&runs);
        let tangents: Vec<&Tangent> = passes.iter().filter_map(|p| p.tangent.as_ref()).collect();
        let runs: Vec<&Run> = runs.iter().collect();
        let fit = NoiseFit { runs: &runs, tangents: &tangents, model: &model, prior: &prior, gate: f64::INFINITY };
        let mut v = noise().to_log();
        v[9] += 0.2;
        let value = |v: &[f64; N]| fit.posterior(v, &fit.innovations(v));
        let (score, information) = fit.score(&v, &fit.innovations(&v));
        for i in 0..N {
            let at = |d: f64| {
                let mut w = v;
                w[i] += d;
                value(&w)
            };
            let slope = (at(1e-4) - at(-1e-4)) / 2e-4;
            // The score's own derivatives are differences over a hundredth.
            let unit = information[(i, i)].sqrt();
            assert!((score[i] - slope).abs() < 0.05 * unit.max(1.0), "{i}: {} {slope}", score[i]);
        }
    }

    #[test]
    fn a_fit_never_ends_below_where_it_began_and_finds_a_noise_four_times_too_large() {
        let (model, runs) = (model(), runs(&model(), 6));
        let mut start = noise();
        start.sensors.iter_mut().for_each(|s| s.white *= 4.0);
        let prior = NoisePrior::around(&noise());
        let passes = linearised(&runs);
        let tangents: Vec<&Tangent> = passes.iter().filter_map(|p| p.tangent.as_ref()).collect();
        let runs: Vec<&Run> = runs.iter().collect();
        let fit = NoiseFit { runs: &runs, tangents: &tangents, model: &model, prior: &prior, gate: GATE };
        let value = |n: &Noise| fit.posterior(&n.to_log(), &fit.innovations(&n.to_log()));
        let found = fit_noise(&runs, &tangents, &model, &start, &prior, GATE, FIRST.noise_iterations);
        assert!(value(&found) > value(&start) + 100.0);
        for (sensor, white) in found.sensors.iter().zip([0.3, 0.002, 0.02, 0.0005]) {
            assert!((sensor.white / white).ln().abs() < 0.25, "{sensor:?} for {white}");
        }
    }
}
