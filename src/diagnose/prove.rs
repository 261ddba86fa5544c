//! The proof: models against each other on runs that no earlier step has touched, in free simulation and in likelihood.
//! It fits nothing.

use super::filter::{Filter, Wanted};
use super::noise::Noise;
use crate::model::Model;
use crate::recording::Run;
use crate::simulate::{Integration, Scenario, reported};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use serde::Serialize;

/// How well one model does on one run.
#[derive(Clone, Debug, Serialize)]
pub struct RunScore {
    /// The run.
    pub run: String,
    /// Combined variable distance metric of the free simulation \[%\]; absent when it diverged.
    pub cvdm: Option<f64>,
    /// Mean distance a step in x, y \[m\], psi \[rad\], u, v \[m/s\], r \[rad/s\].
    pub mean_distance: Option<[f64; 6]>,
    /// Log-likelihood of the run under the filter.
    pub log_likelihood: f64,
}

/// Before against after on held-out runs.
#[derive(Clone, Debug, Serialize)]
pub struct HeldOut {
    /// Number of held-out runs.
    pub runs: usize,
    /// Median cVDM of the base model, refitted \[%\].
    pub before: f64,
    /// Median cVDM with the findings \[%\].
    pub after: f64,
    /// Median relative improvement of cVDM, `1 - after/before`, run by run.
    pub improvement: f64,
    /// Its 95 % bootstrap interval over runs.
    pub ci95: [f64; 2],
    /// Runs that got better.
    pub better: usize,
    /// Runs that got worse.
    pub worse: usize,
    /// The run that lost most.
    pub worst_run: Option<String>,
    /// Its relative change (positive is better).
    pub worst_improvement: Option<f64>,
    /// Median cVDM with a generic correction instead \[%\].
    pub generic: Option<f64>,
    /// Gain in log-likelihood over all held-out runs.
    pub log_likelihood_gain: f64,
    /// Mean square of the standardised innovations before and after; 1 is white noise of the modelled size.
    pub whiteness: [f64; 2],
    /// Run by run, before.
    pub runs_before: Vec<RunScore>,
    /// Run by run, after.
    pub runs_after: Vec<RunScore>,
}

/// Scores of a model on runs.
pub fn score(model: &Model, integration: Integration, noise: &Noise, runs: &[Run]) -> (Vec<RunScore>, f64) {
    let filter = Filter::new(model, integration, &[]);
    let scored: Vec<(RunScore, f64, f64)> = runs
        .par_iter()
        .map(|r| {
            let pass = filter.pass(r, noise, Wanted::default());
            let (mut sum, mut count) = (0.0, 0.0);
            for e in pass.innovations.iter().flatten().filter(|e| e.is_finite() && e.abs() < super::filter::GATE) {
                sum += e * e;
                count += 1.0;
            }
            let distance = distances(model, integration, r);
            let score = RunScore {
                run: r.name.clone(),
                cvdm: distance.map(|d| d.0),
                mean_distance: distance.map(|d| d.1),
                log_likelihood: pass.log_likelihood,
            };
            (score, sum, count)
        })
        .collect();
    let (sum, count) = scored.iter().fold((0.0, 0.0), |a, s| (a.0 + s.1, a.1 + s.2));
    (scored.into_iter().map(|s| s.0).collect(), sum / f64::max(count, 1.0))
}

/// cVDM \[%\] and mean distances of what the sensors would report in the free simulation of a run; `None` when the simulation
/// diverged.
///
/// `cVDM = 100/K sum_k (|dx|/L + |dy|/L + |dpsi|/pi + |du|/U + |dv|/U + |dr|/r_max)` over the measured channels, with path length L
/// and mean speed U of the recording (Papandreou et al. 2025); r_max is 3 U / ship length.
fn distances(model: &Model, integration: Integration, run: &Run) -> Option<(f64, [f64; 6])> {
    let scenario = Scenario { dt: run.dt, inputs: run.inputs.clone(), initial: run.initial };
    let t = reported(model, &model.values_in(&run.session), integration, &scenario, &run.channels());
    if t.diverged_at.is_some() {
        return None;
    }
    let path = run.path_length();
    let duration = run.dt * (run.measured.len().max(2) - 1) as f64;
    let l = model.ship.hull.lpp;
    let path = path.max(0.1 * l);
    let speed = path / duration;
    let unit = [path, path, std::f64::consts::PI, speed, speed, 3.0 * speed / l];
    let mut sums = [0.0; 6];
    let mut counts = [0.0; 6];
    for (s, m) in t.states.iter().zip(&run.measured) {
        for j in 0..6 {
            if let Some(m) = m[j] {
                let mut d = s[j] - m;
                if j == 2 {
                    d = trimtab_ad::smooth::wrap_angle(d);
                }
                sums[j] += d.abs();
                counts[j] += 1.0;
            }
        }
    }
    let mean: [f64; 6] = std::array::from_fn(|j| sums[j] / f64::max(counts[j], 1.0));
    Some((100.0 * (0..6).map(|j| mean[j] / unit[j]).sum::<f64>(), mean))
}

/// The middle value; the mean of the two middle ones for an even number.
pub fn median(values: &[f64]) -> f64 {
    let mut v: Vec<f64> = values.iter().copied().filter(|x| x.is_finite()).collect();
    v.sort_by(f64::total_cmp);
    match v.len() {
        0 => 0.0,
        n if n % 2 == 1 => v[n / 2],
        n => 0.5 * (v[n / 2 - 1] + v[n / 2]),
    }
}

/// A run that diverges counts as this far off \[%\], not as missing.
const DIVERGED: f64 = 1e4;

/// Median cVDM \[%\] of a model's free simulations of runs.
pub fn median_distance(model: &Model, integration: Integration, runs: &[Run]) -> f64 {
    let of = |r: &Run| distances(model, integration, r).map_or(DIVERGED, |d| d.0);
    median(&runs.par_iter().map(of).collect::<Vec<_>>())
}

/// Compares two models on held-out runs.
pub fn prove(
    before: (&Model, &Noise),
    after: (&Model, &Noise),
    generic: Option<&Model>,
    integration: Integration,
    runs: &[Run],
    seed: u64,
) -> HeldOut {
    let (runs_before, white_before) = score(before.0, integration, before.1, runs);
    let (runs_after, white_after) = score(after.0, integration, after.1, runs);
    let value = |s: &RunScore| s.cvdm.unwrap_or(DIVERGED);
    let improvements: Vec<f64> =
        runs_before.iter().zip(&runs_after).map(|(b, a)| 1.0 - value(a) / value(b).max(1e-9)).collect();
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut medians: Vec<f64> = (0..2000)
        .map(|_| {
            let resample: Vec<f64> =
                (0..improvements.len()).map(|_| improvements[rng.random_range(0..improvements.len())]).collect();
            median(&resample)
        })
        .collect();
    medians.sort_by(f64::total_cmp);
    let at = |q: f64| medians.get((q * (medians.len() - 1) as f64).round() as usize).copied().unwrap_or(0.0);
    let worst = improvements.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1));
    HeldOut {
        runs: runs.len(),
        before: median(&runs_before.iter().map(value).collect::<Vec<_>>()),
        after: median(&runs_after.iter().map(value).collect::<Vec<_>>()),
        improvement: median(&improvements),
        ci95: [at(0.025), at(0.975)],
        better: improvements.iter().filter(|i| **i > 0.0).count(),
        worse: improvements.iter().filter(|i| **i < 0.0).count(),
        worst_run: worst.map(|(i, _)| runs[i].name.clone()),
        worst_improvement: worst.map(|(_, v)| *v),
        generic: generic.map(|g| median_distance(g, integration, runs)),
        log_likelihood_gain: runs_after.iter().map(|s| s.log_likelihood).sum::<f64>()
            - runs_before.iter().map(|s| s.log_likelihood).sum::<f64>(),
        whiteness: [white_before, white_after],
        runs_before,
        runs_after,
    }
}
