//! A diagnosis in Python: what physics a model lacks, as records, a table and a page.
//! The library diagnoses.

use crate::cli::diagnose::prepared;
use crate::cli::shared::error::CliError;
use crate::cli::shared::load::{Loaded, no_mechanism};
use crate::convert::{document, frame, records};
use crate::errors::{DiagnosisFailed, Raised};
use crate::fit::goes_on;
use crate::model::Model;
use crate::work::{Line, whole};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::Value;
use std::path::PathBuf;
use trimtab::diagnose::Settings;
use trimtab::files::write_whole;
use trimtab::recording::Run;
use trimtab::report::diagnosis::{Provenance, page, pictures, summary};

/// What a caller asks of a diagnosis.
pub struct Asked {
    pub repeat: bool,
    pub once: bool,
    pub withhold: Vec<String>,
    pub seed: Option<u64>,
}

impl Asked {
    /// The study's settings with what is asked.
    pub fn settings(self, loaded: &Loaded) -> PyResult<Settings> {
        let mut settings = loaded.diagnose_settings().map_err(Raised::raised)?;
        settings.seed = self.seed.unwrap_or(settings.seed);
        settings.repeat = (settings.repeat || self.repeat) && !self.once;
        let catalogue = loaded.model.catalogue();
        if let Some(message) = self.withhold.iter().find_map(|name| no_mechanism(name, catalogue)) {
            return Err(PyValueError::new_err(format!("withhold: {message}")));
        }
        settings.withhold.extend(self.withhold);
        prepared(loaded, settings).map_err(Raised::raised)
    }
}

/// What physics a model lacks: a verdict in one sentence, findings with size and proof, and the improved model.
#[pyclass(module = "trimtab", frozen)]
pub struct Diagnosis {
    inner: trimtab::Diagnosis,
    study: String,
    whole: Value,
}

impl Diagnosis {
    /// Diagnoses a model against runs. Ctrl-C, or a False of `progress`, ends it with `KeyboardInterrupt`: it has no partial answer.
    pub fn new(
        py: Python<'_>,
        loaded: &Loaded,
        model: &trimtab::Model,
        train: &[Run],
        test: &[Run],
        settings: &Settings,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Self> {
        let report = |step: String| match &progress {
            Some(callback) => goes_on(callback.call1(py, (step,))?.bind(py)),
            None => Ok(true),
        };
        let work = |line: &Line<String>| {
            let tell = |step: &str| line.tell_or_give_up(step.to_owned());
            trimtab::diagnose(model, train, test, settings, &tell)
        };
        let inner = whole(py, report, work)?;
        let inner = inner.map_err(|error| CliError::Diagnose { path: loaded.study.path.clone(), error }.raised())?;
        let study = loaded.study.name.clone();
        let whole = trimtab::report::diagnosis::document(&inner, &study)
            .map_err(|e| crate::errors::fault(&format!("cannot write the diagnosis ({e})")))?;
        Ok(Self { inner, study, whole })
    }

    fn part<'py>(&self, py: Python<'py>, key: &str) -> PyResult<Bound<'py, PyAny>> {
        document(py, &self.whole.get(key))
    }
}

#[pymethods]
impl Diagnosis {
    /// The verdict in a word: what was found, nothing_missing, insufficient and so on (`trimtab help diagnosis`).
    #[getter]
    fn verdict(&self) -> String {
        self.whole.get("verdict").and_then(Value::as_str).unwrap_or_default().to_owned()
    }

    /// One sentence.
    #[getter]
    fn headline(&self) -> &str {
        &self.inner.headline
    }

    /// What was found, the confirmed before the suspected: records with mechanism, title, grade, kind, confidence_set, why, sessions,
    /// statistic, p, parameters (name, value, unit, error, ci95 in SI units and radians), held_out.
    #[getter]
    fn findings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.part(py, "findings")
    }

    /// What was selected and is not named, with the grade that says why: records as of `findings`.
    #[getter]
    fn withdrawn<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.part(py, "withdrawn")
    }

    /// The ranking of mechanisms under the base model: records with mechanism, title, statistic, degrees, p, amplitude.
    #[getter]
    fn ranking<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.part(py, "ranking")
    }

    /// The improved model, with the covariance of its parameters.
    #[getter]
    fn improved(&self) -> Model {
        Model::of(self.inner.model.clone(), self.inner.uncertainty.clone())
    }

    /// The base model, refitted.
    #[getter]
    fn base(&self) -> Model {
        Model::of(self.inner.base.clone(), None)
    }

    /// The summary in words as `trimtab diagnose` prints it.
    fn summary(&self) -> String {
        summary(&self.inner, &self.study)
    }

    /// Writes the report: one HTML page with figures, without scripts or links to elsewhere.
    fn report(&self, path: PathBuf) -> PyResult<()> {
        let from = Provenance { command: "study.diagnose() in Python".into(), ..Provenance::default() };
        let page = page(&self.inner, &self.study, &pictures(&self.inner), &from)
            .map_err(|e| DiagnosisFailed::new_err(e.to_string()))?;
        write_whole(&path, page.render().as_bytes()).map_err(|source| CliError::Write { path, source }.raised())
    }

    /// Everything that the diagnosis says, as `result` of `trimtab diagnose --json`.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        document(py, &self.whole)
    }

    /// The findings as a table of pandas, one row a parameter: mechanism, title, grade, parameter, value, unit, error, low95, high95, p.
    fn to_frame<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let mut rows = Vec::new();
        for finding in &self.inner.findings {
            rows.extend(finding.parameters.iter().map(|amplitude| (finding, amplitude)));
        }
        let all = records(py, &rows, |(finding, amplitude), row: &Bound<'py, PyDict>| {
            row.set_item("mechanism", &finding.mechanism)?;
            row.set_item("title", &finding.title)?;
            row.set_item("grade", document(py, &finding.grade)?)?;
            row.set_item("parameter", &amplitude.name)?;
            row.set_item("value", amplitude.value)?;
            row.set_item("unit", &amplitude.unit)?;
            row.set_item("error", amplitude.error)?;
            row.set_item("low95", amplitude.ci95[0])?;
            row.set_item("high95", amplitude.ci95[1])?;
            row.set_item("p", finding.p)
        })?;
        let table = frame(py, &all, None)?;
        let columns = ["mechanism", "title", "grade", "parameter", "value", "unit", "error", "low95", "high95", "p"];
        let only = PyDict::new(py);
        only.set_item("columns", columns.to_vec())?;
        table.call_method("reindex", (), Some(&only))
    }

    fn __repr__(&self) -> String {
        format!("<Diagnosis of {}: {}>", self.study, self.inner.headline)
    }
}
