//! The ship of a concealed case: one of three simulators with coefficients of its own, on ship A or one of two other hulls.
//! It turns velocity, inputs and a [`Tweak`] into accelerations; it simulates nothing and depends on no effect.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use super::tweak::Tweak;
use crate::conceal::family::Family;
use crate::truth::integrate::bisected_rate;
use crate::truth::motion::{Contributions, Force, Inputs, Particulars};
use crate::truth::simulator::Truth;
use crate::truth::{hd, large_drift, mmg, ships};

/// A ship of any family, with coefficients of its own.
#[derive(Debug, Clone)]
pub enum Craft {
    /// The paper's equation.
    Hd(hd::Hd),
    /// The MMG standard method.
    Mmg(mmg::Mmg),
    /// The simulator for large drift.
    LargeDrift(large_drift::LargeDrift),
}

/// Length of every craft \[m\]: similar ships at one Froude number differ in nothing but their units, so that an effect's size
/// that is real for one ship is real for all.
pub const LENGTH: f64 = 85.0;

impl Craft {
    /// The family's ship with every true coefficient off its chart: a factor exp(0.04 z); in the HD family the eleven
    /// parameters by exp(0.05 z) and the hull as in the charts. `hull_error` shifts each hull coefficient by up to that share.
    pub fn draw(family: Family, hull_error: f64, rng: &mut ChaCha8Rng) -> Self {
        let mut off = |sd: f64| {
            let z: f64 = StandardNormal.sample(rng);
            (sd * z.clamp(-2.5, 2.5)).exp()
        };
        // Propeller walk is one of the effects: without it the screw pushes along the keel only.
        let mut craft = match family {
            Family::Hd => Self::Hd(hd::ship_a()),
            Family::Mmg => Self::Mmg(ships::ship_a()),
            Family::Tanker => Self::Mmg(ships::kvlcc2_of(LENGTH)),
            Family::Flap => Self::LargeDrift(ships::ship_b().scaled(LENGTH)),
        };
        match &mut craft {
            Self::Hd(ship) => ship.p.iter_mut().for_each(|p| *p *= off(0.05)),
            Self::Mmg(ship) => ship.propeller.side_force = 0.0,
            Self::LargeDrift(ship) => ship.propeller.side_force = 0.0,
        }
        if family != Family::Hd {
            craft.uncertain().into_iter().for_each(|c| *c *= off(0.04));
        }
        if hull_error > 0.0 {
            craft.uncertain().into_iter().for_each(|c| *c *= 1.0 + rng.random_range(-hull_error..hull_error));
        }
        craft
    }

    /// The coefficients that no chart gives exactly; of the HD family those of the hull.
    fn uncertain(&mut self) -> Vec<&mut f64> {
        match self {
            Self::Hd(ship) => ship.hull.each().into(),
            Self::Mmg(ship) => ship.uncertain(),
            Self::LargeDrift(ship) => ship.uncertain(),
        }
    }

    /// Half the difference of the flow straightening between lateral inflow at the rudder from port and from starboard, as a
    /// single screw makes it; `None` where rudder and screw are polynomials, which are asymmetric themselves.
    pub fn asymmetry(&self) -> Option<f64> {
        let [port, starboard] = match self {
            Self::Hd(_) => return None,
            Self::Mmg(ship) => ship.rudder.straightening,
            Self::LargeDrift(ship) => ship.rudder.straightening,
        };
        Some(0.5 * (port - starboard))
    }

    /// The simulator of the ship, unaltered.
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
        let [u_r, v_r] = self.truth().propulsion(u, v, r, inputs.n).rudder_inflow;
        inputs.delta - v_r.atan2(u_r)
    }

    /// Accelerations through the water (u', v', r') at the velocity through the water, under `extra` (X, Y \[N\], N \[N m\]).
    pub fn accelerations(&self, water: [f64; 3], inputs: &Inputs, tweak: &Tweak, [x, y, n]: [f64; 3]) -> [f64; 3] {
        let mut extra = Force { x, y, n };
        let of = |ship: &dyn Truth| ship.force(water[0], water[1], water[2], inputs.n, inputs.delta).total();
        let (own, inertia) = match self {
            Self::Hd(ship) => {
                extra.x += tweak.resistance_hd(ship, water[0]);
                let ship = tweak.hd(ship);
                (of(&ship), ship.inertia())
            }
            Self::Mmg(ship) => {
                let (ship, inertia) = tweak.mmg(ship);
                (of(&ship), inertia)
            }
            Self::LargeDrift(ship) => {
                let (ship, inertia) = tweak.large_drift(ship);
                (of(&ship), inertia)
            }
        };
        inertia.accelerations(water, &(own + extra))
    }

    /// The force (X, Y \[N\], N \[N m\]) that gives these accelerations through the ship's own, unaltered inertia.
    pub fn inertial_force(&self, accelerations: [f64; 3]) -> [f64; 3] {
        self.truth().inertia().force(accelerations)
    }

    /// Propeller rate that keeps the speed ahead `u` \[m/s\] with the rudder amidships, at most `most` \[rps\].
    pub fn trimmed_rate(&self, u: f64, most: f64) -> f64 {
        bisected_rate(self.truth(), u, most, 40)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::motion::State;
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
            let expected = truth.derivative(&state, &inputs);
            for i in 0..3 {
                assert!((own[i] - expected[3 + i]).abs() < 1e-13, "{own:?} {expected:?}");
            }
        }
    }

    #[test]
    fn the_inertial_force_of_a_change_of_acceleration_is_the_force_that_made_it() {
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
