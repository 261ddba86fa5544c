//! The numbers by which tests and estimates are made, each with its name, value, meaning, and how it was set.
//! The numbers with which tests are compared are in another file.

use crate::likelihood::settings::{COST, CUSTOM, Effort, HULLS, Number, SEEDS, numbers};

/// No step from where a model stands: its value alone.
pub const AS_IT_IS: Effort = Effort { rounds: 0, noise_rounds: 0, noise_iterations: 0 };
/// Ship and noise beside the error of a sensor that is fixed.
pub const TOGETHER_EFFORT: Effort = Effort { rounds: 8, noise_rounds: 3, noise_iterations: 6 };
/// The start of a model that is given its mechanisms: parameters and noise are estimated again with them.
pub const GIVEN_START: Effort = Effort { rounds: 3, noise_rounds: 2, noise_iterations: 6 };
/// The one fit of a model that is given its mechanisms.
pub const GIVEN_FINISH: Effort = Effort { rounds: 8, noise_rounds: 2, noise_iterations: 6 };

/// Shares of the amplitudes of a score test at which a refit may start, the other parameters moved along.
pub const STARTS: [f64; 3] = [1.0, 0.3, 0.1];
/// Multiples at which the refit of an effect that grows with the square of its amplitude may start, the others fixed.
pub const STARTS_OF_SQUARES: [f64; 3] = [3.0, 10.0, 30.0];

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
    /// Standard deviations of its prior from which on a mechanism's own coefficient is reported as unusual.
    UNUSUAL: f64 = 2.0, "one normal value in twenty is further off; no verdict turns on it";
    /// The same from which on a coefficient of the hull is said to stand in for something else.
    BENT: f64 = 8.0, "on sound logs of three outsiders' ships the furthest is 3 to 6.2 off, with a diameter 30 % off 11; no verdict turns on it";
    /// Prior standard deviation of a sensor's error, in units of the parameter's scale.
    SENSOR_SPREAD: f64 = 10.0, "wider than any error that a user would not see; not varied";
    /// Length of the stretches over which the sensors are compared with each other, in ship lengths.
    STRETCH: f64 = 0.5, "chosen with the method, before any case, and not varied";
    /// Stretches in a row, in a block that counts as one in the scatter of the kinematic consistency of sensors.
    STRETCHES: usize = 10, "five ship lengths, more than a turn takes; chosen before any case, and not varied";
    /// Forces are compared with those of the base's asymmetric parameters at every so many samples.
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
    /// Superfluous monomials that a law for what is not in the catalogue may have on average.
    LAW_P: f64 = 0.05, "one law in twenty; simulated nulls have fewer";
}
