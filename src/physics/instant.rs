//! The instant at which physics is evaluated: ship, form, state and inputs.
//! It computes nothing; what the terms share at it is the flow.

use crate::ship::Ship;
use crate::state::{Inputs, State};
use trimtab_ad::Scalar;

/// How the low-speed and astern behaviour of hull and resistance is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Form {
    /// As printed: terms scaled with U >= 0, resistance an even-odd mix in u.
    #[default]
    Paper,
    /// Fore-aft consistent: the odd (Munk-type) terms change sign with u and resistance opposes motion either way.
    Regular,
    /// The standard method of the MMG group as Yasukawa & Yoshimura 2015 print it: hull, wake in a turn and rudder from the terms
    /// `mmg_hull`, `mmg_wake` and `mmg_rudder`, (m + m_x) u r in the sway equation, and the rudder's inflow by the drift angle.
    Mmg,
    /// Any craft: masses and added masses of `hull` with exact Coriolis forces and Munk moment, and the term `general_hull` for all else.
    General,
}

/// The instant at which physics is evaluated.
///
/// Inputs are coefficients: they carry derivatives only where a law is differentiated by its coefficients.
#[derive(Clone, Copy, Debug)]
pub struct Instant<'a, S: Scalar> {
    /// The ship.
    pub ship: &'a Ship,
    /// Small speed below which the dynamics are regularised \[m/s\], [`Ship::small_speed`].
    pub small: f64,
    /// Low-speed form of hull and resistance.
    pub form: Form,
    /// The state, velocities over ground.
    pub state: &'a State<S>,
    /// Sine and cosine of the heading.
    pub heading: [S; 2],
    /// Inputs at this instant.
    pub inputs: &'a Inputs<S::Coefficient>,
}

impl<'a, S: Scalar> Instant<'a, S> {
    /// An instant of a state under inputs.
    #[inline(always)]
    pub fn new(ship: &'a Ship, form: Form, state: &'a State<S>, inputs: &'a Inputs<S::Coefficient>) -> Self {
        let (sin, cos) = state.psi.sin_cos();
        Self { ship, small: ship.small_speed(), form, state, heading: [sin, cos], inputs }
    }

    /// An earth-fixed (north, east) vector in body axes (forward, starboard).
    #[inline(always)]
    pub fn to_body(&self, [north, east]: [S::Coefficient; 2]) -> [S; 2] {
        let [sin, cos] = self.heading;
        [cos * north + sin * east, cos * east - sin * north]
    }
}
