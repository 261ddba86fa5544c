//! How a solve ended, or why there is no solution, each with words that say what to do next.
//! It evaluates nothing.

use super::options::OptionValue;
use std::fmt;

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
    /// [`Nlp::iteration`](super::Nlp::iteration) returned false.
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
    /// A method of the [`Nlp`](super::Nlp) panicked; the text names the method and carries the panic's message.
    Panicked(String),
}

impl Status {
    /// Ipopt's own name of it.
    pub fn name(&self) -> &'static str {
        match self {
            Status::Solved => "Solve_Succeeded",
            Status::SolvedToAcceptable => "Solved_To_Acceptable_Level",
            Status::Infeasible => "Infeasible_Problem_Detected",
            Status::TinyStep => "Search_Direction_Becomes_Too_Small",
            Status::Diverging => "Diverging_Iterates",
            Status::Stopped | Status::Panicked(_) => "User_Requested_Stop",
            Status::FeasiblePointFound => "Feasible_Point_Found",
            Status::MaxIterations { .. } => "Maximum_Iterations_Exceeded",
            Status::RestorationFailed => "Restoration_Failed",
            Status::StepComputationFailed => "Error_In_Step_Computation",
            Status::MaxCpuTime => "Maximum_CpuTime_Exceeded",
            Status::NotEnoughDegreesOfFreedom => "Not_Enough_Degrees_Of_Freedom",
            Status::InvalidProblem => "Invalid_Problem_Definition",
            Status::InvalidOption => "Invalid_Option",
            Status::InvalidNumber => "Invalid_Number_Detected",
            Status::UnrecoverableException => "Unrecoverable_Exception",
            Status::NonIpoptException => "NonIpopt_Exception_Thrown",
            Status::InsufficientMemory => "Insufficient_Memory",
            Status::InternalError => "Internal_Error",
        }
    }

    /// Whether the solution can be used.
    pub fn is_success(&self) -> bool {
        matches!(self, Status::Solved | Status::SolvedToAcceptable | Status::FeasiblePointFound)
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

/// Why there is no [`Solution`](super::Solution): the problem or the options make no sense, or the solve ended before its first point.
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
    /// Ipopt has no such option, or refuses its value.
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
    #[error(
        "a solve was started from inside another one (or as a task of the same rayon pool); run them one after the other"
    )]
    Nested,
    /// The solve ended at no point at which objective and constraints could be evaluated.
    #[error("no usable point was reached: {status}")]
    NoIterate {
        /// How the solve ended.
        status: Status,
        /// Iterations it took.
        iterations: usize,
        /// Evaluations it took.
        counts: Counts,
    },
}
