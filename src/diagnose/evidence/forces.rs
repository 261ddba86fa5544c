//! The force that some parameters of a model bring at the recorded states: with them less without them.
//! It takes the model as given; whether the model is right is tested elsewhere.

use super::candidate::Candidate;
use crate::diagnose::settings::{FORCE_STRIDE, REMAINDER};
use crate::dynamics::Dynamics;
use crate::likelihood::estimate::Estimate;
use crate::model::Model;
use crate::parameter::Parity;
use crate::recording::{Run, or_nan};
use crate::state::{Force, State};

/// The model with some parameters neutral, in every session.
fn without(model: &Model, parameters: &[usize]) -> Model {
    let mut out = model.clone();
    for i in parameters {
        let p = &mut out.parameters[*i];
        p.value = (p.info.default)(&out.ship);
        for list in out.sessions.values_mut() {
            list.retain(|(j, _)| j != i);
        }
    }
    out
}

/// Force that some parameters bring at measured states: X, Y \[N\], N \[N m\].
pub fn forces_of(model: &Model, parameters: &[usize], runs: &[Run]) -> Vec<[f64; 3]> {
    let neutral = without(model, parameters);
    let mut out = Vec::new();
    for r in runs {
        let (with, bare) = (model.values_in(&r.session), neutral.values_in(&r.session));
        let (mut a, mut b) = (r.inputs.clone(), r.inputs.clone());
        let (with, bare) = (Dynamics::new(model, with), Dynamics::new(&neutral, bare));
        with.drive(r.dt, &mut a);
        bare.drive(r.dt, &mut b);
        for ((m, i), j) in r.measured.iter().zip(&a).zip(&b).step_by(FORCE_STRIDE) {
            if m.contains(&None) {
                continue;
            }
            let state = State::from_array(or_nan(m));
            let (x, flow) = with.rates(&state, i, &Force::zero());
            let (y, _) = bare.rates(&state, j, &Force::zero());
            let inertia = with.inertia(&flow);
            let d = [x[3] - y[3], x[4] - y[4], x[5] - y[5]];
            out.push([
                inertia.surge * d[0],
                inertia.sway * d[1] + inertia.sway_yaw * d[2],
                inertia.yaw_sway * d[1] + inertia.yaw * d[2],
            ]);
        }
    }
    out
}

/// Whether a mechanism that breaks mirror symmetry only cancels the force that a free parameter of the base, which breaks it too,
/// brings where the mechanism acts: then that parameter has taken up an effect elsewhere and is wrong here.
pub fn only_cancels(c: &Candidate, found: &Estimate, runs: &[Run]) -> bool {
    let odd = |i: usize| found.model.parameters[i].info.parity == Parity::Odd;
    let own: Vec<usize> = c.columns.iter().map(|col| col.parameter).collect();
    let base = found.free.iter().filter(|f| f.prior.is_none() && f.sessions.is_none()).map(|f| f.column.parameter);
    let rivals: Vec<usize> = base.filter(|i| odd(*i) && !own.contains(i)).collect();
    if rivals.is_empty() || !own.iter().all(|i| odd(*i)) {
        return false;
    }
    let brought = forces_of(&found.model, &own, runs);
    let all: Vec<usize> = own.iter().chain(&rivals).copied().collect();
    let net = forces_of(&found.model, &all, runs);
    let (mut gross, mut left) = (0.0, 0.0);
    for (b, n) in brought.iter().zip(&net).filter(|(b, _)| b[1] != 0.0) {
        gross += b[1] * b[1];
        left += n[1] * n[1];
    }
    left < REMAINDER * REMAINDER * gross
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{at, candidate, model, runs, with};

    #[test]
    fn a_neutral_parameter_brings_no_force_and_a_force_fixed_on_the_earth_its_own_on_every_heading() {
        let runs = runs(&model(), 4);
        let of = |m: &Model| forces_of(m, &[m.find("earth_force.north").unwrap()], &runs);
        assert!(of(&model()).iter().flatten().all(|f| *f == 0.0));
        let model = with(&[("earth_force.north", 1000.0)]);
        let headings = runs.iter().flat_map(|r| r.measured.iter().step_by(FORCE_STRIDE)).map(|m| m[2].unwrap());
        for (f, psi) in of(&model).iter().zip(headings) {
            let expected = [1000.0 * psi.cos(), -1000.0 * psi.sin(), 0.0];
            // The moment is what is left of inertia times acceleration; its unit is the force times the length.
            let off = [f[0] - expected[0], f[1] - expected[1], f[2] / 85.0].map(f64::abs);
            assert!(off.iter().all(|d| *d < 1e-6), "{f:?} {expected:?}");
        }
    }

    #[test]
    fn samples_without_a_value_are_left_out() {
        let model = with(&[("earth_force.north", 1000.0)]);
        let mut runs = runs(&model, 1);
        let all = forces_of(&model, &[model.find("earth_force.north").unwrap()], &runs).len();
        runs[0].measured[0][4] = None;
        assert_eq!(forces_of(&model, &[model.find("earth_force.north").unwrap()], &runs).len(), all - 1);
    }

    #[test]
    fn an_offset_that_takes_back_the_lift_at_zero_angle_only_cancels_it_and_one_beside_no_lift_does_not() {
        let c = candidate(&model(), "rudder_offset");
        let runs = runs(&model(), 6);
        let of = |lift0: f64| {
            let lift = |offset: f64| {
                let m = with(&[("rudder.lift0", lift0), ("rudder_offset.offset", offset)]);
                let all = ["rudder.lift0", "rudder_offset.offset"].map(|n| m.find(n).unwrap());
                (forces_of(&m, &all, &runs).iter().map(|f| f[1] * f[1]).sum::<f64>(), m)
            };
            // The offset that leaves least of the force of both.
            let offsets = (-20..=20).filter(|i| *i != 0).map(|i| 0.002 * f64::from(i));
            let best = offsets.map(lift).min_by(|a, b| a.0.total_cmp(&b.0)).unwrap().1;
            only_cancels(&c, &at(&best), &runs)
        };
        assert!(of(-0.06) && !of(0.0));
    }
}
