//! Exact gradients against finite differences: accuracy over the step, cost of a gradient, and the course of a fit with either.
//! Measuring and reporting are apart; the timings of the project's own speed are in `benches`, not here.

pub mod measure;
pub mod report;
