//! The grade of a finding as a pure function of its tests: the gains on unseen runs, its interval and its size.
//! It estimates nothing and looks at no runs; every number it compares with is in the settings.

use crate::diagnose::settings::{FORM_TOLERANCE, MATERIAL_SHARE, RESOLVED_SAMPLES};
use serde::Serialize;

/// How well a finding is supported.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Grade {
    /// Unseen runs are better with it: significantly by one of log-likelihood and free simulation, and not worse by the other.
    Confirmed,
    /// It is significant on the training runs; unseen runs do not decide, or there are none.
    Suspected,
    /// Unseen runs are worse with it by log-likelihood or, by more than matters, by free simulation, the interval below zero: it is not named
    /// and not written to the improved model.
    Refuted,
    /// Unseen runs are not worse with it by itself, but with all that was found together, and it does least for them of what was found: it is
    /// neither named nor written.
    RefutedTogether,
    /// Significant, but it changes predictions by less than matters, or a clock by less than is resolved.
    Immaterial,
    /// The interval of its size does not exclude zero, and unseen runs do not prove it.
    Undetermined,
    /// Weather nearly all of whose effect the ship's own parameters and the zeros and scales of its sensors can take over, on the headings
    /// that were sailed.
    NotIsolated,
    /// A clock, a point of the positions or an actuator that is late, and explicit Euler steps of one sample period explain it as well:
    /// these recordings cannot distinguish it from a coarse simulation or from values held until the next sample.
    EulerSteps,
    /// Most repetitions on transformed recordings do not find it.
    Unstable,
}

impl Grade {
    /// Whether a finding of this grade is named.
    pub fn is_named(self) -> bool {
        matches!(self, Self::Confirmed | Self::Suspected)
    }

    /// Whether a finding of this grade may stay in the model, though it is not named: it is there, and what it does would be taken for
    /// something else.
    pub fn may_be_carried(self) -> bool {
        matches!(self, Self::Immaterial | Self::EulerSteps)
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
    /// The gain of free simulations of so many runs: where one model diverges on more of them than the other, the share of them by which it
    /// does, for an error without end is larger than any; else the improvement of the mean cVDM.
    pub(in crate::diagnose) fn of_simulations(
        diverged: [usize; 2],
        runs: usize,
        improvement: Option<f64>,
        ci95: Option<[f64; 2]>,
    ) -> Option<Self> {
        let [before, after] = diverged.map(|count| count as f64);
        let lost = (before - after) / runs.max(1) as f64;
        if lost == 0.0 { Some(Self { gain: improvement?, ci95 }) } else { Some(Self { gain: lost, ci95: None }) }
    }

    pub(in crate::diagnose) fn is_above_zero(&self) -> bool {
        self.ci95.is_some_and(|[low, _]| low > 0.0)
    }

    /// Whether it is below zero, significantly where there is an interval.
    pub(in crate::diagnose) fn is_worse(&self) -> bool {
        self.ci95.map_or(self.gain < 0.0, |[_, high]| high < 0.0)
    }

    pub(in crate::diagnose) fn is_below_zero(&self) -> bool {
        self.ci95.is_some_and(|[_, high]| high < 0.0)
    }

    /// Of a free simulation, a share of its error: whether it is worse significantly, and by more than matters.
    pub(in crate::diagnose) fn is_materially_worse(&self) -> bool {
        self.is_below_zero() && self.gain < -MATERIAL_SHARE
    }
}

/// What is known of one finding beside its significance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FindingTests {
    /// Whether the interval of its size excludes zero, whichever of its parameters brings it.
    pub excludes_zero: bool,
    /// For weather, the share of its information that is left beside the ship's own parameters and the errors of its sensors, in the worst
    /// direction; 1 for all else.
    pub isolated: f64,
    /// By how much it changes predictions of the training runs, as a share of the error there is, in the channel where that is most.
    pub change: f64,
    /// Whether a size of it ended at the limit of what such a size can be.
    pub at_limit: bool,
    /// Of what acts in some sessions only, the gain in log-likelihood of a smooth force law there over its own; 0 for all else, and where chance
    /// gains as much.
    pub unexplained: f64,
    /// The least time in its interval by which it shifts a sensor's clock or an actuator's answer, where it does so.
    pub shift: Option<Shift>,
    /// For a clock and for an actuator, the share of its gain in log-posterior that explicit Euler steps of one sample period take over; 0
    /// for all else.
    pub by_steps: f64,
    /// Gain in log-likelihood of unseen runs.
    pub likelihood: Option<GainTest>,
    /// Improvement of the free simulation of unseen runs.
    pub prediction: Option<GainTest>,
    /// For an error of a sensor, gain in log-likelihood of the kinematic consistency of unseen runs, where that is known.
    pub agreement: Option<GainTest>,
}

/// Whether a mechanism that so many of the repetitions find is not stable enough to be named: fewer than half of them.
pub fn is_unstable(found: usize, repetitions: usize) -> bool {
    2 * found < repetitions
}

impl FindingTests {
    /// Whether unseen runs are significantly worse with it by one measure at least: what simulates them worse is no improvement, however
    /// likely it makes them, and what one measure refutes is not named.
    pub fn is_refuted(&self) -> bool {
        refute(self.likelihood, self.prediction, self.agreement)
    }

    /// Whether more is left in the sessions where it acts than the uncertainty in the form of its force: it is another cause, or not the only one.
    pub fn is_part(&self) -> bool {
        self.unexplained > FORM_TOLERANCE
    }

    /// Whether it is too small to matter: a clock by the sensor's own resolution, a lag by that or by how little it changes predictions, all
    /// else by the latter. A position that is late by many samples is off by less than a free simulation is after a minute, and late all the
    /// same.
    fn is_immaterial(&self) -> bool {
        let unchanged = self.change < MATERIAL_SHARE;
        match self.shift {
            None => unchanged,
            Some(Shift::OfClock(s)) => s < RESOLVED_SAMPLES,
            Some(Shift::OfLag(s)) => s < RESOLVED_SAMPLES || unchanged,
        }
    }
}

/// The least time by which something is late, in sample periods of the recordings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shift {
    /// A sensor's clock.
    OfClock(f64),
    /// An actuator's answer.
    OfLag(f64),
}

/// Whether unseen runs are significantly worse by one measure; a free simulation that differs by less than matters refutes nothing.
fn refute(likelihood: Option<GainTest>, prediction: Option<GainTest>, agreement: Option<GainTest>) -> bool {
    [likelihood, agreement].iter().flatten().any(GainTest::is_below_zero)
        || prediction.is_some_and(|g| g.is_materially_worse())
}

/// Whether unseen runs are significantly better by one measure, and worse by none, of log-likelihood, free simulation and, for an error of a
/// sensor, kinematic consistency: by its interval, and by its sign where there is none.
fn confirm(likelihood: Option<GainTest>, prediction: Option<GainTest>, agreement: Option<GainTest>) -> bool {
    let is_shown = agreement.is_some_and(|g| g.is_above_zero());
    let is_judged = is_shown || likelihood.is_some() && prediction.is_some();
    let measures = [likelihood, prediction, agreement];
    let mut known = measures.iter().flatten();
    is_judged && known.clone().any(GainTest::is_above_zero) && known.all(|g| !g.is_worse())
}

/// How well a law for what is not in the catalogue is supported.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum LawGrade {
    /// Unseen runs are better with it, as for [`Grade::Confirmed`].
    Confirmed,
    /// It is significant on the training runs; unseen runs do not decide, or there are none.
    Exploratory,
    /// Unseen runs are worse with it, as for [`Grade::Refuted`].
    Refuted,
}

impl LawGrade {
    /// The grade that gains on unseen runs give.
    pub fn new(likelihood: Option<GainTest>, prediction: Option<GainTest>) -> Self {
        if refute(likelihood, prediction, None) {
            Self::Refuted
        } else if confirm(likelihood, prediction, None) {
            Self::Confirmed
        } else {
            Self::Exploratory
        }
    }
}

/// The grade that the tests of a finding give it. What is determined and too small to matter is neither confirmed nor refuted.
pub fn grade(tests: &FindingTests) -> Grade {
    let proved = confirm(tests.likelihood, tests.prediction, tests.agreement);
    let small = tests.excludes_zero && tests.isolated >= FORM_TOLERANCE && tests.is_immaterial();
    if small {
        Grade::Immaterial
    } else if tests.is_refuted() {
        Grade::Refuted
    } else if !tests.excludes_zero && !proved {
        Grade::Undetermined
    } else if tests.isolated < FORM_TOLERANCE {
        // The share left is less than the uncertainty in the form of the ship's own forces.
        Grade::NotIsolated
    } else if tests.by_steps > 1.0 - FORM_TOLERANCE {
        Grade::EulerSteps
    } else if proved && !tests.at_limit && !tests.is_part() {
        Grade::Confirmed
    } else {
        // At the limit of what it can be it stands for a part of something else.
        Grade::Suspected
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BETTER: Option<GainTest> = Some(GainTest { gain: 20.0, ci95: Some([5.0, 35.0]) });
    const UNDECIDED: Option<GainTest> = Some(GainTest { gain: 3.0, ci95: Some([-5.0, 11.0]) });
    const WORSE: Option<GainTest> = Some(GainTest { gain: -9.0, ci95: Some([-15.0, -3.0]) });

    #[test]
    fn a_model_that_diverges_on_more_runs_is_worse_whatever_it_gains_on_the_others() {
        let of = |diverged| GainTest::of_simulations(diverged, 8, Some(0.3), Some([0.1, 0.5]));
        assert_eq!(of([0, 0]), Some(GainTest { gain: 0.3, ci95: Some([0.1, 0.5]) }));
        assert_eq!(of([2, 2]).map(|g| g.gain), Some(0.3));
        assert!(of([0, 2]).is_some_and(|g| g.gain == -0.25 && g.is_worse()));
        assert!(of([8, 0]).is_some_and(|g| g.gain == 1.0 && !g.is_worse() && !g.is_above_zero()));
        // On all of them: there is no mean error at all.
        assert!(GainTest::of_simulations([0, 8], 8, None, None).is_some_and(|g| g.is_worse()));
        assert_eq!(GainTest::of_simulations([8, 8], 8, None, None), None);
        assert_eq!(grade(&FindingTests { prediction: of([0, 2]), ..sound() }), Grade::Suspected);
    }

    fn sound() -> FindingTests {
        FindingTests {
            excludes_zero: true,
            isolated: 1.0,
            change: 0.5,
            at_limit: false,
            unexplained: 0.0,
            shift: None,
            by_steps: 0.0,
            likelihood: BETTER,
            prediction: BETTER,
            agreement: None,
        }
    }

    #[test]
    fn a_sensors_error_is_confirmed_by_the_sensors_of_unseen_runs_alone_and_refuted_by_them() {
        let alone = |agreement| FindingTests { likelihood: None, prediction: None, agreement, ..sound() };
        assert_eq!(grade(&alone(BETTER)), Grade::Confirmed);
        assert_eq!(grade(&alone(UNDECIDED)), Grade::Suspected);
        assert_eq!(grade(&alone(WORSE)), Grade::Refuted);
        assert_eq!(grade(&FindingTests { agreement: WORSE, ..sound() }), Grade::Refuted);
        assert_eq!(grade(&FindingTests { agreement: UNDECIDED, ..sound() }), Grade::Confirmed);
        let little_worse = Some(GainTest { gain: -4.0, ci95: Some([-9.0, 1.0]) });
        assert_eq!(grade(&FindingTests { agreement: little_worse, ..sound() }), Grade::Confirmed);
        assert_eq!(grade(&FindingTests { excludes_zero: false, ..alone(UNDECIDED) }), Grade::Undetermined);
    }

    #[test]
    fn a_finding_is_confirmed_where_unseen_runs_are_better_by_one_measure_and_not_worse_by_the_other() {
        assert_eq!(grade(&sound()), Grade::Confirmed);
        assert_eq!(grade(&FindingTests { prediction: UNDECIDED, ..sound() }), Grade::Confirmed);
        assert_eq!(grade(&FindingTests { likelihood: UNDECIDED, ..sound() }), Grade::Confirmed);
        let little_worse = Some(GainTest { gain: -0.01, ci95: Some([-0.2, 0.1]) });
        assert_eq!(grade(&FindingTests { prediction: little_worse, ..sound() }), Grade::Confirmed);
        assert_eq!(grade(&FindingTests { likelihood: little_worse, ..sound() }), Grade::Confirmed);
        // Without an interval its sign counts.
        let of_few = Some(GainTest { gain: -0.01, ci95: None });
        assert_eq!(grade(&FindingTests { prediction: of_few, ..sound() }), Grade::Suspected);
    }

    #[test]
    fn what_unseen_runs_prove_is_confirmed_however_wide_the_interval_of_its_size() {
        let wide = FindingTests { excludes_zero: false, ..sound() };
        assert_eq!(grade(&wide), Grade::Confirmed);
        assert_eq!(grade(&FindingTests { prediction: WORSE, ..wide }), Grade::Refuted);
        assert_eq!(grade(&FindingTests { likelihood: UNDECIDED, prediction: UNDECIDED, ..wide }), Grade::Undetermined);
        assert_eq!(grade(&FindingTests { likelihood: None, prediction: None, ..wide }), Grade::Undetermined);
    }

    #[test]
    fn a_clock_matters_by_its_resolution_and_all_else_by_what_it_changes() {
        let small = FindingTests { change: 0.01, ..sound() };
        assert_eq!(grade(&small), Grade::Immaterial);
        assert_eq!(grade(&FindingTests { shift: Some(Shift::OfClock(6.0)), ..small }), Grade::Confirmed);
        assert_eq!(grade(&FindingTests { shift: Some(Shift::OfClock(0.3)), ..sound() }), Grade::Immaterial);
    }

    #[test]
    fn without_unseen_runs_or_with_too_few_it_is_suspected() {
        for undecided in [None, UNDECIDED, Some(GainTest { gain: 50.0, ci95: None })] {
            let tests = FindingTests { likelihood: undecided, prediction: undecided, ..sound() };
            assert_eq!(grade(&tests), Grade::Suspected);
        }
        for tests in [FindingTests { likelihood: None, ..sound() }, FindingTests { prediction: None, ..sound() }] {
            assert_eq!(grade(&tests), Grade::Suspected);
        }
    }

    #[test]
    fn unseen_runs_that_are_worse_by_one_measure_refute_it_whatever_the_other_says() {
        let little_worse = Some(GainTest { gain: -0.01, ci95: Some([-0.2, 0.1]) });
        for tests in [
            FindingTests { likelihood: WORSE, prediction: WORSE, ..sound() },
            FindingTests { likelihood: WORSE, prediction: little_worse, ..sound() },
            FindingTests { likelihood: little_worse, prediction: WORSE, ..sound() },
            FindingTests { likelihood: UNDECIDED, prediction: WORSE, ..sound() },
            FindingTests { likelihood: WORSE, prediction: UNDECIDED, ..sound() },
            FindingTests { likelihood: WORSE, prediction: None, ..sound() },
            FindingTests { likelihood: WORSE, ..sound() },
            FindingTests { prediction: WORSE, ..sound() },
            FindingTests { likelihood: WORSE, prediction: WORSE, excludes_zero: false, change: 0.0, ..sound() },
        ] {
            assert_eq!(grade(&tests), Grade::Refuted);
        }
    }

    #[test]
    fn unseen_runs_grade_a_law_as_they_grade_a_finding() {
        let little_worse = Some(GainTest { gain: -0.01, ci95: Some([-0.2, 0.1]) });
        let all = [None, BETTER, UNDECIDED, WORSE, little_worse];
        for (likelihood, prediction) in all.iter().flat_map(|a| all.map(|b| (*a, b))) {
            let expected = match grade(&FindingTests { likelihood, prediction, ..sound() }) {
                Grade::Confirmed => LawGrade::Confirmed,
                Grade::Refuted => LawGrade::Refuted,
                _ => LawGrade::Exploratory,
            };
            assert_eq!(LawGrade::new(likelihood, prediction), expected, "{likelihood:?} {prediction:?}");
        }
        // Worse by a hair, however significantly, is neither an improvement nor a refutation.
        let hair = Some(GainTest { gain: -0.02, ci95: Some([-0.03, -0.01]) });
        assert_eq!(grade(&FindingTests { prediction: hair, ..sound() }), Grade::Suspected);
        assert_eq!(LawGrade::new(BETTER, hair), LawGrade::Exploratory);
        let share = Some(GainTest { gain: -0.06, ci95: Some([-0.08, -0.04]) });
        assert_eq!(grade(&FindingTests { prediction: share, ..sound() }), Grade::Refuted);
        assert_eq!(LawGrade::new(BETTER, UNDECIDED), LawGrade::Confirmed);
        assert_eq!(LawGrade::new(BETTER, WORSE), LawGrade::Refuted);
        assert_eq!(LawGrade::new(None, None), LawGrade::Exploratory);
    }

    #[test]
    fn an_interval_through_zero_and_a_change_too_small_to_matter_are_not_named() {
        assert_eq!(grade(&FindingTests { isolated: 0.09, ..sound() }), Grade::NotIsolated);
        assert_eq!(grade(&FindingTests { change: 0.049, ..sound() }), Grade::Immaterial);
        assert_eq!(grade(&FindingTests { change: 0.05, ..sound() }), Grade::Confirmed);
        // A clock that is off by less than half a sample.
        assert_eq!(grade(&FindingTests { shift: Some(Shift::OfClock(0.49)), ..sound() }), Grade::Immaterial);
        assert_eq!(grade(&FindingTests { shift: Some(Shift::OfClock(0.5)), ..sound() }), Grade::Confirmed);
        // At the limit of its possible size an effect may be part of another law, whatever unseen runs prove.
        assert_eq!(grade(&FindingTests { at_limit: true, ..sound() }), Grade::Suspected);
        for (unexplained, expected) in [(0.05, Grade::Confirmed), (0.5, Grade::Suspected)] {
            assert_eq!(grade(&FindingTests { unexplained, ..sound() }), expected);
        }
        // A lag is immaterial by that, or by how little it changes predictions.
        for (change, late, wanted) in
            [(0.5, 0.49, Grade::Immaterial), (0.04, 0.6, Grade::Immaterial), (0.5, 0.6, Grade::Confirmed)]
        {
            let lag = FindingTests { change, shift: Some(Shift::OfLag(late)), ..sound() };
            assert_eq!(grade(&lag), wanted);
        }
        // A clock that steps of a coarse simulation explain as well.
        let clock = FindingTests { shift: Some(Shift::OfClock(1.0)), ..sound() };
        assert_eq!(grade(&FindingTests { by_steps: 0.89, ..clock }), Grade::Confirmed);
        assert_eq!(grade(&FindingTests { by_steps: 0.91, ..clock }), Grade::EulerSteps);
        assert_eq!(
            grade(&FindingTests { by_steps: 0.91, shift: Some(Shift::OfClock(0.49)), ..clock }),
            Grade::Immaterial
        );
        assert!([Grade::Immaterial, Grade::EulerSteps].iter().all(|g| g.may_be_carried() && !g.is_named()));
        assert!([Grade::Refuted, Grade::Suspected, Grade::Undetermined].iter().all(|g| !g.may_be_carried()));
        // What is too small to matter is not refuted either, but it is not kept against the unseen runs.
        let small = FindingTests { change: 0.01, likelihood: WORSE, prediction: WORSE, ..sound() };
        assert!(grade(&small) == Grade::Immaterial && small.is_refuted());
        assert!(is_unstable(2, 6) && !is_unstable(3, 6) && !is_unstable(0, 0) && !Grade::Unstable.is_named());
        assert!(!Grade::Immaterial.is_named() && !Grade::Undetermined.is_named() && Grade::Suspected.is_named());
    }
}
