//! What a diagnosis can name: a group of parameters of one term, with the words and cautions that go with it.
//! These are data beside the physics; how a mechanism is tested is the diagnosis' own affair.

use serde::Serialize;

/// How the sensitivity to a parameter is taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Probe {
    /// The exact derivative.
    Tangent,
    /// `(f(+scale) - f(-scale)) / 2`: for effects quadratic in their amplitude, whose derivative at zero vanishes.
    Odd,
    /// `f(scale) - f(0)`: for effects that exist on one side only.
    Forward,
    /// `f(scale) - f(0)`, for what is so or is not: it is wholly so at its scale, where a refit begins as well, since a model fitted without it
    /// is bent so far that its slope may promise nothing.
    Whole,
}

/// What kind of thing a mechanism is, for the verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// A force or inflow from outside the ship.
    Environment,
    /// Hull, propeller or rudder physics.
    Ship,
    /// An actuator that does not do what was recorded.
    Actuator,
    /// A sensor that does not report what is.
    Sensor,
}

/// Something the diagnosis can name.
#[derive(Debug)]
pub struct Mechanism {
    /// Name, unique over the catalogue.
    pub name: &'static str,
    /// Plain words, as the end of "what was left out: ...".
    pub title: &'static str,
    /// What kind of thing it is.
    pub kind: Kind,
    /// Names of its parameters within its term.
    pub parameters: &'static [&'static str],
    /// Names of coefficients of its term that are not known exactly once it acts: freed with it, with their priors.
    pub companions: &'static [&'static str],
    /// How the sensitivity is taken at the neutral point.
    pub probe: Probe,
    /// True when unknown hull, propeller and rudder coefficients can mimic it, so that only a reference session shows it.
    pub needs_reference: bool,
    /// Whether its amplitudes may differ from session to session, as those of weather, which is new every day, and of clocks, which are set
    /// when a logger starts. Coefficients of the ship and what is mounted on it stay.
    pub by_session: bool,
    /// True for a force without a cause, which stands in for physics of some other form: named when no cause comes near.
    pub stand_in: bool,
    /// Names of mechanisms that look alike on some data.
    pub look_alikes: &'static [&'static str],
    /// The trial that shows it best.
    pub trial: &'static str,
}

impl Mechanism {
    /// Whether either names the other as a look-alike.
    pub fn looks_like(&self, other: &Self) -> bool {
        self.look_alikes.contains(&other.name) || other.look_alikes.contains(&self.name)
    }

    /// Whether its form is exact: an error of a sensor, or water that carries the ship, change how motion and measurements are related, and
    /// no law of a force is in them that may be another. Clocks are not: what is late is taken along its rate.
    pub fn is_kinematic(&self) -> bool {
        let is_clock = self.by_session;
        (self.kind == Kind::Sensor && !is_clock) || self.name == "current"
    }

    /// Whether it is a vector over the ground, which the weather makes anew every day; the others are coefficients, which stay.
    pub fn is_weather(&self) -> bool {
        self.kind == Kind::Environment && self.is_vector()
    }

    /// Whether it is given by its components towards north and east.
    pub fn is_vector(&self) -> bool {
        self.parameters == ["north", "east"]
    }
}
