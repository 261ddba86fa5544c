//! A steering gear that turns the rudder no faster than a limit.
//! The parameter is the inverse of the limit, so that 0 is a gear without limit; below the limit there is no lag.

use crate::parameter::ParameterInfo;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::ship::Ship;
use crate::state::Inputs;
use crate::terms::size;
use trimtab_ad::Scalar;

/// Rudder rate limit.
pub struct RudderRate;

static INFO: TermInfo = TermInfo {
    name: "rudder_rate",
    title: "rudder rate limit",
    group: Group::Rudder,
    equation: "per sample: delta moves by e/(1 + (|e| a/dt)^4)^(1/4), e = order - delta; |delta'| < 1/a",
    source: "rate limit with rounded corner; SOLAS asks 35 to -30 deg in 28 s, a = 25 s/rad",
    needs: &[],
    validity: Validity::any("a limit of the steering gear at any state of the ship"),
    mechanisms: &[Mechanism {
        name: "rudder_rate",
        title: "rudder rate limit",
        kind: Kind::Actuator,
        parameters: &["inverse"],
        companions: &[],
        probe: Probe::Forward,
        needs_reference: false,
        by_session: false,
        stand_in: false,
        look_alikes: &["rudder_lag"],
        trial: "rudder from hard over to hard over, with order and rudder angle recorded",
    }],
    parameters: &[ParameterInfo::new(
        "inverse",
        "1/w",
        "s/rad",
        "inverse of the largest rudder rate; 25 s/rad is 2.3 deg/s",
    )
    .scale(|s| 8.5 * size::time(s))
    .bounds(0.0, 200.0)],
};

impl Term for RudderRate {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }
}

impl<S: Scalar> Physics<S> for RudderRate {
    fn drive(&self, p: &[S], _ship: &Ship, dt: f64, series: &mut [Inputs<S>]) {
        let a = p[0] / dt;
        let mut before: Option<S> = None;
        for inputs in series {
            let order = inputs.delta;
            if let Some(at) = before {
                let e = order - at;
                let q = (e * a).squared().squared() + 1.0;
                // What is left of e after the move e/q^(1/4); nothing at all without a limit.
                inputs.delta = order - e * (S::one() - S::one() / q.sqrt().sqrt());
            }
            before = Some(inputs.delta);
        }
    }
}
