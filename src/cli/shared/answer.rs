//! The answer of a command that could run, which becomes the exit code.
//! A command that could not run has an error instead.

/// How a command that could run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// Done: exit code 0.
    Yes,
    /// It ran, but the answer is no (did not converge, a check failed): exit code 1.
    No,
}
