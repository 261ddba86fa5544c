//! A rudder as the law of a named actuator: the normal force of a blade in the stream past the hull or in a propeller's race. The paper's
//! rudder is the term `rudder`, that of the standard MMG method `mmg_rudder`.

use super::rudder::{CURVE_LIMIT, PLATE_LIMIT, PLATE_NORMAL};
use crate::parameter::ParameterInfo;
use crate::physics::flow::{Race, axial, lateral};
use crate::physics::{Flow, Instant};
use crate::state::Force;
use crate::terms::propulsion::screw::Screw;
use trimtab_ad::{Scalar, smooth};

/// A blade at a place of the craft.
#[derive(Debug)]
pub(in crate::terms) struct Foil {
    /// Area \[m2\].
    pub area: f64,
    /// Span \[m\].
    pub span: f64,
    /// Place \[m\], forward and to starboard of midship.
    pub place: [f64; 2],
    /// Index of its angle among the commands.
    pub angle: usize,
    /// The propeller in whose race it stands.
    pub behind: Option<Upstream>,
}

/// The propeller ahead of a blade, and where its parameters are.
#[derive(Debug)]
pub(in crate::terms) struct Upstream {
    /// The propeller.
    pub screw: Screw,
    /// Sine and cosine of its axis.
    pub axis: [f64; 2],
    /// Index of the zero of its direction among its parameters.
    pub zero: usize,
    /// Index of what it has lost among its parameters.
    pub lost: usize,
}

/// Indices of the parameters of a blade, in those of the actuator.
mod index {
    pub const SLOPE: usize = 0;
    pub const T_R: usize = 1;
    pub const A_H: usize = 2;
    pub const X_H: usize = 3;
    pub const WAKE_RATIO: usize = 4;
    pub const STRAIGHTENING: usize = 5;
    pub const LEVER: usize = 6;
    pub const RACE: usize = 7;
    pub const RACE_ASTERN: usize = 8;
}

/// The parameters of a blade in the stream; an actuator's own values are those of its entry in the ship file.
pub(in crate::terms) const PARAMETERS: [ParameterInfo; 7] = [
    ParameterInfo::new("slope", "f_alpha", "-", "slope of the normal-force coefficient")
        .scale(|_| 0.2)
        .spread(|_| 0.3)
        .bounds(0.0, 10.0),
    ParameterInfo::new("t_R", "t_R", "-", "steering resistance deduction")
        .scale(|_| 0.1)
        .spread(|_| 0.15)
        .bounds(-1.0, 1.0),
    ParameterInfo::new("a_H", "a_H", "-", "hull force induced by the rudder, over that of the rudder")
        .scale(|_| 0.1)
        .spread(|_| 0.15)
        .bounds(-0.5, 2.0),
    ParameterInfo::new("x_H", "x_H'", "-", "where that hull force acts, over L, forward of midship")
        .scale(|_| 0.05)
        .spread(|_| 0.05)
        .bounds(-1.0, 1.0),
    ParameterInfo::new(
        "wake_ratio",
        "eps",
        "-",
        "inflow over the advance velocity of the propeller ahead, or over the surge velocity where there is none",
    )
    .scale(|_| 0.1)
    .spread(|_| 0.3)
    .bounds(0.0, 3.0),
    ParameterInfo::new("straightening", "gamma", "-", "flow straightening of the lateral inflow")
        .scale(|_| 0.1)
        .spread(|_| 0.15)
        .bounds(0.0, 2.0),
    ParameterInfo::new("lever", "l_R/L", "-", "effective position in the inflow over L, forward of midship")
        .scale(|_| 0.1)
        .spread(|_| 0.2)
        .bounds(-2.0, 2.0),
];

/// What a blade in a propeller's race has beside them.
pub(in crate::terms) const IN_RACE: [ParameterInfo; 2] = [
    ParameterInfo::new("race", "kappa", "-", "propeller race factor").scale(|_| 0.1).spread(|_| 0.2).bounds(0.0, 2.0),
    ParameterInfo::new("race_astern", "kappa_a", "-", "inflow taken away by the propeller turning astern")
        .scale(|_| 0.05)
        .spread(|_| 0.15)
        .bounds(-1.0, 1.0),
];

impl Foil {
    /// Axial inflow u_R \[m/s\]: `eps (u - r y)` in the stream, that of [`Flow::new`] in the race of a propeller with the parameters
    /// `upstream`.
    #[inline(always)]
    fn axial<S: Scalar>(
        &self,
        own: &[S::Coefficient],
        upstream: &[S::Coefficient],
        at: &Instant<S>,
        flow: &Flow<S>,
    ) -> S {
        let Some(Upstream { screw, axis: [sin, cos], zero, lost }) = &self.behind else {
            return (flow.u - flow.r * self.place[1]) * own[index::WAKE_RATIO];
        };
        let (one, turned) = (S::Coefficient::one(), upstream[*zero].sin_cos());
        let axis = [turned.0 * *cos + turned.1 * *sin, turned.1 * *cos - turned.0 * *sin];
        let [advance, thrust] = screw.advance_and_thrust(upstream, axis, one - upstream[*lost], at, flow);
        let race = Race { density: at.ship.hull.water_density, diameter: screw.diameter, span: self.span };
        axial(&race, at.small, [own[index::RACE], own[index::RACE_ASTERN], own[index::WAKE_RATIO]], advance, thrust)
    }

    /// The force with the blade's parameters `own` and those of the propeller ahead of it; `zero` is added to its angle, `left` is the
    /// share of its force that is left.
    ///
    /// `F_N = 1/2 rho A U_R^2 f_alpha sin a`, `a = delta - atan2(v_R, u_R)`, the slope blending into that of a flat plate from 45 to
    /// 60 degrees; `X = -(1 - t_R) F_N sin delta`, `Y = -(1 + a_H) F_N cos delta`, `N = -(x + a_H x_H' L) F_N cos delta - y X`.
    #[inline(always)]
    pub fn force<S: Scalar>(
        &self,
        own: &[S::Coefficient],
        upstream: &[S::Coefficient],
        [zero, left]: [S::Coefficient; 2],
        at: &Instant<S>,
        flow: &Flow<S>,
    ) -> Force<S> {
        let lpp = at.ship.hull.lpp;
        let bend = [own[index::STRAIGHTENING], S::Coefficient::zero(), own[index::LEVER]];
        let u = self.axial(own, upstream, at, flow);
        let v = lateral(lpp, at.small, bend, flow.v, flow.r);
        let (sin, cos) = (at.inputs.commands[self.angle] + zero).sin_cos();
        let speed = (u * u + v * v + 1e-12).sqrt();
        let across = u * sin - v * cos;
        let sine = (across / speed).abs();
        let (curve, plate) = (CURVE_LIMIT.sin(), PLATE_LIMIT.sin());
        let stalled = smooth::smooth_step((sine - curve) / (plate - curve));
        let slope = (S::one() - stalled) * own[index::SLOPE] + stalled * PLATE_NORMAL;
        let normal = across * speed * slope * (left * (0.5 * at.ship.hull.water_density * self.area));
        let (one, [x, y]) = (S::Coefficient::one(), self.place);
        let surge = -(normal * ((one - own[index::T_R]) * sin));
        let lever = own[index::A_H] * own[index::X_H] * lpp + x;
        Force { x: surge, y: -(normal * ((one + own[index::A_H]) * cos)), n: -(normal * (lever * cos)) - surge * y }
    }
}
