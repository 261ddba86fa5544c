//! Gauss-Newton steps within the linear limits of a fit, each the minimum of a quadratic model of the cost under all of them.
//! It begins and stays within the limits, and judges by the model whether the point that it reached is the optimum.
//!
//! At a point p, with the gradient g of cost and priors, their Gauss-Newton matrix H and the rows and bounds `n_k^T z >= b_k`,
//!
//! ```text
//! step    d = argmin g^T d + d^T (H + S + damping diag H) d / 2   subject to   n_k^T (z + d) >= b_k
//! ends    where |(H + S) d| and u_k n_k^T d, with the multipliers u of the step, are below the tolerance
//! ```
//!
//! in scaled parameters z. A step that does not lower the cost is taken back and the damping raised (Levenberg, Marquardt).
//!
//! H leaves out the curvature of the residuals. Where residuals are large that is a multiple of H in some direction: the steps
//! then overshoot, however near the optimum. The matrix S stands for it, learnt from how the gradient changed over each step that
//! was tried, and is used as long as it foretells the change of the cost better than H alone does. Source: Dennis, Gay and Welsch, "An
//! adaptive nonlinear least-squares algorithm", ACM Trans. Math. Softw. 7 (1981) 348-368, with the change of the gradient less
//! that by H for the change that S explains.

use super::evaluations::Evaluations;
use super::problem::{Priors, Progress};
use super::quadratic_program::{Minimum, minimise};
use super::task::{ActiveSet, Task};
use crate::ipopt::Status;
use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Share of the expected decrease of the cost that a step must bring to be taken.
const ENOUGH: f64 = 1e-4;

/// Share of it from which on the damping is lowered, and below which it is raised.
const GOOD: f64 = 0.75;
const POOR: f64 = 0.25;

/// Damping after the first step that failed, the factor by which it grows and shrinks, the damping at which it is switched off,
/// and the one at which the search is given up.
const FIRST_DAMPING: f64 = 1e-2;
const DAMPING_FACTOR: f64 = 10.0;
const NO_DAMPING: f64 = 1e-6;
const MOST_DAMPING: f64 = 1e8;

/// Share of the largest curvature that is added to each, so that directions which nothing determines have one.
const RIDGE: f64 = 1e-13;

/// Share of the diagonal's largest entry that the damping of a parameter takes at least.
const LEAST_DIAGONAL: f64 = 1e-9;

/// Cosine between a step and the change of the gradient over it, below which nothing is learnt of the curvature.
const LEAST_TURN: f64 = 1e-8;

/// Share of the cost that its rounding may hide.
const ROUNDING: f64 = 1e-13;

/// How the steps ended.
pub(super) struct Walk {
    pub status: Status,
    /// The point, within all limits.
    pub p: Vec<f64>,
    /// Steps that were taken, and points at which cost and derivatives were evaluated.
    pub steps: usize,
    pub evaluated: usize,
    /// What holds the optimum back; empty unless solved.
    pub active: ActiveSet,
}

/// Which constraint a limit of the quadratic program is.
#[derive(Clone, Copy)]
enum Limit {
    Row(usize),
    Lower(usize),
    Upper(usize),
}

/// All rows and bounds of a task as limits of unit normal in scaled parameters.
struct Limits {
    which: Vec<Limit>,
    normals: DMatrix<f64>,
    bounds: DVector<f64>,
}

/// Cost and priors at a point, by the scaled parameters and as the solver counts them.
struct Local {
    p: Vec<f64>,
    value: f64,
    gradient: DVector<f64>,
    gauss_newton: DMatrix<f64>,
}

/// The curvature that the Gauss-Newton matrix leaves out.
pub(super) struct Residual {
    matrix: DMatrix<f64>,
    used: bool,
}

impl Limits {
    fn of(task: &Task) -> Self {
        let n = task.scales.len();
        let mut all: Vec<(Limit, DVector<f64>, f64)> = Vec::new();
        for (i, (row, size)) in task.rows.iter().zip(&task.sizes).enumerate() {
            let normal = DVector::from_fn(n, |j, _| row.coefficients[j] * task.scales[j] / size);
            if row.lower.is_finite() {
                all.push((Limit::Row(i), normal.clone(), (row.lower - row.constant) / size));
            }
            if row.upper.is_finite() {
                all.push((Limit::Row(i), -normal, (row.constant - row.upper) / size));
            }
        }
        for (j, ((lower, upper), scale)) in task.bounds.iter().zip(&task.scales).enumerate() {
            let axis = DVector::from_fn(n, |i, _| f64::from(u8::from(i == j)));
            if lower.is_finite() {
                all.push((Limit::Lower(j), axis.clone(), lower / scale));
            }
            if upper.is_finite() {
                all.push((Limit::Upper(j), -axis, -upper / scale));
            }
        }
        let mut normals = DMatrix::zeros(n, all.len());
        all.iter().enumerate().for_each(|(k, (_, normal, _))| normals.set_column(k, normal));
        let bounds = DVector::from_iterator(all.len(), all.iter().map(|(_, _, bound)| *bound));
        Self { which: all.into_iter().map(|(limit, _, _)| limit).collect(), normals, bounds }
    }

    /// How far each limit is, against its normal, from the scaled point `z`: a step must not go further.
    fn against(&self, z: &DVector<f64>) -> DVector<f64> {
        &self.bounds - self.normals.tr_mul(z)
    }

    fn active(&self, minimum: &Minimum, least: f64) -> ActiveSet {
        let mut active = ActiveSet { rows: Vec::new(), bounds: Vec::new() };
        for (k, _) in minimum.multipliers.iter().filter(|(_, multiplier)| *multiplier > least) {
            match self.which[*k] {
                Limit::Row(i) => active.rows.push(i),
                Limit::Lower(j) => active.bounds.push((j, "lower")),
                Limit::Upper(j) => active.bounds.push((j, "upper")),
            }
        }
        active.rows.sort_unstable();
        active.bounds.sort_unstable();
        active
    }
}

impl Residual {
    /// That of which nothing is known yet.
    pub fn unknown(n: usize) -> Self {
        Self { matrix: DMatrix::zeros(n, n), used: false }
    }

    /// What a step between two points says: which model is used from now on, and what the matrix is. True where it is the other
    /// model that is used.
    fn learn(&mut self, from: &Local, to: &Local, step: &DVector<f64>) -> bool {
        let change = to.value - from.value;
        let alone = from.gradient.dot(step) + 0.5 * (&from.gauss_newton * step).dot(step);
        let extra = 0.5 * (&self.matrix * step).dot(step);
        let (used, other) = if self.used { (alone + extra, alone) } else { (alone, alone + extra) };
        let changes = (change - used).abs() > (change - other).abs();
        self.used ^= changes;
        let turned = &to.gradient - &from.gradient;
        let unexplained = &turned - &to.gauss_newton * step;
        let along = turned.dot(step);
        if along.is_nan() || along <= LEAST_TURN * turned.norm() * step.norm() {
            return changes;
        }
        let known = (&self.matrix * step).dot(step).abs();
        if known > 0.0 {
            self.matrix *= (unexplained.dot(step).abs() / known).min(1.0);
        }
        let miss = unexplained - &self.matrix * step;
        let share = miss.dot(step) / (along * along);
        self.matrix += (&miss * turned.transpose() + &turned * miss.transpose()) / along;
        self.matrix -= &turned * turned.transpose() * share;
        changes
    }

    /// The curvature of the quadratic model: never below 0 in any direction, as the cost itself is at its optimum.
    fn curvature(&self, gauss_newton: &DMatrix<f64>) -> DMatrix<f64> {
        if !self.used {
            return gauss_newton.clone();
        }
        let whole = gauss_newton + &self.matrix;
        let eigen = SymmetricEigen::new(whole.clone());
        if eigen.eigenvalues.iter().all(|v| *v > 0.0) {
            return whole;
        }
        let sizes = DMatrix::from_diagonal(&eigen.eigenvalues.abs());
        &eigen.eigenvectors * sizes * eigen.eigenvectors.transpose()
    }
}

/// A walk under way.
struct Search<'a> {
    task: &'a Task<'a>,
    evaluations: &'a Evaluations<'a>,
    priors: &'a Priors,
    /// Factor from cost to what is minimised: one over the mean number of samples of a run, so that it is of order one.
    factor: f64,
    limits: Limits,
    here: Local,
    residual: &'a mut Residual,
    damping: f64,
    steps: usize,
    evaluated: usize,
}

/// A step that is proposed.
struct Proposal {
    minimum: Minimum,
    /// By how much the quadratic model expects the value to fall.
    gain: f64,
    /// How far from an optimum the point is that it begins at.
    optimality: f64,
}

impl Task<'_> {
    /// Steps from `from`, or from the nearest point within the limits, until the optimum is met to `tolerance` or `most` steps
    /// were taken. `None` where there is no such point, or no cost there.
    pub fn walk(
        &self,
        evaluations: &Evaluations,
        from: &[f64],
        priors: &Priors,
        residual: &mut Residual,
        (tolerance, most): (f64, usize),
        progress: &mut dyn FnMut(&Progress) -> bool,
    ) -> Option<Walk> {
        let mut search = Search::begin(self, evaluations, from, priors, residual)?;
        loop {
            let proposal = search.proposal()?;
            let (gain, optimality) = (proposal.gain, proposal.optimality);
            let unmoved = search.damping == 0.0 && gain <= ROUNDING * search.here.value;
            let status = if !search.report(optimality, progress) {
                Status::Stopped
            } else if optimality <= tolerance || unmoved {
                Status::Solved
            } else if search.steps >= most {
                Status::MaxIterations { iterations: most }
            } else if search.damping > MOST_DAMPING {
                Status::TinyStep
            } else {
                search.attempt(&proposal);
                continue;
            };
            let active = search.limits.active(&proposal.minimum, 1e3 * tolerance * tolerance.min(1e-3));
            let Search { here, steps, evaluated, .. } = search;
            return Some(Walk { status, p: here.p, steps, evaluated, active });
        }
    }

    /// The nearest point within the limits, by the scaled parameters.
    fn nearest_within(&self, limits: &Limits, p: &[f64]) -> Option<Vec<f64>> {
        if self.is_feasible(p) {
            return Some(p.to_vec());
        }
        let n = p.len();
        let against = limits.against(&self.scaled_point(p));
        let step = minimise(&DMatrix::identity(n, n), &DVector::zeros(n), &limits.normals, &against)?.x;
        Some(self.moved(p, &step))
    }

    fn scaled_point(&self, p: &[f64]) -> DVector<f64> {
        DVector::from_iterator(p.len(), p.iter().zip(&self.scales).map(|(p, scale)| p / scale))
    }

    /// The point after a step in scaled parameters, without the rounding that leaves a bound.
    fn moved(&self, p: &[f64], step: &DVector<f64>) -> Vec<f64> {
        let moved: Vec<f64> =
            p.iter().zip(step.iter()).zip(&self.scales).map(|((p, d), scale)| p + d * scale).collect();
        self.within_bounds(&moved)
    }
}

impl<'a> Search<'a> {
    fn begin(
        task: &'a Task<'a>,
        evaluations: &'a Evaluations<'a>,
        from: &[f64],
        priors: &'a Priors,
        residual: &'a mut Residual,
    ) -> Option<Self> {
        let limits = Limits::of(task);
        let start = task.nearest_within(&limits, from)?;
        let factor = evaluations.cost.runs() as f64 / evaluations.cost.samples().max(1) as f64;
        let here = Local::of(task, evaluations, priors, factor, start)?;
        Some(Self { task, evaluations, priors, factor, limits, here, residual, damping: 0.0, steps: 0, evaluated: 1 })
    }

    /// The minimum of the damped quadratic model under all limits.
    fn proposal(&self) -> Option<Proposal> {
        let (here, limits) = (&self.here, &self.limits);
        let curvature = self.residual.curvature(&here.gauss_newton);
        let mut damped = curvature.clone();
        let largest = here.gauss_newton.diagonal().max().max(f64::MIN_POSITIVE);
        for j in 0..here.p.len() {
            let diagonal = here.gauss_newton[(j, j)].max(LEAST_DIAGONAL * largest);
            damped[(j, j)] += RIDGE * largest + self.damping * diagonal;
        }
        let against = limits.against(&self.task.scaled_point(&here.p));
        let minimum = minimise(&damped, &here.gradient, &limits.normals, &against)?;
        let step = &minimum.x;
        let gain = -here.gradient.dot(step) - 0.5 * (&curvature * step).dot(step);
        // The gradient of the Lagrangian with the step's multipliers, and these times the room of their limits: 0 at the optimum.
        let mut gradient = here.gradient.clone();
        let mut slack: f64 = 0.0;
        for (k, multiplier) in &minimum.multipliers {
            gradient.axpy(-multiplier, &limits.normals.column(*k), 1.0);
            slack = slack.max((multiplier * against[*k]).abs());
        }
        Some(Proposal { gain, optimality: gradient.amax().max(slack), minimum })
    }

    /// Tells the caller, and the log where it is wanted, where the walk is; false where the caller wants it to stop.
    fn report(&self, optimality: f64, progress: &mut dyn FnMut(&Progress) -> bool) -> bool {
        let (here, cost) = (&self.here, self.here.value / self.factor);
        if self.task.settings.print {
            let model = if self.residual.used { "with the residuals' curvature" } else { "" };
            let (steps, evaluated, damping) = (self.steps, self.evaluated, self.damping);
            println!(
                "{steps:4} {evaluated:4}  cost {cost:.12e}  optimality {optimality:.2e}  damping {damping:.0e} {model}"
            );
        }
        progress(&Progress { iteration: self.steps, cost, violation: 0.0, optimality, best: Some(&here.p) })
    }

    /// Takes the step where it lowers the value, and sets the damping of the next.
    fn attempt(&mut self, proposal: &Proposal) {
        let step = &proposal.minimum.x;
        let moved = self.task.moved(&self.here.p, step);
        let there = Local::of(self.task, self.evaluations, self.priors, self.factor, moved);
        self.evaluated += 1;
        let raised = (self.damping * DAMPING_FACTOR).max(FIRST_DAMPING);
        let Some(there) = there else {
            self.damping = raised;
            return;
        };
        let share = (self.here.value - there.value) / proposal.gain;
        let other_model = self.residual.learn(&self.here, &there, step);
        if share > GOOD {
            let lowered = self.damping / DAMPING_FACTOR;
            self.damping = if lowered < NO_DAMPING { 0.0 } else { lowered };
        } else if share.is_nan() || share < POOR && !other_model {
            // The other model is tried before shorter steps are.
            self.damping = raised;
        }
        if share > ENOUGH {
            self.here = there;
            self.steps += 1;
        }
    }
}

impl Local {
    /// Cost and priors at a point with a mass matrix.
    fn of(task: &Task, evaluations: &Evaluations, priors: &Priors, factor: f64, p: Vec<f64>) -> Option<Self> {
        if !task.has_mass(&p) {
            return None;
        }
        let quadratic = evaluations.quadratic(&p)?;
        let (mut gradient, mut matrix) = (quadratic.gradient.clone(), quadratic.gauss_newton.clone());
        priors.add_gradient(&p, &mut gradient);
        priors.add_hessian(&mut matrix);
        let value = factor * (quadratic.value + priors.value(&p));
        let (gradient, gauss_newton) = (task.scaled_vector(&gradient) * factor, task.scaled(&matrix) * factor);
        Some(Self { p, value, gradient, gauss_newton })
    }
}
