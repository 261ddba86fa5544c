//! The standard manoeuvring trials (turning circle, zigzag, crash stop, pull-out, spiral) with any model, and their measures read from a track.
//! It neither fits nor judges a model: a poor model gives poor numbers, and only the IMO criteria are compared with them.

mod approach;
mod calm;
mod error;
mod found;
pub mod imo;
mod interval;
mod measured;
mod measures;
mod nomoto;
mod recorded;
mod sail;
mod track;
mod trial;
mod trials;

pub use approach::{Approach, ManeuverSettings, Recorded, Source};
pub use calm::{calm_water, calm_water_of_depth};
pub use error::ManeuverError;
pub use found::{Found, Kind, PassedOver, approach_speed, find};
pub use interval::{
    DRAWS, Drawn, Known, SEED, drawn, drawn_able, drawn_from, of_priors, set_intervals, set_intervals_from,
};
pub use measured::{MeasuredTrial, Measures, Simulated, Taken, measured};
pub use measures::{Measured, PullOut, Quantity, Spiral, Steady, Stopping, Turning, Zigzag};
pub use nomoto::Nomoto;
pub use track::Track;
pub use trial::{Ended, Intervals, Side, Trial};
pub use trials::pullout::{course_stable, is_stability_open, pull_out, pull_out_trial};
pub use trials::spiral::{spiral, spiral_angles, spiral_trial};
pub use trials::stopping::{stopping, stopping_trial};
pub use trials::turning::{turning, turning_execute, turning_trial};
pub use trials::zigzag::{zigzag, zigzag_executes, zigzag_trial};

#[cfg(test)]
mod tests;
