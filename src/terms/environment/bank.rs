//! Suction towards the nearer bank of a channel, with a moment that turns the bow away from it.
//! It needs the distances to both banks; an unrecorded bank cannot be distinguished from other forces fixed to the ship.

use crate::parameter::ParameterInfo;
use crate::physics::Flow;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Instant, Physics, Reach, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::state::Force;
use crate::terms::size;
use trimtab_ad::Scalar;

/// Bank suction.
pub struct Bank;

static INFO: TermInfo = TermInfo {
    name: "bank",
    title: "bank suction",
    group: Group::Environment,
    equation: "eta = B (1/y_s - 1/y_p); Y = suction 1/2 rho L d u^2 eta (towards the bank), N = -moment 1/2 rho L^2 d u^2 eta (bow away)",
    source: "Norrbin's form, linear in 1/distance; coefficients of low certainty",
    needs: &["bank"],
    validity: Validity::any("the form is linear in 1/distance, and the source that was read gives no range"),
    mechanisms: &[Mechanism {
        name: "bank",
        title: "bank suction",
        kind: Kind::Environment,
        parameters: &["suction", "moment"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: false,
        by_session: false,
        stand_in: false,
        look_alikes: &[],
        trial: "the same track close to the bank and in midstream",
    }],
    parameters: &[
        ParameterInfo::new("suction", "c_y", "-", "suction coefficient, about 0.1 in deep water")
            .scale(|_| 0.1)
            .spread(|_| 0.2)
            .bounds(0.0, 2.0),
        ParameterInfo::new("moment", "c_n", "-", "bow-out moment coefficient, about a quarter of that")
            .scale(|_| 0.025)
            .spread(|_| 0.05)
            .bounds(0.0, 1.0),
    ],
};

impl Term for Bank {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }

    fn reach(&self, _parameter: usize) -> Reach {
        Reach::LinearForce
    }
}

impl<S: Scalar> Physics<S> for Bank {
    fn force(&self, p: &[S::Coefficient], at: &Instant<S>, flow: &Flow<S>) -> Force<S> {
        let pressure = flow.u * flow.u * at.inputs.bank * (at.ship.hull.breadth * size::pressure(at.ship));
        Force { x: S::zero(), y: pressure * p[0], n: -(pressure * p[1]) * at.ship.hull.lpp }
    }
}
