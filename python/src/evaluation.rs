//! An evaluation in Python: how well a model predicts runs, beside a baseline.
//! The library judges.

use crate::convert::{document, frame};
use pyo3::prelude::*;

/// How well a model predicts runs beside a baseline. cVDM is the mean deviation from the recording in per cent of the size of the
/// motion; improvements are shares of the baseline's error (1 is all of it); intervals are of 95 % and over runs.
#[pyclass(module = "trimtab", frozen)]
pub struct Evaluation {
    pub inner: trimtab::Evaluation,
}

#[pymethods]
impl Evaluation {
    /// Name of the baseline.
    #[getter]
    fn baseline(&self) -> &str {
        &self.inner.baseline
    }

    /// Name of the model that is judged.
    #[getter]
    fn fitted(&self) -> &str {
        &self.inner.fitted
    }

    /// One record a group (`test`, `train`, `manoeuvre: ...`): runs, md_baseline, md_fitted, md_improvement by dimension,
    /// cvdm_baseline, cvdm_fitted, mari, cvdm_improvement, consistency, each with interval, and runs_better, runs_worse.
    #[getter]
    fn summaries<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        document(py, &self.inner.summaries)
    }

    /// The record of a group, such as "test"; None where there is none.
    #[pyo3(signature = (group="test"))]
    fn summary<'py>(&self, py: Python<'py>, group: &str) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.inner.summary(group).map(|summary| document(py, summary)).transpose()
    }

    /// One record a trajectory: run, split, and for baseline and fitted the mean deviations and cVDM.
    #[getter]
    fn trajectories<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        document(py, &self.inner.trajectories)
    }

    /// Everything, as dictionaries.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        document(py, &self.inner)
    }

    /// The trajectories as a table of pandas, nested records as columns with dots.
    fn to_frame<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        frame(py, &pyo3::types::PyList::empty(py), None)?;
        py.import("pandas")?.call_method1("json_normalize", (self.trajectories(py)?,))
    }

    fn __repr__(&self) -> String {
        let test = self.inner.summary("test").or(self.inner.summaries.first());
        let words =
            test.map_or(String::new(), |s| format!(": better on {} of {} runs ({})", s.runs_better, s.runs, s.group));
        format!("<Evaluation of {} against {}{words}>", self.inner.fitted, self.inner.baseline)
    }
}
