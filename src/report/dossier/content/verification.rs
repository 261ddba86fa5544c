//! Verification on a study's own model and inputs: step size and derivatives, beside the checks of symmetry and conservation.
//! A check compares a number with a limit that is stated beside it; whether the model is right is the validation's question.

use super::check::{Bound, Check, apart};
use super::conservation::conservation;
use super::symmetry::symmetry;
use crate::evaluate::{Judging, outcome, predict};
use crate::fit::{Cost, Derivatives, FitSettings};
use crate::model::Model;
use crate::recording::{Run, Split};
use crate::simulate::{Integration, MOST_SUBSTEPS, Method, Trajectory};
use crate::statistics::mean;
use rayon::prelude::*;
use serde::Serialize;

/// The checks, and those that could not be made.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Verification {
    /// The checks.
    pub checks: Vec<Check>,
    /// Checks that could not be made, with the reason.
    pub missing: Vec<String>,
}

/// Most runs that a check simulates; the first ones of a study.
pub(super) const MOST_RUNS: usize = 50;

impl Verification {
    /// All checks of a model on the runs of a study.
    pub(super) fn new(model: &Model, runs: &[Run], fit: &FitSettings, judging: &Judging) -> Self {
        let side = |split| runs.iter().filter(|r| r.split == split).take(MOST_RUNS).cloned().collect::<Vec<Run>>();
        let (train, test) = (side(Split::Train), side(Split::Test));
        let simulated = if test.is_empty() { &train } else { &test };
        let mut all = Self::default();
        let parts = [
            steps(model, simulated, judging),
            derivatives(model, if train.is_empty() { &test } else { &train }, fit),
            symmetry(model, simulated, judging),
            conservation(model, simulated),
        ];
        for part in parts {
            match part {
                Ok(checks) => all.checks.extend(checks),
                Err(why) => all.missing.push(why),
            }
        }
        all
    }
}

/// Share of the error against recordings that the step may add.
const STEP_SHARE: f64 = 0.1;
/// Difference \[%\] below which successive refinements differ by rounding alone.
const ROUNDING: f64 = 1e-9;

/// The error of the step against a fine one, and the order with which the error falls as the step is halved.
fn steps(model: &Model, runs: &[Run], judging: &Judging) -> Result<Vec<Check>, String> {
    let used = judging.integration;
    let times = |k: usize| Integration { substeps: (used.substeps.max(1) * k).min(MOST_SUBSTEPS), ..used };
    let fine = Integration { method: Method::Rk4, substeps: (used.substeps.max(1) * 4).clamp(8, MOST_SUBSTEPS) };
    let of = |run: &Run| {
        let [one, two, four, fine] = [used, times(2), times(4), fine].map(|i| predict(model, run, i));
        let apart = |a: &Trajectory, b: &Trajectory| apart(run, model, a, b, judging.max_yaw_rate);
        let error = outcome(run, &one, &model.ship, judging.max_yaw_rate).deviation()?.cvdm;
        Some([apart(&one, &fine)?, apart(&one, &two)?, apart(&two, &four)?, error])
    };
    let numbers: Vec<[f64; 4]> = runs.par_iter().map(of).collect::<Vec<_>>().into_iter().flatten().collect();
    let column = |i: usize| mean(numbers.iter().map(|n| n[i]));
    let (Some(step), Some(first), Some(second), Some(error)) = (column(0), column(1), column(2), column(3)) else {
        return Err("step size: no run is simulated to its end at every step".into());
    };
    let method = match used.method {
        Method::Euler => "explicit Euler",
        Method::Rk4 => "Runge-Kutta of order 4",
    };
    let what = format!(
        "mean difference (cVDM) of simulations with the study's step ({method}, {} in a sample period) from a fine step (Runge-Kutta of \
         order 4, {} in a sample period); limit: a tenth of the mean cVDM against the recordings",
        used.substeps, fine.substeps
    );
    let mut checks = vec![Check::most("step", what, step, "%", STEP_SHARE * error, numbers.len())];
    if first > ROUNDING && second > ROUNDING {
        let limit = if used.method == Method::Euler { 0.7 } else { 2.0 };
        let what = "order of convergence: binary logarithm of the ratio of differences as the step is halved once and once more; limit: \
                    near 1 for Euler, above 2 for Runge-Kutta, whose order 4 supposes forces that are smooth where drift changes sign";
        let number = (first / second).log2();
        let (at, passed) = (Bound::Least, number >= limit);
        checks.push(Check {
            key: "order",
            what: what.into(),
            number,
            unit: "-",
            at,
            limit,
            passed,
            runs: numbers.len(),
        });
    }
    Ok(checks)
}

/// Steps of central differences, in scales of the parameters.
const DIFFERENCES: [f64; 3] = [1e-4, 1e-5, 1e-6];

/// The gradient of the fit's cost against central differences, and against the dual numbers of another crate.
fn derivatives(model: &Model, runs: &[Run], fit: &FitSettings) -> Result<Vec<Check>, String> {
    let free = model.free();
    if free.is_empty() {
        return Err("derivatives: the model has no free parameter, so that there is no derivative to check".into());
    }
    let failed = |e: crate::fit::FitError| format!("derivatives: {e}");
    let diverged = || "derivatives: a simulation diverges, so that the cost has no derivative".to_owned();
    let cost = |derivatives| {
        let options = crate::fit::CostOptions { derivatives, ..fit.cost_options() };
        Cost::new(model, runs, options).map_err(failed)
    };
    let p: Vec<f64> = free.iter().map(|i| model.parameters[*i].value).collect();
    let exact = cost(Derivatives::Lanes)?;
    let at = exact.quadratic(&p).ok_or_else(diverged)?;
    let other = cost(Derivatives::NumDual)?.with_gradient(&p).ok_or_else(diverged)?;
    // The largest slope that residuals of this size allow: no slope is small by accident, as at the minimum of a fit.
    let largest = |i: usize| (2.0 * at.gauss_newton[(i, i)] * at.value).sqrt();
    let difference = |i: usize| {
        let scale = model.parameters[free[i]].scale;
        let slope = |step: f64| {
            let moved = |sign: f64| {
                let mut q = p.clone();
                q[i] += sign * step * scale;
                exact.value(&q)
            };
            Some((moved(1.0)? - moved(-1.0)?) / (2.0 * step * scale))
        };
        let errors = DIFFERENCES.iter().filter_map(|step| Some((slope(*step)? - at.gradient[i]).abs()));
        errors.reduce(f64::min)
    };
    let acting: Vec<usize> = (0..p.len()).filter(|i| largest(*i) > 0.0).collect();
    let central = acting.iter().filter_map(|i| Some(difference(*i)? / largest(*i))).fold(0.0, f64::max);
    let dual = acting.iter().map(|i| (other.gradient[*i] - at.gradient[*i]).abs() / largest(*i)).fold(0.0, f64::max);
    let of = format!(
        "of the fit's cost by its {} free parameters, as a share of the largest slope that residuals of this size allow",
        p.len()
    );
    let central_words =
        format!("largest difference between exact and central-difference derivatives {of} (best of three steps)");
    let dual_words =
        format!("largest difference between the derivatives of two programs (own dual numbers and num-dual) {of}");
    Ok(vec![
        Check::most("central_differences", central_words, central, "-", 1e-6, runs.len()),
        Check::most("num_dual", dual_words, dual, "-", 1e-9, runs.len()),
    ])
}
