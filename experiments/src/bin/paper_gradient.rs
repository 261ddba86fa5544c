//! Makes the comparison of exact gradients and finite differences, ours beside the paper's.
//! The work is in `trimtab_experiments::paper`; this only picks it.

use std::process::ExitCode;
use trimtab_experiments::paper::gradient::GRADIENT;

fn main() -> ExitCode {
    trimtab_experiments::paper::run::run(&[&GRADIENT])
}
