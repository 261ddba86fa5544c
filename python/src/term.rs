//! A force of one's own, written in Python: a function of state, inputs and parameters with derivatives by central differences, inside
//! the exact derivatives of all else. It is for trying an idea, and slow: each evaluation takes the lock of the interpreter.

use crate::sampled::Sampled;
use numpy::{AllowTypeChange, PyArray1, PyArrayLike1};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::{Mutex, PoisonError};
use trimtab::Force;
use trimtab::physics::{AnyTerm, Flow, Group, Instant, Physics, Reach, TermInfo, Validity};
use trimtab::ship::parameter::ParameterInfo;

/// The first exception of a force since the last work; the work that it spoilt raises it.
static FAILED: Mutex<Option<PyErr>> = Mutex::new(None);

/// Takes the exception of a force, if there was one.
pub fn failed() -> Option<PyErr> {
    FAILED.lock().unwrap_or_else(PoisonError::into_inner).take()
}

/// Names of what a force is given of the state, with the size of a relevant change in SI units.
const STATE: [(&str, f64); 6] =
    [("u", 1.0), ("v", 1.0), ("r", 0.01), ("psi", 1.0), ("u_ground", 1.0), ("v_ground", 1.0)];
/// The same of the inputs.
const INPUTS: [(&str, f64); 5] =
    [("n", 1.0), ("delta", 0.1), ("thruster", 1.0), ("wind_north", 10.0), ("wind_east", 10.0)];

/// Step of the differences in units of that size: the cube root of the rounding, where their error is least.
const STEP: f64 = 6e-6;

/// A parameter of a force.
#[derive(Clone)]
pub struct Own {
    name: &'static str,
    scale: f64,
    prior: Option<f64>,
}

/// The physics of a force.
struct Call {
    info: &'static TermInfo,
    force: Py<PyAny>,
    parameters: Vec<Own>,
}

/// A force of one's own for a model: `force(at, p)` gives (X, Y, N) in N, N and N m about midship, X forward, Y and N to starboard.
///
/// `at` is a dictionary of arrays of one shape (B,), several instants at once: u, v [m/s, through the water, forward and to
/// starboard], r [rad/s, to starboard], psi [rad], u_ground, v_ground [m/s, over ground], n [1/s], delta [rad], thruster [-1 to 1],
/// wind_north, wind_east [m/s, where it blows to]. `p` has the parameters by name, arrays of that shape too. The force must be smooth,
/// be nothing where all parameters are 0 (their default), and depend on what it is given alone.
///
/// `parameters` is a dictionary by name; each has `scale`, the size of a relevant change in its unit, and may have `unit`, `symbol`,
/// `about`, `lower`, `upper` and `sd`, the standard deviation of its prior about 0.
///
/// Its derivatives are taken by central differences; the exact Hessian of an objective lacks its second ones. A model with such a term
/// cannot be pickled or read from a file.
#[pyclass(module = "trimtab", frozen)]
pub struct Term {
    call: &'static Call,
}

impl Term {
    /// The term as the library knows it.
    pub fn inner(&self) -> &'static dyn AnyTerm {
        self.call
    }

    /// Its parameters' scales and priors, which the library knows by the ship alone.
    pub fn complete(&self, model: &mut trimtab::Model) {
        for own in &self.call.parameters {
            let Some(i) = model.index(&format!("{}.{}", self.call.info.name, own.name)) else { continue };
            let p = &mut model.parameters[i];
            p.scale = own.scale;
            p.prior = own.prior.map(|sd| trimtab::model::Prior { mean: 0.0, sd });
        }
    }
}

#[pymethods]
impl Term {
    #[new]
    #[pyo3(signature = (name, force, parameters, *, title=None, equation=None))]
    fn new(
        py: Python<'_>,
        name: &str,
        force: Py<PyAny>,
        parameters: &Bound<'_, PyDict>,
        title: Option<&str>,
        equation: Option<&str>,
    ) -> PyResult<Self> {
        let is_name = |name: &str| {
            let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
            name.starts_with(|c: char| c.is_ascii_lowercase()) && name.chars().all(plain)
        };
        if !is_name(name) {
            return Err(PyValueError::new_err(format!(
                "name = \"{name}\": give lower-case letters, digits and _, as in \"my_drag\""
            )));
        }
        if trimtab::terms::CATALOGUE.iter().any(|term| term.info().name == name) {
            return Err(PyValueError::new_err(format!(
                "there is a term `{name}` in the catalogue; give yours another name"
            )));
        }
        if !force.bind(py).is_callable() {
            return Err(PyTypeError::new_err("force: expected a function force(at, p) that gives (X, Y, N)"));
        }
        if parameters.is_empty() || parameters.len() > trimtab::physics::MOST_PARAMETERS {
            return Err(PyValueError::new_err(
                "parameters: give at least one, as in {\"k\": {\"scale\": 1e3, \"unit\": \"N\"}}",
            ));
        }
        let (mut infos, mut own) = (Vec::new(), Vec::new());
        for (key, value) in parameters {
            let key: String = key.extract()?;
            if !is_name(&key) {
                return Err(PyValueError::new_err(format!(
                    "parameter \"{key}\": give lower-case letters, digits and _"
                )));
            }
            let (info, one) = parameter(key, &value)?;
            infos.push(info);
            own.push(one);
        }
        // A term lasts as long as the process, as those of the catalogue do: models refer to it.
        let info: &'static TermInfo = Box::leak(Box::new(TermInfo {
            name: kept(name),
            title: kept(title.unwrap_or(name)),
            group: Group::External,
            equation: kept(equation.unwrap_or("a function in Python")),
            source: "the user's own",
            needs: &[],
            validity: Validity::any("the user's own"),
            mechanisms: &[],
            parameters: Box::leak(infos.into_boxed_slice()),
        }));
        Ok(Self { call: Box::leak(Box::new(Call { info, force, parameters: own })) })
    }

    /// Name.
    #[getter]
    fn name(&self) -> &'static str {
        self.call.info.name
    }

    /// Dotted names of its parameters.
    #[getter]
    fn parameters(&self) -> Vec<String> {
        self.call.parameters.iter().map(|p| format!("{}.{}", self.call.info.name, p.name)).collect()
    }

    fn __repr__(&self) -> String {
        format!("<Term {}: {}>", self.call.info.name, self.parameters().join(", "))
    }
}

/// A text that lasts as long as the process.
fn kept(text: &str) -> &'static str {
    Box::leak(text.to_owned().into_boxed_str())
}

/// The description of a parameter.
fn parameter(key: String, given: &Bound<'_, PyAny>) -> PyResult<(ParameterInfo, Own)> {
    let given: &Bound<'_, PyDict> = given.cast().map_err(|_| {
        PyTypeError::new_err(format!(
            "parameter \"{key}\": expected a dictionary with `scale`, as in {{\"scale\": 1e3}}"
        ))
    })?;
    const KNOWN: [&str; 7] = ["scale", "unit", "symbol", "about", "lower", "upper", "sd"];
    for entry in given.keys() {
        let entry: String = entry.extract()?;
        if !KNOWN.contains(&entry.as_str()) {
            let near = trimtab::files::suggestion(&entry, KNOWN.iter().copied());
            return Err(PyValueError::new_err(format!(
                "parameter \"{key}\": unknown `{entry}`{near}; it may have {}",
                KNOWN.join(", ")
            )));
        }
    }
    let number = |name: &str| given.get_item(name)?.map(|v| v.extract::<f64>()).transpose();
    let text = |name: &str| given.get_item(name)?.map(|v| v.extract::<String>()).transpose();
    let positive = |name: &str, value: f64| {
        if value > 0.0 && value.is_finite() {
            return Ok(value);
        }
        Err(PyValueError::new_err(format!("parameter \"{key}\": {name} = {value} must be a number above 0")))
    };
    let scale = number("scale")?.ok_or_else(|| {
        PyValueError::new_err(format!("parameter \"{key}\": give `scale`, the size of a relevant change in its unit"))
    })?;
    let scale = positive("scale", scale)?;
    let prior = number("sd")?.map(|sd| positive("sd", sd)).transpose()?;
    let (lower, upper) = (number("lower")?.unwrap_or(f64::NEG_INFINITY), number("upper")?.unwrap_or(f64::INFINITY));
    if !(lower <= 0.0 && 0.0 <= upper) {
        return Err(PyValueError::new_err(format!(
            "parameter \"{key}\": 0, its default, must be within {lower} to {upper}"
        )));
    }
    let name = kept(&key);
    let symbol = text("symbol")?.map_or(name, |s| kept(&s));
    let info = ParameterInfo::new(
        name,
        symbol,
        text("unit")?.map_or("-", |s| kept(&s)),
        text("about")?.map_or("", |s| kept(&s)),
    );
    Ok((info.bounds(lower, upper), Own { name, scale, prior }))
}

impl trimtab::physics::Term for Call {
    fn info(&self) -> &'static TermInfo {
        self.info
    }

    fn reach(&self, _parameter: usize) -> Reach {
        Reach::Force
    }
}

/// Values of all that a force depends on, at some points at once.
struct Points {
    names: Vec<&'static str>,
    /// How many of them are state or input, and no parameter.
    around: usize,
    columns: Vec<Vec<f64>>,
}

impl Call {
    /// The force at some points, one after the other in each of X, Y and N.
    fn at(&self, points: &Points) -> PyResult<[Vec<f64>; 3]> {
        Python::attach(|py| {
            let (at, p) = (PyDict::new(py), PyDict::new(py));
            for (i, (name, column)) in points.names.iter().zip(&points.columns).enumerate() {
                let into = if i < points.around { &at } else { &p };
                into.set_item(name, PyArray1::from_slice(py, column))?;
            }
            let size = points.columns.first().map_or(0, Vec::len);
            let given = self.force.bind(py).call1((at, p))?;
            let wrong =
                |e: PyErr| PyTypeError::new_err(format!("the force of `{}` must give (X, Y, N): {e}", self.info.name));
            let parts: [Bound<'_, PyAny>; 3] = given.extract().map_err(wrong)?;
            let mut values = [Vec::new(), Vec::new(), Vec::new()];
            for (value, part) in values.iter_mut().zip(parts) {
                *value = match part.extract::<f64>() {
                    Ok(constant) => vec![constant; size],
                    Err(_) => {
                        let array: PyArrayLike1<'_, f64, AllowTypeChange> = part.extract().map_err(wrong)?;
                        array.as_array().to_vec()
                    }
                };
                if value.len() != size {
                    return Err(PyValueError::new_err(format!(
                        "the force of `{}` gave {} values for {size} points; X, Y and N must have the shape of what it is given",
                        self.info.name,
                        value.len()
                    )));
                }
            }
            Ok(values)
        })
    }

    /// As [`Call::at`]; NaN where the function raised, whose exception is kept for the caller of the work.
    fn values(&self, points: &Points) -> [Vec<f64>; 3] {
        self.at(points).unwrap_or_else(|error| {
            FAILED.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
            std::array::from_fn(|_| vec![f64::NAN; points.columns.first().map_or(0, Vec::len)])
        })
    }
}

/// The part of a number that its derivatives are.
fn derivatives<S: Sampled>(x: S) -> S {
    let values: Vec<f64> = (0..S::WIDTH).map(|lane| x.lane(lane)).collect();
    x - S::of_lanes(&values)
}

impl<S> Physics<S> for Call
where
    S: Sampled,
    S::Coefficient: Sampled,
{
    fn force(&self, p: &[S::Coefficient], at: &Instant<S>, flow: &Flow<S>) -> Force<S> {
        let width = S::WIDTH;
        let state = [flow.u, flow.v, at.state.r, at.state.psi, at.state.u, at.state.v];
        let i = at.inputs;
        let plain: Vec<S::Coefficient> =
            [i.n, i.delta, i.thruster, i.wind[0], i.wind[1]].into_iter().chain(p.iter().copied()).collect();
        let lanes = |lane: &dyn Fn(usize) -> f64| (0..width).map(lane).collect::<Vec<f64>>();
        let mut columns: Vec<Vec<f64>> = state.iter().map(|x| lanes(&|lane| x.lane(lane))).collect();
        columns.extend(plain.iter().map(|x| lanes(&|lane| x.lane(lane))));
        let around = STATE.iter().chain(&INPUTS);
        let own = self.parameters.iter().map(|own| (own.name, own.scale));
        let (names, sizes): (Vec<&str>, Vec<f64>) = around.copied().chain(own).unzip();
        let carries = |v: &usize| if *v < STATE.len() { S::CARRIES } else { <S::Coefficient as Sampled>::CARRIES };
        let moved: Vec<usize> = (0..columns.len()).filter(carries).collect();

        // The points themselves, then each moved up and down in each of what carries derivatives.
        let mut steps = Vec::new();
        let mut all: Vec<Vec<f64>> = columns.iter().map(|c| c.repeat(1 + 2 * moved.len())).collect();
        for (k, v) in moved.iter().enumerate() {
            for lane in 0..width {
                let x = columns[*v][lane];
                let h = STEP * sizes[*v].max(x.abs());
                let [up, down] = [1, 2].map(|side| (2 * k + side) * width + lane);
                (all[*v][up], all[*v][down]) = (x + h, x - h);
                steps.push(all[*v][up] - all[*v][down]);
            }
        }
        let values = self.values(&Points { names, around: STATE.len() + INPUTS.len(), columns: all });
        let parts = values.map(|value| {
            let mut sum = S::of_lanes(&value[..width]);
            for (k, v) in moved.iter().enumerate() {
                let slope = |lane: usize| {
                    let [up, down] = [1, 2].map(|side| value[(2 * k + side) * width + lane]);
                    (up - down) / steps[k * width + lane]
                };
                let slope = S::of_lanes(&(0..width).map(slope).collect::<Vec<f64>>());
                let by = match v.checked_sub(STATE.len()) {
                    None => derivatives(state[*v]),
                    Some(c) => S::lift(derivatives(plain[c])),
                };
                sum += slope * by;
            }
            sum
        });
        let [x, y, n] = parts;
        Force { x, y, n }
    }
}
