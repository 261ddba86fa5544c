//! A simulated or recorded run in Python, as arrays.
//! It computes nothing.

use crate::convert::{frame, matrix};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use trimtab::ship::state::{STATE_NAMES, STATES};

/// A simulated run: `t` [s] of shape (K,), `states` of shape (K, 6) with the columns x north, y east [m], psi clockwise from north
/// [rad, not wrapped], u forward, v to starboard [m/s, over ground], r to starboard [rad/s].
///
/// Where the simulation diverged it is shorter than its inputs, and `diverged_at` is the first sample that is missing.
#[pyclass(module = "trimtab", frozen)]
pub struct Trajectory {
    pub start: f64,
    pub inner: trimtab::Trajectory,
}

#[pymethods]
impl Trajectory {
    /// Times [s], shape (K,).
    #[getter]
    fn t<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let at = |k: usize| self.start + self.inner.dt * k as f64;
        PyArray1::from_iter(py, (0..self.inner.states.len()).map(at))
    }

    /// States, shape (K, 6).
    #[getter]
    fn states<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        matrix(py, self.inner.states.len(), STATES, self.inner.states.concat())
    }

    /// North position [m].
    #[getter]
    fn x<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.column(py, 0)
    }

    /// East position [m].
    #[getter]
    fn y<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.column(py, 1)
    }

    /// Heading [rad], clockwise from north, not wrapped.
    #[getter]
    fn psi<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.column(py, 2)
    }

    /// Surge velocity over ground [m/s], forward.
    #[getter]
    fn u<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.column(py, 3)
    }

    /// Sway velocity over ground [m/s], to starboard.
    #[getter]
    fn v<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.column(py, 4)
    }

    /// Yaw rate [rad/s], to starboard.
    #[getter]
    fn r<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.column(py, 5)
    }

    /// Sample period [s].
    #[getter]
    fn dt(&self) -> f64 {
        self.inner.dt
    }

    /// First sample that is not finite or absurdly fast; None where there is none.
    #[getter]
    fn diverged_at(&self) -> Option<usize> {
        self.inner.diverged_at
    }

    fn __len__(&self) -> usize {
        self.inner.states.len()
    }

    /// A table of pandas with the columns t, x, y, psi, u, v, r.
    fn to_frame<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let columns = PyDict::new(py);
        columns.set_item("t", self.t(py))?;
        for (i, name) in STATE_NAMES.iter().enumerate() {
            columns.set_item(name, self.column(py, i))?;
        }
        frame(py, &columns, None)
    }

    fn __repr__(&self) -> String {
        let end = self.inner.diverged_at.map_or(String::new(), |k| format!(", diverged at sample {k}"));
        format!("<Trajectory of {} samples, {} s apart{end}>", self.inner.states.len(), self.inner.dt)
    }
}

impl Trajectory {
    fn column<'py>(&self, py: Python<'py>, channel: usize) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_iter(py, self.inner.states.iter().map(|s| s[channel]))
    }
}
