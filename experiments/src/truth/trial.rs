//! Standard manoeuvring trials of a truth simulator: turning circle and zigzag, with a rudder of constant rate.
//! They validate the simulators; the trials of fitted ships belong to the library.

use super::integrate::step;
use super::motion::{Inputs, State};
use super::simulator::Truth;

/// A trial: how the ship approaches and how its rudder moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Approach {
    /// Approach speed U0 \[m/s\].
    pub speed: f64,
    /// Propeller rate, kept throughout \[rps\].
    pub n: f64,
    /// Rudder rate \[rad/s\].
    pub rudder_rate: f64,
    /// RK4 step \[s\].
    pub step: f64,
}

/// Measures of a turning circle. Lengths in ship lengths, from the instant the rudder starts to move, at midship.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turning {
    /// Distance ahead at 90 deg of heading change.
    pub advance: f64,
    /// Distance abeam at 90 deg.
    pub transfer: f64,
    /// Distance abeam at 180 deg.
    pub tactical_diameter: f64,
    /// Diameter of the steady circle.
    pub steady_diameter: f64,
    /// Steady speed over approach speed.
    pub speed_ratio: f64,
    /// Steady drift angle, magnitude \[rad\].
    pub drift: f64,
    /// Steady r L / U, magnitude.
    pub yaw_rate: f64,
}

impl Turning {
    /// Advance, transfer, tactical and steady diameter \[L\], U/U0, drift \[deg\] and r L/U.
    pub fn measures(&self) -> [f64; 7] {
        let [a, b, c, d] = [self.advance, self.transfer, self.tactical_diameter, self.steady_diameter];
        [a, b, c, d, self.speed_ratio, self.drift.to_degrees(), self.yaw_rate]
    }
}

/// Turns with the rudder hard over to `delta` \[rad\] through 720 deg.
///
/// None if the ship has not turned through 720 deg in the time of 200 ship lengths.
pub fn turning(truth: &dyn Truth, approach: &Approach, delta: f64) -> Option<Turning> {
    let length = truth.particulars().length;
    let side = delta.signum();
    let (mut at_90, mut at_180) = (None, None);
    let mut last = State { u: approach.speed, ..State::default() };
    let mut rudder = 0.0;
    let steps = (200.0 * length / approach.speed / approach.step) as usize;
    for _ in 0..steps {
        let (state, next) = advance(truth, approach, &last, rudder, delta);
        let crossed = |angle: f64| {
            let (a, b) = (side * last.psi - angle, side * state.psi - angle);
            (a < 0.0 && b >= 0.0).then(|| {
                let f = -a / (b - a);
                (last.x + f * (state.x - last.x), last.y + f * (state.y - last.y))
            })
        };
        at_90 = at_90.or_else(|| crossed(0.5 * std::f64::consts::PI));
        at_180 = at_180.or_else(|| crossed(std::f64::consts::PI));
        (last, rudder) = (state, next);
        if let (Some(quarter), Some(half), true) = (at_90, at_180, side * last.psi >= 4.0 * std::f64::consts::PI) {
            let speed = last.speed();
            return Some(Turning {
                advance: quarter.0 / length,
                transfer: side * quarter.1 / length,
                tactical_diameter: side * half.1 / length,
                steady_diameter: 2.0 * speed / last.r.abs() / length,
                speed_ratio: speed / approach.speed,
                drift: (-last.v).atan2(last.u).abs(),
                yaw_rate: last.r.abs() * length / speed,
            });
        }
    }
    None
}

/// Zigzag with rudder and heading both at `angle` \[rad\], the first rudder to starboard if positive: the first two overshoot
/// angles \[rad\]. None if the ship does not complete them in the time of 200 ship lengths.
pub fn zigzag(truth: &dyn Truth, approach: &Approach, angle: f64) -> Option<[f64; 2]> {
    let length = truth.particulars().length;
    let limit = angle.abs();
    let mut side = angle.signum();
    let mut overshoots = Vec::new();
    let mut reversed = 0;
    let mut peak = 0.0_f64;
    let mut rudder = 0.0;
    let mut state = State { u: approach.speed, ..State::default() };
    let steps = (200.0 * length / approach.speed / approach.step) as usize;
    for _ in 0..steps {
        (state, rudder) = advance(truth, approach, &state, rudder, side * limit);
        // Heading on the side of the last execute; after a reversal the ship still swings to that side for a while.
        if reversed > 0 {
            peak = peak.max(-side * state.psi);
            if state.r * side > 0.0 && overshoots.len() < reversed {
                overshoots.push(peak - limit);
                if let [first, second] = overshoots[..] {
                    return Some([first, second]);
                }
            }
        }
        if side * state.psi >= limit {
            side = -side;
            reversed += 1;
            peak = 0.0;
        }
    }
    None
}

/// One step of a trial towards the rudder `order` \[rad\]; gives the state and the rudder at its end.
fn advance(truth: &dyn Truth, approach: &Approach, state: &State, rudder: f64, order: f64) -> (State, f64) {
    let reach = approach.rudder_rate * approach.step;
    let next = rudder + (order - rudder).clamp(-reach, reach);
    let [from, to] = [rudder, next].map(|delta| Inputs { n: approach.n, delta });
    (step(truth, state, [&from, &to], approach.step), next)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::ships::kvlcc2;

    #[test]
    fn standard_trials_never_enter_the_large_drift_hull() {
        let ship = kvlcc2();
        let approach = Approach { speed: 7.97, n: 1.7785, rudder_rate: 1.76_f64.to_radians(), step: 0.1 };
        let (mut state, mut rudder) = (State { u: 7.97, ..State::default() }, 0.0);
        for _ in 0..12_000 {
            (state, rudder) = advance(&ship, &approach, &state, rudder, 35.0_f64.to_radians());
            assert_eq!(ship.large_drift_weight(state.u, state.v, state.r), 0.0, "{state:?}");
        }
    }
}
