//! The audit of runs before a fit and before a diagnosis: channels that contradict each other, and channels that stand still.
//! It applies the checks of a recording's audit to all runs together; how well a model fits the runs is examined elsewhere.

use super::issue::Issue;
use super::motion::series::Series;
use super::record::{Responses, agreement};
use super::values::frozen::frozen;
use crate::recording::Run;

/// Faults of runs that need no model to be found: units, signs and axes that contradict each other over all runs together, which block any
/// conclusion, and channels that are frozen in one.
pub fn audit_runs(runs: &[Run]) -> Vec<Issue> {
    let series: Vec<Series<'static>> = runs.iter().map(Series::from).collect();
    let mut issues = Vec::new();
    let responses: Vec<Responses> = series.iter().map(Responses::of).collect();
    agreement(series.iter().zip(&responses), &mut issues);
    issues.retain(Issue::blocking);
    for (run, series) in runs.iter().zip(&series) {
        let mut own = Vec::new();
        frozen(series, &mut own);
        issues.extend(own.into_iter().map(|i| Issue { text: format!("{}: {}", run.name, i.text), ..i }));
    }
    issues
}
