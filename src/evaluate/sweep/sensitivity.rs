//! What a standard error of each parameter moves: the tracks of the recordings, and the measures of the standard trials.
//! It changes one parameter at a time; what parameters do together is in the covariance.

use crate::evaluate::maneuver::{ManeuverSettings, Side, calm_water, turning_trial, zigzag_trial};
use crate::evaluate::predict;
use crate::fit::Fit;
use crate::model::Model;
use crate::recording::Run;
use rayon::prelude::*;
use serde::Serialize;

/// What one standard error of a parameter moves: half the difference between one more and one less.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sensitivity {
    /// Dotted name.
    pub parameter: String,
    /// Standard error \[its unit\].
    pub standard_error: f64,
    /// Root mean square move of the simulated position over the runs \[m\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub position: Option<f64>,
    /// Root mean square move of the simulated heading \[rad\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub heading: Option<f64>,
    /// Moves of measures of the trials in calm water, by name: advance, transfer and tactical diameter of the turning circle to
    /// starboard in ship lengths, overshoots of the 10/10 and 20/20 zigzag to starboard \[rad\]. A measure that a trial does not reach is left
    /// out.
    pub trials: Vec<(&'static str, f64)>,
}

/// Measures of the trials by name, as far as they are reached.
fn measures(model: &Model, theta: &[f64], settings: &ManeuverSettings) -> Vec<(&'static str, f64)> {
    let Ok(approach) = settings.approach(model, theta) else { return Vec::new() };
    let length = model.ship.hull.lpp;
    let circle = turning_trial(model, theta, &approach, Side::Starboard, settings.turning_angle()).measures;
    let zigzag = |degrees: f64| {
        let angle = degrees.to_radians();
        zigzag_trial(model, theta, &approach, Side::Starboard, [angle, angle]).measures.overshoots.first().copied()
    };
    let lengths = |x: Option<f64>| x.map(|x| x / length);
    let all = [
        ("advance [L]", lengths(circle.advance)),
        ("transfer [L]", lengths(circle.transfer)),
        ("tactical diameter [L]", lengths(circle.tactical_diameter)),
        ("overshoot 10/10 [rad]", zigzag(10.0)),
        ("overshoot 20/20 [rad]", zigzag(20.0)),
    ];
    all.into_iter().filter_map(|(name, value)| Some((name, value?))).collect()
}

/// The sensitivities of every parameter with a standard error, the one that moves the tracks most first.
pub fn sensitivities(found: &Fit, runs: &[Run], settings: &ManeuverSettings) -> Vec<Sensitivity> {
    let (calm, _) = calm_water(&found.model);
    let of = |name: &str, error: f64| {
        let i = found.model.index(name)?;
        let moved = |sign: f64, model: &Model| {
            let mut out = model.clone();
            let p = &mut out.parameters[i];
            p.value = (p.value + sign * error).clamp(p.lower.min(p.value), p.upper.max(p.value));
            out
        };
        let [more, less] = [1.0, -1.0].map(|sign| moved(sign, &found.model));
        let [position, heading] = tracks(&more, &less, runs, found);
        let [up, down] = [1.0, -1.0].map(|sign| {
            let model = moved(sign, &calm);
            measures(&model, &model.values(), settings)
        });
        let both = |(name, value): &(&'static str, f64)| {
            let (_, other) = down.iter().find(|(n, _)| n == name)?;
            Some((*name, 0.5 * (value - other)))
        };
        let trials = up.iter().filter_map(both).collect();
        Some(Sensitivity { parameter: name.to_owned(), standard_error: error, position, heading, trials })
    };
    let known: Vec<(&str, f64)> = found
        .estimates
        .iter()
        .filter_map(|e| Some((e.name.as_str(), e.standard_error.filter(|e| *e > 0.0)?)))
        .collect();
    let mut all: Vec<Sensitivity> = known.par_iter().filter_map(|(name, error)| of(name, *error)).collect();
    all.sort_by(|a, b| b.position.unwrap_or(0.0).total_cmp(&a.position.unwrap_or(0.0)));
    all
}

/// Half the root mean square difference of the simulated positions and headings of two models.
fn tracks(more: &Model, less: &Model, runs: &[Run], found: &Fit) -> [Option<f64>; 2] {
    let (mut squares, mut count) = ([0.0; 2], 0.0);
    for run in runs {
        let [a, b] = [more, less].map(|model| predict(model, run, found.settings.integration));
        if a.diverged_at.is_some() || b.diverged_at.is_some() {
            continue;
        }
        for (a, b) in a.states.iter().zip(&b.states) {
            squares[0] += (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2);
            squares[1] += (a[2] - b[2]).powi(2);
            count += 1.0;
        }
    }
    squares.map(|s| (count > 0.0).then(|| 0.5 * (s / count).sqrt()))
}
