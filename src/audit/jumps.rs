//! Jumps of single values: rows that lie far from their neighbours.
//! Jumps of a position that last are in `receiver`, since a run is parted there.

use super::issue::{Issue, Severity};
use super::series::Series;
use crate::recording::STATE_CHANNELS;

/// Half-width, in rows, of the running median outliers are measured from.
const MEDIAN_ROWS: usize = 3;

/// Single rows far from the median of their neighbours (Hampel's test, at ten times the usual scatter).
pub fn outliers(series: &Series<'_>, issues: &mut Vec<Issue>) {
    for channel in STATE_CHANNELS {
        let Some(values) = series.get(channel) else { continue };
        let far = far(values);
        let (Some(&first), Some(&last)) = (far.first(), far.last()) else { continue };
        let line = |row: usize| series.lines(&(row..row + 1)).map_or(row, |(line, _)| line);
        let lines: Vec<String> = far.iter().take(5).map(|&row| line(row).to_string()).collect();
        let more = if far.len() > 5 { ", ..." } else { "" };
        let text = match far.len() {
            1 => format!("one value stands far from its neighbours (line {})", lines[0]),
            n => format!("{n} values stand far from their neighbours (lines {}{more})", lines.join(", ")),
        };
        let next = "blank them, if they are no motion of the ship";
        issues.push(Issue::new(Severity::Warning, "outlier", text, next).of(channel).at((line(first), line(last))));
    }
}

/// The rows that lie far from their neighbours; none where they are so many that they are no single values.
fn far(values: &[f64]) -> Vec<usize> {
    let median = |v: &mut Vec<f64>| {
        v.sort_by(f64::total_cmp);
        v[v.len() / 2]
    };
    let finite: Vec<usize> = (0..values.len()).filter(|&i| values[i].is_finite()).collect();
    if finite.len() < 4 * MEDIAN_ROWS {
        return Vec::new();
    }
    let from_median: Vec<f64> = (0..finite.len())
        .map(|k| {
            let near = k.saturating_sub(MEDIAN_ROWS)..(k + MEDIAN_ROWS + 1).min(finite.len());
            (values[finite[k]] - median(&mut near.map(|j| values[finite[j]]).collect())).abs()
        })
        .collect();
    // The usual scatter; beside it a tenth of the range, since data without noise have none.
    let usual = 1.4826 * median(&mut from_median.clone());
    let mut sorted: Vec<f64> = finite.iter().map(|&i| values[i]).collect();
    sorted.sort_by(f64::total_cmp);
    let (low, high) = (sorted[sorted.len() / 50], sorted[sorted.len() - 1 - sorted.len() / 50]);
    // Ends are left out: there the median is one-sided.
    let inner = MEDIAN_ROWS..finite.len() - MEDIAN_ROWS;
    let far: Vec<usize> = inner.filter(|&k| from_median[k] > (10.0 * usual).max(0.1 * (high - low))).collect();
    if far.len() * 100 > finite.len() { Vec::new() } else { far.into_iter().map(|k| finite[k]).collect() }
}
