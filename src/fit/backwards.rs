//! Actuators of a craft that push against their orders, or less than their twins, by a fit or by the base of a diagnosis.

use crate::numerals::sig;
use crate::ship::Ship;
use crate::ship::actuator::pairs;
use crate::terms::propulsion::actuator::ActuatorTerm;

/// Standard errors by which a gain is below zero where its actuator pushes against its order.
const BACKWARDS: f64 = 3.0;

/// A free parameter with its estimate, standard error where the data give one, and unit.
pub(crate) type Estimated<'a> = (&'a str, f64, Option<f64>, &'a str);

/// The actuators of a craft that push against their orders: a gain that is surely negative, with the words for it.
pub(crate) fn backwards<'a>(ship: &Ship, estimates: impl Iterator<Item = Estimated<'a>>) -> Vec<(f64, String)> {
    let doubt = |(name, value, error, unit): Estimated<'a>| {
        let (actuator, parameter) = name.split_once('.')?;
        let is_negative = error.is_some_and(|error| value < -BACKWARDS * error);
        let pushes_back = ActuatorTerm::is_gain(parameter) && is_negative && ship.actuator(actuator).is_some();
        pushes_back.then(|| (value, words(actuator, name, value, unit)))
    };
    estimates.filter_map(doubt).collect()
}

/// Standard errors by which the gains of two actuators abreast differ where they are unequal,
const APART: f64 = 3.0;
/// and what the weaker has of the stronger at most: propellers of one make differ by a few per cent, those that turn the same way by some more.
const WEAK: f64 = 0.85;

/// The actuators abreast with the same law of which one has surely the smaller gain, with its share of the other's and the words for it. What
/// their estimates have in common makes the difference surer than errors taken as independent.
pub(crate) fn unequal(ship: &Ship, estimates: &[Estimated<'_>]) -> Vec<(f64, String)> {
    let of = |actuator: &str, parameter: &str| {
        let own = |e: &&Estimated| e.0.split_once('.') == Some((actuator, parameter));
        estimates.iter().find(own).and_then(|e| Some((e.1, e.2?)))
    };
    let compared = |[a, b]: [usize; 2]| {
        let (a, b) = (&ship.actuators[a], &ship.actuators[b]);
        let gain = estimates.iter().filter_map(|e| e.0.split_once('.'));
        let gain = gain.filter(|(own, p)| *own == a.name && ActuatorTerm::is_gain(p)).map(|(_, p)| p).next()?;
        let [(first, e), (second, f)] = [of(&a.name, gain)?, of(&b.name, gain)?];
        let (weak, strong, share) =
            if first < second { (&a.name, &b.name, first / second) } else { (&b.name, &a.name, second / first) };
        let differs = (first - second).abs() > APART * e.hypot(f) && (0.0..WEAK).contains(&share);
        (a.x == b.x && differs).then(|| (share, unequal_words(weak, strong, share)))
    };
    pairs(&ship.actuators).into_iter().filter_map(compared).collect()
}

fn unequal_words(weak: &str, strong: &str, share: f64) -> String {
    format!(
        "`{weak}` pushes {} times as hard as `{strong}` on the other side, in all recordings: another propeller, one that is fouled or \
         damaged, or an order of another scale; a fit cannot tell it from a gain of its own",
        sig(share, 2)
    )
}

/// What may be wrong with it.
fn words(actuator: &str, name: &str, value: f64, unit: &str) -> String {
    format!(
        "`{actuator}` pushes against its order ({name} = {} {unit}): its order or its angle is recorded with the other sign (`scale = -1` \
         in a column map turns it), its place or angle in the ship file is another, or it is the log of another actuator",
        sig(value, 3)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_two_abreast_the_one_that_is_surely_weaker_is_reported_and_no_other_two() {
        let text = "name = \"cat\"\n[hull]\nlpp = 2.0\nbreadth = 1.1\nmass = 55.0\n\
            [[actuator]]\nname = \"left\"\nx = -0.8\ny = -0.4\nlaw = \"thruster\"\nangle = 0\n\
            [[actuator]]\nname = \"right\"\nx = -0.8\ny = 0.4\nlaw = \"thruster\"\nangle = 0\n\
            [[actuator]]\nname = \"bow\"\nx = 0.8\nlaw = \"thruster\"\nangle = 90\n";
        let ship = Ship::parse(text, std::path::Path::new("ship.toml")).unwrap();
        let of = |left: f64, right: f64, error: f64| {
            let all = [("left.gain", left), ("right.gain", right), ("left.loss", 0.1), ("bow.gain", 0.01)];
            let all: Vec<Estimated> = all.iter().map(|(name, value)| (*name, *value, Some(error), "N s2")).collect();
            unequal(&ship, &all)
        };
        let found = of(0.41, 0.29, 0.005);
        assert!(found.len() == 1 && found[0].1.starts_with("`right` pushes 0.71 times as hard as `left`"), "{found:?}");
        assert!(of(0.29, 0.41, 0.005)[0].1.starts_with("`left`"));
        assert!(
            of(0.41, 0.29, 0.05).is_empty() && of(0.41, 0.38, 0.001).is_empty() && of(0.41, -0.2, 0.005).is_empty()
        );
    }
}
