//! A recording in Python, cut as a study says, as arrays in SI units.
//! It reads nothing.

use crate::convert::{frame, matrix};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;
use trimtab::recording::{Run, Split};
use trimtab::ship::state::{STATE_NAMES, STATES};

/// A stretch of a recording on equal steps: what a simulation is given, and what it is compared with.
#[pyclass(module = "trimtab", frozen)]
pub struct Window {
    pub runs: Arc<Vec<Run>>,
    pub index: usize,
    /// Channels of the craft's named actuators, in the order of the inputs' commands.
    pub commands: Arc<[String]>,
}

impl Window {
    fn run(&self) -> &Run {
        &self.runs[self.index]
    }

    /// Adds the channels of the named actuators to a table.
    fn put_commands<'py>(&self, py: Python<'py>, columns: &Bound<'py, PyDict>) -> PyResult<()> {
        for (i, name) in self.commands.iter().enumerate() {
            let values = self.run().inputs.iter().map(|inputs| inputs.commands.get(i).copied().unwrap_or(f64::NAN));
            columns.set_item(name, PyArray1::from_iter(py, values))?;
        }
        Ok(())
    }
}

#[pymethods]
impl Window {
    /// Name, unique in a study.
    #[getter]
    fn name(&self) -> &str {
        &self.run().name
    }

    /// Name of the recording it was cut from.
    #[getter]
    fn recording(&self) -> &str {
        &self.run().recording
    }

    /// Session (a day, a voyage).
    #[getter]
    fn session(&self) -> &str {
        &self.run().session
    }

    /// Kind of manoeuvre.
    #[getter]
    fn manoeuvre(&self) -> &str {
        &self.run().manoeuvre
    }

    /// "train" or "test".
    #[getter]
    fn split(&self) -> &'static str {
        if self.run().split == Split::Train { "train" } else { "test" }
    }

    /// Sample period [s].
    #[getter]
    fn dt(&self) -> f64 {
        self.run().dt
    }

    /// Times on the recording's clock [s], shape (K,).
    #[getter]
    fn t<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let run = self.run();
        PyArray1::from_iter(py, (0..run.inputs.len()).map(|k| run.time(k)))
    }

    /// Measured states [x, y, psi, u, v, r], shape (K, 6), NaN where nothing was measured.
    #[getter]
    fn states<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let run = self.run();
        let values = run.measured.iter().flatten().map(|v| v.unwrap_or(f64::NAN)).collect();
        matrix(py, run.measured.len(), STATES, values)
    }

    /// State at the first sample, in every channel, shape (6,).
    #[getter]
    fn initial_state<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.run().initial)
    }

    /// The inputs as `Model.simulate` takes them: t [s], n [1/s], delta [rad], thruster, channels of named actuators, wind, current,
    /// waves, depth and bank.
    #[getter]
    fn inputs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (run, columns) = (self.run(), PyDict::new(py));
        columns.set_item("t", self.t(py))?;
        let put = |name: &str, of: &dyn Fn(&trimtab::Inputs<f64>) -> f64| {
            columns.set_item(name, PyArray1::from_iter(py, run.inputs.iter().map(of)))
        };
        put("n", &|i| i.n)?;
        put("delta", &|i| i.delta)?;
        put("thruster", &|i| i.thruster)?;
        self.put_commands(py, &columns)?;
        put("wind_north", &|i| i.wind[0])?;
        put("wind_east", &|i| i.wind[1])?;
        put("current_north", &|i| i.current[0])?;
        put("current_east", &|i| i.current[1])?;
        put("waves_north", &|i| i.waves[0])?;
        put("waves_east", &|i| i.waves[1])?;
        put("draught_to_depth", &|i| i.draught_to_depth)?;
        put("bank", &|i| i.bank)?;
        Ok(columns)
    }

    fn __len__(&self) -> usize {
        self.run().inputs.len()
    }

    /// A table of pandas with t, x, y, psi, u, v, r, n, delta and the channels of named actuators.
    fn to_frame<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let (run, columns) = (self.run(), PyDict::new(py));
        columns.set_item("t", self.t(py))?;
        for (c, name) in STATE_NAMES.iter().enumerate() {
            let values = run.measured.iter().map(|m| m[c].unwrap_or(f64::NAN));
            columns.set_item(name, PyArray1::from_iter(py, values))?;
        }
        columns.set_item("n", PyArray1::from_iter(py, run.inputs.iter().map(|i| i.n)))?;
        columns.set_item("delta", PyArray1::from_iter(py, run.inputs.iter().map(|i| i.delta)))?;
        self.put_commands(py, &columns)?;
        frame(py, &columns, None)
    }

    fn __repr__(&self) -> String {
        let run = self.run();
        format!(
            "<Window {} ({}, {}): {} samples, {} s apart>",
            run.name,
            run.manoeuvre,
            self.split(),
            run.inputs.len(),
            run.dt
        )
    }
}
