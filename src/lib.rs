//! Automatic differentiation for ship dynamics: fit an interpretable manoeuvring model to recordings of a ship, and find
//! the physics it lacks.

pub mod audit;
pub mod demo;
pub mod diagnose;
pub mod error;
pub mod evaluate;
pub mod fit;
pub mod maneuver;
pub mod model;
pub mod parameter;
pub mod physics;
pub mod recording;
pub mod report;
pub mod ship;
pub mod simulate;
pub mod state;
pub mod statistics;
pub mod study;
pub mod terms;
