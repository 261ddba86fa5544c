//! 95 % intervals of the measures of a trial, from the covariance of the model's parameters: the trial is sailed with drawn parameters.
//! What the data say is in the covariance; nothing is estimated here.

use super::measures::Measured;
use super::trial::{Ended, Intervals, Trial};
use crate::model::Model;
use crate::statistics::quantile;
use crate::uncertainty::Uncertainty;
use rayon::prelude::*;

/// Draws of a covariance.
pub const DRAWS: usize = 400;
/// Seed of the draws.
pub const SEED: u64 = 1;
/// Share of the draws that must reach a measure, so that it has an interval.
const REACHED: f64 = 0.95;

/// Parameter vectors drawn around the values of a model, each inside the bounds of its parameters. Equal seeds give equal draws.
///
/// A parameter that a bound of zero keeps positive or negative, and whose standard deviation is at most its size, is drawn by its logarithm,
/// `p exp(step / p)`, which is `p + step` for small steps. Forces are products of such parameters, and recordings that determine a
/// product leave its factors uncertain with opposite signs: `(1 + a)(1 - a)` is always below one, and circles were too wide, where
/// `exp(a) exp(-a)` is one.
pub fn drawn(model: &Model, uncertainty: &Uncertainty, count: usize, seed: u64) -> Vec<Vec<f64>> {
    let places: Vec<Option<usize>> = uncertainty.parameters.iter().map(|name| model.index(name)).collect();
    let vector = |deviation: Vec<f64>| {
        let mut theta = model.values();
        let steps = places.iter().zip(deviation).enumerate();
        for (i, step, sd) in steps.filter_map(|(k, (i, step))| Some(((*i)?, step, uncertainty.matrix[k][k].sqrt()))) {
            let p = &model.parameters[i];
            let one_sided = (p.lower == 0.0 && p.value > 0.0) || (p.upper == 0.0 && p.value < 0.0);
            let moved =
                if one_sided && sd <= p.value.abs() { p.value * (step / p.value).exp() } else { p.value + step };
            // An estimate at its bound, or beyond one that was set later, stays where it is.
            theta[i] = moved.clamp(p.lower.min(p.value), p.upper.max(p.value));
        }
        theta
    };
    uncertainty.deviations(count, seed).into_iter().map(vector).collect()
}

/// Sets the intervals of trials from the same trials with drawn parameters: the 2.5 % and 97.5 % quantiles. `sail` makes the trials for a
/// parameter vector, in the same order, or none where it has no approach.
///
/// A measure that fewer than 95 % of the draws reach gets no interval.
pub fn set_intervals<M: Measured + Send>(
    trials: &mut [Trial<M>],
    draws: &[Vec<f64>],
    sail: impl Fn(&[f64]) -> Option<Vec<Trial<M>>> + Sync,
) {
    let sailed: Vec<Vec<Vec<Option<f64>>>> = draws
        .par_iter()
        .map(|theta| {
            let trials = sail(theta).unwrap_or_default();
            let sound = |t: &Trial<M>| !matches!(t.ended, Ended::Diverged { .. });
            let read = |t: &Trial<M>| M::QUANTITIES.iter().map(|(_, q)| q(&t.measures).filter(|_| sound(t))).collect();
            trials.iter().map(read).collect()
        })
        .collect();
    for (k, trial) in trials.iter_mut().enumerate() {
        let mut intervals = Intervals::new();
        for (q, (name, read)) in M::QUANTITIES.iter().enumerate() {
            let mut values: Vec<f64> =
                sailed.iter().filter_map(|draw| draw.get(k)?[q]).filter(|x: &f64| x.is_finite()).collect();
            let enough = values.len() as f64 >= REACHED * draws.len() as f64 && values.len() > 1;
            values.sort_by(f64::total_cmp);
            let ends = quantile(&values, 0.025).zip(quantile(&values, 0.975));
            if let (true, Some(_), Some((low, high))) = (enough, read(&trial.measures), ends) {
                intervals.insert(name, [low, high]);
            }
        }
        trial.intervals = intervals;
    }
}
