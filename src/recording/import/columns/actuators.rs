//! Which column drives which named actuator of the ship file, by the words of both names: `thr_left` is the rate of `port`.
//! Units are decided elsewhere, and a column that fits two channels is left to the user.

use super::names::words;
use crate::recording::{Channel, Quantity};
use std::collections::{BTreeMap, BTreeSet};

/// Words that are written for one place of a ship, the first of each the usual one.
const PLACES: [&[&str]; 6] = [
    &["port", "left", "ps", "bb", "l"],
    &["starboard", "right", "stbd", "sb", "stb", "r"],
    &["bow", "fore", "front", "forward", "fwd"],
    &["stern", "aft", "rear", "back"],
    &["mid", "middle", "centre", "center"],
    &["tunnel", "lateral", "transverse"],
];

/// Words that say what a channel is, and not of which actuator.
const KINDS: [(&[&str], Option<Quantity>); 5] = [
    (&["n", "rpm", "rps", "rate", "speed", "revs", "rev", "omega"], Some(Quantity::Rotation)),
    (
        &["azi", "azimuth", "angle", "alpha", "direction", "steering", "rudder", "delta", "helm", "rsa"],
        Some(Quantity::Angle),
    ),
    (&["u", "cmd", "command", "order", "throttle", "pwm", "pitch", "duty"], Some(Quantity::Number)),
    (&["force", "thrust", "tau", "fx", "fy", "x", "y"], Some(Quantity::Force)),
    (
        &[
            "thr",
            "thruster",
            "motor",
            "engine",
            "propeller",
            "prop",
            "screw",
            "pod",
            "feedback",
            "fb",
            "actual",
            "meas",
            "pct",
            "percent",
        ],
        None,
    ),
];

/// Words that leave no doubt of what a column is though it names no actuator: `speed` and `angle` may be the ship's.
const PLAIN: [&str; 18] = [
    "rpm",
    "rps",
    "revs",
    "rev",
    "azi",
    "azimuth",
    "steering",
    "rudder",
    "helm",
    "rsa",
    "throttle",
    "pwm",
    "duty",
    "thruster",
    "motor",
    "engine",
    "propeller",
    "screw",
];

/// The words of a name with one word for each place, numbers apart from letters (`n1` is `n 1`), as a set.
fn parts(name: &str) -> BTreeSet<String> {
    let mut apart = String::new();
    let mut digit = false;
    for c in name.chars() {
        if c.is_ascii_digit() != digit {
            apart.push(' ');
        }
        digit = c.is_ascii_digit();
        apart.push(c);
    }
    let usual = |word: String| PLACES.iter().find(|p| p.contains(&word.as_str())).map_or(word, |p| p[0].to_owned());
    words(&apart).into_iter().map(usual).collect()
}

/// Which words of an actuator's name a column must have.
#[derive(Clone, Copy, PartialEq)]
enum Asked {
    /// All of them: `thruster_1` is `Thruster 1`.
    All,
    /// Those that do not say what it is: `azi_1` is `n1`, `a1` and `Motor 1`.
    Distinguishing,
    /// None, of a column that says its kind and nothing else: `RPM` is the rate of the only actuator that has one.
    None,
}

/// Whether a column drives this channel, by their names and the unit that the file gives.
fn drives(channel: Channel, column: &str, unit: Option<&str>, asked: Asked) -> bool {
    let quantity = channel.info().quantity;
    let (actuator, _) = channel.name().split_once('.').unwrap_or((channel.name(), ""));
    let (mut wanted, mut found) = (parts(actuator), parts(column));
    let said: Vec<Quantity> =
        found.iter().filter_map(|w| KINDS.iter().find(|(k, _)| k.contains(&w.as_str()))?.1).collect();
    let kind = |word: &String| KINDS.iter().any(|(kinds, _)| kinds.contains(&word.as_str()));
    match asked {
        Asked::All => {}
        Asked::Distinguishing => wanted.retain(|word| !kind(word)),
        Asked::None => wanted.clear(),
    }
    found.retain(|word| wanted.contains(word) || !kind(word));
    let fits = unit.is_none_or(|unit| quantity.factor(unit).is_some());
    // A column that says nothing of its kind is the rate or the order, which every actuator has one of.
    let usual = matches!(quantity, Quantity::Rotation | Quantity::Number);
    let alike = if said.is_empty() { usual } else { said.contains(&quantity) };
    match asked {
        Asked::All | Asked::Distinguishing => !wanted.is_empty() && wanted == found && fits && alike,
        Asked::None => {
            let plain = |word: &String| PLAIN.contains(&word.as_str());
            found.is_empty() && said == [quantity] && fits && parts(column).iter().any(plain)
        }
    }
}

/// The column of each of these channels, where one column alone has its name and it is the name of no other of them: first by all words
/// of the names, then, of what is left, by those that tell one actuator from another, then by the kind alone.
pub fn by_names(columns: &[(&str, Option<&str>)], channels: &[Channel]) -> BTreeMap<String, Channel> {
    let mut named: BTreeMap<String, Channel> = BTreeMap::new();
    for asked in [Asked::All, Asked::Distinguishing, Asked::None] {
        let left: Vec<Channel> = channels.iter().filter(|c| !named.values().any(|n| n == *c)).copied().collect();
        let free: Vec<_> = columns.iter().filter(|(name, _)| !named.contains_key(*name)).collect();
        let of = |channel: Channel| free.iter().filter(move |(name, unit)| drives(channel, name, *unit, asked));
        let alone = |channel: &Channel| {
            let mut fitting = of(*channel);
            let (first, second) = (fitting.next()?, fitting.next());
            let is_of = |other: &&Channel| *other != channel && of(**other).any(|c| c.0 == first.0);
            (second.is_none() && !left.iter().any(|other| is_of(&other))).then(|| (first.0.to_owned(), *channel))
        };
        let found: Vec<_> = left.iter().filter_map(alone).collect();
        named.extend(found);
    }
    named
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(columns: &[(&str, Option<&str>)], channels: &[&str]) -> BTreeMap<String, String> {
        let channels: Vec<Channel> = channels.iter().map(|name| Channel::from_name(name).unwrap()).collect();
        by_names(columns, &channels).into_iter().map(|(column, c)| (column, c.name().to_owned())).collect()
    }

    #[test]
    fn names_of_columns_are_those_of_actuators_in_other_words() {
        let columns = [
            ("thr_left", None),
            ("Thruster right", None),
            ("n1", Some("rpm")),
            ("azi_1", Some("deg")),
            ("speed", None),
        ];
        let channels = ["port.order", "starboard.order", "pod1.rate", "pod1.angle", "pod2.rate"];
        let found = found(&columns, &channels);
        assert_eq!(found["thr_left"], "port.order");
        assert_eq!(found["Thruster right"], "starboard.order");
        assert_eq!((found["n1"].as_str(), found["azi_1"].as_str(), found.len()), ("pod1.rate", "pod1.angle", 4));
        let numbered = self::found(&columns, &["thruster_1.rate", "thruster_1.angle"]);
        assert_eq!((numbered["n1"].as_str(), numbered["azi_1"].as_str()), ("thruster_1.rate", "thruster_1.angle"));
    }

    #[test]
    fn a_kind_alone_is_that_of_the_only_channel_of_its_kind() {
        let columns = [("RPM", None), ("Azi", None), ("u", None)];
        let one = found(&columns, &["azi.rate", "azi.angle"]);
        assert_eq!((one["RPM"].as_str(), one["Azi"].as_str(), one.len()), ("azi.rate", "azi.angle", 2));
        let two = found(&columns, &["port.rate", "starboard.rate"]);
        assert!(two.is_empty(), "{two:?}");
    }

    #[test]
    fn the_rudders_of_twin_screws_are_found_by_their_sides() {
        let columns =
            [("Rudder port", Some("deg")), ("rudder_stbd", Some("deg")), ("rpm_port", Some("rpm")), ("RPM stbd", None)];
        let found = found(
            &columns,
            &["port_screw.rate", "starboard_screw.rate", "port_rudder.angle", "starboard_rudder.angle"],
        );
        let of = |column: &str| found[column].as_str();
        assert_eq!([of("rpm_port"), of("RPM stbd")], ["port_screw.rate", "starboard_screw.rate"]);
        assert_eq!([of("Rudder port"), of("rudder_stbd")], ["port_rudder.angle", "starboard_rudder.angle"]);
    }

    #[test]
    fn all_words_of_a_name_count_before_those_that_tell_one_from_another() {
        let columns = [("thruster_1", Some("rpm")), ("n1", Some("rpm")), ("pod_1", Some("rpm"))];
        let found = found(&columns, &["thruster_1.rate", "pod_1.rate"]);
        assert_eq!((found["thruster_1"].as_str(), found["pod_1"].as_str()), ("thruster_1.rate", "pod_1.rate"));
        assert_eq!(found.len(), 2, "{found:?}");
    }

    #[test]
    fn a_number_stands_for_the_actuator_of_that_number() {
        let columns = [("n1", Some("rpm")), ("n2", Some("rpm")), ("azi_2", Some("deg")), ("azi_1", Some("deg"))];
        let found = found(&columns, &["a1.rate", "a1.angle", "a2.rate", "a2.angle"]);
        assert!(found.is_empty(), "the letter of the actuator is in no column: {found:?}");
    }

    #[test]
    fn a_column_that_fits_two_channels_is_left_to_the_user() {
        let columns = [("left", None), ("left_cmd", None)];
        assert!(found(&columns, &["port.order"]).is_empty());
        assert_eq!(found(&columns[..1], &["port.order"])["left"], "port.order");
    }
}
