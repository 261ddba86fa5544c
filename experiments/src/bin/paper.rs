//! Makes the tables and figures of the paper, ours beside the paper's: all of them, or those named on the command line.
//! The work is in `trimtab_experiments::paper`.

use std::process::ExitCode;
use trimtab_experiments::paper::run::run;

fn main() -> ExitCode {
    run()
}
