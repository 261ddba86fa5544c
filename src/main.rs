//! The `trimtab` command: reads arguments, runs one command of the library, and turns its outcome into an exit code.
//! It holds no physics and no numbers: whatever a command can do, the library can do too.

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(cli::run(std::env::args_os()))
}
