//! Cross-flow drag of the hull in strips, beyond the quadratic damping of the base model.
//! One drag coefficient for all strips, with weights of the yaw rate in force and moment, in which measured hulls differ. It matters
//! at large drift and in turns on the spot; it is not the quadratic damping Y_vv of the base model.

use crate::parameter::ParameterInfo;
use crate::physics::Flow;
use crate::physics::Probe;
use crate::physics::{Group, Instant, Physics, Reach, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::physics::{Validity, degrees};
use crate::state::Force;
use trimtab_ad::Scalar;

/// Cross-flow drag at large drift.
pub struct Crossflow;

/// Integrals over -1 to 1 of `w|w|` and `w|w| s` for `w = a + b s`, cubic in each of the two cases.
///
/// No sign change within (|b| <= |a|): `sgn(a) (2 a^2 + 2/3 b^2)` and `4/3 |a| b`; otherwise `2 a|b| + 2/3 a^3/|b|` and
/// `sgn(b) (a^2 + b^2/2 - a^4/(6 b^2))`. They join with continuous second derivatives.
pub fn strip_integrals<S: Scalar>(a: S, b: S) -> [S; 2] {
    let (abs_a, abs_b) = (a.abs(), b.abs());
    let changes = abs_a.less(abs_b);
    // The divisor of the second case, kept off zero where that case is not taken.
    let q = a / abs_b.max(abs_a).max(S::from_f64(f64::MIN_POSITIVE.sqrt()));
    let sign_a = S::select(a.less(S::zero()), -S::one(), S::one());
    let sway =
        S::select(changes, a * abs_b * 2.0 + a * a * q * (2.0 / 3.0), (a * a * 2.0 + b * b * (2.0 / 3.0)) * sign_a);
    let turn = (a * a + b * b * 0.5 - a * a * q * q / 6.0) * S::select(b.less(S::zero()), -S::one(), S::one());
    let yaw = S::select(changes, turn, abs_a * b * (4.0 / 3.0));
    [sway, yaw]
}

static INFO: TermInfo = TermInfo {
    name: "crossflow",
    title: "cross-flow drag at large drift",
    group: Group::Hull,
    equation: "Y = -1/2 rho d C_D int |v + C_rY x r| (v + C_rY x r) dx, N = -1/2 rho d C_D int |v + C_rN x r| (v + C_rN x r) x dx over the length",
    source: "strip theory with Hoerner's drag coefficients as in Fossen's Marine Systems Simulator (weights of 1), and Yoshimura's low-speed model (2.2 and 0.8 for Esso Osaka); integrals in closed form",
    needs: &[],
    validity: Validity {
        drift: Some([0.0, degrees(90.0)]),
        turn: Some([0.0, f64::INFINITY]),
        depth: Some([1.5, f64::INFINITY]),
        widens: &["hull"],
        source: "strip theory for drift up to 90 deg and turning on the spot; drag coefficients of deep water, with a strong growth below h/d = 1.5 that is not modelled (engineering limit)",
        ..Validity::ANY
    },
    mechanisms: &[Mechanism {
        name: "crossflow",
        title: "cross-flow drag at large drift",
        kind: Kind::Ship,
        parameters: &["drag"],
        companions: &["turn_force", "turn_moment"],
        probe: Probe::Tangent,
        needs_reference: true,
        by_session: false,
        stand_in: false,
        look_alikes: &["shallow", "hull_nonlinear"],
        trial: "drifting sideways and turning on the spot",
    }],
    parameters: &[
        ParameterInfo::new("drag", "C_D", "-", "drag coefficient beyond the base model's; 0.6 to 1.0 with it")
            .scale(|_| 0.2)
            .spread(|_| 0.3)
            .bounds(0.0, 2.0),
        ParameterInfo::new("turn_force", "C_rY", "-", "weight of the yaw rate in the sway force")
            .default(|_| 1.0)
            .scale(|_| 0.5)
            .spread(|_| 0.8)
            .bounds(0.0, 4.0),
        ParameterInfo::new("turn_moment", "C_rN", "-", "weight of the yaw rate in the yaw moment")
            .default(|_| 1.0)
            .scale(|_| 0.2)
            .spread(|_| 0.2)
            .bounds(0.0, 2.0),
    ],
};

impl Term for Crossflow {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }

    fn reach(&self, _parameter: usize) -> Reach {
        Reach::Force
    }
}

impl<S: Scalar> Physics<S> for Crossflow {
    fn force(&self, p: &[S::Coefficient], at: &Instant<S>, flow: &Flow<S>) -> Force<S> {
        let hull = &at.ship.hull;
        let half = 0.5 * hull.lpp;
        let [sway, _] = strip_integrals(flow.v, p[1] * flow.r * half);
        let [_, yaw] = strip_integrals(flow.v, p[2] * flow.r * half);
        let pressure = p[0] * (-0.5 * hull.water_density * hull.draught * half);
        Force { x: S::zero(), y: pressure * sway, n: pressure * yaw * half }
    }
}
