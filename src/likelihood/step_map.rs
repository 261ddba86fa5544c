//! The Jacobians of one step of a simulation by state, force and parameters: from the ends of the step, or through every stage.
//! It uses no measurement and no noise.

use super::directions::Prepared;
use crate::dynamics::Dynamics;
use crate::physics::Flow;
use crate::sensitivity::chain::{StateSlope, euler, runge_kutta};
use crate::sensitivity::{Local, Plain};
use crate::simulate::{Integration, Method};
use crate::state::{Force, Inputs, STATES};

/// Jacobian of the six rates with respect to the six states and the three forces.
pub(super) type Slope<P> = [[P; W]; STATES];

/// Columns of [`Slope`]: states and forces.
const W: usize = STATES + 3;

/// The Jacobians of a step by the state and by the force.
pub(super) type Jacobians<P> = ([[P; STATES]; STATES], [[P; 3]; STATES]);

/// No step.
pub(super) fn none<P: Plain>() -> Jacobians<P> {
    ([[P::zero(); STATES]; STATES], [[P::zero(); 3]; STATES])
}

/// The Jacobian of rates that nothing changes.
pub(super) fn no_slope<P: Plain>() -> Slope<P> {
    [[P::zero(); W]; STATES]
}

/// Writes the Jacobian of the state's rates with respect to state and force into `slope`, whose entries that are zero at every state
/// are left as they are; gives the rates behind it.
#[inline(always)]
pub(super) fn slope_at<P: Plain>(
    dynamics: &Dynamics<P>,
    state: &[P; STATES],
    push: &[P; 3],
    inputs: &Inputs<P>,
    slope: &mut Slope<P>,
) -> (Local<P>, Flow<P>) {
    let force = Force { x: push[0], y: push[1], n: push[2] };
    let (local, flow) = P::linearise(dynamics, state, inputs, &force);
    let [sin, cos] = local.heading;
    let mobility = dynamics.mobility(&flow);
    (slope[0][2], slope[0][3], slope[0][4]) = (-local.rates[1], cos, -sin);
    (slope[1][2], slope[1][3], slope[1][4]) = (local.rates[0], sin, cos);
    slope[2][5] = P::one();
    for i in 0..3 {
        slope[3 + i][2..STATES].copy_from_slice(&local.jacobian[i]);
    }
    slope[3][6] = mobility.surge;
    (slope[4][7], slope[4][8]) = (mobility.sway, mobility.sway_yaw);
    (slope[5][7], slope[5][8]) = (mobility.yaw_sway, mobility.yaw);
    (local, flow)
}

/// The rate of `[d state / d state, d state / d force]` where it has reached `at`, for the Jacobian `j` of the rates. No rate depends
/// on the position, that of the position on heading and velocities alone, and that of the heading is the yaw rate.
#[inline(always)]
fn rate<P: Plain>(j: &Slope<P>, at: &Slope<P>, out: &mut Slope<P>) {
    for i in [0, 1, 3, 4, 5] {
        let last = if i < 2 { 5 } else { STATES };
        for c in 2..W {
            let mut sum = P::zero();
            (2..last).for_each(|l| sum = j[i][l].mul_add(at[l][c], sum));
            out[i][c] = if c < STATES { sum } else { sum + j[i][c] };
        }
    }
    out[2][2..].copy_from_slice(&at[5][2..]);
}

/// Where a rate `k` leads from the identity in the time `h` \[s\].
#[inline(always)]
fn moved<P: Plain>(k: &Slope<P>, h: f64, out: &mut Slope<P>) {
    for i in 0..STATES {
        (2..W).for_each(|c| out[i][c] = k[i][c] * h);
        if i >= 2 {
            out[i][i] += P::one();
        }
    }
}

/// The Jacobians of a step of length `h` \[s\] from those of the rates at its ends: RK4 on the variational equation, whose slope in
/// the middle is the mean of the ends'.
pub(super) fn carry<P: Plain>(start: &Slope<P>, end: &Slope<P>, h: f64, (a, gamma): &mut Jacobians<P>) {
    let mut middle = *end;
    for (row, from) in middle.iter_mut().zip(start) {
        (2..W).for_each(|c| row[c] = (from[c] + row[c]) * 0.5);
    }
    // The rates in the middle and at the end, those in the middle added up; the rate at the start is `start`.
    let (mut at, mut k, mut twice) = (no_slope(), no_slope(), *start);
    moved(start, 0.5 * h, &mut at);
    rate(&middle, &at, &mut twice);
    moved(&twice, 0.5 * h, &mut at);
    rate(&middle, &at, &mut k);
    moved(&k, h, &mut at);
    for i in 0..STATES {
        (2..W).for_each(|c| twice[i][c] = start[i][c] + (twice[i][c] + k[i][c]) * 2.0);
    }
    rate(end, &at, &mut k);
    for i in 0..STATES {
        for c in 2..W {
            let change = (twice[i][c] + k[i][c]) * (h / 6.0);
            if c < STATES {
                a[i][c] = if i == c { change + P::one() } else { change };
            } else {
                gamma[i][c - STATES] = change;
            }
        }
        for c in 0..2 {
            a[i][c] = if i == c { P::one() } else { P::zero() };
        }
    }
}

/// Room for the stages of a step.
pub(super) struct Stages<P> {
    /// Derivatives of the state, by the state and the force where the step began and by the parameters.
    pub columns: Vec<StateSlope<P>>,
    /// The columns' own part in the accelerations at each stage; that of the state is 0.
    own: [Vec<[P; 3]>; 4],
    room: Vec<[P; 3]>,
}

impl<P: Plain> Stages<P> {
    /// For so many parameters.
    pub fn new(parameters: usize) -> Self {
        let own = std::array::from_fn(|_| vec![[P::zero(); 3]; W + parameters]);
        Self { columns: vec![[P::zero(); STATES]; W + parameters], own, room: Vec::new() }
    }

    /// The derivatives by the parameters in the columns of a step.
    pub fn by_parameters(columns: &[StateSlope<P>]) -> &[StateSlope<P>] {
        columns.get(W..).unwrap_or_default()
    }
}

/// The exact Jacobians of a step that begins at instant `from`, and in `stages` the derivatives by the columns it was made for: every
/// stage of the method carries the variational equation along.
pub(super) fn exact<P: Plain>(
    prepared: &Prepared<P>,
    integration: Integration,
    dt: f64,
    from: usize,
    state: &[P; STATES],
    push: &[P; 3],
    Stages { columns, own, room }: &mut Stages<P>,
) -> Jacobians<P> {
    const FIXED: usize = W;
    let width = columns.len() - FIXED;
    let count = integration.substeps.max(1);
    let h = dt / count as f64;
    columns.fill([P::zero(); STATES]);
    (0..STATES).for_each(|i| columns[i][i] = P::one());
    let mut slope = no_slope();
    // The rates at a stage, and the part in the accelerations that force and parameters have there.
    let mut stage = |x: &[P; STATES], when: usize, own: &mut [[P; 3]]| -> Local<P> {
        let local = slope_at(&prepared.dynamics, x, push, &prepared.series[when], &mut slope);
        for l in 0..3 {
            own[STATES + l] = std::array::from_fn(|i| slope[3 + i][STATES + l]);
        }
        if width > 0 {
            prepared.rates(&local, when, x, push, room, &mut own[FIXED..]);
        }
        local.0
    };
    let moved = |x: &[P; STATES], h: f64, k: &[P; STATES]| std::array::from_fn(|j| x[j] + k[j] * h);
    let mut x = *state;
    for i in 0..count {
        match integration.method {
            Method::Euler => {
                let local = stage(&x, from + i, &mut own[0]);
                euler::<P, true>(&local, h, columns, &own[0]);
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
    (
        std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i])),
        std::array::from_fn(|i| std::array::from_fn(|l| columns[STATES + l][i])),
    )
}
