//! Standard manoeuvring trials of a truth simulator: turning circle and zigzag, with a rudder of constant rate.
//! They validate the simulators; the trials of fitted ships belong to the library.

use super::{Environment, Inputs, State, Truth, rk4};

/// A trial: how the ship approaches and how her rudder moves.
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

/// What a turning circle is measured by. Lengths in ship lengths, from the moment the rudder starts to move, at midship.
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

/// Turns with the rudder hard over to `delta` \[rad\] through 720 deg.
///
/// None if she has not turned through 720 deg after sailing 200 ship lengths' worth of time.
pub fn turning(truth: &dyn Truth, approach: &Approach, delta: f64) -> Option<Turning> {
    let length = truth.particulars().length;
    let side = delta.signum();
    let (mut at_90, mut at_180) = (None, None);
    let mut last = State { u: approach.speed, ..State::default() };
    let mut rudder = 0.0;
    let steps = (200.0 * length / approach.speed / approach.step) as usize;
    for i in 0..steps {
        let (state, next) = advance(truth, approach, i, &last, rudder, delta);
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
/// angles \[rad\]. None if she does not answer within the time of 200 ship lengths.
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
    for i in 0..steps {
        (state, rudder) = advance(truth, approach, i, &state, rudder, side * limit);
        // Heading on the side of the last execute; after a reversal the ship still swings there until she is stopped.
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
fn advance(
    truth: &dyn Truth,
    approach: &Approach,
    step: usize,
    state: &State,
    rudder: f64,
    order: f64,
) -> (State, f64) {
    let reach = approach.rudder_rate * approach.step;
    let next = rudder + (order - rudder).clamp(-reach, reach);
    let (from, to) = (Inputs { n: approach.n, delta: rudder }, Inputs { n: approach.n, delta: next });
    let t = step as f64 * approach.step;
    (rk4(truth, t, state, &from, &to, approach.step, &Environment::default()), next)
}

#[cfg(test)]
// An advance of 3.142 ship lengths is not pi.
#[allow(clippy::approx_constant)]
mod tests {
    use super::super::ships::{kvlcc2, kvlcc2_model};
    use super::super::trimmed_rate;
    use super::*;

    fn deg(x: f64) -> f64 {
        x.to_degrees()
    }

    #[test]
    fn kvlcc2_repeats_the_reference_simulation_of_her_trials() {
        let near = |found: f64, expected: f64, within: f64, what: &str| {
            assert!((found - expected).abs() <= within, "{what}: {found} instead of {expected}");
        };
        let rate = 1.76_f64.to_radians();
        // The step of the reference: it reverses the rudder up to one step late, which is worth 0.2 deg of overshoot.
        let model_time = (7.0_f64 / 320.0).sqrt();
        let model = Approach { speed: 1.179, n: 0.0, rudder_rate: rate / model_time, step: 0.5 * model_time };
        let full = Approach { speed: 7.97, n: 0.0, rudder_rate: rate, step: 0.5 };
        struct Expected {
            n: f64,
            starboard: [f64; 7],
            port: [f64; 2],
            zigzags: [(f64, f64, f64); 4],
        }
        let cases = [
            (
                kvlcc2_model(),
                model,
                Expected {
                    n: 11.834,
                    starboard: [3.132, 1.327, 3.113, 2.315, 0.381, 19.1, 0.864],
                    port: [3.142, 3.099],
                    zigzags: [(10.0, 5.5, 15.0), (-10.0, 7.8, 9.7), (20.0, 12.1, 17.5), (-20.0, 15.8, 13.1)],
                },
            ),
            (
                kvlcc2(),
                full,
                Expected {
                    n: 1.7785,
                    starboard: [3.029, 1.272, 3.006, 2.247, 0.377, 19.4, 0.890],
                    port: [3.053, 3.015],
                    zigzags: [(10.0, 5.5, 14.2), (-10.0, 7.6, 9.3), (20.0, 12.0, 16.9), (-20.0, 15.6, 12.9)],
                },
            ),
        ];
        for (ship, mut approach, expected) in cases {
            approach.n = trimmed_rate(&ship, approach.speed, 20.0);
            near(approach.n, expected.n, 0.01 * expected.n, "trimmed n");
            let angle = 35.0_f64.to_radians();
            let right = turning(&ship, &approach, angle).expect("turns to starboard");
            let found = [
                right.advance,
                right.transfer,
                right.tactical_diameter,
                right.steady_diameter,
                right.speed_ratio,
                deg(right.drift),
                right.yaw_rate,
            ];
            for (i, (f, e)) in found.iter().zip(expected.starboard).enumerate() {
                near(*f, e, 0.01 * e, ["advance", "transfer", "TD", "steady", "U/U0", "drift", "r'"][i]);
            }
            let left = turning(&ship, &approach, -angle).expect("turns to port");
            near(left.advance, expected.port[0], 0.01 * expected.port[0], "port advance");
            near(left.tactical_diameter, expected.port[1], 0.01 * expected.port[1], "port TD");
            for (order, first, second) in expected.zigzags {
                let [a, b] = zigzag(&ship, &approach, order.to_radians()).expect("answers the helm");
                near(deg(a), first, 0.1, &format!("OSA1 of {order}"));
                near(deg(b), second, 0.1, &format!("OSA2 of {order}"));
            }
        }
    }

    #[test]
    fn standard_trials_never_enter_the_large_drift_hull() {
        let ship = kvlcc2();
        let approach = Approach { speed: 7.97, n: 1.7785, rudder_rate: 1.76_f64.to_radians(), step: 0.1 };
        let (mut state, mut rudder) = (State { u: 7.97, ..State::default() }, 0.0);
        for i in 0..12_000 {
            (state, rudder) = advance(&ship, &approach, i, &state, rudder, 35.0_f64.to_radians());
            assert_eq!(ship.large_drift_weight(state.u, state.v, state.r), 0.0, "{state:?}");
        }
    }
}
