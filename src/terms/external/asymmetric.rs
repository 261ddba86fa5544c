//! A generic force law that a mirror-symmetric ship in open calm water cannot have: forces to one side, and forces fixed on the earth.
//! The counterpart of `symmetric`: a named mechanism is tested against any constant, earth-fixed or one-sided force. It is no
//! physics to extrapolate.

use crate::parameter::ParameterInfo;
use crate::physics::Flow;
use crate::physics::Validity;
use crate::physics::{Group, Instant, Physics, Reach, Term, TermInfo};
use crate::state::Force;
use crate::terms::size;
use trimtab_ad::Scalar;

/// Mirror-breaking and earth-fixed discrepancy.
pub struct Asymmetric;

static INFO: TermInfo = TermInfo {
    name: "asymmetric",
    title: "generic one-sided or earth-fixed force",
    group: Group::External,
    equation: "X, Y, N = sum of coefficient times monomial (given with each parameter); u|u| times 1/2 rho L d, n|n| D^2 times rho D^2, \
               in N times L; |.| rounded at small speeds",
    source: "generic basis, no source",
    needs: &[],
    validity: Validity::any(
        "an unnamed force law: it is valid where the data that set its coefficients are, and nowhere else",
    ),
    mechanisms: &[],
    parameters: &[
        ParameterInfo::new("X_0", "X_0", "N", "constant").scale(size::force).spread(size::force),
        ParameterInfo::new("Y_0", "Y_0", "N", "constant").scale(size::force).spread(size::force).odd(),
        ParameterInfo::new("N_0", "N_0", "N m", "constant").scale(size::moment).spread(size::moment).odd(),
        ParameterInfo::new("Y_u_absu", "Y_u_absu", "-", "u|u|").scale(|_| 0.002).spread(|_| 0.002).odd(),
        ParameterInfo::new("N_u_absu", "N_u_absu", "-", "u|u|").scale(|_| 0.002).spread(|_| 0.002).odd(),
        ParameterInfo::new("Y_n_absn", "Y_n_absn", "-", "n|n| D^2").scale(|_| 0.01).spread(|_| 0.01).odd(),
        ParameterInfo::new("N_n_absn", "N_n_absn", "-", "n|n| D^2").scale(|_| 0.01).spread(|_| 0.01).odd(),
        ParameterInfo::new("X_cos", "X_cos", "N", "cos psi").scale(size::force).spread(size::force),
        ParameterInfo::new("X_sin", "X_sin", "N", "sin psi").scale(size::force).spread(size::force).odd(),
        ParameterInfo::new("Y_sin", "Y_sin", "N", "sin psi").scale(size::force).spread(size::force),
        ParameterInfo::new("Y_cos", "Y_cos", "N", "cos psi").scale(size::force).spread(size::force).odd(),
        ParameterInfo::new("N_sin", "N_sin", "N m", "sin psi").scale(size::moment).spread(size::moment),
        ParameterInfo::new("N_cos", "N_cos", "N m", "cos psi").scale(size::moment).spread(size::moment).odd(),
    ],
};

impl Term for Asymmetric {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }

    fn reach(&self, _parameter: usize) -> Reach {
        Reach::LinearForce
    }
}

impl<S: Scalar> Physics<S> for Asymmetric {
    fn force(&self, p: &[S::Coefficient], at: &Instant<S>, flow: &Flow<S>) -> Force<S> {
        let [x_0, y_0, n_0, y_u, n_u, y_n, n_n, x_cos, x_sin, y_sin, y_cos, n_sin, n_cos] =
            std::array::from_fn(|i| p[i]);
        let ship = at.ship;
        let d = ship.propeller.diameter;
        let small = at.small;
        let [sin, cos] = at.heading;
        let hull = flow.u * flow.abs_u * size::pressure(ship);
        let n = at.inputs.n * d;
        let propeller = n * (n * n + small * small).sqrt() * (ship.hull.water_density * d * d);
        Force {
            x: cos * x_cos + sin * x_sin + x_0,
            y: hull * y_u + cos * y_cos + sin * y_sin + (y_0 + y_n * propeller),
            n: (hull * n_u + n_n * propeller) * ship.hull.lpp + cos * n_cos + sin * n_sin + n_0,
        }
    }
}
