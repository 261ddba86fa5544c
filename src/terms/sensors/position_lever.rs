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
        stand_in: false,
        look_alikes: &["time_skew", "log_skew", "antenna"],
        trial: "a turn on the spot",
    }],
    parameters: &[
        forward("point of the positions forward of that of the velocities"),
        starboard("point of the positions to starboard of that of the velocities"),
    ],
};

/// The parameter `x` of a lever arm: metres forward.
pub(in crate::terms) const fn forward(about: &'static str) -> ParameterInfo {
    ParameterInfo::new("x", "l_x", "m", about)
        .scale(|s| 0.05 * s.hull.lpp)
        .spread(|s| 0.3 * s.hull.lpp)
        .bounds(-300.0, 300.0)
}

/// The parameter `y` of a lever arm: metres to starboard.
pub(in crate::terms) const fn starboard(about: &'static str) -> ParameterInfo {
    ParameterInfo::new("y", "l_y", "m", about)
        .scale(|s| 0.02 * s.hull.lpp)
        .spread(|s| 0.1 * s.hull.lpp)
        .bounds(-50.0, 50.0)
        .odd()
}

/// Moves reported positions to the point of a lever arm, at a heading given by its sine and cosine.
#[inline(always)]
pub(in crate::terms) fn shift<S: Scalar>(lever: &[S::Coefficient], [sin, cos]: [S; 2], y: &mut [S; STATES]) {
    y[0] += cos * lever[0] - sin * lever[1];
    y[1] += sin * lever[0] + cos * lever[1];
}

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
        shift(p, at.heading, y);
    }
}
