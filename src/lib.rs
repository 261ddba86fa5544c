//! Automatic differentiation for ship dynamics: fit an interpretable manoeuvring model to recordings of a ship, and find
//! the physics it lacks.

pub mod fit;
pub mod state;
