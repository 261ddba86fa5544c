//! Several models on the same runs: the deviation of each, and what separates it from the first by runs, each pair with an interval.
//! How one model is judged against a baseline is in `prove`; this asks which of many to take.

use super::compare::predict;
use super::cvdm::{Outcome, outcome};
use super::prove::Judging;
use super::summary::Estimate;
use crate::model::Model;
use crate::recording::Run;
use crate::statistics::{Bootstrap, mean};
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;
use std::ops::Range;

/// A model among others on the same runs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ranked {
    /// Name of the model.
    pub model: String,
    /// Its free parameters, as its file has them.
    pub free: usize,
    /// Mean cVDM over the trajectories that all models run through \[%\], with its 95 % interval; absent where there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cvdm: Option<Estimate>,
    /// Mean cVDM less that of the first model on the same trajectories \[%\], with its 95 % interval over runs; absent for the first one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub difference: Option<Estimate>,
    /// Runs on which its mean cVDM is below that of the first model.
    pub runs_better: usize,
    /// Runs on which it is above.
    pub runs_worse: usize,
    /// Trajectories on which its simulation diverged.
    pub diverged: usize,
}

/// Models on the same runs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ranking {
    /// Runs.
    pub runs: usize,
    /// Trajectories (windows).
    pub trajectories: usize,
    /// Those that every model runs through: the ones that means and differences are over.
    pub common: usize,
    /// The models, in the order given.
    pub models: Vec<Ranked>,
    /// Resamples of the bootstrap over runs.
    pub resamples: usize,
    /// Its seed.
    pub seed: u64,
}

/// Judges models on the same windows. Differences are paired: of the same trajectories, with one draw of whole runs for all models, so
/// that what makes a run hard for every model does not blur them.
pub fn rank(models: &[Model], windows: &[Run], judging: &Judging) -> Ranking {
    let outcomes: Vec<Vec<Outcome>> = models
        .iter()
        .map(|model| {
            let judged = |window: &Run| {
                let predicted = predict(model, window, judging.integration);
                outcome(window, &predicted, &model.ship, judging.max_yaw_rate)
            };
            windows.par_iter().map(judged).collect()
        })
        .collect();
    let cvdm = |model: usize, window: usize| outcomes[model][window].deviation().map(|d| d.cvdm);
    let sound = |window: &usize| (0..models.len()).all(|model| cvdm(model, *window).is_some());
    let mut runs: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (i, window) in windows.iter().enumerate() {
        runs.entry(window.recording.as_str()).or_default().push(i);
    }
    let common: Vec<Vec<usize>> = runs
        .values()
        .map(|of| of.iter().copied().filter(sound).collect())
        .filter(|of: &Vec<usize>| !of.is_empty())
        .collect();
    let (resamples, seed) = (judging.settings.resamples, judging.settings.seed);
    let bootstrap = Bootstrap::new(common.len(), resamples, seed);
    let ranked = |model: usize| {
        let own: Vec<Vec<f64>> = deviations(&common, &|w| cvdm(model, w));
        let first: Vec<Vec<f64>> = deviations(&common, &|w| cvdm(0, w));
        let apart: Vec<Vec<f64>> =
            own.iter().zip(&first).map(|(a, b)| a.iter().zip(b).map(|(a, b)| a - b).collect()).collect();
        let by_run: Vec<f64> = apart.iter().filter_map(|run| mean(run.iter().copied())).collect();
        Ranked {
            model: models[model].name.clone(),
            free: models[model].parameters.iter().filter(|p| p.free).count(),
            cvdm: estimate(&own, &bootstrap),
            difference: (model > 0).then(|| estimate(&apart, &bootstrap)).flatten(),
            runs_better: by_run.iter().filter(|d| **d < 0.0).count(),
            runs_worse: by_run.iter().filter(|d| **d > 0.0).count(),
            diverged: outcomes[model].iter().filter(|o| o.deviation().is_none()).count(),
        }
    };
    Ranking {
        runs: runs.len(),
        trajectories: windows.len(),
        common: common.iter().map(Vec::len).sum(),
        models: (0..models.len()).map(ranked).collect(),
        resamples,
        seed,
    }
}

fn deviations(runs: &[Vec<usize>], of: &dyn Fn(usize) -> Option<f64>) -> Vec<Vec<f64>> {
    runs.iter().map(|run| run.iter().filter_map(|window| of(*window)).collect()).collect()
}

/// The mean over all trajectories, with its interval from draws of whole runs.
fn estimate(runs: &[Vec<f64>], bootstrap: &Bootstrap) -> Option<Estimate> {
    let all: Range<usize> = 0..runs.len();
    let value = mean(all.flat_map(|run| runs[run].iter().copied()))?;
    let ci95 = bootstrap.interval(|drawn| mean(drawn.iter().flat_map(|run| runs[*run].iter().copied())));
    Some(Estimate { value, ci95 })
}
