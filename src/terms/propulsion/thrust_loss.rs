//! A loss of thrust in proportion: a fouled, damaged or badly known propeller.
//! The propeller race at the rudder follows from the thrust and weakens with it; torque is not modelled.

use crate::parameter::ParameterInfo;
use crate::physics::Adjust;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::ship::Ship;
use crate::state::Inputs;
use trimtab_ad::Scalar;

/// Loss of thrust.
pub struct ThrustLoss;

static INFO: TermInfo = TermInfo {
    name: "thrust_loss",
    title: "loss of thrust",
    group: Group::Propulsion,
    equation: "T -> (1 - k) T",
    source: "proportional loss, no source",
    needs: &[],
    validity: Validity::any("a proportion of the thrust, no law of its own"),
    mechanisms: &[Mechanism {
        name: "thrust_loss",
        title: "loss of thrust",
        kind: Kind::Ship,
        parameters: &["fraction"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: true,
        by_session: false,
        stand_in: false,
        look_alikes: &["fouling"],
        trial: "bollard pull and speed runs before and after",
    }],
    parameters: &[ParameterInfo::new("fraction", "k", "-", "fraction of thrust lost").scale(|_| 0.1).bounds(0.0, 0.9)],
};

impl Term for ThrustLoss {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }
}

impl<S: Scalar> Physics<S> for ThrustLoss {
    fn adjust(&self, p: &[S], _ship: &Ship, _inputs: &Inputs<S>, adjust: &mut Adjust<S>) {
        adjust.thrust *= S::one() - p[0];
    }
}
