//! A uniform current that turns with the principal lunar tide.
//! Only the M2 constituent; the force of the water's acceleration (1e-4 m/s2) is not modelled.

use crate::parameter::ParameterInfo;
use crate::physics::Adjust;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::ship::Ship;
use crate::state::Inputs;
use crate::terms::size;
use std::f64::consts::TAU;
use trimtab_ad::Scalar;

/// Tidal current.
pub struct Tide;

/// Period of the M2 tide \[s\].
pub const PERIOD: f64 = 44_714.0;

static INFO: TermInfo = TermInfo {
    name: "tide",
    title: "tidal current",
    group: Group::Environment,
    equation: "V_c += (north_cos, east_cos) cos w t + (north_sin, east_sin) sin w t, w = 2 pi/44714 s",
    source: "principal lunar constituent M2, 12.42 h; kinematics as `current`",
    needs: &[],
    validity: Validity::any("as `current`; one constituent, so hours and not days"),
    mechanisms: &[Mechanism {
        name: "tide",
        title: "tidal current",
        kind: Kind::Environment,
        parameters: &["north_sin", "north_cos", "east_sin", "east_cos"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: false,
        by_session: false,
        stand_in: false,
        look_alikes: &["current"],
        trial: "the same runs again three and six hours later",
    }],
    parameters: &[
        ParameterInfo::new("north_sin", "V_sinN", "m/s", "sine amplitude of the current towards north")
            .scale(|s| 0.007 * size::speed(s))
            .bounds(-5.0, 5.0),
        ParameterInfo::new("north_cos", "V_cosN", "m/s", "cosine amplitude of the current towards north")
            .scale(|s| 0.007 * size::speed(s))
            .bounds(-5.0, 5.0),
        ParameterInfo::new("east_sin", "V_sinE", "m/s", "sine amplitude of the current towards east")
            .scale(|s| 0.007 * size::speed(s))
            .bounds(-5.0, 5.0)
            .odd(),
        ParameterInfo::new("east_cos", "V_cosE", "m/s", "cosine amplitude of the current towards east")
            .scale(|s| 0.007 * size::speed(s))
            .bounds(-5.0, 5.0)
            .odd(),
    ],
};

impl Term for Tide {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }
}

impl<S: Scalar> Physics<S> for Tide {
    fn adjust(&self, p: &[S], _ship: &Ship, inputs: &Inputs<S>, adjust: &mut Adjust<S>) {
        let (sin, cos) = (inputs.t * (TAU / PERIOD)).sin_cos();
        adjust.current[0] += p[0] * sin + p[1] * cos;
        adjust.current[1] += p[2] * sin + p[3] * cos;
    }
}
