//! Section `[fit]` of a study: where derivatives come from, tolerances, limits, constraints.
//! It holds values and checks them; what they do is elsewhere.

use super::constraints::ConstraintSettings;
use super::cost::{CostOptions, Derivatives};
use super::error::FitError;
use crate::ipopt::DEFAULT_HISTORY;
use crate::simulate::Integration;
use serde::{Deserialize, Serialize};

/// Where the solver's second derivatives come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Hessian {
    /// From the first derivatives of the residuals: `2/M sum J^T W J`.
    #[default]
    GaussNewton,
    /// Exact, by second-order dual numbers.
    Exact,
    /// From the gradients of past steps (BFGS).
    LimitedMemory,
}

/// Section `[fit]` of a study.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct FitSettings {
    /// Where first derivatives come from.
    pub derivatives: Derivatives,
    /// Step of finite differences, in units of each parameter's scale.
    pub difference_step: f64,
    /// Where second derivatives come from.
    pub hessian: Hessian,
    /// Steps remembered by the limited-memory Hessian.
    pub history: usize,
    /// Optimality tolerance of the solver.
    pub tolerance: f64,
    /// Iterations after which to give up.
    pub max_iterations: usize,
    /// Newton steps within the active constraints after the solver, which end the barrier's last small bias; 0 for none.
    pub polish_steps: usize,
    /// r_max of the cost \[rad/s\].
    pub max_yaw_rate: f64,
    /// How many successive samples count as one where residuals are set against priors: residuals along a trajectory are
    /// alike, so that taking each for independent makes the data look more certain than they are.
    pub correlated_samples: f64,
    /// How often the weight of the priors is set anew from the residuals of the fit.
    pub prior_updates: usize,
    /// Whether the solver prints its log.
    pub print: bool,
    /// Constraints.
    pub constraints: ConstraintSettings,
    /// Integration of the simulation.
    pub integration: Integration,
}

impl Default for FitSettings {
    fn default() -> Self {
        Self {
            derivatives: Derivatives::default(),
            difference_step: 1e-5,
            hessian: Hessian::default(),
            history: DEFAULT_HISTORY,
            tolerance: 1e-8,
            max_iterations: 500,
            polish_steps: 10,
            max_yaw_rate: 0.0314,
            correlated_samples: 1.0,
            prior_updates: 10,
            print: false,
            constraints: ConstraintSettings::default(),
            integration: Integration::default(),
        }
    }
}

impl FitSettings {
    pub(super) fn check(&self) -> Result<(), FitError> {
        let positive = [
            ("difference_step", self.difference_step),
            ("tolerance", self.tolerance),
            ("max_yaw_rate", self.max_yaw_rate),
            ("correlated_samples", self.correlated_samples),
        ];
        match positive.iter().find(|(_, value)| !(value.is_finite() && *value > 0.0)) {
            Some((name, value)) => {
                Err(FitError::BadSetting { name, value: *value, expected: "it must be a positive number" })
            }
            None => Ok(()),
        }
    }

    pub(super) fn cost_options(&self) -> CostOptions {
        CostOptions {
            max_yaw_rate: self.max_yaw_rate,
            derivatives: self.derivatives,
            difference_step: self.difference_step,
            integration: self.integration,
        }
    }
}
