//! Exact gradients against finite differences: accuracy over the step, cost of a gradient, the course of a fit with either, and fits from
//! many starts. The timings of the project's own speed are in `benches`, not here.

pub mod benchmark;
pub mod measure;
pub mod report;
