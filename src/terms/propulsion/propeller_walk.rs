//! Side force of the propeller, with its own strength ahead and astern.
//! The paper's side force proportional to net thrust is `propeller.side_force`; this one is proportional to n^2 and fades with speed.

use crate::parameter::ParameterInfo;
use crate::physics::Flow;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Instant, Physics, Reach, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::state::Force;
use trimtab_ad::Scalar;

/// Propeller walk.
pub struct PropellerWalk;

static INFO: TermInfo = TermInfo {
    name: "propeller_walk",
    title: "propeller walk",
    group: Group::Propulsion,
    equation: "Y = w rho D^4 n^2/(1 + J^2), J = u/(n D), w = ahead for n > 0, astern <= 0 for n < 0 (stern to port); N = x_P Y; \
               for a left-handed screw Y and N to the other side",
    source: "shape after Hachii's measurements as used in low-speed MMG models; the fade exp(-J^2) written 1/(1 + J^2), regular at n = 0",
    needs: &[],
    validity: Validity {
        rate: Some([f64::NEG_INFINITY, f64::INFINITY]),
        reversing: Some([-0.8, 0.2]),
        widens: &["propeller"],
        source: "Hachii's measurements turning astern, for u/(n D) from -0.8 to 0.2; turning ahead no range is published",
        ..Validity::ANY
    },
    mechanisms: &[
        Mechanism {
            name: "propeller_walk_astern",
            title: "propeller walk, turning astern",
            kind: Kind::Ship,
            parameters: &["astern"],
            companions: &[],
            probe: Probe::Tangent,
            needs_reference: false,
            by_session: false,
            stand_in: false,
            look_alikes: &["propeller_walk_ahead"],
            trial: "crash stops and starts astern from rest",
        },
        Mechanism {
            name: "propeller_walk_ahead",
            title: "propeller walk, turning ahead",
            kind: Kind::Ship,
            parameters: &["ahead"],
            companions: &[],
            probe: Probe::Tangent,
            needs_reference: true,
            by_session: false,
            stand_in: false,
            look_alikes: &["rudder_offset", "propeller_walk_astern"],
            trial: "straight runs at several propeller rates, and coasting",
        },
    ],
    parameters: &[
        ParameterInfo::new("ahead", "w_a", "-", "side force coefficient turning ahead, to starboard")
            .scale(|_| 0.01)
            .bounds(-0.2, 0.2)
            .odd(),
        ParameterInfo::new(
            "astern",
            "w_b",
            "-",
            "side force coefficient turning astern, to starboard, of a right-handed screw",
        )
        .scale(|_| 0.02)
        .bounds(-0.2, 0.0)
        .odd(),
    ],
};

impl Term for PropellerWalk {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }

    fn reach(&self, _parameter: usize) -> Reach {
        Reach::LinearForce
    }
}

impl<S: Scalar> Physics<S> for PropellerWalk {
    fn force(&self, p: &[S::Coefficient], at: &Instant<S>, flow: &Flow<S>) -> Force<S> {
        let ship = at.ship;
        let d = ship.propeller.diameter;
        let small = at.small;
        let w = S::Coefficient::select(at.inputs.n.less(S::Coefficient::zero()), p[1], p[0]);
        let tip = at.inputs.n * at.inputs.n * (d * d);
        let fade = S::lift(tip) / (flow.u * flow.u + tip + 1e-2 * small * small);
        let side = if ship.propeller.left_handed { -1.0 } else { 1.0 };
        let y = fade * (w * tip) * (side * ship.hull.water_density * d * d);
        Force { x: S::zero(), y, n: y * ship.propeller_x() }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use crate::dynamics::Dynamics;
    use crate::model::Model;
    use crate::physics::Form;
    use crate::ship::Ship;
    use crate::state::{Force, Inputs, State};
    use std::path::Path;

    #[test]
    fn a_left_handed_screw_astern_walks_the_stern_to_the_other_side() {
        let right = Ship::read(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/experiments/ships/a.toml"))).unwrap();
        let mut left = right.clone();
        left.propeller.left_handed = true;
        let brought = |ship: Ship| {
            let mut model = Model::new(ship, "HD", Form::Regular, &["propeller_walk"]).unwrap();
            let astern = model.find("propeller_walk.astern").unwrap();
            let mut rates = |value: f64| {
                model.parameters[astern].value = value;
                let state = State::from_array([0.0, 0.0, 0.0, 2.0, 0.0, 0.0]);
                Dynamics::new(&model, model.values())
                    .rates(&state, &Inputs::actuators(0.0, -2.0, 0.0), &Force::zero())
                    .0
            };
            let (with, without) = (rates(-0.02), rates(0.0));
            [with[4] - without[4], with[5] - without[5]]
        };
        let (right, left) = (brought(right), brought(left));
        // A stern that moves to port turns the bow to starboard.
        assert!(right[1] > 1e-6 && (right[1] + left[1]).abs() < 1e-12 && (right[0] + left[0]).abs() < 1e-12);
    }
}
