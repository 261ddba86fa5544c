//! Why files could not be imported: where, what is wrong, and what to do next.
//! Doubts that do not hinder an import are notes of the result, not errors.

use crate::recording::Channel;
use std::path::PathBuf;

/// The option that names the column of an input.
pub(super) fn flag(input: Channel) -> String {
    let option = if matches!(input, Channel::Command(_)) { "--actuator" } else { "--column" };
    format!("{option} {input}=NAME")
}

/// Why files could not be imported.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ImportError {
    /// A file could not be read.
    #[error("{path}: cannot read the file ({source}); check the path", path = path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A place in a file.
    #[error("{path}:{line}:{column}: {message}", path = path.display())]
    At {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// Field of the line, counted from 1.
        column: usize,
        /// What is wrong and what to do.
        message: String,
    },
    /// A file as a whole.
    #[error("{path}: {message}", path = path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What is wrong and what to do.
        message: String,
    },
    /// What the files do not say: everything at once, each with the flag to pass.
    #[error("the files do not contain everything that is needed: {}; pass what is asked for and import again", .0.join("; "))]
    Undecided(
        /// What is not known, and the flag that says it.
        Vec<String>,
    ),
    /// A choice that cannot be.
    #[error("{0}")]
    Choice(
        /// What is wrong and what to do.
        String,
    ),
}
