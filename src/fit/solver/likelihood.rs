//! The fit by likelihood: parameters with priors, an unknown force, sensor noise and initial states, solved through Ipopt like any other.
//! The likelihood itself is that of `crate::likelihood`; which terms a model has is decided elsewhere.
//!
//! With the gains of the Kalman filter fixed, half the sum of squared standardised innovations
//!
//! ```text
//! f(p) = 1/2 sum_k e_k^2 / s_k + 1/2 sum_j ((p_j - mean_j) / sd_j)^2
//! ```
//!
//! is a smooth function of the parameters; the filter's sensitivities are exactly its derivatives, and the Fisher information is its
//! Gauss-Newton matrix. Ipopt minimises it within constraints and bounds; then the noise is estimated anew by maximum likelihood, the
//! gains follow, and it is minimised again, until the log-posterior rises no more; near the optimum each of these solves takes a few steps.
//! With that noise the gains are then renewed alone, until f falls no more. Where it ends,
//! the scores of the filter, which are unbiased at the true parameters whatever the gains, are zero in the directions that no constraint
//! blocks.
//!
//! Hull, propeller and rudder coefficients that are never known exactly are estimated along, with the values of the model as means and the
//! spreads of their terms as standard deviations of their priors.

use super::constraints::ConstraintSettings;
use super::curvature::Curvature;
use super::descent::{Descent, From, Shared, Work};
use super::limits::Watch;
use super::problem::{FEW, Priors, Progress, Settled, Stage};
use super::rows::WorkingRows;
use super::solve::{End, Search};
use super::stages;
use super::task::Task;
use crate::fit::error::FitError;
use crate::fit::objectives::cost::{Cost, Quadratic};
use crate::fit::objectives::evaluations::Evaluations;
use crate::fit::objectives::innovations::{Innovations, NOISE_ITERATIONS, samples};
use crate::fit::objectives::objective::Objective;
use crate::fit::settings::{FitSettings, Goal, Hessian};
use crate::ipopt::Multipliers;
use crate::likelihood::estimate::{Estimate, fitted_noise, log_posterior};
use crate::likelihood::noise::fit::{KeptInformation, guess};
use crate::likelihood::noise::{Noise, NoisePrior};
use crate::likelihood::parameters::{FreeParameter, base_parameters};
use crate::recording::{Run, Runs};
use crate::simulate::Integration;
use nalgebra::DMatrix;
use serde::Serialize;

/// Rounds of gains and noise at most, in each stage.
const ROUNDS: usize = 30;

/// Rounds up to which a solve takes at most so many iterations: with fixed gains the objective far from where they were made is another
/// one, and what is gained there is lost when they are renewed.
const SHORT: [(usize, usize); 2] = [(3, 4), (6, 16)];

/// Iterations of a solve near the optimum before gains and noise are made anew: f at fixed gains is nearly quadratic there, and what more steps
/// gain is lost when the gains are renewed.
const CLOSE: usize = 4;

/// The same in the first round of a solve that begins near the optimum without multipliers: these have to be found first.
const FIRST_CLOSE: usize = 3 * CLOSE;

/// Rise of the log-posterior in a round below which gains and noise are settled: less than a third of a likelihood unit turns no comparison.
const SETTLED: f64 = 0.3;

/// Likelihood units by which a start may be below the optimum with gains and noise fixed: the barrier's own scale, a thousandth of it at
/// first, is then one unit.
const REACH: f64 = 1e3;

/// Largest gradient that a solve leaves, in likelihood units by a parameter's scale: what it leaves to be gained is far below [`SETTLED`].
const GRADIENT: f64 = 0.01;

/// Gradient and change of the objective in a few iterations in a row, in the same units, below which a solve ends all the same: terms with
/// absolute values make the gradient jump. What it leaves, the next round has to gain.
const ROUGH: f64 = 30.0;
const CHANGE: f64 = 0.03;

/// Fall of the objective in a round of gains below which these are settled: a step of a fifth of a standard error falls by so much.
const LEFT: f64 = 0.02;

/// What a fit by likelihood says beside its estimates.
#[derive(Clone, Debug, Serialize)]
pub struct Likelihood {
    /// Log-likelihood plus log-prior at the start, with the noise that was estimated there.
    pub start_log_posterior: f64,
    /// Log-likelihood plus log-prior at the end, up to the same constant.
    pub log_posterior: f64,
    /// The noise.
    pub noise: Noise,
    /// Rounds of gains and noise.
    pub rounds: usize,
}

/// Where a fit by likelihood ended, with the objective of its last round.
pub(in crate::fit) struct LikelihoodEnd<'a> {
    pub end: End,
    pub innovations: Innovations<'a>,
    pub likelihood: Likelihood,
}

impl Objective for Innovations<'_> {
    fn value(&self, p: &[f64]) -> Option<f64> {
        Innovations::value(self, p)
    }

    fn quadratic(&self, p: &[f64], _with_matrix: bool) -> Option<Quadratic> {
        Innovations::quadratic(self, p)
    }

    fn hessian(&self, _p: &[f64]) -> Option<DMatrix<f64>> {
        None
    }

    /// One over the number of samples.
    fn factor(&self) -> f64 {
        1.0 / self.samples().max(1) as f64
    }

    /// Most of the squares are noise, which no model takes away.
    fn reach(&self, _value: f64) -> f64 {
        REACH
    }
}

/// What stays fixed during a fit by likelihood.
struct Posterior<'a> {
    task: &'a Task<'a>,
    runs: &'a [Run],
    free: Vec<FreeParameter>,
    noise_prior: NoisePrior,
}

impl<'a> Posterior<'a> {
    /// The likelihood of runs with the gains of the filter at `p`.
    fn innovations<'r>(&self, runs: &'r [Run], noise: Noise, p: &[f64]) -> Innovations<'r>
    where
        'a: 'r,
    {
        Innovations::of(self.task.model, runs, self.task.settings.integration, &self.free, noise, p)
    }

    /// Log-likelihood plus log-priors of parameters and noise.
    fn log_density(&self, p: &[f64], noise: &Noise) -> f64 {
        let (model, integration) = (self.task.model_at(p), self.task.settings.integration);
        let of_parameters = log_posterior(&model, integration, self.runs, &self.free, noise);
        of_parameters + self.noise_prior.log_density(&noise.to_log())
    }

    /// These parameters with the noise of the runs there.
    fn reached(&self, p: &[f64], from: &Noise, kept: &mut KeptInformation) -> Reached {
        let (model, integration) = (self.task.model_at(p), self.task.settings.integration);
        let noise = fitted_noise(&model, integration, self.runs, from, &self.noise_prior, NOISE_ITERATIONS, kept);
        Reached { p: p.to_vec(), noise, value: self.log_density(p, &noise) }
    }
}

/// Parameters and noise with their log-posterior.
struct Reached {
    p: Vec<f64>,
    noise: Noise,
    value: f64,
}

/// What goes from round to round.
struct Rounds {
    reached: Reached,
    multipliers: Option<Multipliers>,
    /// Whether they are near the optimum.
    near: bool,
    count: usize,
    /// Of the noise.
    information: KeptInformation,
}

impl<'t> Task<'t> {
    /// Solves by likelihood: noise, gains and parameters in turn, of a few of the runs first where there are many, and at the end the check
    /// of the optimum.
    pub fn solve_by_likelihood<'a>(
        &'a self,
        runs: &'a [Run],
        progress: &mut dyn FnMut(&Progress) -> bool,
    ) -> Result<LikelihoodEnd<'a>, FitError> {
        let watch = Watch::new(self.settings, self.cost.ranks());
        let mut shared = Shared { watch, work: Work::default(), progress, rows: WorkingRows::of(self) };
        let free = base_parameters(self.model, false);
        let priors = priors(&free);
        let first = guess(runs, self.model);
        let posterior = Posterior { task: self, runs, free, noise_prior: NoisePrior::around(&first) };
        let mut information = KeptInformation::default();
        let reached = posterior.reached(&self.start, &first, &mut information);
        let start_log_posterior = reached.value;
        let mut rounds = Rounds { reached, multipliers: None, near: false, count: 0, information };
        let few = stages::drawn(runs);
        if let Some(few) = &few {
            self.approach_by_likelihood(&posterior, few, &priors, &mut rounds, &mut shared)?;
        }
        let short: &[(usize, usize)] = if few.is_some() { &[] } else { &SHORT };
        let mut descent = self.settled(&posterior, &priors, short, &mut rounds, &mut shared)?;
        let (mut checks, mut is_checked) = ([0, 0], false);
        while descent.may_be_minimum() && !shared.watch.is_over() {
            let Reached { p, noise, .. } = &rounds.reached;
            let innovations = posterior.innovations(runs, *noise, p);
            let evaluations = Evaluations::of(&innovations);
            let some = few.as_ref().map(|few| posterior.innovations(few, *noise, p));
            let of_few = some.as_ref().map(|some| Evaluations::of(some));
            let share = few.as_ref().map_or(1.0, |few| share_of(few, runs));
            let search = Search { evaluations: of_few.as_ref().unwrap_or(&evaluations), share };
            let stage = self.likelihood_stage(&evaluations, &innovations, &priors);
            let lower = self.lower_nearby(&stage, search, &descent, checks[0], &mut shared)?;
            checks = [checks[0] + 1, checks[1] + usize::from(lower.is_some())];
            let Some(lower) = lower else {
                is_checked = true;
                break;
            };
            let noise = *noise;
            rounds.reached = posterior.reached(&lower, &noise, &mut rounds.information);
            (rounds.multipliers, rounds.near) = (None, false);
            descent = self.settled(&posterior, &priors, &[], &mut rounds, &mut shared)?;
        }
        let Rounds { reached, count, .. } = rounds;
        self.check_feasible(&descent)?;
        let end = self.ended(descent, is_checked, priors, shared.work, checks);
        let innovations = posterior.innovations(runs, reached.noise, &end.p);
        let (log_posterior, noise) = (reached.value, reached.noise);
        let likelihood = Likelihood { start_log_posterior, log_posterior, noise, rounds: count };
        Ok(LikelihoodEnd { end, innovations, likelihood })
    }

    /// A start for all runs from a few of them, where it is better than the fit's own.
    fn approach_by_likelihood(
        &self,
        posterior: &Posterior,
        few: &[Run],
        priors: &Priors,
        rounds: &mut Rounds,
        shared: &mut Shared,
    ) -> Result<(), FitError> {
        let Posterior { task, free, noise_prior, .. } = posterior;
        let of_few = Posterior { task, runs: few, free: free.clone(), noise_prior: *noise_prior };
        let mut information = KeptInformation::default();
        let reached = of_few.reached(&rounds.reached.p, &rounds.reached.noise, &mut information);
        let mut near = Rounds { reached, multipliers: None, near: false, count: 0, information };
        let before = std::mem::take(&mut shared.work);
        self.with_noise(&of_few, priors, &SHORT, &mut near, shared)?;
        let own = std::mem::replace(&mut shared.work, before);
        shared.work.join(&own, share_of(few, posterior.runs));
        let there = posterior.reached(&near.reached.p, &near.reached.noise, &mut rounds.information);
        rounds.count = near.count;
        if there.value > rounds.reached.value || !self.is_feasible(&rounds.reached.p) {
            (rounds.reached, rounds.multipliers) = (there, near.multipliers);
        }
        Ok(())
    }

    /// Rounds of gains, parameters and noise, the first of them `short`, and then of gains and parameters alone.
    fn settled(
        &self,
        posterior: &Posterior,
        priors: &Priors,
        short: &[(usize, usize)],
        rounds: &mut Rounds,
        shared: &mut Shared,
    ) -> Result<Descent, FitError> {
        let descent = self.with_noise(posterior, priors, short, rounds, shared)?;
        self.with_gains(posterior, priors, descent, LEFT, rounds, shared)
    }

    /// Rounds of gains and parameters with the noise as it is, until the objective falls by less than `left`. A measurement that is no outlier to
    /// the new gains comes back, so that a round may fall by more than the one before.
    fn with_gains(
        &self,
        posterior: &Posterior,
        priors: &Priors,
        mut descent: Descent,
        left: f64,
        rounds: &mut Rounds,
        shared: &mut Shared,
    ) -> Result<Descent, FitError> {
        for _ in 0..ROUNDS {
            if shared.watch.is_over() {
                break;
            }
            let (next, fall) = self.round(posterior, priors, None, rounds, shared)?;
            let noise = rounds.reached.noise;
            let value = posterior.log_density(&next.p, &noise);
            if !(fall >= 0.0 && value.is_finite()) {
                break;
            }
            rounds.reached = Reached { p: next.p.clone(), noise, value };
            descent = next;
            if fall < left {
                break;
            }
        }
        descent.p.clone_from(&rounds.reached.p);
        Ok(descent)
    }

    /// Rounds of gains, parameters and noise until the log-posterior rises no more; the first of them are `short`, and those near the optimum.
    /// Gains and noise of where the last one ended are left to what follows.
    fn with_noise(
        &self,
        posterior: &Posterior,
        priors: &Priors,
        short: &[(usize, usize)],
        rounds: &mut Rounds,
        shared: &mut Shared,
    ) -> Result<Descent, FitError> {
        let mut round = 0;
        loop {
            round += 1;
            let far = short.iter().find(|(until, _)| round <= *until).map(|(_, most)| *most);
            let close = if rounds.multipliers.is_none() && round == 1 { FIRST_CLOSE } else { CLOSE };
            let most = far.or(rounds.near.then_some(close));
            let (mut descent, fall) = self.round(posterior, priors, most, rounds, shared)?;
            let Reached { noise, value: before, .. } = rounds.reached;
            let next = posterior.reached(&descent.p, &noise, &mut rounds.information);
            let rise = next.value - before;
            // A few steps that end far from the optimum, or above where they began since that was not within limits, have not arrived.
            let arrived = most.is_none() || descent.optimum.is_some() || far.is_none() && fall > -SETTLED;
            let settled = arrived && rise < SETTLED;
            rounds.near |= most.is_none();
            if next.value.is_finite() && (rise >= 0.0 || most.is_some() || round == 1) {
                rounds.reached = next;
            }
            if settled || round >= ROUNDS || shared.watch.is_over() {
                descent.p.clone_from(&rounds.reached.p);
                return Ok(descent);
            }
        }
    }

    /// A round: gains made where the last one ended, and a solve with these, of `most` iterations at most. It gives where the solve ended and by
    /// how much the objective fell, NaN where it has no value.
    fn round(
        &self,
        posterior: &Posterior,
        priors: &Priors,
        most: Option<usize>,
        rounds: &mut Rounds,
        shared: &mut Shared,
    ) -> Result<(Descent, f64), FitError> {
        rounds.count += 1;
        let Reached { p, noise, .. } = &rounds.reached;
        let innovations = posterior.innovations(posterior.runs, *noise, p);
        let evaluations = Evaluations::of(&innovations);
        let mut stage = self.likelihood_stage(&evaluations, &innovations, priors);
        stage.max_iterations = stage.max_iterations.min(most.unwrap_or(usize::MAX));
        if posterior.runs.len() < self.runs.len() {
            stage.part = FEW;
        }
        let near = rounds.near || rounds.multipliers.is_some();
        let from = From { p, near, multipliers: rounds.multipliers.take() };
        let before = stage.total(p);
        let descent = self.descend(&stage, from, &mut Curvature::unknown(p.len()), shared)?;
        let fall = before.zip(stage.total(&descent.p)).map_or(f64::NAN, |(before, after)| before - after);
        let of_last = || descent.last.as_ref().filter(|_| most.is_some()).map(|last| &last.multipliers);
        rounds.multipliers = descent.optimum.as_ref().map(|(_, own)| own).or_else(of_last).cloned();
        Ok((descent, fall))
    }

    /// A solve of the likelihood with fixed gains.
    fn likelihood_stage<'s>(
        &'s self,
        evaluations: &'s Evaluations<'s>,
        innovations: &Innovations,
        priors: &'s Priors,
    ) -> Stage<'s> {
        let mut stage = self.stage(evaluations, priors);
        if stage.hessian == Hessian::Exact {
            stage.hessian = Hessian::GaussNewton;
        }
        let unit = innovations.factor();
        stage.tolerance = stage.tolerance.max(GRADIENT * unit);
        stage.settled = Some(Settled { gradient: ROUGH * unit, change: CHANGE * unit });
        stage
    }
}

/// The samples of a few runs over those of all.
fn share_of(few: &[Run], all: &[Run]) -> f64 {
    samples(few) as f64 / samples(all) as f64
}

/// The priors of the variables of a likelihood.
fn priors(free: &[FreeParameter]) -> Priors {
    let prior = |(j, f): (usize, &FreeParameter)| f.prior.map(|prior| (j, prior.mean, prior.sd));
    Priors { terms: free.iter().enumerate().filter_map(prior).collect(), weight: 0.5 }
}

/// An estimate as a fit by likelihood ends: from where it is solved through Ipopt within the bounds of all its parameters, sums with what
/// sessions add among them, and within the constraints; noise and gains in turn, until neither gains what could turn a comparison.
///
/// # Errors
/// As [`super::fit`]; an estimate that no step improves is none.
pub(crate) fn within_limits(
    found: &Estimate,
    integration: Integration,
    runs: &[Run],
    noise_prior: &NoisePrior,
    constraints: ConstraintSettings,
) -> Result<Estimate, FitError> {
    let settings = FitSettings { objective: Goal::Likelihood, integration, constraints, ..FitSettings::default() };
    let mut model = found.model.clone();
    let (common, of_sessions): (Vec<&FreeParameter>, Vec<&FreeParameter>) =
        found.free.iter().partition(|f| f.sessions.is_none());
    for (i, p) in model.parameters.iter_mut().enumerate() {
        let own = common.iter().find(|f| f.column.parameter == i);
        (p.free, p.prior) = (own.is_some(), own.and_then(|f| f.prior));
    }
    let deviations: Vec<FreeParameter> = of_sessions.into_iter().cloned().collect();
    let of_all = |i: usize| common.iter().find(|f| f.column.parameter == i).map(|f| (*f).clone());
    let free: Vec<FreeParameter> =
        model.free().into_iter().filter_map(of_all).chain(deviations.iter().cloned()).collect();
    let cost = Cost::new(&model, runs, settings.cost_options())?;
    let task = Task::new(&model, &cost, Runs::from(runs), &settings)?.beside(deviations);
    let watch = Watch::new(&settings, task.cost.ranks());
    let progress = &mut |_: &Progress| true;
    let mut shared = Shared { watch, work: Work::default(), progress, rows: WorkingRows::of(&task) };
    let priors = priors(&free);
    let posterior = Posterior { task: &task, runs, free, noise_prior: *noise_prior };
    let value = posterior.log_density(&task.start, &found.noise);
    let reached = Reached { p: task.start.clone(), noise: found.noise, value };
    let mut rounds =
        Rounds { reached, multipliers: None, near: true, count: 0, information: KeptInformation::default() };
    let end = task.with_noise(&posterior, &priors, &[], &mut rounds, &mut shared)?;
    let end = task.with_gains(&posterior, &priors, end, SETTLED, &mut rounds, &mut shared)?;
    task.check_feasible(&end)?;
    let Reached { p, noise, .. } = rounds.reached;
    let mut model = task.model_at(&p);
    for (p, own) in model.parameters.iter_mut().zip(&found.model.parameters) {
        (p.free, p.prior) = (own.free, own.prior);
    }
    let log_posterior = log_posterior(&model, integration, runs, &found.free, &noise);
    Ok(Estimate { model, noise, free: found.free.clone(), log_posterior, seen: None })
}

/// Refuses several ranks: the runs of a likelihood are all in one process.
pub(in crate::fit) fn check_ranks(cost: &Cost) -> Result<(), FitError> {
    if cost.ranks().size() > 1 { Err(FitError::OneRank) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{RK4, at, model, noise, runs};
    use crate::fit::objectives::innovations::with_uncertain_coefficients;
    use crate::fit::{Fit, fit};
    use crate::model::Model;
    use nalgebra::DVector;

    fn settings() -> FitSettings {
        let mut settings = FitSettings { objective: Goal::Likelihood, integration: RK4, ..FitSettings::default() };
        settings.constraints.off = true;
        settings
    }

    fn off(by: f64) -> Model {
        let mut model = model();
        for i in model.free() {
            model.parameters[i].value *= by;
        }
        model
    }

    #[test]
    fn the_gradient_is_the_slope_of_the_objective_at_fixed_gains() -> Result<(), FitError> {
        let (start, runs, settings) = (off(1.05), runs(&model(), 3), settings());
        let cost = Cost::new(&start, &runs, settings.cost_options())?;
        let task = Task::new(&start, &cost, (&runs[..]).into(), &settings)?;
        let free = base_parameters(&start, false);
        let innovations = Innovations::of(&start, &runs, RK4, &free, noise(), &task.start);
        let Some(quadratic) = innovations.quadratic(&task.start) else { return Err(FitError::NoRuns) };
        for (j, scale) in task.scaling.scales.iter().enumerate() {
            let value = |d: f64| {
                let mut p = task.start.clone();
                p[j] += d * scale;
                innovations.value(&p).unwrap_or(f64::NAN)
            };
            let slope = (value(1e-4) - value(-1e-4)) / 2e-4;
            let own = quadratic.gradient[j] * scale;
            assert!((own - slope).abs() < 1e-3 * slope.abs().max(1.0), "{j}: {own} {slope}");
        }
        let sum = quadratic.by_run.iter().fold(DVector::zeros(task.start.len()), |sum: DVector<f64>, g| sum + g);
        assert!((sum - &quadratic.gradient).amax() <= 1e-9 * quadratic.gradient.amax());
        Ok(())
    }

    #[test]
    fn parameters_off_by_a_tenth_come_back_within_their_standard_errors() -> Result<(), FitError> {
        let (truth, start) = (model(), off(1.1));
        let runs = runs(&truth, 9);
        let found: Fit = fit(&start, &runs[..], &settings(), &mut |_| true)?;
        assert!(found.converged, "{}", found.headline);
        let said = found.likelihood.as_ref().ok_or(FitError::NoRuns)?;
        assert!(said.log_posterior > said.start_log_posterior + 1.0);
        assert!(found.estimates.len() > truth.free().len(), "the hull is estimated along");
        for i in truth.free() {
            let p = &truth.parameters[i];
            let own = found.estimates.iter().find(|e| e.name == p.name);
            let Some((value, Some(error))) = own.map(|e| (e.value, e.standard_error)) else { continue };
            assert!((value - p.value).abs() < 4.5 * error, "{}: {value} {} +- {error}", p.name, p.value);
        }
        assert_eq!(found.model.free(), truth.free(), "what was estimated along is not free in the fitted model");
        Ok(())
    }

    #[test]
    fn with_noise_and_gains_of_its_end_a_newton_step_promises_next_to_nothing() -> Result<(), FitError> {
        // A current that the model lacks: the noise then depends on the parameters, and they on the noise.
        let (start, settings) = (off(1.05), settings());
        let runs = runs(&crate::diagnose::example::with(&[("current.north", 0.6)]), 12);
        let found = fit(&start, &runs[..], &settings, &mut |_| true)?;
        let noise = found.likelihood.as_ref().ok_or(FitError::NoRuns)?.noise;
        let start = with_uncertain_coefficients(&start);
        let free = base_parameters(&start, false);
        let p: Vec<f64> = found.estimates.iter().map(|e| e.value).collect();
        assert_eq!(free.len(), p.len());
        let innovations = Innovations::of(&start, &runs, RK4, &free, noise, &p);
        let Some(quadratic) = innovations.quadratic(&p) else { return Err(FitError::NoRuns) };
        let (mut gradient, mut matrix, priors) = (quadratic.gradient, quadratic.gauss_newton, priors(&free));
        priors.add_gradient(&p, &mut gradient);
        priors.add_hessian(&mut matrix);
        let scale = |j: usize| matrix[(j, j)].sqrt();
        // The others are at an active bound.
        let is_away = |j: &usize| {
            let own = &start.parameters[free[*j].column.parameter];
            (p[*j] - own.lower).min(own.upper - p[*j]) > 1e-2 * own.scale
        };
        let away: Vec<usize> = (0..p.len()).filter(is_away).collect();
        assert!(away.len() > 20, "{}", away.len());
        let n = away.len();
        let unit = DMatrix::from_fn(n, n, |i, j| matrix[(away[i], away[j])] / scale(away[i]) / scale(away[j]));
        let slope = DVector::from_fn(n, |j, _| gradient[away[j]] / scale(away[j]));
        let step = unit.lu().solve(&slope).ok_or(FitError::NothingFree)?;
        let promise = 0.5 * step.dot(&slope);
        assert!((0.0..0.1).contains(&promise), "{promise}");
        Ok(())
    }

    #[test]
    fn an_estimate_off_the_optimum_is_taken_there_within_limits() -> Result<(), FitError> {
        let (truth, runs) = (model(), runs(&model(), 9));
        let mut found = at(&off(1.1));
        found.log_posterior = log_posterior(&found.model, RK4, &runs, &found.free, &found.noise);
        let prior = NoisePrior::around(&found.noise);
        let written = within_limits(&found, RK4, &runs, &prior, ConstraintSettings::default())?;
        assert!(written.log_posterior > found.log_posterior + 1.0);
        assert_eq!((written.free.len(), written.model.free()), (found.free.len(), truth.free()));
        Ok(())
    }

    #[test]
    fn a_fit_by_likelihood_has_the_same_bits_on_one_thread_and_on_two() -> Result<(), FitError> {
        let (start, runs) = (off(1.05), runs(&model(), 4));
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            let settings = FitSettings { max_iterations: 20, ..settings() };
            pool.map(|pool| pool.install(|| fit(&start, &runs[..], &settings, &mut |_| true)))
        };
        let (Ok(one), Ok(two)) = (on(1), on(2)) else { return Err(FitError::NoRuns) };
        let bits = |fit: &Fit| fit.estimates.iter().map(|e| e.value.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&one?), bits(&two?));
        Ok(())
    }
}
