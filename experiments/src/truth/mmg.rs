//! The first truth simulator: the standard MMG method (Yasukawa & Yoshimura 2015, J. Mar. Sci. Technol. 20, 37-52), made
//! four-quadrant. Ahead and at moderate drift it is the standard method to the last digit; it is not the fitted model.
//!
//! What is added to the standard method, and where it starts:
//! - Hull: beyond a local drift angle of 35 deg the cubic polynomial is blended, until 65 deg, into a regular low-speed form
//!   (Munk-type linear terms with the sign of u, cross-flow drag, resistance that grows to its astern value).
//! - Propeller: wake and thrust deduction fade out in sternway and with astern rotation; side force of an astern screw.
//! - Rudder: inflow that passes smoothly through zero speed, the suction of an astern screw (after Kitagawa), stall
//!   beyond 40 deg of inflow angle.

use std::f64::consts::PI;

use super::laws::blend::smooth_step;
use super::laws::crossflow;
use super::laws::slipstream::{Propeller, Rudder};
use super::motion::{Force, Particulars};
use super::simulator::{AddedMass, Inertia, Propulsion, Truth};

/// Hull coefficients. Primes: forces on 1/2 rho L d U^2, moments on 1/2 rho L^2 d U^2, v' = v/U, r' = r L/U.
#[derive(Debug, Clone, Copy, PartialEq)]
#[allow(missing_docs)] // The derivatives carry their meaning in their names: `yvvr` multiplies v'^2 r' in Y'.
pub struct Hull {
    /// Resistance R0' ahead.
    pub r0: f64,
    /// Resistance R0' astern (only beyond moderate drift).
    pub r0_astern: f64,
    /// Growth of the resistance with Froude number: R0' (1 + k Fn^4). 0 in the standard method.
    pub r0_froude4: f64,
    pub xvv: f64,
    /// In addition to (m + m_y) v r.
    pub xvr: f64,
    pub xrr: f64,
    pub xvvvv: f64,
    pub yv: f64,
    /// With (m + m_x) u r kept on the left-hand side.
    pub yr: f64,
    pub yvvv: f64,
    pub yvvr: f64,
    pub yvrr: f64,
    pub yrrr: f64,
    pub nv: f64,
    pub nr: f64,
    pub nvvv: f64,
    pub nvvr: f64,
    pub nvrr: f64,
    pub nrrr: f64,
    /// Cross-flow drag coefficient C_D of the large-drift form.
    pub cross_flow_drag: f64,
}

/// Force law of the rudder blade: normal force f_alpha sin(alpha), with stall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Blade {
    /// Gradient of the normal force f_alpha.
    pub normal_gradient: f64,
    /// Normal force over sin(alpha) of the stalled rudder.
    pub stalled_gradient: f64,
    /// Factor on the gradient when the flow comes from aft.
    pub reversed_factor: f64,
}

/// A ship under the standard MMG method. Every number is public and plain, so that a copy can be altered.
#[derive(Debug, Clone, PartialEq)]
pub struct Mmg {
    /// Main particulars.
    pub particulars: Particulars,
    /// Added masses and radius of gyration.
    pub added: AddedMass,
    /// Hull.
    pub hull: Hull,
    /// Propeller. Its side force astern is Y_P = -c |X_P| exp(-(J/J0)^2).
    pub propeller: Propeller,
    /// C1 of the wake in a turn.
    pub wake_c1: f64,
    /// C2 of the wake in a turn, for beta_P > 0 and for beta_P < 0.
    pub wake_c2: [f64; 2],
    /// J0 of the side force of an astern screw.
    pub side_force_range: f64,
    /// Rudder.
    pub rudder: Rudder,
    /// Force law of its blade.
    pub blade: Blade,
}

/// Local drift angle at which the large-drift hull starts to enter, and at which it is alone \[rad\].
const LARGE_DRIFT: [f64; 2] = [35.0 * PI / 180.0, 65.0 * PI / 180.0];
/// Inflow angle at which the rudder starts to stall, and at which it is fully stalled \[rad\].
const STALL: [f64; 2] = [40.0 * PI / 180.0, 60.0 * PI / 180.0];

impl Mmg {
    /// The coefficients that no chart gives exactly, by reference.
    pub fn uncertain(&mut self) -> Vec<&mut f64> {
        let (h, p) = (&mut self.hull, &mut self.propeller);
        let mut all: Vec<&mut f64> = self.added.each().into();
        all.extend([&mut h.r0, &mut h.r0_astern, &mut h.r0_froude4]);
        all.extend([&mut h.xvv, &mut h.xvr, &mut h.xrr, &mut h.xvvvv]);
        all.extend([&mut h.yv, &mut h.yr, &mut h.yvvv, &mut h.yvvr, &mut h.yvrr, &mut h.yrrr]);
        all.extend([&mut h.nv, &mut h.nr, &mut h.nvvv, &mut h.nvvr, &mut h.nvrr, &mut h.nrrr]);
        all.extend([&mut h.cross_flow_drag, &mut p.thrust_factor, &mut p.thrust_deduction, &mut p.wake]);
        all.extend([&mut self.wake_c1, &mut self.blade.normal_gradient]);
        all.extend(self.rudder.uncertain());
        all
    }

    /// Weight of the large-drift hull at this velocity, 0..=1.
    ///
    /// Runs on the local drift angle atan2(sqrt(v^2 + (r L/2)^2), u), which is 90 deg when turning on the spot and more in sternway.
    pub fn large_drift_weight(&self, u: f64, v: f64, r: f64) -> f64 {
        smooth_step(v.hypot(0.5 * r * self.particulars.length).atan2(u), LARGE_DRIFT[0], LARGE_DRIFT[1])
    }

    fn resistance(&self, speed: f64) -> f64 {
        let froude2 = speed * speed / (9.81 * self.particulars.length);
        1.0 + self.hull.r0_froude4 * froude2 * froude2
    }

    /// X' = -R0' + Xvv v'^2 + Xvr v'r' + Xrr r'^2 + Xvvvv v'^4, Y' and N' cubic in v', r' (eqs. 8-10 of the source).
    fn cubic_hull(&self, u: f64, v: f64, r: f64) -> Force {
        let (p, h) = (&self.particulars, &self.hull);
        let speed = u.hypot(v);
        let (a, b) = (v / speed, r * p.length / speed);
        let scale = p.force_scale() * speed * speed;
        let x = -h.r0 * self.resistance(speed) + h.xvv * a * a + h.xvr * a * b + h.xrr * b * b + h.xvvvv * a.powi(4);
        let cubic = |c: [f64; 6]| {
            c[0] * a + c[1] * b + c[2] * a * a * a + c[3] * a * a * b + c[4] * a * b * b + c[5] * b * b * b
        };
        let y = cubic([h.yv, h.yr, h.yvvv, h.yvvr, h.yvrr, h.yrrr]);
        let n = cubic([h.nv, h.nr, h.nvvv, h.nvvr, h.nvrr, h.nrrr]);
        Force { x: scale * x, y: scale * y, n: scale * p.length * n }
    }

    /// The regular form for low speed, large drift and sternway (structure after Yoshimura's unified model): no 1/U.
    fn low_speed_hull(&self, u: f64, v: f64, r: f64) -> Force {
        let (p, h) = (&self.particulars, &self.hull);
        let (scale, l, speed) = (p.force_scale(), p.length, u.hypot(v));
        let share_astern = v.atan2(u).abs() / PI;
        let r0 = (h.r0 + (h.r0_astern - h.r0) * share_astern) * self.resistance(speed);
        let (force, moment) = crossflow::integrals(v, r, l);
        Force {
            x: scale * (-r0 * u * speed + h.xvr * v * r * l),
            y: scale * (h.yv * v * u.abs() + h.yr * r * l * u - h.cross_flow_drag * force / l),
            n: scale * l * (h.nv * v * u + h.nr * r * l * u.abs() - h.cross_flow_drag * moment / (l * l)),
        }
    }

    /// Inflow speed of the propeller V_A \[m/s\].
    ///
    /// Ahead (1 - w_P) u with (1 - w_P)/(1 - w_P0) = 1 + (1 - exp(-C1 |beta_P|)) (C2 - 1), beta_P = beta - x_P' r'
    /// (eqs. 16-18); u itself in sternway. At most the ship's speed through the water is kept: w_P >= 0.
    fn propeller_inflow(&self, u: f64, v: f64, r: f64) -> f64 {
        if u <= 0.0 {
            return u;
        }
        let p = &self.propeller;
        let beta_p = (-v).atan2(u) - p.position * self.particulars.length * r / u.hypot(v);
        let c2 = if beta_p > 0.0 { self.wake_c2[0] } else { self.wake_c2[1] };
        let factor = 1.0 + (1.0 - (-self.wake_c1 * beta_p.abs()).exp()) * (c2 - 1.0);
        u * ((1.0 - p.wake) * factor).min(1.0)
    }

    /// Lateral flow before the rudder \[m/s\]: U beta_R, beta_R = beta - l_R' r'.
    fn lateral_flow(&self, u: f64, v: f64, r: f64) -> f64 {
        // U beta of the standard method is an angle times a speed and has no meaning beyond 90 deg, where -v replaces it.
        let weight = self.large_drift_weight(u, v, r);
        let drift = -(1.0 - weight) * u.hypot(v) * v.atan2(u) - weight * v;
        drift - self.rudder.inflow_position * self.particulars.length * r
    }

    /// Normal force coefficient f_alpha sin(alpha), stalling beyond 40 deg and weaker in flow from aft.
    fn normal_coefficient(&self, alpha: f64) -> f64 {
        let q = &self.blade;
        let from_chord = alpha.sin().abs().asin();
        let attached = if alpha.cos() >= 0.0 { q.normal_gradient } else { q.reversed_factor * q.normal_gradient };
        let stall = smooth_step(from_chord, STALL[0], STALL[1]);
        ((1.0 - stall) * attached + stall * q.stalled_gradient) * alpha.sin()
    }
}

impl Truth for Mmg {
    fn particulars(&self) -> &Particulars {
        &self.particulars
    }

    fn inertia(&self) -> Inertia {
        self.added.inertia(&self.particulars)
    }

    fn propulsion(&self, u: f64, v: f64, r: f64, n: f64) -> Propulsion {
        let (p, q, rho) = (&self.propeller, &self.rudder, self.particulars.rho);
        let va = self.propeller_inflow(u, v, r);
        let thrust = p.thrust(n, va, rho);
        let axial = q.axial_inflow(p, rho, [u, n], thrust, va);
        Propulsion { thrust, rudder_inflow: [axial, q.straightened(self.lateral_flow(u, v, r))] }
    }

    fn hull_force(&self, u: f64, v: f64, r: f64) -> Force {
        if u == 0.0 && v == 0.0 && r == 0.0 {
            return Force::default();
        }
        let weight = self.large_drift_weight(u, v, r);
        let mut total = Force::default();
        for (part, share) in [(0, 1.0 - weight), (1, weight)] {
            // A vanishing share is not evaluated: the cubic has no value at U = 0.
            if share > 0.0 {
                let f = if part == 0 { self.cubic_hull(u, v, r) } else { self.low_speed_hull(u, v, r) };
                total = total + Force { x: share * f.x, y: share * f.y, n: share * f.n };
            }
        }
        total
    }

    fn propeller_force(&self, thrust: f64, u: f64, n: f64) -> Force {
        let p = &self.propeller;
        let x = p.effective(thrust, u, n);
        let mut y = 0.0;
        if n < 0.0 {
            let ratio = u / (n * p.diameter * self.side_force_range);
            y = -p.side_force * (-x).max(0.0) * (-ratio * ratio).exp();
        }
        Force { x, y, n: p.position * self.particulars.length * y }
    }

    /// F_N = 1/2 rho A_R U_R^2 f_alpha sin(alpha_R); X = -(1-t_R) F_N sin(delta), Y = -(1+a_H) F_N cos(delta),
    /// N = -(x_R + a_H x_H) F_N cos(delta) (eqs. 19-24).
    fn rudder_force(&self, [u_r, v_r]: [f64; 2], delta: f64) -> Force {
        let (p, q) = (&self.particulars, &self.rudder);
        let delta = delta + q.offset;
        let normal = 0.5 * p.rho * q.area * (u_r * u_r + v_r * v_r) * self.normal_coefficient(delta - v_r.atan2(u_r));
        Force {
            x: -(1.0 - q.deduction) * normal * delta.sin(),
            y: -(1.0 + q.hull_increase) * normal * delta.cos(),
            n: -q.lever() * p.length * normal * delta.cos(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::laws::propeller::OpenWater;
    use crate::truth::ships::{kvlcc2, ship_a};

    /// The standard method as printed in the source, with its quotients by U and J.
    fn printed(s: &Mmg, u: f64, v: f64, r: f64, n: f64, delta: f64) -> Force {
        let (p, h, w, q) = (&s.particulars, &s.hull, &s.propeller, &s.rudder);
        let l = p.length;
        let speed = (u * u + v * v).sqrt();
        let beta = (-v / u).atan();
        let (vp, rp) = (v / speed, r * l / speed);
        let scale = 0.5 * p.rho * l * p.draught * speed * speed;
        let xh = -h.r0 + h.xvv * vp.powi(2) + h.xvr * vp * rp + h.xrr * rp.powi(2) + h.xvvvv * vp.powi(4);
        let yh = h.yv * vp
            + h.yr * rp
            + h.yvvv * vp.powi(3)
            + h.yvvr * vp.powi(2) * rp
            + h.yvrr * vp * rp.powi(2)
            + h.yrrr * rp.powi(3);
        let nh = h.nv * vp
            + h.nr * rp
            + h.nvvv * vp.powi(3)
            + h.nvvr * vp.powi(2) * rp
            + h.nvrr * vp * rp.powi(2)
            + h.nrrr * rp.powi(3);
        let beta_p = beta - w.position * rp;
        let c2 = if beta_p > 0.0 { s.wake_c2[0] } else { s.wake_c2[1] };
        let one_minus_w = (1.0 - w.wake) * (1.0 + (1.0 - (-s.wake_c1 * beta_p.abs()).exp()) * (c2 - 1.0));
        let j = u * one_minus_w / (n * w.diameter);
        let OpenWater::Quadratic { k0, k1, k2, .. } = w.open_water else { panic!("KVLCC2 has a quadratic K_T") };
        let kt = k0 + k1 * j + k2 * j * j;
        let thrust = p.rho * n * n * w.diameter.powi(4) * kt;
        let beta_r = beta - q.inflow_position * rp;
        let gamma = if beta_r < 0.0 { q.straightening[0] } else { q.straightening[1] };
        let v_r = speed * gamma * beta_r;
        let eta = w.diameter / q.span;
        let race = 1.0 + q.race * ((1.0 + 8.0 * kt / (PI * j * j)).sqrt() - 1.0);
        let u_r = q.wake_ratio * u * one_minus_w * (eta * race * race + 1.0 - eta).sqrt();
        let alpha = delta - (v_r / u_r).atan();
        let normal = 0.5 * p.rho * q.area * (u_r * u_r + v_r * v_r) * s.blade.normal_gradient * alpha.sin();
        Force {
            x: scale * xh + (1.0 - w.thrust_deduction) * thrust - (1.0 - q.deduction) * normal * delta.sin(),
            y: scale * yh - (1.0 + q.hull_increase) * normal * delta.cos(),
            n: scale * l * nh - (q.position + q.hull_increase * q.hull_position) * l * normal * delta.cos(),
        }
    }

    #[test]
    fn ahead_and_at_moderate_drift_it_is_the_standard_method() {
        let ship = kvlcc2();
        let l = ship.particulars.length;
        for (u, v, rp, n, delta) in [
            (7.97, 0.0, 0.0, 1.78, 0.0),
            (7.5, -1.2, 0.3, 1.78, 0.4),
            (4.0, 1.5, -0.6, 1.5, -0.6),
            (3.0, -1.0, 0.8, 1.7, 0.6),
            (6.0, 0.5, 0.2, 1.0, -0.1),
        ] {
            let r = rp * f64::hypot(u, v) / l;
            let (a, b) = (ship.force(u, v, r, n, delta).total(), printed(&ship, u, v, r, n, delta));
            let size = b.x.hypot(b.y) + b.n.abs() / l;
            for (a, b, unit) in [(a.x, b.x, 1.0), (a.y, b.y, 1.0), (a.n, b.n, l)] {
                assert!((a - b).abs() < 1e-12 * size * unit, "{a} against {b}");
            }
        }
    }

    #[test]
    fn mirrored_state_mirrors_the_force_once_the_asymmetries_are_removed() {
        let mut ship = ship_a();
        ship.rudder.straightening = [0.4; 2];
        ship.wake_c2 = [1.2; 2];
        ship.propeller.side_force = 0.0;
        for (u, v, r, n, delta) in [
            (5.0, 0.7, -0.01, 2.0, 0.3),
            (-2.0, 1.5, 0.02, -3.0, -0.5),
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
    fn port_and_starboard_differ_only_through_straightening_wake_and_side_force() {
        let ship = ship_a();
        let straight = ship.force(5.0, 0.0, 0.0, 2.0, 0.0).total();
        assert_eq!((straight.y, straight.n), (0.0, 0.0), "no side force on a straight course ahead");
        let astern = ship.force(0.0, 0.0, 0.0, -3.0, 0.0).total();
        assert!(astern.y < 0.0 && astern.n > 0.0, "{astern:?}: an astern right-handed screw moves the stern to port");
        let (a, b) = (ship.force(5.0, 0.8, 0.0, 2.0, 0.0).rudder, ship.force(5.0, -0.8, 0.0, 2.0, 0.0).rudder);
        assert!((a.y + b.y).abs() > 1.0, "the flow is straightened differently on either side");
    }

    #[test]
    fn rudder_to_starboard_turns_to_starboard_and_the_other_way_in_sternway() {
        let ship = ship_a();
        assert!(ship.force(4.0, 0.0, 0.0, 2.0, 0.3).rudder.n > 0.0);
        assert!(ship.force(0.0, 0.0, 0.0, 2.0, 0.3).rudder.n > 0.0, "a kick ahead steers at rest");
        assert!(ship.force(-3.0, 0.0, 0.0, 0.0, 0.3).rudder.n < 0.0);
    }
}
