//! The estimate of the noise by maximum likelihood on linearised runs, and a first guess of it from the recordings alone.
//! The ship's parameters are fixed: they are estimated elsewhere, in turn with the noise.

use super::covariance::{Discrete, Measurement, Z, correct, correct_twice, initial, predict, sum_along, sum_of_rows};
use super::filter::{Tangent, boost};
use super::noise::{GROUP_OF, NOISE_PARAMETERS, Noise, NoisePrior, NoiseScore, SensorNoise};
use super::optimise::{Outcome, Proposal};
use super::settings::{
    COLOURED_GUESS, COLOURED_PERIODS, EXACT_SENSOR, FORCE_GUESS, LITTLE_FORCE, NOISE_DAMPING, NOISE_STEP_LONGEST,
};
use crate::model::Model;
use crate::recording::{Run, or_nan};
use crate::state::STATES;
use crate::units::GRAVITY;
use nalgebra::{SMatrix, SVector};
use rayon::prelude::*;
use trimtab_ad::{Lanes, Scalar};

/// An innovation with its variance.
#[derive(Clone, Copy)]
struct Innovation<S> {
    error: S,
    variance: S,
}

/// The linearised step maps and the measurements that a filter passes over: those of one run for four noises, or of four runs for
/// one noise each.
trait Linearised {
    /// Samples of the longest run.
    fn samples(&self) -> usize;
    /// Where the filter starts.
    fn start(&self) -> [Lanes; STATES];
    /// A measurement less what its sensor reports where the state is zero, and 1 where there is one; `None` without any.
    fn measured(&self, sample: usize, channel: usize) -> Option<(Lanes, Lanes)>;
    /// How the report of a channel changes with the state; `None` where it is the state.
    fn report(&self, sample: usize, channel: usize) -> Option<[Lanes; STATES]>;
    /// Writes the step from a sample to the next.
    fn step(&self, sample: usize, out: &mut Step);
}

/// A linearised step, with the factor on what the unknown force gains in it.
struct Step {
    state: [Lanes; STATES],
    image: [Lanes; STATES],
    a: [[Lanes; STATES]; STATES],
    gamma: [[Lanes; 3]; STATES],
    boost: Lanes,
}

impl Step {
    /// Of zeros.
    fn zero() -> Self {
        let zero = Lanes::zero();
        Self {
            state: [zero; STATES],
            image: [zero; STATES],
            a: [[zero; STATES]; STATES],
            gamma: [[zero; 3]; STATES],
            boost: zero,
        }
    }
}

/// A run with its step maps, the same in every lane.
struct One<'a>(&'a Run, &'a Tangent);

impl Linearised for One<'_> {
    fn samples(&self) -> usize {
        self.0.measured.len()
    }
    fn start(&self) -> [Lanes; STATES] {
        self.0.initial.map(Lanes::from_f64)
    }
    #[inline(always)]
    fn measured(&self, sample: usize, channel: usize) -> Option<(Lanes, Lanes)> {
        let y = self.0.recorded(sample, channel)?;
        Some((Lanes::from_f64(y - self.1.offset[sample][channel]), Lanes::one()))
    }
    #[inline(always)]
    fn report(&self, sample: usize, channel: usize) -> Option<[Lanes; STATES]> {
        Some(self.1.report.get(sample)?[channel].map(Lanes::from_f64))
    }
    #[inline(always)]
    fn step(&self, sample: usize, out: &mut Step) {
        let lift = Lanes::from_f64;
        let Self(run, Tangent { state, image, a, gamma, .. }) = self;
        for i in 0..STATES {
            out.state[i] = lift(state[sample][i]);
            out.image[i] = lift(image[sample][i]);
            (0..STATES).for_each(|l| out.a[i][l] = lift(a[sample][i][l]));
            (0..3).for_each(|l| out.gamma[i][l] = lift(gamma[sample][i][l]));
        }
        out.boost = lift(boost(run, sample));
    }
}

/// Up to four runs with their step maps, one a lane; what a run does not have is 0.
struct Four<'a>(&'a [(&'a Run, &'a Tangent)]);

impl Four<'_> {
    fn gather(&self, of: impl Fn(&Run, &Tangent) -> Option<f64>) -> Lanes {
        Lanes::from_fn(|lane| self.0.get(lane).and_then(|(run, tangent)| of(run, tangent)).unwrap_or(0.0))
    }
}

impl Linearised for Four<'_> {
    fn samples(&self) -> usize {
        self.0.iter().map(|(run, _)| run.measured.len()).max().unwrap_or(0)
    }
    fn start(&self) -> [Lanes; STATES] {
        std::array::from_fn(|i| self.gather(|run, _| Some(run.initial[i])))
    }
    fn measured(&self, sample: usize, channel: usize) -> Option<(Lanes, Lanes)> {
        let has = |run: &Run| run.recorded(sample, channel);
        let error = self.gather(|run, t| Some(has(run)? - t.offset[sample][channel]));
        let some = self.0.iter().any(|(run, _)| has(run).is_some());
        some.then(|| (error, self.gather(|run, _| has(run).map(|_| 1.0))))
    }
    #[inline(always)]
    fn report(&self, sample: usize, channel: usize) -> Option<[Lanes; STATES]> {
        let senses = self.0.iter().any(|(_, t)| !t.report.is_empty());
        senses.then(|| std::array::from_fn(|l| self.gather(|_, t| Some(t.report.get(sample)?[channel][l]))))
    }
    fn step(&self, sample: usize, out: &mut Step) {
        let (none, nowhere, no_force) = ([0.0; STATES], [[0.0; STATES]; STATES], [[0.0; 3]; STATES]);
        let tangent = |lane: usize| self.0.get(lane).map(|(_, tangent)| tangent);
        let state = each_lane(|lane| tangent(lane)?.state.get(sample), &none);
        let image = each_lane(|lane| tangent(lane)?.image.get(sample), &none);
        let a = each_lane(|lane| tangent(lane)?.a.get(sample), &nowhere);
        let gamma = each_lane(|lane| tangent(lane)?.gamma.get(sample), &no_force);
        for i in 0..STATES {
            out.state[i] = Lanes::from_fn(|lane| state[lane][i]);
            out.image[i] = Lanes::from_fn(|lane| image[lane][i]);
            (0..STATES).for_each(|l| out.a[i][l] = Lanes::from_fn(|lane| a[lane][i][l]));
            (0..3).for_each(|l| out.gamma[i][l] = Lanes::from_fn(|lane| gamma[lane][i][l]));
        }
        out.boost = self.gather(|run, _| Some(boost(run, sample)));
    }
}

/// What each lane has, or else `none`.
fn each_lane<'a, T>(of: impl Fn(usize) -> Option<&'a T>, none: &'a T) -> [&'a T; Lanes::LANES] {
    std::array::from_fn(|lane| of(lane).unwrap_or(none))
}

/// Innovations under the linearised step maps, each with a flag by lane, 1 where the lane has one: a Kalman filter without
/// sensitivities. What lies beyond `gate` standard deviations is an outlier, which does not change the filter.
fn innovations<L: Linearised>(
    along: &L,
    noise: &Discrete<Lanes>,
    model: &Model,
    gate: f64,
    mut take: impl FnMut(Innovation<Lanes>, Lanes),
) {
    let gate = Lanes::from_f64(gate * gate);
    let mut z = [Lanes::zero(); Z];
    z[..STATES].copy_from_slice(&along.start());
    let mut p = initial(noise, model);
    let samples = along.samples();
    let mut step = Step::zero();
    // The corrections by measurements of a sample: the covariance is corrected by two at a time, so that one may wait for the next.
    let mut measurements = [Measurement::nothing(); 2];
    for k in 0..samples {
        let mut waiting = false;
        for j in 0..STATES {
            let Some((y, present)) = along.measured(k, j) else { continue };
            let slopes = along.report(k, j);
            let [first, second] = &mut measurements;
            let (before, own) = if waiting { (Some(&*first), second) } else { (None, first) };
            match &slopes {
                Some(slopes) => sum_along(&p, before, slopes, 9 + j, &mut own.ph),
                None => sum_of_rows(&p, before, j, 9 + j, &mut own.ph),
            }
            let seen = |of: &[Lanes; Z]| slopes.as_ref().map_or(of[j], |slopes| product(slopes, of));
            let (reported, spread) = (seen(&z), seen(&own.ph));
            let mut error = -(reported + z[9 + j]) + y;
            if j == 2 {
                error = trimtab_ad::smooth::wrap_angle(error);
            }
            let variance = noise.white[j] + spread + own.ph[9 + j];
            let outlier = (gate * variance).less(error * error);
            let inverse = Lanes::select(outlier, Lanes::zero(), present / variance);
            for i in 0..Z {
                own.gain[i] = own.ph[i] * inverse;
                z[i] += own.gain[i] * error;
            }
            if waiting {
                correct_twice(&mut p, &measurements);
            }
            waiting = !waiting;
            take(Innovation { error, variance }, present);
        }
        if waiting {
            correct(&mut p, &measurements[0]);
        }
        if k + 1 < samples {
            along.step(k, &mut step);
            move_mean(&mut z, &step, noise);
            predict(&mut p, &step.a, &step.gamma, noise, step.boost);
        }
    }
}

/// Slopes by the ship's state times the first entries of a vector.
#[inline(always)]
fn product(slopes: &[Lanes; STATES], of: &[Lanes; Z]) -> Lanes {
    (0..STATES).fold(Lanes::zero(), |sum, l| sum + slopes[l] * of[l])
}

/// Log-likelihood of innovations: an outlier counts as if it were at the gate.
fn log_likelihood(innovations: &[Innovation<f64>], gate: f64) -> f64 {
    let one = |i: &Innovation<f64>| (i.error * i.error / i.variance).min(gate * gate) + i.variance.ln();
    -0.5 * innovations.iter().map(one).sum::<f64>()
}

/// Moves the mean by a sample under the linearised step map.
#[inline(always)]
fn move_mean(z: &mut [Lanes; Z], step: &Step, noise: &Discrete<Lanes>) {
    let mut away = [Lanes::zero(); STATES];
    (0..STATES).for_each(|l| away[l] = z[l] - step.state[l]);
    for i in 0..STATES {
        z[i] = step.image[i];
        (0..STATES).for_each(|l| z[i] += away[l] * step.a[i][l]);
        (0..3).for_each(|l| z[i] += z[6 + l] * step.gamma[i][l]);
    }
    for i in 0..3 {
        z[6 + i] = noise.fade * z[6 + i];
    }
    for j in 0..STATES {
        z[9 + j] = noise.rho[j] * z[9 + j];
    }
}

/// Score and information of the noise's logarithms in one run, from innovations at a noise and at noises nudged by [`NUDGE`]:
/// `g_i = sum (e^2/s - 1) s_i / (2 s) - e e_i / s`, `H_ij = sum s_i s_j / (2 s^2) + e_i e_j / s`, with `e_i`, `s_i` the
/// derivatives of innovation and variance (Gupta & Mehra 1974, IEEE Trans. Autom. Control 19). Outliers have no part in it.
fn noise_score(at: &[Innovation<f64>], nudged: &[Vec<Innovation<Lanes>>; BLOCKS], gate: f64) -> NoiseScore {
    let root = std::f64::consts::FRAC_1_SQRT_2;
    let mut score = [Lanes::zero(); BLOCKS];
    // The lower triangle, four columns side by side.
    let mut information = [[Lanes::zero(); BLOCKS]; N];
    for (m, Innovation { error, variance }) in at.iter().enumerate() {
        let square = error * error / variance;
        if square > gate * gate {
            continue;
        }
        // In units of the standard deviation, and of the variance times the square root of 2.
        let sigma = variance.sqrt();
        let slope = |value: Lanes, from: f64, unit: f64| (value - from) * (unit / NUDGE);
        let errors: [Lanes; BLOCKS] = std::array::from_fn(|b| slope(nudged[b][m].error, *error, 1.0 / sigma));
        let variances: [Lanes; BLOCKS] =
            std::array::from_fn(|b| slope(nudged[b][m].variance, *variance, root / variance));
        for b in 0..BLOCKS {
            score[b] += variances[b] * ((square - 1.0) * root) - errors[b] * (error / sigma);
            let (own_errors, own_variances) = (errors[b].to_array(), variances[b].to_array());
            for lane in 0..Lanes::LANES {
                let (e, s) = (Lanes::from_f64(own_errors[lane]), Lanes::from_f64(own_variances[lane]));
                for (c, sum) in information[b * Lanes::LANES + lane][..=b].iter_mut().enumerate() {
                    *sum = *sum + e * errors[c] + s * variances[c];
                }
            }
        }
    }
    let in_lane = |of: &[Lanes; BLOCKS], i: usize| of[i / Lanes::LANES].lane(i % Lanes::LANES);
    (SVector::from_fn(|i, _| in_lane(&score, i)), SMatrix::from_fn(|i, j| in_lane(&information[i.max(j)], i.min(j))))
}

/// How far the logarithms are nudged for derivatives.
const NUDGE: f64 = 0.01;
const N: usize = NOISE_PARAMETERS;
const BLOCKS: usize = N / Lanes::LANES;
/// Maximises the log-likelihood over the noise, by Fisher scoring on the logarithms, damped where a step gains less than
/// predicted. Innovations beyond `gate` standard deviations are outliers.
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
        let Outcome { taken, .. } = NOISE_DAMPING.search(value, &mut damping, propose, evaluate);
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
    /// Innovations of every run, four runs at a time.
    fn innovations(&self, v: &[f64; N]) -> Vec<Vec<Innovation<f64>>> {
        let noise = Noise::from_log(v);
        let linearised: Vec<(&Run, &Tangent)> = self.runs.iter().copied().zip(self.tangents.iter().copied()).collect();
        let of = |runs: &[(&Run, &Tangent)]| {
            let dt = |lane: usize| runs[lane.min(runs.len() - 1)].0.dt;
            let noise = Discrete::side_by_side(&std::array::from_fn(|lane| Discrete::new(&noise, dt(lane))));
            let room = |(run, _): &(&Run, &Tangent)| Vec::with_capacity(run.measured.len() * STATES);
            let mut out: Vec<Vec<Innovation<f64>>> = runs.iter().map(room).collect();
            innovations(&Four(runs), &noise, self.model, self.gate, |Innovation { error, variance }, present| {
                for (lane, out) in out.iter_mut().enumerate().filter(|(lane, _)| present.lane(*lane) > 0.0) {
                    out.push(Innovation { error: error.lane(lane), variance: variance.lane(lane) });
                }
            });
            out
        };
        let together: Vec<_> = linearised.par_chunks(Lanes::LANES).map(of).collect();
        together.into_iter().flatten().collect()
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
                let mut out = Vec::with_capacity(i.len());
                let noises = Discrete::side_by_side(&some);
                innovations(&One(r, t), &noises, self.model, self.gate, |innovation, _| out.push(innovation));
                out
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
                        .filter(|j| !r.derived[**j])
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
    let speed = (GRAVITY * l).sqrt();
    let [position, heading, velocity, rate] = EXACT_SENSOR;
    let floors = [position * l, heading, velocity * speed, rate * speed / l];
    let dt = runs.iter().map(|r| r.dt).fold(f64::INFINITY, f64::min).clamp(1e-3, 60.0);
    let sensors = std::array::from_fn(|g| {
        let channels: Vec<usize> = (0..STATES).filter(|j| GROUP_OF[*j] == g).collect();
        let white = scatter(&channels).max(floors[g]);
        SensorNoise { white, coloured: COLOURED_GUESS * white, time: COLOURED_PERIODS * dt }
    });
    let mass = model.ship.hull.mass;
    let acceleration = FORCE_GUESS * 0.04 * speed * speed / l;
    Noise {
        sensors,
        force: [mass * acceleration, 2.0 * mass * acceleration, 0.3 * mass * acceleration * l],
        force_time: 0.5 * l / (0.2 * speed) + 3.0 * dt,
    }
}

/// The guess for a second start: with a small unknown force the model has to follow the recordings by itself.
pub fn little_force(guess: &Noise) -> Noise {
    Noise { force: guess.force.map(|force| LITTLE_FORCE * force), ..*guess }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{RK4, model, noise, runs, with};
    use crate::likelihood::estimate::passes;
    use crate::likelihood::filter::{GATE, Pass};
    use crate::likelihood::settings::FIRST;

    #[test]
    fn the_first_guess_of_a_sensor_is_its_white_scatter() {
        let model = model();
        let found = guess(&runs(&model, 12), &model);
        for (sensor, white) in found.sensors.iter().zip([0.3, 0.002, 0.02, 0.0005]) {
            assert!((sensor.white / white).ln().abs() < 0.15, "{sensor:?} for {white}");
        }
    }

    #[test]
    fn a_channel_that_is_derived_is_no_observation() {
        let model = model();
        let (mut derived, mut blank) = (runs(&model, 5), runs(&model, 5));
        for j in 3..STATES {
            derived.iter_mut().for_each(|r| r.derived[j] = true);
            blank.iter_mut().flat_map(|r| &mut r.measured).for_each(|m| m[j] = None);
        }
        let of = |runs: &[Run]| {
            let noise = guess(runs, &model);
            let values: Vec<f64> =
                passes(&model, RK4, &[], runs, &noise, true).iter().map(|pass| pass.log_likelihood).collect();
            (noise, values)
        };
        assert_eq!(of(&derived), of(&blank));
        assert_ne!(of(&derived).1, of(&runs(&model, 5)).1);
    }

    fn linearised(runs: &[Run]) -> Vec<Pass> {
        passes(&model(), RK4, &[], runs, &noise(), true)
    }

    #[test]
    fn the_linearised_filter_is_the_filter_also_where_sensors_report_rates_of_the_state() {
        let skewed = with(&[("time_skew.position", -1.5), ("time_skew.heading", 0.7), ("position_lever.x", 12.0)]);
        let (runs, prior) = (runs(&skewed, 5), NoisePrior::around(&noise()));
        let passes = passes(&skewed, RK4, &[], &runs, &noise(), true);
        let tangents: Vec<&Tangent> = passes.iter().filter_map(|p| p.tangent.as_ref()).collect();
        let runs: Vec<&Run> = runs.iter().collect();
        let fit = NoiseFit { runs: &runs, tangents: &tangents, model: &skewed, prior: &prior, gate: GATE };
        for (of_run, pass) in fit.innovations(&noise().to_log()).iter().zip(&passes) {
            let sizes = of_run.iter().map(|i| i.error / i.variance.sqrt());
            let filtered = pass.innovations.iter().flatten().filter(|e| !e.is_nan());
            assert!(sizes.zip(filtered).all(|(a, b)| (a - b).abs() < 1e-6 * b.abs().max(1.0)));
        }
    }

    #[test]
    fn runs_side_by_side_have_the_innovations_that_each_has_alone() {
        let (model, prior) = (model(), NoisePrior::around(&noise()));
        let mut runs = runs(&model, 5);
        runs[1].measured.truncate(40);
        runs[2].dt = 1.5;
        runs[2].measured.iter_mut().step_by(3).for_each(|m| m[4] = None);
        runs[3].measured[7][3] = Some(90.0);
        runs[3].disturbed.push((10, 14));
        let passes = linearised(&runs);
        let tangents: Vec<&Tangent> = passes.iter().filter_map(|p| p.tangent.as_ref()).collect();
        let runs: Vec<&Run> = runs.iter().collect();
        let of = |runs: &[&Run], tangents: &[&Tangent]| {
            let fit = NoiseFit { runs, tangents, model: &model, prior: &prior, gate: GATE };
            fit.innovations(&noise().to_log())
        };
        let together = of(&runs, &tangents);
        for i in 0..runs.len() {
            let alone = &of(&runs[i..=i], &tangents[i..=i])[0];
            assert_eq!(together[i].len(), runs[i].measured.iter().flatten().flatten().count());
            let same = |(a, b): (&Innovation<f64>, &Innovation<f64>)| (a.error, a.variance) == (b.error, b.variance);
            assert!(together[i].len() == alone.len() && together[i].iter().zip(alone).all(same), "{i}");
            // The linearised filter is the filter itself along its own path.
            let sizes = together[i].iter().map(|i| i.error / i.variance.sqrt());
            let filtered = passes[i].innovations.iter().flatten().filter(|e| !e.is_nan());
            assert!(sizes.zip(filtered).all(|(a, b)| (a - b).abs() < 1e-6 * b.abs().max(1.0)), "{i}");
        }
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
