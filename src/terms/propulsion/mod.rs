//! Propellers, engines and named actuators, and the inflow to propeller and rudder.

pub mod actuator;
pub mod engine_lag;
pub mod flow;
pub mod mmg_wake;
pub mod propeller;
pub mod propeller_walk;
pub mod rate_gain;
pub(in crate::terms) mod screw;
pub mod thrust_loss;
pub mod wake_drift;
