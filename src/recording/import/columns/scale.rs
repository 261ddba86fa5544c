//! What a factor between the speed of a track and a recorded one, or the size of values, says: another unit than was taken or is known.
//! It decides nothing, and gives the flags to pass.

use crate::recording::Quantity;
use crate::recording::import::signals::log::Meaning;

/// The factor of a unit is met within this share (of its logarithm): speeds through water differ from those over ground by less.
const NEAR: f64 = 0.3;
/// Radians that are read as degrees shorten a way by the size of a degree, and one to the east by less: up to 70 deg of latitude by a third.
const IN_RADIANS: std::ops::Range<f64> = 0.8..3.5;

/// Whether a ratio is that of a unit.
fn near(ratio: f64, factor: f64) -> bool {
    (ratio.abs() / factor).ln().abs() < NEAR
}

/// The question for a speed whose unit the file does not give, of which the track is sailed `times` as fast as its numbers say: for the unit of
/// the clock, where another one explains it.
pub fn clock(name: &str, times: f64) -> Option<String> {
    let of = |speed: &str| {
        let factor = Quantity::Speed.factor(speed)?;
        Quantity::Time.units().find(|unit| unit.factor != 1.0 && near(times / factor, unit.factor))
    };
    let (speed, unit) = ["kn", "m/s", "km/h"].into_iter().find_map(|speed| Some((speed, of(speed)?)))?;
    let (words, flag) = (unit.plural(), unit.spellings[0]);
    Some(format!(
        "the track goes with column `{name}` in {speed} where the time counts {words}: pass `--unit t={flag}`"
    ))
}

/// Shares of a whole above this are hundredths; the noise of a sensor takes those of one no farther.
pub const MOST_SHARE: f64 = 1.1;

/// The question for a column of an actuator that is written as a share of its most.
pub fn of_share(meaning: Meaning, column: &str, top: f64) -> String {
    let (parts, whole) = if top > MOST_SHARE { (100.0, "100 %") } else { (1.0, "1") };
    let (most, unit) = if meaning.quantity() == Quantity::Angle { (35.0, "deg") } else { (150.0, "rpm") };
    format!(
        "how much {whole} is of column `{column}` ({}), which is a share of its most: where that is {most} {unit} pass `--unit {}='{} {unit}'`",
        meaning.words(),
        meaning.name(),
        most / parts
    )
}

/// Parts into which a full turn is divided, beside degrees and radians: turns, gon, tenths of a degree, mils (NATO), binary angles.
const PARTS: [f64; 5] = [1.0, 400.0, 3600.0, 6400.0, 65_536.0];
/// A direction comes so near to a full turn in a log that goes round.
const ALL_ROUND: f64 = 0.95;

/// The flag with which the values of a direction fill a full turn, where one of the usual parts of it does so.
pub fn full_turn(meaning: Meaning, top: f64) -> String {
    let parts = PARTS.iter().find(|parts| (ALL_ROUND * **parts..=**parts).contains(&top)).filter(|_| meaning.wraps());
    parts.map_or_else(String::new, |parts| {
        let degrees = 360.0 / parts;
        format!(" (with `--unit {}='{degrees} deg'` its values up to {top} fill a full turn)", meaning.name())
    })
}

/// What to do where the track is sailed `times` as fast as a speed says.
pub fn advice(times: f64) -> String {
    let near = |factor: f64| near(times, factor);
    let unit = Quantity::Time.units().find(|unit| unit.factor != 1.0 && near(unit.factor));
    match unit {
        Some(unit) => format!("the time counts {}, it seems: pass `--unit t={}`", unit.plural(), unit.spellings[0]),
        None if IN_RADIANS.contains(&(times.abs() / 1f64.to_radians())) => {
            "latitude and longitude are in radians, it seems: pass `--unit lat=rad --unit lon=rad`".to_owned()
        }
        None => {
            "no unit of the time explains that, so that the positions may be in another unit, or it is another speed"
                .to_owned()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_unit_that_the_ratio_of_clocks_gives_is_named() {
        let cases =
            [(1e-9, "t=ns"), (1.02e-6, "t=us"), (1e-3, "t=ms"), (61.0, "t=min"), (3500.0, "t=h"), (86_000.0, "t=d")];
        for (times, flag) in cases {
            assert!(advice(times).contains(flag), "{times}: {}", advice(times));
        }
        assert!(
            clock("SOG", 0.514e-3).unwrap().contains("in kn where the time counts milliseconds: pass `--unit t=ms`")
        );
        assert_eq!((clock("SOG", 0.514), clock("SOG", 0.02)), (None, None));
        assert!(
            [0.0175, 0.0249].iter().all(|times| advice(*times).contains("--unit lat=rad --unit lon=rad"))
                && advice(7.0).contains("no unit of the time")
        );
    }
}
