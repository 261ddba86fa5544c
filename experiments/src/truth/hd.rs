//! The third truth simulator: the paper's own equation of motion for ship A, written again in plain `f64` with numbers of its own.
//! It shares no code with the library's model of that equation; a test compares the two, so that either can be trusted.
//!
//! Equation after Papandreou et al. (arXiv 2502.18696, eq. 1 to 4; Spyrou 1996): coefficients are dimensional and constant, the
//! eleven parameters p0 to p10 are propeller side force, resistance polynomial, and rudder lift and drag polynomials. What the
//! paper does not print (thrust, rudder inflow, rudder beyond 45 deg) follows the MMG standard method, as in the library.

use std::f64::consts::PI;

use super::laws::blend::smooth_step;
use super::motion::{Force, Particulars};
use super::simulator::{Inertia, Propulsion, Truth};

/// Hull coefficients of eq. (1), dimensional, for the midship origin. Signs as in the equation (Xud, Yvd, Nrd < 0).
#[derive(Debug, Clone, Copy, PartialEq)]
#[allow(missing_docs)] // each is the coefficient of the same name in the equation of `Hd`
pub struct Hull {
    pub xud: f64,
    pub yvd: f64,
    pub yrd: f64,
    pub nvd: f64,
    pub nrd: f64,
    pub xvr: f64,
    pub yv: f64,
    pub yr: f64,
    pub nv: f64,
    pub nr: f64,
    pub yvv: f64,
    pub yvr: f64,
    pub yrr: f64,
    pub nrr: f64,
    pub nrrv: f64,
    pub nvvr: f64,
}

impl Hull {
    /// The coefficients by reference, so that all of them can be altered alike.
    pub fn each(&mut self) -> [&mut f64; 16] {
        let h = self;
        [
            &mut h.xud,
            &mut h.yvd,
            &mut h.yrd,
            &mut h.nvd,
            &mut h.nrd,
            &mut h.xvr,
            &mut h.yv,
            &mut h.yr,
            &mut h.nv,
            &mut h.nr,
            &mut h.yvv,
            &mut h.yvr,
            &mut h.yrr,
            &mut h.nrr,
            &mut h.nrrv,
            &mut h.nvvr,
        ]
    }
}

/// Propeller: T = f rho (k0 D^4 n|n| + k1 D^3 |n| V_A + k2 D^2 V_A |V_A|).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Propeller {
    /// Diameter D \[m\].
    pub diameter: f64,
    /// Position x_P \[m\].
    pub position: f64,
    /// Wake fraction w, ahead.
    pub wake: f64,
    /// Thrust deduction t, for thrust ahead.
    pub thrust_deduction: f64,
    /// k0, k1, k2 of K_T(J).
    pub kt: [f64; 3],
    /// Factor on k0 with the screw turning astern.
    pub astern: f64,
    /// Factor f on the thrust, 1 when clean.
    pub thrust_factor: f64,
}

/// Rudder and its inflow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rudder {
    /// Area A_R \[m^2\].
    pub area: f64,
    /// Span H_R \[m\].
    pub span: f64,
    /// Position x_R \[m\].
    pub position: f64,
    /// Flow straightening gamma.
    pub straightening: f64,
    /// Effective position in the inflow l_R \[m\].
    pub inflow_position: f64,
    /// Wake ratio epsilon.
    pub wake_ratio: f64,
    /// Race factor kappa.
    pub race: f64,
    /// What an astern screw takes from the inflow.
    pub astern_race: f64,
    /// Factor on lift and drag.
    pub gain: f64,
    /// Offset added to the rudder angle \[rad\].
    pub offset: f64,
}

/// A ship under the paper's equation. Every number is public and plain, so that a copy can be altered.
///
/// ```text
/// (m - Xud) u' + (Yvd - Xvr - m) v r + (Yrd - m xG) r^2 = X
/// (m - Yvd) v' + (m xG - Yrd) r' - Yv U v + (m u - Yr U) r - Yvv v|v| - Yvr v|r| - Yrr r|r| = Y
/// (m xG - Nvd) v' + (Iz - Nrd) r' - Nv U v + (m xG u - Nr U) r - Nrr r|r| - Nrrv r^2 v/U - Nvvr v^2 r/U = N
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Hd {
    /// Main particulars.
    pub particulars: Particulars,
    /// Mass m \[kg\].
    pub mass: f64,
    /// Yaw inertia about midship Iz \[kg m^2\].
    pub yaw_inertia: f64,
    /// Centre of gravity forward of midship xG \[m\].
    pub xg: f64,
    /// Hull.
    pub hull: Hull,
    /// p0 to p10.
    pub p: [f64; 11],
    /// Propeller.
    pub propeller: Propeller,
    /// Rudder.
    pub rudder: Rudder,
    /// Share of the fore-aft consistent form of the linear terms (Yoshimura): 0 as printed, U everywhere.
    pub sternway: f64,
}

/// Speed below which U, |u|, |v| and L|r| are rounded off \[m/s\].
const SMALL: f64 = 0.05;
/// Angle of attack up to which the polynomials are valid, and from which the rudder is a flat plate \[rad\].
const BLEND: [f64; 2] = [45.0 * PI / 180.0, 60.0 * PI / 180.0];

/// Ship A of the paper with its fitted rudder and its baseline resistance.
///
/// Coefficients: Clarke et al. (1982), Zhou (1983) and Inoue et al. (1981) for the reconstructed hull. Rudder: the published
/// fitted values, from the zeros and extremes of their curves. Resistance: the published baseline; the fitted one is far off
/// any physical curve astern (it gives 546 kN at -4.5 m/s).
pub fn ship_a() -> Hd {
    let (length, rho) = (85.0, 1025.0);
    Hd {
        particulars: Particulars { length, breadth: 13.5, draught: 4.2, volume: 3277.0, xg: 0.0, rho },
        mass: 3.359e6,
        yaw_inertia: 1.517e9,
        xg: 0.0,
        hull: Hull {
            xud: -1.546e5,
            yvd: -2.948e6,
            yrd: -1.484e7,
            nvd: -8.807e6,
            nrd: -1.187e9,
            xvr: -9.875e5,
            yv: -5.323e4,
            yr: 9.843e5,
            nv: -1.493e6,
            nr: -5.877e7,
            yvv: -1.058e5,
            yvr: -3.914e6,
            yrr: -5.261e7,
            nrr: -2.997e9,
            nrrv: 3.846e9,
            nvvr: -1.165e8,
        },
        p: [-0.017, 10_500.0, -1_900.0, 346.0, -0.039, 3.193, 0.205, -4.884, 0.048, 0.075, 1.371],
        propeller: Propeller {
            diameter: 2.85,
            position: -0.48 * length,
            wake: 0.28,
            thrust_deduction: 0.19,
            kt: [0.3425, -0.2424, -0.1897],
            astern: 0.74,
            thrust_factor: 1.0,
        },
        rudder: Rudder {
            area: 7.9,
            span: 3.56,
            position: -0.5 * length,
            straightening: 0.45,
            inflow_position: -0.85 * length,
            wake_ratio: 1.05,
            race: 0.5,
            astern_race: 0.144,
            gain: 1.0,
            offset: 0.0,
        },
        sternway: 0.0,
    }
}

impl Hd {
    /// Inflow speed of the propeller and its thrust before deduction, `(V_A [m/s], T [N])`.
    fn thrust(&self, u: f64, n: f64) -> (f64, f64) {
        let p = &self.propeller;
        let ahead = 0.5 * (1.0 + u / u.hypot(SMALL));
        let va = (1.0 - p.wake * ahead) * u;
        let (f0, f1) = if n < 0.0 { (p.astern, 0.3) } else { (1.0, 1.0) };
        let d = p.diameter;
        let sum = f0 * p.kt[0] * d * d * n * n.abs() + f1 * p.kt[1] * d * n.abs() * va + p.kt[2] * va * va.abs();
        (va, p.thrust_factor * self.particulars.rho * d * d * sum)
    }

    /// Longitudinal and lateral inflow at the rudder, `(u_R, v_R)` \[m/s\].
    fn rudder_inflow(&self, v: f64, r: f64, va: f64, thrust: f64) -> [f64; 2] {
        let (d, q) = (self.propeller.diameter, &self.rudder);
        let gain = 8.0 * thrust / (PI * self.particulars.rho * d * d);
        let ahead = q.race * ((va * va + gain.max(0.0)).sqrt() - va.abs());
        let behind = va + ahead - q.astern_race * (-gain).max(0.0).sqrt();
        let eta = (d / q.span).min(1.0);
        let squared = eta * behind * behind.abs() + (1.0 - eta) * va * va.abs();
        // A square root would be infinitely steep at no inflow at all.
        let axial = q.wake_ratio * squared / (squared * squared + (0.1 * SMALL).powi(4)).powf(0.25);
        [axial, -q.straightening * (v + q.inflow_position * r)]
    }
}

impl Truth for Hd {
    fn particulars(&self) -> &Particulars {
        &self.particulars
    }

    /// The equation's own, with Yrd and Nvd; the part of the added mass in v r is in the coefficients of the hull.
    fn inertia(&self) -> Inertia {
        let (h, m) = (&self.hull, self.mass);
        let mxg = m * self.xg;
        Inertia {
            surge: m - h.xud,
            coupled: [[m - h.yvd, mxg - h.yrd], [mxg - h.nvd, self.yaw_inertia - h.nrd]],
            carried: [m, m],
            mxg,
        }
    }

    fn propulsion(&self, u: f64, v: f64, r: f64, n: f64) -> Propulsion {
        let (va, thrust) = self.thrust(u, n);
        Propulsion { thrust, rudder_inflow: self.rudder_inflow(v, r, va, thrust) }
    }

    /// The terms of the left-hand side other than accelerations and rigid-body terms, moved to the right, and -R(u).
    fn hull_force(&self, u: f64, v: f64, r: f64) -> Force {
        let (h, p) = (&self.hull, &self.p);
        let speed = (u * u + v * v + SMALL * SMALL).sqrt();
        let along = u.hypot(SMALL);
        let even = speed + self.sternway * (along - speed);
        let odd = speed + self.sternway * (u - speed);
        let (abs_v, abs_r) = (v.hypot(SMALL), r.hypot(SMALL / self.particulars.length));
        let square = u * (u + self.sternway * (u.abs() - u));
        Force {
            x: (h.xvr - h.yvd) * v * r - h.yrd * r * r - (p[1] * u + p[2] * square + p[3] * u * u * u),
            y: h.yv * even * v + h.yr * odd * r + h.yvv * v * abs_v + h.yvr * v * abs_r + h.yrr * r * abs_r,
            n: h.nv * odd * v
                + h.nr * even * r
                + h.nrr * r * abs_r
                + h.nrrv * r * r * v / speed
                + h.nvvr * v * v * r / speed,
        }
    }

    fn propeller_force(&self, thrust: f64, _u: f64, _n: f64) -> Force {
        let deduction = if thrust > 0.0 { self.propeller.thrust_deduction } else { 0.0 };
        let x = (1.0 - deduction) * thrust;
        let y = self.p[0] * x;
        Force { x, y, n: self.propeller.position * y }
    }

    fn rudder_force(&self, [u_r, v_r]: [f64; 2], delta: f64) -> Force {
        let (p, q) = (&self.p, &self.rudder);
        let flow = v_r.atan2(u_r);
        let turned = delta + q.offset - flow;
        let a = turned - 2.0 * PI * (turned / (2.0 * PI)).round();
        let limited = a.clamp(-BLEND[1], BLEND[1]);
        let plate = smooth_step(a.abs(), BLEND[0], BLEND[1]);
        let lift = p[4] + limited * (p[5] + limited * (p[6] + limited * p[7]));
        let drag = p[8] + limited * (p[9] + limited * p[10]);
        let lift = lift + plate * (1.2 * a.sin() * a.cos() - lift);
        let drag = drag + plate * (1.2 * a.sin() * a.sin() - drag);
        let pressure = 0.5 * self.particulars.rho * q.area * (u_r * u_r + v_r * v_r) * q.gain;
        let (sin, cos) = flow.sin_cos();
        let y = pressure * (drag * sin - lift * cos);
        Force { x: -pressure * (drag * cos + lift * sin), y, n: q.position * y }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn accelerations_agree_with_the_library_s_model_of_this_equation() {
        use trimtab::ship::state as lib;
        let text = include_str!("../../ships/a.toml");
        let ship = trimtab::ship::Ship::parse(text, std::path::Path::new("a.toml")).unwrap();
        let mut model = trimtab::model::Model::new(ship, "check", trimtab::physics::Form::Paper, &[]).unwrap();
        let truth = ship_a();
        model.set_eleven(&truth.p);
        let theta: Vec<f64> = model.parameters.iter().map(|p| p.value).collect();
        for (u, v, r, n, delta) in [
            (5.0, 0.0, 0.0, 2.4, 0.0),
            (4.0, -0.9, 0.02, 2.6, 0.5),
            (6.0, 0.6, -0.015, 3.5, -0.3),
            (3.0, 0.3, -0.01, -2.0, 0.1),
            (-1.5, 0.4, 0.008, -2.5, 0.2),
            (1.0, 1.0, 0.01, 1.0, 0.6),
        ] {
            let state = lib::State { x: 0.0, y: 0.0, psi: 0.4, u, v, r };
            let inputs = lib::Inputs::actuators(0.0, n, delta);
            let (rates, _) = trimtab::model::dynamics::Dynamics::new(&model, theta.clone()).rates(
                &state,
                &inputs,
                &lib::Force::zero(),
            );
            let own = truth.inertia().accelerations([u, v, r], &truth.force(u, v, r, n, delta).total());
            for (i, (a, b)) in own.iter().zip(&rates[3..]).enumerate() {
                let unit = [1e-3, 1e-3, 2e-5][i];
                assert!((a - b).abs() < 0.02 * b.abs() + unit, "rate {i} at u {u} v {v} r {r}: {a} against {b}");
            }
        }
    }

    #[test]
    fn without_its_asymmetric_parameters_port_and_starboard_are_alike() {
        let mut ship = ship_a();
        for i in [0, 4, 6, 9] {
            ship.p[i] = 0.0;
        }
        for (u, v, r, n, delta) in [(5.0, 0.7, -0.01, 2.0, 0.3), (-2.0, 0.5, 0.01, -2.0, 0.2)] {
            let of = |v: f64, r: f64, delta: f64| {
                ship.inertia().accelerations([u, v, r], &ship.force(u, v, r, n, delta).total())
            };
            let (a, b) = (of(v, r, delta), of(-v, -r, -delta));
            assert!((a[0] - b[0]).abs() < 1e-14 && (a[1] + b[1]).abs() < 1e-14 && (a[2] + b[2]).abs() < 1e-16);
        }
    }

    #[test]
    fn the_rudder_curve_has_the_published_extremes() {
        let p = ship_a().p;
        let lift = |a: f64| p[4] + a * (p[5] + a * (p[6] + a * p[7]));
        assert!((lift(27.6_f64.to_radians()) - 1.001).abs() < 5e-3);
        assert!((lift(-26.0_f64.to_radians()) + 0.990).abs() < 5e-3);
        assert!(lift(47.2_f64.to_radians()).abs() < 5e-3);
    }
}
