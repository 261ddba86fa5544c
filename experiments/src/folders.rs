//! Folders of the project that the experiments write to.
//! It writes nothing.

use std::path::{Path, PathBuf};

/// The folder of the committed figures.
pub fn figures() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../figures")
}
