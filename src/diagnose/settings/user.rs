//! The settings that a user may change, each with its limits.
//! The numbers that no user can change are in the other files here.

use crate::evaluate::{EvaluationSettings, Judging};
use crate::fit::{ConstraintSettings, FitSettings};
use crate::ranges::{Limited, OutOfRange, counted, within};
use crate::simulate::{Integration, Method};
use serde::{Deserialize, Serialize};

/// Settings of a diagnosis, the `[diagnose]` table of a study.
#[derive(Clone, Debug, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Chance of naming anything when nothing is missing.
    pub alpha: f64,
    /// At most this many mechanisms.
    pub most: usize,
    /// Mechanisms that must not be considered.
    pub withhold: Vec<String>,
    /// Whether unknown hull, propeller and rudder coefficients are carried along with their priors.
    pub nuisance: bool,
    /// Sub-steps of RK4 in one sample period.
    pub substeps: usize,
    /// Seed of the bootstrap.
    pub seed: u64,
    /// Whether the analysis is repeated with what is named, on transformed recordings, to see whether it is stable.
    pub repeat: bool,
    /// Simulated studies with nothing missing, and as many with what was found, that are analysed for the study's own error rates.
    pub calibrate: usize,
    /// How the proof simulates and weighs the test runs. A study has it in the tables `[fit]` and `[evaluate]`, so that a
    /// diagnosis and an evaluation print the same numbers.
    #[serde(skip, default = "judging")]
    pub judging: Judging,
    /// The constraints of the models that are written. A study has them in its table `[fit.constraints]`.
    #[serde(skip)]
    pub constraints: ConstraintSettings,
}

/// As a fit would judge, but by the integration of a diagnosis.
fn judging() -> Judging {
    let integration = Integration { method: Method::Rk4, substeps: 1 };
    Judging { integration, ..Judging::new(&FitSettings::default(), EvaluationSettings::default()) }
}

impl Settings {
    /// How steps are integrated.
    pub fn integration(&self) -> Integration {
        Integration { method: Method::Rk4, substeps: self.substeps }
    }

    /// The chance of two independent false positives, `alpha` squared: for tests that must be more significant than others.
    pub fn strict(&self) -> f64 {
        self.alpha * self.alpha
    }

    /// Whether a mechanism may be considered.
    pub fn allows(&self, mechanism: &str) -> bool {
        !self.withhold.iter().any(|w| w == mechanism)
    }
}

impl Limited for Settings {
    fn limits(&self) -> Result<(), OutOfRange> {
        within("alpha", self.alpha, &(1e-12..=0.5), "the chance of naming anything when nothing is missing")?;
        counted("most", self.most, &(1..=20), "the largest number of mechanisms that are named")?;
        counted("calibrate", self.calibrate, &(0..=10_000), "the number of simulated studies")?;
        self.integration().limits()
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            alpha: 0.01,
            most: 3,
            withhold: Vec::new(),
            nuisance: true,
            substeps: 1,
            seed: 20250226,
            repeat: false,
            calibrate: 0,
            judging: judging(),
            constraints: ConstraintSettings::default(),
        }
    }
}
