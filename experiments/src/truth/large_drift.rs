//! The second truth simulator: large drift angles, four quadrants, a flapped rudder. It is a reconstruction in the spirit of
//! Okuda et al. (2023, Appl. Ocean Res. 135, 103567), whose text is not public; nothing here is taken from it or checked against it.
//!
//! Hull: Yoshimura's unified low-speed model, linear terms and cross-flow drag without any 1/U. Propeller: four-quadrant Fourier
//! series, wake that fades with local drift, side force of the astern screw after Hachii. Rudder: normal and tangential force after
//! Lindenburg to 180 deg, the flap as a camber that shifts the inflow angle in proportion to the helm.

use std::f64::consts::PI;

use super::laws::crossflow;
use super::laws::slipstream::{Propeller, Rudder};
use super::motion::{Force, Particulars};
use super::simulator::{AddedMass, Inertia, Propulsion, Truth};

/// Hull coefficients, on 1/2 rho L d (force) and 1/2 rho L^2 d (moment).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hull {
    /// Resistance coefficient ahead, -X_0F.
    pub r0: f64,
    /// Resistance coefficient astern, -X_0A.
    pub r0_astern: f64,
    /// X_vr in addition to (m + m_y) v r.
    pub xvr: f64,
    /// Y_v of Y_v v |u|.
    pub yv: f64,
    /// Y_r of Y_r r L u, with (m + m_x) u r kept on the left-hand side.
    pub yr: f64,
    /// N_v of N_v v u.
    pub nv: f64,
    /// N_r of N_r r L |u|.
    pub nr: f64,
    /// Cross-flow drag coefficient C_D.
    pub cross_flow_drag: f64,
    /// Weight of the yaw rate in the cross-flow force, C_rY.
    pub yaw_in_force: f64,
    /// Weight of the yaw rate in the cross-flow moment, C_rN.
    pub yaw_in_moment: f64,
}

/// Force law of the flapped rudder blade.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Blade {
    /// Aspect ratio Lambda.
    pub aspect: f64,
    /// Camber of the flap: inflow angle gained per angle of helm.
    pub flap: f64,
    /// Factor on both force coefficients.
    pub gain: f64,
}

/// A ship with a flapped rudder at large drift. Every number is public and plain, so that a copy can be altered.
#[derive(Debug, Clone, PartialEq)]
pub struct LargeDrift {
    /// Main particulars.
    pub particulars: Particulars,
    /// Added masses and radius of gyration.
    pub added: AddedMass,
    /// Hull.
    pub hull: Hull,
    /// Propeller. Its side force is a factor on Hachii's, negative for a left-handed screw.
    pub propeller: Propeller,
    /// c in w = w_0 exp(-c beta_P^2).
    pub wake_decay: f64,
    /// Rudder.
    pub rudder: Rudder,
    /// Force law of its blade.
    pub blade: Blade,
}

impl LargeDrift {
    /// The coefficients that no chart gives exactly, by reference.
    pub fn uncertain(&mut self) -> Vec<&mut f64> {
        let (h, p) = (&mut self.hull, &mut self.propeller);
        let mut all: Vec<&mut f64> = self.added.each().into();
        all.extend([&mut h.r0, &mut h.r0_astern, &mut h.xvr, &mut h.yv, &mut h.yr, &mut h.nv, &mut h.nr]);
        all.extend([&mut h.cross_flow_drag, &mut h.yaw_in_force, &mut h.yaw_in_moment]);
        all.extend([&mut p.thrust_factor, &mut p.thrust_deduction, &mut p.wake, &mut self.wake_decay]);
        all.extend([&mut self.blade.flap, &mut self.blade.gain]);
        all.extend(self.rudder.uncertain());
        all
    }

    /// The similar ship of this length \[m\], in the same water: coefficients are dimensionless and do not change.
    #[must_use]
    pub fn scaled(&self, length: f64) -> Self {
        let k = length / self.particulars.length;
        let mut ship = self.clone();
        ship.particulars = self.particulars.scaled(length);
        ship.propeller.diameter *= k;
        ship.rudder.span *= k;
        ship.rudder.area *= k * k;
        ship
    }

    /// Inflow speed of the propeller V_A \[m/s\]: (1 - w_0 exp(-c beta_P^2)) u, beta_P = atan2(-(v + x_P r), u), for u > 0; else u.
    fn propeller_inflow(&self, u: f64, v: f64, r: f64) -> f64 {
        if u <= 0.0 {
            return u;
        }
        let p = &self.propeller;
        let beta_p = (-(v + p.position * self.particulars.length * r)).atan2(u);
        u * (1.0 - p.wake * (-self.wake_decay * beta_p * beta_p).exp())
    }

    /// Normal and tangential coefficients at inflow angle `alpha` with the helm at `delta` \[rad\] (after Lindenburg).
    ///
    /// c_N = 1.98 (1/(0.56 + 0.44 |sin a|) - 0.41 (1 - exp(-17/Lambda))) sin a, c_T = 0.00375 cos a - 0.053 |c_N| cos a, with
    /// a = alpha + flap delta (1 + cos alpha)/2: the flap acts in flow from ahead and has no effect in flow from aft. c_T is positive
    /// towards the trailing edge; its suction part changes sign with the flow, unlike the source's.
    fn coefficients(&self, alpha: f64, delta: f64) -> (f64, f64) {
        let q = &self.blade;
        let (sin, cos) = (alpha + q.flap * delta * 0.5 * (1.0 + alpha.cos())).sin_cos();
        let normal = 1.98 * (1.0 / (0.56 + 0.44 * sin.abs()) - 0.41 * (1.0 - (-17.0 / q.aspect).exp())) * sin;
        let tangential = (0.00375 - 0.053 * normal.abs()) * cos;
        (q.gain * normal, q.gain * tangential)
    }
}

impl Truth for LargeDrift {
    fn particulars(&self) -> &Particulars {
        &self.particulars
    }

    fn inertia(&self) -> Inertia {
        self.added.inertia(&self.particulars)
    }

    /// v_R = -gamma (v + l_R r), without any angle, so that it is valid at every drift.
    fn propulsion(&self, u: f64, v: f64, r: f64, n: f64) -> Propulsion {
        let (s, p, q) = (&self.particulars, &self.propeller, &self.rudder);
        let va = self.propeller_inflow(u, v, r);
        let thrust = p.thrust(n, va, s.rho);
        let lateral = -(v + q.inflow_position * s.length * r);
        Propulsion { thrust, rudder_inflow: [q.axial_inflow(p, s.rho, [u, n], thrust, va), q.straightened(lateral)] }
    }

    /// Yoshimura's unified model:
    ///
    /// X = 1/2 rho L d {-(R0F + (R0A - R0F) |beta|/pi) u U + X_vr v r L}
    /// Y = 1/2 rho L d {Y_v v |u| + Y_r r L u - C_D/L int |v + C_rY r x| (v + C_rY r x) dx}
    /// N = 1/2 rho L^2 d {N_v v u + N_r r L |u| - C_D/L^2 int |v + C_rN r x| (v + C_rN r x) x dx}
    fn hull_force(&self, u: f64, v: f64, r: f64) -> Force {
        let (p, h) = (&self.particulars, &self.hull);
        let (scale, l) = (p.force_scale(), p.length);
        let r0 = h.r0 + (h.r0_astern - h.r0) * v.atan2(u).abs() / PI;
        let (force, _) = crossflow::integrals(v, h.yaw_in_force * r, l);
        let (_, moment) = crossflow::integrals(v, h.yaw_in_moment * r, l);
        Force {
            x: scale * (-r0 * u * u.hypot(v) + h.xvr * v * r * l),
            y: scale * (h.yv * v * u.abs() + h.yr * r * l * u - h.cross_flow_drag * force / l),
            n: scale * l * (h.nv * v * u + h.nr * r * l * u.abs() - h.cross_flow_drag * moment / (l * l)),
        }
    }

    /// Side force of an astern screw after Hachii, piecewise linear in J_s = u/(n D), as measured for Esso Osaka:
    /// Y = 1/2 rho L d (n D)^2 a(J_s), N = 1/2 rho L^2 d (n D)^2 b(J_s). To port (bow to starboard) over most of the range.
    fn propeller_force(&self, thrust: f64, u: f64, n: f64) -> Force {
        let (s, p) = (&self.particulars, &self.propeller);
        let nd = n * p.diameter;
        let x = p.effective(thrust, u, n);
        if n >= 0.0 {
            return Force { x, ..Force::default() };
        }
        let scale = p.side_force * s.force_scale();
        // (nD)^2 (c0 + c1 J_s) multiplied out: no quotient by n.
        let line = |c: [f64; 2]| scale * (c[0] * nd * nd + c[1] * nd * u);
        // In terms of u, since n < 0 reverses the limits of J_s = -0.06 and -0.35.
        let tip = -nd;
        let (force, moment) = if u < 0.06 * tip {
            ([-5.58e-4, 0.0], [2.25e-4, 0.0])
        } else if u <= 0.35 * tip {
            ([-7.90e-5, 7.99e-3], [3.5e-5, -3.17e-3])
        } else {
            ([-4.93e-3, -5.87e-3], [1.96e-3, 2.33e-3])
        };
        Force { x, y: line(force), n: s.length * line(moment) }
    }

    /// With F_N, F_T = 1/2 rho A_R U_R^2 (c_N, c_T): X = -(1-t_R) (F_N sin(delta) + F_T cos(delta)),
    /// Y = -(1+a_H) (F_N cos(delta) - F_T sin(delta)), N = (x_R + a_H x_H)/(1+a_H) Y.
    fn rudder_force(&self, [u_r, v_r]: [f64; 2], delta: f64) -> Force {
        let (p, q) = (&self.particulars, &self.rudder);
        let delta = delta + q.offset;
        let (sin, cos) = delta.sin_cos();
        let (c_n, c_t) = self.coefficients(delta - v_r.atan2(u_r), delta);
        let pressure = 0.5 * p.rho * q.area * (u_r * u_r + v_r * v_r);
        let side = pressure * (c_n * cos - c_t * sin);
        Force {
            x: -(1.0 - q.deduction) * pressure * (c_n * sin + c_t * cos),
            y: -(1.0 + q.hull_increase) * side,
            n: -q.lever() * p.length * side,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::ships::ship_b;

    #[test]
    fn mirrored_state_mirrors_the_force_but_for_the_side_force_of_the_screw() {
        let mut ship = ship_b();
        ship.propeller.side_force = 0.0;
        for (u, v, r, n, delta) in [
            (5.0, 0.7, -0.01, 2.0, 0.3),
            (-2.0, 1.5, 0.02, -2.5, -0.5),
            (0.0, -0.6, 0.01, 1.0, 0.6),
            (2.0, 2.0, 0.02, -2.0, 0.1),
        ] {
            let (a, b) = (ship.force(u, v, r, n, delta).total(), ship.force(u, -v, -r, n, -delta).total());
            let size = a.x.abs() + a.y.abs();
            assert!((a.x - b.x).abs() < 1e-12 * size && (a.y + b.y).abs() < 1e-12 * size, "{a:?} {b:?}");
            assert!((a.n + b.n).abs() < 1e-12 * size * ship.particulars.length);
        }
    }

    #[test]
    fn only_the_astern_screw_distinguishes_port_from_starboard() {
        let ship = ship_b();
        let ahead = ship.force(4.0, 0.0, 0.0, 1.5, 0.0).total();
        assert_eq!((ahead.y, ahead.n), (0.0, 0.0));
        let astern = ship.force(1.0, 0.0, 0.0, -2.0, 0.0).total();
        assert!(astern.y < 0.0 && astern.n > 0.0, "stern to port, bow to starboard");
    }

    #[test]
    fn side_force_of_the_screw_is_continuous_over_its_pieces() {
        let ship = ship_b();
        let tip = 2.0 * ship.propeller.diameter;
        for limit in [0.06, 0.35] {
            let side = |factor: f64| ship.propeller_force(0.0, limit * tip * factor, -2.0);
            let (a, b) = (side(1.0 - 1e-9), side(1.0 + 1e-9));
            assert!((a.y - b.y).abs() < 1e-3 * a.y.abs() && (a.n - b.n).abs() < 1e-3 * a.n.abs());
        }
    }

    #[test]
    fn flap_raises_the_lift_slope_and_keeps_it_to_45_deg() {
        let mut ship = ship_b();
        let flapped = |deg: f64| ship.coefficients(deg.to_radians(), deg.to_radians()).0;
        let (low, high, highest) = (flapped(5.0), flapped(40.0), flapped(45.0));
        assert!(highest > high);
        ship.blade.flap = 0.0;
        let plain = ship.coefficients(5.0_f64.to_radians(), 5.0_f64.to_radians()).0;
        assert!((1.3..1.6).contains(&(low / plain)), "{}", low / plain);
    }

    #[test]
    fn drift_of_90_deg_is_resisted_by_the_cross_flow_alone() {
        let ship = ship_b();
        let p = &ship.particulars;
        let hull = ship.force(0.0, 1.5, 0.0, 0.0, 0.0).hull;
        assert!((hull.y + p.force_scale() * ship.hull.cross_flow_drag * 1.5 * 1.5).abs() < 1e-6 * hull.y.abs());
        assert_eq!((hull.x, hull.n), (0.0, 0.0));
    }
}
