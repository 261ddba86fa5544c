//! The dossier put together: each section from the function that computes it, and a list of what is missing in each.
//! It computes nothing itself beyond counting what is there.

use super::causes::Causes;
use super::claim::Claim;
use super::document::{Dossier, Heading, PROCEDURE, SECTIONS};
use super::particulars::ShipPart;
use super::structure::Structure;
use super::trials::Trials;
use super::validation::Validation;
use super::verification::Verification;
use crate::evaluate::maneuver::ManeuverSettings;
use crate::evaluate::{Judging, prove};
use crate::fit::FitSettings;
use crate::model::Model;
use crate::recording::Run;
use crate::recording::audit::{Severity, StudyAudit};
use crate::uncertainty::Uncertainty;
use serde_json::Value;

/// What a dossier is made of.
pub struct Question<'a> {
    /// Name of the study.
    pub study: &'a str,
    /// The model that the dossier is about.
    pub model: &'a Model,
    /// What it is compared with.
    pub baseline: &'a Model,
    /// Covariance of its parameters.
    pub uncertainty: Option<&'a Uncertainty>,
    /// The runs of the study, cut into windows.
    pub runs: &'a [Run],
    /// The audit of its recordings.
    pub audit: &'a StudyAudit,
    /// Settings of its fit.
    pub fit: &'a FitSettings,
    /// How models are judged.
    pub judging: &'a Judging,
    /// Settings of the standard manoeuvres.
    pub maneuver: &'a ManeuverSettings,
    /// The document of a diagnosis and where it is from.
    pub diagnosis: Option<(&'a Value, String)>,
    /// The intended use, as the user states it.
    pub intended_use: Option<String>,
    /// Files, version and build.
    pub inputs: Value,
}

/// Makes the dossier; `progress` receives each step. The result is the same bits on any number of threads.
pub fn dossier(question: &Question, progress: &dyn Fn(&str)) -> Dossier {
    let Question { model, runs, .. } = question;
    let diagnosis = question.diagnosis.as_ref().map(|(document, _)| *document);
    let part = |key: &str| diagnosis.map(|d| d[key].clone()).filter(|v| !v.is_null());
    progress("evaluating");
    let evaluation = prove(question.baseline, model, runs, question.judging);
    progress("sailing the standard manoeuvres");
    let trials = Trials::new(model, question.uncertainty, question.maneuver);
    let refused = trials.as_ref().err().map(|e| format!("standard manoeuvres: {e}"));
    progress("verifying");
    let verification = Verification::new(model, runs, question.fit, question.judging);
    let noise = part("noise_after").map(|n| n["sensors"].clone());
    let causes = question.diagnosis.as_ref().map(|(d, source)| Causes::new(model, d, source.clone()));
    let mut dossier = Dossier {
        schema: "trimtab-dossier/1",
        procedure: PROCEDURE,
        study: question.study.to_owned(),
        sections: Vec::new(),
        claim: Claim::new(&model.name, &model.ship.name, model.ship.hull.lpp, runs, question.intended_use.clone()),
        ship: ShipPart::new(&model.ship, question.audit, runs, noise),
        inputs: question.inputs.clone(),
        model: Structure::new(model, question.uncertainty, runs),
        verification,
        validation: Validation::new(evaluation, trials.ok()),
        error_rates: part("error_rates"),
        causes,
        limits: Vec::new(),
    };
    dossier.sections = headings(&dossier, refused);
    dossier.limits = limits(&dossier);
    dossier
}

/// The sections with what is missing in each.
fn headings(d: &Dossier, refused: Option<String>) -> Vec<Heading> {
    let missing = |key: &str| match key {
        "claim" => claim_missing(d),
        "ship" => ship_missing(d),
        "model" => model_missing(d),
        "verification" => d.verification.missing.clone(),
        "validation" => validation_missing(d, refused.clone()),
        "error_rates" => rates_missing(d),
        "causes" => causes_missing(d),
        _ => Vec::new(),
    };
    SECTIONS.iter().map(|(key, title)| Heading { key, title, missing: missing(key) }).collect()
}

/// A sentence where something is absent.
fn when(absent: bool, text: &str) -> Vec<String> {
    if absent { vec![text.to_owned()] } else { Vec::new() }
}

fn claim_missing(d: &Dossier) -> Vec<String> {
    when(d.claim.intended_use.is_none(), "the intended use is not stated; state it with --use")
}

fn ship_missing(d: &Dossier) -> Vec<String> {
    let source = when(d.ship.source.is_empty(), "the ship file names no source of its particulars");
    let noise = "the noise of the sensors was not estimated, as there is no diagnosis";
    [source, when(d.ship.noise.is_none(), noise)].concat()
}

fn model_missing(d: &Dossier) -> Vec<String> {
    let text = "the model file has no covariance: its parameters have no standard errors";
    when(d.model.covariance.is_none(), text)
}

fn rates_missing(d: &Dossier) -> Vec<String> {
    let text = "not measured; `--calibrate N` measures them on 2 N simulated studies with the inputs and the noise of \
                this one";
    when(d.error_rates.is_none(), text)
}

fn causes_missing(d: &Dossier) -> Vec<String> {
    let Some(causes) = &d.causes else {
        return when(true, "no diagnosis was made or given: no cause of error was looked for");
    };
    let text = "the diagnosis was not repeated on changed recordings (`--repeat`): the stability of what it names is not known";
    when(causes.stability.is_null() && !causes.found.is_empty(), text)
}

fn validation_missing(d: &Dossier, refused: Option<String>) -> Vec<String> {
    let mut all = Vec::new();
    match &d.validation.test {
        None => all.push(
            "the study has no test runs, so that no error on unseen runs was measured; mark some with `split = \"test\"`".to_owned(),
        ),
        Some(t) if t.runs < 3 => {
            all.push(format!("with {} test runs the errors have no intervals; at least three are needed", t.runs));
        }
        Some(_) => {}
    }
    all.extend(refused);
    if d.validation.manoeuvres.as_ref().is_some_and(|t| t.draws == 0) {
        all.push("the standard manoeuvres have no intervals, as the model file has no covariance".into());
    }
    all.push("no recorded standard manoeuvre is compared with the simulated one".into());
    all
}

/// The known limits, a sentence each.
fn limits(d: &Dossier) -> Vec<String> {
    let mut all = Vec::new();
    let conditions = "The errors are those of simulations that start from the recorded state and are given the recorded rudder and \
                      propeller; a longer prediction, other conditions or another loading were not compared.";
    if d.validation.test.is_some() {
        all.push(conditions.to_owned());
    }
    all.push(format!("{}.", d.model.validity.line()));
    let failed: Vec<&str> = d.verification.checks.iter().filter(|c| !c.passed).map(|c| c.key).collect();
    if !failed.is_empty() {
        all.push(format!("Checks of the verification that failed: {}.", failed.join(", ")));
    }
    if let Some(t) = d.validation.test.as_ref().filter(|t| t.diverged_fitted > 0) {
        all.push(format!(
            "The model diverged on {} of {} test trajectories, which the means leave out.",
            t.diverged_fitted, t.trajectories
        ));
    }
    if let Some(t) = &d.validation.manoeuvres {
        all.push(
            "The standard manoeuvres are sailed in calm, deep, open water; their intervals include the uncertainty of the parameters alone, \
             not that of the form of the model."
                .into(),
        );
        if !t.left_out.is_empty() {
            all.push(format!("Terms left out of the standard manoeuvres: {}.", t.left_out.join(", ")));
        }
    }
    if !d.model.undetermined.is_empty() {
        all.push(format!("Free parameters that the recordings do not determine: {}.", d.model.undetermined.join(", ")));
    }
    let count = |s: Severity| d.ship.doubts.iter().filter(|t| t.severity == s).count();
    let (errors, warnings) = (count(Severity::Error), count(Severity::Warning));
    if errors + warnings > 0 {
        all.push(format!("The audit of the recordings has {errors} kinds of error and {warnings} kinds of warning, listed under ship."));
    }
    if let Some(c) = d.causes.as_ref().filter(|c| !c.found.is_empty()) {
        let titles: Vec<&str> = c.found.iter().filter_map(|f| f["title"].as_str()).collect();
        all.push(format!(
            "The diagnosis names causes of error that the model does not contain: {}.",
            titles.join(", ")
        ));
    }
    if let Some(c) = &d.causes {
        all.push(format!(
            "{} causes of error in the catalogue are not excluded by these recordings; causes outside the catalogue are looked for only by \
             tests of general forms of force.",
            c.not_excluded.len()
        ));
    }
    all.push("Uncertainty of the measured channels themselves is not part of the errors and intervals.".into());
    all.push("This dossier was made by a program; it is no approval and no judgement on the intended use.".into());
    all
}
