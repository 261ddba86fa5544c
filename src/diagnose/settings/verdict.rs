//! The numbers with which tests are compared, each with its name, value, meaning, and how it was set.
//! The numbers by which tests and estimates are made are in another file.

use crate::likelihood::settings::{CUSTOM, Number, SEEDS, numbers};

/// p-value below which port and starboard of the ship itself are said to differ: the level at which a diagnosis names anything (`alpha`).
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
    /// Share from which on what is either so or not, as two actuators that are swapped, is so.
    WHOLE_SHARE: f64 = 0.5, "nearer to so than to not so; not tuned";
    /// Likeness of two mechanisms from which on they are refitted and compared.
    LIKENESS: f64 = 0.3, SEEDS;
    /// Log-likelihood that a further parameter must bring.
    PARAMETER_PRICE: f64 = 2.0, "twice the price in the information criterion of Akaike";
    /// Mechanisms closer than this in log-likelihood cannot be distinguished.
    INDISTINGUISHABLE: f64 = 3.0, "a likelihood ratio of 20";
    /// That difference as a share of the gain of a force or of the ship's own physics, whose law is known only so well.
    FORM_TOLERANCE: f64 = 0.1, SEEDS;
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
