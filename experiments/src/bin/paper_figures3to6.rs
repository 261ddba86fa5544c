//! Makes figures 3 to 6: single test runs, ours beside the paper's.
//! The work is in `trimtab_experiments::paper`; this only picks it.

use std::process::ExitCode;
use trimtab_experiments::paper::scenarios::SCENARIOS;

fn main() -> ExitCode {
    trimtab_experiments::paper::run::run(&[&SCENARIOS])
}
