//! Makes the table of what limits the fit.
//! The work is in `trimtab_experiments::paper`; this only picks it.

use std::process::ExitCode;
use trimtab_experiments::paper::limits::LIMITS;

fn main() -> ExitCode {
    trimtab_experiments::paper::run::run(&[&LIMITS])
}
