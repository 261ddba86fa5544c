//! Plateaus: stretches over which a channel keeps one value, with the sums of a regression inside and outside them.
//! It judges nothing; plateaus that are unlike the other runs are reported in `stuck`.

use super::series::{Series, constant};
use super::sums::Sums;
use crate::recording::audit::limits::STUCK_WINDOWS;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// A plateau: the regression at lag 0 inside and outside it, the constant among the columns.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plateau {
    /// First and last line, where the rows were read from a file.
    pub lines: Option<(usize, usize)>,
    /// How long it lasts \[s\].
    pub seconds: f64,
    /// The windows in it.
    pub inside: Part,
    /// The windows outside it.
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

    /// The same without the first `own` columns.
    pub fn left_without(&self, own: usize, coefficients: &[f64]) -> f64 {
        self.sums.left_without(own, coefficients) / self.windows
    }

    /// The constant that fits best together with the other coefficients.
    pub fn constant(&self, others: &[f64]) -> f64 {
        let n = others.len() + 1;
        let explained: f64 = others.iter().enumerate().map(|(i, c)| c * self.sums.columns[i * n + n - 1]).sum();
        (self.sums.response[n - 1] - explained) / self.sums.columns[n * n - 1]
    }
}

/// The plateaus of a channel, with [`STUCK_WINDOWS`] windows of some steps or more inside and outside them. `starts` are the first rows of
/// all windows, in order; `sums` are those of the windows that begin at some rows.
pub fn plateaus(
    series: &Series<'_>,
    values: &[f64],
    starts: &[usize],
    steps: usize,
    sums: impl Fn(&[usize]) -> Option<Sums>,
) -> Vec<Plateau> {
    let Some(all) = sums(starts) else { return Vec::new() };
    let of = |rows: &Range<usize>| {
        let from = |row: usize| starts.partition_point(|start| *start < row);
        let inside = &starts[from(rows.start)..from(rows.end - steps)];
        let touching = &starts[from(rows.start.saturating_sub(steps))..from(rows.end)];
        let windows = [inside.len(), starts.len() - touching.len()];
        if windows.iter().any(|count| *count < STUCK_WINDOWS) {
            return None;
        }
        // All less those that touch it: a long run has many plateaus.
        let mut beside = all.clone();
        beside.subtract(&sums(touching)?);
        let [inside, beside] = [(sums(inside)?, windows[0]), (beside, windows[1])]
            .map(|(sums, count)| Part { sums, windows: count as f64 });
        let seconds = series.t[rows.end - 1] - series.t[rows.start];
        Some(Plateau { lines: series.lines(rows), seconds, inside, beside })
    };
    let still = series.stretches.iter().flat_map(|s| constant(values, s.clone()));
    still.filter(|rows| rows.len() > steps).filter_map(|rows| of(&rows)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::{Channel, Recording};

    #[test]
    fn a_plateau_has_the_windows_in_it_and_those_that_it_does_not_touch() {
        let t: Vec<f64> = (0..200).map(f64::from).collect();
        let delta: Vec<f64> =
            (0..200).map(|i| if (60..120).contains(&i) { 0.5 } else { 0.001 * f64::from(i) }).collect();
        let columns = vec![(Channel::T, t), (Channel::R, vec![0.0; 200]), (Channel::Delta, delta.clone())];
        let recording = Recording::from_channels("run", columns).unwrap();
        let starts: Vec<usize> = (0..196).step_by(2).collect();
        // A regression on the constant alone, which answers the first row of a window.
        let sums = |starts: &[usize]| {
            let of = |power: i32| starts.iter().map(|s| (*s as f64).powi(power)).sum::<f64>();
            Some(Sums { columns: vec![of(0)], response: vec![of(1)], squares: of(2) })
        };
        let found = plateaus(&Series::from(&recording), &delta, &starts, 4, sums);
        assert_eq!(found.len(), 1);
        let (inside, beside): (Vec<usize>, Vec<usize>) = starts.iter().partition(|s| (60..116).contains(*s));
        let beside: Vec<usize> = beside.into_iter().filter(|s| s + 4 < 60 || *s >= 120).collect();
        for (part, starts) in [(&found[0].inside, inside), (&found[0].beside, beside)] {
            assert_eq!(part, &Part { sums: sums(&starts).unwrap(), windows: starts.len() as f64 });
        }
    }
}
