//! A rudder angle that differs from the recorded one by a constant.
//! In steady inflow it acts like `rudder.lift0`; only coasting and changes of rpm distinguish them.

use crate::parameter::ParameterInfo;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::ship::Ship;
use crate::state::Inputs;
use trimtab_ad::Scalar;

/// Rudder zero offset.
pub struct RudderOffset;

static INFO: TermInfo = TermInfo {
    name: "rudder_offset",
    title: "rudder zero offset",
    group: Group::Rudder,
    equation: "delta -> delta + offset",
    source: "constant offset, no source",
    needs: &[],
    validity: Validity::any("a constant angle"),
    mechanisms: &[Mechanism {
        name: "rudder_offset",
        title: "rudder zero offset",
        kind: Kind::Actuator,
        parameters: &["offset"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: true,
        by_session: false,
        stand_in: false,
        look_alikes: &["propeller_walk_ahead"],
        trial: "straight runs before and after the rudder is set",
    }],
    parameters: &[ParameterInfo::new("offset", "b", "rad", "true minus recorded rudder angle")
        .scale(|_| 0.0175)
        .spread(|_| 0.0175)
        .bounds(-0.35, 0.35)
        .odd()],
};

impl Term for RudderOffset {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }
}

impl<S: Scalar> Physics<S> for RudderOffset {
    fn drive(&self, p: &[S], _ship: &Ship, _dt: f64, series: &mut [Inputs<S>]) {
        for inputs in series {
            inputs.delta += p[0];
        }
    }
}
