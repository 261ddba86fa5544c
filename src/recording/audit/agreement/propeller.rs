//! The propeller rate against the ship's speed: an advance ratio that no propeller has reveals a wrong unit of one of the two.
//! The thrust of the propeller is left to the model.

use crate::numerals::sig;
use crate::recording::audit::issue::{Issue, Severity};
use crate::recording::audit::limits::{
    KEEPS_SPEED, POWERED, RATIO_APART, RATIO_INSIDE, RATIO_SAMPLES, SAILED, UNDER_WAY,
};
use crate::recording::{Channel, Recording};
use crate::ship::Ship;
use crate::statistics::median;
use std::f64::consts::TAU;

/// Wrong units of a propeller rate, and by what factor they change it.
const UNITS: [(f64, &str); 4] = [
    (TAU, "the column is in rad/s and was declared rps"),
    (60.0, "the column is in rpm and was declared rps"),
    (1.0 / TAU, "the column is in rps and was declared rad/s"),
    (1.0 / 60.0, "the column is in rps and was declared rpm"),
];

/// The median advance ratio where the ship sails ahead under power; `None` where it does too seldom. A ratio beyond what the wrongest unit makes
/// of a propeller that drives its ship is that of a stopped one, whose record is noise.
pub fn advance_ratio(recording: &Recording, ship: &Ship) -> Option<f64> {
    let (n, u) = recording.get(Channel::N).zip(recording.get(Channel::U))?;
    let slow = ship.small_speed();
    let fastest = n.iter().copied().filter(|n| n.is_finite()).fold(0.0, f64::max);
    let ahead = n.iter().zip(u).filter(|(n, u)| **n > POWERED * fastest && **u > UNDER_WAY * slow);
    let ratios: Vec<f64> = ahead.map(|(n, u)| u / (n * ship.propeller.diameter)).collect();
    let largest = SAILED[1] * UNITS.iter().map(|(factor, _)| factor.max(factor.recip())).fold(1.0, f64::max);
    median(ratios.iter().copied()).filter(|ratio| ratios.len() >= RATIO_SAMPLES && *ratio <= largest)
}

/// Compares the ratios of all runs with those that ships have, and each with the others: a berthing is no voyage, so that one run
/// is doubted together with all others, or where it is far from them.
pub fn advance(ratios: &[Option<f64>], ship: &Ship) -> Vec<Option<Issue>> {
    let [low, high] = SAILED;
    let usual = median(ratios.iter().flatten().copied());
    let alone = ratios.iter().flatten().count() == 1;
    let doubtful = |ratio: f64| {
        let others = usual.unwrap_or(ratio);
        let apart = ratio > RATIO_APART * others || ratio < others / RATIO_APART;
        let outside = |r: f64| !(low..=high).contains(&r);
        if alone { outside(ratio) } else { outside(others) != apart }
    };
    let doubted = |ratio: &Option<f64>| ratio.filter(|r| doubtful(*r)).map(|r| doubt(r, ship));
    ratios.iter().map(doubted).collect()
}

fn doubt(ratio: f64, ship: &Ship) -> Issue {
    let [low, high] = SAILED;
    let fits =
        |(factor, _): &&(f64, &str)| (RATIO_INSIDE[0] * low..=RATIO_INSIDE[1] * high).contains(&(ratio * factor));
    let unit = UNITS.iter().find(fits);
    let meaning = unit.map_or(String::new(), |(_, meaning)| format!(": {meaning}"));
    let text = format!("the advance ratio u / (n D) is {} in the median{meaning}", sig(ratio, 2));
    // Whatever unit the file states, a factor corrects it.
    let scale = unit.map_or(String::new(), |(factor, _)| {
        format!("`n = {{ scale = {} }}` in a column map corrects it; otherwise ", sig(factor.recip(), 5))
    });
    let diameter = ship.propeller.diameter;
    let next = format!("{scale}check the unit of n, and D = {diameter} m in the ship file");
    Issue::new(Severity::Warning, "advance_ratio", text, next).of(Channel::N)
}

/// Whether the propeller stands still in every row of a ship that sails.
pub fn is_unpowered(recording: &Recording, ship: &Ship) -> bool {
    let Some((n, u)) = recording.get(Channel::N).zip(recording.get(Channel::U)) else { return false };
    let sails = u.iter().any(|u| *u > UNDER_WAY * ship.small_speed());
    sails && n.iter().all(|n| *n == 0.0 || n.is_nan()) && n.contains(&0.0)
}

/// The doubt where that is so in every run.
pub fn unpowered() -> Issue {
    let text = "the propeller never turns in any run, and the ship sails";
    let next = "map the column of the propeller rate, or give a measured one (`trimtab help columns`): without it a fit takes the ship to be coasting";
    Issue::new(Severity::Warning, "unpowered", text, next).of(Channel::N)
}

/// Whether a ship sails several lengths and keeps its speed to their end: the mean of the last third of the rows against that of the first.
pub fn keeps_speed(recording: &Recording, ship: &Ship) -> bool {
    let Some(u) = recording.get(Channel::U) else { return false };
    let third = u.len() / 3;
    let mean = |rows: &[f64]| rows.iter().sum::<f64>() / rows.len().max(1) as f64;
    let (first, last) = (mean(&u[..third]), mean(&u[u.len() - third..]));
    let lengths = mean(u) * recording.duration() / ship.hull.lpp;
    lengths > KEEPS_SPEED.0 && last > KEEPS_SPEED.1 * first
}

/// The doubt about a run whose propeller stands still while the ship keeps its speed.
pub fn sails_on() -> Issue {
    let text = "the propeller stands still all through the run, and the ship keeps its speed";
    let next = "is its rate missing there? leave the fields blank or the run out: a fit takes the ship to be coasting";
    Issue::new(Severity::Warning, "unpowered", text, next).of(Channel::N)
}
