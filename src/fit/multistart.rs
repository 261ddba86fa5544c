//! The same fit from many starts, to see whether there is more than one place to end.
//! It keeps every outcome, good or bad, and picks none.

use super::error::FitError;
use super::settings::FitSettings;
use super::summary::{Fit, fit};
use crate::model::Model;
use crate::recording::Run;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

/// Starts drawn uniformly from a box around the model's values.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct MultiStart {
    /// Number of starts.
    pub count: usize,
    /// Half-width of the box as a share of each value; a value of 0 takes its scale instead.
    pub spread: f64,
    /// Seed of the draw.
    pub seed: u64,
}

impl Default for MultiStart {
    fn default() -> Self {
        Self { count: 20, spread: 0.5, seed: 1 }
    }
}

/// How one start ended.
#[derive(Debug)]
pub struct StartOutcome {
    /// Values of the free parameters at the start.
    pub start: Vec<f64>,
    /// The fit, or why there is none.
    pub outcome: Result<Fit, FitError>,
}

/// Fits from each start in turn, in an order and from values that depend on the seed alone.
pub fn multi_start(
    model: &Model,
    runs: &[Run],
    settings: &FitSettings,
    starts: &MultiStart,
    mut progress: impl FnMut(usize),
) -> Vec<StartOutcome> {
    let mut random = ChaCha8Rng::seed_from_u64(starts.seed);
    let free = model.free();
    let mut outcomes = Vec::with_capacity(starts.count);
    for count in 0..starts.count {
        progress(count);
        let mut from = model.clone();
        for i in &free {
            let parameter = &mut from.parameters[*i];
            let size = if parameter.value == 0.0 { parameter.scale } else { parameter.value.abs() };
            let moved = parameter.value + starts.spread * size * random.random_range(-1.0..=1.0);
            parameter.value = moved.max(parameter.lower).min(parameter.upper);
        }
        let start = free.iter().map(|i| from.parameters[*i].value).collect();
        outcomes.push(StartOutcome { start, outcome: fit(&from, runs, settings, &mut |_| true) });
    }
    outcomes
}
