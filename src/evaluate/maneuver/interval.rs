//! 95 % intervals of the measures of a trial, from the covariance of the model's parameters: the trial is sailed with drawn parameters.
//! What the data say is in the covariance, and where there is none the priors are; nothing is estimated here.

use super::measures::Measured;
use super::trial::{Ended, Intervals, Trial};
use crate::model::{Model, Parameter};
use crate::ship::COEFFICIENTS;
use crate::statistics::quantile;
use crate::uncertainty::Uncertainty;
use rayon::prelude::*;

/// Draws of a covariance; each is sailed twice.
pub const DRAWS: usize = 200;
/// Seed of the draws.
pub const SEED: u64 = 1;
/// Draws for each that is wanted, of which those that cannot sail are left out.
const TRIES: usize = 3;
/// Share of the draws that must reach a measure, so that it has an interval.
const REACHED: f64 = 0.95;
/// Share of a drawn deviation that is sailed, to either side of the estimate. A covariance is the inverse of the curvature of the cost at
/// the estimate: it is known for small steps alone, and whole ones leave the ships that the recordings allow (advance of 3.20 L, all
/// draws to one side of it: 3.19 to 3.49). A quarter is small, and large beside the rounding of a simulation.
const STEP: f64 = 0.25;

/// What deviations are drawn from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Known {
    /// The covariance of a fit, which is known for small steps alone: measures are moved to first order.
    ByFit,
    /// What is known before any data, over its whole spread: measures are read from the ships that are drawn.
    Before,
}

impl Known {
    /// Share of a drawn deviation that is sailed.
    fn step(self) -> f64 {
        match self {
            Self::ByFit => STEP,
            Self::Before => 1.0,
        }
    }
}

/// Two parameter vectors, a share of a drawn deviation beyond the values of a model and as much before them, each inside the bounds of
/// its parameters.
pub type Drawn = [Vec<f64>; 2];

/// `count` draws of the covariance of a model. Equal seeds give equal draws.
pub fn drawn(model: &Model, uncertainty: &Uncertainty, count: usize, seed: u64) -> Vec<Drawn> {
    drawn_from(Known::ByFit, model, uncertainty, count, seed)
}

/// As [`drawn`], from what is known by a fit or before it.
pub fn drawn_from(known: Known, model: &Model, uncertainty: &Uncertainty, count: usize, seed: u64) -> Vec<Drawn> {
    let places: Vec<Option<usize>> = uncertainty.parameters.iter().map(|name| model.index(name)).collect();
    // An estimate beyond a bound that was set later stays where it is.
    let limits = |place: usize| {
        let p = places[place].map(|i| &model.parameters[i]);
        p.map_or([f64::NEG_INFINITY, f64::INFINITY], |p| [(p.lower - p.value).min(0.0), (p.upper - p.value).max(0.0)])
    };
    let vector = |deviation: &[f64], share: f64| {
        let step: Vec<f64> = deviation.iter().map(|d| share * d).collect();
        let mut theta = model.values();
        for (i, step) in places.iter().zip(uncertainty.limited(&step, limits)).filter_map(|(i, d)| Some(((*i)?, d))) {
            theta[i] += step;
        }
        theta
    };
    let both = |d: Vec<f64>| [vector(&d, known.step()), vector(&d, -known.step())];
    uncertainty.deviations(count, seed).into_iter().map(both).collect()
}

/// So many pairs of draws of what is known before any data, each of a ship that `can` sail, and the share of all drawn ships that cannot: the
/// spreads of single coefficients, taken as independent, allow for resistances below zero, and no ship has one.
pub fn drawn_able(
    model: &Model,
    uncertainty: &Uncertainty,
    count: usize,
    seed: u64,
    can: impl Fn(&[f64]) -> bool + Sync,
) -> (Vec<Drawn>, f64) {
    let all: Vec<Vec<f64>> =
        drawn_from(Known::Before, model, uncertainty, TRIES * count, seed).into_iter().flatten().collect();
    let able: Vec<bool> = all.par_iter().map(|theta| can(theta)).collect();
    let unable = able.iter().filter(|a| !**a).count() as f64 / all.len().max(1) as f64;
    let mut ships = all.into_iter().zip(able).filter_map(|(theta, able)| able.then_some(theta));
    let pairs = std::iter::from_fn(|| Some([ships.next()?, ships.next()?]));
    (pairs.take(count).collect(), unable)
}

/// What is known of a model that was not fitted: the standard deviations of its priors, and those that the terms give for estimated
/// hull coefficients that no file gives, taken as independent; nothing where there are none.
pub fn of_priors(model: &Model) -> Option<Uncertainty> {
    let ship = &model.ship;
    let estimated = |name: &str| {
        let own = name.strip_prefix("hull.").filter(|own| COEFFICIENTS.iter().any(|(c, _)| c == own));
        own.is_some_and(|own| !ship.coefficients.contains_key(own) && !ship.coefficients_prime.contains_key(own))
    };
    let spread = |(i, p): (usize, &Parameter)| {
        let default = || {
            let prior = model.default_prior(i);
            // A value of the model file's own is no estimate of the ship's.
            (estimated(&p.name) && p.value == prior.mean).then_some(prior)
        };
        let sd = p.prior.or_else(default)?.sd;
        (sd.is_finite() && sd > 0.0).then(|| (p.name.clone(), sd))
    };
    let known: Vec<(String, f64)> = model.parameters.iter().enumerate().filter_map(spread).collect();
    Uncertainty::independent("spreads before any data, taken as independent", &known)
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
    set_intervals_from(Known::ByFit, trials, draws, sail);
}

/// As [`set_intervals`], from draws of what is known by a fit or, over its whole spread, before it: then the interval has the middle 95 %
/// of the measures of the drawn ships. A criterion of a measure that has no interval, since too few of these ships reach it, is open.
pub fn set_intervals_from<M: Measured + Send>(
    known: Known,
    trials: &mut [Trial<M>],
    draws: &[Drawn],
    sail: impl Fn(&[f64]) -> Option<Vec<Trial<M>>> + Sync,
) {
    if draws.is_empty() {
        return;
    }
    let measured = |theta: &Vec<f64>| -> Sailed {
        let trials = sail(theta).unwrap_or_default();
        let sound = |t: &Trial<M>| !matches!(t.ended, Ended::Diverged { .. });
        let read = |t: &Trial<M>| M::QUANTITIES.iter().map(|(_, q)| q(&t.measures).filter(|_| sound(t))).collect();
        trials.iter().map(read).collect()
    };
    let sailed: Vec<[Sailed; 2]> = draws.par_iter().map(|[more, less]| [measured(more), measured(less)]).collect();
    for (k, trial) in trials.iter_mut().enumerate() {
        let mut intervals = Intervals::new();
        for (q, (name, read)) in M::QUANTITIES.iter().enumerate() {
            let Some(value) = read(&trial.measures) else { continue };
            let interval = match known {
                Known::ByFit => to_first_order(&sailed, [k, q], value),
                Known::Before => middle_of(&sailed, [k, q], value),
            };
            intervals.extend(interval.map(|ends| (*name, ends)));
        }
        trial.intervals = intervals;
        judge(trial, known);
    }
}

/// Measures of the trials with one parameter vector, a list a trial.
type Sailed = Vec<Vec<Option<f64>>>;

/// The value, and to either side of it what 95 % of the draws move it by at most, to first order.
fn to_first_order(sailed: &[[Sailed; 2]], [trial, quantity]: [usize; 2], value: f64) -> Option<[f64; 2]> {
    let moved = |[more, less]: &[Sailed; 2]| {
        let difference = more.get(trial)?[quantity]? - less.get(trial)?[quantity]?;
        Some(difference.abs() / (2.0 * STEP)).filter(|x| x.is_finite())
    };
    let mut moves: Vec<f64> = sailed.iter().filter_map(moved).collect();
    moves.sort_by(f64::total_cmp);
    let enough = moves.len() as f64 >= REACHED * sailed.len() as f64 && moves.len() > 1;
    let half = quantile(&moves, 0.95).filter(|_| enough)?;
    Some([value - half, value + half])
}

/// The middle 95 % of what was sailed, and the value.
fn middle_of(sailed: &[[Sailed; 2]], [trial, quantity]: [usize; 2], value: f64) -> Option<[f64; 2]> {
    let read = |one: &Sailed| one.get(trial).and_then(|t| t[quantity]).filter(|x| x.is_finite());
    let mut all: Vec<f64> = sailed.iter().flatten().filter_map(read).collect();
    all.sort_by(f64::total_cmp);
    let enough = all.len() as f64 >= REACHED * 2.0 * sailed.len() as f64 && all.len() > 1;
    let [low, high] = [quantile(&all, 0.025).filter(|_| enough)?, quantile(&all, 0.975)?];
    Some([low.min(value), high.max(value)])
}

/// Says of each criterion of a trial whether its limit lies inside the interval of its measure.
fn judge<M: Measured>(trial: &mut Trial<M>, known: Known) {
    for criterion in &mut trial.criteria {
        let name = criterion.quantity();
        // The unit of a criterion is a multiple of that of the measure.
        let unit = criterion.measured.zip(trial.measures.quantity(&name)).map(|(judged, si)| judged / si);
        match (unit.filter(|u| u.is_finite()), trial.intervals.get(name.as_str())) {
            (Some(unit), Some(ends)) => criterion.set_interval(ends.map(|end| end * unit)),
            (Some(_), None) if known == Known::Before => criterion.leave_open(),
            _ => {}
        }
    }
}
