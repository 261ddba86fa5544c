//! A rudder that leaps in one run faster than its gear moves it in any other: its values were repeated, or lost, before. An engine has no gear:
//! its rate follows an order the faster, the larger the change. Gear whose limit the other runs do not show is not judged; orders that leap in
//! most runs are in `orders`.

use crate::numerals::sig;
use crate::recording::audit::issue::{Issue, Severity, Shared};
use crate::recording::audit::limits::{GEAR_BEYOND, GEAR_REACHED, GEAR_RUNS, GEAR_SHARE, GEAR_STEP};
use crate::recording::{Channel, Recording};
use serde::{Deserialize, Serialize};

/// The fastest change of a channel from one row to the next.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fastest {
    /// The change, in the unit of the file.
    change: f64,
    /// That unit.
    unit: String,
    /// The time between the rows \[s\].
    seconds: f64,
    /// Size of the mean rate, in SI units.
    rate: f64,
    /// The largest value of the channel in the recording, in the unit of the file.
    largest: f64,
    /// Lines of the two rows.
    lines: (usize, usize),
}

impl Fastest {
    /// That of a recording, between rows with no gap; `None` where the channel was not recorded or never moves.
    pub fn of(recording: &Recording, channel: Channel) -> Option<Self> {
        let (t, values) = (recording.time(), recording.get(channel)?);
        let unit = recording.unit(channel);
        let factor = channel.info().quantity.factor(unit).unwrap_or(1.0);
        let largest = values.iter().filter(|v| v.is_finite()).fold(0.0, |m: f64, v| m.max(v.abs())) / factor;
        let between = |row: usize| {
            let (change, seconds) = (values[row] - values[row - 1], t[row] - t[row - 1]);
            let lines = (recording.line(row - 1), recording.line(row));
            Self {
                change: change / factor,
                unit: unit.to_owned(),
                seconds,
                rate: (change / seconds).abs(),
                largest,
                lines,
            }
        };
        let whole = |one: &Self| one.rate > 0.0 && one.seconds > 0.0 && one.seconds < GEAR_STEP * recording.step();
        let rows = recording.segments().into_iter().flat_map(|s| s.start + 1..s.end);
        rows.map(between).filter(whole).max_by(|a, b| a.rate.total_cmp(&b.rate))
    }
}

/// The runs in which the rudder leaps beyond the limit that it reaches in the others.
pub fn leaps(runs: &[(&str, Option<&Fastest>)]) -> Vec<Shared> {
    // The noise of a rudder that rests is no gear.
    let largest = runs.iter().filter_map(|(_, f)| Some((*f)?.largest)).fold(0.0, f64::max);
    let one = |(run, fastest): &(&str, Option<&Fastest>)| {
        let fastest = (*fastest).filter(|f| f.change.abs() > GEAR_SHARE * largest)?;
        let others: Vec<f64> =
            runs.iter().filter(|(other, _)| other != run).filter_map(|(_, f)| Some((*f)?.rate)).collect();
        let limit = others.iter().copied().fold(0.0, f64::max);
        let reached = others.iter().filter(|rate| **rate >= GEAR_REACHED * limit).count();
        let beyond = reached >= GEAR_RUNS && fastest.rate > GEAR_BEYOND * limit;
        beyond.then(|| Shared { runs: vec![(*run).to_owned()], issue: doubt(fastest, limit, reached) })
    };
    runs.iter().filter_map(one).collect()
}

fn doubt(fastest: &Fastest, limit: f64, reached: usize) -> Issue {
    let text = format!(
        "leaps by {} {} in {} s (lines {} to {}), {} times as fast as it moves in any other run; {reached} of them reach that limit",
        sig(fastest.change, 3),
        fastest.unit,
        sig(fastest.seconds, 2),
        fastest.lines.0,
        fastest.lines.1,
        sig(fastest.rate / limit, 2),
    );
    let next = "look at the rows before it: where values were repeated or lost, leave their fields blank, so that they count as a dropout, \
                or use the run from there with `from`";
    Issue::new(Severity::Warning, "leap", text, next).of(Channel::Delta).at(fastest.lines)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A zigzag with a gear of 2.5 deg/s at a step of 2 s; `change` may damage the angles \[deg\].
    fn zigzag(amplitude: f64, change: impl Fn(&mut Vec<f64>)) -> Option<Fastest> {
        let mut angle = 0.0;
        let mut angles: Vec<f64> = Vec::new();
        for row in 0..120 {
            let order = if (row / 20) % 2 == 0 { amplitude } else { -amplitude };
            angle += (order - angle).clamp(-5.0, 5.0);
            angles.push(angle);
        }
        change(&mut angles);
        let t = (0..120).map(|i| 2.0 * f64::from(i)).collect();
        let delta = angles.iter().map(|a: &f64| a.to_radians()).collect();
        Fastest::of(
            &Recording::from_channels("run", vec![(Channel::T, t), (Channel::Delta, delta)]).unwrap(),
            Channel::Delta,
        )
    }

    fn study(last: Option<Fastest>) -> Vec<Shared> {
        let mut runs: Vec<(&str, Option<Fastest>)> = ["a", "b", "c", "d"]
            .into_iter()
            .zip([10.0, 20.0, 15.0, 35.0])
            .map(|(run, a)| (run, zigzag(a, |_| ())))
            .collect();
        runs.push(("last", last));
        of_rudder(&runs)
    }

    fn of_rudder(runs: &[(&str, Option<Fastest>)]) -> Vec<Shared> {
        leaps(&runs.iter().map(|(run, fastest)| (*run, fastest.as_ref())).collect::<Vec<_>>())
    }

    #[test]
    fn a_rudder_that_was_frozen_leaps_when_it_moves_again() {
        let found = study(zigzag(20.0, |a| (30..58).for_each(|i| a[i] = a[30])));
        assert!(found.len() == 1 && found[0].runs == ["last"], "{found:?}");
        assert!(
            found[0].issue.text.contains("8.0 times as fast") && found[0].issue.text.contains("4 of them"),
            "{found:?}"
        );
    }

    #[test]
    fn gear_at_its_limit_and_slower_gear_do_not_leap() {
        assert_eq!(study(zigzag(30.0, |_| ())), []);
        assert_eq!(study(zigzag(3.0, |_| ())), []);
        assert_eq!(study(None), []);
    }

    #[test]
    fn a_limit_that_the_other_runs_do_not_show_is_none() {
        // On a course the rudder moves by as little as the waves ask for.
        let course =
            |k: f64| zigzag(0.0, move |a| a.iter_mut().enumerate().for_each(|(i, a)| *a = k * (i as f64).sin()));
        let turn = zigzag(35.0, |_| ());
        let runs = [("a", course(0.1)), ("b", course(0.3)), ("c", course(0.05)), ("d", course(0.2)), ("turn", turn)];
        assert_eq!(of_rudder(&runs), []);
    }
}
