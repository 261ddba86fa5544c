//! Calm water: a model without what was around the ship when it was recorded, and without what its sensors made of it.
//! The ship's own physics and its actuators stay as they were found.

use crate::model::Model;
use crate::physics::Group;

/// The model in calm, deep, open water, and the terms that were left out: those of environment (wind, waves, current, bottom, banks),
/// other forces from outside (pushes) and sensors. The parameter vector stays whole.
pub fn calm_water(model: &Model) -> (Model, Vec<&'static str>) {
    // A thruster belongs to the ship, and is at rest in the trials.
    let around = |group: Group, name: &str| match group {
        Group::Environment | Group::Sensor => true,
        Group::External => name != "thruster",
        Group::Hull | Group::Propulsion | Group::Rudder => false,
    };
    let left_out: Vec<&'static str> = model.terms().filter(|t| around(t.group, t.name)).map(|t| t.name).collect();
    (model.restricted(|name| !left_out.contains(&name)), left_out)
}
