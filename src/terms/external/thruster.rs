//! Bow thruster, whose force decreases with the ship's speed.
//! Force follows the command at once; the moment decreases later than the force, as suction on the hull aft of the jet acts the other way.
//! A ship without thruster particulars gets a typical one: 1e-4 rho g L^2 d at 0.4 L.

use crate::parameter::ParameterInfo;
use crate::physics::Flow;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Instant, Physics, Reach, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::state::Force;
use crate::terms::size;
use trimtab_ad::Scalar;

/// Bow thruster.
pub struct Thruster;

static INFO: TermInfo = TermInfo {
    name: "thruster",
    title: "bow thruster",
    group: Group::External,
    equation: "Y = gain T_0 command/(1 + (u/u_Y)^2), N = x_T gain T_0 command/(1 + (u/u_N)^2)",
    source: "half the force at 2.5 kn for a coaster, as in harbour-manoeuvring practice; that the moment falls less with speed: Chislett & Bjoerheden 1966",
    needs: &["thruster"],
    validity: Validity {
        froude: Some([0.0, 0.1]),
        source: "model tests ahead (Chislett & Bjoerheden 1966; Int. Shipbuild. Prog. 14, 1967: a 60,000 t tanker has the least moment at 4 kn and more at higher speed, which a fade does not give); the number 0.1 is an engineering limit",
        ..Validity::ANY
    },
    mechanisms: &[Mechanism {
        name: "thruster",
        title: "bow thruster",
        kind: Kind::Environment,
        parameters: &["gain"],
        companions: &["half_speed", "moment_half_speed"],
        probe: Probe::Tangent,
        needs_reference: false,
        by_session: false,
        stand_in: false,
        look_alikes: &["push"],
        trial: "thruster alone, at rest and at slow speed",
    }],
    parameters: &[
        ParameterInfo::new("gain", "k_T", "-", "share of the nominal thrust; 1 as specified")
            .scale(|_| 0.5)
            .spread(|_| 1.0)
            .bounds(0.0, 3.0),
        ParameterInfo::new("half_speed", "u_Y", "m/s", "speed at which half of the side force is left")
            .default(|s| 0.045 * size::speed(s))
            .scale(|s| 0.01 * size::speed(s))
            .spread(|s| 0.03 * size::speed(s))
            .bounds(0.01, 20.0),
        ParameterInfo::new("moment_half_speed", "u_N", "m/s", "speed at which half of the yaw moment is left")
            .default(|s| 0.075 * size::speed(s))
            .scale(|s| 0.01 * size::speed(s))
            .spread(|s| 0.04 * size::speed(s))
            .bounds(0.01, 20.0),
    ],
};

impl Term for Thruster {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }

    fn reach(&self, _parameter: usize) -> Reach {
        Reach::Force
    }
}

impl<S: Scalar> Physics<S> for Thruster {
    fn force(&self, p: &[S::Coefficient], at: &Instant<S>, flow: &Flow<S>) -> Force<S> {
        let hull = &at.ship.hull;
        let (thrust, x) = at.ship.thruster.as_ref().map_or_else(
            || (1e-4 * hull.water_density * size::GRAVITY * hull.lpp.powi(2) * hull.draught, 0.4 * hull.lpp),
            |t| (t.thrust, t.x),
        );
        let full = p[0] * at.inputs.thruster * thrust;
        let left = |half: S::Coefficient| {
            let speed = flow.u / half;
            S::lift(full) / (speed * speed + 1.0)
        };
        Force { x: S::zero(), y: left(p[1]), n: left(p[2]) * x }
    }
}
