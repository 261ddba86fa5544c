//! Hull forces of a craft of which mass, length and breadth are all that is known: damping that takes energy out at every state, by the
//! signs of its coefficients alone, and cross-couplings that do no work. Masses and added masses stay those of `hull`.

use crate::parameter::{ParameterInfo, Start};
use crate::physics::{Flow, Group, Instant, Physics, Reach, Term, TermInfo, Validity};
use crate::ship::Ship;
use crate::state::Force;
use crate::terms::size;
use trimtab_ad::Scalar;

/// Hull of any craft.
pub struct GeneralHull;

/// m/T with T = sqrt(L/g): unit of linear damping \[kg/s\].
fn linear(s: &Ship) -> f64 {
    s.hull.mass / size::time(s)
}

/// m/L: unit of damping by the square of a forward velocity \[kg/m\].
fn along(s: &Ship) -> f64 {
    s.hull.mass / s.hull.lpp
}

/// m/B: unit of damping by the square of a lateral velocity \[kg/m\]: 1/2 rho L d over C_b/2.
fn across(s: &Ship) -> f64 {
    s.hull.mass / s.hull.breadth
}

/// L^2.
fn square(s: &Ship) -> f64 {
    s.hull.lpp * s.hull.lpp
}

/// A coefficient of damping: it begins at its size, and cannot be negative. Sizes are such that a craft turns slowly and keeps its course
/// at first: a fit that begins with one that spins does not find its way back.
macro_rules! damping {
    ($name:literal, $symbol:literal, $unit:literal, $about:literal, $size:expr) => {
        ParameterInfo::new($name, $symbol, $unit, $about)
            .in_general(Start::Own($size))
            .scale($size)
            .spread(|s| 3.0 * ($size)(s))
            .bounds(0.0, f64::INFINITY)
    };
}

static INFO: TermInfo = TermInfo {
    name: "general_hull",
    title: "hull of any craft",
    group: Group::Hull,
    equation: "w_i = v + x_i r at bow, midship and stern, x_i = L/2, 0, -L/2; X = -(a + b |u| + c |v| + d L |r|) u + g v r; \
               Y = -sum_i (a_i + b_i |w_i| + c_i |u|) w_i + (h - g) u r; \
               N = -sum_i x_i (a_i + b_i |w_i| + c_i |u|) w_i - (a_N + b_N |r| + c_N |u|) r - h u v; every a, b, c, d >= 0. \
               With (m + m_y) v r, (m + m_x) u r and the Munk moment (m_y - m_x) u v of `hull` in form `general`",
    source: "cross-flow drag by strips (Faltinsen 1990, Sea Loads, section 6.4) at three stations instead of many, exact Coriolis by Fossen 2011, \
             section 6.3; that every coefficient has one sign, so that v.F <= 0, is this term's own",
    needs: &[],
    validity: Validity::any("it is fitted, not predicted: valid where the recordings are"),
    mechanisms: &[],
    parameters: &[
        damping!("surge_linear", "a", "kg/s", "surge damping at rest", |s| 0.02 * linear(s)),
        damping!("surge_square", "b", "kg/m", "surge damping by |u|", |s| 0.1 * along(s)),
        damping!("surge_drift", "c", "kg/m", "surge damping by |v|", |s| 0.1 * along(s)),
        damping!("surge_turn", "d", "kg/m", "surge damping by L |r|", |s| 0.05 * along(s)),
        damping!("bow_linear", "a_B", "kg/s", "lateral damping at the bow, at rest", |s| 0.02 * linear(s)),
        damping!("mid_linear", "a_M", "kg/s", "lateral damping at midship, at rest", |s| 0.02 * linear(s)),
        damping!("stern_linear", "a_S", "kg/s", "lateral damping at the stern, at rest", |s| 0.02 * linear(s)),
        damping!("bow_square", "b_B", "kg/m", "cross-flow drag at the bow", |s| 0.15 * across(s)),
        damping!("mid_square", "b_M", "kg/m", "cross-flow drag at midship", |s| 0.3 * across(s)),
        damping!("stern_square", "b_S", "kg/m", "cross-flow drag at the stern", |s| 0.15 * across(s)),
        damping!("bow_lift", "c_B", "kg/m", "lateral damping at the bow by |u|", |s| 0.05 * across(s)),
        damping!("mid_lift", "c_M", "kg/m", "lateral damping at midship by |u|", |s| 0.1 * across(s)),
        damping!("stern_lift", "c_S", "kg/m", "lateral damping at the stern by |u|", |s| 0.1 * across(s)),
        damping!("yaw_linear", "a_N", "kg m2/s", "yaw damping at rest", |s| 0.05 * linear(s) * square(s)),
        damping!("yaw_square", "b_N", "kg m2", "yaw damping by |r|", |s: &Ship| 0.1 * s.hull.mass * square(s)),
        damping!("yaw_lift", "c_N", "kg m", "yaw damping by |u|", |s| 0.1 * along(s) * square(s)),
        ParameterInfo::new("turning", "g", "kg", "surge force of drift and turn beside (m + m_y) v r, without work")
            .scale(|s| 0.2 * s.hull.mass)
            .spread(|s| 0.5 * s.hull.mass),
        ParameterInfo::new("lift", "h", "kg", "moment of drift that takes from the Munk moment, without work")
            .in_general(Start::Own(|s| -0.5 * s.hull.mass))
            .scale(|s| 0.2 * s.hull.mass)
            .spread(|s| 0.5 * s.hull.mass),
    ],
};

impl Term for GeneralHull {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }

    fn reach(&self, _parameter: usize) -> Reach {
        Reach::LinearForce
    }
}

/// How many coefficients damp, before those that do no work.
const DAMPING: usize = 16;

/// The force per unit of each coefficient.
#[inline(always)]
fn factors<S: Scalar>(at: &Instant<S>, flow: &Flow<S>) -> [Force<S>; 18] {
    let l = at.ship.hull.lpp;
    let (u, v, r) = (flow.u, flow.v, flow.r);
    let mut out = [Force::zero(); 18];
    for (out, by) in out.iter_mut().zip([S::one(), flow.abs_u, flow.abs_v, flow.abs_r * l]) {
        out.x = -(u * by);
    }
    for (i, x) in [0.5 * l, 0.0, -0.5 * l].into_iter().enumerate() {
        let w = v + r * x;
        let size = (w * w + at.small * at.small).sqrt();
        for (j, by) in [S::one(), size, flow.abs_u].into_iter().enumerate() {
            let y = -(w * by);
            out[4 + 3 * j + i] = Force { x: S::zero(), y, n: y * x };
        }
    }
    for (out, by) in out[13..DAMPING].iter_mut().zip([S::one(), flow.abs_r, flow.abs_u]) {
        out.n = -(r * by);
    }
    let ur = u * r;
    out[DAMPING] = Force { x: v * r, y: -ur, n: S::zero() };
    out[DAMPING + 1] = Force { x: S::zero(), y: ur, n: -(u * v) };
    out
}

impl<S: Scalar> Physics<S> for GeneralHull {
    fn force(&self, p: &[S::Coefficient], at: &Instant<S>, flow: &Flow<S>) -> Force<S> {
        let adjust = &flow.adjust;
        let mut force = Force::zero();
        for (j, (factor, p)) in factors(at, flow).into_iter().zip(p).enumerate() {
            let p = if j < 4 { *p * adjust.resistance } else { *p };
            force += Force { x: factor.x * p, y: factor.y * p, n: factor.n * p };
        }
        force
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Model;
    use crate::model::dynamics::Dynamics;
    use crate::physics::Form;
    use crate::state::{Inputs, State};
    use std::path::Path;

    fn model() -> Model {
        let text = "name = \"cat\"\n[hull]\nlpp = 1.2\nbreadth = 0.9\nmass = 15.0\n";
        let ship = Ship::parse(text, Path::new("ship.toml")).unwrap();
        Model::new(ship, "general", Form::General, &[]).unwrap()
    }

    /// Numbers between -1 and 1 from a fixed seed.
    fn drawn() -> impl FnMut() -> f64 {
        let mut seed = 20_261_127_u64;
        move || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        }
    }

    #[test]
    fn no_state_gains_energy_at_any_coefficients_within_the_bounds() {
        let base = model();
        let mut next = drawn();
        for _ in 0..2000 {
            let mut model = base.clone();
            for p in model.parameters.iter_mut().filter(|p| p.name.starts_with("general_hull.")) {
                p.value = (10.0 * next() * p.scale).max(p.lower);
            }
            for (name, at) in [("hull.Xudot", -20.0), ("hull.Yvdot", -40.0), ("hull.Nrdot", -3.0)] {
                let i = model.index(name).unwrap();
                model.parameters[i].value = at * next().abs();
            }
            let dynamics = Dynamics::new(&model, model.values());
            let state = State { x: 0.0, y: 0.0, psi: next(), u: 3.0 * next(), v: 3.0 * next(), r: 2.0 * next() };
            let inputs = Inputs::actuators(0.0, 0.0, 0.0);
            let at = dynamics.instant(&state, &inputs);
            let flow = dynamics.flow(&at);
            let force = dynamics.force(&at, &flow);
            let power = force.x * state.u + force.y * state.v + force.n * state.r;
            let size = (force.x * state.u).abs() + (force.y * state.v).abs() + (force.n * state.r).abs();
            assert!(power <= 1e-12 * size, "{power:e} W of {size:e} W at {state:?}");
        }
    }

    #[test]
    fn there_is_damping_at_rest() {
        let model = model();
        let dynamics = Dynamics::new(&model, model.values());
        let inputs = Inputs::actuators(0.0, 0.0, 0.0);
        for (u, v, r) in [(1e-6, 0.0, 0.0), (0.0, 1e-6, 0.0), (0.0, 0.0, 1e-6)] {
            let state = State { x: 0.0, y: 0.0, psi: 0.0, u, v, r };
            let at = dynamics.instant(&state, &inputs);
            let force = dynamics.force(&at, &dynamics.flow(&at));
            let damping = -(force.x * u + force.y * v + force.n * r) / (u * u + v * v + r * r);
            assert!(damping > 0.05 * linear(&model.ship) * 0.1, "{damping}");
        }
    }
}
