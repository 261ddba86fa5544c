//! The run that a model predicts far worse than all others: what sums up the runs then depends on it.
//! It asks how far apart the runs are; why one is, a damaged recording or what the model lacks, is for who reads it.

use super::cvdm::Outcome;
use crate::numerals::sig;
use crate::statistics::{mean, outlier_p};
use serde::Serialize;
use std::collections::HashMap;

/// Largest chance that the worst of runs which scatter alike is as far from the others.
const CHANCE: f64 = 0.01;

/// A deviation below this is how a recording is rounded \[%\].
const ROUNDING: f64 = 1e-3;

/// A run that is predicted far worse than the others.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outlying {
    /// Its name.
    pub run: String,
    /// Its cVDM, the mean over its windows \[%\].
    pub cvdm: f64,
    /// Least and largest cVDM of the other runs \[%\].
    pub others: [f64; 2],
    /// Grubbs's test of the logarithm of cVDM, over the runs, one-sided \[-\].
    pub p: f64,
}

/// That run, by the windows of all runs, each with the name of its run; `None` where no run stands apart. A window in which the
/// simulation diverged is reported by itself, and does not count.
pub fn outlying<'n>(windows: impl IntoIterator<Item = (&'n str, &'n Outcome)>) -> Option<Outlying> {
    let mut places: HashMap<&str, usize> = HashMap::new();
    let mut runs: Vec<(&str, Vec<f64>)> = Vec::new();
    for (run, outcome) in windows {
        let Some(deviation) = outcome.deviation() else { continue };
        let place = *places.entry(run).or_insert(runs.len());
        if place == runs.len() {
            runs.push((run, Vec::new()));
        }
        runs[place].1.push(deviation.cvdm);
    }
    let mut cvdm: Vec<(&str, f64)> =
        runs.iter().filter_map(|(run, all)| Some((*run, mean(all.iter().copied())?.max(ROUNDING)))).collect();
    let p = outlier_p(&cvdm.iter().map(|(_, c)| c.ln()).collect::<Vec<_>>());
    cvdm.sort_by(|a, b| a.1.total_cmp(&b.1));
    let ((run, worst), others) = cvdm.split_last()?;
    let ends = [others.first()?.1, others.last()?.1];
    (p < CHANCE).then(|| Outlying { run: (*run).to_owned(), cvdm: *worst, others: ends, p })
}

impl Outlying {
    /// It as a line of text.
    pub fn line(&self) -> String {
        let [least, most] = self.others.map(|c| sig(c, 3));
        format!(
            "warning: `{}` is predicted far worse than all other runs (cVDM {} %, the others {least} to {most} %; p = {}, Grubbs's test): \
             is its recording damaged, or does the model lack what acts in it? Means over the runs hang on it.\n",
            self.run,
            sig(self.cvdm, 3),
            sig(self.p, 1)
        )
    }
}

#[cfg(test)]
mod tests {
    use super::super::cvdm::Deviation;
    use super::*;

    fn found(cvdm: &[f64]) -> Option<Outlying> {
        let names: Vec<String> = (0..cvdm.len()).map(|i| format!("r{i}")).collect();
        let outcomes: Vec<Outcome> =
            cvdm.iter().map(|c| Outcome::Simulated(Deviation { md: [None; 6], cvdm: *c })).collect();
        outlying(names.iter().map(String::as_str).zip(&outcomes))
    }

    #[test]
    fn a_run_that_is_predicted_far_worse_is_reported_with_the_range_of_the_others() {
        let found = found(&[3.6, 6.4, 8.6, 4.4, 61.0, 2.6, 5.1, 7.7]).unwrap();
        assert_eq!((found.run.as_str(), found.cvdm, found.others), ("r4", 61.0, [2.6, 8.6]));
        assert!(found.line().contains("warning: `r4`") && found.line().contains("2.6"), "{}", found.line());
    }

    #[test]
    fn runs_that_scatter_alike_few_runs_and_exact_ones_have_no_outlier() {
        assert_eq!(found(&[3.6, 6.4, 8.6, 4.4, 14.0, 2.6, 5.1, 7.7]), None);
        assert_eq!(found(&[49.0, 6.5, 79.0, 44.0, 24.0, 10.0, 10.4, 89.0]), None);
        assert_eq!(found(&[1.0, 90.0]), None);
        assert_eq!(found(&[1e-12, 1e-11, 3e-9, 1e-13]), None);
        assert_eq!(found(&[]), None);
    }

    #[test]
    fn the_windows_of_one_run_are_one_run_and_a_diverged_one_is_none() {
        let sound = |cvdm: f64| Outcome::Simulated(Deviation { md: [None; 6], cvdm });
        let lost = Outcome::Diverged { diverged_after: 3.0 };
        let (a, b) = (sound(5.0), sound(90.0));
        let apart = [("a", &a), ("b", &b), ("b", &b), ("b", &b), ("c", &a), ("d", &lost), ("b", &b)];
        // Of three runs none can stand apart by this test unless the other two are alike.
        assert_eq!(outlying(apart).map(|o| o.run), Some("b".to_owned()));
        assert_eq!(outlying([("a", &a), ("d", &lost), ("b", &b)]), None);
    }
}
