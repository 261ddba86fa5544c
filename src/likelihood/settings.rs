//! Every number of the likelihood: what is assumed of noise and starts before the data, and how far an estimate goes; each with its name,
//! value, meaning, and how it was set. The numbers with which tests are compared are in the settings of the diagnosis.

use super::optimise::Damping;

/// Rounds and iterations of an estimation.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Rounds of parameter steps, each followed by a noise estimate while `noise_rounds` last.
    pub rounds: usize,
    /// Rounds with a noise estimate.
    pub noise_rounds: usize,
    /// Fisher scoring iterations in a noise estimate.
    pub noise_iterations: usize,
}

/// The first estimate of the base model, from the values of the model file.
/// It ends where neither parameters nor noise gain more; the rounds only bound it: of a craft known by its size alone they begin far from
/// their values, and an unknown force takes up what they lack until they are there.
pub const FIRST: Effort = Effort { rounds: 60, noise_rounds: 60, noise_iterations: 14 };
/// A refit at given noise.
pub const REFIT: Effort = Effort { rounds: 10, noise_rounds: 0, noise_iterations: 0 };
/// A refit with the noise estimated along, to convergence: a noise that includes a missing force falls once the force is in the model.
/// The rounds only bound it.
pub const SETTLE: Effort = Effort { rounds: 20, noise_rounds: 20, noise_iterations: 8 };
/// How a step of the parameters is damped, in units of the columns' scales: parameters that the data hardly determine ask for
/// steps on which the others would fail. It stays while the maximum lies along a curved ridge.
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
/// Standard deviations of a run's own start: x and y in ship lengths, heading \[rad\], u and v in units of the root of gravity
/// times length, yaw rate in that unit over the length.
pub const START_SPREAD: [f64; 6] = [0.5, 0.5, 0.2, 0.05, 0.05, 0.1];
/// Sensor noise below which a sensor is exact for every purpose: position in ship lengths, heading \[rad\], speed and yaw rate in the
/// units of [`START_SPREAD`].
pub const EXACT_SENSOR: [f64; 4] = [1e-4, 2e-4, 1e-4, 1e-4];

/// A number of the likelihood or of the diagnosis.
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

/// Declares numbers as constants, and a table of them.
macro_rules! numbers {
    ($(#[doc = $title:literal])+ $table:ident: $($(#[doc = $meaning:literal])+ $name:ident: $type:ty = $value:expr, $origin:expr;)*) => {
        $($(#[doc = $meaning])+ pub const $name: $type = $value;)*

        $(#[doc = $title])+
        #[allow(clippy::unnecessary_cast)]
        pub const $table: &[Number] = &[
            $(Number {
                name: stringify!($name),
                value: $value as f64,
                meaning: concat!($($meaning),+).trim_ascii(),
                origin: $origin,
            },)*
        ];
    };
}

pub(crate) use numbers;

/// Concealed cases of the campaign's development seeds; no published seed was looked at before it was published.
pub(crate) const SEEDS: &str =
    "development seeds 21, 22 and 24 of the campaign of concealed cases (`campaign -- --alone --seed 21`)";
/// Those cases, and recordings of two real hulls.
pub(crate) const HULLS: &str =
    "the same seeds, and the recordings of Esso Osaka and KVLCC2 (`diagnose_esso_osaka`, `diagnose_kvlcc2`)";
/// A round value in common use; how it was chosen is not recorded.
pub(crate) const CUSTOM: &str = "convention; how it was chosen is not recorded";
/// More costs time, less costs accuracy.
pub(crate) const COST: &str = "computing time against accuracy";

numbers! {
    /// The numbers by which likelihoods and estimates are made.
    LIKELIHOOD:

    /// Directions with less than this share of their information left beside the base parameters are not identifiable.
    IDENTIFIABLE_SHARE: f64 = 0.01, "prototype: a rudder offset keeps 0.000, the least identifiable effect 0.02";
    /// Innovations larger than this many standard deviations are set aside as outliers.
    GATE: f64 = 6.0, CUSTOM;
    /// Fewest groups of runs for the scatter of a parameter; where there are fewer, their number is taken as this.
    SCATTER_GROUPS: usize = 5, SEEDS;
    /// Share of measurements beyond the outlier gate above which the noise is taken as too small and everything counts first.
    OUTLIER_SHARE: f64 = 0.03, "recordings of Esso Osaka, where a quarter lay beyond the gate of the first guess";
    /// Share of the runs, those of the highest likelihood, from which the noise is estimated without what disturbs some runs only.
    CALM_SHARE: f64 = 0.6, SEEDS;
    /// Iterations of the noise estimate on those runs.
    CALM_ITERATIONS: usize = 8, COST;
    /// Gain in log-posterior below which a parameter step is not worth taking.
    STEP_GAIN: f64 = 0.3, COST;
    /// What a Newton step may still promise, in log-posterior, where an estimate counts as at its optimum: damped steps may stop on a curved
    /// ridge, such as that along which masses and gains of a craft known by its size alone grow together.
    LEFT_TO_GAIN: f64 = 1.0, COST;
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
    /// How far a logarithm of the noise may move before the information is made anew that scales the steps.
    INFORMATION_REACH: f64 = 2.0, COST;
    /// About as many runs give that information where there are more.
    INFORMATION_RUNS: usize = 16, COST;
    /// First guess of the coloured part of a sensor noise, as a share of the white part.
    COLOURED_GUESS: f64 = 0.7, CUSTOM;
    /// First guess of its correlation time, in sample periods.
    COLOURED_PERIODS: f64 = 4.0, CUSTOM;
    /// First guess of the unknown force: a share of the mass times the acceleration U^2 / L at a Froude number of 0.2.
    FORCE_GUESS: f64 = 0.01, CUSTOM;
    /// The unknown force of a second start, as a share of that guess: with a large force the filter follows the recordings whatever the model, and
    /// with a small one the model has to; each has an optimum of its own where the other may miss it.
    LITTLE_FORCE: f64 = 0.1, "a tanker of an outside simulator, sound: the first start ends 195 units of log-likelihood lower; starts with 0.1, 10, 100 and 1000 times the force end within 16 of each other";
    /// Prior standard deviation of the logarithm of a sensor noise's size: a factor of about 4.
    NOISE_SIZE_SPREAD: f64 = 1.4, SEEDS;
    /// Prior standard deviation of the logarithm of a white noise below its first guess: a smoothed sensor is not exact.
    NOISE_WHITE_SPREAD: f64 = 0.05, SEEDS;
    /// Prior standard deviation of the logarithm of a correlation time: a factor of about 2.
    NOISE_TIME_SPREAD: f64 = 0.7, SEEDS;
    /// Prior standard deviation of the logarithm of the unknown force's size: a factor of about 12.
    NOISE_FORCE_SPREAD: f64 = 2.5, SEEDS;
    /// Runs that each thread passes over before what they gave is added up.
    TOGETHER: usize = 8, COST;
}
