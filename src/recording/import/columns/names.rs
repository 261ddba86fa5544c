//! Names of columns as ships and loggers write them: what is measured, and the unit where the name has one.
//! Whether a column is what its name says is checked against its values elsewhere.

use super::vocabulary::{
    BESIDE_COUNTS, BESIDE_SHIPS, CALENDAR, CHANGES, CLOCKS, COUNTS, DRIVES, FROM_BOW, FROM_NORTH, GOES_TO, LABVIEW,
    MAGNETIC, MOVES, NEUTRAL, ORDERS, PHRASES, RELATIVE, SHIPS, SINCE, SPEEDS, VAGUE, WATER, WIND, WIND_DIRECTIONS,
    WIND_SPEEDS, is_on, phrases,
};
use crate::recording::file::unit::scaled;
use crate::recording::import::signals::log::Meaning;
use crate::recording::{Channel, Quantity, UNITS};
use std::ops::Range;

/// A letter without its accent.
fn plain(c: char) -> char {
    match c {
        'à' | 'á' | 'â' | 'ã' | 'ä' | 'å' => 'a',
        'è' | 'é' | 'ê' | 'ë' => 'e',
        'ì' | 'í' | 'î' | 'ï' => 'i',
        'ò' | 'ó' | 'ô' | 'õ' | 'ö' | 'ø' => 'o',
        'ù' | 'ú' | 'û' | 'ü' => 'u',
        'ñ' => 'n',
        'ç' => 'c',
        other => other,
    }
}

/// Words of a name, in lower case and without accents: `Rudder_Angle` is `rudder angle`.
pub(in crate::recording::import) fn words(name: &str) -> Vec<String> {
    let mut spaced = String::new();
    let mut last_lower = false;
    // `Heading A/P`: the autopilot's.
    for c in name.replace("A/P", "AP").chars() {
        if c.is_uppercase() && last_lower {
            spaced.push(' ');
        }
        last_lower = c.is_lowercase();
        match c {
            '%' => spaced.push_str(" pct "),
            c => spaced.push(if c.is_alphanumeric() { c } else { ' ' }),
        }
    }
    let plain: String = spaced.to_lowercase().chars().map(plain).collect();
    plain.split_whitespace().map(str::to_owned).collect()
}

/// Spellings of units at the end of a name, as in `sog_kn`, and the unit.
const ENDINGS: [(&[&str], &str); 43] = [
    (&["pct"], "%"),
    (&["percent"], "%"),
    (&["norm"], "-"),
    (&["normalised"], "-"),
    (&["normalized"], "-"),
    (&["ms"], "ms"),
    (&["deg", "per", "min"], "deg/min"),
    (&["deg", "min"], "deg/min"),
    (&["deg", "s"], "deg/s"),
    (&["deg", "sec"], "deg/s"),
    (&["deg", "per", "s"], "deg/s"),
    (&["deg", "per", "sec"], "deg/s"),
    (&["degps"], "deg/s"),
    (&["dps"], "deg/s"),
    (&["rad", "s"], "rad/s"),
    (&["rad", "sec"], "rad/s"),
    (&["mrad", "s"], "mrad/s"),
    (&["mrad"], "mrad"),
    (&["cdeg", "s"], "cdeg/s"),
    (&["cdeg", "per", "s"], "cdeg/s"),
    (&["cdeg"], "cdeg"),
    (&["centideg"], "cdeg"),
    (&["centidegrees"], "cdeg"),
    (&["m", "s"], "m/s"),
    (&["m", "sec"], "m/s"),
    (&["mps"], "m/s"),
    (&["km", "h"], "km/h"),
    (&["kmh"], "km/h"),
    (&["deg"], "deg"),
    (&["degrees"], "deg"),
    (&["rad"], "rad"),
    (&["kn"], "kn"),
    (&["kt"], "kn"),
    (&["kts"], "kn"),
    (&["knots"], "kn"),
    (&["rpm"], "rpm"),
    (&["rps"], "rps"),
    (&["kmph"], "km/h"),
    (&["millis"], "ms"),
    (&["us"], "us"),
    (&["ns"], "ns"),
    (&["time", "min"], "min"),
    (&["time", "h"], "h"),
];

/// A header field as name and unit: `Rudder angle [deg]`, `SOG (kn)`, `hdg_deg`, `Shaft RPM`. A reference that stands with the unit
/// goes to the name: `Heading [°M]` is `Heading magnetic`. What stands in the place of a unit and is no word of a name is one, known or
/// not.
pub fn name_and_unit(field: &str) -> (String, Option<String>) {
    let field = field.trim().trim_matches('"').trim();
    for (open, close) in [('[', ']'), ('(', ')'), ('{', '}'), ('<', '>')] {
        if let Some((name, rest)) = field.split_once(open)
            && let Some((unit, _)) = rest.split_once(close)
        {
            let unit = unit.trim();
            // `Rudder [deg, + port]`.
            let (unit, more) = unit.split_once([',', ';']).filter(|(first, _)| is_unit(first)).unwrap_or((unit, ""));
            let name = format!("{} {}", name.trim(), more.trim()).trim().to_owned();
            if unit.is_empty() || (is_unit(unit) && !is_side(unit, &name)) {
                return (name, Some(unit.trim().to_owned()).filter(|u| !u.is_empty()));
            }
            if let Some((degrees, reference)) = referred(unit) {
                return (format!("{name} {reference}"), Some(degrees.to_owned()));
            }
            // `HDG (M)`.
            if unit == "M" && is_direction(&name) {
                return (format!("{name} magnetic"), None);
            }
            // `Heading (true)` has no unit in its brackets.
            if is_of_names(unit) {
                return (format!("{name} {unit}"), None);
            }
            return (name, Some(unit.to_owned()));
        }
    }
    // `True wind angle °`, `Heading °M`.
    if let Some((name, last)) = field.rsplit_once(' ')
        && last.starts_with('°')
    {
        let (unit, reference) = referred(last).unwrap_or((last, ""));
        if is_unit(unit) {
            return (format!("{name} {reference}").trim().to_owned(), Some(unit.to_owned()));
        }
    }
    let parts = words(field);
    let ending = ENDINGS.iter().find(|(end, _)| parts.len() >= end.len() && parts[parts.len() - end.len()..] == **end);
    (field.to_owned(), ending.map(|(_, unit)| (*unit).to_owned()))
}

/// A unit of angles with the north that it counts from, `°M` or `deg true`, as both.
fn referred(unit: &str) -> Option<(&str, &'static str)> {
    let parted = ["magnetic", "mag", "M", "true", "T"].into_iter().find_map(|end| {
        let degrees = unit.strip_suffix(end)?.trim_end_matches([' ', '_', '(']);
        Some((degrees, if end.starts_with(['m', 'M']) { "magnetic" } else { "true" }))
    });
    parted.filter(|(degrees, _)| crate::recording::Quantity::Angle.factor(degrees).is_some())
}

/// Whether a name is that of a heading or a course.
fn is_direction(name: &str) -> bool {
    meaning(name).is_some_and(|m| matches!(m, Meaning::Course | Meaning::Channel(Channel::Psi)))
}

/// Whether one letter beside a name is no unit of what it names but a side or a reference: `Latitude (N)`, `Rudder (S)`.
fn is_side(letter: &str, name: &str) -> bool {
    ["N", "S", "E", "W", "P", "T", "M"].contains(&letter)
        && name.chars().count() > 1
        && reading(name).is_some_and(|reading| reading.meaning.quantity().factor(letter).is_none())
}

/// Whether what stands in brackets belongs to the name before them: a word of names, a letter or a number.
fn is_of_names(text: &str) -> bool {
    let lists = [
        NEUTRAL, ORDERS, RELATIVE, MAGNETIC, CHANGES, MOVES, CLOCKS, WIND, SPEEDS, FROM_NORTH, FROM_BOW, GOES_TO,
        SHIPS, DRIVES,
    ];
    let phrased = |word: &str| {
        let mut all = PHRASES.iter().chain(VAGUE).flat_map(|(_, list)| phrases(list)).flat_map(|p| p.split(' '));
        all.any(|of| of == word)
    };
    let known = |word: &str| {
        word.chars().count() < 2 || lists.iter().any(|list| is_on(list, word)) || is_wind_word(word) || phrased(word)
    };
    !text.contains(['/', '^', '%']) && words(text).iter().any(|word| known(unnumbered(word)))
}

/// Whether a text is the spelling of a unit.
pub fn is_unit(text: &str) -> bool {
    let text = scaled(text.trim()).map_or(text, |(_, of)| of).trim();
    UNITS.iter().any(|u| u.spellings.iter().any(|s| !s.is_empty() && s.eq_ignore_ascii_case(text)))
}

/// What a name says a column is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// The quantity.
    pub meaning: Meaning,
    /// Share of the name's letters that the quantity's own words explain, 0 to 1.
    pub explained: f64,
}

/// A word such as `speed` may stand for several quantities: it explains this much of what a word of one quantity does. Between the
/// share of a name that is explained whole and that of one explained by half, so that `SOG` comes before `speed` and `speed` before
/// `SOG of the pilot's plug`.
pub const VAGUELY: f64 = 0.7;

/// What a name says a column is; `None` where it says nothing that is used.
pub fn meaning(name: &str) -> Option<Meaning> {
    reading(name).map(|reading| reading.meaning)
}

/// The quantity whose words explain most of a name and that no other word of it rules out.
pub fn reading(name: &str) -> Option<Reading> {
    if let Some(meaning) = Meaning::from_name(name.trim()) {
        return Some(Reading { meaning, explained: 1.0 });
    }
    let parts = without_unit(words(name));
    if let Some(wind) = wind(&parts) {
        return wind.map(|meaning| Reading { meaning, explained: share(&parts, is_wind_word) });
    }
    let all = [(PHRASES, 1.0), (VAGUE, VAGUELY)];
    let each = all.iter().flat_map(|(table, weight)| table.iter().map(move |(m, list)| (*m, *list, *weight)));
    let mut best: Option<Reading> = None;
    for (meaning, list, weight) in each {
        for phrase in phrases(list) {
            let Some(at) = found(&parts, phrase).filter(|at| !ruled_out(meaning, &parts, at)) else { continue };
            // `Heading gyro`: another word of the same quantity leaves nothing unexplained.
            let of = |i: usize| at.contains(&i) || is_on(list, &parts[i]);
            let explained = weight * share_by_place(&parts, of);
            if best.is_none_or(|best| explained > best.explained) {
                best = Some(Reading { meaning, explained });
            }
        }
    }
    let best = best?;
    if !parts.iter().any(|p| is_on(ORDERS, p)) {
        return Some(best);
    }
    match best.meaning {
        Meaning::Channel(Channel::Delta) => Some(Reading { meaning: Meaning::Channel(Channel::DeltaOrder), ..best }),
        Meaning::Channel(Channel::N) => Some(Reading { meaning: Meaning::Channel(Channel::NOrder), ..best }),
        _ => None,
    }
}

/// Whether a name is that of a position in a pose of ROS.
pub fn is_pose(name: &str) -> bool {
    let parts = words(name);
    found(&parts, "pose position").is_some() && !parts.iter().any(|p| p == "ned")
}

/// The words of a name without those of its unit.
fn without_unit(mut parts: Vec<String>) -> Vec<String> {
    let ends = |end: &[&str]| parts.len() > end.len() && parts[parts.len() - end.len()..] == *end;
    if let Some((end, _)) = ENDINGS.iter().filter(|(end, _)| ends(end)).max_by_key(|(end, _)| end.len()) {
        parts.truncate(parts.len() - end.len());
    }
    parts
}

/// Words of the third axis beside those of north and east.
const VERTICAL: [&str; 5] = ["u", "up", "d", "down", "z"];

/// Whether a name is that of a vertical velocity: in the place where two others say north and east it says up or down, `U Velocity` beside
/// `N Velocity` and `E Velocity`. Alone it is one along the ship.
pub fn is_vertical(name: &str, all: &[&str]) -> bool {
    let own = words(name);
    let Some(place) = own.iter().position(|word| VERTICAL.contains(&word.as_str())) else { return false };
    let level = |other: &str, word: &str| {
        let other = words(other);
        let same = |i: usize| if i == place { other[i] == word } else { other[i] == own[i] };
        other.len() == own.len() && (0..own.len()).all(same)
    };
    let is_there = |(word, m): (&str, Meaning)| all.iter().any(|other| level(other, word) && meaning(other) == Some(m));
    [("n", Meaning::VelocityNorth), ("e", Meaning::VelocityEast)].into_iter().all(is_there)
}

/// Where the words of a phrase stand in a name; `heading1` and `heading` are one word.
fn found(parts: &[String], phrase: &str) -> Option<Range<usize>> {
    let wanted: Vec<&str> = phrase.split(' ').collect();
    if wanted.len() == 1 && phrase.len() == 1 {
        let alone = parts.first().is_some_and(|p| p == phrase) && parts.len() <= 2;
        return alone.then_some(0..1);
    }
    let same = |part: &String, word: &str| part == word || (word.len() > 1 && unnumbered(part) == word);
    let at = parts.windows(wanted.len()).position(|w| w.iter().zip(&wanted).all(|(part, word)| same(part, word)))?;
    Some(at..at + wanted.len())
}

fn unnumbered(word: &str) -> &str {
    word.trim_end_matches(|c: char| c.is_ascii_digit())
}

/// Share of the letters of a name that are in words for which `counts` says so, among these and those that mean something else.
fn share_by_place(parts: &[String], counts: impl Fn(usize) -> bool) -> f64 {
    let (mut explained, mut unknown) = (0, 0);
    for (i, part) in parts.iter().enumerate() {
        let letters = part.chars().count();
        if counts(i) {
            explained += letters;
        } else if ![part.as_str(), unnumbered(part)]
            .iter()
            .any(|p| p.is_empty() || is_on(NEUTRAL, p) || is_on(ORDERS, p))
        {
            unknown += letters;
        }
    }
    explained as f64 / (explained + unknown).max(1) as f64
}

fn share(parts: &[String], counts: impl Fn(&str) -> bool) -> f64 {
    share_by_place(parts, |i| counts(&parts[i]))
}

/// Whether a word outside the phrase makes the column something else.
fn ruled_out(meaning: Meaning, parts: &[String], phrase: &Range<usize>) -> bool {
    use Channel::{Delta, Depth, Psi, R, U, UWater, V, X, Y};
    let beside = || parts.iter().enumerate().filter(|(i, _)| !phrase.contains(i)).map(|(_, p)| p.as_str());
    let is = |channels: &[Channel]| matches!(meaning, Meaning::Channel(c) if channels.contains(&c));
    let direction = is(&[Psi]) || meaning == Meaning::Course;
    let still = direction
        || is(&[Delta, X, Y, Depth])
        || matches!(meaning, Meaning::Latitude | Meaning::Longitude | Meaning::Variation);
    let speed = is(&[U, UWater]) || meaning == Meaning::GroundSpeed;
    beside().any(|word| {
        is_on(CHANGES, word)
            || (still && is_on(MOVES, word))
            || (word == "t" && !direction)
            || ((is(&[Psi, R, Delta])) && ["x", "y"].contains(&word))
            || (is(&[Psi]) && word == "z")
            || (speed && ["trans", "transverse", "transversal", "lateral"].contains(&word))
            // Depth under keel or transducer is no water depth.
            || (is(&[Depth]) && ["keel", "transducer", "below", "under"].contains(&word))
            || (is(&[U, V]) && word == "water")
            // A pose in a frame that counts x to the north.
            || (word == "ned" && parts[phrase.start] == "pose")
            || (meaning == Meaning::GroundSpeed && (is_on(WATER, word) || word == "sound"))
    })
}

fn is_wind_word(word: &str) -> bool {
    [WIND, WIND_SPEEDS, WIND_DIRECTIONS, RELATIVE, SPEEDS, FROM_NORTH, FROM_BOW].iter().any(|list| is_on(list, word))
        || ["theoretical", "wahrer", "wahre", "vrai", "reale", "real"].contains(&word)
}

/// What a name says of the wind: an angle counts from the bow, a direction from north, but that of an apparent wind, which is from the
/// bow. `None` where it is not of the wind, `Some(None)` where it is something else of it.
fn wind(parts: &[String]) -> Option<Option<Meaning>> {
    let any = |list: &'static str| parts.iter().any(|p| is_on(list, p));
    // `Speed TW` is through water, `TWS` a wind.
    if found(parts, "speed tw").is_some() {
        return None;
    }
    let [speeds, directions] = [any(WIND_SPEEDS), any(WIND_DIRECTIONS)];
    // Two letters alone are no wind: `AW_speed` is one, `AW` may be anything.
    let said = parts.iter().any(|p| is_on(WIND, p) && p.len() > 2)
        || (any(WIND) && (any(SPEEDS) || any(FROM_NORTH) || any(FROM_BOW)));
    if !(said || speeds || directions) {
        return None;
    }
    if parts.iter().any(|p| is_on(ORDERS, p) || is_on(GOES_TO, p) || (is_on(CHANGES, p) && !is_wind_word(p))) {
        return Some(None);
    }
    let relative = any(RELATIVE);
    let channel = match (speeds || any(SPEEDS), directions || any(FROM_NORTH), any(FROM_BOW)) {
        (true, false, false) if relative => Channel::ApparentWindSpeed,
        (true, false, false) => Channel::WindSpeed,
        (false, _, true) | (false, true, _) if relative => Channel::ApparentWindDirection,
        (false, true, _) => Channel::WindDirection,
        (false, false, true) => return Some(Some(Meaning::WindAngle)),
        _ => return Some(None),
    };
    Some(Some(Meaning::Channel(channel)))
}

/// Whether a name is that of a time, from the surest (3) to the least sure (1); 0 where it is none.
pub fn time_rank(name: &str) -> u8 {
    let parts = words(name);
    let any = |list: &'static str| parts.iter().any(|p| is_on(list, p));
    let since = |p: &String| ["update", "updated", "last", "since", "to", "until", "next"].contains(&p.as_str());
    if any(CLOCKS) {
        return if parts.iter().any(since) { 1 } else { 2 + u8::from(parts.iter().all(|p| is_on(CLOCKS, p))) };
    }
    if any(SINCE) || parts.join(" ") == LABVIEW {
        return 1;
    }
    u8::from((parts.first().is_some_and(|p| p == "t") && parts.len() <= 2) || time_unit(name).is_some())
}

/// The unit of a time by its name: `Hour of day` counts hours, `DOY` and `Day of year` days.
pub fn time_unit(name: &str) -> Option<&'static str> {
    let parts = words(name);
    if parts.join(" ").starts_with("day of") {
        return Some("d");
    }
    let (unit, _) = COUNTS.iter().find(|(_, list)| parts.iter().any(|p| is_on(list, p)))?;
    let beside = |p: &String| is_on(BESIDE_COUNTS, p) || COUNTS.iter().any(|(_, list)| is_on(list, p));
    parts.iter().all(beside).then_some(unit)
}

/// The columns of year, month, day, hour, minute and second among these names, each the first that is left; of `FROM` hour, minute and second
/// alone where that is 3.
pub fn calendar<'a, const FROM: usize, const COUNT: usize>(
    names: impl Iterator<Item = &'a str>,
) -> Option<[usize; COUNT]> {
    let names: Vec<Vec<String>> = names.map(words).collect();
    let mut found = [usize::MAX; COUNT];
    for (part, list) in CALENDAR[FROM..].iter().enumerate().take(COUNT) {
        let is = |(i, name): &(usize, &Vec<String>)| {
            !found[..part].contains(i) && matches!(name.as_slice(), [word] if is_on(list, word))
        };
        found[part] = names.iter().enumerate().find(is)?.0;
    }
    Some(found)
}

/// The propeller rate or its order by the unit: revolutions are counted of nothing else (`Port RPM`), but for what has a name of its own,
/// and other things that happen a minute only of what drives the ship (`Propeller [1/min]`).
pub fn by_revolutions(name: &str, unit: &str) -> Option<Reading> {
    Quantity::Rotation.factor(unit)?;
    let parts = without_unit(words(name));
    let has = |list: &'static str| parts.iter().any(|p| is_on(list, unnumbered(p)));
    // `ME speed [rpm]`: the speed is that of what drives the ship.
    let (drives, named) = (has(DRIVES), reading(name).is_some());
    let counted = !["1/", "min-", "min^", "s-", "s^", "Hz", "rad"].iter().any(|start| unit.starts_with(start));
    if has(CHANGES) || !(drives || (counted && !named)) {
        return None;
    }
    let of_unit = words(unit).iter().map(|word| word.chars().count()).sum::<usize>();
    let known = |p: &String| is_on(DRIVES, unnumbered(p)) || is_on(NEUTRAL, unnumbered(p)) || is_on(ORDERS, p);
    let unknown: usize = parts.iter().filter(|p| !known(p)).map(|p| unnumbered(p).chars().count()).sum();
    let channel = if has(ORDERS) { Channel::NOrder } else { Channel::N };
    Some(Reading { meaning: Meaning::Channel(channel), explained: of_unit as f64 / (of_unit + unknown) as f64 })
}

/// Whether a heading or a course counts from magnetic north, by its name.
pub fn is_magnetic(name: &str) -> bool {
    words(name).iter().any(|p| is_on(MAGNETIC, p))
}

/// Whether a column is taken only where no other is there: a magnetic heading, the rate of an engine next to that of its shaft.
pub fn is_second_choice(name: &str) -> bool {
    is_magnetic(name) || words(name).iter().any(|p| ["engine", "me", "moteur", "motore", "motor"].contains(&p.as_str()))
}

/// What is left of a name without the words of its quantity and of its unit: columns of one sensor share it.
pub fn source(name: &str) -> String {
    let parts = without_unit(words(name));
    let of_quantity = |p: &str| {
        let word = unnumbered(p);
        let axis = ["x", "y", "n", "e", "north", "east", "long", "longitudinal", "trans", "transverse", "lateral"];
        let named = |table: &[(Meaning, &'static str)]| table.iter().any(|(_, list)| is_on(list, word));
        axis.contains(&word) || is_wind_word(word) || named(PHRASES) || named(VAGUE)
    };
    // The number of a sensor stays: `gps1 lat` and `gps1 lon`, `lat1` and `lon1`.
    let kept = parts.iter().map(|p| if of_quantity(p) { p[unnumbered(p).len()..].to_owned() } else { p.clone() });
    kept.filter(|p| !p.is_empty()).collect::<Vec<_>>().join(" ")
}

/// Whether a column says whose row it is: MMSI, name of the ship.
pub fn is_ships_name(name: &str) -> bool {
    let parts = words(name);
    parts.iter().any(|p| is_on(SHIPS, p)) && parts.iter().all(|p| is_on(SHIPS, p) || is_on(BESIDE_SHIPS, p))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_in_several_columns_and_a_count_of_hours_or_days_are_known_by_their_names() {
        let columns = |names: &'static str| calendar::<0, 6>(names.split(' '));
        assert_eq!(columns("YYYY MM DD hh mm ss lat lon"), Some([0, 1, 2, 3, 4, 5]));
        assert_eq!(columns("Year lat lon Month Day Hour Minute Second"), Some([0, 3, 4, 5, 6, 7]));
        assert_eq!((columns("year lat month day"), columns("m d h s lat lon min")), (None, None));
        let cases = [
            ("DOY", Some("d")),
            ("Day of year", Some("d")),
            ("Hour of day", Some("h")),
            ("Engine hours", None),
            ("Time", None),
        ];
        for (name, rank) in [("Time", 3), ("datenum", 1), ("X_Value", 1), ("tow", 1), ("GPS TOW", 1), ("x", 0)] {
            assert_eq!(time_rank(name), rank, "{name}");
        }
        cases.iter().for_each(|(name, unit)| assert_eq!(time_unit(name), *unit, "{name}"));
    }

    #[test]
    fn what_stands_in_the_place_of_a_unit_is_a_unit_or_a_word_of_the_name() {
        for (field, name, unit) in [
            ("Depth (fm)", "Depth", Some("fm")),
            ("Rudder [increments]", "Rudder", Some("increments")),
            ("Heading [0.01 deg]", "Heading", Some("0.01 deg")),
            ("Drehzahl [U/min]", "Drehzahl", Some("U/min")),
            ("lat [min]", "lat", Some("min")),
            ("Rudder [deg, + port]", "Rudder + port", Some("deg")),
            ("Heading (true)", "Heading true", None),
            ("Heading (Gyro 1)", "Heading Gyro 1", None),
            ("Latitude (N)", "Latitude N", None),
            ("Rudder (S)", "Rudder S", None),
            ("Rudder (order)", "Rudder order", None),
            ("Heading (2)", "Heading 2", None),
        ] {
            assert_eq!(name_and_unit(field), (name.to_owned(), unit.map(str::to_owned)), "{field}");
        }
    }

    #[test]
    fn names_of_ships_and_loggers_are_understood() {
        let cases = [
            ("Rudder angle [deg]", "delta", Some("deg")),
            ("SOG (kn)", "sog", Some("kn")),
            ("hdg_deg", "psi", Some("deg")),
            ("rudder_cdeg", "delta", Some("cdeg")),
            ("heading_centidegrees", "psi", Some("cdeg")),
            ("yawrate_cdeg_s", "r", Some("cdeg/s")),
            ("RateOfTurn", "r", None),
            ("rot_deg_per_min", "r", Some("deg/min")),
            ("Heading (true)", "psi", None),
            ("rudder_order", "delta_order", None),
            ("Latitude", "lat", None),
            ("True wind speed [m/s]", "wind_speed", Some("m/s")),
            ("u [kn]", "u", Some("kn")),
            ("Ruderlage [°]", "delta", Some("°")),
            ("Fahrt über Grund [kn]", "sog", Some("kn")),
            ("RUD ORD", "delta_order", None),
            ("Prop. Rev. [rpm]", "n", Some("rpm")),
            ("North [m]", "x", Some("m")),
            ("δ <deg>", "delta", Some("deg")),
            ("speed_through_water_kn", "u_water", Some("kn")),
            ("Fart gjennom vann [kn]", "u_water", Some("kn")),
            ("Fart genom vatten (kn)", "u_water", Some("kn")),
            ("Speed (W) [kn]", "u_water", Some("kn")),
            ("Speed TW [kn]", "u_water", Some("kn")),
            ("EM log [kn]", "u_water", Some("kn")),
            ("Log [kn]", "u_water", Some("kn")),
            ("Speed (G) [kn]", "sog", Some("kn")),
            ("Rudder %", "delta", Some("%")),
            ("RPM_pct", "n", Some("%")),
            ("rudder_norm", "delta", Some("-")),
        ];
        for (field, expected, unit) in cases {
            let (name, found) = name_and_unit(field);
            assert_eq!(meaning(&name).map(Meaning::name), Some(expected), "{field}");
            assert_eq!(found.as_deref(), unit, "{field}");
        }
        // What is counted in revolutions is a propeller rate by its unit alone.
        for (field, expected) in [
            ("Shaft RPM", Some(Channel::N)),
            ("Port RPM", Some(Channel::N)),
            ("/motor/rpm", Some(Channel::N)),
            ("ME speed [U/min]", Some(Channel::N)),
            ("Propeller [min^-1]", Some(Channel::N)),
            ("Port order [rpm]", Some(Channel::NOrder)),
            ("Pump RPM", None),
            ("Bow thruster [rpm]", None),
            ("Alarms [1/min]", None),
        ] {
            let (name, unit) = name_and_unit(field);
            let found = by_revolutions(&name, unit.as_deref().unwrap_or("")).map(|r| r.meaning);
            assert_eq!(found, expected.map(Meaning::Channel), "{field}: {name} {unit:?}");
        }
        for field in [
            "Depth below keel",
            "Heading setpoint",
            "Heading A/P",
            "engine load",
            "UTC",
            "Rudder rate",
            "Rudder pump 1",
            "Sway acceleration",
        ] {
            assert_eq!(meaning(field), None, "{field}");
        }
    }
}
