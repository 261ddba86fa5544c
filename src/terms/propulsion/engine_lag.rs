//! First-order lag between the recorded propeller rate, taken as an order, and the shaft.
//! No torque balance and no reversing delay; a measured shaft rate has no lag.

use crate::parameter::ParameterInfo;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::ship::Ship;
use crate::state::Inputs;
use crate::terms::size;
use crate::terms::steering::rudder_lag::first_order;
use trimtab_ad::Scalar;

/// Engine lag.
pub struct EngineLag;

static INFO: TermInfo = TermInfo {
    name: "engine_lag",
    title: "engine lag",
    group: Group::Propulsion,
    equation: "tau n' = n_c - n",
    source: "first-order shaft response, exact for an order that is linear between samples",
    needs: &[],
    validity: Validity::any("a linear lag of the order; reversing delays are not in it, and no range is published"),
    mechanisms: &[Mechanism {
        name: "engine_lag",
        title: "engine lag",
        kind: Kind::Actuator,
        parameters: &["time"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: false,
        by_session: false,
        stand_in: false,
        look_alikes: &["loading", "thrust_loss"],
        trial: "quick changes of propeller rate with the shaft rate recorded",
    }],
    parameters: &[ParameterInfo::new("time", "tau", "s", "time constant")
        .scale(|s| 3.0 * size::time(s))
        .bounds(0.0, 300.0)],
};

impl Term for EngineLag {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }
}

impl<S: Scalar> Physics<S> for EngineLag {
    fn drive(&self, p: &[S], _ship: &Ship, dt: f64, series: &mut [Inputs<S>]) {
        first_order(p[0], dt, series, |i| &mut i.n);
    }
}
