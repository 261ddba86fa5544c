//! The proof: two models against each other on the same runs, as `trimtab evaluate` prints it and a diagnosis concludes with it.
//! It fits nothing, and uses each model's predictions alone.

use super::compare::{Comparison, compare, predict};
use super::outlying::{Outlying, outlying};
use super::settings::EvaluationSettings;
use super::summary::{Summary, summaries};
use crate::fit::FitSettings;
use crate::model::Model;
use crate::ranks::Ranks;
use crate::recording::Run;
use crate::simulate::Integration;
use crate::validity::{Count, Coverage, samples};
use rayon::prelude::*;
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
    /// The run that the fitted model predicts far worse than all others.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub outlying: Option<Outlying>,
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
    let mut proof = Proof::new(baseline, fitted, judging);
    let part = proof.part(runs);
    proof.add(part);
    proof.evaluation()
}

/// A proof on more runs than are in memory at once: parts of them are judged, on any thread, and added in their order.
pub struct Proof<'a> {
    baseline: &'a Model,
    fitted: &'a Model,
    judging: &'a Judging,
    sum: Part<'a>,
}

/// What some runs say of two models.
pub struct Part<'a> {
    trajectories: Vec<Comparison>,
    validity: Count<'a>,
}

impl<'a> Proof<'a> {
    /// Of no run yet.
    pub fn new(baseline: &'a Model, fitted: &'a Model, judging: &'a Judging) -> Self {
        let sum = Part { trajectories: Vec::new(), validity: Count::new(fitted) };
        Self { baseline, fitted, judging, sum }
    }

    /// Judges both models on some runs.
    pub fn part(&self, runs: &[Run]) -> Part<'a> {
        let Judging { integration, max_yaw_rate, .. } = self.judging;
        let of = |run: &Run| {
            let (before, after) = (predict(self.baseline, run, *integration), predict(self.fitted, run, *integration));
            compare(run, self.fitted, *max_yaw_rate, (&before, &after))
        };
        let mut validity = Count::new(self.fitted);
        validity.add(runs.iter().flat_map(samples));
        Part { trajectories: runs.par_iter().map(of).collect(), validity }
    }

    /// Adds what further runs say.
    pub fn add(&mut self, part: Part) {
        self.sum.trajectories.extend(part.trajectories);
        self.sum.validity.join(&part.validity);
    }

    /// The evaluation on all runs that were added.
    pub fn evaluation(self) -> Evaluation {
        self.evaluation_over(Ranks::one())
    }

    /// The evaluation on all runs that were added on any rank, in the order of the ranks; each rank gets it. The draws of the
    /// bootstrap are divided among them.
    pub fn evaluation_over(self, ranks: &Ranks) -> Evaluation {
        let Judging { max_yaw_rate, settings, .. } = self.judging;
        let Part { trajectories, mut validity } = self.sum;
        let trajectories = ranks.gather(&trajectories).concat();
        validity.gather(ranks);
        Evaluation {
            validity: validity.coverage(),
            baseline: self.baseline.name.clone(),
            fitted: self.fitted.name.clone(),
            summaries: summaries(ranks, &trajectories, settings),
            outlying: outlying(trajectories.iter().map(|t| (t.run.as_str(), &t.fitted))),
            trajectories,
            max_yaw_rate: *max_yaw_rate,
            resamples: settings.resamples,
            seed: settings.seed,
        }
    }
}
