//! What a fit minimises, as its solver sees it: a value with its derivatives by the free parameters.
//! It says nothing of constraints, priors or the way to the minimum.

use super::cost::{Cost, Quadratic};
use nalgebra::DMatrix;

/// A function of the free parameters that a fit minimises.
pub(in crate::fit) trait Objective {
    /// The value, or `None` where there is none.
    fn value(&self, p: &[f64]) -> Option<f64>;

    /// The value with its gradient and, where asked for, the Gauss-Newton matrix; a matrix of zeros otherwise.
    fn quadratic(&self, p: &[f64], with_matrix: bool) -> Option<Quadratic>;

    /// The exact matrix of second derivatives, where there is one.
    fn hessian(&self, p: &[f64]) -> Option<DMatrix<f64>>;

    /// Factor that makes the value of order one, as the tolerances of the solver expect.
    fn factor(&self) -> f64;

    /// By how much the value may fall, from a start where it is `value`: what barriers are small beside.
    fn reach(&self, value: f64) -> f64;
}

impl Objective for Cost<'_> {
    fn value(&self, p: &[f64]) -> Option<f64> {
        Cost::value(self, p)
    }

    fn quadratic(&self, p: &[f64], with_matrix: bool) -> Option<Quadratic> {
        if with_matrix { Cost::quadratic(self, p) } else { self.with_gradient(p) }
    }

    fn hessian(&self, p: &[f64]) -> Option<DMatrix<f64>> {
        Cost::hessian(self, p)
    }

    /// One over the mean number of samples of a run.
    fn factor(&self) -> f64 {
        self.runs() as f64 / self.samples().max(1) as f64
    }

    /// All of it: residuals may vanish.
    fn reach(&self, value: f64) -> f64 {
        value.abs()
    }
}
