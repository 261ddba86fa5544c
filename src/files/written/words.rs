//! What the TOML reader and serde say of a value, in the words of those who wrote it: a number, a text, a list, a table.
//! The place is with those who ask.

use crate::files::suggestion;

/// Names that serde has for what is expected, and the words for them.
const EXPECTED: [(&str, &str); 10] = [
    ("f64", "a number, without quotes and without a unit"),
    ("usize", "a whole number of 0 or more"),
    ("u64", "a whole number of 0 or more"),
    ("u32", "a whole number of 0 or more"),
    ("a boolean", "true or false, without quotes"),
    ("a string", "a text in quotes"),
    ("path string", "the name of a file in quotes"),
    ("a sequence", "a list in square brackets"),
    ("a map", "a table"),
    ("wanted string or table", "a word in quotes"),
];

/// Names that serde has for what was found, and the words for them.
const FOUND: [(&str, &str); 7] = [
    ("string ", "the text "),
    ("integer ", "the number "),
    ("floating point ", "the number "),
    ("boolean ", ""),
    ("sequence", "a list"),
    ("map", "a table"),
    ("unit value", "nothing"),
];

/// What serde says of an unknown key or word.
pub(super) struct Unknown<'a> {
    /// The key or word.
    pub(super) found: &'a str,
    /// Whether it is a key.
    pub(super) is_key: bool,
    /// What is known.
    known: Vec<&'a str>,
}

/// Serde writes: unknown field `found`, expected one of `a`, `b`.
pub(super) fn unknown(message: &str) -> Option<Unknown<'_>> {
    let is_key = message.starts_with("unknown field");
    if !is_key && !message.starts_with("unknown variant") {
        return None;
    }
    let mut quoted = message.split('`').skip(1).step_by(2);
    Some(Unknown { found: quoted.next()?, is_key, known: quoted.collect() })
}

impl Unknown<'_> {
    /// What is wrong and what would be right.
    pub(super) fn joined(&self) -> String {
        let what = if self.is_key { "unknown key" } else { "unknown word" };
        let near = suggestion(self.found, self.known.iter().copied());
        let one = if self.is_key { "the keys here are" } else { "it must be one of" };
        let list: Vec<String> = self.known.iter().map(|k| format!("`{k}`")).collect();
        let list =
            if list.is_empty() { "; there are none here".into() } else { format!("; {one} {}", list.join(", ")) };
        format!("{what} `{}`{near}{list}", self.found)
    }
}

/// What serde says of a value that is in no file, in the words of those who gave it, with the nearest of the known keys or words.
pub fn in_words(message: &str) -> String {
    unknown(message).map_or_else(|| plain(message, None), |unknown| unknown.joined())
}

/// The key of which serde says that it is missing.
pub(super) fn missing(message: &str) -> Option<&str> {
    message.strip_prefix("missing field `")?.split('`').next()
}

/// The words for a key that is missing at a place.
pub(super) fn missing_key(key: &str, place: &str) -> String {
    format!("the key `{key}` is missing{place}; add it")
}

/// The key of which [`missing_key`] says that it is missing.
pub(super) fn missing_told(message: &str) -> Option<&str> {
    let (key, rest) = message.strip_prefix("the key `")?.split_once('`')?;
    rest.starts_with(" is missing").then_some(key)
}

/// What serde says of a value of the wrong kind, with the key where there is one.
pub(super) fn plain(message: &str, key: Option<&str>) -> String {
    let of = key.map_or(String::new(), |k| format!("`{k}`: "));
    let kind = message.strip_prefix("invalid type: ").or_else(|| message.strip_prefix("invalid value: "));
    match kind.and_then(|rest| rest.split_once(", expected ")) {
        Some((found, expected)) => format!("{of}found {}, but it must be {}", as_found(found), as_expected(expected)),
        None => match EXPECTED.iter().find(|(name, _)| *name == message) {
            Some((_, words)) => format!("{of}it must be {words}"),
            None => match message.strip_prefix("invalid length ").and_then(|rest| rest.split_once(", expected ")) {
                Some((length, expected)) => {
                    let expected =
                        expected.replace("an array of length ", "").replace("fewer elements in array", "fewer");
                    format!("{of}it has {length} values, but must have {expected}")
                }
                None => format!("{of}{message}"),
            },
        },
    }
}

fn as_found(found: &str) -> String {
    let words = FOUND.iter().find_map(|(name, words)| Some(format!("{words}{}", found.strip_prefix(name)?)));
    words.unwrap_or_else(|| found.to_owned())
}

fn as_expected(expected: &str) -> String {
    if expected.starts_with("struct ") {
        return "a table, such as { key = value }".to_owned();
    }
    EXPECTED.iter().find(|(name, _)| *name == expected).map_or(expected, |(_, words)| words).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_serde_says_is_put_into_words() {
        let said = |message| plain(message, Some("window"));
        assert_eq!(
            said("invalid type: string \"60 s\", expected f64"),
            "`window`: found the text \"60 s\", but it must be a number, without quotes and without a unit"
        );
        assert_eq!(
            said("invalid value: integer `-5`, expected usize"),
            "`window`: found the number `-5`, but it must be a whole number of 0 or more"
        );
        assert!(said("invalid type: map, expected struct Setting").ends_with("a table, such as { key = value }"));
        assert_eq!(
            said("invalid length 2, expected an array of length 3"),
            "`window`: it has 2 values, but must have 3"
        );
        assert_eq!(plain("a law of its own", None), "a law of its own");
    }

    #[test]
    fn the_nearest_word_stands_beside_one_that_is_not_known() {
        assert_eq!(
            in_words("unknown variant `gauss_nweton`, expected one of `gauss-newton`, `exact`"),
            "unknown word `gauss_nweton`, did you mean `gauss-newton`?; it must be one of `gauss-newton`, `exact`"
        );
        assert!(in_words("unknown field `onn`, expected `on` or `from`").contains("did you mean `on`?"));
        assert!(in_words("invalid value: integer `-1`, expected usize").ends_with("a whole number of 0 or more"));
    }
}
