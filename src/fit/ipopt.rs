//! A safe front to the interior-point solver Ipopt: an [`Nlp`] and [`Options`] in, a [`Solution`] with its [`Status`] out.
//! It knows nothing of ships or fits, scales nothing, and is the only file of the project that contains `unsafe`.
//!
//! The problem, with n variables and m constraints:
//!
//! ```text
//! minimise f(x)   subject to   g_lower <= g(x) <= g_upper,   x_lower <= x <= x_upper
//! Lagrangian      f(x) + lambda . g(x) - z_lower . (x - x_lower) - z_upper . (x_upper - x)
//! ```
//!
//! Source: Waechter and Biegler, "On the implementation of an interior-point filter line-search algorithm for large-scale
//! nonlinear programming", Mathematical Programming 106 (2006) 25-57; the options are those of the Ipopt manual.
//!
//! What the solver underneath demands, and how it is met here:
//!
//! - A panic that unwinds into C++ aborts the process: every callback that runs the caller's code catches it, and the solve
//!   ends with [`Status::Panicked`].
//! - MUMPS, the linear solver, is not thread-safe: one lock for the whole process is held around each solve. Solves from
//!   several threads are therefore correct but take turns. Do not start them as tasks of the same rayon pool that evaluates
//!   the objective: a worker waiting inside an evaluation may pick up a second solve, and wait for itself. Where that happens
//!   on one thread it is reported as [`IpoptError::Nested`].
//! - Ipopt reads a file `ipopt.opt` in the working directory if there is one: this is switched off, so that a result depends
//!   on [`Options`] alone.
//! - Some failures leave zeros instead of the objective and the constraint values in Ipopt's answer: after a failure these are
//!   evaluated anew, and where that is impossible there is no [`Solution`] but [`IpoptError::NoIterate`].

use std::any::Any;
use std::cell::Cell;
use std::ffi::{CString, c_void};
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Mutex, PoisonError};

use ipopt_sys as sys;

/// The lock around every use of Ipopt in the process; it guards MUMPS, not data, so a poisoned lock is as good as any.
static SOLVER: Mutex<()> = Mutex::new(());

thread_local! {
    /// Whether this thread is inside [`solve`]: a second solve started from a callback would wait for the lock for ever.
    static SOLVING: Cell<bool> = const { Cell::new(false) };
}

/// What Ipopt is told in place of an infinite bound; it takes anything beyond 1e19 for "none".
const NO_BOUND: f64 = 2e19;

/// Number of past steps the limited-memory Hessian keeps unless told otherwise. Ipopt's own 6 suits thousands of variables;
/// with a few dozen, a longer memory costs nothing and saves most of the iterations.
pub const DEFAULT_HISTORY: usize = 50;

/// A nonlinear program: objective, constraints and their derivatives.
///
/// Evaluations take `&mut self` so that an implementation can keep what the objective and the gradient share. They return
/// `None` or `false` where the point cannot be evaluated; a value that is not finite counts as such a refusal. Ipopt answers a
/// refusal of the objective or of the constraint values with a shorter step. It has no such answer for the derivatives: there
/// a refusal ends the solve with [`Status::InvalidNumber`], so refuse a point in [`Nlp::objective`] already.
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
    /// solve then uses [`HessianMode::LimitedMemory`] whatever the options say.
    fn hessian_structure(&self) -> Vec<(usize, usize)>;

    /// Writes `objective_factor` d2f/dx2 + sum of `multipliers[i]` d2g_i/dx2, in the order of [`Nlp::hessian_structure`];
    /// false where it cannot be evaluated. A positive semidefinite approximation (Gauss-Newton) serves as well.
    fn hessian_values(&mut self, x: &[f64], objective_factor: f64, multipliers: &[f64], values: &mut [f64]) -> bool;

    /// Called once per iteration; false stops the solve with [`Status::Stopped`].
    fn iteration(&mut self, _report: &IterationReport) -> bool {
        true
    }
}

/// What Ipopt tells of one iteration, under the names of the columns of its own log.
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

/// Where the Hessian of the Lagrangian comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HessianMode {
    /// From [`Nlp::hessian_values`].
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

/// How often each function was evaluated, refusals included.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counts {
    /// Evaluations of the objective.
    pub objective: usize,
    /// Evaluations of its gradient.
    pub gradient: usize,
    /// Evaluations of the constraint values.
    pub constraints: usize,
    /// Evaluations of the constraints' Jacobian.
    pub jacobian: usize,
    /// Evaluations of the Hessian of the Lagrangian.
    pub hessian: usize,
}

/// The point a solve ended at, and how it ended. It is an optimum only if [`Status::is_success`].
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// The variables.
    pub x: Vec<f64>,
    /// The objective at `x`.
    pub objective: f64,
    /// The constraint values at `x`.
    pub constraint_values: Vec<f64>,
    /// lambda of the Lagrangian above (like the other multipliers 0 after a failure that left none): positive where the upper bound of a constraint holds the objective back, negative
    /// where the lower one does.
    pub constraint_multipliers: Vec<f64>,
    /// z_lower of the Lagrangian above, not negative; 0 for a fixed variable.
    pub lower_bound_multipliers: Vec<f64>,
    /// z_upper of the Lagrangian above, not negative; 0 for a fixed variable.
    pub upper_bound_multipliers: Vec<f64>,
    /// How the solve ended.
    pub status: Status,
    /// Iterations taken.
    pub iterations: usize,
    /// Evaluations taken.
    pub counts: Counts,
}

/// How a solve ended. Its text says in words what happened and what to do next.
#[derive(Debug, Clone, PartialEq)]
pub enum Status {
    /// An optimum to the tolerance asked for.
    Solved,
    /// An optimum, but only to Ipopt's looser `acceptable_tol`.
    SolvedToAcceptable,
    /// The constraints contradict each other, as far as can be seen from where the solve ended.
    Infeasible,
    /// The steps became too small to change the variables.
    TinyStep,
    /// The variables run to infinity.
    Diverging,
    /// [`Nlp::iteration`] returned false.
    Stopped,
    /// A feasible point of a problem with as many equalities as variables, where there is nothing to optimise.
    FeasiblePointFound,
    /// The iteration limit was reached.
    MaxIterations {
        /// The iterations taken, which is the limit.
        iterations: usize,
    },
    /// The restoration phase found neither a feasible point nor proof that there is none.
    RestorationFailed,
    /// The linear system for the step could not be solved.
    StepComputationFailed,
    /// The limit on processor time was reached.
    MaxCpuTime,
    /// There are fewer free variables than equality constraints.
    NotEnoughDegreesOfFreedom,
    /// Ipopt finds the problem itself inconsistent.
    InvalidProblem,
    /// Ipopt cannot do what an option asks for.
    InvalidOption,
    /// A derivative, or the start, could not be evaluated.
    InvalidNumber,
    /// Ipopt gave up on an internal exception.
    UnrecoverableException,
    /// An exception that is not Ipopt's own was thrown inside it.
    NonIpoptException,
    /// Memory ran out.
    InsufficientMemory,
    /// Ipopt reports an error of its own making.
    InternalError,
    /// A method of the [`Nlp`] panicked; the text names the method and carries the panic's message.
    Panicked(String),
}

impl Status {
    /// Whether the solution can be used.
    pub fn is_success(&self) -> bool {
        matches!(self, Status::Solved | Status::SolvedToAcceptable | Status::FeasiblePointFound)
    }

    fn from_code(code: sys::CNLP_ApplicationReturnStatus, iterations: usize) -> Self {
        match code {
            sys::CNLP_ApplicationReturnStatus_CNLP_SOLVE_SUCCEEDED => Status::Solved,
            sys::CNLP_ApplicationReturnStatus_CNLP_SOLVED_TO_ACCEPTABLE_LEVEL => Status::SolvedToAcceptable,
            sys::CNLP_ApplicationReturnStatus_CNLP_INFEASIBLE_PROBLEM_DETECTED => Status::Infeasible,
            sys::CNLP_ApplicationReturnStatus_CNLP_SEARCH_DIRECTION_BECOMES_TOO_SMALL => Status::TinyStep,
            sys::CNLP_ApplicationReturnStatus_CNLP_DIVERGING_ITERATES => Status::Diverging,
            sys::CNLP_ApplicationReturnStatus_CNLP_USER_REQUESTED_STOP => Status::Stopped,
            sys::CNLP_ApplicationReturnStatus_CNLP_FEASIBLE_POINT_FOUND => Status::FeasiblePointFound,
            sys::CNLP_ApplicationReturnStatus_CNLP_MAXIMUM_ITERATIONS_EXCEEDED => Status::MaxIterations { iterations },
            sys::CNLP_ApplicationReturnStatus_CNLP_RESTORATION_FAILED => Status::RestorationFailed,
            sys::CNLP_ApplicationReturnStatus_CNLP_ERROR_IN_STEP_COMPUTATION => Status::StepComputationFailed,
            sys::CNLP_ApplicationReturnStatus_CNLP_MAXIMUM_CPUTIME_EXCEEDED => Status::MaxCpuTime,
            sys::CNLP_ApplicationReturnStatus_CNLP_NOT_ENOUGH_DEGREES_OF_FREEDOM => Status::NotEnoughDegreesOfFreedom,
            sys::CNLP_ApplicationReturnStatus_CNLP_INVALID_PROBLEM_DEFINITION => Status::InvalidProblem,
            sys::CNLP_ApplicationReturnStatus_CNLP_INVALID_OPTION => Status::InvalidOption,
            sys::CNLP_ApplicationReturnStatus_CNLP_INVALID_NUMBER_DETECTED => Status::InvalidNumber,
            sys::CNLP_ApplicationReturnStatus_CNLP_UNRECOVERABLE_EXCEPTION => Status::UnrecoverableException,
            sys::CNLP_ApplicationReturnStatus_CNLP_NONIPOPT_EXCEPTION_THROWN => Status::NonIpoptException,
            sys::CNLP_ApplicationReturnStatus_CNLP_INSUFFICIENT_MEMORY => Status::InsufficientMemory,
            _ => Status::InternalError,
        }
    }
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Status::Solved => write!(f, "solved"),
            Status::SolvedToAcceptable => write!(
                f,
                "solved, but only to the acceptable tolerance: the last digits are uncertain; check the derivatives and \
                 the scaling if they matter"
            ),
            Status::Infeasible => write!(
                f,
                "no point near the last one satisfies the constraints: relax the constraints with the largest violation, or \
                 start elsewhere"
            ),
            Status::TinyStep => write!(
                f,
                "the steps became too small to change the variables: the point may be as good as rounding allows; \
                 otherwise check the derivatives and the scaling, or loosen the tolerance"
            ),
            Status::Diverging => write!(
                f,
                "the variables run to infinity: bound them, or add a prior to those the data do not determine"
            ),
            Status::Stopped => write!(f, "stopped by the caller before it converged"),
            Status::FeasiblePointFound => write!(f, "the constraints leave exactly one point, and it was found"),
            Status::MaxIterations { iterations } => write!(
                f,
                "did not converge in {iterations} iterations: raise max_iterations, or start closer, give the Hessian, or check \
                 the scaling"
            ),
            Status::RestorationFailed => write!(
                f,
                "could not get back to a point that satisfies the constraints: start from a feasible point, or check the \
                 constraints' derivatives"
            ),
            Status::StepComputationFailed => write!(
                f,
                "no step could be computed from the derivatives: check them and the scaling, and look for variables that \
                 nothing determines"
            ),
            Status::MaxCpuTime => write!(
                f,
                "did not converge within the processor time allowed: raise max_cpu_seconds, or shorten the problem"
            ),
            Status::NotEnoughDegreesOfFreedom => write!(
                f,
                "fewer free variables than equality constraints: free some variables, or drop equalities that follow from \
                 others"
            ),
            Status::InvalidProblem => {
                write!(f, "Ipopt finds the problem inconsistent: check its sizes, bounds and structures")
            }
            Status::InvalidOption => write!(
                f,
                "Ipopt cannot do what an option asks for: remove the extra options one by one; a linear solver may not be \
                 installed"
            ),
            Status::InvalidNumber => write!(
                f,
                "the start or a derivative could not be evaluated: start where the problem can be evaluated, and refuse \
                 points without derivatives in the objective already"
            ),
            Status::UnrecoverableException => {
                write!(f, "Ipopt gave up on an internal exception: solve with print on to see which")
            }
            Status::NonIpoptException => {
                write!(f, "an exception was thrown inside Ipopt: check its installation and that of its linear solver")
            }
            Status::InsufficientMemory => write!(f, "memory ran out: fit fewer or shorter recordings at a time"),
            Status::InternalError => write!(f, "Ipopt reports an internal error: check its installation"),
            Status::Panicked(message) => {
                write!(f, "{message}: this is a defect of the problem's code; please report it")
            }
        }
    }
}

/// Why there is no [`Solution`]: the problem or the options make no sense, or the solve ended before its first point.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum IpoptError {
    /// The problem has no variables.
    #[error("there is nothing to solve for: the problem has 0 variables; free at least one")]
    NoVariables,
    /// The problem has more entries than Ipopt's 32-bit indices can count.
    #[error("the problem has {count} {what}, more than the {} Ipopt can count; make it smaller", i32::MAX)]
    TooLarge {
        /// What there are too many of.
        what: &'static str,
        /// How many there are.
        count: usize,
    },
    /// A pair of bounds leaves no value, or one of them is not a number.
    #[error(
        "{what} {index} has lower bound {lower} and upper bound {upper}, which leave no value; correct or swap them"
    )]
    Bounds {
        /// `variable` or `constraint`.
        what: &'static str,
        /// Its index, from 0.
        index: usize,
        /// Its lower bound.
        lower: f64,
        /// Its upper bound.
        upper: f64,
    },
    /// The start is not finite.
    #[error("variable {index} starts at {value}; give a finite start")]
    Start {
        /// The variable's index, from 0.
        index: usize,
        /// Its start.
        value: f64,
    },
    /// A structure names an entry that does not exist.
    #[error(
        "entry {entry} of the {matrix} structure is ({row}, {column}), outside its {rows} rows and {columns} columns or, in the \
         Hessian, above the diagonal; correct the structure"
    )]
    Structure {
        /// `Jacobian` or `Hessian`.
        matrix: &'static str,
        /// Position in the structure.
        entry: usize,
        /// Row named there.
        row: usize,
        /// Column named there.
        column: usize,
        /// Rows of the matrix.
        rows: usize,
        /// Columns of the matrix.
        columns: usize,
    },
    /// Ipopt knows no such option, or refuses its value.
    #[error("Ipopt refuses option {name} = {value}; check its name, type and range in the Ipopt manual")]
    Option {
        /// Name of the option.
        name: String,
        /// The value refused.
        value: OptionValue,
    },
    /// Ipopt could not be set up.
    #[error("Ipopt could not be set up (code {code}); check its installation")]
    Create {
        /// The code it returned.
        code: u32,
    },
    /// A solve was started from inside a callback of another.
    #[error("a solve was started from inside another one on the same thread; run them one after the other")]
    Nested,
    /// The solve ended at no point at which objective and constraints could be evaluated.
    #[error("no usable point was reached: {status}")]
    NoIterate {
        /// How the solve ended.
        status: Status,
    },
}

/// Minimises the objective of `nlp` within its bounds and constraints.
///
/// A solve that does not converge is a result: its [`Solution`] says so in `status`. Waits while another thread is solving.
///
/// # Errors
///
/// An [`IpoptError`] if the problem has no variables, contradictory bounds, a start that is not finite or an impossible
/// structure, if Ipopt refuses an option, if called from a callback of another solve, or if the solve ended before there was
/// a point to report.
pub fn solve(nlp: &mut dyn Nlp, options: &Options) -> Result<Solution, IpoptError> {
    let _mark = SolvingMark::set()?;
    let problem = Problem::of(nlp, options)?;
    let mut context =
        Context { nlp, problem, placeholder: true, counts: Counts::default(), iterations: 0, panic: None };

    let outcome = {
        let _lock = SOLVER.lock().unwrap_or_else(PoisonError::into_inner);
        run(&mut context, options)?
    };
    context.settle(outcome)
}

/// Marks this thread as solving for as long as it lives.
struct SolvingMark;

impl SolvingMark {
    fn set() -> Result<Self, IpoptError> {
        if SOLVING.replace(true) { Err(IpoptError::Nested) } else { Ok(Self) }
    }
}

impl Drop for SolvingMark {
    fn drop(&mut self) {
        SOLVING.set(false);
    }
}

/// The part of an [`Nlp`] that stays fixed during a solve, checked.
struct Problem {
    variable_lower: Vec<f64>,
    variable_upper: Vec<f64>,
    constraint_lower: Vec<f64>,
    constraint_upper: Vec<f64>,
    start: Vec<f64>,
    jacobian: Vec<(i32, i32)>,
    /// Empty with a limited-memory Hessian.
    hessian: Vec<(i32, i32)>,
    hessian_mode: HessianMode,
}

impl Problem {
    fn of(nlp: &dyn Nlp, options: &Options) -> Result<Self, IpoptError> {
        let (n, m) = (nlp.variables(), nlp.constraints());
        if n == 0 {
            return Err(IpoptError::NoVariables);
        }
        countable("variables", n)?;
        countable("constraints", m)?;

        let (mut variable_lower, mut variable_upper) = (vec![f64::NEG_INFINITY; n], vec![f64::INFINITY; n]);
        nlp.variable_bounds(&mut variable_lower, &mut variable_upper);
        check_bounds("variable", &mut variable_lower, &mut variable_upper)?;
        let (mut constraint_lower, mut constraint_upper) = (vec![f64::NEG_INFINITY; m], vec![f64::INFINITY; m]);
        nlp.constraint_bounds(&mut constraint_lower, &mut constraint_upper);
        check_bounds("constraint", &mut constraint_lower, &mut constraint_upper)?;

        let mut start = vec![0.0; n];
        nlp.start(&mut start);
        if let Some((index, &value)) = start.iter().enumerate().find(|(_, value)| !value.is_finite()) {
            return Err(IpoptError::Start { index, value });
        }

        let jacobian = check_structure("Jacobian", &nlp.jacobian_structure(), m, n)?;
        let (hessian, hessian_mode) = match options.hessian {
            HessianMode::Given => match check_structure("Hessian", &nlp.hessian_structure(), n, n)? {
                empty if empty.is_empty() => (empty, HessianMode::LimitedMemory { history: DEFAULT_HISTORY }),
                structure => (structure, HessianMode::Given),
            },
            mode @ HessianMode::LimitedMemory { .. } => (Vec::new(), mode),
        };
        Ok(Self {
            variable_lower,
            variable_upper,
            constraint_lower,
            constraint_upper,
            start,
            jacobian,
            hessian,
            hessian_mode,
        })
    }

    fn variables(&self) -> usize {
        self.variable_lower.len()
    }

    fn constraints(&self) -> usize {
        self.constraint_lower.len()
    }
}

fn countable(what: &'static str, count: usize) -> Result<i32, IpoptError> {
    i32::try_from(count).map_err(|_| IpoptError::TooLarge { what, count })
}

/// Refuses bounds that leave no finite value, and turns infinite ones into what Ipopt takes for none.
fn check_bounds(what: &'static str, lower: &mut [f64], upper: &mut [f64]) -> Result<(), IpoptError> {
    for (index, (lower, upper)) in lower.iter_mut().zip(upper.iter_mut()).enumerate() {
        // Negated, so that a NaN is refused too; and a lower bound of +infinity leaves nothing even below an upper one.
        let sensible = *lower <= *upper && *lower < f64::INFINITY && *upper > f64::NEG_INFINITY;
        if !sensible {
            return Err(IpoptError::Bounds { what, index, lower: *lower, upper: *upper });
        }
        *lower = lower.max(-NO_BOUND);
        *upper = upper.min(NO_BOUND);
    }
    Ok(())
}

fn check_structure(
    matrix: &'static str,
    structure: &[(usize, usize)],
    rows: usize,
    columns: usize,
) -> Result<Vec<(i32, i32)>, IpoptError> {
    let what = if matrix == "Hessian" { "Hessian entries" } else { "Jacobian entries" };
    countable(what, structure.len())?;
    let checked = structure.iter().enumerate().map(|(entry, &(row, column))| {
        if row >= rows || column >= columns || (matrix == "Hessian" && column > row) {
            return Err(IpoptError::Structure { matrix, entry, row, column, rows, columns });
        }
        Ok((countable("rows", row)?, countable("columns", column)?))
    });
    checked.collect()
}

/// What the callbacks work on.
struct Context<'a> {
    nlp: &'a mut dyn Nlp,
    problem: Problem,
    /// Whether the start is asked for only to fill the shim's result arrays, before the solve: they get NaN, so that an
    /// answer Ipopt never wrote is told from one it did.
    placeholder: bool,
    counts: Counts,
    iterations: usize,
    /// The first panic caught. From then on every callback refuses without running the caller's code.
    panic: Option<String>,
}

/// What Ipopt leaves behind.
struct Outcome {
    status: Status,
    x: Vec<f64>,
    objective: f64,
    constraint_values: Vec<f64>,
    constraint_multipliers: Vec<f64>,
    lower_bound_multipliers: Vec<f64>,
    upper_bound_multipliers: Vec<f64>,
}

impl Context<'_> {
    fn objective(&mut self, x: &[f64]) -> Option<f64> {
        self.counts.objective += 1;
        self.nlp.objective(x).filter(|value| value.is_finite())
    }

    fn gradient(&mut self, x: &[f64], gradient: &mut [f64]) -> bool {
        self.counts.gradient += 1;
        self.nlp.gradient(x, gradient) && all_finite(gradient)
    }

    fn constraint_values(&mut self, x: &[f64], values: &mut [f64]) -> bool {
        self.counts.constraints += 1;
        self.nlp.constraint_values(x, values) && all_finite(values)
    }

    fn jacobian_values(&mut self, x: &[f64], values: &mut [f64]) -> bool {
        self.counts.jacobian += 1;
        self.nlp.jacobian_values(x, values) && all_finite(values)
    }

    fn hessian_values(&mut self, x: &[f64], factor: f64, multipliers: &[f64], values: &mut [f64]) -> bool {
        self.counts.hessian += 1;
        self.nlp.hessian_values(x, factor, multipliers, values) && all_finite(values)
    }

    /// Turns what Ipopt left into a solution whose every number was computed.
    fn settle(mut self, outcome: Outcome) -> Result<Solution, IpoptError> {
        let Outcome { status, x, mut objective, mut constraint_values, .. } = outcome;
        if !all_finite(&x) {
            return Err(IpoptError::NoIterate { status });
        }
        if !status.is_success() {
            // After a panic this runs the caller's code once more; if it panics again there is nothing to report.
            let evaluated = catch_unwind(AssertUnwindSafe(|| {
                let value = self.objective(&x)?;
                let feasible = constraint_values.is_empty() || self.constraint_values(&x, &mut constraint_values);
                feasible.then_some(value)
            }));
            match evaluated {
                Ok(Some(value)) => objective = value,
                Ok(None) | Err(_) => return Err(IpoptError::NoIterate { status }),
            }
        }
        Ok(Solution {
            x,
            objective,
            constraint_values,
            constraint_multipliers: outcome.constraint_multipliers,
            lower_bound_multipliers: outcome.lower_bound_multipliers,
            upper_bound_multipliers: outcome.upper_bound_multipliers,
            status,
            iterations: self.iterations,
            counts: self.counts,
        })
    }
}

fn all_finite(values: &[f64]) -> bool {
    values.iter().all(|value| value.is_finite())
}

/// A problem of the C shim, freed when dropped.
struct Handle(sys::CNLP_ProblemPtr);

impl Drop for Handle {
    fn drop(&mut self) {
        // SAFETY: the pointer came from `cnlp_create_problem`, is freed only here, and no result that points into it outlives
        // `run`, which copies them.
        unsafe { sys::cnlp_free_problem(self.0) }
    }
}

impl Handle {
    fn create() -> Result<Self, IpoptError> {
        let mut pointer: sys::CNLP_ProblemPtr = std::ptr::null_mut();
        let index_from_zero = 0;
        // SAFETY: `pointer` outlives the call; every callback but the optional scaling is given, as the shim demands, and each
        // has the signature its slot declares. None is called before `cnlp_init_solution` and `cnlp_solve`.
        let code = unsafe {
            sys::cnlp_create_problem(
                &raw mut pointer,
                index_from_zero,
                Some(sizes),
                Some(start),
                Some(bounds),
                Some(objective),
                Some(constraint_values),
                Some(gradient),
                Some(jacobian),
                Some(hessian),
                None,
            )
        };
        if code != sys::CNLP_CreateProblemStatus_CNLP_SUCCESS || pointer.is_null() {
            return Err(IpoptError::Create { code });
        }
        let handle = Self(pointer);
        // SAFETY: the problem was just created, and the callback has the signature its slot declares.
        unsafe { sys::cnlp_set_intermediate_callback(handle.0, Some(iteration)) };
        Ok(handle)
    }

    fn set(&self, name: &str, value: &OptionValue) -> Result<(), IpoptError> {
        let refused = || IpoptError::Option { name: name.to_owned(), value: value.clone() };
        let keyword = CString::new(name).map_err(|_| refused())?;
        let accepted = match value {
            OptionValue::Text(text) => {
                let text = CString::new(text.as_str()).map_err(|_| refused())?;
                // SAFETY: the problem is alive, both strings end in NUL and outlive the call, which copies them.
                unsafe { sys::cnlp_add_str_option(self.0, keyword.as_ptr(), text.as_ptr()) }
            }
            // SAFETY: as above.
            OptionValue::Number(number) => unsafe { sys::cnlp_add_num_option(self.0, keyword.as_ptr(), *number) },
            // SAFETY: as above.
            OptionValue::Integer(integer) => unsafe { sys::cnlp_add_int_option(self.0, keyword.as_ptr(), *integer) },
        };
        if accepted == 0 { Err(refused()) } else { Ok(()) }
    }

    fn set_all(&self, options: &Options, hessian: HessianMode) -> Result<(), IpoptError> {
        let text = |text: &str| OptionValue::Text(text.to_owned());
        let number = OptionValue::Number;
        let integer = |count: usize| OptionValue::Integer(i32::try_from(count).unwrap_or(i32::MAX));

        self.set("option_file_name", &text(""))?;
        self.set("sb", &text("yes"))?;
        self.set("print_level", &integer(if options.print { 5 } else { 0 }))?;
        self.set("nlp_scaling_method", &text("none"))?;
        self.set("tol", &number(options.tolerance))?;
        self.set("constr_viol_tol", &number(options.constraint_tolerance))?;
        self.set("bound_relax_factor", &number(options.bound_relaxation))?;
        self.set("max_iter", &integer(options.max_iterations))?;
        if let Some(seconds) = options.max_cpu_seconds {
            self.set("max_cpu_time", &number(seconds))?;
        }
        if let HessianMode::LimitedMemory { history } = hessian {
            self.set("hessian_approximation", &text("limited-memory"))?;
            self.set("limited_memory_max_history", &integer(history))?;
        }
        if options.linear_constraints {
            self.set("jac_c_constant", &text("yes"))?;
            self.set("jac_d_constant", &text("yes"))?;
        }
        for (name, value) in &options.extra {
            self.set(name, value)?;
        }
        Ok(())
    }
}

/// Solves; the caller holds the lock.
fn run(context: &mut Context<'_>, options: &Options) -> Result<Outcome, IpoptError> {
    let (n, m) = (context.problem.variables(), context.problem.constraints());
    let handle = Handle::create()?;
    handle.set_all(options, context.problem.hessian_mode)?;

    let user_data = (&raw mut *context).cast::<c_void>();
    // SAFETY: the problem is alive; `user_data` points to the context, which outlives the call and which nothing but the
    // callbacks touches until the solve is over. The call sizes the result arrays, so that they exist however the solve ends.
    unsafe { sys::cnlp_init_solution(handle.0, user_data) };
    // SAFETY: as above, and the pointer's target is written between two calls into C, while no callback runs.
    unsafe { (*user_data.cast::<Context<'_>>()).placeholder = false };
    // SAFETY: as for `cnlp_init_solution`.
    let result = unsafe { sys::cnlp_solve(handle.0, user_data) };

    // SAFETY: the shim's result arrays have n (x and its multipliers) and m (constraints and theirs) entries, written by
    // `cnlp_init_solution` or the solve, and live until the problem is freed, at the end of this function; they are copied here.
    let outcome = unsafe {
        Outcome {
            status: Status::from_code(result.status, context.iterations),
            x: view(result.data.x, n).to_vec(),
            objective: result.obj_val,
            constraint_values: view(result.g, m).to_vec(),
            constraint_multipliers: view(result.data.mult_g, m).to_vec(),
            lower_bound_multipliers: view(result.data.mult_x_L, n).to_vec(),
            upper_bound_multipliers: view(result.data.mult_x_U, n).to_vec(),
        }
    };
    match &context.panic {
        Some(message) => Ok(Outcome { status: Status::Panicked(message.clone()), ..outcome }),
        None => Ok(outcome),
    }
}

/// The array behind a pointer from C; empty for a null pointer, which C passes for an array without entries.
///
/// # Safety
///
/// A pointer that is not null must point to `length` initialised values that stay alive and unchanged for `'a`.
unsafe fn view<'a, T>(pointer: *const T, length: usize) -> &'a [T] {
    if pointer.is_null() || length == 0 {
        return &[];
    }
    // SAFETY: the caller's promise, for a pointer that is not null.
    unsafe { std::slice::from_raw_parts(pointer, length) }
}

/// As [`view`], to write to.
///
/// # Safety
///
/// As for [`view`], and nothing else may read or write the array for `'a`.
unsafe fn view_mut<'a, T>(pointer: *mut T, length: usize) -> &'a mut [T] {
    if pointer.is_null() || length == 0 {
        return &mut [];
    }
    // SAFETY: the caller's promise, for a pointer that is not null.
    unsafe { std::slice::from_raw_parts_mut(pointer, length) }
}

/// Runs the body of a callback on the context behind `user_data`: false if it says so, if it panics, or if an earlier one did.
///
/// # Safety
///
/// `user_data` must be the pointer `run` gave to the shim, and no other reference to the context may be in use.
unsafe fn guarded(
    user_data: sys::CNLP_UserDataPtr,
    method: &str,
    body: impl FnOnce(&mut Context<'_>) -> bool,
) -> sys::CNLP_Bool {
    // SAFETY: the caller's promise; the context outlives the solve, and callbacks do not nest.
    let context = unsafe { &mut *user_data.cast::<Context<'_>>() };
    if context.panic.is_some() {
        return 0;
    }
    match catch_unwind(AssertUnwindSafe(|| body(context))) {
        Ok(accepted) => sys::CNLP_Bool::from(accepted),
        Err(payload) => {
            context.panic = Some(format!("{method} panicked: {}", panic_message(payload.as_ref())));
            0
        }
    }
}

fn panic_message(payload: &(dyn Any + Send)) -> &str {
    if let Some(message) = payload.downcast_ref::<&str>() {
        message
    } else if let Some(message) = payload.downcast_ref::<String>() {
        message
    } else {
        "(without a message)"
    }
}

// The callbacks. Ipopt calls them one at a time, from the thread that solves, with arrays of the sizes `sizes` gave it: n
// variables, m constraints, and as many entries as the structures have. The length of every slice is therefore taken from the
// context, and the promise of `guarded` holds because `run` lends the context to nobody else during a solve.

unsafe extern "C" fn sizes(
    n: *mut sys::CNLP_Index,
    m: *mut sys::CNLP_Index,
    jacobian_entries: *mut sys::CNLP_Index,
    hessian_entries: *mut sys::CNLP_Index,
    user_data: sys::CNLP_UserDataPtr,
) -> sys::CNLP_Bool {
    // SAFETY: see above the callbacks; the four pointers are to variables of the C++ caller.
    unsafe {
        guarded(user_data, "the problem's sizes", |context| {
            let problem = &context.problem;
            // `Problem::of` made sure that they fit.
            *n = problem.variables() as sys::CNLP_Index;
            *m = problem.constraints() as sys::CNLP_Index;
            *jacobian_entries = problem.jacobian.len() as sys::CNLP_Index;
            *hessian_entries = problem.hessian.len() as sys::CNLP_Index;
            true
        })
    }
}

unsafe extern "C" fn bounds(
    _n: sys::CNLP_Index,
    x_lower: *mut sys::CNLP_Number,
    x_upper: *mut sys::CNLP_Number,
    _m: sys::CNLP_Index,
    g_lower: *mut sys::CNLP_Number,
    g_upper: *mut sys::CNLP_Number,
    user_data: sys::CNLP_UserDataPtr,
) -> sys::CNLP_Bool {
    // SAFETY: see above the callbacks; the four arrays are distinct.
    unsafe {
        guarded(user_data, "the problem's bounds", |context| {
            let problem = &context.problem;
            view_mut(x_lower, problem.variables()).copy_from_slice(&problem.variable_lower);
            view_mut(x_upper, problem.variables()).copy_from_slice(&problem.variable_upper);
            view_mut(g_lower, problem.constraints()).copy_from_slice(&problem.constraint_lower);
            view_mut(g_upper, problem.constraints()).copy_from_slice(&problem.constraint_upper);
            true
        })
    }
}

unsafe extern "C" fn start(
    _n: sys::CNLP_Index,
    wants_x: sys::CNLP_Bool,
    x: *mut sys::CNLP_Number,
    wants_bound_multipliers: sys::CNLP_Bool,
    z_lower: *mut sys::CNLP_Number,
    z_upper: *mut sys::CNLP_Number,
    _m: sys::CNLP_Index,
    wants_multipliers: sys::CNLP_Bool,
    lambda: *mut sys::CNLP_Number,
    user_data: sys::CNLP_UserDataPtr,
) -> sys::CNLP_Bool {
    // SAFETY: see above the callbacks; the four arrays are distinct and written only where C++ asks for them.
    unsafe {
        guarded(user_data, "the problem's start", |context| {
            let (n, m) = (context.problem.variables(), context.problem.constraints());
            if wants_x != 0 {
                let x = view_mut(x, n);
                if context.placeholder { x.fill(f64::NAN) } else { x.copy_from_slice(&context.problem.start) }
            }
            // Wanted for the placeholder, and where an extra option asks for a warm start: Ipopt's own defaults serve.
            if wants_bound_multipliers != 0 {
                let multiplier = if context.placeholder { 0.0 } else { 1.0 };
                view_mut(z_lower, n).fill(multiplier);
                view_mut(z_upper, n).fill(multiplier);
            }
            if wants_multipliers != 0 {
                view_mut(lambda, m).fill(0.0);
            }
            true
        })
    }
}

unsafe extern "C" fn objective(
    _n: sys::CNLP_Index,
    x: *const sys::CNLP_Number,
    _new_x: sys::CNLP_Bool,
    value: *mut sys::CNLP_Number,
    user_data: sys::CNLP_UserDataPtr,
) -> sys::CNLP_Bool {
    // SAFETY: see above the callbacks; `value` is a variable of the C++ caller.
    unsafe {
        guarded(user_data, "Nlp::objective", |context| {
            let x = view(x, context.problem.variables());
            match context.objective(x) {
                Some(objective) => {
                    *value = objective;
                    true
                }
                None => false,
            }
        })
    }
}

unsafe extern "C" fn gradient(
    _n: sys::CNLP_Index,
    x: *const sys::CNLP_Number,
    _new_x: sys::CNLP_Bool,
    values: *mut sys::CNLP_Number,
    user_data: sys::CNLP_UserDataPtr,
) -> sys::CNLP_Bool {
    // SAFETY: see above the callbacks.
    unsafe {
        guarded(user_data, "Nlp::gradient", |context| {
            let n = context.problem.variables();
            context.gradient(view(x, n), view_mut(values, n))
        })
    }
}

unsafe extern "C" fn constraint_values(
    _n: sys::CNLP_Index,
    x: *const sys::CNLP_Number,
    _new_x: sys::CNLP_Bool,
    _m: sys::CNLP_Index,
    values: *mut sys::CNLP_Number,
    user_data: sys::CNLP_UserDataPtr,
) -> sys::CNLP_Bool {
    // SAFETY: see above the callbacks.
    unsafe {
        guarded(user_data, "Nlp::constraint_values", |context| {
            let (n, m) = (context.problem.variables(), context.problem.constraints());
            m == 0 || context.constraint_values(view(x, n), view_mut(values, m))
        })
    }
}

unsafe extern "C" fn jacobian(
    _n: sys::CNLP_Index,
    x: *const sys::CNLP_Number,
    _new_x: sys::CNLP_Bool,
    _m: sys::CNLP_Index,
    _entries: sys::CNLP_Index,
    rows: *mut sys::CNLP_Index,
    columns: *mut sys::CNLP_Index,
    values: *mut sys::CNLP_Number,
    user_data: sys::CNLP_UserDataPtr,
) -> sys::CNLP_Bool {
    // SAFETY: see above the callbacks; C++ passes either `rows` and `columns` or `x` and `values`, the others null.
    unsafe {
        guarded(user_data, "Nlp::jacobian_values", |context| {
            let (n, entries) = (context.problem.variables(), context.problem.jacobian.len());
            if values.is_null() {
                write_structure(&context.problem.jacobian, view_mut(rows, entries), view_mut(columns, entries));
                return true;
            }
            entries == 0 || context.jacobian_values(view(x, n), view_mut(values, entries))
        })
    }
}

unsafe extern "C" fn hessian(
    _n: sys::CNLP_Index,
    x: *const sys::CNLP_Number,
    _new_x: sys::CNLP_Bool,
    objective_factor: sys::CNLP_Number,
    _m: sys::CNLP_Index,
    lambda: *const sys::CNLP_Number,
    _new_lambda: sys::CNLP_Bool,
    _entries: sys::CNLP_Index,
    rows: *mut sys::CNLP_Index,
    columns: *mut sys::CNLP_Index,
    values: *mut sys::CNLP_Number,
    user_data: sys::CNLP_UserDataPtr,
) -> sys::CNLP_Bool {
    // SAFETY: see above the callbacks; C++ passes either `rows` and `columns` or `x`, `lambda` and `values`, the others null.
    unsafe {
        guarded(user_data, "Nlp::hessian_values", |context| {
            let (n, m) = (context.problem.variables(), context.problem.constraints());
            let entries = context.problem.hessian.len();
            if values.is_null() {
                write_structure(&context.problem.hessian, view_mut(rows, entries), view_mut(columns, entries));
                return true;
            }
            let (x, lambda) = (view(x, n), view(lambda, m));
            entries == 0 || context.hessian_values(x, objective_factor, lambda, view_mut(values, entries))
        })
    }
}

fn write_structure(structure: &[(i32, i32)], rows: &mut [i32], columns: &mut [i32]) {
    for ((row, column), entry) in rows.iter_mut().zip(columns).zip(structure) {
        (*row, *column) = *entry;
    }
}

unsafe extern "C" fn iteration(
    mode: sys::CNLP_AlgorithmMode,
    iteration: sys::CNLP_Index,
    objective: sys::CNLP_Number,
    inf_pr: sys::CNLP_Number,
    inf_du: sys::CNLP_Number,
    mu: sys::CNLP_Number,
    step: sys::CNLP_Number,
    regularisation: sys::CNLP_Number,
    alpha_du: sys::CNLP_Number,
    alpha_pr: sys::CNLP_Number,
    trials: sys::CNLP_Index,
    user_data: sys::CNLP_UserDataPtr,
) -> sys::CNLP_Bool {
    // SAFETY: see above the callbacks.
    unsafe {
        guarded(user_data, "Nlp::iteration", |context| {
            let report = IterationReport {
                iteration: usize::try_from(iteration).unwrap_or(0),
                restoration: mode == sys::CNLP_AlgorithmMode_CNLP_RESTORATION_PHASE_MODE,
                objective,
                inf_pr,
                inf_du,
                mu,
                step,
                regularisation,
                alpha_du,
                alpha_pr,
                trials: usize::try_from(trials).unwrap_or(0),
            };
            context.iterations = report.iteration;
            context.nlp.iteration(&report)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const INF: f64 = f64::INFINITY;

    /// Problem 71 of Hock and Schittkowski: x0 x3 (x0 + x1 + x2) + x2 least, with the product of the four at least 25, the sum
    /// of their squares 40, and each between 1 and 5. The hooks make it misbehave.
    struct Hs071 {
        panic_in: Option<&'static str>,
        stop_at: usize,
        objective_calls: usize,
        panic_from_call: usize,
        hessian: bool,
        nest: bool,
        nested: Option<IpoptError>,
        reports: Vec<IterationReport>,
    }

    impl Hs071 {
        fn new() -> Self {
            Self {
                panic_in: None,
                stop_at: usize::MAX,
                objective_calls: 0,
                panic_from_call: 1,
                hessian: true,
                nest: false,
                nested: None,
                reports: Vec::new(),
            }
        }

        fn maybe_panic(&self, method: &str) {
            assert!(
                self.panic_in != Some(method) || self.objective_calls < self.panic_from_call,
                "the hull {method} came off"
            );
        }
    }

    impl Nlp for Hs071 {
        fn variables(&self) -> usize {
            4
        }
        fn constraints(&self) -> usize {
            2
        }
        fn variable_bounds(&self, lower: &mut [f64], upper: &mut [f64]) {
            lower.fill(1.0);
            upper.fill(5.0);
        }
        fn constraint_bounds(&self, lower: &mut [f64], upper: &mut [f64]) {
            lower.copy_from_slice(&[25.0, 40.0]);
            upper.copy_from_slice(&[INF, 40.0]);
        }
        fn start(&self, x: &mut [f64]) {
            x.copy_from_slice(&[1.0, 5.0, 5.0, 1.0]);
        }
        fn objective(&mut self, x: &[f64]) -> Option<f64> {
            self.objective_calls += 1;
            self.maybe_panic("objective");
            if self.nest {
                self.nested = solve(&mut distance(), &Options::default()).err();
            }
            Some(x[0] * x[3] * (x[0] + x[1] + x[2]) + x[2])
        }
        fn gradient(&mut self, x: &[f64], g: &mut [f64]) -> bool {
            self.maybe_panic("gradient");
            g.copy_from_slice(&[
                x[3] * (2.0 * x[0] + x[1] + x[2]),
                x[0] * x[3],
                x[0] * x[3] + 1.0,
                x[0] * (x[0] + x[1] + x[2]),
            ]);
            true
        }
        fn constraint_values(&mut self, x: &[f64], g: &mut [f64]) -> bool {
            self.maybe_panic("constraint_values");
            g[0] = x.iter().product();
            g[1] = x.iter().map(|x| x * x).sum();
            true
        }
        fn jacobian_structure(&self) -> Vec<(usize, usize)> {
            (0..8).map(|entry| (entry / 4, entry % 4)).collect()
        }
        fn jacobian_values(&mut self, x: &[f64], values: &mut [f64]) -> bool {
            self.maybe_panic("jacobian_values");
            for i in 0..4 {
                values[i] = (0..4).filter(|&j| j != i).map(|j| x[j]).product();
                values[4 + i] = 2.0 * x[i];
            }
            true
        }
        fn hessian_structure(&self) -> Vec<(usize, usize)> {
            let rows = if self.hessian { 4 } else { 0 };
            (0..rows).flat_map(|row| (0..=row).map(move |column| (row, column))).collect()
        }
        fn hessian_values(&mut self, x: &[f64], factor: f64, lambda: &[f64], values: &mut [f64]) -> bool {
            self.maybe_panic("hessian_values");
            let objective = [
                [2.0 * x[3], 0.0, 0.0, 0.0],
                [x[3], 0.0, 0.0, 0.0],
                [x[3], 0.0, 0.0, 0.0],
                [2.0 * x[0] + x[1] + x[2], x[0], x[0], 0.0],
            ];
            for (value, (row, column)) in values.iter_mut().zip(self.hessian_structure()) {
                let product: f64 = (0..4).filter(|&k| k != row && k != column).map(|k| x[k]).product();
                let constraints = if row == column { 2.0 * lambda[1] } else { product * lambda[0] };
                *value = factor * objective[row][column] + constraints;
            }
            true
        }
        fn iteration(&mut self, report: &IterationReport) -> bool {
            self.maybe_panic("iteration");
            self.reports.push(report.clone());
            report.iteration < self.stop_at
        }
    }

    /// Convex quadratic: half the squared distance to `target`, with linear constraints `rows . x` in `range`, in a box.
    #[derive(Clone)]
    struct Distance {
        target: Vec<f64>,
        start: Vec<f64>,
        rows: Vec<Vec<f64>>,
        range: Vec<(f64, f64)>,
        bounds: (f64, f64),
    }

    impl Nlp for Distance {
        fn variables(&self) -> usize {
            self.target.len()
        }
        fn constraints(&self) -> usize {
            self.rows.len()
        }
        fn variable_bounds(&self, lower: &mut [f64], upper: &mut [f64]) {
            lower.fill(self.bounds.0);
            upper.fill(self.bounds.1);
        }
        fn constraint_bounds(&self, lower: &mut [f64], upper: &mut [f64]) {
            for (i, &(low, high)) in self.range.iter().enumerate() {
                (lower[i], upper[i]) = (low, high);
            }
        }
        fn start(&self, x: &mut [f64]) {
            x.copy_from_slice(&self.start);
        }
        fn objective(&mut self, x: &[f64]) -> Option<f64> {
            Some(x.iter().zip(&self.target).map(|(x, t)| 0.5 * (x - t).powi(2)).sum())
        }
        fn gradient(&mut self, x: &[f64], g: &mut [f64]) -> bool {
            for i in 0..x.len() {
                g[i] = x[i] - self.target[i];
            }
            true
        }
        fn constraint_values(&mut self, x: &[f64], g: &mut [f64]) -> bool {
            for (g, row) in g.iter_mut().zip(&self.rows) {
                *g = row.iter().zip(x).map(|(a, x)| a * x).sum();
            }
            true
        }
        fn jacobian_structure(&self) -> Vec<(usize, usize)> {
            let n = self.variables();
            (0..self.constraints()).flat_map(|i| (0..n).map(move |j| (i, j))).collect()
        }
        fn jacobian_values(&mut self, _x: &[f64], values: &mut [f64]) -> bool {
            values.copy_from_slice(&self.rows.concat());
            true
        }
        fn hessian_structure(&self) -> Vec<(usize, usize)> {
            (0..self.variables()).map(|i| (i, i)).collect()
        }
        fn hessian_values(&mut self, _x: &[f64], factor: f64, _lambda: &[f64], values: &mut [f64]) -> bool {
            values.fill(factor);
            true
        }
    }

    /// Distance to (2, 1) with x0 + x1 <= 2 and x1 - x0 <= 4, from (5, 5), where the first constraint is broken. The nearest
    /// point is (1.5, 0.5), at which the gradient (-0.5, -0.5) is balanced by a multiplier of 0.5.
    fn distance() -> Distance {
        Distance {
            target: vec![2.0, 1.0],
            start: vec![5.0, 5.0],
            rows: vec![vec![1.0, 1.0], vec![-1.0, 1.0]],
            range: vec![(-INF, 2.0), (-INF, 4.0)],
            bounds: (-INF, INF),
        }
    }

    /// x - ln x, least at 1 and without a value at x <= 0, where a full Newton step from 10 leads; the one constraint, ln x,
    /// is as undefined there.
    struct Logarithm {
        start: f64,
        constrained: bool,
        refusals: usize,
        refuse_gradient_after: usize,
        gradients: usize,
    }

    impl Logarithm {
        fn from(start: f64) -> Self {
            Self { start, constrained: false, refusals: 0, refuse_gradient_after: usize::MAX, gradients: 0 }
        }

        fn log(&mut self, x: f64) -> Option<f64> {
            if x > 0.0 {
                return Some(x.ln());
            }
            self.refusals += 1;
            None
        }
    }

    impl Nlp for Logarithm {
        fn variables(&self) -> usize {
            1
        }
        fn constraints(&self) -> usize {
            usize::from(self.constrained)
        }
        fn variable_bounds(&self, _lower: &mut [f64], _upper: &mut [f64]) {}
        fn constraint_bounds(&self, _lower: &mut [f64], upper: &mut [f64]) {
            upper.fill(50.0);
        }
        fn start(&self, x: &mut [f64]) {
            x[0] = self.start;
        }
        fn objective(&mut self, x: &[f64]) -> Option<f64> {
            if self.constrained {
                // Leaves the refusing to the constraint.
                return Some(if x[0] > 0.0 { x[0] - x[0].ln() } else { -1e3 });
            }
            Some(x[0] - self.log(x[0])?)
        }
        fn gradient(&mut self, x: &[f64], g: &mut [f64]) -> bool {
            self.gradients += 1;
            g[0] = 1.0 - 1.0 / x[0];
            self.gradients <= self.refuse_gradient_after
        }
        fn constraint_values(&mut self, x: &[f64], g: &mut [f64]) -> bool {
            match self.log(x[0]) {
                Some(log) => {
                    g[0] = log;
                    true
                }
                None => false,
            }
        }
        fn jacobian_structure(&self) -> Vec<(usize, usize)> {
            vec![(0, 0); self.constraints()]
        }
        fn jacobian_values(&mut self, x: &[f64], values: &mut [f64]) -> bool {
            values.fill(1.0 / x[0]);
            true
        }
        fn hessian_structure(&self) -> Vec<(usize, usize)> {
            vec![(0, 0)]
        }
        fn hessian_values(&mut self, x: &[f64], factor: f64, lambda: &[f64], values: &mut [f64]) -> bool {
            values[0] = (factor - lambda.iter().sum::<f64>()) / (x[0] * x[0]);
            true
        }
    }

    fn assert_close(found: &[f64], expected: &[f64], tolerance: f64) {
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() <= tolerance, "found {found}, expected {expected}");
        }
    }

    fn assert_solves_hs071(options: &Options) -> Solution {
        let solution = solve(&mut Hs071::new(), options).unwrap();
        assert_eq!(solution.status, Status::Solved);
        assert_close(&solution.x, &[1.0, 4.742_999_6, 3.821_149_9, 1.379_408_3], 1e-6);
        assert_close(&[solution.objective], &[17.014_017_3], 1e-6);
        solution
    }

    #[test]
    fn hs071_reaches_its_published_optimum_and_multipliers() {
        let solution = assert_solves_hs071(&Options::default());
        assert_close(&solution.constraint_values, &[25.0, 40.0], 1e-6);
        assert_close(&solution.constraint_multipliers, &[-0.552_293_7, 0.161_468_6], 1e-5);
        assert_close(&solution.lower_bound_multipliers, &[1.087_871_2, 0.0, 0.0, 0.0], 1e-5);
        assert_close(&solution.upper_bound_multipliers, &[0.0; 4], 1e-5);
    }

    #[test]
    fn the_gradient_of_the_lagrangian_vanishes_at_a_solution() {
        let mut nlp = Hs071::new();
        let solution = solve(&mut nlp, &Options::default()).unwrap();
        let (mut gradient, mut jacobian) = ([0.0; 4], [0.0; 8]);
        assert!(nlp.gradient(&solution.x, &mut gradient) && nlp.jacobian_values(&solution.x, &mut jacobian));
        for i in 0..4 {
            let lambda = &solution.constraint_multipliers;
            let constraints = lambda[0] * jacobian[i] + lambda[1] * jacobian[4 + i];
            let bounds = solution.upper_bound_multipliers[i] - solution.lower_bound_multipliers[i];
            assert_close(&[gradient[i] + constraints + bounds], &[0.0], 1e-7);
        }
    }

    #[test]
    fn a_limited_memory_hessian_leads_to_the_same_optimum_as_the_given_one() {
        let given = assert_solves_hs071(&Options::default());
        let hessian = HessianMode::LimitedMemory { history: 6 };
        let limited = assert_solves_hs071(&Options { hessian, ..Options::default() });
        assert_close(&limited.x, &given.x, 1e-6);
        assert!(given.counts.hessian > 0);
        assert_eq!(limited.counts.hessian, 0);
    }

    #[test]
    fn constrained_least_squares_from_an_infeasible_start_finds_the_nearest_feasible_point() {
        let solution = solve(&mut distance(), &Options::default()).unwrap();
        assert_eq!(solution.status, Status::Solved);
        assert_close(&solution.x, &[1.5, 0.5], 1e-7);
        assert_close(&[solution.objective], &[0.25], 1e-7);
        assert_close(&solution.constraint_multipliers, &[0.5, 0.0], 1e-6);
    }

    #[test]
    fn linear_constraints_have_their_jacobian_evaluated_once() {
        let options = Options { linear_constraints: true, ..Options::default() };
        let linear = solve(&mut distance(), &options).unwrap();
        let general = solve(&mut distance(), &Options::default()).unwrap();
        assert_close(&linear.x, &general.x, 1e-7);
        assert_eq!(linear.counts.jacobian, 1);
        assert!(general.counts.jacobian > 1);
    }

    #[test]
    fn without_constraints_the_bounds_alone_hold_the_optimum() {
        let mut free = distance();
        (free.rows, free.range, free.bounds) = (Vec::new(), Vec::new(), (-1.0, 1.5));
        let solution = solve(&mut free, &Options::default()).unwrap();
        assert_eq!(solution.status, Status::Solved);
        assert_close(&solution.x, &[1.5, 1.0], 1e-6);
        assert!(solution.x[0] <= 1.5);
        assert_close(&solution.upper_bound_multipliers, &[0.5, 0.0], 1e-6);
        assert!(solution.constraint_values.is_empty() && solution.constraint_multipliers.is_empty());
        assert_eq!((solution.counts.constraints, solution.counts.jacobian), (0, 0));
    }

    #[test]
    fn fixed_variables_stay_where_they_are() {
        let mut fixed = distance();
        fixed.bounds = (0.25, 0.25);
        let solution = solve(&mut fixed, &Options::default()).unwrap();
        assert!(solution.status.is_success());
        assert_eq!(solution.x, [0.25, 0.25]);
        assert_close(&[solution.objective], &[0.5 * (1.75 * 1.75 + 0.75 * 0.75)], 1e-12);
    }

    #[test]
    fn a_problem_without_an_own_hessian_falls_back_to_limited_memory() {
        let solution = solve(&mut Hs071 { hessian: false, ..Hs071::new() }, &Options::default()).unwrap();
        assert_eq!(solution.status, Status::Solved);
        assert_close(&[solution.objective], &[17.014_017_3], 1e-6);
        assert_eq!(solution.counts.hessian, 0);
    }

    #[test]
    fn contradictory_constraints_are_reported_as_infeasible() {
        let mut contradictory = distance();
        contradictory.rows = vec![vec![1.0, 1.0], vec![1.0, 1.0]];
        contradictory.range = vec![(-INF, 1.0), (3.0, INF)];
        let solution = solve(&mut contradictory, &Options::default()).unwrap();
        assert_eq!(solution.status, Status::Infeasible);
        assert!(!solution.status.is_success());
        let expected = contradictory.objective(&solution.x).unwrap();
        assert_close(&[solution.objective], &[expected], 1e-9 * expected.abs());
    }

    #[test]
    fn a_panic_in_any_method_ends_the_solve_and_the_next_one_works() {
        let methods = ["objective", "gradient", "constraint_values", "jacobian_values", "hessian_values", "iteration"];
        for method in methods {
            let mut nlp = Hs071 { panic_in: Some(method), ..Hs071::new() };
            let status = match solve(&mut nlp, &Options::default()) {
                Ok(solution) => solution.status,
                Err(IpoptError::NoIterate { status }) => status,
                Err(other) => panic!("{other}"),
            };
            let expected = format!("Nlp::{method} panicked: the hull {method} came off");
            assert_eq!(status, Status::Panicked(expected), "in {method}");
            assert_solves_hs071(&Options::default());
        }
    }

    #[test]
    fn a_panic_half_way_runs_no_more_of_the_callers_code_during_the_solve() {
        let mut nlp = Hs071 { panic_in: Some("gradient"), panic_from_call: 4, ..Hs071::new() };
        let solution = solve(&mut nlp, &Options::default()).unwrap();
        assert!(matches!(&solution.status, Status::Panicked(message) if message.contains("gradient")));
        assert!(!solution.status.is_success());
        // Four by Ipopt, the last of them before the panic, and one to know the objective where it ended.
        assert_eq!(nlp.objective_calls, 5);
        let expected = Hs071::new().objective(&solution.x).unwrap();
        assert_eq!(solution.objective, expected);
    }

    #[test]
    fn a_step_to_where_the_objective_has_no_value_is_shortened() {
        let mut nlp = Logarithm::from(10.0);
        let solution = solve(&mut nlp, &Options::default()).unwrap();
        assert_eq!(solution.status, Status::Solved);
        assert_close(&solution.x, &[1.0], 1e-7);
        assert!(nlp.refusals > 0);
    }

    #[test]
    fn a_step_to_where_the_constraints_have_no_value_is_shortened() {
        let mut nlp = Logarithm { constrained: true, ..Logarithm::from(10.0) };
        let solution = solve(&mut nlp, &Options::default()).unwrap();
        assert_eq!(solution.status, Status::Solved);
        assert_close(&solution.x, &[1.0], 1e-7);
        assert!(nlp.refusals > 0);
    }

    #[test]
    fn a_start_without_a_value_leaves_no_solution() {
        let outcome = solve(&mut Logarithm::from(-1.0), &Options::default());
        assert_eq!(outcome, Err(IpoptError::NoIterate { status: Status::InvalidNumber }));
    }

    #[test]
    fn a_refused_derivative_ends_the_solve_at_a_point_whose_objective_is_known() {
        let mut nlp = Logarithm { refuse_gradient_after: 2, ..Logarithm::from(10.0) };
        let solution = solve(&mut nlp, &Options::default()).unwrap();
        assert_eq!(solution.status, Status::InvalidNumber);
        assert_eq!(solution.objective, solution.x[0] - solution.x[0].ln());
    }

    #[test]
    fn the_iteration_callback_reports_progress_and_can_stop_the_solve() {
        let mut nlp = Hs071 { stop_at: 3, ..Hs071::new() };
        let solution = solve(&mut nlp, &Options::default()).unwrap();
        assert_eq!(solution.status, Status::Stopped);
        assert_eq!(solution.iterations, 3);
        let iterations: Vec<usize> = nlp.reports.iter().map(|report| report.iteration).collect();
        assert_eq!(iterations, [0, 1, 2, 3]);
        assert_eq!(solution.objective, Hs071::new().objective(&solution.x).unwrap());
        assert_close(&[nlp.reports[3].objective], &[solution.objective], 1e-12);
    }

    #[test]
    fn the_iteration_limit_is_a_result_that_says_what_to_do() {
        let options = Options { max_iterations: 2, ..Options::default() };
        let solution = solve(&mut Hs071::new(), &options).unwrap();
        assert_eq!(solution.status, Status::MaxIterations { iterations: 2 });
        assert_eq!(solution.objective, Hs071::new().objective(&solution.x).unwrap());
        let text = solution.status.to_string();
        assert!(text.contains("2 iterations") && text.contains("raise max_iterations"), "{text}");
    }

    #[test]
    fn the_same_problem_gives_the_same_bits_twice() {
        let first = solve(&mut Hs071::new(), &Options::default()).unwrap();
        assert_eq!(first, solve(&mut Hs071::new(), &Options::default()).unwrap());
    }

    #[test]
    fn solves_on_several_threads_all_succeed() {
        std::thread::scope(|scope| {
            let solves: Vec<_> = (0..4)
                .map(|_| scope.spawn(|| (0..10).for_each(|_| drop(assert_solves_hs071(&Options::default())))))
                .collect();
            for solve in solves {
                solve.join().unwrap();
            }
        });
    }

    #[test]
    fn a_solve_inside_a_callback_is_refused_instead_of_waiting_for_itself() {
        let mut nesting = Hs071 { nest: true, ..Hs071::new() };
        assert_eq!(solve(&mut nesting, &Options::default()).unwrap().status, Status::Solved);
        assert_eq!(nesting.nested, Some(IpoptError::Nested));
        assert_solves_hs071(&Options::default());
    }

    /// Runs this test a second time, as a process of its own in a directory with a hostile `ipopt.opt`: the working directory
    /// belongs to the whole process, so that this one's must not be changed.
    #[test]
    fn an_options_file_in_the_working_directory_is_ignored_and_nothing_is_printed() {
        const CHILD: &str = "TRIMTAB_TEST_IPOPT_OPTIONS_FILE";
        if std::env::var_os(CHILD).is_some() {
            assert_solves_hs071(&Options::default());
            return;
        }
        let directory = tempfile::tempdir().unwrap();
        std::fs::write(directory.path().join("ipopt.opt"), "max_iter 1\nprint_level 5\n").unwrap();
        let name = "fit::ipopt::tests::an_options_file_in_the_working_directory_is_ignored_and_nothing_is_printed";
        let output = std::process::Command::new(std::env::current_exe().unwrap())
            .args([name, "--exact", "--nocapture"])
            .env(CHILD, "1")
            .current_dir(directory.path())
            .output()
            .unwrap();
        let printed = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success(), "{printed}{}", String::from_utf8_lossy(&output.stderr));
        assert!(printed.contains("1 passed"), "{printed}");
        assert!(!printed.contains("Ipopt") && !printed.contains("inf_pr"), "{printed}");
    }

    #[test]
    fn problems_that_make_no_sense_are_refused_by_name() {
        let solve = |nlp: &mut Distance| solve(nlp, &Options::default()).unwrap_err();

        let mut empty = Distance { target: vec![], start: vec![], rows: vec![], range: vec![], bounds: (0.0, 1.0) };
        assert_eq!(solve(&mut empty), IpoptError::NoVariables);

        let mut crossed = Distance { bounds: (1.0, 0.0), ..distance() };
        assert_eq!(solve(&mut crossed), IpoptError::Bounds { what: "variable", index: 0, lower: 1.0, upper: 0.0 });

        let mut crossed = Distance { range: vec![(0.0, 1.0), (3.0, 2.0)], ..distance() };
        assert_eq!(solve(&mut crossed), IpoptError::Bounds { what: "constraint", index: 1, lower: 3.0, upper: 2.0 });

        for bounds in [(f64::NAN, 0.0), (0.0, f64::NAN), (INF, INF), (-INF, -INF)] {
            let error = solve(&mut Distance { bounds, ..distance() });
            assert!(matches!(error, IpoptError::Bounds { what: "variable", index: 0, .. }), "{error}");
        }

        let mut lost = Distance { start: vec![0.0, INF], ..distance() };
        assert_eq!(solve(&mut lost), IpoptError::Start { index: 1, value: INF });
    }

    #[test]
    fn structures_outside_the_matrix_are_refused() {
        assert_eq!(check_structure("Jacobian", &[(0, 2)], 1, 3), Ok(vec![(0, 2)]));
        let outside = check_structure("Jacobian", &[(0, 0), (1, 0)], 1, 3);
        assert!(matches!(outside, Err(IpoptError::Structure { entry: 1, row: 1, column: 0, .. })));
        let above_the_diagonal = check_structure("Hessian", &[(0, 0), (0, 1)], 2, 2);
        assert!(matches!(above_the_diagonal, Err(IpoptError::Structure { matrix: "Hessian", entry: 1, .. })));
    }

    #[test]
    fn extra_options_reach_ipopt_and_wrong_ones_are_refused_by_name() {
        let with = |name: &str, value: OptionValue| Options { extra: vec![(name.into(), value)], ..Options::default() };
        let limited = solve(&mut Hs071::new(), &with("max_iter", OptionValue::Integer(1))).unwrap();
        assert_eq!(limited.status, Status::MaxIterations { iterations: 1 });
        assert_solves_hs071(&with("mu_strategy", OptionValue::Text("adaptive".into())));
        assert_solves_hs071(&with("bound_push", OptionValue::Number(1e-3)));

        for (name, value) in [
            ("no_such_option", OptionValue::Integer(1)),
            ("mu_strategy", OptionValue::Text("hopeful".into())),
            ("tol", OptionValue::Number(-1.0)),
            ("mu_strategy\0", OptionValue::Text("adaptive".into())),
        ] {
            let refused = solve(&mut Hs071::new(), &with(name, value.clone()));
            assert_eq!(refused, Err(IpoptError::Option { name: name.into(), value }));
        }
    }

    #[test]
    fn more_equalities_than_variables_end_without_success() {
        let mut overdetermined = distance();
        overdetermined.rows = vec![vec![1.0, 0.0], vec![0.0, 1.0], vec![1.0, 1.0]];
        overdetermined.range = vec![(1.0, 1.0), (1.0, 1.0), (2.0, 2.0)];
        let outcome = solve(&mut overdetermined, &Options::default());
        assert_eq!(outcome, Err(IpoptError::NoIterate { status: Status::NotEnoughDegreesOfFreedom }));
    }
}
