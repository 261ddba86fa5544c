//! How a sensor reports what is.

pub mod antenna;
pub mod compass_deviation;
pub mod heading_bias;
pub mod log_scale;
pub mod position_lever;
pub mod sway_log_bias;
pub mod time_skew;
pub mod water_log;
pub mod yaw_rate_bias;
