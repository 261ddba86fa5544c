//! Many trajectories under two models in a few numbers, each with its interval over recordings: an improvement, on which verdicts
//! turn, by Student's t, everything else from a bootstrap. It takes the outcomes alone, neither models nor recordings.

use super::compare::Comparison;
use super::cvdm::{Outcome, by_dimension};
use super::settings::EvaluationSettings;
use crate::ranks::Ranks;
use crate::recording::Split;
use crate::state::STATES;
use crate::statistics::{Bootstrap, interval_of_ratio, mean, median, variance};
use serde::Serialize;
use std::collections::BTreeMap;
use std::ops::Range;

/// One of the two outcomes of a comparison.
type Which = fn(&Comparison) -> &Outcome;

/// A number with its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// Its 95 % interval; absent with fewer than three runs, and of an improvement where one run has most of the error.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ci95: Option<[f64; 2]>,
}

/// A trajectory singled out.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Named {
    /// Run.
    pub run: String,
    /// Start of the window in the recording \[s\].
    pub start_time: f64,
    /// Its outcome under the fitted model.
    pub fitted: Outcome,
    /// And under the baseline.
    pub baseline: Outcome,
}

/// Two models compared over a group of trajectories. What cannot be computed (no trajectory, an exact baseline) is absent.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// The group, e.g. `test`, `manoeuvre: zigzag`.
    pub group: String,
    /// Runs in it.
    pub runs: usize,
    /// Trajectories (windows) in it.
    pub trajectories: usize,
    /// Trajectories on which the baseline diverged.
    pub diverged_baseline: usize,
    /// Trajectories on which the fitted model diverged.
    pub diverged_fitted: usize,
    /// Mean of MD of the baseline for x, y, psi, u, v, r.
    #[serde(serialize_with = "by_dimension")]
    pub md_baseline: [Option<Estimate>; STATES],
    /// Mean of MD of the fitted model.
    #[serde(serialize_with = "by_dimension")]
    pub md_fitted: [Option<Estimate>; STATES],
    /// Improvement of each mean MD \[-\].
    #[serde(serialize_with = "by_dimension")]
    pub md_improvement: [Option<Estimate>; STATES],
    /// Mean cVDM of the baseline \[%\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cvdm_baseline: Option<Estimate>,
    /// Mean cVDM of the fitted model \[%\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cvdm_fitted: Option<Estimate>,
    /// Mean cVDM of steady motion \[%\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cvdm_steady: Option<Estimate>,
    /// cVDM improvement \[-\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cvdm_improvement: Option<Estimate>,
    /// mARI \[-\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mari: Option<Estimate>,
    /// Consistency \[-\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub consistency: Option<Estimate>,
    /// Trajectories with a lower cVDM than the baseline's.
    pub better: usize,
    /// Trajectories with a higher one.
    pub worse: usize,
    /// Runs whose mean cVDM over their trajectories is lower than the baseline's.
    pub runs_better: usize,
    /// Runs whose mean cVDM is higher.
    pub runs_worse: usize,
    /// The trajectory with the highest cVDM of the fitted model.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub worst: Option<Named>,
    /// The trajectory that lost most on the baseline, if any did.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub most_worsened: Option<Named>,
}

/// Summaries by split, then by manoeuvre and by session of the test trajectories where there are several.
pub(super) fn summaries(ranks: &Ranks, trajectories: &[Comparison], settings: &EvaluationSettings) -> Vec<Summary> {
    let mut summaries = Vec::new();
    let mut add = |group: String, members: Vec<&Comparison>| {
        if !members.is_empty() {
            summaries.push(summarise_over(ranks, group, &members, settings));
        }
    };
    let of = |split: Split| trajectories.iter().filter(move |t| t.split == split);
    add("test".into(), of(Split::Test).collect());
    add("train".into(), of(Split::Train).collect());
    for kind in ["manoeuvre", "session"] {
        let key = |t: &Comparison| if kind == "session" { t.session.clone() } else { t.manoeuvre.clone() };
        let mut names: Vec<String> = of(Split::Test).map(key).collect();
        names.sort();
        names.dedup();
        // Where every run is a session of its own, sessions would only repeat the runs.
        let mut runs: Vec<&String> = of(Split::Test).map(|t| &t.run).collect();
        runs.sort();
        runs.dedup();
        if (2..runs.len().max(3)).contains(&names.len()) {
            for name in names {
                let members = of(Split::Test).filter(|t| key(t) == name).collect();
                add(format!("{kind}: {name}"), members);
            }
        }
    }
    summaries
}

/// Trajectories by run, in the order of the names of the runs.
fn by_run<'a>(members: &[&'a Comparison]) -> BTreeMap<&'a str, Vec<&'a Comparison>> {
    let mut runs: BTreeMap<&str, Vec<&Comparison>> = BTreeMap::new();
    for t in members {
        runs.entry(t.run.as_str()).or_default().push(t);
    }
    runs
}

/// Compares two models over a group of trajectories.
pub fn summarise(group: String, members: &[&Comparison], settings: &EvaluationSettings) -> Summary {
    summarise_over(Ranks::one(), group, members, settings)
}

/// As [`summarise`], with the draws of the bootstrap divided among the ranks.
fn summarise_over(ranks: &Ranks, group: String, members: &[&Comparison], settings: &EvaluationSettings) -> Summary {
    let runs = by_run(members);
    // Trajectories that both models run through, by run.
    let sound = |t: &&Comparison| t.baseline.deviation().is_some() && t.fitted.deviation().is_some();
    let clusters = runs.values().map(|of_run| of_run.iter().copied().filter(sound).collect::<Vec<_>>());
    let resampled = Resampled::new(ranks, clusters.filter(|c| !c.is_empty()).collect(), settings);
    let diverged = |f: Which| members.iter().filter(|t| f(t).deviation().is_none()).count();
    let lower = |a: f64, b: f64| usize::from(a < b);
    let mean_order =
        |of_run: &[&Comparison], f: Which| of_run.iter().map(|t| f(t).order()).sum::<f64>() / of_run.len() as f64;
    let (before, after): (Which, Which) = (|t| &t.baseline, |t| &t.fitted);
    let named = |t: &&Comparison| Named {
        run: t.run.clone(),
        start_time: t.start_time,
        fitted: t.fitted,
        baseline: t.baseline,
    };
    let loss = |t: &Comparison| t.fitted.order() / t.baseline.order();
    let lost = members.iter().filter(|t| t.fitted.order() > t.baseline.order());
    Summary {
        group,
        runs: runs.len(),
        trajectories: members.len(),
        diverged_baseline: diverged(before),
        diverged_fitted: diverged(after),
        md_baseline: std::array::from_fn(|i| resampled.estimate(|d| mean(d.column(BEFORE + i)))),
        md_fitted: std::array::from_fn(|i| resampled.estimate(|d| mean(d.column(AFTER + i)))),
        md_improvement: std::array::from_fn(|i| resampled.improvement(i)),
        cvdm_baseline: resampled.estimate(|d| mean(d.column(BEFORE + STATES))),
        cvdm_fitted: resampled.estimate(|d| mean(d.column(AFTER + STATES))),
        cvdm_steady: resampled.estimate(|d| mean(d.column(STEADY))),
        cvdm_improvement: resampled.improvement(STATES),
        mari: resampled.estimate(|d| median(d.column(RELATIVE))),
        consistency: resampled.estimate(|d| {
            let spread = |c: usize| variance(&d.column(c).collect::<Vec<_>>());
            gain(spread(BEFORE + STATES)?, spread(AFTER + STATES)?)
        }),
        better: members.iter().map(|t| lower(t.fitted.order(), t.baseline.order())).sum(),
        worse: members.iter().map(|t| lower(t.baseline.order(), t.fitted.order())).sum(),
        runs_better: runs.values().map(|r| lower(mean_order(r, after), mean_order(r, before))).sum(),
        runs_worse: runs.values().map(|r| lower(mean_order(r, before), mean_order(r, after))).sum(),
        worst: members.iter().max_by(|a, b| a.fitted.order().total_cmp(&b.fitted.order())).map(named),
        most_worsened: lost.max_by(|a, b| loss(a).total_cmp(&loss(b))).map(named),
    }
}

/// `1 - after/before`; `None` where there was nothing to gain.
fn gain(before: f64, after: f64) -> Option<f64> {
    (before > 0.0).then(|| 1.0 - after / before)
}

/// Columns of the numbers that are resampled: MD of every dimension and then cVDM of the baseline, the same of the fitted model,
/// the average relative improvement, and cVDM of steady motion.
const BEFORE: usize = 0;
const AFTER: usize = BEFORE + STATES + 1;
const RELATIVE: usize = AFTER + STATES + 1;
const STEADY: usize = RELATIVE + 1;

/// The numbers of trajectories by run, with draws of whole runs.
struct Resampled<'a> {
    /// Each number of every trajectory, run after run; NaN where there is none.
    columns: Vec<Vec<f64>>,
    /// Where the trajectories of each run are in a column.
    clusters: Vec<Range<usize>>,
    bootstrap: Bootstrap<'a>,
}

/// Some runs of them, one perhaps several times.
struct Drawn<'a> {
    columns: &'a [Vec<f64>],
    clusters: &'a [Range<usize>],
    /// The runs; all of them in order where absent.
    drawn: Option<&'a [usize]>,
}

impl Drawn<'_> {
    /// A number of their trajectories.
    fn column(&self, column: usize) -> impl Iterator<Item = f64> {
        let count = self.drawn.map_or(self.clusters.len(), <[usize]>::len);
        let cluster = |k: usize| self.drawn.map_or(k, |drawn| drawn[k]);
        (0..count).flat_map(move |k| &self.columns[column][self.clusters[cluster(k)].clone()]).copied()
    }
}

impl<'a> Resampled<'a> {
    fn new(ranks: &'a Ranks, runs: Vec<Vec<&Comparison>>, settings: &EvaluationSettings) -> Self {
        let bootstrap = Bootstrap::over(ranks, runs.len(), settings.resamples, settings.seed);
        let number = |t: &Comparison, column: usize| -> Option<f64> {
            let of = |outcome: &Outcome, i: usize| {
                let deviation = outcome.deviation()?;
                if i == STATES { Some(deviation.cvdm) } else { deviation.md[i] }
            };
            match column {
                STEADY => of(&t.steady, STATES),
                RELATIVE => t.average_relative_improvement(),
                AFTER.. => of(&t.fitted, column - AFTER),
                _ => of(&t.baseline, column - BEFORE),
            }
        };
        let column = |c: usize| runs.iter().flatten().map(|t| number(t, c).unwrap_or(f64::NAN)).collect();
        let mut end = 0;
        let place = |run: &Vec<&Comparison>| {
            end += run.len();
            end - run.len()..end
        };
        Self { columns: (0..=STEADY).map(column).collect(), clusters: runs.iter().map(place).collect(), bootstrap }
    }

    fn estimate(&self, statistic: impl Fn(&Drawn) -> Option<f64> + Sync) -> Option<Estimate> {
        let of =
            |drawn: Option<&[usize]>| statistic(&Drawn { columns: &self.columns, clusters: &self.clusters, drawn });
        let value = of(None).filter(|v| v.is_finite())?;
        Some(Estimate { value, ci95: self.bootstrap.interval(|drawn| of(Some(drawn))) })
    }

    /// The improvement of the mean of a number over the trajectories that have it under both models, `1 - after/before`, and its
    /// interval over the recordings, which ends at 1, an exact prediction.
    fn improvement(&self, number: usize) -> Option<Estimate> {
        let cluster = |range: &Range<usize>| {
            let pair = |t: usize| (self.columns[AFTER + number][t], self.columns[BEFORE + number][t]);
            let known = range.clone().map(pair).filter(|(after, before)| (after + before).is_finite());
            known.fold((0.0, 0.0), |sum, (after, before)| (sum.0 + after, sum.1 + before))
        };
        let clusters: Vec<(f64, f64)> = self.clusters.iter().map(cluster).filter(|c| c.1 > 0.0 || c.0 > 0.0).collect();
        let (after, before) = clusters.iter().fold((0.0, 0.0), |sum, c| (sum.0 + c.0, sum.1 + c.1));
        let value = gain(before, after).filter(|v| v.is_finite())?;
        Some(Estimate {
            value,
            ci95: interval_of_ratio(&clusters).map(|[low, high]| [1.0 - high, (1.0 - low).min(1.0)]),
        })
    }
}
