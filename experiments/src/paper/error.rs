//! Why a table or figure of the paper could not be made.
//! Each message says what is wrong and what to do.

use std::path::PathBuf;

/// Why a table or figure could not be made.
#[derive(Debug, thiserror::Error)]
pub enum PaperError {
    /// A ship file could not be read.
    #[error(transparent)]
    Ship(#[from] trimtab::ship::ShipError),
    /// A model could not be made.
    #[error(transparent)]
    Model(#[from] trimtab::model::ModelError),
    /// A fit could not be made.
    #[error(transparent)]
    Fit(#[from] trimtab::fit::FitError),
    /// A figure could not be made.
    #[error(transparent)]
    Figure(#[from] trimtab::report::plot::FigureError),
    /// Captive tests that do not determine a parameter.
    #[error("{ship}: the captive tests do not determine the {what}; widen their programme")]
    Captive {
        /// The ship.
        ship: &'static str,
        /// The undetermined quantity.
        what: &'static str,
    },
    /// A split without test or training runs, or without a run to compare.
    #[error("{ship}: no {what}; use a data set with more runs")]
    Empty {
        /// The ship.
        ship: &'static str,
        /// What is missing.
        what: &'static str,
    },
    /// A simulation or a derivative that does not exist where it is needed.
    #[error("{ship}: the cost has no value at the paper's initial guess; use more integration sub-steps")]
    Diverged {
        /// The ship.
        ship: &'static str,
    },
    /// Times that do not repeat.
    #[error(
        "{ship}: repeats of `{what}` took times that differ by {percent:.0} %; run it again while the machine does nothing else"
    )]
    Scatter {
        /// The ship.
        ship: &'static str,
        /// What was timed.
        what: String,
        /// The difference.
        percent: f64,
    },
    /// A file that could not be written.
    #[error("{path}: cannot write ({source}); check that the folder exists and is writable")]
    Write {
        /// The file.
        path: PathBuf,
        /// The error of the CSV writer.
        source: csv::Error,
    },
}
