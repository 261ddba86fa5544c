//! What every selected mechanism is worth by itself: the model with it against the model refitted without it, on the training runs
//! and on unseen ones. It computes the tests of a finding; the grade is a pure function of them.

use super::describe::{Intervals, mechanism_finding, push_finding, sensor_findings};
use super::finding::{Amplitude, Finding, are_times};
use super::grade::{FindingTests, Grade, Shift, grade};
use super::influence::{Following, change};
use super::prove::mean_cvdm;
use super::unseen::{FindingProof, agreement};
use crate::diagnose::evidence::candidate::{Candidate, Extent};
use crate::diagnose::search::base::Question;
use crate::diagnose::search::event::BaseTests;
use crate::diagnose::search::problem::Problem;
use crate::diagnose::search::residual::{Kept, Left};
use crate::diagnose::search::screen::Screen;
use crate::diagnose::search::selected::Selected;
use crate::diagnose::settings::{AS_IT_IS, REFIT, SETTLE};
use crate::evaluate::predict_all;
use crate::likelihood::estimate::Estimate;
use crate::numerals::sig;
use crate::physics::{Kind, Mechanism};
use crate::recording::Run;
use crate::simulate::{Integration, MOST_SUBSTEPS, Method, Trajectory};
use crate::statistics::median;

/// Clocks that differ, in the catalogue.
const CLOCKS: &str = "time_skew";

/// A selected mechanism with the evidence for and against it.
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
    /// Whether it stays in the model, though it is not named: unseen runs must not refute it.
    pub fn is_carried(&self) -> bool {
        self.grade.may_be_carried() && !self.tests.is_refuted()
    }

    /// Whether the sensors of unseen runs show it themselves.
    fn is_shown(&self) -> bool {
        self.proof.as_ref().is_some_and(FindingProof::is_shown)
    }

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
    let proof = (!held_out.is_empty()).then(|| proof(question, kept, of, &without, held_out));
    let mut tests = FindingTests {
        excludes_zero: intervals.excludes_zero(found, candidate, &of.extent),
        isolated: isolated(tests, of),
        change: change(&fit.runs, &predict_all(&without.model, &fit.runs, fit.integration), with),
        at_limit: is_at_limit(&amplitudes, found, candidate, &of.extent),
        unexplained: kept.left.as_ref().map_or(0.0, |left| unexplained(&left.screen, of, question.settings.alpha)),
        shift: shift(candidate.mechanism.kind, &amplitudes, &fit.runs),
        by_steps: 0.0,
        likelihood: proof.as_ref().and_then(FindingProof::likelihood),
        prediction: proof.as_ref().and_then(FindingProof::prediction),
        agreement: proof.as_ref().and_then(FindingProof::agreement),
    };
    // Costs an estimate, and only what would be named needs it.
    let like_a_clock = |m: &Mechanism| m.kind == Kind::Sensor && (m.name == CLOCKS || m.look_alikes.contains(&CLOCKS));
    let may_be_steps = like_a_clock(candidate.mechanism) || candidate.mechanism.kind == Kind::Actuator;
    if may_be_steps && grade(&tests).is_named() {
        tests.by_steps = by_steps(question, kept, &without);
    }
    Weight { grade: grade(&tests), tests, proof, without }
}

/// A mechanism on unseen runs: an error of a sensor by what their sensors show themselves, all else against the model `without` it, refitted.
fn proof(question: &Question, kept: &Kept, of: &Selected, without: &Estimate, held_out: &[Run]) -> FindingProof {
    let (tests, found) = (&kept.selection.tests, &kept.selection.estimate);
    let candidate = &tests.candidates[of.candidate];
    let is_sensor = candidate.mechanism.kind == Kind::Sensor;
    let (alone, _) = candidate.removed(found, &of.extent);
    let asked = is_sensor.then(|| agreement(&alone, &found.model, held_out, &tests.candidates));
    let agreement = asked.flatten();
    if let Some(shown) = agreement.filter(|g| g.is_above_zero()) {
        return FindingProof::shown(shown, held_out);
    }
    let judging = &question.settings.judging;
    let integration = tests.fit.integration;
    FindingProof::new(&without.model, &found.model, &found.noise, integration, held_out, judging).beside(agreement)
}

/// The least share of its information that is left to the weather of a set: what cannot be distinguished from a member that the ship's own
/// parameters can take over counts as taken over too. 1 for what is no weather.
fn isolated(tests: &BaseTests, of: &Selected) -> f64 {
    let is_weather = |i: &&usize| tests.candidates[**i].mechanism.is_weather();
    let left = of.set.iter().filter(is_weather).map(|i| tests.screen.isolated(*i, &of.extent, &tests.candidates));
    left.fold(1.0, f64::min)
}

/// The share of what a clock, a sensor's error like it or an actuator's lag gains over the model `without` it that explicit Euler steps of
/// one sample period of the recordings gain in its place: with such steps positions are late by a sample and the ship answers its
/// actuators late, as they do where values are held until the next sample.
fn by_steps(question: &Question, kept: &Kept, without: &Estimate) -> f64 {
    let steps = median(kept.selection.tests.fit.runs.iter().map(|r| r.dt / r.recorded_dt)).unwrap_or(1.0);
    let substeps = (steps.round() as usize).clamp(1, MOST_SUBSTEPS);
    let fine = kept.selection.tests.problem(question.settings);
    let coarse = Problem { integration: Integration { method: Method::Euler, substeps }, ..fine };
    let found = &kept.selection.estimate;
    // All three with noise estimated along, so that none gains by more rounds of estimation.
    let settled = |p: &Problem, e: &Estimate| p.estimate(&e.model, &e.free, &found.noise, SETTLE).log_posterior;
    let base = settled(&fine, without);
    let gain = settled(&fine, found) - base;
    if gain > 0.0 { ((settled(&coarse, without) - base) / gain).max(0.0) } else { 0.0 }
}

/// Whether a size of a mechanism is at the limit of what such a size can be, other than nothing: within its standard error of it.
fn is_at_limit(amplitudes: &[Amplitude], found: &Estimate, candidate: &Candidate, extent: &Extent) -> bool {
    let places = candidate.positions(&found.free, extent);
    amplitudes.iter().zip(places).any(|(a, i)| {
        let p = &found.model.parameters[found.free[i].column.parameter];
        p.upper > 0.0 && p.upper - a.value < a.error || p.lower < 0.0 && a.value - p.lower < a.error
    })
}

/// What a smooth force law of their own gains in the sessions where a mechanism acts, beside the same law in all sessions and more than by chance,
/// over what the mechanism gained: `(T_law - d) / T`. What is wrong with the form of the ship's forces is the same in all sessions.
fn unexplained(left: &Screen, of: &Selected, alpha: f64) -> f64 {
    let Extent::In(sessions) = &of.extent else { return 0.0 };
    let test = left.law_of_its_own(sessions);
    let gain = test.statistic - test.degrees as f64;
    if test.p < alpha && of.statistic > 0.0 { gain / of.statistic } else { 0.0 }
}

/// The least time by which a clock is off or an actuator late, in sample periods of the recordings: the end of its interval that is nearer to
/// zero, of the largest of its parameters; `None` for what is no time.
fn shift(kind: Kind, amplitudes: &[Amplitude], runs: &[Run]) -> Option<Shift> {
    let period = median(runs.iter().map(|r| r.recorded_dt))?;
    let least = |a: &Amplitude| f64::max(a.ci95[0], -a.ci95[1]).max(0.0);
    let periods = are_times(amplitudes).then(|| amplitudes.iter().map(least).fold(0.0, f64::max) / period)?;
    match kind {
        Kind::Sensor => Some(Shift::OfClock(periods)),
        Kind::Actuator => Some(Shift::OfLag(periods)),
        Kind::Environment | Kind::Ship => None,
    }
}

/// The mechanism that is withdrawn first: of those that their grade neither names nor keeps in the model, the one that gains least on
/// unseen runs.
pub fn weakest(weights: &[Weight]) -> Option<usize> {
    let goes = |w: &Weight| !w.grade.is_named() && !w.is_carried();
    let going = weights.iter().enumerate().filter(|(_, w)| goes(w));
    going.min_by(|a, b| a.1.gain().total_cmp(&b.1.gain())).map(|(i, _)| i)
}

/// Where all that is kept makes unseen runs significantly worse, in the models that are written, and no part did so by itself, the part
/// that does least for them: it is withdrawn first. All that is named together, a push too, must not be refuted.
pub fn weakest_together(question: &Question, kept: &Kept, weights: &mut [Weight], held_out: &[Run]) -> Option<usize> {
    if weights.is_empty() || held_out.is_empty() {
        return None;
    }
    let (tests, judging) = (&kept.selection.tests, &question.settings.judging);
    let written = |e: &Estimate| tests.problem(question.settings).inside_bounds(e);
    let [base, found] = [&tests.fit.estimate, &kept.selection.estimate].map(written);
    let proof = FindingProof::new(&base.model, &found.model, &found.noise, tests.fit.integration, held_out, judging);
    let simulated = proof.prediction().is_some_and(|g| g.is_materially_worse());
    if !simulated && !proof.likelihood().is_some_and(|g| g.is_below_zero()) {
        return None;
    }
    let index = does_least(weights, simulated)?;
    if let [alone] = weights {
        // It was weighed before, in models whose parameters may be outside their bounds.
        (alone.grade, alone.proof) = (Grade::Refuted, Some(proof));
    } else {
        weights[index].grade = Grade::RefutedTogether;
    }
    Some(index)
}

/// What is kept, with the ship of the base model where all that the model has of it, named or not, are errors of sensors that the kinematic
/// consistency of the unseen runs shows, and the ship that was refitted with these errors simulates the unseen runs worse: such errors are
/// no evidence against the ship's own parameters.
pub fn with_ship_held(question: &Question, mut kept: Kept, weights: &[Weight], held_out: &[Run]) -> Kept {
    if weights.is_empty() || !weights.iter().all(Weight::is_shown) {
        return kept;
    }
    let (tests, found) = (&kept.selection.tests, &kept.selection.estimate);
    let base = &tests.fit.estimate;
    let error = |e: &Estimate| mean_cvdm(&e.model, held_out, &question.settings.judging);
    // A ship that is lost has no error.
    if let Some(before) = error(base)
        && error(found).is_none_or(|after| after > before)
    {
        let own = found.free.iter().filter(|f| base.free.iter().all(|b| b.column.parameter != f.column.parameter));
        let (mut model, mut free) = (base.model.clone(), base.free.clone());
        for f in own {
            f.set(&mut model, f.value(&found.model));
            free.push(f.clone());
        }
        kept.selection.estimate = tests.problem(question.settings).estimate(&model, &free, &found.noise, AS_IT_IS);
    }
    kept
}

/// The mechanism that gains least on unseen runs, in free simulation or in log-likelihood, of those that their sensors do not show
/// themselves.
fn does_least(weights: &[Weight], simulated: bool) -> Option<usize> {
    let gain = |w: &Weight| if simulated { w.tests.prediction.map_or(0.0, |g| g.gain) } else { w.gain() };
    let doubted = weights.iter().enumerate().filter(|(_, w)| !w.is_shown());
    doubted.min_by(|a, b| gain(a.1).total_cmp(&gain(b.1))).map(|(i, _)| i)
}

/// A mechanism with its weight, as a finding.
fn weighed(kept: &Kept, mechanism: &Selected, weight: &Weight, intervals: &Intervals) -> Finding {
    let finding = mechanism_finding(mechanism, &kept.selection, intervals);
    let why = if weight.tests.is_part() { finding.why + &in_part(weight.tests.unexplained) } else { finding.why };
    Finding { grade: weight.grade, held_out: weight.proof.clone(), change: Some(weight.tests.change), why, ..finding }
}

/// That something acts beside a mechanism or in its place.
fn in_part(unexplained: f64) -> String {
    format!(
        "; it is another cause, or not the only one: a smooth force law of the sessions where it acts gains {} % as much beside it",
        sig(100.0 * unexplained, 2)
    )
}

/// A mechanism that was tried and withdrawn, as a finding with its grade.
pub fn withdrawn(kept: &Kept, left: &Left, index: usize, weight: &Weight) -> Finding {
    let intervals = Intervals::new(&kept.selection.estimate, &kept.selection.tests.fit.runs, &left.screen);
    weighed(kept, &kept.selection.mechanisms[index], weight, &intervals)
}

/// The mechanisms that stay in the model and are not named, or else those that are named, as findings with their grades.
fn mechanisms(kept: &Kept, weights: &[Weight], are_carried: bool) -> Vec<Finding> {
    let Some(left) = &kept.left else { return Vec::new() };
    let intervals = Intervals::new(&kept.selection.estimate, &kept.selection.tests.fit.runs, &left.screen);
    let some = kept.selection.mechanisms.iter().zip(weights).filter(|(m, _)| m.carried == are_carried);
    some.map(|(m, weight)| weighed(kept, m, weight, &intervals)).collect()
}

/// The mechanisms that stay in the model and are not named, as findings with their grades.
pub fn carried(kept: &Kept, weights: &[Weight]) -> Vec<Finding> {
    mechanisms(kept, weights, true)
}

/// The findings, the strongest first: faults of sensors, mechanisms with their weights, a push.
pub fn findings(kept: &Kept, weights: &[Weight]) -> Vec<Finding> {
    let tests = &kept.selection.tests;
    let mut out = if tests.is_blocked() { sensor_findings(&tests.fit.admission) } else { Vec::new() };
    out.extend(mechanisms(kept, weights, false));
    out.extend(kept.push.as_ref().map(|p| push_finding(p, &tests.location)));
    out
}

/// Whether the model that is kept, or else the base model, follows the recordings: the runs that are simulated better than by
/// steady motion outweigh the others. Without this nothing that is added to a model means anything.
pub struct Base {
    /// The better of the two.
    pub following: Following,
    /// Whether it follows them well enough to name anything.
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
        let following = if found.rank_share > base.rank_share { found } else { base };
        Self { holds: following.holds(), following }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::evidence::candidate::candidates;
    use crate::diagnose::example::{RK4, at, model, runs, with};
    use crate::diagnose::proof::grade::GainTest;
    use crate::diagnose::search::screen::screen;
    use crate::diagnose::settings::Settings;
    use crate::likelihood::estimate::FreeParameter;
    use crate::likelihood::noise::NoisePrior;

    fn weight(grade: Grade, gain: f64) -> Weight {
        let likelihood = Some(GainTest { gain, ci95: None });
        let tests = FindingTests {
            excludes_zero: true,
            isolated: 1.0,
            change: 1.0,
            at_limit: false,
            unexplained: 0.0,
            shift: None,
            by_steps: 0.0,
            likelihood,
            prediction: None,
            agreement: None,
        };
        Weight { grade, tests, proof: None, without: crate::diagnose::example::at(&model()) }
    }

    #[test]
    fn the_first_to_go_is_the_one_that_gains_least_of_those_that_are_not_named() {
        let all = [
            weight(Grade::Confirmed, -90.0),
            weight(Grade::Refuted, -20.0),
            weight(Grade::Undetermined, -30.0),
            weight(Grade::Immaterial, -80.0),
        ];
        assert_eq!(weakest(&all), Some(2));
        assert_eq!(weakest(&all[..1]), None);
        assert_eq!(weakest(&[]), None);
    }

    #[test]
    fn what_the_sensors_of_unseen_runs_show_themselves_stays_whatever_the_ship_predicts() {
        let shown = FindingProof::shown(GainTest { gain: 9.0, ci95: Some([4.0, 14.0]) }, &runs(&model(), 3));
        let proven = Weight { proof: Some(shown), ..weight(Grade::Confirmed, -50.0) };
        assert_eq!(does_least(&[weight(Grade::Suspected, 3.0), proven], false), Some(0));
        let shown = FindingProof::shown(GainTest { gain: 9.0, ci95: Some([4.0, 14.0]) }, &runs(&model(), 3));
        assert_eq!(does_least(&[Weight { proof: Some(shown), ..weight(Grade::Confirmed, -50.0) }], false), None);
    }

    #[test]
    fn of_what_is_refuted_together_the_one_goes_that_does_least_by_the_measure_that_refutes() {
        let of = |likelihood: f64, improvement: f64| {
            let w = weight(Grade::Confirmed, likelihood);
            Weight {
                tests: FindingTests { prediction: Some(GainTest { gain: improvement, ci95: None }), ..w.tests },
                ..w
            }
        };
        let all = [of(50.0, 0.1), of(5.0, 0.3), of(20.0, -0.1)];
        assert_eq!((does_least(&all, true), does_least(&all, false), does_least(&[], true)), (Some(2), Some(1), None));
    }

    #[test]
    fn only_times_are_shifts_and_they_count_in_sample_periods() {
        let runs = runs(&model(), 3);
        let of = |unit: &str, value: f64| Amplitude::within("a.b".into(), value, unit, 0.1, 2.0);
        // The sample period is 3 s, and the interval of -0.8 s reaches to -0.6 s.
        let Some(Shift::OfClock(late)) = shift(Kind::Sensor, &[of("s", -0.8), of("s", 0.3)], &runs) else {
            panic!("a clock")
        };
        assert!((late - 0.2).abs() < 1e-12);
        assert_eq!(shift(Kind::Sensor, &[of("s", 0.1)], &runs), Some(Shift::OfClock(0.0)));
        assert_eq!(shift(Kind::Actuator, &[of("s", 0.1)], &runs), Some(Shift::OfLag(0.0)));
        assert_eq!(shift(Kind::Ship, &[of("s", 0.8)], &runs), None);
        assert_eq!(shift(Kind::Sensor, &[of("s", 0.6), of("m", 0.3)], &runs), None);
        assert_eq!(shift(Kind::Sensor, &[], &runs), None);
    }

    /// What is left to a force law beside a zero of the rudder in session a, where these values hold in that session.
    fn left_in_a(truth: &[(&str, f64)]) -> f64 {
        let (m, settings) = (model(), Settings { nuisance: false, ..Settings::default() });
        let (mut all, of_a) = (runs(&m, 12), runs(&with(truth), 12));
        all.iter_mut().zip(of_a).filter(|(run, _)| run.session == "a").for_each(|(run, own)| *run = own);
        let (list, prior) = (candidates(&m, &[]), NoisePrior::around(&at(&m).noise));
        let problem = Problem { integration: RK4, runs: &all, candidates: &list, prior: &prior, settings: &settings };
        let candidate = list.iter().position(|c| c.mechanism.name == "rudder_offset").unwrap();
        let extent = Extent::In(vec!["a".into()]);
        let base = problem.again(&at(&m), SETTLE);
        let free: Vec<FreeParameter> = base.free.iter().cloned().chain(list[candidate].parameters(&extent)).collect();
        let found = problem.estimate(&base.model, &free, &base.noise, SETTLE);
        let statistic = 2.0 * (found.log_posterior - base.log_posterior);
        let (set, why) = (vec![candidate], String::new());
        let of = Selected { candidate, extent, set, why, statistic, p: 0.0, carried: false };
        unexplained(&screen(&found, RK4, &all, &list), &of, settings.alpha)
    }

    #[test]
    fn a_mechanism_that_is_all_that_acts_in_its_sessions_leaves_nothing_there_and_one_beside_a_current_does() {
        assert_eq!(left_in_a(&[("rudder_offset.offset", 0.06)]), 0.0);
        let beside = left_in_a(&[("rudder_offset.offset", 0.06), ("current.north", 0.4)]);
        assert!(beside > 0.1, "{beside}");
    }
}
