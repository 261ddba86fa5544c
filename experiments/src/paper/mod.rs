//! The paper's evaluation made anew: data sets of the truth simulators, fits, and every table and figure.
//! It adds no physics and no method; those are the library's.
//!
//! Each table or figure is an [`Artefact`] in a file of its own and a binary of the same name; the binary `paper` makes all of
//! them. Every one prints our numbers beside the paper's and writes pictures and the CSV behind them. Same seed, same bits.

pub mod captive_baseline;
pub mod case;
pub mod curves;
pub mod distributions;
pub mod gradient;
pub mod limits;
pub mod performance;
pub mod published;
pub mod run;
pub mod scenarios;
pub mod sheet;
pub mod table1;
pub mod table2;

use case::Case;
use std::path::{Path, PathBuf};

/// A table or figure of the paper.
#[derive(Debug)]
pub struct Artefact {
    /// Stem of its files and, after `paper_`, name of its binary.
    pub name: &'static str,
    /// What it shows.
    pub about: &'static str,
    /// Writes its files into a folder and says in words and tables what they hold.
    pub make: fn(&[Case], &Path) -> Result<String, PaperError>,
}

/// Every table and figure, in the order of the paper.
pub static ARTEFACTS: [&Artefact; 8] = [
    &table1::TABLE1,
    &table2::TABLE2,
    &performance::PERFORMANCE,
    &curves::CURVES,
    &scenarios::SCENARIOS,
    &distributions::DISTRIBUTIONS,
    &limits::LIMITS,
    &gradient::GRADIENT,
];

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
    Figure(#[from] trimtab::plot::FigureError),
    /// Captive tests that say nothing of a parameter.
    #[error("{ship}: the captive tests do not determine the {what}; widen their programme")]
    Captive {
        /// The ship.
        ship: &'static str,
        /// What stays unknown.
        what: &'static str,
    },
    /// A split without test or training runs, or with nothing left to compare.
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
    /// A file that could not be written.
    #[error("{path}: cannot write ({source}); check that the folder exists and is writable")]
    Write {
        /// The file.
        path: PathBuf,
        /// What the CSV writer said.
        source: csv::Error,
    },
}
