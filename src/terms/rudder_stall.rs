//! Loss of rudder lift at large angles of attack.
//! Lift only; drag keeps its curve. The paper's cubic already bends over near 28 degrees, and takes up much of this.

use super::{Group, Moment, Physics, Term, TermInfo};
use crate::diagnose::filter::Probe;
use crate::diagnose::mechanism::{Kind, Mechanism};
use crate::flow::Adjust;
use crate::parameter::ParameterInfo;
use trimtab_ad::Scalar;

/// Rudder stall.
pub struct RudderStall;

static INFO: TermInfo = TermInfo {
    name: "rudder_stall",
    title: "rudder stall",
    group: Group::Rudder,
    equation: "c_L -> c_L (1 - loss (|a| - 25 deg)/(15 deg)) for |a| > 25 deg",
    source: "linear loss after stall onset; onset in the slipstream 27 to 40 deg",
    needs: &[],
    mechanisms: &[Mechanism {
        name: "rudder_stall",
        title: "rudder stall",
        kind: Kind::Ship,
        parameters: &["loss"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: true,
        floor: 0.075,
        stand_in: false,
        look_alikes: &["crossflow", "rudder_rate"],
        trial: "turning circles at 20, 30 and 35 degrees of rudder",
    }],
    parameters: &[ParameterInfo::new("loss", "k_s", "-", "fraction of lift lost at 40 degrees")
        .scale(|_| 0.3)
        .bounds(0.0, 1.0)],
};

impl Term for RudderStall {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }
}

impl<S: Scalar> Physics<S> for RudderStall {
    fn adjust(&self, p: &[S], _at: &Moment<S>, adjust: &mut Adjust<S>) {
        adjust.stall += p[0];
    }
}
