//! The proof: two models against each other on the same runs, as `trimtab evaluate` prints it and a diagnosis concludes with it.
//! It fits nothing, and asks each model for nothing but its predictions.

use super::compare::{Comparison, compare, predict_all};
use super::settings::EvaluationSettings;
use super::summary::{Summary, summaries};
use crate::fit::FitSettings;
use crate::model::Model;
use crate::ranks::Ranks;
use crate::recording::Run;
use crate::simulate::Integration;
use crate::validity::{self, Coverage};
use serde::Serialize;

/// How models are simulated and weighed where they are judged.
#[derive(Clone, Debug, PartialEq)]
pub struct Judging {
    /// Integration of every simulation.
    pub integration: Integration,
    /// Reference yaw rate r_max of cVDM \[rad/s\].
    pub max_yaw_rate: f64,
    /// The bootstrap.
    pub settings: EvaluationSettings,
}

impl Judging {
    /// As the sections `[fit]` and `[evaluate]` of a study have it.
    pub fn new(fit: &FitSettings, settings: EvaluationSettings) -> Self {
        Self { integration: fit.integration, max_yaw_rate: fit.max_yaw_rate, settings }
    }
}

/// The evaluation of a model against a baseline.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Evaluation {
    /// Name of the baseline.
    pub baseline: String,
    /// Name of the fitted model.
    pub fitted: String,
    /// Every trajectory, in the order of the windows.
    pub trajectories: Vec<Comparison>,
    /// By split (`test`, `train`), then by manoeuvre and by session of the test trajectories where there are several.
    pub summaries: Vec<Summary>,
    /// How much of the recordings lies outside the ranges over which the terms of the fitted model are valid.
    pub validity: Coverage,
    /// r_max \[rad/s\].
    pub max_yaw_rate: f64,
    /// Resamples of the bootstrap.
    pub resamples: usize,
    /// Its seed.
    pub seed: u64,
}

impl Evaluation {
    /// The summary of a group, e.g. `test`.
    pub fn summary(&self, group: &str) -> Option<&Summary> {
        self.summaries.iter().find(|s| s.group == group)
    }
}

/// Judges `fitted` against `baseline` on runs, each simulated from the run's initial state.
pub fn prove(baseline: &Model, fitted: &Model, runs: &[Run], judging: &Judging) -> Evaluation {
    prove_over(Ranks::one(), baseline, fitted, runs, judging)
}

/// As [`prove`], with the simulations and the draws of the bootstrap divided among the ranks, each of which has all `runs`.
pub fn prove_over(ranks: &Ranks, baseline: &Model, fitted: &Model, runs: &[Run], judging: &Judging) -> Evaluation {
    let Judging { integration, max_yaw_rate, settings } = judging;
    let own = &runs[ranks.share(runs.len())];
    let before = predict_all(baseline, own, *integration);
    let after = predict_all(fitted, own, *integration);
    let compared = own.iter().zip(before.iter().zip(&after)).map(|(r, p)| compare(r, fitted, *max_yaw_rate, p));
    let trajectories: Vec<Comparison> = ranks.gather(&compared.collect::<Vec<_>>()).into_iter().flatten().collect();
    Evaluation {
        validity: validity::outside(fitted, runs.iter().flat_map(validity::samples)),
        baseline: baseline.name.clone(),
        fitted: fitted.name.clone(),
        summaries: summaries(ranks, &trajectories, settings),
        trajectories,
        max_yaw_rate: *max_yaw_rate,
        resamples: settings.resamples,
        seed: settings.seed,
    }
}
