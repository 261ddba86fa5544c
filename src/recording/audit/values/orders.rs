//! A rudder that leaps: what was recorded is the order, not the angle that the rudder had.
//! It examines one channel of each run; clocks are compared over all runs elsewhere.

use crate::numerals::sig;
use crate::recording::audit::issue::{Issue, Severity};
use crate::recording::audit::limits::{ORDERED_DEGREES, ORDERED_LEAP};
use crate::recording::{Channel, Recording};
use serde::{Deserialize, Serialize};

/// The largest change of the rudder from one row to the next.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Leap {
    /// The change \[rad\].
    angle: f64,
    /// The time between the rows \[s\].
    seconds: f64,
}

impl Leap {
    /// That of a recording; `None` where no rudder moves.
    pub fn of(recording: &Recording) -> Option<Self> {
        let (t, delta) = (recording.time(), recording.get(Channel::Delta)?);
        let step = |i: usize| Self { angle: (delta[i] - delta[i - 1]).abs(), seconds: t[i] - t[i - 1] };
        let steps = (1..recording.len()).map(step).filter(|s| s.angle > 0.0 && s.seconds > 0.0);
        steps.max_by(|a, b| a.rate().total_cmp(&b.rate()))
    }

    /// Mean rate of the change \[rad/s\].
    fn rate(&self) -> f64 {
        self.angle / self.seconds
    }

    /// Whether no steering gear turns so far so fast; `time` is that in which the ship sails its length \[s\].
    fn is_ordered(&self, time: f64) -> bool {
        self.angle.to_degrees() > ORDERED_LEAP && (self.rate() * time).to_degrees() > ORDERED_DEGREES
    }
}

/// The note that rudder angles are orders, where they are in more than half of the runs in which the rudder moves: a damaged value is
/// in one. `time` is that in which the ship sails its length \[s\].
pub fn ordered(leaps: &[Leap], time: f64) -> Option<Issue> {
    let ordered: Vec<&Leap> = leaps.iter().filter(|l| l.is_ordered(time)).collect();
    let largest = ordered.iter().max_by(|a, b| a.rate().total_cmp(&b.rate()))?;
    if 2 * ordered.len() <= leaps.len() || ordered.len() < 2 {
        return None;
    }
    let text = format!(
        "leaps in {} of {} runs, by {} deg in {} s: it is the order, not the angle that the rudder had",
        ordered.len(),
        leaps.len(),
        sig(largest.angle.to_degrees(), 2),
        sig(largest.seconds, 2)
    );
    let next = "record the angle that the rudder has, or expect a diagnosis to name `rudder_lag` or `rudder_rate`, the steering gear";
    Some(Issue::new(Severity::Note, "order", text, next).of(Channel::Delta))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn leap(degrees: f64, seconds: f64) -> Leap {
        Leap { angle: degrees.to_radians(), seconds }
    }

    #[test]
    fn a_rudder_that_leaps_in_most_runs_is_an_order() {
        let order = leap(40.0, 0.1);
        let issue = ordered(&[order, order, leap(1.0, 0.1)], 8.0).unwrap();
        assert!(issue.text.contains("in 2 of 3 runs, by 40 deg in 0.10 s"), "{}", issue.text);
        assert_eq!(issue.severity, Severity::Note);
        // One damaged value, and a damaged value in one of two runs, are none.
        assert_eq!(ordered(&[order, leap(1.0, 0.1), leap(1.0, 0.1)], 8.0), None);
        assert_eq!(ordered(&[order], 8.0), None);
        assert_eq!(ordered(&[], 8.0), None);
    }

    #[test]
    fn a_steering_gear_is_none_at_any_scale_and_sampling() {
        // 2.3 deg/s of a ship of 300 m at 8 m/s; a model at Froude scale 45.7; a ship sampled at 20 s; a small step of a fine rudder.
        for (one, time) in
            [(leap(4.6, 2.0), 37.5), (leap(1.7, 0.1), 5.9), (leap(35.0, 20.0), 37.5), (leap(2.0, 0.01), 10.0)]
        {
            assert_eq!(ordered(&[one; 4], time), None, "{one:?}");
        }
    }
}
