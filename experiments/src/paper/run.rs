//! The command line of the binary `paper`: preparation of both ships, the tables and figures asked for, and exit codes.
//! It makes no table and no figure itself.

use std::process::ExitCode;

use clap::Parser;
use clap::builder::PossibleValuesParser;

use super::artefact::Artefact;
use super::case::{Case, Setup};
use super::error::PaperError;
use super::list::ARTEFACTS;
use crate::folders::Folder;
use crate::truth::dataset::SEED;
use crate::truth::ships::ShipId;

/// Makes tables and figures of the paper anew and prints our numbers beside the paper's.
///
/// Exit code 0: done; 1: a fit did not converge; 2: a table or figure could not be made.
#[derive(Debug, Parser)]
struct Options {
    /// Tables and figures to make; all if none is given.
    #[arg(value_parser = PossibleValuesParser::new(ARTEFACTS.map(|a| a.name)))]
    names: Vec<String>,
    #[command(flatten)]
    folder: Folder,
    /// Seed of the data sets and of the bootstrap.
    #[arg(long, default_value_t = SEED)]
    seed: u64,
}

/// Makes the tables and figures that the command line asks for.
pub fn run() -> ExitCode {
    match make(&Options::parse()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(error) => {
            eprintln!("paper: {error}");
            ExitCode::from(2)
        }
    }
}

fn make(options: &Options) -> Result<bool, PaperError> {
    let out = options.folder.path();
    let asked = |a: &&&Artefact| options.names.is_empty() || options.names.iter().any(|name| name == a.name);
    let setup = Setup { seed: options.seed, ..Setup::default() };
    let mut cases = Vec::new();
    for ship in [ShipId::A, ShipId::B] {
        let case = Case::prepare(ship, setup)?;
        eprintln!("{}: {}", case.label(), case.fit.brief());
        cases.push(case);
    }
    for artefact in ARTEFACTS.iter().filter(asked) {
        println!("\n# {}\n\n{}", artefact.about, (artefact.make)(&cases, &out)?);
    }
    Ok(cases.iter().all(|case| case.fit.converged))
}
