//! What every selected mechanism is worth by itself: the model with it against the model refitted without it, on the training runs
//! and on unseen ones. It computes the tests of a finding; the grade is a pure function of them.

use super::base::Question;
use super::compete::Selected;
use super::describe::{Intervals, mechanism_finding};
use super::estimate::Estimate;
use super::finding::{Amplitude, Finding};
use super::grade::{FindingTests, Grade, grade};
use super::influence::{Following, change};
use super::residual::{Kept, Left};
use super::settings::{FOLLOWED_SHARE, REFIT};
use super::unseen::FindingProof;
use crate::evaluate::predict_all;
use crate::physics::Kind;
use crate::recording::Run;
use crate::simulate::Trajectory;
use crate::statistics::median;

/// A selected mechanism with what speaks for and against it.
pub struct Weight {
    /// The grade.
    pub grade: Grade,
    /// What the grade follows from.
    pub tests: FindingTests,
    /// Unseen runs.
    pub proof: Option<FindingProof>,
    /// The model without it, refitted.
    pub without: Estimate,
}

impl Weight {
    /// How much it gains on unseen runs, for an order among those that are withdrawn.
    fn gain(&self) -> f64 {
        self.tests.likelihood.map_or(0.0, |g| g.gain)
    }
}

/// Weighs every mechanism that is kept, in their order.
pub fn weigh(question: &Question, kept: &Kept, held_out: &[Run]) -> Vec<Weight> {
    let Some(left) = &kept.left else { return Vec::new() };
    (question.progress)("weighing every finding by itself");
    let (found, fit) = (&kept.selection.estimate, &kept.selection.tests.fit);
    let intervals = Intervals::new(found, &fit.runs, &left.screen);
    let with = predict_all(&found.model, &fit.runs, fit.integration);
    kept.selection.mechanisms.iter().map(|m| weight(question, kept, m, &intervals, &with, held_out)).collect()
}

fn weight(
    question: &Question,
    kept: &Kept,
    of: &Selected,
    intervals: &Intervals,
    with: &[Trajectory],
    held_out: &[Run],
) -> Weight {
    let (tests, found) = (&kept.selection.tests, &kept.selection.estimate);
    let (fit, candidate) = (&tests.fit, &tests.candidates[of.candidate]);
    // Without the only mechanism the model is the base model, which is fitted already.
    let without = if kept.selection.mechanisms.len() == 1 {
        fit.estimate.clone()
    } else {
        let (model, free) = candidate.removed(found, &of.extent);
        tests.problem(question.settings).estimate(&model, &free, &found.noise, REFIT)
    };
    let amplitudes = intervals.amplitudes(found, candidate, &of.extent);
    let proof = (!held_out.is_empty()).then(|| {
        let judging = &question.settings.judging;
        FindingProof::new(&without.model, &found.model, &fit.estimate.noise, fit.integration, held_out, judging)
    });
    let tests = FindingTests {
        excludes_zero: intervals.excludes_zero(found, candidate, &of.extent),
        change: change(&fit.runs, &predict_all(&without.model, &fit.runs, fit.integration), with),
        shift: (candidate.mechanism.kind == Kind::Sensor).then(|| shift(&amplitudes, &fit.runs)).flatten(),
        likelihood: proof.as_ref().map(FindingProof::likelihood),
        prediction: proof.as_ref().and_then(FindingProof::prediction),
    };
    Weight { grade: grade(&tests), tests, proof, without }
}

/// The least time by which a clock is off, in sample periods: the end of its interval that is nearer to zero, of the largest of its
/// parameters; `None` for what is no time.
fn shift(amplitudes: &[Amplitude], runs: &[Run]) -> Option<f64> {
    let period = median(runs.iter().map(|r| r.dt))?;
    let times = !amplitudes.is_empty() && amplitudes.iter().all(|a| a.unit == "s");
    let least = |a: &Amplitude| f64::max(a.ci95[0], -a.ci95[1]).max(0.0);
    times.then(|| amplitudes.iter().map(least).fold(0.0, f64::max) / period)
}

/// The mechanism that is withdrawn first: of those that their grade does not name, the one that gains least on unseen runs.
pub fn weakest(weights: &[Weight]) -> Option<usize> {
    let not_named = weights.iter().enumerate().filter(|(_, w)| !w.grade.is_named());
    not_named.min_by(|a, b| a.1.gain().total_cmp(&b.1.gain())).map(|(i, _)| i)
}

/// A mechanism that was tried and withdrawn, as a finding with its grade.
pub fn withdrawn(kept: &Kept, left: &Left, index: usize, weight: &Weight) -> Finding {
    let (selection, found) = (&kept.selection, &kept.selection.estimate);
    let intervals = Intervals::new(found, &selection.tests.fit.runs, &left.screen);
    let finding = mechanism_finding(&selection.mechanisms[index], selection, &intervals);
    Finding { grade: weight.grade, held_out: weight.proof.clone(), change: Some(weight.tests.change), ..finding }
}

/// Whether the model that is kept, or else the base model, follows the recordings: most runs are simulated better than by steady
/// motion. Without this nothing that is added to a model means anything.
pub struct Base {
    /// The better of the two.
    pub following: Following,
    /// Whether it holds.
    pub holds: bool,
}

impl Base {
    /// Judges both models on the training runs.
    pub fn new(question: &Question, kept: &Kept) -> Self {
        let fit = &kept.selection.tests.fit;
        let of = |e: &Estimate| {
            let predicted = predict_all(&e.model, &fit.runs, fit.integration);
            Following::new(&e.model, &fit.runs, &predicted, question.settings.judging.max_yaw_rate)
        };
        let (base, found) = (of(&fit.estimate), of(&kept.selection.estimate));
        let following = if found.share() > base.share() { found } else { base };
        Self { holds: following.share() >= FOLLOWED_SHARE, following }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{model, runs};
    use crate::diagnose::grade::GainTest;

    fn weight(grade: Grade, gain: f64) -> Weight {
        let likelihood = Some(GainTest { gain, ci95: None });
        let tests = FindingTests { excludes_zero: true, change: 1.0, shift: None, likelihood, prediction: None };
        Weight { grade, tests, proof: None, without: crate::diagnose::example::at(&model()) }
    }

    #[test]
    fn the_first_to_go_is_the_one_that_gains_least_of_those_that_are_not_named() {
        let all = [weight(Grade::Confirmed, -90.0), weight(Grade::Refuted, -20.0), weight(Grade::Immaterial, -30.0)];
        assert_eq!(weakest(&all), Some(2));
        assert_eq!(weakest(&all[..1]), None);
        assert_eq!(weakest(&[]), None);
    }

    #[test]
    fn only_times_are_shifts_and_they_count_in_sample_periods() {
        let runs = runs(&model(), 3);
        let of = |unit: &str, value: f64| Amplitude::within("a.b".into(), value, unit, 0.1, 2.0);
        // The sample period is 3 s, and the interval of -0.8 s reaches to -0.6 s.
        assert!((shift(&[of("s", -0.8), of("s", 0.3)], &runs).unwrap() - 0.2).abs() < 1e-12);
        assert_eq!(shift(&[of("s", 0.1)], &runs), Some(0.0));
        assert_eq!(shift(&[of("s", 0.6), of("m", 0.3)], &runs), None);
        assert_eq!(shift(&[], &runs), None);
    }
}
