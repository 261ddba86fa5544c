//! A fit as the nonlinear program that Ipopt is given: scaled parameters, cost plus priors, linear constraints.
//! It decides nothing about what is fitted and reports nothing: it translates, and remembers what evaluations share.

use super::constraints::Row;
use super::cost::{Cost, Quadratic};
use super::settings::Hessian;
use super::task::Task;
use crate::ipopt::{IterationReport, Nlp};
use crate::model::Model;
use nalgebra::{DMatrix, DVector};

/// Where a running fit stands.
#[derive(Clone, Copy, Debug)]
pub struct Progress<'a> {
    /// Iteration of the solver.
    pub iteration: usize,
    /// Cost, priors included.
    pub cost: f64,
    /// Largest violation of a constraint, scaled.
    pub violation: f64,
    /// Largest entry of the gradient of the Lagrangian, scaled.
    pub optimality: f64,
    /// The free parameters at the best feasible point of this solve, in their own units; absent before there is one.
    pub best: Option<&'a [f64]>,
}

/// Priors on the free parameters, as residuals beside those of the data.
///
/// The cost is no likelihood, so a prior needs to be told how much a unit of cost is worth. With the residuals' variance
/// `s^2` (of the weighted residuals, which are taken as equally uncertain), `-2 s^2/M log posterior` is, up to a constant,
/// `C(p) + w sum_j ((p_j - mean_j)/sd_j)^2` with `w = strength s^2/M`.
#[derive(Clone, Debug)]
pub(super) struct Priors {
    /// Index among the free parameters, mean, standard deviation.
    pub terms: Vec<(usize, f64, f64)>,
    /// w above; 0 switches the priors off.
    pub weight: f64,
}

impl Priors {
    pub fn of(model: &Model) -> Self {
        let prior = |(j, i): (usize, usize)| model.parameters[i].prior.map(|prior| (j, prior.mean, prior.sd));
        Self { terms: model.free().into_iter().enumerate().filter_map(prior).collect(), weight: 0.0 }
    }

    pub fn value(&self, p: &[f64]) -> f64 {
        self.weight * self.terms.iter().map(|(j, mean, sd)| ((p[*j] - mean) / sd).powi(2)).sum::<f64>()
    }

    pub fn add_gradient(&self, p: &[f64], gradient: &mut DVector<f64>) {
        for (j, mean, sd) in &self.terms {
            gradient[*j] += 2.0 * self.weight * (p[*j] - mean) / (sd * sd);
        }
    }

    pub fn add_hessian(&self, hessian: &mut DMatrix<f64>) {
        for (j, _, sd) in &self.terms {
            hessian[(*j, *j)] += 2.0 * self.weight / (sd * sd);
        }
    }
}

/// A point in the parameters' own units, and its cost with priors.
#[derive(Clone, Debug)]
pub(super) struct Point {
    pub p: Vec<f64>,
    pub total: f64,
}

/// The program in `z = p / scale`, with each constraint row divided by its size over a change of one scale.
pub(super) struct Problem<'a, 'f> {
    pub task: &'a Task<'a>,
    /// The cost that is minimised: the task's, or that of its runs cut into shorter pieces.
    pub cost: &'a Cost<'a>,
    pub priors: &'a Priors,
    /// Start, in the parameters' own units.
    pub start: &'a [f64],
    /// Factor from cost to the solver's objective: one over the mean number of samples of a run, so that it is of order one.
    pub factor: f64,
    pub progress: &'f mut dyn FnMut(&Progress) -> bool,
    /// The best feasible point of all that were evaluated.
    pub best: Option<Point>,
    /// Number of points evaluated.
    pub evaluated: usize,
    cached: Option<(Vec<f64>, Quadratic)>,
}

impl<'a, 'f> Problem<'a, 'f> {
    pub fn new(
        task: &'a Task<'a>,
        cost: &'a Cost<'a>,
        priors: &'a Priors,
        start: &'a [f64],
        progress: &'f mut dyn FnMut(&Progress) -> bool,
    ) -> Self {
        let factor = cost.runs() as f64 / cost.samples().max(1) as f64;
        Self { task, cost, priors, start, factor, progress, best: None, evaluated: 0, cached: None }
    }

    fn unscaled(&self, z: &[f64]) -> Vec<f64> {
        z.iter().zip(&self.task.scales).map(|(z, s)| z * s).collect()
    }

    /// Value, gradient and Gauss-Newton matrix of the data's part at a point, computed once for all that ask.
    fn quadratic(&mut self, z: &[f64]) -> Option<&Quadratic> {
        if self.cached.as_ref().is_none_or(|(at, _)| at != z) {
            let p = self.unscaled(z);
            let quadratic = match self.task.settings.hessian {
                Hessian::GaussNewton => self.cost.quadratic(&p),
                Hessian::Exact | Hessian::LimitedMemory => self.cost.with_gradient(&p),
            };
            self.cached = Some((z.to_vec(), quadratic?));
        }
        self.cached.as_ref().map(|(_, quadratic)| quadratic)
    }

    fn keep_if_best(&mut self, p: Vec<f64>, total: f64) {
        if self.best.as_ref().is_none_or(|best| total < best.total) && self.task.is_feasible(&p) {
            self.best = Some(Point { p: self.task.within_bounds(&p), total });
        }
    }
}

impl Nlp for Problem<'_, '_> {
    fn variables(&self) -> usize {
        self.task.scales.len()
    }

    fn constraints(&self) -> usize {
        self.task.rows.len()
    }

    fn variable_bounds(&self, lower: &mut [f64], upper: &mut [f64]) {
        for (j, ((lo, hi), scale)) in self.task.bounds.iter().zip(&self.task.scales).enumerate() {
            (lower[j], upper[j]) = (lo / scale, hi / scale);
        }
    }

    fn constraint_bounds(&self, lower: &mut [f64], upper: &mut [f64]) {
        for (i, row) in self.task.rows.iter().enumerate() {
            let size = row.size(&self.task.scales);
            (lower[i], upper[i]) = ((row.lower - row.constant) / size, (row.upper - row.constant) / size);
        }
    }

    fn start(&self, z: &mut [f64]) {
        for (z, (p, scale)) in z.iter_mut().zip(self.start.iter().zip(&self.task.scales)) {
            *z = p / scale;
        }
    }

    fn objective(&mut self, z: &[f64]) -> Option<f64> {
        self.evaluated += 1;
        let p = self.unscaled(z);
        // Without a value the solver steps back.
        if !self.task.has_mass(&p) {
            return None;
        }
        // Nearly every point that is tried is accepted: its derivatives are computed with its value.
        let value = match self.task.settings.hessian {
            Hessian::GaussNewton => self.quadratic(z)?.value,
            Hessian::Exact | Hessian::LimitedMemory => self.cost.value(&p)?,
        };
        let total = value + self.priors.value(&p);
        self.keep_if_best(p, total);
        Some(self.factor * total)
    }

    fn gradient(&mut self, z: &[f64], gradient: &mut [f64]) -> bool {
        let p = self.unscaled(z);
        let Some(mut total) = self.quadratic(z).map(|q| q.gradient.clone()) else { return false };
        self.priors.add_gradient(&p, &mut total);
        for (j, g) in gradient.iter_mut().enumerate() {
            *g = self.factor * total[j] * self.task.scales[j];
        }
        true
    }

    fn constraint_values(&mut self, z: &[f64], values: &mut [f64]) -> bool {
        for (value, row) in values.iter_mut().zip(&self.task.rows) {
            let linear: f64 = row.coefficients.iter().zip(&self.task.scales).zip(z).map(|((a, s), z)| a * s * z).sum();
            *value = linear / row.size(&self.task.scales);
        }
        true
    }

    fn jacobian_structure(&self) -> Vec<(usize, usize)> {
        let entries = |(i, row): (usize, &Row)| {
            let nonzero = row.coefficients.iter().enumerate().filter(|(_, a)| **a != 0.0);
            nonzero.map(move |(j, _)| (i, j)).collect::<Vec<_>>()
        };
        self.task.rows.iter().enumerate().flat_map(entries).collect()
    }

    fn jacobian_values(&mut self, _z: &[f64], values: &mut [f64]) -> bool {
        let mut values = values.iter_mut();
        for row in &self.task.rows {
            let size = row.size(&self.task.scales);
            let nonzero = row.coefficients.iter().zip(&self.task.scales).filter(|(a, _)| **a != 0.0);
            for ((a, scale), value) in nonzero.zip(&mut values) {
                *value = a * scale / size;
            }
        }
        true
    }

    fn hessian_structure(&self) -> Vec<(usize, usize)> {
        (0..self.task.scales.len()).flat_map(|i| (0..=i).map(move |j| (i, j))).collect()
    }

    fn hessian_values(&mut self, z: &[f64], factor: f64, _multipliers: &[f64], values: &mut [f64]) -> bool {
        let p = self.unscaled(z);
        let matrix = match self.task.settings.hessian {
            Hessian::Exact => self.cost.hessian(&p),
            _ => self.quadratic(z).map(|q| q.gauss_newton.clone()),
        };
        let Some(mut matrix) = matrix else { return false };
        self.priors.add_hessian(&mut matrix);
        for ((i, j), value) in self.hessian_structure().into_iter().zip(values) {
            *value = factor * self.factor * matrix[(i, j)] * self.task.scales[i] * self.task.scales[j];
        }
        true
    }

    fn iteration(&mut self, report: &IterationReport) -> bool {
        (self.progress)(&Progress {
            iteration: report.iteration,
            cost: report.objective / self.factor,
            violation: report.inf_pr,
            optimality: report.inf_du,
            best: self.best.as_ref().map(|best| best.p.as_slice()),
        })
    }
}
