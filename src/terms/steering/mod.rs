//! Rudders and their gear.

pub(in crate::terms) mod foil;
pub mod mmg_rudder;
pub mod race;
pub mod rudder;
pub mod rudder_gain;
pub mod rudder_lag;
pub mod rudder_late;
pub mod rudder_limit;
pub mod rudder_offset;
pub mod rudder_rate;
pub mod rudder_stall;
