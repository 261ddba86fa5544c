//! The campaign of concealed cases: which cases there are, the summary of their scores against the aims, and its figure.
//! Cases are made, diagnosed and judged elsewhere.

pub mod arms;
pub mod calibration;
pub mod figure;
pub mod plan;
pub mod rows;
pub mod summary;
