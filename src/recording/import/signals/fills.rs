//! Numbers that stand for a missing value: -999 amid rudder angles, 511 amid headings, 102.3 amid speeds, 0 in every other row.
//! They are taken out before any unit is determined from the values, and are reported.

use super::log::{Column, Meaning};
use super::signal::median;
use crate::recording::{Channel, usual_fill};

/// A fill value is further from all others than their range, this many times.
const APART: f64 = 3.0;
/// The same for numbers that nobody writes for anything else.
const APART_USUAL: f64 = 1.0;
/// A leap to 360 is no turn from this angle on \[deg\], and from so many usual steps.
const LEAP: f64 = 10.0;
const LEAPS: f64 = 10.0;
/// A zero stands for a missing value where so often the column is at it for no longer than this time \[s\] and comes back to within this
/// share of what it was: no rudder, engine or ship does.
const RETURNS: usize = 8;
const RETURNS_WITHIN: f64 = 2.5;
const RETURNS_TO: f64 = 0.5;
/// Kinds of fill values that one column may have.
const KINDS: usize = 3;

/// Takes the fill values of a column out; gives each with its number.
pub fn take_out(column: &mut Column, meaning: Option<Meaning>) -> Vec<(f64, usize)> {
    let mut found = Vec::new();
    while found.len() < KINDS
        && let Some(fill) = fill(&column.v, meaning)
            .or_else(|| north_without_a_course(&column.v, meaning))
            .or_else(|| zero_between_rows(column, meaning).filter(|_| found.iter().all(|(fill, _)| *fill != 0.0)))
    {
        let kept = if fill == 0.0 { known(column) } else { column.v.iter().map(|v| *v != fill).collect() };
        found.push((fill, kept.iter().filter(|k| !**k).count()));
        let keep = |values: &mut Vec<f64>| {
            let mut kept = kept.iter();
            values.retain(|_| kept.next().is_some_and(|k| *k));
        };
        keep(&mut column.t);
        keep(&mut column.v);
    }
    found
}

/// Whether a quantity is one that is set on board.
fn is_set(meaning: Meaning) -> bool {
    use Channel::{Command, Delta, DeltaOrder, N, NOrder};
    matches!(meaning, Meaning::Channel(Delta | DeltaOrder | N | NOrder | Command(_)))
}

/// 360 exactly, which a receiver writes for a course that it does not know: it is among the values of a direction, and is reached by leaps
/// from all sides, where north is reached from nearby.
fn north_without_a_course(values: &[f64], meaning: Option<Meaning>) -> Option<f64> {
    const FULL: f64 = 360.0;
    if !meaning.is_some_and(|m| m.wraps() && m != Meaning::Longitude)
        || values.iter().any(|v| !(0.0..=FULL).contains(v))
    {
        return None;
    }
    let apart = |a: f64, b: f64| ((a - b).abs() % FULL).min(FULL - (a - b).abs() % FULL);
    let leaps = |at_full: bool| -> Vec<f64> {
        values
            .windows(2)
            .filter(|v| (v[1] == FULL && v[0] != FULL) == at_full && v[0] != FULL)
            .map(|v| apart(v[0], v[1]))
            .collect()
    };
    let (to_full, usual) = (leaps(true), leaps(false));
    let leap = median(to_full.clone()).filter(|_| to_full.len() > 1)?;
    (leap > LEAP && leap > LEAPS * median(usual)?).then_some(FULL)
}

/// Zero, which a table writes in the rows of a faster channel, or a logger where a sentence is missing: most of the times that the column is
/// zero it comes back at once to where it was.
fn zero_between_rows(column: &Column, meaning: Option<Meaning>) -> Option<f64> {
    meaning?;
    let v = &column.v;
    let near = |[before, after]: &[usize; 2]| {
        let (a, b) = (v[*before], v[*after]);
        is_between(column, [*before, *after]) && (a - b).abs() <= RETURNS_TO * a.abs().min(b.abs())
    };
    let (back, gone): (Vec<[usize; 2]>, Vec<[usize; 2]>) = around_zeros(v).into_iter().partition(near);
    (back.len() >= RETURNS && back.len() > gone.len()).then_some(0.0)
}

/// The last row before and the first after each stretch of zeros.
fn around_zeros(v: &[f64]) -> Vec<[usize; 2]> {
    let known: Vec<usize> = (0..v.len()).filter(|i| v[*i] != 0.0).collect();
    known.windows(2).filter(|pair| pair[1] - pair[0] > 1).map(|pair| [pair[0], pair[1]]).collect()
}

/// Whether zeros lie for a moment between two values of one sign.
fn is_between(Column { t, v, .. }: &Column, [before, after]: [usize; 2]) -> bool {
    t[after] - t[before] <= RETURNS_WITHIN && v[before] * v[after] > 0.0
}

/// Which rows are known where zero stands for a missing value: a rudder that comes to rest amidships, or passes through it, is at zero.
fn known(column: &Column) -> Vec<bool> {
    let mut known = vec![true; column.v.len()];
    for pair in around_zeros(&column.v).into_iter().filter(|pair| is_between(column, *pair)) {
        known[pair[0] + 1..pair[1]].fill(false);
    }
    known
}

/// The largest or the smallest value, where it stands for a missing one; the further of the two first.
fn fill(values: &[f64], meaning: Option<Meaning>) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let (low, high, middle) = (*sorted.first()?, *sorted.last()?, sorted[sorted.len() / 2]);
    let both = if high - middle > middle - low { [high, low] } else { [low, high] };
    both.into_iter().find(|candidate| stands_apart(&sorted, *candidate, meaning))
}

/// Whether a value is too far from the others, in rising order, to be one of them.
fn stands_apart(sorted: &[f64], candidate: f64, meaning: Option<Meaning>) -> bool {
    let rest: Vec<f64> = sorted.iter().copied().filter(|v| *v != candidate).collect();
    let (Some(least), Some(most)) = (rest.first().copied(), rest.last().copied()) else { return false };
    let count = sorted.len() - rest.len();
    let (apart, range) = ((candidate - most).max(least - candidate), most - least);
    if candidate == 0.0 || range <= 0.0 || count > rest.len() {
        return false;
    }
    let turns = meaning.is_some_and(Meaning::wraps) && meaning != Some(Meaning::Longitude);
    // Directions from 0 to 360, but for one other number; a heading that counts turns passes through many.
    let within = most > 7.0 && least >= 0.0 && most <= 360.0;
    let beside = turns && within && count > 1 && !(0.0..=360.0).contains(&candidate);
    // What is set, such as a propeller, may be switched from one value to another far away, and so may a column of which nothing is known.
    let moves = meaning.is_some_and(|m| !is_set(m));
    let usual = usual_fill(candidate) && apart > APART_USUAL * range;
    beside || usual || (moves && count > 1 && apart > APART * range)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn without(values: &[f64], meaning: Meaning) -> Vec<(f64, usize)> {
        let t = (0..values.len()).map(|i| i as f64).collect();
        take_out(&mut Column { t, v: values.to_vec(), ..Column::default() }, Some(meaning))
    }

    #[test]
    fn zeros_between_rows_are_missing_and_those_of_a_rudder_amidships_are_not() {
        let of = |step: f64, value: &dyn Fn(usize) -> f64| {
            let (t, v) = (0..200).map(|i| (step * i as f64, value(i))).unzip();
            take_out(&mut Column { t, v, ..Column::default() }, Some(Meaning::Channel(Channel::Delta)))
        };
        let zigzag = |i: usize| if (i / 20).is_multiple_of(2) { 10.0 } else { -10.0 };
        // A table twice as fast as the rudder, and a sentence that is lost now and then.
        assert_eq!(of(0.5, &|i| if i % 2 == 1 { 0.0 } else { zigzag(i) }), [(0.0, 90)]);
        assert_eq!(of(1.0, &|i| if i % 19 == 5 { 0.0 } else { zigzag(i) }), [(0.0, 9)]);
        assert!(of(1.0, &|i| if i % 20 == 0 { 0.0 } else { zigzag(i) }).is_empty());
        // Pulses of ten seconds, each put over and taken back.
        assert!(of(1.0, &|i| if (i / 10).is_multiple_of(2) { 10.0 } else { 0.0 }).is_empty());
    }

    #[test]
    fn what_stands_for_a_missing_value_is_taken_out_and_nothing_else() {
        let heading = Meaning::Channel(Channel::Psi);
        assert_eq!(without(&[10.0, 350.0, 511.0, 200.0, 511.0], heading), [(511.0, 2)]);
        assert_eq!(without(&[10.0, 350.0, -1.0, 20.0, 15.0, -1.0], heading), [(-1.0, 2)]);
        // A heading that counts turns, and one that goes to both sides.
        assert!(without(&[300.0, 340.0, 380.0, 380.0, 420.0], heading).is_empty());
        assert!(without(&[-90.0, -20.0, 90.0, 20.0, -90.0], heading).is_empty());
        assert_eq!(without(&[9.0, 102.3, 11.0, 102.3, 10.0], Meaning::GroundSpeed), [(102.3, 2)]);
        assert_eq!(
            without(&[-20.0, 20.0, -999.0, 9999.0, 0.0], Meaning::Channel(Channel::Delta)),
            [(9999.0, 1), (-999.0, 1)]
        );
        // An anemometer and a rate of turn that failed.
        let wind = Meaning::Channel(Channel::WindSpeed);
        assert_eq!(without(&[5.0, 99.9, 9.0, 15.0, 99.9], wind), [(99.9, 2)]);
        assert_eq!(without(&[-40.0, 720.0, 30.0, 60.0, 720.0], Meaning::Channel(Channel::R)), [(720.0, 2)]);
        // A course that is not known, and one that passes north.
        assert_eq!(without(&[90.0, 91.0, 360.0, 360.0, 92.0, 91.0, 360.0, 93.0], Meaning::Course), [(360.0, 3)]);
        assert!(without(&[359.0, 360.0, 1.0, 359.5, 360.0, 0.5, 2.0], Meaning::Course).is_empty());
        // A propeller that is switched off.
        assert!(without(&[100.0, 101.0, 0.0, 0.0, 100.0], Meaning::Channel(Channel::N)).is_empty());
        assert!(without(&[35.0, 35.0, 1.0, -1.0, 0.0], Meaning::Channel(Channel::Delta)).is_empty());
    }
}
