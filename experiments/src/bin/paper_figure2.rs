//! Makes figure 2: resistance and rudder curves, ours beside the paper's.
//! The work is in `trimtab_experiments::paper`; this only picks it.

use std::process::ExitCode;
use trimtab_experiments::paper::curves::CURVES;

fn main() -> ExitCode {
    trimtab_experiments::paper::run::run(&[&CURVES])
}
