//! A speed log that measures velocity through the water but is read as velocity over ground.
//! Without a current in the model it has no effect.

use crate::parameter::ParameterInfo;
use crate::physics::Flow;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Instant, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::state::STATES;
use trimtab_ad::Scalar;

/// Ground/water speed mix-up.
pub struct WaterLog;

static INFO: TermInfo = TermInfo {
    name: "water_log",
    title: "ground/water speed mix-up",
    group: Group::Sensor,
    equation: "(u, v)_m = (u, v) - share V_c in body axes",
    source: "kinematics",
    needs: &[],
    validity: Validity::any("exact kinematics of a sensor"),
    mechanisms: &[Mechanism {
        name: "water_log",
        title: "a speed log that reads through the water",
        kind: Kind::Sensor,
        parameters: &["share"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: false,
        by_session: false,
        stand_in: false,
        look_alikes: &["current", "log_scale"],
        trial: "reciprocal runs in the current",
    }],
    parameters: &[ParameterInfo::new(
        "share",
        "s",
        "-",
        "share of the current missing from the reported velocity; 1 for a log that measures through the water",
    )
    .scale(|_| 1.0)
    .spread(|_| 1.0)
    .bounds(0.0, 1.0)],
};

impl Term for WaterLog {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }
}

impl<S: Scalar> Physics<S> for WaterLog {
    fn measure(
        &self,
        p: &[S::Coefficient],
        _at: &Instant<S>,
        flow: &Flow<S>,
        _rate: &[S; STATES],
        y: &mut [S; STATES],
    ) {
        y[3] -= flow.current[0] * p[0];
        y[4] -= flow.current[1] * p[0];
    }
}
