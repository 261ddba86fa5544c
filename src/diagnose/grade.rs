//! The grade of a finding as a pure function of its tests: what the unseen runs, its interval and its size say of it.
//! It estimates nothing and knows no runs; every number it compares with is in the settings.

use super::settings::{FORM_TOLERANCE, MATERIAL_SHARE, RESOLVED_SAMPLES};
use serde::Serialize;

/// How well a finding is supported.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Grade {
    /// Unseen runs are likelier with it, the interval above zero, and free simulation is not worse.
    Confirmed,
    /// The training runs speak for it; unseen runs cannot tell, or there are none.
    Suspected,
    /// Unseen runs are worse with it, the interval below zero: it is not named and not written to the improved model.
    Refuted,
    /// Significant, but it changes predictions by less than matters, or a clock by less than is resolved.
    Immaterial,
    /// The interval of its size does not exclude zero.
    Undetermined,
    /// Weather nearly all of whose effect the ship's own parameters can take over, on the headings that were sailed.
    NotIsolated,
    /// Most repetitions on the same recordings told otherwise do not find it.
    Unstable,
}

impl Grade {
    /// Whether a finding of this grade is named.
    pub fn is_named(self) -> bool {
        matches!(self, Self::Confirmed | Self::Suspected)
    }
}

/// A gain on unseen runs, positive for the better, with its 95 % interval over recordings where there are enough.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GainTest {
    /// The gain.
    pub gain: f64,
    /// Its interval.
    pub ci95: Option<[f64; 2]>,
}

impl GainTest {
    fn is_above_zero(&self) -> bool {
        self.ci95.is_some_and(|[low, _]| low > 0.0)
    }

    fn is_below_zero(&self) -> bool {
        self.ci95.is_some_and(|[_, high]| high < 0.0)
    }
}

/// What is known of one finding beside its significance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FindingTests {
    /// Whether the interval of its size excludes zero, whichever of its parameters brings it.
    pub excludes_zero: bool,
    /// For weather, the share of its information that is left beside the ship's own parameters, in the worst direction; 1 for all else.
    pub isolated: f64,
    /// By how much it changes predictions of the training runs, as a share of the error there is, in the channel where that is most.
    pub change: f64,
    /// The least time in its interval by which it shifts a sensor's clock, in sample periods, where it does so.
    pub shift: Option<f64>,
    /// Gain in log-likelihood of unseen runs.
    pub likelihood: Option<GainTest>,
    /// Improvement of the free simulation of unseen runs.
    pub prediction: Option<GainTest>,
}

/// Whether a mechanism that so many of the repetitions find is not stable enough to be named: fewer than half of them.
pub fn is_unstable(found: usize, repetitions: usize) -> bool {
    2 * found < repetitions
}

/// Whether one measure of unseen runs is worse beyond chance and the other does not say that they are better. Where the two disagree,
/// as they do when an error that the finding made up for shows, nothing is refuted.
fn is_refuted(one: Option<GainTest>, other: Option<GainTest>) -> bool {
    one.is_some_and(|g| g.is_below_zero()) && other.is_none_or(|g| g.gain <= 0.0)
}

/// The grade that the tests of a finding give it.
pub fn grade(tests: &FindingTests) -> Grade {
    if is_refuted(tests.likelihood, tests.prediction) || is_refuted(tests.prediction, tests.likelihood) {
        Grade::Refuted
    } else if !tests.excludes_zero {
        Grade::Undetermined
    } else if tests.isolated < FORM_TOLERANCE {
        // What is left is no more than the form of the ship's own forces is known.
        Grade::NotIsolated
    } else if tests.change < MATERIAL_SHARE || tests.shift.is_some_and(|s| s < RESOLVED_SAMPLES) {
        Grade::Immaterial
    } else if tests.likelihood.is_some_and(|g| g.is_above_zero()) && tests.prediction.is_some_and(|g| g.gain >= 0.0) {
        Grade::Confirmed
    } else {
        Grade::Suspected
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BETTER: Option<GainTest> = Some(GainTest { gain: 20.0, ci95: Some([5.0, 35.0]) });
    const UNDECIDED: Option<GainTest> = Some(GainTest { gain: 3.0, ci95: Some([-5.0, 11.0]) });
    const WORSE: Option<GainTest> = Some(GainTest { gain: -9.0, ci95: Some([-15.0, -3.0]) });

    fn sound() -> FindingTests {
        FindingTests {
            excludes_zero: true,
            isolated: 1.0,
            change: 0.5,
            shift: None,
            likelihood: BETTER,
            prediction: BETTER,
        }
    }

    #[test]
    fn a_finding_is_confirmed_where_unseen_runs_are_likelier_and_not_simulated_worse() {
        assert_eq!(grade(&sound()), Grade::Confirmed);
        assert_eq!(grade(&FindingTests { prediction: UNDECIDED, ..sound() }), Grade::Confirmed);
        let little_worse = Some(GainTest { gain: -0.01, ci95: Some([-0.2, 0.1]) });
        assert_eq!(grade(&FindingTests { prediction: little_worse, ..sound() }), Grade::Suspected);
    }

    #[test]
    fn without_unseen_runs_or_with_too_few_it_is_suspected() {
        for likelihood in [None, UNDECIDED, Some(GainTest { gain: 50.0, ci95: None })] {
            assert_eq!(grade(&FindingTests { likelihood, ..sound() }), Grade::Suspected);
        }
        assert_eq!(grade(&FindingTests { prediction: None, ..sound() }), Grade::Suspected);
    }

    #[test]
    fn unseen_runs_that_are_worse_by_one_measure_and_no_better_by_the_other_refute_it() {
        let little_worse = Some(GainTest { gain: -0.01, ci95: Some([-0.2, 0.1]) });
        for tests in [
            FindingTests { likelihood: WORSE, prediction: WORSE, ..sound() },
            FindingTests { likelihood: WORSE, prediction: little_worse, ..sound() },
            FindingTests { likelihood: little_worse, prediction: WORSE, ..sound() },
            FindingTests { likelihood: WORSE, prediction: None, ..sound() },
            FindingTests { likelihood: WORSE, prediction: WORSE, excludes_zero: false, change: 0.0, ..sound() },
        ] {
            assert_eq!(grade(&tests), Grade::Refuted);
        }
        // One measure against the other: neither confirmed nor refuted.
        assert_eq!(grade(&FindingTests { likelihood: WORSE, ..sound() }), Grade::Suspected);
        assert_eq!(grade(&FindingTests { prediction: WORSE, ..sound() }), Grade::Suspected);
    }

    #[test]
    fn an_interval_through_zero_and_a_change_too_small_to_matter_are_not_named() {
        assert_eq!(grade(&FindingTests { excludes_zero: false, ..sound() }), Grade::Undetermined);
        assert_eq!(grade(&FindingTests { isolated: 0.09, ..sound() }), Grade::NotIsolated);
        assert_eq!(grade(&FindingTests { change: 0.049, ..sound() }), Grade::Immaterial);
        assert_eq!(grade(&FindingTests { change: 0.05, ..sound() }), Grade::Confirmed);
        // A clock that is off by less than a sample.
        assert_eq!(grade(&FindingTests { shift: Some(0.99), ..sound() }), Grade::Immaterial);
        assert_eq!(grade(&FindingTests { shift: Some(1.0), ..sound() }), Grade::Confirmed);
        assert!(is_unstable(2, 6) && !is_unstable(3, 6) && !is_unstable(0, 0) && !Grade::Unstable.is_named());
        assert!(!Grade::Immaterial.is_named() && !Grade::Undetermined.is_named() && Grade::Suspected.is_named());
    }
}
