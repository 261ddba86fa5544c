//! The catalogue of terms: each physical effect, actuator defect or sensor defect is one file in one of the folders, one line there and one below.
//! A term computes; its description (equation, source, parameters) is data in its `TermInfo`.
//!
//! # Adding a term
//! Write `src/terms/ROOM/my_effect.rs` with a unit struct that implements [`Term`](crate::physics::Term) and [`Physics`](crate::physics::Physics), add `pub mod my_effect;` to the `mod.rs` beside it and
//! `&ROOM::my_effect::MyEffect` below. The registry, `trimtab terms`, bounds, priors, the diagnosis and the catalogue tests
//! read it from there.

use crate::physics::{AnyTerm, Catalogue};
use std::sync::LazyLock;

pub mod environment;
pub mod external;
pub mod hydrodynamics;
pub mod propulsion;
pub mod sensors;
pub mod size;
pub mod steering;

/// Every term, in the order in which they are listed and added up.
pub static CATALOGUE: &[&dyn AnyTerm] = &[
    &propulsion::flow::FlowTerm,
    &hydrodynamics::hull::Hull,
    &hydrodynamics::resistance::Resistance,
    &propulsion::propeller::Propeller,
    &steering::rudder::Rudder,
    &hydrodynamics::mmg_hull::MmgHull,
    &propulsion::mmg_wake::MmgWake,
    &steering::mmg_rudder::MmgRudder,
    &hydrodynamics::general_hull::GeneralHull,
    &environment::current::Current,
    &environment::tide::Tide,
    &environment::wind::Wind,
    &environment::mean_wind::MeanWind,
    &environment::waves::Waves,
    &environment::wave_drift::WaveDrift,
    &environment::earth_force::EarthForce,
    &environment::shallow::Shallow,
    &environment::bank::Bank,
    &propulsion::propeller_walk::PropellerWalk,
    &propulsion::wake_drift::WakeDrift,
    &propulsion::thrust_loss::ThrustLoss,
    &propulsion::rate_gain::RateGain,
    &propulsion::engine_lag::EngineLag,
    &steering::race::Race,
    &steering::rudder_gain::RudderGain,
    &steering::rudder_offset::RudderOffset,
    &steering::rudder_limit::RudderLimit,
    &steering::rudder_lag::RudderLag,
    &steering::rudder_late::RudderLate,
    &steering::rudder_rate::RudderRate,
    &steering::rudder_stall::RudderStall,
    &hydrodynamics::crossflow::Crossflow,
    &hydrodynamics::hull_nonlinear::HullNonlinear,
    &hydrodynamics::sternway::Sternway,
    &hydrodynamics::munk::Munk,
    &hydrodynamics::loading::Loading,
    &hydrodynamics::fouling::Fouling,
    &hydrodynamics::roll::Roll,
    &external::thruster::Thruster,
    &external::push::Push,
    &hydrodynamics::symmetric::Symmetric,
    &external::asymmetric::Asymmetric,
    &sensors::heading_bias::HeadingBias,
    &sensors::compass_deviation::CompassDeviation,
    &sensors::yaw_rate_bias::YawRateBias,
    &sensors::log_scale::LogScale,
    &sensors::sway_log_bias::SwayLogBias,
    &sensors::antenna::Antenna,
    &sensors::position_lever::PositionLever,
    &sensors::time_skew::TimeSkew,
    &sensors::water_log::WaterLog,
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
