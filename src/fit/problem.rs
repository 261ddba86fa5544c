//! A fit as the nonlinear program that Ipopt is given: scaled parameters, cost plus priors, linear constraints.
//! It decides nothing about what is fitted and reports nothing: it translates, and remembers what evaluations share.

use super::constraints::Row;
use super::cost::Quadratic;
use super::evaluations::Evaluations;
use super::settings::Hessian;
use super::task::Task;
use crate::ipopt::{IterationReport, Nlp};
use crate::model::Model;
use nalgebra::{DMatrix, DVector};
use std::rc::Rc;

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
    pub evaluations: &'a Evaluations<'a>,
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
}

impl<'a, 'f> Problem<'a, 'f> {
    pub fn new(
        task: &'a Task<'a>,
        evaluations: &'a Evaluations<'a>,
        priors: &'a Priors,
        start: &'a [f64],
        progress: &'f mut dyn FnMut(&Progress) -> bool,
    ) -> Self {
        let factor = evaluations.cost.runs() as f64 / evaluations.cost.samples().max(1) as f64;
        Self { task, evaluations, priors, start, factor, progress, best: None, evaluated: 0 }
    }

    /// A point in the parameters' own units; the start without the rounding of scaling there and back.
    pub fn unscaled(&self, z: &[f64]) -> Vec<f64> {
        let unscaled = |((z, scale), start): ((&f64, &f64), &f64)| if *z == start / scale { *start } else { z * scale };
        z.iter().zip(&self.task.scales).zip(self.start).map(unscaled).collect()
    }

    /// Value and gradient of the data's part at a point, with the Gauss-Newton matrix where the solver wants it.
    fn quadratic(&self, p: &[f64]) -> Option<Rc<Quadratic>> {
        match self.task.settings.hessian {
            Hessian::GaussNewton => self.evaluations.quadratic(p),
            Hessian::Exact | Hessian::LimitedMemory => self.evaluations.with_gradient(p),
        }
    }

    /// The constraint rows with their sizes.
    fn rows(&self) -> impl Iterator<Item = (&Row, f64)> {
        self.task.rows.iter().zip(self.task.sizes.iter().copied())
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
        for (i, (row, size)) in self.rows().enumerate() {
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
            Hessian::GaussNewton => self.evaluations.quadratic(&p)?.value,
            Hessian::Exact | Hessian::LimitedMemory => self.evaluations.value(&p)?,
        };
        let total = value + self.priors.value(&p);
        self.keep_if_best(p, total);
        Some(self.factor * total)
    }

    fn gradient(&mut self, z: &[f64], gradient: &mut [f64]) -> bool {
        let p = self.unscaled(z);
        let Some(mut total) = self.quadratic(&p).map(|q| q.gradient.clone()) else { return false };
        self.priors.add_gradient(&p, &mut total);
        for (j, g) in gradient.iter_mut().enumerate() {
            *g = self.factor * total[j] * self.task.scales[j];
        }
        true
    }

    fn constraint_values(&mut self, z: &[f64], values: &mut [f64]) -> bool {
        for (value, (row, size)) in values.iter_mut().zip(self.rows()) {
            let linear: f64 = row.coefficients.iter().zip(&self.task.scales).zip(z).map(|((a, s), z)| a * s * z).sum();
            *value = linear / size;
        }
        true
    }

    fn jacobian_structure(&self) -> Vec<(usize, usize)> {
        let entries = |(i, (row, _)): (usize, (&Row, f64))| {
            let nonzero = row.coefficients.iter().enumerate().filter(|(_, a)| **a != 0.0);
            nonzero.map(move |(j, _)| (i, j)).collect::<Vec<_>>()
        };
        self.rows().enumerate().flat_map(entries).collect()
    }

    fn jacobian_values(&mut self, _z: &[f64], values: &mut [f64]) -> bool {
        let mut values = values.iter_mut();
        for (row, size) in self.rows() {
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
            Hessian::Exact => self.evaluations.cost.hessian(&p),
            _ => self.quadratic(&p).map(|q| q.gauss_newton.clone()),
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
