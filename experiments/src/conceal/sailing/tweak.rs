//! Alterations of a ship at one instant, and what each means in the coefficients of the three simulators.
//! An effect sets them without knowing which simulator it acts on; forces and sensors are not altered here.

use crate::truth::hd::Hd;
use crate::truth::large_drift::LargeDrift;
use crate::truth::laws::slipstream::{Propeller, Rudder};
use crate::truth::mmg::Mmg;
use crate::truth::motion::Particulars;
use crate::truth::simulator::{AddedMass, Inertia};

/// What an effect changes in the ship at one instant. Neutral: factors 1, additions 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tweak {
    /// Added to the wake fraction.
    pub wake: f64,
    /// Factor on the propeller thrust.
    pub thrust: f64,
    /// Factor on the race factor kappa.
    pub race: f64,
    /// Factor on the rudder force.
    pub rudder: f64,
    /// Added to the rudder angle \[rad\].
    pub rudder_angle: f64,
    /// Factor on the hull resistance.
    pub resistance: f64,
    /// Factors on Y_v, Y_r, N_v, N_r.
    pub linear: [f64; 4],
    /// Factors on the nonlinear groups: Y of drift, Y of drift with turn, N of drift with turn, N of turn.
    pub nonlinear: [f64; 4],
    /// Factors on the added masses of surge, sway and yaw.
    pub added: [f64; 3],
    /// Factor on mass and yaw inertia.
    pub mass: f64,
    /// Shift of the centre of gravity, forward \[m\].
    pub xg: f64,
    /// Share of the fore-aft consistent hull terms (HD family only).
    pub sternway: f64,
}

impl Tweak {
    /// No change.
    pub const NEUTRAL: Self = Self {
        wake: 0.0,
        thrust: 1.0,
        race: 1.0,
        rudder: 1.0,
        rudder_angle: 0.0,
        resistance: 1.0,
        linear: [1.0; 4],
        nonlinear: [1.0; 4],
        added: [1.0; 3],
        mass: 1.0,
        xg: 0.0,
        sternway: 0.0,
    };

    /// The altered HD ship; its resistance is altered by [`Tweak::resistance_hd`].
    pub fn hd(&self, ship: &Hd) -> Hd {
        let mut s = ship.clone();
        s.propeller.wake += self.wake;
        s.propeller.thrust_factor *= self.thrust;
        s.rudder.race *= self.race;
        s.rudder.gain *= self.rudder;
        s.rudder.offset += self.rudder_angle;
        s.sternway += self.sternway;
        s.mass *= self.mass;
        s.yaw_inertia *= self.mass;
        s.xg += self.xg;
        let (h, [lyv, lyr, lnv, lnr], [y, yr, n, nr]) = (&mut s.hull, self.linear, self.nonlinear);
        let [surge, sway, yaw] = self.added;
        h.xud *= surge;
        multiply([&mut h.yvd, &mut h.yrd, &mut h.nvd], sway);
        h.nrd *= yaw;
        h.yv *= lyv;
        h.yr *= lyr;
        h.nv *= lnv;
        h.nr *= lnr;
        h.yvv *= y;
        multiply([&mut h.yvr, &mut h.yrr], yr);
        multiply([&mut h.nvvr, &mut h.nrrv], n);
        h.nrr *= nr;
        s
    }

    /// Surge force \[N\] of the altered resistance of an HD ship at speed `u` \[m/s\]; 0 without a change.
    pub fn resistance_hd(&self, ship: &Hd, u: f64) -> f64 {
        let p = &ship.p;
        if self.resistance == 1.0 {
            0.0
        } else {
            -(self.resistance - 1.0) * (p[1] * u + p[2] * u * u.abs() + p[3] * u * u * u)
        }
    }

    /// The altered MMG ship, and its inertia.
    pub fn mmg(&self, ship: &Mmg) -> (Mmg, Inertia) {
        let mut s = ship.clone();
        self.propulsion(&mut s.propeller, &mut s.rudder, &mut s.added);
        multiply([&mut s.blade.normal_gradient, &mut s.blade.stalled_gradient], self.rudder);
        let h = &mut s.hull;
        multiply([&mut h.r0, &mut h.r0_astern], self.resistance);
        self.linear([&mut h.yv, &mut h.yr, &mut h.nv, &mut h.nr]);
        let [y, yr, n, nr] = self.nonlinear;
        multiply([&mut h.yvvv, &mut h.cross_flow_drag], y);
        multiply([&mut h.yvvr, &mut h.yvrr, &mut h.yrrr], yr);
        multiply([&mut h.nvvr, &mut h.nvrr], n);
        h.nrrr *= nr;
        let inertia = self.inertia(&s.particulars, &s.added);
        (s, inertia)
    }

    /// The altered ship at large drift, and its inertia. Strips are its only nonlinearity: their drag takes the factor of the
    /// sway force of drift.
    pub fn large_drift(&self, ship: &LargeDrift) -> (LargeDrift, Inertia) {
        let mut s = ship.clone();
        self.propulsion(&mut s.propeller, &mut s.rudder, &mut s.added);
        s.blade.gain *= self.rudder;
        let h = &mut s.hull;
        multiply([&mut h.r0, &mut h.r0_astern], self.resistance);
        self.linear([&mut h.yv, &mut h.yr, &mut h.nv, &mut h.nr]);
        h.cross_flow_drag *= self.nonlinear[0];
        let inertia = self.inertia(&s.particulars, &s.added);
        (s, inertia)
    }

    fn propulsion(&self, propeller: &mut Propeller, rudder: &mut Rudder, added: &mut AddedMass) {
        propeller.wake += self.wake;
        propeller.thrust_factor *= self.thrust;
        rudder.race *= self.race;
        rudder.offset += self.rudder_angle;
        let [surge, sway, yaw, _] = added.each();
        for (mass, factor) in [surge, sway, yaw].into_iter().zip(self.added) {
            *mass *= factor;
        }
    }

    fn linear(&self, coefficients: [&mut f64; 4]) {
        for (coefficient, factor) in coefficients.into_iter().zip(self.linear) {
            *coefficient *= factor;
        }
    }

    /// The inertia with altered mass and centre of gravity, which the simulators take from their particulars.
    fn inertia(&self, p: &Particulars, added: &AddedMass) -> Inertia {
        let mass = p.mass() * self.mass;
        let xg = p.xg + self.xg;
        let radius = added.gyration * p.length;
        let yaw = mass * (radius * radius + xg * xg) + added.yaw * p.force_scale() * p.length.powi(3);
        let scale = p.force_scale() * p.length;
        Inertia::new(mass, xg, [added.surge * scale, added.sway * scale], yaw)
    }
}

fn multiply<const N: usize>(coefficients: [&mut f64; N], factor: f64) {
    coefficients.into_iter().for_each(|c| *c *= factor);
}
