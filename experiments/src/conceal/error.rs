//! Why a concealed case could not be made, written or judged.
//! Each message says what is wrong, where, and what to do.

use std::path::{Path, PathBuf};

/// Why a case could not be made, written or judged.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ConcealError {
    /// No such effect.
    #[error("unknown effect `{name}`; the effects are {known}")]
    UnknownEffect {
        /// Name given.
        name: String,
        /// All names.
        known: String,
    },
    /// The effect is part of the family's own structure.
    #[error("effect `{effect}` cannot be concealed in the {family} family, which contains it; choose --family hd")]
    NotInFamily {
        /// Effect.
        effect: &'static str,
        /// Family.
        family: &'static str,
    },
    /// A size outside the realistic range.
    #[error("size {size} {unit} of effect `{effect}` must lie in 0 to {most}")]
    Size {
        /// Effect.
        effect: &'static str,
        /// Size given.
        size: f64,
        /// Its unit.
        unit: &'static str,
        /// Largest size.
        most: f64,
    },
    /// The effect cannot be seen at any size tried.
    #[error("effect `{effect}` at {size} {unit} has a signal-to-noise ratio of {snr:.3}; give --size instead of --snr")]
    Invisible {
        /// Effect.
        effect: &'static str,
        /// Size tried.
        size: f64,
        /// Its unit.
        unit: &'static str,
        /// The ratio at that size.
        snr: f64,
    },
    /// The meter of the signal-to-noise ratio failed.
    #[error("cannot measure the signal-to-noise ratio: {message}")]
    Meter {
        /// The cause.
        message: String,
    },
    /// A file could not be read or written.
    #[error("{path}: {source}", path = path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: std::io::Error,
    },
    /// A file with the wrong content.
    #[error("{path}: {message}", path = path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        message: String,
    },
    /// The manifest or a recording has changed since it was sealed.
    #[error("{path}: SHA-256 is {found}, sealed was {sealed}; the case has been changed and cannot be judged", path = path.display())]
    Broken {
        /// The file.
        path: PathBuf,
        /// Digest found.
        found: String,
        /// Digest sealed.
        sealed: String,
    },
}

impl ConcealError {
    /// A file with the wrong content.
    pub fn content(path: &Path, message: &dyn std::fmt::Display) -> Self {
        Self::Content { path: path.to_owned(), message: message.to_string() }
    }

    /// A file that could not be read or written.
    pub fn file(path: &Path, source: std::io::Error) -> Self {
        Self::File { path: path.to_owned(), source }
    }
}
