//! A ship in Python: read from its file, or estimated from its main dimensions.
//! The library reads and estimates.

use crate::cli::shared::error::CliError;
use crate::convert::{Words, document, warn};
use crate::errors::{Raised, fault};
use crate::model::Model;
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::{Path, PathBuf};
use toml::{Table, Value};
use trimtab::files::suggestion;
use trimtab::files::write_whole;
use trimtab::ship::particulars::{KINDS, Kind, estimate};

/// A ship: its fixed particulars in SI units, x forward of midship, y to starboard.
///
/// Made by `Ship.load(path)` from a ship file, or by `Ship.estimate(lpp=..., breadth=..., draught=..., type=...)`.
#[pyclass(module = "trimtab", frozen)]
#[derive(Clone)]
pub struct Ship {
    pub inner: trimtab::Ship,
    /// The text of its file.
    text: String,
    /// The text of a model file with the spreads of the estimates as priors.
    model: Option<String>,
    /// Where each value is from.
    entries: Vec<trimtab::ship::particulars::Entry>,
}

impl Ship {
    /// A ship that the library has.
    pub fn of(inner: trimtab::Ship) -> PyResult<Self> {
        let text = toml::to_string(&inner).map_err(|e| fault(&format!("cannot write the ship ({e})")))?;
        Ok(Self { inner, text, model: None, entries: Vec::new() })
    }
}

#[pymethods]
impl Ship {
    /// Reads a ship file (TOML, SI units; `trimtab help ship` lists the keys).
    #[staticmethod]
    fn load(path: PathBuf) -> PyResult<Self> {
        let inner = trimtab::Ship::read(&path).map_err(Raised::raised)?;
        let text =
            std::fs::read_to_string(&path).map_err(|e| PyOSError::new_err(format!("{}: {e}", path.display())))?;
        Ok(Self { inner, text, model: None, entries: Vec::new() })
    }

    /// Reads a ship from the text of a ship file.
    #[staticmethod]
    fn from_toml(text: String) -> PyResult<Self> {
        let inner = trimtab::Ship::parse(&text, Path::new("<ship>")).map_err(Raised::raised)?;
        Ok(Self { inner, text, model: None, entries: Vec::new() })
    }

    /// A whole ship from length between perpendiculars, breadth and draught [m] and a type; what is not given is estimated by the
    /// published regressions of the field, see `entries` for each value's source and spread.
    ///
    /// `speed` is the service speed [m/s]; `given` sets any key of a ship file, as in `given={"hull.mass": 3.4e6}` (SI units).
    #[staticmethod]
    #[pyo3(signature = (*, lpp, breadth, draught, r#type, speed=None, name=None, given=None))]
    fn estimate(
        py: Python<'_>,
        lpp: f64,
        breadth: f64,
        draught: f64,
        r#type: &str,
        speed: Option<f64>,
        name: Option<String>,
        given: Option<Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let kind = Kind::find(r#type).ok_or_else(|| unknown(r#type))?;
        if let Some(speed) = speed.filter(|s| !(s.is_finite() && *s > 0.0)) {
            return Err(PyValueError::new_err(format!("speed = {speed} must be a positive number, in m/s")));
        }
        let mut table = Table::new();
        for (key, value) in [("hull.lpp", lpp), ("hull.breadth", breadth), ("hull.draught", draught)] {
            put(&mut table, key, Value::Float(value))?;
        }
        if let Some(name) = name {
            put(&mut table, "name", Value::String(name))?;
        }
        for (key, value) in given.iter().flatten() {
            let key: String = key.extract()?;
            put(&mut table, &key, toml_value(&key, &value)?)?;
        }
        let estimated = estimate(kind, &table, speed).map_err(Raised::raised)?;
        for sentence in &estimated.outside {
            warn(py, &format!("{sentence}: the estimates are less sure than their spreads say"))?;
        }
        let (text, model) = (estimated.ship_file().to_owned(), Some(estimated.model_file()));
        Ok(Self { inner: estimated.ship, text, model, entries: estimated.entries })
    }

    /// Name.
    #[getter]
    fn name(&self) -> &str {
        &self.inner.name
    }

    /// Length between perpendiculars [m].
    #[getter]
    fn lpp(&self) -> f64 {
        self.inner.hull.lpp
    }

    /// Breadth [m].
    #[getter]
    fn breadth(&self) -> f64 {
        self.inner.hull.breadth
    }

    /// Draught [m].
    #[getter]
    fn draught(&self) -> f64 {
        self.inner.hull.draught
    }

    /// Mass [kg].
    #[getter]
    fn mass(&self) -> f64 {
        self.inner.hull.mass
    }

    /// Every particular as nested dictionaries, in the layout of a ship file, SI units.
    #[getter]
    fn particulars<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        document(py, &self.inner)
    }

    /// Where each value of an estimated ship is from: records with key, value, origin, source and spread. Empty for a ship of a file.
    #[getter]
    fn entries<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        document(py, &self.entries)
    }

    /// The model of this ship: base terms, the paper's eleven parameters free; for an estimated ship with the spreads as priors.
    ///
    /// `terms` are further terms by name; `form` is the low-speed form of hull and resistance, "regular" or "paper".
    #[pyo3(signature = (*, terms=Words::default(), form=None, name=None))]
    fn model(&self, terms: Words, form: Option<&str>, name: Option<String>) -> PyResult<Model> {
        let mut model = match &self.model {
            Some(text) => trimtab::Model::parse(text, Path::new("<model>"), self.inner.clone()),
            None => trimtab::Model::new(self.inner.clone(), &self.inner.name, trimtab::Form::default(), &[]),
        }
        .map_err(Raised::raised)?;
        if let Some(form) = form {
            model.form = crate::convert::word("form", form, &["regular", "paper"])?;
        }
        for term in &terms.0 {
            model.add_term(term).map_err(Raised::raised)?;
        }
        if let Some(name) = name {
            model.name = name;
        }
        Ok(Model::of(model, None))
    }

    /// The text of the ship file.
    fn to_toml(&self) -> &str {
        &self.text
    }

    /// Writes the ship file.
    fn save(&self, path: PathBuf) -> PyResult<()> {
        write_whole(&path, self.text.as_bytes()).map_err(|source| CliError::Write { path, source }.raised())
    }

    fn __repr__(&self) -> String {
        let hull = &self.inner.hull;
        format!("<Ship {}: {} x {} x {} m>", self.inner.name, hull.lpp, hull.breadth, hull.draught)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        Ok((py.get_type::<Self>().getattr("from_toml")?, (self.text.clone(),)))
    }
}

fn unknown(kind: &str) -> PyErr {
    let names = KINDS.iter().flat_map(|k| k.aliases.iter().chain([&k.name])).copied();
    let (near, types) = (suggestion(kind, names), KINDS.iter().map(|k| k.name).collect::<Vec<_>>());
    PyValueError::new_err(format!("unknown type `{kind}`{near}; the types are {}", types.join(", ")))
}

/// Sets a dotted key; names in `[parameters]` have a dot of their own.
fn put(table: &mut Table, key: &str, value: Value) -> PyResult<()> {
    let Some((outer, inner)) = key.split_once('.') else {
        table.insert(key.to_owned(), value);
        return Ok(());
    };
    let entry = table.entry(outer.to_owned()).or_insert_with(|| Value::Table(Table::new()));
    let Some(entry) = entry.as_table_mut() else {
        return Err(PyValueError::new_err(format!(
            "`{outer}` is a value and not a table, so that it has no `{inner}`"
        )));
    };
    entry.insert(inner.to_owned(), value);
    Ok(())
}

fn toml_value(key: &str, value: &Bound<'_, PyAny>) -> PyResult<Value> {
    if let Ok(value) = value.extract::<bool>() {
        return Ok(Value::Boolean(value));
    }
    if let Ok(value) = value.extract::<f64>() {
        return Ok(Value::Float(value));
    }
    if let Ok(value) = value.extract::<String>() {
        return Ok(Value::String(value));
    }
    if let Ok(values) = value.extract::<Vec<f64>>() {
        return Ok(Value::Array(values.into_iter().map(Value::Float).collect()));
    }
    Err(PyValueError::new_err(format!("given[\"{key}\"]: expected a number, a text, or a list of numbers")))
}
