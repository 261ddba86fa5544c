//! What runs add to the cost and its derivatives: sums of squares, of gradients and of the products behind the Gauss-Newton matrix.
//! It knows no run, weight or model: it is given weighted residuals and their derivatives, sample by sample.

use crate::sensitivity::Plain;
use crate::state::STATES;
use trimtab_ad::Scalar;

/// How many samples are gathered before their products are added.
const SAMPLES: usize = 4;
/// Values of one column in the samples gathered.
const DEPTH: usize = SAMPLES * STATES;
/// Rows and columns of a tile: its sums, and one value of each row and column, fit the sixteen vector registers of AVX2.
const HIGH: usize = 4;
const WIDE: usize = 3;

/// Sums of `e^2`, `e de/dp_j` and `de/dp_i de/dp_j`, lane by lane.
pub(super) struct Sums<P> {
    /// Sum of squares.
    pub(super) square: P,
    /// Sum of `e de/dp_j` by column.
    pub(super) gradient: Vec<P>,
    products: Option<Products<P>>,
}

impl<P: Plain> Sums<P> {
    /// Sums over nothing, for `n` columns.
    pub(super) fn new(n: usize, with_matrix: bool) -> Self {
        Self { square: P::zero(), gradient: vec![P::zero(); n], products: with_matrix.then(|| Products::new(n)) }
    }

    /// Adds the residuals of one sample and their derivatives by column.
    #[inline(always)]
    pub(super) fn add(&mut self, residuals: &[P; STATES], rows: impl Iterator<Item = [P; STATES]>) {
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
                let from = products.gathered * STATES;
                for ((g, column), row) in self.gradient.iter_mut().zip(&mut products.columns).zip(rows) {
                    *g = dot(residuals, &row, *g);
                    column[from..from + STATES].copy_from_slice(&row);
                }
                products.gathered += 1;
                if products.gathered == SAMPLES {
                    products.multiply();
                }
            }
        }
    }

    /// The sums when the last sample is in.
    pub(super) fn finished(mut self) -> Self {
        if let Some(products) = &mut self.products {
            let from = products.gathered * STATES;
            products.columns.iter_mut().for_each(|column| column[from..].fill(P::zero()));
            products.multiply();
        }
        self
    }

    /// Sum of `de/dp_i de/dp_j` where `j <= i`; 0 without matrix.
    pub(super) fn product(&self, i: usize, j: usize) -> P {
        self.products.as_ref().map_or_else(P::zero, |p| p.panels[i / HIGH][j / WIDE][i % HIGH][j % WIDE])
    }
}

/// `sum + a . b`.
#[inline(always)]
fn dot<P: Scalar>(a: &[P; STATES], b: &[P; STATES], sum: P) -> P {
    a.iter().zip(b).fold(sum, |sum, (a, b)| a.mul_add(*b, sum))
}

/// A tile of the matrix.
type Tile<P> = [[P; WIDE]; HIGH];

/// Sums of products of any two columns, added a few samples at a time and tile by tile, so that a value that is loaded enters several
/// products and a sum is stored once for all samples gathered.
struct Products<P> {
    /// The values of each column in the samples gathered; columns of zeros fill up the last tiles.
    columns: Vec<[P; DEPTH]>,
    /// How many samples are gathered.
    gathered: usize,
    /// Tiles that touch the lower triangle: by rows, then columns.
    panels: Vec<Vec<Tile<P>>>,
}

impl<P: Plain> Products<P> {
    fn new(n: usize) -> Self {
        let panels: Vec<Vec<Tile<P>>> = (0..n.div_ceil(HIGH))
            .map(|panel| vec![[[P::zero(); WIDE]; HIGH]; n.min((panel + 1) * HIGH).div_ceil(WIDE)])
            .collect();
        let filled = (n.div_ceil(HIGH) * HIGH).max(n.div_ceil(WIDE) * WIDE);
        Self { columns: vec![[P::zero(); DEPTH]; filled], gathered: 0, panels }
    }

    /// Adds the products of the samples gathered.
    #[inline(always)]
    fn multiply(&mut self) {
        for (panel, rows) in self.panels.iter_mut().zip(self.columns.chunks_exact(HIGH)) {
            let Some(rows) = rows.first_chunk::<HIGH>() else { continue };
            for (tile, columns) in panel.iter_mut().zip(self.columns.chunks_exact(WIDE)) {
                let Some(columns) = columns.first_chunk::<WIDE>() else { continue };
                multiply(rows, columns, tile);
            }
        }
        self.gathered = 0;
    }
}

/// Adds the products of a tile's rows and columns.
#[inline(always)]
fn multiply<P: Plain>(rows: &[[P; DEPTH]; HIGH], columns: &[[P; DEPTH]; WIDE], tile: &mut Tile<P>) {
    let mut sums = *tile;
    for k in 0..DEPTH {
        for i in 0..HIGH {
            for j in 0..WIDE {
                sums[i][j] = rows[i][k].mul_add(columns[j][k], sums[i][j]);
            }
        }
    }
    *tile = sums;
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
