//! The fit by likelihood: parameters with priors, an unknown force, sensor noise and initial states, solved through Ipopt like any other.
//! The likelihood itself is that of `crate::likelihood`; which terms a model has is decided elsewhere.
//!
//! With the gains of the Kalman filter held fixed, half the sum of squared standardised innovations
//!
//! ```text
//! f(p) = 1/2 sum_k e_k^2 / s_k + 1/2 sum_j ((p_j - mean_j) / sd_j)^2
//! ```
//!
//! is a smooth function of the parameters; the filter's sensitivities are exactly its derivatives, and the Fisher information is its
//! Gauss-Newton matrix. Ipopt minimises it within constraints and bounds; then the noise is estimated anew by maximum likelihood, the
//! gains follow, and it is minimised again, until the log-posterior rises no more. Where it ends, the scores of the filter, which are
//! unbiased at the true parameters whatever the gains, are zero in the directions that no constraint blocks.
//!
//! Hull, propeller and rudder coefficients that are never known exactly are estimated along, with the values of the model as means and the
//! spreads of their terms as standard deviations of their priors.

use super::cost::{Cost, Quadratic};
use super::curvature::Curvature;
use super::descent::{From, Shared, Work};
use super::error::FitError;
use super::evaluations::Evaluations;
use super::limits::Watch;
use super::objective::Objective;
use super::problem::{Priors, Progress};
use super::rows::WorkingRows;
use super::settings::Hessian;
use super::solve::End;
use super::task::Task;
use crate::ipopt::Multipliers;
use crate::likelihood::estimate::{fitted_noise, log_posterior};
use crate::likelihood::filter::{Column, Filter, Gains, Pass, Wanted};
use crate::likelihood::noise::{Noise, NoisePrior};
use crate::likelihood::noise_fit::guess;
use crate::likelihood::parameters::{FreeParameter, NUISANCE};
use crate::model::{Model, Prior};
use crate::recording::Run;
use crate::simulate::Integration;
use nalgebra::{DMatrix, DVector};
use serde::Serialize;

/// Rounds of gains and noise at most.
const ROUNDS: usize = 30;

/// Rounds up to which a solve takes at most so many iterations: with gains held fixed the objective far from where they were made is another
/// one, and what is gained there is lost when they are renewed.
const SHORT: [(usize, usize); 2] = [(3, 4), (6, 16)];

/// Rise of the log-posterior in a round below which gains and noise are settled: a tenth of a likelihood unit turns no comparison.
const SETTLED: f64 = 0.1;

/// Likelihood units by which a start may be below the optimum with gains and noise held fixed: the barrier's own scale, a thousandth of it at
/// first, is then one unit.
const REACH: f64 = 1e3;

/// Largest gradient that a solve leaves, in likelihood units by a parameter's scale: what it leaves to be gained is far below [`SETTLED`].
const GRADIENT: f64 = 0.01;

/// Iterations of the noise estimate in a round.
const NOISE_ITERATIONS: usize = 8;

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

/// The negative log-likelihood of runs with the filter's gains held fixed, as a function of the free parameters.
pub(super) struct Innovations<'a> {
    model: &'a Model,
    free: Vec<usize>,
    integration: Integration,
    runs: &'a [Run],
    noise: Noise,
    gains: Vec<Gains>,
    columns: Vec<Column>,
    samples: usize,
}

/// Where a fit by likelihood ended, with the objective of its last round.
pub(super) struct LikelihoodEnd<'a> {
    pub end: End,
    pub innovations: Innovations<'a>,
    pub likelihood: Likelihood,
}

/// The model of a fit by likelihood: coefficients that are never known exactly are free too, with priors.
pub(super) fn with_uncertain_coefficients(model: &Model) -> Model {
    let mut model = model.clone();
    for name in NUISANCE {
        let Some(i) = model.index(name).filter(|i| !model.parameters[*i].free) else { continue };
        let prior = model.parameters[i].prior.or(FreeParameter::uncertain(&model, i).prior);
        let p = &mut model.parameters[i];
        // Whatever the prior says, a value beyond its bounds is no ship.
        (p.free, p.prior) = (true, prior);
    }
    model
}

impl<'a> Innovations<'a> {
    /// With the gains of the filter at `p`.
    fn new(task: &'a Task, runs: &'a [Run], noise: Noise, p: &[f64]) -> Self {
        let (model, integration) = (task.model, task.settings.integration);
        let at = task.model_at(p);
        let filter = Filter::new(&at, integration, &[]);
        let passes = filter.passes(runs, &noise, Wanted { gains: true, ..Wanted::default() });
        let gains = passes.into_iter().map(|pass| pass.gains.unwrap_or_default()).collect();
        let free = model.free();
        // In the parameters' own units.
        let column = |i: &usize| Column { scale: 1.0, ..Column::tangent(model, *i) };
        let columns = free.iter().map(column).collect();
        let samples = runs.iter().map(|run| run.measured.len()).sum();
        Self { model, free, integration, runs, noise, gains, columns, samples }
    }

    fn at(&self, p: &[f64]) -> Model {
        let mut model = self.model.clone();
        for (i, value) in self.free.iter().zip(p) {
            model.parameters[*i].value = *value;
        }
        model
    }

    /// Half the sum of squared innovations, and what `take` makes of each pass; `None` where the model left the numbers.
    fn passes(&self, p: &[f64], columns: &[Column], mut take: impl FnMut(DVector<f64>, DMatrix<f64>)) -> Option<f64> {
        let model = self.at(p);
        let filter = Filter::new(&model, self.integration, columns);
        let wanted = Wanted { frozen: Some(&self.gains), exact: true, ..Wanted::default() };
        let work = |_: &Run, pass: Pass| {
            let Pass { score, information, innovations, filtered, .. } = pass;
            // A model that left the numbers has no innovations at all, and would look perfect.
            let finite = filtered.iter().flatten().all(|z| z.is_finite());
            let square: f64 = innovations.iter().flatten().filter(|e| !e.is_nan()).map(|e| e * e).sum();
            (0.5 * square, finite, score, information)
        };
        let (mut value, mut is_finite) = (0.0, true);
        filter.each(self.runs, &self.noise, wanted, work, |(square, finite, score, information)| {
            value += square;
            is_finite &= finite;
            take(score, information);
        });
        (is_finite && value.is_finite()).then_some(value)
    }
}

impl Objective for Innovations<'_> {
    fn value(&self, p: &[f64]) -> Option<f64> {
        self.passes(p, &[], |_, _| ())
    }

    fn quadratic(&self, p: &[f64], _with_matrix: bool) -> Option<Quadratic> {
        let n = self.free.len();
        let (mut gradient, mut information, mut by_run) = (DVector::zeros(n), DMatrix::zeros(n, n), Vec::new());
        let value = self.passes(p, &self.columns, |score, own| {
            gradient -= &score;
            information += own;
            by_run.push(-score);
        })?;
        let finite = gradient.iter().chain(information.iter()).all(|v: &f64| v.is_finite());
        finite.then_some(Quadratic { value, gradient, gauss_newton: information, by_run })
    }

    fn hessian(&self, _p: &[f64]) -> Option<DMatrix<f64>> {
        None
    }

    /// One over the number of samples.
    fn factor(&self) -> f64 {
        1.0 / self.samples.max(1) as f64
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

impl Posterior<'_> {
    /// Log-likelihood plus log-priors of parameters and noise.
    fn log_density(&self, p: &[f64], noise: &Noise) -> f64 {
        let (model, integration) = (self.task.model_at(p), self.task.settings.integration);
        let of_parameters = log_posterior(&model, integration, self.runs, &self.free, noise);
        of_parameters + self.noise_prior.log_density(&noise.to_log())
    }

    /// The noise of the runs at these parameters.
    fn noise(&self, p: &[f64], from: &Noise) -> Noise {
        let (model, integration) = (self.task.model_at(p), self.task.settings.integration);
        fitted_noise(&model, integration, self.runs, from, &self.noise_prior, NOISE_ITERATIONS)
    }
}

/// Parameters and noise with their log-posterior.
struct Reached {
    p: Vec<f64>,
    noise: Noise,
    value: f64,
}

impl<'t> Task<'t> {
    /// Solves by likelihood: noise, gains and parameters in turn, and at the end the check of the optimum.
    pub fn solve_by_likelihood<'a>(
        &'a self,
        runs: &'a [Run],
        progress: &mut dyn FnMut(&Progress) -> bool,
    ) -> Result<LikelihoodEnd<'a>, FitError> {
        let watch = Watch::new(self.settings, self.cost.ranks());
        let mut shared = Shared { watch, work: Work::default(), progress, rows: WorkingRows::of(self) };
        let mut priors = Priors::of(self.model);
        priors.weight = 0.5;
        let free: Vec<FreeParameter> = self.model.free().into_iter().map(|i| common(self.model, i)).collect();
        let first = guess(runs, self.model);
        let posterior = Posterior { task: self, runs, free, noise_prior: NoisePrior::around(&first) };
        let noise = posterior.noise(&self.start, &first);
        let value = posterior.log_density(&self.start, &noise);
        let (mut reached, start_log_posterior) = (Reached { p: self.start.clone(), noise, value }, value);
        let mut multipliers: Option<Multipliers> = None;
        let (mut rounds, mut checks, mut is_checked) = (0, [0, 0], false);
        let mut last = None;
        while rounds < ROUNDS && !is_checked && !shared.watch.is_over() {
            rounds += 1;
            let innovations = Innovations::new(self, runs, reached.noise, &reached.p);
            let evaluations = Evaluations::of(&innovations);
            let mut stage = self.stage(&evaluations, &priors);
            if stage.hessian == Hessian::Exact {
                stage.hessian = Hessian::GaussNewton;
            }
            stage.tolerance = stage.tolerance.max(GRADIENT * innovations.factor());
            let short = SHORT.iter().find(|(until, _)| rounds <= *until).map(|(_, most)| *most);
            stage.max_iterations = stage.max_iterations.min(short.unwrap_or(usize::MAX));
            let from = From { p: &reached.p, near: multipliers.is_some(), multipliers: multipliers.take() };
            let mut descent = self.descend(&stage, from, &mut Curvature::unknown(reached.p.len()), &mut shared)?;
            let noise = posterior.noise(&descent.p, &reached.noise);
            let value = posterior.log_density(&descent.p, &noise);
            let settled = short.is_none() && value - reached.value < SETTLED;
            if settled && descent.may_be_minimum() && !shared.watch.is_over() {
                let lower = self.lower_nearby(&stage, &descent, checks[0], &mut shared)?;
                checks = [checks[0] + 1, checks[1] + usize::from(lower.is_some())];
                is_checked = lower.is_none();
                if let Some(lower) = lower {
                    descent.p = lower;
                    descent.optimum = None;
                }
            }
            if value.is_finite() && (value >= reached.value || short.is_some() || last.is_none()) {
                reached = Reached { p: descent.p.clone(), noise, value };
            }
            multipliers = descent.optimum.as_ref().map(|(_, multipliers)| multipliers.clone());
            last = Some(descent);
        }
        let Some(mut descent) = last else { return Err(FitError::NothingFree) };
        descent.p.clone_from(&reached.p);
        self.check_feasible(&descent)?;
        let end = self.ended(descent, is_checked, priors, shared.work, checks);
        let innovations = Innovations::new(self, runs, reached.noise, &end.p);
        let likelihood = Likelihood { start_log_posterior, log_posterior: reached.value, noise: reached.noise, rounds };
        Ok(LikelihoodEnd { end, innovations, likelihood })
    }
}

/// A parameter that acts in all runs, with its prior.
fn common(model: &Model, i: usize) -> FreeParameter {
    let prior: Option<Prior> = model.parameters[i].prior;
    FreeParameter::common(Column::tangent(model, i), prior)
}

/// Refuses several ranks: the runs of a likelihood are all in one process.
pub(super) fn check_ranks(cost: &Cost) -> Result<(), FitError> {
    if cost.ranks().size() > 1 { Err(FitError::OneRank) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{RK4, model, noise, runs};
    use crate::fit::{Fit, FitSettings, Goal, fit};

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
        let innovations = Innovations::new(&task, &runs, noise(), &task.start);
        let Some(quadratic) = innovations.quadratic(&task.start, true) else { return Err(FitError::NoRuns) };
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
