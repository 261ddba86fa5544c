//! Wind, waves, current, bottom and banks.

pub mod bank;
pub mod current;
pub mod earth_force;
pub mod mean_wind;
pub mod shallow;
pub mod tide;
pub mod wave_drift;
pub mod waves;
pub mod wind;
