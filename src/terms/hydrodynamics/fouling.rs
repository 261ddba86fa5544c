//! A resistance that is higher in proportion: a fouled hull, or added resistance of any kind.
//! Within one loading and one season it cannot be distinguished from p1 to p3; it is meant for differences between sessions.

use crate::parameter::ParameterInfo;
use crate::physics::Adjust;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::ship::Ship;
use crate::state::Inputs;
use trimtab_ad::Scalar;

/// Fouling.
pub struct Fouling;

static INFO: TermInfo = TermInfo {
    name: "fouling",
    title: "fouling",
    group: Group::Hull,
    equation: "R -> (1 + f) R",
    source: "proportional increase, no source",
    needs: &[],
    validity: Validity::any("a proportion of the resistance, no law of its own"),
    mechanisms: &[Mechanism {
        name: "fouling",
        title: "hull fouling",
        kind: Kind::Ship,
        parameters: &["fraction"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: true,
        by_session: false,
        stand_in: false,
        look_alikes: &["thrust_loss"],
        trial: "speed runs before and after docking",
    }],
    parameters: &[ParameterInfo::new("fraction", "f", "-", "relative increase of resistance")
        .scale(|_| 0.1)
        .bounds(0.0, 3.0)],
};

impl Term for Fouling {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }
}

impl<S: Scalar> Physics<S> for Fouling {
    fn adjust(&self, p: &[S], _ship: &Ship, _inputs: &Inputs<S>, adjust: &mut Adjust<S>) {
        adjust.resistance *= p[0] + 1.0;
    }
}
