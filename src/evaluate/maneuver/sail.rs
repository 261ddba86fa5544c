//! Simulates a ship under orders that depend on its motion, with rudder and engine of finite rate.
//! The orders and the measures belong to each trial, not to this file.

use super::approach::Approach;
use super::track::Track;
use super::trial::Ended;
use crate::dynamics::Dynamics;
use crate::model::Model;
use crate::simulate::{Integration, Method, absurd_speed, driven, step};
use crate::state::{Force, Inputs, STATES};

/// Orders to rudder and engine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Orders {
    /// Rudder angle \[rad\].
    pub delta: f64,
    /// Propeller rate \[rps\].
    pub n: f64,
    /// Share of a step by which they were due before the sample at which they are given.
    pub late: f64,
}

impl Orders {
    /// Orders that are due at the sample at which they are given.
    pub fn at_once(delta: f64, n: f64) -> Self {
        Self { delta, n, late: 0.0 }
    }
}

/// Simulates from the approach (x = y = psi = 0, straight ahead) under the orders of `helm`, which receives the track so
/// far at every sample and gives the orders from then on, or `None` to end the trial.
///
/// Orders are followed at the approach's rudder and engine rate. Terms that act on whole input series (actuator lag,
/// rudder offset) are applied to the series that results, anew whenever an order changes; they must be causal.
pub(super) fn sail(
    model: &Model,
    theta: &[f64],
    approach: &Approach,
    helm: impl FnMut(&Track) -> Option<Orders>,
) -> (Track, Ended) {
    sail_for(model, theta, approach, 200.0, helm)
}

/// [`sail`] for at most the time of so many ship lengths at approach speed.
pub(super) fn sail_for(
    model: &Model,
    theta: &[f64],
    approach: &Approach,
    lengths: f64,
    mut helm: impl FnMut(&Track) -> Option<Orders>,
) -> (Track, Ended) {
    let dt = approach.step;
    let steps = (lengths * model.ship.hull.lpp / approach.speed / dt).ceil() as usize;
    let integration = Integration { method: Method::Rk4, substeps: 1 };
    let limit = absurd_speed(model);
    let dynamics = Dynamics::new(model, theta.to_vec());

    let mut orders = Orders::at_once(0.0, approach.n);
    let mut actuators: Vec<Inputs<f64>> =
        (0..=steps).map(|k| model.ship.inputs_ordered(k as f64 * dt, approach.n, 0.0)).collect();
    let mut series = driven(&dynamics, integration, dt, &actuators).into_owned();

    let mut track = Track::default();
    let mut state: [f64; STATES] = [0.0, 0.0, 0.0, approach.speed, 0.0, 0.0];
    for k in 0..=steps {
        track.t.push(k as f64 * dt);
        track.states.push(state);
        track.delta.push(actuators[k].delta);
        track.n.push(actuators[k].n);
        let Some(new) = helm(&track) else {
            return (track, Ended::Complete);
        };
        if (new.delta, new.n) != (orders.delta, orders.n) {
            orders = new;
            for i in k + 1..=steps {
                // What was due before this sample has the time since then beside the first step.
                let time = if i == k + 1 { (1.0 + orders.late) * dt } else { dt };
                let delta = follow(actuators[i - 1].delta, orders.delta, approach.rudder_rate * time);
                let n = follow(actuators[i - 1].n, orders.n, approach.engine_rate * time);
                actuators[i] = model.ship.inputs_ordered(i as f64 * dt, n, delta);
            }
            series = driven(&dynamics, integration, dt, &actuators).into_owned();
        }
        if k < steps {
            state = step(&dynamics, integration, dt, &state, &series[k * integration.instants()..], &Force::zero());
            if !(state.iter().all(|s| s.is_finite()) && state[3].hypot(state[4]) < limit) {
                return (track, Ended::Diverged { after: (k + 1) as f64 * dt });
            }
        }
    }
    (track, Ended::TimeOut { after: steps as f64 * dt })
}

/// One step of an actuator towards its order, by at most `reach`.
fn follow(now: f64, order: f64, reach: f64) -> f64 {
    now + (order - now).clamp(-reach, reach)
}
