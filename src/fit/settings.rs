//! Section `[fit]` of a study: where derivatives come from, tolerances, limits, constraints.
//! It contains values and checks them; other files use them.

use crate::fit::objectives::cost::{CostOptions, Derivatives};
use crate::fit::solver::constraints::ConstraintSettings;
use crate::ipopt::DEFAULT_HISTORY;
use crate::ranges::{Limited, OutOfRange, counted, within};
use crate::simulate::Integration;
use serde::{Deserialize, Serialize};

/// Where the solver's second derivatives come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
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

/// What a fit minimises.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Goal {
    /// The weighted squares of the differences between recorded and simulated trajectories, through every Euler step.
    #[default]
    Trajectory,
    /// Minus the log-likelihood of the recordings, with sensor noise, an unknown force and initial states, and minus the log-prior of
    /// coefficients that are never known exactly.
    Likelihood,
}

/// Section `[fit]` of a study.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FitSettings {
    /// What is minimised.
    pub objective: Goal,
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
    /// Iterations of the solver after which a fit ends, over all its solves.
    pub max_iterations: usize,
    /// Evaluations of the objective after which a fit ends, over all its solves.
    pub max_evaluations: usize,
    /// Time after which a fit ends \[s\].
    pub max_seconds: f64,
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
            objective: Goal::default(),
            derivatives: Derivatives::default(),
            difference_step: 1e-5,
            hessian: Hessian::default(),
            history: DEFAULT_HISTORY,
            tolerance: 1e-8,
            max_iterations: 1000,
            max_evaluations: 5000,
            max_seconds: 3600.0,
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

impl Limited for FitSettings {
    fn limits(&self) -> Result<(), OutOfRange> {
        within("difference_step", self.difference_step, &(1e-12..=0.1), "a step in units of each parameter's scale")?;
        counted("history", self.history, &(1..=10_000), "steps that the limited-memory Hessian remembers")?;
        within("tolerance", self.tolerance, &(1e-15..=1.0), "the optimality tolerance of the solver")?;
        counted("max_iterations", self.max_iterations, &(1..=1_000_000), "iterations of the solver")?;
        counted("max_evaluations", self.max_evaluations, &(1..=10_000_000), "evaluations of the objective")?;
        within("max_seconds", self.max_seconds, &(1e-3..=1e9), "a time in s")?;
        counted("polish_steps", self.polish_steps, &(0..=1000), "Newton steps after the solver")?;
        within("max_yaw_rate", self.max_yaw_rate, &(1e-6..=10.0), "a yaw rate in rad/s, as the ship turns at most")?;
        within("correlated_samples", self.correlated_samples, &(1.0..=1e6), "samples that count as one")?;
        counted("prior_updates", self.prior_updates, &(0..=1000), "times that the weight of the priors is set anew")?;
        self.constraints.limits()?;
        self.integration.limits()
    }
}

impl FitSettings {
    /// The part of the settings that a [`Cost`](super::Cost) takes.
    pub fn cost_options(&self) -> CostOptions {
        CostOptions {
            max_yaw_rate: self.max_yaw_rate,
            derivatives: self.derivatives,
            difference_step: self.difference_step,
            integration: self.integration,
        }
    }
}
