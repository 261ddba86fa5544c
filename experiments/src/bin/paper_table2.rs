//! Makes Table 2: the fitted parameters, ours beside the paper's.
//! The work is in `trimtab_experiments::paper`; this only picks it.

use std::process::ExitCode;
use trimtab_experiments::paper::table2::TABLE2;

fn main() -> ExitCode {
    trimtab_experiments::paper::run::run(&[&TABLE2])
}
