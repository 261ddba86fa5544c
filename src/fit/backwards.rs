//! Actuators of a craft that push against their orders, by a fit or by the base of a diagnosis.

use crate::numerals::sig;
use crate::ship::Ship;
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

/// What may be wrong with it.
fn words(actuator: &str, name: &str, value: f64, unit: &str) -> String {
    format!(
        "`{actuator}` pushes against its order ({name} = {} {unit}): its order or its angle is recorded with the other sign (`scale = -1` \
         in a column map turns it), its place or angle in the ship file is another, or it is the log of another actuator",
        sig(value, 3)
    )
}
