//! Letters beside numbers: the hemisphere of a place, the side of a rudder, the sense of a propeller, a unit.
//! They stand in the field of the number, before or after it, or in a column of their own.

use super::layout::number;
use crate::recording::import::columns::names::is_unit;
use crate::recording::import::signals::log::Meaning;
use crate::recording::{Channel, Quantity};
use std::collections::BTreeSet;

/// Letters that say which way a number counts: those of positive numbers and those of negative ones.
struct Sides {
    positive: &'static [&'static str],
    negative: &'static [&'static str],
}

const NORTH_SOUTH: Sides = Sides { positive: &["n", "north"], negative: &["s", "south"] };
const EAST_WEST: Sides = Sides { positive: &["e", "east"], negative: &["w", "west"] };
const STARBOARD_PORT: Sides = Sides {
    positive: &[
        "s",
        "sb",
        "stb",
        "stbd",
        "starboard",
        "r",
        "right",
        "steuerbord",
        "tribord",
        "estribor",
        "dx",
        "dritta",
    ],
    negative: &["p", "ps", "port", "l", "left", "bb", "backbord", "babord", "bâbord", "babor", "sx", "sinistra"],
};
/// The same in Slavic languages: `P` is right, as in Polish prawo, Russian and Croatian pravo.
const RIGHT_LEFT: Sides = Sides {
    positive: &["p", "prawo", "prawa", "pravo", "prava", "prb"],
    negative: &["l", "lewo", "lewa", "levo", "leva", "lb"],
};
const AHEAD_ASTERN: Sides =
    Sides { positive: &["ah", "ahd", "ahead", "fwd", "forward"], negative: &["as", "ast", "astern", "rev", "reverse"] };
/// Words of a telegraph that leave the sense as it was.
const STOPPED: [&str; 4] = ["stop", "stopped", "standby", "fwe"];

/// Words beside a heading that change nothing.
const TRUE: [&str; 2] = ["t", "true"];
/// Words beside a heading that counts from magnetic north.
const MAGNETIC: [&str; 3] = ["m", "mag", "magnetic"];

impl Sides {
    /// Those of a quantity; `S` is south of a latitude and starboard of a rudder. Of two alphabets the one is taken in which the marks are of
    /// both sides: `L` and `P` are left and right, where both would be port otherwise.
    fn of<'a>(meaning: Option<Meaning>, marks: impl Iterator<Item = &'a str> + Clone) -> Option<&'static Self> {
        let all: &[&'static Self] = match meaning? {
            Meaning::Latitude => &[&NORTH_SOUTH],
            Meaning::Longitude | Meaning::Variation => &[&EAST_WEST],
            Meaning::Channel(Channel::Delta | Channel::DeltaOrder | Channel::Thruster) => {
                &[&STARBOARD_PORT, &RIGHT_LEFT]
            }
            Meaning::Channel(Channel::N | Channel::NOrder) => &[&AHEAD_ASTERN],
            _ => return None,
        };
        let both = |sides: &&Self| [1.0, -1.0].iter().all(|s| marks.clone().any(|mark| sides.sign(mark) == Some(*s)));
        all.iter().copied().find(both).or_else(|| all.first().copied())
    }

    fn sign(&self, letters: &str) -> Option<f64> {
        let among = |all: &[&str]| all.iter().any(|l| letters.trim_end_matches('.').eq_ignore_ascii_case(l));
        if among(self.positive) { Some(1.0) } else { among(self.negative).then_some(-1.0) }
    }
}

/// What the letters in a column say.
pub struct Marks {
    sides: Option<&'static Sides>,
    /// The unit that stands next to every number.
    pub unit: Option<String>,
    /// Whether a heading or a course counts from magnetic north: `023.4 M`.
    pub magnetic: bool,
}

impl Marks {
    /// Those of a column of this meaning.
    pub fn of<'a>(fields: impl Iterator<Item = &'a str>, meaning: Option<Meaning>, decimal_comma: bool) -> Self {
        let parts = fields.filter_map(|f| marked(f, decimal_comma));
        let found: BTreeSet<&str> = parts.map(|(_, mark)| mark).filter(|mark| !mark.is_empty()).collect();
        let sides = Sides::of(meaning, found.iter().copied())
            .filter(|sides| found.iter().any(|mark| sides.sign(mark).is_some()));
        let counts = matches!(meaning, Some(Meaning::Course | Meaning::Channel(Channel::Psi)));
        let magnetic = counts && !found.is_empty() && found.iter().all(|mark| among(&MAGNETIC, mark));
        let mut units = found.iter().filter(|mark| is_unit(mark) && !magnetic);
        let unit = match (units.next(), units.next()) {
            (Some(unit), None) => Some((*unit).to_owned()),
            _ => None,
        };
        Self { sides, unit: unit.filter(|_| sides.is_none()), magnetic }
    }

    /// A field as a number with its sign; NaN for a missing value, `None` for what is no number or has other letters.
    pub fn value(&self, field: &str, decimal_comma: bool) -> Option<f64> {
        let (value, mark) = marked(field, decimal_comma)?;
        let known = mark.is_empty() || self.unit.as_deref() == Some(mark);
        match self.sides {
            // Amidships has no side.
            Some(_) if mark.is_empty() => (value == 0.0 || value.is_nan()).then_some(value),
            Some(sides) => sides.sign(mark).filter(|_| value >= 0.0).map(|sign| sign * value),
            None => (known || among(&TRUE, mark) || (self.magnetic && among(&MAGNETIC, mark))).then_some(value),
        }
    }
}

fn among(words: &[&str], mark: &str) -> bool {
    words.iter().any(|word| mark.eq_ignore_ascii_case(word))
}

/// The signs that a column of letters alone gives to the numbers of another with this meaning, NaN where it has none; `None` where it
/// contains anything else. A telegraph says `HALF ASTERN`, and keeps the sense where it says `STOP`.
pub fn signs<'a>(fields: impl Iterator<Item = &'a str> + Clone, meaning: Option<Meaning>) -> Option<Vec<f64>> {
    let sides = Sides::of(meaning, fields.clone().map(str::trim))?;
    let telegraph = meaning.is_some_and(|m| m.quantity() == Quantity::Rotation);
    let mut last = 1.0;
    let mut sign = |field: &'a str| {
        let words = || field.split(|c: char| !c.is_alphanumeric());
        let order = || words().find_map(|w| sides.sign(w)).or(words().any(|w| among(&STOPPED, w)).then_some(last));
        last = sides.sign(field).or_else(|| telegraph.then(order).flatten())?;
        Some(last)
    };
    let signs: Option<Vec<f64>> =
        fields.map(|f| if number(f, true).is_some() { Some(f64::NAN) } else { sign(f.trim()) }).collect();
    signs.filter(|signs| signs.iter().any(|s| s.is_finite()))
}

/// A field as a number, or an arc in degrees, and the letters before or after it.
fn marked(field: &str, decimal_comma: bool) -> Option<(f64, &str)> {
    let field = field.trim();
    if let Some(value) = number(field, decimal_comma) {
        return Some((value, ""));
    }
    let core = |c: char| c.is_ascii_digit() || " +-.,\u{a0}".contains(c) || is_arc(c);
    let from = field.find(|c: char| c.is_ascii_digit() || "+-".contains(c))?;
    let (before, rest) = (field[..from].trim(), &field[from..]);
    let end = rest.find(|c| !core(c)).unwrap_or(rest.len());
    let (mut text, mut after) = (rest[..end].trim(), rest[end..].trim());
    // The degree sign of `12 °/min` is that of the unit.
    if after.starts_with('/') {
        text = text.trim_end_matches(is_degree).trim_end();
        after = rest[rest.find(is_degree)?..].trim();
    }
    let mark = match (before, after) {
        ("", mark) | (mark, "") => mark,
        _ => return None,
    };
    let value = number(text, decimal_comma).or_else(|| arc(text, decimal_comma, !mark.is_empty()))?;
    value.is_finite().then_some((value, mark))
}

fn is_degree(c: char) -> bool {
    ['°', 'º', '˚'].contains(&c)
}

/// Whether a character parts degrees, minutes and seconds.
fn is_arc(c: char) -> bool {
    is_degree(c) || ['\'', '"', '′', '″', '’', '”', '´'].contains(&c)
}

/// Degrees, minutes and seconds as degrees: `51°30.25'`, `51 30.25` and `51-30.25` where a letter of the hemisphere is beside it.
fn arc(text: &str, decimal_comma: bool, lettered: bool) -> Option<f64> {
    let (sign, text) = text.strip_prefix('-').map_or((1.0, text), |rest| (-1.0, rest));
    if !lettered && !text.contains(is_arc) {
        return None;
    }
    let parts: Vec<&str> =
        text.split(|c: char| is_arc(c) || " -\u{a0}".contains(c)).filter(|p| !p.is_empty()).collect();
    let digits = |p: &str| p.bytes().all(|b| b.is_ascii_digit() || b == b'.' || b == b',');
    let whole = |p: &str| p.bytes().all(|b| b.is_ascii_digit());
    let (last, leading) = parts.split_last()?;
    if parts.len() > 3 || !digits(last) || !leading.iter().all(|p| whole(p)) {
        return None;
    }
    let values = parts.iter().map(|p| number(p, decimal_comma)).collect::<Option<Vec<f64>>>()?;
    let possible = values[1..].iter().all(|v| (0.0..60.0).contains(v));
    let degrees: f64 = values.iter().zip([1.0, 60.0, 3600.0]).map(|(v, share)| v / share).sum();
    (possible && degrees.is_finite()).then_some(sign * degrees)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(fields: &[&str], meaning: Meaning) -> Vec<Option<f64>> {
        let marks = Marks::of(fields.iter().copied(), Some(meaning), false);
        fields.iter().map(|f| marks.value(f, false)).collect()
    }

    #[test]
    fn places_are_read_as_people_write_them() {
        let same = [
            "51.504166666666667 S",
            "S51.504166666666667",
            "51°30.25'S",
            "51° 30.25' S",
            "51°30′15″S",
            "51°30'15.0\"S",
            "51 30.25 S",
            "S 51 30.25",
            "51-30.25S",
            "-51°30.25'",
            "51.504166666666667° south",
        ];
        for text in same {
            let value = read(&[text, "10 S"], Meaning::Latitude)[0].or_else(|| read(&[text], Meaning::Latitude)[0]);
            assert!(value.is_some_and(|v| (v + 51.504_166_666).abs() < 1e-8), "{text}: {value:?}");
        }
        assert_eq!(read(&["10 E", "10 W"], Meaning::Longitude), [Some(10.0), Some(-10.0)]);
        assert_eq!(read(&["51 75.5 N", "51 30 7 8 N", "51 30.25"], Meaning::Latitude), [None; 3]);
        // Degrees and minutes in one number stay as they are: that is seen in all of them together.
        assert_eq!(read(&["5130.25N"], Meaning::Latitude), [Some(5130.25)]);
    }

    #[test]
    fn a_letter_is_a_side_of_what_it_stands_beside() {
        let rudder = Meaning::Channel(Channel::Delta);
        let fields = ["P 10", "10.5S", "Port 3.0", "2.5° STBD", "0.0", "-", "4.0"];
        let values = read(&fields, rudder);
        assert_eq!(values[..5], [Some(-10.0), Some(10.5), Some(-3.0), Some(2.5), Some(0.0)]);
        assert!(values[5].is_some_and(f64::is_nan) && values[6].is_none());
        assert_eq!(read(&["Bb 0.0", "Bb 3.5", "Stb 2.0"], rudder), [Some(0.0), Some(-3.5), Some(2.0)]);
        assert_eq!(read(&["3,5 Bâbord", "tribord 2"], rudder)[1], Some(2.0));
        assert_eq!(read(&["P 10", "S 5"], Meaning::Latitude), [None, Some(-5.0)]);
        // Left and right in Polish, where both would be port.
        assert_eq!(read(&["L 10", "2.5P"], rudder), [Some(-10.0), Some(2.5)]);
        assert_eq!(signs(["L", "P"].into_iter(), Some(rudder)), Some(vec![-1.0, 1.0]));
        let telegraph = ["STOP", "HALF AHEAD", "Stop", "D. SLOW ASTERN", "STOP"];
        let senses = signs(telegraph.into_iter(), Some(Meaning::Channel(Channel::N)));
        assert_eq!(senses, Some(vec![1.0, 1.0, 1.0, -1.0, -1.0]));
        assert_eq!(signs(["P", "Stbd", ""].into_iter(), Some(rudder)).map(|s| s[..2].to_vec()), Some(vec![-1.0, 1.0]));
        assert_eq!(signs(["S", "S"].into_iter(), Some(Meaning::Latitude)), Some(vec![-1.0, -1.0]));
        assert!(
            signs(["N", "S"].into_iter(), Some(rudder)).is_none() && signs([""].into_iter(), Some(rudder)).is_none()
        );
    }

    #[test]
    fn a_unit_may_stand_beside_every_number() {
        let fields = ["11.5 kn", "12 kn"];
        assert_eq!(Marks::of(fields.into_iter(), None, false).unit.as_deref(), Some("kn"));
        assert_eq!(read(&["12 °/min", "-3.5 °/min"], Meaning::Channel(Channel::R)), [Some(12.0), Some(-3.5)]);
        assert_eq!(read(&["023.4 T", "5 x"], Meaning::Channel(Channel::Psi)), [Some(23.4), None]);
    }
}
