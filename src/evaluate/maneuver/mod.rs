//! The standard manoeuvring trials (turning circle, zigzag, crash stop) with any model, and their measures read from a track.
//! It neither fits nor judges a model: a poor model gives poor numbers, and only the IMO criteria are compared with them.

mod approach;
mod calm;
mod error;
pub mod imo;
mod interval;
mod measures;
mod recorded;
mod sail;
mod stopping;
mod track;
mod trial;
mod turning;
mod zigzag;

pub use approach::{Approach, ManeuverSettings, Source};
pub use calm::calm_water;
pub use error::ManeuverError;
pub use interval::{DRAWS, Drawn, Known, SEED, drawn, drawn_from, of_priors, set_intervals, set_intervals_from};
pub use measures::{Measured, Quantity, Steady, Stopping, Turning, Zigzag};
pub use recorded::{Recorded, recorded};
pub use stopping::{stopping, stopping_trial};
pub use track::Track;
pub use trial::{Ended, Intervals, Side, Trial};
pub use turning::{turning, turning_execute, turning_trial};
pub use zigzag::{zigzag, zigzag_executes, zigzag_trial};

#[cfg(test)]
mod tests;
