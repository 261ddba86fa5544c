//! Directions that active constraints leave free, and the inverse of a curvature within them.
//! It is about matrices alone: no model, no cost, no solver.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Directions whose curvature is below this share of the largest count as not determined at all.
const SINGULAR: f64 = 1e-13;

/// Columns that span the directions in which no active row changes. Rows are of length one; there may be none, or more than
/// variables.
pub(in crate::fit) fn null_space(active: &[DVector<f64>], n: usize) -> DMatrix<f64> {
    let mut normal = DMatrix::zeros(n, n);
    for row in active {
        normal += row * row.transpose();
    }
    let eigen = SymmetricEigen::new(normal);
    let free: Vec<usize> = (0..n).filter(|i| eigen.eigenvalues[*i] < 1e-10).collect();
    DMatrix::from_fn(n, free.len(), |i, j| eigen.eigenvectors[(i, free[j])])
}

/// A symmetric positive semidefinite matrix, inverted within a subspace as far as it can be.
pub(in crate::fit) struct Inverse {
    /// `Z V D^-1 V^T Z^T` over the directions that are determined.
    pub matrix: DMatrix<f64>,
    /// Directions (unit vectors) with their curvature, largest first.
    pub directions: Vec<(f64, DVector<f64>)>,
    /// How many of them are determined.
    pub rank: usize,
}

/// Inverts `h` within the span of `z`.
pub(in crate::fit) fn inverse(h: &DMatrix<f64>, z: &DMatrix<f64>) -> Inverse {
    let n = h.nrows();
    if z.ncols() == 0 {
        return Inverse { matrix: DMatrix::zeros(n, n), directions: Vec::new(), rank: 0 };
    }
    let reduced = z.transpose() * h * z;
    let eigen = SymmetricEigen::new((&reduced + reduced.transpose()) * 0.5);
    let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
    let directions: Vec<(f64, DVector<f64>)> =
        order.iter().map(|i| (eigen.eigenvalues[*i].max(0.0), z * eigen.eigenvectors.column(*i))).collect();
    let largest = directions.first().map_or(0.0, |d| d.0);
    let rank = directions.iter().filter(|d| d.0 > SINGULAR * largest).count();
    let mut matrix = DMatrix::zeros(n, n);
    for (curvature, direction) in &directions[..rank] {
        matrix += direction * direction.transpose() / *curvature;
    }
    Inverse { matrix, directions, rank }
}

impl Inverse {
    /// Whether a direction has a part that is not determined.
    pub fn loose(&self, direction: &DVector<f64>) -> bool {
        self.directions[self.rank..].iter().any(|(_, d)| d.dot(direction).abs() >= 1e-3)
    }

    /// Whether each variable is free of directions that are not determined.
    pub fn determined(&self) -> Vec<bool> {
        let n = self.matrix.nrows();
        let unit = |i: usize| DVector::from_fn(n, |j, _| f64::from(u8::from(i == j)));
        (0..n).map(|i| !self.loose(&unit(i))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vector(values: &[f64]) -> DVector<f64> {
        DVector::from_row_slice(values)
    }

    #[test]
    fn the_null_space_is_orthogonal_to_every_active_row() {
        let rows = [vector(&[1.0, 0.0, 0.0, 0.0]), vector(&[0.6, 0.8, 0.0, 0.0]), vector(&[0.8, 0.6, 0.0, 0.0])];
        let z = null_space(&rows, 4);
        assert_eq!(z.ncols(), 2);
        for row in &rows {
            assert!((row.transpose() * &z).norm() < 1e-12);
        }
        assert_eq!(null_space(&[], 3).ncols(), 3);
    }

    #[test]
    fn constraints_that_fix_every_variable_leave_no_variance() {
        let found = inverse(&DMatrix::identity(2, 2), &null_space(&[vector(&[1.0, 0.0]), vector(&[0.0, 1.0])], 2));
        assert_eq!((found.matrix, found.rank), (DMatrix::zeros(2, 2), 0));
    }

    #[test]
    fn an_active_constraint_takes_its_direction_out_of_the_covariance() {
        // Minimise over x + y = 1: only x - y is free, where H = diag(2, 6) has curvature (2 + 6)/2 along (1,-1)/sqrt(2).
        let h = DMatrix::from_diagonal(&vector(&[2.0, 6.0]));
        let z = null_space(&[vector(&[0.5f64.sqrt(), 0.5f64.sqrt()])], 2);
        let b = inverse(&h, &z).matrix;
        let expected = DMatrix::from_row_slice(2, 2, &[0.125, -0.125, -0.125, 0.125]);
        assert!((b - expected).norm() < 1e-12);
    }

    #[test]
    fn what_the_data_do_not_determine_is_distinguished_from_what_they_do() {
        // The data see 2 x + y and w alone.
        let h = DMatrix::from_row_slice(3, 3, &[4.0, 2.0, 0.0, 2.0, 1.0, 0.0, 0.0, 0.0, 5.0]);
        let inverse = inverse(&h, &DMatrix::identity(3, 3));
        assert_eq!(inverse.rank, 2);
        assert_eq!(inverse.determined(), [false, false, true]);
    }
}
