//! What can be injected: each effect with the size against which it is graded, and the names that are right for it.
//! It makes operations; it applies none.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::operation::{Instrument, Operation};
use super::record::Column;
use super::set::Set;

/// What a diagnosis should make of an injection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Expected {
    /// Name it, alone or in its class.
    Named,
    /// Name nothing more than without it.
    Silent,
    /// Name it or nothing: the model's own coefficients can absorb it.
    Either,
    /// Refuse the recordings.
    Refused,
}

impl Expected {
    /// Word in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Named => "named",
            Self::Silent => "silent",
            Self::Either => "either",
            Self::Refused => "refused",
        }
    }
}

/// An effect that can be injected.
#[derive(Debug, Clone, Copy)]
pub struct Effect {
    /// Name in keys and tables.
    pub name: &'static str,
    /// Unit of the size.
    pub unit: &'static str,
    /// Size at strength 1: as plain on these recordings as a current of a tenth of the speed.
    reference: fn(Set) -> f64,
    /// Names of a diagnosis that are right.
    pub accepted: &'static [&'static str],
    /// Names that are not wrong.
    pub near: &'static [&'static str],
    /// What should come of it.
    pub expected: Expected,
    /// Whether it is a fault of a sensor or a logger, so that neither ship nor weather may be named for it.
    pub sensor: bool,
    make: fn(&mut Maker) -> Operation,
}

/// What an operation is made of.
struct Maker<'a> {
    set: Set,
    /// Size with its sign.
    size: f64,
    rng: &'a mut ChaCha8Rng,
    parameters: Vec<(String, f64)>,
}

/// An effect with its size in one case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Injection {
    /// Name of the effect.
    pub effect: String,
    /// The operation.
    pub operation: Operation,
    /// Size.
    pub size: f64,
    /// Its unit.
    pub unit: String,
    /// True values of parameters that a diagnosis may report, by their dotted names.
    pub parameters: Vec<(String, f64)>,
    /// Names that are right.
    pub accepted: Vec<String>,
    /// Names that are not wrong.
    pub near: Vec<String>,
    /// What should come of it.
    pub expected: Expected,
    /// Whether it is a fault of a sensor or a logger.
    pub sensor: bool,
}

impl Maker<'_> {
    fn seed(&mut self) -> u64 {
        // 48 bits: exact as a number in every JSON reader.
        self.rng.random_range(0..1_u64 << 48)
    }

    /// Adds the truth of a parameter.
    fn truth(&mut self, name: &str, value: f64) {
        self.parameters.push((name.to_owned(), value));
    }

    fn clock(&mut self, instrument: Instrument) -> Operation {
        // Whole rows, so that no value is interpolated.
        let row = self.set.facts().row;
        let delay = self.size.signum() * (self.size.abs() / row).round().max(1.0) * row;
        match instrument {
            Instrument::Position => self.truth("time_skew.position", delay),
            Instrument::Heading => self.truth("time_skew.heading", delay),
            // The diagnosis takes these two for the clock.
            Instrument::Velocity | Instrument::YawRate => {}
        }
        Operation::Clock { instrument, delay }
    }

    fn lever(&mut self, velocities: bool) -> Operation {
        let term = if velocities { "antenna" } else { "position_lever" };
        let bearing: f64 = self.rng.random_range(0.0..std::f64::consts::TAU);
        let [forward, starboard] = [bearing.cos() * self.size.abs(), bearing.sin() * self.size.abs()];
        self.truth(&format!("{term}.x"), forward);
        self.truth(&format!("{term}.y"), starboard);
        Operation::Lever { forward, starboard, velocities }
    }

    fn instrument(&mut self) -> Instrument {
        match self.rng.random_range(0..4) {
            0 => Instrument::Position,
            1 => Instrument::Heading,
            2 => Instrument::Velocity,
            _ => Instrument::YawRate,
        }
    }

    fn quantise(&mut self) -> Operation {
        let facts = self.set.facts();
        let instrument = self.instrument();
        let reference = match instrument {
            Instrument::Position => 0.005 * facts.length,
            Instrument::Heading => 0.5_f64.to_radians(),
            Instrument::Velocity => 0.02 * facts.speed,
            Instrument::YawRate => 0.05 * facts.turn,
        };
        Operation::Quantise { instrument, step: self.size.abs() * reference }
    }

    /// A vector of the size in a drawn direction.
    fn vector(&mut self) -> [f64; 2] {
        let bearing: f64 = self.rng.random_range(0.0..std::f64::consts::TAU);
        [bearing.cos() * self.size.abs(), bearing.sin() * self.size.abs()]
    }

    fn current(&mut self) -> Operation {
        let [north, east] = self.vector();
        self.truth("current.north", north);
        self.truth("current.east", east);
        Operation::Current { north, east }
    }

    fn jump(&mut self) -> Operation {
        let [north, east] = self.vector();
        Operation::Jump { north, east, seed: self.seed() }
    }

    /// An error of one number: the truth of one parameter, with its sign.
    fn plain(&mut self, parameter: &str, sign: f64, of: fn(f64) -> Operation) -> Operation {
        self.truth(parameter, sign * self.size);
        of(self.size)
    }
}

/// What most effects share.
const PLAIN: Effect = Effect {
    name: "",
    unit: "-",
    reference: |_| 1.0,
    accepted: &[],
    near: &[],
    expected: Expected::Named,
    sensor: true,
    make: |_| Operation::LogScale(0.0),
};

const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// Part of the time over a length that a clock, a lag or a stamp is off at strength 1.
const LATE: f64 = 0.05;

/// Injections that have a size.
pub const EFFECTS: [Effect; 19] = [
    Effect {
        name: "current",
        unit: "m/s",
        reference: |set| 0.1 * set.facts().speed,
        accepted: &["current"],
        near: &["tide"],
        sensor: false,
        make: |m| m.current(),
        ..PLAIN
    },
    Effect {
        name: "clock_position",
        unit: "s",
        reference: |set| LATE * set.time(),
        accepted: &["time_skew"],
        make: |m| m.clock(Instrument::Position),
        ..PLAIN
    },
    Effect {
        name: "clock_heading",
        unit: "s",
        reference: |set| LATE * set.time(),
        accepted: &["time_skew"],
        make: |m| m.clock(Instrument::Heading),
        ..PLAIN
    },
    Effect {
        name: "clock_velocity",
        unit: "s",
        reference: |set| LATE * set.time(),
        accepted: &["log_skew", "time_skew"],
        near: &["yaw_rate_skew"],
        make: |m| m.clock(Instrument::Velocity),
        ..PLAIN
    },
    Effect {
        name: "clock_yaw_rate",
        unit: "s",
        reference: |set| LATE * set.time(),
        accepted: &["yaw_rate_skew", "time_skew"],
        make: |m| m.clock(Instrument::YawRate),
        ..PLAIN
    },
    Effect {
        name: "heading_zero",
        unit: "rad",
        reference: |_| 2.0 * DEGREE,
        accepted: &["heading_bias"],
        make: |m| m.plain("heading_bias.bias", 1.0, Operation::HeadingZero),
        ..PLAIN
    },
    Effect {
        name: "rate_bias",
        unit: "rad/s",
        reference: |set| 0.02 * set.facts().turn,
        accepted: &["yaw_rate_bias"],
        make: |m| m.plain("yaw_rate_bias.bias", 1.0, Operation::RateBias),
        ..PLAIN
    },
    Effect {
        name: "log_scale",
        reference: |_| 0.04,
        accepted: &["log_scale"],
        make: |m| m.plain("log_scale.error", 1.0, Operation::LogScale),
        ..PLAIN
    },
    Effect {
        name: "sway_bias",
        unit: "m/s",
        reference: |set| 0.03 * set.facts().speed,
        accepted: &["sway_log_bias"],
        make: |m| m.plain("sway_log_bias.bias", 1.0, Operation::SwayBias),
        ..PLAIN
    },
    Effect {
        name: "lever",
        unit: "m",
        reference: |set| 0.05 * set.facts().length,
        accepted: &["antenna"],
        make: |m| m.lever(true),
        ..PLAIN
    },
    Effect {
        name: "lever_position",
        unit: "m",
        reference: |set| 0.05 * set.facts().length,
        accepted: &["position_lever"],
        make: |m| m.lever(false),
        ..PLAIN
    },
    Effect {
        name: "rudder_zero",
        unit: "rad",
        reference: |_| 2.0 * DEGREE,
        accepted: &["rudder_offset"],
        expected: Expected::Either,
        make: |m| m.plain("rudder_offset.offset", -1.0, Operation::RudderZero),
        ..PLAIN
    },
    Effect {
        name: "rudder_lag",
        unit: "s",
        reference: |set| LATE * set.time(),
        accepted: &["rudder_lag"],
        near: &["rudder_rate"],
        sensor: false,
        make: |m| {
            let time = m.size.abs();
            m.truth("rudder_lag.time", time);
            Operation::RudderLag(time)
        },
        ..PLAIN
    },
    Effect {
        name: "propeller_scale",
        reference: |_| 0.04,
        near: &["thrust_loss", "fouling", "loading", "race"],
        expected: Expected::Either,
        make: |m| Operation::PropellerScale(m.size),
        ..PLAIN
    },
    Effect { name: "quantise", expected: Expected::Silent, make: |m| m.quantise(), ..PLAIN },
    Effect {
        name: "hold",
        unit: "s",
        reference: |set| 2.0 * LATE * set.time(),
        // The repeated value is late by half the time, in the mean.
        near: &["time_skew"],
        expected: Expected::Silent,
        make: |m| Operation::Hold { instrument: m.instrument(), period: m.size.abs() },
        ..PLAIN
    },
    Effect {
        name: "drop_out",
        unit: "s",
        reference: |set| 0.5 * set.time(),
        expected: Expected::Silent,
        make: |m| Operation::DropOut { gaps: 3, length: m.size.abs(), seed: m.seed() },
        ..PLAIN
    },
    Effect {
        name: "jump",
        unit: "m",
        reference: |set| 0.5 * set.facts().length,
        expected: Expected::Silent,
        make: |m| m.jump(),
        ..PLAIN
    },
    Effect {
        name: "jitter",
        unit: "s",
        reference: |set| LATE * set.time(),
        expected: Expected::Silent,
        make: |m| Operation::Jitter { most: m.size.abs(), seed: m.seed() },
        ..PLAIN
    },
];

/// Errors of a user in one session: there or not.
pub const MISTAKES: [&str; 10] = [
    "heading_in_degrees",
    "yaw_rate_in_degrees",
    "rudder_in_degrees",
    "propeller_in_rpm",
    "speed_in_knots",
    "rudder_sign",
    "yaw_rate_sign",
    "east_sign",
    "positions_swapped",
    "velocities_swapped",
];

/// The effect of that name.
pub fn effect(name: &str) -> Option<&'static Effect> {
    EFFECTS.iter().find(|e| e.name == name)
}

impl Effect {
    /// The effect at a strength, its direction or sign drawn.
    pub fn at(&self, set: Set, strength: f64, rng: &mut ChaCha8Rng) -> Injection {
        let sign = if rng.random_range(0..2) == 0 { 1.0 } else { -1.0 };
        let size = sign * strength * (self.reference)(set);
        let mut maker = Maker { set, size, rng, parameters: Vec::new() };
        let operation = (self.make)(&mut maker);
        let parameters = maker.parameters;
        Injection {
            effect: self.name.to_owned(),
            operation,
            size,
            unit: self.unit.to_owned(),
            parameters,
            accepted: self.accepted.iter().map(ToString::to_string).collect(),
            near: self.near.iter().map(ToString::to_string).collect(),
            expected: self.expected,
            sensor: self.sensor,
        }
    }
}

/// A user's mistake.
pub fn mistake(name: &str) -> Injection {
    use Column::{Delta, N, Psi, R, U, V, X, Y};
    let unit = |columns: &[Column], factor: f64| Operation::Unit { columns: columns.to_vec(), factor };
    let (operation, accepted) = match name {
        "heading_in_degrees" => (unit(&[Psi], 1.0 / DEGREE), "unit_error"),
        "yaw_rate_in_degrees" => (unit(&[R], 1.0 / DEGREE), "unit_error"),
        "rudder_in_degrees" => (unit(&[Delta], 1.0 / DEGREE), "unit_error"),
        "propeller_in_rpm" => (unit(&[N], 60.0), "unit_error"),
        "speed_in_knots" => (unit(&[U, V], 3600.0 / 1852.0), "unit_error"),
        "rudder_sign" => (unit(&[Delta], -1.0), "sign_error"),
        "yaw_rate_sign" => (unit(&[R], -1.0), "sign_error"),
        "east_sign" => (unit(&[Y], -1.0), "sign_error"),
        "positions_swapped" => (Operation::Swap(X, Y), "axes_error"),
        _ => (Operation::Swap(U, V), "axes_error"),
    };
    Injection {
        effect: name.to_owned(),
        operation,
        size: 1.0,
        unit: "-".to_owned(),
        parameters: Vec::new(),
        accepted: vec![accepted.to_owned()],
        near: ["unit_error", "sign_error", "axes_error"].map(str::to_owned).to_vec(),
        expected: Expected::Refused,
        sensor: true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::injected::set::SETS;
    use rand::SeedableRng;

    #[test]
    fn sizes_grow_with_strength_and_the_truth_is_what_the_operation_does() {
        for effect in &EFFECTS {
            for set in SETS {
                let of = |strength: f64| effect.at(set, strength, &mut ChaCha8Rng::seed_from_u64(5));
                let (one, two) = (of(1.0), of(2.0));
                assert!((two.size / one.size - 2.0).abs() < 1e-12, "{}", effect.name);
                assert_eq!(one, of(1.0));
                assert!(effect.expected != Expected::Named || !one.accepted.is_empty(), "{}", effect.name);
            }
        }
        let current = effect("current").unwrap().at(Set::Marin, 1.0, &mut ChaCha8Rng::seed_from_u64(5));
        let Operation::Current { north, east } = current.operation else { unreachable!() };
        assert!((north.hypot(east) - 0.8).abs() < 1e-12);
        assert_eq!(current.parameters, [("current.north".to_owned(), north), ("current.east".to_owned(), east)]);
    }

    #[test]
    fn clocks_are_off_by_whole_rows() {
        for set in SETS {
            let clock = effect("clock_heading").unwrap().at(set, 0.25, &mut ChaCha8Rng::seed_from_u64(5));
            let Operation::Clock { delay, .. } = clock.operation else { unreachable!() };
            let rows = delay / set.facts().row;
            assert!(rows != 0.0 && (rows - rows.round()).abs() < 1e-9, "{rows}");
            assert_eq!(clock.parameters[0].1, delay);
        }
    }

    #[test]
    fn a_mistake_is_refused_and_changes_the_recording() {
        for name in MISTAKES {
            let mistake = mistake(name);
            assert_eq!(mistake.expected, Expected::Refused);
            let mut record = crate::injected::record::tests::example(10);
            let before = record.clone();
            mistake.operation.apply(&mut record, 0);
            assert_ne!(record, before, "{name}");
        }
    }
}
