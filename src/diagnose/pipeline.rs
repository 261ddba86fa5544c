//! The diagnosis from end to end: each step a function from one named type to the next.
//! Arithmetic is in the steps, and thresholds are in the settings.

use super::answer::analysis::Answer;
use super::answer::calibrate::ErrorRates;
use super::answer::cause::causes;
use super::answer::diagnosis::{Diagnosis, Trace};
use super::answer::models::{OnUnseen, Whose, on_unseen, written};
use super::answer::sailed::{Sailed, sailed};
use super::answer::summary::{absorbed, adequacy, budget, confusable, detectable, moves, ranking, resolved, traces};
use super::answer::words::{Missing, Said, Worse, differing, headline, next_trial};
use super::error::DiagnoseError;
use super::evidence::generic::corrected;
use super::evidence::push::Window;
use super::evidence::set_aside::Divided;
use super::law::Law;
use super::law::sides::sides;
use super::proof::describe::{confirmed_of_one_sign, kinds, sized};
use super::proof::grade::Grade;
use super::proof::improved::{trimmed, uncertainty};
use super::proof::prove::{HeldOut, prove, scores};
use super::proof::stability::Stability;
use super::search::base::{BaseFit, Question};
use super::search::decide::{Unlisted, Verdict};
use super::search::screen::screen;
use super::settings::Settings;
use crate::likelihood::estimate::Estimate;
use crate::model::Model;
use crate::ranges::Limited;
use crate::recording::Run;
use crate::uncertainty::Uncertainty;
use crate::validity::{self, Coverage};
use std::borrow::Cow;
use std::collections::BTreeSet;

/// Diagnoses a model against recordings.
///
/// `runs` are used to locate, name and model, and are not copied where they are given away; `held_out` only to prove. Without
/// `held_out` a part of the recordings is set aside for the proof, where there are at least eight. `progress` receives each step in
/// words. The result is the same bits on any number of threads.
///
/// # Errors
/// A setting outside its range, or a term of the catalogue that cannot be added to the model (a singular mass matrix, for
/// instance).
pub fn diagnose<'r>(
    model: &Model,
    runs: impl Into<Cow<'r, [Run]>>,
    held_out: &'r [Run],
    settings: &Settings,
    progress: &(dyn Fn(&str) + Sync),
) -> Result<Diagnosis, DiagnoseError> {
    settings.limits()?;
    let question = Question::new(model, settings, progress)?;
    let Divided { training, held_out, set_aside } = Divided::new(runs.into(), held_out);
    // What is repeated begins with the runs as they were given: what the analysis leaves out of them is a part of its answer.
    let given: Vec<Run> = if settings.repeat || settings.calibrate > 0 { training.to_vec() } else { Vec::new() };
    let answer: Answer = Answer::new(&question, training, &held_out);
    let (answer, stability): (Answer, Option<Stability>) = answer.repeated(&question, &given, &held_out)?;
    let answer: Answer = answer.with_law(&question, &held_out);
    let rates: Option<ErrorRates> = ErrorRates::new(&question, &answer, &given, &held_out, settings.calibrate)?;
    let (answer, written): (Answer, Written) = written_and_sized(&question, answer, &held_out);
    let proof: Option<HeldOut> = proof(&question, &answer, &written, &held_out);
    let answer: Answer = answer.capped(proof.as_ref());
    let sailed: Vec<Sailed> = pictured(&question, &answer, &written, &held_out);
    let models = proof.as_ref().map_or_else(Vec::new, |proof| models(&question, &answer, proof, &held_out));
    let said = report(&question, answer, &written, proof, models);
    Ok(Diagnosis { set_aside, stability, error_rates: rates, sailed, ..said })
}

/// The models that a diagnosis writes, which every command reads, and which the proof compares.
struct Written {
    base: Estimate,
    found: Estimate,
}

impl Written {
    /// Those of an answer, of which `base` is known.
    fn new(question: &Question, answer: &Answer, base: Estimate) -> Self {
        let problem = answer.kept.selection.tests.problem(question.settings);
        let found = if answer.improves() { problem.written(answer.improved()) } else { base.clone() };
        Self { base, found }
    }
}

/// The models that are written, and the answer with the sizes that these have. A finding whose intervals include zero there is not named.
fn written_and_sized(question: &Question, mut answer: Answer, held_out: &[Run]) -> (Answer, Written) {
    (question.progress)("fitting the models that are written");
    let tests = &answer.kept.selection.tests;
    // What is named in the end does not change the model without it.
    let known = tests.fit.within.clone();
    let base = known.unwrap_or_else(|| tests.problem(question.settings).written(&tests.fit.estimate));
    loop {
        let written = Written::new(question, &answer, base.clone());
        let lost = sized(&mut answer.findings, &answer.kept.selection, &written.found);
        if lost.is_empty() {
            confirmed_of_one_sign(&mut answer.findings, &answer.kept.selection);
            return (answer, written);
        }
        answer = answer.regraded(question, &lost, Grade::Undetermined, held_out).with_law(question, held_out);
    }
}

/// The runs that a report shows with their simulations: those of the proof, or else those of the training.
fn pictured(question: &Question, answer: &Answer, written: &Written, held_out: &[Run]) -> Vec<Sailed> {
    let fit = &answer.kept.selection.tests.fit;
    let runs = if held_out.is_empty() { &fit.runs[..] } else { held_out };
    let found = answer.improves().then_some(&written.found.model);
    sailed(runs, &written.base.model, found, question.settings.judging.integration)
}

/// The base model against the model with the findings, and against a generic correction, on runs that no step before has used.
fn proof(question: &Question, answer: &Answer, written: &Written, held_out: &[Run]) -> Option<HeldOut> {
    if held_out.is_empty() {
        return None;
    }
    (question.progress)("proving on held-out runs");
    let tests = &answer.kept.selection.tests;
    let screen = &tests.screen;
    let generic = corrected(&screen.law, &screen.evidence, &screen.base, &tests.fit.estimate.model);
    let Written { base, found } = written;
    let [before, after] = [&base.model, &found.model].map(|m| (m, &found.noise));
    Some(prove(before, after, Some(&generic), tests.fit.integration, held_out, &question.settings.judging))
}

/// The study's own model, the base model and the one with what was found, on the runs of the proof, which has simulated the last two.
fn models(question: &Question, answer: &Answer, proof: &HeldOut, held_out: &[Run]) -> Vec<OnUnseen> {
    let own = scores(question.model, held_out, &question.settings.judging);
    let mut models = vec![(Whose::Own, &own[..]), (Whose::Base, &proof.runs_before[..])];
    if answer.improves() {
        models.push((Whose::Improved, &proof.runs_after[..]));
    }
    on_unseen(&models)
}

/// How much of the runs lies outside the ranges of a model's terms.
fn coverage(model: &Model, runs: &[Run]) -> Coverage {
    validity::outside(model, runs.iter().flat_map(validity::samples))
}

/// A law with the values of states and inputs that the training runs visit.
fn visited(law: Law, traces: &[Trace]) -> Law {
    law.over(traces.iter().flat_map(|t| t.state.iter().zip(&t.inputs)))
}

/// Whose model is in improved.toml, that model, and the covariance of its parameters where they were estimated.
fn file(
    question: &Question,
    fit: &BaseFit,
    fits: &Written,
    adds: bool,
    models: &[OnUnseen],
) -> (Whose, Model, Option<Uncertainty>) {
    let kept = if adds { &fits.found } else { &fits.base };
    let whose = written(if adds { Whose::Improved } else { Whose::Base }, models);
    if whose == Whose::Own {
        return (whose, question.model.clone(), None);
    }
    let improved = trimmed(&kept.model, question.model, &kept.free);
    let uncertainty = uncertainty(kept, &improved, fit.integration, &fit.runs);
    (whose, improved, uncertainty)
}

/// The recordings that differ from all others, where nothing is named, and the number of all.
fn apart<'a>(verdict: Verdict, windows: &'a [Window], runs: &[Run]) -> (Vec<&'a str>, usize) {
    let recordings = runs.iter().map(|run| &run.recording).collect::<BTreeSet<_>>().len();
    let quiet = matches!(verdict, Verdict::NothingMissing | Verdict::Random);
    (if quiet { differing(windows, recordings) } else { Vec::new() }, recordings)
}

/// What is missing and not in the catalogue.
fn missing(answer: &Answer) -> Option<Missing<'_>> {
    match (answer.unlisted(), &answer.kept.place, &answer.law) {
        (Some(Unlisted::Place), Some(place), _) => Some(Missing::Place(place)),
        (Some(Unlisted::Law), _, law) => Some(Missing::Law(law.as_ref())),
        (_, _, Some(law)) => Some(Missing::Law(Some(law))),
        _ => None,
    }
}

/// Everything that the diagnosis says of one analysis.
fn report(
    question: &Question,
    answer: Answer,
    fits: &Written,
    proof: Option<HeldOut>,
    models: Vec<OnUnseen>,
) -> Diagnosis {
    let (tests, found) = (&answer.kept.selection.tests, answer.improved());
    let (fit, first) = (&tests.fit, &tests.screen);
    let base = &fit.estimate;
    let last = answer.kept.left_by_named().filter(|_| answer.base.holds).map(|l| &l.screen);
    let beside_law = answer.confirmed_law().map(|law| screen(&law.estimate, fit.integration, &fit.runs, &[]));
    let left = last.or(beside_law.as_ref());
    let missing = missing(&answer);
    // What predicts unseen runs worse than the base model is no improvement, however significant its parts are.
    let worse = proof.as_ref().is_some_and(HeldOut::is_worse);
    let adds = answer.improves() && !worse;
    let (file, improved, uncertainty) = file(question, fit, fits, adds, &models);
    let traces = traces(&fit.runs, fit.integration, base, last.map(|_| found));
    let verdict = answer.verdict;
    let hull_budget = budget(found);
    let planned = || next_trial(verdict, &answer.findings, &tests.candidates);
    let (differing, recordings) = apart(verdict, &tests.location.windows, &fit.runs);
    let causes = causes(tests, &differing, question.settings);
    let said = Said {
        causes: &causes,
        hull: &hull_budget,
        windows: &tests.location.windows,
        differing: &differing,
        recordings,
        findings: &answer.findings,
        withdrawn: &answer.withdrawn,
        following: &answer.base.following,
        holds: answer.base.holds,
        form_holds: tests.search.chance.form_holds,
        missing: missing.as_ref(),
        worse: proof.as_ref().filter(|p| p.is_worse()).map(Worse::from),
    };
    Diagnosis {
        schema: "trimtab-diagnosis/2",
        verdict,
        headline: headline(verdict, &said),
        next_trial: missing.as_ref().map(Missing::next_trial).or_else(planned),
        law: answer.law.clone().map(|law| visited(law, &traces)),
        admission: fit.admission.clone(),
        noise_before: base.noise,
        noise_after: found.noise,
        location: tests.location.clone(),
        location_after: answer.kept.left_by_named().map(|l| l.location.clone()),
        ranking: ranking(first, &tests.candidates),
        absorbed: absorbed(first, &tests.candidates),
        detectable: resolved(detectable(first, &tests.candidates, question.settings, &question.full), &fit.runs),
        confusable: confusable(first, &tests.candidates),
        adequacy_before: adequacy(first),
        adequacy_after: adequacy(left.unwrap_or(first)),
        moves: moves(&fits.base, &fits.found, fit.integration, &fit.runs, question.model),
        sides: sides(left.unwrap_or(first), left.map_or(base, |_| found), base.free.len(), &kinds(&fit.runs)),
        hull_budget,
        held_out: proof,
        set_aside: 0,
        stability: None,
        error_rates: None,
        following: answer.base.following.clone(),
        improved_is_base: !adds,
        models,
        written: file,
        settings: question.settings.clone(),
        sailed: Vec::new(),
        traces,
        validity: coverage(&improved, &fit.runs),
        uncertainty,
        model: improved,
        base: trimmed(&fits.base.model, question.model, &fits.base.free),
        findings: answer.findings,
        withdrawn: answer.withdrawn,
        differing: differing.into_iter().map(str::to_owned).collect(),
        causes,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{model, runs, with};
    use std::sync::Mutex;

    #[test]
    fn the_steps_run_in_order_and_a_current_is_named_with_its_proof() -> Result<(), DiagnoseError> {
        let truth = runs(&with(&[("current.north", 0.3)]), 15);
        let settings = Settings { nuisance: false, repeat: true, ..Settings::default() };
        let steps = Mutex::new(Vec::new());
        let note = |step: &str| steps.lock().unwrap().push(step.to_owned());
        let d = diagnose(&model(), &truth[..12], &truth[12..], &settings, &note)?;
        assert_eq!((d.verdict, d.findings[0].mechanism.as_str()), (Verdict::Named, "current"), "{}", d.headline);
        assert_eq!(d.held_out.as_ref().map(|h| h.runs), Some(3));
        for size in &d.findings[0].parameters {
            assert_eq!(d.model.index(&size.name).map(|i| d.model.parameters[i].value), Some(size.value), "{size:?}");
        }
        assert!(d.findings[0].held_out.is_some() && d.location_after.is_some() && d.law.is_none());
        let steps = steps.into_inner().unwrap();
        assert_eq!(d.findings[0].grade, Grade::Confirmed, "{:?} {:?}", d.findings[0].held_out, d.stability);
        assert!(d.stability.as_ref().is_some_and(|s| s.same == s.of && s.further.is_empty()), "{:?}", d.stability);
        let order = [
            "estimating",
            "auditing",
            "locating",
            "testing",
            "refitting",
            "checking",
            "weighing",
            "repeating",
            "proving",
        ];
        let place = |word: &str| steps.iter().position(|s| s.starts_with(word));
        assert!(order.windows(2).all(|w| place(w[0]) < place(w[1]) && place(w[0]).is_some()), "{steps:?}");
        Ok(())
    }

    #[test]
    fn without_held_out_runs_a_part_of_the_recordings_proves_and_with_few_nothing_does() -> Result<(), DiagnoseError> {
        let settings = Settings { nuisance: false, ..Settings::default() };
        let d = diagnose(&model(), runs(&model(), 6), &[], &settings, &|_| ())?;
        assert!(d.held_out.is_none() && d.findings.is_empty() && d.set_aside == 0);
        let truth = with(&[("current.north", 0.3)]);
        let d = diagnose(&model(), runs(&truth, 16), &[], &settings, &|_| ())?;
        assert_eq!((d.set_aside, d.held_out.as_ref().map(|h| h.runs)), (4, Some(4)));
        assert_eq!((d.findings[0].mechanism.as_str(), d.findings[0].grade), ("current", Grade::Confirmed));
        let d = diagnose(&model(), runs(&truth, 7), &[], &settings, &|_| ())?;
        assert_eq!((d.findings[0].mechanism.as_str(), d.findings[0].grade), ("current", Grade::Suspected));
        Ok(())
    }

    #[test]
    fn a_name_that_unseen_runs_refute_is_withdrawn_and_not_written() -> Result<(), DiagnoseError> {
        let settings = Settings { nuisance: false, ..Settings::default() };
        // The current of the training runs turns before the others are sailed.
        let (train, test) = (runs(&with(&[("current.north", 0.3)]), 12), runs(&with(&[("current.north", -0.3)]), 6));
        let d = diagnose(&model(), train, &test, &settings, &|_| ())?;
        assert_eq!((d.verdict, d.findings.len()), (Verdict::NotInCatalogue, 0), "{}", d.headline);
        let tried = &d.withdrawn[0];
        assert_eq!((tried.mechanism.as_str(), tried.grade), ("current", Grade::Refuted));
        assert!(d.headline.contains("refute") && d.improved_is_base);
        assert!(
            !d.model.term_names().contains(&"current")
                || d.model.parameters[d.model.find("current.north").unwrap()].value == 0.0
        );
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
