//! Sums of products of any two columns of derivatives over samples: the matrix behind Gauss-Newton steps and information.
//! It uses no weight and no residual: the values come weighted.

use super::local::Plain;
use crate::state::STATES;

/// How many samples are gathered before their products are added.
const SAMPLES: usize = 4;
/// Values of one column in the samples gathered.
const DEPTH: usize = SAMPLES * STATES;
/// Rows and columns of a tile: its sums, and one value of each row and column, fit the sixteen vector registers of AVX2.
const HIGH: usize = 4;
const WIDE: usize = 3;

/// A tile of the matrix.
type Tile<P> = [[P; WIDE]; HIGH];

/// Sums of products of any two columns, added a few samples at a time and tile by tile, so that a value that is loaded enters several
/// products and a sum is stored once for all samples gathered.
pub struct Products<P> {
    /// The values of each column in the samples gathered; columns of zeros fill up the last tiles.
    columns: Vec<[P; DEPTH]>,
    /// How many samples are gathered.
    gathered: usize,
    /// How many of the columns, the first ones, have had values: the others are zero.
    begun: usize,
    /// Tiles that touch the lower triangle: by rows, then columns.
    panels: Vec<Vec<Tile<P>>>,
}

impl<P: Plain> Products<P> {
    /// Sums over nothing, for `n` columns.
    pub fn new(n: usize) -> Self {
        let panels: Vec<Vec<Tile<P>>> = (0..n.div_ceil(HIGH))
            .map(|panel| vec![[[P::zero(); WIDE]; HIGH]; n.min((panel + 1) * HIGH).div_ceil(WIDE)])
            .collect();
        let filled = (n.div_ceil(HIGH) * HIGH).max(n.div_ceil(WIDE) * WIDE);
        Self { columns: vec![[P::zero(); DEPTH]; filled], gathered: 0, begun: n, panels }
    }

    /// Leaves the columns from `begun` on at zero until they begin too; none that had values may be among them.
    pub fn begin(&mut self, begun: usize) {
        self.begun = begun;
    }

    /// The values of a column in the sample that is being gathered.
    #[inline(always)]
    pub fn set(&mut self, column: usize, row: &[P; STATES]) {
        let from = self.gathered * STATES;
        self.columns[column][from..from + STATES].copy_from_slice(row);
    }

    /// The sample has the values of every column.
    #[inline(always)]
    pub fn next_sample(&mut self) {
        self.gathered += 1;
        if self.gathered == SAMPLES {
            self.multiply();
        }
    }

    /// Adds what is gathered when the last sample is in.
    pub fn finish(&mut self) {
        let from = self.gathered * STATES;
        self.columns.iter_mut().for_each(|column| column[from..].fill(P::zero()));
        self.multiply();
    }

    /// Sum of products of the columns `i` and `j <= i`.
    pub fn get(&self, i: usize, j: usize) -> P {
        self.panels[i / HIGH][j / WIDE][i % HIGH][j % WIDE]
    }

    /// Adds the products of the samples gathered.
    #[inline(always)]
    fn multiply(&mut self) {
        let begun = self.panels.iter_mut().take(self.begun.div_ceil(HIGH));
        for (panel, rows) in begun.zip(self.columns.chunks_exact(HIGH)) {
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
