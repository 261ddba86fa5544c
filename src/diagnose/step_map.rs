//! The Jacobians of one step of a simulation by state, force and parameters: from the ends of the step, or through every stage.
//! It knows no measurement and no noise.

use super::directions::Prepared;
use crate::dynamics::Dynamics;
use crate::physics::Flow;
use crate::sensitivity::chain::{StateSlope, euler, runge_kutta};
use crate::sensitivity::{Local, Plain};
use crate::simulate::{Integration, Method};
use crate::state::{Force, Inputs, STATES};

/// Jacobian of the six rates with respect to the six states and the three forces.
pub(super) type Slope<P> = [[P; STATES + 3]; STATES];

/// The Jacobians of a step by the state and by the force.
pub(super) type Jacobians<P> = ([[P; STATES]; STATES], [[P; 3]; STATES]);

/// No step.
pub(super) fn none<P: Plain>() -> Jacobians<P> {
    ([[P::zero(); STATES]; STATES], [[P::zero(); 3]; STATES])
}

/// The Jacobian of the state's rates with respect to state and force, and the rates behind it.
pub(super) fn slope_at<P: Plain>(
    dynamics: &Dynamics<P>,
    state: &[P; STATES],
    push: &[P; 3],
    inputs: &Inputs<P>,
) -> (Slope<P>, (Local<P>, Flow<P>)) {
    let force = Force { x: push[0], y: push[1], n: push[2] };
    let (local, flow) = P::linearise(dynamics, state, inputs, &force);
    let [sin, cos] = local.heading;
    let mobility = dynamics.mobility(&flow);
    let mut slope = [[P::zero(); STATES + 3]; STATES];
    (slope[0][2], slope[0][3], slope[0][4]) = (-local.rates[1], cos, -sin);
    (slope[1][2], slope[1][3], slope[1][4]) = (local.rates[0], sin, cos);
    slope[2][5] = P::one();
    for i in 0..3 {
        slope[3 + i][2..STATES].copy_from_slice(&local.jacobian[i]);
    }
    slope[3][6] = mobility.surge;
    (slope[4][7], slope[4][8]) = (mobility.sway, mobility.sway_yaw);
    (slope[5][7], slope[5][8]) = (mobility.yaw_sway, mobility.yaw);
    (slope, (local, flow))
}

/// The Jacobians of a step of length `h` \[s\] from those of the rates at its ends: RK4 on the variational equation, whose slope in
/// the middle is the mean of the ends'.
pub(super) fn carry<P: Plain>(start: &Slope<P>, end: &Slope<P>, h: f64) -> Jacobians<P> {
    const W: usize = STATES + 3;
    let middle: Slope<P> = std::array::from_fn(|i| std::array::from_fn(|j| (start[i][j] + end[i][j]) * 0.5));
    // The rate of [d state / d state, d state / d force] where it has reached `at`. No rate depends on the position.
    let rate = |j: &Slope<P>, at: &Slope<P>| -> Slope<P> {
        std::array::from_fn(|i| {
            let mut row = [P::zero(); W];
            for l in 2..STATES {
                for c in 2..W {
                    row[c] = j[i][l].mul_add(at[l][c], row[c]);
                }
            }
            for c in STATES..W {
                row[c] += j[i][c];
            }
            row
        })
    };
    let unit = |i: usize, c: usize| if i == c { P::one() } else { P::zero() };
    let moved = |k: &Slope<P>, h: f64| -> Slope<P> {
        std::array::from_fn(|i| std::array::from_fn(|c| k[i][c] * h + unit(i, c)))
    };
    let k1 = rate(start, &moved(start, 0.0));
    let k2 = rate(&middle, &moved(&k1, 0.5 * h));
    let k3 = rate(&middle, &moved(&k2, 0.5 * h));
    let k4 = rate(end, &moved(&k3, h));
    let sum = |i: usize, c: usize| k1[i][c] + (k2[i][c] + k3[i][c]) * 2.0 + k4[i][c];
    let at = |i: usize, c: usize| sum(i, c) * (h / 6.0) + unit(i, c);
    (
        std::array::from_fn(|i| std::array::from_fn(|c| at(i, c))),
        std::array::from_fn(|i| std::array::from_fn(|c| at(i, STATES + c))),
    )
}

/// The exact Jacobians of a step that begins at instant `from`, and into `parameters`, where it is not empty, the derivatives by the
/// columns: every stage of the method carries the variational equation along.
pub(super) fn exact<P: Plain>(
    prepared: &Prepared<P>,
    integration: Integration,
    dt: f64,
    from: usize,
    state: &[P; STATES],
    push: &[P; 3],
    parameters: &mut [StateSlope<P>],
) -> Jacobians<P> {
    const FIXED: usize = STATES + 3;
    let width = parameters.len();
    let count = integration.substeps.max(1);
    let h = dt / count as f64;
    let mut columns = vec![[P::zero(); STATES]; FIXED + width];
    (0..STATES).for_each(|i| columns[i][i] = P::one());
    let mut own: [Vec<[P; 3]>; 4] = std::array::from_fn(|_| vec![[P::zero(); 3]; FIXED + width]);
    let mut room = Vec::new();
    // The rates at a stage, and the part in the accelerations that force and parameters have there.
    let mut stage = |x: &[P; STATES], when: usize, own: &mut [[P; 3]]| -> Local<P> {
        let (slope, local) = slope_at(&prepared.dynamics, x, push, &prepared.series[when]);
        for l in 0..3 {
            own[STATES + l] = std::array::from_fn(|i| slope[3 + i][STATES + l]);
        }
        if width > 0 {
            prepared.rates(&local, when, x, push, &mut room, &mut own[FIXED..]);
        }
        local.0
    };
    let moved = |x: &[P; STATES], h: f64, k: &[P; STATES]| std::array::from_fn(|j| x[j] + k[j] * h);
    let mut x = *state;
    for i in 0..count {
        match integration.method {
            Method::Euler => {
                let local = stage(&x, from + i, &mut own[0]);
                euler::<P, true>(&local, h, &mut columns, &own[0]);
                x = moved(&x, h, &local.rates);
            }
            Method::Rk4 => {
                let at = from + 2 * i;
                let one = stage(&x, at, &mut own[0]);
                let two = stage(&moved(&x, 0.5 * h, &one.rates), at + 1, &mut own[1]);
                let three = stage(&moved(&x, 0.5 * h, &two.rates), at + 1, &mut own[2]);
                let four = stage(&moved(&x, h, &three.rates), at + 2, &mut own[3]);
                let locals = [one, two, three, four];
                for (c, column) in columns.iter_mut().enumerate() {
                    *column = runge_kutta(&locals, h, column, &std::array::from_fn(|s| own[s][c]));
                }
                let k = locals.map(|local| local.rates);
                x = std::array::from_fn(|j| x[j] + (k[0][j] + (k[1][j] + k[2][j]) * 2.0 + k[3][j]) * (h / 6.0));
            }
        }
    }
    parameters.copy_from_slice(&columns[FIXED..]);
    (
        std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i])),
        std::array::from_fn(|i| std::array::from_fn(|l| columns[STATES + l][i])),
    )
}
