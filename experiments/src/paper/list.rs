//! Every table and figure, in the order of the paper.
//! It makes none.

use super::artefact::Artefact;
use super::gradient;
use super::pictures::{curves, distributions, limits, performance, scenarios, table1, table2};

/// Every table and figure.
pub static ARTEFACTS: [&Artefact; 9] = [
    &table1::TABLE1,
    &table2::TABLE2,
    &performance::PERFORMANCE,
    &curves::CURVES,
    &scenarios::SCENARIOS,
    &distributions::DISTRIBUTIONS,
    &limits::LIMITS,
    &gradient::report::GRADIENT,
    &gradient::benchmark::BENCHMARK,
];
