//! File names made of names that users give: safe on every system, and distinct where the names are.
//! It makes no file.

use std::collections::HashSet;

/// Bytes that a name may have; systems allow 255, of which extensions and numbers need some.
const LONGEST: usize = 120;

/// Names that Windows keeps for devices, with any extension.
const DEVICES: [&str; 4] = ["con", "prn", "aux", "nul"];

/// A file name without extension for a name of any kind: letters, digits and `-_.` stay, everything else becomes `_`. It does not
/// begin or end with a dot, is not empty or too long, and is no device of Windows. Different names may become one: see [`Names`].
pub fn file_name(text: &str) -> String {
    let safe: String = text.chars().map(|c| if c.is_alphanumeric() || "-_.".contains(c) { c } else { '_' }).collect();
    let end = (0..=LONGEST.min(safe.len())).rev().find(|i| safe.is_char_boundary(*i)).unwrap_or(0);
    let mut name = safe[..end].trim_end_matches('.').to_owned();
    if name.starts_with('.') || name.is_empty() {
        name.insert(0, '_');
    }
    let stem = name.split('.').next().unwrap_or_default().to_lowercase();
    let port = |word: &str| stem.strip_prefix(word).is_some_and(|n| n.chars().count() == 1 && n != "0");
    if DEVICES.contains(&stem.as_str()) || port("com") || port("lpt") {
        name.insert(0, '_');
    }
    name
}

/// File names that all differ, also where a file system does not distinguish capitals from small letters.
#[derive(Clone, Debug, Default)]
pub struct Names {
    taken: HashSet<String>,
}

impl Names {
    /// The file name for a name, as [`file_name`] gives it; with `_2`, `_3` and so on where an earlier one took it.
    pub fn take(&mut self, text: &str) -> String {
        let name = file_name(text);
        let mut tried = name.clone();
        let mut count = 1_usize;
        while !self.taken.insert(tried.to_lowercase()) {
            count += 1;
            tried = format!("{name}_{count}");
        }
        tried
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn ordinary_names_stay_and_others_become_safe() {
        for name in ["ship_a_001", "zigzag-20.5", "Fähre", "試験_1"] {
            assert_eq!(file_name(name), name);
        }
        let cases = [
            ("a/b", "a_b"),
            ("../../etc/passwd", "_.._.._etc_passwd"),
            ("", "_"),
            (".", "_"),
            ("..", "_"),
            (".hidden", "_.hidden"),
            ("run.", "run"),
            ("nul", "_nul"),
            ("CON.a", "_CON.a"),
            ("com1", "_com1"),
            ("com10", "com10"),
            ("console", "console"),
            ("a\u{1b}[31mb", "a__31mb"),
        ];
        for (name, expected) in cases {
            assert_eq!(file_name(name), expected);
        }
    }

    #[test]
    fn names_that_collide_get_numbers() {
        let mut names = Names::default();
        let taken = ["a/b", "a b", "A_B", "a_b_2", "nul", "NUL", "c"].map(|n| names.take(n));
        assert_eq!(taken, ["a_b", "a_b_2", "A_B_3", "a_b_2_2", "_nul", "_NUL_2", "c"]);
    }

    proptest! {
        #[test]
        fn any_names_get_safe_and_distinct_file_names(given in prop::collection::vec("\\PC{0,8}|[aA/ .]{0,3}|.{150}", 1..20)) {
            let mut names = Names::default();
            let mut seen = HashSet::new();
            for text in &given {
                let name = names.take(text);
                prop_assert!(!name.is_empty() && name.len() <= LONGEST + 8 && !name.starts_with('.') && !name.ends_with('.'));
                prop_assert!(name.chars().all(|c| c.is_alphanumeric() || "-_.".contains(c)), "{}", name);
                prop_assert!(seen.insert(name.to_lowercase()), "{} is given twice", name);
            }
        }
    }
}
