//! What the binaries share: the command line, the preparation of both ships, and exit codes.
//! It makes no table and no figure.

use super::case::{Case, Setup};
use super::{Artefact, PaperError};
use crate::truth::dataset::SEED;
use crate::truth::ships::ShipId;
use clap::Parser;
use std::path::PathBuf;
use std::process::ExitCode;

/// Makes tables and figures of the paper anew and prints our numbers beside the paper's.
#[derive(Debug, Parser)]
struct Options {
    /// Folder for pictures and the CSV behind them.
    #[arg(long, default_value = "figures")]
    out: PathBuf,
    /// Seed of the data sets and of the bootstrap.
    #[arg(long, default_value_t = SEED)]
    seed: u64,
}

/// Makes these tables and figures; exit code 0 if done, 1 if a fit did not converge, 2 if they could not be made.
pub fn run(artefacts: &[&Artefact]) -> ExitCode {
    match make(&Options::parse(), artefacts) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

fn make(options: &Options, artefacts: &[&Artefact]) -> Result<bool, PaperError> {
    let setup = Setup { seed: options.seed, ..Setup::default() };
    let mut cases = Vec::new();
    for ship in [ShipId::A, ShipId::B] {
        let case = Case::prepare(ship, setup)?;
        eprintln!("{}: {}", case.label(), case.fit.brief());
        cases.push(case);
    }
    for artefact in artefacts {
        println!("\n# {}\n\n{}", artefact.about, (artefact.make)(&cases, &options.out)?);
    }
    Ok(cases.iter().all(|case| case.fit.converged))
}
