//! A constant push on the ship during one window of time: a tug, a line, an unrecorded thruster.
//! The window is in run time `t` and alike in every run; force and moment are fixed to the ship, not to the earth.

use crate::parameter::ParameterInfo;
use crate::physics::Flow;
use crate::physics::Validity;
use crate::physics::{Group, Instant, Physics, Reach, Term, TermInfo};
use crate::state::Force;
use crate::terms::size;
use trimtab_ad::Scalar;

/// Push of limited duration.
pub struct Push;

static INFO: TermInfo = TermInfo {
    name: "push",
    title: "push of limited duration",
    group: Group::External,
    equation: "(X, Y, N) = (x, y, n) (tanh((t - start)/1 s) - tanh((t - end)/1 s))/2",
    source: "generic, no source",
    needs: &[],
    validity: Validity::any("no cause and no law: a constant force in a window of time"),
    mechanisms: &[],
    parameters: &[
        ParameterInfo::new("x", "F_x", "N", "force forward").scale(size::force),
        ParameterInfo::new("y", "F_y", "N", "force to starboard").scale(size::force).odd(),
        ParameterInfo::new("n", "M_n", "N m", "moment to starboard").scale(size::moment).odd(),
        ParameterInfo::new("start", "t_1", "s", "begin of the push").scale(|_| 10.0).bounds(0.0, 1e6),
        ParameterInfo::new("end", "t_2", "s", "end of the push").default(|_| 60.0).scale(|_| 10.0).bounds(0.0, 1e6),
    ],
};

impl Term for Push {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }

    fn reach(&self, _parameter: usize) -> Reach {
        Reach::Force
    }
}

impl<S: Scalar> Physics<S> for Push {
    fn force(&self, p: &[S::Coefficient], at: &Instant<S>, _flow: &Flow<S>) -> Force<S> {
        let t = at.inputs.t;
        let window = ((t - p[3]).tanh() - (t - p[4]).tanh()) * 0.5;
        Force { x: S::lift(p[0] * window), y: S::lift(p[1] * window), n: S::lift(p[2] * window) }
    }
}
