//! Effects of screw, engine, rudder and steering gear: walk, wake, race, lags, stall, offsets, limits.
//! The orders are recorded; the positions of delayed or limited actuators are not.

use std::f64::consts::PI;

use super::effect::{Class, Compare, Draw, Entry, FORCE, Instant, Physics, ramp};
use crate::conceal::sailing::tweak::Tweak;
use crate::truth::motion::{Inputs, State};

/// Side force of the screw, right-handed: astern to port at the stern.
struct Walk {
    size: f64,
    /// J_0 of the astern law; none for the ahead law.
    range: Option<f64>,
}

impl Physics for Walk {
    /// Astern: Y = -s |X_P| exp(-(J/J_0)^2) (after Hachii's measurements). Ahead: Y = s X_P. N = -0.48 L Y.
    fn force(&self, at: &Instant<'_>) -> [f64; 3] {
        let n = at.inputs.n;
        let thrust = at.craft.force(at.water, &at.inputs).propeller.x;
        let y = match self.range {
            Some(range) if n < 0.0 => {
                let (diameter, _) = at.craft.propeller();
                let j = at.water[0] / (n * diameter) / range;
                -self.size * thrust.abs() * (-j * j).exp()
            }
            None if n > 0.0 => self.size * thrust,
            _ => 0.0,
        };
        [0.0, y, -0.48 * at.craft.particulars().length * y]
    }
}

fn walk_astern(size: f64, d: &mut Draw<'_>) -> Box<dyn Physics> {
    Box::new(Walk { size, range: Some(d.between(0.3, 0.4)) })
}

fn walk_ahead(size: f64, _d: &mut Draw<'_>) -> Box<dyn Physics> {
    Box::new(Walk { size, range: None })
}

/// The wake fades with the drift angle at the screw: w = w_0 (1 - s (1 - exp(-4 beta_P^2))), ahead.
struct WakeInDrift(f64);

impl Physics for WakeInDrift {
    fn alter(&self, at: &Instant<'_>, tweak: &mut Tweak) {
        let [u, v, r] = at.water;
        if u <= 0.0 {
            return;
        }
        let (_, wake) = at.craft.propeller();
        let beta = (-(v - 0.48 * at.craft.particulars().length * r)).atan2(u);
        tweak.wake -= self.0 * wake * (1.0 - (-4.0 * beta * beta).exp()) * ramp(u, 0.0, 0.5);
    }
}

/// A loss of part of the thrust.
struct ThrustLoss(f64);

impl Physics for ThrustLoss {
    fn alter(&self, _at: &Instant<'_>, tweak: &mut Tweak) {
        tweak.thrust *= 1.0 - self.0;
    }
}

/// A race that is stronger or weaker than by kappa.
struct Race(f64);

impl Physics for Race {
    fn alter(&self, _at: &Instant<'_>, tweak: &mut Tweak) {
        tweak.race *= 1.0 + self.0;
    }
}

/// Zero offset of the rudder \[rad\].
struct Offset(f64);

impl Physics for Offset {
    fn alter(&self, _at: &Instant<'_>, tweak: &mut Tweak) {
        tweak.rudder_angle += self.0;
    }
}

/// Rudder force drops by a share once the angle of attack passes an onset, within 4 deg; the fitter loses lift linearly.
struct Stall {
    drop: f64,
    onset: f64,
}

impl Physics for Stall {
    fn alter(&self, at: &Instant<'_>, tweak: &mut Tweak) {
        let attack = at.craft.attack(at.water, &at.inputs).abs();
        tweak.rudder *= 1.0 - self.drop * ramp(attack, self.onset, self.onset + 4.0 * PI / 180.0);
    }
}

/// A first-order lag behind an order that runs linearly: exact over a step.
fn lagged(tau: f64, h: f64, from: f64, to: f64, at: f64) -> f64 {
    if tau <= 0.0 {
        return to;
    }
    let slope = (to - from) / h;
    to - slope * tau + (at - from + slope * tau) * (-h / tau).exp()
}

/// Lag of the steering gear \[s\] on top of the recorded order.
struct RudderLag(f64);

impl Physics for RudderLag {
    fn actuate(&self, h: f64, orders: [Inputs; 2], at: &Inputs, _state: &State, actual: &mut Inputs) {
        actual.delta = lagged(self.0, h, orders[0].delta, orders[1].delta, at.delta);
    }
}

/// Constant-rate steering gear; the size is the inverse rate \[s/rad\].
struct RateLimit(f64);

impl Physics for RateLimit {
    fn actuate(&self, h: f64, orders: [Inputs; 2], at: &Inputs, _state: &State, actual: &mut Inputs) {
        if self.0 > 0.0 {
            let reach = h / self.0;
            let wanted = orders[1].delta - at.delta;
            if wanted.abs() > reach {
                actual.delta = at.delta + reach * wanted.signum();
            }
        }
    }
}

/// Lag of the shaft \[s\] behind the telegraph.
struct EngineLag(f64);

impl Physics for EngineLag {
    fn actuate(&self, h: f64, orders: [Inputs; 2], at: &Inputs, _state: &State, actual: &mut Inputs) {
        actual.n = lagged(self.0, h, orders[0].n, orders[1].n, at.n);
    }
}

/// The effects of this file.
pub const ENTRIES: &[Entry] = &[
    Entry {
        name: "walk_astern",
        accepted: &["propeller_walk_astern"],
        near: &["propeller_walk_ahead"],
        size: 0.12,
        most: 1.0,
        law: "share of the thrust, fading as exp(-(J/J0)^2)",
        build: walk_astern,
        ..FORCE
    },
    Entry {
        name: "walk_ahead",
        class: Class::Absorbed,
        accepted: &["propeller_walk_ahead"],
        near: &["asymmetric", "propeller_walk_astern"],
        size: 0.03,
        most: 0.3,
        reference: true,
        law: "proportional to thrust ahead: the parameter p0 can mimic it",
        build: walk_ahead,
        ..FORCE
    },
    Entry {
        name: "wake_drift",
        accepted: &["wake_drift"],
        near: &["symmetric", "thrust_loss"],
        size: 0.6,
        most: 2.5,
        reference: true,
        law: "w = w0 (1 - s (1 - exp(-4 beta_P^2)))",
        build: |size, _| Box::new(WakeInDrift(size)),
        ..FORCE
    },
    Entry {
        name: "thrust_loss",
        class: Class::Absorbed,
        accepted: &["thrust_loss"],
        near: &["fouling", "race", "wake_drift"],
        size: 0.12,
        most: 0.8,
        compare: Compare::Size("fraction"),
        reference: true,
        law: "a share of the thrust; thrust coefficients known within 15 % can mimic it",
        build: |size, _| Box::new(ThrustLoss(size)),
        ..FORCE
    },
    Entry {
        name: "engine_lag",
        accepted: &["engine_lag"],
        unit: "s",
        size: 4.0,
        most: 60.0,
        compare: Compare::Size("time"),
        moves_actuators: true,
        law: "first-order shaft behind the recorded telegraph, continuous in time",
        build: |size, _| Box::new(EngineLag(size)),
        ..FORCE
    },
    Entry {
        name: "race",
        class: Class::Absorbed,
        accepted: &["race"],
        near: &["rudder_stall", "thrust_loss"],
        size: 0.4,
        most: 2.0,
        reference: true,
        law: "kappa off its chart: rudder polynomials and race prior can mimic it",
        build: |size, _| Box::new(Race(size)),
        ..FORCE
    },
    Entry {
        name: "rudder_offset",
        class: Class::Absorbed,
        accepted: &["rudder_offset"],
        near: &["asymmetric", "propeller_walk_ahead"],
        unit: "rad",
        size: 0.03,
        most: 0.3,
        compare: Compare::Size("offset"),
        reference: true,
        law: "constant: the parameter p4 can mimic it",
        build: |size, _| Box::new(Offset(size)),
        ..FORCE
    },
    Entry {
        name: "rudder_stall",
        accepted: &["rudder_stall"],
        near: &["race"],
        size: 0.4,
        most: 1.0,
        reference: true,
        law: "a sudden drop of the rudder force beyond 24 to 28 deg",
        build: |size, d| Box::new(Stall { drop: size.min(1.0), onset: d.between(24.0, 28.0).to_radians() }),
        ..FORCE
    },
    Entry {
        name: "rudder_rate",
        accepted: &["rudder_rate", "rudder_lag"],
        unit: "s/rad",
        size: 35.0,
        most: 300.0,
        moves_actuators: true,
        law: "constant-rate steering gear behind the recorded order",
        build: |size, _| Box::new(RateLimit(size)),
        ..FORCE
    },
    Entry {
        name: "rudder_lag",
        accepted: &["rudder_lag", "rudder_rate"],
        unit: "s",
        size: 2.0,
        most: 30.0,
        compare: Compare::Size("time"),
        moves_actuators: true,
        law: "first-order steering gear behind the recorded order, continuous in time",
        build: |size, _| Box::new(RudderLag(size)),
        ..FORCE
    },
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lag_follows_a_ramp_at_its_distance_and_a_step_exponentially() {
        let (mut at, h, tau) = (0.0, 0.25, 2.0);
        for i in 0..400 {
            let t = i as f64 * h;
            at = lagged(tau, h, 0.1 * t, 0.1 * (t + h), at);
        }
        assert!((at - 0.1 * (100.0 - tau)).abs() < 1e-9);
        let stepped = lagged(tau, h, 1.0, 1.0, 0.0);
        assert!((stepped - (1.0 - (-h / tau).exp())).abs() < 1e-15);
        assert_eq!(lagged(0.0, h, 0.3, 0.7, 0.1), 0.7);
    }

    #[test]
    fn limited_rudder_moves_at_its_rate_and_arrives() {
        let limit = RateLimit(40.0);
        let order = Inputs { n: 1.0, delta: 0.5 };
        let mut at = Inputs { n: 1.0, delta: 0.0 };
        for _ in 0..81 {
            let mut next = order;
            limit.actuate(0.25, [order, order], &at, &State::default(), &mut next);
            assert!((next.delta - at.delta).abs() <= 0.25 / 40.0 + 1e-15);
            at = next;
        }
        assert_eq!(at.delta, 0.5);
    }
}
