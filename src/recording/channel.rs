//! The channels a recording can have: name, quantity, sign convention and the range a ship can reach.
//! How a channel is found in a file is not here (`map.rs`, `read.rs`), nor what a channel does to the ship (the terms).

use super::file::unit::Quantity;
use crate::ship::actuator::Drive;
use crate::state::recorded_inputs;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::cmp::Ordering;
use std::sync::{PoisonError, RwLock};

/// What is to be known about a channel: one row of the table in the help and the README.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ChannelInfo {
    /// The channel.
    pub channel: Channel,
    /// Name in a header and in a column map.
    pub name: &'static str,
    /// Quantity, which fixes the units accepted.
    pub quantity: Quantity,
    /// Smallest and largest value accepted, SI. Outside, the unit is taken to be wrong.
    pub limits: (f64, f64),
    /// In words, for messages: `rudder angle`.
    pub words: &'static str,
    /// Meaning, axis and sign.
    pub doc: &'static str,
}

const fn info(
    channel: Channel,
    name: &'static str,
    quantity: Quantity,
    limits: (f64, f64),
    words: &'static str,
    doc: &'static str,
) -> ChannelInfo {
    ChannelInfo { channel, name, quantity, limits, words, doc }
}

const ANY: (f64, f64) = (f64::MIN, f64::MAX);
/// Twenty turns either way: more than any trial, less than a heading of 360 degrees read as radians.
const HEADING: (f64, f64) = (-126.0, 126.0);
/// A little over one turn either way: directions are read in 0..360 or in +-180 degrees, with room for noise.
const DIRECTION: (f64, f64) = (-7.0, 7.0);
/// A little over a right angle, as for the rudder angle.
const RUDDER: (f64, f64) = (-1.6, 1.6);
/// Revolutions a second: above those of model propellers, below a ship's in rpm.
const SHAFT: (f64, f64) = (-60.0, 60.0);

macro_rules! channel {
    ($($name:ident $channel:ident: $quantity:ident, $limits:expr, $words:literal, $doc:literal;)*) => {
        /// A channel of a recording. Stored in SI units and radians, whatever the file's units were.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[allow(missing_docs)] // each is documented, for users too, in `CHANNELS`
        pub enum Channel {
            T,
            X,
            Y,
            Psi,
            U,
            V,
            R,
            $($channel,)*
            WindSpeed,
            WindDirection,
            ApparentWindSpeed,
            ApparentWindDirection,
            CurrentSpeed,
            CurrentDirection,
            WaveHeight,
            WaveDirection,
            Depth,
            BankStarboard,
            BankPort,
            DeltaOrder,
            NOrder,
            UWater,
            VWater,
            /// A channel of a named actuator, `port.rate`.
            Command(Command),
        }

        /// Every channel but those of named actuators, in the order of [`Channel`].
        pub const CHANNELS: &[ChannelInfo] = &[
            info(Channel::T, "t", Quantity::Time, ANY, "time", "time, increasing from row to row"),
            info(
                Channel::X,
                "x",
                Quantity::Length,
                ANY,
                "north position",
                "position of midship along the earth axis of heading 0 (north)",
            ),
            info(
                Channel::Y,
                "y",
                Quantity::Length,
                ANY,
                "east position",
                "position of midship along the earth axis of heading +90 deg (east)",
            ),
            info(
                Channel::Psi,
                "psi",
                Quantity::Angle,
                HEADING,
                "heading",
                "heading, clockwise from north; may be wrapped, is unwrapped on reading",
            ),
            info(Channel::U, "u", Quantity::Speed, (-40.0, 40.0), "surge velocity", "velocity of midship over ground, forward"),
            info(
                Channel::V,
                "v",
                Quantity::Speed,
                (-20.0, 20.0),
                "sway velocity",
                "velocity of midship over ground, to starboard",
            ),
            info(Channel::R, "r", Quantity::AngularRate, (-3.5, 3.5), "yaw rate", "yaw rate, bow to starboard"),
            $(info(Channel::$channel, stringify!($name), Quantity::$quantity, $limits, $words, $doc),)*
            info(
                Channel::WindSpeed,
                "wind_speed",
                Quantity::Speed,
                (0.0, 100.0),
                "true wind speed",
                "true wind speed over ground",
            ),
            info(
                Channel::WindDirection,
                "wind_direction",
                Quantity::Angle,
                DIRECTION,
                "true wind direction",
                "direction the true wind comes FROM, clockwise from north",
            ),
            info(
                Channel::ApparentWindSpeed,
                "apparent_wind_speed",
                Quantity::Speed,
                (0.0, 100.0),
                "apparent wind speed",
                "wind speed relative to the moving ship; becomes true wind with the ship's own motion",
            ),
            info(
                Channel::ApparentWindDirection,
                "apparent_wind_direction",
                Quantity::Angle,
                DIRECTION,
                "apparent wind direction",
                "direction the apparent wind comes FROM, clockwise from the bow",
            ),
            info(
                Channel::CurrentSpeed,
                "current_speed",
                Quantity::Speed,
                (0.0, 10.0),
                "current speed",
                "speed of the current over ground",
            ),
            info(
                Channel::CurrentDirection,
                "current_direction",
                Quantity::Angle,
                DIRECTION,
                "current direction",
                "direction the current sets TO, clockwise from north",
            ),
            info(
                Channel::WaveHeight,
                "wave_height",
                Quantity::Length,
                (0.0, 30.0),
                "wave height",
                "significant wave height H_s",
            ),
            info(
                Channel::WaveDirection,
                "wave_direction",
                Quantity::Angle,
                DIRECTION,
                "wave direction",
                "direction waves come FROM, clockwise from north",
            ),
            info(
                Channel::Depth,
                "depth",
                Quantity::Length,
                (0.01, 12_000.0),
                "water depth",
                "water depth h from the surface to the bottom",
            ),
            info(
                Channel::BankStarboard,
                "bank_starboard",
                Quantity::Length,
                (0.01, 1e7),
                "distance to the starboard bank",
                "distance from midship to the bank on the starboard side",
            ),
            info(
                Channel::BankPort,
                "bank_port",
                Quantity::Length,
                (0.01, 1e7),
                "distance to the port bank",
                "distance from midship to the bank on the port side",
            ),
            info(
                Channel::DeltaOrder,
                "delta_order",
                Quantity::Angle,
                RUDDER,
                "ordered rudder angle",
                "rudder angle ordered, same sign as delta",
            ),
            info(
                Channel::NOrder,
                "n_order",
                Quantity::Rotation,
                SHAFT,
                "ordered propeller rate",
                "propeller rate ordered, same sign as n",
            ),
            info(
                Channel::UWater,
                "u_water",
                Quantity::Speed,
                (-40.0, 40.0),
                "surge velocity through water",
                "velocity through water, forward (a log)",
            ),
            info(
                Channel::VWater,
                "v_water",
                Quantity::Speed,
                (-20.0, 20.0),
                "sway velocity through water",
                "velocity through water, to starboard (a log)",
            ),
        ];
    };
}
recorded_inputs!(channel);

/// The measured state, in the order of [`crate::state::STATE_NAMES`].
pub const STATE_CHANNELS: [Channel; 6] = [Channel::X, Channel::Y, Channel::Psi, Channel::U, Channel::V, Channel::R];

/// A channel of an actuator, such as `port.rate`, by its place in the list of those that were named; made by [`Channel::from_name`].
///
/// A number and no text, so that errors that name a channel stay small.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Command(u16);

impl Command {
    fn info(self) -> Option<&'static ChannelInfo> {
        COMMANDS.read().unwrap_or_else(PoisonError::into_inner).get(usize::from(self.0)).copied()
    }
}

impl Ord for Command {
    /// By name, whatever was named first.
    fn cmp(&self, other: &Self) -> Ordering {
        if self == other { Ordering::Equal } else { self.info().map(|c| c.name).cmp(&other.info().map(|c| c.name)) }
    }
}

impl PartialOrd for Command {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Orders may be shares, per cent, volts or pulse widths, forces those of any craft: only values beyond those of any such channel are refused.
const ORDER: (f64, f64) = (-1e6, 1e6);
const FORCE: (f64, f64) = (-1e9, 1e9);
/// Revolutions a second of a small craft's thruster: above 6000 rpm the unit is another.
const THRUSTER: (f64, f64) = (-100.0, 100.0);

/// Catalogue rows of the channels of actuators that were named in this process; each is kept until the process ends, as those of the table are.
static COMMANDS: RwLock<Vec<&'static ChannelInfo>> = RwLock::new(Vec::new());

/// The channel of an actuator with this name, if it is one.
fn command(name: &str) -> Option<&'static ChannelInfo> {
    let (actuator, drive) = Drive::split(name)?;
    let mut known = COMMANDS.write().unwrap_or_else(PoisonError::into_inner);
    if let Some(row) = known.iter().find(|row| row.name == name) {
        return Some(row);
    }
    let place = u16::try_from(known.len()).ok()?;
    let (quantity, limits, what, doc) = match drive {
        Drive::Rate => (Quantity::Rotation, THRUSTER, "rate", "rate, positive ahead"),
        Drive::Angle => (
            Quantity::Angle,
            HEADING,
            "angle",
            "direction in which it pushes, clockwise from the bow; of a foil its angle, positive as `delta`",
        ),
        Drive::Order => (Quantity::Number, ORDER, "order", "order, in any unit of its own"),
        Drive::X => (Quantity::Force, FORCE, "surge force", "force forward"),
        Drive::Y => (Quantity::Force, FORCE, "sway force", "force to starboard"),
        Drive::N => (Quantity::Moment, FORCE, "yaw moment", "moment to starboard"),
        Drive::RateOrder => {
            (Quantity::Rotation, THRUSTER, "ordered rate", "rate ordered; drives it where `.rate` is not recorded")
        }
        Drive::AngleOrder => {
            (Quantity::Angle, HEADING, "ordered angle", "angle ordered; drives it where `.angle` is not recorded")
        }
    };
    let kept: &'static str = Box::leak(name.to_owned().into_boxed_str());
    let words: &'static str = Box::leak(format!("{what} of the actuator {actuator}").into_boxed_str());
    let row = Box::leak(Box::new(info(Channel::Command(Command(place)), kept, quantity, limits, words, doc)));
    known.push(row);
    Some(row)
}

impl Channel {
    /// The catalogue row of this channel.
    pub fn info(self) -> &'static ChannelInfo {
        let named = || if let Self::Command(command) = self { command.info() } else { None };
        // The first row is never taken: every other channel is in the table, and a command is made with its row.
        CHANNELS.iter().find(|c| c.channel == self).or_else(named).unwrap_or(&CHANNELS[0])
    }

    /// Its name in headers and column maps.
    pub fn name(self) -> &'static str {
        self.info().name
    }

    /// The channel of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        let listed = CHANNELS.iter().find(|c| c.name == name);
        listed.or_else(|| command(name)).map(|c| c.channel)
    }

    /// Whether it is an angle that goes all the way round: the heading, and that of an azimuth. Such a one is unwrapped on reading.
    pub(crate) fn turns(self) -> bool {
        self == Self::Psi || matches!(self, Self::Command(_)) && self.info().quantity == Quantity::Angle
    }

    /// Channels whose dropouts interrupt a run: all but the orders and the logs, which no simulation needs.
    pub fn interrupts(self) -> bool {
        !matches!(self, Self::T | Self::DeltaOrder | Self::NOrder | Self::UWater | Self::VWater)
            && !matches!(Drive::split(self.name()), Some((_, Drive::RateOrder | Drive::AngleOrder)))
    }

    /// The channel of what was ordered of this one, for the rate and the angle of a named actuator: `port.rate_order` of `port.rate`.
    pub fn ordered(self) -> Option<Self> {
        let (actuator, drive) = Drive::split(self.name())?;
        Self::from_name(&format!("{actuator}.{}", drive.ordered()?.suffix()))
    }
}

impl Serialize for Channel {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

impl<'de> Deserialize<'de> for Channel {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        Self::from_name(&name).ok_or_else(|| serde::de::Error::custom(format!("unknown channel `{name}`")))
    }
}

impl std::fmt::Display for Channel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_catalogue_is_in_the_order_of_the_enum() {
        for (i, c) in CHANNELS.iter().enumerate() {
            assert!(i == 0 || CHANNELS[i - 1].channel < c.channel, "{}", c.name);
            assert_eq!(c.channel.info().name, c.name);
            assert_eq!(Channel::from_name(c.name), Some(c.channel));
            assert!(c.limits.0 < c.limits.1);
        }
    }
    #[test]
    fn a_channel_of_an_actuator_is_one_by_its_name() {
        let rate = Channel::from_name("port.rate").unwrap();
        assert_eq!((rate.name(), rate.info().quantity), ("port.rate", Quantity::Rotation));
        assert_eq!(Channel::from_name("port.rate"), Some(rate));
        assert!(rate > Channel::VWater && rate < Channel::from_name("stern.angle").unwrap());
        assert_eq!(Channel::from_name("port.speed"), None);
        assert_eq!(serde_json::to_string(&rate).unwrap(), "\"port.rate\"");
        assert_eq!(serde_json::from_str::<Channel>("\"u_water\"").unwrap(), Channel::UWater);
    }
}
