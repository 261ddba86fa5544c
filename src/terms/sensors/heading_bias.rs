//! A compass that reads a constant too much.
//! It acts on the heading channel only; it is identifiable because the track does not follow the reported heading.

use crate::parameter::ParameterInfo;
use crate::physics::Flow;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Instant, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::state::STATES;
use trimtab_ad::Scalar;

/// Heading bias.
pub struct HeadingBias;

static INFO: TermInfo = TermInfo {
    name: "heading_bias",
    title: "heading bias",
    group: Group::Sensor,
    equation: "psi_m = psi + b",
    source: "constant bias, no source",
    needs: &[],
    validity: Validity::any("exact kinematics of a sensor"),
    mechanisms: &[Mechanism {
        name: "heading_bias",
        title: "a bias of the compass",
        kind: Kind::Sensor,
        parameters: &["bias"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: false,
        by_session: false,
        stand_in: false,
        look_alikes: &["sway_log_bias", "current"],
        trial: "reciprocal straight runs",
    }],
    parameters: &[ParameterInfo::new("bias", "b", "rad", "reported minus true heading")
        .scale(|_| 0.0175)
        .spread(|_| 0.035)
        .bounds(-0.5, 0.5)
        .odd()],
};

impl Term for HeadingBias {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }
}

impl<S: Scalar> Physics<S> for HeadingBias {
    fn measure(
        &self,
        p: &[S::Coefficient],
        _at: &Instant<S>,
        _flow: &Flow<S>,
        _rate: &[S; STATES],
        y: &mut [S; STATES],
    ) {
        y[2] = y[2] + p[0];
    }
}
