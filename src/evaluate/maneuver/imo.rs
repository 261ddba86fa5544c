//! The IMO standards for ship manoeuvrability, resolution MSC.137(76), beside the measures of a trial.
//! The criteria bind ships of 100 m and more, at full load and test speed; for shorter ships they are a comparison only.

use super::measures::{Stopping, Turning, Zigzag};
use crate::ship::Ship;
use serde::Serialize;

/// Whether a criterion is met.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Met.
    Met,
    /// Not met.
    NotMet,
    /// The 95 % interval of the measure reaches to both sides of the limit.
    Open,
    /// The trial has no such criterion, or did not reach the measure.
    NotApplicable,
}

impl Verdict {
    /// `met`, `NOT met`, `open` or `not applicable`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Met => "met",
            Self::NotMet => "NOT met",
            Self::Open => "open",
            Self::NotApplicable => "not applicable",
        }
    }
}

/// One criterion beside one measure.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Criterion {
    /// The measure: `advance`.
    pub name: String,
    /// What was measured, in `unit`; absent when it was not reached.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measured: Option<f64>,
    /// 95 % interval of what was measured, in `unit`; absent where it is not known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub interval: Option<[f64; 2]>,
    /// Largest value allowed, in `unit`; absent where there is no criterion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limit: Option<f64>,
    /// `L` (ship lengths) or `deg`.
    pub unit: &'static str,
    /// Whether it is met.
    pub verdict: Verdict,
    /// Whether the standard binds this ship: 100 m or longer.
    pub binding: bool,
}

/// Shortest ship that the standard binds \[m\].
pub const SHORTEST: f64 = 100.0;

fn criterion(ship: &Ship, name: String, measured: Option<f64>, limit: Option<f64>, unit: &'static str) -> Criterion {
    let verdict = match (measured, limit) {
        (Some(m), Some(limit)) if m <= limit => Verdict::Met,
        (Some(_), Some(_)) => Verdict::NotMet,
        _ => Verdict::NotApplicable,
    };
    Criterion { name, measured, interval: None, limit, unit, verdict, binding: ship.hull.lpp >= SHORTEST }
}

impl Criterion {
    /// The name of the measure among those of its trial: `tactical_diameter`.
    pub fn quantity(&self) -> String {
        self.name.replace(' ', "_")
    }

    /// Sets the 95 % interval of the measure, in the unit of the criterion. Where it reaches to both sides of the limit the verdict is open.
    pub(super) fn set_interval(&mut self, interval: [f64; 2]) {
        self.interval = Some(interval);
        if self.limit.is_some_and(|limit| interval[0] <= limit && limit < interval[1]) {
            self.leave_open();
        }
    }

    /// Takes a verdict back that is not known.
    pub(super) fn leave_open(&mut self) {
        if matches!(self.verdict, Verdict::Met | Verdict::NotMet) {
            self.verdict = Verdict::Open;
        }
    }
}

/// Turning ability (5.3.1): advance <= 4.5 L and tactical diameter <= 5 L, with the rudder at 35 deg or hard over.
pub fn turning(ship: &Ship, measures: &Turning) -> Vec<Criterion> {
    let lengths = |x: Option<f64>| x.map(|x| x / ship.hull.lpp);
    // A smaller angle than 35 deg is no turning test unless it is all the rudder has, which a ship file does not say.
    let tested = measures.rudder.abs().to_degrees() > 34.5;
    vec![
        criterion(ship, "advance".into(), lengths(measures.advance), tested.then_some(4.5), "L"),
        criterion(ship, "tactical diameter".into(), lengths(measures.tactical_diameter), tested.then_some(5.0), "L"),
    ]
}

/// Initial turning (5.3.2) and yaw checking (5.3.3): for 10/10, 2.5 L to the first 10 deg of heading and overshoots that
/// depend on the time L/V of a ship length; for 20/20, a first overshoot of 25 deg.
pub fn zigzag(ship: &Ship, measures: &Zigzag) -> Vec<Criterion> {
    let is =
        |angle: f64| [measures.rudder.abs(), measures.heading].iter().all(|a| (a.to_degrees() - angle).abs() < 0.5);
    let time = ship.hull.lpp / measures.approach_speed;
    let overshoot = |i: usize| measures.overshoots.get(i).map(|o| o.to_degrees());
    let name = |i: usize| format!("overshoot {}", i + 1);
    if is(10.0) {
        let initial = measures.initial_turning.map(|x| x / ship.hull.lpp);
        // 5 + 0.5 L/V and 17.5 + 0.75 L/V between 10 s and 30 s, constant outside.
        let time = time.clamp(10.0, 30.0);
        vec![
            criterion(ship, "initial turning".into(), initial, Some(2.5), "L"),
            criterion(ship, name(0), overshoot(0), Some(5.0 + 0.5 * time), "deg"),
            criterion(ship, name(1), overshoot(1), Some(17.5 + 0.75 * time), "deg"),
        ]
    } else if is(20.0) {
        vec![criterion(ship, name(0), overshoot(0), Some(25.0), "deg")]
    } else {
        vec![criterion(ship, name(0), overshoot(0), None, "deg"), criterion(ship, name(1), overshoot(1), None, "deg")]
    }
}

/// Stopping ability (5.3.4): track reach <= 15 L (the administration may allow up to 20 L for large displacements).
pub fn stopping(ship: &Ship, measures: &Stopping) -> Vec<Criterion> {
    let reach = measures.track_reach.map(|x| x / ship.hull.lpp);
    vec![criterion(ship, "track reach".into(), reach, Some(15.0), "L")]
}
