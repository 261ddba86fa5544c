//! What runs add to the cost and its derivatives: sums of squares, of gradients and of the products behind the Gauss-Newton matrix.
//! It uses no run, weight or model: it is given weighted residuals and their derivatives, sample by sample.

use crate::sensitivity::{Plain, Products};
use crate::state::STATES;
use trimtab_ad::Scalar;

/// Sums of `e^2`, `e de/dp_j` and `de/dp_i de/dp_j`, lane by lane.
pub(in crate::fit) struct Sums<P> {
    /// Sum of squares.
    pub(in crate::fit) square: P,
    /// Sum of `e de/dp_j` by column.
    pub(in crate::fit) gradient: Vec<P>,
    products: Option<Products<P>>,
}

impl<P: Plain> Sums<P> {
    /// Sums over nothing, for `n` columns.
    pub(in crate::fit) fn new(n: usize, with_matrix: bool) -> Self {
        Self { square: P::zero(), gradient: vec![P::zero(); n], products: with_matrix.then(|| Products::new(n)) }
    }

    /// Adds the residuals of one sample and their derivatives by column.
    #[inline(always)]
    pub(in crate::fit) fn add(&mut self, residuals: &[P; STATES], rows: impl Iterator<Item = [P; STATES]>) {
        for r in residuals {
            self.square = r.mul_add(*r, self.square);
        }
        match &mut self.products {
            None => {
                for (g, row) in self.gradient.iter_mut().zip(rows) {
                    *g = dot(residuals, &row, *g);
                }
            }
            Some(products) => {
                for (c, (g, row)) in self.gradient.iter_mut().zip(rows).enumerate() {
                    *g = dot(residuals, &row, *g);
                    products.set(c, &row);
                }
                products.next_sample();
            }
        }
    }

    /// The sums when the last sample is in.
    pub(in crate::fit) fn finished(mut self) -> Self {
        if let Some(products) = &mut self.products {
            products.finish();
        }
        self
    }

    /// Sum of `de/dp_i de/dp_j` where `j <= i`; 0 without matrix.
    pub(in crate::fit) fn product(&self, i: usize, j: usize) -> P {
        self.products.as_ref().map_or_else(P::zero, |p| p.get(i, j))
    }
}

/// `sum + a . b`.
#[inline(always)]
fn dot<P: Scalar>(a: &[P; STATES], b: &[P; STATES], sum: P) -> P {
    a.iter().zip(b).fold(sum, |sum, (a, b)| a.mul_add(*b, sum))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::Lanes;

    /// Residuals and derivatives of a sample.
    fn sample(k: usize, n: usize, lane: usize) -> ([f64; STATES], Vec<[f64; STATES]>) {
        let value = |i: usize, c: usize| (1.0 + (3 * k + 7 * i + 11 * c + 5 * lane) as f64).sin();
        (std::array::from_fn(|c| value(n, c)), (0..n).map(|i| std::array::from_fn(|c| value(i, c))).collect())
    }

    #[test]
    fn sums_of_products_are_those_entry_by_entry_whatever_the_number_of_columns_and_samples() {
        for (n, samples) in [(0, 3), (1, 1), (3, 4), (5, 9), (11, 6), (12, 8), (25, 3)] {
            let mut sums = Sums::<Lanes>::new(n, true);
            let mut gradient_alone = Sums::<Lanes>::new(n, false);
            for k in 0..samples {
                let lanes: Vec<_> = (0..Lanes::LANES).map(|lane| sample(k, n, lane)).collect();
                let residuals = std::array::from_fn(|c| Lanes::from_fn(|lane| lanes[lane].0[c]));
                let rows = || (0..n).map(|i| std::array::from_fn(|c| Lanes::from_fn(|lane| lanes[lane].1[i][c])));
                sums.add(&residuals, rows());
                gradient_alone.add(&residuals, rows());
            }
            let (sums, gradient_alone) = (sums.finished(), gradient_alone.finished());
            assert_eq!(sums.gradient, gradient_alone.gradient);
            assert_eq!(sums.square, gradient_alone.square);
            for lane in 0..Lanes::LANES {
                let all: Vec<_> = (0..samples).map(|k| sample(k, n, lane)).collect();
                let near = |a: Lanes, b: f64| assert!((a.lane(lane) - b).abs() < 1e-12, "{n} columns: {a:?} {b}");
                let dot = |a: &[f64; STATES], b: &[f64; STATES]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
                near(sums.square, all.iter().map(|(e, _)| dot(e, e)).sum());
                for i in 0..n {
                    near(sums.gradient[i], all.iter().map(|(e, rows)| dot(e, &rows[i])).sum());
                    for j in 0..=i {
                        near(sums.product(i, j), all.iter().map(|(_, rows)| dot(&rows[i], &rows[j])).sum());
                    }
                }
            }
        }
    }
}
