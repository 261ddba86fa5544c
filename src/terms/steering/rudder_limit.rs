//! A rudder that goes no further than some angle, whatever is recorded: a stop of the steering gear, an indicator that follows the order.
//! The parameter is the inverse of the limit, so that 0 is a rudder without one. A rudder whose lift flattens out (a flap, a stall) looks alike
//! in all runs: a limit is named against sessions without it.

use crate::parameter::ParameterInfo;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::ship::Ship;
use crate::state::Inputs;
use trimtab_ad::Scalar;

/// Rudder angle limit.
pub struct RudderLimit;

static INFO: TermInfo = TermInfo {
    name: "rudder_limit",
    title: "rudder angle limit",
    group: Group::Rudder,
    equation: "delta -> delta/(1 + (delta a)^8)^(1/8); |delta| < 1/a",
    source: "limit with rounded corner: 0.05 % off at half of it, 8 % at the corner",
    needs: &[],
    validity: Validity::any("a limit of the steering gear at any state of the ship"),
    mechanisms: &[Mechanism {
        name: "rudder_limit",
        title: "rudder that goes no further than some angle",
        kind: Kind::Actuator,
        parameters: &["inverse"],
        companions: &[],
        probe: Probe::Forward,
        needs_reference: true,
        by_session: false,
        stand_in: false,
        look_alikes: &["rudder_gain", "rudder_rate", "rudder_stall"],
        trial: "turning circles at 10, 20 and 35 deg of rudder to both sides",
    }],
    // At its scale a rudder goes to 20 deg and not to 35.
    parameters: &[ParameterInfo::new("inverse", "1/d", "1/rad", "inverse of the largest rudder angle; 2.9 is 20 deg")
        .scale(|_| 2.9)
        .bounds(0.0, 20.0)],
};

impl Term for RudderLimit {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }
}

impl<S: Scalar> Physics<S> for RudderLimit {
    fn drive(&self, p: &[S], _ship: &Ship, _dt: f64, series: &mut [Inputs<S>]) {
        for inputs in series {
            let q = (inputs.delta * p[0]).squared().squared().squared() + 1.0;
            inputs.delta = inputs.delta / q.sqrt().sqrt().sqrt();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rudder_follows_up_to_its_limit_and_stays_there_to_either_side() {
        let limit = 20.0_f64.to_radians();
        let at = |degrees: f64, inverse: f64| {
            let mut inputs = [Inputs::actuators(0.0, 2.0, degrees.to_radians())];
            let ship = crate::diagnose::example::model().ship;
            Physics::<f64>::drive(&RudderLimit, &[inverse], &ship, 1.0, &mut inputs);
            inputs[0].delta.to_degrees()
        };
        assert!((at(10.0, 1.0 / limit) - 10.0).abs() < 0.01);
        assert!((at(35.0, 1.0 / limit) - 20.0).abs() < 0.1 && (at(-35.0, 1.0 / limit) + 20.0).abs() < 0.1);
        assert_eq!(at(35.0, 0.0).to_bits(), 35.0_f64.to_radians().to_degrees().to_bits());
    }
}
