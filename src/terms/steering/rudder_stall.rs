//! Loss of rudder lift at large angles of attack.
//! Lift only; the drag curve does not change. The paper's cubic already bends over near 28 degrees and absorbs much of the loss.

use crate::parameter::ParameterInfo;
use crate::physics::Adjust;
use crate::physics::Probe;
use crate::physics::{Group, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::physics::{Validity, degrees};
use crate::ship::Ship;
use crate::state::Inputs;
use trimtab_ad::Scalar;

/// Rudder stall.
pub struct RudderStall;

static INFO: TermInfo = TermInfo {
    name: "rudder_stall",
    title: "rudder stall",
    group: Group::Rudder,
    equation: "c_L -> c_L (1 - loss s), s from 0 to 1 as |a| goes from onset to onset + 6 deg",
    source: "linear lift up to stall and a drop of 20 to 40 % after it, at 27 to 40 deg in the slipstream; the smooth step is trimtab's",
    needs: &[],
    validity: Validity {
        attack: Some([0.0, degrees(45.0)]),
        source: "stall angles of 27 to 40 deg; beyond 45 deg the rudder of the base model is a flat plate",
        ..Validity::ANY
    },
    mechanisms: &[Mechanism {
        name: "rudder_stall",
        title: "rudder stall",
        kind: Kind::Ship,
        parameters: &["loss"],
        companions: &["onset"],
        probe: Probe::Tangent,
        needs_reference: true,
        by_session: false,
        stand_in: false,
        look_alikes: &["crossflow", "rudder_limit", "rudder_rate"],
        trial: "turning circles at 20, 30 and 35 degrees of rudder",
    }],
    parameters: &[
        ParameterInfo::new("loss", "k_s", "-", "fraction of lift lost beyond stall").scale(|_| 0.3).bounds(0.0, 1.0),
        ParameterInfo::new("onset", "a_s", "rad", "angle of attack at which lift begins to be lost")
            .default(|_| 0.44)
            .scale(|_| 0.05)
            .spread(|_| 0.07)
            .bounds(0.3, 0.7),
    ],
};

impl Term for RudderStall {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }
}

impl<S: Scalar> Physics<S> for RudderStall {
    fn adjust(&self, p: &[S], _ship: &Ship, _inputs: &Inputs<S>, adjust: &mut Adjust<S>) {
        adjust.stall += p[0];
        adjust.stall_onset = p[1];
    }
}
