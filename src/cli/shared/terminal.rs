//! Text as a terminal may have it: what would move the cursor, change colours or turn the order of letters is shown, not obeyed.
//! Names of runs, columns and files come from users' files; they reach the terminal through here only.

use super::style::on_stderr;
use std::fmt::Write as _;
use std::io::{Result, Write};
pub use trimtab::files::plain;
use trimtab::files::{controls, readable};

/// Prints a line on standard error; without a reader there is nothing to do about it.
pub fn tell(line: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{}", on_stderr(&plain(&readable(line))));
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
