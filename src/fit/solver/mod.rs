//! From a start to an optimum that was checked: the problem that Ipopt is given, its limits and its stages.
//!
//! | file | what |
//! |---|---|
//! | `constraints` | the constraints as data: curves bounded on grids |
//! | `task` | what stays fixed during a fit: model, cost, constraints, scales, start |
//! | `scaling` | scales of the parameters, sizes of the rows |
//! | `curvature` | the matrix of second derivatives that Ipopt is given |
//! | `rows` | which of the constraint rows the solver gets |
//! | `limits` | what ends a fit before its optimum |
//! | `problem` | the task with the priors, scaled, as Ipopt wants it |
//! | `stages` | runs in shorter pieces, or a few of them, to be fitted first |
//! | `descent` | one solve through Ipopt, with its restarts |
//! | `solve` | from the start through the stages to an optimum that was checked |
//! | `likelihood` | the fit by likelihood: noise, gains and parameters in turn |
//! | `subspace` | directions that constraints leave free |

pub mod constraints;
#[cfg(feature = "ipopt")]
pub(in crate::fit) mod curvature;
#[cfg(feature = "ipopt")]
pub(in crate::fit) mod descent;
#[cfg(feature = "ipopt")]
pub(in crate::fit) mod likelihood;
#[cfg(feature = "ipopt")]
pub(in crate::fit) mod limits;
#[cfg(feature = "ipopt")]
pub(in crate::fit) mod problem;
#[cfg(feature = "ipopt")]
pub(in crate::fit) mod rows;
#[cfg(feature = "ipopt")]
pub(in crate::fit) mod scaling;
#[cfg(feature = "ipopt")]
pub(in crate::fit) mod solve;
#[cfg(feature = "ipopt")]
pub(in crate::fit) mod stages;
#[cfg(feature = "ipopt")]
pub(in crate::fit) mod subspace;
#[cfg(feature = "ipopt")]
pub(in crate::fit) mod task;
