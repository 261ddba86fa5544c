//! What a fit minimises, as a function for anyone's own optimiser: value, exact derivatives, constraints, bounds and scales.
//! It is the cost that [`trimtab::fit::fit`] minimises, on the same threads; it solves nothing.

use crate::convert::{finite, frame, matrix, records, vector};
use crate::errors::{FitFailed, Raised, fault};
use crate::model::Model;
use crate::study::{Side, Study};
use crate::work::short;
use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use self_cell::self_cell;
use std::sync::{Arc, Mutex, PoisonError};
use trimtab::fit::constraints::{Row, rows, speed_range};
use trimtab::fit::{Cost, FitError, FitSettings, Goal, Quadratic, bounds};
use trimtab::recording::Run;
use trimtab::ship::state::STATE_NAMES;

/// What the cost is of.
struct Question {
    model: trimtab::Model,
    runs: Arc<Vec<Run>>,
}

self_cell!(
    struct Held {
        owner: Question,
        #[not_covariant]
        dependent: Cost,
    }
);

/// A prior as a residual: index of the free parameter, mean, standard deviation.
type PriorTerm = (usize, f64, f64);

/// The weighted trajectory cost of a model against the runs of a study, with exact derivatives by the n free parameters.
///
///     C(theta) = 1/M sum_i sum_k e^T W_i e + w sum_j ((theta_j - mean_j) / sd_j)^2,      e = recorded - simulated
///
/// over M runs and their samples, W_i = diag(1/L, 1/L, 1/pi, 1/U, 1/U, 1/r_max) with the run's path length L [m] and mean speed
/// U [m/s] (Papandreou et al. 2025, eq. 5), and the priors with weight w. `theta` has shape (n,), in the parameters' own units and
/// the order of `names`. Where a simulation diverges `f` is inf, residuals are inf, and derivatives are NaN.
///
/// The residuals r of shape (m,) are scaled so that f = sum(r**2): grad = 2 J^T r, gauss_newton = 2 J^T J. SciPy's `least_squares`
/// minimises half of it, sum(r**2)/2, which has the same minimum.
///
/// All calls release the interpreter's lock. An objective can be pickled: it then stands for study file, model and settings.
#[pyclass(module = "trimtab", frozen)]
pub struct Objective {
    held: Held,
    study: Py<Study>,
    settings: FitSettings,
    side: Side,
    names: Vec<String>,
    priors: Vec<PriorTerm>,
    weight: f64,
    x0: Vec<f64>,
    bounds: Vec<(f64, f64)>,
    scales: Vec<f64>,
    rows: Vec<Row>,
    /// The last point at which derivatives were asked for, and what they were.
    last: Mutex<Option<(Vec<f64>, Arc<Quadratic>)>>,
}

impl Objective {
    /// The objective of a model against runs.
    pub fn new(
        py: Python<'_>,
        study: Py<Study>,
        model: trimtab::Model,
        runs: Arc<Vec<Run>>,
        settings: FitSettings,
        side: Side,
        weight: Option<f64>,
    ) -> PyResult<Self> {
        if settings.objective == Goal::Likelihood {
            return Err(PyValueError::new_err(
                "objective = \"likelihood\": a fit by likelihood estimates noise and initial states between its solves, so that there is \
                 no one function of the parameters; use study.fit(objective=\"likelihood\"), or the objective \"trajectory\" here",
            ));
        }
        if let Some(weight) = weight.filter(|w| !(w.is_finite() && *w >= 0.0)) {
            return Err(PyValueError::new_err(format!("prior_weight = {weight} must be a number of 0 or more")));
        }
        let free = model.free();
        if free.is_empty() {
            return Err(FitError::NothingFree.raised());
        }
        let parameters: Vec<_> = free.iter().map(|i| model.parameters[*i].clone()).collect();
        let rows = rows(&model, &settings.constraints, speed_range(&*runs)).map_err(Raised::raised)?;
        let bounds = bounds(&model);
        let x0: Vec<f64> = parameters.iter().zip(&bounds).map(|(p, (lo, hi))| p.value.max(*lo).min(*hi)).collect();
        let prior = |(j, p): (usize, &trimtab::model::Parameter)| p.prior.map(|prior| (j, prior.mean, prior.sd));
        let priors = parameters.iter().enumerate().filter_map(prior).collect();
        let scale = |p: &trimtab::model::Parameter| if p.scale > 0.0 && p.scale.is_finite() { p.scale } else { 1.0 };
        let build =
            || Held::try_new(Question { model, runs }, |q| Cost::new(&q.model, &*q.runs, settings.cost_options()));
        let held = short(py, build)?.map_err(Raised::raised)?;
        let objective = Self {
            held,
            study,
            settings,
            side,
            names: parameters.iter().map(|p| p.name.clone()).collect(),
            priors,
            weight: 0.0,
            scales: parameters.iter().map(scale).collect(),
            x0,
            bounds,
            rows,
            last: Mutex::new(None),
        };
        let weight = match weight {
            Some(weight) => weight,
            None => objective.usual_weight(py)?,
        };
        Ok(Self { weight, ..objective })
    }

    /// The weight that a fit gives the priors at its start: what a unit of the cost is worth, from the residuals' variance there.
    fn usual_weight(&self, py: Python<'_>) -> PyResult<f64> {
        if self.priors.is_empty() {
            return Ok(0.0);
        }
        let n = self.names.len();
        let at_start = |cost: &Cost| {
            let freedom = cost.residuals().saturating_sub(n).max(1);
            cost.value(&self.x0).map(|value| value / freedom as f64 * self.settings.correlated_samples)
        };
        self.on_cost(py, at_start)?.ok_or_else(|| {
            FitFailed::new_err(
                "a simulation diverges with the starting parameters, so that the weight of the priors is not known; give prior_weight, \
                 start from other parameters, or use shorter windows",
            )
        })
    }

    /// Does something with the cost, without the lock of the interpreter.
    fn on_cost<T: Send>(&self, py: Python<'_>, work: impl FnOnce(&Cost) -> T + Send) -> PyResult<T> {
        short(py, || self.held.with_dependent(|_, cost| work(cost)))
    }

    fn theta(&self, theta: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
        finite("theta", theta, &self.names)
    }

    /// Value, gradient and Gauss-Newton matrix of the data's part, from the last evaluation where that was here.
    fn quadratic(&self, py: Python<'_>, theta: &[f64]) -> PyResult<Option<Arc<Quadratic>>> {
        if let Some(known) = self.known(theta) {
            return Ok(Some(known));
        }
        let Some(new) = self.on_cost(py, |cost| cost.quadratic(theta))? else { return Ok(None) };
        let new = Arc::new(new);
        *self.last.lock().unwrap_or_else(PoisonError::into_inner) = Some((theta.to_vec(), Arc::clone(&new)));
        Ok(Some(new))
    }

    fn known(&self, theta: &[f64]) -> Option<Arc<Quadratic>> {
        let last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        last.as_ref().filter(|(at, _)| at == theta).map(|(_, known)| Arc::clone(known))
    }

    fn prior_value(&self, theta: &[f64]) -> f64 {
        self.weight * self.priors.iter().map(|(j, mean, sd)| ((theta[*j] - mean) / sd).powi(2)).sum::<f64>()
    }

    fn gradient(&self, theta: &[f64], quadratic: Option<&Quadratic>) -> Vec<f64> {
        let Some(quadratic) = quadratic else { return vec![f64::NAN; theta.len()] };
        let mut gradient: Vec<f64> = quadratic.gradient.iter().copied().collect();
        for (j, mean, sd) in &self.priors {
            gradient[*j] += 2.0 * self.weight * (theta[*j] - mean) / (sd * sd);
        }
        gradient
    }

    /// A matrix of second derivatives of the data's part with that of the priors.
    fn curvature<'py>(
        &self,
        py: Python<'py>,
        data: Option<impl IntoIterator<Item = f64>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let n = self.names.len();
        let mut values: Vec<f64> = data.map_or_else(|| vec![f64::NAN; n * n], |data| data.into_iter().collect());
        for (j, _, sd) in &self.priors {
            values[j * n + j] += 2.0 * self.weight / (sd * sd);
        }
        matrix(py, n, n, values)
    }

    /// Number of residuals, those of the priors included.
    fn count(&self) -> usize {
        self.held.with_dependent(|_, cost| cost.residuals()) + self.prior_rows()
    }

    fn prior_rows(&self) -> usize {
        if self.weight > 0.0 { self.priors.len() } else { 0 }
    }

    fn prior_residuals(&self, theta: &[f64]) -> impl Iterator<Item = f64> {
        let root = self.weight.sqrt();
        let rows = self.priors[..self.prior_rows()].iter();
        rows.map(move |(j, mean, sd)| root * (theta[*j] - mean) / sd).collect::<Vec<_>>().into_iter()
    }
}

#[pymethods]
impl Objective {
    /// Dotted names of the n free parameters, in the order of `theta`.
    #[getter]
    fn names(&self) -> Vec<String> {
        self.names.clone()
    }

    /// The model's values of the free parameters, put within the bounds: where a fit starts, shape (n,).
    #[getter]
    fn x0<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.x0)
    }

    /// Lower and upper bounds, each of shape (n,), infinite where there is none: as a fit has them.
    #[getter]
    fn bounds<'py>(&self, py: Python<'py>) -> (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>) {
        let of = |side: fn(&(f64, f64)) -> f64| PyArray1::from_iter(py, self.bounds.iter().map(side));
        (of(|b| b.0), of(|b| b.1))
    }

    /// Size of a relevant change of each parameter, in its own unit, shape (n,): `x_scale` of SciPy.
    #[getter]
    fn scales<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.scales)
    }

    /// Weight w of the priors in the cost; 0 where no free parameter has one.
    #[getter]
    fn prior_weight(&self) -> f64 {
        self.weight
    }

    /// Number of residuals m, those of the priors included.
    #[getter]
    fn size(&self) -> usize {
        self.count()
    }

    /// Number of runs M.
    #[getter]
    fn runs(&self) -> usize {
        self.held.with_dependent(|_, cost| cost.runs())
    }

    /// The cost C(theta); inf where a simulation diverges.
    fn f(&self, py: Python<'_>, theta: &Bound<'_, PyAny>) -> PyResult<f64> {
        let theta = self.theta(theta)?;
        let data = match self.known(&theta) {
            Some(known) => Some(known.value),
            None => self.on_cost(py, |cost| cost.value(&theta))?,
        };
        Ok(data.map_or(f64::INFINITY, |value| value + self.prior_value(&theta)))
    }

    /// The exact gradient dC/dtheta, shape (n,).
    fn grad<'py>(&self, py: Python<'py>, theta: &Bound<'_, PyAny>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let theta = self.theta(theta)?;
        let quadratic = self.quadratic(py, &theta)?;
        Ok(PyArray1::from_vec(py, self.gradient(&theta, quadratic.as_deref())))
    }

    /// Cost and gradient from one evaluation: `minimize(objective.f_and_grad, ..., jac=True)`.
    fn f_and_grad<'py>(&self, py: Python<'py>, theta: &Bound<'_, PyAny>) -> PyResult<(f64, Bound<'py, PyArray1<f64>>)> {
        let theta = self.theta(theta)?;
        let quadratic = self.quadratic(py, &theta)?;
        let value = quadratic.as_ref().map_or(f64::INFINITY, |q| q.value + self.prior_value(&theta));
        Ok((value, PyArray1::from_vec(py, self.gradient(&theta, quadratic.as_deref()))))
    }

    /// The Gauss-Newton matrix 2 J^T J, shape (n, n): the Hessian without the residuals' own curvature.
    fn gauss_newton<'py>(&self, py: Python<'py>, theta: &Bound<'_, PyAny>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let theta = self.theta(theta)?;
        let quadratic = self.quadratic(py, &theta)?;
        // It is symmetric: the order of rows and columns does not matter.
        self.curvature(py, quadratic.as_ref().map(|q| q.gauss_newton.iter().copied()))
    }

    /// The exact Hessian d2C/dtheta2 by second-order dual numbers, shape (n, n); many times as slow as `gauss_newton`.
    fn hessian<'py>(&self, py: Python<'py>, theta: &Bound<'_, PyAny>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let theta = self.theta(theta)?;
        let data = self.on_cost(py, |cost| cost.hessian(&theta).map(|h| h.iter().copied().collect::<Vec<f64>>()))?;
        self.curvature(py, data)
    }

    /// The residuals r with f = sum(r**2), shape (m,): run after run, sample after sample, channel after channel (see `labels`),
    /// then one for each prior. inf where a simulation diverges.
    fn residuals<'py>(&self, py: Python<'py>, theta: &Bound<'_, PyAny>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let theta = self.theta(theta)?;
        let values = match self.on_cost(py, |cost| cost.residuals_at(&theta))? {
            Some(own) => own.values.into_iter().chain(self.prior_residuals(&theta)).collect(),
            None => vec![f64::INFINITY; self.count()],
        };
        Ok(PyArray1::from_vec(py, values))
    }

    /// The exact derivatives J = dr/dtheta, shape (m, n); NaN where a simulation diverges.
    fn jacobian<'py>(&self, py: Python<'py>, theta: &Bound<'_, PyAny>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let theta = self.theta(theta)?;
        let (n, m) = (self.names.len(), self.count());
        let Some(own) = self.on_cost(py, |cost| cost.jacobian_at(&theta))? else {
            return matrix(py, m, n, vec![f64::NAN; m * n]);
        };
        let mut slopes = own.slopes;
        for (j, _, sd) in &self.priors[..self.prior_rows()] {
            let start = slopes.len();
            slopes.resize(start + n, 0.0);
            slopes[start + j] = self.weight.sqrt() / sd;
        }
        matrix(py, m, n, slopes)
    }

    /// What each residual compares, as records with run, sample and channel (x, y, psi, u, v, r), or prior and the parameter's name.
    fn labels(&self, py: Python<'_>) -> PyResult<Vec<(String, Option<usize>, String)>> {
        let compared = self.on_cost(py, |cost| cost.compared())?.ok_or_else(|| fault("the runs cannot be read"))?;
        let runs = &self.held.borrow_owner().runs;
        let of_run =
            compared.iter().map(|c| (runs[c.run].name.clone(), Some(c.sample), STATE_NAMES[c.channel].to_owned()));
        let of_prior = self.priors[..self.prior_rows()].iter();
        Ok(of_run.chain(of_prior.map(|(j, ..)| ("prior".to_owned(), None, self.names[*j].clone()))).collect())
    }

    /// The linear constraints of the fit, lower <= A theta <= upper.
    fn constraints(&self) -> Constraints {
        let kept = |p: fn(&Row) -> f64| self.rows.iter().map(|row| p(row) - row.constant).collect();
        Constraints {
            columns: self.names.len(),
            matrix: self.rows.iter().flat_map(|row| row.coefficients.iter().copied()).collect(),
            lower: kept(|row| row.lower),
            upper: kept(|row| row.upper),
            rules: self.rows.iter().map(|row| row.rule).collect(),
            quantities: self.rows.iter().map(|row| format!("{} [{}]", row.quantity, unit(row.unit))).collect(),
        }
    }

    /// The model with its free parameters at `theta`.
    fn model_at(&self, theta: &Bound<'_, PyAny>) -> PyResult<Model> {
        let theta = self.theta(theta)?;
        let mut model = self.held.borrow_owner().model.clone();
        for (i, value) in model.free().into_iter().zip(theta) {
            model.parameters[i].value = value;
        }
        Ok(Model::of(model, None))
    }

    fn __call__(&self, py: Python<'_>, theta: &Bound<'_, PyAny>) -> PyResult<f64> {
        self.f(py, theta)
    }

    fn __repr__(&self) -> String {
        format!("<Objective of {} parameters: {} residuals of {} runs>", self.names.len(), self.count(), self.runs())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let settings =
            serde_json::to_string(&self.settings).map_err(|e| fault(&format!("cannot write the settings ({e})")))?;
        let model = Model::of(self.held.borrow_owner().model.clone(), None);
        let arguments = (self.study.clone_ref(py), model, settings, self.side.word(), self.weight).into_pyobject(py)?;
        Ok((py.get_type::<Self>().getattr("_restore")?, arguments))
    }

    /// An objective from what a pickle keeps of it.
    #[staticmethod]
    fn _restore(
        py: Python<'_>,
        study: Py<Study>,
        model: &Model,
        settings: &str,
        split: &str,
        weight: f64,
    ) -> PyResult<Self> {
        let settings =
            serde_json::from_str(settings).map_err(|e| PyValueError::new_err(format!("no objective: {e}")))?;
        let side = Side::named(split)?;
        let runs = study.get().windows_of(py, side)?;
        Self::new(py, study, model.snapshot().model, runs, settings, side, Some(weight))
    }
}

fn unit(unit: &str) -> &str {
    if unit.is_empty() { "-" } else { unit }
}

/// Linear constraints on the free parameters, `lower <= matrix @ theta <= upper`: each rule of [fit.constraints] bounds a curve of the
/// model (resistance, lift, drag, thrust) at the samples of a grid. `scipy.optimize.LinearConstraint(c.matrix, c.lower, c.upper)`.
#[pyclass(module = "trimtab", frozen)]
pub struct Constraints {
    columns: usize,
    matrix: Vec<f64>,
    lower: Vec<f64>,
    upper: Vec<f64>,
    rules: Vec<&'static str>,
    quantities: Vec<String>,
}

#[pymethods]
impl Constraints {
    /// The matrix, shape (rows, n).
    #[getter]
    fn matrix<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        matrix(py, self.lower.len(), self.columns, self.matrix.clone())
    }

    /// Lower limits, shape (rows,), -inf for none.
    #[getter]
    fn lower<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.lower)
    }

    /// Upper limits, shape (rows,), inf for none.
    #[getter]
    fn upper<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.upper)
    }

    /// Key of the rule of each row.
    #[getter]
    fn rules(&self) -> Vec<&'static str> {
        self.rules.clone()
    }

    /// What each row bounds, with its unit: `R'(1.31 m/s) [N s/m]`.
    #[getter]
    fn quantities(&self) -> Vec<String> {
        self.quantities.clone()
    }

    /// By how much each row is broken at `theta`, 0 where it is kept, shape (rows,).
    fn violation<'py>(&self, py: Python<'py>, theta: &Bound<'_, PyAny>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let theta = vector("theta", theta)?;
        if theta.len() != self.columns {
            let words = format!("theta has {} values, and {} are needed", theta.len(), self.columns);
            return Err(PyValueError::new_err(words));
        }
        let broken = |(row, (lower, upper)): (&[f64], (&f64, &f64))| {
            let value: f64 = row.iter().zip(&theta).map(|(a, p)| a * p).sum();
            (lower - value).max(value - upper).max(0.0)
        };
        let limits = self.lower.iter().zip(&self.upper);
        Ok(PyArray1::from_iter(py, self.matrix.chunks(self.columns.max(1)).zip(limits).map(broken)))
    }

    fn __len__(&self) -> usize {
        self.lower.len()
    }

    /// A table of pandas with rule, quantity, lower and upper.
    fn to_frame<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let all: Vec<usize> = (0..self.lower.len()).collect();
        let rows = records(py, &all, |i, row: &Bound<'py, PyDict>| {
            row.set_item("rule", self.rules[*i])?;
            row.set_item("quantity", &self.quantities[*i])?;
            row.set_item("lower", self.lower[*i])?;
            row.set_item("upper", self.upper[*i])
        })?;
        frame(py, &rows, None)
    }

    fn __repr__(&self) -> String {
        format!("<Constraints: {} rows>", self.lower.len())
    }
}
