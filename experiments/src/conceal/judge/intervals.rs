//! Comparisons of numbers and time windows with the truth: size of an effect, coverage of an interval, overlap in time.
//! It depends on no verdict and no mechanism.

use super::said::{Finding, FoundParameter, FoundWindow};
use crate::conceal::seal::Answer;

/// Standard errors that a 90 % interval reaches to either side.
const NINETY: f64 = 1.644_854;

/// The standard error behind a 95 % interval, as if normal.
fn standard_error([low, high]: [f64; 2]) -> f64 {
    (high - low) / (2.0 * 1.959_964)
}

/// Whether the 90 % interval behind a 95 % interval of a value contains the truth.
pub(crate) fn covers(value: f64, ci95: [f64; 2], truth: f64) -> bool {
    (value - truth).abs() <= NINETY * standard_error(ci95)
}

/// How far a size is from the truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SizeError {
    /// |found - true|/true.
    pub(crate) share: f64,
    /// (found - true) along the true direction, in standard errors; unknown where a parameter has no interval.
    pub(crate) errors: Option<f64>,
}

impl SizeError {
    /// Whether the 90 % interval contains the truth.
    pub(crate) fn covered(self) -> Option<bool> {
        self.errors.map(|e| e.abs() <= NINETY)
    }
}

/// How far the size of a finding is from the truth; `None` when not all parameters were reported.
pub(crate) fn size(answer: &Answer, finding: &Finding) -> Option<SizeError> {
    if answer.parameters.is_empty() {
        return None;
    }
    let mut pairs = Vec::new();
    for (name, truth, _) in &answer.parameters {
        let last = |p: &&FoundParameter| p.name.rsplit('.').next() == Some(name.as_str());
        pairs.push((*truth, finding.parameters.iter().find(last)?));
    }
    let length = |values: &mut dyn Iterator<Item = f64>| values.map(|v| v * v).sum::<f64>().sqrt();
    let truth = length(&mut pairs.iter().map(|p| p.0));
    if truth == 0.0 {
        return None;
    }
    // One component keeps its sign; of a vector the length is compared.
    let single = pairs.len() == 1;
    let found = if single { pairs[0].1.value } else { length(&mut pairs.iter().map(|p| p.1.value)) };
    let share = (found - if single { pairs[0].0 } else { truth }).abs() / truth;
    // Along the true direction, components taken as independent.
    let along: f64 = pairs.iter().map(|(t, p)| (p.value - t) * t / truth).sum();
    let mut variance = 0.0;
    for (t, p) in &pairs {
        let Some(ci95) = p.ci95 else { return Some(SizeError { share, errors: None }) };
        variance += (standard_error(ci95) * t / truth).powi(2);
    }
    let errors = (variance > 0.0).then(|| along / variance.sqrt());
    Some(SizeError { share, errors })
}

/// Time common to true and found windows over the time of their union, all runs together.
pub(crate) fn overlap(truth: &[(String, f64, f64)], found: &[&FoundWindow]) -> f64 {
    let mut runs: Vec<&str> = truth.iter().map(|w| w.0.as_str()).collect();
    runs.extend(found.iter().filter_map(|w| w.run()));
    runs.sort_unstable();
    runs.dedup();
    let (mut common, mut all) = (0.0, 0.0);
    for run in runs {
        let real: Vec<[f64; 2]> = truth.iter().filter(|w| w.0 == run).map(|w| [w.1, w.2]).collect();
        let said: Vec<[f64; 2]> = found.iter().filter(|w| w.run() == Some(run)).map(|w| [w.start, w.end]).collect();
        let mut edges: Vec<f64> = real.iter().chain(&said).flatten().copied().collect();
        edges.sort_by(f64::total_cmp);
        for pair in edges.windows(2) {
            let middle = 0.5 * (pair[0] + pair[1]);
            let within = |windows: &[[f64; 2]]| windows.iter().any(|w| w[0] <= middle && middle <= w[1]);
            let (a, b) = (within(&real), within(&said));
            let length = pair[1] - pair[0];
            common += if a && b { length } else { 0.0 };
            all += if a || b { length } else { 0.0 };
        }
    }
    if all > 0.0 { common / all } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_overlap_by_time_and_by_run() {
        let truth = [("r02".to_owned(), 100.0, 150.0)];
        let w = |run: &str, start, end| FoundWindow { run: Some(run.into()), start, end };
        let iou = |found: &[FoundWindow]| overlap(&truth, &found.iter().collect::<Vec<_>>());
        assert_eq!(iou(&[w("r02", 100.0, 150.0)]), 1.0);
        assert_eq!(iou(&[w("r02 0 s", 125.0, 175.0)]), 25.0 / 75.0);
        assert_eq!(iou(&[w("r03", 100.0, 150.0)]), 0.0);
        assert_eq!(iou(&[w("r02", 100.0, 150.0), w("r05", 0.0, 50.0)]), 0.5);
        assert_eq!(iou(&[]), 0.0);
    }
}
