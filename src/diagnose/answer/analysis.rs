//! The answer of one analysis: what is named, what was withdrawn, the verdict; and the same analysis repeated to see whether it is
//! stable. It runs the steps in order; arithmetic and thresholds are in other files.

use super::conclude::{cap, capped_law, conclude, lead};
use crate::diagnose::error::DiagnoseError;
use crate::diagnose::law::Law;
use crate::diagnose::proof::finding::{Finding, PUSH};
use crate::diagnose::proof::grade::Grade;
use crate::diagnose::proof::improved::trimmed;
use crate::diagnose::proof::prove::HeldOut;
use crate::diagnose::proof::stability::{Brief, CHANGES, Change, Doubts, Stability, Variant};
use crate::diagnose::proof::weigh::{
    Base, Weight, carried, findings, weakest, weakest_together, weigh, with_ship_held, withdrawn,
};
use crate::diagnose::search::base::{AuditedRuns, BaseFit, Question};
use crate::diagnose::search::decide::{Decision, Unlisted, Verdict, decide};
use crate::diagnose::search::event::{BaseTests, Opening};
use crate::diagnose::search::residual::{Kept, Residual};
use crate::diagnose::search::select::Selection;
use crate::diagnose::settings::Settings;
use crate::likelihood::estimate::Estimate;
use crate::model::Model;
use crate::recording::Run;
use std::borrow::Cow;

/// What one analysis answers.
pub struct Answer {
    /// The verdict.
    pub verdict: Verdict,
    /// What is named, with grades.
    pub findings: Vec<Finding>,
    /// What was selected and withdrawn, with grades.
    pub withdrawn: Vec<Finding>,
    /// The mechanisms that are named, with the tests of what they leave.
    pub kept: Kept,
    /// Whether the model follows the recordings.
    pub base: Base,
    /// A law for what is not in the catalogue.
    pub law: Option<Law>,
    decision: Decision,
    /// Mechanisms that one of the repetitions does not find.
    doubtful: Vec<String>,
}

impl Answer {
    /// This answer under the proof of all findings together.
    pub fn capped(mut self, proof: Option<&HeldOut>) -> Self {
        cap(&mut self.findings, proof.is_some_and(HeldOut::is_worse));
        if let Some(law) = &mut self.law {
            law.grade = capped_law(law.grade, proof.is_none_or(HeldOut::is_better));
        }
        self
    }

    /// All steps up to the verdict. A mechanism that its grade does not name is taken out again, one after the other, and what is left
    /// is tested and decided anew.
    pub fn new<'r>(question: &Question, runs: impl Into<Cow<'r, [Run]>>, held_out: &[Run]) -> Self {
        let audited = AuditedRuns::new(runs, question.full.ship.hull.lpp);
        let base: BaseFit = BaseFit::new(question, audited);
        let tests: BaseTests = BaseTests::new(question, base);
        let opening: Opening = Opening::new(question, tests);
        let selection: Selection = Selection::new(question, opening);
        Self::settled(question, Residual::new(question, selection), Vec::new(), &[], held_out)
    }

    /// Takes out what is not named, one mechanism after the other, and decides on what is left; `tried` lists what was withdrawn before,
    /// `graded` the names whose grade is known.
    fn settled(
        question: &Question,
        mut residual: Residual,
        mut tried: Vec<Finding>,
        graded: &[(String, Grade)],
        held_out: &[Run],
    ) -> Self {
        let (mut kept, mut decision, mut weights, push) = loop {
            let push = residual.selection.push.clone();
            let decision: Decision = decide(&residual.table(question));
            let kept: Kept = residual.decided(&decision);
            let mut weights = weigh(question, &kept, held_out);
            for (mechanism, weight) in kept.selection.mechanisms.iter().zip(&mut weights) {
                let name = kept.selection.tests.candidates[mechanism.candidate].mechanism.name;
                if let Some((_, grade)) = graded.iter().find(|(known, _)| known == name) {
                    weight.grade = *grade;
                }
            }
            let goes = weakest(&weights).or_else(|| weakest_together(question, &kept, &mut weights, held_out));
            let (Some(i), Some(left)) = (goes, &kept.left) else { break (kept, decision, weights, push) };
            let weight = weights.swap_remove(i);
            tried.push(withdrawn(&kept, left, i, &weight));
            residual = kept.without(question, i, weight.without, push);
        };
        let stays: Vec<bool> = weights.iter().map(Weight::is_carried).collect();
        if !kept.is_marked(&stays) {
            // The model is the same, and so are the weights; only what may be named is decided anew.
            residual = kept.marked(&stays, push);
            decision = decide(&residual.table(question));
            kept = residual.decided(&decision);
            weights.truncate(kept.selection.mechanisms.len());
        }
        tried.extend(carried(&kept, &weights));
        let base = Base::new(question, &kept);
        let grades: Vec<Grade> = tried.iter().map(|f| f.grade).collect();
        let verdict = conclude(decision.verdict, &grades, base.holds);
        let mut findings = findings(&kept, &weights);
        if !base.holds {
            tried.append(&mut findings);
        }
        let verdict = lead(verdict, &mut findings);
        let tried = unnamed(tried, &findings);
        let kept = with_ship_held(question, kept, &weights, held_out);
        Self { verdict, findings, withdrawn: tried, kept, base, law: None, decision, doubtful: Vec::new() }
    }

    /// This answer with a law for what is missing, where that is not in the catalogue and is no force in one part of the water.
    pub fn with_law(mut self, question: &Question, held_out: &[Run]) -> Self {
        if self.verdict == Verdict::NotInCatalogue && self.unlisted() != Some(Unlisted::Place) {
            self.law = Law::new(question, &self.kept.selection.tests, held_out);
        }
        self
    }

    /// The law that unseen runs confirm, where nothing is named.
    pub fn confirmed_law(&self) -> Option<&Law> {
        self.law.as_ref().filter(|l| l.is_confirmed() && self.findings.is_empty())
    }

    /// Whether the improved model has more than the base model.
    pub fn improves(&self) -> bool {
        !self.findings.is_empty() || self.confirmed_law().is_some()
    }

    /// The estimate with what is named, or else with a law that unseen runs confirm; that of the base model where there is neither.
    pub fn improved(&self) -> &Estimate {
        let Selection { estimate, tests, .. } = &self.kept.selection;
        let base = || self.confirmed_law().map_or(&tests.fit.estimate, |l| &l.estimate);
        if self.findings.is_empty() { base() } else { estimate }
    }

    /// What is missing and not in the catalogue.
    pub fn unlisted(&self) -> Option<Unlisted> {
        self.decision.unlisted.filter(|_| self.base.holds)
    }

    /// Repeats the analysis on the recordings as they were given: transformed (turned, mirrored, cut, thinned, started elsewhere), and,
    /// once, with the improved model. A finding that one of the transformed analyses does not find is suspected at most; one that most
    /// of them do not find is withdrawn. Nothing is repeated where nothing was found or the user does not want it.
    ///
    /// # Errors
    /// When the catalogue's terms cannot be added to a changed model.
    pub fn repeated(
        self,
        question: &Question,
        runs: &[Run],
        held_out: &[Run],
    ) -> Result<(Self, Option<Stability>), DiagnoseError> {
        if self.findings.is_empty() || !question.settings.repeat {
            return Ok((self, None));
        }
        let own = Brief::new(self.verdict, &self.findings);
        let mut others = Vec::with_capacity(CHANGES.len());
        for (i, change) in CHANGES.iter().enumerate() {
            (question.progress)(&format!("repeating ({} of {}): {}", i + 1, CHANGES.len(), change.name));
            others.push(brief(question.settings, change, question.model, runs, held_out)?);
        }
        let doubts = own.doubts(&others);
        let variants: Vec<Variant> = CHANGES
            .iter()
            .zip(&others)
            .map(|(change, o)| Variant {
                name: change.name,
                verdict: o.verdict,
                findings: o.names(),
                same: own.is_same(o),
            })
            .collect();
        let answer = self.doubted(question, &doubts, held_out);
        (question.progress)("diagnosing the improved model again");
        let further = answer.lacking(question, runs, held_out)?;
        let same = variants.iter().filter(|v| v.same).count();
        Ok((answer, Some(Stability { same, of: variants.len(), further, variants })))
    }

    /// The answer once repetitions differ: what most of them do not find is withdrawn, the rest decided anew, and what one of them does
    /// not find is suspected at most.
    fn doubted(self, question: &Question, doubts: &Doubts, held_out: &[Run]) -> Self {
        self.regraded(question, &doubts.unstable, Grade::Unstable, held_out).doubting(doubts.doubtful.clone())
    }

    /// The answer in which these mechanisms are suspected at most.
    fn doubting(mut self, doubtful: Vec<String>) -> Self {
        for finding in self.findings.iter_mut().filter(|f| doubtful.contains(&f.mechanism)) {
            if finding.grade == Grade::Confirmed {
                finding.grade = Grade::Suspected;
            }
        }
        self.verdict = lead(self.verdict, &mut self.findings);
        Self { doubtful, ..self }
    }

    /// The answer once some of the mechanisms have a grade that does not name them; what was doubtful stays so.
    pub fn regraded(self, question: &Question, names: &[String], grade: Grade, held_out: &[Run]) -> Self {
        if names.is_empty() {
            return self;
        }
        let Self { kept: Kept { selection, left, .. }, mut withdrawn, doubtful, .. } = self;
        withdrawn.retain(|f| !selection.carries(&f.mechanism));
        let graded: Vec<(String, Grade)> = names.iter().map(|name| (name.clone(), grade)).collect();
        Self::settled(question, Residual { selection, left }, withdrawn, &graded, held_out).doubting(doubtful)
    }

    /// What the improved model still lacks when it is diagnosed on the same recordings, but for pushes.
    fn lacking(&self, question: &Question, runs: &[Run], held_out: &[Run]) -> Result<Vec<String>, DiagnoseError> {
        if self.findings.is_empty() {
            return Ok(Vec::new());
        }
        let found = self.kept.selection.tests.problem(question.settings).inside_bounds(self.improved());
        let improved = trimmed(&found.model, question.model, &found.free);
        let as_they_are = Change { name: "", model: Model::clone, run: |r, _| vec![r.clone()] };
        let again = brief(question.settings, &as_they_are, &improved, runs, held_out)?;
        Ok(again.names().into_iter().filter(|n| n != PUSH).collect())
    }
}

/// What was withdrawn and is not named. A named mechanism may have been withdrawn before, in other sessions: it counts as named.
fn unnamed(mut tried: Vec<Finding>, findings: &[Finding]) -> Vec<Finding> {
    tried.retain(|w| findings.iter().all(|f| f.mechanism != w.mechanism));
    tried
}

/// What the analysis answers once something is changed.
fn brief(
    settings: &Settings,
    change: &Change,
    model: &Model,
    runs: &[Run],
    held_out: &[Run],
) -> Result<Brief, DiagnoseError> {
    let changed = |all: &[Run]| all.iter().flat_map(|run| (change.run)(run, &model.ship)).collect::<Vec<Run>>();
    let [runs, held_out] = [runs, held_out].map(changed);
    let model = (change.model)(model);
    let question = Question::new(&model, settings, &|_| ())?;
    let answer = Answer::new(&question, runs, &held_out);
    Ok(Brief::new(answer.verdict, &answer.findings))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{erring, erring_as, finding, made_by_euler, model, runs, with};

    fn without_repetitions() -> Settings {
        Settings { nuisance: false, ..Settings::default() }
    }

    #[test]
    fn clocks_that_differ_by_session_are_named_with_one_delay_for_each() {
        let (model, settings) = (model(), without_repetitions());
        let mut all = runs(&model, 12);
        for run in &mut all {
            // Positions a row of 3 s late in session a, a row early in session b.
            let (inner, shift) = (1..run.measured.len() - 1, if run.session == "a" { -1 } else { 1 });
            let from = |row: usize, channel: usize| run.measured[row.wrapping_add_signed(shift)][channel];
            let measured = inner.clone().map(|row| {
                let [_, _, psi, u, v, r] = run.measured[row];
                [from(row, 0), from(row, 1), psi, u, v, r]
            });
            run.measured = measured.collect();
            run.inputs = run.inputs[inner].to_vec();
            run.initial = run.measured[0].map(Option::unwrap);
        }
        let question = Question::new(&model, &settings, &|_| ()).unwrap();
        let answer = Answer::new(&question, all, &[]);
        let found = answer.findings.iter().find(|f| f.mechanism == "time_skew").unwrap();
        let delay = |name: &str| found.parameters.iter().find(|a| a.name == name).unwrap();
        for (name, truth) in [("time_skew.position [a]", 3.0), ("time_skew.position [b]", -3.0)] {
            let [lower, upper] = delay(name).ci95;
            assert!(lower < truth && truth < upper && upper - lower < 1.0, "{name}: {lower} to {upper}");
        }
    }

    #[test]
    fn clocks_that_differ_between_sessions_by_less_than_half_a_sample_have_one_value() {
        let (model, settings) = (model(), without_repetitions());
        let [a, b] = [-3.0, -2.0].map(|delay| erring(&[("time_skew.position", delay)], 12));
        let all: Vec<Run> = a.into_iter().zip(b).map(|(a, b)| if a.session == "a" { a } else { b }).collect();
        let question = Question::new(&model, &settings, &|_| ()).unwrap();
        let answer = Answer::new(&question, all, &[]);
        let found = answer.findings.iter().find(|f| f.mechanism == "time_skew").unwrap();
        let delay = found.parameters.iter().find(|a| a.name == "time_skew.position").map(|a| a.value);
        assert!(!found.by_session && delay.is_some_and(|d| (d + 2.5).abs() < 0.3), "{:?}", found.parameters);
    }

    #[test]
    fn an_error_of_the_compass_is_found_where_the_velocities_were_made_with_its_heading() {
        let (mut model, settings) = (model(), without_repetitions());
        model.ship.velocity_by_heading = true;
        let all = erring_as(&model, &[("heading_bias.bias", 0.026)], 16);
        let turned = &erring(&[("heading_bias.bias", 0.026)], 16)[0].measured[30];
        assert!(all[0].measured[30][2] == turned[2] && all[0].measured[30][4] != turned[4]);
        let (train, unseen) = all.split_at(12);
        let question = Question::new(&model, &settings, &|_| ()).unwrap();
        let answer = Answer::new(&question, train, unseen);
        let found = answer.findings.iter().find(|f| f.mechanism == "heading_bias").unwrap();
        let [low, high] = found.parameters[0].ci95;
        assert!(found.grade == Grade::Confirmed && low < 0.026 && 0.026 < high && high - low < 0.01, "{found:?}");
    }

    #[test]
    fn an_error_of_a_sensor_is_proven_and_refuted_by_what_the_sensors_of_unseen_runs_say() {
        let (model, settings) = (model(), without_repetitions());
        let question = Question::new(&model, &settings, &|_| ()).unwrap();
        let biased = erring(&[("yaw_rate_bias.bias", 0.002)], 16);
        let (train, unseen) = biased.split_at(12);
        let answer = Answer::new(&question, train, unseen);
        let found = answer.findings.iter().find(|f| f.mechanism == "yaw_rate_bias").unwrap();
        let proof = found.held_out.as_ref().unwrap();
        assert!(found.grade == Grade::Confirmed && proof.is_shown() && proof.improvement.is_none(), "{found:?}");
        let sound = runs(&model, 16).split_off(12);
        let answer = Answer::new(&question, train, &sound);
        let tried = answer.withdrawn.iter().find(|f| f.mechanism == "yaw_rate_bias").unwrap();
        assert!(tried.grade == Grade::Refuted && answer.findings.is_empty(), "{tried:?}");
    }

    #[test]
    fn a_mechanism_that_is_named_was_not_withdrawn() {
        let of = |names: &[&str]| names.iter().map(|n| finding(n, n, &[n])).collect::<Vec<_>>();
        let left = unnamed(of(&["position_lever", "waves"]), &of(&["time_skew", "position_lever"]));
        assert_eq!(left.iter().map(|f| f.mechanism.as_str()).collect::<Vec<_>>(), ["waves"]);
    }

    #[test]
    fn beside_an_error_that_the_sensors_show_the_ship_is_that_of_the_base_where_it_predicts_worse() {
        let (model, settings) = (model(), without_repetitions());
        let question = Question::new(&model, &settings, &|_| ()).unwrap();
        let biased = erring(&[("yaw_rate_bias.bias", 0.002)], 16);
        let (train, unseen) = biased.split_at(12);
        let Answer { mut kept, .. } = Answer::new(&question, train, unseen);
        let weights = weigh(&question, &kept, unseen);
        let value = |e: &Estimate, name: &str| e.model.parameters[e.model.find(name).unwrap()].value;
        // A rudder that steers half as well.
        let found = &mut kept.selection.estimate;
        let (lift, bias) = (found.model.find("rudder.lift1").unwrap(), value(found, "yaw_rate_bias.bias"));
        found.model.parameters[lift].value *= 0.5;
        let held = with_ship_held(&question, kept, &weights, unseen);
        let (base, improved) = (&held.selection.tests.fit.estimate, &held.selection.estimate);
        assert_eq!(value(improved, "rudder.lift1"), value(base, "rudder.lift1"));
        assert_eq!(value(improved, "yaw_rate_bias.bias"), bias);
        assert_eq!(improved.free.len(), base.free.len() + 1);
    }

    #[test]
    fn clocks_and_lags_that_euler_steps_explain_as_well_stay_in_the_model_and_are_not_named() {
        let (model, settings) = (model(), without_repetitions());
        let question = Question::new(&model, &settings, &|_| ()).unwrap();
        let answer = Answer::new(&question, made_by_euler(&model, 12), &[]);
        assert_eq!((answer.verdict, answer.findings.len()), (Verdict::NothingMissing, 0), "{:?}", answer.findings);
        assert_eq!(answer.withdrawn[0].mechanism, "time_skew");
        // Such steps may answer the actuators late as well, and positions are late as those of a point astern are in a turn.
        assert!(answer.withdrawn.iter().all(|f| f.grade == Grade::EulerSteps), "{:?}", answer.withdrawn);
        assert!(answer.kept.selection.carries("time_skew") && answer.kept.left_by_named().is_none());
        // Where nothing is named, the improved model is the base model.
        assert!(answer.improved().free.len() < answer.kept.selection.estimate.free.len());
    }

    #[test]
    fn a_rudder_angle_that_is_recorded_late_is_named_and_no_clock_of_the_sensors() {
        let (model, settings) = (model(), without_repetitions());
        let question = Question::new(&model, &settings, &|_| ()).unwrap();
        let all = runs(&with(&[("rudder_late.time", 4.0)]), 12);
        let (train, unseen) = all.split_at(9);
        let answer = Answer::new(&question, train, unseen);
        let named: Vec<&str> = answer.findings.iter().map(|f| f.mechanism.as_str()).collect();
        assert_eq!(named, ["rudder_late"], "{:?}", answer.findings);
        let size = &answer.findings[0].parameters[0];
        assert!((size.value - 4.0).abs() < 0.4, "{size:?}");
    }

    #[test]
    fn what_most_repetitions_do_not_find_is_withdrawn_and_what_one_does_not_find_is_suspected() {
        let (model, settings) = (model(), without_repetitions());
        let question = Question::new(&model, &settings, &|_| ()).unwrap();
        let all = runs(&with(&[("current.north", 0.4), ("current.east", -0.2), ("rudder_lag.time", 6.0)]), 12);
        let (train, unseen) = all.split_at(9);
        let answer = Answer::new(&question, train, unseen);
        let grade = |answer: &Answer, name: &str| answer.findings.iter().find(|f| f.mechanism == name).map(|f| f.grade);
        assert_eq!(grade(&answer, "current"), Some(Grade::Confirmed), "{:?}", answer.findings);
        assert!(grade(&answer, "rudder_lag").is_some());
        let [current, lag] = ["current", "rudder_lag"].map(str::to_owned);
        // What is doubtful stays so when another is withdrawn later.
        let doubts = Doubts { unstable: Vec::new(), doubtful: vec![current.clone()] };
        let again = Answer::new(&question, train, unseen).doubted(&question, &doubts, unseen);
        let again = again.regraded(&question, std::slice::from_ref(&lag), Grade::Undetermined, unseen);
        assert_eq!((grade(&again, "current"), grade(&again, &lag)), (Some(Grade::Suspected), None));
        let doubts = Doubts { unstable: vec![lag.clone()], doubtful: vec![current, lag.clone()] };
        let doubted = answer.doubted(&question, &doubts, unseen);
        assert!(doubted.withdrawn.iter().any(|f| f.mechanism == lag && f.grade == Grade::Unstable));
        assert_eq!(grade(&doubted, &lag), None);
        assert_eq!(grade(&doubted, "current"), Some(Grade::Suspected));
    }
}
