//! The library's errors as exceptions of Python, word for word.
//! It words nothing of its own but what only a caller in Python can do wrong.

use crate::cli::shared::error::CliError;
use pyo3::create_exception;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use std::io::Error;
use std::path::Path;
use trimtab::evaluate::maneuver::ManeuverError;
use trimtab::fit::FitError;
use trimtab::model::ModelError as LibraryModelError;
use trimtab::ship::ShipError as LibraryShipError;
use trimtab::ship::particulars::EstimateError;
use trimtab::study::StudyError as LibraryStudyError;

create_exception!(
    trimtab,
    TrimtabError,
    PyValueError,
    "What is wrong, where (file, line, column), and what to do next; every error of trimtab is one."
);
create_exception!(trimtab, StudyError, TrimtabError, "A study file, a table of runs, a column map or a recording.");
create_exception!(trimtab, ShipError, TrimtabError, "A ship file, or an estimate of a ship.");
create_exception!(trimtab, ModelError, TrimtabError, "A model file, a term or a parameter.");
create_exception!(trimtab, RecordingsError, TrimtabError, "Recordings that contradict themselves (unit, sign, axes).");
create_exception!(trimtab, FitFailed, TrimtabError, "There is no fit; one that does not converge is a result.");
create_exception!(trimtab, DiagnosisFailed, TrimtabError, "There is no diagnosis.");
create_exception!(trimtab, TrialFailed, TrimtabError, "A standard trial that cannot be sailed.");

/// Adds the exceptions to the module.
pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    module.add("TrimtabError", py.get_type::<TrimtabError>())?;
    module.add("StudyError", py.get_type::<StudyError>())?;
    module.add("ShipError", py.get_type::<ShipError>())?;
    module.add("ModelError", py.get_type::<ModelError>())?;
    module.add("RecordingsError", py.get_type::<RecordingsError>())?;
    module.add("FitError", py.get_type::<FitFailed>())?;
    module.add("DiagnosisError", py.get_type::<DiagnosisFailed>())?;
    module.add("ManeuverError", py.get_type::<TrialFailed>())
}

/// An error of the library as the exception that is raised.
pub trait Raised {
    /// The exception.
    fn raised(self) -> PyErr;
}

impl Raised for CliError {
    fn raised(self) -> PyErr {
        let words = self.to_string();
        match self {
            Self::Study(_) | Self::Table { .. } | Self::Nothing { .. } => StudyError::new_err(words),
            Self::Ship(_) => ShipError::new_err(words),
            Self::Model { .. } => ModelError::new_err(words),
            // The command goes on with an option, a call with an argument.
            Self::Faulty { fault, .. } => RecordingsError::new_err(
                words.replace(&format!("`--accept {fault}`"), &format!("`accept=[\"{fault}\"]`")),
            ),
            // The command writes into a folder of results, a call to the path that it is given.
            Self::Write { path, source } => TrimtabError::new_err(unwritten(&path, &source)),
            Self::Fit { .. } => FitFailed::new_err(words),
            Self::Diagnose { .. } => DiagnosisFailed::new_err(words),
            Self::Maneuver { .. } => TrialFailed::new_err(words),
            _ => TrimtabError::new_err(words),
        }
    }
}

impl Raised for LibraryStudyError {
    fn raised(self) -> PyErr {
        StudyError::new_err(self.to_string())
    }
}

impl Raised for LibraryShipError {
    fn raised(self) -> PyErr {
        ShipError::new_err(self.to_string())
    }
}

impl Raised for EstimateError {
    fn raised(self) -> PyErr {
        ShipError::new_err(self.to_string())
    }
}

impl Raised for LibraryModelError {
    fn raised(self) -> PyErr {
        ModelError::new_err(self.to_string())
    }
}

impl Raised for FitError {
    fn raised(self) -> PyErr {
        FitFailed::new_err(self.to_string())
    }
}

impl Raised for ManeuverError {
    fn raised(self) -> PyErr {
        TrialFailed::new_err(self.to_string())
    }
}

/// Why a file could not be written.
fn unwritten(path: &Path, source: &Error) -> String {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    match folder.filter(|folder| !folder.is_dir()) {
        Some(folder) => format!("{}: there is no folder {}; make the folder first", path.display(), folder.display()),
        None => format!("{}: cannot write ({source}); check that the folder is writable", path.display()),
    }
}

/// What the audit asks of a column map, for a study that a call has made of tables or logs: unit and column are arguments of the call, and
/// all else stands in the map that it has written.
pub fn of_a_call(words: &str) -> String {
    const MAP: &str = " in a column map";
    // A map of some runs alone is none that a call writes.
    let is_whole = |rest: &str| !rest.starts_with(" of th");
    let words = words.replace("`bridge` in a column map", "`bridge=...`");
    if let Some((before, rest)) = words.split_once("set `unit` for `")
        && let Some((channel, rest)) = rest.split_once(&format!("`{MAP}"))
        && is_whole(rest)
    {
        return format!("{before}pass `units={{\"{channel}\": ...}}`{rest}");
    }
    let names_a_column = ["name its column", "name it", "name those"].iter().any(|name| words.contains(name));
    let by = if words.contains("`unit`") {
        " by `units={...}`"
    } else if names_a_column {
        " by `columns={...}`"
    } else {
        " in columns.toml beside the study"
    };
    let mut parts = words.split(MAP);
    let mut out = parts.next().unwrap_or_default().to_owned();
    for rest in parts {
        out += if is_whole(rest) { by } else { MAP };
        out += rest;
    }
    out
}

/// Something that cannot happen, if there is no fault in trimtab.
pub fn fault(what: &str) -> PyErr {
    PyRuntimeError::new_err(format!("{what}; this is a fault of trimtab: please report it, with what you called"))
}
