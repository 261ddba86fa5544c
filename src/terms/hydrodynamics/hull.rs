//! Inertia and hull hydrodynamics in the Spyrou 1996 form, the left-hand side of the paper's eq. (1).
//! It gives the mass matrix and everything quadratic in (u, v, r); resistance in u alone is a term of its own.

use crate::parameter::{ParameterInfo, Start};
use crate::physics::Flow;
use crate::physics::{Adjust, Form, Group, Inertia, Instant, Physics, Reach, Term, TermInfo};
use crate::physics::{Validity, degrees};
use crate::ship::Ship;
use crate::state::Force;
use trimtab_ad::{Dual, Scalar};

/// Inertia and hull forces.
pub struct Hull;

macro_rules! derivative {
    ($name:literal, $unit:literal, $about:literal) => {
        ParameterInfo::new($name, $name, $unit, $about)
            .default(|s| s.coefficient($name))
            .in_mmg(Start::Replaced)
            .in_general(Start::Replaced)
            .scale(|s| 0.1 * reference(s, $name))
            .spread(|s| 0.3 * reference(s, $name))
    };
    // Added mass and the damping of a motion by its own force: a force that fed the motion would be energy from nowhere.
    ($name:literal, $unit:literal, $about:literal, negative) => {
        derivative!($name, $unit, $about).bounds(f64::NEG_INFINITY, 0.0)
    };
    // The added masses m_x, m_y and J_z, which forms `mmg` and `general` keep; all else of these is `mmg_hull` or `general_hull`. In form
    // `general` they begin at a share of the mass, for no regression is of such craft, and are known to half the mass.
    ($name:literal, $unit:literal, $about:literal, mass, $share:literal, $of:expr) => {
        derivative!($name, $unit, $about, negative)
            .in_mmg(Start::Same)
            .in_general(Start::Known(|s| $share * ($of)(s), |s| 0.5 * ($of)(s)))
    };
}

/// The mass of the ship \[kg\].
fn mass(ship: &Ship) -> f64 {
    ship.hull.mass
}

/// The size of a coefficient for scaling: its estimate, kept away from zero by a usual size of its kind.
fn reference(ship: &Ship, name: &str) -> f64 {
    let usual = match name {
        "Xudot" | "Xvr" => 0.01,
        "Yvdot" | "Yv" | "Yvv" => 0.1,
        "Nrdot" | "Nr" | "Nrr" => 0.01,
        "Yr" | "Nv" | "Yvr" | "Nrrv" | "Nvvr" => 0.05,
        _ => 0.01,
    };
    let power = crate::ship::COEFFICIENTS.iter().find(|(n, _)| *n == name).map_or(0, |(_, p)| *p);
    let floor = usual * 0.5 * ship.hull.water_density * ship.hull.lpp.powi(power) * ship.hull.draught;
    ship.coefficient(name).abs().max(floor)
}

static INFO: TermInfo = TermInfo {
    name: "hull",
    title: "inertia and hull hydrodynamics",
    group: Group::Hull,
    equation: "(m-Xudot) u' + (Yvdot-Xvr-m) v r + (Yrdot-m xG) r^2 = X; \
               (m-Yvdot) v' + (m xG-Yrdot) r' - Yv U v + (m u-Yr U) r - Yvv v|v| - Yvr v|r| - Yrr r|r| = Y; \
               (m xG-Nvdot) v' + (Iz-Nrdot) r' - Nv U v + (m xG u-Nr U) r - Nrr r|r| - Nrrv r^2 v/U - Nvvr v^2 r/U = N; \
               form `mmg`: (m-Xudot) u r in Y, and what is not a mass is `mmg_hull`; form `general`: as `mmg`, with \
               (Xudot-Yvdot) u v in N, and what is not a mass is `general_hull`",
    source: "Papandreou et al. 2025 (arXiv 2502.18696) eq. (1) after Spyrou 1996; coefficients by Clarke et al. 1982 and Inoue et al. 1981",
    needs: &[],
    validity: Validity {
        froude: Some([0.0, 0.25]),
        drift: Some([0.0, degrees(20.0)]),
        turn: Some([0.0, 1.4]),
        depth: Some([3.0, f64::INFINITY]),
        source: "Yasukawa & Yoshimura 2015, section 2: lateral velocity small beside the forward one, no wave making; printed for headway; deep water is h/d > 3 by the classes of PIANC 1992. The numbers 0.25, 20 deg and 1.4 are engineering limits: from 20 deg and 0.5 r L/u = tan 35 deg on, low-speed codes go over to another model",
        ..Validity::ANY
    },
    mechanisms: &[],
    parameters: &[
        ParameterInfo::new("mass", "m", "kg", "mass")
            .default(|s| s.hull.mass)
            .scale(|s| 0.1 * s.hull.mass)
            .spread(|s| 0.05 * s.hull.mass)
            .bounds(1e-3, f64::INFINITY),
        ParameterInfo::new("inertia", "Iz", "kg m2", "yaw moment of inertia about midship")
            .default(Ship::yaw_inertia)
            .scale(|s| 0.1 * s.yaw_inertia())
            .spread(|s| 0.1 * s.yaw_inertia())
            .bounds(1e-6, f64::INFINITY),
        ParameterInfo::new("x_g", "xG", "m", "centre of gravity forward of midship")
            .default(|s| s.hull.x_g)
            .scale(|s| 0.01 * s.hull.lpp)
            .spread(|s| 0.01 * s.hull.lpp),
        derivative!("Xudot", "kg", "surge added mass, negative", mass, -0.1, mass),
        derivative!("Yvdot", "kg", "sway added mass, negative", mass, -0.7, mass),
        derivative!("Yrdot", "kg m", "sway-yaw added mass"),
        derivative!("Nvdot", "kg m", "yaw-sway added mass"),
        derivative!("Nrdot", "kg m2", "yaw added inertia, negative", mass, -0.5, Ship::yaw_inertia),
        derivative!("Xvr", "kg", "surge force of drift and turn"),
        derivative!("Yv", "kg/m", "linear sway damping", negative),
        derivative!("Yr", "kg", "sway force of turn"),
        derivative!("Nv", "kg", "yaw moment of drift"),
        derivative!("Nr", "kg m", "linear yaw damping", negative),
        derivative!("Yvv", "kg/m", "quadratic sway damping", negative),
        derivative!("Yvr", "kg", "sway force of v|r|"),
        derivative!("Yrr", "kg m", "sway force of r|r|"),
        derivative!("Nrr", "kg m2", "quadratic yaw damping", negative),
        derivative!("Nrrv", "kg m2", "yaw moment of r^2 v/U"),
        derivative!("Nvvr", "kg m", "yaw moment of v^2 r/U"),
    ],
};

impl Term for Hull {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }

    fn reach(&self, parameter: usize) -> Reach {
        if parameter < DAMPING { Reach::Inertia } else { Reach::LinearForce }
    }
}

/// Index of the first damping coefficient: before it are masses, inertia and added masses.
pub(crate) const DAMPING: usize = 8;

/// Mass \[kg\] and its moment about midship \[kg m\], and the added masses Yvdot \[kg\], Yrdot \[kg m\] and, in forms `mmg` and `general`, Xudot \[kg\],
/// as they turn with the ship. The forms `paper` and `regular` have Xudot in their Yr.
#[inline(always)]
fn turning<C: Scalar<Coefficient = C>>(p: &[C], a: &Adjust<C>, form: Form) -> [C; 5] {
    let surge = if matches!(form, Form::Mmg | Form::General) { p[3] } else { C::zero() };
    [p[0] * a.mass, p[0] * a.mass * (p[2] + a.x_g), p[4] * a.added_mass, p[5] * a.added_mass, surge]
}

/// What one of the masses of the term changes, per unit: the mass matrix and the masses that turn with the ship.
#[derive(Clone, Copy, Debug)]
pub struct MassSlope<C> {
    matrix: Inertia<C>,
    turning: [C; 5],
    /// Whether the Munk moment is a force of its own.
    munk: bool,
}

impl<C: Scalar<Coefficient = C>> MassSlope<C> {
    /// By each of the masses from m to Nrdot at the parameters `p` of the term, under what other terms change.
    #[inline(always)]
    pub fn all(p: &[C], adjust: &Adjust<C>, form: Form) -> [Self; DAMPING] {
        let p: [Dual<C, DAMPING>; DAMPING] = std::array::from_fn(|j| Dual::variable(p[j], j));
        let adjust = adjust.map(Dual::constant);
        let (matrix, turning) = (Inertia::new(&p, &adjust), turning(&p, &adjust, form));
        let munk = form == Form::General;
        std::array::from_fn(|j| Self { matrix: matrix.map(|m| m.eps[j]), turning: turning.map(|m| m.eps[j]), munk })
    }

    /// The change of force per unit mass, less what the changed mass matrix takes for itself at the accelerations (u', v', r')
    /// through the water: the change of the accelerations follows from it as from a force.
    #[inline(always)]
    pub fn force(&self, flow: &Flow<C>, rates: &[C; 3]) -> Force<C> {
        let [m, moment, yvdot, yrdot, xudot] = self.turning;
        let ur = flow.u * flow.r;
        let x = flow.v * flow.r * (m - yvdot) + flow.r * flow.r * (moment - yrdot);
        let mut force = Force { x, y: -(ur * (m - xudot)), n: -(ur * moment) };
        if self.munk {
            force.n -= flow.u * flow.v * (xudot - yvdot);
        }
        force - self.matrix.force(rates)
    }
}

/// What each damping coefficient is multiplied with, from Xvr to Nvvr: a surge force, seven sway forces and yaw moments as the
/// coefficient's name says.
///
/// Form `regular` (Yoshimura's low-speed form, and share `sternway` of it in the paper form): U is replaced by |u| in the
/// damping terms Yv and Nr, and by u in the odd terms Yr and Nv. 1/U is 1/sqrt(U^2 + small^2) in both forms.
#[inline(always)]
fn damping<S: Scalar>(at: &Instant<S>, flow: &Flow<S>) -> [S; 11] {
    let a = &flow.adjust;
    let (u, v, r) = (flow.u, flow.v, flow.r);
    let share = match at.form {
        Form::Paper => a.sternway,
        Form::Regular | Form::Mmg | Form::General => S::Coefficient::one(),
    };
    let (even, odd) = (flow.speed + (flow.abs_u - flow.speed) * share, flow.speed + (u - flow.speed) * share);
    let (vr, rr) = (v * r, r * flow.abs_r);
    let slow = vr / flow.speed;
    [
        vr,
        v * even * a.sway,
        r * odd * a.rotary,
        v * odd * a.yaw_static,
        r * even * a.rotary,
        v * flow.abs_v * a.sway_drag,
        v * flow.abs_r * a.sway_mixed,
        rr * a.sway_mixed,
        rr * a.rotary_drag,
        slow * r * a.yaw_mixed,
        slow * v * a.yaw_mixed,
    ]
}

impl<S: Scalar> Physics<S> for Hull {
    /// Everything of eq. (1)'s left-hand side but the accelerations, moved to the right.
    #[inline(always)]
    fn force(&self, p: &[S::Coefficient], at: &Instant<S>, flow: &Flow<S>) -> Force<S> {
        let [m, moment, yvdot, yrdot, xudot] = turning(p, &flow.adjust, at.form);
        let [vr, y_v, y_r, n_v, n_r, y_vv, y_vr, y_rr, n_rr, n_rrv, n_vvr] = damping(at, flow);
        let p = &p[DAMPING..];
        let ur = flow.u * flow.r;
        let mut force = Force {
            x: vr * (m + p[0] - yvdot) + flow.r * flow.r * (moment - yrdot),
            y: y_v * p[1] + y_r * p[2] + y_vv * p[5] + y_vr * p[6] + y_rr * p[7] - ur * (m - xudot),
            n: n_v * p[3] + n_r * p[4] + n_rr * p[8] + n_rrv * p[9] + n_vvr * p[10] - ur * moment,
        };
        if at.form == Form::General {
            force.n -= flow.u * flow.v * (xudot - yvdot);
        }
        force
    }

    #[inline(always)]
    fn slopes(&self, _p: &mut [S::Coefficient], at: &Instant<S>, flow: &Flow<S>, out: &mut [Force<S>]) {
        let surge = |x: S| Force { x, ..Force::zero() };
        let sway = |y: S| Force { y, ..Force::zero() };
        let yaw = |n: S| Force { n, ..Force::zero() };
        let [vr, y_v, y_r, n_v, n_r, y_vv, y_vr, y_rr, n_rr, n_rrv, n_vvr] = damping(at, flow);
        let slopes = [
            surge(vr),
            sway(y_v),
            sway(y_r),
            yaw(n_v),
            yaw(n_r),
            sway(y_vv),
            sway(y_vr),
            sway(y_rr),
            yaw(n_rr),
            yaw(n_rrv),
            yaw(n_vvr),
        ];
        out[DAMPING..].copy_from_slice(&slopes);
    }
}
