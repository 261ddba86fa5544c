//! A study from what ships and loggers write, for the function of the package that names its arguments.
//! It is the command `trimtab import`, with its report as a dictionary instead of on the screen.

use crate::cli::study::import::{Args, made};
use crate::convert::document;
use crate::errors::{Raised, TrimtabError};
use crate::work::{Line, whole};
use clap::{Args as _, Command, FromArgMatches};
use pyo3::prelude::*;
use std::ffi::OsString;

/// Makes a study folder from the arguments of `trimtab import` and gives its report in words and as a dictionary.
#[pyfunction]
pub fn import_files(py: Python<'_>, arguments: Vec<OsString>) -> PyResult<(String, Bound<'_, PyAny>)> {
    let command = Args::augment_args(Command::new("import").no_binary_name(true));
    let parsed = command.try_get_matches_from(arguments).and_then(|given| Args::from_arg_matches(&given));
    let args = parsed.map_err(|e| TrimtabError::new_err(e.to_string()))?;
    let work = |_: &Line<()>| {
        let done = made(&args)?;
        done.output.close().ended(Ok(()))?;
        Ok((done.text, done.report))
    };
    let (text, report) =
        whole(py, |()| Ok(true), work)?.map_err(|error: crate::cli::shared::error::CliError| error.raised())?;
    Ok((text, document(py, &report)?))
}
