//! How well models predict recordings: mean deviations, cVDM, and what a fitted model gains on a baseline, with intervals.
//! It compares trajectories and fits nothing; which windows are held out is the study's.
//!
//! # Definitions
//! Source: Papandreou et al. 2025 (arXiv 2502.18696). For a window of K steps, with differences d between simulated and
//! measured state at the samples k = 1..K after the initial one (heading differences wrapped into (-pi, pi]):
//!
//! - Mean deviation of each dimension: `MD = (1/K) sum_k |d|` \[unit of the dimension\].
//! - `cVDM = (100/K) sum_k ( |dx|/L + |dy|/L + |dpsi|/pi + |du|/U + |dv|/U + |dr|/r_max )` \[%\] with the length L of the
//!   measured path, the mean measured speed U and a reference yaw rate r_max, as in the cost of a fit. Values that were not
//!   measured are left out, K of each channel being the samples that were; a channel never measured is left out of the means below.
//! - Relative improvement of a dimension over the baseline (marked ~): `(MD~ - MD*)/MD~`; its mean over the dimensions is
//!   the trajectory's average relative improvement, and `mARI` is the median of that over the trajectories. The paper's
//!   wording ("median of the average relative improvement") would also allow the mean over the dimensions of each
//!   dimension's median; we take it as said here.
//! - cVDM improvement: `(mean cVDM~ - mean cVDM*)/mean cVDM~` over the trajectories.
//! - Consistency: `1 - Var(cVDM*)/Var(cVDM~)` over the trajectories.
//!
//! Intervals are 95 % percentile intervals of a bootstrap that draws whole runs: windows of one run share what is unknown.
//!
//! A simulation that diverges has no deviation. It is counted, counts as worse than any that does not, and the other numbers
//! are of the trajectories that neither model diverges on.

use crate::fit::cost::weights;
use crate::model::Model;
use crate::recording::{Run, Split};
use crate::ship::Ship;
use crate::simulate::{Integration, Scenario, Trajectory, reported};
use crate::state::{STATE_NAMES, STATES};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use trimtab_ad::smooth::wrap_angle;

/// Settings of an evaluation, the section `[evaluate]` of a study.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct EvaluationSettings {
    /// Model file of the baseline, relative to the study.
    pub baseline: Option<PathBuf>,
    /// Bootstrap resamples behind the intervals.
    pub resamples: usize,
    /// Seed of the bootstrap.
    pub seed: u64,
}

impl Default for EvaluationSettings {
    fn default() -> Self {
        Self { baseline: None, resamples: 2000, seed: 1 }
    }
}

/// How far a simulated trajectory is from the measured one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Deviation {
    /// Mean deviation of x, y, psi, u, v, r (m, m, rad, m/s, m/s, rad/s); absent where not measured.
    #[serde(serialize_with = "by_dimension")]
    pub md: [Option<f64>; STATES],
    /// cVDM \[%\].
    pub cvdm: f64,
}

/// A value for each dimension as a map by name, without the absent ones.
fn by_dimension<T: Serialize, S: serde::Serializer>(
    values: &[Option<T>; STATES],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_map(STATE_NAMES.iter().zip(values).filter_map(|(name, value)| Some((name, value.as_ref()?))))
}

/// What a model makes of a window.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case", untagged)]
pub enum Outcome {
    /// The simulation ran through.
    Simulated(Deviation),
    /// The simulation diverged.
    Diverged {
        /// Time since the start of the window \[s\].
        diverged_after: f64,
    },
}

impl Outcome {
    /// The deviation, of a simulation that ran through.
    pub fn deviation(&self) -> Option<&Deviation> {
        match self {
            Self::Simulated(deviation) => Some(deviation),
            Self::Diverged { .. } => None,
        }
    }

    /// cVDM \[%\], infinite where the simulation diverged: for ordering, not for reports.
    fn order(&self) -> f64 {
        self.deviation().map_or(f64::INFINITY, |d| d.cvdm)
    }
}

/// A window under two models.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// Name of the run.
    pub run: String,
    /// Session.
    pub session: String,
    /// Manoeuvre.
    pub manoeuvre: String,
    /// Train or test.
    pub split: Split,
    /// Time of the first sample in the recording \[s\].
    pub start_time: f64,
    /// Length \[s\].
    pub duration: f64,
    /// Under the baseline.
    pub baseline: Outcome,
    /// Under the fitted model.
    pub fitted: Outcome,
}

impl Comparison {
    /// `(cVDM~ - cVDM*)/cVDM~` of this trajectory \[-\]; absent where a simulation diverged or the baseline is exact.
    pub fn improvement(&self) -> Option<f64> {
        let (before, after) = (self.baseline.deviation()?.cvdm, self.fitted.deviation()?.cvdm);
        (before > 0.0).then(|| 1.0 - after / before)
    }

    /// Mean over the measured dimensions of `(MD~ - MD*)/MD~` \[-\]; a dimension in which the baseline is exact is left out.
    pub fn average_relative_improvement(&self) -> Option<f64> {
        let (before, after) = (self.baseline.deviation()?, self.fitted.deviation()?);
        let relative = before.md.iter().zip(&after.md).filter_map(|(b, a)| match (b, a) {
            (Some(b), Some(a)) if *b > 0.0 => Some(1.0 - a / b),
            _ => None,
        });
        mean(&relative.collect::<Vec<_>>())
    }
}

/// One of the two outcomes of a comparison.
type Which = fn(&Comparison) -> &Outcome;

/// A number with its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// Its 95 % interval; absent with fewer than three runs.
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

/// The evaluation of a model against a baseline.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Evaluation {
    /// Name of the baseline.
    pub baseline: String,
    /// Name of the fitted model.
    pub fitted: String,
    /// Every trajectory, in the order of the windows.
    pub trajectories: Vec<Comparison>,
    /// By split (`test`, `train`), then by manoeuvre and by session of the test trajectories where there are several.
    pub summaries: Vec<Summary>,
    /// r_max \[rad/s\].
    pub max_yaw_rate: f64,
    /// Resamples of the bootstrap.
    pub resamples: usize,
    /// Its seed.
    pub seed: u64,
}

impl Evaluation {
    /// The summary of a group, e.g. `test`.
    pub fn summary(&self, group: &str) -> Option<&Summary> {
        self.summaries.iter().find(|s| s.group == group)
    }
}

/// The scenario of a window: its inputs and initial state.
impl From<&Run> for Scenario {
    fn from(window: &Run) -> Self {
        Self { dt: window.dt, inputs: window.inputs.clone(), initial: window.initial }
    }
}

/// What a model predicts the sensors to report over a window that starts where they report its initial state, with the parameter
/// additions of the window's session.
pub fn predict(model: &Model, window: &Run, integration: Integration) -> Trajectory {
    let theta = model.values_in(&window.session);
    reported(model, &theta, integration, &Scenario::from(window), &window.channels())
}

/// Predictions of every window, in order.
pub fn predict_all(model: &Model, windows: &[Run], integration: Integration) -> Vec<Trajectory> {
    windows.par_iter().map(|w| predict(model, w, integration)).collect()
}

/// The outcome of a prediction of a window; `max_yaw_rate` is r_max \[rad/s\].
pub fn outcome(window: &Run, predicted: &Trajectory, ship: &Ship, max_yaw_rate: f64) -> Outcome {
    let weights = weights(ship, window, max_yaw_rate);
    let diverged = |sample: usize| Outcome::Diverged { diverged_after: sample as f64 * window.dt };
    if let Some(sample) = predicted.diverged_at {
        return diverged(sample);
    }
    let mut sums = [0.0; STATES];
    let mut counts = [0_usize; STATES];
    for (s, m) in predicted.states.iter().zip(&window.measured).skip(1) {
        for i in 0..STATES {
            let Some(m) = m[i] else { continue };
            let difference = s[i] - m;
            sums[i] += if i == 2 { wrap_angle(difference).abs() } else { difference.abs() };
            counts[i] += 1;
        }
    }
    let md: [Option<f64>; STATES] = std::array::from_fn(|i| (counts[i] > 0).then(|| sums[i] / counts[i] as f64));
    let cvdm = (0..STATES).filter_map(|i| Some(100.0 * md[i]? * weights[i])).sum::<f64>();
    // A sensor term with absurd parameters can report what no number holds, from a simulation that ran through.
    if !cvdm.is_finite() {
        return diverged(0);
    }
    Outcome::Simulated(Deviation { md, cvdm })
}

/// Judges `fitted` against `baseline` on windows, each simulated from the window's initial state.
///
/// `max_yaw_rate` is r_max \[rad/s\], as in the fit.
pub fn evaluate(
    baseline: &Model,
    fitted: &Model,
    windows: &[Run],
    integration: Integration,
    max_yaw_rate: f64,
    settings: &EvaluationSettings,
) -> Evaluation {
    let before = predict_all(baseline, windows, integration);
    let after = predict_all(fitted, windows, integration);
    let trajectories: Vec<Comparison> =
        windows.iter().zip(before.iter().zip(&after)).map(|(w, p)| compare(w, fitted, max_yaw_rate, p)).collect();
    Evaluation {
        baseline: baseline.name.clone(),
        fitted: fitted.name.clone(),
        summaries: summaries(&trajectories, settings),
        trajectories,
        max_yaw_rate,
        resamples: settings.resamples,
        seed: settings.seed,
    }
}

/// Compares two predictions of a window, the baseline's first.
pub fn compare(
    window: &Run,
    model: &Model,
    max_yaw_rate: f64,
    (baseline, fitted): (&Trajectory, &Trajectory),
) -> Comparison {
    let ship = &model.ship;
    Comparison {
        run: window.recording.clone(),
        session: window.session.clone(),
        manoeuvre: window.manoeuvre.clone(),
        split: window.split,
        start_time: window.start_time(),
        duration: window.duration(),
        baseline: outcome(window, baseline, ship, max_yaw_rate),
        fitted: outcome(window, fitted, ship, max_yaw_rate),
    }
}

fn summaries(trajectories: &[Comparison], settings: &EvaluationSettings) -> Vec<Summary> {
    let mut summaries = Vec::new();
    let mut add = |group: String, members: Vec<&Comparison>| {
        if !members.is_empty() {
            summaries.push(summarise(group, &members, settings));
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

/// Compares two models over a group of trajectories.
pub fn summarise(group: String, members: &[&Comparison], settings: &EvaluationSettings) -> Summary {
    // Trajectories that both models run through, by run.
    let mut runs: Vec<&String> = members.iter().map(|t| &t.run).collect();
    runs.sort();
    runs.dedup();
    let sound = |run: &String| {
        let of_run = members.iter().filter(move |t| t.run == *run);
        of_run.filter(|t| t.baseline.deviation().is_some() && t.fitted.deviation().is_some()).copied().collect()
    };
    let clusters: Vec<Vec<&Comparison>> = runs.iter().map(|r| sound(r)).filter(|c: &Vec<_>| !c.is_empty()).collect();
    let bootstrap = Bootstrap::new(&clusters, settings);
    let diverged = |f: Which| members.iter().filter(|t| f(t).deviation().is_none()).count();
    let lower = |a: f64, b: f64| usize::from(a < b);
    let mean_order = |run: &String, f: Which| {
        let of_run: Vec<f64> = members.iter().filter(|t| t.run == *run).map(|t| f(t).order()).collect();
        of_run.iter().sum::<f64>() / of_run.len() as f64
    };
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
        md_baseline: std::array::from_fn(|i| bootstrap.estimate(|ts| mean(&column(ts, before, i)))),
        md_fitted: std::array::from_fn(|i| bootstrap.estimate(|ts| mean(&column(ts, after, i)))),
        md_improvement: std::array::from_fn(|i| {
            bootstrap.estimate(|ts| gain(&column(ts, before, i), &column(ts, after, i)))
        }),
        cvdm_baseline: bootstrap.estimate(|ts| mean(&cvdm(ts, before))),
        cvdm_fitted: bootstrap.estimate(|ts| mean(&cvdm(ts, after))),
        cvdm_improvement: bootstrap.estimate(|ts| gain(&cvdm(ts, before), &cvdm(ts, after))),
        mari: bootstrap.estimate(|ts| median(ts.iter().filter_map(|t| t.average_relative_improvement()).collect())),
        consistency: bootstrap.estimate(|ts| {
            let (before, after) = (variance(&cvdm(ts, before))?, variance(&cvdm(ts, after))?);
            (before > 0.0).then(|| 1.0 - after / before)
        }),
        better: members.iter().map(|t| lower(t.fitted.order(), t.baseline.order())).sum(),
        worse: members.iter().map(|t| lower(t.baseline.order(), t.fitted.order())).sum(),
        runs_better: runs.iter().map(|r| lower(mean_order(r, after), mean_order(r, before))).sum(),
        runs_worse: runs.iter().map(|r| lower(mean_order(r, before), mean_order(r, after))).sum(),
        worst: members.iter().max_by(|a, b| a.fitted.order().total_cmp(&b.fitted.order())).map(named),
        most_worsened: lost.max_by(|a, b| loss(a).total_cmp(&loss(b))).map(named),
    }
}

fn column(ts: &[&Comparison], f: Which, i: usize) -> Vec<f64> {
    ts.iter().filter_map(|t| f(t).deviation()?.md[i]).collect()
}

fn cvdm(ts: &[&Comparison], f: Which) -> Vec<f64> {
    ts.iter().filter_map(|t| Some(f(t).deviation()?.cvdm)).collect()
}

fn gain(before: &[f64], after: &[f64]) -> Option<f64> {
    let (before, after) = (mean(before)?, mean(after)?);
    (before > 0.0).then(|| 1.0 - after / before)
}

fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// Sample variance, of two values or more.
fn variance(values: &[f64]) -> Option<f64> {
    let m = mean(values).filter(|_| values.len() > 1)?;
    Some(values.iter().map(|v| (v - m).powi(2)).sum::<f64>() / (values.len() - 1) as f64)
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let (n, half) = (values.len(), values.len() / 2);
    (n > 0).then(|| if n % 2 == 1 { values[half] } else { 0.5 * (values[half - 1] + values[half]) })
}

/// A bootstrap over runs: the same draws for every statistic.
struct Bootstrap<'a> {
    all: Vec<&'a Comparison>,
    draws: Vec<Vec<&'a Comparison>>,
}

impl<'a> Bootstrap<'a> {
    fn new(clusters: &[Vec<&'a Comparison>], settings: &EvaluationSettings) -> Self {
        let all = clusters.concat();
        // With fewer than three runs an interval would only seem to say something.
        let resamples = if clusters.len() < 3 { 0 } else { settings.resamples };
        let mut random = ChaCha8Rng::seed_from_u64(settings.seed);
        let draw =
            |_| (0..clusters.len()).flat_map(|_| clusters[random.random_range(0..clusters.len())].clone()).collect();
        Self { all, draws: (0..resamples).map(draw).collect() }
    }

    fn estimate(&self, statistic: impl Fn(&[&Comparison]) -> Option<f64> + Sync) -> Option<Estimate> {
        let value = statistic(&self.all).filter(|v| v.is_finite())?;
        let mut drawn: Vec<f64> =
            self.draws.par_iter().filter_map(|d| statistic(d)).filter(|v| v.is_finite()).collect();
        drawn.sort_by(f64::total_cmp);
        let at = |share: f64| drawn[((drawn.len() - 1) as f64 * share).round() as usize];
        // Below a hundred draws the ends of the interval are single draws.
        let ci95 = (drawn.len() >= 100).then(|| [at(0.025), at(0.975)]);
        Some(Estimate { value, ci95 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::{Cost, CostOptions, Derivatives};
    use crate::physics::Form;
    use crate::recording::{measured, or_nan};
    use crate::simulate::report;
    use crate::state::Inputs;
    use std::f64::consts::PI;
    use std::path::Path;

    const R_MAX: f64 = 0.0314;

    fn model() -> Model {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments/ships/a.toml");
        let mut model = Model::new(Ship::read(&path).unwrap(), "A", Form::Regular, &[]).unwrap();
        model.set_eleven(&[-0.017, 34187.0, -12568.0, 1594.0, -0.039, 3.193, 0.205, -4.882, 0.048, 0.0746, 1.370]);
        model
    }

    /// Windows sailed by the model itself under rudder angles that differ from window to window.
    fn windows(model: &Model, count: usize) -> Vec<Run> {
        (0..count)
            .map(|i| {
                let angle = 0.04 * (i as f64 - 2.0);
                let inputs: Vec<_> = (0..=40).map(|k| Inputs::actuators(5.0 * k as f64, 2.0, angle)).collect();
                let initial = [0.0, 0.0, 0.3 * i as f64, 4.0, 0.0, 0.0];
                let mut window = Run {
                    name: format!("run_{i} 0 s"),
                    recording: format!("run_{i}"),
                    session: format!("day {}", i % 2),
                    manoeuvre: "turn".into(),
                    split: Split::Test,
                    dt: 5.0,
                    measured: vec![initial.map(Some); inputs.len()],
                    inputs,
                    initial,
                    disturbed: Vec::new(),
                };
                window.measured = measured(&predict(model, &window, Integration::default()).states);
                window
            })
            .collect()
    }

    #[test]
    fn what_sensors_report_is_predicted_from_what_they_reported_first() {
        let ship = model();
        let mut off = ship.clone();
        for (term, values) in [
            ("heading_bias", [("heading_bias.bias", 0.05)].as_slice()),
            ("log_scale", &[("log_scale.error", 0.08)]),
            ("antenna", &[("antenna.x", 30.0), ("antenna.y", -8.0)]),
            ("time_skew", &[("time_skew.position", 1.5)]),
        ] {
            off.add_term(term).unwrap();
            off.set(values).unwrap();
        }
        let theta = off.values();
        let mut windows = windows(&ship, 3);
        for w in &mut windows {
            for (m, inputs) in w.measured.iter_mut().zip(&w.inputs) {
                *m = report(&off, &theta, &or_nan(m), inputs).map(Some);
            }
            w.initial = or_nan(&w.measured[0]);
        }
        let cvdm = |model: &Model, w: &Run| {
            let Outcome::Simulated(d) = outcome(w, &predict(model, w, Integration::default()), &ship.ship, R_MAX)
            else {
                panic!("diverged")
            };
            d.cvdm
        };
        for w in &windows {
            assert!(cvdm(&off, w) < 1e-4 && cvdm(&ship, w) > 3.0, "{} {}", cvdm(&off, w), cvdm(&ship, w));
        }
        // A fit sees the same: its cost has its least value, nothing, at the sensors' own errors, and is level there.
        let at = off.find("log_scale.error").unwrap();
        off.parameters.iter_mut().enumerate().for_each(|(i, p)| p.free = i == at);
        for derivatives in [Derivatives::Lanes, Derivatives::NumDual] {
            let options = CostOptions {
                max_yaw_rate: R_MAX,
                derivatives,
                difference_step: 1e-6,
                integration: Integration::default(),
            };
            let cost = Cost::new(&off, &windows, options).unwrap();
            let (here, there) = (cost.with_gradient(&[0.08]).unwrap(), cost.with_gradient(&[0.06]).unwrap());
            assert!(here.value < 1e-9 && there.value > 1e-4, "{} {}", here.value, there.value);
            let h = 1e-5;
            let slope = (cost.value(&[0.06 + h]).unwrap() - cost.value(&[0.06 - h]).unwrap()) / (2.0 * h);
            assert!((there.gradient[0] - slope).abs() < 1e-6 * slope.abs(), "{} {slope}", there.gradient[0]);
        }
    }

    fn changed(by: f64) -> Model {
        let mut model = model();
        model.set(&[("rudder.lift1", 3.193 * (1.0 + by)), ("resistance.linear", 34187.0 * (1.0 + by))]).unwrap();
        model
    }

    fn evaluated(baseline: &Model, fitted: &Model, windows: &[Run]) -> Evaluation {
        evaluate(baseline, fitted, windows, Integration::default(), R_MAX, &EvaluationSettings::default())
    }

    #[test]
    fn cvdm_of_a_constant_offset_is_what_the_formula_says() {
        let model = model();
        let window = windows(&model, 1).remove(0);
        let mut predicted = predict(&model, &window, Integration::default());
        let offset = [3.0, -4.0, 0.1, 0.2, -0.05, 0.002];
        for s in predicted.states.iter_mut().skip(1) {
            *s = std::array::from_fn(|i| s[i] + offset[i]);
            // A whole turn is no difference of heading.
            s[2] += 2.0 * PI;
        }
        let (l, u) = (window.path_length(), window.mean_speed());
        let expected = 100.0 * (7.0 / l + 0.1 / PI + 0.25 / u + 0.002 / R_MAX);
        let comparison = compare(&window, &model, R_MAX, (&predicted, &predicted));
        let deviation = comparison.fitted.deviation().unwrap();
        assert!((deviation.cvdm - expected).abs() < 1e-9 * expected, "{} {expected}", deviation.cvdm);
        for (md, offset) in deviation.md.iter().zip(offset) {
            assert!((md.unwrap() - offset.abs()).abs() < 1e-9);
        }
    }

    #[test]
    fn halving_every_deviation_improves_every_number_by_half() {
        let model = model();
        let windows = windows(&model, 6);
        let settings = EvaluationSettings::default();
        let comparisons: Vec<Comparison> = windows
            .iter()
            .enumerate()
            .map(|(i, w)| {
                let moved = |by: f64| {
                    let mut p = predict(&model, w, Integration::default());
                    p.states.iter_mut().for_each(|s| *s = s.map(|x| x + by * 0.01 * (i + 1) as f64));
                    p
                };
                compare(w, &model, R_MAX, (&moved(1.0), &moved(0.5)))
            })
            .collect();
        let summary = summarise("all".into(), &comparisons.iter().collect::<Vec<_>>(), &settings);
        let near = |e: Option<Estimate>, v: f64| assert!((e.unwrap().value - v).abs() < 1e-9, "{e:?} {v}");
        near(summary.cvdm_improvement, 0.5);
        near(summary.mari, 0.5);
        near(summary.consistency, 0.75);
        summary.md_improvement.iter().for_each(|e| near(*e, 0.5));
        assert_eq!((summary.better, summary.worse, summary.runs_better), (6, 0, 6));
        let [lo, hi] = summary.cvdm_improvement.unwrap().ci95.unwrap();
        assert!(lo <= 0.5 + 1e-9 && hi >= 0.5 - 1e-9);
        assert_eq!(summary.most_worsened, None);
    }

    #[test]
    fn the_true_model_is_exact_and_beats_a_wrong_one_everywhere() {
        let truth = model();
        let windows = windows(&truth, 6);
        let evaluation = evaluated(&changed(0.2), &truth, &windows);
        let test = evaluation.summary("test").unwrap();
        assert!(test.cvdm_fitted.unwrap().value < 1e-9);
        assert!((test.mari.unwrap().value - 1.0).abs() < 1e-9);
        assert_eq!((test.better, test.worse), (6, 0));
        // And the other way round an exact baseline leaves no relative improvement to speak of, and no NaN.
        let reversed = evaluated(&truth, &changed(0.2), &windows);
        let test = reversed.summary("test").unwrap();
        assert_eq!((test.mari, test.cvdm_improvement, test.better), (None, None, 0));
        assert!(!serde_json::to_string(&reversed).unwrap().contains("null"));
    }

    #[test]
    fn a_diverged_simulation_is_counted_and_named_and_spoils_no_number() {
        let truth = model();
        let windows = windows(&truth, 5);
        let mut wild = changed(0.1);
        wild.set(&[("resistance.linear", -1e9)]).unwrap();
        let evaluation = evaluated(&changed(0.2), &wild, &windows);
        let test = evaluation.summary("test").unwrap();
        assert_eq!((test.diverged_fitted, test.diverged_baseline), (5, 0));
        assert_eq!((test.better, test.worse, test.runs_worse), (0, 5, 5));
        assert_eq!(test.cvdm_fitted, None);
        assert!(matches!(test.worst.as_ref().unwrap().fitted, Outcome::Diverged { .. }));
        let text = serde_json::to_string(&evaluation).unwrap();
        assert!(!text.contains("null") && !text.contains("NaN"), "{text}");
    }

    #[test]
    fn channels_that_were_not_measured_take_no_part() {
        let truth = model();
        let mut windows = windows(&truth, 4);
        for w in &mut windows {
            w.measured.iter_mut().for_each(|m| m[4] = None);
        }
        let evaluation = evaluated(&changed(0.2), &truth, &windows);
        assert_eq!(evaluation.trajectories[1].fitted.deviation().unwrap().md[4], None);
        assert!((evaluation.summary("test").unwrap().mari.unwrap().value - 1.0).abs() < 1e-9);
    }

    #[test]
    fn intervals_repeat_with_the_seed_and_cover_the_number() {
        let truth = model();
        let windows = windows(&truth, 8);
        let (a, b) = (changed(0.3), changed(-0.1));
        let first = evaluated(&a, &b, &windows);
        assert_eq!(first, evaluated(&a, &b, &windows));
        let estimate = first.summary("test").unwrap().cvdm_improvement.unwrap();
        let [lo, hi] = estimate.ci95.unwrap();
        assert!(lo < estimate.value && estimate.value < hi);
        let other = evaluate(
            &a,
            &b,
            &windows,
            Integration::default(),
            R_MAX,
            &EvaluationSettings { seed: 2, ..EvaluationSettings::default() },
        );
        assert_ne!(other.summary("test").unwrap().cvdm_improvement.unwrap().ci95, estimate.ci95);
    }

    #[test]
    fn groups_follow_split_manoeuvre_and_session() {
        let truth = model();
        let mut windows = windows(&truth, 6);
        windows[0].split = Split::Train;
        windows[1].manoeuvre = "stop".into();
        let evaluation = evaluated(&changed(0.2), &truth, &windows);
        let groups: Vec<&str> = evaluation.summaries.iter().map(|s| s.group.as_str()).collect();
        let expected = ["test", "train", "manoeuvre: stop", "manoeuvre: turn", "session: day 0", "session: day 1"];
        assert_eq!(groups, expected);
        assert_eq!(evaluation.summary("manoeuvre: stop").unwrap().cvdm_improvement.unwrap().ci95, None);
    }
}
