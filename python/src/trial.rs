//! The standard manoeuvring trials in Python: turning circle, zigzag and crash stop, with their measures.
//! The library sails and measures; the intervals are from draws of the model's covariance.

use crate::convert::{document, frame, matrix};
use crate::errors::{Raised, fault};
use crate::model::Inner;
use crate::work::short;
use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::Serialize;
use serde_json::Value;
use trimtab::evaluate::maneuver::{
    Approach, DRAWS, ManeuverError, ManeuverSettings, Measured, SEED, Side, Track, calm_water, drawn, set_intervals,
    stopping_trial, turning_trial, zigzag_trial,
};
use trimtab::files::suggestion;
use trimtab::ship::state::{STATE_NAMES, STATES};

/// One trial with its measures, beside the criteria of IMO MSC.137(76).
#[pyclass(module = "trimtab", frozen)]
pub struct Trial {
    whole: Value,
    track: Track,
}

impl Trial {
    fn of<M: Serialize>(trial: trimtab::evaluate::maneuver::Trial<M>) -> Result<Self, serde_json::Error> {
        Ok(Self { whole: serde_json::to_value(&trial)?, track: trial.track })
    }

    fn text(&self, key: &str) -> &str {
        self.whole.get(key).and_then(Value::as_str).unwrap_or_default()
    }

    fn part<'py>(&self, py: Python<'py>, key: &str) -> PyResult<Bound<'py, PyAny>> {
        match self.whole.get(key) {
            Some(part) => document(py, part),
            None => Ok(PyDict::new(py).into_any()),
        }
    }
}

#[pymethods]
impl Trial {
    /// In words: `turning 35 deg starboard`.
    #[getter]
    fn name(&self) -> &str {
        self.text("name")
    }

    /// "starboard" or "port": the side of the first rudder.
    #[getter]
    fn side(&self) -> &str {
        self.text("side")
    }

    /// The measures in SI units and radians, None where the trial did not reach one. Turning: advance, transfer,
    /// tactical_diameter [m], time_90, time_180 [s], steady (diameter, speed, drift, yaw_rate ...). Zigzag: overshoots [rad],
    /// initial_turning [m], reach, period [s] ... Stopping: track_reach, head_reach, lateral_deviation [m] ...
    #[getter]
    fn measures<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.part(py, "measures")
    }

    /// 95 % intervals of the measures, low and high; empty where the model's covariance is not known.
    #[getter]
    fn intervals<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.part(py, "intervals")
    }

    /// The criteria of IMO MSC.137(76) that apply: records with name, measured, limit, unit, verdict.
    #[getter]
    fn criteria<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.part(py, "criteria")
    }

    /// How the trial was approached: speed [m/s], propeller rate n [1/s] and so on.
    #[getter]
    fn approach<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.part(py, "approach")
    }

    /// How it ended: {"how": "complete"}, "time_out" or "diverged".
    #[getter]
    fn ended<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.part(py, "ended")
    }

    /// Times of the track [s], shape (K,).
    #[getter]
    fn t<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.track.t)
    }

    /// States of the track [x, y, psi, u, v, r], shape (K, 6).
    #[getter]
    fn states<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        matrix(py, self.track.states.len(), STATES, self.track.states.concat())
    }

    /// Rudder angle [rad], shape (K,).
    #[getter]
    fn delta<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.track.delta)
    }

    /// Propeller rate [1/s], shape (K,).
    #[getter]
    fn n<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.track.n)
    }

    /// Everything but the track, as dictionaries.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        document(py, &self.whole)
    }

    /// The track as a table of pandas: t, x, y, psi, u, v, r, delta, n.
    fn to_frame<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let columns = PyDict::new(py);
        columns.set_item("t", self.t(py))?;
        for (i, name) in STATE_NAMES.iter().enumerate() {
            columns.set_item(name, PyArray1::from_iter(py, self.track.states.iter().map(|s| s[i])))?;
        }
        columns.set_item("delta", self.delta(py))?;
        columns.set_item("n", self.n(py))?;
        frame(py, &columns, None)
    }

    fn __repr__(&self) -> String {
        format!("<Trial {}>", self.name())
    }
}

/// Draws of the covariance for the intervals, where there is one.
struct Draws {
    count: usize,
    seed: u64,
}

/// Sails the trials of a kind.
pub fn sail(
    py: Python<'_>,
    inner: Inner,
    kind: &str,
    angle: Option<f64>,
    [speed, n_rpm]: [Option<f64>; 2],
    as_found: bool,
    draws: Option<usize>,
    seed: Option<u64>,
) -> PyResult<Vec<Trial>> {
    const KINDS: [&str; 3] = ["turning", "zigzag", "stopping"];
    if !KINDS.contains(&kind) {
        let near = suggestion(kind, KINDS.iter().copied());
        return Err(PyValueError::new_err(format!(
            "there is no trial \"{kind}\"{near}; they are turning, zigzag and stopping"
        )));
    }
    let mut settings = ManeuverSettings { speed, n_rpm, ..ManeuverSettings::default() };
    match kind {
        "turning" => settings.turning_deg = angle,
        "zigzag" => settings.zigzag_deg = angle.map(|a| vec![[a, a]]),
        _ if angle.is_some() => {
            return Err(PyValueError::new_err("a stopping trial has no angle; leave out angle_deg"));
        }
        _ => {}
    }
    trimtab::numbers::ranges::Limited::limits(&settings).map_err(|e| PyValueError::new_err(e.to_string()))?;
    let draws = Draws { count: draws.unwrap_or(DRAWS), seed: seed.unwrap_or(SEED) };
    let trials = short(py, || sailed(&inner, kind, &settings, as_found, &draws))?.map_err(Raised::raised)?;
    trials.map_err(|e| fault(&format!("cannot write the measures ({e})")))
}

fn sailed(
    inner: &Inner,
    kind: &str,
    settings: &ManeuverSettings,
    as_found: bool,
    draws: &Draws,
) -> Result<Result<Vec<Trial>, serde_json::Error>, ManeuverError> {
    let model = if as_found { inner.model.clone() } else { calm_water(&inner.model).0 };
    let theta = model.values();
    let approach = settings.approach(&model, &theta)?;
    let thetas = inner.uncertainty.as_ref().map_or_else(Vec::new, |u| drawn(&model, u, draws.count, draws.seed));
    let again = |theta: &[f64]| settings.approach(&model, theta).ok();
    Ok(match kind {
        "turning" => {
            let angle = settings.turning_angle();
            finished(&approach, &theta, &thetas, again, |approach, theta| {
                Side::BOTH.map(|side| turning_trial(&model, theta, approach, side, angle)).to_vec()
            })
        }
        "zigzag" => {
            let angles = settings.zigzag_angles();
            finished(&approach, &theta, &thetas, again, |approach, theta| {
                let both = |a: &[f64; 2]| Side::BOTH.map(|side| zigzag_trial(&model, theta, approach, side, *a));
                angles.iter().flat_map(both).collect()
            })
        }
        _ => {
            finished(&approach, &theta, &thetas, again, |approach, theta| vec![stopping_trial(&model, theta, approach)])
        }
    })
}

/// The trials with the model's parameters, and their intervals.
fn finished<M: Measured + Send + Serialize>(
    approach: &Approach,
    theta: &[f64],
    drawn: &[trimtab::evaluate::maneuver::Drawn],
    again: impl Fn(&[f64]) -> Option<Approach> + Sync,
    sail: impl Fn(&Approach, &[f64]) -> Vec<trimtab::evaluate::maneuver::Trial<M>> + Sync,
) -> Result<Vec<Trial>, serde_json::Error> {
    let mut trials = sail(approach, theta);
    set_intervals(&mut trials, drawn, |theta| Some(sail(&again(theta)?, theta)));
    trials.into_iter().map(Trial::of).collect()
}
