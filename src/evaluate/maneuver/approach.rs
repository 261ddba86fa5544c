//! How a trial is approached: the settings of a study, and the balanced approach that follows from them.
//! No trial is simulated here.

use super::error::ManeuverError;
use crate::dynamics::Dynamics;
use crate::model::Model;
use crate::ranges::{Limited, OutOfRange, within};
use crate::state::{Force, STATES, State};
use crate::units::GRAVITY;
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// Settings of the trials, the table `[maneuver]` of a study. A setting left out is derived from the ship.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ManeuverSettings {
    /// Approach speed \[m/s\]; when neither `speed` nor `n_rpm` is given that of the recordings, without recordings the service speed of
    /// the ship file, and Froude number 0.15 where that has none.
    pub speed: Option<f64>,
    /// Propeller rate of the approach \[rpm\]; the rate that holds `speed` when left out.
    pub n_rpm: Option<f64>,
    /// Rudder angle of the turning circle \[deg\]; 35.
    pub turning_deg: Option<f64>,
    /// Rudder and heading angle of each zigzag \[deg\]; 10/10 and 20/20.
    pub zigzag_deg: Option<Vec<[f64; 2]>>,
    /// Rudder rate \[deg/s\]; that of the recordings, without recordings `rate_deg_s` of the ship file, else 2.32 (35 deg to 30 deg across
    /// in 28 s, SOLAS), for models below 20 m that of a 200 m ship in model time.
    pub rudder_rate_deg_s: Option<f64>,
    /// Depth of the water \[m\], by the term `shallow`; deep water when left out.
    pub depth: Option<f64>,
    /// Propeller rate of the crash stop \[rpm\], negative astern; minus the approach rate.
    pub astern_rpm: Option<f64>,
    /// Rate at which the propeller is reversed \[rpm/s\]; from ahead to astern while sailing two ship lengths.
    pub engine_rate_rpm_s: Option<f64>,
    /// Integration step \[s\], Runge-Kutta of order 4; a fiftieth of a ship length at approach speed.
    pub step: Option<f64>,
    /// What the recordings of the study show of both.
    #[serde(skip)]
    pub recorded: Recorded,
}

/// What recordings show of the approach; absent where they do not.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Recorded {
    /// Approach speed \[m/s\]: the middle one of the runs' speeds.
    pub speed: Option<f64>,
    /// Rudder rate \[rad/s\].
    pub rudder_rate: Option<f64>,
    /// Recordings that were read.
    pub recordings: usize,
}

/// Where a quantity of the approach is from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Source {
    /// Set for the trial.
    Set,
    /// Held by the propeller rate that was set for the trial.
    PropellerRate,
    /// The recordings of the study.
    Recordings,
    /// The ship file.
    ShipFile,
    /// What is usual for a ship of this length.
    Usual,
}

impl Source {
    /// The first of the values that are given, in the order in which they count.
    fn first(set: Option<f64>, recorded: Option<f64>, ship: Option<f64>, usual: f64) -> (f64, Self) {
        let given = [(set, Self::Set), (recorded, Self::Recordings), (ship, Self::ShipFile)];
        given.into_iter().find_map(|(value, source)| Some((value?, source))).unwrap_or((usual, Self::Usual))
    }

    /// `as set`, `of the recordings`, ...
    pub fn words(self) -> &'static str {
        match self {
            Self::Set => "as set",
            Self::PropellerRate => "held by the propeller rate",
            Self::Recordings => "of the recordings",
            Self::ShipFile => "of the ship file",
            Self::Usual => "usual for its length",
        }
    }
}

/// A balanced approach, in SI units.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Approach {
    /// Approach speed U0 \[m/s\].
    pub speed: f64,
    /// Where it is from.
    pub speed_source: Source,
    /// Propeller rate \[rps\], kept through turning circle and zigzag.
    pub n: f64,
    /// Whether `n` holds `speed` on a straight course; false when both were given.
    pub balanced: bool,
    /// Rudder rate \[rad/s\].
    pub rudder_rate: f64,
    /// Where it is from.
    pub rudder_rate_source: Source,
    /// Propeller rate of the crash stop \[rps\].
    pub astern: f64,
    /// Rate at which the propeller rate changes \[rps/s\].
    pub engine_rate: f64,
    /// Integration step \[s\].
    pub step: f64,
}

/// Froude number of the approach where nothing is given.
const FROUDE: f64 = 0.15;
/// Tolerance of a balance, relative.
const BALANCE: f64 = 1e-10;

impl ManeuverSettings {
    /// Rudder angle of the turning circle \[rad\].
    pub fn turning_angle(&self) -> f64 {
        self.turning_deg.unwrap_or(35.0).to_radians()
    }

    /// Rudder and heading angle of each zigzag \[rad\].
    pub fn zigzag_angles(&self) -> Vec<[f64; 2]> {
        self.zigzag_deg.clone().unwrap_or_else(|| vec![[10.0, 10.0], [20.0, 20.0]]).iter().map(to_radians).collect()
    }

    /// The approach of a ship with this model and parameter vector.
    ///
    /// # Errors
    /// [`ManeuverError`]: a craft without propeller or rudder, an impossible setting, or no balance between thrust and resistance.
    pub fn approach(&self, model: &Model, theta: &[f64]) -> Result<Approach, ManeuverError> {
        self.limits()?;
        let missing = match (model.ship.is_driven(), model.ship.is_steered()) {
            (true, true) => None,
            (false, false) => Some("propeller and no rudder"),
            (false, true) => Some("propeller"),
            (true, false) => Some("rudder"),
        };
        if let Some(missing) = missing {
            return Err(ManeuverError::NoDrive { missing });
        }
        let length = model.ship.hull.lpp;
        if let Some(speed) = self.speed {
            let fastest = (GRAVITY * length).sqrt();
            let meaning = "an approach speed in m/s, up to a Froude number of 1, where no displacement ship sails; is it in knots?";
            within("speed", speed, &(0.0..=(fastest * 100.0).round() / 100.0), meaning)?;
        }
        let (speed, speed_source, n, balanced) = match (self.speed, self.n_rpm) {
            (Some(speed), Some(rpm)) => (speed, Source::Set, rpm / 60.0, false),
            (None, Some(rpm)) => (balanced_speed(model, theta, rpm / 60.0)?, Source::PropellerRate, rpm / 60.0, true),
            (set, None) => {
                let usual = FROUDE * (GRAVITY * length).sqrt();
                let (speed, source) = Source::first(set, self.recorded.speed, model.ship.hull.service_speed, usual);
                (speed, source, balanced_rate(model, theta, speed)?, true)
            }
        };
        let step = 0.02 * length / speed;
        if let Some(value) = self.step {
            let range = 0.01 * step..=10.0 * step;
            within("step", value, &range, "5 to 5000 integration steps while the ship sails its length")?;
        }
        let step = self.step.unwrap_or(step);
        let usual = if length < 20.0 { 2.32 * (200.0 / length).sqrt() } else { 2.32 };
        let (rudder_rate, rudder_rate_source) = Source::first(
            self.rudder_rate_deg_s,
            self.recorded.rudder_rate.map(f64::to_degrees),
            model.ship.rudder.rate_deg_s,
            usual,
        );
        let astern = self.astern_rpm.map_or(-n, |rpm| rpm / 60.0);
        let engine = (n - astern).abs().max(1e-3) * speed / (2.0 * length);
        Ok(Approach {
            speed,
            speed_source,
            n,
            balanced,
            rudder_rate: rudder_rate.to_radians(),
            rudder_rate_source,
            astern,
            engine_rate: self.engine_rate_rpm_s.map_or(engine, |rate| rate / 60.0),
            step,
        })
    }
}

/// Angles that a trial is sailed with \[deg\]: one below is in radians, as 0.61 for 35 deg.
const SAILED_DEG: RangeInclusive<f64> = 2.0..=90.0;

impl Limited for ManeuverSettings {
    fn limits(&self) -> Result<(), OutOfRange> {
        let positive = [
            ("speed", self.speed),
            ("n_rpm", self.n_rpm),
            ("rudder_rate_deg_s", self.rudder_rate_deg_s),
            ("engine_rate_rpm_s", self.engine_rate_rpm_s),
            ("step", self.step),
            ("depth", self.depth),
        ];
        for (key, value) in positive {
            if let Some(value) = value.filter(|v| !(v.is_finite() && *v > 0.0)) {
                return Err(OutOfRange { key, value, expected: "a positive number".into() });
            }
        }
        if let Some(value) = self.astern_rpm.filter(|v| !(v.is_finite() && *v < 0.0)) {
            return Err(OutOfRange {
                key: "astern_rpm",
                value,
                expected: "negative: the propeller turns astern".into(),
            });
        }
        let angles = self.zigzag_deg.iter().flatten().flatten().map(|a| ("zigzag_deg", *a));
        for (key, value) in angles.chain(self.turning_deg.map(|a| ("turning_deg", a))) {
            within(key, value, &SAILED_DEG, "an angle in degrees, not in radians; both sides are sailed")?;
        }
        Ok(())
    }
}

fn to_radians(pair: &[f64; 2]) -> [f64; 2] {
    pair.map(f64::to_radians)
}

/// Surge acceleration \[m/s2\] on a straight course with the rudder amidships.
fn surge(model: &Model, theta: &[f64], u: f64, n: f64) -> f64 {
    let state = State::from_array([0.0, 0.0, 0.0, u, 0.0, 0.0]);
    let dynamics = Dynamics::new(model, theta.to_vec());
    let rates: [f64; STATES] = dynamics.rates(&state, &model.ship.inputs_ordered(0.0, n, 0.0), &Force::zero()).0;
    rates[3]
}

/// The propeller rate \[rps\] that holds a speed ahead \[m/s\]: zero surge acceleration at v = r = delta = 0.
fn balanced_rate(model: &Model, theta: &[f64], speed: f64) -> Result<f64, ManeuverError> {
    // Ten times the rate of no slip is beyond any propeller.
    let limit = 10.0 * speed / model.ship.screw_diameter();
    first_root(|n| surge(model, theta, speed, n), 0.0, limit, 1.0).ok_or(ManeuverError::NoRate { speed, limit })
}

/// The lowest speed ahead \[m/s\] that a propeller rate \[rps\] holds.
fn balanced_speed(model: &Model, theta: &[f64], n: f64) -> Result<f64, ManeuverError> {
    let limit = 2.0 * (GRAVITY * model.ship.hull.lpp).sqrt();
    first_root(|u| surge(model, theta, u, n), 0.0, limit, -1.0).ok_or(ManeuverError::NoSpeed { n })
}

/// The first root of `f` in (`low`, `high`] where it changes to the sign of `after`: marching, then bisection.
fn first_root(f: impl Fn(f64) -> f64, low: f64, high: f64, after: f64) -> Option<f64> {
    const STEPS: usize = 400;
    let at = |i: usize| low + (high - low) * i as f64 / STEPS as f64;
    let i = (1..=STEPS).find(|&i| f(at(i - 1)) * after < 0.0 && f(at(i)) * after >= 0.0)?;
    let (mut low, mut high) = (at(i - 1), at(i));
    while high - low > BALANCE * high {
        let middle = 0.5 * (low + high);
        if f(middle) * after < 0.0 { low = middle } else { high = middle }
    }
    Some(0.5 * (low + high))
}
