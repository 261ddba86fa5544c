//! The wake of the standard MMG method in a turn: it shrinks with the drift angle at the propeller, more on one side than on the other.
//! It gives no force: thrust and rudder inflow follow from the wake. The parabola of `wake_drift` is another law for the same effect.

use crate::parameter::{ParameterInfo, Start};
use crate::physics::Adjust;
use crate::physics::{Group, Physics, Term, TermInfo};
use crate::physics::{Validity, degrees};
use crate::ship::Ship;
use crate::state::Inputs;
use trimtab_ad::Scalar;

/// Wake in a turn.
pub struct MmgWake;

static INFO: TermInfo = TermInfo {
    name: "mmg_wake",
    title: "wake of the standard MMG method in a turn",
    group: Group::Propulsion,
    equation: "(1 - w_P)/(1 - w_P0) = 1 + (1 - exp(-C_1 |b_P|)) (C_2 - 1), b_P = beta - x_P' r', beta = atan2(-v, u); \
               C_2 = C_2 + dC_2 for b_P > 0 and C_2 - dC_2 for b_P < 0",
    source: "Yasukawa & Yoshimura 2015, J. Mar. Sci. Technol. 20, eq. 16 to 18; start values are those of KVLCC2 there, C_2 = 1.6 for b_P > 0 and 1.1 for b_P < 0",
    needs: &[],
    validity: Validity {
        drift: Some([0.0, degrees(30.0)]),
        rate: Some([0.0, f64::INFINITY]),
        source: "Yasukawa & Yoshimura 2015: measured for a propeller turning ahead; 30 deg is an engineering limit",
        ..Validity::ANY
    },
    mechanisms: &[],
    parameters: &[
        ParameterInfo::new("C_1", "C_1", "-", "how fast the wake changes with the drift angle at the propeller")
            .in_mmg(Start::Own(|_| 2.0))
            .scale(|_| 0.3)
            .spread(|_| 0.5)
            .bounds(0.0, 20.0),
        ParameterInfo::new(
            "C_2",
            "C_2",
            "-",
            "1 - w_P at large drift over that on a straight course, mean of the sides",
        )
        .default(|_| 1.0)
        .in_mmg(Start::Own(|_| 1.35))
        .scale(|_| 0.1)
        .spread(|_| 0.2)
        .bounds(0.0, 3.0),
        ParameterInfo::new(
            "dC_2",
            "dC_2",
            "-",
            "half its difference between b_P > 0, a turn to starboard, and b_P < 0",
        )
        .in_mmg(Start::Own(|_| 0.25))
        .scale(|_| 0.1)
        .spread(|_| 0.2)
        .bounds(-1.0, 1.0)
        .odd(),
    ],
};

impl Term for MmgWake {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }
}

impl<S: Scalar> Physics<S> for MmgWake {
    fn adjust(&self, p: &[S], _ship: &Ship, _inputs: &Inputs<S>, adjust: &mut Adjust<S>) {
        adjust.wake_turn = Some([p[0], p[1], p[2]]);
    }
}
