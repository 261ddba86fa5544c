//! The propeller rate against the ship's speed: an advance ratio that no propeller has tells a wrong unit of the one or the other.
//! What the propeller's thrust is, is the model's affair.

use super::issue::{Issue, Severity};
use crate::numerals::sig;
use crate::recording::{Channel, Recording};
use crate::ship::Ship;
use std::f64::consts::TAU;

/// Advance ratios u / (n D) that ships under way have, from heavy towing to wind from astern. Open-water diagrams of the Wageningen B
/// series reach zero thrust between 0.6 and 1.5, by pitch.
const SAILED: [f64; 2] = [0.15, 1.6];
/// Samples ahead under power that a ratio is told from.
const FEWEST: usize = 20;

/// Wrong units of a propeller rate, and by what factor they change it.
const UNITS: [(f64, &str); 4] = [
    (TAU, "the column is in rad/s and was declared rps"),
    (60.0, "the column is in rpm and was declared rps"),
    (1.0 / TAU, "the column is in rps and was declared rad/s"),
    (1.0 / 60.0, "the column is in rps and was declared rpm"),
];

/// Holds the propeller rate against the speed where the ship sails ahead under power.
pub fn advance(recording: &Recording, ship: &Ship, issues: &mut Vec<Issue>) {
    let Some((n, u)) = recording.get(Channel::N).zip(recording.get(Channel::U)) else { return };
    let slow = ship.small_speed();
    let ahead = n.iter().zip(u).filter(|(n, u)| **n > 0.0 && **u > 10.0 * slow);
    let mut ratios: Vec<f64> = ahead.map(|(n, u)| u / (n * ship.propeller.diameter)).collect();
    if ratios.len() < FEWEST {
        return;
    }
    ratios.sort_by(f64::total_cmp);
    let median = ratios[ratios.len() / 2];
    let [low, high] = SAILED;
    if (low..=high).contains(&median) {
        return;
    }
    let fits = |(factor, _): &&(f64, &str)| (2.0 * low..=0.8 * high).contains(&(median * factor));
    let meaning = UNITS.iter().find(fits).map_or(String::new(), |(_, meaning)| format!(": {meaning}"));
    let text = format!("the advance ratio u / (n D) is {} in the median{meaning}", sig(median, 2));
    let next = format!("check the unit of n, and D = {} m in the ship file", ship.propeller.diameter);
    issues.push(Issue::new(Severity::Warning, "advance_ratio", text, next).of(Channel::N));
}
