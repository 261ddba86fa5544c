//! Names of columns as ships and loggers write them: what is measured, and the unit where the name has one.
//! Whether a column is what its name says is asked of its values elsewhere.

use super::log::Meaning;
use crate::recording::{Channel, UNITS};

/// Words of a name, in lower case: `Rudder_Angle` is `rudder angle`.
fn words(name: &str) -> Vec<String> {
    let mut spaced = String::new();
    let mut last_lower = false;
    for c in name.chars() {
        if c.is_uppercase() && last_lower {
            spaced.push(' ');
        }
        last_lower = c.is_lowercase();
        spaced.push(if c.is_alphanumeric() { c } else { ' ' });
    }
    spaced.to_lowercase().split_whitespace().map(str::to_owned).collect()
}

/// Spellings of units at the end of a name, as in `sog_kn`, and the unit.
const ENDINGS: [(&[&str], &str); 33] = [
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

/// A header field as name and unit: `Rudder angle [deg]`, `SOG (kn)`, `hdg_deg`, `Shaft RPM`.
pub fn name_and_unit(field: &str) -> (String, Option<String>) {
    let field = field.trim().trim_matches('"').trim();
    for (open, close) in [('[', ']'), ('(', ')'), ('{', '}'), ('<', '>')] {
        if let Some((name, rest)) = field.split_once(open)
            && let Some((unit, _)) = rest.split_once(close)
        {
            let unit = unit.trim();
            // `Heading (true)` has no unit in its brackets.
            if unit.is_empty() || is_unit(unit) {
                return (name.trim().to_owned(), Some(unit.to_owned()).filter(|u| !u.is_empty()));
            }
            return (format!("{} {unit}", name.trim()), None);
        }
    }
    let parts = words(field);
    let ending = ENDINGS.iter().find(|(end, _)| parts.len() >= end.len() && parts[parts.len() - end.len()..] == **end);
    (field.to_owned(), ending.map(|(_, unit)| (*unit).to_owned()))
}

/// Whether a text is the spelling of a unit.
pub fn is_unit(text: &str) -> bool {
    let text = text.trim();
    UNITS.iter().any(|u| u.spellings.iter().any(|s| !s.is_empty() && s.eq_ignore_ascii_case(text)))
}

/// Phrases that tell what a column is: the first that is found in a name. A phrase of one letter must be the whole name.
const PHRASES: &[(&str, Meaning)] = &[
    ("lat", Meaning::Latitude),
    ("latitude", Meaning::Latitude),
    ("breite", Meaning::Latitude),
    ("breddegrad", Meaning::Latitude),
    ("breedtegraad", Meaning::Latitude),
    ("lon", Meaning::Longitude),
    ("lng", Meaning::Longitude),
    ("long", Meaning::Longitude),
    ("longitude", Meaning::Longitude),
    ("länge", Meaning::Longitude),
    ("laenge", Meaning::Longitude),
    ("lengdegrad", Meaning::Longitude),
    ("lengtegraad", Meaning::Longitude),
    ("v north", Meaning::VelocityNorth),
    ("vn", Meaning::VelocityNorth),
    ("velocity north", Meaning::VelocityNorth),
    ("north velocity", Meaning::VelocityNorth),
    ("speed north", Meaning::VelocityNorth),
    ("north speed", Meaning::VelocityNorth),
    ("v east", Meaning::VelocityEast),
    ("ve", Meaning::VelocityEast),
    ("velocity east", Meaning::VelocityEast),
    ("east velocity", Meaning::VelocityEast),
    ("speed east", Meaning::VelocityEast),
    ("east speed", Meaning::VelocityEast),
    ("u water", Meaning::Channel(Channel::UWater)),
    ("v water", Meaning::Channel(Channel::VWater)),
    ("stw", Meaning::Channel(Channel::UWater)),
    ("speed through water", Meaning::Channel(Channel::UWater)),
    ("water speed", Meaning::Channel(Channel::UWater)),
    ("log speed", Meaning::Channel(Channel::UWater)),
    ("speed log", Meaning::Channel(Channel::UWater)),
    ("bank starboard", Meaning::Channel(Channel::BankStarboard)),
    ("bank port", Meaning::Channel(Channel::BankPort)),
    ("bow thruster", Meaning::Channel(Channel::Thruster)),
    ("thruster", Meaning::Channel(Channel::Thruster)),
    ("rudder", Meaning::Channel(Channel::Delta)),
    ("rud", Meaning::Channel(Channel::Delta)),
    ("ruderlage", Meaning::Channel(Channel::Delta)),
    ("ruderwinkel", Meaning::Channel(Channel::Delta)),
    ("ror", Meaning::Channel(Channel::Delta)),
    ("rorvinkel", Meaning::Channel(Channel::Delta)),
    ("roerhoek", Meaning::Channel(Channel::Delta)),
    ("rudderangle", Meaning::Channel(Channel::Delta)),
    ("rsa", Meaning::Channel(Channel::Delta)),
    ("helm", Meaning::Channel(Channel::Delta)),
    ("delta", Meaning::Channel(Channel::Delta)),
    ("δ", Meaning::Channel(Channel::Delta)),
    ("rot", Meaning::Channel(Channel::R)),
    ("rate of turn", Meaning::Channel(Channel::R)),
    ("turn rate", Meaning::Channel(Channel::R)),
    ("yaw rate", Meaning::Channel(Channel::R)),
    ("yawrate", Meaning::Channel(Channel::R)),
    ("drehrate", Meaning::Channel(Channel::R)),
    ("wendegeschwindigkeit", Meaning::Channel(Channel::R)),
    ("svinghastighet", Meaning::Channel(Channel::R)),
    ("draaisnelheid", Meaning::Channel(Channel::R)),
    ("cog", Meaning::Course),
    ("course", Meaning::Course),
    ("track made good", Meaning::Course),
    ("kurs über grund", Meaning::Course),
    ("kurs over grunn", Meaning::Course),
    ("grondkoers", Meaning::Course),
    ("sog", Meaning::GroundSpeed),
    ("speed over ground", Meaning::GroundSpeed),
    ("ground speed", Meaning::GroundSpeed),
    ("gps speed", Meaning::GroundSpeed),
    ("fahrt über grund", Meaning::GroundSpeed),
    ("fart over grunn", Meaning::GroundSpeed),
    ("heading", Meaning::Channel(Channel::Psi)),
    ("hdg", Meaning::Channel(Channel::Psi)),
    ("hdt", Meaning::Channel(Channel::Psi)),
    ("gyro", Meaning::Channel(Channel::Psi)),
    ("psi", Meaning::Channel(Channel::Psi)),
    ("yaw", Meaning::Channel(Channel::Psi)),
    ("compass", Meaning::Channel(Channel::Psi)),
    ("head", Meaning::Channel(Channel::Psi)),
    ("steuerkurs", Meaning::Channel(Channel::Psi)),
    ("ψ", Meaning::Channel(Channel::Psi)),
    ("rpm", Meaning::Channel(Channel::N)),
    ("rps", Meaning::Channel(Channel::N)),
    ("revs", Meaning::Channel(Channel::N)),
    ("rev", Meaning::Channel(Channel::N)),
    ("revolutions", Meaning::Channel(Channel::N)),
    ("revolution", Meaning::Channel(Channel::N)),
    ("drehzahl", Meaning::Channel(Channel::N)),
    ("propellerdrehzahl", Meaning::Channel(Channel::N)),
    ("turtall", Meaning::Channel(Channel::N)),
    ("toerental", Meaning::Channel(Channel::N)),
    ("shaft speed", Meaning::Channel(Channel::N)),
    ("propeller rate", Meaning::Channel(Channel::N)),
    ("propeller speed", Meaning::Channel(Channel::N)),
    ("propeller rotation", Meaning::Channel(Channel::N)),
    ("engine speed", Meaning::Channel(Channel::N)),
    ("northing", Meaning::Channel(Channel::X)),
    ("easting", Meaning::Channel(Channel::Y)),
    ("north", Meaning::Channel(Channel::X)),
    ("east", Meaning::Channel(Channel::Y)),
    ("x0", Meaning::Channel(Channel::X)),
    ("y0", Meaning::Channel(Channel::Y)),
    ("pos x", Meaning::Channel(Channel::X)),
    ("pos y", Meaning::Channel(Channel::Y)),
    ("surge", Meaning::Channel(Channel::U)),
    ("sway", Meaning::Channel(Channel::V)),
    ("wave height", Meaning::Channel(Channel::WaveHeight)),
    ("hs", Meaning::Channel(Channel::WaveHeight)),
    ("current speed", Meaning::Channel(Channel::CurrentSpeed)),
    ("current direction", Meaning::Channel(Channel::CurrentDirection)),
    ("wave direction", Meaning::Channel(Channel::WaveDirection)),
    ("wave dir", Meaning::Channel(Channel::WaveDirection)),
    ("depth", Meaning::Channel(Channel::Depth)),
    ("x", Meaning::Channel(Channel::X)),
    ("y", Meaning::Channel(Channel::Y)),
    ("u", Meaning::Channel(Channel::U)),
    ("v", Meaning::Channel(Channel::V)),
    ("r", Meaning::Channel(Channel::R)),
    ("n", Meaning::Channel(Channel::N)),
    ("speed", Meaning::GroundSpeed),
    ("spd", Meaning::GroundSpeed),
    ("geschwindigkeit", Meaning::GroundSpeed),
    ("snelheid", Meaning::GroundSpeed),
];

/// Words that make a column an order rather than a measurement.
const ORDERS: [&str; 16] = [
    "order",
    "ordered",
    "ord",
    "command",
    "commanded",
    "cmd",
    "set",
    "setpoint",
    "demand",
    "desired",
    "target",
    "ref",
    "reference",
    "requested",
    "soll",
    "sollwert",
];

/// Words that make a column something else of the thing that it names: how fast a rudder moves, whether its pump runs.
const ELSE: [&str; 22] = [
    "acceleration",
    "accel",
    "acc",
    "limit",
    "pump",
    "status",
    "state",
    "alarm",
    "mode",
    "running",
    "valid",
    "quality",
    "torque",
    "power",
    "load",
    "temperature",
    "temp",
    "pressure",
    "turbo",
    "turbocharger",
    "std",
    "covariance",
];

/// What a name says a column is; `None` where it says nothing that is used.
pub fn meaning(name: &str) -> Option<Meaning> {
    if let Some(meaning) = Meaning::from_name(name.trim()) {
        return Some(meaning);
    }
    let parts = words(name);
    if let Some(wind) = wind(&parts) {
        return Some(wind);
    }
    let has = |word: &str| parts.iter().any(|p| p == word);
    // Depth under keel or transducer is no water depth.
    if has("depth") && ["keel", "transducer", "below", "under"].iter().any(|w| has(w)) {
        return None;
    }
    let found = PHRASES.iter().find(|(phrase, _)| {
        let phrase: Vec<&str> = phrase.split(' ').collect();
        match phrase.as_slice() {
            [letter] if letter.len() == 1 => parts.first().is_some_and(|p| p == letter) && parts.len() <= 2,
            several => parts.windows(several.len()).any(|w| w == several),
        }
    });
    let meaning = found.map(|(_, meaning)| *meaning)?;
    let rate = matches!(meaning, Meaning::Channel(Channel::Delta)) && has("rate");
    if rate || ELSE.iter().any(|word| has(word)) {
        return None;
    }
    if !ORDERS.iter().any(|order| has(order)) {
        return Some(meaning);
    }
    match meaning {
        Meaning::Channel(Channel::Delta) => Some(Meaning::Channel(Channel::DeltaOrder)),
        Meaning::Channel(Channel::N) => Some(Meaning::Channel(Channel::NOrder)),
        _ => None,
    }
}

fn wind(parts: &[String]) -> Option<Meaning> {
    let has = |word: &str| parts.iter().any(|p| p == word);
    let short = [
        ("tws", Channel::WindSpeed),
        ("twd", Channel::WindDirection),
        ("aws", Channel::ApparentWindSpeed),
        ("awa", Channel::ApparentWindDirection),
    ];
    if let Some((_, channel)) = short.iter().find(|(word, _)| has(word)) {
        return Some(Meaning::Channel(*channel));
    }
    if !has("wind") {
        return None;
    }
    let relative = ["apparent", "relative", "rel"].iter().any(|w| has(w));
    let speed = has("speed");
    let direction = ["direction", "dir", "angle"].iter().any(|w| has(w));
    let channel = match (relative, speed, direction) {
        (false, true, _) => Channel::WindSpeed,
        (false, _, true) => Channel::WindDirection,
        (true, true, _) => Channel::ApparentWindSpeed,
        (true, _, true) => Channel::ApparentWindDirection,
        _ => return None,
    };
    Some(Meaning::Channel(channel))
}

/// Whether a name is that of a time, from the surest (2) to the least sure (1); 0 where it is none.
pub fn time_rank(name: &str) -> u8 {
    let parts = words(name);
    let has = |word: &str| parts.iter().any(|p| p == word);
    let clocks =
        ["timestamp", "datetime", "time", "utc", "epoch", "unix", "zeit", "uhrzeit", "zeitstempel", "tid", "tijd"];
    if clocks.iter().any(|w| has(w)) {
        return 2;
    }
    if ["stamp", "elapsed", "seconds", "secs", "sec", "millis"].iter().any(|w| has(w)) {
        return 1;
    }
    u8::from(parts.first().is_some_and(|p| p == "t") && parts.len() <= 2)
}

/// Whether a column that is counted in revolutions is that of the propeller or what drives it: `ME speed [rpm]`, `Propeller [1/min]`.
pub fn is_shaft(name: &str) -> bool {
    let parts = words(name);
    let has = |all: &[&str]| parts.iter().any(|p| all.contains(&p.as_str()));
    has(&["propeller", "prop", "shaft", "engine", "me"]) && !has(&ELSE) && !has(&ORDERS)
}

/// Whether a heading is that of a magnetic compass, by its name.
pub fn is_magnetic(name: &str) -> bool {
    words(name).iter().any(|p| ["magnetic", "mag", "hdm", "compass"].contains(&p.as_str()))
}

/// Whether a column is taken only where no other is there: a magnetic heading, the rate of an engine beside that of its shaft.
pub fn is_second_choice(name: &str) -> bool {
    is_magnetic(name) || words(name).iter().any(|p| ["engine", "me"].contains(&p.as_str()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_ships_and_loggers_are_understood() {
        let cases = [
            ("Rudder angle [deg]", "delta", Some("deg")),
            ("SOG (kn)", "sog", Some("kn")),
            ("hdg_deg", "psi", Some("deg")),
            ("Shaft RPM", "n", Some("rpm")),
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
        ];
        for (field, expected, unit) in cases {
            let (name, found) = name_and_unit(field);
            assert_eq!(meaning(&name).map(Meaning::name), Some(expected), "{field}");
            assert_eq!(found.as_deref(), unit, "{field}");
        }
        for field in [
            "Depth below keel",
            "Heading setpoint",
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
