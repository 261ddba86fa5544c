//! Whether two columns are one angle or rate to two sides, each with numbers where the other has nought.

use super::agree::top;
use super::names::words;
use crate::recording::import::signals::log::Column;

/// Words of two sides.
const OPPOSITE: [[&str; 2]; 6] = [
    ["ahead", "astern"],
    ["forward", "reverse"],
    ["port", "starboard"],
    ["port", "stbd"],
    ["left", "right"],
    ["bb", "stb"],
];
/// Share of the samples in which noise may leave both sides.
const BESIDE: f64 = 0.01;
/// A value below this share of the largest is noise about nought.
const FAINT: f64 = 0.05;

/// Whether two columns are the sides of one quantity: their names are one but for the side, and neither is above nought where the other is. Two
/// rudders or two propellers would be.
pub fn are_sides(one: (&str, &[&Column]), other: (&str, &[&Column])) -> bool {
    let [(a, of_a), (b, of_b)] = [one, other];
    let [a, b] = [a, b].map(words);
    let turned = |from: &[String], to: &[String], [side, opposite]: [&str; 2]| {
        let other = from.iter().map(|word| if word == side { opposite } else { word.as_str() });
        from.iter().any(|word| word == side) && other.eq(to.iter().map(String::as_str))
    };
    let pairs = || {
        let values = of_a.iter().zip(of_b).flat_map(|(a, b)| a.v.iter().zip(&b.v));
        values.filter(|(a, b)| a.is_finite() && b.is_finite())
    };
    let [faint_a, faint_b] = [of_a, of_b].map(|columns| FAINT * top(columns));
    let together = pairs().filter(|(a, b)| **a > faint_a && **b > faint_b).count();
    OPPOSITE.iter().any(|sides| turned(&a, &b, *sides) || turned(&b, &a, *sides))
        && pairs().any(|(a, _)| *a > 0.0)
        && pairs().any(|(_, b)| *b > 0.0)
        && pairs().all(|(a, b)| *a >= 0.0 && *b >= 0.0)
        && together as f64 <= BESIDE * pairs().count() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn column(of: impl Fn(f64) -> f64) -> Column {
        let mut column = Column::default();
        (0..200).for_each(|i| column.push(f64::from(i), of((0.05 * f64::from(i)).sin())));
        column
    }

    #[test]
    fn the_sides_of_one_quantity_are_never_above_nought_together() {
        let (up, down) = (column(|v| v.max(0.0)), column(|v| (-v).max(0.0)));
        let are = |a: &str, of_a: &Column, b: &str, of_b: &Column| are_sides((a, &[of_a]), (b, &[of_b]));
        assert!(are("RPM ahead", &up, "RPM astern", &down) && are("Rudder to stbd", &up, "Rudder to port", &down));
        // Other names, two rudders that turn together, and angles with a sign.
        assert!(!are("Rudder 1", &up, "Rudder 2", &down) && !are("Rudder port", &up, "Rudder starboard", &up));
        let signed = column(|v| v);
        assert!(!are("Rudder port", &signed, "Rudder starboard", &signed));
    }
}
