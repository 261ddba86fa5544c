//! Why there is no fit.
//! A fit that does not converge is a result and no error: see [`Fit::status`](super::Fit::status).

#[cfg(feature = "ipopt")]
use crate::ipopt::IpoptError;
use crate::ranges::OutOfRange;

/// Why there is no fit.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// There is nothing to fit to.
    #[error("there are no recordings to fit to; mark at least one run of the study for training")]
    NoRuns,
    /// The file that keeps the runs cannot be read.
    #[error(
        "the temporary file with the recordings cannot be read; check the disk with the folder for temporary files"
    )]
    Unreadable,
    /// There is nothing to fit.
    #[error("no parameter is free; set `free = true` for at least one parameter in the model file")]
    NothingFree,
    /// A run that the cost cannot use.
    #[error("run `{run}`: {what}")]
    BadRun {
        /// The run.
        run: String,
        /// What is wrong.
        what: String,
    },
    /// A setting with a value that cannot be used.
    #[error("[fit] {0}")]
    Setting(#[from] OutOfRange),
    /// A constraint rule that cannot be imposed.
    #[error("[fit.constraints] {rule}: {what}")]
    BadRule {
        /// Its key.
        rule: String,
        /// What is wrong, and what to do.
        what: String,
    },
    /// The simulation diverges at the start.
    #[error(
        "the simulation of run `{run}` diverges at t = {time:.1} s with the starting parameters; start from parameters that \
         can be simulated, or use shorter windows or more integration sub-steps"
    )]
    Diverged {
        /// The run.
        run: String,
        /// When \[s\], on the recording's clock.
        time: f64,
    },
    /// The constraints contradict each other.
    #[error(
        "the constraints contradict each other: where the solver gave up, {sentence} is still broken by {violation:.3e}; relax \
         [fit.constraints] {rule}, or the bounds of its parameters"
    )]
    Infeasible {
        /// Key of the rule that is broken most.
        rule: &'static str,
        /// What it asks for.
        sentence: String,
        /// By how much it is broken, in its own unit.
        violation: f64,
    },
    /// A fit by likelihood on several ranks.
    #[error(
        "a fit with objective = \"likelihood\" runs in one process; start it without mpirun, or set objective = \"trajectory\" in [fit]"
    )]
    OneRank,
    /// The solver could not start.
    #[cfg(feature = "ipopt")]
    #[error("the solver could not start: {0}")]
    Solver(#[from] IpoptError),
}
