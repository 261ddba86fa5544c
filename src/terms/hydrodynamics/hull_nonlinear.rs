//! Hull forces of higher order in drift and turn, which the base model leaves out.
//! The N_vvr and N_vrr of the cubic model are already in `hull`; coefficients are dimensionless, with 1/2 rho L d.

use crate::parameter::ParameterInfo;
use crate::physics::Flow;
use crate::physics::Probe;
use crate::physics::{Group, Instant, Physics, Reach, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::physics::{Validity, degrees};
use crate::state::Force;
use crate::terms::size;
use trimtab_ad::Scalar;

/// Other hull nonlinearity.
pub struct HullNonlinear;

static INFO: TermInfo = TermInfo {
    name: "hull_nonlinear",
    title: "other hull nonlinearity",
    group: Group::Hull,
    equation: "V^2 = u^2 + v^2 + (r L/2)^2; X = 1/2 rho L d (X_vv v^2 + X_rr r^2 L^2 + X_vvvv v^4/V^2), Y = 1/2 rho L d (Y_vvv v^3 + Y_vvr v^2 r L + Y_vrr v r^2 L^2 + Y_rrr r^3 L^3)/V, N = 1/2 rho L^2 d (N_vvv v^3 + N_rrr r^3 L^3)/V",
    source: "cubic hull force of Yasukawa & Yoshimura 2015, with V for U so that turning on the spot stays finite",
    needs: &[],
    validity: Validity {
        froude: Some([0.0, 0.25]),
        drift: Some([0.0, degrees(20.0)]),
        turn: Some([0.0, 1.4]),
        source: "Yasukawa & Yoshimura 2015, as `hull`: a series in drift and turn, for headway without wave making; the numbers are engineering limits",
        ..Validity::ANY
    },
    mechanisms: &[Mechanism {
        name: "hull_nonlinear",
        title: "further hull nonlinearity",
        kind: Kind::Ship,
        parameters: &["X_vv", "X_rr", "Y_vvv", "Y_vrr", "N_vvv", "N_rrr"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: true,
        by_session: false,
        stand_in: false,
        look_alikes: &["crossflow"],
        trial: "turning circles at several rudder angles",
    }],
    parameters: &[
        ParameterInfo::new("X_vv", "X_vv", "-", "surge force of drift").scale(|_| 0.03).spread(|_| 0.06),
        ParameterInfo::new("X_rr", "X_rr", "-", "surge force of turn").scale(|_| 0.01).spread(|_| 0.02),
        ParameterInfo::new("X_vvvv", "X_vvvv", "-", "surge force of large drift").scale(|_| 0.5).spread(|_| 1.0),
        ParameterInfo::new("Y_vvv", "Y_vvv", "-", "cubic sway damping").scale(|_| 0.5).spread(|_| 1.0),
        ParameterInfo::new("Y_vvr", "Y_vvr", "-", "sway force of v^2 r").scale(|_| 0.3).spread(|_| 0.6),
        ParameterInfo::new("Y_vrr", "Y_vrr", "-", "sway force of v r^2").scale(|_| 0.3).spread(|_| 0.6),
        ParameterInfo::new("Y_rrr", "Y_rrr", "-", "cubic sway force of turn").scale(|_| 0.02).spread(|_| 0.04),
        ParameterInfo::new("N_vvv", "N_vvv", "-", "cubic yaw moment of drift").scale(|_| 0.1).spread(|_| 0.2),
        ParameterInfo::new("N_rrr", "N_rrr", "-", "cubic yaw damping").scale(|_| 0.01).spread(|_| 0.02),
    ],
};

impl Term for HullNonlinear {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }

    fn reach(&self, _parameter: usize) -> Reach {
        Reach::LinearForce
    }
}

impl<S: Scalar> Physics<S> for HullNonlinear {
    fn force(&self, p: &[S::Coefficient], at: &Instant<S>, flow: &Flow<S>) -> Force<S> {
        let ship = at.ship;
        let l = ship.hull.lpp;
        let small = at.small;
        let (v, r) = (flow.v, flow.r * l);
        let square = flow.u * flow.u + v * v + r * r * 0.25 + small * small;
        let inverse = S::one() / square.sqrt();
        let (vv, rr) = (v * v, r * r);
        let unit = size::pressure(ship);
        Force {
            x: (vv * p[0] + rr * p[1] + vv * vv * p[2] / square) * unit,
            y: (vv * v * p[3] + vv * r * p[4] + v * rr * p[5] + rr * r * p[6]) * inverse * unit,
            n: (vv * v * p[7] + rr * r * p[8]) * inverse * (unit * l),
        }
    }
}
