//! The small dense algebra of scores and information: parts of a matrix, and an inverse where directions carry no information.
//! It depends on no ship and no test.

use nalgebra::{DMatrix, SymmetricEigen};

/// Rows and columns of a matrix.
pub fn pick(m: &DMatrix<f64>, rows: &[usize], columns: &[usize]) -> DMatrix<f64> {
    DMatrix::from_fn(rows.len(), columns.len(), |i, j| m[(rows[i], columns[j])])
}

/// Inverse of a symmetric positive matrix, scaled to unit diagonal; directions without information get none.
pub fn pseudo_inverse(m: &DMatrix<f64>) -> DMatrix<f64> {
    let n = m.nrows();
    let unit: Vec<f64> = (0..n).map(|i| 1.0 / m[(i, i)].max(f64::MIN_POSITIVE).sqrt()).collect();
    let scaled = DMatrix::from_fn(n, n, |i, j| 0.5 * (m[(i, j)] + m[(j, i)]) * unit[i] * unit[j]);
    if let Some(c) = scaled.clone().cholesky() {
        let inverse = c.inverse();
        if inverse.iter().all(|v| v.is_finite()) && inverse.amax() < 1e10 {
            return DMatrix::from_fn(n, n, |i, j| inverse[(i, j)] * unit[i] * unit[j]);
        }
    }
    let eigen = SymmetricEigen::new(scaled);
    let mut inverse = DMatrix::zeros(n, n);
    for (l, v) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
        if *l > 1e-10 {
            inverse += v * v.transpose() / *l;
        }
    }
    DMatrix::from_fn(n, n, |i, j| inverse[(i, j)] * unit[i] * unit[j])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_and_columns_are_picked_in_the_order_asked() {
        let m = DMatrix::from_row_slice(2, 3, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        assert_eq!(pick(&m, &[1, 0], &[2]), DMatrix::from_row_slice(2, 1, &[6.0, 3.0]));
    }

    #[test]
    fn a_well_conditioned_matrix_has_its_inverse_in_any_units() {
        // [[4, 2], [2, 3]] with units 1e4 and 1e-3: the inverse is [[3, -2], [-2, 4]] / 8 in inverse units.
        let (a, b) = (1e4, 1e-3);
        let m = DMatrix::from_row_slice(2, 2, &[4.0 * a * a, 2.0 * a * b, 2.0 * a * b, 3.0 * b * b]);
        let inverse = pseudo_inverse(&m);
        for (i, j, expected) in [(0, 0, 0.375 / a / a), (0, 1, -0.25 / a / b), (1, 1, 0.5 / b / b)] {
            assert!((inverse[(i, j)] / expected - 1.0).abs() < 1e-12, "{inverse}");
        }
    }

    #[test]
    fn a_direction_without_information_gets_none() {
        // Two columns that are one: the inverse along their sum, nothing along their difference.
        let inverse = pseudo_inverse(&DMatrix::from_element(2, 2, 4.0));
        assert!(inverse.iter().all(|v| (v - 1.0 / 16.0).abs() < 1e-12), "{inverse}");
        assert_eq!(pseudo_inverse(&DMatrix::zeros(2, 2)).amax(), 0.0);
        assert_eq!(pseudo_inverse(&DMatrix::zeros(0, 0)).len(), 0);
    }
}
