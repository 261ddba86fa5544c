//! A rudder angle that is recorded too large or too small by a constant factor: a feedback sensor out of calibration.
//! Where every session has it, the rudder's own coefficients take it over; a session with another factor shows it.

use crate::parameter::ParameterInfo;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::ship::Ship;
use crate::state::Inputs;
use trimtab_ad::Scalar;

/// Gain of the recorded rudder angle.
pub struct RudderGain;

static INFO: TermInfo = TermInfo {
    name: "rudder_gain",
    title: "gain of the recorded rudder angle",
    group: Group::Rudder,
    equation: "delta -> (1 + g) delta",
    source: "constant factor of a sensor, no source",
    needs: &[],
    validity: Validity::any("a constant factor"),
    mechanisms: &[Mechanism {
        name: "rudder_gain",
        title: "gain of the recorded rudder angle",
        kind: Kind::Actuator,
        parameters: &["gain"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: true,
        by_session: false,
        stand_in: false,
        look_alikes: &["race", "rudder_stall"],
        trial: "rudder hard over to both stops, whose angles are known, in every session",
    }],
    parameters: &[ParameterInfo::new("gain", "g_d", "-", "true over recorded rudder angle, less one")
        .scale(|_| 0.1)
        .spread(|_| 0.05)
        .bounds(-0.5, 1.0)],
};

impl Term for RudderGain {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }
}

impl<S: Scalar> Physics<S> for RudderGain {
    fn drive(&self, p: &[S], _ship: &Ship, _dt: f64, series: &mut [Inputs<S>]) {
        for inputs in series {
            inputs.delta *= p[0] + 1.0;
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use std::path::Path;

    #[test]
    fn a_gain_of_a_tenth_turns_nine_tenths_of_an_angle_into_nearly_the_whole_of_it() {
        let ship = Ship::read(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/experiments/ships/a.toml"))).unwrap();
        let mut driven = [Inputs::actuators(0.0, 2.0, 0.45), Inputs::actuators(1.0, 2.0, -0.2)];
        RudderGain.drive(&[0.1], &ship, 1.0, &mut driven);
        let angles: Vec<f64> = driven.iter().map(|i| i.delta).collect();
        assert!((angles[0] - 0.495).abs() < 1e-12 && (angles[1] + 0.22).abs() < 1e-12, "{angles:?}");
        assert!(driven.iter().all(|i| i.n == 2.0));
    }
}
