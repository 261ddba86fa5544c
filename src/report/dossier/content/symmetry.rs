//! Symmetry of a model on a study's own inputs: the mirrored ship sails the mirrored track, and a turned one the turned track.
//! What is mirrored and turned is defined where diagnoses are repeated, in [`crate::diagnose::stability`].

use super::check::{Check, apart};
use crate::diagnose::proof::stability::CHANGES;
use crate::evaluate::{Judging, predict};
use crate::model::Model;
use crate::recording::{Run, measured, or_nan};
use crate::simulate::Trajectory;
use rayon::prelude::*;

/// Largest difference allowed \[%\]: rounding, grown along a run.
const LARGEST: f64 = 1e-6;

/// The two symmetries.
pub(super) fn symmetry(model: &Model, runs: &[Run], judging: &Judging) -> Result<Vec<Check>, String> {
    let names = [
        (
            "mirrored",
            "mirror",
            "mirror symmetry: largest difference (cVDM) between the simulation of the mirrored ship under mirrored \
                                inputs and the mirrored simulation",
        ),
        (
            "turned by 90 deg",
            "turn",
            "frame: largest difference (cVDM) between the simulation with every direction on the earth turned by \
                                      90 deg and the turned simulation",
        ),
    ];
    names.iter().map(|(name, key, what)| changed(model, runs, judging, name, key, what)).collect()
}

fn changed(
    model: &Model,
    runs: &[Run],
    judging: &Judging,
    name: &str,
    key: &'static str,
    what: &str,
) -> Result<Check, String> {
    let change = CHANGES.iter().find(|c| c.name == name).ok_or_else(|| format!("{key}: no such change"))?;
    let other = (change.model)(model);
    let of = |run: &Run| {
        let own = predict(model, run, judging.integration);
        if own.diverged_at.is_some() {
            return None;
        }
        let simulated = Run { measured: measured(&own.states), ..run.clone() };
        let (images, expected) = ((change.run)(run, &model.ship), (change.run)(&simulated, &model.ship));
        let ([image], [expected]) = (images.as_slice(), expected.as_slice()) else {
            return None;
        };
        let states = expected.measured.iter().map(or_nan).collect();
        let expected = Trajectory { dt: run.dt, states, diverged_at: None };
        apart(image, &other, &predict(&other, image, judging.integration), &expected, judging.max_yaw_rate)
    };
    let numbers: Vec<f64> = runs.par_iter().map(of).collect::<Vec<_>>().into_iter().flatten().collect();
    let largest = numbers.iter().copied().reduce(f64::max);
    let largest = largest.ok_or_else(|| format!("{key}: no run is simulated to its end"))?;
    Ok(Check::most(key, what.to_owned(), largest, "%", LARGEST, numbers.len()))
}
