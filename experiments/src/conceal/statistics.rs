//! Shares and medians with their uncertainty, for the summary of a campaign.
//! It does not know what is counted.

use serde::Serialize;

/// A share of so many cases, with its Wilson score interval at 95 %.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Share {
    /// Cases counted.
    pub hits: usize,
    /// All cases.
    pub of: usize,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Share {
    /// Counts the true among the known cases; `None` without a known case.
    pub fn of(cases: impl IntoIterator<Item = Option<bool>>) -> Option<Self> {
        let known: Vec<bool> = cases.into_iter().flatten().collect();
        let hits = known.iter().filter(|b| **b).count();
        (!known.is_empty()).then(|| Self::new(hits, known.len()))
    }

    /// `hits` of `of` > 0 cases.
    pub fn new(hits: usize, of: usize) -> Self {
        let (n, p, z) = (of as f64, hits as f64 / of as f64, 1.959_964);
        let centre = p + z * z / (2.0 * n);
        let half = z * (p * (1.0 - p) / n + z * z / (4.0 * n * n)).sqrt();
        let whole = 1.0 + z * z / n;
        Self { hits, of, low: ((centre - half) / whole).max(0.0), high: ((centre + half) / whole).min(1.0) }
    }

    /// The share itself.
    pub fn value(&self) -> f64 {
        self.hits as f64 / self.of as f64
    }
}

impl std::fmt::Display for Share {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [p, a, b] = [self.value(), self.low, self.high].map(|v| 100.0 * v);
        write!(f, "{p:.0} % ({a:.0} to {b:.0}) of {}", self.of)
    }
}

/// Mean of the known values.
pub fn mean(values: impl IntoIterator<Item = Option<f64>>) -> Option<f64> {
    let known: Vec<f64> = values.into_iter().flatten().filter(|v| v.is_finite()).collect();
    (!known.is_empty()).then(|| known.iter().sum::<f64>() / known.len() as f64)
}

/// Median of the known values.
pub fn median(values: impl IntoIterator<Item = Option<f64>>) -> Option<f64> {
    let mut known: Vec<f64> = values.into_iter().flatten().filter(|v| v.is_finite()).collect();
    known.sort_by(f64::total_cmp);
    let n = known.len();
    match n {
        0 => None,
        _ if n % 2 == 1 => Some(known[n / 2]),
        _ => Some(0.5 * (known[n / 2 - 1] + known[n / 2])),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wilson_interval_is_the_published_one() {
        // Newcombe 1998, table I: 81 of 263, and 0 of 20.
        let s = Share::new(81, 263);
        assert!((s.low - 0.2553).abs() < 1e-4 && (s.high - 0.3662).abs() < 1e-4, "{s:?}");
        let s = Share::new(0, 20);
        assert!(s.low == 0.0 && (s.high - 0.1611).abs() < 1e-4, "{s:?}");
    }

    #[test]
    fn unknown_cases_are_not_counted() {
        let s = Share::of([Some(true), None, Some(false), None]).unwrap();
        assert_eq!((s.hits, s.of), (1, 2));
        assert!(Share::of([None]).is_none());
        assert_eq!(median([Some(3.0), None, Some(1.0)]), Some(2.0));
    }
}
