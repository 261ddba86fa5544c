//! The rudder of the standard MMG method: a normal force with what it induces on the hull.
//! Its inflow is that of `flow`; a model of form `mmg` has this term in place of the lift and drag curves of `rudder`.

use super::rudder::STALL_WIDTH;
use crate::parameter::{ParameterInfo, Start};
use crate::physics::Flow;
use crate::physics::{Group, Instant, Physics, Reach, Term, TermInfo};
use crate::physics::{Validity, degrees};
use crate::ship::Ship;
use crate::ship::rudder::{induced_force, normal_slope, steering_deduction};
use crate::state::Force;
use trimtab_ad::{Scalar, smooth};

/// Rudder of the standard MMG method.
pub struct MmgRudder;

/// Fujii's slope at the aspect ratio A = H_R^2/A_R.
fn fujii(s: &Ship) -> f64 {
    normal_slope(s.rudder.span * s.rudder.span / s.rudder.area)
}

static INFO: TermInfo = TermInfo {
    name: "mmg_rudder",
    title: "rudder of the standard MMG method",
    group: Group::Rudder,
    equation: "a_R = delta - atan2(v_R, u_R); F_N = 1/2 rho A_R U_R^2 f_alpha sin a_R; X = -(1 - t_R) F_N sin delta, \
               Y = -(1 + a_H) F_N cos delta, N = -(x_R + a_H x_H' L) F_N cos delta",
    source: "Yasukawa & Yoshimura 2015, J. Mar. Sci. Technol. 20, eq. 19 to 21; start values: slope by Fujii & Tsuda 1961, t_R = 0.45 - 0.28 C_b, a_H = 0.627 C_b - 0.153, x_H' = -0.45",
    needs: &[],
    validity: Validity {
        attack: Some([0.0, degrees(35.0)]),
        source: "a normal force proportional to sin a is printed for an attached flow; 35 deg is an engineering limit, beyond which a rudder stalls (`rudder_stall`)",
        ..Validity::ANY
    },
    mechanisms: &[],
    parameters: &[
        ParameterInfo::new("f_alpha", "f_alpha", "-", "slope of the normal-force coefficient")
            .in_mmg(Start::Own(fujii))
            .scale(|_| 0.2)
            .spread(|_| 0.3)
            .bounds(0.0, 10.0),
        ParameterInfo::new("t_R", "t_R", "-", "steering resistance deduction")
            .in_mmg(Start::Own(|s| steering_deduction(s.hull.block_coefficient)))
            .scale(|_| 0.1)
            .spread(|_| 0.15)
            .bounds(-1.0, 1.0),
        ParameterInfo::new("a_H", "a_H", "-", "hull force induced by the rudder, over that of the rudder")
            .in_mmg(Start::Own(|s| induced_force(s.hull.block_coefficient)))
            .scale(|_| 0.1)
            .spread(|_| 0.15)
            .bounds(-0.5, 2.0),
        ParameterInfo::new("x_H", "x_H'", "-", "where that hull force acts, over L, forward of midship")
            .in_mmg(Start::Own(|_| -0.45))
            .scale(|_| 0.05)
            .spread(|_| 0.05)
            .bounds(-1.0, 1.0),
    ],
};

impl Term for MmgRudder {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }

    fn reach(&self, _parameter: usize) -> Reach {
        Reach::Force
    }
}

impl<S: Scalar> Physics<S> for MmgRudder {
    fn force(&self, p: &[S::Coefficient], at: &Instant<S>, flow: &Flow<S>) -> Force<S> {
        let (u, v) = (flow.rudder_u, flow.rudder_v);
        let delta = at.inputs.delta;
        // sin(delta - atan2(v, u)) U_R = u sin delta - v cos delta: no angle, and no inflow gives no force.
        let (sin, cos) = delta.sin_cos();
        let speed = (u * u + v * v + 1e-12).sqrt();
        let across = u * sin - v * cos;
        let attack = (across / speed).clamp(-1.0, 1.0).abs();
        let stalled = smooth::smooth_step((attack - flow.adjust.stall_onset.sin()) / STALL_WIDTH);
        let lifting = S::one() - stalled * flow.adjust.stall;
        let normal = across * speed * lifting * (p[0] * (0.5 * at.ship.hull.water_density * at.ship.rudder.area));
        let one = S::Coefficient::one();
        let lever = p[2] * p[3] * at.ship.hull.lpp + at.ship.rudder_x();
        Force { x: -(normal * ((one - p[1]) * sin)), y: -(normal * ((one + p[2]) * cos)), n: -(normal * (lever * cos)) }
    }
}
