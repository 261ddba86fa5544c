//! Which channel a name of everyday use stands for: `rudder`, `rpm` or `heading`, in a column map or in a header.
//! It helps messages alone: nothing is read by such a name.

use crate::recording::channel::{CHANNELS, Channel};

/// Everyday words that are not in the channels' own description.
const EVERYDAY: [(&str, Channel); 24] = [
    ("time", Channel::T),
    ("seconds", Channel::T),
    ("northing", Channel::X),
    ("north", Channel::X),
    ("easting", Channel::Y),
    ("east", Channel::Y),
    ("hdg", Channel::Psi),
    ("gyro", Channel::Psi),
    ("compass", Channel::Psi),
    ("yaw", Channel::Psi),
    ("sog", Channel::U),
    ("speed", Channel::U),
    ("surge", Channel::U),
    ("sway", Channel::V),
    ("rot", Channel::R),
    ("turn", Channel::R),
    ("rpm", Channel::N),
    ("rps", Channel::N),
    ("revs", Channel::N),
    ("shaft", Channel::N),
    ("propeller", Channel::N),
    ("helm", Channel::Delta),
    ("rudder", Channel::Delta),
    ("steering", Channel::Delta),
];

impl Channel {
    /// The channel that a name stands for by its meaning: the channel described by exactly these words, or else by one of them. A
    /// name that is a channel's own stands for that one.
    pub fn meant_by(name: &str) -> Option<Self> {
        let words: Vec<String> = name
            .to_lowercase()
            .split(|c: char| !c.is_alphanumeric())
            .filter(|w| !w.is_empty())
            .map(Into::into)
            .collect();
        let phrase = words.join(" ");
        let described = || CHANNELS.iter().find(|c| c.words == phrase).map(|c| c.channel);
        let everyday = |word: &String| EVERYDAY.iter().find(|(known, _)| known == word).map(|(_, channel)| *channel);
        // The yaw of `yaw_rate` is no heading: what is described in full goes before single words.
        Self::from_name(&words.join("_")).or_else(described).or_else(|| words.iter().find_map(everyday))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everyday_names_stand_for_channels() {
        for (name, channel) in [
            ("rudder", Channel::Delta),
            ("Rudder_Angle", Channel::Delta),
            ("rpm", Channel::N),
            ("Shaft RPM", Channel::N),
            ("heading", Channel::Psi),
            ("yaw rate", Channel::R),
            ("ROT", Channel::R),
            ("SOG", Channel::U),
            ("true wind speed", Channel::WindSpeed),
            ("delta", Channel::Delta),
        ] {
            assert_eq!(Channel::meant_by(name), Some(channel), "{name}");
        }
        assert_eq!(Channel::meant_by("fuel"), None);
    }
}
