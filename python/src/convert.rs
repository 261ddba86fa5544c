//! Numbers and documents between Rust and Python: arrays in and out, JSON as dictionaries, tables for pandas.
//! It checks shapes and finiteness, and words what a caller can do about them.

use crate::errors::fault;
use numpy::{AllowTypeChange, PyArray1, PyArray2, PyArrayLike1, PyArrayMethods};
use pyo3::exceptions::{PyImportError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyList};
use serde::Serialize;
use serde::de::DeserializeOwned;
use trimtab::files::suggestion;
use trimtab::numbers::ranges::{Limited, OutOfRange};

/// A document as dictionaries and lists of Python.
pub fn document<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    let bytes = serde_json::to_vec(value).map_err(|e| fault(&format!("cannot write the result ({e})")))?;
    py.import("json")?.call_method1("loads", (PyBytes::new(py, &bytes),))
}

/// A word of a setting, such as `"likelihood"`, as the value it stands for.
pub fn word<T: DeserializeOwned>(name: &str, given: &str, known: &[&str]) -> PyResult<T> {
    serde_json::from_value(serde_json::Value::from(given)).map_err(|_| {
        let near = suggestion(given, known.iter().copied());
        let all: Vec<String> = known.iter().map(|k| format!("\"{k}\"")).collect();
        PyValueError::new_err(format!("{name} = \"{given}\"{near}: give one of {}", all.join(", ")))
    })
}

/// Words that a caller gives: a list of them, or one alone.
#[derive(Default)]
pub struct Words(pub Vec<String>);

impl FromPyObject<'_, '_> for Words {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        match given.extract::<String>() {
            Ok(one) => Ok(Self(vec![one])),
            Err(_) => given.extract::<Vec<String>>().map(Self),
        }
    }
}

/// What a seed must be.
pub const SEEDS: &str = "between 0 and 18446744073709551615";

/// A whole number that a caller gives. That of Python may be negative, and of any size.
pub fn whole_number<T: TryFrom<i128>>(name: &str, given: i128, allowed: &str) -> PyResult<T> {
    T::try_from(given).map_err(|_| PyValueError::new_err(format!("{name} = {given} must be {allowed}")))
}

/// A number of things that a caller gives; of one that no setting can be, it says what the settings say of `none` of these things.
pub fn counted(given: i128, none: &impl Limited) -> PyResult<usize> {
    usize::try_from(given).map_err(|_| match none.limits() {
        Err(error) => PyValueError::new_err(OutOfRange { value: given as f64, ..error }.to_string()),
        Ok(()) => fault("a setting that must be 1 or more may be 0"),
    })
}

/// Refuses keywords that a function does not have, in the words of Python and with the one that was probably meant.
pub fn no_others(function: &str, others: Option<&Bound<'_, PyDict>>, known: &[&str]) -> PyResult<()> {
    let Some((name, _)) = others.and_then(|others| others.iter().next()) else { return Ok(()) };
    let name: String = name.extract()?;
    let near = suggestion(&name, known.iter().copied());
    Err(PyTypeError::new_err(format!("{function}() got an unexpected keyword argument '{name}'{near}")))
}

/// A vector of numbers from an array, a list or anything that numpy can make one of.
pub fn vector(name: &str, given: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let wrong = |_| {
        let kind = given.get_type().name().map_or_else(|_| "this".to_owned(), |n| n.to_string());
        PyTypeError::new_err(format!(
            "{name}: expected numbers in one dimension (a list, a numpy array, a column of a table), and got {kind}"
        ))
    };
    let array: PyArrayLike1<'_, f64, AllowTypeChange> = given.extract().map_err(wrong)?;
    Ok(array.as_array().to_vec())
}

/// A vector of so many numbers, one for each of `names`.
pub fn numbers(name: &str, given: &Bound<'_, PyAny>, names: &[String]) -> PyResult<Vec<f64>> {
    let values = vector(name, given)?;
    if values.len() == names.len() {
        return Ok(values);
    }
    Err(PyValueError::new_err(format!(
        "{name} has {} values, and {} are needed, in this order: {}",
        values.len(),
        names.len(),
        names.join(", ")
    )))
}

/// As [`numbers`], each of them finite.
pub fn finite(name: &str, given: &Bound<'_, PyAny>, names: &[String]) -> PyResult<Vec<f64>> {
    let values = numbers(name, given, names)?;
    match values.iter().position(|v| !v.is_finite()) {
        Some(i) => Err(PyValueError::new_err(format!(
            "{name}[{i}] ({}) = {} is not a finite number; replace it",
            names[i], values[i]
        ))),
        None => Ok(values),
    }
}

/// A matrix of numbers as an array of so many columns, row after row.
pub fn matrix<'py>(
    py: Python<'py>,
    rows: usize,
    columns: usize,
    values: Vec<f64>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    PyArray1::from_vec(py, values).reshape([rows, columns])
}

/// A table with entries that may be absent as an array with NaN there.
pub fn table<'py>(py: Python<'py>, rows: &[Vec<Option<f64>>]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let values = rows.iter().flatten().map(|v| v.unwrap_or(f64::NAN)).collect();
    matrix(py, rows.len(), rows.first().map_or(0, Vec::len), values)
}

/// A table of pandas from a dictionary of columns or a list of records; a column may be its index.
pub fn frame<'py>(py: Python<'py>, columns: &Bound<'py, PyAny>, index: Option<&str>) -> PyResult<Bound<'py, PyAny>> {
    let pandas = py.import("pandas").map_err(|_| {
        PyImportError::new_err("to_frame needs pandas: pip install pandas; to_dict gives the same without it")
    })?;
    let frame = pandas.call_method1("DataFrame", (columns,))?;
    match index {
        Some(column) => frame.call_method1("set_index", (column,)),
        None => Ok(frame),
    }
}

/// Dictionaries of some records, each by its own columns.
pub fn records<'py, T>(
    py: Python<'py>,
    all: &[T],
    fill: impl Fn(&T, &Bound<'py, PyDict>) -> PyResult<()>,
) -> PyResult<Bound<'py, PyList>> {
    let list = PyList::empty(py);
    for one in all {
        let row = PyDict::new(py);
        fill(one, &row)?;
        list.append(row)?;
    }
    Ok(list)
}

/// Tells a warning by the logger `trimtab`.
pub fn warn(py: Python<'_>, words: &str) -> PyResult<()> {
    let logger = py.import("logging")?.call_method1("getLogger", ("trimtab",))?;
    logger.call_method1("warning", ("%s", words))?;
    Ok(())
}
