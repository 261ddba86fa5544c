//! One solve through Ipopt from a start to the best point that was met, with restarts where it ended above that.
//! It takes objective, priors and limits as given; what is solved in which order is the work of `solve`.
//!
//! What keeps a solve from ending above its start:
//!
//! - A trial point that cannot be simulated, or whose mass matrix cannot be inverted, has no value: Ipopt steps back.
//! - The barrier begins small beside the objective and then only falls (`monotone`), so that each step must lower the cost. Ipopt's own
//!   start (a barrier parameter of 1 against a cost of 0.02 a sample) lets the barrier of a one-sided limit, such as R >= 0,
//!   push the parameters away to where no trajectory is followed; from there the way back is not found.
//! - The best feasible point of all evaluations is kept; Ipopt starts again from it where it ended elsewhere.

use super::curvature::Curvature;
use super::limits::{Stop, Watch};
use super::problem::{Point, Problem, Progress, Settled, Stage};
use super::rows::WorkingRows;
use super::subspace::inverse;
use super::task::{ActiveSet, KEPT, Task};
use crate::fit::error::FitError;
use crate::fit::settings::Hessian;
use crate::ipopt::{self, Counts, HessianMode, IpoptError, Multipliers, OptionValue, Options, Solution, Status};
use nalgebra::DMatrix;

/// Share of the cost by which a point must be better for the solver to start again from it: less is rounding, or the kinks of
/// a cost whose terms take absolute values.
pub(in crate::fit) const BETTER: f64 = 1e-4;

/// Share of the cost below which the solver's own answer is as good as the best point.
const SAME: f64 = 1e-9;

/// Curvature, as a share of the largest, that directions have which the data do not determine.
pub(in crate::fit) const UNDETERMINED: f64 = 1e-12;

/// Distance from a limit, in the sizes of rows, up to which a row is the solver's from the start.
const NEAR_ROW: f64 = 0.1;

/// Fall of the objective without a limit, in units of log-likelihood, below which the limit is not active: the optimum without it is a fifth of
/// a standard error beyond it.
const INFORMS: f64 = 0.02;

/// Barrier parameter at the start over what the objective may fall by. A thousand constraints then weigh about as much as the cost.
const BARRIER_SHARE: f64 = 1e-3;

/// The same, and how far a start is pushed away from its bounds, from a point near the optimum.
const NEAR_BARRIER_SHARE: f64 = 1e-6;
const NEAR_PUSH: f64 = 1e-8;

/// How far it is pushed where no multipliers are known: Ipopt sets those of bounds to 1, and from nearer bounds it takes dozens of steps until
/// they belong to the barrier.
const NEAR_PUSH_ALONE: f64 = 1e-4;

/// Iterations in a row after which an objective that changes no more ends a solve.
const SETTLED_ITERATIONS: i32 = 2;

/// What the solver took.
#[derive(Default)]
pub(in crate::fit) struct Work {
    pub iterations: usize,
    pub counts: Counts,
}

/// Where one solve, with its restarts, ended.
pub(in crate::fit) struct Descent {
    pub p: Vec<f64>,
    /// Ipopt's status at its end.
    pub status: Status,
    /// What ended it before that, where something else did.
    pub stop: Option<Stop>,
    /// The active limits at `p`, where it is the solver's optimum, with the multipliers.
    pub optimum: Option<(ActiveSet, Multipliers)>,
    /// Ipopt's last answer, to say what it could not satisfy.
    pub last: Option<Solution>,
    /// Whether `p` is within all limits.
    pub is_feasible: bool,
    pub evaluated: usize,
}

impl Descent {
    /// Whether the end may be a minimum: the solver's optimum, or a feasible point from which no step led down. Where terms take absolute
    /// values the slope of the cost jumps, and at a minimum there it is nowhere 0 as the solver asks.
    pub fn may_be_minimum(&self) -> bool {
        let stuck = matches!(
            self.status,
            Status::TinyStep | Status::RestorationFailed | Status::StepComputationFailed | Status::SolvedToAcceptable
        );
        self.optimum.is_some()
            || self.is_feasible && (stuck && self.stop.is_none() || self.stop == Some(Stop::NoProgress))
    }
}

/// What all solves of a fit share.
pub(in crate::fit) struct Shared<'f, 'w> {
    pub watch: Watch<'w>,
    pub work: Work,
    pub progress: &'f mut dyn FnMut(&Progress) -> bool,
    /// Constraint rows that the solver gets.
    pub rows: WorkingRows,
}

/// Where a solve starts.
pub(in crate::fit) struct From<'a> {
    pub p: &'a [f64],
    /// Whether it is near the optimum: the barrier then starts lower still, and the bounds do not push the start away.
    pub near: bool,
    /// The multipliers there, where they are known.
    pub multipliers: Option<Multipliers>,
}

/// What one run of Ipopt left.
struct Attempt {
    status: Status,
    solution: Option<Solution>,
    /// Where it ended, put back within the bounds.
    at: Option<Vec<f64>>,
    /// The best feasible point it met.
    best: Option<Point>,
    evaluated: usize,
}

impl Task<'_> {
    /// Solves through Ipopt, and again from the best feasible point where it ended above that.
    pub fn descend(
        &self,
        stage: &Stage,
        from: From,
        curvature: &mut Curvature,
        shared: &mut Shared,
    ) -> Result<Descent, FitError> {
        let start = from.p.to_vec();
        let mut best =
            stage.total(&start).filter(|_| self.is_feasible(&start)).map(|total| Point { p: start.clone(), total });
        if shared.watch.is_over() {
            let (is_feasible, stop) = (best.is_some(), shared.watch.stop());
            let status = Status::Stopped;
            return Ok(Descent { p: start, status, stop, optimum: None, last: None, is_feasible, evaluated: 0 });
        }
        let (mut evaluated, mut restarts, mut from) = (0, 0, From { p: &start, ..from });
        let mut again: Vec<f64>;
        shared.rows.take(self, stage.scaling, from.p, NEAR_ROW);
        loop {
            let attempt = self.attempt(stage, &from, curvature, shared)?;
            evaluated += attempt.evaluated;
            let Attempt { status, solution, at, best: found, .. } = attempt;
            best = found.filter(|f| best.as_ref().is_none_or(|b| f.total < b.total)).or(best);
            let reached = at.as_ref().and_then(|p| stage.total(p).filter(|_| self.has_mass(p)));
            let given_up =
                shared.watch.is_over() || matches!(status, Status::Panicked(_) | Status::MaxIterations { .. });
            // A row that was left out and is broken joins the others.
            if let Some(p) = at.as_ref().filter(|_| !given_up)
                && shared.rows.take(self, stage.scaling, p, -KEPT)
            {
                again = p.clone();
                from = From { p: &again, near: true, multipliers: solution.map(|s| s.multipliers) };
                continue;
            }
            let is_best = |value: f64| best.as_ref().is_none_or(|b| value <= b.total + BETTER * b.total.abs());
            if let (Some(p), Some(value), Some(solution)) = (&at, reached, &solution)
                && status.is_success()
                && is_best(value)
            {
                let better = best.filter(|b| b.total < value - SAME * value.abs());
                let p = better.map_or_else(|| p.clone(), |b| b.p);
                let active = self.active_set(stage, &p, &solution.multipliers);
                let optimum = Some((active, solution.multipliers.clone()));
                let is_feasible = self.is_feasible(&p);
                return Ok(Descent { p, status, stop: None, optimum, last: None, is_feasible, evaluated });
            }
            match &best {
                // Not from where this attempt began already.
                Some(best) if best.p != from.p && restarts < stage.restarts && !given_up => again = best.p.clone(),
                _ => {
                    let fallback = || at.filter(|_| reached.is_some()).unwrap_or_else(|| start.clone());
                    let p = best.map_or_else(fallback, |b| b.p);
                    let stop = shared.watch.stop();
                    let is_feasible = self.is_feasible(&p);
                    return Ok(Descent { p, status, stop, optimum: None, last: solution, is_feasible, evaluated });
                }
            }
            (restarts, from) = (restarts + 1, From { p: &again, near: true, multipliers: None });
        }
    }

    /// One run of Ipopt.
    fn attempt(
        &self,
        stage: &Stage,
        from: &From,
        curvature: &mut Curvature,
        shared: &mut Shared,
    ) -> Result<Attempt, FitError> {
        shared.watch.begin();
        let before = shared.watch.evaluations();
        curvature.leave();
        let options = self.options(stage, from);
        let rows = shared.rows.indices();
        let mut problem = Problem {
            task: self,
            stage: *stage,
            start: from.p,
            rows: &rows,
            multipliers: from.multipliers.clone(),
            curvature,
            watch: &mut shared.watch,
            progress: shared.progress,
            best: None,
            trials: 0,
        };
        let (status, iterations, counts, mut solution) = match ipopt::solve(&mut problem, &options) {
            Ok(solution) => (solution.status.clone(), solution.iterations, solution.counts, Some(solution)),
            // The start could be evaluated, a point near it could not; or the limits left no evaluation for the end.
            Err(IpoptError::NoIterate { status, iterations, counts }) => (status, iterations, counts, None),
            Err(error) => return Err(error.into()),
        };
        shared.work.add(iterations, &counts);
        let at = solution.as_ref().map(|s| self.within_bounds(&problem.unscaled(&s.x)));
        let best = problem.best.take();
        let evaluated = shared.watch.evaluations() - before;
        if let Some(solution) = &mut solution {
            let multipliers = &mut solution.multipliers;
            multipliers.constraints = shared.rows.of_all(&multipliers.constraints);
        }
        Ok(Attempt { status, solution, at, best, evaluated })
    }

    fn options(&self, stage: &Stage, from: &From) -> Options {
        let number = |name: &str, value: f64| (name.to_owned(), OptionValue::Number(value));
        let objective = stage.evaluations.objective;
        let reach = objective.factor() * objective.reach(stage.total(from.p).unwrap_or(1.0));
        let share = if from.near { NEAR_BARRIER_SHARE } else { BARRIER_SHARE };
        let mut extra = vec![
            ("mu_strategy".to_owned(), OptionValue::Text("monotone".to_owned())),
            number("mu_init", (share * reach).max(0.1 * stage.tolerance)),
            // Rows and variables are scaled already: to let MUMPS do it again takes a third of its time.
            ("mumps_permuting_scaling".to_owned(), OptionValue::Integer(0)),
            ("mumps_scaling".to_owned(), OptionValue::Integer(0)),
        ];
        if let Some(Settled { gradient, change }) = stage.settled {
            extra.push(number("acceptable_tol", gradient));
            extra.push(number("acceptable_obj_change_tol", change));
            extra.push(("acceptable_iter".to_owned(), OptionValue::Integer(SETTLED_ITERATIONS)));
        }
        if from.near {
            let pushes = ["bound_push", "bound_frac", "slack_bound_push", "slack_bound_frac"];
            let warm = ["", "warm_start_"].into_iter().flat_map(|kind| pushes.map(|name| format!("{kind}{name}")));
            let push = if from.multipliers.is_some() { NEAR_PUSH } else { NEAR_PUSH_ALONE };
            extra.extend(warm.map(|name| number(&name, push)));
        }
        Options {
            tolerance: stage.tolerance,
            max_iterations: stage.max_iterations,
            hessian: match stage.hessian {
                Hessian::LimitedMemory => HessianMode::LimitedMemory { history: self.settings.history },
                Hessian::GaussNewton | Hessian::Exact => HessianMode::Given,
            },
            linear_constraints: true,
            print: self.settings.print,
            extra,
            ..Options::default()
        }
    }

    /// The active limits at a solution. Without the limit, whose multiplier is y and whose normal is a, the point would move by
    /// `y a' H^-1 a` across it (H the curvature of the objective), and that is more than its distance from it. An interior-point solution keeps
    /// a distance of the barrier parameter over y from an active limit, so that neither y nor the distance shows alone whether it is active.
    /// The objective would fall by `y^2 a' H^-1 a / 2`: where that is next to nothing, along what the data do not determine, the limit says
    /// nothing of the estimates.
    fn active_set(&self, stage: &Stage, p: &[f64], multipliers: &Multipliers) -> ActiveSet {
        let n = p.len();
        let yielding = stage.local(p).map(|local| {
            let ridge = UNDETERMINED * local.gauss_newton.diagonal().max();
            let matrix = local.gauss_newton + DMatrix::identity(n, n) * ridge;
            // M residuals of variance 2 f / M: a unit of log-likelihood.
            let unit = 2.0 * local.value / self.cost.residuals().max(1) as f64;
            (inverse(&matrix, &DMatrix::identity(n, n)).matrix, INFORMS * unit)
        });
        let (yielding, least) = yielding.unwrap_or_else(|| (DMatrix::identity(n, n), 0.0));
        let is_active = |multiplier: f64, along: f64, slack: f64| {
            multiplier.abs() * along > slack.abs() && 0.5 * multiplier * multiplier * along > least
        };
        let rows = multipliers.constraints.iter().enumerate().filter(|(i, multiplier)| {
            let (row, normal) = (&self.rows[*i], self.normal(stage.scaling, *i));
            let value = row.value(p);
            let slack = (value - row.lower).abs().min((row.upper - value).abs()) / stage.scaling.sizes[*i];
            is_active(**multiplier, (&yielding * &normal).dot(&normal), slack)
        });
        let mut bounds = Vec::new();
        for (j, (lower, upper)) in self.bounds.iter().enumerate() {
            let (scale, along) = (stage.scaling.scales[j], yielding[(j, j)]);
            if is_active(multipliers.lower[j], along, (p[j] - lower) / scale) {
                bounds.push((j, "lower"));
            } else if is_active(multipliers.upper[j], along, (upper - p[j]) / scale) {
                bounds.push((j, "upper"));
            }
        }
        ActiveSet { rows: rows.map(|(i, _)| i).collect(), bounds }
    }
}

impl Work {
    /// Adds the work of a stage, its evaluations by the share of all samples that each of them took.
    pub fn join(&mut self, stage: &Self, share: f64) {
        self.iterations += stage.iterations;
        let part = |count: usize| (share.min(1.0) * count as f64).ceil() as usize;
        let (sum, counts) = (&mut self.counts, &stage.counts);
        sum.objective += part(counts.objective);
        sum.gradient += part(counts.gradient);
        sum.constraints += counts.constraints;
        sum.jacobian += counts.jacobian;
        sum.hessian += part(counts.hessian);
    }

    fn add(&mut self, iterations: usize, counts: &Counts) {
        self.iterations += iterations;
        let sum = &mut self.counts;
        sum.objective += counts.objective;
        sum.gradient += counts.gradient;
        sum.constraints += counts.constraints;
        sum.jacobian += counts.jacobian;
        sum.hessian += counts.hessian;
    }
}
