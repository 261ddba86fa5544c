//! The standard manoeuvres of a dossier: turning circle and zigzag in calm water, with intervals, as `trimtab maneuver` sails them.
//! They are predictions of the model; none is compared with a recorded trial here.

use crate::evaluate::maneuver::{
    Approach, DRAWS, Drawn, ManeuverError, ManeuverSettings, Measured, SEED, Side, Trial, Turning, Zigzag, calm_water,
    drawn, set_intervals, turning_trial, zigzag_trial,
};
use crate::model::Model;
use crate::uncertainty::Uncertainty;
use serde::Serialize;

/// Standard manoeuvres.
#[derive(Clone, Debug, Serialize)]
pub struct Trials {
    /// How they are approached.
    pub approach: Approach,
    /// Length of the ship \[m\], the unit of distances on the page.
    pub length: f64,
    /// Terms that are left out: what was around the ship, and its sensors.
    pub left_out: Vec<&'static str>,
    /// Draws of the covariance behind the intervals; 0 where the model has none.
    pub draws: usize,
    /// Seed of the draws.
    pub seed: u64,
    /// Turning circles.
    pub turning: Vec<Trial<Turning>>,
    /// Zigzags.
    pub zigzag: Vec<Trial<Zigzag>>,
}

impl Trials {
    /// Sails both manoeuvres to both sides.
    ///
    /// # Errors
    /// Those of the approach: an impossible setting, or no balance between thrust and resistance.
    pub(super) fn new(
        model: &Model,
        uncertainty: Option<&Uncertainty>,
        settings: &ManeuverSettings,
    ) -> Result<Self, ManeuverError> {
        let (model, left_out) = calm_water(model);
        let theta = model.values();
        let approach = settings.approach(&model, &theta)?;
        let draws = uncertainty.map_or_else(Vec::new, |u| drawn(&model, u, DRAWS, SEED));
        let (angle, angles) = (settings.turning_angle(), settings.zigzag_angles());
        let turn = |approach: &Approach, theta: &[f64]| {
            Side::BOTH.map(|side| turning_trial(&model, theta, approach, side, angle)).to_vec()
        };
        let check = |approach: &Approach, theta: &[f64]| -> Vec<Trial<Zigzag>> {
            let both = |a: &[f64; 2]| Side::BOTH.map(|side| zigzag_trial(&model, theta, approach, side, *a));
            angles.iter().flat_map(both).collect()
        };
        let turning = with_intervals(&model, settings, &approach, &theta, &draws, turn);
        let zigzag = with_intervals(&model, settings, &approach, &theta, &draws, check);
        let (length, draws) = (model.ship.hull.lpp, draws.len());
        Ok(Self { approach, length, left_out, draws, seed: SEED, turning, zigzag })
    }
}

/// Trials with the model's parameters, and their intervals from the draws.
fn with_intervals<M: Measured + Send>(
    model: &Model,
    settings: &ManeuverSettings,
    approach: &Approach,
    theta: &[f64],
    draws: &[Drawn],
    sail: impl Fn(&Approach, &[f64]) -> Vec<Trial<M>> + Sync,
) -> Vec<Trial<M>> {
    let mut trials = sail(approach, theta);
    set_intervals(&mut trials, draws, |theta| Some(sail(&settings.approach(model, theta).ok()?, theta)));
    trials
}
