//! Positions and velocities of an antenna that is away from midship.
//! Its horizontal lever only; motion of the antenna in roll is not modelled.

use super::position_lever::{forward, shift, starboard};
use crate::physics::Flow;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Instant, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::state::STATES;
use trimtab_ad::Scalar;

/// Antenna lever arm.
pub struct Antenna;

static INFO: TermInfo = TermInfo {
    name: "antenna",
    title: "antenna lever arm",
    group: Group::Sensor,
    equation: "(x, y)_m = (x, y) + R(psi) (l_x, l_y), u_m = u - r l_y, v_m = v + r l_x",
    source: "rigid-body kinematics",
    needs: &[],
    validity: Validity::any("exact kinematics of a horizontal lever; roll is not in it"),
    mechanisms: &[Mechanism {
        name: "antenna",
        title: "an antenna away from its stated position",
        kind: Kind::Sensor,
        parameters: &["x", "y"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: true,
        by_session: false,
        stand_in: false,
        look_alikes: &["time_skew", "position_lever"],
        trial: "a turn on the spot",
    }],
    parameters: &[
        forward("antenna forward of its stated position"),
        starboard("antenna to starboard of its stated position"),
    ],
};

impl Term for Antenna {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }
}

impl<S: Scalar> Physics<S> for Antenna {
    fn measure(
        &self,
        p: &[S::Coefficient],
        at: &Instant<S>,
        _flow: &Flow<S>,
        _rate: &[S; STATES],
        y: &mut [S; STATES],
    ) {
        shift(p, at.heading, y);
        y[3] -= at.state.r * p[1];
        y[4] += at.state.r * p[0];
    }
}
