//! Plateaus: stretches over which a channel holds one value, with the sums of a regression inside them and beside them.
//! It judges nothing; what is unlike the other runs is told in `stuck`.

use super::limits::STUCK_WINDOWS;
use super::series::{Series, constant};
use super::sums::Sums;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// A plateau: the regression at lag 0 inside it and beside it, the constant among the columns.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plateau {
    /// First and last line, where the rows were read from a file.
    pub lines: Option<(usize, usize)>,
    /// How long it lasts \[s\].
    pub seconds: f64,
    /// The windows in it.
    pub inside: Part,
    /// Those beside it.
    pub beside: Part,
}

/// Sums over some windows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Part {
    sums: Sums,
    windows: f64,
}

impl Part {
    /// Mean square that coefficients leave, the last one that of the constant.
    pub fn left(&self, coefficients: &[f64]) -> f64 {
        self.sums.left(coefficients) / self.windows
    }

    /// The constant that fits best beside the other coefficients.
    pub fn constant(&self, others: &[f64]) -> f64 {
        let n = others.len() + 1;
        let explained: f64 = others.iter().enumerate().map(|(i, c)| c * self.sums.columns[i * n + n - 1]).sum();
        (self.sums.response[n - 1] - explained) / self.sums.columns[n * n - 1]
    }
}

/// The plateaus of a channel, with [`STUCK_WINDOWS`] windows of some steps or more in them and beside them.
/// `sums` are those of the windows that begin at some rows.
pub fn plateaus(
    series: &Series<'_>,
    values: &[f64],
    starts: &[usize],
    steps: usize,
    sums: impl Fn(&[usize]) -> Option<Sums>,
) -> Vec<Plateau> {
    let of = |rows: &Range<usize>| {
        let (inside, others): (Vec<usize>, Vec<usize>) =
            starts.iter().partition(|start| **start >= rows.start && **start + steps < rows.end);
        let beside: Vec<usize> = others.into_iter().filter(|s| s + steps < rows.start || *s >= rows.end).collect();
        let part = |starts: &[usize]| {
            let enough = starts.len() >= STUCK_WINDOWS;
            enough.then(|| Some(Part { sums: sums(starts)?, windows: starts.len() as f64 })).flatten()
        };
        let seconds = series.t[rows.end - 1] - series.t[rows.start];
        Some(Plateau { lines: series.lines(rows), seconds, inside: part(&inside)?, beside: part(&beside)? })
    };
    let all = series.stretches.iter().flat_map(|s| constant(values, s.clone()));
    all.filter(|rows| rows.len() > steps).filter_map(|rows| of(&rows)).collect()
}
