//! The instant at which physics is evaluated: ship, form, state and inputs.
//! It computes nothing; what the terms share at it is the flow.

use crate::ship::Ship;
use crate::state::{Inputs, State};

/// How the low-speed and astern behaviour of hull and resistance is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Form {
    /// As printed: terms scaled with U >= 0, resistance an even-odd mix in u.
    #[default]
    Paper,
    /// Fore-aft consistent: the odd (Munk-type) terms change sign with u and resistance opposes motion either way.
    Regular,
}

/// The instant at which physics is evaluated.
#[derive(Clone, Copy, Debug)]
pub struct Instant<'a, S> {
    /// The ship.
    pub ship: &'a Ship,
    /// Low-speed form of hull and resistance.
    pub form: Form,
    /// The state, velocities over ground.
    pub state: &'a State<S>,
    /// Inputs at this instant.
    pub inputs: &'a Inputs<S>,
}
