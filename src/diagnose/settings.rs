//! Every number of the diagnosis: those with which tests are compared, those by which tests are made, and the settings that a user may
//! change; each with its name, value, meaning, and how it was set.

use crate::evaluate::{EvaluationSettings, Judging};
use crate::fit::{ConstraintSettings, FitSettings};
use crate::likelihood::settings::{COST, CUSTOM, HULLS, SEEDS, numbers};
pub use crate::likelihood::settings::{
    Effort, FIRST, GATE, IDENTIFIABLE_SHARE, LIKELIHOOD, Number, REFIT, SCATTER_GROUPS, SETTLE, STEP_GAIN, TOGETHER,
};
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

    /// The chance that two independent accidents have: for what other tests must have been wrong about, too.
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
            repeat: true,
            calibrate: 0,
            judging: judging(),
            constraints: ConstraintSettings::default(),
        }
    }
}

/// No step from where a model stands: its value alone.
pub const AS_IT_IS: Effort = Effort { rounds: 0, noise_rounds: 0, noise_iterations: 0 };
/// Ship and noise beside the error of a sensor that is held.
pub const TOGETHER_EFFORT: Effort = Effort { rounds: 8, noise_rounds: 3, noise_iterations: 6 };
/// The base model of a signal-to-noise ratio: noise within a few per cent.
pub const SIGNAL: Effort = Effort { rounds: 6, noise_rounds: 2, noise_iterations: 6 };
/// The start of a model that is given its mechanisms: parameters and noise are estimated again with them.
pub const GIVEN_START: Effort = Effort { rounds: 3, noise_rounds: 2, noise_iterations: 6 };
/// The one fit of a model that is given its mechanisms.
pub const GIVEN_FINISH: Effort = Effort { rounds: 8, noise_rounds: 2, noise_iterations: 6 };

/// Shares of the amplitudes of a score test at which a refit may start, the other parameters moved along.
pub const STARTS: [f64; 3] = [1.0, 0.3, 0.1];
/// Multiples at which the refit of an effect that grows with the square of its amplitude may start, the others held.
pub const STARTS_OF_SQUARES: [f64; 3] = [3.0, 10.0, 30.0];
/// p-value below which port and starboard of the ship itself are told apart: the level at which a diagnosis names anything (`alpha`).
pub const SIDES_DIFFER: f64 = 0.01;
numbers! {
    /// The numbers with which tests are compared: all on which a verdict turns once the tests are made, beside the settings of the user.
    VERDICT:

    /// p-value below which a test is beyond doubt: of a further mechanism beside others, of weather that differs from place to place,
    /// and, as its logarithm, of Euler steps in the making of the recordings.
    BEYOND_DOUBT: f64 = 1e-6, SEEDS;
    /// p-value below which a force is beyond what the ship's own forces make where they have another form than the model gives them:
    /// their asymmetry reaches 1e-6. It counts for a law that the catalogue lacks, and for a push on such a ship.
    BEYOND_FORM: f64 = 1e-8, SEEDS;
    /// Share of a statistic, or of a force, that may be left where one thing explains another whose form is not exact.
    REMAINDER: f64 = 0.4, SEEDS;
    /// Share of its statistic that an amplitude may lose where it is kept inside the bounds of its parameters.
    BEYOND_BOUNDS: f64 = 0.25, SEEDS;
    /// Likeness of two mechanisms from which on they are refitted and compared.
    LIKENESS: f64 = 0.3, SEEDS;
    /// Log-likelihood that a further parameter must bring.
    PARAMETER_PRICE: f64 = 2.0, "twice the price in the information criterion of Akaike";
    /// Mechanisms closer than this in log-likelihood cannot be distinguished.
    INDISTINGUISHABLE: f64 = 3.0, "a likelihood ratio of 20";
    /// That difference as a share of the gain of a force or of the ship's own physics, whose law is known only so well.
    FORM_TOLERANCE: f64 = 0.1, SEEDS;
    /// Prior standard deviations that a mechanism's own coefficients may be off before its force is another mechanism's.
    IMPLAUSIBLE: f64 = 2.0, CUSTOM;
    /// Share of the runs that a push is expected to act in beforehand.
    PUSH_PRIOR: f64 = 0.2, SEEDS;
    /// Share of the error of predictions that a finding must change, in one channel at least, to matter.
    MATERIAL_SHARE: f64 = 0.05, "the default share of the users' requirement; not tuned";
    /// Sample periods of the recordings that a clock must be off by to be resolved.
    RESOLVED_SAMPLES: f64 = 0.5, "half of it, as a resolution is counted; not tuned";
    /// Share of the force that turns the ship, m u^2 / L, above which the unknown force is gusts: in the mean over the time L / u.
    GUST_SHARE: f64 = 0.02,
        "its standard deviation on development seeds 21, 22 and 24 of the campaign of concealed cases (`campaign -- --alone --seed 21`); kept for the mean, which is 0.017 at most in 130 nulls of seed 8702";
    /// Root mean square error of explicit Euler steps, as a share of that of steps of second order, below which they reproduce
    /// recorded positions to rounding.
    EULER_EXACT: f64 = 0.05, "rounding of recorded values; sensors are at least ten times as noisy";
    /// Fewest runs that can show that nothing is missing. One recording of so many is set aside for the proof, where there are
    /// twice as many.
    FEWEST_RUNS: usize = 4, CUSTOM;
    /// Fewest samples that can show that nothing is missing.
    FEWEST_SAMPLES: usize = 150, CUSTOM;
    /// Fewest recordings that have a scatter: for an interval over unseen recordings, and for a push that is no state of its own.
    FEWEST_RECORDINGS: usize = 3, "the fewest for a variance that means something";
}

numbers! {
    /// The numbers by which tests and estimates are made: what is assumed of the noise before the data, how far a search goes, and
    /// what it costs.
    ESTIMATION:

    /// Measurements of a channel in a row beyond the outlier gate from which on the filter has lost the ship.
    LOST_MEASUREMENTS: usize = 5, HULLS;
    /// Share of the runs above which lost stretches are the model's fault, and the runs stay whole.
    FEW_LOST_SHARE: f64 = 0.1, HULLS;
    /// Rounds in which stretches that the filter does not follow are looked for and left out before the base model is kept.
    LOSS_ROUNDS: usize = 4, COST;
    /// Loss in log-posterior of an unfitted Euler reading beyond which it is not fitted.
    EULER_HOPELESS: f64 = 1000.0, COST;


    /// Statistics of two groups of sessions closer than this are equal.
    EQUAL_STATISTICS: f64 = 0.01, CUSTOM;
    /// Most sessions of which every division into two groups is tested.
    DIVIDED_SESSIONS: usize = 6, COST;
    /// Shortest span of the recordings that can show a tide: a quarter of its period of 12.42 h \[s\].
    QUARTER_TIDE: f64 = 11_178.0, "a quarter of the principal lunar tide";
    /// Prior standard deviation of a sensor's error, in units of the parameter's scale.
    SENSOR_SPREAD: f64 = 10.0, "wider than any error that a user would not see; not varied";
    /// Length of the stretches over which the sensors are held against each other, in ship lengths.
    STRETCH: f64 = 0.5, "chosen with the method, before any case, and not varied";
    /// Stretches in a row, in a block that counts as one in the scatter of what the sensors say of each other.
    STRETCHES: usize = 10, "five ship lengths, more than a turn takes; chosen before any case, and not varied";
    /// Forces are held against those of the base's asymmetric parameters at every so many samples.
    FORCE_STRIDE: usize = 4, COST;
    /// Most rivals that are refitted beside a leader.
    RIVALS: usize = 3, COST;
    /// A rival is refitted where its statistic is less than this below the leader's, or less than the remainder of an inexact form.
    RIVAL_GAP: f64 = 60.0, COST;

    /// Blocks of the time scan of the longest run, at most.
    BLOCKS: usize = 64, COST;
    /// Runs whose innovations with the step as used and with a finer one are in memory at once.
    COMPARED: usize = 64, COST;
    /// Samples in a block of the time scan, at least.
    BLOCK_SAMPLES: usize = 2, COST;
    /// Longest window of a push, as a share of its run.
    PUSH_LONGEST: f64 = 0.7, SEEDS;
    /// Windows, the best of their runs, from which the search for a push starts.
    PUSH_STARTS: usize = 12, COST;
    /// Rounds of that search.
    PUSH_ROUNDS: usize = 4, COST;
    /// Steps by which recorded states are freed from the errors that a model's sensors have.
    CORRECTIONS: usize = 3, COST;
    /// Parts into which the water sailed is divided each way.
    PLACE_PARTS: usize = 3, CUSTOM;
    /// Share of the positions at either end that the parts leave out.
    PLACE_TAIL: f64 = 0.02, CUSTOM;
    /// Superfluous monomials that a law for what the catalogue does not hold may have on average.
    LAW_P: f64 = 0.05, "one law in twenty; simulated nulls have fewer";
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_number_has_a_name_of_its_own_a_meaning_and_an_origin() {
        let numbers = || VERDICT.iter().chain(ESTIMATION).chain(LIKELIHOOD);
        let names: BTreeSet<&str> = numbers().map(|n| n.name).collect();
        assert_eq!(names.len(), numbers().count());
        assert!(numbers().all(|n| n.value > 0.0 && n.meaning.len() > 20 && !n.origin.is_empty()));
        assert!(VERDICT.len() <= 20, "{}", VERDICT.len());
    }

    #[test]
    fn no_other_file_of_the_diagnosis_hides_a_number_behind_a_name() {
        // How an answer is listed and drawn, how a search ends, and rival methods.
        let own = ["optimise.rs", "baseline.rs", "summary.rs", "push.rs", "sailed.rs"];
        let mut found = Vec::new();
        for entry in std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/src/diagnose")).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            if name == "settings.rs" || name == "example.rs" || own.contains(&name.as_str()) {
                continue;
            }
            let text = std::fs::read_to_string(&path).unwrap();
            let code = text.split("#[cfg(test)]").next().unwrap_or_default();
            let is_number = |l: &&str| l.contains("const ") && (l.contains(": f64 =") || l.contains(": usize ="));
            found.extend(code.lines().filter(is_number).map(|l| format!("{name}: {l}")));
        }
        // Sizes of arrays are no thresholds.
        found.retain(|l| {
            ![
                "NOISE_PARAMETERS",
                "const N:",
                "const W:",
                "const FIXED:",
                "const Z:",
                "BLOCKS:",
                "PARTS:",
                "NUDGE:",
                "COMPONENTS:",
                "WIDE:",
            ]
            .iter()
            .any(|n| l.contains(n))
        });
        assert!(found.is_empty(), "{found:#?}");
    }
}
