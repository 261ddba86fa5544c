//! Responses: how the motion answers what is recorded of rudder, propeller, gyro and receiver, with each of many lags between them.
//! It gives evidence on lag and sign, run by run; what is reported is decided in `signs` and `across`.

use super::plateau::{Plateau, plateaus};
use super::series::{Series, mean_square};
use super::sums::{Gathered, Sums};
use crate::recording::Channel;
use crate::recording::audit::limits::{LAG_LONGEST, RESPONSE_STEPS};
use crate::recording::convert::DERIVE_ROWS;
use nalgebra::{SMatrix, SVector};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// What a channel leaves unexplained of the motion, by how late it is taken to be.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// Sample period \[s\].
    pub step: f64,
    /// Lags \[rows\], positive where the channel is behind the motion.
    pub lags: Vec<isize>,
    /// Sum of squares left at each lag.
    pub left: Vec<f64>,
    /// Whether the motion answers to the side to which it must, at each lag: 1 or -1.
    pub sign: Vec<f64>,
    /// Sum of squares left without the channel.
    pub without: f64,
    /// Independent samples that the residuals are worth.
    pub samples: f64,
    /// Equations of the regression.
    pub rows: f64,
    /// The sums of the regression at each lag, the mean taken out, for a comparison with other runs.
    pub sums: Vec<Sums>,
    /// The same at lag 0, over the windows that a channel that is early has, and over those that a late one has.
    pub beside: [Sums; 2],
    /// Columns of the regression that belong to the channel: the first ones.
    pub own: usize,
    /// Stretches over which a rudder or a propeller keeps one value.
    pub plateaus: Vec<Plateau>,
    /// Half of the time over which the motion was smoothed to derive it \[s\]; 0 where it was recorded. It seems to begin so much before what
    /// moves it.
    pub blur: f64,
}

/// A regression at one lag: what is left, the sign of the effect.
#[derive(Clone)]
struct Solved<const N: usize> {
    left: f64,
    sign: f64,
    coefficients: SVector<f64, N>,
    sums: Sums,
}

impl Curve {
    /// Place of lag 0.
    pub fn zero(&self) -> usize {
        self.lags.iter().position(|lag| *lag == 0).unwrap_or(0)
    }

    /// The sums at lag 0.
    pub fn at_zero(&self) -> &Sums {
        &self.sums[self.zero()]
    }

    /// The sums at lag 0 over the windows of a lag.
    pub fn at_zero_beside(&self, lag: usize) -> &Sums {
        match self.lags[lag] {
            0 => self.at_zero(),
            lag if lag < 0 => &self.beside[0],
            _ => &self.beside[1],
        }
    }

    /// Place of the lag that leaves least.
    pub fn best(&self) -> usize {
        (0..self.left.len()).min_by(|i, j| self.left[*i].total_cmp(&self.left[*j])).unwrap_or(0)
    }

    /// Twice the log-likelihood ratio of one lag over another.
    pub fn evidence(&self, lag: usize, over: usize) -> f64 {
        self.samples * (self.left[over] / self.left[lag]).ln()
    }

    /// Twice the log-likelihood ratio of the channel at a lag over its absence.
    pub fn effect(&self, lag: usize) -> f64 {
        self.samples * (self.without / self.left[lag]).ln()
    }

    /// The same at no lag, negative where the motion answers to the other side: to which side the channel acts, and how surely.
    pub fn side(&self) -> f64 {
        let zero = self.zero();
        self.sign[zero] * self.effect(zero)
    }

    /// Place of a lag \[s\]; `None` where it was not tried.
    pub fn at(&self, seconds: f64) -> Option<usize> {
        (0..self.lags.len()).find(|place| (self.seconds(*place) - seconds).abs() < 0.5 * self.step)
    }

    /// A lag \[s\].
    pub fn seconds(&self, lag: usize) -> f64 {
        self.lags[lag] as f64 * self.step
    }
}

/// Running integrals of a channel over time, by the trapezoidal rule.
pub fn integral(t: &[f64], values: impl Fn(usize) -> f64) -> Vec<f64> {
    let mut sum = 0.0;
    let mut sums = Vec::with_capacity(t.len());
    for row in 0..t.len() {
        if row > 0 {
            // A missing value ends its stretch; what follows it is not compared with what was before.
            let area = 0.5 * (values(row) + values(row - 1)) * (t[row] - t[row - 1]);
            sum += if area.is_finite() { area } else { 0.0 };
        }
        sums.push(sum);
    }
    sums
}

/// The lags that are tried: every one up to 6, then in steps of a quarter.
fn lags(longest: usize) -> Vec<isize> {
    let mut lags = vec![0];
    let mut lag = 1;
    while lag <= longest {
        lags.extend([lag as isize, -(lag as isize)]);
        lag += (lag / 5).max(1);
    }
    lags.sort_unstable();
    lags
}

/// What an integral gains from step `i` over some steps, `k` steps later.
fn late(of: &[f64], i: usize, k: isize, steps: usize) -> f64 {
    of[(i + steps).wrapping_add_signed(k)] - of[i.wrapping_add_signed(k)]
}

/// Steps over which a response is integrated: half the span of the local fits, so that a gyro that is read twenty times a second does not
/// drown what a rudder does in a fifth of a second.
fn response_steps(series: &Series<'_>) -> usize {
    ((0.5 * series.span / series.step).round() as usize).max(RESPONSE_STEPS)
}

/// The rudder against the yaw: `dr/dt = a r + b r|r| + c v + d delta U^2 + e delta n|n| + f` with the mean square speed `U^2` of the run,
/// integrated over some steps in which the ship sails ahead with its propeller ahead: a rudder in a flow from astern acts to the other
/// side, or not at all.
pub fn rudder(series: &Series<'_>) -> Option<Curve> {
    let (delta, r) = (series.delta.as_deref()?, series.get(Channel::R)?);
    let (t, v, n) = (&series.t, series.get(Channel::V), series.n.as_deref());
    let of = |values: Option<&[f64]>, row: usize| values.map_or(0.0, |v| v[row]);
    let turn = integral(t, |i| r[i]);
    let square = integral(t, |i| r[i] * r[i].abs());
    let sway = integral(t, |i| of(v, i));
    let u = series.get(Channel::U);
    // The square of each row would distinguish runs as well, but within a turn it also stands for the speed that is lost there.
    let flow = u.and_then(mean_square).unwrap_or(1.0);
    let angle = integral(t, |i| delta[i] * flow);
    let force = integral(t, |i| delta[i] * of(n, i) * of(n, i).abs());
    let ahead = |row: usize| u.is_none_or(|u| u[row] > 0.0) && n.is_none_or(|n| n[row] >= 0.0);
    let steps = response_steps(series);
    let usable = |start: usize| (start..=start + steps).all(ahead);
    curve::<6, 2, 1>(series, Some(delta), usable, |i, k| {
        let over = |of: &[f64]| late(of, i, 0, steps);
        [(
            [late(&angle, i, k, steps), late(&force, i, k, steps), over(&turn), over(&square), over(&sway), over(t)],
            over(r),
        )]
    })
    .map(|curve| Curve { blur: blur(series, Channel::R), ..curve })
}

/// Half of the time over which a channel of the motion was smoothed \[s\], as a column map derives it that gives no span.
fn blur(series: &Series<'_>, channel: Channel) -> f64 {
    if series.recorded(channel).is_some() { 0.0 } else { 0.5 * DERIVE_ROWS * series.step }
}

/// The propeller against the surge: `du/dt = a n|n| + b n + c u + d u|u| + e v r + f delta^2 + g`, integrated over some steps.
pub fn propeller(series: &Series<'_>) -> Option<Curve> {
    let (n, u) = (series.n.as_deref()?, series.get(Channel::U)?);
    let t = &series.t;
    let of = |values: Option<&[f64]>, row: usize| values.map_or(0.0, |v| v[row]);
    let (v, r, delta) = (series.get(Channel::V), series.get(Channel::R), series.delta.as_deref());
    let thrust = integral(t, |i| n[i] * n[i].abs());
    let rate = integral(t, |i| n[i]);
    let (speed, square) = (integral(t, |i| u[i]), integral(t, |i| u[i] * u[i].abs()));
    let turning = integral(t, |i| of(v, i) * of(r, i));
    let drag = integral(t, |i| of(delta, i) * of(delta, i));
    let steps = response_steps(series);
    curve::<7, 2, 1>(
        series,
        Some(n),
        |_| true,
        |i, k| {
            let over = |of: &[f64]| late(of, i, 0, steps);
            let fixed = [over(&speed), over(&square), over(&turning), over(&drag), over(t)];
            [(
                [
                    late(&thrust, i, k, steps),
                    late(&rate, i, k, steps),
                    fixed[0],
                    fixed[1],
                    fixed[2],
                    fixed[3],
                    fixed[4],
                ],
                over(u),
            )]
        },
    )
    .map(|curve| Curve { blur: blur(series, Channel::U), ..curve })
}

/// The sway against the turn: `v = a r + b r|r| + c u r + d delta + e delta n|n| + f`, the mean over some steps in which the ship sails
/// ahead with its propeller ahead: the drift of a turn, which is the same at the same turn in every run.
pub fn sway(series: &Series<'_>) -> Option<Curve> {
    let (v, r, u) = (series.recorded(Channel::V)?, series.get(Channel::R)?, series.get(Channel::U)?);
    let (t, n, delta) = (&series.t, series.n.as_deref(), series.delta.as_deref());
    let of = |values: Option<&[f64]>, row: usize| values.map_or(0.0, |v| v[row]);
    let slide = integral(t, |i| v[i]);
    let turn = integral(t, |i| r[i]);
    let square = integral(t, |i| r[i] * r[i].abs());
    let centre = integral(t, |i| u[i] * r[i]);
    let angle = integral(t, |i| of(delta, i));
    let force = integral(t, |i| of(delta, i) * of(n, i) * of(n, i).abs());
    let ahead = |row: usize| u[row] > 0.0 && n.is_none_or(|n| n[row] >= 0.0);
    let steps = response_steps(series);
    let usable = |start: usize| (start..=start + steps).all(ahead);
    curve::<6, 5, 1>(series, None, usable, |i, k| {
        let over = |of: &[f64]| late(of, i, 0, steps);
        let columns = [over(&turn), over(&square), over(&centre), over(&angle), over(&force), over(t)];
        [(columns, late(&slide, i, k, steps))]
    })
}

/// The yaw rate against the heading: `d psi/dt = a r + b`.
pub fn gyro(series: &Series<'_>) -> Option<Curve> {
    let (psi, r, t) = (series.get(Channel::Psi)?, series.recorded(Channel::R)?, &series.t);
    let (turn, steps) = (integral(t, |i| r[i]), response_steps(series));
    curve::<2, 1, 1>(
        series,
        None,
        |_| true,
        |i, k| [([late(&turn, i, k, steps), late(t, i, 0, steps)], late(psi, i, 0, steps))],
    )
}

/// The position against velocity and heading: `d(x, y)/dt = a (u, v turned by psi) + (b, c)`.
pub fn receiver(series: &Series<'_>) -> Option<Curve> {
    let [x, y, psi] = [Channel::X, Channel::Y, Channel::Psi].map(|c| series.get(c));
    let (x, y, psi) = (x?, y?, psi?);
    let (u, v) = (series.recorded(Channel::U)?, series.recorded(Channel::V)?);
    let t = &series.t;
    let north = integral(t, |i| u[i] * psi[i].cos() - v[i] * psi[i].sin());
    let east = integral(t, |i| u[i] * psi[i].sin() + v[i] * psi[i].cos());
    let steps = response_steps(series);
    curve::<3, 1, 2>(
        series,
        None,
        |_| true,
        |i, k| {
            let (h, n, e) = (late(t, i, 0, steps), late(&north, i, 0, steps), late(&east, i, 0, steps));
            [([n, h, 0.0], late(x, i, k, steps)), ([e, 0.0, h], late(y, i, k, steps))]
        },
    )
}

/// The curve of a regression on `N` columns, the first `P` of which belong to the channel, with `E` equations a row, over the windows
/// that are `usable` by their first row.
///
/// A lag has the windows that every lag of its sign has, and is compared with lag 0 over the same: how a ship starts from rest is in
/// the first rows, where a late channel still has its value.
fn curve<const N: usize, const P: usize, const E: usize>(
    series: &Series<'_>,
    actuator: Option<&[f64]>,
    usable: impl Fn(usize) -> bool,
    equations: impl Fn(usize, isize) -> [([f64; N], f64); E],
) -> Option<Curve> {
    let rows: usize = series.stretches.iter().map(ExactSizeIterator::len).max()?;
    let longest = ((LAG_LONGEST.0 * rows as f64) as usize).min((LAG_LONGEST.1 / series.step) as usize);
    let lags = lags(longest);
    let reach = lags.last().map_or(0, |lag| lag.unsigned_abs());
    let steps = response_steps(series);
    let windows = |before: usize, after: usize| {
        let inner = |s: &Range<usize>| s.start + before..s.end.saturating_sub(after + steps);
        let every = series.stretches.iter().flat_map(|s| inner(s).step_by(steps / 2));
        every.filter(|start| usable(*start)).collect::<Vec<usize>>()
    };
    let [early, whole, late] = [windows(reach, 0), windows(0, 0), windows(0, reach)];
    if longest < 2 || early.len().min(late.len()) < 2 * N || whole.len() < 4 * N {
        return None;
    }
    let of_sign = |lag: isize| if lag < 0 { &early } else { &late };
    let solve = |starts: &[usize], lag: isize| normal::<N, P, E>(starts, lag, &equations);
    let (zero, without) = solve(&whole, 0)?;
    let (before, after) = (solve(&early, 0)?.0, solve(&late, 0)?.0);
    let mut solved: Vec<Solved<N>> = Vec::with_capacity(lags.len());
    for lag in &lags {
        let mut one = if *lag == 0 { zero.clone() } else { solve(of_sign(*lag), *lag)?.0 };
        if *lag != 0 {
            // As many squares as there are at lag 0 over all windows.
            one.left *= zero.left / if *lag < 0 { before.left } else { after.left };
        }
        solved.push(one);
    }
    let best = (0..lags.len()).min_by(|i, j| solved[*i].left.total_cmp(&solved[*j].left))?;
    let starts = if lags[best] == 0 { &whole } else { of_sign(lags[best]) };
    let correlation = likeness(
        starts,
        |i, e| {
            let (columns, y) = equations(i, lags[best])[e];
            y - SVector::from(columns).dot(&solved[best].coefficients)
        },
        E,
        steps,
    );
    let samples = whole.len() as f64 * (1.0 - correlation) / (1.0 + correlation);
    let (left, sign) = solved.iter().map(|s| (s.left, s.sign)).unzip();
    let sums = solved.into_iter().map(|s| s.sums).collect();
    let rows = (E * whole.len()) as f64;
    let beside = [before.sums, after.sums];
    let of_windows = |starts: &[usize]| Some(Gathered::new(starts, 0, &equations)?.whole());
    let plateaus = actuator.map_or_else(Vec::new, |values| plateaus(series, values, &whole, steps, of_windows));
    let step = series.step;
    Some(Curve { step, lags, left, sign, without, samples, rows, sums, beside, own: P, plateaus, blur: 0.0 })
}

/// Correlation of the residuals of successive windows of some steps, of so many equations each: they are worth as many independent ones as it leaves.
fn likeness(starts: &[usize], residual: impl Fn(usize, usize) -> f64, equations: usize, steps: usize) -> f64 {
    let (mut squares, mut products) = (0.0, 0.0);
    for pair in starts.windows(2).filter(|p| p[1] - p[0] == steps / 2) {
        for e in 0..equations {
            let (a, b) = (residual(pair[0], e), residual(pair[1], e));
            squares += 0.5 * (a * a + b * b);
            products += a * b;
        }
    }
    if squares > 0.0 { (products / squares).clamp(0.0, 0.99) } else { 0.0 }
}

/// The regression at one lag, and what is left without the channel. `None` where nothing moves.
fn normal<const N: usize, const P: usize, const E: usize>(
    starts: &[usize],
    lag: isize,
    equations: &impl Fn(usize, isize) -> [([f64; N], f64); E],
) -> Option<(Solved<N>, f64)> {
    let gathered = Gathered::new(starts, lag, equations)?;
    let Gathered { a, b, squares, sums, count } = &gathered;
    // Columns of one size; a little is added to the diagonal, since columns may be alike (a propeller at one rate) or nothing.
    let scale = a.diagonal().map(|d| if d > 0.0 { d.sqrt().recip() } else { 0.0 });
    let scaled =
        SMatrix::<f64, N, N>::from_fn(|i, j| a[(i, j)] * scale[i] * scale[j] + f64::from(u8::from(i == j)) * 1e-9);
    let right = b.component_mul(&scale);
    let full = scaled.cholesky()?.solve(&right);
    let rounding = 1e-12 * squares;
    let left = (squares - full.dot(&right)).max(rounding);
    let mut reduced = scaled;
    let mut rest = right;
    for p in 0..P {
        rest[p] = 0.0;
        for j in 0..N {
            let own = f64::from(u8::from(p == j));
            (reduced[(p, j)], reduced[(j, p)]) = (own, own);
        }
    }
    let without = (squares - reduced.cholesky()?.solve(&rest).dot(&rest)).max(rounding);
    let coefficients = full.component_mul(&scale);
    let together = |j: usize| a[(j, 0)] - sums[j] * sums[0] / count;
    let sign = (0..P).map(|j| coefficients[j] * together(j)).sum::<f64>().signum();
    Some((Solved { left, sign, coefficients, sums: gathered.centred() }, without))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::Recording;
    use crate::recording::audit::example::noise;
    use crate::recording::audit::limits::{LAG_EVIDENCE, SIGN_EVIDENCE};

    /// A ship that gathers way under a propeller that turns faster in the fourth row, and is recorded so many rows late.
    fn gathering(seed: u32, late: usize) -> Curve {
        let mut noise = noise(seed);
        let (mut u, mut speeds) = (1.0_f64, Vec::new());
        let n: Vec<f64> = (0..120_usize).map(|i| if i < 3 { 0.5 } else { 2.0 }).collect();
        for n in &n {
            speeds.push(u + 0.02 * noise());
            u += 2.0 * (0.03 * n * n - 0.01 * u * u);
        }
        let recorded = (0..120).map(|i: usize| n[i.saturating_sub(late)]).collect();
        let t = (0..120).map(|i| 2.0 * f64::from(i)).collect();
        let columns = vec![(Channel::T, t), (Channel::U, speeds), (Channel::N, recorded)];
        propeller(&Series::from(&Recording::from_channels("run", columns).unwrap())).unwrap()
    }

    #[test]
    fn a_rudder_shows_its_side_however_often_a_noisy_gyro_is_read() {
        for step in [0.05, 0.5] {
            let mut noise = noise(3);
            let rows = (120.0 / step) as usize;
            let delta: Vec<f64> = (0..rows).map(|i| [0.35, -0.35][(i as f64 * step / 8.0) as usize % 2]).collect();
            let (mut r, mut rates) = (0.0_f64, Vec::new());
            for delta in &delta {
                rates.push(r + 0.045 * noise());
                r += step * (0.1 * delta - 0.3 * r);
            }
            let t = (0..rows).map(|i| step * i as f64).collect();
            let columns = vec![(Channel::T, t), (Channel::R, rates), (Channel::Delta, delta)];
            let curve = rudder(&Series::from(&Recording::from_channels("run", columns).unwrap())).unwrap();
            let (effect, sign) = (curve.effect(curve.zero()), curve.sign[curve.zero()]);
            assert!(effect > SIGN_EVIDENCE && sign > 0.0, "{step}: {effect} {sign}");
        }
    }

    #[test]
    fn a_channel_that_acts_in_the_first_rows_alone_shows_how_late_it_is() {
        for seed in 1..6 {
            for late in [3, 6] {
                let curve = gathering(seed, late);
                let (best, zero) = (curve.best(), curve.zero());
                assert!(curve.lags[best].abs_diff(late as isize) <= 1, "{seed} {late}: {}", curve.lags[best]);
                assert!(curve.evidence(best, zero) > LAG_EVIDENCE, "{seed} {late}: {}", curve.evidence(best, zero));
            }
            // A sound one is explained better by another lag only by chance, not significantly.
            let sound = gathering(seed, 0);
            assert!(sound.evidence(sound.best(), sound.zero()) < LAG_EVIDENCE, "{seed}");
        }
    }
}
