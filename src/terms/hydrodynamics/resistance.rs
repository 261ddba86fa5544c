//! Surge resistance as a cubic in u, the parameters p1 to p3 of the paper.
//! It enters the surge equation as -R(u); with the plus sign that the paper prints, R >= 0 would push the ship.

use crate::parameter::{ParameterInfo, Start};
use crate::physics::Flow;
use crate::physics::Validity;
use crate::physics::{Form, Group, Instant, Physics, Reach, Term, TermInfo};
use crate::state::Force;
use crate::units::GRAVITY;
use trimtab_ad::Scalar;

/// Surge resistance.
pub struct Resistance;

static INFO: TermInfo = TermInfo {
    name: "resistance",
    title: "surge resistance",
    group: Group::Hull,
    equation: "X = -R(u), R = p1 u + p2 u^2 + p3 u^3 (form `regular`: p2 u|u|)",
    source: "Papandreou et al. 2025 (arXiv 2502.18696) eq. (1); sign corrected",
    needs: &[],
    validity: Validity {
        froude: Some([0.0, 0.25]),
        depth: Some([3.0, f64::INFINITY]),
        source: "the even power of the printed cubic keeps its sign astern, so that it is valid for headway; deep water is h/d > 3 by the classes of PIANC 1992; 0.25, from where wave making outgrows a cubic, is an engineering limit",
        ..Validity::ANY
    },
    mechanisms: &[],
    parameters: &[
        ParameterInfo::new("linear", "p1", "N s/m", "linear resistance")
            .in_mmg(Start::Replaced)
            .in_general(Start::Replaced)
            .scale(rate::<1>),
        ParameterInfo::new("quadratic", "p2", "N s2/m2", "quadratic resistance")
            .in_mmg(Start::Replaced)
            .in_general(Start::Replaced)
            .scale(rate::<2>),
        ParameterInfo::new("cubic", "p3", "N s3/m3", "cubic resistance")
            .in_mmg(Start::Replaced)
            .in_general(Start::Replaced)
            .scale(rate::<3>),
    ],
};

/// Resistance of order 1/2 rho L d u^2 0.02 at Froude number 0.2, spread over the powers of u.
fn rate<const POWER: i32>(ship: &crate::ship::Ship) -> f64 {
    let h = &ship.hull;
    let u = 0.2 * (GRAVITY * h.lpp).sqrt();
    0.5 * h.water_density * h.lpp * h.draught * 0.02 * u.powi(2 - POWER)
}

impl Resistance {
    /// R(u) \[N\] of the printed form.
    pub fn curve<S: Scalar>(p: &[S::Coefficient], u: S) -> S {
        p[0] * u + p[1] * (u * u) + p[2] * (u * u * u)
    }
}

impl Term for Resistance {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }

    fn reach(&self, _parameter: usize) -> Reach {
        Reach::LinearForce
    }
}

impl<S: Scalar> Physics<S> for Resistance {
    #[inline(always)]
    fn force(&self, p: &[S::Coefficient], at: &Instant<S>, flow: &Flow<S>) -> Force<S> {
        let u = flow.u;
        let share = match at.form {
            Form::Paper => flow.adjust.sternway,
            Form::Regular | Form::Mmg | Form::General => S::Coefficient::one(),
        };
        let square = u * (u + (u.abs() - u) * share);
        let r = u * p[0] + square * p[1] + u * u * u * p[2];
        Force { x: -(r * flow.adjust.resistance), ..Force::zero() }
    }
}
