//! Hull and resistance forces with the right sign when the ship moves astern.
//! A share of the fore-aft consistent form within the paper's form; it has no effect in a model of form `regular`.

use crate::parameter::ParameterInfo;
use crate::physics::Adjust;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::ship::Ship;
use crate::state::Inputs;
use trimtab_ad::Scalar;

/// Sternway hull forces.
pub struct Sternway;

static INFO: TermInfo = TermInfo {
    name: "sternway",
    title: "sternway hull forces",
    group: Group::Hull,
    equation: "Yv U v -> Yv |u| v, Nr U r -> Nr |u| r, Yr U r -> Yr u r, Nv U v -> Nv u v, p2 u^2 -> p2 u|u|, in a share from 0 to 1",
    source: "Yoshimura's low-speed form, no factor 1/U",
    needs: &[],
    validity: Validity {
        froude: Some([-0.25, 0.25]),
        widens: &["hull", "resistance"],
        source: "Yoshimura's low-speed form is written for both directions of motion; the number 0.25 is an engineering limit as in `hull`",
        ..Validity::ANY
    },
    mechanisms: &[Mechanism {
        name: "sternway",
        title: "hull forces that change sign astern",
        kind: Kind::Ship,
        parameters: &["share"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: true,
        by_session: false,
        stand_in: false,
        look_alikes: &["propeller_walk_astern"],
        trial: "steering with sternway",
    }],
    parameters: &[ParameterInfo::new("share", "s", "-", "share of the consistent form")
        .scale(|_| 1.0)
        .spread(|_| 1.0)
        .bounds(0.0, 1.0)],
};

impl Term for Sternway {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }
}

impl<S: Scalar> Physics<S> for Sternway {
    fn adjust(&self, p: &[S], _ship: &Ship, _inputs: &Inputs<S>, adjust: &mut Adjust<S>) {
        adjust.sternway += p[0];
    }
}
