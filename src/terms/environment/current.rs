//! A uniform steady current that carries the ship and the water around it.
//! Its forces come from the velocity through the water, which all other terms use; a tidal current is the term `tide`.

use crate::parameter::ParameterInfo;
use crate::physics::Adjust;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::ship::Ship;
use crate::state::Inputs;
use crate::terms::size;
use trimtab_ad::Scalar;

/// Steady current.
pub struct Current;

static INFO: TermInfo = TermInfo {
    name: "current",
    title: "steady current",
    group: Group::Environment,
    equation: "V_c = (north, east) over ground, setting to; u_r = u - V_c,x, v_r = v - V_c,y in body axes; u' = u_r' + V_c,y r, v' = v_r' - V_c,x r",
    source: "kinematics of a uniform irrotational current",
    needs: &[],
    validity: Validity::any("exact for a current that is uniform over the ship's length and steady over a run"),
    mechanisms: &[Mechanism {
        name: "current",
        title: "steady current",
        kind: Kind::Environment,
        parameters: &["north", "east"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: false,
        by_session: true,
        stand_in: false,
        look_alikes: &["tide", "mean_wind", "earth_force", "log_scale", "water_log"],
        trial: "a stop and drift, then slow turns through all headings",
    }],
    parameters: &[
        ParameterInfo::new("north", "V_cN", "m/s", "current towards north")
            .scale(|s| 0.007 * size::speed(s))
            .bounds(-5.0, 5.0),
        ParameterInfo::new("east", "V_cE", "m/s", "current towards east")
            .scale(|s| 0.007 * size::speed(s))
            .bounds(-5.0, 5.0)
            .odd(),
    ],
};

impl Term for Current {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }
}

impl<S: Scalar> Physics<S> for Current {
    fn adjust(&self, p: &[S], _ship: &Ship, _inputs: &Inputs<S>, adjust: &mut Adjust<S>) {
        adjust.current[0] += p[0];
        adjust.current[1] += p[1];
    }
}
