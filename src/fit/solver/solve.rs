//! From the start of a fit through its stages to an optimum that was checked, with the priors weighed anew between solves.
//! It says where the fit ended and what stopped it; how uncertain the estimates are is the work of `covariance`.
//!
//! Shorter pieces of the runs are fitted first where errors grow too fast for whole runs; of many runs, a few (see `stages`).
//! An optimum is only called one after a second solve from a disturbed point near it, by another Hessian (limited memory), found
//! no lower cost; where it does find one, the fit goes on from there.

use super::constraints::Row;
use super::curvature::{Curvature, Local};
use super::descent::{BETTER, Descent, From, Shared, UNDETERMINED, Work};
use super::limits::Watch;
use super::problem::{ALL, CHECK, Priors, Progress, Stage};
use super::rows::WorkingRows;
use super::scaling::Scaling;
use super::stages::{self, Sample};
use super::subspace::inverse;
use super::task::{ActiveSet, Task};
use crate::fit::error::FitError;
use crate::fit::objectives::cost::Cost;
use crate::fit::objectives::evaluations::Evaluations;
use crate::fit::settings::{FitSettings, Hessian};
use crate::ipopt::{Multipliers, Status};
use crate::recording::{RunStore, Runs};
use crate::state::STATES;
use nalgebra::{DMatrix, DVector};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// Share of the weight of the priors below which a change of it changes nothing.
const SAME_WEIGHT: f64 = 1e-3;

/// Share of the cost that its rounding may hide.
const ROUNDING: f64 = 1e-12;

/// How often the solver starts again from a better point that it left.
const RESTARTS: usize = 3;

/// Iterations of a fit to shorter pieces or to a few runs, and its tolerance: it only has to bring the fit near.
const STAGE_ITERATIONS: usize = 100;
const STAGE_TOLERANCE: f64 = 1e-6;

/// Distance from a limit, in units of its size, at which a point touches it.
const TOUCH: f64 = 1e-6;

/// The check of an optimum: its seed, the rise of the cost by the disturbance as a share of the cost, the largest change of a parameter
/// in units of its scale, the share of the way to the nearest limit, iterations of the second solve, and the share of what it looks for that
/// its tolerance leaves: in units of unit curvature a gradient g predicts a fall of g^2/2.
const CHECK_SEED: u64 = 20_261_126;
const CHECK_RISE: f64 = 0.05;
const CHECK_REACH: f64 = 0.5;
const CHECK_ROOM: f64 = 0.9;
const CHECK_ITERATIONS: usize = 50;
const CHECK_LEFT: f64 = 1e-4;

/// Objective, as the solver counts it, below which nothing is left to be found: 1e-6 of what residuals are measured in.
const NOTHING_LEFT: f64 = 1e-12;

/// Where a fit ended.
pub(in crate::fit) struct End {
    pub p: Vec<f64>,
    pub priors: Priors,
    /// Whether `p` is the solver's optimum, and no lower cost was found near it.
    pub converged: bool,
    /// How the fit ended, in words.
    pub words: String,
    /// The solver's own name for it.
    pub solver: &'static str,
    /// How often an optimum was checked by a second solve, and how many of these found a lower cost.
    pub checks: [usize; 2],
    pub work: Work,
    pub active: ActiveSet,
    /// Parts into which runs were cut for the first stage; 1 without stages.
    pub parts: usize,
}

/// What the second solve of a check minimises: the objective itself, or that of a few of the runs.
#[derive(Clone, Copy)]
pub(in crate::fit) struct Search<'a> {
    pub evaluations: &'a Evaluations<'a>,
    /// Its samples over those of the objective.
    pub share: f64,
}

/// A step in scaled parameters, and by how much a quadratic model of the cost expects it to fall.
struct NewtonStep {
    direction: DVector<f64>,
    gain: f64,
}

impl Task<'_> {
    /// Solves in stages and checks the optimum.
    pub fn solve(&self, progress: &mut dyn FnMut(&Progress) -> bool) -> Result<End, FitError> {
        let mut shared = Shared {
            watch: Watch::new(self.settings, self.cost.ranks()),
            work: Work::default(),
            progress,
            rows: WorkingRows::of(self),
        };
        let (parts, from, multipliers) = self.approach(&mut shared)?;
        let mut priors = Priors::of(self.model);
        let mut curvature = Curvature::unknown(from.len());
        let mut end = self.weighed(&from, multipliers, &mut priors, &mut curvature, &mut shared)?;
        let (mut checks, mut is_checked) = ([0, 0], false);
        // Of many runs a few show another minimum as well as all; only all show whether it is lower.
        let few = self.few_runs()?;
        let few = few.as_ref().map(|(runs, weights)| self.cost_of(runs, weights.clone())).transpose()?.flatten();
        let of_few = few.as_ref().map(|few| Evaluations::of(few));
        let share = few.as_ref().map_or(1.0, |few| few.samples() as f64 / self.cost.samples() as f64);
        let search = Search { evaluations: of_few.as_ref().unwrap_or(&self.evaluations), share };
        while end.may_be_minimum() && !shared.watch.is_over() {
            let stage = self.stage(&self.evaluations, &priors);
            let lower = self.lower_nearby(&stage, search, &end, checks[0], &mut shared)?;
            checks[0] += 1;
            let Some(lower) = lower else {
                is_checked = true;
                break;
            };
            checks[1] += 1;
            let on = self.weighed(&lower, None, &mut priors, &mut curvature, &mut shared)?;
            end = on;
        }
        self.check_feasible(&end)?;
        end.evaluated = shared.watch.evaluations();
        Ok(self.settle(end, is_checked, priors, shared.work, parts, checks))
    }

    /// Solves, and where there are priors solves again with their weight set by the residuals just found.
    fn weighed(
        &self,
        from: &[f64],
        mut multipliers: Option<Multipliers>,
        priors: &mut Priors,
        curvature: &mut Curvature,
        shared: &mut Shared,
    ) -> Result<Descent, FitError> {
        let rounds = if priors.terms.is_empty() { 1 } else { 1 + self.settings.prior_updates };
        let mut end: Option<Descent> = None;
        let mut p = from.to_vec();
        for _ in 0..rounds {
            let value = self.evaluations.value(&p).ok_or_else(|| self.diverged())?;
            // A weight that is never set anew is that of the fit's own start.
            let value = if rounds == 1 && self.start_cost.is_finite() { self.start_cost } else { value };
            let weight = self.weight(self.cost, value);
            if end.is_some() && (weight - priors.weight).abs() <= SAME_WEIGHT * weight {
                break;
            }
            priors.weight = weight;
            let stage = self.stage(&self.evaluations, priors);
            let from = From { p: &p, near: multipliers.is_some(), multipliers };
            let descent = self.descend(&stage, from, curvature, shared)?;
            p.clone_from(&descent.p);
            multipliers = descent.optimum.as_ref().map(|(_, multipliers)| multipliers.clone());
            end = Some(descent);
            if multipliers.is_none() {
                break;
            }
        }
        end.ok_or(FitError::NothingFree)
    }

    /// The last stage: all runs, to the tolerance of the settings.
    pub(in crate::fit) fn stage<'a>(&'a self, evaluations: &'a Evaluations<'a>, priors: &'a Priors) -> Stage<'a> {
        let FitSettings { hessian, tolerance, max_iterations, .. } = *self.settings;
        let (scaling, settled, restarts) = (&self.scaling, None, RESTARTS);
        Stage { evaluations, part: ALL, priors, scaling, hessian, tolerance, max_iterations, settled, restarts }
    }

    /// A feasible point of lower cost that a second solve finds from a disturbed point near an optimum.
    pub(in crate::fit) fn lower_nearby(
        &self,
        stage: &Stage,
        search: Search,
        end: &Descent,
        round: usize,
        shared: &mut Shared,
    ) -> Result<Option<Vec<f64>>, FitError> {
        let Some(local) = stage.local(&end.p) else { return Ok(None) };
        // Of a cost that fell to the rounding of where it began, nothing is left either.
        let rounding = ROUNDING * stage.evaluations.objective.factor() * self.start_cost;
        if local.value < if rounding.is_finite() { NOTHING_LEFT.max(rounding) } else { NOTHING_LEFT } {
            return Ok(None);
        }
        // In units of each parameter's own curvature: what a limited-memory matrix begins with.
        let most = local.gauss_newton.diagonal().max();
        let unit = |j: usize| local.gauss_newton[(j, j)].max(ROUNDING * most).sqrt().recip().min(CHECK_REACH);
        let units: Vec<f64> = (0..end.p.len()).map(unit).collect();
        let directions = match &end.optimum {
            Some((active, _)) => self.free_directions(active),
            None => self.free_directions(&self.touched(&end.p)),
        };
        let disturbed = self.disturbed(&end.p, &local, &directions, &units, round);
        let Some(disturbed) = disturbed.filter(|p| stage.total(p).is_some() && self.has_mass(p)) else {
            return Ok(None);
        };
        let scales = units.iter().zip(&self.scaling.scales).map(|(unit, scale)| unit * scale).collect();
        let scaling = Scaling::of(scales, &self.rows);
        let second = Stage {
            evaluations: search.evaluations,
            part: CHECK,
            scaling: &scaling,
            hessian: Hessian::LimitedMemory,
            tolerance: (2.0 * CHECK_LEFT * BETTER * local.value).sqrt().max(stage.tolerance),
            max_iterations: CHECK_ITERATIONS,
            restarts: 0,
            ..*stage
        };
        let from = From { p: &disturbed, near: true, multipliers: None };
        let outer = std::mem::take(&mut shared.work);
        let found = self.descend(&second, from, &mut Curvature::unknown(end.p.len()), shared);
        let own = std::mem::replace(&mut shared.work, outer);
        shared.work.join(&own, search.share);
        let found = found?;
        let (before, after) = (stage.total(&end.p), stage.total(&found.p));
        let lower = before.zip(after).is_some_and(|(before, after)| after < before - BETTER * before.abs());
        Ok((lower && self.is_feasible(&found.p)).then_some(found.p))
    }

    /// A point near an optimum: each parameter disturbed at random in its unit, within the directions that no active constraint blocks, so
    /// far that the quadratic model of the cost rises by [`CHECK_RISE`], or to near the first constraint. `None` where nothing is free.
    fn disturbed(
        &self,
        p: &[f64],
        local: &Local,
        directions: &DMatrix<f64>,
        units: &[f64],
        round: usize,
    ) -> Option<Vec<f64>> {
        let mut random = ChaCha8Rng::seed_from_u64(CHECK_SEED.wrapping_add(round as u64));
        let mut draw = |unit: &f64| {
            let normal: f64 = StandardNormal.sample(&mut random);
            normal * unit
        };
        let drawn = DVector::from_iterator(p.len(), units.iter().map(&mut draw));
        let step = directions * directions.tr_mul(&drawn);
        let rise = 0.5 * (&local.gauss_newton * &step).dot(&step);
        let wanted = (CHECK_RISE * local.value / rise).sqrt().min(CHECK_REACH / step.amax());
        let step: Vec<f64> = step.iter().zip(&self.scaling.scales).map(|(step, scale)| step * scale).collect();
        let length = wanted.min(CHECK_ROOM * self.room(p, &step));
        let disturbed: Vec<f64> = p.iter().zip(&step).map(|(p, step)| p + length * step).collect();
        (length > 0.0 && length.is_finite()).then(|| self.within_bounds(&disturbed))
    }

    /// How often a step can be made from a feasible point before it leaves a bound or constraint that it is not on already.
    fn room(&self, p: &[f64], step: &[f64]) -> f64 {
        let to = |value: f64, change: f64, lower: f64, upper: f64, size: f64| {
            let room = if change > 0.0 { upper - value } else { value - lower };
            let blind = change.abs() <= ROUNDING * size || room <= TOUCH * size;
            if blind { f64::INFINITY } else { room / change.abs() }
        };
        let of_row = |(row, size): (&Row, &f64)| {
            let change = row.value(step) - row.constant;
            to(row.value(p), change, row.lower, row.upper, *size)
        };
        let of_bound =
            |(j, (lower, upper)): (usize, &(f64, f64))| to(p[j], step[j], *lower, *upper, self.scaling.scales[j]);
        let rows = self.rows.iter().zip(&self.scaling.sizes).map(of_row);
        rows.chain(self.bounds.iter().enumerate().map(of_bound)).fold(f64::INFINITY, f64::min)
    }

    /// The start of the last stage: the fit's own start, or what fits shorter pieces or a few of the runs where that is better. The
    /// constraints that are active for a few of the runs are so for all of them: the multipliers come along.
    fn approach(&self, shared: &mut Shared) -> Result<(usize, Vec<f64>, Option<Multipliers>), FitError> {
        let parts = stages::parts(self);
        if parts < 2 && !self.start_cost.is_finite() {
            return Err(self.diverged());
        }
        let mut p = self.start.clone();
        let mut priors = Priors::of(self.model);
        let mut multipliers = None;
        for sample in Sample::stages(self, parts) {
            let (runs, weights) = sample.draw(self.runs, self.cost.weights())?;
            let Some(cost) = self.cost_of(&runs, weights)? else { continue };
            let evaluations = Evaluations::of(&cost);
            let Some(value) = evaluations.value(&p) else { continue };
            priors.weight = self.weight(&cost, value);
            let whole = self.stage(&evaluations, &priors);
            let stage = Stage {
                part: sample.part(),
                tolerance: whole.tolerance.max(STAGE_TOLERANCE),
                max_iterations: whole.max_iterations.min(STAGE_ITERATIONS),
                ..whole
            };
            let before = std::mem::take(&mut shared.work);
            let from = From { p: &p, near: false, multipliers: None };
            let descent = self.descend(&stage, from, &mut Curvature::unknown(p.len()), shared)?;
            let own = std::mem::replace(&mut shared.work, before);
            shared.work.join(&own, cost.samples() as f64 / self.cost.samples() as f64);
            p = descent.p;
            multipliers =
                descent.optimum.map(|(_, multipliers)| multipliers).filter(|_| matches!(sample, Sample::Few(_)));
            if shared.watch.is_over() {
                break;
            }
        }
        let start = self.better_start(p.clone(), priors)?;
        let multipliers = multipliers.filter(|_| start == p);
        Ok((parts, start, multipliers))
    }

    /// A few of the runs with their weights, where there are many.
    fn few_runs(&self) -> Result<Option<(RunStore, Vec<[f64; STATES]>)>, FitError> {
        Sample::few(self).map(|sample| sample.draw(self.runs, self.cost.weights())).transpose()
    }

    /// The cost over runs that were drawn for a stage; `None` where none was.
    fn cost_of<'r>(&'r self, runs: &'r RunStore, weights: Vec<[f64; STATES]>) -> Result<Option<Cost<'r>>, FitError> {
        match Cost::weighted(self.cost.ranks(), self.model, Runs::from(runs), weights, self.cost_options()) {
            Err(FitError::NoRuns) => Ok(None),
            cost => cost.map(Some),
        }
    }

    /// The better of where the stages ended and the fit's own start.
    fn better_start(&self, p: Vec<f64>, mut priors: Priors) -> Result<Vec<f64>, FitError> {
        if p == self.start {
            return Ok(p);
        }
        priors.weight = self.weight(self.cost, self.start_cost);
        // Where the solver begins at the end of the stages, it needs the derivatives there.
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

    /// The better of where the solver ended and the start, with the active limits and why it is the answer.
    fn settle(
        &self,
        end: Descent,
        is_checked: bool,
        priors: Priors,
        work: Work,
        parts: usize,
        checks: [usize; 2],
    ) -> End {
        let here = self.evaluations.value(&end.p).map_or(f64::INFINITY, |value| value + priors.value(&end.p));
        let there = self.start_cost + priors.value(&self.start);
        let start_is_better = there < here - BETTER * here.abs() && self.is_feasible(&self.start);
        let converged = is_checked && !start_is_better;
        let is_optimum = end.optimum.is_some();
        let p = if start_is_better { self.start.clone() } else { end.p };
        let active = end.optimum.map(|(active, _): (ActiveSet, Multipliers)| active).filter(|_| !start_is_better);
        let says = end.stop.map_or_else(|| end.status.to_string(), |stop| stop.to_string());
        let words = if converged && is_optimum {
            end.status.to_string()
        } else if converged {
            "solved: no step lowers the cost, whose slope jumps there".to_owned()
        } else if start_is_better || p == self.start {
            format!(
                "no point better than the start was found in {} evaluations, and the start is returned; {says}",
                end.evaluated
            )
        } else {
            format!("the best feasible point of {} evaluations is returned; {says}", end.evaluated)
        };
        let active = active.unwrap_or_else(|| self.touched(&p));
        End { converged, words, solver: end.status.name(), checks, p, priors, work, active, parts }
    }

    /// The end of a fit whose objective changed on the way, so that no cost compares it with its start.
    pub(in crate::fit) fn ended(
        &self,
        end: Descent,
        is_checked: bool,
        priors: Priors,
        work: Work,
        checks: [usize; 2],
    ) -> End {
        let says = end.stop.map_or_else(|| end.status.to_string(), |stop| stop.to_string());
        let words = if is_checked {
            "solved".to_owned()
        } else {
            format!("the best feasible point of {} evaluations is returned; {says}", work.counts.objective)
        };
        let active = end.optimum.map_or_else(|| self.touched(&end.p), |(active, _)| active);
        let solver = end.status.name();
        End { converged: is_checked, words, solver, checks, p: end.p, priors, work, active, parts: 1 }
    }

    /// Infeasibility is an error where it is the constraints' own: they are linear, so that Ipopt's answer is exact.
    pub(in crate::fit) fn check_feasible(&self, end: &Descent) -> Result<(), FitError> {
        if !matches!(end.status, Status::Infeasible | Status::RestorationFailed) || self.is_feasible(&end.p) {
            return Ok(());
        }
        let p = end.last.as_ref().map_or_else(
            || end.p.clone(),
            |s| self.within_bounds(&s.x.iter().zip(&self.scaling.scales).map(|(z, s)| z * s).collect::<Vec<_>>()),
        );
        let broken = |i: usize| self.rows[i].violation(&p) / self.scaling.sizes[i];
        let worst = (0..self.rows.len()).max_by(|a, b| broken(*a).total_cmp(&broken(*b)));
        match worst {
            Some(worst) if broken(worst) > 1e-6 => {
                let row = &self.rows[worst];
                Err(FitError::Infeasible { rule: row.rule, sentence: row.sentence(&p), violation: row.violation(&p) })
            }
            _ => Ok(()),
        }
    }

    /// Rows and bounds that a point touches, where no multipliers say which of them are active.
    fn touched(&self, p: &[f64]) -> ActiveSet {
        let touches = |i: &usize| {
            let row = &self.rows[*i];
            let value = row.value(p);
            (value - row.lower).abs().min((row.upper - value).abs()) <= TOUCH * self.scaling.sizes[*i]
        };
        let mut bounds = Vec::new();
        for (j, (lower, upper)) in self.bounds.iter().enumerate() {
            if (p[j] - lower).abs() <= TOUCH * self.scaling.scales[j] {
                bounds.push((j, "lower"));
            } else if (upper - p[j]).abs() <= TOUCH * self.scaling.scales[j] {
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
        if let Some(p) = self.on_limits(end) {
            end.p = p;
        }
        let total = |p: &[f64]| Some(self.evaluations.value(p)? + end.priors.value(p));
        let (Some(mut best), Some(mut step)) = (total(&end.p), self.newton_step(&end.p, &end.priors, &z)) else {
            return;
        };
        let start = self.start_cost + end.priors.value(&self.start);
        for _ in 0..self.settings.polish_steps {
            let moved: Vec<f64> =
                (0..end.p.len()).map(|j| end.p[j] + step.direction[j] * self.scaling.scales[j]).collect();
            let inside = |(j, p): (usize, &f64)| *p >= self.bounds[j].0 && *p <= self.bounds[j].1;
            let broken = |(row, size): (&Row, &f64)| row.violation(&moved) > row.violation(&end.p) + 1e-9 * size;
            let outside =
                !moved.iter().enumerate().all(inside) || self.rows.iter().zip(&self.scaling.sizes).any(broken);
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

    /// The point on the limits that are active at an end, where it is feasible and no worse: of all steps to them, that along which the
    /// quadratic model of the cost rises least, `d = H^-1 N' (N H^-1 N')^-1 r` with the normals N of the limits and the distances r to them.
    fn on_limits(&self, end: &End) -> Option<Vec<f64>> {
        let (n, scaling) = (end.p.len(), &self.scaling);
        let stage = self.stage(&self.evaluations, &end.priors);
        let local = stage.local(&end.p)?;
        let (mut normals, mut distances) = (Vec::new(), Vec::new());
        for i in &end.active.rows {
            let (row, size) = (&self.rows[*i], scaling.sizes[*i]);
            let value = row.value(&end.p);
            let [below, above] = [value - row.lower, row.upper - value];
            normals.push(self.normal(scaling, *i));
            distances.push(if below < above { -below / size } else { above / size });
        }
        for (j, side) in &end.active.bounds {
            let limit = if *side == "lower" { self.bounds[*j].0 } else { self.bounds[*j].1 };
            let unit = |k: usize| if k == *j { 1.0 } else { 0.0 };
            normals.push(DVector::from_fn(n, |k, _| unit(k)));
            distances.push((limit - end.p[*j]) / scaling.scales[*j]);
        }
        if normals.is_empty() {
            return None;
        }
        let normals = DMatrix::from_columns(&normals);
        let ridge = UNDETERMINED * local.gauss_newton.diagonal().max();
        let matrix = &local.gauss_newton + DMatrix::identity(n, n) * ridge;
        let yielding = inverse(&matrix, &DMatrix::identity(n, n)).matrix;
        let along = normals.tr_mul(&yielding) * &normals;
        let m = distances.len();
        let back = inverse(&along, &DMatrix::identity(m, m)).matrix * DVector::from_vec(distances);
        let step = yielding * (normals * back);
        let moved: Vec<f64> = (0..n).map(|j| end.p[j] + step[j] * scaling.scales[j]).collect();
        let moved = self.within_bounds(&moved);
        let is_better = stage.total(&moved).zip(stage.total(&end.p)).is_some_and(|(new, old)| new <= old);
        (is_better && self.is_feasible(&moved)).then_some(moved)
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
