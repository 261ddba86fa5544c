//! Wake at the propeller that changes with the drift angle there.
//! It changes thrust and, through the race, the rudder force; port and starboard may differ. It gives no force of its own.

use crate::parameter::ParameterInfo;
use crate::physics::Adjust;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::ship::Ship;
use crate::state::Inputs;
use trimtab_ad::Scalar;

/// Wake change in drift.
pub struct WakeDrift;

static INFO: TermInfo = TermInfo {
    name: "wake_drift",
    title: "wake change in drift",
    group: Group::Propulsion,
    equation: "w = w_0 - relief s^2 + asymmetry s, s = (v + x_P r)/sqrt(u^2 + (v + x_P r)^2), the sine of the drift angle at the propeller",
    source: "quadratic wake law of low-speed MMG models; an exponential one is in Yasukawa & Yoshimura 2015",
    needs: &[],
    validity: Validity {
        froude: Some([0.0, f64::INFINITY]),
        source: "low-speed MMG models use the quadratic law ahead only and set the wake to zero astern",
        ..Validity::ANY
    },
    mechanisms: &[Mechanism {
        name: "wake_drift",
        title: "wake that changes with drift",
        kind: Kind::Ship,
        parameters: &["relief", "asymmetry"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: true,
        by_session: false,
        stand_in: false,
        look_alikes: &["race", "hull_nonlinear"],
        trial: "turning circles at several propeller rates",
    }],
    parameters: &[
        ParameterInfo::new("relief", "c", "-", "wake lost in inflow from the side, about 0.4 in beam flow")
            .scale(|_| 0.3)
            .spread(|_| 0.5)
            .bounds(0.0, 2.0),
        ParameterInfo::new("asymmetry", "c_a", "-", "wake gained when the stern moves to starboard")
            .scale(|_| 0.1)
            .spread(|_| 0.2)
            .bounds(-0.5, 0.5)
            .odd(),
    ],
};

impl Term for WakeDrift {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }
}

impl<S: Scalar> Physics<S> for WakeDrift {
    fn adjust(&self, p: &[S], _ship: &Ship, _inputs: &Inputs<S>, adjust: &mut Adjust<S>) {
        adjust.wake_relief += p[0];
        adjust.wake_asymmetry += p[1];
    }
}
