//! A rate gyro that reads a constant too much.
//! It acts on the yaw-rate channel only; it is identifiable from the heading channel.

use crate::parameter::ParameterInfo;
use crate::physics::Flow;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Instant, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::state::STATES;
use trimtab_ad::Scalar;

/// Yaw-rate bias.
pub struct YawRateBias;

static INFO: TermInfo = TermInfo {
    name: "yaw_rate_bias",
    title: "yaw-rate bias",
    group: Group::Sensor,
    equation: "r_m = r + b",
    source: "constant bias, no source",
    needs: &[],
    validity: Validity::any("exact kinematics of a sensor"),
    mechanisms: &[Mechanism {
        name: "yaw_rate_bias",
        title: "a bias of the rate gyro",
        kind: Kind::Sensor,
        parameters: &["bias"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: false,
        by_session: false,
        stand_in: false,
        look_alikes: &[],
        trial: "a minute at rest",
    }],
    parameters: &[ParameterInfo::new("bias", "b", "rad/s", "reported minus true yaw rate")
        .scale(|_| 0.001)
        .spread(|_| 0.002)
        .bounds(-0.1, 0.1)
        .odd()],
};

impl Term for YawRateBias {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }
}

impl<S: Scalar> Physics<S> for YawRateBias {
    fn measure(
        &self,
        p: &[S::Coefficient],
        _at: &Instant<S>,
        _flow: &Flow<S>,
        _rate: &[S; STATES],
        y: &mut [S; STATES],
    ) {
        y[5] = y[5] + p[0];
    }
}
