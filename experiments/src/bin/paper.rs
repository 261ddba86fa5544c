//! Makes every table and figure of the paper, ours beside the paper's.
//! The work is in `trimtab_experiments::paper`; each table and figure has a binary of its own, too.

use std::process::ExitCode;
use trimtab_experiments::paper::{ARTEFACTS, run::run};

fn main() -> ExitCode {
    run(&ARTEFACTS)
}
