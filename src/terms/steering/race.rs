//! A change of the propeller race at the rudder.
//! It shows only in the rudder force with the propeller turning; lift slope and race are hard to distinguish.

use crate::parameter::ParameterInfo;
use crate::physics::Adjust;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::ship::Ship;
use crate::state::Inputs;
use trimtab_ad::Scalar;

/// Propeller race on the rudder.
pub struct Race;

static INFO: TermInfo = TermInfo {
    name: "race",
    title: "propeller race on the rudder",
    group: Group::Rudder,
    equation: "kappa -> (1 + c) kappa",
    source: "propeller race factor of Yasukawa & Yoshimura 2015, proportional change",
    needs: &[],
    validity: Validity {
        rate: Some([0.0, f64::INFINITY]),
        source: "Yasukawa & Yoshimura 2015: the race factor is that of a propeller turning ahead",
        ..Validity::ANY
    },
    mechanisms: &[Mechanism {
        name: "race",
        title: "propeller race on the rudder",
        kind: Kind::Ship,
        parameters: &["change"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: true,
        by_session: false,
        stand_in: false,
        look_alikes: &["rudder_stall", "wake_drift"],
        trial: "rudder steps at rest with the propeller ahead, and coasting",
    }],
    parameters: &[ParameterInfo::new("change", "c", "-", "relative change of the race factor")
        .scale(|_| 0.3)
        .bounds(-1.0, 3.0)],
};

impl Term for Race {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }
}

impl<S: Scalar> Physics<S> for Race {
    fn adjust(&self, p: &[S], _ship: &Ship, _inputs: &Inputs<S>, adjust: &mut Adjust<S>) {
        adjust.race *= p[0] + 1.0;
    }
}
