//! A speed log that reads a constant too much across the ship.
//! It differs from a current in that it turns with the ship.

use crate::parameter::ParameterInfo;
use crate::physics::Flow;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Instant, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::state::STATES;
use trimtab_ad::Scalar;

/// Sway-log bias.
pub struct SwayLogBias;

static INFO: TermInfo = TermInfo {
    name: "sway_log_bias",
    title: "sway-log bias",
    group: Group::Sensor,
    equation: "v_m = v + b",
    source: "constant bias, no source",
    needs: &[],
    validity: Validity::any("exact kinematics of a sensor"),
    mechanisms: &[Mechanism {
        name: "sway_log_bias",
        title: "a bias of the sway log",
        kind: Kind::Sensor,
        parameters: &["bias"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: false,
        by_session: false,
        stand_in: false,
        look_alikes: &["heading_bias", "current"],
        trial: "reciprocal straight runs",
    }],
    parameters: &[ParameterInfo::new("bias", "b", "m/s", "reported minus true sway velocity, to starboard")
        .scale(|_| 0.05)
        .spread(|_| 0.1)
        .bounds(-2.0, 2.0)
        .odd()],
};

impl Term for SwayLogBias {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }
}

impl<S: Scalar> Physics<S> for SwayLogBias {
    fn measure(
        &self,
        p: &[S::Coefficient],
        _at: &Instant<S>,
        _flow: &Flow<S>,
        _rate: &[S; STATES],
        y: &mut [S; STATES],
    ) {
        y[4] = y[4] + p[0];
    }
}
