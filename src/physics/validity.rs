//! The range of motion over which the law of a term is valid, as data, with the source of that range.
//! It counts no sample: how much of the data lies outside is worked out from a model and its recordings.

use serde::Serialize;
use std::f64::consts::PI;

/// Something about the motion that a range can be stated in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Surge velocity through the water over sqrt(g L) \[-\], negative astern.
    Froude,
    /// Angle between the velocity through the water and the keel line \[rad\], 0 ahead and astern, pi/2 abeam.
    Drift,
    /// Size of the yaw rate, made dimensionless: |r| L / U \[-\].
    Turn,
    /// Water depth over draught h/d \[-\]; infinite in deep water and where no depth was recorded.
    Depth,
    /// Propeller rate n \[1/s\], negative astern.
    Rate,
    /// Advance ratio J = V_A/(n D) \[-\] of a propeller that turns ahead.
    Advance,
    /// Apparent advance ratio u/(n D) \[-\] of a propeller that turns astern; negative while the ship still moves ahead.
    Reversing,
    /// Size of the rudder's angle of attack \[rad\].
    Attack,
}

impl Quantity {
    /// Plain words, as in "outside in drift angle".
    pub fn words(self) -> &'static str {
        match self {
            Self::Froude => "Froude number",
            Self::Drift => "drift angle",
            Self::Turn => "yaw rate r L/U",
            Self::Depth => "depth over draught",
            Self::Rate => "propeller rate",
            Self::Advance => "advance ratio ahead",
            Self::Reversing => "advance ratio astern",
            Self::Attack => "angle of attack",
        }
    }

    /// Factor to the unit people read, and that unit: degrees for angles, nothing for pure numbers.
    pub fn unit(self) -> (f64, &'static str) {
        match self {
            Self::Drift | Self::Attack => (180.0 / PI, " deg"),
            Self::Rate => (1.0, " 1/s"),
            Self::Froude | Self::Turn | Self::Depth | Self::Advance | Self::Reversing => (1.0, ""),
        }
    }
}

/// Degrees as radians, for ranges written as constants.
pub const fn degrees(angle: f64) -> f64 {
    angle * PI / 180.0
}

/// The range over which the law of a term is valid; a quantity that is `None` is not limited.
///
/// Ranges are `[low, high]`, both ends included, and may be infinite on one side. Start from [`Validity::ANY`]:
/// `Validity { drift: Some([0.0, degrees(20.0)]), source: "...", ..Validity::ANY }`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Validity {
    /// Range of [`Quantity::Froude`] \[-\].
    pub froude: Option<[f64; 2]>,
    /// Range of [`Quantity::Drift`] \[rad\].
    pub drift: Option<[f64; 2]>,
    /// Range of [`Quantity::Turn`] \[-\].
    pub turn: Option<[f64; 2]>,
    /// Range of [`Quantity::Depth`] \[-\].
    pub depth: Option<[f64; 2]>,
    /// Range of [`Quantity::Rate`] \[1/s\].
    pub rate: Option<[f64; 2]>,
    /// Range of [`Quantity::Advance`] \[-\].
    pub advance: Option<[f64; 2]>,
    /// Range of [`Quantity::Reversing`] \[-\].
    pub reversing: Option<[f64; 2]>,
    /// Range of [`Quantity::Attack`] \[rad\].
    pub attack: Option<[f64; 2]>,
    /// Names of terms whose own range this term widens to its own: it models what their law leaves out.
    pub widens: &'static [&'static str],
    /// Where the range comes from, or why there is none; says so where a number is an engineering limit.
    pub source: &'static str,
}

impl Validity {
    /// Valid anywhere.
    pub const ANY: Self = Self {
        froude: None,
        drift: None,
        turn: None,
        depth: None,
        rate: None,
        advance: None,
        reversing: None,
        attack: None,
        widens: &[],
        source: "no range: the law is exact, or its source gives none",
    };

    /// Valid anywhere, for a stated reason.
    pub const fn any(source: &'static str) -> Self {
        Self { source, ..Self::ANY }
    }

    /// The range of a quantity, `None` where it is not limited.
    pub const fn range(&self, quantity: Quantity) -> Option<[f64; 2]> {
        match quantity {
            Quantity::Froude => self.froude,
            Quantity::Drift => self.drift,
            Quantity::Turn => self.turn,
            Quantity::Depth => self.depth,
            Quantity::Rate => self.rate,
            Quantity::Advance => self.advance,
            Quantity::Reversing => self.reversing,
            Quantity::Attack => self.attack,
        }
    }

    /// The quantities that are limited, with their ranges.
    pub fn limits(&self) -> impl Iterator<Item = (Quantity, [f64; 2])> + '_ {
        use Quantity as Q;
        [Q::Froude, Q::Drift, Q::Turn, Q::Depth, Q::Rate, Q::Advance, Q::Reversing, Q::Attack]
            .into_iter()
            .filter_map(|q| Some((q, self.range(q)?)))
    }
}

/// A range in words: `0 to 20 deg`, `3 or more`, `at most 0.25`, or `anywhere`.
pub fn range_in_words(quantity: Quantity, [low, high]: [f64; 2]) -> String {
    let (factor, unit) = quantity.unit();
    let number = |x: f64| {
        let rounded = (x * factor * 1e4).round() / 1e4;
        format!("{rounded}")
    };
    match (low.is_finite(), high.is_finite()) {
        (true, true) => format!("{} to {}{unit}", number(low), number(high)),
        (true, false) => format!("{}{unit} or more", number(low)),
        (false, true) => format!("at most {}{unit}", number(high)),
        (false, false) => "anywhere".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_reads_in_the_unit_people_use() {
        let words = |q, range| range_in_words(q, range);
        assert_eq!(words(Quantity::Drift, [0.0, degrees(20.0)]), "0 to 20 deg");
        assert_eq!(words(Quantity::Depth, [3.0, f64::INFINITY]), "3 or more");
        assert_eq!(words(Quantity::Froude, [f64::NEG_INFINITY, 0.25]), "at most 0.25");
        assert_eq!(words(Quantity::Rate, [0.0, f64::INFINITY]), "0 1/s or more");
    }

    #[test]
    fn limits_list_what_is_limited_and_nothing_else() {
        const LAW: Validity =
            Validity { froude: Some([0.0, 0.2]), attack: Some([0.0, degrees(45.0)]), ..Validity::ANY };
        let quantities: Vec<Quantity> = LAW.limits().map(|(q, _)| q).collect();
        assert_eq!(quantities, [Quantity::Froude, Quantity::Attack]);
        assert_eq!(Validity::ANY.limits().count(), 0);
    }
}
