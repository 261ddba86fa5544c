//! From the start of a fit through Ipopt to the best point that was evaluated, with the priors weighed anew between solves.
//! It says where the fit ended and what stopped it; how sure the estimates are is the work of `covariance`.
//!
//! What keeps a solve from ending above its start:
//!
//! - Where hull coefficients are free, the barrier begins small beside the objective. Ipopt's own start (a barrier parameter of
//!   1 against a cost of 0.02 a sample) lets the barrier of a one-sided limit, such as R >= 0, push the parameters away to
//!   where no trajectory is followed; from there the way back is not found. The barrier parameter then only falls
//!   (`monotone`), so that each step must lower the cost. Without hull coefficients Ipopt's adaptive barrier takes fewer
//!   iterations.
//! - A trial point that cannot be simulated, or whose mass matrix cannot be inverted, has no value: the solver steps back.
//! - The best feasible point of all evaluations is kept; the solver starts again from it where it ended elsewhere.
//! - Where hull coefficients are free, shorter pieces of the runs are fitted first (see `stages`).

use super::constraints::Row;
use super::cost::Cost;
use super::error::FitError;
use super::problem::{Point, Priors, Problem, Progress};
use super::settings::Hessian;
use super::stages;
use super::subspace::inverse;
use super::task::{ActiveSet, Task};
use crate::ipopt::{self, Counts, HessianMode, IpoptError, OptionValue, Options, Solution, Status};
use crate::recording::Runs;

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
    /// The solver's own answer, where `p` is its optimum.
    solution: Option<Solution>,
    /// The solver's last answer, to say what it could not satisfy.
    last: Option<Solution>,
    evaluated: usize,
}

/// What is solved: a cost over runs, and where from.
struct Stage<'a> {
    cost: &'a Cost<'a>,
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
            cost: self.cost,
            tolerance: settings.tolerance,
            max_iterations: settings.max_iterations,
            near: false,
        };
        let mut priors = Priors::of(self.model);
        let rounds = if priors.terms.is_empty() { 1 } else { 1 + settings.prior_updates };
        let mut end: Option<Descent> = None;
        let mut p = from;
        for _ in 0..rounds {
            let value = self.cost.value(&p).ok_or_else(|| self.diverged())?;
            let weight = self.weight(self.cost, value);
            if end.is_some() && (weight - priors.weight).abs() <= SAME_WEIGHT * weight {
                break;
            }
            priors.weight = weight;
            let descent = self.descend(&stage, &p, &priors, &mut work, progress)?;
            p.clone_from(&descent.p);
            stage.near = descent.solution.is_some();
            end = Some(descent);
            if !stage.near {
                break;
            }
        }
        let Some(end) = end else { return Err(FitError::NothingFree) };
        self.check_feasible(&end)?;
        Ok(self.settle(end, priors, work, parts))
    }

    /// The start of the last stage: the fit's own start, or what fits shorter pieces of the runs where that is better.
    fn approach(
        &self,
        work: &mut Work,
        progress: &mut dyn FnMut(&Progress) -> bool,
    ) -> Result<(usize, Vec<f64>), FitError> {
        let parts = stages::parts(self);
        let mut p = self.start.clone();
        let mut priors = Priors::of(self.model);
        for parts in stages::falling(parts) {
            let (pieces, weights) = stages::cut(self.runs, self.cost.weights(), parts)?;
            let pieces = Runs::from(&pieces);
            let cost = Cost::weighted(self.cost.ranks(), self.model, pieces, weights, self.cost_options())?;
            let Some(value) = cost.value(&p) else { continue };
            priors.weight = self.weight(&cost, value);
            let stage = Stage {
                cost: &cost,
                tolerance: self.settings.tolerance.max(STAGE_TOLERANCE),
                max_iterations: self.settings.max_iterations.min(STAGE_ITERATIONS),
                near: false,
            };
            let descent = self.descend(&stage, &p, &priors, work, progress)?;
            p = descent.p;
            if descent.status == Status::Stopped {
                break;
            }
        }
        priors.weight = self.weight(self.cost, self.start_cost);
        let total = |p: &[f64]| Some(self.cost.value(p)? + priors.value(p));
        match (total(&p), total(&self.start)) {
            (Some(staged), Some(start)) if staged <= start || !self.is_feasible(&self.start) => Ok((parts, p)),
            (Some(_), None) => Ok((parts, p)),
            (_, Some(_)) => Ok((parts, self.start.clone())),
            (None, None) => Err(self.diverged()),
        }
    }

    /// Weight of the priors at a cost: see [`Priors`].
    fn weight(&self, cost: &Cost, value: f64) -> f64 {
        self.variance_of(cost, value) * self.settings.correlated_samples / cost.runs() as f64
    }

    fn options(&self, stage: &Stage, objective: f64, again: bool) -> Options {
        let number = |name: &str, value: f64| (name.to_owned(), OptionValue::Number(value));
        let near = stage.near || again;
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

    /// Solves from `from`, and again from the best feasible point where the solver ended above it.
    fn descend(
        &self,
        stage: &Stage,
        from: &[f64],
        priors: &Priors,
        work: &mut Work,
        progress: &mut dyn FnMut(&Progress) -> bool,
    ) -> Result<Descent, FitError> {
        let total = |p: &[f64]| Some(stage.cost.value(p)? + priors.value(p));
        let mut best = total(from).map(|total| Point { p: from.to_vec(), total });
        let feasible_start = self.is_feasible(from);
        if !feasible_start {
            best = None;
        }
        let mut evaluated = 0;
        let mut start = from.to_vec();
        for attempt in 0..=RESTARTS {
            let mut problem = Problem::new(self, stage.cost, priors, &start, progress);
            let objective = problem.factor * total(&start).unwrap_or(1.0);
            let outcome = ipopt::solve(&mut problem, &self.options(stage, objective, attempt > 0));
            let found = problem.best.take();
            evaluated += problem.evaluated;
            let (status, solution) = match outcome {
                Ok(solution) => (solution.status.clone(), Some(solution)),
                // The start could be evaluated, a point near it could not.
                Err(IpoptError::NoIterate { status }) => (status, None),
                Err(error) => return Err(error.into()),
            };
            if let Some(solution) = &solution {
                work.add(solution);
            }
            let at = solution.as_ref().map(|s| self.within_bounds(&self.unscaled(&s.x)));
            let better = found.filter(|f| best.as_ref().is_none_or(|b| f.total < b.total));
            let improved = better
                .as_ref()
                .is_some_and(|f| best.as_ref().is_none_or(|b| f.total < b.total - BETTER * b.total.abs()));
            best = better.or(best);
            let reached = at.as_ref().and_then(|p| total(p).filter(|_| self.has_mass(p)));
            let is_best = |value: f64| best.as_ref().is_none_or(|b| value <= b.total + BETTER * b.total.abs());
            if let (Some(p), Some(value), true) = (&at, reached, status.is_success())
                && is_best(value)
            {
                let better = best.filter(|b| b.total < value - SAME * value.abs());
                let p = better.map_or_else(|| p.clone(), |b| b.p);
                return Ok(Descent { p, status, last: solution.clone(), solution, evaluated });
            }
            let given_up = matches!(status, Status::Stopped | Status::MaxIterations { .. } | Status::Panicked(_));
            match &best {
                Some(best) if improved && attempt < RESTARTS && !given_up => start.clone_from(&best.p),
                _ => {
                    let fallback = || at.filter(|_| reached.is_some()).unwrap_or_else(|| from.to_vec());
                    let p = best.map_or_else(fallback, |b| b.p);
                    return Ok(Descent { p, status, solution: None, last: solution, evaluated });
                }
            }
        }
        Ok(Descent { p: start, status: Status::TinyStep, solution: None, last: None, evaluated })
    }

    fn unscaled(&self, z: &[f64]) -> Vec<f64> {
        z.iter().zip(&self.scales).map(|(z, s)| z * s).collect()
    }

    /// The better of where the solver ended and the start, with what holds it back and why it is the answer.
    fn settle(&self, end: Descent, priors: Priors, work: Work, parts: usize) -> End {
        let total = |p: &[f64]| self.cost.value(p).map_or(f64::INFINITY, |value| value + priors.value(p));
        let (here, there) = (total(&end.p), total(&self.start));
        let start_is_better = there < here - BETTER * here.abs() && self.is_feasible(&self.start);
        let p = if start_is_better { self.start.clone() } else { end.p };
        let solution = end.solution.filter(|_| !start_is_better);
        let words = match &solution {
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
        let active = match &solution {
            Some(solution) => self.active_set(&p, solution),
            None => self.touched(&p),
        };
        End { converged: solution.is_some(), words, p, priors, work, active, parts }
    }

    /// Infeasibility is an error where it is the constraints' own: they are linear, so that Ipopt's word is final.
    fn check_feasible(&self, end: &Descent) -> Result<(), FitError> {
        if !matches!(end.status, Status::Infeasible | Status::RestorationFailed) || self.is_feasible(&end.p) {
            return Ok(());
        }
        let p = end.last.as_ref().map_or_else(|| end.p.clone(), |s| self.within_bounds(&self.unscaled(&s.x)));
        let broken = |row: &&Row| row.violation(&p) / row.size(&self.scales);
        let worst = self.rows.iter().max_by(|a, b| broken(a).total_cmp(&broken(b)));
        match worst {
            Some(row) if broken(&row) > 1e-6 => {
                Err(FitError::Infeasible { rule: row.rule, sentence: row.sentence(&p), violation: row.violation(&p) })
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
            let slack = (value - row.lower).abs().min((row.upper - value).abs()) / row.size(&self.scales);
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

    /// Rows and bounds that a point touches, where no multipliers say which of them hold it back.
    fn touched(&self, p: &[f64]) -> ActiveSet {
        const TOUCH: f64 = 1e-6;
        let touches = |i: &usize| {
            let row = &self.rows[*i];
            let value = row.value(p);
            (value - row.lower).abs().min((row.upper - value).abs()) <= TOUCH * row.size(&self.scales)
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
            let broken = |row: &Row| row.violation(&moved) > row.violation(&end.p) + 1e-9 * row.size(&self.scales);
            if !moved.iter().enumerate().all(inside) || self.rows.iter().any(broken) || !self.has_mass(&moved) {
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

impl Work {
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
