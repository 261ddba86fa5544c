//! The extension module of the Python package: what the library does, with numpy arrays in and out.
//! It computes nothing of its own; the parts of the package that need no Rust are in `trimtab/`.

// An interface for Python: its classes and functions are documented there, and nothing in Rust uses them.
#![allow(missing_docs)]
// Arrays and paths are taken by value where Python gives a new one.
#![allow(clippy::needless_pass_by_value)]

#[path = "../../src/cli/mod.rs"]
mod cli;
mod convert;
mod diagnosis;
mod errors;
mod evaluation;
mod fit;
mod function;
mod inputs;
mod log;
mod model;
mod objective;
mod sampled;
mod ship;
mod study;
mod term;
mod trajectory;
mod trial;
mod window;
mod work;

use cli::shared::processor::{Build, build};
use pyo3::exceptions::PyImportError;
use pyo3::prelude::*;
use pyo3::types::PyList;
use std::ffi::OsString;

/// Runs the command `trimtab` with its arguments, the name of the program first, and gives its exit code.
#[pyfunction]
fn command(py: Python<'_>, arguments: Vec<OsString>) -> PyResult<u8> {
    work::alone(py, || cli::run(arguments))
}

/// Sets the number of threads of all work that begins from now on, from 1 to 1024; None for the number of processors. Results do not
/// depend on it.
#[pyfunction]
#[pyo3(signature = (count=None))]
fn set_threads(count: Option<i128>) -> PyResult<()> {
    work::set_threads(count)
}

/// The files of the example study, name and text: forty recordings of a simulated container ship of 85 m.
#[pyfunction]
fn example_files() -> Vec<(String, String)> {
    trimtab::study::demo::files()
}

/// The catalogue of terms: records with name, title, equation, source and parameters (name, symbol, unit, about).
#[pyfunction]
fn terms(py: Python<'_>) -> PyResult<Bound<'_, PyList>> {
    let list = PyList::empty(py);
    for info in trimtab::terms::CATALOGUE.iter().map(|term| term.info()) {
        let parameters: Vec<_> = info
            .parameters
            .iter()
            .map(|p| serde_json::json!({"name": format!("{}.{}", info.name, p.name), "symbol": p.symbol, "unit": p.unit, "about": p.about}))
            .collect();
        let record = serde_json::json!({
            "name": info.name, "title": info.title, "equation": info.equation, "source": info.source, "parameters": parameters,
        });
        list.append(convert::document(py, &record)?)?;
    }
    Ok(list)
}

#[pymodule]
fn _trimtab(module: &Bound<'_, PyModule>) -> PyResult<()> {
    if build() == Build::TooNew {
        return Err(PyImportError::new_err(
            "this build of trimtab is for processors with AVX2 and FMA, which this one lacks; build the package from source with \
             RUSTFLAGS=\"-C target-cpu=native\"",
        ));
    }
    errors::register(module)?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<ship::Ship>()?;
    module.add_class::<model::Model>()?;
    module.add_class::<model::Parameter>()?;
    module.add_class::<term::Term>()?;
    module.add_class::<trajectory::Trajectory>()?;
    module.add_class::<trial::Trial>()?;
    module.add_class::<study::Study>()?;
    module.add_class::<window::Window>()?;
    module.add_class::<fit::Fit>()?;
    module.add_class::<fit::Estimate>()?;
    module.add_class::<fit::FitProgress>()?;
    module.add_class::<objective::Objective>()?;
    module.add_class::<objective::Constraints>()?;
    module.add_class::<evaluation::Evaluation>()?;
    module.add_class::<diagnosis::Diagnosis>()?;
    module.add_function(wrap_pyfunction!(command, module)?)?;
    module.add_function(wrap_pyfunction!(log::import_files, module)?)?;
    module.add_function(wrap_pyfunction!(set_threads, module)?)?;
    module.add_function(wrap_pyfunction!(example_files, module)?)?;
    module.add_function(wrap_pyfunction!(terms, module)?)
}
