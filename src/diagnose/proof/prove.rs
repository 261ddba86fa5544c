//! The proof of a diagnosis: models against each other on runs that no earlier step has touched, in free simulation as
//! [`crate::evaluate::prove`] judges it, and in likelihood. It fits nothing.

use super::grade::GainTest;
use super::unseen::interval_of_improvement;
use crate::evaluate::{Comparison, Judging, Outcome, outcome, predict_all, summarise};
use crate::likelihood::filter::{Filter, GATE, Pass, Wanted};
use crate::likelihood::noise::Noise;
use crate::model::Model;
use crate::recording::Run;
use crate::recording::audit::settled;
use crate::simulate::Integration;
use crate::state::STATES;
use crate::statistics::mean;
use serde::Serialize;

/// How well one model does on one run.
#[derive(Clone, Debug, Serialize)]
pub struct RunScore {
    /// The run.
    pub run: String,
    /// Combined variable distance metric of the free simulation \[%\]; absent when it diverged.
    pub cvdm: Option<f64>,
    /// Mean distance a step in x, y \[m\], psi \[rad\], u, v \[m/s\], r \[rad/s\]; absent in what was not measured.
    pub mean_distance: Option<[Option<f64>; STATES]>,
}

impl RunScore {
    fn new(run: &Run, outcome: &Outcome) -> Self {
        let deviation = outcome.deviation();
        Self { run: run.name.clone(), cvdm: deviation.map(|d| d.cvdm), mean_distance: deviation.map(|d| d.md) }
    }
}

/// The base model (before) against the model with the findings (after) on held-out runs. The numbers of
/// free simulation are those that `trimtab evaluate` prints.
#[derive(Clone, Debug, Serialize)]
pub struct HeldOut {
    /// Number of held-out runs.
    pub runs: usize,
    /// Mean cVDM of the base model, refitted \[%\], over the runs on which neither model diverges.
    pub before: Option<f64>,
    /// Mean cVDM with the findings \[%\].
    pub after: Option<f64>,
    /// Relative improvement of the mean cVDM, `1 - after/before`.
    pub improvement: Option<f64>,
    /// Its 95 % interval, by Student's t over recordings; absent with fewer than three, where one has most of the error, and where a
    /// simulation diverged.
    pub ci95: Option<[f64; 2]>,
    /// Runs that got better.
    pub better: usize,
    /// Runs that got worse.
    pub worse: usize,
    /// The run that lost most, or gained least.
    pub worst_run: Option<String>,
    /// Its relative change (positive is better).
    pub worst_improvement: Option<f64>,
    /// Mean cVDM with a generic correction instead \[%\].
    pub generic: Option<f64>,
    /// Gain in log-likelihood over all held-out runs.
    pub log_likelihood_gain: f64,
    /// Mean square of the standardised innovations before and after; 1 is white noise of the modelled size.
    pub whiteness: [f64; 2],
    /// Run by run, before.
    pub runs_before: Vec<RunScore>,
    /// Run by run, after.
    pub runs_after: Vec<RunScore>,
}

/// Runs on which a simulation diverged.
pub fn diverged(scores: &[RunScore]) -> usize {
    scores.iter().filter(|score| score.cvdm.is_none()).count()
}

impl HeldOut {
    /// Runs on which the free simulation diverges, before and after.
    pub fn diverged(&self) -> [usize; 2] {
        [&self.runs_before, &self.runs_after].map(|of| diverged(of))
    }

    /// The gain of the free simulation of the held-out runs.
    fn simulation(&self) -> Option<GainTest> {
        GainTest::of_simulations(self.diverged(), self.runs, self.improvement, self.ci95)
    }

    /// Whether free simulation of the held-out runs is better after than before.
    pub fn is_better(&self) -> bool {
        self.simulation().is_some_and(|g| g.gain > 0.0)
    }

    /// Whether free simulation of the held-out runs is worse after than before, beyond its interval, or by its sign where there is none: then
    /// no part of what changed is written or confirmed, though each by itself may predict better.
    pub fn is_worse(&self) -> bool {
        self.simulation().is_some_and(|g| g.is_worse())
    }
}

/// Log-likelihood of runs under a model, and the mean square of its standardised innovations without the outliers.
pub fn likelihood(model: &Model, integration: Integration, noise: &Noise, runs: &[Run]) -> (f64, f64) {
    let filter = Filter::new(model, integration, &[]);
    let of = |pass: &Pass| {
        let usual = pass.innovations.iter().flatten().filter(|e| e.is_finite() && e.abs() < GATE);
        let (sum, count) = usual.fold((0.0, 0.0), |(sum, count), e| (sum + e * e, count + 1.0));
        (pass.log_likelihood, sum, count)
    };
    let passes = filter.passes(runs, noise, Wanted::default());
    let total = passes.iter().map(of).fold((0.0, 0.0, 0.0), |a, p| (a.0 + p.0, a.1 + p.1, a.2 + p.2));
    (total.0, total.1 / f64::max(total.2, 1.0))
}

/// How well a model does on each of some runs, simulated freely.
pub fn scores(model: &Model, runs: &[Run], judging: &Judging) -> Vec<RunScore> {
    let predicted = predict_all(model, runs, judging.integration);
    let of = |(run, p)| RunScore::new(run, &outcome(run, p, &model.ship, judging.max_yaw_rate));
    runs.iter().zip(&predicted).map(of).collect()
}

/// Mean cVDM \[%\] of a model's free simulations of runs; `None` where one diverges, and of no runs.
pub fn mean_cvdm(model: &Model, runs: &[Run], judging: &Judging) -> Option<f64> {
    let each = scores(model, runs, judging).into_iter().map(|score| score.cvdm);
    mean(each.collect::<Option<Vec<f64>>>()?)
}

/// Compares two models on held-out runs as they were recorded. The likelihood is of the runs as the diagnosis takes them, parted
/// where the position jumps.
pub fn prove(
    before: (&Model, &Noise),
    after: (&Model, &Noise),
    generic: Option<&Model>,
    integration: Integration,
    runs: &[Run],
    judging: &Judging,
) -> HeldOut {
    let evaluation = crate::evaluate::prove(before.0, after.0, runs, judging);
    let all: Vec<&Comparison> = evaluation.trajectories.iter().collect();
    let summary = summarise("held out".into(), &all, &judging.settings);
    let (sound, _) = settled(runs, before.0.ship.hull.lpp);
    let (likely_before, white_before) = likelihood(before.0, integration, before.1, &sound);
    let (likely_after, white_after) = likelihood(after.0, integration, after.1, &sound);
    let changes = all.iter().zip(runs).filter_map(|(c, run)| Some((&run.name, c.improvement()?)));
    let worst = changes.min_by(|a, b| a.1.total_cmp(&b.1));
    let scores = |of: fn(&Comparison) -> &Outcome| {
        let score = |(c, run): (&&Comparison, &Run)| RunScore::new(run, of(c));
        all.iter().zip(runs).map(score).collect::<Vec<_>>()
    };
    HeldOut {
        runs: summary.trajectories,
        before: summary.cvdm_baseline.map(|e| e.value),
        after: summary.cvdm_fitted.map(|e| e.value),
        improvement: summary.cvdm_improvement.map(|e| e.value),
        ci95: interval_of_improvement(&summary),
        better: summary.better,
        worse: summary.worse,
        worst_run: worst.map(|(name, _)| name.clone()),
        worst_improvement: worst.map(|(_, change)| change),
        generic: generic.and_then(|g| mean_cvdm(g, runs, judging)),
        log_likelihood_gain: likely_after - likely_before,
        whiteness: [white_before, white_after],
        runs_before: scores(|c| &c.baseline),
        runs_after: scores(|c| &c.fitted),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{RK4, model, noise, runs, with};
    use crate::diagnose::settings::Settings;

    #[test]
    fn a_model_against_itself_gains_nothing_and_the_truth_gains_on_every_run() {
        let truth = with(&[("current.north", 0.4)]);
        let (held_out, judging) = (runs(&truth, 6), Settings::default().judging);
        let base = model();
        let against = |after: &Model| prove((&base, &noise()), (after, &noise()), None, RK4, &held_out, &judging);
        let same = against(&base);
        assert_eq!((same.improvement, same.log_likelihood_gain, same.better, same.worse), (Some(0.0), 0.0, 0, 0));
        let better = against(&truth);
        assert!(better.improvement > Some(0.5) && better.log_likelihood_gain > 50.0, "{better:?}");
        assert_eq!((better.runs, better.better, better.worse), (6, 6, 0));
        assert!(better.whiteness[1] < better.whiteness[0]);
    }

    #[test]
    fn innovations_under_the_truth_have_the_size_that_the_noise_says() {
        let truth = model();
        let (_, square) = likelihood(&truth, RK4, &noise(), &runs(&truth, 12));
        assert!((0.7..1.1).contains(&square), "{square}");
    }
}
