//! First-order lag between the recorded rudder angle, taken as an order, and the rudder.
//! The rudder starts at its order; a limit of its rate is the term `rudder_rate`.

use crate::parameter::ParameterInfo;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::ship::Ship;
use crate::state::Inputs;
use crate::terms::size;
use trimtab_ad::Scalar;

/// Rudder lag.
pub struct RudderLag;

/// Passes one input through `tau y' = x - y`, exactly for `x` linear between samples and `y = x` at the first.
///
/// `y_1 = x_1 - s tau (1 - e) + (y_0 - x_0) e` with the slope `s` of `x` and `e = exp(-dt/tau)`: at tau = 0 the input
/// unchanged, with the derivative `-s` that a lag has. Below a hundredth of a sample `e` is 1e-44 and kept there.
pub(in crate::terms) fn first_order<S: Scalar>(
    tau: S,
    dt: f64,
    series: &mut [Inputs<S>],
    channel: impl Fn(&mut Inputs<S>) -> &mut S,
) {
    let e = (S::from_f64(-dt) / tau.max(S::from_f64(0.01 * dt))).exp();
    let fade = tau * (S::one() - e) / dt;
    let mut before: Option<(S, S)> = None;
    for inputs in series {
        let value = channel(inputs);
        let x = *value;
        if let Some((x0, y0)) = before {
            *value = x - (x - x0) * fade + (y0 - x0) * e;
        }
        before = Some((x, *value));
    }
}

static INFO: TermInfo = TermInfo {
    name: "rudder_lag",
    title: "rudder lag",
    group: Group::Rudder,
    equation: "tau delta' = delta_c - delta",
    source: "first-order steering gear, exact for an order that is linear between samples",
    needs: &[],
    validity: Validity::any("a linear lag of the order; no range is published"),
    mechanisms: &[Mechanism {
        name: "rudder_lag",
        title: "rudder lag",
        kind: Kind::Actuator,
        parameters: &["time"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: false,
        by_session: false,
        stand_in: false,
        look_alikes: &["rudder_rate", "time_skew"],
        trial: "zigzags with quick rudder orders, with order and rudder angle recorded",
    }],
    parameters: &[ParameterInfo::new("time", "tau", "s", "time constant")
        .scale(|s| 0.7 * size::time(s))
        .bounds(0.0, 60.0)],
};

impl Term for RudderLag {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }
}

impl<S: Scalar> Physics<S> for RudderLag {
    fn drive(&self, p: &[S], _ship: &Ship, dt: f64, series: &mut [Inputs<S>]) {
        first_order(p[0], dt, series, |i| &mut i.delta);
    }
}
