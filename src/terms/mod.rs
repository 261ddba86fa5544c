//! The catalogue of terms: each physical effect, actuator defect or sensor defect is one file here and two lines below.
//! A term computes; its description (equation, source, parameters) is data in its `TermInfo`.
//!
//! # Adding a term
//! Write `src/terms/my_effect.rs` with a unit struct that implements [`Term`](crate::physics::Term) and [`Physics`](crate::physics::Physics), add `mod my_effect;` and
//! `&my_effect::MyEffect` below. The registry, `trimtab terms`, bounds, priors, the diagnosis and the catalogue tests
//! read it from there.

use crate::physics::{AnyTerm, Catalogue};
use std::sync::LazyLock;

pub mod actuator;
pub mod antenna;
pub mod asymmetric;
pub mod bank;
pub mod crossflow;
pub mod current;
pub mod earth_force;
pub mod engine_lag;
pub mod flow;
pub mod fouling;
pub mod general_hull;
pub mod heading_bias;
pub mod hull;
pub mod hull_nonlinear;
pub mod loading;
pub mod log_scale;
pub mod mean_wind;
pub mod mmg_hull;
pub mod mmg_rudder;
pub mod mmg_wake;
pub mod munk;
pub mod position_lever;
pub mod propeller;
pub mod propeller_walk;
pub mod push;
pub mod race;
pub mod rate_gain;
pub mod resistance;
pub mod roll;
pub mod rudder;
pub mod rudder_gain;
pub mod rudder_lag;
pub mod rudder_offset;
pub mod rudder_rate;
pub mod rudder_stall;
pub mod shallow;
pub mod size;
pub mod sternway;
pub mod sway_log_bias;
pub mod symmetric;
pub mod thrust_loss;
pub mod thruster;
pub mod tide;
pub mod time_skew;
pub mod wake_drift;
pub mod water_log;
pub mod wave_drift;
pub mod waves;
pub mod wind;
pub mod yaw_rate_bias;

/// Every term, in the order in which they are listed and added up.
pub static CATALOGUE: &[&dyn AnyTerm] = &[
    &flow::FlowTerm,
    &hull::Hull,
    &resistance::Resistance,
    &propeller::Propeller,
    &rudder::Rudder,
    &mmg_hull::MmgHull,
    &mmg_wake::MmgWake,
    &mmg_rudder::MmgRudder,
    &general_hull::GeneralHull,
    &current::Current,
    &tide::Tide,
    &wind::Wind,
    &mean_wind::MeanWind,
    &waves::Waves,
    &wave_drift::WaveDrift,
    &earth_force::EarthForce,
    &shallow::Shallow,
    &bank::Bank,
    &propeller_walk::PropellerWalk,
    &wake_drift::WakeDrift,
    &thrust_loss::ThrustLoss,
    &rate_gain::RateGain,
    &engine_lag::EngineLag,
    &race::Race,
    &rudder_gain::RudderGain,
    &rudder_offset::RudderOffset,
    &rudder_lag::RudderLag,
    &rudder_rate::RudderRate,
    &rudder_stall::RudderStall,
    &crossflow::Crossflow,
    &hull_nonlinear::HullNonlinear,
    &sternway::Sternway,
    &munk::Munk,
    &loading::Loading,
    &fouling::Fouling,
    &roll::Roll,
    &thruster::Thruster,
    &push::Push,
    &symmetric::Symmetric,
    &asymmetric::Asymmetric,
    &heading_bias::HeadingBias,
    &yaw_rate_bias::YawRateBias,
    &log_scale::LogScale,
    &sway_log_bias::SwayLogBias,
    &antenna::Antenna,
    &position_lever::PositionLever,
    &time_skew::TimeSkew,
    &water_log::WaterLog,
];

/// The project's own terms as a [`Catalogue`].
pub fn standard() -> &'static Catalogue {
    static STANDARD: LazyLock<Catalogue> = LazyLock::new(|| Catalogue::new(CATALOGUE));
    &STANDARD
}

/// The project's own term of that name.
pub fn find(name: &str) -> Option<&'static dyn AnyTerm> {
    standard().find(name)
}
