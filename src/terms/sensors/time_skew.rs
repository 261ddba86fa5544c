//! Delays of the position channels, of the heading channel, of the yaw rate channel and of the velocity channels.
//! Second order in the delay for positions and heading, whose accelerations the model knows; first order for velocities and yaw rate.

use crate::parameter::ParameterInfo;
use crate::physics::Flow;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Instant, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::state::STATES;
use crate::terms::size;
use trimtab_ad::Scalar;

/// Time skew between channels.
pub struct TimeSkew;

static INFO: TermInfo = TermInfo {
    name: "time_skew",
    title: "time skew between channels",
    group: Group::Sensor,
    equation: "y_m(t) = y(t) - tau y'(t) + tau^2/2 y''(t); u, v, r without the last",
    source: "Taylor expansion of a delay",
    needs: &[],
    validity: Validity::any("good while accelerations (of u, v and r: rates) change little over the delay"),
    mechanisms: &[
        Mechanism {
            name: "time_skew",
            title: "channels recorded at different times",
            kind: Kind::Sensor,
            parameters: &["position", "heading"],
            companions: &[],
            probe: Probe::Tangent,
            needs_reference: false,
            by_session: true,
            stand_in: false,
            look_alikes: &["antenna", "log_skew", "position_lever", "rudder_lag", "yaw_rate_skew"],
            trial: "zigzags after a check of the clocks",
        },
        Mechanism {
            name: "yaw_rate_skew",
            title: "yaw rate recorded at another time than the heading",
            kind: Kind::Sensor,
            parameters: &["yaw_rate"],
            companions: &[],
            probe: Probe::Tangent,
            needs_reference: false,
            by_session: true,
            stand_in: false,
            look_alikes: &["time_skew", "rudder_lag"],
            trial: "zigzags after a check of the clocks",
        },
        Mechanism {
            name: "log_skew",
            title: "velocities recorded at another time than the other channels",
            kind: Kind::Sensor,
            parameters: &["velocity"],
            companions: &[],
            probe: Probe::Tangent,
            needs_reference: false,
            by_session: true,
            stand_in: false,
            look_alikes: &["time_skew", "position_lever", "yaw_rate_skew"],
            trial: "zigzags at two speeds after a check of the clocks",
        },
    ],
    parameters: &[
        ParameterInfo::new("position", "tau_p", "s", "delay of the position channels")
            .scale(|s| 0.2 * size::time(s))
            .spread(size::time)
            .bounds(-20.0, 20.0),
        ParameterInfo::new("heading", "tau_h", "s", "delay of the heading channel")
            .scale(|s| 0.2 * size::time(s))
            .spread(size::time)
            .bounds(-20.0, 20.0),
        ParameterInfo::new("yaw_rate", "tau_r", "s", "delay of the yaw rate channel")
            .scale(|s| 0.2 * size::time(s))
            .spread(size::time)
            .bounds(-20.0, 20.0),
        ParameterInfo::new("velocity", "tau_u", "s", "delay of the velocity channels, u and v")
            .scale(|s| 0.2 * size::time(s))
            .spread(size::time)
            .bounds(-20.0, 20.0),
    ],
};

impl Term for TimeSkew {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }
}

impl<S: Scalar> Physics<S> for TimeSkew {
    fn measure(&self, p: &[S::Coefficient], at: &Instant<S>, _flow: &Flow<S>, rate: &[S; STATES], y: &mut [S; STATES]) {
        let ([sin, cos], r) = (at.heading, rate[2]);
        let acceleration =
            [cos * rate[3] - sin * rate[4] - r * rate[1], sin * rate[3] + cos * rate[4] + r * rate[0], rate[5]];
        for (i, acceleration) in acceleration.into_iter().enumerate() {
            let delay = p[usize::from(i == 2)];
            y[i] -= (rate[i] - acceleration * delay * 0.5) * delay;
        }
        y[3] -= rate[3] * p[3];
        y[4] -= rate[4] * p[3];
        y[5] -= rate[5] * p[2];
    }
}
