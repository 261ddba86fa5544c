//! Why a study could not be used.
//! What is wrong with a recording is an error of `recording`, passed on here.

use crate::recording::RecordingError;
use std::path::PathBuf;

/// Why a study could not be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StudyError {
    /// A file could not be opened.
    #[error("{path}: cannot read the {what} ({source}); check the path", path = path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// `study` or `table of runs`.
        what: &'static str,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file is not of the expected shape, or a value in it cannot be.
    #[error("{path}:{line}: {message}", path = path.display())]
    Parse {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// What is wrong and what to do.
        message: String,
    },
    /// None of the data folders exists.
    #[error("{path}:{line}: no folder with the recordings: {tried}; correct `data`", path = path.display())]
    NoData {
        /// The study.
        path: PathBuf,
        /// Line of `data`.
        line: usize,
        /// What was tried, and what came of it.
        tried: String,
    },
    /// A recording named in the study is not there.
    #[error("{path}:{line}: recording {file} does not exist{suggestion}; correct `file`, or `data` in the study", path = path.display(), file = file.display())]
    MissingFile {
        /// The study or its table of runs.
        path: PathBuf,
        /// Line of the run.
        line: usize,
        /// The recording.
        file: PathBuf,
        /// `, did you mean ...?` or nothing.
        suggestion: String,
    },
    /// A recording or its column map has a fault.
    #[error(transparent)]
    Recording(#[from] RecordingError),
}
