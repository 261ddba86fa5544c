//! The refit of an accepted model through Ipopt: weighted least squares on the filter's innovations with its gains held fixed,
//! inside the parameters' bounds. Gains and noise come from the estimate; which mechanisms are in it is decided elsewhere.
//!
//! With gains fixed, `sum e^2/s` is a smooth function of the parameters, its gradient is exactly the score of an exact pass and
//! its Gauss-Newton Hessian the information. The filter's gains are then computed anew and the problem solved again.

use crate::ipopt::{IpoptError, Nlp, OptionValue, Options, Solution, solve};
use crate::likelihood::estimate::{Estimate, base_of, log_posterior, restrictions, run_evidence};
use crate::likelihood::evidence::{Base, Evidence};
use crate::likelihood::filter::{Column, Filter, Gains, Pass, Wanted};
use crate::model::Model;
use crate::recording::Run;
use crate::simulate::Integration;
use nalgebra::DMatrix;

struct Refit<'a> {
    found: &'a Estimate,
    integration: Integration,
    runs: &'a [Run],
    gains: &'a [Gains],
    columns: Vec<Column>,
    cached: Option<Point>,
    /// Where the objective alone was evaluated: a line search comes back to its steps.
    tried: Vec<(Vec<f64>, f64)>,
}

/// Objective, gradient and Gauss-Newton Hessian at a point.
struct Point {
    x: Vec<f64>,
    value: f64,
    gradient: Vec<f64>,
    hessian: DMatrix<f64>,
}

impl Refit<'_> {
    fn model_at(&self, x: &[f64]) -> Model {
        let mut model = self.found.model.clone();
        for (f, x) in self.found.free.iter().zip(x) {
            f.set(&mut model, x * f.column.scale);
        }
        model
    }

    /// Passes with the gains held fixed: what they say, and the objective's part that they make, half the sum of squared
    /// innovations.
    fn passes(&self, model: &Model, columns: &[Column]) -> (Evidence, f64) {
        let filter = Filter::new(model, self.integration, columns);
        let restrictions = if columns.is_empty() { Vec::new() } else { restrictions(&self.found.free) };
        let (mut evidence, mut value) = (Evidence::default(), 0.0);
        let wanted = Wanted { frozen: Some(self.gains), exact: true, ..Wanted::default() };
        let work = |run: &Run, pass: Pass| {
            let Pass { score, information, innovations, filtered, .. } = pass;
            // A model that left the numbers has no innovations at all, and would look perfect.
            let finite = filtered.iter().flatten().all(|z| z.is_finite());
            (run_evidence(run, score, information, &restrictions), innovations, finite)
        };
        let mut finite = true;
        filter.each(self.runs, &self.found.noise, wanted, work, |(one, innovations, is_finite)| {
            evidence.add(one, false);
            for e in innovations.iter().flatten().filter(|e| !e.is_nan()) {
                value += 0.5 * e * e;
            }
            finite &= is_finite;
        });
        (evidence, if finite { value } else { f64::INFINITY })
    }

    /// The objective alone, without sensitivities: most of what a line search asks for.
    fn value_at(&mut self, x: &[f64]) -> Option<f64> {
        if let Some(known) = self.cached.as_ref().filter(|c| c.x == x) {
            return Some(known.value);
        }
        if let Some((_, known)) = self.tried.iter().find(|(tried, _)| tried == x) {
            return Some(*known).filter(|value| value.is_finite());
        }
        let model = self.model_at(x);
        let (_, mut value) = self.passes(&model, &[]);
        for f in &self.found.free {
            value -= f.log_prior(&model);
        }
        self.tried.push((x.to_vec(), value));
        value.is_finite().then_some(value)
    }

    /// The point at `x`, in one pass, kept for the callbacks at the same point.
    fn at(&mut self, x: &[f64]) -> Option<&Point> {
        if self.cached.as_ref().is_none_or(|c| c.x != x) {
            let model = self.model_at(x);
            let (e, mut value) = self.passes(&model, &self.columns);
            let Base { score, .. } = base_of(&e, &model, &self.found.free);
            let mut hessian = e.total.information;
            for (i, f) in self.found.free.iter().enumerate() {
                value -= f.log_prior(&model);
                hessian[(i, i)] += f.prior_terms(&model).0;
            }
            if !value.is_finite() {
                return None;
            }
            let gradient = score.iter().map(|s| -s).collect();
            self.cached = Some(Point { x: x.to_vec(), value, gradient, hessian });
        }
        self.cached.as_ref()
    }
}

impl Nlp for Refit<'_> {
    fn variables(&self) -> usize {
        self.columns.len()
    }
    fn constraints(&self) -> usize {
        0
    }
    fn variable_bounds(&self, lower: &mut [f64], upper: &mut [f64]) {
        for (i, f) in self.found.free.iter().enumerate() {
            (lower[i], upper[i]) = f.bounds(&self.found.model);
        }
    }
    fn constraint_bounds(&self, _lower: &mut [f64], _upper: &mut [f64]) {}
    fn start(&self, x: &mut [f64]) {
        for (x, f) in x.iter_mut().zip(&self.found.free) {
            *x = f.value(&self.found.model) / f.column.scale;
        }
    }
    fn objective(&mut self, x: &[f64]) -> Option<f64> {
        self.value_at(x)
    }
    fn gradient(&mut self, x: &[f64], gradient: &mut [f64]) -> bool {
        self.at(x).map(|c| gradient.copy_from_slice(&c.gradient)).is_some()
    }
    fn constraint_values(&mut self, _x: &[f64], _values: &mut [f64]) -> bool {
        true
    }
    fn jacobian_structure(&self) -> Vec<(usize, usize)> {
        Vec::new()
    }
    fn jacobian_values(&mut self, _x: &[f64], _values: &mut [f64]) -> bool {
        true
    }
    fn hessian_structure(&self) -> Vec<(usize, usize)> {
        (0..self.columns.len()).flat_map(|i| (0..=i).map(move |j| (i, j))).collect()
    }
    fn hessian_values(&mut self, x: &[f64], factor: f64, _multipliers: &[f64], values: &mut [f64]) -> bool {
        let n = self.columns.len();
        self.at(x)
            .map(|c| {
                let mut k = 0;
                for i in 0..n {
                    for j in 0..=i {
                        values[k] = factor * c.hessian[(i, j)];
                        k += 1;
                    }
                }
            })
            .is_some()
    }
}

/// The estimate is near the optimum: Ipopt starts there with its barrier nearly gone, where it would otherwise step back from
/// the bounds and lower the barrier anew; a few Gauss-Newton steps are all that is left to do. The objective is in units of
/// log-likelihood and a column's scale is far above its standard error: gradients below the tolerance promise less than a
/// hundredth of a unit.
fn options() -> Options {
    let number = |name: &str, value: f64| (name.to_owned(), OptionValue::Number(value));
    Options {
        tolerance: 0.5,
        max_iterations: 3,
        extra: vec![
            number("mu_init", 1e-7),
            number("bound_push", 1e-9),
            number("bound_frac", 1e-9),
            ("nlp_scaling_method".to_owned(), OptionValue::Text("none".to_owned())),
        ],
        ..Options::default()
    }
}

/// Refits the free parameters of an estimate through Ipopt, with gains computed once at its values.
///
/// The estimate comes back with the refitted model and its likelihood; `None` where Ipopt did not improve it.
///
/// # Errors
/// When Ipopt cannot be started at all; a solve that does not converge is not an error but changes nothing.
pub fn refit(found: &Estimate, integration: Integration, runs: &[Run]) -> Result<Option<Estimate>, IpoptError> {
    let filter = Filter::new(&found.model, integration, &[]);
    let wanted = Wanted { gains: true, ..Wanted::default() };
    let passes = filter.passes(runs, &found.noise, wanted);
    let gains: Vec<Gains> = passes.into_iter().map(|pass| pass.gains.unwrap_or_default()).collect();
    let columns: Vec<Column> = found.free.iter().map(|f| f.column).collect();
    let mut problem = Refit { found, integration, runs, gains: &gains, columns, cached: None, tried: Vec::new() };
    let Solution { x, .. } = solve(&mut problem, &options())?;
    let model = problem.model_at(&x);
    let log_posterior = log_posterior(&model, integration, runs, &found.free, &found.noise);
    let improved = log_posterior >= found.log_posterior;
    Ok(improved.then(|| Estimate { model, log_posterior, seen: None, ..found.clone() }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{RK4, at, model, runs};

    /// An estimate off the truth, with the gains at it.
    fn off() -> (Estimate, Vec<Run>) {
        let mut found = at(&model());
        for f in &found.free {
            let value = f.value(&found.model) + 0.5 * f.column.scale;
            f.set(&mut found.model, value);
        }
        let runs = runs(&model(), 3);
        found.log_posterior = log_posterior(&found.model, RK4, &runs, &found.free, &found.noise);
        (found, runs)
    }

    #[test]
    fn the_gradient_is_the_slope_of_the_objective() {
        let (found, runs) = off();
        let filter = Filter::new(&found.model, RK4, &[]);
        let wanted = Wanted { gains: true, ..Wanted::default() };
        let gains: Vec<Gains> = runs.iter().filter_map(|r| filter.pass(r, &found.noise, wanted).gains).collect();
        let columns = found.free.iter().map(|f| f.column).collect();
        let mut problem = Refit {
            found: &found,
            integration: RK4,
            runs: &runs,
            gains: &gains,
            columns,
            cached: None,
            tried: Vec::new(),
        };
        let x: Vec<f64> = found.free.iter().map(|f| f.value(&found.model) / f.column.scale).collect();
        let gradient = problem.at(&x).map(|p| p.gradient.clone()).unwrap_or_default();
        for i in 0..x.len() {
            let mut value = |d: f64| {
                let mut y = x.clone();
                y[i] += d;
                problem.value_at(&y).unwrap_or(f64::NAN)
            };
            let slope = (value(1e-4) - value(-1e-4)) / 2e-4;
            assert!((gradient[i] - slope).abs() < 1e-3 * slope.abs().max(1.0), "{i}: {} {slope}", gradient[i]);
        }
    }

    #[test]
    fn a_refit_raises_the_likelihood_or_changes_nothing() -> Result<(), IpoptError> {
        let (found, runs) = off();
        let refitted = refit(&found, RK4, &runs)?.unwrap();
        assert!(refitted.log_posterior > found.log_posterior + 1.0);
        let again = refit(&refitted, RK4, &runs)?;
        assert!(again.is_none_or(|again| again.log_posterior >= refitted.log_posterior));
        Ok(())
    }
}
