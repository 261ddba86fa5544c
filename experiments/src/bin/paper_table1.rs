//! Makes Table 1: what the data sets cover, ours beside the paper's.
//! The work is in `trimtab_experiments::paper`; this only picks it.

use std::process::ExitCode;
use trimtab_experiments::paper::table1::TABLE1;

fn main() -> ExitCode {
    trimtab_experiments::paper::run::run(&[&TABLE1])
}
