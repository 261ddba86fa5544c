//! Repeated values: a channel that keeps its value to the last digit, where by chance it never does.
//! Coarse channels repeat; stretches that contradict other channels are in `frozen`. Rudder and propeller often stay at one value, and are
//! tested only where they never do so in the rest of the run, and leap from the value at its end.

use crate::recording::audit::issue::{Issue, Severity, Shared};
use crate::recording::audit::limits::{
    HELD_BESIDE, HELD_CHANCE, HELD_CHANGES, HELD_DIGITS, HELD_LEAP, HELD_REST, HELD_ROWS, HELD_ROWS_MOVING, HELD_SAME,
    HELD_SELDOM, HELD_STEPS,
};
use crate::recording::audit::motion::series::{changes, constant};
use crate::recording::{Channel, Recording, STATE_CHANNELS};
use crate::statistics::median;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// What moves the ship.
const ACTUATORS: [Channel; 2] = [Channel::Delta, Channel::N];

/// What a channel repeats in a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Repeats {
    channel: Channel,
    /// Successive rows of which both have a value.
    pairs: usize,
    /// Those that repeat a value.
    repeated: usize,
    /// The longest stretch of at least [`HELD_ROWS`] rows of one value.
    held: Option<Hold>,
}

/// A stretch of one value while the other channels move.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Hold {
    /// Its rows.
    rows: usize,
    /// First and last line.
    lines: (usize, usize),
    /// Whether the run begins with it.
    first: bool,
    /// The value and its unit.
    value: String,
    /// Chance of a repetition by the resolution of the channel.
    coarse: f64,
    /// Whether the channel comes to the value as it moves, and leaps from it.
    leaps: bool,
}

impl Repeats {
    /// Pairs that repeat a value, less those of the longest stretch if `held`.
    fn elsewhere(&self, held: bool) -> f64 {
        let longest = self.held.as_ref().filter(|_| held).map_or(0, |h| h.rows - 1);
        (self.repeated - longest) as f64
    }

    /// Whether the run begins with its longest stretch.
    fn at_first(&self) -> bool {
        self.held.as_ref().is_some_and(|h| h.first)
    }
}

/// What every channel of the motion, the rudder and the propeller repeat in a recording.
pub fn repeats(recording: &Recording) -> Vec<Repeats> {
    let recorded = |c: &Channel| recording.has(*c) && !recording.derived().contains(c);
    let state: Vec<Channel> = STATE_CHANNELS.into_iter().filter(recorded).collect();
    let all = state.iter().chain(&ACTUATORS);
    all.filter_map(|channel| of_channel(recording, *channel, &state)).collect()
}

fn of_channel(recording: &Recording, channel: Channel, state: &[Channel]) -> Option<Repeats> {
    let values = recording.get(channel)?;
    let segments = recording.segments();
    let stretches: Vec<Range<usize>> = segments.iter().flat_map(|s| constant(values, s.clone())).collect();
    let changes: Vec<f64> = changes(values, &stretches).collect();
    let others: Vec<&[f64]> = state.iter().filter(|c| **c != channel).filter_map(|c| recording.get(*c)).collect();
    let partner = match channel {
        Channel::Psi => recording.get(Channel::R),
        Channel::R => recording.get(Channel::Psi),
        _ => None,
    };
    // Where a ship that is simulated without noise sails straight on, or a model is not yet released, several channels stand still at a
    // time, at 0.
    let alone = |rows: &Range<usize>| {
        let moves = |of: &&[f64], row: usize| of[row] != of[row - 1];
        let most = |row: usize| others.iter().filter(|o| moves(o, row)).count() + 1 >= others.len().max(3);
        values[rows.start] != 0.0
            && Range::clone(rows).skip(1).all(|row| most(row) && partner.is_none_or(|p| moves(&p, row)))
    };
    let factor = channel.info().quantity.factor(recording.unit(channel)).unwrap_or(1.0);
    let resolution = digits(values, factor).max(steps(&changes));
    let typical = median(changes.iter().copied()).unwrap_or(0.0);
    let hold = |(at, rows): (usize, &Range<usize>)| Hold {
        rows: rows.len(),
        lines: (recording.line(rows.start), recording.line(rows.end - 1)),
        first: rows.start == 0,
        value: format!("{:.4} {}", values[rows.start] / factor, recording.unit(channel)),
        coarse: coarse(resolution, change_beside(values, &stretches, at), typical),
        leaps: leaps(values, &stretches, at),
    };
    let long = stretches.iter().enumerate().filter(|(_, rows)| rows.len() >= HELD_ROWS && alone(rows));
    Some(Repeats {
        channel,
        pairs: segments.iter().map(|s| s.len() - 1).sum(),
        repeated: stretches.iter().map(|s| s.len() - 1).sum(),
        held: long.max_by_key(|(_, rows)| rows.len()).map(hold),
    })
}

/// The last digit with which values are written in a unit of that factor; 0 where they have more than [`HELD_DIGITS`] decimals.
fn digits(values: &[f64], factor: f64) -> f64 {
    let written = |power: &f64| {
        // A small value is no multiple of a digit that it does not reach.
        let whole = |v: &f64| {
            let steps = v / factor * power;
            (steps - steps.round()).abs() < HELD_SAME && (*v == 0.0 || steps.round() != 0.0)
        };
        values.iter().filter(|v| v.is_finite()).all(whole)
    };
    let mut powers = (0..=HELD_DIGITS).map(|d| 10_f64.powi(d));
    powers.find(written).map_or(0.0, |power| factor.abs() / power)
}

/// The step of a sensor: the smallest change, where all that are not much larger are its multiples; else 0.
fn steps(changes: &[f64]) -> f64 {
    let Some(least) = changes.iter().copied().reduce(f64::min) else { return 0.0 };
    let multiple = |c: &f64| (c / least - (c / least).round()).abs() < HELD_SAME;
    if changes.iter().filter(|c| **c < HELD_CHANGES * least).all(multiple) { least } else { 0.0 }
}

/// Chance of a repetition: of two values with normal noise, whose difference is `1.48 change` in standard deviation, it is
/// `resolution / (1.48 sqrt(2 pi) change)`. Where the channel moves before or after it by few steps, or by much less than it does in the run,
/// it may stand still as it turns, or before it starts.
fn coarse(resolution: f64, change: f64, typical: f64) -> f64 {
    let rests = change < HELD_STEPS * resolution || change < HELD_REST * typical;
    if rests { 1.0 } else { 0.27 * resolution / change.max(f64::MIN_POSITIVE) }
}

/// Median change from value to value before or after stretch `at`, the smaller one: motion dies away before it stands still.
fn change_beside(values: &[f64], stretches: &[Range<usize>], at: usize) -> f64 {
    let change = |near: &[Range<usize>]| median(changes(values, near));
    let (before, after) = (
        change(&stretches[at.saturating_sub(HELD_BESIDE)..=at]),
        change(&stretches[at..(at + 1 + HELD_BESIDE).min(stretches.len())]),
    );
    before.into_iter().chain(after).reduce(f64::min).unwrap_or(0.0)
}

/// Whether a channel leaps from the value of stretch `at` by many times what brought it there: gear stays where it was moved to.
fn leaps(values: &[f64], stretches: &[Range<usize>], at: usize) -> bool {
    let step = |i: usize| (values[stretches[i].start] - values[stretches[i - 1].start]).abs();
    let before = (1..=at).rev().take(HELD_BESIDE).map(step).fold(0.0, f64::max);
    at > 0 && at + 1 < stretches.len() && step(at + 1) > HELD_LEAP * before
}

/// The repeated values of each run, one doubt a run and channel: by chance there is one in less than one study of [`HELD_CHANCE`].
pub fn held(runs: &[(&str, &[Repeats])]) -> Vec<Shared> {
    let mut found = Vec::new();
    for (run, repeats) in runs {
        for one in *repeats {
            let by_nature = ACTUATORS.contains(&one.channel);
            let comparable = |r: &&Repeats| r.channel == one.channel && (!by_nature || std::ptr::eq(*r, one));
            let all: Vec<&Repeats> = runs.iter().flat_map(|(_, r)| *r).filter(comparable).collect();
            if let Some(issue) = doubt(one, &all) {
                found.push(Shared { runs: vec![(*run).to_owned()], issue });
            }
        }
    }
    found
}

/// The doubt about a channel of one run, with what it repeats in all runs: a late channel may begin each of them with one value.
fn doubt(one: &Repeats, all: &[&Repeats]) -> Option<Issue> {
    let hold = one.held.as_ref().filter(|h| h.leaps || !ACTUATORS.contains(&one.channel))?;
    // A lag is the same in all runs; the time until a model is released is not.
    let other = |r: &&&Repeats| r.held.as_ref().is_some_and(|h| h.first && h.rows != hold.rows);
    if hold.first && all.iter().any(|r| other(&r)) {
        return None;
    }
    let pairs = all.iter().map(|r| r.pairs).sum::<usize>() as f64;
    let known = |r: &&&Repeats| std::ptr::eq(**r, one) || (hold.first && r.at_first());
    let elsewhere: f64 = all.iter().map(|r| r.elsewhere(known(&r))).sum();
    let chance = (elsewhere + 1.0) / pairs;
    let by_chance = pairs * chance.max(hold.coarse).powf(hold.rows as f64 - 1.0) >= 1.0 / HELD_CHANCE;
    let seldom = chance < HELD_SELDOM && one.elsewhere(true) < HELD_SELDOM * one.pairs as f64;
    if by_chance || !seldom || one.pairs - one.repeated < HELD_ROWS_MOVING {
        return None;
    }
    let text = format!(
        "keeps the value {} over {} rows (lines {} to {}), but elsewhere changes from row to row",
        hold.value, hold.rows, hold.lines.0, hold.lines.1
    );
    let blank = "leave the fields blank, so that it counts as a dropout";
    let next = if hold.first {
        format!("the run begins with it: if the channel is late, `delay` in a column map takes it back; else {blank}")
    } else {
        blank.to_owned()
    };
    Some(Issue::new(Severity::Warning, "frozen", text, next).of(one.channel).at(hold.lines))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::audit::example::noise;

    /// A run with noise in every channel, to four digits; `change` may damage channel r.
    fn run(seed: u32, digits: f64, change: impl Fn(&mut Vec<f64>)) -> Vec<Repeats> {
        let mut noise = noise(seed);
        let mut column = |size: f64| {
            let value = |i: u32| (size * ((f64::from(i) * 0.05).sin() + 0.3 * noise()) * digits).round() / digits;
            (0..120).map(value).collect::<Vec<f64>>()
        };
        let mut columns: Vec<(Channel, Vec<f64>)> = STATE_CHANNELS.into_iter().map(|c| (c, column(1.0))).collect();
        change(&mut columns[5].1);
        columns.push((Channel::T, (0..120).map(f64::from).collect()));
        repeats(&Recording::from_channels("run", columns).unwrap())
    }

    fn study(digits: f64, damaged: usize, change: impl Fn(&mut Vec<f64>) + Copy) -> Vec<Shared> {
        let damage = |i: u32, r: &mut Vec<f64>| {
            if (i as usize) < damaged {
                change(r)
            }
        };
        let runs: Vec<(String, Vec<Repeats>)> =
            (0..8).map(|i| (format!("r{i}"), run(i + 1, digits, |r| damage(i, r)))).collect();
        held(&runs.iter().map(|(name, r)| (name.as_str(), &r[..])).collect::<Vec<_>>())
    }

    #[test]
    fn a_sound_study_raises_no_doubt_whatever_its_digits() {
        for digits in [1e5, 1e3, 1e2, 20.0, 5.0] {
            assert_eq!(study(digits, 0, |_| ()), [], "{digits}");
        }
    }

    #[test]
    fn a_repeated_value_is_reported_in_one_run_and_in_all() {
        let late = |r: &mut Vec<f64>| (1..3).for_each(|i| r[i] = r[0]);
        let frozen = |r: &mut Vec<f64>| (40..80).for_each(|i| r[i] = r[40]);
        assert_eq!(study(1e6, 1, late)[0].runs, ["r0"]);
        // In some run the values that follow may happen to change by little.
        assert!(study(1e6, 8, late).len() >= 6);
        let found = study(1e4, 1, frozen);
        assert!(found.len() == 1 && found[0].runs == ["r0"], "{found:?}");
        assert_eq!(found[0].issue.lines, Some((42, 81)));
        assert!(study(1e6, 1, late)[0].issue.next_step.contains("`delay`"));
    }

    #[test]
    fn a_frozen_value_is_reported_wherever_it_begins() {
        // Next to some of these the channel happens to move little.
        for at in 15..75 {
            let found = study(1e4, 1, |r| (at + 1..at + 40).for_each(|i| r[i] = r[at]));
            assert!(found.len() == 1 && found[0].runs == ["r0"], "{at}: {found:?}");
        }
    }

    #[test]
    fn a_frozen_yaw_rate_of_thousandths_of_a_radian_is_reported() {
        for size in [1e-2, 1e-3, 1e-4] {
            let frozen = |r: &mut Vec<f64>| {
                r.iter_mut().for_each(|r| *r = (size * *r * 1e8).round() / 1e8);
                (41..80).for_each(|i| r[i] = r[40]);
            };
            let found = study(1e6, 1, frozen);
            assert!(found.len() == 1 && found[0].runs == ["r0"], "{size}: {found:?}");
        }
    }

    #[test]
    fn a_rudder_is_frozen_where_it_never_rests_and_leaps_and_sound_where_it_was_ordered() {
        let study = |change: &dyn Fn(&mut Vec<f64>)| {
            let mut noise = noise(9);
            // A rudder that keeps a course, and channels that move.
            let mut delta: Vec<f64> = (0..120).map(|i| 0.1 * (f64::from(i) * 0.07).sin() + 1e-3 * noise()).collect();
            change(&mut delta);
            let mut columns: Vec<(Channel, Vec<f64>)> =
                STATE_CHANNELS.into_iter().map(|c| (c, (0..120).map(|_| noise()).collect())).collect();
            columns.extend([(Channel::Delta, delta), (Channel::T, (0..120).map(f64::from).collect())]);
            let repeats = repeats(&Recording::from_channels("run", columns).unwrap());
            held(&[("a", &repeats)])
        };
        let found = study(&|d| (41..80).for_each(|i| d[i] = d[40]));
        assert!(found.len() == 1 && found[0].issue.channel == Some(Channel::Delta), "{found:?}");
        assert_eq!(study(&|_| ()), []);
        let hard_over = |d: &mut Vec<f64>| {
            let (from, to) = (d[40], d[90]);
            let gear = |i: usize| (from + 0.1 * (i as f64 - 40.0)).min(0.6).min(to + 0.1 * (90.0 - i as f64));
            (41..90).for_each(|i| d[i] = gear(i));
        };
        // Put hard over at the limit of the gear, and eased as fast.
        assert_eq!(study(&|d| hard_over(d)), []);
        // A zigzag keeps its angles.
        assert_eq!(study(&|d| d.iter_mut().enumerate().for_each(|(i, d)| *d = [0.17, -0.17][(i / 20) % 2])), []);
    }

    #[test]
    fn motion_that_dies_away_to_its_last_digit_is_no_doubt() {
        let settles = |r: &mut Vec<f64>| {
            r.iter_mut().enumerate().for_each(|(i, r)| *r = ((-0.08 * i as f64).exp() * 1e3).round() / 1e3);
        };
        assert_eq!(study(1e4, 1, settles), []);
    }
}
