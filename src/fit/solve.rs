//! From the start of a fit to the best point that was evaluated, with the priors weighed anew between solves.
//! It says where the fit ended and what stopped it; how sure the estimates are is the work of `covariance`.
//!
//! With the Gauss-Newton matrix a fit is solved by steps within its limits (see `steps`), which take the fewest evaluations. Ipopt
//! solves what these do not: with another Hessian, and where they find no optimum. What keeps a solve from ending above its
//! start:
//!
//! - A trial point that cannot be simulated, or whose mass matrix cannot be inverted, has no value: the solver steps back.
//! - Where hull coefficients are free, Ipopt's barrier begins small beside the objective. Its own start (a barrier parameter of
//!   1 against a cost of 0.02 a sample) lets the barrier of a one-sided limit, such as R >= 0, push the parameters away to
//!   where no trajectory is followed; from there the way back is not found. The barrier parameter then only falls
//!   (`monotone`), so that each step must lower the cost. Without hull coefficients Ipopt's adaptive barrier takes fewer
//!   iterations.
//! - The best feasible point of all of Ipopt's evaluations is kept; it starts again from it where it ended elsewhere.
//! - Where hull coefficients are free, shorter pieces of the runs are fitted first; of many runs, a few (see `stages`).

use super::constraints::Row;
use super::cost::Cost;
use super::error::FitError;
use super::evaluations::Evaluations;
use super::problem::{Point, Priors, Problem, Progress};
use super::settings::Hessian;
use super::stages::{self, Sample};
use super::steps::{Residual, Walk};
use super::subspace::inverse;
use super::task::{ActiveSet, Task};
use crate::ipopt::{self, Counts, HessianMode, IpoptError, OptionValue, Options, Solution, Status};
use crate::recording::Runs;
use nalgebra::{DMatrix, DVector};

/// How often the solver starts again from a better point that it left.
const RESTARTS: usize = 3;

/// Share of the cost by which a point must be better for the solver to start again from it: less is rounding, or the kinks of
/// a cost whose terms take absolute values.
const BETTER: f64 = 1e-4;

/// Share of the cost below which the solver's own answer is as good as the best point.
const SAME: f64 = 1e-9;

/// Share of the weight of the priors below which a change of it changes nothing.
const SAME_WEIGHT: f64 = 1e-3;

/// Barrier parameter at the start over the objective there. A thousand constraints then weigh about as much as the cost.
const BARRIER_SHARE: f64 = 1e-3;

/// Share of the cost that its rounding may hide.
const ROUNDING: f64 = 1e-12;

/// Iterations of a fit to shorter pieces, and its tolerance: it only has to bring the fit near.
const STAGE_ITERATIONS: usize = 100;
const STAGE_TOLERANCE: f64 = 1e-6;

/// Where a fit ended.
pub(super) struct End {
    pub p: Vec<f64>,
    pub priors: Priors,
    /// Whether `p` is the solver's optimum.
    pub converged: bool,
    /// How the fit ended, in words.
    pub words: String,
    pub work: Work,
    pub active: ActiveSet,
    /// Parts into which runs were cut for the first stage; 1 without stages.
    pub parts: usize,
}

/// What the solver took.
#[derive(Default)]
pub(super) struct Work {
    pub iterations: usize,
    pub counts: Counts,
}

/// Where one solve, with its restarts, ended.
struct Descent {
    p: Vec<f64>,
    status: Status,
    /// What holds `p` back, where it is the solver's optimum.
    active: Option<ActiveSet>,
    /// Ipopt's last answer, to say what it could not satisfy.
    last: Option<Solution>,
    evaluated: usize,
}

/// How Ipopt is set out.
#[derive(Clone, Copy, PartialEq)]
enum Way {
    /// From a point far from the optimum.
    Whole,
    /// From a point near the optimum.
    Again,
}

/// A step in scaled parameters, and by how much a quadratic model of the cost expects it to fall.
struct NewtonStep {
    direction: DVector<f64>,
    gain: f64,
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

/// What is solved: a cost over runs, and where from.
struct Stage<'a> {
    evaluations: &'a Evaluations<'a>,
    tolerance: f64,
    max_iterations: usize,
    /// Whether the start is near the optimum: the barrier then starts lower still, and the bounds do not push the start away.
    near: bool,
}

impl Task<'_> {
    /// Solves in stages, and where there are priors solves again with their weight set by the residuals just found.
    pub fn solve(&self, progress: &mut dyn FnMut(&Progress) -> bool) -> Result<End, FitError> {
        let mut work = Work::default();
        let (parts, from) = self.approach(&mut work, progress)?;
        let settings = self.settings;
        let mut stage = Stage {
            evaluations: &self.evaluations,
            tolerance: settings.tolerance,
            max_iterations: settings.max_iterations,
            near: false,
        };
        let mut priors = Priors::of(self.model);
        let rounds = if priors.terms.is_empty() { 1 } else { 1 + settings.prior_updates };
        let mut end: Option<Descent> = None;
        let mut p = from;
        let mut residual = Residual::unknown(p.len());
        for _ in 0..rounds {
            let value = self.evaluations.value(&p).ok_or_else(|| self.diverged())?;
            let weight = self.weight(self.cost, value);
            if end.is_some() && (weight - priors.weight).abs() <= SAME_WEIGHT * weight {
                break;
            }
            priors.weight = weight;
            let descent = self.descend(&stage, &p, &priors, &mut residual, &mut work, progress)?;
            p.clone_from(&descent.p);
            stage.near = descent.active.is_some();
            end = Some(descent);
            if !stage.near {
                break;
            }
        }
        let Some(end) = end else { return Err(FitError::NothingFree) };
        self.check_feasible(&end)?;
        Ok(self.settle(end, priors, work, parts))
    }

    /// The start of the last stage: the fit's own start, or what fits shorter pieces or a few of the runs where that is better.
    fn approach(
        &self,
        work: &mut Work,
        progress: &mut dyn FnMut(&Progress) -> bool,
    ) -> Result<(usize, Vec<f64>), FitError> {
        let parts = stages::parts(self);
        if parts < 2 && !self.start_cost.is_finite() {
            return Err(self.diverged());
        }
        let mut p = self.start.clone();
        let mut priors = Priors::of(self.model);
        for sample in Sample::stages(self, parts) {
            let (runs, weights) = sample.draw(self.runs, self.cost.weights())?;
            let runs = Runs::from(&runs);
            let cost = match Cost::weighted(self.cost.ranks(), self.model, runs, weights, self.cost_options()) {
                // None was drawn.
                Err(FitError::NoRuns) => continue,
                cost => cost?,
            };
            let evaluations = Evaluations::of(&cost);
            let Some(value) = evaluations.value(&p) else { continue };
            priors.weight = self.weight(&cost, value);
            let stage = Stage {
                evaluations: &evaluations,
                tolerance: self.settings.tolerance.max(STAGE_TOLERANCE),
                max_iterations: self.settings.max_iterations.min(STAGE_ITERATIONS),
                near: false,
            };
            let mut own = Work::default();
            let descent = self.descend(&stage, &p, &priors, &mut Residual::unknown(p.len()), &mut own, progress)?;
            work.join(&own, cost.samples() as f64 / self.cost.samples() as f64);
            p = descent.p;
            if descent.status == Status::Stopped {
                break;
            }
        }
        Ok((parts, self.better_start(p, priors)?))
    }

    /// The better of where the stages ended and the fit's own start.
    fn better_start(&self, p: Vec<f64>, mut priors: Priors) -> Result<Vec<f64>, FitError> {
        if p == self.start {
            return Ok(p);
        }
        priors.weight = self.weight(self.cost, self.start_cost);
        // Where the steps begin at the end of the stages, they need the derivatives there.
        let value = match self.settings.hessian {
            Hessian::GaussNewton => self.evaluations.quadratic(&p).map(|quadratic| quadratic.value),
            _ => self.evaluations.value(&p),
        };
        let staged = value.map(|value| value + priors.value(&p));
        let start = Some(self.start_cost + priors.value(&self.start)).filter(|total| total.is_finite());
        match (staged, start) {
            (Some(staged), Some(start)) if staged <= start || !self.is_feasible(&self.start) => Ok(p),
            (Some(_), None) => Ok(p),
            (_, Some(_)) => Ok(self.start.clone()),
            (None, None) => Err(self.diverged()),
        }
    }

    /// Weight of the priors at a cost: see [`Priors`].
    fn weight(&self, cost: &Cost, value: f64) -> f64 {
        self.variance_of(cost, value) * self.settings.correlated_samples / cost.runs() as f64
    }

    fn options(&self, stage: &Stage, objective: f64, way: Way) -> Options {
        let number = |name: &str, value: f64| (name.to_owned(), OptionValue::Number(value));
        let near = stage.near || way == Way::Again;
        let strategy = |word: &str| ("mu_strategy".to_owned(), OptionValue::Text(word.to_owned()));
        let mut extra = vec![strategy("adaptive")];
        if near || stages::frees_hull(self) {
            let barrier = if near { 1e-3 * BARRIER_SHARE } else { BARRIER_SHARE };
            extra = vec![strategy("monotone"), number("mu_init", (barrier * objective).max(0.1 * stage.tolerance))];
        }
        if near {
            let pushes = ["bound_push", "bound_frac", "slack_bound_push", "slack_bound_frac"];
            extra.extend(pushes.map(|name| number(name, 1e-8)));
        }
        Options {
            tolerance: stage.tolerance,
            max_iterations: stage.max_iterations,
            hessian: match self.settings.hessian {
                Hessian::LimitedMemory => HessianMode::LimitedMemory { history: self.settings.history },
                Hessian::GaussNewton | Hessian::Exact => HessianMode::Given,
            },
            linear_constraints: true,
            print: self.settings.print,
            extra,
            ..Options::default()
        }
    }

    /// Solves from `from`: by Gauss-Newton steps within the limits, and through Ipopt where these find no optimum.
    fn descend(
        &self,
        stage: &Stage,
        from: &[f64],
        priors: &Priors,
        residual: &mut Residual,
        work: &mut Work,
        progress: &mut dyn FnMut(&Progress) -> bool,
    ) -> Result<Descent, FitError> {
        if self.settings.hessian != Hessian::GaussNewton {
            return self.through_ipopt(stage, from, priors, work, progress);
        }
        let limit = (stage.tolerance, stage.max_iterations);
        let Some(walk) = self.walk(stage.evaluations, from, priors, residual, limit, progress) else {
            return self.through_ipopt(stage, from, priors, work, progress);
        };
        work.walked(&walk);
        let Walk { status, p, evaluated, active, .. } = walk;
        match status {
            Status::Solved => Ok(Descent { p, status, active: Some(active), last: None, evaluated }),
            Status::Stopped | Status::MaxIterations { .. } => {
                Ok(Descent { p, status, active: None, last: None, evaluated })
            }
            _ => self.through_ipopt(stage, &p, priors, work, progress),
        }
    }

    /// Solves through Ipopt, and again from the best feasible point where it ended above that.
    fn through_ipopt(
        &self,
        stage: &Stage,
        from: &[f64],
        priors: &Priors,
        work: &mut Work,
        progress: &mut dyn FnMut(&Progress) -> bool,
    ) -> Result<Descent, FitError> {
        let total = |p: &[f64]| Some(stage.evaluations.value(p)? + priors.value(p));
        let mut best = total(from).filter(|_| self.is_feasible(from)).map(|total| Point { p: from.to_vec(), total });
        let mut start = from.to_vec();
        let mut evaluated = 0;
        let mut restarts = 0;
        let mut way = Way::Whole;
        loop {
            let attempt = self.attempt(stage, &start, way, priors, work, progress)?;
            evaluated += attempt.evaluated;
            let Attempt { status, solution, at, best: found, .. } = attempt;
            let better = found.filter(|f| best.as_ref().is_none_or(|b| f.total < b.total));
            let improved = better
                .as_ref()
                .is_some_and(|f| best.as_ref().is_none_or(|b| f.total < b.total - BETTER * b.total.abs()));
            best = better.or(best);
            let reached = at.as_ref().and_then(|p| total(p).filter(|_| self.has_mass(p)));
            let is_best = |value: f64| best.as_ref().is_none_or(|b| value <= b.total + BETTER * b.total.abs());
            if let (Some(p), Some(value), Some(solution)) = (&at, reached, &solution)
                && status.is_success()
                && is_best(value)
            {
                let better = best.filter(|b| b.total < value - SAME * value.abs());
                let p = better.map_or_else(|| p.clone(), |b| b.p);
                let active = Some(self.active_set(&p, solution));
                return Ok(Descent { p, status, active, last: None, evaluated });
            }
            let given_up = matches!(status, Status::Stopped | Status::Panicked(_) | Status::MaxIterations { .. });
            match &best {
                Some(best) if improved && restarts < RESTARTS && !given_up => start.clone_from(&best.p),
                _ => {
                    let fallback = || at.filter(|_| reached.is_some()).unwrap_or_else(|| from.to_vec());
                    let p = best.map_or_else(fallback, |b| b.p);
                    return Ok(Descent { p, status, active: None, last: solution, evaluated });
                }
            }
            (restarts, way) = (restarts + 1, Way::Again);
        }
    }

    /// One run of Ipopt.
    fn attempt(
        &self,
        stage: &Stage,
        start: &[f64],
        way: Way,
        priors: &Priors,
        work: &mut Work,
        progress: &mut dyn FnMut(&Progress) -> bool,
    ) -> Result<Attempt, FitError> {
        let mut problem = Problem::new(self, stage.evaluations, priors, start, progress);
        let total = stage.evaluations.value(start).map(|value| value + priors.value(start));
        let objective = problem.factor * total.unwrap_or(1.0);
        let (status, solution) = match ipopt::solve(&mut problem, &self.options(stage, objective, way)) {
            Ok(solution) => (solution.status.clone(), Some(solution)),
            // The start could be evaluated, a point near it could not.
            Err(IpoptError::NoIterate { status }) => (status, None),
            Err(error) => return Err(error.into()),
        };
        if let Some(solution) = &solution {
            work.add(solution);
        }
        let at = solution.as_ref().map(|s| self.within_bounds(&problem.unscaled(&s.x)));
        Ok(Attempt { status, solution, at, best: problem.best.take(), evaluated: problem.evaluated })
    }

    fn unscaled(&self, z: &[f64]) -> Vec<f64> {
        z.iter().zip(&self.scales).map(|(z, s)| z * s).collect()
    }

    /// The better of where the solver ended and the start, with what holds it back and why it is the answer.
    fn settle(&self, end: Descent, priors: Priors, work: Work, parts: usize) -> End {
        let here = self.evaluations.value(&end.p).map_or(f64::INFINITY, |value| value + priors.value(&end.p));
        let there = self.start_cost + priors.value(&self.start);
        let start_is_better = there < here - BETTER * here.abs() && self.is_feasible(&self.start);
        let p = if start_is_better { self.start.clone() } else { end.p };
        let active = end.active.filter(|_| !start_is_better);
        let words = match &active {
            Some(_) => end.status.to_string(),
            None if start_is_better || p == self.start => format!(
                "no point better than the start was found in {} evaluations, and the start is returned; the solver says: {}",
                end.evaluated, end.status
            ),
            None => format!(
                "the best feasible point of {} evaluations is returned, which the solver does not hold for an optimum; it says: {}",
                end.evaluated, end.status
            ),
        };
        let converged = active.is_some();
        let active = active.unwrap_or_else(|| self.touched(&p));
        End { converged, words, p, priors, work, active, parts }
    }

    /// Infeasibility is an error where it is the constraints' own: they are linear, so that Ipopt's word is final.
    fn check_feasible(&self, end: &Descent) -> Result<(), FitError> {
        if !matches!(end.status, Status::Infeasible | Status::RestorationFailed) || self.is_feasible(&end.p) {
            return Ok(());
        }
        let p = end.last.as_ref().map_or_else(|| end.p.clone(), |s| self.within_bounds(&self.unscaled(&s.x)));
        let broken = |i: usize| self.rows[i].violation(&p) / self.sizes[i];
        let worst = (0..self.rows.len()).max_by(|a, b| broken(*a).total_cmp(&broken(*b)));
        match worst {
            Some(worst) if broken(worst) > 1e-6 => {
                let row = &self.rows[worst];
                Err(FitError::Infeasible { rule: row.rule, sentence: row.sentence(&p), violation: row.violation(&p) })
            }
            _ => Ok(()),
        }
    }

    /// What holds the solution back: the multiplier exceeds the distance from the limit, both in solver units.
    fn active_set(&self, p: &[f64], solution: &Solution) -> ActiveSet {
        let least = 1e3 * self.settings.tolerance * self.settings.tolerance.min(1e-3);
        let is_active = |multiplier: f64, slack: f64| multiplier.abs() > slack.abs().max(least);
        let multipliers = solution.constraint_multipliers.iter().enumerate();
        let rows = multipliers.filter(|(i, multiplier)| {
            let row = &self.rows[*i];
            let value = row.value(p);
            let slack = (value - row.lower).abs().min((row.upper - value).abs()) / self.sizes[*i];
            is_active(**multiplier, slack)
        });
        let mut bounds = Vec::new();
        for (j, (lower, upper)) in self.bounds.iter().enumerate() {
            if is_active(solution.lower_bound_multipliers[j], (p[j] - lower) / self.scales[j]) {
                bounds.push((j, "lower"));
            } else if is_active(solution.upper_bound_multipliers[j], (upper - p[j]) / self.scales[j]) {
                bounds.push((j, "upper"));
            }
        }
        ActiveSet { rows: rows.map(|(i, _)| i).collect(), bounds }
    }

    /// Rows and bounds that a point touches, where no multipliers say which of them hold it back.
    fn touched(&self, p: &[f64]) -> ActiveSet {
        const TOUCH: f64 = 1e-6;
        let touches = |i: &usize| {
            let row = &self.rows[*i];
            let value = row.value(p);
            (value - row.lower).abs().min((row.upper - value).abs()) <= TOUCH * self.sizes[*i]
        };
        let mut bounds = Vec::new();
        for (j, (lower, upper)) in self.bounds.iter().enumerate() {
            if (p[j] - lower).abs() <= TOUCH * self.scales[j] {
                bounds.push((j, "lower"));
            } else if (upper - p[j]).abs() <= TOUCH * self.scales[j] {
                bounds.push((j, "upper"));
            }
        }
        ActiveSet { rows: (0..self.rows.len()).filter(touches).collect(), bounds }
    }

    /// Newton steps within the active constraints: an interior-point solution keeps a distance of the order of its barrier
    /// from every limit and is blurred along directions of little curvature.
    pub fn polish(&self, end: &mut End) {
        if !end.converged {
            return;
        }
        let z = self.free_directions(&end.active);
        let total = |p: &[f64]| Some(self.evaluations.value(p)? + end.priors.value(p));
        let (Some(mut best), Some(mut step)) = (total(&end.p), self.newton_step(&end.p, &end.priors, &z)) else {
            return;
        };
        let start = self.start_cost + end.priors.value(&self.start);
        for _ in 0..self.settings.polish_steps {
            let moved: Vec<f64> = (0..end.p.len()).map(|j| end.p[j] + step.direction[j] * self.scales[j]).collect();
            let inside = |(j, p): (usize, &f64)| *p >= self.bounds[j].0 && *p <= self.bounds[j].1;
            let broken = |(row, size): (&Row, &f64)| row.violation(&moved) > row.violation(&end.p) + 1e-9 * size;
            let outside = !moved.iter().enumerate().all(inside) || self.rows.iter().zip(&self.sizes).any(broken);
            if outside || !self.has_mass(&moved) || step.gain <= f64::EPSILON * best {
                return;
            }
            let Some(next) = self.newton_step(&moved, &end.priors, &z) else { return };
            let Some(value) = total(&moved) else { return };
            // A gain that the rounding of the cost hides still shows in the gradient.
            let hidden = step.gain <= ROUNDING * best
                && next.gain < step.gain
                && value <= best * (1.0 + ROUNDING)
                && value <= start;
            if !(value < best || hidden) {
                return;
            }
            (end.p, best, step) = (moved, value, next);
        }
    }

    /// The step to the minimum of the cost's quadratic model within the span of `directions`.
    fn newton_step(&self, p: &[f64], priors: &Priors, directions: &DMatrix<f64>) -> Option<NewtonStep> {
        let quadratic = self.evaluations.quadratic(p)?;
        let (mut gradient, mut hessian) = (quadratic.gradient.clone(), quadratic.gauss_newton.clone());
        if self.settings.hessian == Hessian::Exact {
            hessian = self.cost.hessian(p)?;
        }
        priors.add_gradient(p, &mut gradient);
        priors.add_hessian(&mut hessian);
        let gradient = self.scaled_vector(&gradient);
        let direction = -(inverse(&self.scaled(&hessian), directions).matrix * &gradient);
        Some(NewtonStep { gain: -0.5 * direction.dot(&gradient), direction })
    }
}

impl Work {
    /// Adds the work of a stage, its evaluations by the share of all samples that each of them took.
    fn join(&mut self, stage: &Self, share: f64) {
        self.iterations += stage.iterations;
        let part = |count: usize| (share.min(1.0) * count as f64).ceil() as usize;
        let (sum, counts) = (&mut self.counts, &stage.counts);
        sum.objective += part(counts.objective);
        sum.gradient += part(counts.gradient);
        sum.constraints += counts.constraints;
        sum.jacobian += counts.jacobian;
        sum.hessian += part(counts.hessian);
    }

    fn walked(&mut self, walk: &Walk) {
        self.iterations += walk.steps;
        let counts = &mut self.counts;
        for count in [&mut counts.objective, &mut counts.gradient, &mut counts.hessian] {
            *count += walk.evaluated;
        }
    }

    fn add(&mut self, solution: &Solution) {
        self.iterations += solution.iterations;
        let (sum, counts) = (&mut self.counts, &solution.counts);
        sum.objective += counts.objective;
        sum.gradient += counts.gradient;
        sum.constraints += counts.constraints;
        sum.jacobian += counts.jacobian;
        sum.hessian += counts.hessian;
    }
}
