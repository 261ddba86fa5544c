//! Jacobians, gradients and Hessians of functions of any number of variables, a few variables at a time, and a check of
//! them against central differences. Derivatives come from [`Dual`] alone; this file differentiates nothing itself.

use crate::{Dual, Scalar};
use nalgebra::{DMatrix, DVector};
use std::fmt;

/// How many variables [`jacobian`] and [`gradient`] differentiate by in one pass: a cache line of `f64`.
pub const CHUNK: usize = 8;

/// How many variables [`hessian`] takes on each of its two levels: a number then has `(1 + 4)^2` values.
pub const HESSIAN_CHUNK: usize = 4;

/// A function of `x.len()` numbers with [`outputs`](Self::outputs) results, written once for every [`Scalar`].
///
/// It is a trait because a closure cannot be generic over the number it takes. Constants (data, settings) are
/// fields; the variables are `x`. A law's coefficients may be among them, since [`Scalar::Coefficient`] is the number itself.
pub trait VectorFunction {
    /// How many numbers [`eval`](Self::eval) writes.
    fn outputs(&self) -> usize;
    /// Writes `f(x)` over all of `y`, which has length [`outputs`](Self::outputs) and arrives filled with zeros.
    fn eval<S: Scalar<Coefficient = S>>(&self, x: &[S], y: &mut [S]);
}

/// A function of `x.len()` numbers with one result, written once for every [`Scalar`]: a cost, or one force.
///
/// Each is a [`VectorFunction`] of one output as well.
pub trait ScalarFunction {
    /// The value `f(x)`.
    fn of<S: Scalar<Coefficient = S>>(&self, x: &[S]) -> S;
}

impl<F: ScalarFunction> VectorFunction for F {
    fn outputs(&self) -> usize {
        1
    }
    fn eval<S: Scalar<Coefficient = S>>(&self, x: &[S], y: &mut [S]) {
        y[0] = self.of(x);
    }
}

/// `f(x)` and the exact Jacobian `J[i, j] = d f_i / d x_j`, [`CHUNK`] columns to a pass.
pub fn jacobian<F: VectorFunction>(f: &F, x: &[f64]) -> (Vec<f64>, DMatrix<f64>) {
    jacobian_in_chunks::<CHUNK, F>(f, x)
}

/// As [`jacobian`] with `C` columns to a pass (at least 1). The result does not depend on `C`; the time does.
pub fn jacobian_in_chunks<const C: usize, F: VectorFunction>(f: &F, x: &[f64]) -> (Vec<f64>, DMatrix<f64>) {
    const { assert!(C > 0, "a chunk has at least one variable") };
    let mut jacobian = DMatrix::zeros(f.outputs(), x.len());
    let mut y = vec![Dual::<f64, C>::zero(); f.outputs()];
    for start in (0..x.len()).step_by(C) {
        let columns = start..x.len().min(start + C);
        let seeded: Vec<_> = (0..x.len())
            .map(|k| if columns.contains(&k) { Dual::variable(x[k], k - start) } else { Dual::constant(x[k]) })
            .collect();
        y.fill(Dual::zero());
        f.eval(&seeded, &mut y);
        for j in columns {
            for (i, yi) in y.iter().enumerate() {
                jacobian[(i, j)] = yi.eps[j - start];
            }
        }
    }
    // Without variables no pass was made.
    let values = if x.is_empty() { values(f, x) } else { y.iter().map(|yi| yi.re).collect() };
    (values, jacobian)
}

/// `f(x)` and the exact gradient of a function with one result.
pub fn gradient<F: ScalarFunction>(f: &F, x: &[f64]) -> (f64, DVector<f64>) {
    let (y, jacobian) = jacobian(f, x);
    (y[0], jacobian.row(0).transpose())
}

/// `f(x)`, the gradient, and the exact Hessian `H[i, j] = d2 f / d x_i d x_j`, symmetric to the last bit.
pub fn hessian<F: ScalarFunction>(f: &F, x: &[f64]) -> (f64, DVector<f64>, DMatrix<f64>) {
    hessian_in_chunks::<HESSIAN_CHUNK, F>(f, x)
}

/// As [`hessian`] with `C` by `C` entries to a pass (at least 1), over nested duals.
pub fn hessian_in_chunks<const C: usize, F: ScalarFunction>(f: &F, x: &[f64]) -> (f64, DVector<f64>, DMatrix<f64>) {
    const { assert!(C > 0, "a chunk has at least one variable") };
    let n = x.len();
    let mut gradient = DVector::zeros(n);
    let mut hessian = DMatrix::zeros(n, n);
    for row in (0..n).step_by(C) {
        // The blocks on and below the diagonal; the rest is their mirror image.
        for column in (0..=row).step_by(C) {
            let seeded: Vec<Dual<Dual<f64, C>, C>> = (0..n)
                .map(|k| {
                    let inner = if (column..column + C).contains(&k) {
                        Dual::variable(x[k], k - column)
                    } else {
                        Dual::constant(x[k])
                    };
                    if (row..row + C).contains(&k) { Dual::variable(inner, k - row) } else { Dual::constant(inner) }
                })
                .collect();
            let y = f.of(&seeded);
            for i in row..n.min(row + C) {
                gradient[i] = y.eps[i - row].re;
                for j in column..(column + C).min(i + 1) {
                    hessian[(i, j)] = y.eps[i - row].eps[j - column];
                    hessian[(j, i)] = hessian[(i, j)];
                }
            }
        }
    }
    (f.of(x), gradient, hessian)
}

/// How far [`central_differences`] steps to either side of `x_j`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// The same step for every variable, in the unit of each.
    Absolute(f64),
    /// `relative * max(|x_j|, floor)`: for variables of unlike size. `floor` is the size below which a variable counts
    /// as zero.
    Relative {
        /// The step of a variable of size 1.
        relative: f64,
        /// The least size that a variable is taken to have.
        floor: f64,
    },
}

impl Default for Step {
    /// The cube root of the rounding unit, at which the truncation and the rounding error are about equal.
    fn default() -> Self {
        Self::Relative { relative: f64::EPSILON.cbrt(), floor: 1.0 }
    }
}

impl Step {
    /// The step for a variable at `x`.
    pub fn at(self, x: f64) -> f64 {
        match self {
            Self::Absolute(step) => step,
            Self::Relative { relative, floor } => relative * f64::max(x.abs(), floor),
        }
    }
}

/// The Jacobian by `(f(x + h e_j) - f(x - h e_j)) / 2h`: second order in `h`, and only as good as `f` is smooth.
pub fn central_differences<F: VectorFunction>(f: &F, x: &[f64], step: Step) -> DMatrix<f64> {
    differences(f, x, step).estimate
}

/// Central differences, and how far rounding of the two values alone can carry each entry.
struct Differences {
    estimate: DMatrix<f64>,
    rounding: DMatrix<f64>,
}

fn differences<F: VectorFunction>(f: &F, x: &[f64], step: Step) -> Differences {
    /// How many rounding units the values of `f` are trusted to.
    const ROUNDING_UNITS: f64 = 8.0;
    let mut estimate = DMatrix::zeros(f.outputs(), x.len());
    let mut rounding = estimate.clone();
    let mut at = x.to_vec();
    for j in 0..x.len() {
        let h = step.at(x[j]);
        let (above, below) = (x[j] + h, x[j] - h);
        at[j] = above;
        let y_above = values(f, &at);
        at[j] = below;
        let y_below = values(f, &at);
        at[j] = x[j];
        for i in 0..f.outputs() {
            // The distance actually stepped, which rounding may have made other than 2 h.
            estimate[(i, j)] = (y_above[i] - y_below[i]) / (above - below);
            let size = f64::max(y_above[i].abs(), y_below[i].abs());
            rounding[(i, j)] = ROUNDING_UNITS * f64::EPSILON * size / (above - below);
        }
    }
    Differences { estimate, rounding }
}

/// `f(x)` without derivatives.
fn values<F: VectorFunction>(f: &F, x: &[f64]) -> Vec<f64> {
    let mut y = vec![0.0; f.outputs()];
    f.eval(x, &mut y);
    y
}

/// One entry of a Jacobian, computed both ways.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GradientEntry {
    /// Which result of the function.
    pub output: usize,
    /// Which variable it is differentiated by.
    pub input: usize,
    /// The derivative by dual numbers.
    pub exact: f64,
    /// The derivative by central differences.
    pub estimate: f64,
    /// `|exact - estimate|` over the larger of the two, less the part that rounding of the values explains. Infinite when
    /// either is not finite.
    pub relative_error: f64,
}

/// The result of [`check_gradient`]. Its `Display` is one line that names the worst entry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GradientCheck {
    /// The entry that disagrees most; `None` for a function without results or variables.
    pub worst: Option<GradientEntry>,
    /// The relative error up to which the two count as equal.
    pub tolerance: f64,
}

impl GradientCheck {
    /// Whether every entry agrees within the tolerance.
    pub fn passed(&self) -> bool {
        self.worst.is_none_or(|entry| entry.relative_error <= self.tolerance)
    }
}

impl fmt::Display for GradientCheck {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(entry) = self.worst else {
            return write!(out, "gradient check passed: there is no derivative to compare");
        };
        let GradientEntry { output, input, exact, estimate, relative_error } = entry;
        if self.passed() {
            return write!(
                out,
                "gradient check passed: the largest relative error is {relative_error:.1e}, in d y[{output}] / d x[{input}]"
            );
        }
        if !relative_error.is_finite() {
            return write!(
                out,
                "gradient check failed: d y[{output}] / d x[{input}] is not finite; guard a division, root or logarithm \
                 at this point before it is taken"
            );
        }
        write!(
            out,
            "gradient check failed: d y[{output}] / d x[{input}] is {exact:.9e} by dual numbers and {estimate:.9e} by \
             central differences (relative error {relative_error:.1e}, tolerance {:.1e}); look for a derivative dropped \
             through `value()`, or for a corner within a step of this point",
            self.tolerance
        )
    }
}

/// Compares the exact Jacobian of `f` at `x` with central differences, entry by entry, in the manner of Ceres Solver's
/// `GradientChecker`. With the default [`Step`] a smooth function agrees to about 1e-8; `1e-6` is a sensible tolerance.
///
/// ```
/// use trimtab_ad::{Scalar, ScalarFunction, Step, check_gradient};
///
/// /// A term that lost its derivative: `value()` makes a plain number of the speed.
/// struct Broken;
/// impl ScalarFunction for Broken {
///     fn of<S: Scalar>(&self, x: &[S]) -> S {
///         x[0] * x[1].value()
///     }
/// }
///
/// let check = check_gradient(&Broken, &[2.0, 3.0], Step::default(), 1e-6);
/// assert!(!check.passed());
/// assert_eq!(check.worst.map(|entry| entry.input), Some(1));
/// ```
pub fn check_gradient<F: VectorFunction>(f: &F, x: &[f64], step: Step, tolerance: f64) -> GradientCheck {
    let (_, exact) = jacobian(f, x);
    let Differences { estimate, rounding } = differences(f, x, step);
    let entries = (0..x.len()).flat_map(|input| (0..f.outputs()).map(move |output| (output, input)));
    let worst = entries
        .map(|(output, input)| {
            let at = (output, input);
            let (exact, estimate) = (exact[at], estimate[at]);
            let unexplained = (exact - estimate).abs() - rounding[at];
            let relative_error = if !unexplained.is_finite() {
                f64::INFINITY
            } else if unexplained <= 0.0 {
                0.0
            } else {
                unexplained / f64::max(exact.abs(), estimate.abs())
            };
            GradientEntry { output, input, exact, estimate, relative_error }
        })
        // The first of equals, so that the report does not change with the number of entries after it.
        .reduce(|worst, entry| if entry.relative_error > worst.relative_error { entry } else { worst });
    GradientCheck { worst, tolerance }
}
