//! The weighted trajectory cost of a model against recordings, with exact first and second derivatives by the parameters.
//! It has no constraint, prior or solver: it evaluates one sum of squares and what follows from it.
//!
//! With M runs of K_i samples, measured states `xi_bar` and simulated states `xi`,
//!
//! ```text
//! C(p) = (1/M) sum_i sum_k e^T W_i e,    e = xi_bar - xi,    W_i = diag(1/L_i, 1/L_i, 1/pi, 1/U_i, 1/U_i, 1/r_max)
//! ```
//!
//! L_i path length \[m\], U_i mean speed \[m/s\], r_max a reference yaw rate \[rad/s\], the heading difference wrapped into
//! (-pi, pi]. Channels that were not measured have weight 0. Source: Papandreou et al. 2025 (arXiv 2502.18696), eq. (5).

mod by_sample;

pub use by_sample::{Compared, Residuals};

use super::sums::Sums;
use crate::dynamics::Dynamics;
use crate::fit::error::FitError;
use crate::model::{BASE, Model};
use crate::physics::{CHUNK, Curvature, Gradient, Group, Lanes, NumDual, Number};
use crate::ranks::{ExactSums, Ranks};
use crate::recording::{Measured, Run, Runs};
use crate::sensitivity::local::side_by_side;
use crate::sensitivity::{Column, Columns, Plain, Sensitivity};
use crate::ship::Ship;
use crate::simulate::{self, Integration, Scenario, absurd_speed};
use crate::state::{Inputs, STATES};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::f64::consts::{PI, TAU};
use trimtab_ad::{Dual, Scalar};

/// Number of derivatives in each of the two blocks of [`Curvature`].
const BLOCK: usize = 6;

/// The diagonal of W for a run: `1/L, 1/L, 1/pi, 1/U, 1/U, 1/r_max`, with its path length L \[m\], its mean speed U \[m/s\] and
/// r_max \[rad/s\].
///
/// A run that hardly moves would weigh without limit: L counts as at least a tenth of the ship's length and U as at least the
/// ship's small speed, 0.002 sqrt(g Lpp).
pub fn weights(ship: &Ship, run: &Run, max_yaw_rate: f64) -> [f64; STATES] {
    let length = 1.0 / run.path_length().max(0.1 * ship.hull.lpp);
    let speed = 1.0 / run.mean_speed().max(ship.small_speed());
    [length, length, 1.0 / PI, speed, speed, 1.0 / max_yaw_rate]
}

/// Where the derivatives of the trajectories come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Derivatives {
    /// Exact: dual numbers over SIMD lanes, four runs side by side.
    #[default]
    Lanes,
    /// Exact: dual numbers, run by run.
    Dual,
    /// Exact: dual numbers of the num-dual crate, run by run.
    NumDual,
    /// Central differences of the residuals, four runs side by side.
    FiniteDifferences,
    /// Forward differences of the residuals, four runs side by side: half the simulations, and an error that grows with the step.
    ForwardDifferences,
}

/// A value with its gradient and Gauss-Newton matrix, by the free parameters in their own units.
#[derive(Clone, Debug)]
pub struct Quadratic {
    /// The cost.
    pub value: f64,
    /// Its gradient.
    pub gradient: DVector<f64>,
    /// `2/M sum_ik J^T W J`: the Hessian without the residuals' own curvature.
    pub gauss_newton: DMatrix<f64>,
    /// Gradient of the part of each of this rank's runs, in their order; those of all ranks add up to `gradient`.
    pub by_run: Vec<DVector<f64>>,
}

/// The cost of a model against runs, as a function of the model's free parameters.
pub struct Cost<'a> {
    model: &'a Model,
    ranks: &'a Ranks,
    /// The runs of this rank.
    runs: Runs<'a>,
    /// Runs, samples and residuals of all ranks.
    counts: [usize; 3],
    /// The diagonal of W of each run of this rank.
    weights: Vec<[f64; STATES]>,
    free: Vec<usize>,
    derivatives: Derivatives,
    difference_step: f64,
    integration: Integration,
    limit: f64,
    /// Whether a term may change what is reported of the state.
    sensed: bool,
    columns: Columns,
    lanes: Blocks<Lanes>,
    single: Blocks<f64>,
}

/// Settings of a [`Cost`].
#[derive(Clone, Copy, Debug)]
pub struct CostOptions {
    /// Reference yaw rate r_max \[rad/s\] of the weights.
    pub max_yaw_rate: f64,
    /// Where the derivatives come from.
    pub derivatives: Derivatives,
    /// Step of finite differences, in units of each parameter's scale.
    pub difference_step: f64,
    /// Integration of the simulation.
    pub integration: Integration,
}

/// Blocks of runs: built, or planned as the indices of their runs where these are too many for the memory.
enum Blocks<P> {
    Built(Vec<Block<P>>),
    Planned(Vec<Vec<usize>>),
}

/// Blocks that are evaluated before what they gave is added up.
const TOGETHER: usize = 256;

/// Runs that are evaluated side by side.
struct Block<P> {
    /// Indices of the runs, one a lane; lanes beyond repeat the first run with weight 0.
    runs: Vec<usize>,
    dt: f64,
    /// Inputs of the run in each lane; a run that is over keeps its last.
    inputs: Vec<Inputs<P>>,
    initial: [P; STATES],
    /// 1 in the channels that are measured, 0 in the others.
    channels: [P; STATES],
    /// Measured states.
    target: Vec<[P; STATES]>,
    /// Square roots of the weights, 0 where there is nothing to compare.
    root: Vec<[P; STATES]>,
    /// For each sample, whether every lane has a weight above 0 in every channel.
    whole: Vec<bool>,
    /// Fixed parameter values, and the session's additions to the free ones.
    base: Vec<P>,
    /// Whether no current was recorded.
    still: bool,
}

/// A dual number that carries derivatives by a chunk of the parameters, run by run: the oracle of the sensitivities.
trait Seeded: Number<Coefficient = Self> {
    fn variable(x: f64, j: usize) -> Self;
    fn constant(x: f64) -> Self;
    fn slopes(&self) -> [f64; CHUNK];
}

impl Seeded for Gradient {
    fn variable(x: f64, j: usize) -> Self {
        Dual::variable(x, j)
    }
    fn constant(x: f64) -> Self {
        Dual::constant(x)
    }
    fn slopes(&self) -> [f64; CHUNK] {
        self.eps
    }
}

impl Seeded for NumDual {
    fn variable(x: f64, j: usize) -> Self {
        let mut eps = nalgebra::SVector::<f64, CHUNK>::zeros();
        eps[j] = 1.0;
        Self::new(x, num_dual::Derivative::some(eps))
    }
    fn constant(x: f64) -> Self {
        Self::from_re(x)
    }
    fn slopes(&self) -> [f64; CHUNK] {
        let eps = self.eps.unwrap_generic(nalgebra::Const::<CHUNK>, nalgebra::Const::<1>);
        std::array::from_fn(|j| eps[j])
    }
}

impl<P: Plain> Block<P> {
    /// The block of some runs; `None` where one cannot be read.
    fn of(model: &Model, runs: Runs, weights: &[[f64; STATES]], lanes: &[usize]) -> Option<Self> {
        let runs = lanes.iter().map(|run| runs.get(*run)).collect::<Option<Vec<Cow<Run>>>>()?;
        let runs: Vec<&Run> = runs.iter().map(|run| &**run).collect();
        let in_lane = |lane: usize| runs[lane.min(runs.len() - 1)];
        let steps = runs.iter().map(|r| r.inputs.len()).max().unwrap_or(0);
        let sample = |lane: usize, k: usize| {
            let inputs = &in_lane(lane).inputs;
            &inputs[k.min(inputs.len() - 1)]
        };
        let inputs = (0..steps).map(|k| side_by_side(|lane| sample(lane, k))).collect();
        let roots: Vec<[f64; STATES]> = lanes.iter().map(|run| weights[*run].map(|w| w.max(0.0).sqrt())).collect();
        let weight = |lane: usize, k: usize, c: usize| {
            let Some(run) = runs.get(lane) else { return 0.0 };
            let compared = run.measured.get(k).is_some_and(|m| m[c].is_some());
            if compared { roots[lane][c] } else { 0.0 }
        };
        let measured =
            |lane: usize, k: usize, c: usize| in_lane(lane).measured.get(k).and_then(|m| m[c]).unwrap_or(0.0);
        let root: Vec<[P; STATES]> = table(steps, weight);
        let weighted = |root: &[P; STATES]| (0..P::WIDTH).all(|lane| root.iter().all(|w| w.in_lane(lane) > 0.0));
        let measured_at_all: Vec<[bool; STATES]> = (0..P::WIDTH).map(|lane| in_lane(lane).channels()).collect();
        let mut by_lane: Vec<Vec<f64>> = Vec::new();
        for lane in 0..P::WIDTH {
            let mut values: Vec<f64> = model.parameters.iter().map(|p| if p.free { 0.0 } else { p.value }).collect();
            for (i, addition) in model.sessions.get(&in_lane(lane).session).into_iter().flatten() {
                values[*i] += addition;
            }
            by_lane.push(values);
        }
        Some(Self {
            runs: lanes.to_vec(),
            dt: in_lane(0).dt,
            inputs,
            initial: std::array::from_fn(|c| P::gather(|lane| in_lane(lane).initial[c])),
            channels: std::array::from_fn(|c| P::gather(|lane| f64::from(u8::from(measured_at_all[lane][c])))),
            target: table(steps, measured),
            whole: root.iter().map(weighted).collect(),
            root,
            base: (0..model.parameters.len()).map(|i| P::gather(|lane| by_lane[lane][i])).collect(),
            still: runs.iter().all(|run| is_still(run)),
        })
    }

    /// Runs in blocks of one sample period and similar length, in an order that depends on the runs alone, in still water or not:
    /// a run is computed the same way whatever runs are beside it. `None` where a run cannot be read.
    fn group(model: &Model, runs: Runs, weights: &[[f64; STATES]], shapes: &[Shape]) -> Option<Blocks<P>> {
        let mut order: Vec<usize> = (0..runs.len()).collect();
        order.sort_by(|a, b| {
            let (a, b) = (&shapes[*a], &shapes[*b]);
            a.dt.total_cmp(&b.dt).then(a.still.cmp(&b.still)).then(b.samples.cmp(&a.samples))
        });
        let alike = order.chunk_by(|a, b| (shapes[*a].dt, shapes[*a].still) == (shapes[*b].dt, shapes[*b].still));
        let mut lanes = alike.flat_map(|runs| runs.chunks(P::WIDTH));
        if runs.held() {
            lanes.map(|lanes| Self::of(model, runs, weights, lanes)).collect::<Option<_>>().map(Blocks::Built)
        } else {
            Some(Blocks::Planned(lanes.by_ref().map(<[usize]>::to_vec).collect()))
        }
    }

    /// The weighted difference in one channel, and its factor on the derivatives of the simulated value.
    #[inline]
    fn residual(&self, k: usize, c: usize, simulated: P) -> P {
        let mut difference = self.target[k][c] - simulated;
        if c == 2 {
            difference -= (difference / TAU).nearest() * TAU;
        }
        let root = self.root[k][c];
        let residual = difference * root;
        if self.whole[k] { residual } else { P::select(P::zero().less(root), residual, P::zero()) }
    }

    /// The weighted differences of a sample.
    #[inline(always)]
    fn residuals(&self, k: usize, simulated: &[P; STATES]) -> [P; STATES] {
        std::array::from_fn(|c| self.residual(k, c, simulated[c]))
    }

    /// The derivatives of those weighted differences by one column. What a run does after it has ended, be it NaN, is dropped.
    #[inline(always)]
    fn row(&self, k: usize, slopes: &[P; STATES]) -> [P; STATES] {
        let root = &self.root[k];
        let row = std::array::from_fn(|c| -(slopes[c] * root[c]));
        if self.whole[k] {
            return row;
        }
        std::array::from_fn(|c| P::select(P::zero().less(root[c]), row[c], P::zero()))
    }
}

impl<P> Blocks<P> {
    fn is_empty(&self) -> bool {
        match self {
            Self::Built(blocks) => blocks.is_empty(),
            Self::Planned(plans) => plans.is_empty(),
        }
    }
}

/// What decides which runs are evaluated side by side.
struct Shape {
    /// Sample period \[s\].
    dt: f64,
    still: bool,
    samples: usize,
}

/// Whether no current was recorded in a run.
fn is_still(run: &Run) -> bool {
    run.inputs.iter().all(|i| i.current == [0.0; 2])
}

/// What `f` says of lane, sample and channel, side by side.
fn table<P: Plain>(samples: usize, f: impl Fn(usize, usize, usize) -> f64) -> Vec<[P; STATES]> {
    (0..samples).map(|k| std::array::from_fn(|c| P::gather(|lane| f(lane, k, c)))).collect()
}

/// Whether a run can be fitted to.
pub(in crate::fit) fn check(run: &Run, weights: &[f64; STATES]) -> Result<(), FitError> {
    let bad = |what: &str| Err(FitError::BadRun { run: run.recording.clone(), what: what.into() });
    if run.inputs.len() != run.measured.len() || run.inputs.len() < 2 {
        return bad("inputs and measured states must have the same number of samples, at least 2");
    }
    if !(run.dt.is_finite() && run.dt > 0.0) {
        return bad("the sample period must be positive");
    }
    if !run.initial.iter().chain(weights).all(|v| v.is_finite()) {
        return bad("the initial state and the weights must be finite");
    }
    Ok(())
}

impl<'a> Cost<'a> {
    /// The cost of `model` against `runs`.
    ///
    /// # Errors
    /// No runs, a run without samples or of unequal lengths, or a sample period that is not positive.
    pub fn new(model: &'a Model, runs: impl Into<Runs<'a>>, options: CostOptions) -> Result<Self, FitError> {
        Self::over(Ranks::one(), model, runs, options)
    }

    /// The cost of `model` against the runs of all ranks, of which this one has `runs`. Every rank calls the same methods at the
    /// same points, and gets the same values, which do not depend on which rank has which run.
    ///
    /// # Errors
    /// As [`Cost::new`], for the runs of this rank; no runs on any rank.
    pub fn over(
        ranks: &'a Ranks,
        model: &'a Model,
        runs: impl Into<Runs<'a>>,
        options: CostOptions,
    ) -> Result<Self, FitError> {
        let runs = runs.into();
        let weights = runs.iter().map(|r| weights(&model.ship, &r, options.max_yaw_rate)).collect();
        Self::weighted(ranks, model, runs, weights, options)
    }

    /// As [`Cost::over`], with the diagonal of W of each run given, as for pieces that keep the weights of their whole run.
    pub(in crate::fit) fn weighted(
        ranks: &'a Ranks,
        model: &'a Model,
        runs: Runs<'a>,
        weights: Vec<[f64; STATES]>,
        options: CostOptions,
    ) -> Result<Self, FitError> {
        let (mut shapes, mut residuals) = (Vec::with_capacity(runs.len()), 0);
        for (run, weights) in runs.iter().zip(&weights) {
            check(&run, weights)?;
            shapes.push(Shape { dt: run.dt, still: is_still(&run), samples: run.inputs.len() });
            let of = |m: &Measured| (0..STATES).filter(|c| weights[*c] > 0.0 && m[*c].is_some()).count();
            residuals += run.measured.iter().map(of).sum::<usize>();
        }
        if shapes.len() < runs.len() {
            return Err(FitError::Unreadable);
        }
        let counts = ranks.counts([runs.len(), shapes.iter().map(|s| s.samples).sum(), residuals]);
        if counts[0] == 0 {
            return Err(FitError::NoRuns);
        }
        let free = model.free();
        let columns: Vec<Column> = free.iter().map(|p| Column { parameter: *p, scale: 1.0 }).collect();
        let (mut lanes, mut single) = (Blocks::Built(Vec::new()), Blocks::Built(Vec::new()));
        match options.derivatives {
            Derivatives::Lanes | Derivatives::FiniteDifferences | Derivatives::ForwardDifferences => {
                lanes = Block::group(model, runs, &weights, &shapes).ok_or(FitError::Unreadable)?;
            }
            Derivatives::Dual | Derivatives::NumDual => {
                single = Block::group(model, runs, &weights, &shapes).ok_or(FitError::Unreadable)?;
            }
        }
        Ok(Self {
            model,
            ranks,
            runs,
            counts,
            weights,
            columns: Columns::new(model, &columns),
            free,
            derivatives: options.derivatives,
            difference_step: options.difference_step,
            integration: options.integration,
            limit: absurd_speed(model),
            sensed: model.placed()[BASE.len()..].iter().any(|t| t.term.info().group == Group::Sensor),
            lanes,
            single,
        })
    }

    /// Indices of the free parameters in the model.
    pub fn free(&self) -> &[usize] {
        &self.free
    }

    /// The ranks whose runs the cost is of.
    pub fn ranks(&self) -> &'a Ranks {
        self.ranks
    }

    /// Number of runs on all ranks.
    pub fn runs(&self) -> usize {
        self.counts[0]
    }

    /// The diagonal of W of each run of this rank.
    pub fn weights(&self) -> &[[f64; STATES]] {
        &self.weights
    }

    /// Number of residuals that count, on all ranks: measured values with a weight above 0.
    pub fn residuals(&self) -> usize {
        self.counts[2]
    }

    /// Number of samples of the runs of all ranks.
    #[cfg(feature = "ipopt")]
    pub(in crate::fit) fn samples(&self) -> usize {
        self.counts[1]
    }

    /// Hands every block to `work`, side by side, and what that makes of it to `take` in the order of the blocks, until `take` says
    /// no more or a run cannot be read: `None` then.
    fn each<P: Plain, T: Send>(
        &self,
        blocks: &Blocks<P>,
        work: impl Fn(&Block<P>) -> T + Sync,
        mut take: impl FnMut(&[usize], T) -> Option<()>,
    ) -> Option<()> {
        match blocks {
            Blocks::Built(blocks) => {
                for some in blocks.chunks(TOGETHER) {
                    let done: Vec<T> = some.par_iter().map(&work).collect();
                    some.iter().zip(done).try_for_each(|(block, one)| take(&block.runs, one))?;
                }
            }
            Blocks::Planned(plans) => {
                for some in plans.chunks(TOGETHER) {
                    let one = |lanes: &Vec<usize>| Some(work(&Block::of(self.model, self.runs, &self.weights, lanes)?));
                    let done: Vec<Option<T>> = some.par_iter().map(one).collect();
                    some.iter().zip(done).try_for_each(|(lanes, one)| take(lanes, one?))?;
                }
            }
        }
        Some(())
    }

    /// The cost at the free parameters `p`, or `None` where a simulation diverges.
    pub fn value(&self, p: &[f64]) -> Option<f64> {
        let mut sums = ExactSums::new(1).at(p);
        match self.squares(p) {
            Some(squares) => squares.into_iter().for_each(|square| sums.add(0, square)),
            None => sums.spoil(),
        }
        Some(self.ranks.total(sums)?[0] / self.runs() as f64)
    }

    /// The sum of squared weighted residuals of each run of this rank, or `None` where a simulation diverges.
    pub fn squares(&self, p: &[f64]) -> Option<Vec<f64>> {
        if self.lanes.is_empty() { self.squares_over(&self.single, p) } else { self.squares_over(&self.lanes, p) }
    }

    fn squares_over<P: Plain>(&self, blocks: &Blocks<P>, p: &[f64]) -> Option<Vec<f64>> {
        let of_block = |block: &Block<P>| {
            let (mut square, mut fastest) = (P::zero(), P::zero());
            self.rollout(block, p, |k, y| {
                for residual in block.residuals(k, y) {
                    square = residual.mul_add(residual, square);
                }
                fastest =
                    fastest.max(P::select(P::zero().less(block.root[k][3]), y[3] * y[3] + y[4] * y[4], P::zero()));
            });
            let sane = (0..P::WIDTH)
                .all(|lane| square.in_lane(lane).is_finite() && fastest.in_lane(lane) < self.limit * self.limit);
            sane.then_some(square)
        };
        let mut squares = vec![0.0; self.runs.len()];
        self.each(blocks, of_block, |runs, part| {
            let part = part?;
            for (lane, run) in runs.iter().enumerate() {
                squares[*run] = part.in_lane(lane);
            }
            Some(())
        })?;
        Some(squares)
    }

    /// Hands the weighted residuals of each run at `p` to `take`, by sample and channel, NaN where nothing is compared and after
    /// the run's end. The order depends on the runs alone. `None` where a run cannot be read or `take` says no more.
    #[cfg(feature = "ipopt")]
    pub(in crate::fit) fn residuals_by_run(
        &self,
        p: &[f64],
        take: impl FnMut(usize, Vec<[f64; STATES]>) -> Option<()>,
    ) -> Option<()> {
        if self.lanes.is_empty() {
            self.residuals_over(&self.single, p, take)
        } else {
            self.residuals_over(&self.lanes, p, take)
        }
    }

    #[cfg(feature = "ipopt")]
    fn residuals_over<P: Plain>(
        &self,
        blocks: &Blocks<P>,
        p: &[f64],
        mut take: impl FnMut(usize, Vec<[f64; STATES]>) -> Option<()>,
    ) -> Option<()> {
        let by_lane = |block: &Block<P>| {
            let mut residuals = vec![[P::zero(); STATES]; block.inputs.len()];
            self.rollout(block, p, |k, y| residuals[k] = block.residuals(k, y));
            let of_lane = |lane: usize| {
                let entry = |(residual, root): (&P, &P)| {
                    if root.in_lane(lane) > 0.0 { residual.in_lane(lane) } else { f64::NAN }
                };
                let sample = |(residuals, roots): (&[P; STATES], &[P; STATES])| {
                    std::array::from_fn(|c| entry((&residuals[c], &roots[c])))
                };
                residuals.iter().zip(&block.root).map(sample).collect()
            };
            (0..block.runs.len()).map(of_lane).collect::<Vec<Vec<[f64; STATES]>>>()
        };
        self.each(blocks, by_lane, |runs, values| {
            runs.iter().zip(values).try_for_each(|(run, values)| take(*run, values))
        })
    }

    /// The cost with its gradient and Gauss-Newton matrix, or `None` where a simulation or a derivative diverges.
    pub fn quadratic(&self, p: &[f64]) -> Option<Quadratic> {
        self.evaluate(p, true)
    }

    /// As [`Cost::quadratic`], with a Gauss-Newton matrix of zeros, for solvers that have no use for it.
    pub fn with_gradient(&self, p: &[f64]) -> Option<Quadratic> {
        self.evaluate(p, false)
    }

    fn evaluate(&self, p: &[f64], with_matrix: bool) -> Option<Quadratic> {
        match self.derivatives {
            Derivatives::Lanes => self.assemble(&self.lanes, p, with_matrix, |b| self.sweep(b, p, with_matrix)),
            Derivatives::Dual => {
                self.assemble(&self.single, p, with_matrix, |b| self.by_duals::<Gradient>(b, p, with_matrix))
            }
            Derivatives::NumDual => {
                self.assemble(&self.single, p, with_matrix, |b| self.by_duals::<NumDual>(b, p, with_matrix))
            }
            Derivatives::FiniteDifferences | Derivatives::ForwardDifferences => {
                self.assemble(&self.lanes, p, with_matrix, |b| self.differences(b, p, with_matrix))
            }
        }
    }

    /// Adds up the runs of all ranks: exactly, so that neither ranks, threads nor blocks change a bit.
    fn assemble<P: Plain>(
        &self,
        blocks: &Blocks<P>,
        p: &[f64],
        with_matrix: bool,
        sums: impl Fn(&Block<P>) -> Sums<P> + Sync + Send,
    ) -> Option<Quadratic> {
        let n = self.free.len();
        let mut by_run = vec![DVector::zeros(n); self.runs.len()];
        let entries = if with_matrix { n * (n + 1) / 2 } else { 0 };
        let mut total = ExactSums::new(1 + n + entries).at(p);
        let factor = 2.0 / self.runs() as f64;
        let read = self.each(blocks, sums, |runs, part| {
            for (lane, run) in runs.iter().enumerate() {
                let pairs = (0..if with_matrix { n } else { 0 }).flat_map(|i| (0..=i).map(move |j| (i, j)));
                let products = pairs.map(|(i, j)| part.product(i, j));
                let own = std::iter::once(part.square).chain(part.gradient.iter().copied()).chain(products);
                own.enumerate().for_each(|(i, sum)| total.add(i, sum.in_lane(lane)));
                by_run[*run] = DVector::from_iterator(n, part.gradient.iter().map(|g| factor * g.in_lane(lane)));
            }
            Some(())
        });
        if read.is_none() {
            total.spoil();
        }
        let total = self.ranks.total(total)?;
        let (gradient, packed) = total[1..].split_at(n);
        let mut matrix = DMatrix::zeros(n, n);
        let mut packed = packed.iter();
        for i in 0..n {
            for (j, entry) in (0..=i).zip(&mut packed) {
                matrix[(i, j)] = factor * entry;
            }
        }
        matrix.fill_upper_triangle_with_lower_triangle();
        let gradient = DVector::from_iterator(n, gradient.iter().map(|g| factor * g));
        let value = total[0] / self.runs() as f64;
        let finite = value.is_finite() && gradient.iter().chain(matrix.iter()).all(|v| v.is_finite());
        finite.then_some(Quadratic { value, gradient, gauss_newton: matrix, by_run })
    }

    /// Sums of a block by the sensitivities of its simulation.
    fn sweep<P: Plain>(&self, block: &Block<P>, p: &[f64], with_matrix: bool) -> Sums<P> {
        let n = self.free.len();
        let mut sums = Sums::new(n, with_matrix);
        let sensitivity = Sensitivity::new(self.dynamics(block, p), &self.columns, self.sensed);
        sensitivity.rollout(
            self.integration,
            block.dt,
            &block.inputs,
            &block.initial,
            &block.channels,
            |k, y, slopes| sums.add(&block.residuals(k, y), slopes.iter().map(|s| block.row(k, s))),
        );
        sums.finished()
    }

    /// Sums of a run by dual numbers through the whole simulation, in as many passes as the parameters take chunks.
    fn by_duals<S: Seeded>(&self, block: &Block<f64>, p: &[f64], with_matrix: bool) -> Sums<f64> {
        let n = self.free.len();
        let mut residuals = vec![[0.0; STATES]; block.inputs.len()];
        let mut rows = vec![[0.0; STATES]; block.inputs.len() * n];
        for start in (0..n.max(1)).step_by(CHUNK) {
            let mut theta: Vec<S> = self.theta(block, p).into_iter().map(S::constant).collect();
            let chunk = start..(start + CHUNK).min(n);
            for j in chunk.clone() {
                theta[self.free[j]] = S::variable(theta[self.free[j]].value(), j - start);
            }
            self.roll_with(block, theta, |k, y| {
                residuals[k] = block.residuals(k, &y.map(|v| v.value()));
                let slopes = y.map(|v| v.slopes());
                for j in chunk.clone() {
                    rows[k * n + j] = block.row(k, &std::array::from_fn(|c| slopes[c][j - start]));
                }
            });
        }
        let mut sums = Sums::new(n, with_matrix);
        for (k, residuals) in residuals.iter().enumerate() {
            sums.add(residuals, rows[k * n..(k + 1) * n].iter().copied());
        }
        sums.finished()
    }

    /// Sums of a block by differences of its residuals, central or forward.
    fn differences<P: Plain>(&self, block: &Block<P>, p: &[f64], with_matrix: bool) -> Sums<P> {
        let n = self.free.len();
        let residuals = |p: &[f64]| {
            let mut residuals = vec![[P::zero(); STATES]; block.inputs.len()];
            self.rollout(block, p, |k, y| residuals[k] = block.residuals(k, y));
            residuals
        };
        let here = residuals(p);
        let mut rows = vec![[P::zero(); STATES]; block.inputs.len() * n];
        for j in 0..n {
            let step = self.difference_step * self.model.parameters[self.free[j]].scale;
            let mut moved = p.to_vec();
            moved[j] = p[j] + step;
            let (above, up) = (residuals(&moved), moved[j]);
            moved[j] = p[j] - step;
            let central = (self.derivatives == Derivatives::FiniteDifferences).then(|| residuals(&moved));
            let (below, down) = central.as_ref().map_or((&here, p[j]), |below| (below, moved[j]));
            for (k, (a, b)) in above.iter().zip(below).enumerate() {
                rows[k * n + j] = std::array::from_fn(|c| (a[c] - b[c]) / (up - down));
            }
        }
        let mut sums = Sums::new(n, with_matrix);
        for (k, residuals) in here.iter().enumerate() {
            sums.add(residuals, rows[k * n..(k + 1) * n].iter().copied());
        }
        sums.finished()
    }

    /// The exact Hessian of the cost, by second-order dual numbers in blocks of 6 by 6, or `None` where it diverges.
    pub fn hessian(&self, p: &[f64]) -> Option<DMatrix<f64>> {
        let n = self.free.len();
        let of_run = |run: usize| {
            let block = Block::<f64>::of(self.model, self.runs, &self.weights, &[run])?;
            let mut sum = DMatrix::zeros(n, n);
            for row in (0..n).step_by(BLOCK) {
                for column in (0..=row).step_by(BLOCK) {
                    self.add_curvature(&block, p, row, column, &mut sum);
                }
            }
            Some(sum)
        };
        let mut total = ExactSums::new(n * n).at(p);
        for first in (0..self.runs.len()).step_by(TOGETHER) {
            let some = first..(first + TOGETHER).min(self.runs.len());
            for part in some.into_par_iter().map(of_run).collect::<Vec<Option<DMatrix<f64>>>>() {
                match part {
                    Some(part) => part.iter().enumerate().for_each(|(i, sum)| total.add(i, *sum)),
                    None => total.spoil(),
                }
            }
        }
        let mut hessian = DMatrix::from_vec(n, n, self.ranks.total(total)?) * (2.0 / self.runs() as f64);
        hessian.fill_upper_triangle_with_lower_triangle();
        hessian.iter().all(|v: &f64| v.is_finite()).then_some(hessian)
    }

    fn add_curvature(&self, block: &Block<f64>, p: &[f64], row: usize, column: usize, sum: &mut DMatrix<f64>) {
        let n = self.free.len();
        let mut theta: Vec<Curvature> = self.theta(block, p).into_iter().map(Curvature::from_f64).collect();
        for j in 0..BLOCK {
            if row + j < n {
                theta[self.free[row + j]].eps[j].re = 1.0;
            }
            if column + j < n {
                theta[self.free[column + j]].re.eps[j] = 1.0;
            }
        }
        self.roll_with(block, theta, |k, y| {
            for c in 0..STATES {
                let root = block.root[k][c];
                if root == 0.0 {
                    continue;
                }
                let residual = block.residual(k, c, y[c].re.re);
                for i in 0..BLOCK.min(n - row) {
                    for j in 0..BLOCK.min(n - column) {
                        let first = y[c].eps[i].re * y[c].re.eps[j] * root * root;
                        sum[(row + i, column + j)] += first - residual * root * y[c].eps[i].eps[j];
                    }
                }
            }
        });
    }

    /// All parameters of the model for the runs of a block.
    fn theta<P: Plain>(&self, block: &Block<P>, p: &[f64]) -> Vec<P> {
        let mut theta = block.base.clone();
        for (i, value) in self.free.iter().zip(p) {
            theta[*i] = theta[*i] + *value;
        }
        theta
    }

    fn dynamics<P: Plain>(&self, block: &Block<P>, p: &[f64]) -> Dynamics<'a, P> {
        Dynamics::new(self.model, self.theta(block, p)).in_still_water(block.still)
    }

    /// Simulates a block and hands over what is measured of every sample.
    fn rollout<P: Plain>(&self, block: &Block<P>, p: &[f64], sink: impl FnMut(usize, &[P; STATES])) {
        self.roll(block, &self.dynamics(block, p), &block.inputs, |x| x, sink);
    }

    /// As [`Self::rollout`], with parameters of a number that carries derivatives.
    fn roll_with<S: Number<Coefficient = S>>(
        &self,
        block: &Block<f64>,
        theta: Vec<S>,
        sink: impl FnMut(usize, &[S; STATES]),
    ) {
        let dynamics = Dynamics::new(self.model, theta).in_still_water(block.still);
        let samples: Vec<Inputs<S>> = block.inputs.iter().map(|i| i.map(S::from_f64)).collect();
        self.roll(block, &dynamics, &samples, S::from_f64, sink);
    }

    fn roll<P: Plain, S: Number<Coefficient = S>>(
        &self,
        block: &Block<P>,
        dynamics: &Dynamics<S>,
        samples: &[Inputs<S>],
        constant: impl Fn(P) -> S,
        mut sink: impl FnMut(usize, &[S; STATES]),
    ) {
        let series = simulate::driven(dynamics, self.integration, block.dt, samples);
        let mut initial = block.initial.map(&constant);
        if self.sensed {
            initial = simulate::start(dynamics, &series[0], &initial, &block.channels.map(&constant));
        }
        let instants = self.integration.instants();
        simulate::rollout(dynamics, self.integration, block.dt, &series, &initial, |k, state| {
            if self.sensed {
                sink(k, &dynamics.report(state, &series[k * instants]));
            } else {
                sink(k, state);
            }
            true
        });
    }

    /// The first run, on any rank, whose simulation diverges at `p`, and when \[s\] on its recording's clock.
    pub fn divergence(&self, p: &[f64]) -> Option<(String, f64)> {
        let own = self.runs.iter().enumerate().find_map(|(i, run)| {
            let theta = self.theta(&Block::<f64>::of(self.model, self.runs, &self.weights, &[i])?, p);
            let scenario = Scenario { dt: run.dt, inputs: run.inputs.clone(), initial: run.initial };
            let trajectory = simulate::reported(self.model, &theta, self.integration, &scenario, &run.channels());
            trajectory.diverged_at.map(|k| (run.recording.clone(), run.time(k)))
        });
        self.ranks.gather(&own).into_iter().flatten().next()
    }
}
