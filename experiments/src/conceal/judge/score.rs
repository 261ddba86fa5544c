//! The scores of one concealed case: a row of the campaign's results.
//! It is data; the judge and the baselines fill it.

use serde::{Deserialize, Serialize};

/// Scores of one case. A score that does not apply is absent: a null has no right name, a sensor no equation.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Score {
    /// Key of the case in the campaign.
    pub case: String,
    /// Part of the campaign.
    pub arm: String,
    /// Truth family.
    pub family: String,
    /// Concealed effects, joined by `+`; empty for a null.
    pub effects: String,
    /// Background.
    pub background: String,
    /// Design.
    pub design: String,
    /// Whether some sessions were a reference.
    pub contrast: bool,
    /// Seed.
    pub seed: u64,
    /// Signal-to-noise ratio asked for.
    pub snr_asked: Option<f64>,
    /// Signal-to-noise ratio reached by the first effect.
    pub snr: Option<f64>,
    /// Size of the first effect.
    pub size: Option<f64>,
    /// Its unit.
    pub unit: String,
    /// The right verdict.
    pub expected: String,
    /// The verdict of the diagnosis.
    pub verdict: String,
    /// Mechanisms named, joined by `+`.
    pub named: String,
    /// The verdict is right for the case.
    pub verdict_right: Option<bool>,
    /// p of the strongest mechanism against the base model, corrected for the number of mechanisms, whatever came of it.
    pub lead_p: Option<f64>,
    /// Nulls: a mechanism was named that is not the family's own structure, or missing physics was claimed.
    pub false_alarm: Option<bool>,
    /// Effects: the diagnosis reported missing physics.
    pub detected: Option<bool>,
    /// Detected cases: the first name is right.
    pub first_right: Option<bool>,
    /// Detected cases: a right name is in the first confidence set.
    pub in_set: Option<bool>,
    /// Size of that set.
    pub set_size: Option<f64>,
    /// Detected forces: the equation with most of the force.
    pub right_equation: Option<bool>,
    /// Effects of limited duration: overlap of found and true windows over their union.
    pub window_iou: Option<f64>,
    /// |found - true|/true of the size, where one number is comparable.
    pub size_error: Option<f64>,
    /// (found - true)/standard error of that size, along the true direction.
    pub size_errors: Option<f64>,
    /// The true size lies in the 90 % interval.
    pub covered: Option<bool>,
    /// Share of the held-out gap between the diagnosis' base model and the oracle that was closed.
    pub gap_closed: Option<f64>,
    /// One mechanism was named with confidence, and it is neither right nor near.
    pub wrong_confident: Option<bool>,
    /// Absorbed effects: a mechanism was named although the parameters can mimic the effect.
    pub absorbed_named: Option<bool>,
    /// Several effects: at least one right and none wrong.
    pub some_right_none_wrong: Option<bool>,
    /// Several effects: all of them named and no other.
    pub exact: Option<bool>,
    /// Mechanisms named that describe the truth family itself.
    pub structural: usize,
    /// Held-out median cVDM \[%\] of the paper's method: the eleven parameters fitted to trajectories.
    pub refit_held_out: Option<f64>,
    /// The same score of the base model that the diagnosis estimated, with its hull and propeller coefficients.
    pub base_held_out: Option<f64>,
    /// The same score of the model with the mechanisms named.
    pub named_held_out: Option<f64>,
    /// The same score of the oracle.
    pub oracle_held_out: Option<f64>,
    /// iid BIC on trajectories over the same catalogue: the mechanism it named, `nothing` for none.
    pub bic_named: String,
    /// Whether BIC is right: the effect, or nothing on a null.
    pub bic_right: Option<bool>,
    /// Sparse regression on residual accelerations: the mechanism it named.
    pub sindy_named: String,
    /// Whether sparse regression is right.
    pub sindy_right: Option<bool>,
    /// Ships whose flow straightening differs between the sides: half the true difference.
    pub asymmetry: Option<f64>,
    /// The estimate of that half difference.
    pub asymmetry_found: Option<f64>,
    /// The true half difference lies in the 90 % interval.
    pub asymmetry_covered: Option<bool>,
    /// The diagnosis reported that port and starboard of the ship differ.
    pub sides_differ: Option<bool>,
    /// Time of the diagnosis \[s\].
    pub seconds: Option<f64>,
    /// Why there is no score.
    pub error: String,
}
