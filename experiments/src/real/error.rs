//! Why an experiment on a real hull could not run.
//! Most causes are the library's and are passed on word for word.

use std::path::PathBuf;

use trimtab::model::ModelError;
use trimtab::report::plot::FigureError;
use trimtab::ship::ShipError;
use trimtab::study::StudyError;

use super::hulls::published::PublishedError;

/// Why an experiment on a real hull could not run.
#[derive(Debug, thiserror::Error)]
pub enum RealError {
    /// The study or its recordings.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// The ship file.
    #[error(transparent)]
    Ship(#[from] ShipError),
    /// A model file.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A table of the study.
    #[error("{path}: [{table}] {message}; correct the study", path = path.display())]
    Settings {
        /// The study.
        path: PathBuf,
        /// Its table.
        table: &'static str,
        /// What is wrong.
        message: String,
    },
    /// The fit.
    #[error(transparent)]
    Fit(#[from] trimtab::fit::FitError),
    /// The diagnosis.
    #[error(transparent)]
    Diagnose(#[from] trimtab::diagnose::DiagnoseError),
    /// A standard trial.
    #[error(transparent)]
    Maneuver(#[from] trimtab::evaluate::maneuver::ManeuverError),
    /// The published parameters.
    #[error(transparent)]
    Published(#[from] PublishedError),
    /// A figure.
    #[error(transparent)]
    Figure(#[from] FigureError),
    /// A file could not be written.
    #[error("{path}: cannot write ({source}); check that the folder exists and is writable", path = path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: std::io::Error,
    },
}

/// Whether the recordings are absent, which are not part of the project.
pub fn is_absent(error: &RealError) -> bool {
    matches!(error, RealError::Study(StudyError::NoData { .. }))
}
