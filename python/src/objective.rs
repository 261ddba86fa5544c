//! What a fit minimises, as a function for anyone's own optimiser: value, exact derivatives, constraints, bounds and scales.
//! It is the cost that [`trimtab::fit::fit`] minimises, on the same threads; it solves nothing.

use crate::convert::{document, finite, frame, matrix, numbers, records, vector};
use crate::errors::{FitFailed, Raised, fault};
use crate::function::{Function, Made, Question};
use crate::model::Model;
use crate::study::{Side, Study};
use crate::work::short;
use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use self_cell::self_cell;
use std::sync::{Arc, Mutex, PoisonError};
use trimtab::fit::solver::constraints::{Row, rows, speed_range};
use trimtab::fit::{FitError, FitSettings, Goal, Quadratic, bounds, noise_at, with_uncertain_coefficients};
use trimtab::likelihood::noise::Noise;
use trimtab::model::Parameter;
use trimtab::recording::Run;
use trimtab::ship::state::STATE_NAMES;

self_cell!(
    struct Held {
        owner: Question,
        #[not_covariant]
        dependent: Function,
    }
);

/// What a caller asks an objective to be.
#[derive(Clone)]
pub struct Wanted {
    pub model: trimtab::Model,
    pub settings: FitSettings,
    pub side: Side,
    /// Weight of the priors, as a fit has it where absent.
    pub weight: Option<f64>,
    /// Whether coefficients that are never known exactly are free in a likelihood.
    pub uncertain: bool,
}

/// A prior as a residual: index of the free parameter, mean, standard deviation.
type PriorTerm = (usize, f64, f64);

/// What a fit minimises, with exact derivatives by the n free parameters: the trajectory cost, or the likelihood.
///
/// The trajectory cost, where `kind` is "trajectory" and a = 1:
///
///     C(theta) = 1/M sum_i sum_k e^T W_i e + w sum_j ((theta_j - mean_j) / sd_j)^2,      e = recorded - simulated
///
/// over M runs and their samples, W_i = diag(1/L, 1/L, 1/pi, 1/U, 1/U, 1/r_max) with the run's path length L [m] and mean speed
/// U [m/s] (Papandreou et al. 2025, eq. 5), and the priors with weight w.
///
/// The likelihood with the gains of the Kalman filter fixed, where `kind` is "likelihood" and a = 1/2:
///
///     f(theta) = 1/2 sum_k e_k^2 / s_k + w sum_j ((theta_j - mean_j) / sd_j)^2,      e_k = recorded - expected by the filter
///
/// with w = 1/2: -f is the logarithm of the posterior up to a constant. `noise` is estimated and the gains and variances s_k are made at
/// x0; the further theta is from there, the more f differs from the likelihood with gains made at theta. `renewed(theta)` makes them
/// anew, as a fit by likelihood does until it settles.
///
/// `theta` has shape (n,), in the parameters' own units and the order of `names`. Where the model leaves the numbers, or `theta` contains
/// NaN or inf, f is inf, residuals are inf, and derivatives are NaN: nothing is raised, so that an optimiser can go back.
///
/// The residuals r of shape (m,) are scaled so that f = a sum(r**2): grad = 2 a J^T r, gauss_newton = 2 a J^T J. SciPy's `least_squares`
/// minimises sum(r**2)/2, which has the same minimum.
///
/// All calls release the interpreter's lock. An objective can be pickled: it then stands for study file, model, settings and gains.
#[pyclass(module = "trimtab", frozen)]
pub struct Objective {
    held: Held,
    study: Py<Study>,
    /// What was asked for, with the weight that was found.
    wanted: Wanted,
    names: Vec<String>,
    priors: Vec<PriorTerm>,
    weight: f64,
    /// Number of residuals of the data.
    count: usize,
    x0: Vec<f64>,
    bounds: Vec<(f64, f64)>,
    scales: Vec<f64>,
    rows: Vec<Row>,
    /// The last point at which derivatives were asked for, and what they were.
    last: Mutex<Option<(Vec<f64>, Arc<Quadratic>)>>,
}

/// The factor a on the squares of the residuals.
fn factor(goal: Goal) -> f64 {
    match goal {
        Goal::Trajectory => 1.0,
        Goal::Likelihood => 0.5,
    }
}

impl Objective {
    /// The objective that was asked for, against runs; a likelihood with its gains as they were `made`, or else of the start.
    pub fn new(
        py: Python<'_>,
        study: Py<Study>,
        wanted: Wanted,
        runs: Arc<Vec<Run>>,
        made: Option<Made>,
    ) -> PyResult<Self> {
        let Wanted { settings, weight, .. } = &wanted;
        if let Some(weight) = weight.filter(|w| !(w.is_finite() && *w >= 0.0)) {
            return Err(PyValueError::new_err(format!("prior_weight = {weight} must be a number of 0 or more")));
        }
        let likelihood = settings.objective == Goal::Likelihood;
        let model = if likelihood && wanted.uncertain {
            with_uncertain_coefficients(&wanted.model)
        } else {
            wanted.model.clone()
        };
        let free = model.free();
        if free.is_empty() {
            return Err(FitError::NothingFree.raised());
        }
        let parameters: Vec<Parameter> = free.iter().map(|i| model.parameters[*i].clone()).collect();
        let rows = rows(&model, &settings.constraints, speed_range(&*runs)).map_err(Raised::raised)?;
        let bounds = bounds(&model);
        let start = parameters.iter().zip(&bounds).map(|(p, (lo, hi))| p.value.max(*lo).min(*hi)).collect();
        let x0: Vec<f64> = made.as_ref().map_or(start, |made| made.at.clone());
        let prior = |(j, p): (usize, &Parameter)| p.prior.map(|prior| (j, prior.mean, prior.sd));
        let priors = parameters.iter().enumerate().filter_map(prior).collect();
        let scale = |p: &Parameter| if p.scale > 0.0 && p.scale.is_finite() { p.scale } else { 1.0 };
        let build = || {
            let of_start = || Made { noise: noise_at(&model, &runs, settings.integration, None, &x0), at: x0.clone() };
            let made = likelihood.then(|| made.unwrap_or_else(of_start));
            let held = Held::try_new(Question { model, runs, made }, |question| Function::new(question, settings))?;
            let count = held.with_dependent(|_, function| function.count());
            Ok((held, count))
        };
        let (held, count) = short(py, build)?.map_err(|error: FitError| error.raised())?;
        let objective = Self {
            held,
            study,
            names: parameters.iter().map(|p| p.name.clone()).collect(),
            priors,
            weight: weight.unwrap_or(0.5),
            count,
            scales: parameters.iter().map(scale).collect(),
            x0,
            bounds,
            rows,
            last: Mutex::new(None),
            wanted,
        };
        let weight = match objective.wanted.weight {
            None if !likelihood => objective.usual_weight(py)?,
            _ => objective.weight,
        };
        let wanted = Wanted { weight: Some(weight), ..objective.wanted };
        Ok(Self { weight, wanted, ..objective })
    }

    /// The weight that a fit of trajectories gives the priors at its start: what a unit of the cost is worth, from the residuals' variance
    /// there.
    fn usual_weight(&self, py: Python<'_>) -> PyResult<f64> {
        if self.priors.is_empty() {
            return Ok(0.0);
        }
        let freedom = self.count.saturating_sub(self.names.len()).max(1);
        let value = self.on_function(py, |function| function.value(&self.x0))?;
        value.map(|value| value / freedom as f64 * self.wanted.settings.correlated_samples).ok_or_else(|| {
            FitFailed::new_err(
                "a simulation diverges with the starting parameters, so that the weight of the priors is not known; give prior_weight, \
                 start from other parameters, or use shorter windows",
            )
        })
    }

    /// Does something with the function, without the lock of the interpreter.
    fn on_function<T: Send>(&self, py: Python<'_>, work: impl FnOnce(&Function) -> T + Send) -> PyResult<T> {
        short(py, || self.held.with_dependent(|_, function| work(function)))
    }

    fn goal(&self) -> Goal {
        self.wanted.settings.objective
    }

    /// A point as an optimiser gives it, which may be out of the numbers.
    fn theta(&self, theta: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
        numbers("theta", theta, &self.names)
    }

    /// A point at which something is made that lasts.
    fn finite_theta(&self, theta: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
        finite("theta", theta, &self.names)
    }

    /// What the function gives at a point; `None` where it gives nothing, as out of the numbers. Optimisers go there: after an infinite
    /// value the line search of L-BFGS-B asks at NaN.
    fn at<T: Send>(
        &self,
        py: Python<'_>,
        theta: &[f64],
        work: impl FnOnce(&Function) -> Option<T> + Send,
    ) -> PyResult<Option<T>> {
        if theta.iter().all(|p| p.is_finite()) { self.on_function(py, work) } else { Ok(None) }
    }

    /// Value, gradient and Gauss-Newton matrix of the data's part, from the last evaluation where that was here.
    fn quadratic(&self, py: Python<'_>, theta: &[f64]) -> PyResult<Option<Arc<Quadratic>>> {
        if let Some(known) = self.known(theta) {
            return Ok(Some(known));
        }
        let Some(new) = self.at(py, theta, |function| function.quadratic(theta))? else { return Ok(None) };
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
        self.count + self.prior_rows()
    }

    fn prior_rows(&self) -> usize {
        if self.weight > 0.0 { self.priors.len() } else { 0 }
    }

    /// What a prior's residual is in its standard deviations.
    fn prior_root(&self) -> f64 {
        (self.weight / factor(self.goal())).sqrt()
    }

    fn prior_residuals(&self, theta: &[f64]) -> impl Iterator<Item = f64> {
        let root = self.prior_root();
        let rows = self.priors[..self.prior_rows()].iter();
        rows.map(move |(j, mean, sd)| root * (theta[*j] - mean) / sd).collect::<Vec<_>>().into_iter()
    }
}

#[pymethods]
impl Objective {
    /// "trajectory" or "likelihood".
    #[getter]
    fn kind(&self) -> &'static str {
        match self.goal() {
            Goal::Trajectory => "trajectory",
            Goal::Likelihood => "likelihood",
        }
    }

    /// Dotted names of the n free parameters, in the order of `theta`.
    #[getter]
    fn names(&self) -> Vec<String> {
        self.names.clone()
    }

    /// The model's values of the free parameters, put within the bounds: where a fit starts, shape (n,). Of a likelihood the point of its
    /// gains, which is the same until it is `renewed`.
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

    /// Weight w of the priors: 1/2 in a likelihood; in a trajectory cost what a fit gives them, 0 where no free parameter has one.
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
        self.held.borrow_owner().runs.len()
    }

    /// The value, without a unit; inf where the model leaves the numbers, or `theta` does.
    fn f(&self, py: Python<'_>, theta: &Bound<'_, PyAny>) -> PyResult<f64> {
        let theta = self.theta(theta)?;
        let data = match self.known(&theta) {
            Some(known) => Some(known.value),
            None => self.at(py, &theta, |function| function.value(&theta))?,
        };
        Ok(data.map_or(f64::INFINITY, |value| value + self.prior_value(&theta)))
    }

    /// The exact gradient df/dtheta, shape (n,).
    fn grad<'py>(&self, py: Python<'py>, theta: &Bound<'_, PyAny>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let theta = self.theta(theta)?;
        let quadratic = self.quadratic(py, &theta)?;
        Ok(PyArray1::from_vec(py, self.gradient(&theta, quadratic.as_deref())))
    }

    /// Value and gradient from one evaluation: `minimize(objective.f_and_grad, ..., jac=True)`.
    fn f_and_grad<'py>(&self, py: Python<'py>, theta: &Bound<'_, PyAny>) -> PyResult<(f64, Bound<'py, PyArray1<f64>>)> {
        let theta = self.theta(theta)?;
        let quadratic = self.quadratic(py, &theta)?;
        let value = quadratic.as_ref().map_or(f64::INFINITY, |q| q.value + self.prior_value(&theta));
        Ok((value, PyArray1::from_vec(py, self.gradient(&theta, quadratic.as_deref()))))
    }

    /// The Gauss-Newton matrix 2 a J^T J, shape (n, n): the Hessian without the residuals' own curvature. Of a likelihood it is the
    /// information of data and priors, whose inverse is near the covariance of the posterior.
    fn gauss_newton<'py>(&self, py: Python<'py>, theta: &Bound<'_, PyAny>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let theta = self.theta(theta)?;
        let quadratic = self.quadratic(py, &theta)?;
        // It is symmetric: the order of rows and columns does not matter.
        self.curvature(py, quadratic.as_ref().map(|q| q.gauss_newton.iter().copied()))
    }

    /// The exact Hessian d2f/dtheta2 by second-order dual numbers, shape (n, n); many times as slow as `gauss_newton`. Of a trajectory
    /// cost alone.
    fn hessian<'py>(&self, py: Python<'py>, theta: &Bound<'_, PyAny>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        if self.goal() == Goal::Likelihood {
            return Err(PyValueError::new_err(
                "a likelihood has no exact Hessian; use gauss_newton(theta), or differences of grad(theta), which is exact",
            ));
        }
        let theta = self.theta(theta)?;
        let data = self.at(py, &theta, |function| function.hessian(&theta))?;
        self.curvature(py, data)
    }

    /// The residuals r with f = a sum(r**2), shape (m,): run after run, sample after sample, channel after channel (see `labels`),
    /// then one for each prior. Of a likelihood the standardised innovations, without those that were outliers when its gains were made.
    /// inf where the model leaves the numbers.
    fn residuals<'py>(&self, py: Python<'py>, theta: &Bound<'_, PyAny>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let theta = self.theta(theta)?;
        let values = match self.at(py, &theta, |function| function.residuals_at(&theta))? {
            Some(own) => own.values.into_iter().chain(self.prior_residuals(&theta)).collect(),
            None => vec![f64::INFINITY; self.count()],
        };
        Ok(PyArray1::from_vec(py, values))
    }

    /// The exact derivatives J = dr/dtheta, shape (m, n); NaN where the model leaves the numbers.
    fn jacobian<'py>(&self, py: Python<'py>, theta: &Bound<'_, PyAny>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let theta = self.theta(theta)?;
        let (n, m) = (self.names.len(), self.count());
        let Some(own) = self.at(py, &theta, |function| function.jacobian_at(&theta))? else {
            return matrix(py, m, n, vec![f64::NAN; m * n]);
        };
        let mut slopes = own.slopes;
        for (j, _, sd) in &self.priors[..self.prior_rows()] {
            let start = slopes.len();
            slopes.resize(start + n, 0.0);
            slopes[start + j] = self.prior_root() / sd;
        }
        matrix(py, m, n, slopes)
    }

    /// What each residual compares, as tuples: (run, sample, channel) with the channel x, y, psi, u, v or r, and ("prior", None, parameter)
    /// of a prior.
    fn labels(&self, py: Python<'_>) -> PyResult<Vec<(String, Option<usize>, String)>> {
        let compared =
            self.on_function(py, |function| function.compared())?.ok_or_else(|| fault("the runs cannot be read"))?;
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

    /// The noise of a likelihood: of each group of `sensors` (position [m], heading [rad], speed [m/s], yaw rate [rad/s], in this order) the
    /// standard deviations of the `white` and the `coloured` part and the correlation `time` [s] of the latter; the standard deviations of
    /// the unknown `force` in X, Y [N] and N [N m], and its correlation time `force_time` [s]. None of a trajectory cost.
    #[getter]
    fn noise<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.held.borrow_owner().made.as_ref().map(|made| document(py, &made.noise)).transpose()
    }

    /// The likelihood with its gains made anew at `theta`, which is its `x0`, and the noise estimated there from this objective's on.
    ///
    /// The estimate of the noise is a local one, and another start may find another: `noise`, such as `Fit.noise`, is taken as it is.
    #[pyo3(signature = (theta, *, noise=None))]
    fn renewed(&self, py: Python<'_>, theta: &Bound<'_, PyAny>, noise: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let at = self.finite_theta(theta)?;
        let Question { model, runs, made } = self.held.borrow_owner();
        let Some(made) = made else {
            return Err(PyValueError::new_err(
                "a trajectory cost has no gains to renew: it is the same function everywhere; study.objective(objective=\"likelihood\") \
                 has them",
            ));
        };
        let integration = self.wanted.settings.integration;
        let noise = match noise {
            Some(given) => noise_of(given)?,
            None => short(py, || noise_at(model, runs, integration, Some(&made.noise), &at))?,
        };
        let made = Some(Made { noise, at });
        Self::new(py, self.study.clone_ref(py), self.wanted.clone(), Arc::clone(runs), made)
    }

    /// The model with its free parameters at `theta`.
    fn model_at(&self, theta: &Bound<'_, PyAny>) -> PyResult<Model> {
        let theta = self.finite_theta(theta)?;
        let mut model = self.wanted.model.clone();
        for (i, value) in self.held.borrow_owner().model.free().into_iter().zip(theta) {
            model.parameters[i].value = value;
        }
        Ok(Model::of(model, None))
    }

    fn __call__(&self, py: Python<'_>, theta: &Bound<'_, PyAny>) -> PyResult<f64> {
        self.f(py, theta)
    }

    fn __repr__(&self) -> String {
        let (kind, count, runs) = (self.kind(), self.count(), self.runs());
        format!("<Objective ({kind}) of {} parameters: {count} residuals of {runs} runs>", self.names.len())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let Wanted { model, settings, side, uncertain, .. } = &self.wanted;
        let written = |e| fault(&format!("cannot write the settings ({e})"));
        let kept = serde_json::to_string(&(settings, &self.held.borrow_owner().made)).map_err(written)?;
        let model = Model::of(model.clone(), None);
        let arguments = (self.study.clone_ref(py), model, kept, side.word(), self.weight, *uncertain);
        Ok((py.get_type::<Self>().getattr("_restore")?, arguments.into_pyobject(py)?))
    }

    /// An objective from what a pickle keeps of it.
    #[staticmethod]
    fn _restore(
        py: Python<'_>,
        study: Py<Study>,
        model: &Model,
        kept: &str,
        split: &str,
        weight: f64,
        uncertain: bool,
    ) -> PyResult<Self> {
        let (settings, made): (FitSettings, Option<Made>) =
            serde_json::from_str(kept).map_err(|e| PyValueError::new_err(format!("no objective: {e}")))?;
        let side = Side::named(split)?;
        let runs = study.get().windows_of(py, side)?;
        let wanted = Wanted { model: model.snapshot().model, settings, side, weight: Some(weight), uncertain };
        Self::new(py, study, wanted, runs, made)
    }
}

/// A noise as `noise` gives it.
fn noise_of(given: &Bound<'_, PyAny>) -> PyResult<Noise> {
    let text: String = given.py().import("json")?.call_method1("dumps", (given,))?.extract()?;
    let noise: Noise = serde_json::from_str(&text)
        .map_err(|e| PyValueError::new_err(format!("noise: {e}; give what Objective.noise or Fit.noise gives")))?;
    if noise.to_log().iter().all(|log| log.is_finite()) {
        return Ok(noise);
    }
    Err(PyValueError::new_err("noise: standard deviations and times must be finite numbers above 0"))
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

    /// By how much each row is broken at `theta`, 0 where it is kept, shape (rows,); NaN where `theta` is.
    fn violation<'py>(&self, py: Python<'py>, theta: &Bound<'_, PyAny>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let theta = vector("theta", theta)?;
        if theta.len() != self.columns {
            let words = format!("theta has {} values, and {} are needed", theta.len(), self.columns);
            return Err(PyValueError::new_err(words));
        }
        let broken = |(row, (lower, upper)): (&[f64], (&f64, &f64))| {
            let value: f64 = row.iter().zip(&theta).map(|(a, p)| a * p).sum();
            // The greater of NaN and a number is the number.
            if value.is_nan() { value } else { (lower - value).max(value - upper).max(0.0) }
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
