//! A constant force in a fixed direction on the earth, acting at midship.
//! It is generic and states no cause: wind, waves or a line act so on a ship of constant speed.

use crate::parameter::ParameterInfo;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Flow, Reach};
use crate::physics::{Group, Instant, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::state::Force;
use crate::terms::size;
use trimtab_ad::Scalar;

/// Constant earth-fixed force.
pub struct EarthForce;

static INFO: TermInfo = TermInfo {
    name: "earth_force",
    title: "constant earth-fixed force",
    group: Group::Environment,
    equation: "X = F_N cos psi + F_E sin psi, Y = F_E cos psi - F_N sin psi, N = 0",
    source: "generic, no source",
    needs: &[],
    validity: Validity::any("no cause and no law: a constant"),
    mechanisms: &[Mechanism {
        name: "earth_force",
        title: "a force fixed on the earth",
        kind: Kind::Environment,
        parameters: &["north", "east"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: false,
        by_session: true,
        stand_in: true,
        look_alikes: &["mean_wind", "wave_drift", "current"],
        trial: "drifting stopped on several headings",
    }],
    parameters: &[
        ParameterInfo::new("north", "F_N", "N", "force towards north").scale(size::force),
        ParameterInfo::new("east", "F_E", "N", "force towards east").scale(size::force).odd(),
    ],
};

impl Term for EarthForce {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }

    fn reach(&self, _parameter: usize) -> Reach {
        Reach::LinearForce
    }
}

impl<S: Scalar> Physics<S> for EarthForce {
    fn force(&self, p: &[S::Coefficient], at: &Instant<S>, _flow: &Flow<S>) -> Force<S> {
        let [x, y] = at.to_body([p[0], p[1]]);
        Force { x, y, n: S::zero() }
    }
}
