//! A fit as the nonlinear program that Ipopt is given: scaled parameters, cost plus priors, linear constraints.
//! It decides nothing about what is fitted and reports nothing: it translates, keeps the best feasible point and checks the limits.

use super::constraints::Row;
use super::curvature::{Curvature, Local};
use super::limits::Watch;
use super::scaling::Scaling;
use super::task::Task;
use crate::fit::objectives::cost::Quadratic;
use crate::fit::objectives::evaluations::Evaluations;
use crate::fit::settings::Hessian;
use crate::ipopt::{IterationReport, Multipliers, Nlp};
use crate::model::Model;
use nalgebra::{DMatrix, DVector};
use std::rc::Rc;

/// Where a running fit stands.
#[derive(Clone, Copy, Debug)]
pub struct Progress<'a> {
    /// Which solve of the fit this is, the first being 1: a fit solves in stages, and checks its optimum by a further solve.
    pub solve: usize,
    /// What this solve minimises the cost of: `all runs`, `a few runs` or `pieces of the runs`, or `check` for the check of an optimum.
    pub part: &'static str,
    /// Iteration of the solver, from 0 in each solve.
    pub iteration: usize,
    /// Cost of that part, priors included.
    pub cost: f64,
    /// Largest violation of a constraint, scaled.
    pub violation: f64,
    /// Largest entry of the gradient of the Lagrangian, scaled.
    pub optimality: f64,
    /// The free parameters at the best feasible point of this solve, in their own units; absent before there is one.
    pub best: Option<&'a [f64]>,
}

/// The parts of a fit, as [`Progress::part`] says them.
pub(in crate::fit) const ALL: &str = "all runs";
pub(in crate::fit) const FEW: &str = "a few runs";
pub(in crate::fit) const PIECES: &str = "pieces of the runs";
pub(in crate::fit) const CHECK: &str = "check";

/// Priors on the free parameters, as residuals beside those of the data.
///
/// The cost is no likelihood, so a prior needs the weight of a unit of cost. With the residuals' variance
/// `s^2` (of the weighted residuals, which are taken as equally uncertain), `-2 s^2/M log posterior` is, up to a constant,
/// `C(p) + w sum_j ((p_j - mean_j)/sd_j)^2` with `w = strength s^2/M`.
#[derive(Clone, Debug)]
pub(in crate::fit) struct Priors {
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
pub(in crate::fit) struct Point {
    pub p: Vec<f64>,
    pub total: f64,
}

/// When an objective counts as settled before its gradient is 0, both as the solver counts them: where terms take absolute values, a
/// gradient jumps from sample to sample, and below the size of these jumps nothing can be minimised.
#[derive(Clone, Copy)]
pub(in crate::fit) struct Settled {
    /// Largest gradient of the Lagrangian, violation and complementarity.
    pub gradient: f64,
    /// Largest change of the objective in an iteration, as a share of it (of 1 where it is less).
    pub change: f64,
}

/// What is minimised, and in which way.
#[derive(Clone, Copy)]
pub(in crate::fit) struct Stage<'a> {
    /// The objective that is minimised: the task's, or that of its runs cut into shorter pieces.
    pub evaluations: &'a Evaluations<'a>,
    /// What that is, as [`Progress::part`] says it.
    pub part: &'static str,
    pub priors: &'a Priors,
    pub scaling: &'a Scaling,
    pub hessian: Hessian,
    pub tolerance: f64,
    pub max_iterations: usize,
    /// What ends it where its tolerance is not met; none: the solver's own defaults.
    pub settled: Option<Settled>,
    /// How often the solver may start again from a better point that it left.
    pub restarts: usize,
}

impl Stage<'_> {
    /// Value at a point, priors included.
    pub fn total(&self, p: &[f64]) -> Option<f64> {
        Some(self.evaluations.value(p)? + self.priors.value(p))
    }

    /// Value, gradient and Gauss-Newton matrix at a point as the solver counts them, priors included.
    pub fn local(&self, p: &[f64]) -> Option<Local> {
        let quadratic = self.evaluations.quadratic(p)?;
        let (mut gradient, mut matrix) = (quadratic.gradient.clone(), quadratic.gauss_newton.clone());
        self.priors.add_gradient(p, &mut gradient);
        self.priors.add_hessian(&mut matrix);
        let (n, scales, factor) = (p.len(), &self.scaling.scales, self.evaluations.objective.factor());
        Some(Local {
            z: DVector::from_fn(n, |j, _| p[j] / scales[j]),
            value: factor * (quadratic.value + self.priors.value(p)),
            gradient: DVector::from_fn(n, |j, _| factor * gradient[j] * scales[j]),
            gauss_newton: DMatrix::from_fn(n, n, |i, j| factor * matrix[(i, j)] * scales[i] * scales[j]),
        })
    }
}

/// The program in `z = p / scale`, with each constraint row divided by its size over a change of one scale.
pub(in crate::fit) struct Problem<'a, 'f, 'w> {
    pub task: &'a Task<'a>,
    pub stage: Stage<'a>,
    /// Start, in the parameters' own units.
    pub start: &'a [f64],
    /// The constraint rows that the solver gets, of all those of the task.
    pub rows: &'a [usize],
    /// Multipliers of all rows to start with.
    pub multipliers: Option<Multipliers>,
    pub curvature: &'f mut Curvature,
    pub watch: &'f mut Watch<'w>,
    pub progress: &'f mut dyn FnMut(&Progress) -> bool,
    /// The best feasible point of all that were evaluated.
    pub best: Option<Point>,
    /// Trial points of the last line search.
    pub trials: usize,
}

impl Problem<'_, '_, '_> {
    /// A point in the parameters' own units; the start without the rounding of scaling there and back.
    pub fn unscaled(&self, z: &[f64]) -> Vec<f64> {
        let unscaled = |((z, scale), start): ((&f64, &f64), &f64)| if *z == start / scale { *start } else { z * scale };
        z.iter().zip(&self.stage.scaling.scales).zip(self.start).map(unscaled).collect()
    }

    fn factor(&self) -> f64 {
        self.stage.evaluations.objective.factor()
    }

    /// Value and gradient of the data's part at a point, with the Gauss-Newton matrix where the solver wants it.
    fn quadratic(&self, p: &[f64]) -> Option<Rc<Quadratic>> {
        match self.stage.hessian {
            Hessian::GaussNewton => self.stage.evaluations.quadratic(p),
            Hessian::Exact | Hessian::LimitedMemory => self.stage.evaluations.with_gradient(p),
        }
    }

    /// The solver's constraint rows with their sizes.
    fn rows(&self) -> impl Iterator<Item = (&Row, f64)> {
        self.rows.iter().map(|i| (&self.task.rows[*i], self.stage.scaling.sizes[*i]))
    }

    fn keep_if_best(&mut self, p: Vec<f64>, total: f64) {
        if self.best.as_ref().is_none_or(|best| total < best.total) && self.task.is_feasible(&p) {
            self.best = Some(Point { p: self.task.within_bounds(&p), total });
        }
    }

    /// The matrix of second derivatives as the solver counts them.
    fn matrix(&mut self, p: &[f64]) -> Option<DMatrix<f64>> {
        if self.stage.hessian != Hessian::Exact {
            let local = self.stage.local(p)?;
            return Some(self.curvature.at(local, self.trials));
        }
        let mut matrix = self.stage.evaluations.objective.hessian(p)?;
        self.stage.priors.add_hessian(&mut matrix);
        let scales = &self.stage.scaling.scales;
        let factor = self.factor();
        Some(DMatrix::from_fn(p.len(), p.len(), |i, j| factor * matrix[(i, j)] * scales[i] * scales[j]))
    }
}

impl Nlp for Problem<'_, '_, '_> {
    fn variables(&self) -> usize {
        self.stage.scaling.scales.len()
    }

    fn constraints(&self) -> usize {
        self.rows.len()
    }

    fn variable_bounds(&self, lower: &mut [f64], upper: &mut [f64]) {
        for (j, ((lo, hi), scale)) in self.task.bounds.iter().zip(&self.stage.scaling.scales).enumerate() {
            (lower[j], upper[j]) = (lo / scale, hi / scale);
        }
    }

    fn constraint_bounds(&self, lower: &mut [f64], upper: &mut [f64]) {
        for (i, (row, size)) in self.rows().enumerate() {
            (lower[i], upper[i]) = ((row.lower - row.constant) / size, (row.upper - row.constant) / size);
        }
    }

    fn start(&self, z: &mut [f64]) {
        for (z, (p, scale)) in z.iter_mut().zip(self.start.iter().zip(&self.stage.scaling.scales)) {
            *z = p / scale;
        }
    }

    fn multipliers(&self) -> Option<Multipliers> {
        let all = self.multipliers.as_ref()?;
        let constraints = self.rows.iter().map(|i| all.constraints[*i]).collect();
        Some(Multipliers { constraints, ..all.clone() })
    }

    fn objective(&mut self, z: &[f64]) -> Option<f64> {
        let p = self.unscaled(z);
        // Without a value the solver steps back.
        if !self.watch.evaluates() || !self.task.has_mass(&p) {
            return None;
        }
        // Nearly every point that is tried is accepted: its derivatives are computed with its value.
        let total = self.quadratic(&p)?.value + self.stage.priors.value(&p);
        self.keep_if_best(p, total);
        Some(self.factor() * total)
    }

    fn gradient(&mut self, z: &[f64], gradient: &mut [f64]) -> bool {
        let p = self.unscaled(z);
        let Some(mut total) = self.quadratic(&p).map(|q| q.gradient.clone()) else { return false };
        self.stage.priors.add_gradient(&p, &mut total);
        let factor = self.factor();
        for ((g, total), scale) in gradient.iter_mut().zip(total.iter()).zip(&self.stage.scaling.scales) {
            *g = factor * total * scale;
        }
        true
    }

    fn constraint_values(&mut self, z: &[f64], values: &mut [f64]) -> bool {
        let scales = &self.stage.scaling.scales;
        for (value, (row, size)) in values.iter_mut().zip(self.rows()) {
            let linear: f64 = row.coefficients.iter().zip(scales).zip(z).map(|((a, s), z)| a * s * z).sum();
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
            let nonzero = row.coefficients.iter().zip(&self.stage.scaling.scales).filter(|(a, _)| **a != 0.0);
            for ((a, scale), value) in nonzero.zip(&mut values) {
                *value = a * scale / size;
            }
        }
        true
    }

    fn hessian_structure(&self) -> Vec<(usize, usize)> {
        (0..self.variables()).flat_map(|i| (0..=i).map(move |j| (i, j))).collect()
    }

    fn hessian_values(&mut self, z: &[f64], factor: f64, _multipliers: &[f64], values: &mut [f64]) -> bool {
        let p = self.unscaled(z);
        let Some(matrix) = self.matrix(&p) else { return false };
        for ((i, j), value) in self.hessian_structure().into_iter().zip(values) {
            *value = factor * matrix[(i, j)];
        }
        true
    }

    fn iteration(&mut self, report: &IterationReport) -> bool {
        self.trials = report.trials;
        let cost = report.objective / self.factor();
        let wanted = (self.progress)(&Progress {
            solve: self.watch.solves(),
            part: self.stage.part,
            iteration: report.iteration,
            cost,
            violation: report.inf_pr,
            optimality: report.inf_du,
            best: self.best.as_ref().map(|best| best.p.as_slice()),
        });
        self.watch.goes_on(report, wanted)
    }
}
