//! A manoeuvring model in Python: parameters by name, simulation, standard trials.
//! The physics is in the library.

use crate::cli::fit::fitted_text;
use crate::cli::shared::error::CliError;
use crate::convert::{SEEDS, counted, finite, frame, records, whole_number, word};
use crate::errors::Raised;
use crate::inputs::{inputs, state};
use crate::ship::Ship;
use crate::term::Term;
use crate::trajectory::Trajectory;
use crate::trial::{Trial, sail};
use crate::work::short;
use numpy::PyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use trimtab::files::write_whole;
use trimtab::model::Prior;
use trimtab::numbers::ranges::Limited;
use trimtab::numbers::uncertainty::Uncertainty;
use trimtab::recording::Driven;
use trimtab::{Integration, Scenario};

/// A manoeuvring model of one ship: terms (forces with a name, an equation and units) and their parameters.
///
/// `model["rudder.lift1"]` reads a parameter, by dotted name or by the symbol of the paper (`p5`), and
/// `model["rudder.lift1"] = 3.2` sets it. Made by `Model.load`, `Ship.model`, `Study.model` or `Fit.model`.
#[pyclass(module = "trimtab", frozen)]
pub struct Model {
    inner: Mutex<Inner>,
}

/// A model and what is known of its parameters.
#[derive(Clone)]
pub struct Inner {
    pub model: trimtab::Model,
    /// The covariance of its parameters; none once one of them was set.
    pub uncertainty: Option<Uncertainty>,
}

impl Model {
    /// A model that the library has.
    pub fn of(model: trimtab::Model, uncertainty: Option<Uncertainty>) -> Self {
        Self { inner: Mutex::new(Inner { model, uncertainty }) }
    }

    /// Model and uncertainty as they are now.
    pub fn snapshot(&self) -> Inner {
        self.lock().clone()
    }

    fn lock(&self) -> MutexGuard<'_, Inner> {
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Changes the model, wholly or not at all.
    fn change(
        &self,
        change: impl FnOnce(&mut trimtab::Model) -> Result<(), trimtab::model::ModelError>,
    ) -> PyResult<()> {
        let mut inner = self.lock();
        let mut model = inner.model.clone();
        change(&mut model).map_err(Raised::raised)?;
        *inner = Inner { model, uncertainty: None };
        Ok(())
    }
}

/// A parameter of a model as it was when it was asked for.
#[pyclass(module = "trimtab", frozen, get_all)]
#[derive(Clone)]
pub struct Parameter {
    /// Dotted name, `term.parameter`.
    pub name: String,
    /// Symbol as in the source, e.g. `p5`.
    pub symbol: &'static str,
    /// SI unit, `-` for none.
    pub unit: &'static str,
    /// Meaning in plain words.
    pub about: &'static str,
    /// Value.
    pub value: f64,
    /// Whether a fit may change it.
    pub free: bool,
    /// Lower bound.
    pub lower: f64,
    /// Upper bound.
    pub upper: f64,
    /// Prior, mean and standard deviation; None without one.
    pub prior: Option<(f64, f64)>,
    /// Size of a relevant change: the solver's unit for it.
    pub scale: f64,
}

impl Parameter {
    fn of(p: &trimtab::model::Parameter) -> Self {
        Self {
            name: p.name.clone(),
            symbol: p.info.symbol,
            unit: p.info.unit,
            about: p.info.about,
            value: p.value,
            free: p.free,
            lower: p.lower,
            upper: p.upper,
            prior: p.prior.map(|prior| (prior.mean, prior.sd)),
            scale: p.scale,
        }
    }
}

#[pymethods]
impl Parameter {
    fn __repr__(&self) -> String {
        let free = if self.free { "free" } else { "fixed" };
        format!("<Parameter {} ({}) = {} {}, {free}>", self.name, self.symbol, self.value, self.unit)
    }
}

#[pymethods]
impl Model {
    /// Reads a model file (TOML) for a ship, with the covariance of its parameters where a fit wrote one.
    #[staticmethod]
    fn load(path: PathBuf, ship: &Ship) -> PyResult<Self> {
        let model = trimtab::Model::read(&path, ship.inner.clone()).map_err(Raised::raised)?;
        let uncertainty = trimtab::Model::read_uncertainty(&path).map_err(Raised::raised)?;
        Ok(Self::of(model, uncertainty))
    }

    /// Reads a model from the text of a model file.
    #[staticmethod]
    fn from_toml(text: &str, ship: &Ship) -> PyResult<Self> {
        let model = trimtab::Model::parse(text, Path::new("<model>"), ship.inner.clone()).map_err(Raised::raised)?;
        let file: Option<trimtab::model::ModelFile> = toml::from_str(text).ok();
        Ok(Self::of(model, file.and_then(|file| file.covariance)))
    }

    /// Name.
    #[getter]
    fn name(&self) -> String {
        self.lock().model.name.clone()
    }

    /// The ship.
    #[getter]
    fn ship(&self) -> PyResult<Ship> {
        Ship::of(self.lock().model.ship.clone())
    }

    /// Names of the terms, in order.
    #[getter]
    fn terms(&self) -> Vec<&'static str> {
        self.lock().model.term_names()
    }

    /// The parameters, in order.
    #[getter]
    fn parameters(&self) -> Vec<Parameter> {
        self.lock().model.parameters.iter().map(Parameter::of).collect()
    }

    /// Dotted names of the free parameters, in the order of `theta`.
    #[getter]
    fn free_names(&self) -> Vec<String> {
        let inner = self.lock();
        inner.model.free().into_iter().map(|i| inner.model.parameters[i].name.clone()).collect()
    }

    /// A parameter by dotted name or symbol.
    fn parameter(&self, name: &str) -> PyResult<Parameter> {
        let inner = self.lock();
        let i = inner.model.find(name).map_err(Raised::raised)?;
        Ok(Parameter::of(&inner.model.parameters[i]))
    }

    fn __getitem__(&self, name: &str) -> PyResult<f64> {
        Ok(self.parameter(name)?.value)
    }

    fn __setitem__(&self, name: &str, value: f64) -> PyResult<()> {
        if !value.is_finite() {
            return Err(PyValueError::new_err(format!("parameter `{name}` = {value} is not a finite number")));
        }
        self.change(|model| model.set(&[(name, value)]))
    }

    /// Lets a fit change parameters (`"flow.asymmetry"`) or all of a term (`"wake_drift"`), each with the prior that its term knows;
    /// a term that the model lacks is added. `"hull"` frees every hydrodynamic coefficient of the hull.
    #[pyo3(signature = (*names))]
    fn free(&self, names: Vec<String>) -> PyResult<()> {
        self.change(|model| {
            let before: Vec<Option<Prior>> = model.parameters.iter().map(|p| p.prior).collect();
            names.iter().try_for_each(|name| model.release(name))?;
            // A prior that was given stays where the term knows none.
            for (p, before) in model.parameters.iter_mut().zip(before) {
                p.prior = p.prior.or(before);
            }
            Ok(())
        })
    }

    /// Holds parameters, or all of a term, at their values; `value` sets the value of one.
    #[pyo3(signature = (*names, value=None))]
    fn fix(&self, names: Vec<String>, value: Option<f64>) -> PyResult<()> {
        if let (Some(value), [name]) = (value, &names[..]) {
            self.__setitem__(name, value)?;
        } else if value.is_some() {
            return Err(PyValueError::new_err("value = ... sets the value of one parameter; give one name with it"));
        }
        self.change(|model| names.iter().try_for_each(|name| model.hold(name)))
    }

    /// Sets the bounds of a parameter in its own unit; None for no bound.
    #[pyo3(signature = (name, lower=None, upper=None))]
    fn bound(&self, name: &str, lower: Option<f64>, upper: Option<f64>) -> PyResult<()> {
        let (lower, upper) = (lower.unwrap_or(f64::NEG_INFINITY), upper.unwrap_or(f64::INFINITY));
        self.change(|model| model.bound(name, lower, upper))
    }

    /// Sets the prior of a parameter, mean and standard deviation in its own unit; both None for no prior.
    #[pyo3(signature = (name, mean=None, sd=None))]
    fn prior(&self, name: &str, mean: Option<f64>, sd: Option<f64>) -> PyResult<()> {
        let prior = match (mean, sd) {
            (Some(mean), Some(sd)) => Some(Prior { mean, sd }),
            (None, None) => None,
            _ => {
                return Err(PyValueError::new_err(format!(
                    "the prior of `{name}` needs both mean and sd, or neither for none"
                )));
            }
        };
        self.change(|model| model.prior(name, prior))
    }

    /// Adds a term of the catalogue by name (`trimtab terms` lists them), or a Term of one's own; with its default parameters it has no
    /// effect. Its parameters are fixed: set `model["my_term.k"]`, or free them by `free`.
    fn add_term(&self, term: Added<'_>) -> PyResult<()> {
        match term {
            Added::Name(name) => self.change(|model| model.add_term(&name)),
            Added::Own(term) => self.add_own(&term),
        }
    }

    /// Simulates the ship: inputs at K samples to a trajectory of K states.
    ///
    /// `inputs` is a dictionary or a table with the columns `n` [1/s] and `delta` [rad, positive turns to starboard], each an array of
    /// shape (K,) or one number, and of a ship with named actuators their channels, such as `port.rate`; a propeller that stands still
    /// is `"n": 0.0`. Where the model has such terms, `thruster` [-1 to 1], `wind_north`, `wind_east`, `current_north`, `current_east`
    /// [m/s, where it blows and sets to], `waves_north`, `waves_east`, `draught_to_depth` and `bank` come too, and are 0 without.
    /// The samples are `dt` [s] apart, or at the times `t` [s] of the inputs. `initial_state` is [x, y, psi, u, v, r] in m, rad, m/s.
    /// `theta` gives the free parameters other values. `method` is "euler" (as in the paper) or "rk4", with `substeps` a sample.
    #[pyo3(signature = (inputs, initial_state, *, dt=None, theta=None, method="euler", substeps=1))]
    fn simulate(
        &self,
        py: Python<'_>,
        inputs: &Bound<'_, PyAny>,
        initial_state: &Bound<'_, PyAny>,
        dt: Option<f64>,
        theta: Option<&Bound<'_, PyAny>>,
        method: &str,
        substeps: i128,
    ) -> PyResult<Trajectory> {
        let substeps = counted(substeps, &Integration { substeps: 0, ..Integration::default() })?;
        let model = self.at(theta)?;
        let (dt, samples) = self::inputs(inputs, dt, &Driven::of(&model.ship))?;
        let start = samples.first().map_or(0.0, |s| s.t);
        let scenario = Scenario { dt, inputs: samples, initial: state(initial_state)? };
        let integration = Integration { method: word("method", method, &["euler", "rk4"])?, substeps };
        integration.limits().map_err(|e| PyValueError::new_err(e.to_string()))?;
        let inner = short(py, || trimtab::simulate(&model, &model.values(), integration, &scenario))?;
        Ok(Trajectory { start, inner })
    }

    /// Sails a standard trial in calm water: `kind` is "turning", "zigzag" or "stopping"; one Trial a side (and angle).
    ///
    /// `angle_deg` is the rudder angle of the turn (35 without) or rudder and heading angle of the zigzag (10 and 20 without);
    /// `speed` [m/s] or `rpm` set the approach. `draws` of the covariance give the 95 % intervals of a fitted model; 0 for none.
    #[pyo3(signature = (kind, *, angle_deg=None, speed=None, rpm=None, as_found=false, draws=None, seed=None))]
    fn trial(
        &self,
        py: Python<'_>,
        kind: &str,
        angle_deg: Option<f64>,
        speed: Option<f64>,
        rpm: Option<f64>,
        as_found: bool,
        draws: Option<i128>,
        seed: Option<i128>,
    ) -> PyResult<Vec<Trial>> {
        let draws = draws
            .map(|given| whole_number("draws", given, "0 or more: draws of the covariance, 0 for no intervals"))
            .transpose()?;
        let seed = seed.map(|given| whole_number("seed", given, SEEDS)).transpose()?;
        sail(py, self.snapshot(), kind, angle_deg, [speed, rpm], as_found, draws, seed)
    }

    /// Values of all parameters, in their order.
    fn values<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.lock().model.values())
    }

    /// A copy, which changes by itself.
    fn copy(&self) -> Self {
        Self { inner: Mutex::new(self.snapshot()) }
    }

    /// The text of the model file, with the covariance where the model has one.
    fn to_toml(&self) -> PyResult<String> {
        let Inner { model, uncertainty } = self.snapshot();
        fitted_text(&model, uncertainty).map_err(Raised::raised)
    }

    /// Writes the model file.
    fn save(&self, path: PathBuf) -> PyResult<()> {
        let text = self.to_toml()?;
        write_whole(&path, text.as_bytes()).map_err(|source| CliError::Write { path, source }.raised())
    }

    /// A table of pandas with the parameters, by name.
    fn to_frame<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let all = records(py, &self.parameters(), |p, row: &Bound<'py, PyDict>| {
            row.set_item("name", &p.name)?;
            row.set_item("symbol", p.symbol)?;
            row.set_item("unit", p.unit)?;
            row.set_item("value", p.value)?;
            row.set_item("free", p.free)?;
            row.set_item("lower", p.lower)?;
            row.set_item("upper", p.upper)?;
            row.set_item("prior_mean", p.prior.map(|prior| prior.0))?;
            row.set_item("prior_sd", p.prior.map(|prior| prior.1))?;
            row.set_item("about", p.about)
        })?;
        frame(py, &all, Some("name"))
    }

    fn __repr__(&self) -> String {
        let inner = self.lock();
        let model = &inner.model;
        format!(
            "<Model {} of {}: {}, {} free parameters>",
            model.name,
            model.ship.name,
            model.term_names().join(", "),
            model.free().len()
        )
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let arguments = (self.to_toml()?, self.ship()?).into_pyobject(py)?;
        Ok((py.get_type::<Self>().getattr("from_toml")?, arguments))
    }
}

/// What can be added to a model.
#[derive(FromPyObject)]
enum Added<'py> {
    Name(String),
    Own(PyRef<'py, Term>),
}

impl Model {
    /// Puts a term of one's own into the catalogue of the model, and adds it.
    fn add_own(&self, term: &Term) -> PyResult<()> {
        let name = term.inner().info().name;
        self.change(|model| {
            let catalogue = model.catalogue().with(term.inner());
            let mut changed = trimtab::Model::from_file_with(catalogue, &model.to_file(), model.ship.clone())?;
            // What a model file does not keep, of the terms that were there before.
            for p in &mut changed.parameters {
                if let Some(own) = model.parameters.iter().find(|own| own.name == p.name) {
                    p.scale = own.scale;
                }
            }
            changed.add_term(name)?;
            term.complete(&mut changed);
            *model = changed;
            Ok(())
        })
    }

    /// The model with its free parameters at `theta`, where that is given.
    fn at(&self, theta: Option<&Bound<'_, PyAny>>) -> PyResult<trimtab::Model> {
        let mut model = self.snapshot().model;
        let Some(theta) = theta else { return Ok(model) };
        let free = model.free();
        let names: Vec<String> = free.iter().map(|i| model.parameters[*i].name.clone()).collect();
        for (i, value) in free.into_iter().zip(finite("theta", theta, &names)?) {
            model.parameters[i].value = value;
        }
        Ok(model)
    }
}
