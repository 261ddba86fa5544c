//! Why a command could not run: the library's errors word for word, and errors of arguments and output.
//! Every text says what is wrong, where, and what to do next; nothing is mended here.

use std::path::PathBuf;
use trimtab::diagnose::DiagnoseError;
use trimtab::diagnose::plan::PlanError;
use trimtab::evaluate::maneuver::ManeuverError;
use trimtab::files::FolderError;
use trimtab::fit::FitError;
use trimtab::model::ModelError;
use trimtab::recording::import::ImportError;
use trimtab::report::plot::FigureError;
use trimtab::ship::ShipError;
use trimtab::study::StudyError;

/// Why a command could not run.
#[derive(Debug, thiserror::Error)]
pub enum CliError {
    /// The study or a recording.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// The ship.
    #[error(transparent)]
    Ship(#[from] ShipError),
    /// The model, and the file it comes from where the library does not name it.
    #[error("{}{error}", path.as_ref().map_or(String::new(), |p| format!("{}: ", p.display())))]
    Model {
        /// The file.
        path: Option<PathBuf>,
        /// What the library says.
        error: ModelError,
    },
    /// Recordings that contradict themselves.
    #[error("{path}: {what}; mend it, or go on with `--accept {fault}`", path = path.display())]
    Faulty {
        /// The study.
        path: PathBuf,
        /// What was found, where, and what to do.
        what: String,
        /// The fault's name.
        fault: String,
    },
    /// Several of these, each in a line of its own or more.
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
    Several(Vec<CliError>),
    /// Files that could not be imported.
    #[error(transparent)]
    Import(#[from] ImportError),
    /// A table of the study.
    #[error("{path}:{line}: [{table}] {message}", path = path.display())]
    Table {
        /// The study.
        path: PathBuf,
        /// Line.
        line: usize,
        /// Name of the table.
        table: &'static str,
        /// What is wrong.
        message: String,
    },
    /// The fit.
    #[error("{path}: {error}", path = path.display())]
    Fit {
        /// The study.
        path: PathBuf,
        /// What the library says.
        error: FitError,
    },
    /// The diagnosis.
    #[error("{path}: {error}", path = path.display())]
    Diagnose {
        /// The study.
        path: PathBuf,
        /// What the library says.
        error: DiagnoseError,
    },
    /// The plan.
    #[error("{path}: {error}", path = path.display())]
    Plan {
        /// The study, or the ship where there is none.
        path: PathBuf,
        /// What the library says.
        error: PlanError,
    },
    /// A trial.
    #[error("{path}: {error}", path = path.display())]
    Maneuver {
        /// The study.
        path: PathBuf,
        /// What the library says.
        error: ManeuverError,
    },
    /// A simulation diverged where a result was asked for.
    #[error(
        "{what}: the simulation diverged {after:.1} s after its start; check the model's parameters (`--model`), or integrate more finely (`substeps` in [fit.integration] of the study, `step` in [maneuver])"
    )]
    Diverged {
        /// Run or trial.
        what: String,
        /// When \[s\].
        after: f64,
    },
    /// There is nothing to work on.
    #[error("{path}: {message}", path = path.display())]
    Nothing {
        /// The study.
        path: PathBuf,
        /// What is missing, and what to do.
        message: String,
    },
    /// A figure.
    #[error(transparent)]
    Figure(#[from] FigureError),
    /// A file could not be written.
    #[error("{path}: cannot write ({source}); check that the folder given with --out is writable", path = path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The folder of results cannot be used.
    #[error("{0} (--out)")]
    Folder(FolderError),
    /// An argument with an impossible value.
    #[error("{0}")]
    Argument(String),
    /// Threads could not be started.
    #[error("cannot start the threads ({0}); give a smaller --threads")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// A result could not be turned into JSON or TOML.
    #[error("cannot write the result as {format} ({message}); please report this, it is a fault of trimtab")]
    Format {
        /// JSON or TOML.
        format: &'static str,
        /// What the writer said.
        message: String,
    },
    /// Standard output could not be written.
    #[error("cannot write to standard output ({0}); is the disk full?")]
    Stdout(std::io::Error),
}

impl CliError {
    /// All of some errors as one, of which there must be some.
    pub fn all(mut errors: Vec<Self>) -> Self {
        if errors.len() == 1 { errors.remove(0) } else { Self::Several(errors) }
    }
}

impl From<toml::de::Error> for CliError {
    fn from(error: toml::de::Error) -> Self {
        Self::Format { format: "TOML", message: error.to_string() }
    }
}

impl From<serde_json::Error> for CliError {
    fn from(error: serde_json::Error) -> Self {
        Self::Format { format: "JSON", message: error.to_string() }
    }
}
