//! Numbers for physics that is written once and evaluated many ways.
//!
//! [`Scalar`] is the trait that dynamics are written against. It is implemented for `f64` (simulate), for [`Dual`] (value
//! and exact first derivatives in one pass) and for duals over duals (second derivatives). This crate knows no ship.

mod dual;
mod lanes;
mod num_dual;
mod scalar;
pub mod smooth;

pub use dual::Dual;
pub use lanes::{LaneMask, Lanes};
pub use scalar::Scalar;
