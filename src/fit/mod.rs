//! Fitting a model's parameters to recordings: from the cost and its constraints to estimates with their uncertainty.
//! It does not say which physics a model contains or how a ship is simulated; it takes both as given.
//!
//! | file | what |
//! |---|---|
//! | [`cost`] | the weighted trajectory cost and its derivatives |
//! | [`constraints`] | the constraints as data: curves bounded on grids |
//! | `problem` | both, scaled, with the priors, as Ipopt wants them |
//! | [`ipopt`] | the solver |
//! | `uncertainty` | covariances, and what the data do not determine |
//! | [`report`] | a fit in words and tables |
//! | [`multistart`] | the same fit from many starts |
//!
//! [`fit`] joins them.

pub mod constraints;
pub mod cost;
pub mod ipopt;
pub mod multistart;
mod problem;
pub mod report;
mod uncertainty;

pub use constraints::{ConstraintSettings, Limits, Rule};
pub use cost::{Cost, CostOptions, Derivatives, Quadratic};
pub use ipopt::Counts;
pub use multistart::{MultiStart, StartOutcome, multi_start};

use crate::model::Model;
use crate::recording::Run;
use crate::simulate::Integration;
use constraints::Row;
use ipopt::{HessianMode, IpoptError, OptionValue, Options, Solution, Status};
use nalgebra::{DMatrix, DVector};
use problem::{Priors, Problem, row_size};
use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, StudentsT};
use std::time::Instant;

/// Number of recordings from which on standard errors allow for what residuals of one recording share.
pub const SANDWICH_FROM: usize = 8;

/// Why there is no fit.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// There is nothing to fit to.
    #[error("there are no recordings to fit to; mark at least one run of the study for training")]
    NoRuns,
    /// There is nothing to fit.
    #[error("no parameter is free; set `free = true` for at least one parameter in the model file")]
    NothingFree,
    /// A run that the cost cannot use.
    #[error("run `{run}`: {what}")]
    BadRun {
        /// The run.
        run: String,
        /// What is wrong.
        what: String,
    },
    /// A setting that makes no sense.
    #[error("[fit] {name} = {value}: {expected}")]
    BadSetting {
        /// Its key.
        name: &'static str,
        /// The value found.
        value: f64,
        /// What it should be.
        expected: &'static str,
    },
    /// A constraint rule that cannot be imposed.
    #[error("[fit.constraints] {rule}: {what}")]
    BadRule {
        /// Its key.
        rule: String,
        /// What is wrong, and what to do.
        what: String,
    },
    /// The simulation diverges at the start.
    #[error(
        "the simulation of run `{run}` diverges at t = {time:.1} s with the starting parameters; start from parameters that \
         can be simulated, or use shorter windows or more integration sub-steps"
    )]
    Diverged {
        /// The run.
        run: String,
        /// When \[s\], on the recording's clock.
        time: f64,
    },
    /// The constraints contradict each other.
    #[error(
        "the constraints contradict each other: where the solver gave up, {sentence} is still broken by {violation:.3e}; relax \
         [fit.constraints] {rule}, or the bounds of its parameters"
    )]
    Infeasible {
        /// Key of the rule that is broken most.
        rule: &'static str,
        /// What it asks for.
        sentence: String,
        /// By how much it is broken, in its own unit.
        violation: f64,
    },
    /// The solver could not start.
    #[error("the solver could not start: {0}")]
    Solver(#[from] IpoptError),
}

/// Where the solver's second derivatives come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Hessian {
    /// From the first derivatives of the residuals: `2/M sum J^T W J`.
    #[default]
    GaussNewton,
    /// Exact, by second-order dual numbers.
    Exact,
    /// From the gradients of past steps (BFGS).
    LimitedMemory,
}

/// Section `[fit]` of a study.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct FitSettings {
    /// Where first derivatives come from.
    pub derivatives: Derivatives,
    /// Step of finite differences, in units of each parameter's scale.
    pub difference_step: f64,
    /// Where second derivatives come from.
    pub hessian: Hessian,
    /// Steps remembered by the limited-memory Hessian.
    pub history: usize,
    /// Optimality tolerance of the solver.
    pub tolerance: f64,
    /// Iterations after which to give up.
    pub max_iterations: usize,
    /// Newton steps within the active constraints after the solver, which end the barrier's last small bias; 0 for none.
    pub polish_steps: usize,
    /// r_max of the cost \[rad/s\].
    pub max_yaw_rate: f64,
    /// How many successive samples count as one where residuals are set against priors: residuals along a trajectory are
    /// alike, so that taking each for independent makes the data look more certain than they are.
    pub correlated_samples: f64,
    /// How often the weight of the priors is set anew from the residuals of the fit.
    pub prior_updates: usize,
    /// Whether the solver prints its log.
    pub print: bool,
    /// Constraints.
    pub constraints: ConstraintSettings,
    /// Integration of the simulation.
    pub integration: Integration,
}

impl Default for FitSettings {
    fn default() -> Self {
        Self {
            derivatives: Derivatives::default(),
            difference_step: 1e-5,
            hessian: Hessian::default(),
            history: ipopt::DEFAULT_HISTORY,
            tolerance: 1e-8,
            max_iterations: 500,
            polish_steps: 10,
            max_yaw_rate: 0.0314,
            correlated_samples: 1.0,
            prior_updates: 3,
            print: false,
            constraints: ConstraintSettings::default(),
            integration: Integration::default(),
        }
    }
}

impl FitSettings {
    fn check(&self) -> Result<(), FitError> {
        let positive = [
            ("difference_step", self.difference_step),
            ("tolerance", self.tolerance),
            ("max_yaw_rate", self.max_yaw_rate),
            ("correlated_samples", self.correlated_samples),
        ];
        match positive.iter().find(|(_, value)| !(value.is_finite() && *value > 0.0)) {
            Some((name, value)) => {
                Err(FitError::BadSetting { name, value: *value, expected: "it must be a positive number" })
            }
            None => Ok(()),
        }
    }

    fn cost_options(&self) -> CostOptions {
        CostOptions {
            max_yaw_rate: self.max_yaw_rate,
            derivatives: self.derivatives,
            difference_step: self.difference_step,
            integration: self.integration,
        }
    }
}

/// Where a running fit stands.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    /// Iteration of the solver.
    pub iteration: usize,
    /// Cost, priors included.
    pub cost: f64,
    /// Largest violation of a constraint, scaled.
    pub violation: f64,
    /// Largest entry of the gradient of the Lagrangian, scaled.
    pub optimality: f64,
}

/// What a fit says of one parameter.
#[derive(Clone, Debug, Serialize)]
pub struct Estimate {
    /// Dotted name.
    pub name: String,
    /// Symbol.
    pub symbol: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Value at the start.
    pub start: f64,
    /// Estimate.
    pub value: f64,
    /// Standard error; absent where the data do not determine the parameter, 0 where active constraints fix it.
    pub standard_error: Option<f64>,
    /// 95 % interval, absent with the standard error.
    pub interval: Option<[f64; 2]>,
    /// `lower` or `upper` where the estimate lies on a bound that holds it back.
    pub at_bound: Option<&'static str>,
}

/// Which covariance standard errors come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum CovarianceKind {
    /// Residuals taken as independent.
    GaussNewton,
    /// Recordings taken as independent, residuals of one recording not.
    Sandwich,
}

/// Covariance of the estimates, in the parameters' units and the order of the estimates.
///
/// An entry is absent where the data do not determine one of the two parameters.
pub type Covariance = Vec<Vec<Option<f64>>>;

/// A constraint that holds the fit back.
#[derive(Clone, Debug, Serialize)]
pub struct Active {
    /// In words: `R'(1.31 m/s) >= 0 N s/m`.
    pub sentence: String,
    /// Key of its rule, or `bounds`.
    pub rule: &'static str,
}

/// A combination of parameters and how well the data determine it.
#[derive(Clone, Debug, Serialize)]
pub struct Combination {
    /// In words, each parameter in units of its scale: `0.71 p5 - 0.70 p7`.
    pub words: String,
    /// Its standard deviation from the data alone, in the same units; absent where the data say nothing at all.
    pub standard_deviation: Option<f64>,
}

/// The outcome of a fit.
#[derive(Clone, Debug, Serialize)]
pub struct Fit {
    /// The model with the estimates in place.
    #[serde(skip)]
    pub model: Model,
    /// Whether the solver found an optimum.
    pub converged: bool,
    /// How it ended, in words.
    pub status: String,
    /// The free parameters.
    pub estimates: Vec<Estimate>,
    /// Which covariance `covariance`, `correlations` and the standard errors are.
    pub covariance_kind: CovarianceKind,
    /// Covariance with residuals taken as independent.
    pub covariance_gauss_newton: Covariance,
    /// Covariance with recordings taken as independent; absent with fewer than two.
    pub covariance_sandwich: Option<Covariance>,
    /// Correlations of the estimates.
    pub correlations: Covariance,
    /// How many times larger the variances are than independent residuals would make them; absent with fewer than two
    /// recordings.
    pub design_effect: Option<f64>,
    /// Constraints and bounds that hold the fit back.
    pub active: Vec<Active>,
    /// Combinations the data determine to no better than one scale unit, the worst first.
    pub undetermined: Vec<Combination>,
    /// Cost at the start, without priors.
    pub start_cost: f64,
    /// Cost at the end, without priors.
    pub cost: f64,
    /// What the priors add to it.
    pub prior_cost: f64,
    /// Variance of the weighted residuals.
    pub residual_variance: f64,
    /// Number of runs.
    pub runs: usize,
    /// Number of recordings they come from.
    pub recordings: usize,
    /// Number of residuals.
    pub residuals: usize,
    /// Number of constraint rows.
    pub constraints: usize,
    /// Iterations of the solver.
    pub iterations: usize,
    /// Evaluations by the solver.
    #[serde(serialize_with = "serialize_counts")]
    pub counts: Counts,
    /// Time taken \[s\].
    pub seconds: f64,
    /// The settings.
    pub settings: FitSettings,
}

fn serialize_counts<S: serde::Serializer>(counts: &Counts, serializer: S) -> Result<S::Ok, S::Error> {
    use serde::ser::SerializeStruct;
    let mut s = serializer.serialize_struct("Counts", 5)?;
    s.serialize_field("objective", &counts.objective)?;
    s.serialize_field("gradient", &counts.gradient)?;
    s.serialize_field("constraints", &counts.constraints)?;
    s.serialize_field("jacobian", &counts.jacobian)?;
    s.serialize_field("hessian", &counts.hessian)?;
    s.end()
}

/// Fits the free parameters of `model` to `runs`, starting from their values.
///
/// `progress` is called once per iteration; it stops the fit by returning false. A fit that does not converge is a result:
/// [`Fit::converged`] is false and [`Fit::status`] says why.
///
/// # Errors
/// See [`FitError`]: nothing to fit or to fit to, unusable runs or settings, a simulation that diverges at the start,
/// constraints that contradict each other.
pub fn fit(
    model: &Model,
    runs: &[Run],
    settings: &FitSettings,
    progress: &mut dyn FnMut(&Progress) -> bool,
) -> Result<Fit, FitError> {
    let clock = Instant::now();
    settings.check()?;
    let cost = Cost::new(model, runs, settings.cost_options())?;
    let task = Task::new(model, &cost, runs, settings)?;
    let mut end = task.solve(progress)?;
    task.polish(&mut end);
    Ok(task.describe(end, clock))
}

/// What stays fixed during a fit.
struct Task<'a> {
    model: &'a Model,
    cost: &'a Cost<'a>,
    runs: &'a [Run],
    settings: &'a FitSettings,
    rows: Vec<Row>,
    scales: Vec<f64>,
    bounds: Vec<(f64, f64)>,
    start: Vec<f64>,
    start_cost: f64,
}

/// Where the solver ended.
struct End {
    p: Vec<f64>,
    priors: Priors,
    status: Status,
    iterations: usize,
    counts: Counts,
    active: ActiveSet,
}

/// Rows and bounds that hold the solution back.
struct ActiveSet {
    rows: Vec<usize>,
    /// Index of the free parameter, and which bound.
    bounds: Vec<(usize, &'static str)>,
}

impl<'a> Task<'a> {
    fn new(model: &'a Model, cost: &'a Cost<'a>, runs: &'a [Run], settings: &'a FitSettings) -> Result<Self, FitError> {
        let free: Vec<&crate::model::Parameter> = cost.free().iter().map(|i| &model.parameters[*i]).collect();
        if free.is_empty() {
            return Err(FitError::NothingFree);
        }
        let rows = constraints::rows(model, &settings.constraints, constraints::speed_range(runs))?;
        let bounds: Vec<(f64, f64)> = free.iter().map(|p| (p.lower, p.upper)).collect();
        let start: Vec<f64> = free.iter().map(|p| p.value.max(p.lower).min(p.upper)).collect();
        let Some(start_cost) = cost.value(&start) else {
            let (run, time) =
                cost.divergence(&start).unwrap_or_else(|| (runs[0].recording.clone(), runs[0].start_time()));
            return Err(FitError::Diverged { run, time });
        };
        let scales = free.iter().map(|p| if p.scale > 0.0 && p.scale.is_finite() { p.scale } else { 1.0 }).collect();
        Ok(Self { model, cost, runs, settings, rows, scales, bounds, start, start_cost })
    }

    /// One over the mean number of samples of a run.
    fn factor(&self) -> f64 {
        let samples: usize = self.runs.iter().map(|r| r.measured.len()).sum();
        self.runs.len() as f64 / samples as f64
    }

    /// Variance of the weighted residuals at a given cost.
    fn variance(&self, cost: f64) -> f64 {
        let freedom = self.cost.residuals().saturating_sub(self.scales.len()).max(1);
        cost * self.runs.len() as f64 / freedom as f64
    }

    fn options(&self) -> Options {
        Options {
            tolerance: self.settings.tolerance,
            max_iterations: self.settings.max_iterations,
            hessian: match self.settings.hessian {
                Hessian::LimitedMemory => HessianMode::LimitedMemory { history: self.settings.history },
                Hessian::GaussNewton | Hessian::Exact => HessianMode::Given,
            },
            linear_constraints: true,
            print: self.settings.print,
            extra: vec![("mu_strategy".into(), OptionValue::Text("adaptive".into()))],
            ..Options::default()
        }
    }

    /// Solves, and where there are priors solves again with their weight set by the residuals just found.
    fn solve(&self, progress: &mut dyn FnMut(&Progress) -> bool) -> Result<End, FitError> {
        let mut priors = Priors::of(self.model);
        let rounds = if priors.terms.is_empty() { 1 } else { 1 + self.settings.prior_updates };
        let weight = |cost: f64| self.variance(cost) * self.settings.correlated_samples / self.runs.len() as f64;
        let mut p = self.start.clone();
        let mut data_cost = self.start_cost;
        let (mut iterations, mut counts) = (0, Counts::default());
        let mut last: Option<(Solution, f64)> = None;
        for _ in 0..rounds {
            let next = weight(data_cost);
            if last.as_ref().is_some_and(|(_, weight)| (next - weight).abs() <= 0.01 * weight) {
                break;
            }
            priors.weight = next;
            let (cost, factor) = (self.cost, self.factor());
            let mut problem = Problem::new(
                cost,
                &self.rows,
                &priors,
                &self.scales,
                &self.bounds,
                &p,
                factor,
                self.settings.hessian,
                progress,
            );
            let solution = ipopt::solve(&mut problem, &self.options())?;
            p = solution.x.iter().zip(&self.scales).map(|(z, s)| z * s).collect();
            for (p, (lower, upper)) in p.iter_mut().zip(&self.bounds) {
                *p = p.max(*lower).min(*upper);
            }
            iterations += solution.iterations;
            counts.objective += solution.counts.objective;
            counts.gradient += solution.counts.gradient;
            counts.constraints += solution.counts.constraints;
            counts.jacobian += solution.counts.jacobian;
            counts.hessian += solution.counts.hessian;
            let converged = solution.status.is_success();
            data_cost = self.cost.value(&p).unwrap_or(f64::INFINITY);
            last = Some((solution, next));
            if !converged || !data_cost.is_finite() {
                break;
            }
        }
        let Some((solution, _)) = last else { return Err(FitError::NothingFree) };
        self.check_feasible(&p, &solution)?;
        let active = self.active_set(&p, &solution);
        Ok(End { p, priors, status: solution.status, iterations, counts, active })
    }

    /// Infeasibility is an error where it is the constraints' own: they are linear, so that Ipopt's word is final.
    fn check_feasible(&self, p: &[f64], solution: &Solution) -> Result<(), FitError> {
        if !matches!(solution.status, Status::Infeasible | Status::RestorationFailed) {
            return Ok(());
        }
        let broken = |row: &&Row| row.violation(p) / row_size(row, &self.scales);
        let worst = self.rows.iter().max_by(|a, b| broken(a).total_cmp(&broken(b)));
        match worst {
            Some(row) if broken(&row) > 1e-6 => {
                Err(FitError::Infeasible { rule: row.rule, sentence: row.sentence(p), violation: row.violation(p) })
            }
            _ => Ok(()),
        }
    }

    /// What holds the solution back: the multiplier exceeds the distance from the limit, both in solver units.
    fn active_set(&self, p: &[f64], solution: &Solution) -> ActiveSet {
        let least = 1e3 * self.settings.tolerance * self.settings.tolerance.min(1e-3);
        let is_active = |multiplier: f64, slack: f64| multiplier.abs() > slack.abs().max(least);
        let rows = (0..self.rows.len()).filter(|i| {
            let row = &self.rows[*i];
            let value = row.value(p);
            let slack = (value - row.lower).abs().min((row.upper - value).abs()) / row_size(row, &self.scales);
            is_active(solution.constraint_multipliers[*i], slack)
        });
        let mut bounds = Vec::new();
        for (j, (lower, upper)) in self.bounds.iter().enumerate() {
            if is_active(solution.lower_bound_multipliers[j], (p[j] - lower) / self.scales[j]) {
                bounds.push((j, "lower"));
            } else if is_active(solution.upper_bound_multipliers[j], (upper - p[j]) / self.scales[j]) {
                bounds.push((j, "upper"));
            }
        }
        ActiveSet { rows: rows.collect(), bounds }
    }

    /// Directions in scaled parameters along which no active constraint changes.
    fn free_directions(&self, active: &ActiveSet) -> DMatrix<f64> {
        let n = self.scales.len();
        let mut normals: Vec<DVector<f64>> = Vec::new();
        for i in &active.rows {
            let row = &self.rows[*i];
            let size = row_size(row, &self.scales);
            let scaled = row.coefficients.iter().zip(&self.scales).map(|(a, s)| a * s / size);
            normals.push(DVector::from_iterator(n, scaled));
        }
        for (j, _) in &active.bounds {
            let mut normal = DVector::zeros(n);
            normal[*j] = 1.0;
            normals.push(normal);
        }
        uncertainty::null_space(&normals, n)
    }

    /// A matrix or vector by the parameters, by the scaled parameters.
    fn scaled(&self, matrix: &DMatrix<f64>) -> DMatrix<f64> {
        DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(i, j)] * self.scales[i] * self.scales[j])
    }

    fn scaled_vector(&self, vector: &DVector<f64>) -> DVector<f64> {
        DVector::from_fn(vector.len(), |i, _| vector[i] * self.scales[i])
    }

    /// Newton steps within the active constraints: an interior-point solution keeps a distance of the order of its barrier
    /// from every limit and is blurred along directions of little curvature.
    fn polish(&self, end: &mut End) {
        if !end.status.is_success() {
            return;
        }
        let z = self.free_directions(&end.active);
        let total = |p: &[f64]| Some(self.cost.value(p)? + end.priors.value(p));
        let Some(mut best) = total(&end.p) else { return };
        for _ in 0..self.settings.polish_steps {
            let Some(quadratic) = self.cost.quadratic(&end.p) else { return };
            let (mut gradient, mut hessian) = (quadratic.gradient, quadratic.gauss_newton);
            if self.settings.hessian == Hessian::Exact {
                let Some(exact) = self.cost.hessian(&end.p) else { return };
                hessian = exact;
            }
            end.priors.add_gradient(&end.p, &mut gradient);
            end.priors.add_hessian(&mut hessian);
            let inverse = uncertainty::inverse(&self.scaled(&hessian), &z);
            let step = -(inverse.matrix * self.scaled_vector(&gradient));
            let moved: Vec<f64> = (0..step.len()).map(|j| end.p[j] + step[j] * self.scales[j]).collect();
            let inside = |(j, p): (usize, &f64)| *p >= self.bounds[j].0 && *p <= self.bounds[j].1;
            let broken = |row: &Row| row.violation(&moved) > row.violation(&end.p) + 1e-9 * row_size(row, &self.scales);
            if !moved.iter().enumerate().all(inside) || self.rows.iter().any(broken) {
                return;
            }
            match total(&moved) {
                Some(value) if value < best => (end.p, best) = (moved, value),
                _ => return,
            }
            if step.amax() < 1e-14 {
                return;
            }
        }
    }

    fn describe(&self, end: End, clock: Instant) -> Fit {
        let n = self.scales.len();
        let names: Vec<&str> = self.cost.free().iter().map(|i| self.model.parameters[*i].info.symbol).collect();
        let z = self.free_directions(&end.active);
        let cost = self.cost.value(&end.p).unwrap_or(self.start_cost);
        let variance = self.variance(cost);
        let quadratic = self.cost.quadratic(&end.p);

        let mut clusters: Vec<(&str, DVector<f64>)> = Vec::new();
        let zeros = || DMatrix::zeros(n, n);
        let (data, scores) = match &quadratic {
            Some(q) => (self.scaled(&q.gauss_newton), &q.by_run[..]),
            None => (zeros(), &[][..]),
        };
        for (run, score) in self.runs.iter().zip(scores) {
            let score = self.scaled_vector(score);
            match clusters.iter_mut().find(|(name, _)| *name == run.recording) {
                Some((_, sum)) => *sum += score,
                None => clusters.push((&run.recording, score)),
            }
        }
        let clusters: Vec<DVector<f64>> = clusters.into_iter().map(|(_, score)| score).collect();

        let mut prior = zeros();
        end.priors.add_hessian(&mut prior);
        let prior = self.scaled(&prior);
        // 2 s^2/M: what turns the inverse of the cost's Hessian into a covariance.
        let unit = 2.0 * variance * self.settings.correlated_samples / self.runs.len() as f64;
        let bread = uncertainty::inverse(&(&data + &prior), &z);
        let determined = bread.determined();
        let independent = &bread.matrix * unit;
        let meat = uncertainty::meat(&clusters, n);
        let sandwich = &bread.matrix * (&meat + &prior * unit) * &bread.matrix;
        let ratio = (&bread.matrix * &meat).trace() / (&bread.matrix * &data * unit).trace();
        let design_effect = (clusters.len() > 1 && ratio.is_finite()).then_some(ratio);
        let kind = if clusters.len() >= SANDWICH_FROM { CovarianceKind::Sandwich } else { CovarianceKind::GaussNewton };
        let (chosen, freedom) = match kind {
            CovarianceKind::Sandwich => (&sandwich, clusters.len() - 1),
            CovarianceKind::GaussNewton => (&independent, self.cost.residuals().saturating_sub(n).max(1)),
        };

        let entry = |matrix: &DMatrix<f64>, i: usize, j: usize| {
            let value = matrix[(i, j)] * self.scales[i] * self.scales[j];
            (determined[i] && determined[j] && value.is_finite()).then_some(value)
        };
        let table = |f: &dyn Fn(usize, usize) -> Option<f64>| -> Covariance {
            (0..n).map(|i| (0..n).map(|j| f(i, j)).collect()).collect()
        };
        let error = |i: usize| entry(chosen, i, i).map(|v| v.max(0.0).sqrt());
        let correlation = |i: usize, j: usize| {
            let (si, sj, cij) = (error(i)?, error(j)?, entry(chosen, i, j)?);
            let r = cij / (si * sj);
            r.is_finite().then_some(r.clamp(-1.0, 1.0))
        };
        let quantile = StudentsT::new(0.0, 1.0, freedom as f64).map_or(1.96, |t| t.inverse_cdf(0.975));
        let estimate = |(j, i): (usize, &usize)| {
            let parameter = &self.model.parameters[*i];
            // Rounding in the projection leaves 1e-16 where active constraints leave nothing.
            let held = z.row(j).norm() < 1e-9;
            let standard_error = error(j).map(|e| if held { 0.0 } else { e });
            Estimate {
                name: parameter.name.clone(),
                symbol: parameter.info.symbol,
                unit: parameter.info.unit,
                start: self.start[j],
                value: end.p[j],
                standard_error,
                interval: standard_error.map(|e| [end.p[j] - quantile * e, end.p[j] + quantile * e]),
                at_bound: end.active.bounds.iter().find(|(b, _)| *b == j).map(|(_, side)| *side),
            }
        };

        let by_data = uncertainty::inverse(&data, &z);
        let inflation = if kind == CovarianceKind::Sandwich { design_effect.unwrap_or(1.0).max(1.0) } else { 1.0 };
        let mut undetermined = Vec::new();
        for (rank, (curvature, direction)) in by_data.directions.iter().enumerate().rev() {
            let deviation = (unit * inflation / curvature).sqrt();
            let standard_deviation = (rank < by_data.rank && deviation.is_finite()).then_some(deviation);
            if standard_deviation.is_none_or(|s| s > 1.0) {
                undetermined.push(Combination { words: uncertainty::in_words(direction, &names), standard_deviation });
            }
        }

        let mut active: Vec<Active> = (end.active.rows.iter())
            .map(|i| Active { sentence: self.rows[*i].sentence(&end.p), rule: self.rows[*i].rule })
            .collect();
        for (j, side) in &end.active.bounds {
            let (sign, limit) = if *side == "lower" { (">=", self.bounds[*j].0) } else { ("<=", self.bounds[*j].1) };
            active.push(Active { sentence: format!("{} {sign} {limit}", names[*j]), rule: "bounds" });
        }

        let mut model = self.model.clone();
        for (i, value) in self.cost.free().iter().zip(&end.p) {
            model.parameters[*i].value = *value;
        }
        Fit {
            converged: end.status.is_success(),
            status: end.status.to_string(),
            estimates: self.cost.free().iter().enumerate().map(estimate).collect(),
            covariance_kind: kind,
            covariance_gauss_newton: table(&|i, j| entry(&independent, i, j)),
            covariance_sandwich: (clusters.len() > 1).then(|| table(&|i, j| entry(&sandwich, i, j))),
            correlations: table(&correlation),
            design_effect,
            active,
            undetermined,
            start_cost: self.start_cost,
            cost,
            prior_cost: end.priors.value(&end.p),
            residual_variance: variance,
            runs: self.runs.len(),
            recordings: clusters.len(),
            residuals: self.cost.residuals(),
            constraints: self.rows.len(),
            iterations: end.iterations,
            counts: end.counts,
            seconds: clock.elapsed().as_secs_f64(),
            settings: *self.settings,
            model,
        }
    }
}
