//! Time steps of the truth simulators: classical Runge-Kutta with inputs that run linearly, and the rate that keeps a speed.
//! It is the integrator of the experiments alone; the library's is never used for a truth.

use super::motion::{Inputs, State};
use super::simulator::Truth;

/// Largest RK4 step of a truth simulation \[s\].
pub const MAX_STEP: f64 = 0.1;

/// A state plus `h` times its rates.
pub fn moved(state: &State, h: f64, rates: &[f64; 6]) -> State {
    let s = state.to_array();
    State::from_array(std::array::from_fn(|i| s[i] + h * rates[i]))
}

/// One classical Runge-Kutta step of `h` seconds; `rates` gives the time derivative at a fraction (0, 0.5 or 1) of the step.
pub fn runge_kutta(state: &State, h: f64, rates: impl Fn(f64, &State) -> [f64; 6]) -> State {
    let k1 = rates(0.0, state);
    let k2 = rates(0.5, &moved(state, 0.5 * h, &k1));
    let k3 = rates(0.5, &moved(state, 0.5 * h, &k2));
    let k4 = rates(1.0, &moved(state, h, &k3));
    moved(state, h, &std::array::from_fn(|i| (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]) / 6.0))
}

/// One Runge-Kutta step of a simulator; the inputs run linearly from `from` to `to` over it.
pub fn step(truth: &dyn Truth, state: &State, [from, to]: [&Inputs; 2], h: f64) -> State {
    let middle = Inputs::between(from, to, 0.5);
    runge_kutta(state, h, |fraction, s| {
        let inputs = match fraction {
            0.0 => from,
            1.0 => to,
            _ => &middle,
        };
        truth.derivative(s, inputs)
    })
}

/// Simulates `period` seconds in equal Runge-Kutta steps of at most `max_step` seconds, the inputs running linearly from `from`
/// to `to`.
pub fn sail(truth: &dyn Truth, state: &State, [from, to]: [&Inputs; 2], period: f64, max_step: f64) -> State {
    let steps = (period / max_step - 1e-9).ceil().max(1.0) as usize;
    let at = |i: usize| Inputs::between(from, to, i as f64 / steps as f64);
    (0..steps).fold(*state, |state, i| step(truth, &state, [&at(i), &at(i + 1)], period / steps as f64))
}

/// Propeller rate \[rps\] at which the ship keeps the ahead speed `u` \[m/s\] on a straight course with the rudder amidships; the
/// result is clipped to 0..=`most`.
pub fn trimmed_rate(truth: &dyn Truth, u: f64, most: f64) -> f64 {
    bisected_rate(truth, u, most, 80)
}

/// [`trimmed_rate`] after so many halvings of the range; the surge force rises with the rate.
pub fn bisected_rate(truth: &dyn Truth, u: f64, most: f64, halvings: usize) -> f64 {
    let (mut low, mut high) = (0.0, most);
    for _ in 0..halvings {
        let middle = 0.5 * (low + high);
        if truth.force(u, 0.0, 0.0, middle, 0.0).total().x > 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    0.5 * (low + high)
}
