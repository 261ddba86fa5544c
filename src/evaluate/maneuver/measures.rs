//! The measures of the standard trials: turning circle, zigzag, crash stop, pull-out and spiral.
//! They are data; each trial's own file reads them from a track.

use super::nomoto::Nomoto;
use serde::Serialize;

/// What a turning circle is measured by. Lengths are of the midship point, from the instant the rudder begins to move,
/// on axes along the heading at that instant; a measure that was not reached is absent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Turning {
    /// Rudder angle held \[rad\].
    pub rudder: f64,
    /// Speed when the rudder began to move \[m/s\].
    pub approach_speed: f64,
    /// Distance ahead when heading has changed by 90 deg \[m\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub advance: Option<f64>,
    /// Distance abeam, towards the turn, when heading has changed by 90 deg \[m\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub transfer: Option<f64>,
    /// Distance abeam, towards the turn, when heading has changed by 180 deg \[m\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tactical_diameter: Option<f64>,
    /// Time to a change of heading of 90 deg \[s\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_90: Option<f64>,
    /// Time to a change of heading of 180 deg \[s\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_180: Option<f64>,
    /// The steady turn.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steady: Option<Steady>,
    /// Nomoto's K and T of the first 90 deg.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nomoto: Option<Nomoto>,
}

/// The steady turn: means over the last 90 deg of heading before the rudder is eased, of a turn of 270 deg or more.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Steady {
    /// Diameter of the midship point's circle, 2 U / |r| \[m\].
    pub diameter: f64,
    /// Speed \[m/s\].
    pub speed: f64,
    /// Speed lost: 1 - U/U0 \[-\].
    pub speed_loss: f64,
    /// Drift angle atan2(-v, u) \[rad\], positive in a turn to starboard.
    pub drift: f64,
    /// Yaw rate \[rad/s\].
    pub yaw_rate: f64,
}

/// What a zigzag is measured by; a measure that was not reached is absent.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Zigzag {
    /// Rudder angle \[rad\].
    pub rudder: f64,
    /// Change of heading at which the rudder is put over \[rad\].
    pub heading: f64,
    /// Speed at the first execute \[m/s\].
    pub approach_speed: f64,
    /// Times of the executes, from the first \[s\].
    pub executes: Vec<f64>,
    /// Overshoot angles, first to last \[rad\]: how far heading runs past `heading` after each execute but the first, from
    /// the course midway between the headings at the second and the third.
    pub overshoots: Vec<f64>,
    /// Distance sailed along the track until heading has changed by `heading` \[m\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub initial_turning: Option<f64>,
    /// Time until heading has changed by `heading` \[s\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub initial_turning_time: Option<f64>,
    /// Time from the first execute until heading is back where it began \[s\] (the reach).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reach: Option<f64>,
    /// Time from the second to the fourth execute \[s\]: one full cycle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub period: Option<f64>,
    /// Nomoto's K and T from the first execute to the last, of a zigzag of three executes or more.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nomoto: Option<Nomoto>,
}

/// What a stop is measured by, from the order to the engine until the ship makes no more way ahead; a measure that was
/// not reached is absent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Stopping {
    /// Speed at the order \[m/s\].
    pub approach_speed: f64,
    /// Distance along the track \[m\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub track_reach: Option<f64>,
    /// Distance along the course at the order \[m\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub head_reach: Option<f64>,
    /// Distance across that course \[m\], positive to starboard.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lateral_deviation: Option<f64>,
    /// Change of heading \[rad\], positive to starboard.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub heading_change: Option<f64>,
    /// Time \[s\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time: Option<f64>,
}

/// What a pull-out is measured by; a measure that was not reached is absent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct PullOut {
    /// Rudder angle of the turn before \[rad\].
    pub rudder: f64,
    /// Speed of the approach \[m/s\].
    pub approach_speed: f64,
    /// Steady yaw rate of that turn \[rad/s\].
    pub turning_rate: f64,
    /// Steady yaw rate with the rudder amidships again \[rad/s\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub residual_rate: Option<f64>,
    /// Time until the rate has come as near to that as 1/e of the way \[s\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub decay_time: Option<f64>,
}

/// What a spiral is measured by; a measure that was not reached is absent.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Spiral {
    /// Largest rudder angle \[rad\].
    pub rudder: f64,
    /// Speed of the approach \[m/s\].
    pub approach_speed: f64,
    /// Rudder angles between which the ship turns to the side from which it comes \[rad\]; 0 for a ship that is stable on its course.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub loop_width: Option<f64>,
    /// Difference of the two yaw rates with the rudder amidships \[rad/s\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub loop_height: Option<f64>,
    /// Rudder angle in the middle of the loop \[rad\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub neutral: Option<f64>,
    /// Rudder angle \[rad\] and steady yaw rate \[rad/s\], in the order in which they were sailed.
    pub points: Vec<[f64; 2]>,
}

/// A measure of a kind of trial: its name, and how it is read.
pub type Quantity<M> = (&'static str, fn(&M) -> Option<f64>);

/// Measures that can be listed: those that get intervals and columns of tables.
pub trait Measured: Sized + 'static {
    /// The measures, in SI units and radians.
    const QUANTITIES: &'static [Quantity<Self>];

    /// The measure of that name, if it was reached.
    fn quantity(&self, name: &str) -> Option<f64> {
        Self::QUANTITIES.iter().find(|(n, _)| *n == name).and_then(|(_, read)| read(self))
    }
}

impl Measured for Turning {
    const QUANTITIES: &'static [Quantity<Self>] = &[
        ("advance", |m| m.advance),
        ("transfer", |m| m.transfer),
        ("tactical_diameter", |m| m.tactical_diameter),
        ("steady_diameter", |m| m.steady.map(|s| s.diameter)),
        ("speed_loss", |m| m.steady.map(|s| s.speed_loss)),
        ("drift", |m| m.steady.map(|s| s.drift)),
        ("time_90", |m| m.time_90),
        ("time_180", |m| m.time_180),
        ("nomoto_gain", |m| m.nomoto.map(|n| n.gain)),
        ("nomoto_time", |m| m.nomoto.map(|n| n.time)),
    ];
}

impl Measured for Zigzag {
    const QUANTITIES: &'static [Quantity<Self>] = &[
        ("overshoot_1", |m| m.overshoots.first().copied()),
        ("overshoot_2", |m| m.overshoots.get(1).copied()),
        ("overshoot_3", |m| m.overshoots.get(2).copied()),
        ("initial_turning", |m| m.initial_turning),
        ("execute_2", |m| m.executes.get(1).copied()),
        ("execute_3", |m| m.executes.get(2).copied()),
        ("reach", |m| m.reach),
        ("period", |m| m.period),
        ("nomoto_gain", |m| m.nomoto.map(|n| n.gain)),
        ("nomoto_time", |m| m.nomoto.map(|n| n.time)),
    ];
}

impl Measured for PullOut {
    const QUANTITIES: &'static [Quantity<Self>] = &[
        ("turning_rate", |m| m.residual_rate.map(|_| m.turning_rate)),
        ("residual_rate", |m| m.residual_rate),
        ("decay_time", |m| m.decay_time),
    ];
}

impl Measured for Spiral {
    const QUANTITIES: &'static [Quantity<Self>] =
        &[("loop_width", |m| m.loop_width), ("loop_height", |m| m.loop_height), ("neutral", |m| m.neutral)];
}

impl Measured for Stopping {
    const QUANTITIES: &'static [Quantity<Self>] = &[
        ("track_reach", |m| m.track_reach),
        ("head_reach", |m| m.head_reach),
        ("lateral_deviation", |m| m.lateral_deviation),
        ("heading_change", |m| m.heading_change),
        ("time", |m| m.time),
    ];
}
