//! Actuators of a craft by name: a place, a direction, a law, and the channels that drive it.
//! What they push with is the term in `terms/actuator`; how their channels are found in a file is in `recording`.

use super::rudder::{induced_force, normal_slope, steering_deduction};
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
    /// Direction in which it pushes the craft \[deg\], clockwise from the bow; left out: the channel NAME.angle. Not for the laws `force`
    /// and `foil`.
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
    /// Laws `thruster` and `propeller`: thrust astern over thrust ahead, at rest \[-\]; 1 and 0.74 when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub astern: Option<f64>,
    /// Law `propeller`: diameter D \[m\].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub diameter: Option<f64>,
    /// Law `propeller`: `K_T(J) = k0 + k1 J + k2 J^2`; that of a B4-70 with P/D = 0.8 when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub thrust_coefficients: Option<[f64; 3]>,
    /// Law `propeller`: effective wake fraction in straight running w \[-\]; Taylor's for this block coefficient when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wake: Option<f64>,
    /// Law `propeller`: thrust deduction t \[-\]; 0.6 w on the centre line and 0.25 w + 0.14 beside it when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub thrust_deduction: Option<f64>,
    /// Law `foil`: area of the blade A \[m2\].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub area: Option<f64>,
    /// Law `foil`: span of the blade H \[m\]; sqrt(1.8 A) when left out, a rudder of usual aspect ratio.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub span: Option<f64>,
    /// Law `foil`: name of the actuator of law `propeller`, listed before it, in whose race it stands.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub behind: Option<String>,
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
    /// A propeller at the rate NAME.rate by its open-water curve: T = rho n^2 D^4 K_T(J), in all quadrants.
    Propeller,
    /// A rudder at the angle NAME.angle, positive as `delta`: aft of midship it turns the craft to starboard.
    Foil,
}

/// Aspect ratio of a blade of which the area alone is known \[-\]: the middle of 1.5 to 2.2 of ships' rudders.
const USUAL_ASPECT: f64 = 1.8;

/// K_T of a Wageningen B4-70 with P/D = 0.8 (Roddy, Hess & Faller 2006), fitted from J = 0 to 0.8.
const USUAL_THRUST: [f64; 3] = [0.3425, -0.2424, -0.1897];

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
    /// `NAME.rate_order`: the rate that was ordered, beside the one fed back or in its place.
    RateOrder,
    /// `NAME.angle_order`: the angle that was ordered, beside the one fed back or in its place.
    AngleOrder,
}

impl Drive {
    /// All of them.
    pub const ALL: [Self; 8] =
        [Self::Rate, Self::Angle, Self::Order, Self::X, Self::Y, Self::N, Self::RateOrder, Self::AngleOrder];

    /// The second half of the channel's name.
    pub fn suffix(self) -> &'static str {
        match self {
            Self::Rate => "rate",
            Self::Angle => "angle",
            Self::Order => "order",
            Self::X => "X",
            Self::Y => "Y",
            Self::N => "N",
            Self::RateOrder => "rate_order",
            Self::AngleOrder => "angle_order",
        }
    }

    /// What was ordered of what is fed back; `None` where there is no such pair.
    pub fn ordered(self) -> Option<Self> {
        match self {
            Self::Rate => Some(Self::RateOrder),
            Self::Angle => Some(Self::AngleOrder),
            _ => None,
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
            Law::Thruster | Law::Propeller => [Some(Drive::Rate), turned].into_iter().flatten().collect(),
            Law::Foil => vec![Drive::Angle],
        }
    }

    /// 1 where a positive rate pushes it ahead along the keel in a trial, -1 where it pushes astern, 0 where it has no rate or lies across.
    pub(super) fn drives_ahead(&self) -> f64 {
        let along = self.angle.map_or(1.0, |angle| angle.to_radians().cos());
        let turns = matches!(self.law, Law::Thruster | Law::Propeller);
        if turns && along.abs() > 0.5 { along.signum() } else { 0.0 }
    }

    /// Its angle per rudder angle in a trial: 1 of a rudder aft, -1 of a thruster aft, whose push to port turns the craft to starboard.
    pub(super) fn steers(&self) -> f64 {
        match (self.law, self.angle) {
            _ if self.x >= 0.0 => 0.0,
            (Law::Foil, _) => 1.0,
            (Law::Thruster | Law::Propeller, None) => -1.0,
            _ => 0.0,
        }
    }

    /// Span of its blade \[m\].
    pub fn blade_span(&self) -> f64 {
        self.span.unwrap_or_else(|| (USUAL_ASPECT * self.area.unwrap_or(0.0)).sqrt())
    }

    /// Where its parameters begin, as far as they are its own and not those of any craft of the size: by name, from length \[m\] and
    /// block coefficient of the hull.
    ///
    /// Wake by Taylor, 0.5 C_b - 0.05 on the centre line and 0.55 C_b - 0.20 beside it, with the thrust deductions of Schoenherr (Lewis
    /// 1988, Principles of Naval Architecture II, p. 159). A rudder in a race begins as in the standard MMG method, one in the stream as
    /// a foil alone.
    pub fn starts(&self, lpp: f64, block: f64) -> Vec<(&'static str, f64)> {
        let lag = self.lag.and_then(|lag| match lag {
            Lag::Seconds(lag) => Some(lag),
            Lag::Word(_) => None,
        });
        let given = |name: &'static str, value: Option<f64>| value.map(|value| (name, value));
        let own = match self.law {
            Law::Force => self.components().iter().filter_map(|c| given(c.gain(), self.gain)).collect(),
            Law::Order => given("gain", self.gain).into_iter().collect(),
            Law::Thruster => [given("gain", self.gain), given("astern", self.astern)].into_iter().flatten().collect(),
            Law::Propeller => {
                let is_central = self.y == 0.0;
                let taylor = if is_central { 0.5 * block - 0.05 } else { 0.55 * block - 0.20 };
                let wake = self.wake.unwrap_or(taylor.max(0.0));
                let deduction = if is_central { 0.6 * wake } else { 0.25 * wake + 0.14 };
                let [k0, k1, k2] = self.thrust_coefficients.unwrap_or(USUAL_THRUST);
                let deduction = self.thrust_deduction.unwrap_or(deduction);
                let curve = [("kt0", k0), ("kt1", k1), ("kt2", k2), ("astern", self.astern.unwrap_or(0.74))];
                [("wake", wake), ("thrust_deduction", deduction)].into_iter().chain(curve).collect()
            }
            Law::Foil => {
                let span = self.blade_span();
                let slope = ("slope", normal_slope(span * span / self.area.unwrap_or(1.0)));
                let place = self.x / lpp;
                if self.behind.is_none() {
                    vec![slope, ("wake_ratio", 1.0), ("straightening", 1.0), ("lever", place)]
                } else {
                    // The lever of a single rudder, -0.85 L at -0.5 L, in proportion.
                    let flow = [("wake_ratio", 1.05), ("straightening", 0.45), ("lever", 1.7 * place), ("race", 0.5)];
                    let induced = [("t_R", steering_deduction(block)), ("a_H", induced_force(block)), ("x_H", -0.45)];
                    [slope, ("race_astern", 0.144)].into_iter().chain(flow).chain(induced).collect()
                }
            }
        };
        own.into_iter().chain(given("lag", lag)).collect()
    }

    /// The components of its force that are recorded, each once.
    pub fn components(&self) -> Vec<Component> {
        let mut components = self.components.clone().unwrap_or(vec![Component::X, Component::Y, Component::N]);
        components.sort_unstable();
        components.dedup();
        components
    }

    /// Whether another stands in its mirror place: abreast of it on the other side, or on the same line at the other end; driven alike, its
    /// direction the same or mirrored.
    fn mirrors(&self, other: &Self, mirror: Mirror) -> bool {
        let (opposite, turned): (bool, fn(f64) -> f64) = match mirror {
            Mirror::Sides => (self.y != 0.0 && self.y == -other.y && self.x == other.x, |angle| -angle),
            Mirror::Ends => (self.x != 0.0 && self.x == -other.x && self.y == other.y, |angle| 180.0 - angle),
        };
        let alike = self.angle == other.angle || self.angle == other.angle.map(turned);
        opposite && alike && self.law == other.law && self.drives() == other.drives()
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
        number("diameter", self.diameter, 1e-3, lpp, "of the propeller in m");
        number("wake", self.wake, 0.0, 0.9, "effective wake fraction in straight running");
        number("thrust_deduction", self.thrust_deduction, 0.0, 0.8, "share of the thrust ahead that the hull takes");
        number("thrust_coefficients k0", self.thrust_coefficients.map(|k| k[0]), 0.0, 2.0, "K_T at rest");
        number("thrust_coefficients k1", self.thrust_coefficients.map(|k| k[1]), -2.0, 0.0, "slope of K_T over J");
        number("thrust_coefficients k2", self.thrust_coefficients.map(|k| k[2]), -2.0, 1.0, "curvature of K_T over J");
        number("area", self.area, 1e-6, lpp * lpp, "of the blade in m2");
        number("span", self.span, 1e-3, lpp, "of the blade in m");
        if let Some(Lag::Seconds(lag)) = self.lag {
            number("lag", Some(lag), 0.0, MOST_LAG, "a time constant in s, or \"free\"");
        }
        faults.extend(self.misplaced());
        if self.components.as_ref().is_some_and(Vec::is_empty) {
            faults.push(("components", f64::NAN, "must name one of X, Y and N at least".into()));
        }
        faults
    }

    /// Keys that belong to another law, and those that its own needs.
    fn misplaced(&self) -> Vec<(&'static str, f64, String)> {
        let screw = &[Law::Propeller][..];
        let blade = &[Law::Foil][..];
        let belongs = [
            ("gain", self.gain.is_some(), &[Law::Force, Law::Order, Law::Thruster][..]),
            ("astern", self.astern.is_some(), &[Law::Thruster, Law::Propeller]),
            ("components", self.components.is_some(), &[Law::Force]),
            ("diameter", self.diameter.is_some(), screw),
            ("thrust_coefficients", self.thrust_coefficients.is_some(), screw),
            ("wake", self.wake.is_some(), screw),
            ("thrust_deduction", self.thrust_deduction.is_some(), screw),
            ("area", self.area.is_some(), blade),
            ("span", self.span.is_some(), blade),
            ("behind", self.behind.is_some(), blade),
            ("angle", self.angle.is_some(), &[Law::Order, Law::Thruster, Law::Propeller]),
        ];
        let wrong = |(key, given, laws): (&'static str, bool, &[Law])| {
            let named: Vec<String> = laws.iter().map(|law| format!("`{law:?}`").to_lowercase()).collect();
            let reason = match key {
                "angle" => {
                    ": the components of a logged force say its direction, and a foil has the channel NAME.angle"
                }
                _ => "",
            };
            let text = format!("belongs to law {}{reason}", named.join(", "));
            (given && !laws.contains(&self.law)).then_some((key, f64::NAN, text))
        };
        let mut faults: Vec<_> = belongs.into_iter().filter_map(wrong).collect();
        let mut needs = |law: Law, key, given: bool, words: &str| {
            if self.law == law && !given {
                faults.push((key, f64::NAN, format!("is missing: {words}")));
            }
        };
        needs(Law::Propeller, "diameter", self.diameter.is_some(), "the propeller's, in m");
        needs(Law::Foil, "area", self.area.is_some(), "the blade's, in m2");
        faults
    }
}

/// Longest time constant of a lag \[s\]: more is another unit.
pub const MOST_LAG: f64 = 300.0;

impl Component {
    /// Name of the parameter that multiplies it.
    fn gain(self) -> &'static str {
        match self {
            Self::X => "gain_x",
            Self::Y => "gain_y",
            Self::N => "gain_n",
        }
    }

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

/// What two actuators are the mirror image in.
#[derive(Clone, Copy)]
enum Mirror {
    /// Port and starboard.
    Sides,
    /// Bow and stern.
    Ends,
}

/// The actuators of a list that stand in each other's mirror place, by their indices: each in one pair at most, and with the one abreast of it
/// before the one at the other end.
pub fn pairs(actuators: &[Actuator]) -> Vec<[usize; 2]> {
    let mut pairs: Vec<[usize; 2]> = Vec::new();
    for mirror in [Mirror::Sides, Mirror::Ends] {
        for (i, own) in actuators.iter().enumerate() {
            let is_alone = |k: &usize| !pairs.iter().flatten().any(|paired| paired == k);
            let other = (i + 1..actuators.len()).filter(is_alone).find(|j| own.mirrors(&actuators[*j], mirror));
            if is_alone(&i)
                && let Some(j) = other
            {
                pairs.push([i, j]);
            }
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
    for (i, a) in actuators.iter().enumerate() {
        let Some(ahead) = &a.behind else { continue };
        let before = actuators[..i].iter().find(|other| other.name == *ahead);
        let fault = match before {
            Some(other) if other.law == Law::Propeller && other.angle.is_some() => continue,
            Some(_) => {
                "is no actuator of law `propeller` with a fixed `angle`; a foil in the stream alone has no `behind`"
            }
            None if actuators.iter().any(|other| other.name == *ahead) => {
                "is listed after it; list the propeller first"
            }
            None => "is the name of no actuator",
        };
        return Some((a.name.clone(), format!("actuator `{}`: behind = `{ahead}` {fault}", a.name)));
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
        assert_eq!(Drive::split("port.rate_order"), Some(("port", Drive::RateOrder)));
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
            ("name = \"a\"\nlaw = \"propeller\"\nangle = 0", "diameter"),
            ("name = \"a\"\nlaw = \"propeller\"\nangle = 0\ndiameter = 9", "diameter"),
            ("name = \"a\"\nlaw = \"propeller\"\nangle = 0\ndiameter = 0.1\ngain = 1", "gain"),
            ("name = \"a\"\nlaw = \"foil\"", "area"),
            ("name = \"a\"\nlaw = \"foil\"\narea = 0.01\nangle = 0", "angle"),
            ("name = \"a\"\nlaw = \"order\"\nangle = 0\nbehind = \"b\"", "behind"),
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
        // The two ends of a ferry; what has one abreast of it is a pair with that.
        let ferry = [
            of("fore", 2.0, 0.0, ""),
            of("port", -2.0, -1.0, ""),
            of("starboard", -2.0, 1.0, ""),
            of("aft", -2.0, 0.0, ""),
        ];
        assert_eq!(pairs(&ferry), [[1, 2], [0, 3]]);
        assert!(pairs(&[of("fore", 2.0, 0.0, "angle = 0"), of("aft", -2.0, 0.0, "angle = 90")]).is_empty());
        let apart = [of("a", 0.0, -0.1, "angle = 0"), of("b", 0.1, 0.1, "angle = 0"), of("c", 0.0, 0.1, "angle = 30")];
        assert!(pairs(&apart).is_empty());
        let tau = Actuator { law: Law::Force, angle: None, ..apart[1].clone() };
        assert!(pairs(&[apart[0].clone(), Actuator { x: 0.0, ..tau }]).is_empty());
    }

    #[test]
    fn a_foil_stands_behind_a_propeller_that_is_listed_before_it() {
        let screw = actuator("name = \"screw\"\nlaw = \"propeller\"\nangle = 0\ndiameter = 0.1");
        let rudder = actuator("name = \"rudder\"\nlaw = \"foil\"\narea = 0.01\nbehind = \"screw\"");
        assert_eq!(channels(&[screw.clone(), rudder.clone()]), ["screw.rate", "rudder.angle"]);
        assert!(list_fault(&[screw.clone(), rudder.clone()]).is_none());
        let said = |list: &[Actuator]| list_fault(list).unwrap().1;
        assert!(said(&[rudder.clone(), screw.clone()]).contains("list the propeller first"));
        assert!(said(std::slice::from_ref(&rudder)).contains("name of no actuator"));
        let azimuth = Actuator { angle: None, ..screw };
        assert!(said(&[azimuth, rudder]).contains("fixed `angle`"));
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
