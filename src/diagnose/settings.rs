//! Every number that can turn a verdict: name, value, meaning, and how it was set; and the settings that a user may change.
//! The smallest size worth naming of each mechanism is not here: it is a `floor` of the mechanism, in its term's file.

use super::optimise::Damping;
use crate::evaluate::{EvaluationSettings, Judging};
use crate::fit::FitSettings;
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
    /// Whether the analysis is repeated with what is named, on the same recordings told otherwise, to see whether it is stable.
    pub repeat: bool,
    /// Simulated studies with nothing missing, and as many with what was found, that are analysed for the study's own error rates.
    pub calibrate: usize,
    /// How the proof simulates and weighs the test runs. A study has it in the tables `[fit]` and `[evaluate]`, so that a
    /// diagnosis and an evaluation print the same numbers.
    #[serde(skip, default = "judging")]
    pub judging: Judging,
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
        }
    }
}

/// Rounds and iterations of an estimation.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Rounds of parameter steps, each followed by a noise estimate while `noise_rounds` last.
    pub rounds: usize,
    /// Rounds with a noise estimate.
    pub noise_rounds: usize,
    /// Fisher scoring iterations in a noise estimate.
    pub noise_iterations: usize,
    /// Runs used for the noise estimate, evenly spread.
    pub noise_runs: usize,
}

/// The first estimate of the base model, from the values of the model file.
pub const FIRST: Effort = Effort { rounds: 12, noise_rounds: 4, noise_iterations: 14, noise_runs: 12 };
/// A refit at given noise.
pub const REFIT: Effort = Effort { rounds: 10, noise_rounds: 0, noise_iterations: 0, noise_runs: 10 };
/// A refit with the noise estimated along.
pub const SETTLE: Effort = Effort { rounds: 10, noise_rounds: 1, noise_iterations: 4, noise_runs: 10 };
/// The errors of all sensors at once.
pub const TOGETHER_EFFORT: Effort = Effort { rounds: 8, noise_rounds: 3, noise_iterations: 6, noise_runs: 10 };
/// The base model of a signal-to-noise ratio: noise within a few per cent.
pub const SIGNAL: Effort = Effort { rounds: 6, noise_rounds: 2, noise_iterations: 6, noise_runs: 6 };
/// The start of a model that is given its mechanisms: parameters and noise are estimated again with them.
pub const GIVEN_START: Effort = Effort { rounds: 3, noise_rounds: 2, noise_iterations: 6, noise_runs: 6 };
/// The one fit of a model that is given its mechanisms.
pub const GIVEN_FINISH: Effort = Effort { rounds: 8, noise_rounds: 2, noise_iterations: 6, noise_runs: 10 };

/// How a step of the parameters is damped, in units of the columns' scales: parameters that the data hardly determine ask for
/// steps on which the others would fail. It stays while the valley bends.
pub const STEP_DAMPING: Damping = Damping {
    attempts: 6,
    least_promise: STEP_GAIN,
    loss: STEP_LOSS,
    first: 0.3,
    most: f64::INFINITY,
    shrink: 0.3,
    off: 0.03,
    trusted: 0.5,
};
/// How a step of the noise's logarithms is damped, in units of the information's diagonal.
pub const NOISE_DAMPING: Damping = Damping {
    attempts: 6,
    least_promise: NOISE_STEP_GAIN,
    loss: 0.0,
    first: 0.1,
    most: f64::INFINITY,
    shrink: 0.1,
    off: 0.05,
    trusted: 0.0,
};
/// Shares of the amplitudes of a score test at which a refit may start, the other parameters moved along.
pub const STARTS: [f64; 3] = [1.0, 0.3, 0.1];
/// Multiples at which the refit of an effect that grows with the square of its amplitude may start, the others held.
pub const STARTS_OF_SQUARES: [f64; 3] = [3.0, 10.0, 30.0];
/// Standard deviations of a run's own start: x and y in ship lengths, heading \[rad\], u and v in units of the root of gravity
/// times length, yaw rate in that unit over the length.
pub const START_SPREAD: [f64; 6] = [0.5, 0.5, 0.2, 0.05, 0.05, 0.1];
/// Sensor noise below which a sensor is exact for every purpose: position in ship lengths, heading \[rad\], speed and yaw rate in the
/// units of [`START_SPREAD`].
pub const EXACT_SENSOR: [f64; 4] = [1e-4, 2e-4, 1e-4, 1e-4];

/// A number that can turn a verdict.
#[derive(Clone, Copy, Debug)]
pub struct Number {
    /// Its name in this file.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// What it means.
    pub meaning: &'static str,
    /// How it was set.
    pub origin: &'static str,
}

/// Declares the numbers as constants, and [`NUMBERS`] as the table of them.
macro_rules! numbers {
    ($($(#[doc = $meaning:literal])+ $name:ident: $type:ty = $value:expr, $origin:expr;)*) => {
        $($(#[doc = $meaning])+ pub const $name: $type = $value;)*

        /// Every number that can turn a verdict, in the order of the steps.
        #[allow(clippy::unnecessary_cast)]
        pub const NUMBERS: &[Number] = &[
            $(Number {
                name: stringify!($name),
                value: $value as f64,
                meaning: concat!($($meaning),+).trim_ascii(),
                origin: $origin,
            },)*
        ];
    };
}

/// Concealed cases of the campaign's development seeds (21, 22, 24); no published seed was looked at before it was published.
const SEEDS: &str = "development seeds of the campaign of concealed cases";
/// Those cases, and recordings of two real hulls.
const HULLS: &str = "development seeds of the campaign, and the recordings of Esso Osaka and KVLCC2";
/// A round value in common use; how it was chosen is not recorded.
const CUSTOM: &str = "convention; how it was chosen is not recorded";
/// More costs time, less costs accuracy.
const COST: &str = "computing time against accuracy";

numbers! {
    /// Measurements of a channel in a row beyond the outlier gate from which on the filter has lost the ship.
    LOST_MEASUREMENTS: usize = 5, HULLS;
    /// Share of the runs above which lost stretches are the model's fault, and the runs stay whole.
    FEW_LOST_SHARE: f64 = 0.1, HULLS;
    /// Rounds in which stretches that the filter does not follow are looked for and left out before the base model is kept.
    LOSS_ROUNDS: usize = 4, COST;
    /// Root mean square error of explicit Euler steps, as a share of that of steps of second order, below which they reproduce
    /// recorded positions to rounding.
    EULER_EXACT: f64 = 0.05, "rounding of recorded values; sensors are at least ten times as noisy";
    /// Gain in log-posterior above which recordings are read as explicit Euler steps of one sample period.
    EULER_GAIN: f64 = 15.0, SEEDS;
    /// Loss in log-posterior of an unfitted Euler reading beyond which it is not fitted.
    EULER_HOPELESS: f64 = 1000.0, COST;

    /// Innovations larger than this many standard deviations are set aside as outliers.
    GATE: f64 = 6.0, CUSTOM;
    /// Share of measurements beyond the outlier gate above which the noise is taken as too small and everything counts first.
    OUTLIER_SHARE: f64 = 0.03, "recordings of Esso Osaka, where a quarter lay beyond the gate of the first guess";
    /// Loss in log-posterior above which a noise that was fitted to some runs is fitted to all of them.
    NOISE_REFUSED: f64 = 10.0, "recordings of Esso Osaka and KVLCC2";
    /// Share of the runs, those of the highest likelihood, that tell the noise without what disturbs some runs only.
    CALM_SHARE: f64 = 0.6, SEEDS;
    /// Iterations of the noise estimate on those runs.
    CALM_ITERATIONS: usize = 8, COST;
    /// Gain in log-posterior below which a parameter step is not worth taking.
    STEP_GAIN: f64 = 0.3, COST;
    /// Longest parameter step, in units of the scales: beyond it the linearisation says nothing.
    STEP_LONGEST: f64 = 10.0, COST;
    /// Length of a parameter step, in units of the scales, below which the estimate has converged.
    STEP_SHORTEST: f64 = 0.03, COST;
    /// Loss in log-posterior that a parameter step may make and still count as no worse.
    STEP_LOSS: f64 = 0.01, COST;
    /// Gain in log-posterior below which a step of the noise's logarithms is not worth taking.
    NOISE_STEP_GAIN: f64 = 0.05, COST;
    /// Longest step of the noise's logarithms.
    NOISE_STEP_LONGEST: f64 = 1.5, COST;
    /// First guess of the coloured part of a sensor noise, as a share of the white part.
    COLOURED_GUESS: f64 = 0.7, CUSTOM;
    /// First guess of its correlation time, in sample periods.
    COLOURED_PERIODS: f64 = 4.0, CUSTOM;
    /// First guess of the unknown force: a share of the mass times the acceleration U^2 / L at a Froude number of 0.2.
    FORCE_GUESS: f64 = 0.01, CUSTOM;
    /// Prior standard deviation of the logarithm of a sensor noise's size: a factor of about 4.
    NOISE_SIZE_SPREAD: f64 = 1.4, SEEDS;
    /// Prior standard deviation of the logarithm of a white noise below its first guess: a smoothed sensor is not exact.
    NOISE_WHITE_SPREAD: f64 = 0.05, SEEDS;
    /// Prior standard deviation of the logarithm of a correlation time: a factor of about 2.
    NOISE_TIME_SPREAD: f64 = 0.7, SEEDS;
    /// Prior standard deviation of the logarithm of the unknown force's size: a factor of about 12.
    NOISE_FORCE_SPREAD: f64 = 2.5, SEEDS;

    /// Directions with less than this share of their information left beside the base parameters are not identifiable.
    IDENTIFIABLE_SHARE: f64 = 0.01, "prototype: a rudder offset keeps 0.000, the least identifiable effect 0.02";
    /// Fewest groups of runs for the scatter of a parameter; where there are fewer, their number is taken as this.
    SCATTER_GROUPS: usize = 5, SEEDS;
    /// Gain in log-likelihood by which a variance of the generic force law must beat the one chosen before it, none at first.
    GENERIC_GAIN: f64 = 2.0, SEEDS;
    /// Statistics of two groups of sessions closer than this are equal.
    EQUAL_STATISTICS: f64 = 0.01, CUSTOM;
    /// Most sessions of which every division into two groups is tested.
    DIVIDED_SESSIONS: usize = 6, COST;
    /// What a group of sessions, or one amplitude a session, must explain more (statistic less degrees) than what is simpler.
    SESSIONS_GAIN: f64 = 6.0, SEEDS;
    /// What every further amplitude must explain more.
    AMPLITUDE_GAIN: f64 = 2.0, SEEDS;
    /// Share of its statistic that an amplitude may lose where it is kept inside the bounds of its parameters.
    BEYOND_BOUNDS: f64 = 0.25, SEEDS;
    /// Shortest span of the recordings that can show a tide: a quarter of its period of 12.42 h \[s\].
    QUARTER_TIDE: f64 = 11_178.0, "a quarter of the principal lunar tide";

    /// p-value of the symmetric generic force law above which the ship's own forces have the form that the model gives them.
    FORM_P: f64 = 0.05, CUSTOM;
    /// A mechanism is named only where its p-value beside a free generic force law is below this.
    SECOND_OPINION_P: f64 = 0.01, CUSTOM;
    /// Factor on the chance of a false name for the ship's own physics, whose form may differ between sessions by what was sailed.
    OWN_PHYSICS_ALPHA: f64 = 0.02, SEEDS;
    /// Smallest size worth naming, in units of the mechanism's own floor.
    SMALLEST_SIZE: f64 = 1.0, "by the definition of the floors";
    /// p-value below which a further mechanism may be named beside others.
    FURTHER_P: f64 = 1e-6, SEEDS;
    /// Share of the statistic of a look-alike that a further mechanism must exceed: less may be left by the look-alike's form.
    FURTHER_SHARE: f64 = 0.4, SEEDS;
    /// Factor on the chance of a false name above which the p-value of an earlier mechanism removes it again.
    REMOVAL_ALPHA: f64 = 0.1, SEEDS;

    /// Log-likelihood that a further parameter must bring.
    PARAMETER_PRICE: f64 = 2.0, "twice the price in the information criterion of Akaike";
    /// Mechanisms closer than this in log-likelihood cannot be told apart.
    INDISTINGUISHABLE: f64 = 3.0, "a likelihood ratio of 20";
    /// That difference as a share of the gain of a force or of the ship's own physics, whose law is known only so well.
    FORM_TOLERANCE: f64 = 0.1, SEEDS;
    /// Prior standard deviation of a sensor's error beside those of all sensors, in units of the parameter's scale.
    SENSOR_SPREAD: f64 = 10.0, "wider than any error that a user would not see; not varied";
    /// Length of the stretches over which the sensors are held against each other, in ship lengths.
    STRETCH: f64 = 0.5, "chosen with the method, before any case, and not varied";
    /// Prior standard deviations that a mechanism's own coefficients may be off before its force is another mechanism's.
    IMPLAUSIBLE: f64 = 2.0, CUSTOM;
    /// Share of its own force that a mechanism must leave once the force of the base's asymmetric parameters is added.
    CANCELLED_SHARE: f64 = 0.4, "recordings of Esso Osaka";
    /// The forces of that comparison are taken at every so many samples.
    FORCE_STRIDE: usize = 4, COST;
    /// Most rivals that are refitted beside a leader.
    RIVALS: usize = 3, COST;
    /// A rival is refitted where its statistic is less than this below the leader's.
    RIVAL_GAP: f64 = 60.0, SEEDS;
    /// That gap as a share of the leader's statistic, where this is larger.
    RIVAL_SHARE: f64 = 0.3, SEEDS;
    /// Likeness above which mechanisms that act in all sessions are rivals.
    RIVAL_LIKENESS: f64 = 0.3, SEEDS;
    /// Likeness to a leader whose coefficients are implausible below which another mechanism explains something else.
    UNRELATED_LIKENESS: f64 = 0.3, SEEDS;

    /// Blocks of the time scan of the longest run, at most.
    BLOCKS: usize = 64, COST;
    /// Runs that each thread passes over before what they gave is added up.
    TOGETHER: usize = 8, COST;
    /// Runs whose innovations with the step as used and with a finer one are in memory at once.
    COMPARED: usize = 64, COST;
    /// Samples in a block of the time scan, at least.
    BLOCK_SAMPLES: usize = 2, COST;
    /// Share of the runs that a push is expected to act in beforehand.
    PUSH_PRIOR: f64 = 0.2, SEEDS;
    /// Longest window of a push, as a share of its run.
    PUSH_LONGEST: f64 = 0.7, SEEDS;
    /// Windows, the best of their runs, from which the search for a push starts.
    PUSH_STARTS: usize = 12, COST;
    /// Rounds of that search.
    PUSH_ROUNDS: usize = 4, COST;
    /// A push across the keel holds at least this share of its statistic in sway force and yaw moment.
    PUSH_ACROSS_SHARE: f64 = 0.7, SEEDS;
    /// Factor on the needed statistic for a push along the keel, where thrust and resistance of another form make windows too.
    PUSH_ALONG: f64 = 2.5, HULLS;
    /// Share of a push's statistic that its mirror image must stay below: what the ship's motion brings acts on both sides.
    PUSH_MIRRORED: f64 = 0.2, SEEDS;
    /// Statistic that a push across the keel must exceed in one or two recordings, and beside a mechanism in a few.
    PUSH_IN_TWO: f64 = 250.0, SEEDS;
    /// Statistic that it must exceed in three recordings.
    PUSH_IN_THREE: f64 = 120.0, SEEDS;
    /// Statistic that it must exceed in four recordings.
    PUSH_IN_FOUR: f64 = 50.0, SEEDS;
    /// Statistic that it must exceed in five recordings or more.
    PUSH_IN_MANY: f64 = 40.0, SEEDS;
    /// Statistic in five recordings or more where the ship's own forces have the model's form.
    PUSH_IN_MANY_OF_FORM: f64 = 25.0, SEEDS;
    /// Recordings up to which a push cannot be told from the ship's own forces in a state that no other recording visits.
    PUSH_FEW_RECORDINGS: usize = 2, HULLS;
    /// Recordings from which on a push beside a mechanism needs the lower statistic.
    PUSH_MANY_RECORDINGS: usize = 5, SEEDS;
    /// Statistic that a push beside a mechanism must exceed in so many recordings.
    PUSH_BESIDE: f64 = 60.0, SEEDS;
    /// A push enters the base model first where its statistic exceeds the best mechanism's times this.
    PUSH_FIRST: f64 = 2.0, SEEDS;
    /// Share of a push's statistic below which a mechanism leaves so little of it that its windows were the mechanism's traces.
    PUSH_EXPLAINED: f64 = 0.5, SEEDS;

    /// Share of the error of predictions that a finding must change, in one channel at least, to matter.
    MATERIAL_SHARE: f64 = 0.05, "the default share of the users' requirement; not tuned";
    /// Sample periods of the recordings that a clock must be off by to be resolved.
    RESOLVED_SAMPLES: f64 = 0.5, "half of it, as a resolution is counted; not tuned";
    /// Share of the runs that a model must simulate better than steady motion does, to be a base on which anything is named.
    FOLLOWED_SHARE: f64 = 0.5, "by the meaning of a majority; not tuned";
    /// Fewest recordings of which a part is set aside for the proof.
    FEWEST_TO_DIVIDE: usize = 8, "five to train with and three for an interval";
    /// Recordings that are set aside, at least: an interval over recordings needs three.
    FEWEST_SET_ASIDE: usize = 3, "the fewest for a variance that means something";
    /// One recording of so many is set aside.
    SET_ASIDE_EVERY: usize = 4, CUSTOM;

    /// Parts into which the water sailed is divided each way.
    PLACE_PARTS: usize = 3, CUSTOM;
    /// Share of the positions at either end that the parts leave out.
    PLACE_TAIL: f64 = 0.02, CUSTOM;
    /// p-value below which an earth-fixed force differs from place to place.
    PLACE_P: f64 = 1e-4, SEEDS;
    /// Weather that leaves more than this share of its statistic to forces that differ from place to place is refuted.
    PLACE_SHARE: f64 = 0.3, SEEDS;
    /// p-value of the asymmetric generic force law below which the catalogue lacks the cause: the ship's own asymmetry in another
    /// form reaches 1e-6.
    UNLISTED_P: f64 = 1e-8, SEEDS;
    /// Most monomials of a surrogate law for what the catalogue does not hold.
    SURROGATE_TERMS: usize = 4, CUSTOM;
    /// p-value above which a surrogate law takes no further monomial.
    SURROGATE_P: f64 = 0.01, CUSTOM;
    /// Fewest runs that can show that nothing is missing.
    FEWEST_RUNS: usize = 4, CUSTOM;
    /// Fewest samples that can show that nothing is missing.
    FEWEST_SAMPLES: usize = 150, CUSTOM;
    /// Share of the force that turns the ship, m u^2 / L, above which the unknown force is gusts.
    GUST_SHARE: f64 = 0.02, SEEDS;
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_number_has_a_name_of_its_own_a_meaning_and_an_origin() {
        let names: BTreeSet<&str> = NUMBERS.iter().map(|n| n.name).collect();
        assert_eq!(names.len(), NUMBERS.len());
        assert!(NUMBERS.iter().all(|n| n.value > 0.0 && n.meaning.len() > 20 && !n.origin.is_empty()));
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
            !["NOISE_PARAMETERS", "const N:", "const W:", "const FIXED:", "const Z:", "BLOCKS:", "PARTS:", "NUDGE:"]
                .iter()
                .any(|n| l.contains(n))
        });
        assert!(found.is_empty(), "{found:#?}");
    }
}
