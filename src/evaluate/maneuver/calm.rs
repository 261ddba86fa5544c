//! Calm water: a model without what was around the ship when it was recorded, and without what its sensors made of it.
//! The ship's own physics and its actuators stay as they were found.

use crate::model::Model;
use crate::physics::Group;
use crate::ranges::{OutOfRange, within};

/// The model in calm, deep, open water, and the terms that were left out: those of environment (wind, waves, current, bottom, banks),
/// other forces from outside (pushes) and sensors. The parameter vector stays whole.
pub fn calm_water(model: &Model) -> (Model, Vec<&'static str>) {
    kept(model, false)
}

/// As [`calm_water`], in water of a depth \[m\]: the term `shallow` acts by its published law, or by the share of it that the model has.
///
/// # Errors
/// A depth in which the ship is aground or nearly so, or a catalogue without that term.
pub fn calm_water_of_depth(model: &Model, depth: Option<f64>) -> Result<(Model, Vec<&'static str>), OutOfRange> {
    let Some(depth) = depth else { return Ok(calm_water(model)) };
    let draught = model.ship.hull.draught;
    let meaning = "a depth of water in m, from 1.2 times the draught";
    within("depth", depth, &(1.2 * draught..=1e4), meaning)?;
    let mut model = model.clone();
    let share = model.index("shallow.strength").map_or(0.0, |i| model.parameters[i].value);
    let share = if share > 0.0 { share } else { 1.0 };
    let set = [("shallow.ratio", share * draught / (depth - draught)), ("shallow.strength", 0.0)];
    model.add_term("shallow").and_then(|()| model.set(&set)).map_err(|error| OutOfRange {
        key: "depth",
        value: depth,
        expected: format!("left out, as the model cannot be put into shallow water: {error}"),
    })?;
    Ok(kept(&model, true))
}

/// The model without what is around it, in shallow water or not.
fn kept(model: &Model, shallow: bool) -> (Model, Vec<&'static str>) {
    // A thruster belongs to the ship, and is at rest in the trials.
    let around = |group: Group, name: &str| match group {
        Group::Environment | Group::Sensor => !(shallow && name == "shallow"),
        Group::External => name != "thruster",
        Group::Hull | Group::Propulsion | Group::Rudder => false,
    };
    let left_out: Vec<&'static str> = model.terms().filter(|t| around(t.group, t.name)).map(|t| t.name).collect();
    (model.restricted(|name| !left_out.contains(&name)), left_out)
}
