//! A loading condition other than the ship file's: mass, yaw inertia and centre of gravity.
//! Draught and hull coefficients do not change.

use crate::parameter::ParameterInfo;
use crate::physics::Adjust;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::ship::Ship;
use crate::state::Inputs;
use trimtab_ad::Scalar;

/// Loading condition.
pub struct Loading;

static INFO: TermInfo = TermInfo {
    name: "loading",
    title: "loading condition",
    group: Group::Hull,
    equation: "m -> (1 + mass) m, Iz -> (1 + mass) Iz, xG -> xG + x_g L",
    source: "rigid body",
    needs: &[],
    validity: Validity::any("rigid-body mechanics; hull coefficients stay those of the design draught"),
    mechanisms: &[Mechanism {
        name: "loading",
        title: "another loading condition (mass, trim)",
        kind: Kind::Ship,
        parameters: &["mass", "x_g"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: true,
        by_session: false,
        stand_in: false,
        look_alikes: &["munk", "fouling", "engine_lag"],
        trial: "accelerations at known thrust",
    }],
    parameters: &[
        ParameterInfo::new("mass", "dm/m", "-", "relative change of mass and yaw inertia")
            .scale(|_| 0.1)
            .bounds(-0.5, 0.5),
        ParameterInfo::new("x_g", "dxG/L", "-", "shift of the centre of gravity forward, over L")
            .scale(|_| 0.01)
            .bounds(-0.1, 0.1),
    ],
};

impl Term for Loading {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }
}

impl<S: Scalar> Physics<S> for Loading {
    fn adjust(&self, p: &[S], ship: &Ship, _inputs: &Inputs<S>, adjust: &mut Adjust<S>) {
        adjust.mass *= p[0] + 1.0;
        adjust.x_g += p[1] * ship.hull.lpp;
    }
}
