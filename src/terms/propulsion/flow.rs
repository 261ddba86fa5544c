//! The pseudo-term with the parameters of the flow: wake, thrust, propeller race and rudder inflow.
//! It gives no force; [`Flow::new`](crate::physics::Flow::new) uses the parameters.

use crate::parameter::ParameterInfo;
use crate::physics::Validity;
use crate::physics::{Group, Physics, Reach, Term, TermInfo};
use crate::ship::Ship;
use trimtab_ad::Scalar;

/// The pseudo-term with the parameters of [`Flow`](crate::physics::Flow).
pub struct FlowTerm;

/// A tenth of K_T at rest; of a craft without propeller, whose K_T is 0, that of a usual one.
fn thrust_scale(ship: &Ship) -> f64 {
    let at_rest = ship.propeller.thrust_coefficients[0];
    if at_rest == 0.0 { 0.035 } else { 0.1 * at_rest }
}

static INFO: TermInfo = TermInfo {
    name: "flow",
    title: "propeller thrust, wake and rudder inflow",
    group: Group::Propulsion,
    equation: "T = rho n^2 D^4 K_T(J), K_T = k0 + k1 J + k2 J^2, J = (1-w) u/(n D), four quadrants; \
               u_R = eps sqrt(eta (u_P + kappa (sqrt(u_P^2 + 8T/(pi rho D^2)) - u_P))^2 + (1-eta) u_P^2); v_R = -gamma (v + l_R r)",
    source: "Yasukawa & Yoshimura 2015, J. Mar. Sci. Technol. 20, eq. 11-14 and 22-26; reversal by Yasukawa's factor",
    needs: &[],
    validity: Validity {
        advance: Some([-0.5, 0.8]),
        reversing: Some([-1.0, 0.8]),
        source: "four-quadrant chart of the Wageningen B4-70 (Roddy, Hess & Faller 2006), with which the quadratic was compared from J = 0 to 0.8 ahead and to -1 reversing; below J = -0.5 ahead low-speed MMG codes leave the polynomial (Yasukawa's extension); a shaft at rest in a moving ship is outside",
        ..Validity::ANY
    },
    mechanisms: &[],
    parameters: &[
        ParameterInfo::new("wake", "w", "-", "effective wake fraction")
            .default(|s| s.propeller.wake)
            .scale(|_| 0.05)
            .spread(|_| 0.08)
            .bounds(0.0, 0.9),
        ParameterInfo::new("thrust_deduction", "t", "-", "thrust deduction, thrust ahead")
            .default(|s| s.propeller.thrust_deduction)
            .scale(|_| 0.05)
            .spread(|_| 0.06)
            .bounds(0.0, 0.8),
        ParameterInfo::new("kt0", "k0", "-", "thrust coefficient at J = 0")
            .default(|s| s.propeller.thrust_coefficients[0])
            .scale(thrust_scale)
            .spread(|s| 0.15 * s.propeller.thrust_coefficients[0])
            .bounds(0.0, 2.0),
        ParameterInfo::new("kt1", "k1", "-", "slope of the thrust coefficient")
            .default(|s| s.propeller.thrust_coefficients[1])
            .scale(thrust_scale)
            .spread(|s| 0.3 * s.propeller.thrust_coefficients[0])
            .bounds(-2.0, 0.0),
        ParameterInfo::new("kt2", "k2", "-", "curvature of the thrust coefficient")
            .default(|s| s.propeller.thrust_coefficients[2])
            .scale(thrust_scale)
            .spread(|s| 0.3 * s.propeller.thrust_coefficients[0])
            .bounds(-2.0, 1.0),
        ParameterInfo::new("astern", "b_t", "-", "thrust astern over thrust ahead, at rest")
            .default(|s| s.propeller.astern)
            .scale(|_| 0.1)
            .spread(|_| 0.2)
            .bounds(0.0, 2.0),
        ParameterInfo::new("wake_ratio", "eps", "-", "wake at the rudder over wake at the propeller")
            .default(|s| s.rudder.wake_ratio)
            .scale(|_| 0.1)
            .spread(|_| 0.3)
            .bounds(0.0, 3.0),
        ParameterInfo::new("race", "kappa", "-", "propeller race factor at the rudder")
            .default(|s| s.rudder.race)
            .scale(|_| 0.1)
            .spread(|_| 0.2)
            .bounds(0.0, 2.0),
        ParameterInfo::new("race_astern", "kappa_a", "-", "inflow taken from the rudder by a propeller turning astern")
            .default(|_| 0.144)
            .scale(|_| 0.05)
            .spread(|_| 0.15)
            .bounds(-1.0, 1.0),
        ParameterInfo::new("straightening", "gamma", "-", "flow straightening of the lateral rudder inflow")
            .default(|s| s.rudder.straightening)
            .scale(|_| 0.1)
            .spread(|_| 0.15)
            .bounds(0.0, 2.0),
        ParameterInfo::new("asymmetry", "dgamma", "-", "port-starboard difference of the flow straightening")
            .scale(|_| 0.05)
            .spread(|_| 0.1)
            .bounds(-1.0, 1.0)
            .odd(),
        ParameterInfo::new("lever", "l_R/L", "-", "effective position of the rudder in the inflow over L")
            .default(|s| s.rudder.lever)
            .scale(|_| 0.1)
            .spread(|_| 0.2)
            .bounds(-2.0, 0.0),
    ],
};

impl FlowTerm {
    /// The thrust coefficient K_T at an advance ratio J of a propeller that turns ahead.
    pub fn thrust_coefficient<S: Scalar>(p: &[S], j: S) -> S {
        p[2] + j * (p[3] + j * p[4])
    }
}

impl Term for FlowTerm {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }

    fn reach(&self, _parameter: usize) -> Reach {
        Reach::Flow
    }
}

impl<S: Scalar> Physics<S> for FlowTerm {}
