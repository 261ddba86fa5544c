//! The diagnosis from end to end: each step a function from one named type to the next.
//! It holds no arithmetic and no threshold; these are in the steps and in the settings.

use super::base::{AuditedRuns, BaseFit, Question};
use super::decide::{Decision, Unlisted, decide};
use super::describe::{findings, kinds};
use super::diagnosis::Diagnosis;
use super::error::DiagnoseError;
use super::event::{BaseTests, Opening};
use super::generic::{corrected, surrogate};
use super::improved::trimmed;
use super::prove::{HeldOut, prove};
use super::residual::{Kept, Residual};
use super::select::Selection;
use super::settings::Settings;
use super::sides::sides;
use super::summary::{absorbed, adequacy, budget, confusable, detectable, moves, ranking, traces};
use super::words::{Missing, headline, next_trial};
use crate::model::Model;
use crate::ranges::Limited;
use crate::recording::Run;
use crate::validity::{self, Coverage};
use std::borrow::Cow;

/// Diagnoses a model against recordings.
///
/// `runs` are used to locate, name and model, and are not copied where they are given away; `held_out` only to prove. `progress` is told each step in words. The result is
/// the same bits on any number of threads.
///
/// # Errors
/// A setting outside its range, or a term of the catalogue that cannot be added to the model (a singular mass matrix, for
/// instance).
pub fn diagnose<'r>(
    model: &Model,
    runs: impl Into<Cow<'r, [Run]>>,
    held_out: &[Run],
    settings: &Settings,
    progress: &(dyn Fn(&str) + Sync),
) -> Result<Diagnosis, DiagnoseError> {
    settings.limits()?;
    let question = Question::new(model, settings, progress)?;
    let audited = AuditedRuns::new(runs, question.full.ship.hull.lpp);
    let base: BaseFit = BaseFit::new(&question, audited);
    let tests: BaseTests = BaseTests::new(&question, base);
    let opening: Opening = Opening::new(&question, tests);
    let selection: Selection = Selection::new(&question, opening).refitted(&question);
    let residual: Residual = Residual::new(&question, selection);
    let decision: Decision = decide(&residual.table(&question));
    let kept: Kept = residual.decided(&decision);
    let proof: Option<HeldOut> = proof(&question, &kept, held_out);
    Ok(report(&question, &kept, &decision, proof))
}

/// The base model against the model with the findings, and against a generic correction, on runs that no step before has used.
fn proof(question: &Question, kept: &Kept, held_out: &[Run]) -> Option<HeldOut> {
    if held_out.is_empty() {
        return None;
    }
    (question.progress)("proving on held-out runs");
    let (tests, found) = (&kept.selection.tests, &kept.selection.estimate);
    let (base, screen) = (&tests.fit.estimate, &tests.screen);
    let generic = corrected(&screen.law, &screen.evidence, &screen.base, &base.model);
    let (before, after) = ((&base.model, &base.noise), (&found.model, &base.noise));
    Some(prove(before, after, Some(&generic), tests.fit.integration, held_out, &question.settings.judging))
}

/// How much of the runs lies outside the ranges of a model's terms.
fn coverage(model: &Model, runs: &[Run]) -> Coverage {
    validity::outside(model, runs.iter().flat_map(validity::samples))
}

/// Everything that the diagnosis says.
fn report(question: &Question, kept: &Kept, decision: &Decision, proof: Option<HeldOut>) -> Diagnosis {
    let (tests, found) = (&kept.selection.tests, &kept.selection.estimate);
    let (fit, first) = (&tests.fit, &tests.screen);
    let base = &fit.estimate;
    let last = kept.left.as_ref().map(|l| &l.screen);
    let missing = match (decision.unlisted, &kept.place) {
        (Some(Unlisted::Place), Some(place)) => Some(Missing::Place(place)),
        (Some(Unlisted::Law), _) => {
            Some(Missing::Law(surrogate(&first.law, &first.evidence, &first.base, &base.model)))
        }
        _ => None,
    };
    let findings = findings(kept, proof.as_ref());
    let verdict = decision.verdict;
    let improved = trimmed(&found.model, question.model, &found.free);
    Diagnosis {
        schema: "trimtab-diagnosis/1",
        verdict,
        headline: headline(verdict, &findings, missing.as_ref()),
        next_trial: missing
            .as_ref()
            .map(Missing::next_trial)
            .or_else(|| next_trial(verdict, &findings, &tests.candidates)),
        surrogate: missing.map(Missing::into_surrogate).unwrap_or_default(),
        admission: fit.admission.clone(),
        noise_before: base.noise,
        noise_after: found.noise,
        location: tests.location.clone(),
        location_after: kept.left.as_ref().map(|l| l.location.clone()),
        ranking: ranking(first, &tests.candidates),
        absorbed: absorbed(first, &tests.candidates),
        detectable: detectable(first, &tests.candidates, question.settings, &question.full),
        confusable: confusable(first, &tests.candidates),
        adequacy_before: adequacy(first),
        adequacy_after: adequacy(last.unwrap_or(first)),
        moves: moves(base, found, fit.integration, &fit.runs, question.model),
        sides: sides(last.unwrap_or(first), found, base.free.len(), &kinds(&fit.runs)),
        hull_budget: budget(found),
        held_out: proof,
        findings,
        settings: question.settings.clone(),
        traces: traces(&fit.runs, fit.integration, base, last.map(|_| found)),
        validity: coverage(&improved, &fit.runs),
        model: improved,
        base: trimmed(&base.model, question.model, &base.free),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::decide::Verdict;
    use crate::diagnose::example::{model, runs, with};
    use std::sync::Mutex;

    #[test]
    fn the_steps_run_in_order_and_a_current_is_named_with_its_proof() -> Result<(), DiagnoseError> {
        let truth = runs(&with(&[("current.north", 0.3)]), 15);
        let settings = Settings { nuisance: false, ..Settings::default() };
        let steps = Mutex::new(Vec::new());
        let note = |step: &str| steps.lock().unwrap().push(step.to_owned());
        let d = diagnose(&model(), &truth[..12], &truth[12..], &settings, &note)?;
        assert_eq!((d.verdict, d.findings[0].mechanism.as_str()), (Verdict::Named, "current"), "{}", d.headline);
        assert_eq!(d.held_out.as_ref().map(|h| h.runs), Some(3));
        assert!(d.findings[0].held_out.is_some() && d.location_after.is_some() && d.surrogate.is_empty());
        let steps = steps.into_inner().unwrap();
        let order = ["estimating", "auditing", "locating", "testing", "refitting", "checking", "proving"];
        let place = |word: &str| steps.iter().position(|s| s.starts_with(word));
        assert!(order.windows(2).all(|w| place(w[0]) < place(w[1]) && place(w[0]).is_some()), "{steps:?}");
        Ok(())
    }

    #[test]
    fn without_held_out_runs_there_is_no_proof() -> Result<(), DiagnoseError> {
        let settings = Settings { nuisance: false, ..Settings::default() };
        let d = diagnose(&model(), runs(&model(), 6), &[], &settings, &|_| ())?;
        assert!(d.held_out.is_none() && d.findings.is_empty());
        Ok(())
    }

    #[test]
    fn a_setting_outside_its_range_is_refused_before_anything_is_computed() {
        for settings in [
            Settings { alpha: f64::NAN, ..Settings::default() },
            Settings { most: 0, ..Settings::default() },
            Settings { substeps: 1_000_000_000, ..Settings::default() },
        ] {
            let refused = diagnose(&model(), runs(&model(), 6), &[], &settings, &|_| ());
            assert!(matches!(refused, Err(DiagnoseError::Setting(_))), "{settings:?}");
        }
    }
}
