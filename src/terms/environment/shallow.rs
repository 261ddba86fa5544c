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

// Least-squares slopes over z of the published factors, mean of ships A and B, KVLCC2, KCS and Esso Osaka, by Hirano/Kijima's effective
// aspect ratio and by Clarke/Ankudinov's form as Taimuri et al. (2020) have it. Of the linear derivatives both give nearly the same
// (Y_v 0.39 and 0.33, N_v 0.49 and 0.41, N_r 0.10 and 0.16; Y_r 0.15), and of the masses there is one (m_y 0.59, J_z 0.49).
const SWAY: f64 = 0.4;
const YAW_STATIC: f64 = 0.5;
const ROTARY: f64 = 0.12;
const ADDED_MASS: f64 = 0.55;
const RESISTANCE: f64 = 0.15;
// Of the nonlinear derivatives they give 1.4 and 0.3 (Y_vv), 0.53 and 0.3 (Y_vr, Y_rr), 1.0 and 0.3 (N_vvr, N_rrv), 0.49 and 0.22 (N_rr):
// the means, and a factor on all of them that is as uncertain as the two are apart.
const SWAY_DRAG: f64 = 0.85;
const SWAY_MIXED: f64 = 0.42;
const YAW_MIXED: f64 = 0.65;
const ROTARY_DRAG: f64 = 0.35;
/// Largest d/h that is used \[-\]: the ship is nearly aground.
const MOST: f64 = 0.9;

static INFO: TermInfo = TermInfo {
    name: "shallow",
    title: "shallow water",
    group: Group::Environment,
    equation: "z = ratio + strength (d/h)/(1 - d/h); factors 1 + a z: Y_v a = 0.4, N_v 0.5, Y_r and N_r 0.12, added mass 0.55, resistance 0.15; with the factor n: Y_vv a = 0.85 n, Y_vr and Y_rr 0.42 n, N_vvr and N_rrv 0.65 n, N_rr 0.35 n",
    source: "Hirano/Kijima effective aspect ratio, Clarke/Ankudinov as in Taimuri et al. 2020, and Li & Wu added mass, fitted over h/d = 1.5 to 3 for five ships; resistance after Schlichting",
    needs: &[],
    validity: Validity {
        depth: Some([1.5, f64::INFINITY]),
        widens: &["hull", "resistance"],
        source: "fitted to Hirano/Kijima, Clarke/Ankudinov and Li & Wu for h/d from 1.5 to 3, with no effect in deep water",
        ..Validity::ANY
    },
    mechanisms: &[Mechanism {
        name: "shallow",
        title: "shallow water",
        kind: Kind::Environment,
        parameters: &["ratio"],
        companions: &["nonlinear"],
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
        ParameterInfo::new(
            "nonlinear",
            "n",
            "-",
            "factor on the growth of the nonlinear derivatives; 0.5 to 1.5 as published",
        )
        .default(|_| 1.0)
        .scale(|_| 0.5)
        .spread(|_| 0.5)
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
        let nonlinear = |sensitivity: f64| z * p[2] * sensitivity + 1.0;
        adjust.sway_drag *= nonlinear(SWAY_DRAG);
        adjust.sway_mixed *= nonlinear(SWAY_MIXED);
        adjust.yaw_static *= factor(YAW_STATIC);
        adjust.yaw_mixed *= nonlinear(YAW_MIXED);
        adjust.rotary *= factor(ROTARY);
        adjust.rotary_drag *= nonlinear(ROTARY_DRAG);
        adjust.added_mass *= factor(ADDED_MASS);
        adjust.resistance *= factor(RESISTANCE);
    }
}
