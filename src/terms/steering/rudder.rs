//! Rudder forces from a cubic lift and a quadratic drag curve, the parameters p4 to p10 of the paper.
//! The curves are valid up to 45 degrees of attack; beyond 60 degrees the rudder is a flat plate, with a smooth blend between.

use crate::parameter::{ParameterInfo, Start};
use crate::physics::Flow;
use crate::physics::{Form, Group, Instant, Physics, Reach, Term, TermInfo};
use crate::physics::{Validity, degrees};
use crate::state::Force;
use std::f64::consts::PI;
use trimtab_ad::{Scalar, smooth};

/// Rudder forces.
pub struct Rudder;

/// Angle of attack up to which the polynomials are valid \[rad\].
pub const CURVE_LIMIT: f64 = 45.0 * PI / 180.0;
/// Angle of attack from which the rudder is a flat plate \[rad\].
pub const PLATE_LIMIT: f64 = 60.0 * PI / 180.0;
/// Range of angles of attack over which a stalling rudder loses its lift \[rad\].
pub const STALL_WIDTH: f64 = 6.0 * PI / 180.0;
/// Normal-force coefficient of a flat plate across the flow \[-\].
pub const PLATE_NORMAL: f64 = 1.2;

static INFO: TermInfo = TermInfo {
    name: "rudder",
    title: "rudder lift and drag",
    group: Group::Rudder,
    equation: "a = delta - g, g = atan2(v_R, u_R); c_L = p4 + p5 a + p6 a^2 + p7 a^3, c_D = p8 + p9 a + p10 a^2; \
               L, D = 1/2 rho A_R U_R^2 (c_L, c_D); X = -D cos g - L sin g, Y = D sin g - L cos g, N = x_R Y; \
               |a| from 45 to 60 deg blends into a flat plate, c_L = 1.2 sin a cos a, c_D = 1.2 sin^2 a",
    source: "Papandreou et al. 2025 (arXiv 2502.18696) eq. (3)-(4); resolution of lift and drag derived, area and inflow not printed there",
    needs: &[],
    validity: Validity {
        attack: Some([0.0, degrees(45.0)]),
        source: "the published cubics change sign between 45 and 57 deg; beyond 45 deg the flat plate that takes over is an engineering estimate",
        ..Validity::ANY
    },
    mechanisms: &[],
    parameters: &[
        ParameterInfo::new("lift0", "p4", "-", "lift coefficient at zero angle")
            .in_mmg(Start::Replaced)
            .scale(|_| 0.05)
            .odd(),
        ParameterInfo::new("lift1", "p5", "1/rad", "slope of the lift coefficient")
            .in_mmg(Start::Replaced)
            .default(|_| 2.5)
            .scale(|_| 0.5)
            .bounds(0.0, f64::INFINITY),
        ParameterInfo::new("lift2", "p6", "1/rad2", "even curvature of the lift coefficient")
            .in_mmg(Start::Replaced)
            .scale(|_| 0.5)
            .odd(),
        ParameterInfo::new("lift3", "p7", "1/rad3", "cubic of the lift coefficient")
            .in_mmg(Start::Replaced)
            .default(|_| -3.0)
            .scale(|_| 1.0),
        ParameterInfo::new("drag0", "p8", "-", "drag coefficient at zero angle")
            .in_mmg(Start::Replaced)
            .default(|_| 0.02)
            .scale(|_| 0.02)
            .bounds(0.0, f64::INFINITY),
        ParameterInfo::new("drag1", "p9", "1/rad", "slope of the drag coefficient")
            .in_mmg(Start::Replaced)
            .scale(|_| 0.1)
            .odd(),
        ParameterInfo::new("drag2", "p10", "1/rad2", "curvature of the drag coefficient")
            .in_mmg(Start::Replaced)
            .default(|_| 1.3)
            .scale(|_| 0.5)
            .bounds(0.0, f64::INFINITY),
    ],
};

impl Rudder {
    /// The printed lift polynomial at an angle of attack `a` \[rad\].
    #[inline(always)]
    pub fn lift_polynomial<S: Scalar>(p: &[S::Coefficient], a: S) -> S {
        p[0] + a * (p[1] + a * (p[2] + a * p[3]))
    }
    /// The printed drag polynomial at an angle of attack `a` \[rad\].
    #[inline(always)]
    pub fn drag_polynomial<S: Scalar>(p: &[S::Coefficient], a: S) -> S {
        p[4] + a * (p[5] + a * p[6])
    }
}

/// What rudder forces are made of at an instant: the curves' powers of the angle of attack, and what a unit of lift or drag does.
struct Blade<S> {
    /// Lift per unit of p4 to p7.
    lift: [S; 4],
    /// Drag per unit of p8 to p10.
    drag: [S; 3],
    /// Lift and drag of the flat plate, as far as the rudder is one.
    plate: [S; 2],
    /// Surge and sway force \[N\] of a unit of lift; a unit of drag gives the same, turned by a right angle.
    unit: [S; 2],
}

impl<S: Scalar> Blade<S> {
    /// At the angle of attack a = delta - g, wrapped into (-pi, pi].
    ///
    /// Of the lift, the fraction `adjust.stall` goes as the angle passes `adjust.stall_onset` \[rad\] by [`STALL_WIDTH`].
    #[inline(always)]
    fn new(at: &Instant<S>, flow: &Flow<S>) -> Self {
        let (u, v) = (flow.rudder_u, flow.rudder_v);
        let a = smooth::wrap_angle(at.inputs.delta - v.atan2(u));
        let inside = a.clamp(-PLATE_LIMIT, PLATE_LIMIT);
        let plate = smooth::smooth_step((a.abs() - CURVE_LIMIT) / (PLATE_LIMIT - CURVE_LIMIT));
        let curve = S::one() - plate;
        let (sin, cos) = a.sin_cos();
        let stalled = smooth::smooth_step((inside.abs() - flow.adjust.stall_onset) / STALL_WIDTH);
        let lifting = (S::one() - stalled * flow.adjust.stall) * curve;
        let first = lifting * inside;
        let second = first * inside;
        let drag = curve * inside;
        let pressure = 0.5 * at.ship.hull.water_density * at.ship.rudder.area;
        // L and D with cos g = u_R/U_R and sin g = v_R/U_R: one factor U_R is left, so that no inflow gives no force.
        let speed = (u * u + v * v + 1e-12).sqrt() * pressure;
        // In form `mmg` the blade is the term `mmg_rudder`, and no plate is added to it.
        let normal = match at.form {
            Form::Paper | Form::Regular | Form::General => sin * plate * PLATE_NORMAL,
            Form::Mmg => S::zero(),
        };
        Self {
            lift: [lifting, first, second, second * inside],
            drag: [curve, drag, drag * inside],
            plate: [normal * cos, normal * sin],
            unit: [-(v * speed), -(u * speed)],
        }
    }

    #[inline(always)]
    fn force(&self, at: &Instant<S>, lift: S, drag: S) -> Force<S> {
        let [x, y] = self.unit;
        let side = y * lift - x * drag;
        Force { x: x * lift + y * drag, y: side, n: side * at.ship.rudder_x() }
    }

    /// The force with the parameters `p`.
    #[inline(always)]
    fn total(&self, p: &[S::Coefficient], at: &Instant<S>) -> Force<S> {
        let (l, d) = (&self.lift, &self.drag);
        let lift = l[0] * p[0] + l[1] * p[1] + l[2] * p[2] + l[3] * p[3] + self.plate[0];
        let drag = d[0] * p[4] + d[1] * p[5] + d[2] * p[6] + self.plate[1];
        self.force(at, lift, drag)
    }

    /// The force per unit of each parameter.
    #[inline(always)]
    fn slopes(&self, at: &Instant<S>) -> [Force<S>; 7] {
        let lift = |lift: S| self.force(at, lift, S::zero());
        let drag = |drag: S| self.force(at, S::zero(), drag);
        let ([l0, l1, l2, l3], [d0, d1, d2]) = (self.lift, self.drag);
        [lift(l0), lift(l1), lift(l2), lift(l3), drag(d0), drag(d1), drag(d2)]
    }
}

impl Term for Rudder {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }

    fn reach(&self, _parameter: usize) -> Reach {
        Reach::LinearForce
    }
}

impl Rudder {
    /// The force, and the force per unit of each parameter, from one evaluation of what they share.
    #[inline(always)]
    pub fn force_and_slopes<S: Scalar>(
        p: &[S::Coefficient],
        at: &Instant<S>,
        flow: &Flow<S>,
    ) -> (Force<S>, [Force<S>; 7]) {
        let blade = Blade::new(at, flow);
        (blade.total(p, at), blade.slopes(at))
    }
}

impl<S: Scalar> Physics<S> for Rudder {
    #[inline(always)]
    fn force(&self, p: &[S::Coefficient], at: &Instant<S>, flow: &Flow<S>) -> Force<S> {
        Blade::new(at, flow).total(p, at)
    }

    #[inline(always)]
    fn slopes(&self, _p: &mut [S::Coefficient], at: &Instant<S>, flow: &Flow<S>, out: &mut [Force<S>]) {
        out.copy_from_slice(&Blade::new(at, flow).slopes(at));
    }
}
