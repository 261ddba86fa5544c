//! One finding on runs that no earlier step has used: a model with it against the same model refitted without it, and, for an error of a
//! sensor, their kinematic consistency. It computes gains and their intervals over recordings; what follows from them is decided elsewhere.

use super::grade::GainTest;
use crate::diagnose::evidence::candidate::Candidate;
use crate::diagnose::evidence::kinematic;
use crate::diagnose::settings::INDISTINGUISHABLE;
use crate::evaluate::{self, Judging, Summary, summarise};
use crate::likelihood::filter::{Filter, Wanted};
use crate::likelihood::noise::Noise;
use crate::model::Model;
use crate::recording::Run;
use crate::recording::audit::settled;
use crate::simulate::Integration;
use crate::statistics::interval_of_sum;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// What unseen runs say of one finding: the model without it, refitted, (before) against the model with it (after). An error of a sensor that
/// the sensors of the unseen runs show themselves needs no ship for its proof: it has their agreement alone, and whether the ship that was
/// refitted beside it predicts better is asked of all findings together.
#[derive(Clone, Debug, Default, Serialize)]
pub struct FindingProof {
    /// Recordings.
    pub recordings: usize,
    /// Their runs.
    pub runs: usize,
    /// Gain in log-likelihood over all of them.
    pub log_likelihood_gain: Option<f64>,
    /// Its 95 % interval, by Student's t over recordings; absent with fewer than three, and where one has most of the samples.
    pub log_likelihood_ci95: Option<[f64; 2]>,
    /// For an error of a sensor, gain in log-likelihood of the kinematic consistency of the runs; absent where that is not known.
    pub agreement_gain: Option<f64>,
    /// Its 95 % interval, as that of the likelihood.
    pub agreement_ci95: Option<[f64; 2]>,
    /// Runs on which the free simulation diverges, without and with it.
    pub diverged: [usize; 2],
    /// Mean cVDM without the finding \[%\].
    pub before: Option<f64>,
    /// Mean cVDM with it \[%\].
    pub after: Option<f64>,
    /// Relative improvement of the mean cVDM, `1 - after/before`.
    pub improvement: Option<f64>,
    /// Its 95 % interval, by Student's t over recordings; absent with fewer than three, where one has most of the error, and where a
    /// simulation diverged.
    pub improvement_ci95: Option<[f64; 2]>,
    /// Mean distance of the simulated from the measured position \[m\], without and with it; absent where none was measured.
    pub position: Option<[f64; 2]>,
    /// Mean difference of the heading \[rad\], without and with it.
    pub heading: Option<[f64; 2]>,
    /// Mean difference of the surge speed \[m/s\], without and with it.
    pub speed: Option<[f64; 2]>,
}

impl FindingProof {
    /// Compares `after` with `before` on held-out runs, both under the same noise. It is the noise estimated with the finding: the noise of
    /// a model without a sensor's error includes that error, and under it the two models hardly differ.
    pub fn new(
        before: &Model,
        after: &Model,
        noise: &Noise,
        integration: Integration,
        runs: &[Run],
        judging: &Judging,
    ) -> Self {
        let evaluation = evaluate::prove(before, after, runs, judging);
        let all: Vec<_> = evaluation.trajectories.iter().collect();
        let summary = summarise("held out".into(), &all, &judging.settings);
        let (sound, _) = settled(runs, before.ship.hull.lpp);
        let gains = by_recording(&sound, [before, after].map(|m| likelihoods(m, integration, noise, &sound)));
        let of = |channel: usize| {
            let both = [summary.md_baseline[channel], summary.md_fitted[channel]].map(|e| e.map(|e| e.value));
            Some([both[0]?, both[1]?])
        };
        let position = of(0).zip(of(1)).map(|(x, y)| [x[0].hypot(y[0]), x[1].hypot(y[1])]);
        Self {
            recordings: gains.len(),
            runs: runs.len(),
            log_likelihood_gain: Some(gains.iter().map(|g| g.0).sum()),
            log_likelihood_ci95: interval_of_sum(&gains),
            agreement_gain: None,
            agreement_ci95: None,
            diverged: [summary.diverged_baseline, summary.diverged_fitted],
            before: summary.cvdm_baseline.map(|e| e.value),
            after: summary.cvdm_fitted.map(|e| e.value),
            improvement: summary.cvdm_improvement.map(|e| e.value),
            improvement_ci95: interval_of_improvement(&summary),
            position,
            heading: of(2),
            speed: of(3),
        }
    }

    /// Unseen runs whose sensors show the error of a sensor themselves.
    pub fn shown(agreement: GainTest, runs: &[Run]) -> Self {
        let recordings = runs.iter().map(|r| r.recording.as_str()).collect::<BTreeSet<_>>().len();
        Self { recordings, runs: runs.len(), ..Self::default() }.beside(Some(agreement))
    }

    /// With the gain in kinematic consistency.
    pub fn beside(self, agreement: Option<GainTest>) -> Self {
        Self { agreement_gain: agreement.map(|g| g.gain), agreement_ci95: agreement.and_then(|g| g.ci95), ..self }
    }

    /// The gain in kinematic consistency.
    pub fn agreement(&self) -> Option<GainTest> {
        Some(GainTest { gain: self.agreement_gain?, ci95: self.agreement_ci95 })
    }

    /// Whether the kinematic consistency of the runs shows the finding significantly.
    pub fn is_shown(&self) -> bool {
        self.agreement().is_some_and(|g| g.is_above_zero())
    }

    /// The gain in log-likelihood.
    pub fn likelihood(&self) -> Option<GainTest> {
        Some(GainTest { gain: self.log_likelihood_gain?, ci95: self.log_likelihood_ci95 })
    }

    /// The improvement of the free simulation.
    pub fn prediction(&self) -> Option<GainTest> {
        GainTest::of_simulations(self.diverged, self.runs, self.improvement, self.improvement_ci95)
    }
}

/// The gain in kinematic consistency of runs by the errors of sensors of `after` over those of `before`; `None` where that is too small to
/// distinguish them.
pub fn agreement(before: &Model, after: &Model, runs: &[Run], candidates: &[Candidate]) -> Option<GainTest> {
    let (sound, _) = settled(runs, before.ship.hull.lpp);
    let (gain, ci95) = kinematic::gain(before, after, &sound, candidates)?;
    (gain.abs() > INDISTINGUISHABLE).then_some(GainTest { gain, ci95 })
}

/// Log-likelihood of each run.
fn likelihoods(model: &Model, integration: Integration, noise: &Noise, runs: &[Run]) -> Vec<f64> {
    let mut out = Vec::with_capacity(runs.len());
    let filter = Filter::new(model, integration, &[]);
    let wanted = Wanted { sums_only: true, ..Wanted::default() };
    filter.each(runs, noise, wanted, |_, pass| pass.log_likelihood, |l| out.push(l));
    out
}

/// Gains and samples summed over the runs of each recording.
fn by_recording(runs: &[Run], [before, after]: [Vec<f64>; 2]) -> Vec<(f64, f64)> {
    let mut sums: BTreeMap<&str, (f64, f64)> = BTreeMap::new();
    for (run, (b, a)) in runs.iter().zip(before.iter().zip(&after)) {
        let sum = sums.entry(run.recording.as_str()).or_default();
        *sum = (sum.0 + a - b, sum.1 + run.measured.len() as f64);
    }
    sums.into_values().collect()
}

/// The interval of the improvement, as an evaluation prints it: by Student's t over recordings, of which few are resampled to too narrow
/// an interval (Cameron & Miller 2015, J. Human Resources 50, p. 317, section VI). Nothing is concluded from it where a simulation diverged.
pub(in crate::diagnose) fn interval_of_improvement(summary: &Summary) -> Option<[f64; 2]> {
    summary.cvdm_improvement.filter(|_| summary.diverged_baseline + summary.diverged_fitted == 0)?.ci95
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{RK4, erring, model, noise, runs, with};
    use crate::diagnose::proof::prove::mean_cvdm;
    use crate::diagnose::settings::Settings;
    use crate::statistics::interval_of_ratio;

    #[test]
    fn unseen_runs_of_a_current_gain_by_it_lose_by_its_mirror_image_and_by_a_model_against_itself_nothing() {
        let truth = with(&[("current.north", 0.4)]);
        let held_out = runs(&truth, 6);
        let judging = Settings::default().judging;
        let against = |after: &Model| FindingProof::new(&model(), after, &noise(), RK4, &held_out, &judging);
        let right = against(&truth);
        assert!(right.recordings == 6 && right.likelihood().is_some_and(|g| g.is_above_zero()), "{right:?}");
        assert!(right.prediction().is_some_and(|p| p.gain > 0.5));
        assert!(right.position.is_some_and(|[b, a]| a < 0.5 * b) && right.heading.is_some() && right.speed.is_some());
        let wrong = against(&with(&[("current.north", -0.4)]));
        assert!(wrong.likelihood().is_some_and(|g| g.is_below_zero()), "{wrong:?}");
        let same = against(&model());
        assert_eq!((same.log_likelihood_gain, same.improvement), (Some(0.0), Some(0.0)));
    }

    #[test]
    fn a_noise_that_includes_an_error_shows_less_of_it_than_the_noise_estimated_with_it() {
        let runs = erring(&[("log_scale.error", 0.08)], 6);
        let off = with(&[("log_scale.error", 0.08)]);
        let mut wide = noise();
        (wide.sensors[2].coloured, wide.sensors[2].time) = (0.3, 1e3);
        let judging = Settings::default().judging;
        let gain =
            |noise: &Noise| FindingProof::new(&model(), &off, noise, RK4, &runs, &judging).log_likelihood_gain.unwrap();
        assert!(gain(&noise()) > 10.0 * gain(&wide).abs(), "{} {}", gain(&noise()), gain(&wide));
    }

    #[test]
    fn the_interval_of_the_improvement_is_that_of_a_ratio_over_recordings_and_ends_at_an_exact_prediction() {
        let truth = with(&[("current.north", 0.4)]);
        let judging = Settings::default().judging;
        for lengths in [[100, 100, 100, 100], [40, 100, 60, 80]] {
            let mut held_out = runs(&truth, 4);
            for (run, steps) in held_out.iter_mut().zip(lengths) {
                run.inputs.truncate(steps + 1);
                run.measured.truncate(steps + 1);
            }
            // A model that gains a little in each, and the truth.
            for after in [with(&[("current.north", 0.1)]), truth.clone()] {
                let proof = FindingProof::new(&model(), &after, &noise(), RK4, &held_out, &judging);
                let cvdm = |m: &Model, run: &Run| mean_cvdm(m, std::slice::from_ref(run), &judging).unwrap();
                let clusters: Vec<(f64, f64)> = held_out.iter().map(|r| (cvdm(&after, r), cvdm(&model(), r))).collect();
                let [low, high] = interval_of_ratio(&clusters).unwrap().map(|q| 1.0 - q);
                let found = proof.improvement_ci95.unwrap();
                assert!((found[0] - high).abs() < 1e-12 && (found[1] - low.min(1.0)).abs() < 1e-12, "{found:?}");
                assert!(found[0] < proof.improvement.unwrap() && proof.improvement.unwrap() < found[1]);
            }
        }
    }

    #[test]
    fn two_recordings_give_a_gain_and_no_interval() {
        let truth = with(&[("current.north", 0.4)]);
        let held_out = runs(&truth, 2);
        let judging = Settings::default().judging;
        let proof = FindingProof::new(&model(), &truth, &noise(), RK4, &held_out, &judging);
        assert!(proof.log_likelihood_gain > Some(0.0) && proof.log_likelihood_ci95.is_none());
        assert!(proof.improvement.is_some() && proof.improvement_ci95.is_none());
    }
}
