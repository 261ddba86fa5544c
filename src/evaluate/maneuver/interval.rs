//! 95 % intervals of the measures of a trial, from the covariance of the model's parameters: the trial is sailed with drawn parameters.
//! What the data say is in the covariance; nothing is estimated here.

use super::measures::Measured;
use super::trial::{Ended, Intervals, Trial};
use crate::model::Model;
use crate::statistics::quantile;
use crate::uncertainty::Uncertainty;
use rayon::prelude::*;

/// Draws of a covariance; each is sailed twice.
pub const DRAWS: usize = 200;
/// Seed of the draws.
pub const SEED: u64 = 1;
/// Share of the draws that must reach a measure, so that it has an interval.
const REACHED: f64 = 0.95;
/// Share of a drawn deviation that is sailed, to either side of the estimate. A covariance is the inverse of the curvature of the cost at
/// the estimate: it is known for small steps alone, and whole ones leave the ships that the recordings allow (advance of 3.20 L, all
/// draws to one side of it: 3.19 to 3.49). A quarter is small, and the step of integration, by which an execute of a zigzag comes late,
/// adds 0.2 deg to an overshoot.
const STEP: f64 = 0.25;

/// Two parameter vectors, a quarter of a drawn deviation beyond the values of a model and as much before them, each inside the bounds of
/// its parameters.
pub type Drawn = [Vec<f64>; 2];

/// `count` draws of the covariance of a model. Equal seeds give equal draws.
pub fn drawn(model: &Model, uncertainty: &Uncertainty, count: usize, seed: u64) -> Vec<Drawn> {
    let places: Vec<Option<usize>> = uncertainty.parameters.iter().map(|name| model.index(name)).collect();
    let vector = |deviation: &[f64], share: f64| {
        let mut theta = model.values();
        for (i, deviation) in places.iter().zip(deviation).filter_map(|(i, d)| Some(((*i)?, d))) {
            let p = &model.parameters[i];
            // An estimate at its bound, or beyond one that was set later, stays where it is.
            theta[i] = (p.value + share * deviation).clamp(p.lower.min(p.value), p.upper.max(p.value));
        }
        theta
    };
    let both = |d: Vec<f64>| [vector(&d, STEP), vector(&d, -STEP)];
    uncertainty.deviations(count, seed).into_iter().map(both).collect()
}

/// Sets the intervals of trials from the same trials with drawn parameters: the value, and to either side of it what 95 % of the draws
/// move it by at most, to first order. `sail` makes the trials for a parameter vector, in the same order, or none where it has no approach.
///
/// A deviation d moves a measure m by (m(p + h d) - m(p - h d)) / 2h. What is even in d, such as the product of the errors of two
/// parameters of which the recordings determine the product alone, drops out: the interval has the value in its middle.
///
/// A measure that fewer than 95 % of the draws reach to both sides gets no interval.
pub fn set_intervals<M: Measured + Send>(
    trials: &mut [Trial<M>],
    draws: &[Drawn],
    sail: impl Fn(&[f64]) -> Option<Vec<Trial<M>>> + Sync,
) {
    let measured = |theta: &Vec<f64>| -> Vec<Vec<Option<f64>>> {
        let trials = sail(theta).unwrap_or_default();
        let sound = |t: &Trial<M>| !matches!(t.ended, Ended::Diverged { .. });
        let read = |t: &Trial<M>| M::QUANTITIES.iter().map(|(_, q)| q(&t.measures).filter(|_| sound(t))).collect();
        trials.iter().map(read).collect()
    };
    let sailed: Vec<[Vec<Vec<Option<f64>>>; 2]> =
        draws.par_iter().map(|[more, less]| [measured(more), measured(less)]).collect();
    for (k, trial) in trials.iter_mut().enumerate() {
        let mut intervals = Intervals::new();
        for (q, (name, read)) in M::QUANTITIES.iter().enumerate() {
            let moved = |[more, less]: &[Vec<Vec<Option<f64>>>; 2]| {
                let difference = more.get(k)?[q]? - less.get(k)?[q]?;
                Some(difference.abs() / (2.0 * STEP)).filter(|x| x.is_finite())
            };
            let mut moves: Vec<f64> = sailed.iter().filter_map(moved).collect();
            moves.sort_by(f64::total_cmp);
            let enough = moves.len() as f64 >= REACHED * draws.len() as f64 && moves.len() > 1;
            if let (true, Some(value), Some(half)) = (enough, read(&trial.measures), quantile(&moves, 0.95)) {
                intervals.insert(name, [value - half, value + half]);
            }
        }
        trial.intervals = intervals;
    }
}
