//! An additional destabilising yaw moment of drift, as potential flow gives it.
//! It is odd in u and changes sign with the direction of motion; the base model's N_v U v does not.

use crate::parameter::ParameterInfo;
use crate::physics::Flow;
use crate::physics::Probe;
use crate::physics::{Group, Instant, Physics, Reach, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::physics::{Validity, degrees};
use crate::state::Force;
use crate::terms::size;
use trimtab_ad::Scalar;

/// Munk moment.
pub struct Munk;

static INFO: TermInfo = TermInfo {
    name: "munk",
    title: "Munk moment",
    group: Group::Hull,
    equation: "N = -k 1/2 rho L^2 d u v",
    source: "potential flow about a slender body (Munk)",
    needs: &[],
    validity: Validity {
        drift: Some([0.0, degrees(20.0)]),
        source: "potential flow about a slender body, before the flow separates; the number 20 deg is an engineering limit as in `hull`",
        ..Validity::ANY
    },
    mechanisms: &[Mechanism {
        name: "munk",
        title: "unstable yaw moment of drift",
        kind: Kind::Ship,
        parameters: &["factor"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: true,
        by_session: false,
        stand_in: false,
        look_alikes: &["loading", "shallow"],
        trial: "pull-out from a turn with rudder amidships",
    }],
    parameters: &[ParameterInfo::new("factor", "k", "-", "moment coefficient, 0.2 for a slender body")
        .scale(|_| 0.02)
        .spread(|_| 0.05)
        .bounds(-1.0, 1.0)],
};

impl Term for Munk {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }

    fn reach(&self, _parameter: usize) -> Reach {
        Reach::LinearForce
    }
}

impl<S: Scalar> Physics<S> for Munk {
    fn force(&self, p: &[S::Coefficient], at: &Instant<S>, flow: &Flow<S>) -> Force<S> {
        let n = -(p[0] * flow.u * flow.v) * (size::pressure(at.ship) * at.ship.hull.lpp);
        Force { n, ..Force::zero() }
    }
}
