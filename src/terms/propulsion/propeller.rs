//! Propeller forces: net thrust, and a side force proportional to it (parameter p0 of the paper).
//! Thrust comes from the flow; side forces beyond the paper's linear one are the term `propeller_walk`.

use crate::parameter::ParameterInfo;
use crate::physics::Flow;
use crate::physics::Validity;
use crate::physics::{Group, Instant, Physics, Reach, Term, TermInfo};
use crate::state::Force;
use trimtab_ad::Scalar;

/// Propeller forces.
pub struct Propeller;

static INFO: TermInfo = TermInfo {
    name: "propeller",
    title: "propeller thrust and side force",
    group: Group::Propulsion,
    equation: "X_n = (1-t) T; Y_n = p0 X_n; N_n = x_P Y_n",
    source: "Papandreou et al. 2025 (arXiv 2502.18696) eq. (2)",
    needs: &[],
    validity: Validity {
        rate: Some([0.0, f64::INFINITY]),
        source: "a side force proportional to thrust is valid for a propeller that turns ahead: astern Hachii's measurements have the other sign and a share of the thrust that changes with speed",
        ..Validity::ANY
    },
    mechanisms: &[],
    parameters: &[ParameterInfo::new("side_force", "p0", "-", "side force over net thrust, to starboard")
        .scale(|_| 0.01)
        .odd()],
};

impl Term for Propeller {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }

    fn reach(&self, _parameter: usize) -> Reach {
        Reach::LinearForce
    }
}

impl<S: Scalar> Physics<S> for Propeller {
    #[inline(always)]
    fn force(&self, p: &[S::Coefficient], at: &Instant<S>, flow: &Flow<S>) -> Force<S> {
        let y = flow.propulsion * p[0];
        Force { x: flow.propulsion, y, n: y * at.ship.propeller_x() }
    }
}
