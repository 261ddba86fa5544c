//! The outcome of a fit: estimates with their uncertainty, active constraints, what it cost; and [`fit`], which joins the steps.
//! It solves nothing and prints nothing; the words are in [`report`](super::report).

use super::covariance::{Covariance, CovarianceKind, Covariances, in_words};
use super::doubts::{Doubt, ResidualStatistics, against_orders, headline};
use super::error::FitError;
use super::inputs::{InputError, Inputs, SeenInput, inputs};
use super::settings::{FitSettings, Goal, Hessian};
use crate::fit::objectives::cost::Cost;
use crate::fit::objectives::evaluations::Evaluations;
use crate::fit::objectives::innovations::with_uncertain_coefficients;
use crate::fit::solver::likelihood::{Likelihood, LikelihoodEnd, check_ranks};
use crate::fit::solver::problem::Progress;
use crate::fit::solver::solve::End;
use crate::fit::solver::subspace::inverse;
use crate::fit::solver::task::Task;
use crate::ipopt::Counts;
use crate::likelihood::noise::Noise;
use crate::model::Model;
use crate::ranges::Limited;
use crate::ranks::Ranks;
use crate::recording::audit::settled;
use crate::recording::{Run, Runs};
use crate::uncertainty::Uncertainty;
use crate::validity::{self, Count, Coverage};
use serde::Serialize;
use statrs::distribution::{ContinuousCDF, StudentsT};
use std::borrow::Cow;
use std::time::Instant;

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
    /// Standard error; absent where the data do not determine the parameter, 0 where active constraints leave nothing of it to the data.
    pub standard_error: Option<f64>,
    /// 95 % interval within the parameter's bounds, absent with the standard error.
    pub interval: Option<[f64; 2]>,
    /// `lower` or `upper` where the estimate lies on an active bound.
    pub at_bound: Option<&'static str>,
}

/// An active constraint or bound at the end of a fit.
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
    /// How it ended and what residuals say against it, in one line.
    pub headline: String,
    /// How it ended, in words: what stopped the solver, and whether its last point is the one returned.
    pub status: String,
    /// How the solver's last solve ended, as Ipopt names it.
    pub solver_status: &'static str,
    /// Where the solver's second derivatives came from.
    pub hessian: Hessian,
    /// How often the optimum was checked by a second solve from a disturbed point, and how many of these found a lower cost.
    pub checks: [usize; 2],
    /// What residuals say against the estimates.
    pub doubts: Vec<Doubt>,
    /// The statistics behind the doubts.
    pub residual_statistics: ResidualStatistics,
    /// The input that one recording or one session records in another way than the others, where there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub input_error: Option<InputError>,
    /// From which size on an error of the inputs of one recording would be reported.
    pub seen_inputs: Vec<SeenInput>,
    /// The free parameters.
    pub estimates: Vec<Estimate>,
    /// Which covariance `covariance`, `correlations` and the standard errors are.
    pub covariance_kind: CovarianceKind,
    /// The covariance that the standard errors come from.
    pub covariance: Covariance,
    /// Degrees of freedom of the variance behind it: those of the Student-t quantile of the intervals.
    pub freedom: usize,
    /// Covariance with residuals taken as independent.
    pub covariance_gauss_newton: Covariance,
    /// Covariance with recordings taken as independent; absent with fewer than two.
    pub covariance_sandwich: Option<Covariance>,
    /// Correlations of the estimates.
    pub correlations: Covariance,
    /// How many times larger the variances are than independent residuals would make them; absent with fewer than two
    /// recordings.
    pub design_effect: Option<f64>,
    /// Active constraints and bounds.
    pub active: Vec<Active>,
    /// What a fit by likelihood says beside its estimates; absent in a fit of trajectories.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub likelihood: Option<Likelihood>,
    /// Combinations the data determine to no better than one scale unit, the worst first.
    pub undetermined: Vec<Combination>,
    /// Cost at the start, without priors.
    pub start_cost: f64,
    /// Cost at the end, without priors.
    pub cost: f64,
    /// What the priors add to it.
    pub prior_cost: f64,
    /// What they add at the start, with the same weight; a fit never ends above cost and priors of a feasible start.
    pub start_prior_cost: f64,
    /// Parts into which runs were cut for the first stage of the fit; 1 without stages.
    pub first_stage_parts: usize,
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
    /// How much of the data lies outside the ranges over which the terms are valid.
    pub validity: Coverage,
    /// Time taken \[s\]; no part of the result as a file, so that equal fits are equal files.
    #[serde(skip)]
    pub seconds: f64,
    /// The settings.
    pub settings: FitSettings,
}

impl Fit {
    /// The estimates as they are reported, zero where only rounding is left.
    pub fn reported(&self) -> Vec<Estimate> {
        let reported = |e: &Estimate| {
            let parameter = self.model.index(&e.name).map(|i| &self.model.parameters[i]);
            let whole = |x: f64| parameter.map_or(x, |p| p.reported(x));
            Estimate {
                start: whole(e.start),
                value: whole(e.value),
                standard_error: e.standard_error.map(whole),
                interval: e.interval.map(|ends| ends.map(whole)),
                ..e.clone()
            }
        };
        self.estimates.iter().map(reported).collect()
    }

    /// What was minimised, at the estimates: the cost with priors, or by likelihood minus the log-posterior.
    pub fn minimised(&self) -> f64 {
        self.likelihood.as_ref().map_or(self.cost + self.prior_cost, |likelihood| -likelihood.log_posterior)
    }

    /// The covariance as a model file keeps it; nothing where the data determine no parameter.
    pub fn uncertainty(&self) -> Option<Uncertainty> {
        let names: Vec<String> = self.estimates.iter().map(|e| e.name.clone()).collect();
        let found = Uncertainty::new(self.covariance_kind.words(), Some(self.freedom), &names, &self.covariance)?;
        let sound = self.converged && self.doubts.is_empty();
        Some(Uncertainty { doubt: (!sound).then(|| self.headline.clone()), ..found })
    }
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
pub fn fit<'a>(
    model: &'a Model,
    runs: impl Into<Runs<'a>>,
    settings: &FitSettings,
    progress: &mut dyn FnMut(&Progress) -> bool,
) -> Result<Fit, FitError> {
    fit_over(Ranks::one(), model, runs, settings, progress)
}

/// As [`fit`], to the runs of all ranks, of which this one has `runs`; those of a recording are all on one rank.
///
/// Every rank calls this with the same model and settings and gets the same fit, whose numbers do not depend on how many ranks
/// there are: each evaluates its own runs and adds to the sums of all, and each solves the same program.
///
/// # Errors
/// As [`fit`]. An error that only this rank meets, such as an unusable run, must end the job ([`Ranks::fail`]): the other ranks
/// wait for its sums.
pub fn fit_over<'a>(
    ranks: &'a Ranks,
    model: &'a Model,
    runs: impl Into<Runs<'a>>,
    settings: &FitSettings,
    progress: &mut dyn FnMut(&Progress) -> bool,
) -> Result<Fit, FitError> {
    let clock = Instant::now();
    settings.limits()?;
    let runs = runs.into();
    if settings.objective == Goal::Likelihood {
        return by_likelihood(ranks, model, runs, settings, progress, clock);
    }
    let cost = Cost::over(ranks, model, runs, settings.cost_options())?;
    let task = Task::new(model, &cost, runs, settings)?;
    let mut end = task.solve(progress)?;
    task.polish(&mut end);
    let variance = task.variance(task.evaluations.value(&end.p).unwrap_or(task.start_cost));
    let unit = 2.0 * variance * settings.correlated_samples / cost.runs() as f64;
    Ok(describe(&task, &task.evaluations, None, unit, end, clock))
}

/// As [`fit`], by likelihood. The model keeps which of its parameters are free: the coefficients that were estimated along are not.
fn by_likelihood(
    ranks: &Ranks,
    model: &Model,
    runs: Runs,
    settings: &FitSettings,
    progress: &mut dyn FnMut(&Progress) -> bool,
    clock: Instant,
) -> Result<Fit, FitError> {
    let read: Vec<Run> = runs.iter().map(Cow::into_owned).collect();
    if read.len() < runs.len() {
        return Err(FitError::Unreadable);
    }
    // What a receiver did that no ship can is no motion to be likely, in a fit as in a diagnosis.
    let read = settled(read, model.ship.hull.lpp).0;
    let all = with_uncertain_coefficients(model);
    let cost = Cost::over(ranks, &all, &read[..], settings.cost_options())?;
    check_ranks(&cost)?;
    let task = Task::new(&all, &cost, Runs::from(&read[..]), settings)?;
    let LikelihoodEnd { end, innovations, likelihood } = task.solve_by_likelihood(&read, progress)?;
    let mut fit = describe(&task, &Evaluations::of(&innovations), Some(&likelihood.noise), 1.0, end, clock);
    for (p, own) in fit.model.parameters.iter_mut().zip(&model.parameters) {
        (p.free, p.prior) = (own.free, own.prior);
    }
    fit.likelihood = Some(likelihood);
    Ok(fit)
}

/// The outcome of a task from where it ended; its covariance from the objective that was minimised.
fn describe(task: &Task, evaluations: &Evaluations, noise: Option<&Noise>, unit: f64, end: End, clock: Instant) -> Fit {
    let cost = task.evaluations.value(&end.p).unwrap_or(task.start_cost);
    let model = task.model_at(&end.p);
    let statistics = ResidualStatistics::of(task, &end.p);
    let likeness = if unit == 1.0 { None } else { statistics.likeness };
    let covariances = Covariances::of(task, evaluations, unit, &end, likeness);
    let Inputs { error: input_error, seen: seen_inputs } = inputs(task, &end.p, noise);
    let estimates = estimates(task, &end, &covariances);
    let free = estimates.iter().map(|e| (e.name.as_str(), e.value, e.standard_error, e.unit));
    let mut doubts = against_orders(&model.ship, free);
    doubts.extend(statistics.doubts(input_error.as_ref()));
    let mut validity = Count::new(&model);
    task.runs.iter().for_each(|run| validity.add(validity::samples(&run)));
    validity.gather(task.cost.ranks());
    Fit {
        validity: validity.coverage(),
        converged: end.converged,
        headline: headline(end.converged, &end.words, &doubts),
        doubts,
        residual_statistics: statistics,
        input_error,
        seen_inputs,
        status: end.words.clone(),
        solver_status: end.solver,
        hessian: task.settings.hessian,
        checks: end.checks,
        estimates,
        covariance_kind: covariances.kind,
        covariance: covariances.table(task, covariances.chosen()),
        freedom: covariances.freedom,
        covariance_gauss_newton: covariances.table(task, &covariances.independent),
        covariance_sandwich: (covariances.clusters > 1).then(|| covariances.table(task, &covariances.sandwich)),
        correlations: covariances.correlations(task),
        design_effect: covariances.design_effect,
        active: active(task, &end),
        likelihood: None,
        undetermined: undetermined(task, &covariances),
        start_cost: task.start_cost,
        cost,
        prior_cost: end.priors.value(&end.p),
        start_prior_cost: end.priors.value(&task.start),
        first_stage_parts: end.parts,
        residual_variance: task.variance(cost),
        runs: task.cost.runs(),
        recordings: covariances.clusters,
        residuals: task.cost.residuals(),
        constraints: task.rows.len(),
        iterations: end.work.iterations,
        counts: end.work.counts,
        seconds: clock.elapsed().as_secs_f64(),
        settings: *task.settings,
        model,
    }
}

fn estimates(task: &Task, end: &End, covariances: &Covariances) -> Vec<Estimate> {
    let quantile = StudentsT::new(0.0, 1.0, covariances.freedom as f64).map_or(1.96, |t| t.inverse_cdf(0.975));
    let estimate = |(j, i): (usize, &usize)| {
        let parameter = &task.model.parameters[*i];
        let standard_error = covariances.standard_error(task, j);
        let (lower, upper) = task.bounds[j];
        Estimate {
            name: parameter.name.clone(),
            symbol: parameter.info.symbol,
            unit: parameter.info.unit,
            start: task.start[j],
            value: end.p[j],
            standard_error,
            interval: standard_error
                .map(|e| [(end.p[j] - quantile * e).max(lower), (end.p[j] + quantile * e).min(upper)]),
            at_bound: end.active.bounds.iter().find(|(b, _)| *b == j).map(|(_, side)| *side),
        }
    };
    task.cost.free().iter().enumerate().map(estimate).collect()
}

/// A short name of each of some parameters, given by symbol and dotted name: the symbol, and the name where several have the same symbol, as
/// those of several actuators.
pub(crate) fn labels<'a>(parameters: impl Iterator<Item = (&'a str, &'a str)> + Clone) -> Vec<&'a str> {
    let alone = |symbol: &str| parameters.clone().filter(|p| p.0 == symbol).count() == 1;
    parameters.clone().map(|(symbol, name)| if alone(symbol) { symbol } else { name }).collect()
}

/// Short names of the free parameters.
fn names<'a>(task: &Task<'a>) -> Vec<&'a str> {
    let model = task.model;
    labels(task.cost.free().iter().map(|i| &model.parameters[*i]).map(|p| (p.info.symbol, p.name.as_str())))
}

/// The active constraints and bounds, in words.
fn active(task: &Task, end: &End) -> Vec<Active> {
    let names = names(task);
    let row = |i: &usize| Active { sentence: task.rows[*i].sentence(&end.p), rule: task.rows[*i].rule };
    let bound = |(j, side): &(usize, &str)| {
        let (sign, limit) = if *side == "lower" { (">=", task.bounds[*j].0) } else { ("<=", task.bounds[*j].1) };
        Active { sentence: format!("{} {sign} {limit}", names[*j]), rule: "bounds" }
    };
    end.active.rows.iter().map(row).chain(end.active.bounds.iter().map(bound)).collect()
}

/// Combinations that the data alone determine to no better than one scale unit, the worst first.
fn undetermined(task: &Task, covariances: &Covariances) -> Vec<Combination> {
    let names = names(task);
    let by_data = inverse(&covariances.data, &covariances.directions);
    let inflation = match covariances.kind {
        CovarianceKind::Sandwich => covariances.design_effect.unwrap_or(1.0).max(1.0),
        CovarianceKind::Correlated => covariances.likeness,
        CovarianceKind::GaussNewton => 1.0,
    };
    let mut undetermined = Vec::new();
    for (rank, (curvature, direction)) in by_data.directions.iter().enumerate().rev() {
        let deviation = (covariances.unit * inflation / curvature).sqrt();
        let standard_deviation = (rank < by_data.rank && deviation.is_finite()).then_some(deviation);
        if standard_deviation.is_none_or(|s| s > 1.0) {
            undetermined.push(Combination { words: in_words(direction, &names), standard_deviation });
        }
    }
    undetermined
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_that_share_a_symbol_are_called_by_their_names() {
        let some = [("tau", "port.lag"), ("g", "hull.g"), ("tau", "starboard.lag")];
        assert_eq!(labels(some.into_iter()), ["port.lag", "g", "starboard.lag"]);
    }
}
