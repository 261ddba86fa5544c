//! From a scenario, a model and parameters to a trajectory: explicit Euler as in the paper, RK4 for audits.
//! The same code runs on any number type; what happens to the states on the way out is the caller's.

pub mod sensitivity;

use crate::dynamics::Dynamics;
use crate::model::Model;
use crate::physics::Number;
use crate::ranges::{Limited, OutOfRange, counted};
use crate::state::{Force, Inputs, STATES, State};
use crate::units::GRAVITY;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use trimtab_ad::Scalar;

/// How a step is integrated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// Explicit Euler, as in the paper: order 1.
    #[default]
    Euler,
    /// Classical Runge-Kutta: order 4 where the inputs are linear within a sub-step.
    Rk4,
}

/// Integration settings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Integration {
    /// Method.
    pub method: Method,
    /// Sub-steps within one sample period; inputs are linear between samples.
    pub substeps: usize,
}

impl Default for Integration {
    fn default() -> Self {
        Self { method: Method::Euler, substeps: 1 }
    }
}

impl Limited for Integration {
    fn limits(&self) -> Result<(), OutOfRange> {
        counted("substeps", self.substeps, &(1..=MOST_SUBSTEPS), "steps of the integration in one sample period")
    }
}

/// More sub-steps than any recording needs: a sample period of 10 s in steps of 10 ms.
pub const MOST_SUBSTEPS: usize = 1000;

impl Integration {
    /// Instants in a sample period at which a simulation looks at the inputs, one end included: 1 for Euler's step, 2 for RK4's.
    pub fn instants(self) -> usize {
        let stages = match self.method {
            Method::Euler => 1,
            Method::Rk4 => 2,
        };
        stages * self.substeps.max(1)
    }
}

/// What a simulation needs beside a model: sample period, inputs at every sample, and the initial state.
#[derive(Clone, Debug)]
pub struct Scenario {
    /// Sample period \[s\].
    pub dt: f64,
    /// Inputs at each sample.
    pub inputs: Vec<Inputs<f64>>,
    /// State at the first sample `[x, y, psi, u, v, r]`.
    pub initial: [f64; STATES],
}

/// A simulated run.
#[derive(Clone, Debug)]
pub struct Trajectory {
    /// Sample period \[s\].
    pub dt: f64,
    /// State at each sample; shorter than the scenario when the simulation diverged.
    pub states: Vec<[f64; STATES]>,
    /// First sample at which the state was no longer finite or the ship was absurdly fast.
    pub diverged_at: Option<usize>,
}

/// Speed over ground beyond which a simulation is called diverged: 10 sqrt(g L) \[m/s\].
pub fn absurd_speed(model: &Model) -> f64 {
    10.0 * (GRAVITY * model.ship.hull.lpp).sqrt()
}

/// Advances a state over one sub-step of length `h` \[s\] under inputs known at its start, middle and end.
#[inline(always)]
fn advance<S: Number>(
    dynamics: &Dynamics<S::Coefficient>,
    method: Method,
    h: f64,
    state: &[S; STATES],
    inputs: [&Inputs<S::Coefficient>; 3],
    push: &Force<S>,
) -> [S; STATES]
where
    S::Coefficient: Number<Coefficient = S::Coefficient>,
{
    let f = |s: &[S; STATES], i: &Inputs<S::Coefficient>| dynamics.rates(&State::from_array(*s), i, push).0;
    let moved = |k: &[S; STATES], h: f64| std::array::from_fn(|j| state[j] + k[j] * h);
    let k1 = f(state, inputs[0]);
    match method {
        Method::Euler => moved(&k1, h),
        Method::Rk4 => {
            let k2 = f(&moved(&k1, 0.5 * h), inputs[1]);
            let k3 = f(&moved(&k2, 0.5 * h), inputs[1]);
            let k4 = f(&moved(&k3, h), inputs[2]);
            std::array::from_fn(|j| state[j] + (k1[j] + (k2[j] + k3[j]) * 2.0 + k4[j]) * (h / 6.0))
        }
    }
}

/// Advances a state over one sample period, in sub-steps; `inputs` are those at its [`Integration::instants`], both ends
/// included.
pub fn step<S: Number>(
    dynamics: &Dynamics<S::Coefficient>,
    integration: Integration,
    dt: f64,
    state: &[S; STATES],
    inputs: &[Inputs<S::Coefficient>],
    push: &Force<S>,
) -> [S; STATES]
where
    S::Coefficient: Number<Coefficient = S::Coefficient>,
{
    let count = integration.substeps.max(1);
    let stages = integration.instants() / count;
    let h = dt / count as f64;
    let mut state = *state;
    for i in (0..count).map(|i| i * stages) {
        let stage = [&inputs[i], &inputs[i + stages / 2], &inputs[i + stages]];
        state = advance(dynamics, integration.method, h, &state, stage, push);
    }
    state
}

/// Inputs that are linear between two samples, at the instants that follow the first, up to the second.
pub fn between<S: Scalar>(now: &Inputs<S>, next: &Inputs<S>, instants: usize) -> impl Iterator<Item = Inputs<S>> {
    let (now, next) = (*now, *next);
    (1..=instants).map(move |i| if i == instants { next } else { now.between(&next, i as f64 / instants as f64) })
}

/// Inputs as the ship has them, at every instant at which a simulation looks at them: linear between the recorded samples, then
/// passed through the terms that change them (actuator lag, rate limit, rudder offset). Sample `k` is at
/// `k` [`Integration::instants`].
pub fn driven<'a, C: Number<Coefficient = C>>(
    dynamics: &Dynamics<C>,
    integration: Integration,
    dt: f64,
    samples: &'a [Inputs<C>],
) -> Cow<'a, [Inputs<C>]> {
    let instants = integration.instants();
    if instants == 1 && dynamics.extras().is_empty() {
        return Cow::Borrowed(samples);
    }
    let mut series = Vec::with_capacity(samples.len() * instants);
    series.extend(samples.first());
    for pair in samples.windows(2) {
        series.extend(between(&pair[0], &pair[1], instants));
    }
    dynamics.drive(dt / instants as f64, &mut series);
    Cow::Owned(series)
}

/// Simulates under the inputs of [`driven`] and hands every sample (index, state) to `sink`, the initial one first.
///
/// `sink` returns false to stop early. `initial` may carry derivatives.
pub fn rollout<C: Number<Coefficient = C>>(
    dynamics: &Dynamics<C>,
    integration: Integration,
    dt: f64,
    series: &[Inputs<C>],
    initial: &[C; STATES],
    mut sink: impl FnMut(usize, &[C; STATES]) -> bool,
) {
    let instants = integration.instants();
    let mut state = *initial;
    for k in 0..=series.len().saturating_sub(1) / instants {
        if !sink(k, &state) || (k + 1) * instants >= series.len() {
            return;
        }
        state = step(dynamics, integration, dt, &state, &series[k * instants..], &Force::zero());
    }
}

/// Simulates a scenario with plain numbers.
pub fn simulate(model: &Model, theta: &[f64], integration: Integration, scenario: &Scenario) -> Trajectory {
    let dynamics = Dynamics::new(model, theta.to_vec());
    let series = driven(&dynamics, integration, scenario.dt, &scenario.inputs);
    sailed(&dynamics, integration, scenario.dt, &series, &scenario.initial)
}

/// Simulates under inputs that are known at every instant, up to where the simulation diverges.
fn sailed(
    dynamics: &Dynamics<f64>,
    integration: Integration,
    dt: f64,
    series: &[Inputs<f64>],
    initial: &[f64; STATES],
) -> Trajectory {
    let limit = absurd_speed(dynamics.model());
    let mut states = Vec::with_capacity(series.len() / integration.instants() + 1);
    let mut diverged_at = None;
    if series.is_empty() {
        return Trajectory { dt, states, diverged_at };
    }
    rollout(dynamics, integration, dt, series, initial, |k, s| {
        let sane = s.iter().all(|v| v.is_finite()) && s[3].hypot(s[4]) < limit;
        if sane {
            states.push(*s);
        } else {
            diverged_at = Some(k);
        }
        sane
    });
    Trajectory { dt, states, diverged_at }
}

/// Rounds in which the start of a simulation is looked for.
const START_ROUNDS: usize = 6;

/// The state of which the sensors report `initial`, in the channels that are `measured` (1, or 0); the others are as given.
///
/// `x <- x + initial - h(x)`, six times: an error of the sensors by a share e leaves the share e^7 of it.
pub fn start<C: Number<Coefficient = C>>(
    dynamics: &Dynamics<C>,
    inputs: &Inputs<C>,
    initial: &[C; STATES],
    measured: &[C; STATES],
) -> [C; STATES] {
    let mut x = *initial;
    for _ in 0..START_ROUNDS {
        let y = dynamics.report(&x, inputs);
        x = std::array::from_fn(|j| x[j] + (initial[j] - y[j]) * measured[j]);
    }
    x
}

/// What the sensors report along a simulation that starts where they report the scenario's initial state, see [`start`].
pub fn reported(
    model: &Model,
    theta: &[f64],
    integration: Integration,
    scenario: &Scenario,
    measured: &[bool; STATES],
) -> Trajectory {
    let dynamics = Dynamics::new(model, theta.to_vec());
    let series = driven(&dynamics, integration, scenario.dt, &scenario.inputs);
    let measured = measured.map(|m| f64::from(u8::from(m)));
    let first = series.first().map(|inputs| start(&dynamics, inputs, &scenario.initial, &measured));
    let initial = first.unwrap_or(scenario.initial);
    let mut trajectory = sailed(&dynamics, integration, scenario.dt, &series, &initial);
    for (s, inputs) in trajectory.states.iter_mut().zip(series.iter().step_by(integration.instants())) {
        *s = dynamics.report(s, inputs);
    }
    trajectory
}
