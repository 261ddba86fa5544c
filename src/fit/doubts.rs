//! What the residuals of a fit say against its estimates: model error, windows that are too long, a recording that stands apart.
//! It computes statistics and compares each with a limit; it changes no estimate.
//!
//! With the weighted residual `e_c(k)` of channel c at sample k of a run,
//!
//! | statistic | definition | limit | reason for the limit |
//! |---|---|---|---|
//! | model error | `mean e^2 / mean q^2`, `q_c^2 = s_c^2 + mean sum_j (de_c/dx0_j)^2 s_j^2`, `s_c^2 = mean (e_c(k+1) - 2 e_c(k) + e_c(k-1))^2 / 6` | 10 | less than a tenth of the residual variance is the sensors', in the sample or in the start x0 that was measured |
//! | apart | Grubbs's test of `ln (mean e^2 / mean s^2)` over the recordings, the largest | p = 0.001 | hard manoeuvres are described worse than easy ones |
//! | growth | exponent b of `rms e ~ t^b` in the velocities between the second and the last quarter of the windows | 1 | a force that is wrong makes errors of velocity grow linearly at most; what grows faster is an open loop that runs away |
//! | loss | `mean e^2` in sway and yaw rate in the last quarter over the variance measured there | 1/2 | more of the motion is lost than is predicted; windows are too long for it where the first quarter loses less than half as much |
//! | likeness | integrated autocorrelation `1 + 2 sum rho(l)` | none | along a simulated trajectory residuals are always alike; standard errors allow for it (see `covariance`) |
//!
//! The second difference of white noise of variance s^2 has the variance 6 s^2, and a smooth error has next to none: it is
//! taken of the residuals, from which the simulation has removed most of the motion, so that it measures the sensors. Sources:
//! von Neumann, Ann. Math. Stat. 12 (1941) 367-395 for successive differences.

use super::backwards::{Estimated, backwards};
use super::inputs::{APART_RECORDINGS, INPUT_CHANCE, InputError};
use super::objectives::cost::Cost;
use crate::fit::solver::task::Task;
use crate::numerals::sig;
use crate::ranks::{ExactSums, Ranks};
use crate::recording::Run;
use crate::ship::Ship;
use crate::state::STATES;
use crate::statistics::{outlier_p, quantile};
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;

/// Residual variance over the sensors' from which on a cost is far above its noise.
pub const MODEL_ERROR_LIMIT: f64 = 10.0;

/// Exponent of the growth of errors along a window from which on windows are too long.
pub const GROWTH_LIMIT: f64 = 1.0;

/// Share of the measured variance of sway and yaw rate that may be lost in the last quarter of the windows.
pub const LOSS_LIMIT: f64 = 0.5;

/// Largest chance at which a recording is said to be described far worse than the others: a tenth of the usual hundredth, since hard
/// manoeuvres are described worse than easy ones.
pub const APART_CHANCE: f64 = 1e-3;

/// Windows, evenly drawn, on which errors of the start are carried along.
const STARTS: usize = 40;

/// Noise below which no sensor goes, as a share of what a residual is measured in (path length, pi, speed, r_max).
const FINEST: f64 = 1e-6;

/// Autocorrelation below which the sum over lags ends: beyond it is scatter.
const UNCORRELATED: f64 = 0.05;

/// Windows over which autocorrelations are taken, evenly drawn where there are more.
const WINDOWS: usize = 1000;

/// Lags of which products are computed at once.
const LAGS: usize = 16;

/// A reason to doubt a fit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Doubt {
    /// What is wrong.
    pub kind: DoubtKind,
    /// The statistic.
    pub value: f64,
    /// The limit that it exceeds.
    pub limit: f64,
    /// In words, with what to do.
    pub sentence: String,
}

/// Kinds of doubt.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum DoubtKind {
    /// The cost is far above what the noise of the sensors leaves.
    ModelError,
    /// The windows are too long to be predicted in open loop.
    WindowsTooLong,
    /// A recording is described far worse than the others.
    Apart,
    /// The input of one recording or session has another gain or zero than in the others.
    Input,
    /// An actuator pushes against its order.
    Backwards,
}

/// The statistics behind the doubts; one is absent where there are too few samples for it.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ResidualStatistics {
    /// Variance of the residuals over what the noise of the sensors leaves, in each sample and through the start of each run.
    pub model_error: Option<f64>,
    /// Exponent b of the growth of the errors of velocity along the windows, `rms e ~ t^b`.
    pub growth: Option<f64>,
    /// Standard error of `growth` over the recordings; absent with fewer than three.
    pub growth_error: Option<f64>,
    /// Shares of the measured variance of sway and yaw rate that are lost in the first and in the last quarter of the windows.
    pub loss: Option<[f64; 2]>,
    /// How many successive residuals of a run count as one.
    pub likeness: Option<f64>,
    /// Variance of the residuals over that of the sensors in the middle recording.
    pub middle: Option<f64>,
    /// The recording that is described far worse than the others, with that number and the chance of it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub apart: Option<(String, f64, f64)>,
}

/// Weighted residuals of one run: an entry is NaN where nothing was measured.
struct Residuals {
    recording: String,
    values: Vec<[f64; STATES]>,
    /// Weighted variance of what was measured of each channel that a rudder moves; NaN in the others and where nothing was.
    variance: [f64; STATES],
}

/// Channels of velocity: u, v, r.
const VELOCITIES: std::ops::Range<usize> = 3..6;

/// Channels that a rudder moves: v, r.
const STEERED: std::ops::Range<usize> = 4..6;

impl ResidualStatistics {
    /// The statistics of a task's residuals at `p`.
    pub(in crate::fit) fn of(task: &Task, p: &[f64]) -> Self {
        let every = task.cost.runs().div_ceil(WINDOWS).max(1);
        let ranks = task.cost.ranks();
        let before = ranks.before(task.runs.len());
        let mut tally = Tally::new();
        // A run that cannot be read ends the sums; the fit itself then says so.
        let _ = task.cost.residuals_by_run(p, |run, mut values| {
            let drawn = (before + run).is_multiple_of(every);
            let weights = &task.cost.weights()[run];
            let run = task.runs.get(run)?;
            values.truncate(run.measured.len());
            let variance = measured_variance(&run, weights);
            tally.add(Residuals { recording: run.recording.clone(), values, variance }, drawn);
            Some(())
        });
        tally.statistics(ranks, |noise| by_start(task, p, noise).unwrap_or_default())
    }

    /// What the statistics say against the fit.
    pub(in crate::fit) fn doubts(&self, input: Option<&InputError>) -> Vec<Doubt> {
        let of_input = input.map(|error| Doubt {
            kind: DoubtKind::Input,
            value: error.p,
            limit: INPUT_CHANCE,
            sentence: error.sentence(),
        });
        // What is said of its input need not be said of the recording again.
        let apart = self.set_apart().filter(|_| {
            let same = |error: &InputError| self.apart.as_ref().is_some_and(|(name, ..)| *name == error.name);
            !input.is_some_and(same)
        });
        let model_error = self.model_error.filter(|r| *r > MODEL_ERROR_LIMIT).map(|value| Doubt {
            kind: DoubtKind::ModelError,
            value,
            limit: MODEL_ERROR_LIMIT,
            sentence: format!(
                "the residuals have {} times the variance of the sensors' noise, so that the estimates make up for physics \
                 that the model lacks (see `trimtab diagnose`), or for a number of the ship file that is not this ship's",
                sig(value, 2)
            ),
        });
        [of_input, apart, model_error, self.too_long()].into_iter().flatten().collect()
    }

    fn set_apart(&self) -> Option<Doubt> {
        let ((name, ratio, p), middle) = (self.apart.as_ref()?, self.middle?);
        let sentence = format!(
            "recording `{name}` is described far worse than the others: the residuals have {} times the variance of the sensors' noise, and {} \
             times in the middle recording (p = {}): is it damaged, is its rudder, propeller rate, gain, zero or time another, or does \
             something act in it alone? (`trimtab check`; fit without it and compare)",
            sig(*ratio, 2),
            sig(middle, 2),
            sig(*p, 1)
        );
        Some(Doubt { kind: DoubtKind::Apart, value: *p, limit: APART_CHANCE, sentence })
    }

    fn too_long(&self) -> Option<Doubt> {
        let surely = |b: f64| b - 2.0 * self.growth_error.unwrap_or(0.0);
        let (value, limit, what) = match (self.growth, self.loss) {
            (_, Some([early, late])) if late > LOSS_LIMIT && early < 0.5 * late => {
                (late, LOSS_LIMIT, format!("their last quarter loses {:.0} % of the motion", 100.0 * late))
            }
            (Some(b), _) if surely(b) > GROWTH_LIMIT => {
                (b, GROWTH_LIMIT, format!("errors of velocity grow as t^{b:.1}"))
            }
            _ => return None,
        };
        let sentence =
            format!("the windows are too long to be predicted in open loop: {what} (shorten `window` in the study)");
        Some(Doubt { kind: DoubtKind::WindowsTooLong, value, limit, sentence })
    }
}

/// The doubts about the actuators of a craft that push against their orders.
pub(in crate::fit) fn against_orders<'a>(ship: &Ship, estimates: impl Iterator<Item = Estimated<'a>>) -> Vec<Doubt> {
    let doubt = |(value, sentence)| Doubt { kind: DoubtKind::Backwards, value, limit: 0.0, sentence };
    backwards(ship, estimates).into_iter().map(doubt).collect()
}

/// The first line of a fit: how it ended, and what is said against it.
pub(in crate::fit) fn headline(converged: bool, words: &str, doubts: &[Doubt]) -> String {
    if !converged {
        return format!("NOT CONVERGED: {words}");
    }
    match doubts {
        [] => format!("Converged: {words}"),
        doubts => {
            let sentences: Vec<&str> = doubts.iter().map(|d| d.sentence.as_str()).collect();
            format!("Converged, but IN DOUBT: {}", sentences.join("; "))
        }
    }
}

/// Weighted variance of what was measured of the channels that a rudder moves; NaN in the others.
fn measured_variance(run: &Run, weights: &[f64; STATES]) -> [f64; STATES] {
    let mut variance = [f64::NAN; STATES];
    for c in STEERED {
        let values = || run.measured.iter().filter_map(|m| m[c]);
        let count = values().count() as f64;
        let mean = values().sum::<f64>() / count;
        variance[c] = weights[c] * values().map(|v| (v - mean).powi(2)).sum::<f64>() / count;
    }
    variance
}

/// Mean square of some channels over some samples, with the number of values.
fn squares(values: &[[f64; STATES]], channels: std::ops::Range<usize>) -> (f64, f64) {
    let finite = values.iter().flat_map(|e| &e[channels.clone()]).filter(|e| e.is_finite());
    finite.fold((0.0, 0.0), |(sum, count), e| (sum + e * e, count + 1.0))
}

/// Sums over the residuals of runs, from which the statistics come.
struct Tally {
    /// For each channel: the sum of squares and the number of values, and the same of the second differences, a sixth each.
    squares: ExactSums,
    /// Mean squares of velocities in the second and in the last quarter, summed by recording.
    quarters: BTreeMap<String, [f64; 2]>,
    /// Mean squares in sway and yaw rate in the first and the last quarter, and the variance measured.
    lost: ExactSums,
    /// The sums of `squares`, by recording.
    recordings: BTreeMap<String, [f64; 4 * STATES]>,
    /// Residuals of some runs, evenly drawn.
    drawn: Vec<Residuals>,
}

impl Tally {
    /// Of no run yet.
    fn new() -> Self {
        let (squares, lost) = (ExactSums::new(4 * STATES), ExactSums::new(3));
        Self { squares, quarters: BTreeMap::new(), lost, recordings: BTreeMap::new(), drawn: Vec::new() }
    }

    /// Adds a run, which is kept for autocorrelations where it was drawn for them.
    fn add(&mut self, run: Residuals, drawn: bool) {
        for c in 0..STATES {
            let (square, count) = squares(&run.values, c..c + 1);
            let second = |w: &[[f64; STATES]]| w[2][c] - 2.0 * w[1][c] + w[0][c];
            let seconds = run.values.windows(3).map(second).filter(|d| d.is_finite());
            let (differences, triples) = seconds.fold((0.0, 0.0), |(sum, n), d| (sum + d * d / 6.0, n + 1.0));
            let own = self.recordings.entry(run.recording.clone()).or_insert([0.0; 4 * STATES]);
            for (i, x) in [square, count, differences, triples].into_iter().enumerate() {
                self.squares.add(4 * c + i, x);
                own[4 * c + i] += x;
            }
        }
        let quarter = run.values.len() / 4;
        if quarter >= 2 {
            self.add_quarters(&run, quarter);
        }
        if drawn {
            self.drawn.push(run);
        }
    }

    fn add_quarters(&mut self, run: &Residuals, quarter: usize) {
        // The middles of the second and of the last quarter are at 3/8 and 7/8 of the window.
        let [first, second] = [&run.values[..quarter], &run.values[quarter..2 * quarter]];
        let last = &run.values[run.values.len() - quarter..];
        let mean_square = |(sum, count): (f64, f64)| if count > 0.0 { sum / count } else { 0.0 };
        let sums = self.quarters.entry(run.recording.clone()).or_default();
        sums[0] += mean_square(squares(second, VELOCITIES));
        sums[1] += mean_square(squares(last, VELOCITIES));
        for c in STEERED.filter(|c| run.variance[*c].is_finite()) {
            let ends = [first, last].map(|part| squares(part, c..c + 1));
            if ends.iter().all(|(_, count)| *count > 0.0) {
                ends.iter().enumerate().for_each(|(i, (square, count))| self.lost.add(i, square / count));
                self.lost.add(2, run.variance[c]);
            }
        }
    }

    /// The statistics of the runs of all ranks; `by_start` gives the variances that errors of the start leave, by the noise of the sensors.
    fn statistics(self, ranks: &Ranks, by_start: impl FnOnce(&[f64; STATES]) -> [f64; STATES]) -> ResidualStatistics {
        let channels = ranks.total(self.squares);
        let growth = growth(ranks, &self.quarters);
        let (middle, apart) = apart(ranks, &self.recordings);
        ResidualStatistics {
            middle,
            apart,
            model_error: channels.and_then(|sums| over_noise(&sums, &by_start(&noise(&sums)))),
            growth: growth.map(|g| g.0),
            growth_error: growth.and_then(|g| g.1),
            loss: loss(ranks, self.lost),
            likeness: likeness(ranks, &self.drawn),
        }
    }
}

/// The middle recording's variance of residuals over that of its sensors, and the recording that is far above the others by it.
fn apart(ranks: &Ranks, recordings: &BTreeMap<String, [f64; 4 * STATES]>) -> (Option<f64>, Option<(String, f64, f64)>) {
    let of = |sums: &[f64; 4 * STATES]| over_noise(sums, &[0.0; STATES]);
    let own: Vec<(String, f64)> =
        recordings.iter().filter_map(|(name, sums)| Some((name.clone(), of(sums)?))).collect();
    let mut all: Vec<(String, f64)> = ranks.gather(&own).into_iter().flatten().collect();
    all.sort_by(|a, b| a.1.total_cmp(&b.1));
    let sorted: Vec<f64> = all.iter().map(|(_, ratio)| *ratio).collect();
    let middle = quantile(&sorted, 0.5).filter(|_| sorted.len() >= APART_RECORDINGS);
    let p = outlier_p(&sorted.iter().map(|ratio| ratio.ln()).collect::<Vec<_>>());
    let worst = all.pop().filter(|(_, ratio)| middle.is_some() && p < APART_CHANCE && *ratio > MODEL_ERROR_LIMIT);
    (middle, worst.map(|(name, ratio)| (name, ratio, p)))
}

/// Variance of the sensors in each channel, weighted as the residuals; 0 where nothing was measured.
fn noise(sums: &[f64]) -> [f64; STATES] {
    std::array::from_fn(|c| {
        let [differences, triples] = [2, 3].map(|i| sums[4 * c + i]);
        if triples > 0.0 { f64::max(differences / triples, FINEST * FINEST) } else { 0.0 }
    })
}

/// Mean square of the residuals over what the noise of the sensors leaves; `by_start` of it comes through the start of the runs.
fn over_noise(sums: &[f64], by_start: &[f64; STATES]) -> Option<f64> {
    let (mut square, mut left) = (0.0, 0.0);
    for ((of_channel, noise), by_start) in sums.chunks(4).zip(noise(sums)).zip(by_start) {
        if of_channel[3] > 0.0 {
            square += of_channel[0];
            left += of_channel[1] * (noise + by_start);
        }
    }
    (left > 0.0).then(|| square / left)
}

/// The variance that errors of the start, as large as the `noise` of the sensors that measured it, leave in each channel: some runs are
/// simulated again with each channel of their start moved by one standard deviation.
fn by_start(task: &Task, p: &[f64], noise: &[f64; STATES]) -> Option<[f64; STATES]> {
    let ranks = task.cost.ranks();
    let every = task.cost.runs().div_ceil(STARTS).max(1);
    let before = ranks.before(task.runs.len());
    let drawn: Vec<usize> = (0..task.runs.len()).filter(|run| (before + run).is_multiple_of(every)).collect();
    let some: Vec<Run> = drawn.iter().filter_map(|run| Some(task.runs.get(*run)?.into_owned())).collect();
    let residuals = |runs: &[Run]| {
        let cost = Cost::over(ranks, task.model, runs, task.settings.cost_options()).ok()?;
        let mut all = vec![Vec::new(); runs.len()];
        cost.residuals_by_run(p, |run, values| {
            all[run] = values;
            Some(())
        })?;
        Some(all)
    };
    let plain = residuals(&some);
    let (mut squares, mut counts) = (ExactSums::new(STATES), ExactSums::new(STATES));
    for (j, noise) in noise.iter().enumerate() {
        let mut moved = some.clone();
        for (run, i) in moved.iter_mut().zip(&drawn) {
            let weight = task.cost.weights()[*i][j];
            if weight > 0.0 {
                run.initial[j] += (noise / weight).sqrt();
            }
        }
        // Every rank makes as many costs as the others, whether its own can be simulated or not.
        let (Some(plain), Some(moved)) = (&plain, residuals(&moved)) else {
            squares.spoil();
            continue;
        };
        for (a, b) in plain.iter().flatten().zip(moved.iter().flatten()) {
            for (c, change) in a.iter().zip(b).map(|(a, b)| a - b).enumerate().filter(|(_, d)| d.is_finite()) {
                squares.add(c, change * change);
                if j == 0 {
                    counts.add(c, 1.0);
                }
            }
        }
    }
    let (squares, counts) = (ranks.total(squares)?, ranks.total(counts)?);
    Some(std::array::from_fn(|c| if counts[c] > 0.0 { squares[c] / counts[c] } else { 0.0 }))
}

/// Exponent of the growth of the residuals along the windows, with its standard error over the recordings.
fn growth(ranks: &Ranks, quarters: &BTreeMap<String, [f64; 2]>) -> Option<(f64, Option<f64>)> {
    let exponent = |[early, late]: &[f64; 2]| {
        (*early > FINEST * FINEST && *late > 0.0).then(|| 0.5 * (late / early).ln() / (7.0_f64 / 3.0).ln())
    };
    let exponents: Vec<f64> = quarters.values().filter_map(exponent).collect();
    let total = |of: &dyn Fn(f64) -> f64| {
        let mut sums = ExactSums::new(1);
        exponents.iter().for_each(|b| sums.add(0, of(*b)));
        ranks.total(sums).map_or(f64::NAN, |sum| sum[0])
    };
    let n = total(&|_| 1.0);
    let mean = total(&|b| b) / n;
    let scatter = total(&|b| (b - mean).powi(2));
    mean.is_finite().then(|| (mean, (n > 2.0).then(|| (scatter / (n * (n - 1.0))).sqrt())))
}

/// Shares of the measured variance of sway and yaw rate that the first and the last quarter of the windows lose.
fn loss(ranks: &Ranks, sums: ExactSums) -> Option<[f64; 2]> {
    let total = ranks.total(sums)?;
    (total[2] > 0.0).then(|| [total[0] / total[2], total[1] / total[2]])
}

/// Residuals of one run in one row, sample after sample.
struct Flat {
    /// 0 where there is none.
    values: Vec<f64>,
    /// 1 where there is a residual and 0 where there is none; empty where there are all.
    present: Vec<f64>,
}

impl Flat {
    fn of(residuals: &Residuals) -> Self {
        let entries = || residuals.values.iter().flatten();
        let present: Vec<f64> = if entries().all(|e| e.is_finite()) {
            Vec::new()
        } else {
            entries().map(|e| f64::from(u8::from(e.is_finite()))).collect()
        };
        Self { values: entries().map(|e| if e.is_finite() { *e } else { 0.0 }).collect(), present }
    }

    /// Sum of the products of residuals that are `lag` samples apart, with their number.
    fn product(&self, lag: usize) -> (f64, f64) {
        let shift = (lag * STATES).min(self.values.len());
        let apart = |x: &[f64]| dot(&x[..x.len() - shift], &x[shift..]);
        let count = if self.present.is_empty() { (self.values.len() - shift) as f64 } else { apart(&self.present) };
        (apart(&self.values), count)
    }
}

/// The scalar product, in eight partial sums that a machine can add side by side.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (a, b) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest: f64 = a.remainder().iter().zip(b.remainder()).map(|(a, b)| a * b).sum();
    let mut sums = [0.0; 8];
    for (a, b) in a.zip(b) {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += a * b;
        }
    }
    sums.iter().sum::<f64>() + rest
}

/// How many successive residuals count as one: `1 + 2 sum rho(l)` over the lags up to where rho is lost in scatter.
fn likeness(ranks: &Ranks, drawn: &[Residuals]) -> Option<f64> {
    let drawn: Vec<Flat> = drawn.iter().map(Flat::of).collect();
    let longest = drawn.iter().map(|r| r.values.len() / STATES).max().unwrap_or(0);
    let longest = ranks.largest(&[longest as f64])[0] as usize;
    // Mean products at some lags in one go: threads and ranks meet once for all of them.
    let products = |lags: std::ops::Range<usize>| -> Vec<f64> {
        let of_run = |r: &Flat| lags.clone().map(|lag| r.product(lag)).collect::<Vec<_>>();
        let mut sums = ExactSums::new(2 * lags.len());
        for (i, (sum, count)) in
            drawn.par_iter().map(of_run).collect::<Vec<_>>().iter().flat_map(|p| p.iter().enumerate())
        {
            sums.add(2 * i, *sum);
            sums.add(2 * i + 1, *count);
        }
        let total = ranks.total(sums).unwrap_or_default();
        let mean =
            |i: usize| total.get(2 * i + 1).filter(|count| **count > 0.0).map_or(0.0, |count| total[2 * i] / count);
        (0..lags.len()).map(mean).collect()
    };
    let variance = products(0..1)[0];
    if variance <= FINEST * FINEST {
        return None;
    }
    let batches = (1..longest / 2).step_by(LAGS).map(|lag| lag..(lag + LAGS).min(longest / 2));
    let correlations = batches.flat_map(products).map(|product| product / variance);
    Some(1.0 + 2.0 * correlations.take_while(|rho| *rho > UNCORRELATED).sum::<f64>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    /// Twelve recordings of two windows of 120 samples: what `error` gives at a sample, plus white noise.
    fn made(noise: f64, error: impl Fn(usize, usize) -> f64) -> Vec<(String, Vec<[f64; STATES]>)> {
        let mut rng = ChaCha8Rng::seed_from_u64(7);
        let window = |w: usize, rng: &mut ChaCha8Rng| {
            let sample = |k: usize, rng: &mut ChaCha8Rng| {
                let white: f64 = StandardNormal.sample(rng);
                [f64::NAN, f64::NAN, f64::NAN, f64::NAN, noise * white + error(w, k), f64::NAN]
            };
            (0..120).map(|k| sample(k, rng)).collect()
        };
        (0..24).map(|w| (format!("recording {}", w / 2), window(w, &mut rng))).collect()
    }

    fn view(made: &[(String, Vec<[f64; STATES]>)]) -> ResidualStatistics {
        // Sway that was measured to vary by 0.1.
        let variance = [f64::NAN, f64::NAN, f64::NAN, f64::NAN, 0.01, f64::NAN];
        let mut tally = Tally::new();
        for (recording, values) in made.iter().cloned() {
            tally.add(Residuals { recording, values, variance }, true);
        }
        tally.statistics(Ranks::one(), |_| [0.0; STATES])
    }

    #[test]
    fn an_actuator_whose_gain_is_surely_negative_pushes_against_its_order() {
        let text = "name = \"boat\"\n[hull]\nlpp = 5.0\nbreadth = 1.8\nmass = 900.0\n[[actuator]]\nname = \"jet\"\nlaw = \"order\"\n";
        let ship = Ship::parse(text, std::path::Path::new("ship.toml")).unwrap();
        let of = |name: &'static str, value: f64, error: Option<f64>| {
            backwards(&ship, std::iter::once((name, value, error, "N"))).len()
        };
        assert_eq!(of("jet.gain", -482.0, Some(40.0)), 1);
        assert_eq!(
            [of("jet.gain", -482.0, Some(200.0)), of("jet.gain", -482.0, None), of("jet.gain", 482.0, Some(40.0))],
            [0; 3]
        );
        assert_eq!([of("jet.zero", -4.0, Some(0.1)), of("rudder.lift1", -4.0, Some(0.1))], [0; 2]);
    }

    #[test]
    fn white_noise_alone_gives_no_reason_to_doubt() {
        let white = made(0.01, |_, _| 0.0);
        let found = view(&white);
        assert!((found.model_error.unwrap() - 1.0).abs() < 0.1);
        assert!(found.growth.unwrap().abs() < 0.1 && found.growth_error.unwrap() < 0.1, "{found:?}");
        assert!((found.likeness.unwrap() - 1.0).abs() < 0.2);
    }

    #[test]
    fn a_smooth_error_above_the_noise_is_a_model_error_and_makes_residuals_alike() {
        let wave = made(0.01, |w, k| 0.1 * (0.1 * k as f64 + w as f64).sin());
        let found = view(&wave);
        // Variance 0.005 of the wave over 0.0001 of the noise.
        let ratio = found.model_error.unwrap();
        assert!((40.0..60.0).contains(&ratio), "{ratio}");
        assert!(found.likeness.unwrap() > 10.0);
        assert!(found.growth.unwrap() < 0.5);
    }

    #[test]
    fn a_recording_that_is_described_far_worse_than_the_others_is_named() {
        let wave = |w: usize, k: usize, size: f64| size * (0.1 * k as f64 + w as f64).sin();
        // Recordings that are described as well as others, some better than others.
        let usual = |w: usize| 0.01 * (1.0 + 0.3 * (w / 2) as f64);
        let one = view(&made(0.01, |w, k| wave(w, k, if w / 2 == 5 { 0.5 } else { usual(w) })));
        let (name, ratio, p) = one.apart.clone().unwrap();
        assert!(name == "recording 5" && ratio > 100.0 && p < 1e-3, "{one:?}");
        let said = one.set_apart().unwrap().sentence;
        assert!(said.contains("recording `recording 5` is described far worse"), "{said}");
        for largest in [0.01, 0.04, 0.08] {
            let found = view(&made(0.01, |w, k| wave(w, k, if w / 2 == 5 { largest } else { usual(w) })));
            assert_eq!(found.apart, None, "{largest}: {found:?}");
        }
    }

    #[test]
    fn the_exponent_of_growth_is_found() {
        for power in [0.5, 1.0, 2.0] {
            let grown = made(0.0, |w, k| (1.0 + 0.1 * w as f64) * (k as f64 / 120.0).powf(power));
            let found = view(&grown);
            // The rms of a quarter is not at its middle.
            assert!((found.growth.unwrap() - power).abs() < 0.1, "t^{power}: {found:?}");
        }
    }

    #[test]
    fn windows_at_whose_end_the_motion_is_lost_are_too_long() {
        let doubt = |made: &[(String, Vec<[f64; STATES]>)]| view(made).too_long().map(|d| d.kind);
        let wave = |w: usize, k: usize| (0.2 * k as f64 + w as f64).sin();
        // Out of step from the middle of the window on, by as much as is measured; out of step all the time; and in step.
        let lost = made(0.001, |w, k| 0.08 * wave(w, k) * (k as f64 / 60.0).min(1.0));
        assert_eq!(doubt(&lost), None, "a third of the variance is lost, less than the limit");
        let lost = made(0.001, |w, k| 0.15 * wave(w, k) * (k as f64 / 60.0).min(1.0));
        assert_eq!(doubt(&lost), Some(DoubtKind::WindowsTooLong));
        assert_eq!(doubt(&made(0.001, |w, k| 0.15 * wave(w, k))), None);
        assert_eq!(doubt(&made(0.001, |w, k| 0.02 * wave(w, k) * (k as f64 / 60.0).min(1.0))), None);
    }

    #[test]
    fn an_exact_fit_is_not_doubted_for_the_shape_of_its_rounding() {
        let exact = made(0.0, |w, k| 1e-9 * (0.1 * k as f64 + w as f64).sin());
        let found = view(&exact);
        assert!(found.model_error.unwrap() < 1.0);
        assert_eq!((found.growth, found.likeness), (None, None));
    }

    #[test]
    fn the_first_line_says_what_is_in_doubt() {
        let doubt = Doubt { kind: DoubtKind::ModelError, value: 50.0, limit: 10.0, sentence: "model error".into() };
        assert_eq!(headline(true, "solved", &[]), "Converged: solved");
        assert!(
            headline(true, "solved", std::slice::from_ref(&doubt)).starts_with("Converged, but IN DOUBT: model error")
        );
        assert!(headline(false, "stopped", &[doubt]).starts_with("NOT CONVERGED: stopped"));
    }
}
