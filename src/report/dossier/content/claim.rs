//! What is claimed of a model: no more than was compared with recordings, and over which conditions that was done.
//! The intended use is the user's to state; none is made up here.

use crate::recording::{Run, Split};
use crate::units::GRAVITY;
use serde::Serialize;

/// A quantity and the values that runs visit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Span {
    /// What it is, in words.
    pub name: &'static str,
    /// SI unit; `-` for none.
    pub unit: &'static str,
    /// Smallest value.
    pub low: f64,
    /// Largest value.
    pub high: f64,
}

/// Claim and intended use.
#[derive(Clone, Debug, Serialize)]
pub struct Claim {
    /// The claim in words.
    pub statement: String,
    /// The intended use as the user states it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub intended_use: Option<String>,
    /// Which runs the conditions are of: `test`, or `train` where there are no test runs.
    pub conditions_of: Split,
    /// The conditions: what these runs visit.
    pub conditions: Vec<Span>,
}

impl Claim {
    /// The claim that the runs of a study allow.
    pub(super) fn new(model: &str, ship: &str, length: f64, runs: &[Run], intended_use: Option<String>) -> Self {
        let tested = runs.iter().any(|r| r.split == Split::Test);
        let conditions_of = if tested { Split::Test } else { Split::Train };
        let statement = if tested {
            format!(
                "Started from its recorded state and given the recorded rudder and propeller, the model \"{model}\" predicts the motion of \
                 {ship} on runs that it was not fitted to with the errors stated under validation, within the conditions below. Nothing \
                 is claimed outside them."
            )
        } else {
            format!(
                "No accuracy is claimed for the model \"{model}\" of {ship}: the study has no test run, so that no error on unseen runs was \
                 measured."
            )
        };
        let of: Vec<&Run> = runs.iter().filter(|r| r.split == conditions_of).collect();
        Self { statement, intended_use, conditions_of, conditions: conditions(length, &of) }
    }
}

/// What runs visit.
fn conditions(length: f64, runs: &[&Run]) -> Vec<Span> {
    let speeds: Vec<f64> =
        runs.iter().flat_map(|r| &r.measured).filter_map(|m| Some(m[3]?.hypot(m[4].unwrap_or(0.0)))).collect();
    let wave = (GRAVITY * length).sqrt();
    let channel = |c: usize| runs.iter().flat_map(|r| &r.measured).filter_map(|m| m[c]).collect::<Vec<f64>>();
    let input =
        |f: fn(&crate::state::Inputs<f64>) -> f64| -> Vec<f64> { runs.iter().flat_map(|r| &r.inputs).map(f).collect() };
    let froude = speeds.iter().map(|u| u / wave).collect();
    let wind = input(|i| i.wind[0].hypot(i.wind[1]));
    let depth = runs.iter().flat_map(|r| &r.inputs).map(|i| i.draught_to_depth).filter(|d| *d > 0.0).map(|d| 1.0 / d);
    let all = [
        ("speed over ground", "m/s", speeds),
        ("Froude number", "-", froude),
        ("yaw rate", "rad/s", channel(5)),
        ("rudder angle", "rad", input(|i| i.delta)),
        ("propeller rate", "1/s", input(|i| i.n)),
        ("recorded wind speed", "m/s", if wind.iter().all(|w| *w == 0.0) { Vec::new() } else { wind }),
        ("recorded depth over draught", "-", depth.collect()),
        ("duration of a prediction", "s", runs.iter().map(|r| r.duration()).collect()),
    ];
    all.into_iter().filter_map(|(name, unit, values)| span(name, unit, &values)).collect()
}

/// The span of values; nothing where there are none.
pub(super) fn span(name: &'static str, unit: &'static str, values: &[f64]) -> Option<Span> {
    let finite = || values.iter().copied().filter(|v| v.is_finite());
    let (low, high) = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
    (low <= high).then_some(Span { name, unit, low, high })
}
