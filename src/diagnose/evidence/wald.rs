//! Wald's test: how far estimated parameters are from zero, in units of their covariance.
//! It takes estimate and covariance as they are; whether a parameter is worth naming is decided elsewhere.

use crate::likelihood::algebra::{pick, pseudo_inverse};
use crate::likelihood::estimate::{Estimate, FreeParameter};
use crate::recording::Run;
use crate::simulate::Integration;
use nalgebra::{DMatrix, DVector};

/// Values of some free parameters of an estimate, with their covariance, in units of their columns.
pub struct Wald {
    /// Values.
    pub value: DVector<f64>,
    /// Their covariance.
    pub covariance: DMatrix<f64>,
}

impl Wald {
    /// All free parameters of an estimate, with the inverse of the information at it.
    pub fn at(found: &Estimate, integration: Integration, runs: &[Run]) -> Self {
        Self::of(found, pseudo_inverse(&found.information(integration, runs)))
    }

    /// All free parameters of an estimate, with a given covariance.
    pub fn of(found: &Estimate, covariance: DMatrix<f64>) -> Self {
        let value = |f: &FreeParameter| f.value(&found.model) / f.column.scale;
        Self { value: DVector::from_iterator(found.free.len(), found.free.iter().map(value)), covariance }
    }

    /// Squared distance from zero in units of the covariance; 0 where the covariance is singular.
    pub fn statistic(&self) -> f64 {
        let inverse = self.covariance.clone().try_inverse();
        inverse.map_or(0.0, |inverse| (self.value.transpose() * inverse * &self.value)[(0, 0)])
    }

    /// Some of the parameters, the others unknown.
    pub fn part(&self, of: &[usize]) -> Self {
        Self { value: DVector::from_fn(of.len(), |i, _| self.value[of[i]]), covariance: pick(&self.covariance, of, of) }
    }

    /// How far they are from other values than zero.
    pub fn less(self, values: &DVector<f64>) -> Self {
        Self { value: self.value - values, ..self }
    }

    /// Some of the parameters, with others fixed at their estimates: their covariance is conditional on these.
    pub fn given(&self, of: &[usize], held: &[usize]) -> Self {
        let mut part = self.part(of);
        if let Some(inverse) = pick(&self.covariance, held, held).try_inverse() {
            let cross = pick(&self.covariance, of, held);
            part.covariance -= &cross * inverse * cross.transpose();
        }
        part
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pair() -> Wald {
        Wald {
            value: DVector::from_column_slice(&[3.0, 1.0]),
            covariance: DMatrix::from_row_slice(2, 2, &[2.0, 1.0, 1.0, 1.0]),
        }
    }

    #[test]
    fn the_statistic_is_the_squared_distance_in_units_of_the_covariance() {
        // The inverse of [[2, 1], [1, 1]] is [[1, -1], [-1, 2]]: 9 - 6 + 2 = 5.
        assert!((pair().statistic() - 5.0).abs() < 1e-12);
        assert!((pair().part(&[0]).statistic() - 4.5).abs() < 1e-12);
    }

    #[test]
    fn holding_a_parameter_leaves_the_conditional_variance_of_the_other() {
        // 2 - 1 * 1 / 1.
        let given = pair().given(&[0], &[1]);
        assert!((given.covariance[(0, 0)] - 1.0).abs() < 1e-12 && (given.statistic() - 9.0).abs() < 1e-12);
        assert_eq!(pair().given(&[0], &[]).covariance[(0, 0)], 2.0);
    }

    #[test]
    fn a_singular_covariance_says_nothing() {
        let w = Wald { covariance: DMatrix::zeros(2, 2), ..pair() };
        assert_eq!(w.statistic(), 0.0);
    }
}
