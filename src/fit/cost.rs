//! The weighted trajectory cost of a model against recordings, with exact first and second derivatives by the parameters.
//! It knows no constraint, prior or solver: it evaluates one sum of squares and what follows from it.
//!
//! With M runs of K_i samples, measured states `xi_bar` and simulated states `xi`,
//!
//! ```text
//! C(p) = (1/M) sum_i sum_k e^T W_i e,    e = xi_bar - xi,    W_i = diag(1/L_i, 1/L_i, 1/pi, 1/U_i, 1/U_i, 1/r_max)
//! ```
//!
//! L_i path length \[m\], U_i mean speed \[m/s\], r_max a reference yaw rate \[rad/s\], the heading difference wrapped into
//! (-pi, pi]. Channels that were not measured have weight 0. Source: Papandreou et al. 2025 (arXiv 2502.18696), eq. (5).

use super::FitError;
use crate::model::{BASE, Model};
use crate::physics::{CHUNK, Curvature, Gradient, GradientLanes, Group, Lanes, NumDual, Number};
use crate::recording::{Measured, Run};
use crate::ship::Ship;
use crate::simulate::{self, Integration, Scenario, absurd_speed, step};
use crate::state::{Force, Inputs, STATES};
use crate::terms;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};
use std::ops::Range;
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
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Derivatives {
    /// Exact: dual numbers over SIMD lanes, eight runs side by side.
    #[default]
    Lanes,
    /// Exact: dual numbers, run by run.
    Dual,
    /// Exact: dual numbers of the num-dual crate, run by run.
    NumDual,
    /// Central differences of the residuals, eight runs side by side.
    FiniteDifferences,
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
    /// Gradient of each run's part, in the order of the runs; they add up to `gradient`.
    pub by_run: Vec<DVector<f64>>,
}

/// The cost of a model against runs, as a function of the model's free parameters.
pub struct Cost<'a> {
    model: &'a Model,
    runs: &'a [Run],
    /// The diagonal of W of each run.
    weights: Vec<[f64; STATES]>,
    free: Vec<usize>,
    derivatives: Derivatives,
    difference_step: f64,
    integration: Integration,
    limit: f64,
    /// Whether a term may change the inputs of a run.
    driven: bool,
    /// Whether a term may change what is reported of the state.
    sensed: bool,
    lanes: Vec<Block<Lanes>>,
    single: Vec<Block<f64>>,
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
}

/// A number without derivatives: one run, or eight.
trait Plain: Differential<Plain = Self> {
    const WIDTH: usize;
    fn gather(f: impl FnMut(usize) -> f64) -> Self;
    fn in_lane(self, lane: usize) -> f64;
}

/// A number that may carry derivatives by a chunk of the parameters.
trait Differential: Number {
    type Plain: Plain;
    fn constant(x: Self::Plain) -> Self;
    fn variable(x: Self::Plain, j: usize) -> Self;
    fn re(&self) -> Self::Plain;
    fn slopes(&self) -> [Self::Plain; CHUNK];
}

impl Plain for f64 {
    const WIDTH: usize = 1;
    fn gather(mut f: impl FnMut(usize) -> f64) -> Self {
        f(0)
    }
    fn in_lane(self, _lane: usize) -> f64 {
        self
    }
}

impl Plain for Lanes {
    const WIDTH: usize = Lanes::LANES;
    fn gather(f: impl FnMut(usize) -> f64) -> Self {
        Lanes::from_fn(f)
    }
    fn in_lane(self, lane: usize) -> f64 {
        self.lane(lane)
    }
}

macro_rules! without_derivatives {
    ($($number:ty),+) => {$(
        impl Differential for $number {
            type Plain = Self;
            fn constant(x: Self) -> Self {
                x
            }
            fn variable(x: Self, _j: usize) -> Self {
                x
            }
            fn re(&self) -> Self {
                *self
            }
            fn slopes(&self) -> [Self; CHUNK] {
                [Self::zero(); CHUNK]
            }
        }
    )+};
}
without_derivatives!(f64, Lanes);

macro_rules! with_derivatives {
    ($($number:ty, $plain:ty);+) => {$(
        impl Differential for $number {
            type Plain = $plain;
            fn constant(x: $plain) -> Self {
                Dual::constant(x)
            }
            fn variable(x: $plain, j: usize) -> Self {
                Dual::variable(x, j)
            }
            fn re(&self) -> $plain {
                self.re
            }
            fn slopes(&self) -> [$plain; CHUNK] {
                self.eps
            }
        }
    )+};
}
with_derivatives!(Gradient, f64; GradientLanes, Lanes);

impl Differential for NumDual {
    type Plain = f64;
    fn constant(x: f64) -> Self {
        Self::from_re(x)
    }
    fn variable(x: f64, j: usize) -> Self {
        let mut eps = nalgebra::SVector::<f64, CHUNK>::zeros();
        eps[j] = 1.0;
        Self::new(x, num_dual::Derivative::some(eps))
    }
    fn re(&self) -> f64 {
        self.re
    }
    fn slopes(&self) -> [f64; CHUNK] {
        let eps = self.eps.unwrap_generic(nalgebra::Const::<CHUNK>, nalgebra::Const::<1>);
        std::array::from_fn(|j| eps[j])
    }
}

/// What one block adds to the cost, lane by lane: sums of `e^2`, `e de/dp_j` and `de/dp_i de/dp_j` (lower triangle, packed).
struct Sums<P> {
    square: P,
    gradient: Vec<P>,
    matrix: Vec<P>,
}

impl<P: Plain> Sums<P> {
    fn new(n: usize, with_matrix: bool) -> Self {
        let entries = if with_matrix { n * (n + 1) / 2 } else { 0 };
        Self { square: P::zero(), gradient: vec![P::zero(); n], matrix: vec![P::zero(); entries] }
    }

    #[inline]
    fn add(&mut self, residual: P, row: &[P]) {
        self.square += residual * residual;
        for (g, d) in self.gradient.iter_mut().zip(row) {
            *g += residual * *d;
        }
        if self.matrix.is_empty() {
            return;
        }
        let mut rest = &mut self.matrix[..];
        for i in 0..row.len() {
            let (line, next) = rest.split_at_mut(i + 1);
            let d = row[i];
            for (h, e) in line.iter_mut().zip(row) {
                *h += d * *e;
            }
            rest = next;
        }
    }
}

impl<P: Plain> Block<P> {
    fn of(model: &Model, runs: &[Run], weights: &[[f64; STATES]], lanes: &[usize]) -> Self {
        let in_lane = |lane: usize| &runs[lanes[lane.min(lanes.len() - 1)]];
        let steps = lanes.iter().map(|r| runs[*r].inputs.len()).max().unwrap_or(0);
        let sample = |lane: usize, k: usize| {
            let inputs = &in_lane(lane).inputs;
            &inputs[k.min(inputs.len() - 1)]
        };
        let field = |k: usize, f: &dyn Fn(&Inputs<f64>) -> f64| P::gather(|lane| f(sample(lane, k)));
        let inputs = (0..steps)
            .map(|k| Inputs {
                t: field(k, &|i| i.t),
                n: field(k, &|i| i.n),
                delta: field(k, &|i| i.delta),
                wind: [field(k, &|i| i.wind[0]), field(k, &|i| i.wind[1])],
                current: [field(k, &|i| i.current[0]), field(k, &|i| i.current[1])],
                waves: [field(k, &|i| i.waves[0]), field(k, &|i| i.waves[1])],
                draught_to_depth: field(k, &|i| i.draught_to_depth),
                bank: field(k, &|i| i.bank),
                thruster: field(k, &|i| i.thruster),
            })
            .collect();
        let weight = |lane: usize, k: usize, c: usize| {
            let Some(&run) = lanes.get(lane) else { return 0.0 };
            let compared = runs[run].measured.get(k).is_some_and(|m| m[c].is_some());
            if compared { weights[run][c].max(0.0).sqrt() } else { 0.0 }
        };
        let measured =
            |lane: usize, k: usize, c: usize| in_lane(lane).measured.get(k).and_then(|m| m[c]).unwrap_or(0.0);
        let table = |f: &dyn Fn(usize, usize, usize) -> f64| -> Vec<[P; STATES]> {
            (0..steps).map(|k| std::array::from_fn(|c| P::gather(|lane| f(lane, k, c)))).collect()
        };
        let channels = |lane: usize| in_lane(lane).channels();
        let whole =
            (0..steps).map(|k| (0..P::WIDTH).all(|lane| (0..STATES).all(|c| weight(lane, k, c) > 0.0))).collect();
        let mut by_lane: Vec<Vec<f64>> = Vec::new();
        for lane in 0..P::WIDTH {
            let mut values: Vec<f64> = model.parameters.iter().map(|p| if p.free { 0.0 } else { p.value }).collect();
            for (i, addition) in model.sessions.get(&in_lane(lane).session).into_iter().flatten() {
                values[*i] += addition;
            }
            by_lane.push(values);
        }
        Self {
            runs: lanes.to_vec(),
            dt: in_lane(0).dt,
            inputs,
            initial: std::array::from_fn(|c| P::gather(|lane| in_lane(lane).initial[c])),
            channels: std::array::from_fn(|c| P::gather(|lane| f64::from(u8::from(channels(lane)[c])))),
            target: table(&measured),
            root: table(&weight),
            whole,
            base: (0..model.parameters.len()).map(|i| P::gather(|lane| by_lane[lane][i])).collect(),
        }
    }

    /// Runs in blocks of equal sample period and similar length, in an order that depends on the runs alone.
    fn group(model: &Model, runs: &[Run], weights: &[[f64; STATES]]) -> Vec<Self> {
        let mut order: Vec<usize> = (0..runs.len()).collect();
        order.sort_by(|a, b| {
            let (a, b) = (&runs[*a], &runs[*b]);
            a.dt.total_cmp(&b.dt).then(b.inputs.len().cmp(&a.inputs.len()))
        });
        let same_dt = order.chunk_by(|a, b| runs[*a].dt == runs[*b].dt);
        same_dt.flat_map(|runs| runs.chunks(P::WIDTH)).map(|lanes| Self::of(model, runs, weights, lanes)).collect()
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

    /// The derivatives of that weighted difference. What a run does after it has ended, be it NaN, is dropped.
    #[inline]
    fn row<const N: usize>(&self, k: usize, c: usize, slopes: [P; N]) -> [P; N] {
        let root = self.root[k][c];
        let row = slopes.map(|slope| -(slope * root));
        if self.whole[k] {
            return row;
        }
        let counted = P::zero().less(root);
        row.map(|r| P::select(counted, r, P::zero()))
    }
}

impl<'a> Cost<'a> {
    /// The cost of `model` against `runs`.
    ///
    /// # Errors
    /// No runs, a run without samples or of unequal lengths, or a sample period that is not positive.
    pub fn new(model: &'a Model, runs: &'a [Run], options: CostOptions) -> Result<Self, FitError> {
        if runs.is_empty() {
            return Err(FitError::NoRuns);
        }
        for run in runs {
            let bad = |what: &str| Err(FitError::BadRun { run: run.recording.clone(), what: what.into() });
            if run.inputs.len() != run.measured.len() || run.inputs.len() < 2 {
                return bad("inputs and measured states must have the same number of samples, at least 2");
            }
            if !(run.dt.is_finite() && run.dt > 0.0) {
                return bad("the sample period must be positive");
            }
            let weights = weights(&model.ship, run, options.max_yaw_rate);
            if !run.initial.iter().chain(&weights).all(|v| v.is_finite()) {
                return bad("the initial state and the weights must be finite");
            }
        }
        let names = model.term_names();
        let sensor = |name: &&str| terms::find(name).is_some_and(|t| t.info().group == Group::Sensor);
        let mut cost = Self {
            model,
            runs,
            weights: runs.iter().map(|r| weights(&model.ship, r, options.max_yaw_rate)).collect(),
            free: model.free(),
            derivatives: options.derivatives,
            difference_step: options.difference_step,
            integration: options.integration,
            limit: absurd_speed(model),
            driven: names.iter().any(|name| !BASE.contains(name)),
            sensed: names.iter().any(sensor),
            lanes: Vec::new(),
            single: Vec::new(),
        };
        match options.derivatives {
            Derivatives::Lanes | Derivatives::FiniteDifferences => {
                cost.lanes = Block::group(model, runs, &cost.weights)
            }
            Derivatives::Dual | Derivatives::NumDual => cost.single = Block::group(model, runs, &cost.weights),
        }
        Ok(cost)
    }

    /// Indices of the free parameters in the model.
    pub fn free(&self) -> &[usize] {
        &self.free
    }

    /// Number of residuals that count: measured values with a weight above 0.
    pub fn residuals(&self) -> usize {
        let counted = |(run, weights): (&Run, &[f64; STATES])| {
            let of = |m: &Measured| (0..STATES).filter(|c| weights[*c] > 0.0 && m[*c].is_some()).count();
            run.measured.iter().map(of).sum::<usize>()
        };
        self.runs.iter().zip(&self.weights).map(counted).sum()
    }

    /// The cost at the free parameters `p`, or `None` where a simulation diverges.
    pub fn value(&self, p: &[f64]) -> Option<f64> {
        let squares = self.squares(p)?;
        Some(squares.iter().sum::<f64>() / self.runs.len() as f64)
    }

    /// The sum of squared weighted residuals of each run, or `None` where a simulation diverges.
    pub fn squares(&self, p: &[f64]) -> Option<Vec<f64>> {
        if self.lanes.is_empty() { self.squares_over(&self.single, p) } else { self.squares_over(&self.lanes, p) }
    }

    fn squares_over<P: Plain>(&self, blocks: &[Block<P>], p: &[f64]) -> Option<Vec<f64>> {
        let parts: Vec<Option<P>> = blocks
            .par_iter()
            .map(|block| {
                let (mut square, mut fastest) = (P::zero(), P::zero());
                self.rollout(block, &self.theta::<P>(block, p, 0..0), |k, y| {
                    for c in 0..STATES {
                        let residual = block.residual(k, c, y[c]);
                        square += residual * residual;
                    }
                    fastest =
                        fastest.max(P::select(P::zero().less(block.root[k][3]), y[3] * y[3] + y[4] * y[4], P::zero()));
                });
                let sane = (0..P::WIDTH)
                    .all(|lane| square.in_lane(lane).is_finite() && fastest.in_lane(lane) < self.limit * self.limit);
                sane.then_some(square)
            })
            .collect();
        let mut squares = vec![0.0; self.runs.len()];
        for (block, part) in blocks.iter().zip(parts) {
            let part = part?;
            for (lane, run) in block.runs.iter().enumerate() {
                squares[*run] = part.in_lane(lane);
            }
        }
        Some(squares)
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
            Derivatives::Lanes => self.assemble(&self.lanes, |b| self.sweep::<GradientLanes>(b, p, with_matrix)),
            Derivatives::Dual => self.assemble(&self.single, |b| self.sweep::<Gradient>(b, p, with_matrix)),
            Derivatives::NumDual => self.assemble(&self.single, |b| self.sweep::<NumDual>(b, p, with_matrix)),
            Derivatives::FiniteDifferences => self.assemble(&self.lanes, |b| self.differences(b, p, with_matrix)),
        }
    }

    /// Adds up the blocks, in their order whatever thread computed them.
    fn assemble<P: Plain>(
        &self,
        blocks: &[Block<P>],
        sums: impl Fn(&Block<P>) -> Sums<P> + Sync + Send,
    ) -> Option<Quadratic> {
        let n = self.free.len();
        let parts: Vec<Sums<P>> = blocks.par_iter().map(sums).collect();
        let mut squares = vec![0.0; self.runs.len()];
        let mut by_run = vec![DVector::zeros(n); self.runs.len()];
        let mut matrix = DMatrix::zeros(n, n);
        let factor = 2.0 / self.runs.len() as f64;
        for (block, part) in blocks.iter().zip(&parts) {
            for (lane, run) in block.runs.iter().enumerate() {
                squares[*run] = part.square.in_lane(lane);
                by_run[*run] = DVector::from_iterator(n, part.gradient.iter().map(|g| factor * g.in_lane(lane)));
            }
            let mut entries = part.matrix.iter();
            for i in 0..n {
                for (j, entry) in (0..=i).zip(&mut entries) {
                    matrix[(i, j)] += factor * (0..block.runs.len()).map(|lane| entry.in_lane(lane)).sum::<f64>();
                }
            }
        }
        matrix.fill_upper_triangle_with_lower_triangle();
        let mut gradient = DVector::zeros(n);
        for part in &by_run {
            gradient += part;
        }
        let value = squares.iter().sum::<f64>() / self.runs.len() as f64;
        let finite = value.is_finite() && gradient.iter().chain(matrix.iter()).all(|v| v.is_finite());
        finite.then_some(Quadratic { value, gradient, gauss_newton: matrix, by_run })
    }

    /// Sums of a block by dual numbers, in as many passes as the parameters take chunks.
    fn sweep<S: Differential>(&self, block: &Block<S::Plain>, p: &[f64], with_matrix: bool) -> Sums<S::Plain> {
        let n = self.free.len();
        let mut sums = Sums::new(n, with_matrix);
        if n <= CHUNK {
            self.rollout(block, &self.theta::<S>(block, p, 0..n), |k, y| {
                for c in 0..STATES {
                    let row = block.row(k, c, y[c].slopes());
                    sums.add(block.residual(k, c, y[c].re()), &row[..n]);
                }
            });
            return sums;
        }
        let zero = S::Plain::zero();
        let mut residuals = vec![zero; block.inputs.len() * STATES];
        let mut rows = vec![zero; block.inputs.len() * STATES * n];
        for start in (0..n).step_by(CHUNK) {
            let chunk = start..(start + CHUNK).min(n);
            self.rollout(block, &self.theta::<S>(block, p, chunk.clone()), |k, y| {
                for c in 0..STATES {
                    let at = k * STATES + c;
                    residuals[at] = block.residual(k, c, y[c].re());
                    let row = block.row(k, c, y[c].slopes());
                    rows[at * n..][chunk.clone()].copy_from_slice(&row[..chunk.len()]);
                }
            });
        }
        for (residual, row) in residuals.iter().zip(rows.chunks(n)) {
            sums.add(*residual, row);
        }
        sums
    }

    /// Sums of a block by central differences of its residuals.
    fn differences<P: Plain>(&self, block: &Block<P>, p: &[f64], with_matrix: bool) -> Sums<P> {
        let n = self.free.len();
        let residuals = |p: &[f64]| {
            let mut residuals = vec![P::zero(); block.inputs.len() * STATES];
            self.rollout(block, &self.theta::<P>(block, p, 0..0), |k, y| {
                for c in 0..STATES {
                    residuals[k * STATES + c] = block.residual(k, c, y[c]);
                }
            });
            residuals
        };
        let mut rows = vec![P::zero(); block.inputs.len() * STATES * n];
        for j in 0..n {
            let step = self.difference_step * self.model.parameters[self.free[j]].scale;
            let mut moved = p.to_vec();
            moved[j] = p[j] + step;
            let (above, up) = (residuals(&moved), moved[j]);
            moved[j] = p[j] - step;
            let (below, down) = (residuals(&moved), moved[j]);
            for (at, (a, b)) in above.iter().zip(&below).enumerate() {
                rows[at * n + j] = (*a - *b) / (up - down);
            }
        }
        let mut sums = Sums::new(n, with_matrix);
        for (residual, row) in residuals(p).iter().zip(rows.chunks(n)) {
            sums.add(*residual, row);
        }
        sums
    }

    /// The exact Hessian of the cost, by second-order dual numbers in blocks of 6 by 6, or `None` where it diverges.
    pub fn hessian(&self, p: &[f64]) -> Option<DMatrix<f64>> {
        let n = self.free.len();
        let parts: Vec<DMatrix<f64>> = (0..self.runs.len())
            .into_par_iter()
            .map(|run| {
                let block = Block::<f64>::of(self.model, self.runs, &self.weights, &[run]);
                let mut sum = DMatrix::zeros(n, n);
                for row in (0..n).step_by(BLOCK) {
                    for column in (0..=row).step_by(BLOCK) {
                        self.add_curvature(&block, p, row, column, &mut sum);
                    }
                }
                sum
            })
            .collect();
        let mut hessian = DMatrix::zeros(n, n);
        for part in parts {
            hessian += part * (2.0 / self.runs.len() as f64);
        }
        hessian.fill_upper_triangle_with_lower_triangle();
        hessian.iter().all(|v: &f64| v.is_finite()).then_some(hessian)
    }

    fn add_curvature(&self, block: &Block<f64>, p: &[f64], row: usize, column: usize, sum: &mut DMatrix<f64>) {
        let n = self.free.len();
        let mut theta: Vec<Curvature> =
            self.theta::<f64>(block, p, 0..0).iter().map(|x| Curvature::from_f64(*x)).collect();
        for j in 0..BLOCK {
            if row + j < n {
                theta[self.free[row + j]].eps[j].re = 1.0;
            }
            if column + j < n {
                theta[self.free[column + j]].re.eps[j] = 1.0;
            }
        }
        self.roll(block, &theta, Curvature::from_f64, |k, y| {
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

    /// All parameters of the model for the runs of a block, the `chunk` of the free ones as variables.
    fn theta<S: Differential>(&self, block: &Block<S::Plain>, p: &[f64], chunk: Range<usize>) -> Vec<S> {
        let mut theta: Vec<S> = block.base.iter().map(|x| S::constant(*x)).collect();
        for (j, i) in self.free.iter().enumerate() {
            let value = block.base[*i] + p[j];
            theta[*i] = if chunk.contains(&j) { S::variable(value, j - chunk.start) } else { S::constant(value) };
        }
        theta
    }

    fn rollout<S: Differential>(&self, block: &Block<S::Plain>, theta: &[S], sink: impl FnMut(usize, &[S; STATES])) {
        self.roll(block, theta, S::constant, sink);
    }

    /// Simulates a block and hands over what is measured of every sample.
    ///
    /// As [`simulate::rollout`], but with inputs that differ between lanes.
    fn roll<P: Plain, S: Number>(
        &self,
        block: &Block<P>,
        theta: &[S],
        constant: impl Fn(P) -> S,
        mut sink: impl FnMut(usize, &[S; STATES]),
    ) {
        // Inputs of a whole run as dual numbers are a megabyte: they are made only where a term may change them.
        let driven: Option<Vec<Inputs<S>>> = self.driven.then(|| {
            let samples: Vec<_> = block.inputs.iter().map(|i| i.map(&constant)).collect();
            simulate::driven(self.model, theta, self.integration, block.dt, &samples)
        });
        let instants = self.integration.instants();
        let mut state = block.initial.map(&constant);
        let mut period = vec![block.inputs[0].map(&constant)];
        if self.sensed {
            let first = driven.as_ref().map_or(&period[0], |series| &series[0]);
            state = simulate::start(self.model, theta, first, &state, &block.channels.map(&constant));
        }
        for k in 0..block.inputs.len() {
            let next = block.inputs.get(k + 1);
            if let (None, Some(next)) = (&driven, next) {
                let now = period[0];
                period.extend(simulate::between(&now, &next.map(&constant), instants));
            }
            let inputs = driven.as_ref().map_or(period.as_slice(), |series| &series[k * instants..]);
            if self.sensed {
                sink(k, &simulate::report(self.model, theta, &state, &inputs[0]));
            } else {
                sink(k, &state);
            }
            if next.is_some() {
                state = step(self.model, theta, self.integration, block.dt, &state, inputs, &Force::zero());
                period.drain(..period.len() - 1);
            }
        }
    }

    /// The first run whose simulation diverges at `p`, and when \[s\] on its recording's clock.
    pub fn divergence(&self, p: &[f64]) -> Option<(String, f64)> {
        self.runs.iter().enumerate().find_map(|(i, run)| {
            let theta = self.theta::<f64>(&Block::of(self.model, self.runs, &self.weights, &[i]), p, 0..0);
            let scenario = Scenario { dt: run.dt, inputs: run.inputs.clone(), initial: run.initial };
            let trajectory = simulate::reported(self.model, &theta, self.integration, &scenario, &run.channels());
            trajectory.diverged_at.map(|k| (run.recording.clone(), run.time(k)))
        })
    }
}
