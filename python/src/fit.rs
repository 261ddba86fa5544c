//! A fit in Python: its settings, how it is run with progress and Ctrl-C, and its outcome.
//! The library fits.

use crate::convert::{document, frame, records, table};
use crate::errors::fault;
use crate::model::Model;
use crate::work::{Line, long};
use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::{PyKeyError, PyKeyboardInterrupt, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::Value;
use std::path::PathBuf;
use trimtab::FitSettings;
use trimtab::files::suggestion;
use trimtab::files::written::in_words;
use trimtab::fit::FitError;
use trimtab::numbers::ranges::Limited;
use trimtab::recording::Run;

/// What a caller sets of a fit; what is absent is as the study says.
#[derive(Default)]
pub struct Settings<'a, 'py> {
    pub objective: Option<&'a str>,
    pub hessian: Option<&'a str>,
    pub tolerance: Option<f64>,
    pub max_iterations: Option<usize>,
    pub max_seconds: Option<f64>,
    /// Any other key of `[fit]`.
    pub more: Option<&'a Bound<'py, PyDict>>,
}

impl Settings<'_, '_> {
    /// These over those of a study.
    pub fn over(&self, settings: FitSettings) -> PyResult<FitSettings> {
        let mut whole =
            serde_json::to_value(settings).map_err(|e| fault(&format!("cannot write the settings ({e})")))?;
        if let Some(more) = self.more {
            let text: String = more.py().import("json")?.call_method1("dumps", (more,))?.extract()?;
            let more = serde_json::from_str(&text).map_err(|e| PyValueError::new_err(format!("settings: {e}")))?;
            merge(&mut whole, more);
        }
        let own = [
            ("objective", self.objective.map(Value::from)),
            ("hessian", self.hessian.map(Value::from)),
            ("tolerance", self.tolerance.map(Value::from)),
            ("max_iterations", self.max_iterations.map(Value::from)),
            ("max_seconds", self.max_seconds.map(Value::from)),
        ];
        for (key, value) in own {
            if let Some(value) = value {
                whole[key] = value;
            }
        }
        let settings: FitSettings = serde_json::from_value(whole).map_err(|e| {
            let words = in_words(&e.to_string());
            PyValueError::new_err(format!("settings of the fit: {words}; `trimtab help study` lists the keys of [fit]"))
        })?;
        settings.limits().map_err(|e| PyValueError::new_err(format!("settings of the fit: {e}")))?;
        Ok(settings)
    }
}

/// Puts the entries of a table into another, tables within them likewise.
fn merge(into: &mut Value, from: Value) {
    match (into, from) {
        (Value::Object(into), Value::Object(from)) => {
            for (key, value) in from {
                merge(into.entry(key).or_insert(Value::Null), value);
            }
        }
        (into, from) => *into = from,
    }
}

/// Where a running fit stands.
#[pyclass(module = "trimtab", frozen, get_all)]
pub struct FitProgress {
    /// Which solve of the fit this is, the first being 1: a fit solves in stages, and checks its optimum by a further solve.
    pub solve: usize,
    /// What this solve minimises the cost of: "all runs", "a few runs" or "pieces of the runs", or "check" for the check of an optimum.
    pub part: &'static str,
    /// Iteration of the solver, from 0 in each solve.
    pub iteration: usize,
    /// Cost of that part, priors included.
    pub cost: f64,
    /// Largest violation of a constraint, scaled.
    pub violation: f64,
    /// Largest entry of the gradient of the Lagrangian, scaled.
    pub optimality: f64,
    /// The free parameters at the best feasible point of this solve; None before there is one.
    pub best: Option<Vec<f64>>,
}

#[pymethods]
impl FitProgress {
    fn __repr__(&self) -> String {
        format!(
            "<FitProgress: solve {} ({}), iteration {}, cost {:.6e}, optimality {:.1e}>",
            self.solve, self.part, self.iteration, self.cost, self.optimality
        )
    }
}

/// Whether an answer of a callback says to go on: everything but False.
pub fn goes_on(answer: &Bound<'_, PyAny>) -> PyResult<bool> {
    if answer.is_none() { Ok(true) } else { answer.is_truthy() }
}

/// Fits, reports progress, and stops at Ctrl-C with the best point so far.
pub fn run(
    py: Python<'_>,
    model: &trimtab::Model,
    runs: &[Run],
    settings: &FitSettings,
    progress: Option<Py<PyAny>>,
    raised: impl FnOnce(FitError) -> PyErr,
) -> PyResult<Fit> {
    let report = |event: FitProgress| match &progress {
        Some(callback) => goes_on(callback.call1(py, (event,))?.bind(py)),
        None => Ok(true),
    };
    let wants = progress.is_some();
    let work = |line: &Line<FitProgress>| {
        let mut each = |p: &trimtab::fit::Progress| {
            if !wants {
                return !line.is_stopped();
            }
            line.tell(FitProgress {
                solve: p.solve,
                part: p.part,
                iteration: p.iteration,
                cost: p.cost,
                violation: p.violation,
                optimality: p.optimality,
                best: p.best.map(<[f64]>::to_vec),
            })
        };
        trimtab::fit(model, runs, settings, &mut each)
    };
    let ended = long(py, report, work)?;
    // Only a fit that still waited for another one gives nothing.
    let inner = ended.value.ok_or_else(|| PyKeyboardInterrupt::new_err(()))?.map_err(raised)?;
    Ok(Fit { inner, interrupted: ended.interrupted })
}

/// The estimate of one parameter.
#[pyclass(module = "trimtab", frozen, get_all)]
#[derive(Clone)]
pub struct Estimate {
    /// Dotted name.
    pub name: String,
    /// Symbol as in the source, e.g. `p5`.
    pub symbol: &'static str,
    /// SI unit, `-` for none.
    pub unit: &'static str,
    /// Value at the start.
    pub start: f64,
    /// Estimate.
    pub value: f64,
    /// Standard error; None where the data do not determine the parameter, 0 where active constraints leave nothing of it to the data.
    pub standard_error: Option<f64>,
    /// 95 % interval, low and high; None with the standard error.
    pub interval: Option<(f64, f64)>,
    /// "lower" or "upper" where the estimate lies on an active bound; None elsewhere.
    pub at_bound: Option<&'static str>,
}

#[pymethods]
impl Estimate {
    fn __repr__(&self) -> String {
        let interval = self.interval.map_or_else(String::new, |(low, high)| format!(" [{low:.4}, {high:.4}]"));
        format!("<Estimate {} ({}) = {:.4} {}{interval}>", self.name, self.symbol, self.value, self.unit)
    }
}

/// The outcome of a fit: estimates with their uncertainty, the active limits, and the fitted model.
#[pyclass(module = "trimtab", frozen)]
pub struct Fit {
    pub inner: trimtab::Fit,
    interrupted: bool,
}

#[pymethods]
impl Fit {
    /// Whether an optimum was found, and a second solve from a disturbed point found no lower cost.
    #[getter]
    fn converged(&self) -> bool {
        self.inner.converged
    }

    /// Whether Ctrl-C ended it.
    #[getter]
    fn interrupted(&self) -> bool {
        self.interrupted
    }

    /// How it ended, in words.
    #[getter]
    fn status(&self) -> &str {
        &self.inner.status
    }

    /// How it ended and what residuals say against it, in one line.
    #[getter]
    fn headline(&self) -> &str {
        &self.inner.headline
    }

    /// The model with the estimates in place and their covariance.
    #[getter]
    fn model(&self) -> Model {
        Model::of(self.inner.model.clone(), self.inner.uncertainty())
    }

    /// The estimates, in the order of `theta`.
    #[getter]
    fn estimates(&self) -> Vec<Estimate> {
        let of = |e: trimtab::fit::Estimate| Estimate {
            name: e.name,
            symbol: e.symbol,
            unit: e.unit,
            start: e.start,
            value: e.value,
            standard_error: e.standard_error,
            interval: e.interval.map(|[low, high]| (low, high)),
            at_bound: e.at_bound,
        };
        self.inner.reported().into_iter().map(of).collect()
    }

    fn __getitem__(&self, name: &str) -> PyResult<Estimate> {
        let all = self.estimates();
        let found = all.iter().find(|e| e.name == name || e.symbol == name).cloned();
        found.ok_or_else(|| {
            let near = suggestion(name, all.iter().map(|e| e.name.as_str()));
            PyKeyError::new_err(format!(
                "`{name}` was not fitted{near}; free it before the fit: study.model.free(\"{name}\")"
            ))
        })
    }

    /// The estimates as an array, shape (n,), exactly where the fit ended.
    #[getter]
    fn theta<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_iter(py, self.inner.estimates.iter().map(|e| e.value))
    }

    /// Covariance of the estimates, shape (n, n), in the parameters' own units; NaN where the data do not determine a parameter.
    #[getter]
    fn covariance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        table(py, &self.inner.covariance)
    }

    /// Correlations of the estimates, shape (n, n).
    #[getter]
    fn correlations<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        table(py, &self.inner.correlations)
    }

    /// What the covariance takes as independent, in words.
    #[getter]
    fn covariance_kind(&self) -> &'static str {
        self.inner.covariance_kind.words()
    }

    /// Cost at the end, without priors.
    #[getter]
    fn cost(&self) -> f64 {
        self.inner.cost
    }

    /// Cost at the start, without priors.
    #[getter]
    fn start_cost(&self) -> f64 {
        self.inner.start_cost
    }

    /// What the priors add to the cost at the end.
    #[getter]
    fn prior_cost(&self) -> f64 {
        self.inner.prior_cost
    }

    /// Weight of the priors that belongs to the residuals at the end: `prior_weight` of an objective with the same optimum.
    #[getter]
    fn prior_weight(&self) -> f64 {
        let Fit { inner, .. } = self;
        inner.residual_variance * inner.settings.correlated_samples / inner.runs as f64
    }

    /// The noise of a fit by likelihood, as `Objective.noise` has it; None of a fit of trajectories.
    #[getter]
    fn noise<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.inner.likelihood.as_ref().map(|likelihood| document(py, &likelihood.noise)).transpose()
    }

    /// Iterations of the solver.
    #[getter]
    fn iterations(&self) -> usize {
        self.inner.iterations
    }

    /// Time taken [s].
    #[getter]
    fn seconds(&self) -> f64 {
        self.inner.seconds
    }

    /// Active constraints and bounds, in words.
    #[getter]
    fn active(&self) -> Vec<String> {
        self.inner.active.iter().map(|a| a.sentence.clone()).collect()
    }

    /// What residuals say against taking the fit at its word: records.
    #[getter]
    fn doubts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        document(py, &self.inner.doubts)
    }

    /// Combinations of parameters that the data do not determine, in words, the worst first.
    #[getter]
    fn undetermined(&self) -> Vec<String> {
        self.inner.undetermined.iter().map(|c| c.words.clone()).collect()
    }

    /// The report as `trimtab fit` prints it.
    fn report(&self) -> String {
        self.inner.report()
    }

    /// Everything that the fit says, as `result` of `trimtab fit --json`.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        document(py, &self.inner)
    }

    /// The estimates as a table of pandas, by name.
    fn to_frame<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let all = records(py, &self.estimates(), |e, row: &Bound<'py, PyDict>| {
            row.set_item("name", &e.name)?;
            row.set_item("symbol", e.symbol)?;
            row.set_item("unit", e.unit)?;
            row.set_item("start", e.start)?;
            row.set_item("value", e.value)?;
            row.set_item("standard_error", e.standard_error.unwrap_or(f64::NAN))?;
            row.set_item("low95", e.interval.map_or(f64::NAN, |i| i.0))?;
            row.set_item("high95", e.interval.map_or(f64::NAN, |i| i.1))?;
            row.set_item("at_bound", e.at_bound)
        })?;
        frame(py, &all, Some("name"))
    }

    /// Writes the fitted model as a model file with its covariance.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        Bound::new(py, self.model())?.call_method1("save", (path,)).map(|_| ())
    }

    fn __repr__(&self) -> String {
        format!("<Fit of {} parameters: {}>", self.inner.estimates.len(), self.inner.headline)
    }
}
