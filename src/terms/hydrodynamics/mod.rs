//! What the water does to the hull: hull forms, resistance, mass, and what may be wrong with them.

pub mod crossflow;
pub mod fouling;
pub mod general_hull;
pub mod hull;
pub mod hull_nonlinear;
pub mod loading;
pub mod mmg_hull;
pub mod munk;
pub mod resistance;
pub mod roll;
pub mod sternway;
pub mod symmetric;
