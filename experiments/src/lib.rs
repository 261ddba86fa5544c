//! What the experiments share: truth simulators with ships and data, the paper's evaluation, concealed cases, real recordings.
//! It is not part of the product: the library never sees it, and each table or figure is a binary of its own.

pub mod conceal;
pub mod demo;
pub mod paper;
pub mod real;
pub mod truth;
