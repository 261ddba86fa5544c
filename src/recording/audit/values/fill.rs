//! Fill values: numbers such as -9999 or 9.97e36 that stand for a missing one and were read as measured.
//! Values that no ship reaches are refused where the file is read; here are those that a channel without limits lets through.

use crate::recording::audit::issue::{Issue, Severity};
use crate::recording::audit::limits::{FILL_APART, FILL_KINDS, FILL_ROWS};
use crate::recording::{Channel, Recording, STATE_CHANNELS, usual_fill};

/// Reports the fill values, and returns the recording without them, for the other checks; `None` where there are none.
pub fn fills(recording: &Recording, issues: &mut Vec<Issue>) -> Option<Recording> {
    let mut left: Option<Recording> = None;
    for (channel, values) in recording.channels().filter(|(c, _)| *c != Channel::T) {
        if recording.derived().contains(&channel) {
            continue;
        }
        let factor = channel.info().quantity.factor(recording.unit(channel)).unwrap_or(1.0);
        for rows in fill_rows(values, factor, STATE_CHANNELS.contains(&channel)) {
            let [first, last] = [rows[0], rows[rows.len() - 1]];
            let written = values[first] / factor;
            let number = if written.abs() < 1e7 { format!("{}", rounded(written)) } else { format!("{written:.6e}") };
            let count = if rows.len() == 1 { "one row".to_owned() } else { format!("{} rows", rows.len()) };
            let text = format!(
                "{number} {} in {count}, far from all other values: it stands for a missing one",
                recording.unit(channel)
            );
            let next = format!("`blank = {number}` for `{channel}` in a column map takes it for missing");
            let issue = Issue::new(Severity::Error, "fill_value", text, next).of(channel);
            issues.push(issue.at((recording.line(first), recording.line(last))));
            left = Some(left.as_ref().unwrap_or(recording).without(channel, &rows));
        }
    }
    left
}

/// A number without the last digits that a change of unit leaves.
fn rounded(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

/// The rows of each fill value, the farthest value first. A channel that is set to one of few values (`moves` is false) has no fill
/// value but the usual ones.
fn fill_rows(values: &[f64], factor: f64, moves: bool) -> Vec<Vec<usize>> {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let mut found = Vec::new();
    while found.len() < FILL_KINDS && sorted.len() > FILL_ROWS {
        let (low, high, middle) = (sorted[0], sorted[sorted.len() - 1], sorted[sorted.len() / 2]);
        let candidate = if high - middle > middle - low { high } else { low };
        let (from, to) = (sorted.partition_point(|v| *v < candidate), sorted.partition_point(|v| *v <= candidate));
        let mut rest = sorted.clone();
        rest.drain(from..to);
        let (Some(least), Some(most)) = (rest.first().copied(), rest.last().copied()) else { break };
        let apart = (candidate - most).max(least - candidate);
        let usual = usual_fill(candidate / factor);
        // Where all others have one value, a channel may have been switched on.
        let range = if most > least { most - least } else { most.abs() };
        let again = to - from >= FILL_ROWS && moves && range > 0.0;
        if apart <= FILL_APART * range || !(usual || again) {
            break;
        }
        found.push((0..values.len()).filter(|row| values[*row] == candidate).collect());
        sorted = rest;
    }
    found
}
