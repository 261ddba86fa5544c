//! What a nonlinear program must be able to evaluate, and what Ipopt reports of each iteration.
//! It says nothing of how the program is solved.

/// A nonlinear program: objective, constraints and their derivatives.
///
/// Evaluations take `&mut self` so that an implementation can keep what the objective and the gradient share. They return
/// `None` or `false` where the point cannot be evaluated; a value that is not finite counts as such a refusal. Ipopt answers a
/// refusal of the objective or of the constraint values with a shorter step. It has no such answer for the derivatives: there
/// a refusal ends the solve with [`Status::InvalidNumber`](super::Status::InvalidNumber), so refuse a point in [`Nlp::objective`] already.
pub trait Nlp {
    /// Number of variables n, at least 1.
    fn variables(&self) -> usize;

    /// Number of constraints m, possibly 0.
    fn constraints(&self) -> usize;

    /// Writes the bounds of the variables, n each; infinite where there is none, equal where the variable is fixed.
    fn variable_bounds(&self, lower: &mut [f64], upper: &mut [f64]);

    /// Writes the bounds of the constraint values, m each; infinite where there is none, equal for an equality.
    fn constraint_bounds(&self, lower: &mut [f64], upper: &mut [f64]);

    /// Writes the point to start from. Ipopt first moves it strictly inside the variable bounds.
    fn start(&self, x: &mut [f64]);

    /// Multipliers to start with, of a program that differs little from one that was solved: Ipopt then starts from these and
    /// does not push the start away from its bounds. `None` where nothing is known of them.
    fn multipliers(&self) -> Option<Multipliers> {
        None
    }

    /// The objective f(x), or `None` where it cannot be evaluated.
    fn objective(&mut self, x: &[f64]) -> Option<f64>;

    /// Writes the n entries of the objective's gradient; false where it cannot be evaluated.
    fn gradient(&mut self, x: &[f64], gradient: &mut [f64]) -> bool;

    /// Writes the m constraint values g(x); false where they cannot be evaluated.
    fn constraint_values(&mut self, x: &[f64], values: &mut [f64]) -> bool;

    /// The (constraint, variable) pairs, counted from 0, of the Jacobian entries that may differ from zero. Entries named
    /// twice are added.
    fn jacobian_structure(&self) -> Vec<(usize, usize)>;

    /// Writes dg/dx in the order of [`Nlp::jacobian_structure`]; false where it cannot be evaluated.
    fn jacobian_values(&mut self, x: &[f64], values: &mut [f64]) -> bool;

    /// The (row, column) pairs, row >= column, of the Hessian of the Lagrangian. Empty means that there is none to give: the
    /// solve then uses [`HessianMode::LimitedMemory`](super::HessianMode::LimitedMemory) whatever the options say.
    fn hessian_structure(&self) -> Vec<(usize, usize)>;

    /// Writes `objective_factor` d2f/dx2 + sum of `multipliers[i]` d2g_i/dx2, in the order of [`Nlp::hessian_structure`];
    /// false where it cannot be evaluated. A positive semidefinite approximation (Gauss-Newton) serves as well.
    fn hessian_values(&mut self, x: &[f64], objective_factor: f64, multipliers: &[f64], values: &mut [f64]) -> bool;

    /// Called once per iteration; false stops the solve with [`Status::Stopped`](super::Status::Stopped).
    fn iteration(&mut self, _report: &IterationReport) -> bool {
        true
    }
}

/// The multipliers of a solution, as in the Lagrangian of [this module](super).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Multipliers {
    /// lambda, one a constraint: positive where the upper bound of a constraint is active, negative where the
    /// lower one is.
    pub constraints: Vec<f64>,
    /// z_lower, one a variable, not negative; 0 for a fixed variable.
    pub lower: Vec<f64>,
    /// z_upper, one a variable, not negative; 0 for a fixed variable.
    pub upper: Vec<f64>,
}

/// What Ipopt reports of one iteration, under the names of the columns of its own log.
#[derive(Debug, Clone, PartialEq)]
pub struct IterationReport {
    /// Number of the iteration; 0 is the start.
    pub iteration: usize,
    /// Whether the restoration phase is running, which looks for a feasible point and leaves the objective aside.
    pub restoration: bool,
    /// Objective at the current point.
    pub objective: f64,
    /// Largest violation of a constraint.
    pub inf_pr: f64,
    /// Largest entry of the gradient of the Lagrangian.
    pub inf_du: f64,
    /// Barrier parameter.
    pub mu: f64,
    /// Largest entry of the step.
    pub step: f64,
    /// Regularisation added to the Hessian's diagonal; 0 where none was needed.
    pub regularisation: f64,
    /// Fraction taken of the step of the bound multipliers.
    pub alpha_du: f64,
    /// Fraction taken of the step of the variables.
    pub alpha_pr: f64,
    /// Number of trial points of the line search.
    pub trials: usize,
}
