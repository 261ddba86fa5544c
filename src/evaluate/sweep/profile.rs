//! Profiles of the likelihood: one parameter, or two, fixed at values around the estimate, the others fitted again.
//! Which parameters are asked about is the caller's choice.

use crate::fit::{Fit, fit};
use crate::model::Model;
use crate::recording::Run;
use crate::statistics::student_quantile;
use serde::Serialize;

/// How profiles are taken.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SweepSettings {
    /// Values on each side of the estimate, 2 to 50.
    pub points: usize,
    /// Distance of the outermost values from the estimate, in standard errors, above 0.
    pub span: f64,
}

impl Default for SweepSettings {
    fn default() -> Self {
        Self { points: 4, span: 3.0 }
    }
}

/// A value of a profile.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Point {
    /// Value of the parameter \[its unit\].
    pub value: f64,
    /// Twice the fall of the log-likelihood below the fit; absent where no fit was found.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fall: Option<f64>,
}

/// The profile of a parameter.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Profile {
    /// Dotted name.
    pub parameter: String,
    /// Unit.
    pub unit: &'static str,
    /// Estimate.
    pub estimate: f64,
    /// Its standard error in the fit.
    pub standard_error: f64,
    /// The profile, by rising value; the estimate among them.
    pub points: Vec<Point>,
    /// Ends of the 95 % interval; an end that lies beyond the values tried is absent.
    pub interval: [Option<f64>; 2],
    /// Whether some value is more likely than the fit: the fit had not found the best point.
    pub better_elsewhere: bool,
}

/// Twice the fall of the log-likelihood over two parameters.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Pair {
    /// Dotted names.
    pub parameters: [String; 2],
    /// Values of both.
    pub values: [Vec<f64>; 2],
    /// The fall: a row a value of the first, a column a value of the second; absent where no fit was found.
    pub fall: Vec<Vec<Option<f64>>>,
}

/// A fall below this is rounding of the solver, not a better point.
const ROUNDING: f64 = 0.01;

/// The model of a fit with some parameters fixed.
fn fixed(model: &Model, values: &[(usize, f64)]) -> Model {
    let mut out = model.clone();
    for (i, value) in values {
        out.parameters[*i].value = *value;
        out.parameters[*i].free = false;
    }
    out
}

/// Twice the fall of the log-likelihood with some parameters fixed, and the values of all at the least cost; `None` where the others
/// cannot be fitted.
fn fall(found: &Fit, start: &Model, runs: &[Run], values: &[(usize, f64)]) -> Option<(f64, Model)> {
    let model = fixed(start, values);
    let unit = found.residual_variance * found.design_effect.unwrap_or(1.0).max(1.0) / found.runs as f64;
    let least = found.cost + found.prior_cost;
    // With its only free parameter fixed there is nothing to fit, and the cost is what it is.
    let free = model.parameters.iter().any(|p| p.free);
    let (cost, model) = if free {
        let again = fit(&model, runs, &found.settings, &mut |_| true).ok()?;
        (again.cost + again.prior_cost, again.model)
    } else {
        (cost_of(&model, runs, found)?, model)
    };
    Some(((cost - least) / unit, model)).filter(|(fall, _)| fall.is_finite())
}

/// The cost and priors of a model as it is.
fn cost_of(model: &Model, runs: &[Run], found: &Fit) -> Option<f64> {
    // One parameter is free, and may not move: what a fit starts from is its cost.
    let mut still = model.clone();
    let first = still.parameters.iter_mut().find(|p| found.estimates.iter().any(|e| e.name == p.name))?;
    (first.free, first.lower, first.upper) = (true, first.value, first.value);
    let again = fit(&still, runs, &found.settings, &mut |_| false).ok()?;
    Some(again.start_cost + again.start_prior_cost)
}

/// Values on one side of an estimate, from the nearest outwards, inside the bounds.
fn side(settings: &SweepSettings, estimate: f64, error: f64, [lower, upper]: [f64; 2], sign: f64) -> Vec<f64> {
    let mut values: Vec<f64> = (1..=settings.points)
        .map(|i| estimate + sign * settings.span * error * i as f64 / settings.points as f64)
        .map(|v| v.clamp(lower.min(estimate), upper.max(estimate)))
        .collect();
    values.dedup();
    values.retain(|v| *v != estimate);
    values
}

/// Place, bounds, estimate and standard error of a parameter that the data determine.
fn known(found: &Fit, name: &str) -> Option<(usize, [f64; 2], f64, f64)> {
    let estimate = found.estimates.iter().find(|e| e.name == name)?;
    let i = found.model.index(name)?;
    let p = &found.model.parameters[i];
    let error = estimate.standard_error.filter(|e| *e > 0.0)?;
    Some((i, [p.lower, p.upper], estimate.value, error))
}

/// The profile of a parameter around a fit; `None` for one without a standard error, which a constraint fixes or the data do not
/// determine.
pub fn profile(found: &Fit, runs: &[Run], parameter: &str, settings: &SweepSettings) -> Option<Profile> {
    let (i, bounds, estimate, error) = known(found, parameter)?;
    // From the estimate outwards, each fit begins where the last one ended.
    let outwards = |sign: f64| {
        let mut start = found.model.clone();
        let step = |value: f64| {
            let reached = fall(found, &start, runs, &[(i, value)]);
            if let Some((_, model)) = &reached {
                start = model.clone();
                start.parameters[i].free = true;
            }
            Point { value, fall: reached.map(|(fall, _)| fall) }
        };
        side(settings, estimate, error, bounds, sign).into_iter().map(step).collect::<Vec<_>>()
    };
    let [below, above] = [-1.0, 1.0].map(outwards);
    let centre = Point { value: estimate, fall: Some(0.0) };
    let points: Vec<Point> = below.iter().rev().chain([&centre]).chain(&above).copied().collect();
    let limit = student_quantile(0.975, found.freedom.max(1) as f64).powi(2);
    let better_elsewhere = points.iter().any(|p| p.fall.is_some_and(|f| f < -ROUNDING));
    Some(Profile {
        parameter: parameter.to_owned(),
        unit: found.model.parameters[i].info.unit,
        estimate,
        standard_error: error,
        interval: [end(estimate, &below, limit), end(estimate, &above, limit)],
        points,
        better_elsewhere,
    })
}

/// Where a side of a profile crosses a limit, by the square root of the fall, which is straight for a quadratic cost; `None` where it
/// does not.
fn end(estimate: f64, side: &[Point], limit: f64) -> Option<f64> {
    let mut last = (estimate, 0.0_f64);
    for point in side {
        let root = point.fall?.max(0.0).sqrt();
        if root >= limit.sqrt() {
            let share = (limit.sqrt() - last.1) / (root - last.1);
            return Some(last.0 + share * (point.value - last.0));
        }
        last = (point.value, root);
    }
    None
}

/// The profile of two parameters; `None` where one has no standard error.
pub fn pair(found: &Fit, runs: &[Run], parameters: [&str; 2], settings: &SweepSettings) -> Option<Pair> {
    let [a, b] = parameters.map(|name| known(found, name));
    let (a, b) = (a?, b?);
    let values = [a, b].map(|(_, bounds, estimate, error)| {
        let mut all = side(settings, estimate, error, bounds, -1.0);
        all.reverse();
        all.push(estimate);
        all.extend(side(settings, estimate, error, bounds, 1.0));
        all
    });
    let row = |first: &f64| -> Vec<Option<f64>> {
        let at = |second: &f64| fall(found, &found.model, runs, &[(a.0, *first), (b.0, *second)]).map(|(fall, _)| fall);
        values[1].iter().map(at).collect()
    };
    let fall = values[0].iter().map(row).collect();
    Some(Pair { parameters: parameters.map(str::to_owned), values, fall })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_of_a_quadratic_profile_ends_where_the_fall_reaches_its_limit() {
        // Standard error 0.5 around 2: the fall is the square of the distance in standard errors.
        let point = |value: f64| Point { value, fall: Some(((value - 2.0) / 0.5).powi(2)) };
        let above: Vec<Point> = [2.4, 2.8, 3.2, 3.6].map(point).into();
        assert!((end(2.0, &above, 3.84).unwrap() - (2.0 + 0.5 * 3.84_f64.sqrt())).abs() < 1e-12);
        assert_eq!(end(2.0, &above[..2], 3.84), None);
        let lost = [Point { value: 2.4, fall: None }, point(3.6)];
        assert_eq!(end(2.0, &lost, 3.84), None);
    }

    #[test]
    fn values_stay_inside_the_bounds_and_go_outwards() {
        let settings = SweepSettings { points: 3, span: 3.0 };
        assert_eq!(side(&settings, 1.0, 0.5, [0.0, 9.0], -1.0), [0.5, 0.0]);
        assert_eq!(side(&settings, 1.0, 0.5, [0.0, 9.0], 1.0), [1.5, 2.0, 2.5]);
    }
}
