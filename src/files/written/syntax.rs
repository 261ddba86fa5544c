//! Mistakes that keep a text from being TOML at all, reported by what people usually meant.
//! What the keys may be is not known here.

use super::mistake::{Mistake, line_at};
use toml::de::Error;

/// Most mistakes of this kind that are reported at once: one may bring others with it.
const MOST: usize = 5;

/// The mistakes, one a line.
pub(super) fn mistakes(text: &str, errors: &[Error]) -> Vec<Mistake> {
    let mut mistakes: Vec<Mistake> = Vec::new();
    for error in errors {
        let span = error.span().unwrap_or(0..0);
        let line = line_at(text, span.start);
        if mistakes.iter().all(|m| m.line != line) && mistakes.len() < MOST {
            let written = text.lines().nth(line - 1).unwrap_or_default();
            let key = text.get(span.clone()).unwrap_or_default();
            mistakes.push(Mistake::new(line, meant(error.message().trim(), written, key)));
        }
    }
    mistakes
}

/// What is wrong with a line, by the marks of what was meant; otherwise what the reader says.
fn meant(message: &str, line: &str, key: &str) -> String {
    let value = line.split_once('=').map(|(_, value)| value.trim());
    let digit_after = |text: &str, mark: char| {
        text.split_once(mark).is_some_and(|(before, after)| {
            before.ends_with(|c: char| c.is_ascii_digit()) && after.starts_with(|c: char| c.is_ascii_digit())
        })
    };
    let hint = if message.contains("duplicate key") {
        return format!("`{}` is there twice; keep one", key.trim());
    } else if line.contains(['“', '”', '„', '‘', '’', '«', '»']) {
        "these quotes are typographic; write straight ones, as in \"text\""
    } else if value.is_some_and(|v| v.starts_with('"') && v.contains('\\')) {
        "a backslash inside double quotes means something else; write `/` between folders, or use single quotes"
    } else if value.is_some_and(|v| !v.starts_with(['[', '{', '"', '\'']) && digit_after(v, ',')) {
        "a number has a decimal point, not a comma, as in 0.5"
    } else if line.trim_start().starts_with("//") {
        "a comment begins with `#`"
    } else if value.is_some_and(|v| v.starts_with(['.', '+', '-']) && message.contains("mantissa")) {
        "a number begins with a digit, as in 0.5"
    } else if value.is_some_and(|v| v.starts_with("True") || v.starts_with("False")) {
        "true and false are written in small letters"
    } else if value.is_none() && line.contains(':') {
        "a key and its value are joined by `=`, as in key = \"text\""
    } else if value.is_some_and(|v| v.starts_with('"') && v.matches('"').count() == 1) {
        "the quote at the end is missing"
    } else if value.is_some_and(|v| v.starts_with(|c: char| c.is_ascii_digit())) {
        "a number stands alone, without a unit"
    } else if message.contains("must be quoted") {
        "a text stands in quotes, as in key = \"text\""
    } else {
        return format!("{message}; `key = value` is expected, a text in quotes, a comment after `#`");
    };
    hint.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use toml::de::DeTable;

    fn said(text: &str) -> String {
        let mistakes = mistakes(text, &DeTable::parse_recoverable(text).1);
        assert!(!mistakes.is_empty() && mistakes[0].line == 2, "{text}: {mistakes:?}");
        mistakes[0].message.clone()
    }

    #[test]
    fn slips_of_the_hand_are_reported_by_what_was_meant() {
        for (line, words) in [
            ("step = 0,5", "decimal point"),
            ("ship = ship.toml", "stands in quotes"),
            ("ship = \"ship.toml", "quote at the end"),
            ("ship = “ship.toml”", "typographic"),
            ("ship: \"ship.toml\"", "joined by `=`"),
            ("file = \"C:\\data\\a.csv\"", "write `/`"),
            ("step = .5", "begins with a digit"),
            ("free = True", "small letters"),
            ("// a comment", "begins with `#`"),
            ("step = 10 s", "without a unit"),
            ("name = \"b\"", "`name` is there twice"),
        ] {
            let message = said(&format!("name = \"a\"\n{line}\n"));
            assert!(message.contains(words), "{line}: {message}");
        }
    }

    #[test]
    fn mistakes_on_several_lines_are_reported_at_once() {
        let text = "a = 0,5\nb = True\nc = 1\n";
        let lines: Vec<usize> = mistakes(text, &DeTable::parse_recoverable(text).1).iter().map(|m| m.line).collect();
        assert_eq!(lines, [1, 2]);
    }
}
