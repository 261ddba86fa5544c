//! The ships behind one set of alterations, two families on ship A and two other hulls: what an effect may change in a ship without
//! knowing which she is.
//! It sails nothing and knows no effect; it turns a state, inputs and a [`Tweak`] into accelerations.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use serde::{Deserialize, Serialize};

use crate::truth::{Contributions, Inputs, Particulars, Truth, hd, large_drift, mmg, ships};

/// Which equations stand behind a data set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Family {
    /// The paper's HD equation, the family that is fitted.
    Hd,
    /// The MMG standard method with a four-quadrant propeller and a large-drift hull: another family than the fitted one.
    Mmg,
    /// Another hull: a full tanker, KVLCC2's form with her published MMG parameters, brought to ship A's length.
    Tanker,
    /// Another hull and another simulator: ship B, flapped rudder and strips at large drift, brought to ship A's length.
    Flap,
}

impl Family {
    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Hd => "hd",
            Self::Mmg => "mmg",
            Self::Tanker => "tanker",
            Self::Flap => "flap",
        }
    }

    /// Factor on the speeds of the programme: a tanker is slower than a coaster of her length at the same rate of the screw.
    pub fn pace(self) -> f64 {
        match self {
            Self::Hd | Self::Mmg => 1.0,
            Self::Tanker => 0.6,
            Self::Flap => 0.75,
        }
    }

    /// Mechanisms that describe the family itself against the fitted model, whatever is concealed beside them: to name one of
    /// these is no false alarm. None are environment, external force or sensor.
    pub fn structure(self) -> &'static [&'static str] {
        match self {
            Self::Hd => &[],
            Self::Mmg | Self::Tanker | Self::Flap => &[
                "crossflow",
                "hull_nonlinear",
                "munk",
                "sternway",
                "wake_drift",
                "race",
                "rudder_stall",
                "symmetric",
                "asymmetric",
            ],
        }
    }
}

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
}

/// A ship of either family, with coefficients of her own.
#[derive(Debug, Clone)]
pub enum Craft {
    /// The paper's equation.
    Hd(hd::Hd),
    /// The MMG standard method.
    Mmg(mmg::Mmg),
    /// The simulator for large drift.
    LargeDrift(large_drift::LargeDrift),
}

/// Length of every craft \[m\]: similar ships at one Froude number differ in nothing but their units, so that sizes of effects
/// that are real for one are real for all.
pub const LENGTH: f64 = 85.0;

impl Craft {
    /// The family's ship with every true coefficient off its chart: a factor exp(0.04 z); in the HD family the eleven
    /// parameters by exp(0.05 z) and the hull as in the charts. `hull_error` shifts each hull coefficient by up to that share.
    pub fn draw(family: Family, hull_error: f64, rng: &mut ChaCha8Rng) -> Self {
        let mut off = |sd: f64| {
            let z: f64 = StandardNormal.sample(rng);
            (sd * z.clamp(-2.5, 2.5)).exp()
        };
        let mut craft = match family {
            Family::Hd => {
                let mut ship = hd::ship_a();
                ship.p.iter_mut().for_each(|p| *p *= off(0.05));
                Self::Hd(ship)
            }
            Family::Mmg | Family::Tanker => {
                let mut ship = match family {
                    Family::Tanker => ships::kvlcc2_of(LENGTH),
                    _ => ships::ship_a(),
                };
                // Propeller walk is one of the effects: without it the screw pushes along the keel only.
                ship.propeller.side_force = 0.0;
                for c in coefficients(&mut ship) {
                    *c *= off(0.04);
                }
                Self::Mmg(ship)
            }
            Family::Flap => {
                let mut ship = ships::ship_b().scaled(LENGTH);
                ship.propeller.side_force = 0.0;
                for c in large_drift_coefficients(&mut ship) {
                    *c *= off(0.04);
                }
                Self::LargeDrift(ship)
            }
        };
        if hull_error > 0.0 {
            let mut shift = |c: &mut f64| *c *= 1.0 + rng.random_range(-hull_error..hull_error);
            match &mut craft {
                Self::Hd(ship) => ship.hull.each().into_iter().for_each(&mut shift),
                Self::Mmg(ship) => coefficients(ship).into_iter().for_each(&mut shift),
                Self::LargeDrift(ship) => large_drift_coefficients(ship).into_iter().for_each(&mut shift),
            }
        }
        craft
    }

    /// Half the difference of the flow straightening between lateral inflow at the rudder from port and from starboard, what her
    /// single screw makes of it; `None` where rudder and screw are polynomials, lopsided in themselves.
    pub fn asymmetry(&self) -> Option<f64> {
        let [port, starboard] = match self {
            Self::Hd(_) => return None,
            Self::Mmg(ship) => ship.rudder.straightening,
            Self::LargeDrift(ship) => ship.rudder.straightening,
        };
        Some(0.5 * (port - starboard))
    }

    /// The simulator behind her, unaltered.
    fn truth(&self) -> &dyn Truth {
        match self {
            Self::Hd(ship) => ship,
            Self::Mmg(ship) => ship,
            Self::LargeDrift(ship) => ship,
        }
    }

    /// Main particulars.
    pub fn particulars(&self) -> &Particulars {
        self.truth().particulars()
    }

    /// Propeller diameter D \[m\], and wake fraction on a straight course.
    pub fn propeller(&self) -> (f64, f64) {
        match self {
            Self::Hd(ship) => (ship.propeller.diameter, ship.propeller.wake),
            Self::Mmg(ship) => (ship.propeller.diameter, ship.propeller.wake),
            Self::LargeDrift(ship) => (ship.propeller.diameter, ship.propeller.wake),
        }
    }

    /// Forces by origin at velocity through the water.
    pub fn force(&self, [u, v, r]: [f64; 3], inputs: &Inputs) -> Contributions {
        self.truth().force(u, v, r, inputs.n, inputs.delta)
    }

    /// Angle of attack of the rudder \[rad\].
    pub fn attack(&self, [u, v, r]: [f64; 3], inputs: &Inputs) -> f64 {
        let (u_r, v_r) = match self {
            Self::Hd(ship) => {
                let (va, thrust) = ship.thrust(u, inputs.n);
                ship.rudder_inflow(v, r, va, thrust)
            }
            Self::Mmg(ship) => {
                let (va, p) = (ship.propeller_inflow(u, v, r), &ship.propeller);
                let thrust = p.thrust_factor * p.open_water.thrust(inputs.n, va, p.diameter, ship.particulars.rho);
                ship.rudder_inflow(u, v, r, inputs.n, thrust, va)
            }
            Self::LargeDrift(ship) => {
                let (va, p) = (ship.propeller_inflow(u, v, r), &ship.propeller);
                let thrust = p.thrust_factor * p.open_water.thrust(inputs.n, va, p.diameter, ship.particulars.rho);
                ship.rudder_inflow(u, v, r, inputs.n, thrust, va)
            }
        };
        inputs.delta - v_r.atan2(u_r)
    }

    /// Accelerations through the water (u', v', r') at the velocity through the water, under `extra` (X, Y \[N\], N \[N m\]).
    pub fn accelerations(&self, water: [f64; 3], inputs: &Inputs, tweak: &Tweak, extra: [f64; 3]) -> [f64; 3] {
        match self {
            Self::Hd(ship) => {
                let ship = tweak_hd(ship, tweak);
                let [u, v, r] = water;
                let mut extra = extra;
                if tweak.resistance != 1.0 {
                    let p = &ship.p;
                    extra[0] -= (tweak.resistance - 1.0) * (p[1] * u + p[2] * u * u.abs() + p[3] * u * u * u);
                }
                ship.accelerations(u, v, r, inputs.n, inputs.delta, extra)
            }
            Self::Mmg(ship) => {
                let ship = tweak_mmg(ship, tweak);
                truth_accelerations(&ship, [ship.gyration, ship.yaw_added], water, inputs, tweak, extra)
            }
            Self::LargeDrift(ship) => {
                let ship = tweak_large_drift(ship, tweak);
                truth_accelerations(&ship, [ship.gyration, ship.yaw_added], water, inputs, tweak, extra)
            }
        }
    }

    /// The force (X, Y \[N\], N \[N m\]) that gives these accelerations through the ship's own, unaltered inertia.
    pub fn inertial_force(&self, [du, dv, dr]: [f64; 3]) -> [f64; 3] {
        if let Self::Hd(ship) = self {
            let (surge, [[a, b], [c, d]]) = ship.masses();
            return [surge * du, a * dv + b * dr, c * dv + d * dr];
        }
        let i = self.truth().inertia();
        let mxg = i.mass * i.xg;
        [(i.mass + i.surge_added) * du, (i.mass + i.sway_added) * dv + mxg * dr, mxg * dv + i.yaw * dr]
    }

    /// Propeller rate that holds the speed ahead `u` \[m/s\] with the rudder amidships, at most `most` \[rps\].
    pub fn trimmed_rate(&self, u: f64, most: f64) -> f64 {
        let (mut low, mut high) = (0.0, most);
        for _ in 0..40 {
            let n = 0.5 * (low + high);
            if self.force([u, 0.0, 0.0], &Inputs { n, delta: 0.0 }).total().x > 0.0 {
                high = n;
            } else {
                low = n;
            }
        }
        0.5 * (low + high)
    }
}

/// The coefficients of an MMG ship that no chart gives exactly.
fn coefficients(ship: &mut mmg::Mmg) -> Vec<&mut f64> {
    let (h, p, q) = (&mut ship.hull, &mut ship.propeller, &mut ship.rudder);
    let [left, right] = &mut q.straightening;
    vec![
        &mut ship.surge_added,
        &mut ship.sway_added,
        &mut ship.yaw_added,
        &mut ship.gyration,
        &mut h.r0,
        &mut h.r0_astern,
        &mut h.r0_froude4,
        &mut h.xvv,
        &mut h.xvr,
        &mut h.xrr,
        &mut h.xvvvv,
        &mut h.yv,
        &mut h.yr,
        &mut h.yvvv,
        &mut h.yvvr,
        &mut h.yvrr,
        &mut h.yrrr,
        &mut h.nv,
        &mut h.nr,
        &mut h.nvvv,
        &mut h.nvvr,
        &mut h.nvrr,
        &mut h.nrrr,
        &mut h.cross_flow_drag,
        &mut p.thrust_factor,
        &mut p.thrust_deduction,
        &mut p.wake,
        &mut p.wake_c1,
        &mut q.normal_gradient,
        &mut q.deduction,
        &mut q.hull_increase,
        &mut q.hull_position,
        &mut q.inflow_position,
        left,
        right,
        &mut q.wake_ratio,
        &mut q.race,
        &mut q.astern_race,
    ]
}

/// The coefficients of a ship at large drift that no chart gives exactly.
fn large_drift_coefficients(ship: &mut large_drift::LargeDrift) -> Vec<&mut f64> {
    let (h, p, q) = (&mut ship.hull, &mut ship.propeller, &mut ship.rudder);
    let [left, right] = &mut q.straightening;
    vec![
        &mut ship.surge_added,
        &mut ship.sway_added,
        &mut ship.yaw_added,
        &mut ship.gyration,
        &mut h.r0,
        &mut h.r0_astern,
        &mut h.xvr,
        &mut h.yv,
        &mut h.yr,
        &mut h.nv,
        &mut h.nr,
        &mut h.cross_flow_drag,
        &mut h.yaw_in_force,
        &mut h.yaw_in_moment,
        &mut p.thrust_factor,
        &mut p.thrust_deduction,
        &mut p.wake,
        &mut p.wake_decay,
        &mut q.flap,
        &mut q.gain,
        &mut q.deduction,
        &mut q.hull_increase,
        &mut q.hull_position,
        &mut q.inflow_position,
        left,
        right,
        &mut q.wake_ratio,
        &mut q.race,
        &mut q.astern_race,
    ]
}

fn tweak_hd(ship: &hd::Hd, t: &Tweak) -> hd::Hd {
    let mut s = ship.clone();
    s.propeller.wake += t.wake;
    s.propeller.thrust_factor *= t.thrust;
    s.rudder.race *= t.race;
    s.rudder.gain *= t.rudder;
    s.rudder.offset += t.rudder_angle;
    s.sternway += t.sternway;
    s.mass *= t.mass;
    s.yaw_inertia *= t.mass;
    s.xg += t.xg;
    let h = &mut s.hull;
    let pairs = [
        (&mut h.xud, t.added[0]),
        (&mut h.yvd, t.added[1]),
        (&mut h.yrd, t.added[1]),
        (&mut h.nvd, t.added[1]),
        (&mut h.nrd, t.added[2]),
        (&mut h.yv, t.linear[0]),
        (&mut h.yr, t.linear[1]),
        (&mut h.nv, t.linear[2]),
        (&mut h.nr, t.linear[3]),
        (&mut h.yvv, t.nonlinear[0]),
        (&mut h.yvr, t.nonlinear[1]),
        (&mut h.yrr, t.nonlinear[1]),
        (&mut h.nvvr, t.nonlinear[2]),
        (&mut h.nrrv, t.nonlinear[2]),
        (&mut h.nrr, t.nonlinear[3]),
    ];
    for (coefficient, factor) in pairs {
        *coefficient *= factor;
    }
    s
}

fn tweak_mmg(ship: &mmg::Mmg, t: &Tweak) -> mmg::Mmg {
    let mut s = ship.clone();
    s.propeller.wake += t.wake;
    s.propeller.thrust_factor *= t.thrust;
    s.rudder.race *= t.race;
    s.rudder.normal_gradient *= t.rudder;
    s.rudder.stalled_gradient *= t.rudder;
    s.rudder.offset += t.rudder_angle;
    s.surge_added *= t.added[0];
    s.sway_added *= t.added[1];
    s.yaw_added *= t.added[2];
    let h = &mut s.hull;
    let pairs = [
        (&mut h.r0, t.resistance),
        (&mut h.r0_astern, t.resistance),
        (&mut h.yv, t.linear[0]),
        (&mut h.yr, t.linear[1]),
        (&mut h.nv, t.linear[2]),
        (&mut h.nr, t.linear[3]),
        (&mut h.yvvv, t.nonlinear[0]),
        (&mut h.cross_flow_drag, t.nonlinear[0]),
        (&mut h.yvvr, t.nonlinear[1]),
        (&mut h.yvrr, t.nonlinear[1]),
        (&mut h.yrrr, t.nonlinear[1]),
        (&mut h.nvvr, t.nonlinear[2]),
        (&mut h.nvrr, t.nonlinear[2]),
        (&mut h.nrrr, t.nonlinear[3]),
    ];
    for (coefficient, factor) in pairs {
        *coefficient *= factor;
    }
    s
}

fn tweak_large_drift(ship: &large_drift::LargeDrift, t: &Tweak) -> large_drift::LargeDrift {
    let mut s = ship.clone();
    s.propeller.wake += t.wake;
    s.propeller.thrust_factor *= t.thrust;
    s.rudder.race *= t.race;
    s.rudder.gain *= t.rudder;
    s.rudder.offset += t.rudder_angle;
    s.surge_added *= t.added[0];
    s.sway_added *= t.added[1];
    s.yaw_added *= t.added[2];
    let h = &mut s.hull;
    // Strips are all the nonlinearity there is: their drag takes the factor of the sway force.
    let pairs = [
        (&mut h.r0, t.resistance),
        (&mut h.r0_astern, t.resistance),
        (&mut h.yv, t.linear[0]),
        (&mut h.yr, t.linear[1]),
        (&mut h.nv, t.linear[2]),
        (&mut h.nr, t.linear[3]),
        (&mut h.cross_flow_drag, t.nonlinear[0]),
    ];
    for (coefficient, factor) in pairs {
        *coefficient *= factor;
    }
    s
}

/// (m + m_x) u' = X + (m + m_y) v r + m x_G r^2 and so on; `tweak` still holds mass and centre of gravity, which the
/// simulator takes from its particulars. `[k_zz / L, J_z']` are what its yaw inertia is made of.
fn truth_accelerations(
    ship: &dyn Truth,
    [gyration, yaw_added]: [f64; 2],
    [u, v, r]: [f64; 3],
    inputs: &Inputs,
    tweak: &Tweak,
    extra: [f64; 3],
) -> [f64; 3] {
    let own = ship.force(u, v, r, inputs.n, inputs.delta).total();
    let i = ship.inertia();
    let p = ship.particulars();
    let mass = i.mass * tweak.mass;
    let xg = i.xg + tweak.xg;
    let radius = gyration * p.length;
    let yaw = mass * (radius * radius + xg * xg) + yaw_added * p.force_scale() * p.length.powi(3);
    let (surge, sway, mxg) = (mass + i.surge_added, mass + i.sway_added, mass * xg);
    let du = (own.x + extra[0] + sway * v * r + mxg * r * r) / surge;
    let y = own.y + extra[1] - surge * u * r;
    let n = own.n + extra[2] - mxg * u * r;
    let det = sway * yaw - mxg * mxg;
    [du, (yaw * y - mxg * n) / det, (sway * n - mxg * y) / det]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::{Environment, State};
    use rand::SeedableRng;

    #[test]
    fn neutral_craft_accelerates_like_the_simulator_behind_it() {
        let (state, inputs) = (State { u: 4.0, v: -0.6, r: 0.012, ..State::default() }, Inputs { n: 2.2, delta: 0.3 });
        for (craft, truth) in [
            (Craft::Hd(hd::ship_a()), Box::new(hd::ship_a()) as Box<dyn Truth>),
            (Craft::Mmg(ships::ship_a()), Box::new(ships::ship_a())),
            (Craft::LargeDrift(ships::ship_b()), Box::new(ships::ship_b())),
        ] {
            let own = craft.accelerations([state.u, state.v, state.r], &inputs, &Tweak::NEUTRAL, [0.0; 3]);
            let expected = truth.derivative(0.0, &state, &inputs, &Environment::default());
            for i in 0..3 {
                assert!((own[i] - expected[3 + i]).abs() < 1e-13, "{own:?} {expected:?}");
            }
        }
    }

    #[test]
    fn inertia_undoes_what_a_force_does() {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        for family in [Family::Hd, Family::Mmg, Family::Tanker, Family::Flap] {
            let craft = Craft::draw(family, 0.1, &mut rng);
            assert_eq!(craft.particulars().length, LENGTH);
            let (water, inputs, push) = ([3.0, 0.4, -0.01], Inputs { n: 1.5, delta: 0.1 }, [1e4, -2e4, 3e5]);
            let calm = craft.accelerations(water, &inputs, &Tweak::NEUTRAL, [0.0; 3]);
            let pushed = craft.accelerations(water, &inputs, &Tweak::NEUTRAL, push);
            let force = craft.inertial_force(std::array::from_fn(|i| pushed[i] - calm[i]));
            for i in 0..3 {
                assert!((force[i] - push[i]).abs() < 1e-6 * push[i].abs(), "{force:?}");
            }
        }
    }

    #[test]
    fn no_two_seeds_give_the_same_ship_and_one_seed_gives_one() {
        let draw = |seed| Craft::draw(Family::Mmg, 0.0, &mut ChaCha8Rng::seed_from_u64(seed));
        let speed = |craft: &Craft| craft.trimmed_rate(5.0, 6.0);
        assert_eq!(speed(&draw(1)), speed(&draw(1)));
        assert_ne!(speed(&draw(1)), speed(&draw(2)));
    }
}
