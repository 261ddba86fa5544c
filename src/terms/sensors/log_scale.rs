//! A speed log with a constant relative error, along and across.
//! Positions are not affected; they make the error identifiable.

use crate::parameter::ParameterInfo;
use crate::physics::Flow;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Instant, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::state::STATES;
use trimtab_ad::Scalar;

/// Log scale error.
pub struct LogScale;

static INFO: TermInfo = TermInfo {
    name: "log_scale",
    title: "log scale error",
    group: Group::Sensor,
    equation: "(u, v)_m = (1 + e) (u, v)",
    source: "constant scale error, no source",
    needs: &[],
    validity: Validity::any("exact kinematics of a sensor"),
    mechanisms: &[Mechanism {
        name: "log_scale",
        title: "a scale error of the speed log",
        kind: Kind::Sensor,
        parameters: &["error"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: false,
        by_session: false,
        stand_in: false,
        look_alikes: &["current", "water_log"],
        trial: "reciprocal runs over a measured mile",
    }],
    parameters: &[ParameterInfo::new("error", "e", "-", "relative error of the reported speed")
        .scale(|_| 0.03)
        .spread(|_| 0.05)
        .bounds(-0.5, 0.5)],
};

impl Term for LogScale {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }
}

impl<S: Scalar> Physics<S> for LogScale {
    fn measure(
        &self,
        p: &[S::Coefficient],
        _at: &Instant<S>,
        _flow: &Flow<S>,
        _rate: &[S; STATES],
        y: &mut [S; STATES],
    ) {
        y[3] += y[3] * p[0];
        y[4] += y[4] * p[0];
    }
}
