//! What the experiments share: the truth simulators, their ships and their data.
//! It is not part of the product: the library never sees it, and each table or figure is a binary of its own.

pub mod conceal;
pub mod demo;
pub mod real;
pub mod truth;
