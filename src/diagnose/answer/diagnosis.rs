//! The document of a diagnosis: verdict, findings, and every test that led to them.
//! It computes nothing; the steps that fill it are in other files.

use super::calibrate::ErrorRates;
use super::cause::Cause;
use super::models::{OnUnseen, Whose};
use super::sailed::Sailed;
use crate::diagnose::evidence::admit::Admission;
use crate::diagnose::evidence::locate::Location;
use crate::diagnose::law::Law;
use crate::diagnose::law::sides::Sides;
use crate::diagnose::proof::finding::Finding;
use crate::diagnose::proof::influence::Following;
use crate::diagnose::proof::prove::HeldOut;
use crate::diagnose::proof::stability::Stability;
use crate::diagnose::search::decide::Verdict;
use crate::diagnose::settings::Settings;
use crate::likelihood::noise::Noise;
use crate::model::Model;
use crate::uncertainty::Uncertainty;
use crate::validity::Coverage;
use serde::Serialize;

/// One row of the ranking.
#[derive(Clone, Debug, Serialize)]
pub struct Ranked {
    /// Mechanism.
    pub mechanism: String,
    /// Plain words.
    pub title: String,
    /// Twice the gain in log-likelihood that the score test predicts.
    pub statistic: f64,
    /// Degrees of freedom.
    pub degrees: usize,
    /// Corrected p-value.
    pub p: f64,
    /// Amplitudes \[units of the parameters\]; one session after the other where each has its own.
    pub amplitude: Vec<f64>,
    /// Whether the sign is possible.
    pub admissible: bool,
    /// Share of information left after base parameters and nuisances.
    pub retained: f64,
    /// p-value with a free mirror-symmetric discrepancy as rival.
    pub second_opinion: f64,
    /// Sessions in which it acts; empty for all.
    pub sessions: Vec<String>,
    /// Whether each of these sessions has an amplitude of its own.
    pub by_session: bool,
}

/// A mechanism that cannot be seen, and why.
#[derive(Clone, Debug, Serialize)]
pub struct Absorbed {
    /// Mechanism.
    pub mechanism: String,
    /// Share of information left.
    pub retained: f64,
    /// What mimics it.
    pub by: String,
}

/// The smallest size of a mechanism that would have been seen.
#[derive(Clone, Debug, Serialize)]
pub struct Detectable {
    /// Mechanism.
    pub mechanism: String,
    /// Size that is seen in 80 % of such data sets; of a time at least what is resolved, half a sample period.
    pub size: f64,
    /// Unit.
    pub unit: String,
    /// Whether it is the size of a change between sessions: what is the same in all the coefficients of the ship take up.
    pub of_change: bool,
}

/// How far a parameter moved.
#[derive(Clone, Debug, Serialize)]
pub struct Move {
    /// Dotted name.
    pub name: String,
    /// Before the findings.
    pub before: f64,
    /// After.
    pub after: f64,
    /// Standard error after.
    pub error: f64,
    /// Difference in standard errors.
    pub moved: f64,
}

/// How much of what was allowed for in the hull coefficients was used.
#[derive(Clone, Debug, Serialize)]
pub struct Budget {
    /// Dotted name.
    pub name: String,
    /// Prior mean.
    pub prior: f64,
    /// Prior standard deviation.
    pub sd: f64,
    /// Estimate.
    pub value: f64,
    /// Distance from the prior mean in prior standard deviations.
    pub used: f64,
}

/// Tests of a generic discrepancy.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Adequacy {
    /// p-value of mirror-symmetric force terms: the ship's own forces have another form.
    pub symmetric: f64,
    /// p-value of mirror-breaking and earth-fixed force terms.
    pub asymmetric: f64,
}

/// Two mechanisms and how alike they are on these data.
#[derive(Clone, Debug, Serialize)]
pub struct Likeness {
    /// One.
    pub a: String,
    /// The other.
    pub b: String,
    /// Cosine of the principal angle after the base is projected out: 1 when they cannot be distinguished.
    pub cosine: f64,
}

/// A trial worth sailing next.
#[derive(Clone, Debug, Serialize)]
pub struct NextTrial {
    /// The trial.
    pub trial: String,
    /// What it would decide.
    pub why: String,
}

/// The unknown force along one run, as the filter estimates it.
#[derive(Clone, Debug)]
pub struct Trace {
    /// Index of the run.
    pub index: usize,
    /// The run.
    pub run: String,
    /// Its session.
    pub session: String,
    /// Time \[s\].
    pub time: Vec<f64>,
    /// Filtered state `[x, y, psi, u, v, r]`.
    pub state: Vec<[f64; 6]>,
    /// Propeller rate \[1/s\] and rudder angle \[rad\].
    pub inputs: Vec<[f64; 2]>,
    /// Unknown force under the base model: X, Y \[N\], N \[N m\].
    pub before: Vec<[f64; 3]>,
    /// Unknown force with the findings.
    pub after: Vec<[f64; 3]>,
    /// Standard deviation of the former.
    pub sd: Vec<[f64; 3]>,
}

/// Everything a diagnosis says.
#[derive(Clone, Debug, Serialize)]
pub struct Diagnosis {
    /// Layout of this document.
    pub schema: &'static str,
    /// The verdict.
    pub verdict: Verdict,
    /// One sentence.
    pub headline: String,
    /// What was found, the confirmed before the suspected, each strongest first.
    pub findings: Vec<Finding>,
    /// What was selected and is not named, with the grade that says why.
    pub withdrawn: Vec<Finding>,
    /// One or two recordings in which forces act that the model does not have and no other shows, where nothing is named.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub differing: Vec<String>,
    /// What acts in them alone, where something of the catalogue explains them.
    pub causes: Vec<Cause>,
    /// Whether the answer is the same on transformed recordings; absent where nothing was found.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stability: Option<Stability>,
    /// The study's own error rates, by simulation; absent where they were not asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error_rates: Option<ErrorRates>,
    /// How the model follows the training runs.
    pub following: Following,
    /// Recordings that the diagnosis set aside for the proof, because the user marked none.
    pub set_aside: usize,
    /// Whether the improved model is the base model, refitted: nothing was found and no law confirmed, or unseen runs are predicted
    /// worse with it.
    pub improved_is_base: bool,
    /// The study's own model, the base model and the improved one on unseen runs; empty where there are none to judge by.
    pub models: Vec<OnUnseen>,
    /// Which of them is in improved.toml: the study's own where it simulates the unseen runs better.
    pub written: Whose,
    /// Audit of recordings and numerics.
    pub admission: Admission,
    /// Noise under the base model.
    pub noise_before: Noise,
    /// Noise with the findings.
    pub noise_after: Noise,
    /// Unexplained force under the base model.
    pub location: Location,
    /// Unexplained force that is left.
    pub location_after: Option<Location>,
    /// The ranking under the base model.
    pub ranking: Vec<Ranked>,
    /// Mechanisms that cannot be seen.
    pub absorbed: Vec<Absorbed>,
    /// Sizes that would have been seen.
    pub detectable: Vec<Detectable>,
    /// Pairs of mechanisms that look alike on these data.
    pub confusable: Vec<Likeness>,
    /// Generic tests under the base model.
    pub adequacy_before: Adequacy,
    /// Generic tests with the findings.
    pub adequacy_after: Adequacy,
    /// A law for what is not in the catalogue; absent where no monomial is worth its price.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub law: Option<Law>,
    /// How far the model's own parameters moved.
    pub moves: Vec<Move>,
    /// Whether the ship's own two sides differ.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sides: Option<Sides>,
    /// Hull error budget used.
    pub hull_budget: Vec<Budget>,
    /// Which trial to sail next.
    pub next_trial: Option<NextTrial>,
    /// Proof on held-out runs.
    pub held_out: Option<HeldOut>,
    /// How much of the training runs lies outside the ranges over which the terms of the improved model are valid.
    pub validity: Coverage,
    /// Settings used.
    pub settings: Settings,
    /// The unknown force along every run, before and after, for pictures.
    #[serde(skip)]
    pub traces: Vec<Trace>,
    /// The test runs, or without any the training runs, recorded and simulated, for pictures.
    #[serde(skip)]
    pub sailed: Vec<Sailed>,
    /// The model of improved.toml.
    #[serde(skip)]
    pub model: Model,
    /// Covariance of the improved model's parameters, hull coefficients included; absent where the data do not determine them.
    #[serde(skip)]
    pub uncertainty: Option<Uncertainty>,
    /// The base model, refitted.
    #[serde(skip)]
    pub base: Model,
}

impl Diagnosis {
    /// Whether something was added to the base model and compared with it: a finding, or a law that unseen runs confirm.
    pub fn adds(&self) -> bool {
        !self.findings.is_empty() || self.law.as_ref().is_some_and(Law::is_confirmed)
    }
}
