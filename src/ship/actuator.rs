//! Actuators of a craft by name: a place, a direction, a law, and the channels that drive it.
//! What they push with is the term in `terms/actuator`; how their channels are found in a file is in `recording`.

use crate::state::COMMANDS;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// One actuator of a craft: an entry `[[actuator]]` of the ship file.
#[derive(Clone, Debug, Serialize, Deserialize, PartialEq, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Actuator {
    /// Name, the first half of its channels (`port.rate`) and of its parameters (`port.gain`): letters, digits and `_`.
    pub name: String,
    /// Place \[m\], forward of midship.
    #[serde(default)]
    pub x: f64,
    /// Place \[m\], to starboard of the centre line.
    #[serde(default)]
    pub y: f64,
    /// Direction in which it pushes the craft \[deg\], clockwise from the bow; left out: the channel NAME.angle. Not for law `force`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angle: Option<f64>,
    /// How its force follows from its channels.
    pub law: Law,
    /// Time constant \[s\] of a first-order lag between channel and force, or `"free"` to have it estimated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lag: Option<Lag>,
    /// Where its gain begins; estimated from the size of the craft when left out, 1 for law `force`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gain: Option<f64>,
    /// Law `thruster`: thrust astern over thrust ahead \[-\]; 1 when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub astern: Option<f64>,
    /// Law `force`: which of X, Y and N are recorded; all three when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub components: Option<Vec<Component>>,
}

/// How the force of an actuator follows from its channels.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, PartialEq, Eq, PartialOrd, Ord, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Law {
    /// Forces as logged, NAME.X, NAME.Y \[N\] and NAME.N \[N m\], each with a gain.
    Force,
    /// Proportional to an order NAME.order: a throttle, a pump, one axis of a Voith-Schneider propeller.
    Order,
    /// A propeller at the rate NAME.rate: T = k (n|n| - l |n| u_a), u_a the inflow along its axis.
    Thruster,
}

/// A lag: a time, or one that is estimated.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, PartialEq, JsonSchema)]
#[serde(untagged, expecting = "a number of seconds, or \"free\"")]
pub enum Lag {
    /// In seconds.
    Seconds(f64),
    /// To be estimated.
    Word(LagWord),
}

/// The word that stands for a lag that is estimated.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, PartialEq, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum LagWord {
    /// To be estimated.
    Free,
}

/// A component of a logged force.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, PartialEq, Eq, PartialOrd, Ord, JsonSchema)]
pub enum Component {
    /// Forward.
    X,
    /// To starboard.
    Y,
    /// Moment to starboard about the actuator's place.
    N,
}

/// What a channel of an actuator is, the second half of its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Drive {
    /// `NAME.rate`.
    Rate,
    /// `NAME.angle`.
    Angle,
    /// `NAME.order`.
    Order,
    /// `NAME.X`.
    X,
    /// `NAME.Y`.
    Y,
    /// `NAME.N`.
    N,
}

impl Drive {
    /// All of them.
    pub const ALL: [Self; 6] = [Self::Rate, Self::Angle, Self::Order, Self::X, Self::Y, Self::N];

    /// The second half of the channel's name.
    pub fn suffix(self) -> &'static str {
        match self {
            Self::Rate => "rate",
            Self::Angle => "angle",
            Self::Order => "order",
            Self::X => "X",
            Self::Y => "Y",
            Self::N => "N",
        }
    }

    /// The two halves of a channel's name, `None` for a name that is not of an actuator's channel.
    pub fn split(name: &str) -> Option<(&str, Self)> {
        let (actuator, suffix) = name.split_once('.')?;
        let drive = Self::ALL.into_iter().find(|d| d.suffix() == suffix)?;
        is_name(actuator).then_some((actuator, drive))
    }
}

/// Whether a text can be the name of an actuator.
pub fn is_name(text: &str) -> bool {
    let plain = |c: char| c.is_ascii_alphanumeric() || c == '_';
    text.starts_with(|c: char| c.is_ascii_alphabetic()) && text.len() <= 40 && text.chars().all(plain)
}

impl Actuator {
    /// The channels that drive it, in the order in which a simulation has them.
    pub fn drives(&self) -> Vec<Drive> {
        let turned = self.angle.is_none().then_some(Drive::Angle);
        match self.law {
            Law::Force => self.components().into_iter().map(Component::drive).collect(),
            Law::Order => [Some(Drive::Order), turned].into_iter().flatten().collect(),
            Law::Thruster => [Some(Drive::Rate), turned].into_iter().flatten().collect(),
        }
    }

    /// The components of its force that are recorded, each once.
    pub fn components(&self) -> Vec<Component> {
        let mut components = self.components.clone().unwrap_or(vec![Component::X, Component::Y, Component::N]);
        components.sort_unstable();
        components.dedup();
        components
    }

    /// Whether another stands in its mirror place: abreast of it on the other side, driven alike, its direction the same or mirrored.
    fn mirrors(&self, other: &Self) -> bool {
        let abreast = self.y != 0.0 && self.y == -other.y && self.x == other.x;
        let turned = self.angle == other.angle || self.angle == other.angle.map(|angle| -angle);
        abreast && turned && self.law == other.law && self.drives() == other.drives()
    }

    /// What is wrong with it by itself: key, value found (NaN for none), and what it should be.
    pub fn faults(&self, lpp: f64) -> Vec<(&'static str, f64, String)> {
        let mut faults = Vec::new();
        let mut number = |key, value: Option<f64>, low: f64, high: f64, meaning: &str| {
            if let Some(value) = value.filter(|v| !(low..=high).contains(v)) {
                faults.push((key, value, format!("must be between {low} and {high}: {meaning}")));
            }
        };
        number("x", Some(self.x), -lpp, lpp, "in m forward of midship");
        number("y", Some(self.y), -lpp, lpp, "in m to starboard of the centre line");
        number("angle", self.angle, -360.0, 360.0, "in degrees, clockwise from the bow");
        number("gain", self.gain, -1e12, 1e12, "force for one unit of the channel");
        number("astern", self.astern, 0.0, 2.0, "thrust astern over thrust ahead");
        if let Some(Lag::Seconds(lag)) = self.lag {
            number("lag", Some(lag), 0.0, MOST_LAG, "a time constant in s, or \"free\"");
        }
        let wrong = |given: bool, key, law| given.then(|| (key, f64::NAN, format!("belongs to law `{law}` alone")));
        faults.extend(wrong(self.astern.is_some() && self.law != Law::Thruster, "astern", "thruster"));
        faults.extend(wrong(self.components.is_some() && self.law != Law::Force, "components", "force"));
        if self.law == Law::Force && self.angle.is_some() {
            faults.push(("angle", f64::NAN, "is not for law `force`, whose components say the direction".into()));
        }
        if self.components.as_ref().is_some_and(Vec::is_empty) {
            faults.push(("components", f64::NAN, "must name one of X, Y and N at least".into()));
        }
        faults
    }
}

/// Longest time constant of a lag \[s\]: more is another unit.
pub const MOST_LAG: f64 = 300.0;

impl Component {
    fn drive(self) -> Drive {
        match self {
            Self::X => Drive::X,
            Self::Y => Drive::Y,
            Self::N => Drive::N,
        }
    }
}

/// The channels of a list of actuators, in the order in which a simulation has them: `port.rate`, `port.angle`, ...
pub fn channels(actuators: &[Actuator]) -> Vec<String> {
    let of = |a: &Actuator| a.drives().into_iter().map(|d| format!("{}.{}", a.name, d.suffix())).collect::<Vec<_>>();
    actuators.iter().flat_map(of).collect()
}

/// The actuators of a list that stand in each other's mirror place, by their indices: each in one pair at most.
pub fn pairs(actuators: &[Actuator]) -> Vec<[usize; 2]> {
    let mut pairs: Vec<[usize; 2]> = Vec::new();
    for (i, own) in actuators.iter().enumerate() {
        let is_alone = |k: &usize| !pairs.iter().flatten().any(|paired| paired == k);
        let other = (i + 1..actuators.len()).filter(is_alone).find(|j| own.mirrors(&actuators[*j]));
        if is_alone(&i)
            && let Some(j) = other
        {
            pairs.push([i, j]);
        }
    }
    pairs
}

/// What is wrong with the names of a list of actuators, or with their number: the key that it concerns, and why.
pub fn list_fault(actuators: &[Actuator]) -> Option<(String, String)> {
    let mut seen: Vec<&str> = Vec::new();
    for Actuator { name, .. } in actuators {
        let fault = if !is_name(name) {
            "is no name of an actuator: it begins with a letter and has letters, digits and `_`, 40 at most"
        } else if seen.contains(&name.as_str()) {
            "is the name of two actuators; give each its own"
        } else {
            seen.push(name);
            continue;
        };
        return Some((name.clone(), format!("`{name}` {fault}")));
    }
    let count = channels(actuators).len();
    let text = format!("the actuators have {count} channels together; at most {COMMANDS} are simulated");
    (count > COMMANDS).then(|| ("actuator".to_owned(), text))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn actuator(text: &str) -> Actuator {
        toml::from_str(text).unwrap()
    }

    #[test]
    fn a_name_of_a_channel_is_an_actuator_and_what_drives_it() {
        assert_eq!(Drive::split("fore_port.rate"), Some(("fore_port", Drive::Rate)));
        assert_eq!(Drive::split("tau.X"), Some(("tau", Drive::X)));
        for other in ["tau.x", "rate", ".rate", "1a.rate", "a b.rate", "a.rate.order"] {
            assert_eq!(Drive::split(other), None, "{other}");
        }
    }

    #[test]
    fn an_angle_that_is_left_out_is_a_channel() {
        let fixed = actuator("name = \"port\"\nlaw = \"thruster\"\nangle = 0");
        let turned = actuator("name = \"azi\"\nlaw = \"thruster\"\nlag = \"free\"");
        assert_eq!(channels(&[fixed, turned]), ["port.rate", "azi.rate", "azi.angle"]);
        let tau = actuator("name = \"tau\"\nlaw = \"force\"\ncomponents = [\"N\", \"X\"]\nlag = 1");
        assert_eq!(channels(std::slice::from_ref(&tau)), ["tau.X", "tau.N"]);
        assert_eq!(tau.lag, Some(Lag::Seconds(1.0)));
        assert!(tau.faults(2.0).is_empty());
    }

    #[test]
    fn what_does_not_belong_to_a_law_is_a_fault() {
        for (text, key) in [
            ("name = \"a\"\nlaw = \"order\"\nangle = 0\nastern = 0.5", "astern"),
            ("name = \"a\"\nlaw = \"order\"\nangle = 0\ncomponents = [\"X\"]", "components"),
            ("name = \"a\"\nlaw = \"force\"\nangle = 0", "angle"),
            ("name = \"a\"\nlaw = \"force\"\nx = 40", "x"),
            ("name = \"a\"\nlaw = \"force\"\nlag = -1", "lag"),
        ] {
            assert_eq!(actuator(text).faults(2.0)[0].0, key, "{text}");
        }
    }

    #[test]
    fn actuators_abreast_that_are_driven_alike_are_pairs_and_others_are_not() {
        let of = |name: &str, x: f64, y: f64, more: &str| {
            actuator(&format!("name = {name:?}\nx = {x:?}\ny = {y:?}\nlaw = \"order\"\n{more}"))
        };
        let azimuths = |y: f64| of("a", -1.0, y, "");
        let all = [
            of("px", -0.4, -0.1, "angle = 0"),
            of("py", -0.4, -0.1, "angle = 90"),
            of("bow", 0.4, 0.0, "angle = 90"),
            of("sy", -0.4, 0.1, "angle = -90"),
            of("sx", -0.4, 0.1, "angle = 0"),
            azimuths(0.5),
            azimuths(-0.5),
            azimuths(-0.5),
        ];
        assert_eq!(pairs(&all), [[0, 4], [1, 3], [5, 6]]);
        let apart = [of("a", 0.0, -0.1, "angle = 0"), of("b", 0.1, 0.1, "angle = 0"), of("c", 0.0, 0.1, "angle = 30")];
        assert!(pairs(&apart).is_empty());
        let tau = Actuator { law: Law::Force, angle: None, ..apart[1].clone() };
        assert!(pairs(&[apart[0].clone(), Actuator { x: 0.0, ..tau }]).is_empty());
    }

    #[test]
    fn names_are_unique_and_channels_not_too_many() {
        let named = |name: &str| Actuator { name: name.into(), ..actuator("name = \"a\"\nlaw = \"force\"") };
        assert!(list_fault(&[named("a"), named("b")]).is_none());
        assert!(list_fault(&[named("a"), named("a")]).unwrap().1.contains("two actuators"));
        assert!(list_fault(&[named("a.b")]).unwrap().1.contains("letters"));
        let many: Vec<Actuator> = (0..5).map(|i| named(&format!("a{i}"))).collect();
        assert!(list_fault(&many).unwrap().1.contains("15 channels"));
    }
}
