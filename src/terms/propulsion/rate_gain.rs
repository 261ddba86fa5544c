//! A propeller rate that is recorded too high or too low by a constant factor: pulses counted wrongly, or the rate of the engine
//! before a gear. It acts on thrust, race and walk alike, where a loss of thrust leaves the advance ratio as it was.

use crate::parameter::ParameterInfo;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::ship::Ship;
use crate::state::Inputs;
use trimtab_ad::Scalar;

/// Gain of the recorded propeller rate.
pub struct RateGain;

static INFO: TermInfo = TermInfo {
    name: "rate_gain",
    title: "gain of the recorded propeller rate",
    group: Group::Propulsion,
    equation: "n -> (1 + g) n",
    source: "constant factor of a sensor, no source",
    needs: &[],
    validity: Validity::any("a constant factor"),
    mechanisms: &[Mechanism {
        name: "rate_gain",
        title: "gain of the recorded propeller rate",
        kind: Kind::Actuator,
        parameters: &["gain"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: true,
        by_session: false,
        stand_in: false,
        look_alikes: &["thrust_loss", "fouling"],
        trial: "speed runs at several rates, with the shaft timed by hand, in every session",
    }],
    parameters: &[ParameterInfo::new("gain", "g_n", "-", "true over recorded propeller rate, less one")
        .scale(|_| 0.1)
        .spread(|_| 0.05)
        .bounds(-0.5, 1.0)],
};

impl Term for RateGain {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }
}

impl<S: Scalar> Physics<S> for RateGain {
    fn drive(&self, p: &[S], _ship: &Ship, _dt: f64, series: &mut [Inputs<S>]) {
        for inputs in series {
            inputs.n *= p[0] + 1.0;
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use std::path::Path;

    #[test]
    fn a_rate_recorded_at_nine_tenths_is_made_whole_ahead_and_astern() {
        let ship = Ship::read(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/experiments/ships/a.toml"))).unwrap();
        let mut driven = [Inputs::actuators(0.0, 1.8, 0.1), Inputs::actuators(1.0, -0.9, 0.1)];
        RateGain.drive(&[1.0 / 0.9 - 1.0], &ship, 1.0, &mut driven);
        let rates: Vec<f64> = driven.iter().map(|i| i.n).collect();
        assert!((rates[0] - 2.0).abs() < 1e-12 && (rates[1] + 1.0).abs() < 1e-12, "{rates:?}");
        assert!(driven.iter().all(|i| i.delta == 0.1));
    }
}
