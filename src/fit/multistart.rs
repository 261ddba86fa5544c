//! The same fit from many starts, to see whether there is more than one place to end.
//! It keeps every outcome, good or bad, and picks none.

use super::error::FitError;
use super::settings::FitSettings;
use super::summary::{Fit, fit};
use crate::model::Model;
use crate::ranks::Ranks;
use crate::recording::Run;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Starts drawn uniformly from a box around the model's values.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct MultiStart {
    /// Number of starts.
    pub count: usize,
    /// Half-width of the box as a share of each value; a value of 0 takes its scale instead.
    pub spread: f64,
    /// Seed of the draw.
    pub seed: u64,
}

impl Default for MultiStart {
    fn default() -> Self {
        Self { count: 20, spread: 0.5, seed: 1 }
    }
}

impl MultiStart {
    /// A model at every start, inside its bounds.
    pub fn models(&self, model: &Model) -> Vec<Model> {
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        let mut one = |_| {
            let mut from = model.clone();
            for i in model.free() {
                let parameter = &mut from.parameters[i];
                let size = if parameter.value == 0.0 { parameter.scale } else { parameter.value.abs() };
                let moved = parameter.value + self.spread * size * random.random_range(-1.0..=1.0);
                parameter.value = moved.max(parameter.lower).min(parameter.upper);
            }
            from
        };
        (0..self.count).map(&mut one).collect()
    }
}

/// How one start ended.
#[derive(Debug)]
pub struct StartOutcome {
    /// Values of the free parameters at the start.
    pub start: Vec<f64>,
    /// The fit, or why there is none.
    pub outcome: Result<Fit, FitError>,
}

/// How one start ended, in numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StartRow {
    /// Values of the free parameters at the start.
    pub start: Vec<f64>,
    /// Their values at the end; empty where there is no fit.
    pub end: Vec<f64>,
    /// What the fit minimises, there: the cost with priors, or by likelihood minus the log-posterior; absent where there is no fit.
    pub cost: Option<f64>,
    /// Whether the solver found an optimum.
    pub converged: bool,
    /// Iterations of the solver.
    pub iterations: usize,
    /// How it ended, in words.
    pub ended: String,
}

/// Fits from each start in turn, in an order and from values that depend on the seed alone.
pub fn multi_start(
    model: &Model,
    runs: &[Run],
    settings: &FitSettings,
    starts: &MultiStart,
    mut progress: impl FnMut(usize),
) -> Vec<StartOutcome> {
    let from = starts.models(model);
    let outcome = |(count, from): (usize, &Model)| {
        progress(count);
        StartOutcome { start: free_values(from), outcome: fit(from, runs, settings, &mut |_| true) }
    };
    from.iter().enumerate().map(outcome).collect()
}

/// As [`multi_start`], with the starts dealt out to the ranks, each of which has all `runs`: every rank gets every row. A start
/// whose row is in `known`, from a job that was stopped, is not fitted again; `ended` receives each other one as it ends.
pub fn multi_start_over(
    ranks: &Ranks,
    model: &Model,
    runs: &[Run],
    settings: &FitSettings,
    starts: &MultiStart,
    known: &BTreeMap<usize, StartRow>,
    mut ended: impl FnMut(usize, &StartRow),
) -> Vec<StartRow> {
    let from = starts.models(model);
    let own = from.iter().enumerate().filter(|(count, _)| ranks.takes(*count));
    let row = |(count, from): (usize, &Model)| {
        let values = free_values(from);
        if let Some(row) = known.get(&count).filter(|row| row.start == values) {
            return (count, row.clone());
        }
        let row = StartRow::of(from, values, fit(from, runs, settings, &mut |_| true));
        ended(count, &row);
        (count, row)
    };
    ranks.rows(own.map(row).collect())
}

impl StartRow {
    /// Of a fit that began at a model. A fit by likelihood estimates coefficients along, which are not free in the model.
    fn of(from: &Model, start: Vec<f64>, outcome: Result<Fit, FitError>) -> Self {
        match outcome {
            Ok(fit) => Self {
                start,
                end: from.free().into_iter().map(|i| fit.model.parameters[i].value).collect(),
                cost: Some(fit.minimised()).filter(|value| value.is_finite()),
                converged: fit.converged,
                iterations: fit.iterations,
                ended: fit.status,
            },
            Err(error) => {
                let ended = error.to_string();
                Self { start, end: Vec::new(), cost: None, converged: false, iterations: 0, ended }
            }
        }
    }
}

fn free_values(model: &Model) -> Vec<f64> {
    model.free().into_iter().map(|i| model.parameters[i].value).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{RK4, model, runs};
    use crate::fit::Goal;

    #[test]
    fn a_row_has_the_free_parameters_and_what_its_fit_minimises_by_either_objective() {
        let (model, runs) = (model(), runs(&model(), 4));
        for objective in [Goal::Trajectory, Goal::Likelihood] {
            let settings = FitSettings { integration: RK4, objective, ..FitSettings::default() };
            let starts = MultiStart { count: 2, spread: 0.1, seed: 3 };
            let none = BTreeMap::new();
            let rows = multi_start_over(Ranks::one(), &model, &runs, &settings, &starts, &none, |_, _| ());
            let fits = multi_start(&model, &runs, &settings, &starts, |_| {});
            for (row, fit) in rows.iter().zip(fits) {
                let fit = fit.outcome.unwrap();
                let least = fit.likelihood.as_ref().map_or(fit.cost + fit.prior_cost, |l| -l.log_posterior);
                assert_eq!(row.cost, Some(least), "{objective:?}");
                let value = |i: usize| fit.estimates.iter().find(|e| e.name == model.parameters[i].name).unwrap().value;
                assert_eq!(row.end, model.free().into_iter().map(value).collect::<Vec<_>>(), "{objective:?}");
            }
        }
    }
}
