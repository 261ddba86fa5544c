//! Positions of another point of the ship than the velocities: of the antenna, where only the velocities are carried to midship.
//! Its horizontal lever only; motion of the antenna in roll is not modelled.

use crate::parameter::ParameterInfo;
use crate::physics::Flow;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Instant, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::state::STATES;
use trimtab_ad::Scalar;

/// Lever arm of the positions alone.
pub struct PositionLever;

static INFO: TermInfo = TermInfo {
    name: "position_lever",
    title: "lever arm of the positions",
    group: Group::Sensor,
    equation: "(x, y)_m = (x, y) + R(psi) (l_x, l_y)",
    source: "rigid-body kinematics",
    needs: &[],
    validity: Validity::any("exact kinematics of a horizontal lever; roll is not in it"),
    mechanisms: &[Mechanism {
        name: "position_lever",
        title: "positions of another point of the ship than the velocities",
        kind: Kind::Sensor,
        parameters: &["x", "y"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: false,
        by_session: false,
        floor: 0.02,
        stand_in: false,
        look_alikes: &["time_skew", "antenna"],
        trial: "a turn on the spot",
    }],
    parameters: &[
        ParameterInfo::new("x", "l_x", "m", "point of the positions forward of that of the velocities")
            .scale(|s| 0.05 * s.hull.lpp)
            .spread(|s| 0.3 * s.hull.lpp)
            .bounds(-300.0, 300.0),
        ParameterInfo::new("y", "l_y", "m", "point of the positions to starboard of that of the velocities")
            .scale(|s| 0.02 * s.hull.lpp)
            .spread(|s| 0.1 * s.hull.lpp)
            .bounds(-50.0, 50.0)
            .odd(),
    ],
};

impl Term for PositionLever {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }
}

impl<S: Scalar> Physics<S> for PositionLever {
    fn measure(
        &self,
        p: &[S::Coefficient],
        at: &Instant<S>,
        _flow: &Flow<S>,
        _rate: &[S; STATES],
        y: &mut [S; STATES],
    ) {
        let [sin, cos] = at.heading;
        y[0] += cos * p[0] - sin * p[1];
        y[1] += sin * p[0] + cos * p[1];
    }
}
