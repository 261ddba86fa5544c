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
    let (mut series, mut frozen_in) = (Vec::new(), Vec::new());
    for run in runs {
        let (one, mut own) = (Series::from(run), Vec::new());
        // What a frozen channel contradicts besides is no fault of its own.
        if frozen(&one, &mut own).is_empty() {
            series.push(one);
        }
        frozen_in.extend(own.into_iter().map(|i| Issue { text: format!("{}: {}", run.name, i.text), ..i }));
    }
    let mut issues = Vec::new();
    let responses: Vec<Responses> = series.iter().map(Responses::of).collect();
    agreement(series.iter().zip(&responses), &mut issues);
    issues.retain(Issue::blocking);
    issues.extend(frozen_in);
    issues
}
