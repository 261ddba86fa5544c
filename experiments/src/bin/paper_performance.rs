//! Makes the overall performance, ours beside the paper's.
//! The work is in `trimtab_experiments::paper`; this only picks it.

use std::process::ExitCode;
use trimtab_experiments::paper::performance::PERFORMANCE;

fn main() -> ExitCode {
    trimtab_experiments::paper::run::run(&[&PERFORMANCE])
}
