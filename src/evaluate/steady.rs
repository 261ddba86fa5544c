//! Steady motion, the prediction that uses no model: what every model is to beat.

use crate::recording::Run;
use crate::simulate::Trajectory;

/// Steady motion from the initial state of a window: `x' = u cos psi - v sin psi`, `y' = u sin psi + v cos psi`, `psi' = r` with u, v
/// \[m/s\] and r \[rad/s\] kept.
pub fn steady_motion(window: &Run) -> Trajectory {
    let mut state = window.initial;
    let mut states = vec![state; window.measured.len()];
    for next in states.iter_mut().skip(1) {
        let [x, y, psi, u, v, r] = state;
        // The heading in the middle of the step: exact to second order on a circle.
        let (sin, cos) = (psi + 0.5 * r * window.dt).sin_cos();
        state =
            [x + window.dt * (u * cos - v * sin), y + window.dt * (u * sin + v * cos), psi + window.dt * r, u, v, r];
        *next = state;
    }
    Trajectory { dt: window.dt, states, diverged_at: None }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{model, runs};

    #[test]
    fn steady_motion_is_a_circle_that_closes() {
        let mut run = runs(&model(), 1).remove(0);
        let steps = run.measured.len() - 1;
        run.initial = [10.0, -5.0, 0.3, 4.0, 1.0, std::f64::consts::TAU / (steps as f64 * run.dt)];
        let end = steady_motion(&run).states[steps];
        assert!((end[0] - 10.0).abs() < 1e-9 && (end[1] + 5.0).abs() < 1e-9, "{end:?}");
    }
}
