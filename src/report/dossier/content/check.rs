//! A check: a number beside its limit; and the distance between two simulations, on which most checks stand.

use crate::evaluate::{Outcome, outcome};
use crate::model::Model;
use crate::recording::{Run, measured};
use crate::simulate::Trajectory;
use serde::Serialize;

/// A number beside its limit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Check {
    /// Name.
    pub key: &'static str,
    /// What was computed, in words.
    pub what: String,
    /// The number.
    pub number: f64,
    /// Its unit; `-` for none.
    pub unit: &'static str,
    /// Whether the number must be at most or at least the limit.
    pub at: Bound,
    /// The limit.
    pub limit: f64,
    /// Whether the number keeps to the limit.
    pub passed: bool,
    /// Runs that it was computed on.
    pub runs: usize,
}

/// To which side of a limit a number must be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Bound {
    /// At most the limit.
    Most,
    /// At least the limit.
    Least,
}

impl Check {
    pub(super) fn most(
        key: &'static str,
        what: String,
        number: f64,
        unit: &'static str,
        limit: f64,
        runs: usize,
    ) -> Self {
        Self { key, what, number, unit, at: Bound::Most, limit, passed: number <= limit, runs }
    }
}

/// How far a trajectory is from another of the same run: cVDM \[%\], absent where one of them diverged.
pub(super) fn apart(
    run: &Run,
    model: &Model,
    found: &Trajectory,
    expected: &Trajectory,
    max_yaw_rate: f64,
) -> Option<f64> {
    if expected.diverged_at.is_some() || expected.states.len() != run.measured.len() {
        return None;
    }
    let against = Run { measured: measured(&expected.states), ..run.clone() };
    match outcome(&against, found, &model.ship, max_yaw_rate) {
        Outcome::Simulated(d) => Some(d.cvdm),
        Outcome::Diverged { .. } => None,
    }
}
