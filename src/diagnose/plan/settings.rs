//! The table `[plan]` of a study: planned trials and sensors, their defaults and their ranges.
//! No trial is simulated here.

use crate::ranges::{Limited, OutOfRange, counted, within};
use serde::{Deserialize, Serialize};

/// Planned trials and sensors, the table `[plan]` of a study.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct PlanSettings {
    /// Trials in the order in which they are sailed; where none is listed, turning circles of 35 deg and zigzags 10/10 and 20/20 to
    /// both sides, a crash stop, and straight runs at the approach speed and at 0.6 of it, each on courses 0, 90, 180 and 270 deg.
    pub trials: Vec<PlannedTrial>,
    /// What is measured, and how exactly.
    pub sensors: SensorSettings,
}

/// Kind of a trial.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// The rudder is put over and held, through 720 deg of heading.
    Turning,
    /// The rudder is put over to the other side at each change of heading, until the fifth time.
    Zigzag,
    /// The propeller is reversed, until the ship makes no more way.
    Stopping,
    /// Rudder amidships, constant propeller rate.
    Straight,
    /// From a lower speed to the approach speed, rudder amidships.
    Acceleration,
}

impl Kind {
    /// `turning`, `zigzag`, `stopping`, `straight` or `acceleration`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Turning => "turning",
            Self::Zigzag => "zigzag",
            Self::Stopping => "stopping",
            Self::Straight => "straight",
            Self::Acceleration => "acceleration",
        }
    }

    fn uses_rudder(self) -> bool {
        matches!(self, Self::Turning | Self::Zigzag)
    }
}

/// A planned trial, an entry `[[plan.trials]]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlannedTrial {
    /// Kind of trial.
    pub kind: Kind,
    /// Rudder angle of a turning circle or a zigzag \[deg\], negative for a first rudder to port; 35 and 20.
    pub rudder_deg: Option<f64>,
    /// Change of heading at which the rudder of a zigzag is put over \[deg\]; the rudder angle.
    pub heading_change_deg: Option<f64>,
    /// Speed at the start \[m/s\]; that of `[maneuver]`, and half of it for an acceleration.
    pub speed: Option<f64>,
    /// Propeller rate \[rpm\]; the rate that holds the speed, for an acceleration that of `[maneuver]`.
    pub n_rpm: Option<f64>,
    /// Course at the start \[deg\], one or several; 0.
    #[serde(default)]
    pub heading_deg: Headings,
    /// Longest duration \[s\]; of a straight run 15 ship lengths at its speed, of an acceleration 20 at the approach speed.
    pub duration: Option<f64>,
    /// How often it is sailed.
    #[serde(default = "one")]
    pub repeat: usize,
    /// What shares a hidden condition; all trials share one when left out.
    #[serde(default = "session")]
    pub session: String,
}

/// One course or several \[deg\].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(untagged, expecting = "`heading_deg` must be a course in degrees, or a list of courses")]
pub enum Headings {
    /// One course.
    One(f64),
    /// Several, each sailed.
    Many(Vec<f64>),
}

impl Default for Headings {
    fn default() -> Self {
        Self::One(0.0)
    }
}

impl Headings {
    /// All of them.
    pub fn all(&self) -> &[f64] {
        match self {
            Self::One(heading) => std::slice::from_ref(heading),
            Self::Many(headings) => headings,
        }
    }
}

fn one() -> usize {
    1
}

fn session() -> String {
    "trials".into()
}

/// The four courses on which default trials are sailed \[deg\].
pub const COURSES: [f64; 4] = [0.0, 90.0, 180.0, 270.0];
/// Speed of the slower straight run, as a share of the approach speed.
const SLOWER: f64 = 0.6;

impl PlannedTrial {
    /// A trial of a kind, everything else left out.
    pub fn new(kind: Kind) -> Self {
        Self {
            kind,
            rudder_deg: None,
            heading_change_deg: None,
            speed: None,
            n_rpm: None,
            heading_deg: Headings::default(),
            duration: None,
            repeat: 1,
            session: session(),
        }
    }

    fn with_rudder(kind: Kind, rudder_deg: f64) -> Self {
        Self { rudder_deg: Some(rudder_deg), ..Self::new(kind) }
    }

    /// The same trial on these courses.
    pub fn on(self, headings: &[f64]) -> Self {
        Self { heading_deg: Headings::Many(headings.to_vec()), ..self }
    }

    /// The trials that are sailed where none is listed; `speed` is that of the approach \[m/s\].
    pub fn programme(speed: f64) -> Vec<Self> {
        let sides = |kind, angle: f64| [angle, -angle].map(|rudder| Self::with_rudder(kind, rudder));
        let mut trials: Vec<Self> = sides(Kind::Turning, 35.0).into();
        trials.extend([10.0, 20.0].into_iter().flat_map(|angle| sides(Kind::Zigzag, angle)));
        trials.push(Self::new(Kind::Stopping));
        trials.push(Self { speed: Some(speed), ..Self::new(Kind::Straight) });
        trials.push(Self { speed: Some(SLOWER * speed), ..Self::new(Kind::Straight) });
        trials.into_iter().map(|t| t.on(&COURSES)).collect()
    }

    /// Rudder angle \[rad\], positive for a first rudder to starboard.
    pub fn rudder(&self) -> f64 {
        let usual = if self.kind == Kind::Turning { 35.0 } else { 20.0 };
        self.rudder_deg.unwrap_or(usual).to_radians()
    }

    /// Change of heading of a zigzag \[rad\].
    pub fn heading_change(&self) -> f64 {
        self.heading_change_deg.map_or(self.rudder().abs(), f64::to_radians)
    }

    /// A key that a kind has no use for.
    fn idle(&self, key: &'static str, value: Option<f64>, used: bool) -> Result<(), OutOfRange> {
        match value {
            Some(value) if !used => Err(OutOfRange {
                key,
                value,
                expected: format!("left out: a {} trial has no such angle", self.kind.word()),
            }),
            _ => Ok(()),
        }
    }
}

fn positive(key: &'static str, value: Option<f64>) -> Result<(), OutOfRange> {
    match value.filter(|v| !(v.is_finite() && *v > 0.0)) {
        Some(value) => Err(OutOfRange { key, value, expected: "a positive number".into() }),
        None => Ok(()),
    }
}

impl Limited for PlannedTrial {
    fn limits(&self) -> Result<(), OutOfRange> {
        self.idle("rudder_deg", self.rudder_deg, self.kind.uses_rudder())?;
        self.idle("heading_change_deg", self.heading_change_deg, self.kind == Kind::Zigzag)?;
        if let Some(value) = self.rudder_deg {
            let expected = "between 1 and 70 degrees, negative for a first rudder to port";
            if !(1.0..=70.0).contains(&value.abs()) {
                return Err(OutOfRange { key: "rudder_deg", value, expected: expected.into() });
            }
        }
        if let Some(value) = self.heading_change_deg {
            within("heading_change_deg", value, &(1.0..=90.0), "degrees of heading at which the rudder is put over")?;
        }
        positive("speed", self.speed)?;
        positive("n_rpm", self.n_rpm)?;
        for value in self.heading_deg.all() {
            within("heading_deg", *value, &(-360.0..=360.0), "a course in degrees clockwise from north")?;
        }
        counted("heading_deg", self.heading_deg.all().len(), &(1..=36), "courses in a list")?;
        positive("duration", self.duration)?;
        counted("repeat", self.repeat, &(1..=100), "times that the trial is sailed")
    }
}

/// A sensor, or a group of two that are alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Sensor {
    /// North and east.
    Position,
    /// Heading.
    Heading,
    /// Velocity ahead and across.
    Speed,
    /// Yaw rate.
    YawRate,
}

/// Planned sensors, the table `[plan.sensors]`: standard deviations of their white noise. What is left out is that of a survey ship,
/// and for models below 20 m that of a basin.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SensorSettings {
    /// Position, north and east \[m\]; 0.5, in a basin 0.005.
    pub position: Option<f64>,
    /// Heading \[deg\]; 0.1, in a basin 0.05.
    pub heading_deg: Option<f64>,
    /// Velocity ahead and across \[m/s\]; 0.05, in a basin 0.01.
    pub speed: Option<f64>,
    /// Yaw rate \[deg/s\]; 0.02, in a basin 0.05.
    pub yaw_rate_deg_s: Option<f64>,
    /// Sample period \[s\]; the time in which the ship sails a tenth of its length at approach speed.
    pub step: Option<f64>,
    /// Sensors that are not on board.
    pub without: Vec<Sensor>,
}

impl Limited for SensorSettings {
    fn limits(&self) -> Result<(), OutOfRange> {
        positive("position", self.position)?;
        positive("heading_deg", self.heading_deg)?;
        positive("speed", self.speed)?;
        positive("yaw_rate_deg_s", self.yaw_rate_deg_s)?;
        positive("step", self.step)
    }
}

impl Limited for PlanSettings {
    fn limits(&self) -> Result<(), OutOfRange> {
        self.trials.iter().try_for_each(Limited::limits)?;
        self.sensors.limits()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<PlanSettings, String> {
        let settings: PlanSettings = toml::from_str(text).map_err(|e| e.to_string())?;
        settings.limits().map_err(|e| e.to_string())?;
        Ok(settings)
    }

    #[test]
    fn impossible_trials_are_refused_with_their_range() {
        let trial = |rest: &str| read(&format!("[[trials]]\n{rest}"));
        for (text, expected) in [
            ("kind = \"zigzag\"\nheading_change_deg = 0", "between 1 and 90"),
            ("kind = \"turning\"\nrudder_deg = 85", "between 1 and 70"),
            ("kind = \"turning\"\nrudder_deg = 0", "between 1 and 70"),
            ("kind = \"straight\"\nrudder_deg = 10", "left out"),
            ("kind = \"turning\"\nheading_change_deg = 10", "left out"),
            ("kind = \"straight\"\nspeed = -1", "positive"),
            ("kind = \"straight\"\nrepeat = 0", "between 1 and 100"),
            ("kind = \"straight\"\nheading_deg = []", "courses"),
            ("kind = \"straight\"\nheading_deg = \"north\"", "a list of courses"),
            ("kind = \"spiral\"", "unknown variant"),
            ("kind = \"turning\"\nrudder = 3", "unknown field"),
        ] {
            let refused = trial(text).unwrap_err();
            assert!(refused.contains(expected), "{text}: {refused}");
        }
        assert!(read("[sensors]\nposition = 0").unwrap_err().contains("positive"));
        assert!(read("[sensors]\nwithout = [\"speed\", \"yaw_rate\"]").is_ok());
    }

    #[test]
    fn a_course_or_several_are_read_and_the_programme_is_within_its_ranges() {
        let trials = read(
            "[[trials]]\nkind = \"turning\"\nheading_deg = 45\n[[trials]]\nkind = \"zigzag\"\nheading_deg = [0, 90]",
        );
        let courses: Vec<usize> = trials.unwrap().trials.iter().map(|t| t.heading_deg.all().len()).collect();
        assert_eq!(courses, [1, 2]);
        let programme = PlanSettings { trials: PlannedTrial::programme(5.0), ..PlanSettings::default() };
        assert!(programme.limits().is_ok() && programme.trials.len() == 9);
    }
}
