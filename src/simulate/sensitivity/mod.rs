//! Exact derivatives of a simulation by parameters of its model: a local Jacobian by state, the parameters' own part in the
//! accelerations, and the chain of both through every step. It uses no cost and no measurement noise.

pub mod chain;
pub mod columns;
pub mod local;
pub mod products;

pub use chain::Sensitivity;
pub use columns::{Column, Columns};
pub use local::{Local, Plain};
pub use products::Products;
