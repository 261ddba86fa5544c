//! How to solve: tolerances, limits, the source of the Hessian, and Ipopt's own options by name.
//! It contains values; handing them to Ipopt is the work of `ffi`.

use std::fmt;

/// Where the Hessian of the Lagrangian comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HessianMode {
    /// From [`Nlp::hessian_values`](super::Nlp::hessian_values).
    Given,
    /// From the gradients of the last `history` steps (BFGS).
    LimitedMemory {
        /// Number of past steps remembered.
        history: usize,
    },
}

/// The value of an Ipopt option set by name.
#[derive(Debug, Clone, PartialEq)]
pub enum OptionValue {
    /// A word, such as `adaptive`.
    Text(String),
    /// A real number.
    Number(f64),
    /// A whole number.
    Integer(i32),
}

impl fmt::Display for OptionValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            OptionValue::Text(text) => write!(f, "\"{text}\""),
            OptionValue::Number(number) => write!(f, "{number}"),
            OptionValue::Integer(integer) => write!(f, "{integer}"),
        }
    }
}

/// How to solve.
///
/// Ipopt's automatic scaling is off (`nlp_scaling_method none`): it depends on the gradient at the start, so that the same
/// tolerance would mean something else from each start. Objective, variables and constraints should be of order one.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Optimality tolerance (`tol`) on the gradient of the Lagrangian, the constraints and complementarity.
    pub tolerance: f64,
    /// Iterations after which to give up.
    pub max_iterations: usize,
    /// Processor time after which to give up, s, summed over all threads of the process.
    pub max_cpu_seconds: Option<f64>,
    /// Largest constraint violation accepted at the solution (`constr_viol_tol`), in the constraints' own units.
    pub constraint_tolerance: f64,
    /// Where the Hessian comes from.
    pub hessian: HessianMode,
    /// Whether all constraints are linear in the variables: their Jacobian is then evaluated once.
    pub linear_constraints: bool,
    /// How far Ipopt moves the bounds outwards, relative to their size (`bound_relax_factor`), so that a feasible set without
    /// interior still has one. The returned variables are put back inside their bounds; constraint values may be outside
    /// theirs by this much.
    pub bound_relaxation: f64,
    /// Whether Ipopt prints its log to standard output.
    pub print: bool,
    /// Further Ipopt options by name, set last.
    pub extra: Vec<(String, OptionValue)>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            tolerance: 1e-8,
            max_iterations: 500,
            max_cpu_seconds: None,
            constraint_tolerance: 1e-8,
            hessian: HessianMode::Given,
            linear_constraints: false,
            bound_relaxation: 1e-8,
            print: false,
            extra: Vec::new(),
        }
    }
}
