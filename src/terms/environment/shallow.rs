//! Shallow water: damping, added mass and resistance grow with draught over water under the keel.
//! One depth number scales fixed sensitivities; squat and what grows faster below h/d = 1.5 are not modelled.

use crate::parameter::ParameterInfo;
use crate::physics::Adjust;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::ship::Ship;
use crate::state::Inputs;
use trimtab_ad::Scalar;

/// Shallow water.
pub struct Shallow;

// Least-squares slopes over z of the published factors, mean of ships A and B, KVLCC2, KCS and Esso Osaka:
// Y_v 0.39 and Y_vv 1.4, Y_vr and Y_rr 0.53; N_v 0.49, N_vvr and N_rrv 1.0; Y_r 0.15, N_r 0.10 and N_rr 0.49; m_y 0.59 and J_z 0.49.
const SWAY: f64 = 0.4;
const SWAY_DRAG: f64 = 1.4;
const SWAY_MIXED: f64 = 0.5;
const YAW_STATIC: f64 = 0.5;
const YAW_MIXED: f64 = 1.0;
const ROTARY: f64 = 0.12;
const ROTARY_DRAG: f64 = 0.5;
const ADDED_MASS: f64 = 0.55;
const RESISTANCE: f64 = 0.15;
/// Largest d/h that is used \[-\]: the ship is nearly aground.
const MOST: f64 = 0.9;

static INFO: TermInfo = TermInfo {
    name: "shallow",
    title: "shallow water",
    group: Group::Environment,
    equation: "z = ratio + strength (d/h)/(1 - d/h); factors 1 + a z: Y_v a = 0.4, Y_vv 1.4, Y_vr and Y_rr 0.5, N_v 0.5, N_vvr and N_rrv 1, Y_r and N_r 0.12, N_rr 0.5, added mass 0.55, resistance 0.15",
    source: "Hirano/Kijima effective aspect ratio and Li & Wu added mass, fitted over h/d = 1.5 to 3 for five ships; resistance after Schlichting",
    needs: &[],
    validity: Validity {
        depth: Some([1.5, f64::INFINITY]),
        widens: &["hull", "resistance"],
        source: "fitted to Hirano/Kijima and Li & Wu for h/d from 1.5 to 3, with no effect in deep water",
        ..Validity::ANY
    },
    mechanisms: &[Mechanism {
        name: "shallow",
        title: "shallow water",
        kind: Kind::Environment,
        parameters: &["ratio"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: true,
        by_session: false,
        stand_in: false,
        look_alikes: &["crossflow", "munk", "loading"],
        trial: "the same turning circle in deep and in shallow water",
    }],
    parameters: &[
        ParameterInfo::new("ratio", "z", "-", "draught over water under the keel d/(h-d), depth not recorded")
            .scale(|_| 0.5)
            .bounds(0.0, 4.0),
        ParameterInfo::new("strength", "k", "-", "share of the published effect of the recorded depth; 1 as published")
            .scale(|_| 1.0)
            .spread(|_| 1.0)
            .bounds(0.0, 3.0),
    ],
};

impl Term for Shallow {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }
}

impl<S: Scalar> Physics<S> for Shallow {
    fn adjust(&self, p: &[S], _ship: &Ship, inputs: &Inputs<S>, adjust: &mut Adjust<S>) {
        let q = inputs.draught_to_depth.clamp(0.0, MOST);
        let z = p[0] + p[1] * q / (S::one() - q);
        let factor = |sensitivity: f64| z * sensitivity + 1.0;
        adjust.sway *= factor(SWAY);
        adjust.sway_drag *= factor(SWAY_DRAG);
        adjust.sway_mixed *= factor(SWAY_MIXED);
        adjust.yaw_static *= factor(YAW_STATIC);
        adjust.yaw_mixed *= factor(YAW_MIXED);
        adjust.rotary *= factor(ROTARY);
        adjust.rotary_drag *= factor(ROTARY_DRAG);
        adjust.added_mass *= factor(ADDED_MASS);
        adjust.resistance *= factor(RESISTANCE);
    }
}
