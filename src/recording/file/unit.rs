//! Units as people write them in column headers, and the factor that takes each to SI.
//! Which channel is measured in which quantity is not said here: that is the catalogue in `channel.rs`.

use serde::Serialize;

/// A kind of measured quantity; its SI unit is the first one listed for it in [`UNITS`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Time, in seconds.
    Time,
    /// Length, in metres.
    Length,
    /// Angle, in radians.
    Angle,
    /// Speed, in metres a second.
    Speed,
    /// Rate of turn, in radians a second.
    AngularRate,
    /// Shaft speed, in revolutions a second. `rad/s` is 1/(2 pi) of it.
    Rotation,
    /// A pure number.
    Number,
    /// Force, in newtons.
    Force,
    /// Moment of a force, in newton metres.
    Moment,
}

/// A unit: the spellings accepted in a header and the factor to SI.
#[derive(Clone, Copy, Debug)]
pub struct Unit {
    /// What it measures.
    pub quantity: Quantity,
    /// Accepted spellings, the preferred one first. Compared without regard to case.
    pub spellings: &'static [&'static str],
    /// SI value of one of this unit.
    pub factor: f64,
}

const TURN: f64 = std::f64::consts::TAU;
const DEGREE: f64 = TURN / 360.0;
/// The international knot: 1852 m an hour.
const KNOT: f64 = 1852.0 / 3600.0;

/// A unit with a positive number before it, `0.1 deg` or `1/100 deg`: the number, and the spelling of the unit.
pub(crate) fn scaled(spelling: &str) -> Option<(f64, &str)> {
    let (number, of) = spelling.split_once(' ')?;
    let (over, under) = number.split_once('/').unwrap_or((number, "1"));
    let many = over.parse::<f64>().ok()? / under.parse::<f64>().ok()?;
    (many.is_finite() && many > 0.0).then_some((many, of))
}

const fn unit(quantity: Quantity, spellings: &'static [&'static str], factor: f64) -> Unit {
    Unit { quantity, spellings, factor }
}

/// Every unit understood in a header or a column map; for each quantity the SI unit first.
pub const UNITS: &[Unit] = &[
    unit(Quantity::Time, &["s", "sec", "second", "seconds"], 1.0),
    unit(Quantity::Time, &["min", "minute", "minutes"], 60.0),
    unit(Quantity::Time, &["ms", "millisecond", "milliseconds"], 1e-3),
    unit(Quantity::Time, &["us", "µs", "microsecond", "microseconds"], 1e-6),
    unit(Quantity::Time, &["ns", "nanosecond", "nanoseconds"], 1e-9),
    unit(Quantity::Time, &["h", "hour", "hours"], 3600.0),
    unit(Quantity::Time, &["d", "day", "days"], 86_400.0),
    unit(Quantity::Length, &["m", "metre", "meter", "metres", "meters"], 1.0),
    unit(Quantity::Length, &["km"], 1000.0),
    // Not `M`, the symbol of the nautical mile: headers in capitals write metres so.
    unit(Quantity::Length, &["nm", "nmi"], 1852.0),
    unit(Quantity::Length, &["cm"], 0.01),
    unit(Quantity::Length, &["mm"], 0.001),
    unit(Quantity::Length, &["ft", "feet", "foot"], 0.3048),
    unit(Quantity::Length, &["fm", "fathom", "fathoms", "ftm", "fth"], 1.8288),
    unit(Quantity::Angle, &["rad", "radian", "radians"], 1.0),
    unit(
        Quantity::Angle,
        &[
            "deg",
            "degree",
            "degrees",
            "°",
            "degrees_north",
            "degrees_east",
            "degree_north",
            "degree_east",
            "decimal degrees",
            "grad",
            "degré",
            "degrés",
            "grader",
            "graden",
            "gradi",
            "grados",
        ],
        DEGREE,
    ),
    unit(Quantity::Angle, &["mrad", "milliradian", "milliradians"], 1e-3),
    unit(Quantity::Angle, &["cdeg", "centideg", "centidegree", "centidegrees"], 0.01 * DEGREE),
    unit(Quantity::Angle, &["arcmin", "min", "minute", "minutes"], DEGREE / 60.0),
    unit(Quantity::Speed, &["m/s", "ms-1", "m s-1", "m/sec", "mps"], 1.0),
    unit(
        Quantity::Speed,
        &[
            "kn", "kt", "kts", "knot", "knots", "nds", "nd", "noeuds", "nœuds", "nodi", "nudos", "knoten", "knop",
            "knopen",
        ],
        KNOT,
    ),
    unit(Quantity::Speed, &["km/h", "kmh", "kph", "kmph", "km/hr"], 1.0 / 3.6),
    unit(Quantity::Speed, &["mph", "mi/h"], 1609.344 / 3600.0),
    unit(Quantity::Speed, &["m/min"], 1.0 / 60.0),
    unit(Quantity::Speed, &["cm/s", "cm/sec"], 0.01),
    unit(Quantity::Speed, &["mm/s", "mm/sec"], 0.001),
    unit(Quantity::AngularRate, &["rad/s", "rad s-1", "rad/sec"], 1.0),
    unit(
        Quantity::AngularRate,
        &["deg/s", "deg s-1", "°/s", "deg/sec", "°/sec", "degree/s", "degrees/s", "degps", "dps"],
        DEGREE,
    ),
    unit(
        Quantity::AngularRate,
        &["deg/min", "deg min-1", "°/min", "deg/minute", "degree/min", "degrees/min"],
        DEGREE / 60.0,
    ),
    unit(Quantity::AngularRate, &["rad/min", "rad min-1"], 1.0 / 60.0),
    unit(Quantity::AngularRate, &["mrad/s", "mrad s-1", "mrad/sec"], 1e-3),
    unit(Quantity::AngularRate, &["cdeg/s", "cdeg s-1", "cdeg/sec", "centideg/s", "centidegrees/s"], 0.01 * DEGREE),
    unit(
        Quantity::Rotation,
        &["rps", "1/s", "s-1", "s^-1", "Hz", "rev/s", "rev/sec", "r/s", "U/s", "tr/s", "giri/s"],
        1.0,
    ),
    unit(
        Quantity::Rotation,
        &[
            "rpm",
            "1/min",
            "min-1",
            "min^-1",
            "rev/min",
            "revs/min",
            "r/min",
            "r.p.m.",
            "U/min",
            "Umdr/min",
            "tr/min",
            "tours/min",
            "giri/min",
            "g/min",
            "o/min",
            "omw/min",
        ],
        1.0 / 60.0,
    ),
    unit(Quantity::Rotation, &["rad/s"], 1.0 / TURN),
    unit(Quantity::Number, &["-", "1", ""], 1.0),
    unit(Quantity::Number, &["%", "percent"], 0.01),
    unit(Quantity::Force, &["N", "newton", "newtons"], 1.0),
    unit(Quantity::Force, &["kN"], 1e3),
    unit(Quantity::Force, &["MN"], 1e6),
    unit(Quantity::Force, &["kgf"], 9.806_65),
    unit(Quantity::Moment, &["N m", "Nm", "N*m"], 1.0),
    unit(Quantity::Moment, &["kN m", "kNm", "kN*m"], 1e3),
];

impl Unit {
    /// Its name in the plural, the last of the spellings: `milliseconds`.
    pub(crate) fn plural(&self) -> &'static str {
        self.spellings[self.spellings.len() - 1]
    }
}

impl Quantity {
    /// The units of this quantity, SI first.
    pub fn units(self) -> impl Iterator<Item = &'static Unit> {
        UNITS.iter().filter(move |u| u.quantity == self)
    }

    /// The SI unit of this quantity.
    pub fn si(self) -> &'static str {
        self.units().next().map_or("-", |u| u.spellings[0])
    }

    /// SI value of one `spelling`, or `None` when no unit of this quantity is spelt so.
    ///
    /// Spellings are compared as written first, then without regard to case. A number before one counts how much of it is one: `0.01 deg`,
    /// `1/100 deg`.
    pub fn factor(self, spelling: &str) -> Option<f64> {
        let spelling = spelling.trim();
        if let Some((many, of)) = scaled(spelling) {
            return Some(many * self.factor(of)?);
        }
        let exact = self.units().find(|u| u.spellings.contains(&spelling));
        exact
            .or_else(|| self.units().find(|u| u.spellings.iter().any(|s| s.eq_ignore_ascii_case(spelling))))
            .map(|u| u.factor)
    }

    /// The preferred spellings of the units of this quantity, for messages: `rad, deg`.
    pub fn choices(self) -> String {
        self.units().map(|u| u.spellings[0]).collect::<Vec<_>>().join(", ")
    }

    /// The unit, other than `current`, in which `value` (SI, read as `current`) would lie inside `limits`, if one does.
    pub(crate) fn likelier_unit(self, current: &str, value: f64, limits: (f64, f64)) -> Option<&'static str> {
        let as_written = value / self.factor(current)?;
        self.units()
            .filter(|u| !u.spellings.contains(&current))
            .find(|u| (limits.0..=limits.1).contains(&(as_written * u.factor)))
            .map(|u| u.spellings[0])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_first_unit_of_every_quantity_is_si() {
        for u in UNITS {
            assert_eq!(u.quantity.factor(u.quantity.si()), Some(1.0), "{:?}", u.quantity);
        }
    }

    #[test]
    fn known_conversions_hold() {
        let close = |a: Option<f64>, b: f64| assert!((a.unwrap() - b).abs() < 1e-12 * b, "{a:?} {b}");
        close(Quantity::Speed.factor("kn"), 0.514_444_444_444_444_4);
        close(Quantity::Angle.factor("0.01 deg"), 0.01 * DEGREE);
        close(Quantity::Rotation.factor("1/10 rpm"), 1.0 / 600.0);
        close(Quantity::Speed.factor("KM/H"), 1.0 / 3.6);
        close(Quantity::Angle.factor("deg"), std::f64::consts::PI / 180.0);
        close(Quantity::AngularRate.factor("deg/min"), std::f64::consts::PI / 180.0 / 60.0);
        close(Quantity::AngularRate.factor("deg/sec"), std::f64::consts::PI / 180.0);
        close(Quantity::AngularRate.factor("Degrees/s"), std::f64::consts::PI / 180.0);
        close(Quantity::AngularRate.factor("mrad/s"), 1e-3);
        close(Quantity::Angle.factor("mrad"), 1e-3);
        close(Quantity::Angle.factor("centidegrees"), 0.01 * DEGREE);
        close(Quantity::AngularRate.factor("cdeg/s"), 0.01 * DEGREE);
        close(Quantity::Rotation.factor("rpm"), 1.0 / 60.0);
        close(Quantity::Rotation.factor("rad/s"), 1.0 / std::f64::consts::TAU);
        close(Quantity::Number.factor("%"), 0.01);
    }

    #[test]
    fn a_capital_m_is_a_metre() {
        for (spelling, factor) in [("M", 1.0), ("m", 1.0), ("NM", 1852.0), ("nmi", 1852.0)] {
            assert_eq!(Quantity::Length.factor(spelling), Some(factor), "{spelling}");
        }
    }

    #[test]
    fn a_unit_of_another_quantity_is_refused() {
        assert_eq!(Quantity::Angle.factor("m/s"), None);
        assert_eq!(Quantity::Speed.factor("rpm"), None);
    }

    #[test]
    fn no_spelling_means_two_units_of_one_quantity() {
        for (i, a) in UNITS.iter().enumerate() {
            for b in &UNITS[i + 1..] {
                let shared = a.spellings.iter().any(|s| b.spellings.contains(s));
                assert!(a.quantity != b.quantity || !shared, "{:?} {:?}", a.spellings, b.spellings);
            }
        }
    }

    proptest! {
        #![proptest_config(crate::recording::seeded())]
        #[test]
        fn a_value_written_in_any_unit_is_read_back(value in -1e4..1e4f64, which in 0..UNITS.len()) {
            let u = UNITS[which];
            let written = value / u.factor;
            let read = written * u.quantity.factor(u.spellings[0]).unwrap();
            prop_assert!((read - value).abs() <= 1e-12 * value.abs());
        }
    }
}
