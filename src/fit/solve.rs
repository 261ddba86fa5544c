//! From the start of a fit through Ipopt to the point it returns, with the priors weighed anew between solves.
//! It says where the fit ended and what stopped it; how sure the estimates are is the work of `covariance`.

use super::constraints::Row;
use super::error::FitError;
use super::problem::{Priors, Problem, Progress, row_size};
use super::settings::Hessian;
use super::subspace::inverse;
use super::task::{ActiveSet, Task};
use crate::ipopt::{self, Counts, HessianMode, OptionValue, Options, Solution, Status};

/// Where the solver ended.
pub(super) struct End {
    pub p: Vec<f64>,
    pub priors: Priors,
    pub status: Status,
    pub iterations: usize,
    pub counts: Counts,
    pub active: ActiveSet,
}

impl Task<'_> {
    /// Solves, and where there are priors solves again with their weight set by the residuals just found.
    pub fn solve(&self, progress: &mut dyn FnMut(&Progress) -> bool) -> Result<End, FitError> {
        let mut priors = Priors::of(self.model);
        let rounds = if priors.terms.is_empty() { 1 } else { 1 + self.settings.prior_updates };
        let weight = |cost: f64| self.variance(cost) * self.settings.correlated_samples / self.runs.len() as f64;
        let mut p = self.start.clone();
        let mut data_cost = self.start_cost;
        let (mut iterations, mut counts) = (0, Counts::default());
        let mut last: Option<(Solution, f64)> = None;
        for _ in 0..rounds {
            let next = weight(data_cost);
            if last.as_ref().is_some_and(|(_, weight)| (next - weight).abs() <= 0.01 * weight) {
                break;
            }
            priors.weight = next;
            let (cost, factor) = (self.cost, self.factor());
            let mut problem = Problem::new(
                cost,
                &self.rows,
                &priors,
                &self.scales,
                &self.bounds,
                &p,
                factor,
                self.settings.hessian,
                progress,
            );
            let solution = ipopt::solve(&mut problem, &self.options())?;
            p = solution.x.iter().zip(&self.scales).map(|(z, s)| z * s).collect();
            for (p, (lower, upper)) in p.iter_mut().zip(&self.bounds) {
                *p = p.max(*lower).min(*upper);
            }
            iterations += solution.iterations;
            counts.objective += solution.counts.objective;
            counts.gradient += solution.counts.gradient;
            counts.constraints += solution.counts.constraints;
            counts.jacobian += solution.counts.jacobian;
            counts.hessian += solution.counts.hessian;
            let converged = solution.status.is_success();
            data_cost = self.cost.value(&p).unwrap_or(f64::INFINITY);
            last = Some((solution, next));
            if !converged || !data_cost.is_finite() {
                break;
            }
        }
        let Some((solution, _)) = last else { return Err(FitError::NothingFree) };
        self.check_feasible(&p, &solution)?;
        let active = self.active_set(&p, &solution);
        Ok(End { p, priors, status: solution.status, iterations, counts, active })
    }

    fn options(&self) -> Options {
        Options {
            tolerance: self.settings.tolerance,
            max_iterations: self.settings.max_iterations,
            hessian: match self.settings.hessian {
                Hessian::LimitedMemory => HessianMode::LimitedMemory { history: self.settings.history },
                Hessian::GaussNewton | Hessian::Exact => HessianMode::Given,
            },
            linear_constraints: true,
            print: self.settings.print,
            extra: vec![("mu_strategy".into(), OptionValue::Text("adaptive".into()))],
            ..Options::default()
        }
    }

    /// Infeasibility is an error where it is the constraints' own: they are linear, so that Ipopt's word is final.
    fn check_feasible(&self, p: &[f64], solution: &Solution) -> Result<(), FitError> {
        if !matches!(solution.status, Status::Infeasible | Status::RestorationFailed) {
            return Ok(());
        }
        let broken = |row: &&Row| row.violation(p) / row_size(row, &self.scales);
        let worst = self.rows.iter().max_by(|a, b| broken(a).total_cmp(&broken(b)));
        match worst {
            Some(row) if broken(&row) > 1e-6 => {
                Err(FitError::Infeasible { rule: row.rule, sentence: row.sentence(p), violation: row.violation(p) })
            }
            _ => Ok(()),
        }
    }

    /// What holds the solution back: the multiplier exceeds the distance from the limit, both in solver units.
    fn active_set(&self, p: &[f64], solution: &Solution) -> ActiveSet {
        let least = 1e3 * self.settings.tolerance * self.settings.tolerance.min(1e-3);
        let is_active = |multiplier: f64, slack: f64| multiplier.abs() > slack.abs().max(least);
        let rows = (0..self.rows.len()).filter(|i| {
            let row = &self.rows[*i];
            let value = row.value(p);
            let slack = (value - row.lower).abs().min((row.upper - value).abs()) / row_size(row, &self.scales);
            is_active(solution.constraint_multipliers[*i], slack)
        });
        let mut bounds = Vec::new();
        for (j, (lower, upper)) in self.bounds.iter().enumerate() {
            if is_active(solution.lower_bound_multipliers[j], (p[j] - lower) / self.scales[j]) {
                bounds.push((j, "lower"));
            } else if is_active(solution.upper_bound_multipliers[j], (upper - p[j]) / self.scales[j]) {
                bounds.push((j, "upper"));
            }
        }
        ActiveSet { rows: rows.collect(), bounds }
    }

    /// Newton steps within the active constraints: an interior-point solution keeps a distance of the order of its barrier
    /// from every limit and is blurred along directions of little curvature.
    pub fn polish(&self, end: &mut End) {
        if !end.status.is_success() {
            return;
        }
        let z = self.free_directions(&end.active);
        let total = |p: &[f64]| Some(self.cost.value(p)? + end.priors.value(p));
        let Some(mut best) = total(&end.p) else { return };
        for _ in 0..self.settings.polish_steps {
            let Some(quadratic) = self.cost.quadratic(&end.p) else { return };
            let (mut gradient, mut hessian) = (quadratic.gradient, quadratic.gauss_newton);
            if self.settings.hessian == Hessian::Exact {
                let Some(exact) = self.cost.hessian(&end.p) else { return };
                hessian = exact;
            }
            end.priors.add_gradient(&end.p, &mut gradient);
            end.priors.add_hessian(&mut hessian);
            let inverse = inverse(&self.scaled(&hessian), &z);
            let step = -(inverse.matrix * self.scaled_vector(&gradient));
            let moved: Vec<f64> = (0..step.len()).map(|j| end.p[j] + step[j] * self.scales[j]).collect();
            let inside = |(j, p): (usize, &f64)| *p >= self.bounds[j].0 && *p <= self.bounds[j].1;
            let broken = |row: &Row| row.violation(&moved) > row.violation(&end.p) + 1e-9 * row_size(row, &self.scales);
            if !moved.iter().enumerate().all(inside) || self.rows.iter().any(broken) {
                return;
            }
            match total(&moved) {
                Some(value) if value < best => (end.p, best) = (moved, value),
                _ => return,
            }
            if step.amax() < 1e-14 {
                return;
            }
        }
    }
}
