//! Sums of regressions, so that those of several runs can be added and the coefficients of one compared with another.
//! Which columns explain which motion is decided in `response`.

use nalgebra::{SMatrix, SVector};
use serde::{Deserialize, Serialize};

/// Sums of a regression: of products of columns, of columns with the response, and of its squares.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sums {
    /// Row by row, without the constant.
    pub columns: Vec<f64>,
    /// With the response.
    pub response: Vec<f64>,
    /// Of the response.
    pub squares: f64,
}

impl Sums {
    /// Adds those of another run.
    pub fn add(&mut self, other: &Self) {
        self.columns.iter_mut().zip(&other.columns).for_each(|(s, o)| *s += o);
        self.response.iter_mut().zip(&other.response).for_each(|(s, o)| *s += o);
        self.squares += other.squares;
    }

    /// Takes out those of some of its windows.
    pub fn subtract(&mut self, other: &Self) {
        self.columns.iter_mut().zip(&other.columns).for_each(|(s, o)| *s -= o);
        self.response.iter_mut().zip(&other.response).for_each(|(s, o)| *s -= o);
        self.squares -= other.squares;
    }

    /// Squares that coefficients leave without the first `own` columns.
    pub fn left_without(&self, own: usize, coefficients: &[f64]) -> f64 {
        let mut rest = coefficients.to_vec();
        rest[..own].fill(0.0);
        self.left(&rest)
    }

    /// Squares that coefficients of other runs leave.
    pub fn left(&self, coefficients: &[f64]) -> f64 {
        let n = coefficients.len();
        let linear: f64 = coefficients.iter().zip(&self.response).map(|(c, b)| c * b).sum();
        let of = |i: usize| -> f64 { (0..n).map(|j| self.columns[i * n + j] * coefficients[j]).sum() };
        let square: f64 = (0..n).map(|i| coefficients[i] * of(i)).sum();
        self.squares - 2.0 * linear + square
    }
}

/// Sums of a regression on `N` columns.
pub struct Gathered<const N: usize> {
    /// Of products of columns.
    pub a: SMatrix<f64, N, N>,
    /// Of columns with the response.
    pub b: SVector<f64, N>,
    /// Of the squares of the response.
    pub squares: f64,
    /// Of the columns.
    pub sums: SVector<f64, N>,
    /// Equations.
    pub count: f64,
}

impl<const N: usize> Gathered<N> {
    /// Those of the windows that begin at some rows. `None` where nothing moves.
    pub fn new<const E: usize>(
        starts: &[usize],
        lag: isize,
        equations: &impl Fn(usize, isize) -> [([f64; N], f64); E],
    ) -> Option<Self> {
        let (a, b) = (SMatrix::zeros(), SVector::zeros());
        let mut of = Self { a, b, squares: 0.0, sums: SVector::zeros(), count: 0.0 };
        for &start in starts {
            for (columns, y) in equations(start, lag) {
                let columns = SVector::from(columns);
                of.a += columns * columns.transpose();
                of.b += columns * y;
                of.sums += columns;
                of.squares += y * y;
                of.count += 1.0;
            }
        }
        (of.squares > 0.0 && of.squares.is_finite()).then_some(of)
    }

    /// All of them, the constant among the columns.
    pub fn whole(&self) -> Sums {
        let columns = self.a.transpose().as_slice().to_vec();
        Sums { columns, response: self.b.as_slice().to_vec(), squares: self.squares }
    }

    /// Those without the last column, the constant, and what it explains.
    pub fn centred(&self) -> Sums {
        let Self { a, b, squares, .. } = self;
        let constant = N - 1;
        let own = a[(constant, constant)];
        let share = |i: usize| if own > 0.0 { a[(i, constant)] / own } else { 0.0 };
        let columns = (0..constant).flat_map(|i| (0..constant).map(move |j| a[(i, j)] - share(i) * a[(constant, j)]));
        Sums {
            columns: columns.collect(),
            response: (0..constant).map(|i| b[i] - share(i) * b[constant]).collect(),
            squares: squares - if own > 0.0 { b[constant] * b[constant] / own } else { 0.0 },
        }
    }
}
