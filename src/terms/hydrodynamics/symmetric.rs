//! A generic force law, alike to port and to starboard: every low-order monomial of speed, drift, yaw rate, rpm and rudder.
//! A named mechanism is tested against it, that is, against any smooth error of hull, propeller and rudder; it is no physics
//! to extrapolate.

use crate::parameter::ParameterInfo;
use crate::physics::Flow;
use crate::physics::Validity;
use crate::physics::{Group, Instant, Physics, Reach, Term, TermInfo};
use crate::ship::Ship;
use crate::state::Force;
use crate::terms::size;
use trimtab_ad::Scalar;

/// Mirror-symmetric discrepancy.
pub struct Symmetric;

const fn coefficient(name: &'static str, monomial: &'static str, size: fn(&Ship) -> f64) -> ParameterInfo {
    ParameterInfo::new(name, name, "-", monomial).scale(size).spread(size)
}

/// Number of monomials in X, and in each of Y and N.
const SURGE: usize = 10;
const LATERAL: usize = 13;

static INFO: TermInfo = TermInfo {
    name: "symmetric",
    title: "generic mirror-symmetric force",
    group: Group::Hull,
    equation: "X, Y, N/L = sum of coefficient times monomial (given with each parameter) times 1/2 rho L d; rho D^2 in its place \
               where n is in the monomial, else 1/2 rho A_R where delta is; W = u_R |u_R|, U_0 = 0.2 sqrt(g L); \
               X even and Y, N odd in (v, r, delta); |.| rounded at small speeds",
    source: "generic basis, no source",
    needs: &[],
    validity: Validity::any(
        "an unnamed force law: it is valid where the data that set its coefficients are, and nowhere else",
    ),
    mechanisms: &[],
    parameters: &[
        coefficient("X_u_absu", "u|u|", |_| 0.02),
        coefficient("X_uu", "u^2", |_| 0.02),
        coefficient("X_u", "u U_0", |_| 0.02),
        coefficient("X_vv", "v^2", |_| 0.02),
        coefficient("X_vr", "v r L", |_| 0.02),
        coefficient("X_rr", "r^2 L^2", |_| 0.02),
        coefficient("X_n_absn", "n|n| D^2", |_| 0.02),
        coefficient("X_nn", "n^2 D^2", |_| 0.02),
        coefficient("X_u_absn", "u |n| D", |_| 0.02),
        coefficient("X_deltadelta", "delta^2 W", |_| 0.1),
        coefficient("Y_v_absu", "v|u|", |_| 0.02),
        coefficient("Y_vu", "v u", |_| 0.02),
        coefficient("Y_v_absv", "v|v|", |_| 0.02),
        coefficient("Y_r_absu", "r L |u|", |_| 0.02),
        coefficient("Y_ru", "r L u", |_| 0.02),
        coefficient("Y_r_absr", "r|r| L^2", |_| 0.02),
        coefficient("Y_v_absr", "v|r| L", |_| 0.02),
        coefficient("Y_absv_r", "|v| r L", |_| 0.02),
        coefficient("Y_v_absn", "v |n| D", |_| 0.02),
        coefficient("Y_r_absn", "r L |n| D", |_| 0.02),
        coefficient("Y_delta_n", "delta n|n| D^2", |_| 0.02),
        coefficient("Y_delta_u", "delta u|u|", |_| 0.1),
        coefficient("Y_delta3", "delta^3 W", |_| 0.1),
        coefficient("N_v_absu", "v|u|", |_| 0.02),
        coefficient("N_vu", "v u", |_| 0.02),
        coefficient("N_v_absv", "v|v|", |_| 0.02),
        coefficient("N_r_absu", "r L |u|", |_| 0.02),
        coefficient("N_ru", "r L u", |_| 0.02),
        coefficient("N_r_absr", "r|r| L^2", |_| 0.02),
        coefficient("N_v_absr", "v|r| L", |_| 0.02),
        coefficient("N_absv_r", "|v| r L", |_| 0.02),
        coefficient("N_v_absn", "v |n| D", |_| 0.02),
        coefficient("N_r_absn", "r L |n| D", |_| 0.02),
        coefficient("N_delta_n", "delta n|n| D^2", |_| 0.02),
        coefficient("N_delta_u", "delta u|u|", |_| 0.1),
        coefficient("N_delta3", "delta^3 W", |_| 0.1),
    ],
};

impl Term for Symmetric {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }

    fn reach(&self, _parameter: usize) -> Reach {
        Reach::LinearForce
    }
}

fn dot<S: Scalar, const N: usize>(p: &[S::Coefficient], monomials: &[S; N]) -> S {
    p.iter().zip(monomials).fold(S::zero(), |sum, (p, m)| sum + *m * *p)
}

/// The monomials of X and those of Y and N, all in the hull's unit of force: 1/2 rho L d.
#[inline(always)]
fn monomials<S: Scalar>(at: &Instant<S>, flow: &Flow<S>) -> ([S; SURGE], [S; LATERAL]) {
    let ship = at.ship;
    let l = ship.hull.lpp;
    let d = ship.propeller.diameter;
    let hull = size::pressure(ship);
    // Conversions from the hull's unit to those of propeller and rudder.
    let propeller = ship.hull.water_density * d * d / hull;
    let rudder = 0.5 * ship.hull.water_density * ship.rudder.area / hull;
    let small = at.small;
    let (u, v, r) = (flow.u, flow.v, flow.r * l);
    let (abs_u, abs_v, abs_r) = (flow.abs_u, flow.abs_v, flow.abs_r * l);
    let n = at.inputs.n * d;
    let abs_n = (n * n + small * small).sqrt();
    let delta = at.inputs.delta;
    let race = flow.rudder_u * (flow.rudder_u * flow.rudder_u + small * small).sqrt();
    let surge = [
        u * abs_u,
        u * u,
        u * (0.2 * size::speed(ship)),
        v * v,
        v * r,
        r * r,
        S::lift(n * abs_n * propeller),
        S::lift(n * n * propeller),
        u * abs_n * propeller,
        race * (delta * delta) * rudder,
    ];
    let lateral = [
        v * abs_u,
        v * u,
        v * abs_v,
        r * abs_u,
        r * u,
        r * abs_r,
        v * abs_r,
        abs_v * r,
        v * abs_n * propeller,
        r * abs_n * propeller,
        S::lift(delta * n * abs_n * propeller),
        u * abs_u * delta * rudder,
        race * (delta * delta * delta) * rudder,
    ];
    (surge, lateral)
}

impl<S: Scalar> Physics<S> for Symmetric {
    fn force(&self, p: &[S::Coefficient], at: &Instant<S>, flow: &Flow<S>) -> Force<S> {
        let (hull, l) = (size::pressure(at.ship), at.ship.hull.lpp);
        let (surge, lateral) = monomials(at, flow);
        Force {
            x: dot(&p[..SURGE], &surge) * hull,
            y: dot(&p[SURGE..SURGE + LATERAL], &lateral) * hull,
            n: dot(&p[SURGE + LATERAL..], &lateral) * (hull * l),
        }
    }

    fn slopes(&self, _p: &mut [S::Coefficient], at: &Instant<S>, flow: &Flow<S>, out: &mut [Force<S>]) {
        let (hull, l) = (size::pressure(at.ship), at.ship.hull.lpp);
        let (surge, lateral) = monomials(at, flow);
        let (x, rest) = out.split_at_mut(SURGE);
        let (y, n) = rest.split_at_mut(LATERAL);
        let none = Force::zero();
        x.iter_mut().zip(surge).for_each(|(out, m)| *out = Force { x: m * hull, ..none });
        y.iter_mut().zip(lateral).for_each(|(out, m)| *out = Force { y: m * hull, ..none });
        n.iter_mut().zip(lateral).for_each(|(out, m)| *out = Force { n: m * (hull * l), ..none });
    }
}
