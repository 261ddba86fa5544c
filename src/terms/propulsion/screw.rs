//! A propeller as the law of a named actuator: open-water thrust in its own inflow, in all quadrants. The paper's single propeller is the
//! term `flow`, whose formulas these are.

use crate::parameter::ParameterInfo;
use crate::physics::flow::{ahead, index, thrust};
use crate::physics::{Flow, Instant};
use trimtab_ad::Scalar;

/// A propeller at a place of the craft.
#[derive(Debug)]
pub(in crate::terms) struct Screw {
    /// Diameter \[m\].
    pub diameter: f64,
    /// Place \[m\], forward and to starboard of midship.
    pub place: [f64; 2],
    /// Index of its rate among the commands.
    pub rate: usize,
}

/// The parameters of a propeller, in the order of the first ones of the term `flow`; an actuator's own values are those of its entry in the ship file.
pub(super) const PARAMETERS: [ParameterInfo; 6] = [
    ParameterInfo::new("wake", "w", "-", "effective wake fraction").scale(|_| 0.05).spread(|_| 0.08).bounds(0.0, 0.9),
    ParameterInfo::new("thrust_deduction", "t", "-", "thrust deduction, thrust ahead")
        .scale(|_| 0.05)
        .spread(|_| 0.06)
        .bounds(0.0, 0.8),
    ParameterInfo::new("kt0", "k0", "-", "thrust coefficient at J = 0")
        .scale(|_| 0.035)
        .spread(|_| 0.05)
        .bounds(0.0, 2.0),
    ParameterInfo::new("kt1", "k1", "-", "slope of the thrust coefficient")
        .scale(|_| 0.035)
        .spread(|_| 0.1)
        .bounds(-2.0, 0.0),
    ParameterInfo::new("kt2", "k2", "-", "curvature of the thrust coefficient")
        .scale(|_| 0.035)
        .spread(|_| 0.1)
        .bounds(-2.0, 1.0),
    ParameterInfo::new("astern", "b_t", "-", "thrust astern over thrust ahead, at rest")
        .scale(|_| 0.1)
        .spread(|_| 0.2)
        .bounds(0.0, 2.0),
];

/// Whether a parameter of a propeller changes what a rudder in its race feels: all but the thrust deduction.
pub(super) fn is_in_race(parameter: usize) -> bool {
    parameter != index::THRUST_DEDUCTION
}

impl Screw {
    /// Advance velocity along its axis \[m/s\] and thrust \[N\], before the thrust deduction, with the axis' sine and cosine; `left` is the
    /// share of its thrust that is left.
    #[inline(always)]
    pub fn advance_and_thrust<S: Scalar>(
        &self,
        p: &[S::Coefficient],
        [sin, cos]: [S::Coefficient; 2],
        left: S::Coefficient,
        at: &Instant<S>,
        flow: &Flow<S>,
    ) -> [S; 2] {
        let [x, y] = self.place;
        let inflow = (flow.u - flow.r * y) * cos + (flow.v + flow.r * x) * sin;
        let size = (inflow * inflow + at.small * at.small).sqrt();
        let advance = (S::one() - ahead(inflow, size) * p[index::WAKE]) * inflow;
        let curve = [p[index::KT0], p[index::KT1], p[index::KT2], p[index::ASTERN]];
        let open_water = thrust(self.diameter, at.small, curve, advance, at.inputs.commands[self.rate]);
        [advance, open_water * (left * at.ship.hull.water_density)]
    }

    /// What of a thrust \[N\] moves the craft: less the thrust deduction where it pushes ahead.
    #[inline(always)]
    pub fn net<S: Scalar>(p: &[S::Coefficient], thrust: S) -> S {
        let positive = S::zero().less(thrust);
        thrust - S::select(positive, thrust * p[index::THRUST_DEDUCTION], S::zero())
    }
}
