//! The matrix of second derivatives that Ipopt is given: Gauss-Newton, what that leaves out as estimated from gradients, and damping.
//! It chooses no step: Ipopt does.
//!
//! ```text
//! W = abs(H + S) + damping diag(H)
//! ```
//!
//! H is the Gauss-Newton matrix of cost and priors in scaled parameters. It leaves out the curvature of the residuals, which is a multiple of
//! H in some direction where residuals are large: Newton steps then overshoot, however near the optimum. The matrix S stands for it,
//! learnt from how the gradient changed over each step, and is used as long as it predicts the change of the objective better than H
//! alone does. Source: Dennis, Gay and Welsch, "An adaptive nonlinear least-squares algorithm", ACM Trans. Math. Softw. 7 (1981)
//! 348-368, with the change of the gradient less that by H for the change that S explains. abs() takes the absolute values of the
//! eigenvalues: at a minimum none is below 0.
//!
//! A line search alone goes less far along a poor direction. Damping also turns the direction towards that of steepest descent, in units of each
//! parameter's own curvature: it grows where Ipopt had to shorten a step and falls where it had not. Source: Levenberg, Quart. Appl.
//! Math. 2 (1944) 164-168; Marquardt, J. SIAM 11 (1963) 431-441.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Trial points of a line search up to which a step counts as well predicted, and from which on as poorly predicted.
const FORETOLD: usize = 1;
const POORLY: usize = 3;

/// Damping after the first step that was shortened, the factor by which it grows and falls, where it is switched off, and its most.
const FIRST_DAMPING: f64 = 1e-2;
const DAMPING_FACTOR: f64 = 10.0;
const NO_DAMPING: f64 = 1e-6;
const MOST_DAMPING: f64 = 1e4;

/// Share of the diagonal's largest entry that the damping of a parameter takes at least.
const LEAST_DIAGONAL: f64 = 1e-9;

/// Share of the largest curvature that is added to each, so that directions which nothing determines have one.
const RIDGE: f64 = 1e-13;

/// Cosine between a step and the change of the gradient over it, below which nothing is learnt of the curvature.
const LEAST_TURN: f64 = 1e-8;

/// The objective at a point, by the scaled parameters and as the solver counts it.
#[derive(Clone)]
pub(in crate::fit) struct Local {
    pub z: DVector<f64>,
    pub value: f64,
    pub gradient: DVector<f64>,
    pub gauss_newton: DMatrix<f64>,
}

/// What was learnt of the curvature along the way of a solve.
pub(in crate::fit) struct Curvature {
    /// S above.
    residual: DMatrix<f64>,
    used: bool,
    damping: f64,
    /// The last iterate.
    here: Option<Local>,
}

impl Curvature {
    /// That of which nothing is known yet.
    pub fn unknown(n: usize) -> Self {
        Self { residual: DMatrix::zeros(n, n), used: false, damping: 0.0, here: None }
    }

    /// Forgets where the last solve was, and what its steps say of the damping, but not what was learnt.
    pub fn leave(&mut self) {
        self.here = None;
        self.damping = 0.0;
    }

    /// The matrix for the solver at an iterate that its line search reached in so many trials.
    pub fn at(&mut self, now: Local, trials: usize) -> DMatrix<f64> {
        if let Some(before) = self.here.take().filter(|before| before.z != now.z) {
            let step = &now.z - &before.z;
            let other_model = self.learn(&before, &now, &step);
            if trials <= FORETOLD {
                let lowered = self.damping / DAMPING_FACTOR;
                self.damping = if lowered < NO_DAMPING { 0.0 } else { lowered };
            } else if trials >= POORLY && !other_model {
                // The other model is tried before shorter steps are.
                self.damping = (self.damping * DAMPING_FACTOR).clamp(FIRST_DAMPING, MOST_DAMPING);
            }
        }
        let matrix = self.matrix(&now.gauss_newton);
        self.here = Some(now);
        matrix
    }

    /// What a step between two points says: which model is used from now on, and what S is. True where it is the other model that is
    /// used.
    fn learn(&mut self, from: &Local, to: &Local, step: &DVector<f64>) -> bool {
        let change = to.value - from.value;
        let alone = from.gradient.dot(step) + 0.5 * (&from.gauss_newton * step).dot(step);
        let extra = 0.5 * (&self.residual * step).dot(step);
        let (used, other) = if self.used { (alone + extra, alone) } else { (alone, alone + extra) };
        let changes = (change - used).abs() > (change - other).abs();
        self.used ^= changes;
        let turned = &to.gradient - &from.gradient;
        let unexplained = &turned - &to.gauss_newton * step;
        let along = turned.dot(step);
        if along.is_nan() || along <= LEAST_TURN * turned.norm() * step.norm() {
            return changes;
        }
        let known = (&self.residual * step).dot(step).abs();
        if known > 0.0 {
            self.residual *= (unexplained.dot(step).abs() / known).min(1.0);
        }
        let miss = unexplained - &self.residual * step;
        let share = miss.dot(step) / (along * along);
        self.residual += (&miss * turned.transpose() + &turned * miss.transpose()) / along;
        self.residual -= &turned * turned.transpose() * share;
        changes
    }

    /// W above.
    fn matrix(&self, gauss_newton: &DMatrix<f64>) -> DMatrix<f64> {
        let mut matrix = if self.used { absolute(gauss_newton + &self.residual) } else { gauss_newton.clone() };
        let largest = gauss_newton.diagonal().max().max(f64::MIN_POSITIVE);
        for j in 0..matrix.nrows() {
            let diagonal = gauss_newton[(j, j)].max(LEAST_DIAGONAL * largest);
            matrix[(j, j)] += RIDGE * largest + self.damping * diagonal;
        }
        matrix
    }
}

/// A symmetric matrix with the absolute values of its eigenvalues.
fn absolute(matrix: DMatrix<f64>) -> DMatrix<f64> {
    let eigen = SymmetricEigen::new(matrix.clone());
    if eigen.eigenvalues.iter().all(|v| *v > 0.0) {
        return matrix;
    }
    let sizes = DMatrix::from_diagonal(&eigen.eigenvalues.abs());
    &eigen.eigenvectors * sizes * eigen.eigenvectors.transpose()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `f = sum_i r_i^2` of the residuals `x^2 - 2` and `3 (y - x) + c x^2`, large where c is.
    fn local(x: f64, y: f64) -> Local {
        let r = [x * x + 5.0, 3.0 * (y - x)];
        let j = DMatrix::from_row_slice(2, 2, &[2.0 * x, 0.0, -3.0, 3.0]);
        let r = DVector::from_row_slice(&r);
        Local {
            z: DVector::from_row_slice(&[x, y]),
            value: r.norm_squared(),
            gradient: 2.0 * j.transpose() * &r,
            gauss_newton: 2.0 * j.transpose() * &j,
        }
    }

    #[test]
    fn the_curvature_of_large_residuals_is_learnt_from_the_gradients() {
        // At the minimum x = y = 0 the Gauss-Newton matrix has no curvature along (1, 1), where the cost has 2 * 2 * 5.
        let mut curvature = Curvature::unknown(2);
        for (x, y) in [(0.4, 0.5), (0.2, 0.1), (0.1, 0.12), (0.05, 0.02), (0.02, 0.03), (0.01, 0.0)] {
            curvature.at(local(x, y), 1);
        }
        let matrix = curvature.at(local(0.0, 0.0), 1);
        let along = DVector::from_row_slice(&[0.5f64.sqrt(), 0.5f64.sqrt()]);
        let found = (&matrix * &along).dot(&along);
        assert!((found - 10.0).abs() < 1.0, "{found}");
    }

    /// The squares of `x` and `3 (y - x)` at x = y: residuals without curvature.
    fn linear(x: f64) -> Local {
        let j = DMatrix::from_row_slice(2, 2, &[1.0, 0.0, -3.0, 3.0]);
        let r = DVector::from_row_slice(&[x, 0.0]);
        Local {
            z: DVector::from_row_slice(&[x, x]),
            value: r.norm_squared(),
            gradient: 2.0 * j.transpose() * &r,
            gauss_newton: 2.0 * j.transpose() * &j,
        }
    }

    #[test]
    fn damping_grows_where_steps_are_shortened_and_goes_where_they_are_not() {
        let mut curvature = Curvature::unknown(2);
        let mut damping = |x: f64, trials: usize| curvature.at(linear(x), trials)[(1, 1)] / 18.0 - 1.0;
        // Whole numbers of 64ths leave no rounding to be taken for curvature.
        assert!(damping(1.0, 0) < 1e-9);
        assert!(damping(60.0 / 64.0, POORLY) > 0.9 * FIRST_DAMPING);
        let poor = (1..6).map(|i| damping((60.0 - f64::from(i)) / 64.0, POORLY)).fold(0.0, f64::max);
        assert!(poor > 5.0 * FIRST_DAMPING, "{poor}");
        let good = (1..15).map(|i| damping((50.0 - f64::from(i)) / 64.0, FORETOLD)).last();
        assert!(good < Some(1e-6), "{good:?}");
    }
}
