//! A safe front to the interior-point solver Ipopt: an [`Nlp`] and [`Options`] in, a [`Solution`] with its [`Status`] out.
//! It is independent of ships and fits, and scales nothing.
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
//!   several threads are therefore correct but take turns; a worker of a rayon pool that waits for its turn works on. Do not
//!   start them as tasks of the same rayon pool that evaluates the objective: a worker waiting inside an evaluation may pick
//!   up a second solve, which is refused as [`IpoptError::Nested`].
//! - Ipopt reads a file `ipopt.opt` in the working directory if there is one: this is switched off, so that a result depends
//!   on [`Options`] alone.
//! - Some failures leave zeros instead of the objective and the constraint values in Ipopt's answer: after a failure these are
//!   evaluated anew, and where that is impossible there is no [`Solution`] but [`IpoptError::NoIterate`].
//!
//! Without the cargo feature `ipopt` only the options are left, which the settings of a fit name.
//!
//! | file | what |
//! |---|---|
//! | `nlp` | what a problem must be able to evaluate |
//! | `options` | how to solve |
//! | `status` | how a solve ended and what it evaluated, or why there is none |
//! | `problem` | the fixed part of a problem, checked |
//! | `ffi` | the C interface: the only file of the project that contains `unsafe` |
//! | `solve` | one solve from the problem to the solution |

#[cfg(feature = "ipopt")]
mod ffi;
mod history;
#[cfg(feature = "ipopt")]
mod nlp;
#[cfg(feature = "ipopt")]
mod options;
#[cfg(feature = "ipopt")]
mod problem;
#[cfg(feature = "ipopt")]
mod solve;
#[cfg(feature = "ipopt")]
mod status;
#[cfg(all(test, feature = "ipopt"))]
mod tests;

pub use history::DEFAULT_HISTORY;
#[cfg(feature = "ipopt")]
pub use nlp::{IterationReport, Multipliers, Nlp};
#[cfg(feature = "ipopt")]
pub use options::{HessianMode, OptionValue, Options};
#[cfg(feature = "ipopt")]
pub use solve::{Solution, solve};
#[cfg(feature = "ipopt")]
pub use status::{Counts, IpoptError, Status};
