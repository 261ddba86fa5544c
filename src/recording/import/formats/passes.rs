//! A clock that steps back: the stretches of a file in each of which time goes on, where they cover the same time twice.
//! Rows that merely come late are no stretch of their own: they are sorted where signals are made.

use std::ops::Range;

/// Rows that two stretches must have of the same time for the clock to have stepped back: one or two are late rows.
pub const FEW: usize = 3;
/// Earlier stretches that a further one is compared with.
const STRETCHES: usize = 100;
/// Share of the rows with the time of the one before that must record something else for the times to be rounded: a ship under way moves
/// between any two, and one that lies still does so in part of a log.
pub const OTHERWISE: f64 = 0.3;
/// Times closer than this are one \[s\].
const SAME_TIME: f64 = 1e-6;

/// The stretches of rows with these times. One begins where time steps back over what the file has covered before, which `repeats` decides for
/// the rows of both; a batch of late rows fills a hole and begins none.
pub fn passes(t: &[f64], repeats: impl Fn(Range<usize>, Range<usize>) -> bool) -> Vec<Range<usize>> {
    let rows: Vec<usize> = (0..t.len()).filter(|row| t[*row].is_finite()).collect();
    let time = |at: usize| t[rows[at]];
    let mut starts = vec![0];
    // The last run of rising times, and the longest of each stretch.
    let (mut last, mut longest): (Range<usize>, Vec<Range<usize>>) = (0..0, Vec::new());
    let mut at = 0;
    while at < rows.len() {
        let mut end = at + 1;
        while end < rows.len() && time(end) >= time(end - 1) - SAME_TIME {
            end += 1;
        }
        if end - at >= FEW {
            let again = |rise: &Range<usize>| {
                if rise.is_empty() {
                    return false;
                }
                let top = time(rise.end - 1).min(time(end - 1));
                let here = at..at + rows[at..end].partition_point(|row| t[*row] <= top + SAME_TIME);
                if here.len() < FEW {
                    return false;
                }
                // Late rows cover a time that was not covered before: only times between theirs count.
                let until = |least: f64| rise.start + rows[rise.clone()].partition_point(|row| t[*row] < least);
                let before = until(time(at) - SAME_TIME)..until(time(here.end - 1) + SAME_TIME);
                before.len() >= FEW
                    && repeats(rows[before.start]..rows[before.end - 1] + 1, rows[at]..rows[here.end - 1] + 1)
            };
            if std::iter::once(&last).chain(longest.iter().rev().take(STRETCHES)).any(again) {
                starts.push(rows[at]);
                longest.push(at..end);
            } else if longest.last().is_none_or(|longest| longest.len() < end - at) {
                longest.pop();
                longest.push(at..end);
            }
            last = at..end;
        }
        at = end;
    }
    let ends = starts[1..].iter().copied().chain([t.len()]);
    starts.iter().copied().zip(ends).map(|(start, end)| start..end).collect()
}

/// The note on a clock that stepped back; `place` is where it did so first.
pub fn stepped_back(passes: usize, place: &str) -> String {
    let times = if passes == 2 { "once".to_owned() } else { format!("{} times", passes - 1) };
    format!(
        "its clock steps back {times}, first at {place}, over time that it has passed before: what follows is a recording of its own (summer time that ends, or another ship; write UTC to keep one recording)"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clock_that_steps_back_begins_another_stretch_and_late_rows_do_not() {
        let of = |t: &[f64]| passes(t, |_, _| true).len();
        let hour: Vec<f64> = (0..40).map(f64::from).collect();
        let twice = [&hour[..], &hour[20..], &hour[..5]].concat();
        assert_eq!(passes(&twice, |_, _| true), [0..40, 40..60, 60..65]);
        assert_eq!(passes(&twice, |_, _| false).len(), 1);
        // One row late, a batch that fills a hole, newest first, and a time that is missing.
        assert_eq!(of(&[0.0, 1.0, 3.0, 2.0, 4.0, 5.0]), 1);
        assert_eq!(of(&[0.0, 1.0, 5.0, 6.0, 7.0, 2.0, 3.0, 4.0, 8.0, 9.0]), 1);
        assert_eq!(of(&[0.0, 1.0, 2.0, 7.0, 8.0, 9.0, 3.0, 4.0, 5.0, 6.0, 10.0]), 1);
        assert_eq!(of(&hour.iter().rev().copied().collect::<Vec<f64>>()), 1);
        assert_eq!(of(&[0.0, 1.0, f64::NAN, 2.0, 3.0, 4.0, 0.5, f64::NAN, 1.5, 2.5, 3.5, 9.0]), 2);
    }
}
