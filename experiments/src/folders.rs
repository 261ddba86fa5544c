//! What the binaries share: the folder of the committed figures, its option on the command line, and exit codes.
//! It writes nothing.

use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// The folder of the committed figures.
pub fn figures() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../figures")
}

/// The folder that a binary writes to.
#[derive(Debug, clap::Args)]
pub struct Folder {
    /// Folder for pictures and CSV; the committed figures if not given.
    #[arg(long)]
    out: Option<PathBuf>,
}

impl Folder {
    /// The folder.
    pub fn path(&self) -> PathBuf {
        self.out.clone().unwrap_or_else(figures)
    }
}

/// Where a campaign puts what is published of it. The table of every answer stays in the campaign's own folder.
#[derive(Debug, clap::Args)]
pub struct Published {
    /// Folder for counts, failing rows and figures; that of --out if not given.
    #[arg(long, value_name = "DIR")]
    figures: Option<PathBuf>,
}

impl Published {
    /// The folder, made if absent, of a campaign that works in `out`.
    ///
    /// # Errors
    /// Those of the file system.
    pub fn folder<'a>(&'a self, out: &'a Path) -> std::io::Result<&'a Path> {
        let folder = self.figures.as_deref().unwrap_or(out);
        std::fs::create_dir_all(folder)?;
        Ok(folder)
    }
}

/// Exit code 0, or the message of an error and exit code 2.
pub fn exit<E: Display>(program: &str, outcome: Result<(), E>) -> ExitCode {
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{program}: {error}");
            ExitCode::from(2)
        }
    }
}
