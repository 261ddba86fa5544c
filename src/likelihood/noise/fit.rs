//! The estimate of the noise by maximum likelihood on linearised runs, and a first guess of it from the recordings alone.
//! The ship's parameters are fixed: they are estimated elsewhere, in turn with the noise.

use super::adjoint::slopes;
use super::levels::{GROUP_OF, NOISE_PARAMETERS, Noise, NoisePrior, SensorNoise};
use super::linearised::{Follow, Place, Taken, Together, pass};
use crate::likelihood::covariance::Discrete;
use crate::likelihood::filter::Tangent;
use crate::likelihood::optimise::{Outcome, Proposal};
use crate::likelihood::settings::{
    COLOURED_GUESS, COLOURED_PERIODS, EXACT_SENSOR, FORCE_GUESS, INFORMATION_REACH, INFORMATION_RUNS, LITTLE_FORCE,
    NOISE_DAMPING, NOISE_STEP_LONGEST,
};
use crate::model::Model;
use crate::recording::{Run, or_nan};
use crate::state::STATES;
use crate::units::GRAVITY;
use nalgebra::{SMatrix, SVector};
use rayon::prelude::*;
use trimtab_ad::{Lanes, Scalar};

const N: usize = NOISE_PARAMETERS;

/// How far the logarithms are nudged for the derivatives of the innovations.
const NUDGE: f64 = 0.01;

/// Samples between two places of a filter that are kept for the way back.
const KEPT: usize = 16;

/// The information of a noise's logarithms, kept from step to step and from search to search: it learns from the scores, and is made anew
/// only where the noise has moved far.
#[derive(Default)]
pub struct KeptInformation {
    kept: Option<([f64; N], SMatrix<f64, N, N>)>,
}

impl KeptInformation {
    /// The information at some logarithms, or at kept ones near them.
    fn near(&mut self, v: &[f64; N], make: impl Fn() -> SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
        let far = |at: &[f64; N]| at.iter().zip(v).any(|(a, b)| (a - b).abs() > INFORMATION_REACH);
        match &self.kept {
            Some((at, information)) if !far(at) => *information,
            _ => {
                let information = make();
                self.kept = Some((*v, information));
                information
            }
        }
    }

    /// Changes the information H so that it explains, along a step s of the logarithms, how the score fell by y: `H + r r' / r's - H s s' H /
    /// s'Hs` with r = y, or between y and `H s` where H would lose more than four fifths of its size along s (Powell 1978; Nocedal &
    /// Wright, Numerical Optimization, 2006, procedure 18.2).
    fn learn(&mut self, step: &SVector<f64, N>, fall: &SVector<f64, N>) {
        let Some((_, information)) = &mut self.kept else { return };
        let expected = *information * step;
        let (curvature, seen) = (step.dot(&expected), step.dot(fall));
        let trust = if seen < 0.2 * curvature { 0.8 * curvature / (curvature - seen) } else { 1.0 };
        let learnt = fall * trust + expected * (1.0 - trust);
        let gained = step.dot(&learnt);
        if curvature > 0.0 && gained > 0.0 && gained.is_finite() {
            *information += learnt * learnt.transpose() / gained - expected * expected.transpose() / curvature;
        }
    }
}

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
    kept: &mut KeptInformation,
) -> Noise {
    let linearised: Vec<(&Run, &Tangent)> = runs.iter().copied().zip(tangents.iter().copied()).collect();
    let fit = NoiseFit { runs: &linearised, model, prior, gate };
    let mut v = start.to_log();
    let mut at = fit.passed(&v);
    let mut value = fit.posterior(&v, &at);
    let mut damping = 0.0;
    let mut last: Option<([f64; N], SVector<f64, N>)> = None;
    for _ in 0..iterations {
        let (of_prior, precision) = prior.score(&v);
        let of_runs = fit.score(&v, &at);
        if let Some((from, score)) = last.replace((v, of_runs)) {
            kept.learn(&SVector::from_fn(|i, _| v[i] - from[i]), &(score - of_runs));
        }
        let score = of_runs + of_prior;
        let information = kept.near(&v, || fit.information(&v)) + precision;
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
            let trial = fit.passed(&w);
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
    runs: &'a [(&'a Run, &'a Tangent)],
    model: &'a Model,
    prior: &'a NoisePrior,
    gate: f64,
}

/// What a filter gave on up to four runs.
struct Passed {
    /// Log-likelihood of each.
    values: [f64; Lanes::LANES],
    /// Where it was on its way.
    places: Vec<Place>,
}

/// Log-likelihoods of four runs: an outlier counts as if it were at the gate.
struct LogLikelihood {
    sum: Lanes,
    most: Lanes,
}

impl Follow for LogLikelihood {
    #[inline(always)]
    fn takes(&mut self, Taken { error, variance, present, .. }: Taken) {
        let square = error * error / variance;
        self.sum -= present * (square.min(self.most) + variance.ln()) * 0.5;
    }
}

/// Innovations with their variances and weights.
#[derive(Default)]
struct Innovations(Vec<[Lanes; 3]>);

impl Follow for Innovations {
    #[inline(always)]
    fn takes(&mut self, Taken { error, variance, weight, .. }: Taken) {
        self.0.push([error, variance, weight]);
    }
}

impl NoiseFit<'_> {
    /// The filter on every run, four runs at a time.
    fn passed(&self, v: &[f64; N]) -> Vec<Passed> {
        let noise = Noise::from_log(v);
        let of = |runs: &[(&Run, &Tangent)]| {
            let along = Together(runs);
            let discrete = along.discrete(&noise);
            let mut place = along.start(&discrete, self.model);
            let mut sums = LogLikelihood { sum: Lanes::zero(), most: Lanes::from_f64(self.gate * self.gate) };
            let mut places = Vec::with_capacity(along.samples() / KEPT + 1);
            while place.sample < along.samples() {
                places.push(place.clone());
                let until = place.sample + KEPT;
                pass(&along, &discrete, self.gate, &mut place, until, &mut sums);
            }
            Passed { values: sums.sum.to_array(), places }
        };
        self.runs.par_chunks(Lanes::LANES).map(of).collect()
    }

    /// Log-likelihood plus log-prior.
    fn posterior(&self, v: &[f64; N], passed: &[Passed]) -> f64 {
        let values = passed.iter().flat_map(|passed| passed.values);
        values.take(self.runs.len()).sum::<f64>() + self.prior.log_density(v)
    }

    /// The slope of the log-likelihood by the logarithms; outliers have no part in it.
    fn score(&self, v: &[f64; N], passed: &[Passed]) -> SVector<f64, N> {
        let noise = Noise::from_log(v);
        let of =
            |(runs, passed): (&[(&Run, &Tangent)], &Passed)| slopes(&Together(runs), &noise, self.gate, &passed.places);
        let parts: Vec<_> = self.runs.par_chunks(Lanes::LANES).zip(passed.par_iter()).map(of).collect();
        parts.iter().flatten().fold(SVector::zeros(), |sum, part| sum + SVector::from(*part))
    }

    /// The expected information of the logarithms, `H_ij = sum s_i s_j / (2 s^2) + e_i e_j / s` with `e_i`, `s_i` the derivatives of
    /// innovation and variance, by differences between noises nudged by [`NUDGE`] (Gupta & Mehra 1974, IEEE Trans. Autom. Control
    /// 19). Outliers have no part in it. Of many runs it is that of a part of them, evenly spaced, times the samples of all over theirs.
    fn information(&self, v: &[f64; N]) -> SMatrix<f64, N, N> {
        let nudged = |i: usize| {
            let mut w = *v;
            w[i] += NUDGE;
            Noise::from_log(&w)
        };
        let noises: Vec<Noise> = std::iter::once(Noise::from_log(v)).chain((0..N).map(nudged)).collect();
        let of = |runs: &[(&Run, &Tangent)]| {
            let along = Together(runs);
            let discrete: Vec<Discrete<Lanes>> = noises.iter().map(|noise| along.discrete(noise)).collect();
            let mut places: Vec<Place> = discrete.iter().map(|noise| along.start(noise, self.model)).collect();
            let mut innovations: Vec<Innovations> = noises.iter().map(|_| Innovations::default()).collect();
            let mut sum = [[Lanes::zero(); N]; N];
            while places[0].sample < along.samples() {
                for ((noise, place), out) in discrete.iter().zip(&mut places).zip(&mut innovations) {
                    out.0.clear();
                    let until = place.sample + KEPT;
                    pass(&along, noise, self.gate, place, until, out);
                }
                add_information(&innovations, &mut sum);
            }
            let total = |lanes: Lanes| lanes.to_array()[..runs.len()].iter().sum::<f64>();
            SMatrix::<f64, N, N>::from_fn(|i, j| total(sum[i.max(j)][i.min(j)]))
        };
        let all: Vec<&[(&Run, &Tangent)]> = self.runs.chunks(Lanes::LANES).collect();
        let apart = (self.runs.len() / INFORMATION_RUNS).max(1);
        let some: Vec<&[(&Run, &Tangent)]> = all.iter().copied().step_by(apart).collect();
        let samples = |of: &[&[(&Run, &Tangent)]]| of.concat().iter().map(|(run, _)| run.measured.len()).sum::<usize>();
        let times = samples(&all) as f64 / samples(&some) as f64;
        let parts: Vec<_> = some.into_par_iter().map(of).collect();
        parts.iter().fold(SMatrix::zeros(), |sum, part| sum + part) * times
    }
}

/// Adds the information in innovations of a noise, the first, and of nudged ones to its lower triangle.
fn add_information(innovations: &[Innovations], sum: &mut [[Lanes; N]; N]) {
    let [at, nudged @ ..] = innovations else { return };
    for (m, [error, variance, weight]) in at.0.iter().enumerate() {
        let (by_error, by_variance) = (*weight * (1.0 / (NUDGE * NUDGE)), *weight * *weight * (0.5 / (NUDGE * NUDGE)));
        let slopes: [[Lanes; 2]; N] =
            std::array::from_fn(|i| [nudged[i].0[m][0] - *error, nudged[i].0[m][1] - *variance]);
        for (i, row) in sum.iter_mut().enumerate() {
            let [e, s] = [slopes[i][0] * by_error, slopes[i][1] * by_variance];
            (0..=i).for_each(|j| row[j] += e * slopes[j][0] + s * slopes[j][1]);
        }
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

    /// Innovations and variances of up to four runs.
    struct Kept(Vec<Vec<[f64; 2]>>);

    impl Follow for Kept {
        fn takes(&mut self, Taken { error, variance, present, .. }: Taken) {
            for (lane, out) in self.0.iter_mut().enumerate().filter(|(lane, _)| present.lane(*lane) > 0.0) {
                out.push([error.lane(lane), variance.lane(lane)]);
            }
        }
    }

    fn innovations(model: &Model, runs: &[(&Run, &Tangent)]) -> Vec<Vec<[f64; 2]>> {
        let along = Together(runs);
        let discrete = along.discrete(&noise());
        let mut kept = Kept(vec![Vec::new(); runs.len()]);
        pass(&along, &discrete, GATE, &mut along.start(&discrete, model), usize::MAX, &mut kept);
        kept.0
    }

    #[test]
    fn the_linearised_filter_is_the_filter_also_where_sensors_report_rates_of_the_state() {
        let skewed = with(&[("time_skew.position", -1.5), ("time_skew.heading", 0.7), ("position_lever.x", 12.0)]);
        let runs = runs(&skewed, 5);
        let passes = passes(&skewed, RK4, &[], &runs, &noise(), true);
        let tangents: Vec<&Tangent> = passes.iter().filter_map(|p| p.tangent.as_ref()).collect();
        for ((run, tangent), pass) in runs.iter().zip(tangents).zip(&passes) {
            let sizes = innovations(&skewed, &[(run, tangent)]).remove(0).into_iter().map(|[e, s]| e / s.sqrt());
            let filtered = pass.innovations.iter().flatten().filter(|e| !e.is_nan());
            assert!(sizes.zip(filtered).all(|(a, b)| (a - b).abs() < 1e-6 * b.abs().max(1.0)));
        }
    }

    #[test]
    fn runs_side_by_side_have_the_innovations_that_each_has_alone() {
        let model = model();
        let mut runs = runs(&model, 5);
        runs[1].measured.truncate(40);
        runs[2].dt = 1.5;
        runs[2].measured.iter_mut().step_by(3).for_each(|m| m[4] = None);
        runs[3].measured[7][3] = Some(90.0);
        runs[3].disturbed.push((10, 14));
        let passes = linearised(&runs);
        let pairs: Vec<(&Run, &Tangent)> = runs.iter().zip(passes.iter().filter_map(|p| p.tangent.as_ref())).collect();
        let together: Vec<_> = pairs.chunks(Lanes::LANES).flat_map(|some| innovations(&model, some)).collect();
        for i in 0..runs.len() {
            let alone = &innovations(&model, &pairs[i..=i])[0];
            assert_eq!(together[i].len(), runs[i].measured.iter().flatten().flatten().count());
            assert_eq!(&together[i], alone, "{i}");
            // The linearised filter is the filter itself along its own path.
            let sizes = together[i].iter().map(|[e, s]| e / s.sqrt());
            let filtered = passes[i].innovations.iter().flatten().filter(|e| !e.is_nan());
            assert!(sizes.zip(filtered).all(|(a, b)| (a - b).abs() < 1e-6 * b.abs().max(1.0)), "{i}");
        }
    }

    #[test]
    fn the_score_of_the_logarithms_is_the_slope_of_the_likelihood() {
        // Sensors that report rates of the state, runs of several lengths and periods with channels missing and a disturbed span; and a
        // filter that is kept at several places on its way.
        let model = with(&[("time_skew.position", -1.5), ("time_skew.heading", 0.7), ("position_lever.x", 12.0)]);
        let mut runs = runs(&model, 6);
        runs[1].measured.truncate(40);
        runs[2].dt = 1.5;
        runs[2].measured.iter_mut().step_by(3).for_each(|m| m[4] = None);
        runs[3].disturbed.push((10, 14));
        let prior = NoisePrior::around(&noise());
        let passes = passes(&model, RK4, &[], &runs, &noise(), true);
        let pairs: Vec<(&Run, &Tangent)> = runs.iter().zip(passes.iter().filter_map(|p| p.tangent.as_ref())).collect();
        let fit = NoiseFit { runs: &pairs, model: &model, prior: &prior, gate: f64::INFINITY };
        let mut v = noise().to_log();
        v[9] += 0.2;
        let at = fit.passed(&v);
        assert!(at[0].places.len() > 2);
        let score = fit.score(&v, &at) + prior.score(&v).0;
        let unit = fit.information(&v).map_diagonal(f64::sqrt);
        for i in 0..N {
            let at = |d: f64| {
                let mut w = v;
                w[i] += d;
                fit.posterior(&w, &fit.passed(&w))
            };
            let slope = (at(1e-4) - at(-1e-4)) / 2e-4;
            assert!(
                (score[i] - slope).abs() < 1e-5 * unit[i].max(1.0) + 1e-6 * slope.abs(),
                "{i}: {} {slope}",
                score[i]
            );
        }
    }

    #[test]
    fn the_information_of_the_logarithms_is_what_their_score_varies_by() {
        // The mean over recordings of the square of the score at the truth.
        let prior = NoisePrior::around(&noise());
        let (model, runs) = (model(), runs(&model(), 24));
        let passes = linearised(&runs);
        let pairs: Vec<(&Run, &Tangent)> = runs.iter().zip(passes.iter().filter_map(|p| p.tangent.as_ref())).collect();
        let v = noise().to_log();
        let (mut squares, mut sum) = (SVector::<f64, N>::zeros(), SVector::<f64, N>::zeros());
        for pair in &pairs {
            let fit = NoiseFit { runs: &[*pair], model: &model, prior: &prior, gate: f64::INFINITY };
            let score = fit.score(&v, &fit.passed(&v));
            squares += score.component_mul(&score);
            sum += fit.information(&v).diagonal();
        }
        // The white parts, whose scores are nearly normal.
        for i in [0, 3, 6, 9] {
            assert!((squares[i] / sum[i]).ln().abs() < 0.7, "{i}: {} {}", squares[i], sum[i]);
        }
    }

    #[test]
    fn the_information_of_many_runs_is_nearly_that_of_each() {
        let prior = NoisePrior::around(&noise());
        let (model, runs) = (model(), runs(&model(), 2 * INFORMATION_RUNS + 3));
        let passes = linearised(&runs);
        let pairs: Vec<(&Run, &Tangent)> = runs.iter().zip(passes.iter().filter_map(|p| p.tangent.as_ref())).collect();
        let v = noise().to_log();
        let of = |runs| NoiseFit { runs, model: &model, prior: &prior, gate: f64::INFINITY }.information(&v).diagonal();
        let each = pairs.chunks(Lanes::LANES).map(of).fold(SVector::<f64, N>::zeros(), |sum, one| sum + one);
        let all = of(&pairs);
        assert!(all != each && all.component_div(&each).iter().all(|share| share.ln().abs() < 0.2), "{all} {each}");
    }

    #[test]
    fn the_information_learns_the_curvature_along_a_step_and_stays_positive() {
        let mut kept = KeptInformation::default();
        kept.near(&noise().to_log(), || SMatrix::from_diagonal_element(10.0));
        let step = SVector::<f64, N>::from_fn(|i, _| if i < 3 { 0.1 } else { 0.0 });
        let fall = SVector::<f64, N>::from_fn(|i, _| if i < 3 { 0.1 * [30.0, 20.0, 5.0][i] } else { 0.0 });
        kept.learn(&step, &fall);
        let learnt = kept.near(&noise().to_log(), SMatrix::zeros);
        assert!((learnt * step - fall).amax() < 1e-12);
        assert!((learnt[(5, 5)], learnt[(5, 1)]) == (10.0, 0.0));
        kept.learn(&step, &(-fall));
        assert!(kept.near(&noise().to_log(), SMatrix::zeros).cholesky().is_some());
    }

    #[test]
    fn the_information_is_made_anew_where_the_noise_has_moved_far() {
        let mut kept = KeptInformation::default();
        let mut v = noise().to_log();
        let mut at = |v: &[f64; N], size: f64| kept.near(v, || SMatrix::from_diagonal_element(size))[(0, 0)];
        assert_eq!(at(&v, 1.0), 1.0);
        v[3] += 0.9 * INFORMATION_REACH;
        assert_eq!(at(&v, 2.0), 1.0);
        v[3] += 0.2 * INFORMATION_REACH;
        assert_eq!((at(&v, 3.0), at(&v, 4.0)), (3.0, 3.0));
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
        let pairs: Vec<(&Run, &Tangent)> = runs.iter().copied().zip(tangents.iter().copied()).collect();
        let fit = NoiseFit { runs: &pairs, model: &model, prior: &prior, gate: GATE };
        let value = |n: &Noise| fit.posterior(&n.to_log(), &fit.passed(&n.to_log()));
        let kept = &mut KeptInformation::default();
        let found = fit_noise(&runs, &tangents, &model, &start, &prior, GATE, FIRST.noise_iterations, kept);
        assert!(value(&found) > value(&start) + 100.0);
        for (sensor, white) in found.sensors.iter().zip([0.3, 0.002, 0.02, 0.0005]) {
            assert!((sensor.white / white).ln().abs() < 0.25, "{sensor:?} for {white}");
        }
    }
}
