//! The best model of a given structure: parameters with priors by Fisher scoring on the filter's scores, noise by maximum
//! likelihood, in turn. Which parameters are free, and what is concluded, is decided elsewhere.

use super::evidence::{Base, Evidence, RunEvidence, step_inside};
use super::filter::{Column, Filter, GATE, Pass, Wanted};
use super::noise::{Noise, NoisePrior, fit_noise};
use crate::model::{Model, Prior};
use crate::recording::Run;
use crate::simulate::Integration;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// A free parameter of the estimate.
#[derive(Clone, Debug)]
pub struct FreeParameter {
    /// Its column.
    pub column: Column,
    /// Sessions in which it acts, added there to the common value; `None` for all of them.
    pub sessions: Option<Vec<String>>,
    /// What is known of it beforehand \[unit of the parameter\].
    pub prior: Option<Prior>,
}

impl FreeParameter {
    /// A parameter that acts in every run.
    pub fn common(column: Column, prior: Option<Prior>) -> Self {
        Self { column, sessions: None, prior }
    }

    /// A coefficient that is not known exactly: common to all runs, its value the mean and its spread (its scale where it has
    /// none) the standard deviation of its prior.
    pub fn uncertain(model: &Model, parameter: usize) -> Self {
        let p = &model.parameters[parameter];
        let spread = (p.info.spread)(&model.ship);
        let sd = if spread.is_finite() { spread } else { p.scale };
        Self::common(Column::tangent(model, parameter), Some(Prior { mean: p.value, sd }))
    }

    /// Its present value \[unit of the parameter\].
    pub fn value(&self, model: &Model) -> f64 {
        let i = self.column.parameter;
        match self.sessions.as_ref().and_then(|s| s.first()) {
            None => model.parameters[i].value,
            Some(first) => {
                model.sessions.get(first).into_iter().flatten().filter(|(j, _)| *j == i).map(|(_, v)| v).sum()
            }
        }
    }

    /// Sets its value, kept inside the parameter's bounds.
    pub fn set(&self, model: &mut Model, value: f64) {
        let i = self.column.parameter;
        let p = &mut model.parameters[i];
        let Some(sessions) = &self.sessions else {
            p.value = value.clamp(p.lower, p.upper);
            return;
        };
        let value = (p.value + value).clamp(p.lower, p.upper) - p.value;
        for session in sessions {
            let list = model.sessions.entry(session.clone()).or_default();
            match list.iter_mut().find(|(j, _)| *j == i) {
                Some(entry) => entry.1 = value,
                None => list.push((i, value)),
            }
        }
    }

    /// Its least and greatest value, in units of the column.
    pub(super) fn bounds(&self, model: &Model) -> (f64, f64) {
        let p = &model.parameters[self.column.parameter];
        // An addition in some sessions is bounded by what the sum may be.
        let common = if self.sessions.is_some() { p.value } else { 0.0 };
        let (a, b) = ((p.lower - common) / self.column.scale, (p.upper - common) / self.column.scale);
        (a.min(b), a.max(b))
    }

    /// Precision of the prior, and the pull of the prior on the score, in units of the column.
    pub(super) fn prior_terms(&self, model: &Model) -> (f64, f64) {
        self.prior.map_or((0.0, 0.0), |prior| {
            let precision = (self.column.scale / prior.sd).powi(2);
            let away = (self.value(model) - prior.mean) / self.column.scale;
            (precision, -precision * away)
        })
    }

    /// Logarithm of the prior density at the present value, up to a constant.
    pub(super) fn log_prior(&self, model: &Model) -> f64 {
        self.prior.map_or(0.0, |prior| -0.5 * ((self.value(model) - prior.mean) / prior.sd).powi(2))
    }
}

/// A fitted structure.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// The model with its estimated values.
    pub model: Model,
    /// The noise.
    pub noise: Noise,
    /// What was free.
    pub free: Vec<FreeParameter>,
    /// Log-likelihood plus log-prior at the estimate.
    pub log_posterior: f64,
}

/// Settings of an estimation.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Rounds of parameter steps, each followed by a noise estimate while `noise_rounds` last.
    pub rounds: usize,
    /// Rounds with a noise estimate.
    pub noise_rounds: usize,
    /// BFGS iterations in a noise estimate.
    pub noise_iterations: usize,
    /// Runs used for the noise estimate, evenly spread.
    pub noise_runs: usize,
}

/// Share of measurements set aside as outliers above which they are none.
const MANY: f64 = 0.03;

/// A noise that some runs prefer is refused by all when it costs them more than this in log-likelihood.
const REFUSED: f64 = 10.0;

/// Share of the measurements that passes set aside as outliers.
fn aside(passes: &[Pass]) -> f64 {
    let (outliers, used) = passes.iter().fold((0, 0), |(o, u), p| (o + p.outliers, u + p.used));
    outliers as f64 / (outliers + used).max(1) as f64
}

/// One pass over all runs.
pub fn passes(
    model: &Model,
    integration: Integration,
    columns: &[Column],
    runs: &[Run],
    noise: &Noise,
    tangent: bool,
) -> Vec<Pass> {
    let filter = Filter::new(model, integration, columns);
    runs.par_iter().map(|r| filter.pass(r, noise, Wanted { tangent, ..Wanted::default() })).collect()
}

/// Scores and information of passes over runs.
///
/// `sessions[c]` restricts column c to runs of those sessions; columns beyond the slice act in every run.
pub fn evidence(runs: &[Run], passes: &[Pass], sessions: &[Option<Vec<String>>]) -> Evidence {
    let of = |r: &Run, p: &Pass| {
        let (mut score, mut information) = (p.score.clone(), p.information.clone());
        for (c, only) in sessions.iter().enumerate() {
            if only.as_ref().is_some_and(|s| !s.contains(&r.session)) {
                score[c] = 0.0;
                information.row_mut(c).fill(0.0);
                information.column_mut(c).fill(0.0);
            }
        }
        RunEvidence { session: r.session.clone(), score, information }
    };
    Evidence::new(runs.iter().zip(passes).map(|(r, p)| of(r, p)).collect())
}

/// The session restrictions of free parameters, in their order.
pub fn restrictions(free: &[FreeParameter]) -> Vec<Option<Vec<String>>> {
    free.iter().map(|f| f.sessions.clone()).collect()
}

/// The base block of free parameters that are the first columns of the evidence.
pub fn base_of(evidence: &Evidence, model: &Model, free: &[FreeParameter]) -> Base {
    let (precision, pull): (Vec<f64>, Vec<f64>) = free.iter().map(|f| f.prior_terms(model)).unzip();
    evidence.base(&(0..free.len()).collect::<Vec<_>>(), &precision, &pull)
}

/// The quadratic model of the log-posterior in the free parameters, in units of their columns, and how far each may go.
struct Quadratic {
    information: DMatrix<f64>,
    score: DVector<f64>,
    room: Vec<(f64, f64)>,
}

impl Quadratic {
    fn new(Evidence { total, .. }: &Evidence, model: &Model, free: &[FreeParameter]) -> Self {
        let (mut information, mut score) = (total.information.clone(), total.score.clone());
        let mut room = Vec::with_capacity(free.len());
        for (i, f) in free.iter().enumerate() {
            let (precision, pull) = f.prior_terms(model);
            information[(i, i)] += precision;
            score[i] += pull;
            let (now, (least, most)) = (f.value(model) / f.column.scale, f.bounds(model));
            room.push((least - now, most - now));
        }
        Self { information, score, room }
    }

    /// The best step within bounds, as if each parameter were held where it is with the precision `damping`.
    fn step(&self, damping: f64) -> DVector<f64> {
        let n = self.score.len();
        step_inside(&(&self.information + DMatrix::from_diagonal_element(n, n, damping)), &self.score, &self.room)
    }

    /// What a step adds.
    fn promise(&self, step: &DVector<f64>) -> f64 {
        step.dot(&(&self.score - 0.5 * &self.information * step))
    }
}

/// Log-likelihood plus log-prior of a model.
pub fn log_posterior(
    model: &Model,
    integration: Integration,
    runs: &[Run],
    free: &[FreeParameter],
    noise: &Noise,
) -> f64 {
    let likelihood: f64 = passes(model, integration, &[], runs, noise, false).iter().map(|p| p.log_likelihood).sum();
    likelihood + free.iter().map(|f| f.log_prior(model)).sum::<f64>()
}

/// The noise of the calmer runs: what disturbs some runs only is no noise.
pub fn calm_noise(found: &Estimate, integration: Integration, runs: &[Run], prior: &NoisePrior) -> Noise {
    let p = passes(&found.model, integration, &[], runs, &found.noise, true);
    let likelihood = |i: &usize| p[*i].log_likelihood / runs[*i].measured.len() as f64;
    let mut order: Vec<usize> = (0..runs.len()).collect();
    order.sort_by(|a, b| likelihood(b).total_cmp(&likelihood(a)));
    order.truncate((0.6 * runs.len() as f64).ceil() as usize);
    order.sort_unstable();
    let some: Vec<&Run> = order.iter().map(|i| &runs[*i]).collect();
    let tangents: Vec<_> = order.iter().filter_map(|i| p[*i].tangent.as_ref()).collect();
    fit_noise(&some, &tangents, &found.model, &found.noise, prior, GATE, 8)
}

/// A gain in log-posterior below this changes no verdict.
const ENOUGH: f64 = 0.3;

/// The least damping that is tried when a step fails; below a tenth of it there is none.
const DAMPING: f64 = 0.3;

/// A step that gains less than this share of what it promised was too long for the quadratic model.
const TRUSTED: f64 = 0.5;

/// Fits the free parameters and the noise, starting from the model's values.
///
/// A step that lowers the log-posterior is tried again with more damping, at most five times. Values stay inside the parameters'
/// bounds.
pub fn estimate(
    start: &Model,
    integration: Integration,
    runs: &[Run],
    free: &[FreeParameter],
    noise: &Noise,
    prior: &NoisePrior,
    effort: Effort,
) -> Estimate {
    estimate_above(f64::NEG_INFINITY, start, integration, runs, free, noise, prior, effort)
}

/// The same, given up where even twice what the quadratic model promises ends below a log-posterior of `least`.
pub(super) fn estimate_above(
    least: f64,
    start: &Model,
    integration: Integration,
    runs: &[Run],
    free: &[FreeParameter],
    noise: &Noise,
    prior: &NoisePrior,
    effort: Effort,
) -> Estimate {
    let columns: Vec<Column> = free.iter().map(|f| f.column).collect();
    let mut model = start.clone();
    let mut noise = *noise;
    let log_prior = |m: &Model| free.iter().map(|f| f.log_prior(m)).sum::<f64>();
    let posterior = |m: &Model, p: &[Pass]| p.iter().map(|p| p.log_likelihood).sum::<f64>() + log_prior(m);
    let mut current = passes(&model, integration, &columns, runs, &noise, true);
    let mut value = posterior(&model, &current);
    // Parameters that the data hardly determine ask for steps on which the others would founder: damping, in units of the
    // columns' scales, holds those back and lets the rest move (Levenberg, Marquardt). It stays while the valley bends.
    let mut damping = 0.0;
    for round in 0..effort.rounds {
        let quadratic = Quadratic::new(&evidence(runs, &current, &restrictions(free)), &model, free);
        // A law that bends may hold more than its slope where it starts promises: never before the first step.
        if round > 0 && least.is_finite() && value + 2.0 * quadratic.promise(&quadratic.step(0.0)) < least {
            break;
        }
        let mut moved = false;
        let mut length: f64 = 0.0;
        let before = value;
        for _ in 0..6 {
            let mut step = quadratic.step(damping);
            // Never more than ten scales at once: beyond that the linearisation says nothing.
            length = step.amax();
            if length > 10.0 {
                step *= 10.0 / length;
                length = 10.0;
            }
            let promised = quadratic.promise(&step);
            if promised < ENOUGH {
                break;
            }
            let mut trial = model.clone();
            for (f, s) in free.iter().zip(step.iter()) {
                f.set(&mut trial, f.value(&model) + s * f.column.scale);
            }
            let trial_passes = passes(&trial, integration, &columns, runs, &noise, true);
            let trial_value = posterior(&trial, &trial_passes);
            if trial_value.is_finite() && trial_value > value - 0.01 {
                moved = true;
                damping *= 0.3;
                if trial_value - value < TRUSTED * promised {
                    damping = damping.max(DAMPING);
                } else if damping < 0.1 * DAMPING {
                    damping = 0.0;
                }
                (model, current, value) = (trial, trial_passes, trial_value);
                break;
            }
            damping = f64::max(DAMPING, 10.0 * damping);
        }
        let settled = !moved || length < 0.03 || value - before < ENOUGH;
        if round < effort.noise_rounds {
            // The noise is fitted to some runs, linearised: where it does not serve all of them, it is fitted to all.
            let sparse = runs.len().div_ceil(effort.noise_runs.max(1)).max(1);
            let mut strides = vec![sparse, 1];
            strides.dedup();
            for stride in strides {
                let chosen: Vec<usize> = (0..runs.len()).step_by(stride).collect();
                let some: Vec<&Run> = chosen.iter().map(|i| &runs[*i]).collect();
                let tangents: Vec<_> = chosen.iter().filter_map(|i| current[*i].tangent.as_ref()).collect();
                // Where much is set aside the noise is too small by far, and a gate hides that: everything counts first.
                let gates = if aside(&current) > MANY { &[f64::INFINITY, GATE][..] } else { &[GATE] };
                let trial = gates.iter().fold(noise, |noise, gate| {
                    fit_noise(&some, &tangents, &model, &noise, prior, *gate, effort.noise_iterations)
                });
                let trial_passes = passes(&model, integration, &columns, runs, &trial, true);
                let trial_value = posterior(&model, &trial_passes);
                if trial_value > value {
                    (noise, current, value) = (trial, trial_passes, trial_value);
                    break;
                }
                if value - trial_value < REFUSED {
                    break;
                }
            }
        } else if settled {
            break;
        }
    }
    Estimate { model, noise, free: free.to_vec(), log_posterior: value }
}
