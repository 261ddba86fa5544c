//! Text as a terminal may have it: what would move the cursor, change colours or turn the order of letters is shown, not obeyed.
//! Names of runs, columns and files come from users' files; they reach the terminal through here only.

use super::style::told;
use std::borrow::Cow;
use std::fmt::Write as _;
use std::io::{Result, Write};

/// Whether a character controls a terminal, beside ends of lines and tabulators: controls (C0, DEL, C1) and marks of direction.
fn controls(c: char) -> bool {
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

/// Prints a line on standard error; without a reader there is nothing to do about it.
pub fn tell(line: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{}", told(&plain(line)));
}

/// A writer of JSON whose strings have such characters as `\uXXXX`; JSON itself asks this only below U+0020. Each call of `write`
/// must be given whole characters or bytes of ASCII.
pub struct Escaped<W: Write>(pub W);

impl<W: Write> Write for Escaped<W> {
    fn write(&mut self, bytes: &[u8]) -> Result<usize> {
        // serde_json and `BufWriter` hand on whole strings; what is no text is left as it is.
        match std::str::from_utf8(bytes) {
            Ok(text) if text.chars().any(controls) => {
                let mut shown = String::with_capacity(text.len());
                for c in text.chars() {
                    if controls(c) {
                        // Not a failure: a `String` takes everything.
                        let _ = write!(shown, "\\u{:04x}", u32::from(c));
                    } else {
                        shown.push(c);
                    }
                }
                self.0.write_all(shown.as_bytes())?;
            }
            _ => self.0.write_all(bytes)?,
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> Result<()> {
        self.0.flush()
    }
}
