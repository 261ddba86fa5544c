//! Hull forces of the standard MMG method: resistance and the cubic polynomial in drift and turn, as primes in the form in which they are published.
//! Masses and added masses stay those of `hull`; a model of form `mmg` has this term in place of the other coefficients there.

use crate::parameter::{ParameterInfo, Start};
use crate::physics::Flow;
use crate::physics::{Group, Instant, Physics, Reach, Term, TermInfo};
use crate::physics::{Validity, degrees};
use crate::ship::Ship;
use crate::state::Force;
use crate::terms::size;
use std::f64::consts::PI;
use trimtab_ad::Scalar;

/// Hull of the standard MMG method.
pub struct MmgHull;

/// C_b B/L.
fn fullness(s: &Ship) -> f64 {
    s.hull.block_coefficient * s.hull.breadth / s.hull.lpp
}

/// Aspect ratio of the hull below water, 2d/L.
fn aspect(s: &Ship) -> f64 {
    2.0 * s.hull.draught / s.hull.lpp
}

/// (1 - C_b) L/B.
fn slenderness(s: &Ship) -> f64 {
    (1.0 - s.hull.block_coefficient) * s.hull.lpp / s.hull.breadth
}

/// R_0' of the resistance that the ship file sets at Froude number 0.15, else 0.02, the middle of published values.
fn resistance(s: &Ship) -> f64 {
    let u = 0.15 * size::speed(s);
    let given = |name: &str, power: i32| s.parameters.get(name).map_or(0.0, |p| p * u.powi(power));
    let total = given("resistance.linear", 1) + given("resistance.quadratic", 2) + given("resistance.cubic", 3);
    if total > 0.0 { total / (size::pressure(s) * u * u) } else { 0.02 }
}

macro_rules! prime {
    ($name:literal, $about:literal, $size:expr, $start:expr) => {
        ParameterInfo::new($name, concat!($name, "'"), "-", $about)
            .in_mmg(Start::Own($start))
            .scale(|_| 0.1 * $size)
            .spread(|_| 0.3 * $size)
    };
    ($name:literal, $about:literal, $size:expr, $start:expr, negative) => {
        prime!($name, $about, $size, $start).bounds(f64::NEG_INFINITY, 0.0)
    };
}

static INFO: TermInfo = TermInfo {
    name: "mmg_hull",
    title: "hull of the standard MMG method",
    group: Group::Hull,
    equation: "v' = v/U, r' = r L/U; X = 1/2 rho L d U^2 (-R_0' + X_vv' v'^2 + X_vr' v' r' + X_rr' r'^2 + X_vvvv' v'^4); \
               Y = 1/2 rho L d U^2 (Y_v' v' + Y_r' r' + Y_vvv' v'^3 + Y_vvr' v'^2 r' + Y_vrr' v' r'^2 + Y_rrr' r'^3); \
               N = 1/2 rho L^2 d U^2 (N_v' v' + ... + N_rrr' r'^3); with (m + m_x) u r and (m + m_y) v r on the left in form `mmg`. \
               For sternway R_0, Y_r, Y_vvr, Y_rrr, N_v, N_vvv and N_vrr change sign with u; r' beyond 3 is limited to about 3",
    source: "Yasukawa & Yoshimura 2015, J. Mar. Sci. Technol. 20, eq. 4 and 8 to 10; start values by Yoshimura & Masumoto 2012 (MARSIM), their X_vr less m_y'. The signs astern and the limit on r' are added, so that the law is finite at rest and the ship's ends are alike",
    needs: &[],
    validity: Validity {
        froude: Some([0.0, 0.25]),
        drift: Some([0.0, degrees(20.0)]),
        turn: Some([0.0, 1.4]),
        depth: Some([3.0, f64::INFINITY]),
        source: "Yasukawa & Yoshimura 2015, section 2: lateral velocity small beside the forward one, no wave making; printed for headway in deep water. The numbers are engineering limits, those of `hull`",
        ..Validity::ANY
    },
    mechanisms: &[],
    parameters: &[
        ParameterInfo::new("R_0", "R_0'", "-", "resistance on a straight course")
            .in_mmg(Start::Own(resistance))
            .scale(|_| 0.002)
            .spread(|_| 0.006)
            .bounds(0.0, f64::INFINITY),
        prime!("X_vv", "surge force of drift", 0.1, |s| 1.15 * fullness(s) - 0.18),
        prime!("X_vr", "surge force of drift and turn, beside (m + m_y) v r", 0.1, |s| 0.08 - 1.91 * fullness(s)),
        prime!("X_rr", "surge force of turn", 0.02, |s| 0.008 - 0.085 * fullness(s)),
        prime!("X_vvvv", "surge force of large drift", 0.8, |s| 1.1 - 6.68 * fullness(s)),
        prime!("Y_v", "sway damping", 0.3, |s| -(0.5 * PI * aspect(s) + 1.4 * fullness(s)), negative),
        prime!("Y_r", "sway force of turn, beside (m + m_x) u r", 0.1, |s| {
            -s.coefficient("Xudot") / (size::pressure(s) * s.hull.lpp) + 0.5 * fullness(s)
        }),
        prime!("Y_vvv", "cubic sway damping", 1.0, |s| 0.48 - 0.185 * s.hull.lpp / s.hull.breadth),
        prime!("Y_vvr", "sway force of v'^2 r'", 0.6, |_| -0.75),
        prime!("Y_vrr", "sway force of v' r'^2", 0.5, |s| -(0.26 * slenderness(s) + 0.11)),
        prime!("Y_rrr", "cubic sway force of turn", 0.05, |_| -0.051),
        prime!("N_v", "yaw moment of drift", 0.15, |s| -aspect(s)),
        prime!("N_r", "yaw damping", 0.05, |s| aspect(s) * (aspect(s) - 0.54), negative),
        prime!("N_vvv", "cubic yaw moment of drift", 0.2, |s| 0.69 * s.hull.block_coefficient - 0.66),
        prime!("N_vvr", "yaw damping of v'^2 r'", 0.4, |s| 1.55 * fullness(s) - 0.76),
        prime!("N_vrr", "yaw moment of v' r'^2", 0.2, |s| -(0.075 * slenderness(s) + 0.098)),
        prime!("N_rrr", "cubic yaw damping", 0.03, |s| 0.25 * fullness(s) - 0.056),
    ],
};

impl Term for MmgHull {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }

    fn reach(&self, _parameter: usize) -> Reach {
        Reach::LinearForce
    }
}

/// r' from which on the polynomial is no longer followed.
const FASTEST_TURN: f64 = 3.0;

/// What each prime is multiplied with: five surge forces, six sway forces and six yaw moments.
#[inline(always)]
fn factors<S: Scalar>(at: &Instant<S>, flow: &Flow<S>) -> [S; 17] {
    let (l, a) = (at.ship.hull.lpp, &flow.adjust);
    let (v, r) = (flow.v, flow.r * l);
    // Speed by which the quotients are made: U, but not below r L/3, so that turning on the spot stays finite. By the eighth power
    // it is U to a thousandth for r' up to 1.7.
    let slowest = r * r / (FASTEST_TURN * FASTEST_TURN);
    let (square, low) = (flow.speed * flow.speed, slowest * slowest);
    let quartic = square * square * square * square + low * low;
    let pace = quartic.sqrt().sqrt().sqrt();
    let inverse = S::one() / pace;
    let (vv, rr) = (v * v, r * r);
    let ahead = flow.u / flow.abs_u;
    let unit = size::pressure(at.ship);
    let (vvv, vvr, vrr, rrr) = (vv * v * inverse, vv * r * inverse, rr * v * inverse, rr * r * inverse);
    let surge = [square * ahead * -a.resistance, vv, v * r, rr, vv * vv * inverse * inverse];
    let drift = v * flow.speed;
    let turn = r * flow.speed;
    let sway = [
        drift * a.sway,
        turn * ahead * a.rotary,
        vvv * a.sway_drag,
        vvr * ahead * a.sway_mixed,
        vrr * a.sway_mixed,
        rrr * ahead * a.sway_mixed,
    ];
    let yaw = [
        drift * ahead * a.yaw_static,
        turn * a.rotary,
        vvv * ahead * a.yaw_static,
        vvr * a.yaw_mixed,
        vrr * ahead * a.yaw_mixed,
        rrr * a.rotary_drag,
    ];
    let mut all = [S::zero(); 17];
    for (out, factor) in all.iter_mut().zip(surge.into_iter().chain(sway)) {
        *out = factor * unit;
    }
    for (out, factor) in all[11..].iter_mut().zip(yaw) {
        *out = factor * (unit * l);
    }
    all
}

impl<S: Scalar> Physics<S> for MmgHull {
    fn force(&self, p: &[S::Coefficient], at: &Instant<S>, flow: &Flow<S>) -> Force<S> {
        let factors = factors(at, flow);
        let sum = |range: std::ops::Range<usize>| range.fold(S::zero(), |sum, i| sum + factors[i] * p[i]);
        Force { x: sum(0..5), y: sum(5..11), n: sum(11..17) }
    }

    fn slopes(&self, _p: &mut [S::Coefficient], at: &Instant<S>, flow: &Flow<S>, out: &mut [Force<S>]) {
        for (i, (out, factor)) in out.iter_mut().zip(factors(at, flow)).enumerate() {
            let mut force = Force::zero();
            match i {
                0..5 => force.x = factor,
                5..11 => force.y = factor,
                _ => force.n = factor,
            }
            *out = force;
        }
    }
}
