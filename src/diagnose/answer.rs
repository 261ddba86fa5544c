//! The answer of one analysis: what is named, what was withdrawn, the verdict; and the same analysis repeated to see whether it is
//! stable. It runs the steps in order and holds no arithmetic and no threshold.

use super::base::{AuditedRuns, BaseFit, Question};
use super::conclude::conclude;
use super::decide::{Decision, Unlisted, Verdict, decide};
use super::error::DiagnoseError;
use super::estimate::Estimate;
use super::event::{BaseTests, Opening};
use super::finding::{Finding, PUSH};
use super::grade::{Grade, is_unstable};
use super::improved::trimmed;
use super::residual::{Kept, Residual};
use super::select::Selection;
use super::settings::Settings;
use super::stability::{Brief, CHANGES, Change, Stability, Variant};
use super::weigh::{Base, Weight, findings, weakest, weigh, withdrawn};
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
    decision: Decision,
    weights: Vec<Weight>,
}

impl Answer {
    /// All steps up to the verdict. A mechanism that its grade does not name is taken out again, one after the other, and what is left
    /// is tested and decided anew.
    pub fn new<'r>(question: &Question, runs: impl Into<Cow<'r, [Run]>>, held_out: &[Run]) -> Self {
        let audited = AuditedRuns::new(runs, question.full.ship.hull.lpp);
        let base: BaseFit = BaseFit::new(question, audited);
        let tests: BaseTests = BaseTests::new(question, base);
        let opening: Opening = Opening::new(question, tests);
        let selection: Selection = Selection::new(question, opening).refitted(question);
        Self::settled(question, Residual::new(question, selection), Vec::new(), held_out)
    }

    /// Takes out what is not named, one mechanism after the other, and decides on what is left; `tried` holds what was withdrawn before.
    fn settled(question: &Question, mut residual: Residual, mut tried: Vec<Finding>, held_out: &[Run]) -> Self {
        let (kept, decision, weights) = loop {
            let decision: Decision = decide(&residual.table(question));
            let kept: Kept = residual.decided(&decision);
            let mut weights = weigh(question, &kept, held_out);
            match (weakest(&weights), &kept.left) {
                (Some(i), Some(left)) => {
                    let weight = weights.swap_remove(i);
                    tried.push(withdrawn(&kept, left, i, &weight));
                    residual = kept.without(question, i, weight.without);
                }
                _ => break (kept, decision, weights),
            }
        };
        let base = Base::new(question, &kept);
        let grades: Vec<Grade> = tried.iter().map(|f| f.grade).collect();
        let rejected = !kept.selection.rejected.is_empty();
        let verdict = conclude(decision.verdict, &grades, rejected, base.holds);
        let mut findings = findings(&kept, &weights);
        if !base.holds {
            tried.append(&mut findings);
        }
        Self { verdict, findings, withdrawn: tried, kept, base, decision, weights }
    }

    /// The answer without the mechanisms of these names, which the repetitions do not find.
    fn without_unstable(self, question: &Question, names: &[String], held_out: &[Run]) -> Self {
        let Self { mut kept, mut weights, withdrawn: mut tried, .. } = self;
        let name = |kept: &Kept, i: usize| {
            let selection = &kept.selection;
            selection.tests.candidates[selection.mechanisms[i].candidate].mechanism.name.to_owned()
        };
        loop {
            let next = (0..kept.selection.mechanisms.len()).find(|i| names.contains(&name(&kept, *i)));
            let (Some(i), Some(left)) = (next, &kept.left) else { break };
            let weight = Weight { grade: Grade::Unstable, ..weights.remove(i) };
            tried.push(withdrawn(&kept, left, i, &weight));
            let residual = kept.without(question, i, weight.without);
            let decision = decide(&residual.table(question));
            kept = residual.decided(&decision);
            weights = weigh(question, &kept, held_out);
        }
        let Kept { selection, left, .. } = kept;
        Self::settled(question, Residual { selection, left }, tried, held_out)
    }

    /// The estimate with what is named; that of the base model where nothing is.
    pub fn improved(&self) -> &Estimate {
        if self.base.holds { &self.kept.selection.estimate } else { &self.kept.selection.tests.fit.estimate }
    }

    /// What the catalogue does not hold.
    pub fn unlisted(&self) -> Option<Unlisted> {
        self.decision.unlisted.filter(|_| self.base.holds)
    }

    /// Repeats the analysis with the recordings as they were given, told otherwise, and, once, with the improved model. A finding that one of the
    /// repetitions does not find is suspected at most; one that most of them do not find is withdrawn. Nothing is repeated where
    /// nothing was found or the user does not want it.
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
        let found: Vec<usize> =
            (0..own.findings.len()).map(|f| others.iter().filter(|o| own.is_found_in(f, o)).count()).collect();
        let unstable: Vec<String> = own
            .names()
            .into_iter()
            .zip(&found)
            .filter(|(_, n)| is_unstable(**n, others.len()))
            .map(|(n, _)| n)
            .collect();
        let mut answer = self;
        for (finding, n) in answer.findings.iter_mut().zip(&found) {
            if *n < others.len() && finding.grade == Grade::Confirmed {
                finding.grade = Grade::Suspected;
            }
        }
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
        if !unstable.is_empty() {
            answer = answer.without_unstable(question, &unstable, held_out);
        }
        (question.progress)("diagnosing the improved model again");
        let further = answer.lacking(question, runs, held_out)?;
        let same = variants.iter().filter(|v| v.same).count();
        Ok((answer, Some(Stability { same, of: variants.len(), further, variants })))
    }

    /// What the improved model still lacks when it is diagnosed on the same recordings, but for pushes.
    fn lacking(&self, question: &Question, runs: &[Run], held_out: &[Run]) -> Result<Vec<String>, DiagnoseError> {
        if self.findings.is_empty() {
            return Ok(Vec::new());
        }
        let found = self.improved();
        let improved = trimmed(&found.model, question.model, &found.free);
        let as_they_are = Change { name: "", model: Model::clone, run: |r| vec![r.clone()] };
        let again = brief(question.settings, &as_they_are, &improved, runs, held_out)?;
        Ok(again.names().into_iter().filter(|n| n != PUSH).collect())
    }
}

/// What the analysis answers once something is changed.
fn brief(
    settings: &Settings,
    change: &Change,
    model: &Model,
    runs: &[Run],
    held_out: &[Run],
) -> Result<Brief, DiagnoseError> {
    let model = (change.model)(model);
    let question = Question::new(&model, settings, &|_| ())?;
    let [runs, held_out] = [runs, held_out].map(|all| all.iter().flat_map(change.run).collect::<Vec<Run>>());
    let answer = Answer::new(&question, runs, &held_out);
    Ok(Brief::new(answer.verdict, &answer.findings))
}
