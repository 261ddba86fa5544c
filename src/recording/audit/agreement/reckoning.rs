//! Dead reckoning, one run against all others: whether velocity and heading lead to the recorded track as they do in the other runs.
//! A sway velocity of another sign or unit shows here, and a track that jumps or runs late; how fast the track runs is in `signs`.

use crate::numerals::sig;
use crate::recording::Channel;
use crate::recording::audit::issue::{Issue, Severity, Shared};
use crate::recording::audit::limits::{
    POOLED_RUNS, RECKONED_EVIDENCE, RECKONED_LEAVES, RECKONED_LENGTH, RECKONED_ROWS, RECKONED_UNLIKE, RECKONED_UNUSUAL,
};
use crate::recording::audit::motion::pooled::coefficients;
use crate::recording::audit::motion::response::integral;
use crate::recording::audit::motion::series::Series;
use crate::recording::audit::motion::sources::Sources;
use crate::recording::audit::motion::sums::Sums;
use crate::statistics::median;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Columns of the regression: sway, surge, drift to the side of the surge by a heading that is offset, and a lever forward and to
/// starboard.
const COLUMNS: usize = 5;

/// By what a sway velocity may be too large: its sign, knots, km/h.
const FACTORS: [f64; 5] = [-1.0, 1.943_844, 0.514_444, 3.6, 1.0 / 3.6];

/// Sums of the regression of a run's track on dead reckoning,
/// `(x, y) = (x0, y0) + a int v (-sin psi, cos psi) dt + b int u (cos psi, sin psi) dt + c int u (-sin psi, cos psi) dt + R(psi) (d, e)`,
/// by stretches, each with a start of its own.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Reckoned {
    /// Products of a row with itself.
    sums: Sums,
    /// Products of a row with the next, for the correlation of the residuals.
    next: Sums,
    /// Equations, two a row.
    rows: f64,
}

impl Reckoned {
    /// That of some rows; `None` where a channel was not recorded, or for few rows.
    pub fn of(series: &Series<'_>) -> Option<Self> {
        let [x, y, psi] = [Channel::X, Channel::Y, Channel::Psi].map(|c| series.recorded(c));
        let [u, v] = [Channel::U, Channel::V].map(|c| series.recorded(c));
        let (position, psi, u, v) = ([x?, y?], psi?, u?, v?);
        let t = &series.t;
        let (ahead, abeam) = (|i: usize| [psi[i].cos(), psi[i].sin()], |i: usize| [-psi[i].sin(), psi[i].cos()]);
        let along = |e: usize| {
            let [sway, surge] = [integral(t, |i| v[i] * abeam(i)[e]), integral(t, |i| u[i] * ahead(i)[e])];
            [sway, surge, integral(t, |i| u[i] * abeam(i)[e])]
        };
        let integrals = [along(0), along(1)];
        let row = |e: usize, i: usize| {
            let [sway, surge, aside] = &integrals[e];
            ([sway[i], surge[i], aside[i], ahead(i)[e], abeam(i)[e]], position[e][i])
        };
        let mut one = Self::default();
        one.sums = Sums { columns: vec![0.0; COLUMNS * COLUMNS], response: vec![0.0; COLUMNS], squares: 0.0 };
        one.next = one.sums.clone();
        for stretch in &series.stretches {
            (0..2).for_each(|e| one.add(stretch, |i| row(e, i)));
        }
        (one.rows >= RECKONED_ROWS).then_some(one)
    }

    /// Adds one coordinate over a stretch, less its mean.
    fn add(&mut self, stretch: &Range<usize>, row: impl Fn(usize) -> ([f64; COLUMNS], f64)) {
        let finite = |(columns, p): &([f64; COLUMNS], f64)| p.is_finite() && columns.iter().all(|c| c.is_finite());
        let (mut mean, mut place, mut count) = ([0.0; COLUMNS], 0.0, 0.0);
        for (columns, p) in stretch.clone().map(&row).filter(finite) {
            mean.iter_mut().zip(columns).for_each(|(m, c)| *m += c);
            place += p;
            count += 1.0;
        }
        let centred = |(columns, p): ([f64; COLUMNS], f64)| {
            (std::array::from_fn::<f64, COLUMNS, _>(|c| columns[c] - mean[c] / count), p - place / count)
        };
        let mut before: Option<([f64; COLUMNS], f64)> = None;
        for now in stretch.clone().map(&row) {
            let now = finite(&now).then(|| centred(now));
            if let Some(now) = &now {
                add(&mut self.sums, now, now);
            }
            if let (Some(before), Some(now)) = (&before, &now) {
                add(&mut self.next, before, now);
            }
            before = now;
        }
        self.rows += count;
    }

    /// Mean square that coefficients leave \[m2\].
    fn mean_square(&self, coefficients: &[f64]) -> f64 {
        self.sums.left(coefficients) / self.rows
    }

    /// Independent samples that the residuals which coefficients leave are worth.
    fn samples(&self, coefficients: &[f64]) -> f64 {
        let left = self.sums.left(coefficients);
        let likeness = if left > 0.0 { (self.next.left(coefficients) / left).clamp(0.0, 0.99) } else { 0.0 };
        self.rows * (1.0 - likeness) / (1.0 + likeness)
    }
}

/// Adds the products of two rows, half of each with the other.
fn add(sums: &mut Sums, (a, x): &([f64; COLUMNS], f64), (b, y): &([f64; COLUMNS], f64)) {
    for i in 0..COLUMNS {
        for j in 0..COLUMNS {
            sums.columns[COLUMNS * i + j] += 0.5 * (a[i] * b[j] + b[i] * a[j]);
        }
        sums.response[i] += 0.5 * (a[i] * y + b[i] * x);
    }
    sums.squares += x * y;
}

/// Runs whose dead reckoning leads elsewhere than in the other runs, in terms of what these leave, for a ship of some length \[m\].
pub fn reckoned(known: &[(&str, &Reckoned)], sources: &Sources, length: f64) -> Vec<Shared> {
    if known.len() < POOLED_RUNS {
        return Vec::new();
    }
    let all = vec![true; known.len()];
    let Some((others, usual)) = pooled(known, &all) else { return Vec::new() };
    // A run that is far off would distort the coefficients for all others.
    let near: Vec<bool> = known
        .iter()
        .zip(&others)
        .map(|((_, one), others)| others.as_ref().is_some_and(|o| one.mean_square(o) < RECKONED_UNUSUAL * usual))
        .collect();
    let Some((others, usual)) = pooled(known, &near) else { return Vec::new() };
    let doubt_of = |place: usize| {
        let ((run, one), others) = (known[place], others[place].as_deref()?);
        let in_all = |factor: f64| {
            let own = divided(others, factor);
            sources.agree(place, |other| Some([others, &own].map(|c| known[other].1.sums.left(c))))
        };
        let issue = judged(one, others, usual, length, in_all)?;
        Some(Shared { runs: vec![run.to_owned()], issue })
    };
    (0..known.len()).filter_map(doubt_of).collect()
}

/// For each run the coefficients of the others among those that count, each as much as any other, and the median of the mean squares
/// \[m2\] that they leave of these.
fn pooled(known: &[(&str, &Reckoned)], counts: &[bool]) -> Option<(Vec<Option<Vec<f64>>>, f64)> {
    let share = |one: &Reckoned| Sums {
        columns: one.sums.columns.iter().map(|c| c / one.rows).collect(),
        response: one.sums.response.iter().map(|b| b / one.rows).collect(),
        squares: one.sums.squares / one.rows,
    };
    let mut total = Sums { columns: vec![0.0; COLUMNS * COLUMNS], response: vec![0.0; COLUMNS], squares: 0.0 };
    let kept = || known.iter().zip(counts).filter(|(_, counts)| **counts);
    kept().for_each(|((_, one), _)| total.add(&share(one)));
    let of =
        |((_, one), counts): (&(&str, &Reckoned), &bool)| coefficients(&total, counts.then(|| share(one)).as_ref());
    let others: Vec<Option<Vec<f64>>> = known.iter().zip(counts).map(of).collect();
    let left = known.iter().zip(&others).zip(counts).filter(|(_, counts)| **counts);
    let usual = median(left.filter_map(|(((_, one), others), _)| Some(one.mean_square(others.as_ref()?))))?;
    (kept().count() >= POOLED_RUNS && usual > 0.0).then_some((others, usual))
}

/// Coefficients for a sway that is recorded so many times too large.
fn divided(others: &[f64], factor: f64) -> Vec<f64> {
    let mut own = others.to_vec();
    own[0] /= factor;
    own
}

/// The doubt about a run of a ship of some length \[m\], given the coefficients of the others and the mean square \[m2\] that they usually
/// leave; `in_all` says whether all runs of its recording agree on a factor of the sway.
fn judged(one: &Reckoned, others: &[f64], usual: f64, length: f64, in_all: impl Fn(f64) -> bool) -> Option<Issue> {
    let as_it_is = one.mean_square(others);
    if as_it_is < RECKONED_UNUSUAL * usual {
        return None;
    }
    let with = |factor: f64| {
        let own = divided(others, factor);
        (one.mean_square(&own), one.samples(&own), factor)
    };
    let best = FACTORS.into_iter().map(with).min_by(|a, b| a.0.total_cmp(&b.0));
    if let Some((left, samples, factor)) = best {
        let evidence = samples * (as_it_is / left.max(0.25 * usual)).ln();
        if left < RECKONED_LEAVES * as_it_is
            && left < RECKONED_UNUSUAL * usual
            && evidence > RECKONED_EVIDENCE
            && in_all(factor)
        {
            return Some(scaled(factor));
        }
    }
    let text = format!(
        "track and dead reckoning by velocity and heading part by {} m (root mean square), {} times as much as in the other runs",
        sig(as_it_is.sqrt(), 2),
        sig((as_it_is / usual).sqrt(), 2)
    );
    let next =
        "look for a jump, a wrong unit or a late clock in x, y, psi, u and v of this run (`trimtab help columns`)";
    (as_it_is > RECKONED_UNLIKE * usual && as_it_is.sqrt() > RECKONED_LENGTH * length)
        .then(|| Issue::new(Severity::Warning, "disagreement", text, next).of(Channel::X))
}

/// The doubt about a sway velocity that is recorded so many times too large.
fn scaled(factor: f64) -> Issue {
    let map = "for `v` in a column map of this run";
    let (fault, text, next) = if factor < 0.0 {
        let text = "leads dead reckoning to the other side of the track than in the other runs".to_owned();
        ("sign_error", text, format!("is its sign that of the other runs? set `sign = -1` {map}"))
    } else {
        let text = format!("leads along the track only if it is recorded {} times too large", sig(factor, 3));
        ("unit_error", text, format!("is its unit that of the other runs? set `unit`, or `scale`, {map}"))
    };
    Issue::new(Severity::Warning, fault, text, next).of(Channel::V)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::Recording;
    use crate::recording::audit::example::noise;

    /// What a run records of a ship of some speed \[m/s\] that weaves and slides: `change` may damage the columns x, y, psi, u, v.
    fn run(seed: u32, speed: f64, change: impl Fn(&mut [Vec<f64>; 5])) -> Reckoned {
        let mut noise = noise(seed);
        let mut columns: [Vec<f64>; 5] = Default::default();
        let mut at = [0.0, 0.0];
        let step = 8.0 / speed;
        for i in 0..160 {
            let phase = f64::from(i) * (0.04 + 0.003 * f64::from(seed % 7));
            let (psi, u) = (0.4 * phase.sin() + f64::from(seed), speed * (1.0 + 0.05 * phase.cos()));
            let v = -0.06 * speed * phase.cos() + 0.01 * speed;
            let row =
                [at[0] + 4.0 * noise(), at[1] + 4.0 * noise(), psi + 2e-3 * noise(), u, v + 0.01 * speed * noise()];
            columns.iter_mut().zip(row).for_each(|(c, value)| c.push(value));
            at[0] += step * (u * psi.cos() - v * psi.sin());
            at[1] += step * (u * psi.sin() + v * psi.cos());
        }
        change(&mut columns);
        let names = [Channel::X, Channel::Y, Channel::Psi, Channel::U, Channel::V];
        let t = (0..160).map(|i| step * f64::from(i)).collect();
        let all = names.into_iter().zip(columns).chain([(Channel::T, t)]).collect();
        Reckoned::of(&Series::from(&Recording::from_channels("run", all).unwrap())).unwrap()
    }

    fn doubts(runs: &[(String, Reckoned)], speed: f64) -> Vec<Shared> {
        let known: Vec<(&str, &Reckoned)> = runs.iter().map(|(name, one)| (name.as_str(), one)).collect();
        reckoned(&known, &Sources::of(0..runs.len()), 85.0 * speed / 4.0)
    }

    /// The doubts about nine runs of a ship, of which the first is damaged.
    fn study(speed: f64, change: impl Fn(&mut [Vec<f64>; 5])) -> Vec<Shared> {
        let runs: Vec<(String, Reckoned)> = (0..9)
            .map(|i| (format!("r{i}"), if i == 0 { run(1, speed, &change) } else { run(i + 1, speed, |_| ()) }))
            .collect();
        doubts(&runs, speed)
    }

    #[test]
    fn sound_runs_of_a_fast_ship_and_of_a_slow_model_raise_no_doubt() {
        for speed in [8.0, 4.0, 0.5] {
            assert_eq!(study(speed, |_| ()), [], "{speed}");
            // A compass that is offset in every run is an offset in every run.
            let offset: Vec<(String, Reckoned)> = (0..9)
                .map(|i| (format!("r{i}"), run(i + 1, speed, |c| c[2].iter_mut().for_each(|psi| *psi += 0.05))))
                .collect();
            assert_eq!(doubts(&offset, speed), []);
        }
    }

    #[test]
    fn a_sway_of_another_sign_or_unit_is_reported_in_its_run_alone() {
        for speed in [8.0, 4.0, 0.5] {
            for (factor, fault) in [(-1.0, "sign_error"), (1.943_844, "unit_error"), (1.0 / 3.6, "unit_error")] {
                let found = study(speed, |c| c[4].iter_mut().for_each(|v| *v *= factor));
                assert!(found.len() == 1 && found[0].runs == ["r0"], "{speed} {factor}: {found:?}");
                assert_eq!((found[0].issue.fault, found[0].issue.channel), (fault, Some(Channel::V)));
            }
        }
    }

    #[test]
    fn a_track_that_jumps_or_is_late_or_in_another_unit_disagrees() {
        let jumps = |c: &mut [Vec<f64>; 5]| c[0][80..].iter_mut().for_each(|x| *x += 25.0);
        let late = |c: &mut [Vec<f64>; 5]| {
            c[1].rotate_right(8);
            let first = c[1][8];
            c[1][..8].fill(first);
        };
        let feet = |c: &mut [Vec<f64>; 5]| c[0].iter_mut().for_each(|x| *x *= 0.3048);
        for (name, found) in [("jumps", study(4.0, jumps)), ("late", study(4.0, late)), ("feet", study(4.0, feet))] {
            assert!(found.len() == 1 && found[0].runs == ["r0"], "{name}: {found:?}");
            assert_eq!((found[0].issue.fault, found[0].issue.channel), ("disagreement", Some(Channel::X)), "{name}");
        }
    }
}
