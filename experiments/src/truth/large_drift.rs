//! The second truth simulator: large drift angles, four quadrants, a flapped rudder. It is a reconstruction in the spirit of
//! Okuda et al. (2023, Appl. Ocean Res. 135, 103567), whose text is not public; nothing here is taken from it or checked against it.
//!
//! Hull: Yoshimura's unified low-speed model, linear terms and cross-flow drag without any 1/U. Propeller: four-quadrant Fourier
//! series, wake that fades with local drift, side force of the astern screw after Hachii. Rudder: normal and tangential force after
//! Lindenburg to 180 deg, the flap as a camber that shifts the inflow angle in proportion to the helm.

use std::f64::consts::PI;

use super::crossflow;
use super::propeller::OpenWater;
use super::{Contributions, Force, Inertia, Particulars, Truth, astern_weight};

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

/// Propeller, wake and thrust deduction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Propeller {
    /// Diameter D \[m\].
    pub diameter: f64,
    /// Open-water law.
    pub open_water: OpenWater,
    /// Factor on the open-water thrust, 1 when clean.
    pub thrust_factor: f64,
    /// Thrust deduction t, ahead rotation only.
    pub thrust_deduction: f64,
    /// Wake fraction on a straight course w_0.
    pub wake: f64,
    /// c in w = w_0 exp(-c beta_P^2).
    pub wake_decay: f64,
    /// Position x_P / L.
    pub position: f64,
    /// Factor on Hachii's side force of the astern screw; 0 for none, negative for a left-handed screw.
    pub side_force: f64,
}

/// Flapped rudder.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rudder {
    /// Area A_R with flap \[m^2\].
    pub area: f64,
    /// Span H_R \[m\].
    pub span: f64,
    /// Aspect ratio Lambda.
    pub aspect: f64,
    /// Camber of the flap: inflow angle gained per angle of helm.
    pub flap: f64,
    /// Factor on both force coefficients.
    pub gain: f64,
    /// Steering deduction t_R.
    pub deduction: f64,
    /// Rudder force increase a_H.
    pub hull_increase: f64,
    /// Its position x_H / L.
    pub hull_position: f64,
    /// Position x_R / L.
    pub position: f64,
    /// Effective position in the inflow l_R / L.
    pub inflow_position: f64,
    /// Flow straightening gamma for inflow from port (v_R < 0) and from starboard.
    pub straightening: [f64; 2],
    /// Wake ratio epsilon.
    pub wake_ratio: f64,
    /// Race factor kappa.
    pub race: f64,
    /// k_x of the suction of an astern screw.
    pub astern_race: f64,
    /// C_PR of the inflow behind an astern screw.
    pub astern_loss: f64,
    /// Offset added to the rudder angle \[rad\].
    pub offset: f64,
}

/// A ship with a flapped rudder at large drift. Every number is public and plain, so that a copy can be altered.
#[derive(Debug, Clone, PartialEq)]
pub struct LargeDrift {
    /// Main particulars.
    pub particulars: Particulars,
    /// m_x', on 1/2 rho L^2 d.
    pub surge_added: f64,
    /// m_y', on 1/2 rho L^2 d.
    pub sway_added: f64,
    /// J_z', on 1/2 rho L^4 d.
    pub yaw_added: f64,
    /// Radius of gyration k_zz / L about the centre of gravity.
    pub gyration: f64,
    /// Hull.
    pub hull: Hull,
    /// Propeller.
    pub propeller: Propeller,
    /// Rudder.
    pub rudder: Rudder,
}

impl LargeDrift {
    /// The similar ship of this length \[m\], in the same water: coefficients are without dimension and stay.
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

    /// Inflow speed of the propeller V_A \[m/s\]: (1 - w_0 exp(-c beta_P^2)) u, beta_P = atan2(-(v + x_P r), u), for u > 0; else u.
    pub fn propeller_inflow(&self, u: f64, v: f64, r: f64) -> f64 {
        if u <= 0.0 {
            return u;
        }
        let p = &self.propeller;
        let beta_p = (-(v + p.position * self.particulars.length * r)).atan2(u);
        u * (1.0 - p.wake * (-p.wake_decay * beta_p * beta_p).exp())
    }

    /// Side force of an astern screw after Hachii, piecewise linear in J_s = u/(n D), as measured for Esso Osaka:
    /// Y = 1/2 rho L d (n D)^2 a(J_s), N = 1/2 rho L^2 d (n D)^2 b(J_s). To port (bow to starboard) over most of the range.
    fn propeller_force(&self, thrust: f64, u: f64, n: f64) -> Force {
        let (s, p) = (&self.particulars, &self.propeller);
        let nd = n * p.diameter;
        let x = thrust * (1.0 - p.thrust_deduction * (1.0 - astern_weight(n, p.diameter, u)));
        if n >= 0.0 {
            return Force { x, ..Force::default() };
        }
        let scale = p.side_force * s.force_scale();
        // (nD)^2 (c0 + c1 J_s) multiplied out: no quotient by n.
        let line = |c: [f64; 2]| scale * (c[0] * nd * nd + c[1] * nd * u);
        // In terms of u, since n < 0 turns the limits of J_s = -0.06 and -0.35 round.
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

    /// Longitudinal and lateral inflow at the rudder, (u_R, v_R) \[m/s\].
    ///
    /// u_R as in the momentum theory of the standard method ahead; with astern rotation the race gives way to the suction
    /// -k_x sqrt(8 |T|/(pi rho D^2)) and the loss C_PR u^2 (Kitagawa). v_R = -gamma (v + l_R r), without any angle, so that
    /// it holds at every drift.
    pub fn rudder_inflow(&self, u: f64, v: f64, r: f64, n: f64, thrust: f64, va: f64) -> (f64, f64) {
        let (s, p, q) = (&self.particulars, &self.propeller, &self.rudder);
        let race = 8.0 * thrust / (PI * s.rho * p.diameter * p.diameter);
        let astern = astern_weight(n, p.diameter, u);
        let (ratio, astern_loss) = if u >= 0.0 { (q.wake_ratio, q.astern_loss * astern) } else { (1.0, 0.0) };
        let ahead_gain = q.wake_ratio * q.race * ((va * va + race).max(0.0).sqrt() - va.abs());
        let astern_gain = -q.astern_race * (-race).max(0.0).sqrt();
        let behind = ratio * va + (1.0 - astern) * ahead_gain + astern * astern_gain;
        let beside = ratio * va;
        let eta = (p.diameter / q.span).min(1.0);
        let squared = eta * behind * behind.abs() + (1.0 - eta) * beside * beside.abs() + astern_loss * u * u;
        let cross = -(v + q.inflow_position * s.length * r);
        let gamma = if cross < 0.0 { q.straightening[0] } else { q.straightening[1] };
        (squared.signum() * squared.abs().sqrt(), gamma * cross)
    }

    /// Normal and tangential coefficients at inflow angle `alpha` with the helm at `delta` \[rad\] (after Lindenburg).
    ///
    /// c_N = 1.98 (1/(0.56 + 0.44 |sin a|) - 0.41 (1 - exp(-17/Lambda))) sin a, c_T = 0.00375 cos a - 0.053 |c_N| cos a, with
    /// a = alpha + flap delta (1 + cos alpha)/2: the flap works in flow from ahead and is idle in flow from aft. c_T is positive
    /// towards the trailing edge; its suction part changes side with the flow, where the source leaves it.
    fn coefficients(&self, alpha: f64, delta: f64) -> (f64, f64) {
        let q = &self.rudder;
        let (sin, cos) = (alpha + q.flap * delta * 0.5 * (1.0 + alpha.cos())).sin_cos();
        let normal = 1.98 * (1.0 / (0.56 + 0.44 * sin.abs()) - 0.41 * (1.0 - (-17.0 / q.aspect).exp())) * sin;
        let tangential = (0.00375 - 0.053 * normal.abs()) * cos;
        (q.gain * normal, q.gain * tangential)
    }

    /// With F_N, F_T = 1/2 rho A_R U_R^2 (c_N, c_T): X = -(1-t_R) (F_N sin(delta) + F_T cos(delta)),
    /// Y = -(1+a_H) (F_N cos(delta) - F_T sin(delta)), N = (x_R + a_H x_H)/(1+a_H) Y.
    fn rudder_force(&self, u_r: f64, v_r: f64, delta: f64) -> Force {
        let (p, q) = (&self.particulars, &self.rudder);
        let delta = delta + q.offset;
        let (sin, cos) = delta.sin_cos();
        let (c_n, c_t) = self.coefficients(delta - v_r.atan2(u_r), delta);
        let pressure = 0.5 * p.rho * q.area * (u_r * u_r + v_r * v_r);
        let side = pressure * (c_n * cos - c_t * sin);
        Force {
            x: -(1.0 - q.deduction) * pressure * (c_n * sin + c_t * cos),
            y: -(1.0 + q.hull_increase) * side,
            n: -(q.position + q.hull_increase * q.hull_position) * p.length * side,
        }
    }
}

impl Truth for LargeDrift {
    fn particulars(&self) -> &Particulars {
        &self.particulars
    }

    fn inertia(&self) -> Inertia {
        let p = &self.particulars;
        let (mass, scale) = (p.mass(), p.force_scale() * p.length);
        let radius = self.gyration * p.length;
        Inertia {
            mass,
            surge_added: self.surge_added * scale,
            sway_added: self.sway_added * scale,
            yaw: mass * (radius * radius + p.xg * p.xg) + self.yaw_added * scale * p.length * p.length,
            xg: p.xg,
        }
    }

    fn force(&self, u: f64, v: f64, r: f64, n: f64, delta: f64) -> Contributions {
        let p = &self.propeller;
        let va = self.propeller_inflow(u, v, r);
        let thrust = p.thrust_factor * p.open_water.thrust(n, va, p.diameter, self.particulars.rho);
        let (u_r, v_r) = self.rudder_inflow(u, v, r, n, thrust, va);
        Contributions {
            hull: self.hull_force(u, v, r),
            propeller: self.propeller_force(thrust, u, n),
            rudder: self.rudder_force(u_r, v_r, delta),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::ships::ship_b;
    use super::*;

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
    fn only_the_astern_screw_tells_port_from_starboard() {
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
        ship.rudder.flap = 0.0;
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
