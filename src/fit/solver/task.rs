//! What stays fixed during a fit: model, cost, runs, constraint rows, and the scales, bounds and start of the free parameters.
//! It prepares and translates; it neither solves nor judges a solution.

use super::constraints::{self, Row};
use super::scaling::Scaling;
use super::subspace::null_space;
use crate::fit::error::FitError;
use crate::fit::objectives::cost::{Cost, CostOptions};
use crate::fit::objectives::evaluations::Evaluations;
use crate::fit::objectives::innovations::model_at;
use crate::fit::settings::FitSettings;
use crate::likelihood::parameters::FreeParameter;
use crate::model::{Model, Parameter};
use crate::recording::Runs;
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeSet;

/// Share of its largest possible value that the product of the off-diagonal entries of the sway-yaw mass matrix may reach.
const MASS_MARGIN: f64 = 0.9;

/// Scaled violation below which a constraint counts as kept: what the solver's own relaxation of its bounds may leave.
pub(in crate::fit) const KEPT: f64 = 1e-7;

/// What stays fixed during a fit.
pub(in crate::fit) struct Task<'a> {
    pub model: &'a Model,
    pub cost: &'a Cost<'a>,
    /// Its evaluations.
    pub evaluations: Evaluations<'a>,
    /// The runs of this rank.
    pub runs: Runs<'a>,
    pub settings: &'a FitSettings,
    pub rows: Vec<Row>,
    /// The scales of the free parameters, and the sizes of the rows.
    pub scaling: Scaling,
    pub bounds: Vec<(f64, f64)>,
    pub start: Vec<f64>,
    /// Cost at the start; infinite where its simulation diverges.
    pub start_cost: f64,
    /// Sessions whose additions to the parameters enter the runs.
    sessions: Vec<String>,
    /// What some sessions add to parameters, as variables after the free parameters.
    deviations: Vec<FreeParameter>,
}

/// Rows and bounds that are active at a point.
pub(in crate::fit) struct ActiveSet {
    pub rows: Vec<usize>,
    /// Index of the free parameter, and which bound.
    pub bounds: Vec<(usize, &'static str)>,
}

impl<'a> Task<'a> {
    pub fn new(
        model: &'a Model,
        cost: &'a Cost<'a>,
        runs: Runs<'a>,
        settings: &'a FitSettings,
    ) -> Result<Self, FitError> {
        let free: Vec<&Parameter> = cost.free().iter().map(|i| &model.parameters[*i]).collect();
        if free.is_empty() {
            return Err(FitError::NothingFree);
        }
        let [slowest, fastest] = constraints::speed_range(runs);
        let ends = cost.ranks().largest(&[-slowest, fastest]);
        let rows = constraints::rows(model, &settings.constraints, [-ends[0], ends[1]])?;
        let bounds = bounds(model);
        let start: Vec<f64> = free.iter().zip(&bounds).map(|(p, (lo, hi))| p.value.max(*lo).min(*hi)).collect();
        let evaluations = Evaluations::of(cost);
        let start_cost = evaluations.value(&start).unwrap_or(f64::INFINITY);
        let scale = |p: &&Parameter| if p.scale > 0.0 && p.scale.is_finite() { p.scale } else { 1.0 };
        let scaling = Scaling::of(free.iter().map(scale).collect(), &rows);
        let mut sessions: Vec<String> = if model.sessions.is_empty() {
            Vec::new()
        } else {
            let own: BTreeSet<String> = runs.iter().map(|r| r.session.clone()).collect();
            let met: BTreeSet<String> = cost.ranks().gather(&own).into_iter().flatten().collect();
            met.into_iter().filter(|s| model.sessions.contains_key(s)).collect()
        };
        sessions.push(String::new());
        let deviations = Vec::new();
        Ok(Self {
            model,
            cost,
            evaluations,
            runs,
            settings,
            rows,
            scaling,
            bounds,
            start,
            start_cost,
            sessions,
            deviations,
        })
    }

    /// With what some sessions add to parameters as further variables. Where the parameter itself is free, its sum with the addition is a
    /// row between the bounds of the parameter.
    pub fn beside(mut self, deviations: Vec<FreeParameter>) -> Self {
        let own = self.start.len();
        let variables = own + deviations.len();
        self.rows.iter_mut().for_each(|row| row.coefficients.resize(variables, 0.0));
        let mut scales = self.scaling.scales;
        for (k, deviation) in deviations.iter().enumerate() {
            let p = &self.model.parameters[deviation.column.parameter];
            self.start.push(deviation.value(self.model));
            scales.push(deviation.column.scale.abs());
            let common = self.cost.free().iter().position(|i| *i == deviation.column.parameter);
            self.bounds
                .push(common.map_or((p.lower - p.value, p.upper - p.value), |_| (f64::NEG_INFINITY, f64::INFINITY)));
            let Some(common) = common.filter(|_| p.lower.is_finite() || p.upper.is_finite()) else { continue };
            let mut coefficients = vec![0.0; variables];
            (coefficients[common], coefficients[own + k]) = (1.0, 1.0);
            let quantity = format!("{} in some sessions", p.info.symbol);
            let (lower, upper, unit) = (p.lower, p.upper, p.info.unit);
            self.rows.push(Row { rule: "bounds", quantity, unit, coefficients, constant: 0.0, lower, upper });
        }
        let inside = |(p, (lower, upper)): (&f64, &(f64, f64))| p.max(*lower).min(*upper);
        self.start = self.start.iter().zip(&self.bounds).map(inside).collect();
        self.scaling = Scaling::of(scales, &self.rows);
        self.deviations = deviations;
        self
    }

    /// How costs of this task are evaluated.
    pub fn cost_options(&self) -> CostOptions {
        self.settings.cost_options()
    }

    /// The error of a start whose simulation diverges.
    pub fn diverged(&self) -> FitError {
        let first = || self.runs.get(0).map_or((String::new(), 0.0), |run| (run.recording.clone(), run.start_time()));
        let (run, time) = self.cost.divergence(&self.start).unwrap_or_else(first);
        FitError::Diverged { run, time }
    }

    /// The model with the free parameters, and what sessions add to them, at `p`.
    pub fn model_at(&self, p: &[f64]) -> Model {
        model_at(self.model, self.cost.free(), &self.deviations, p)
    }

    /// Whether the mass matrix at `p` can be inverted, in every session: a point where it cannot describes no ship.
    pub fn has_mass(&self, p: &[f64]) -> bool {
        self.sessions.iter().all(|session| {
            let mut theta = self.model.values();
            for (i, value) in self.cost.free().iter().zip(p) {
                theta[*i] = *value;
            }
            for (i, addition) in self.model.sessions.get(session).into_iter().flatten() {
                theta[*i] += addition;
            }
            self.model.inertia_at_rest(&theta).is_positive()
        })
    }

    /// Whether `p` is within every bound and constraint, and the mass matrix can be inverted there.
    pub fn is_feasible(&self, p: &[f64]) -> bool {
        let inside =
            |((p, (lo, hi)), scale): ((&f64, &(f64, f64)), &f64)| *p >= lo - KEPT * scale && *p <= hi + KEPT * scale;
        p.iter().zip(&self.bounds).zip(&self.scaling.scales).all(inside)
            && self.rows.iter().zip(&self.scaling.sizes).all(|(row, size)| row.violation(p) <= KEPT * size)
            && self.has_mass(p)
    }

    /// `p` put back within the bounds.
    pub fn within_bounds(&self, p: &[f64]) -> Vec<f64> {
        p.iter().zip(&self.bounds).map(|(p, (lower, upper))| p.max(*lower).min(*upper)).collect()
    }

    /// Variance of the weighted residuals of a cost, at a given value.
    pub fn variance_of(&self, cost: &Cost, value: f64) -> f64 {
        let freedom = cost.residuals().saturating_sub(self.scaling.scales.len()).max(1);
        value * cost.runs() as f64 / freedom as f64
    }

    /// Variance of the weighted residuals at a given value of the fit's cost.
    pub fn variance(&self, value: f64) -> f64 {
        self.variance_of(self.cost, value)
    }

    /// Gradient of a constraint row in scaled parameters, divided by its size.
    pub fn normal(&self, scaling: &Scaling, row: usize) -> DVector<f64> {
        let each = self.rows[row].coefficients.iter().zip(&scaling.scales);
        DVector::from_iterator(scaling.scales.len(), each.map(|(a, scale)| a * scale / scaling.sizes[row]))
    }

    /// Directions in scaled parameters along which no active constraint changes.
    pub fn free_directions(&self, active: &ActiveSet) -> DMatrix<f64> {
        null_space(&self.normals(active), self.scaling.scales.len())
    }

    /// Normals of active rows and bounds in scaled parameters, of length one.
    pub fn normals(&self, active: &ActiveSet) -> Vec<DVector<f64>> {
        let n = self.scaling.scales.len();
        let mut normals: Vec<DVector<f64>> = Vec::new();
        normals.extend(active.rows.iter().map(|i| self.normal(&self.scaling, *i)));
        for (j, _) in &active.bounds {
            let mut normal = DVector::zeros(n);
            normal[*j] = 1.0;
            normals.push(normal);
        }
        normals
    }

    /// A matrix or vector by the parameters, by the scaled parameters.
    pub fn scaled(&self, matrix: &DMatrix<f64>) -> DMatrix<f64> {
        DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
            matrix[(i, j)] * self.scaling.scales[i] * self.scaling.scales[j]
        })
    }

    pub fn scaled_vector(&self, vector: &DVector<f64>) -> DVector<f64> {
        DVector::from_fn(vector.len(), |i, _| vector[i] * self.scaling.scales[i])
    }
}

/// The bounds of the free parameters as a fit has them, in their order: those of the model, and tighter ones for the coupling added
/// masses where these could make the mass matrix singular.
pub fn bounds(model: &Model) -> Vec<(f64, f64)> {
    let free: Vec<&Parameter> = model.parameters.iter().filter(|p| p.free).collect();
    let mut bounds: Vec<(f64, f64)> = free.iter().map(|p| (p.lower, p.upper)).collect();
    keep_mass_matrix_positive(model, &free, &mut bounds);
    bounds
}

/// Tightens the bounds of Yrdot and Nvdot so that no values of the free added masses make the mass matrix singular.
///
/// With m, Iz and xG fixed, `m - Yvdot >= a` and `Iz - Nrdot >= b` follow from the bounds of Yvdot and Nrdot; the determinant
/// `(m-Yvdot)(Iz-Nrdot) - (m xG-Yrdot)(m xG-Nvdot)` is then positive wherever the two off-diagonal entries are within
/// `sqrt(0.9 a b)`. A physical added-mass matrix is well within it: `Yrdot^2 <= Yvdot Nrdot`. Where m, Iz or xG is free, or a
/// term changes them, bounds cannot say it: [`Task::has_mass`] then keeps the solver's points inside.
fn keep_mass_matrix_positive(model: &Model, free: &[&Parameter], bounds: &mut [(f64, f64)]) {
    let position = |name: &str| free.iter().position(|p| p.name == name);
    let value = |name: &str| model.index(name).map_or(0.0, |i| model.parameters[i].value);
    if ["hull.mass", "hull.inertia", "hull.x_g"].iter().any(|name| position(name).is_some()) {
        return;
    }
    let largest = |name: &str| position(name).map_or_else(|| value(name), |j| bounds[j].1);
    let (sway, yaw) = (value("hull.mass") - largest("hull.Yvdot"), value("hull.inertia") - largest("hull.Nrdot"));
    let product = MASS_MARGIN * sway * yaw;
    if !(sway > 0.0 && yaw > 0.0 && product.is_finite()) {
        return;
    }
    let moment = value("hull.mass") * value("hull.x_g");
    for (name, other) in [("hull.Yrdot", "hull.Nvdot"), ("hull.Nvdot", "hull.Yrdot")] {
        let Some(j) = position(name) else { continue };
        // Beside a fixed other entry only the product counts.
        let reach = match position(other) {
            Some(_) => product.sqrt(),
            None => product / (moment - value(other)).abs().max(1e-12 * product.sqrt()),
        };
        let (lower, upper) = (bounds[j].0.max(moment - reach), bounds[j].1.min(moment + reach));
        if lower <= upper {
            bounds[j] = (lower, upper);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::Form;
    use crate::ship::Ship;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use std::path::Path;

    #[test]
    fn what_sessions_add_is_a_variable_and_its_sum_with_a_free_parameter_a_row() -> Result<(), FitError> {
        let mut model = crate::diagnose::example::model();
        let Some(i) = model.index("rudder_offset.offset") else { return Err(FitError::NothingFree) };
        model.parameters[i].free = true;
        let runs = crate::diagnose::example::runs(&model, 2);
        let settings = FitSettings::default();
        let cost = Cost::new(&model, &runs, settings.cost_options())?;
        let column = crate::likelihood::filter::Column::tangent(&model, i);
        let deviation = FreeParameter { column, sessions: Some(vec!["a".into()]), prior: None };
        let task = Task::new(&model, &cost, (&runs[..]).into(), &settings)?.beside(vec![deviation]);
        let (n, common) = (task.start.len(), cost.free().iter().position(|j| *j == i).unwrap_or(0));
        assert_eq!((n, task.bounds.len(), task.scaling.scales.len()), (cost.free().len() + 1, n, n));
        assert_eq!(task.scaling.sizes.len(), task.rows.len());
        let mut p = task.start.clone();
        (p[common], p[n - 1]) = (0.1, 0.05);
        let at = task.model_at(&p);
        assert!((at.values_in("a")[i] - 0.15).abs() < 1e-12 && (at.values_in("b")[i] - 0.1).abs() < 1e-12);
        let Some(row) = task.rows.last() else { return Err(FitError::NothingFree) };
        assert_eq!((row.rule, row.value(&p), row.violation(&p)), ("bounds", p[common] + p[n - 1], 0.0));
        p[n - 1] = 0.35;
        assert!(row.violation(&p) > 0.09 && !task.is_feasible(&p));
        Ok(())
    }

    #[test]
    fn no_values_within_the_bounds_make_the_mass_matrix_singular() {
        let path = format!("{}/experiments/ships/a.toml", env!("CARGO_MANIFEST_DIR"));
        let mut model = Model::new(Ship::read(Path::new(&path)).unwrap(), "HD", Form::Paper, &[]).unwrap();
        for freed in [&["Yvdot", "Yrdot", "Nvdot", "Nrdot"][..], &["Yrdot"], &["Nvdot", "Yvdot"]] {
            for p in &mut model.parameters {
                p.free = freed.iter().any(|name| p.name == format!("hull.{name}"));
            }
            let free: Vec<&Parameter> = model.parameters.iter().filter(|p| p.free).collect();
            let mut bounds: Vec<(f64, f64)> = free.iter().map(|p| (p.lower, p.upper)).collect();
            keep_mass_matrix_positive(&model, &free, &mut bounds);
            let values = |p: &Parameter, (lower, upper): (f64, f64), share: f64| {
                let (lower, upper) = (lower.max(-1e3 * p.scale), upper.min(1e3 * p.scale));
                lower + share * (upper - lower)
            };
            let mut random = ChaCha8Rng::seed_from_u64(1);
            for _ in 0..1000 {
                let mut theta = model.values();
                for (p, b) in free.iter().zip(&bounds) {
                    // Corners as often as what is between them.
                    let share = if random.random_bool(0.5) {
                        f64::from(random.random_range(0..2))
                    } else {
                        random.random_range(0.0..1.0)
                    };
                    theta[model.index(&p.name).unwrap_or(0)] = values(p, *b, share);
                }
                assert!(model.inertia_at_rest(&theta).is_positive(), "{theta:?}");
            }
            // The estimates themselves are inside.
            assert!(free.iter().zip(&bounds).all(|(p, (lower, upper))| p.value > *lower && p.value < *upper));
        }
    }
}
