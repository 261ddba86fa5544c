//! The ships of the truth simulators: KVLCC2 as published, and ships A and B.
//! Ships A and B are reconstructions from public particulars of comparable Japanese coastal container ships; they are not the paper's
//! ships, whose particulars are not public.
//!
//! Sources of the regressions: hull Yoshimura & Masumoto (2012), linear part also Kijima (1990); added masses Zhou et al. (1983)
//! from the Motora charts; interaction from published collections of MMG formulas. What no formula gives is marked "assumed".

use super::large_drift::{self, LargeDrift};
use super::laws::propeller::OpenWater;
use super::laws::slipstream::{Propeller, Rudder};
use super::mmg::{self, Mmg};
use super::motion::Particulars;
use super::simulator::{AddedMass, Truth};

/// Sea water \[kg/m^3\].
pub const SEA_WATER: f64 = 1025.0;
/// Fresh water of a towing tank \[kg/m^3\].
pub const FRESH_WATER: f64 = 1000.0;

/// Which ship a data set is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ShipId {
    /// Container ship of 85 m and 1750 DWT, standard MMG ([`ship_a`]).
    A,
    /// Container ship of the 130 m class, 8000 DWT, flapped rudder ([`ship_b`]).
    B,
}

impl ShipId {
    /// Name in file names and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::A => "ship_a",
            Self::B => "ship_b",
        }
    }

    /// The truth simulator of the ship.
    pub fn truth(self) -> Box<dyn Truth> {
        match self {
            Self::A => Box::new(ship_a()),
            Self::B => Box::new(ship_b()),
        }
    }
}

/// Added masses over ship mass `(m_x/m, m_y/m)` and radius of gyration of the added yaw inertia over L (Zhou et al. 1983).
fn added_masses(p: &Particulars) -> (f64, f64, f64) {
    let (cb, lb, db) = (p.block(), p.length / p.breadth, p.draught / p.breadth);
    let surge = 0.01
        * (0.398 + 11.97 * cb * (1.0 + 3.73 * db) - 2.89 * cb * lb * (1.0 + 1.13 * db)
            + 0.175 * cb * lb * lb * (1.0 + 0.541 * db)
            - 1.107 * lb * db);
    let sway = 0.882 - 0.54 * cb * (1.0 - 1.6 * db) - 0.156 * lb * (1.0 - 0.673 * cb)
        + 0.826 * db * lb * (1.0 - 0.678 * db)
        - 0.638 * cb * db * lb * (1.0 - 0.669 * db);
    let yaw = 0.01 * (33.0 - 76.85 * cb * (1.0 - 0.784 * cb) + 3.43 * lb * (1.0 - 0.63 * cb));
    (surge, sway, yaw)
}

/// Added masses as primes, and a radius of gyration of a quarter of the length.
fn added_primes(p: &Particulars) -> AddedMass {
    let (surge, sway, yaw) = added_masses(p);
    let mass = p.volume / (0.5 * p.length * p.length * p.draught);
    AddedMass { surge: surge * mass, sway: sway * mass, yaw: yaw * yaw * mass, gyration: 0.25 }
}

/// The form parameters that the regressions are made of: Cb, k = 2 d/L and Cb B/L.
fn form(p: &Particulars) -> (f64, f64, f64) {
    let cb = p.block();
    (cb, 2.0 * p.draught / p.length, cb * p.breadth / p.length)
}

/// Linear derivatives [Y_v, Y_r, N_v, N_r] of a hull (Yoshimura & Masumoto 2012, Kijima 1990).
fn linear(p: &Particulars, surge_added: f64) -> [f64; 4] {
    let (_, k, xc) = form(p);
    [-(0.5 * std::f64::consts::PI * k + 1.4 * xc), surge_added + 0.5 * xc, -k, -0.54 * k + k * k]
}

/// A rudder behind a hull of this form: interaction from the regressions, the suction of an astern screw after Kitagawa.
fn rudder_behind(p: &Particulars, area: f64, span: f64, straightening: [f64; 2]) -> Rudder {
    let (cb, _, xc) = form(p);
    let wake_ratio = -156.2 * xc * xc + 41.6 * xc - 1.76;
    Rudder {
        area,
        span,
        deduction: 1.0 - (0.28 * cb + 0.55),
        hull_increase: 0.627 * cb - 0.153,
        hull_position: -(0.4 + 0.1 * cb),
        position: -0.5,
        inflow_position: -0.9,
        straightening,
        wake_ratio,
        race: 0.6 / wake_ratio,
        astern_race: 0.288,
        astern_loss: -0.176,
        offset: 0.0,
    }
}

/// KVLCC2 at full scale (Lpp 320 m), parameters of Yasukawa & Yoshimura (2015).
pub fn kvlcc2() -> Mmg {
    kvlcc2_at_scale(
        Particulars { length: 320.0, breadth: 58.0, draught: 20.8, volume: 312_600.0, xg: 11.2, rho: SEA_WATER },
        0.35,
    )
}

/// The 7 m model of KVLCC2 (L7), parameters of Yasukawa & Yoshimura (2015). It differs from the full scale by its wake.
///
/// Draught and x_G are the full-scale ones scaled down; the source prints them rounded to 0.46 m and 0.25 m.
pub fn kvlcc2_model() -> Mmg {
    kvlcc2_at_scale(
        Particulars { length: 7.0, breadth: 1.27, draught: 0.455, volume: 3.27, xg: 0.245, rho: FRESH_WATER },
        0.40,
    )
}

/// KVLCC2 at full scale, brought to a length \[m\] in the same water.
pub fn kvlcc2_of(length: f64) -> Mmg {
    let full = kvlcc2();
    kvlcc2_at_scale(full.particulars.scaled(length), full.propeller.wake)
}

fn kvlcc2_at_scale(particulars: Particulars, wake: f64) -> Mmg {
    let scale = particulars.length / 320.0;
    Mmg {
        particulars,
        added: AddedMass { surge: 0.022, sway: 0.223, yaw: 0.011, gyration: 0.25 },
        hull: mmg::Hull {
            r0: 0.022,
            // Astern half as much again, as measured for Esso Osaka; the standard method has no value.
            r0_astern: 0.033,
            r0_froude4: 0.0,
            xvv: -0.040,
            xvr: 0.002,
            xrr: 0.011,
            xvvvv: 0.771,
            yv: -0.315,
            yr: 0.083,
            yvvv: -1.607,
            yvvr: 0.379,
            yvrr: -0.391,
            yrrr: 0.008,
            nv: -0.137,
            nr: -0.049,
            nvvv: -0.030,
            nvvr: -0.294,
            nvrr: 0.055,
            nrrr: -0.013,
            // Hoerner at B/2d = 1.39.
            cross_flow_drag: 0.74,
        },
        propeller: Propeller {
            diameter: 9.86 * scale,
            open_water: OpenWater::Quadratic { k0: 0.2931, k1: -0.2753, k2: -0.1385, pitch_ratio: 0.721 },
            thrust_factor: 1.0,
            thrust_deduction: 0.220,
            wake,
            position: -0.48,
            side_force: 0.10,
        },
        wake_c1: 2.0,
        wake_c2: [1.6, 1.1],
        side_force_range: 0.35,
        blade: mmg::Blade { normal_gradient: 2.747, stalled_gradient: 1.3, reversed_factor: 0.7 },
        rudder: Rudder {
            area: 112.5 * scale * scale,
            span: 15.8 * scale,
            deduction: 0.387,
            hull_increase: 0.312,
            hull_position: -0.464,
            position: -0.5,
            inflow_position: -0.710,
            straightening: [0.395, 0.640],
            wake_ratio: 1.09,
            race: 0.50,
            astern_race: 0.288,
            astern_loss: -0.176,
            offset: 0.0,
        },
    }
}

/// Ship A (reconstruction): coastal container ship, 85 m, 1750 DWT, about 195 TEU, single right-handed screw.
pub fn ship_a() -> Mmg {
    let p = Particulars { length: 85.0, breadth: 13.5, draught: 4.2, volume: 3277.0, xg: 0.0, rho: SEA_WATER };
    let added = added_primes(&p);
    let ((cb, _, xc), lb) = (form(&p), p.length / p.breadth);
    let slender = (1.0 - cb) * lb;
    let [yv, yr, nv, nr] = linear(&p, added.surge);
    let aspect = 1.6;
    // Two published regressions of gamma, one for each side: the sides differ less than those of KVLCC2.
    let straightening = [2.06 * xc + 0.14, -22.2 * xc * xc + 0.02 * xc + 0.68];
    Mmg {
        particulars: p,
        added,
        hull: mmg::Hull {
            // Assumed: brings 249 rpm to 8.2 m/s and 95 rpm to 3.2 m/s, and rises with wave resistance above Fn 0.2.
            r0: 0.0118,
            r0_astern: 0.0177,
            r0_froude4: 12.0,
            // Yoshimura & Masumoto; theirs contains m_y', because their surge equation carries m v r alone.
            xvv: 1.15 * xc - 0.18,
            xvr: -1.91 * xc + 0.08,
            xrr: -0.085 * xc + 0.008,
            xvvvv: -6.68 * xc + 1.1,
            yv,
            yr,
            yvvv: -0.185 * lb + 0.48,
            yvvr: -0.75,
            yvrr: -(0.26 * slender + 0.11),
            yrrr: -0.051,
            nv,
            nr,
            nvvv: -(0.66 - 0.69 * cb),
            nvvr: 1.55 * xc - 0.76,
            // Published for KCS. The regression gives -0.25, with which the steady circle shrinks to 1.2 L.
            nvrr: -0.0512,
            nrrr: 0.25 * xc - 0.056,
            // Hoerner at B/2d = 1.61.
            cross_flow_drag: 0.70,
        },
        propeller: Propeller {
            diameter: 2.85,
            open_water: OpenWater::B470Pitch08,
            thrust_factor: 1.0,
            thrust_deduction: 0.19,
            wake: 0.28,
            position: -0.48,
            side_force: 0.10,
        },
        // Assumed; C2 - 1 scaled down from KVLCC2 with the wake fraction.
        wake_c1: 2.0,
        wake_c2: [1.35, 1.10],
        side_force_range: 0.35,
        rudder: rudder_behind(&p, 7.9, 3.56, straightening),
        blade: mmg::Blade {
            normal_gradient: 6.13 * aspect / (aspect + 2.25),
            stalled_gradient: 1.3,
            reversed_factor: 0.7,
        },
    }
}

/// Ship B (reconstruction): container ship of the 130 m class, 8000 DWT, about 700 TEU, flapped rudder, single right-handed screw.
///
/// Its screw is smaller than that of a real ship of this size, as the paper's resistance curve and rpm range imply.
pub fn ship_b() -> LargeDrift {
    let p = Particulars { length: 123.0, breadth: 20.0, draught: 7.3, volume: 12_571.0, xg: 0.0, rho: SEA_WATER };
    let added = added_primes(&p);
    let [yv, yr, nv, nr] = linear(&p, added.surge);
    LargeDrift {
        particulars: p,
        added,
        hull: large_drift::Hull {
            // Assumed: brings 170 rpm to 6.2 m/s and 93 rpm to 3.6 m/s.
            r0: 0.0060,
            r0_astern: 0.0090,
            // Hasegawa: X_vr = (c_m - 1) m_y, c_m = 1.75 Cb - 0.525.
            xvr: (1.75 * p.block() - 1.525) * added.sway,
            yv,
            yr,
            nv,
            nr,
            // Hoerner at B/2d = 1.37, with the yaw rate at its plain weight: the strips of a slender container ship. (Esso Osaka,
            // a full tanker, was measured at C_D 0.97, C_rY 2.2, C_rN 0.81.)
            cross_flow_drag: 0.75,
            yaw_in_force: 1.0,
            yaw_in_moment: 1.0,
        },
        propeller: Propeller {
            diameter: 3.2,
            open_water: OpenWater::B470Pitch08,
            thrust_factor: 1.0,
            thrust_deduction: 0.20,
            wake: 0.30,
            position: -0.48,
            // Half of Esso Osaka's: the scaling of the law with L d to another ship is an extrapolation.
            side_force: 0.5,
        },
        wake_decay: 4.0,
        rudder: rudder_behind(&p, 19.7, 5.6, [0.40; 2]),
        blade: large_drift::Blade { aspect: 1.6, flap: 0.40, gain: 1.0 },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::integrate::trimmed_rate;

    #[test]
    fn added_masses_of_kvlcc2_are_near_the_published_ones() {
        let AddedMass { surge: mx, sway: my, yaw: jz, .. } = added_primes(&kvlcc2().particulars);
        assert!(
            (mx - 0.0231).abs() < 2e-4 && (my - 0.2243).abs() < 1e-3 && (jz - 0.0112).abs() < 1e-4,
            "{mx} {my} {jz}"
        );
    }

    #[test]
    fn masses_are_those_of_the_reconstruction() {
        for (mass, expected) in [(ship_a().particulars.mass(), 3.359e6), (ship_b().particulars.mass(), 1.288e7)] {
            assert!((mass / expected - 1.0).abs() < 1e-3, "{mass}");
        }
    }

    #[test]
    fn propeller_rates_at_speed_are_near_those_of_the_paper() {
        let (a, b) = (ship_a(), ship_b());
        for (truth, u, rpm) in [(&a as &dyn Truth, 8.23, 249.0), (&a, 3.27, 95.0), (&b, 6.17, 170.0), (&b, 3.83, 93.0)]
        {
            let found = 60.0 * trimmed_rate(truth, u, 6.0);
            assert!((found / rpm - 1.0).abs() < 0.12, "{u} m/s at {found} rpm instead of {rpm}");
        }
    }
}
