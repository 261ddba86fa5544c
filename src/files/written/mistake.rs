//! One mistake in a file written by hand, and how several are reported together.
//! Which error type carries them is decided by those who read the file.

use std::path::Path;

/// A mistake in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mistake {
    /// Line, counted from 1.
    pub line: usize,
    /// What is wrong, and what to do.
    pub message: String,
    /// The key, where the file has one that is not known.
    pub unknown: Option<String>,
}

impl Mistake {
    /// A mistake at a line.
    pub fn new(line: usize, message: impl Into<String>) -> Self {
        Self { line, message: message.into(), unknown: None }
    }
}

/// The line of the first mistake, and one message of all: those after the first stand on lines of their own, each with its place.
pub fn joined(mut mistakes: Vec<Mistake>, path: &Path) -> (usize, String) {
    mistakes.sort_by_key(|m| m.line);
    mistakes.dedup();
    let further = |m: &Mistake| format!("\n{}:{}: {}", path.display(), m.line, m.message);
    match mistakes.split_first() {
        Some((first, rest)) => (first.line, rest.iter().fold(first.message.clone(), |all, m| all + &further(m))),
        None => (1, String::new()),
    }
}

/// The line, counted from 1, of a byte offset in a text.
pub fn line_at(text: &str, offset: usize) -> usize {
    1 + text.bytes().take(offset).filter(|b| *b == b'\n').count()
}
