//! Text without characters that control a terminal: what would move the cursor, change colours or turn the order of letters is shown.
//! Names of runs come from users' files and go into tables, reports and messages; they are made plain where they are read.

use std::borrow::Cow;

/// Whether a character controls a terminal, beside ends of lines and tabulators: controls (C0, DEL, C1) and marks of direction.
pub fn controls(c: char) -> bool {
    (c.is_control() && c != '\n' && c != '\t')
        || matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// A text with every character that controls a terminal written as its number, such as `\u{1b}`.
pub fn plain(text: &str) -> Cow<'_, str> {
    if !text.chars().any(controls) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        if controls(c) {
            shown.extend(c.escape_unicode());
        } else {
            shown.push(c);
        }
    }
    Cow::Owned(shown)
}

/// Characters of one line of a message: four paths of the longest that systems allow are longer, and nobody reads them.
const LONGEST: usize = 4000;

/// A message whose lines keep to what can be read: of a longer one, as of a key of many megabytes, the beginning and the end are left.
pub fn readable(message: &str) -> Cow<'_, str> {
    if message.len() <= LONGEST {
        return Cow::Borrowed(message);
    }
    let cut = |line: &str| {
        let count = line.chars().count();
        if count <= LONGEST {
            return line.to_owned();
        }
        let half = LONGEST / 2;
        let (head, tail): (String, String) =
            (line.chars().take(half).collect(), line.chars().skip(count - half).collect());
        format!("{head} [{} characters left out] {tail}", count - 2 * half)
    };
    Cow::Owned(message.split('\n').map(cut).collect::<Vec<_>>().join("\n"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_controls_a_terminal_is_shown_as_its_number() {
        assert_eq!(plain("a\u{1b}[2J\u{202e}b"), "a\\u{1b}[2J\\u{202e}b");
        assert!(matches!(plain("Überfahrt\t1"), Cow::Borrowed(_)));
    }

    #[test]
    fn a_long_line_of_a_message_keeps_its_beginning_and_its_end() {
        let message = format!("study.toml:3: unknown key `{}`; remove it\nsecond", "k".repeat(1_000_000));
        let cut = readable(&message);
        assert!(cut.len() < 5000 && cut.starts_with("study.toml:3: ") && cut.ends_with("; remove it\nsecond"), "{cut}");
        assert_eq!(readable("short"), "short");
    }
}
