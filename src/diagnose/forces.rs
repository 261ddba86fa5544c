//! The force that some parameters of a model bring at the recorded states: with them less without them.
//! It measures what a model says; whether the model is right is not asked here.

use super::candidate::Candidate;
use super::estimate::Estimate;
use crate::model::Model;
use crate::parameter::Parity;
use crate::physics::Inertia;
use crate::recording::{Run, or_nan};
use crate::state::{Force, State};

/// Every so many samples are looked at.
const STRIDE: usize = 4;
/// A mechanism that leaves less than this share of its own force, once the base's is added, acts only to undo that.
const UNDONE: f64 = 0.4;

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
pub(super) fn forces_of(model: &Model, parameters: &[usize], runs: &[Run]) -> Vec<[f64; 3]> {
    let neutral = without(model, parameters);
    let mut out = Vec::new();
    for r in runs {
        let (with, bare) = (model.values_in(&r.session), neutral.values_in(&r.session));
        let (mut a, mut b) = (r.inputs.clone(), r.inputs.clone());
        model.drive(&with, r.dt, &mut a);
        neutral.drive(&bare, r.dt, &mut b);
        for ((m, i), j) in r.measured.iter().zip(&a).zip(&b).step_by(STRIDE) {
            if m.contains(&None) {
                continue;
            }
            let state = State::from_array(or_nan(m));
            let (x, flow) = model.rates(&with, &state, i, &Force::zero());
            let (y, _) = neutral.rates(&bare, &state, j, &Force::zero());
            let inertia = Inertia::new(model.part("hull", &with), &flow);
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

/// Whether a mechanism that breaks mirror symmetry only takes back what a free parameter of the base, which breaks it too, puts
/// where it acts: then that parameter is what is off there, it has taken up an effect elsewhere, and nothing acts here.
pub(super) fn undoes(c: &Candidate, found: &Estimate, runs: &[Run]) -> bool {
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
    left < UNDONE * UNDONE * gross
}
