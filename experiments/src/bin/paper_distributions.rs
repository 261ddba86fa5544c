//! Makes the distributions of errors over all runs, ours beside the paper's.
//! The work is in `trimtab_experiments::paper`; this only picks it.

use std::process::ExitCode;
use trimtab_experiments::paper::distributions::DISTRIBUTIONS;

fn main() -> ExitCode {
    trimtab_experiments::paper::run::run(&[&DISTRIBUTIONS])
}
