//! Why a case of the campaign on real recordings could not be made, run or judged.
//! Files, contents and broken seals are reported as for concealed cases.

use std::path::{Path, PathBuf};

use crate::conceal::error::ConcealError;

/// Why a case could not be made, run or judged.
#[derive(Debug, thiserror::Error)]
pub enum InjectedError {
    /// The recordings are absent; they are not part of the project.
    #[error(
        "no folder `{folder}` with recordings in {}; set TRIMTAB_DATA to the folder that contains it",
        listed(tried)
    )]
    NoData {
        /// Name of the folder of the set.
        folder: &'static str,
        /// Where it was looked for.
        tried: Vec<PathBuf>,
    },
    /// A file, its content, or a seal.
    #[error(transparent)]
    Case(#[from] ConcealError),
}

impl InjectedError {
    /// A file with the wrong content.
    pub fn content(path: &Path, message: &dyn std::fmt::Display) -> Self {
        ConcealError::content(path, message).into()
    }

    /// A file that could not be read or written.
    pub fn file(path: &Path, source: std::io::Error) -> Self {
        ConcealError::file(path, source).into()
    }

    /// Whether the recordings are absent.
    pub fn is_absent(&self) -> bool {
        matches!(self, Self::NoData { .. })
    }
}

fn listed(tried: &[PathBuf]) -> String {
    tried.iter().map(|p| p.display().to_string()).collect::<Vec<_>>().join(" or ")
}
