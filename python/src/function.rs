//! What an objective evaluates, one like the other: the trajectory cost, or the likelihood with the gains of its filter fixed.
//! It does not depend on Python, priors or constraints.

use serde::{Deserialize, Serialize};
use std::sync::Arc;
use trimtab::fit::{Compared, Cost, FitError, FitSettings, Innovations, Quadratic, Residuals};
use trimtab::likelihood::noise::Noise;
use trimtab::recording::Run;

/// The noise and the point of a likelihood's gains.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Made {
    pub noise: Noise,
    /// The free parameters.
    pub at: Vec<f64>,
}

/// What a function is of.
pub struct Question {
    pub model: trimtab::Model,
    pub runs: Arc<Vec<Run>>,
    /// Of a likelihood.
    pub made: Option<Made>,
}

/// A function of the free parameters.
pub enum Function<'a> {
    Trajectory(Box<Cost<'a>>),
    Likelihood(Box<Innovations<'a>>),
}

impl<'a> Function<'a> {
    /// The function of a question.
    pub fn new(question: &'a Question, settings: &FitSettings) -> Result<Self, FitError> {
        let Question { model, runs, made } = question;
        let Some(made) = made else {
            return Cost::new(model, &**runs, settings.cost_options()).map(|cost| Self::Trajectory(Box::new(cost)));
        };
        let innovations = Innovations::new(model, runs, settings.integration, made.noise, &made.at)?;
        Ok(Self::Likelihood(Box::new(innovations)))
    }

    /// The value; `None` where the model leaves the numbers, here and below.
    pub fn value(&self, p: &[f64]) -> Option<f64> {
        match self {
            Self::Trajectory(cost) => cost.value(p),
            Self::Likelihood(innovations) => innovations.value(p),
        }
    }

    /// The value with its gradient and Gauss-Newton matrix.
    pub fn quadratic(&self, p: &[f64]) -> Option<Quadratic> {
        match self {
            Self::Trajectory(cost) => cost.quadratic(p),
            Self::Likelihood(innovations) => innovations.quadratic(p),
        }
    }

    /// The exact Hessian, of a trajectory cost.
    pub fn hessian(&self, p: &[f64]) -> Option<Vec<f64>> {
        match self {
            Self::Trajectory(cost) => cost.hessian(p).map(|h| h.iter().copied().collect()),
            Self::Likelihood(_) => None,
        }
    }

    /// The residuals.
    pub fn residuals_at(&self, p: &[f64]) -> Option<Residuals> {
        match self {
            Self::Trajectory(cost) => cost.residuals_at(p),
            Self::Likelihood(innovations) => innovations.residuals_at(p),
        }
    }

    /// The residuals with their slopes.
    pub fn jacobian_at(&self, p: &[f64]) -> Option<Residuals> {
        match self {
            Self::Trajectory(cost) => cost.jacobian_at(p),
            Self::Likelihood(innovations) => innovations.jacobian_at(p),
        }
    }

    /// What each residual compares; `None` where a run cannot be read.
    pub fn compared(&self) -> Option<Vec<Compared>> {
        match self {
            Self::Trajectory(cost) => cost.compared(),
            Self::Likelihood(innovations) => Some(innovations.compared()),
        }
    }

    /// Number of residuals.
    pub fn count(&self) -> usize {
        match self {
            Self::Trajectory(cost) => cost.residuals(),
            Self::Likelihood(innovations) => innovations.compared().len(),
        }
    }
}
