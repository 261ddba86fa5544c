//! Why a trial could not be simulated.
//! A trial that ends early is no error; see `trial`.

use crate::ranges::OutOfRange;

/// Why a trial could not be simulated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ManeuverError {
    /// A setting with a value that cannot be used.
    #[error("[maneuver] {0}")]
    Setting(#[from] OutOfRange),
    /// The trial is steered by a rudder and driven by a propeller, and the craft has one of them at most.
    #[error(
        "the ship file has no {missing} that trials can be sailed with: `[propeller]` or an actuator of law `propeller` or `thruster` along the keel, and `[rudder]` or aft of midship a `foil` or a thruster that turns; `trimtab simulate` sails recorded orders of other actuators"
    )]
    NoDrive {
        /// What there is not: `propeller`, `rudder`, or both.
        missing: &'static str,
    },
    /// No propeller rate holds the approach speed.
    #[error(
        "no propeller rate up to {limit:.2} rps holds the approach speed of {speed:.3} m/s on a straight course; set a lower `speed`, or `speed` and `n` together to approach without balance"
    )]
    NoRate {
        /// Approach speed \[m/s\].
        speed: f64,
        /// Largest rate tried \[rps\].
        limit: f64,
    },
    /// No speed is held by the approach propeller rate.
    #[error(
        "the propeller rate {n:.3} rps holds no speed ahead on a straight course; give a rate ahead (positive), or `speed` and `n` together to approach without balance"
    )]
    NoSpeed {
        /// Propeller rate \[rps\].
        n: f64,
    },
}
