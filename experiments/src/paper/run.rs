//! The command line of the binary `paper`: preparation of both ships, the tables and figures asked for, and exit codes.
//! It makes no table and no figure itself.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use clap::builder::PossibleValuesParser;
use trimtab::report::plot::{Format, Width};

use super::artefact::Artefact;
use super::case::{Case, Setup};
use super::error::PaperError;
use super::list::ARTEFACTS;
use super::target::Target;
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
    /// Folder for tables and figures; the committed ones are in `figures`.
    #[arg(long, value_name = "DIR", default_value = "paper")]
    out: PathBuf,
    /// Formats of the figures; several with commas between.
    #[arg(long, value_name = "LIST", value_delimiter = ',', default_value = "png", value_parser = PossibleValuesParser::new(["png", "svg", "pdf"]))]
    format: Vec<String>,
    /// Lay the figures out for one column of a printed page (89 mm) or two (183 mm).
    #[arg(long, value_name = "COLUMNS", value_parser = PossibleValuesParser::new(["one", "two"]))]
    width: Option<String>,
    /// Write the tables as LaTeX (booktabs) too.
    #[arg(long)]
    latex: bool,
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

impl Options {
    fn target(&self) -> Target {
        let format = |name: &String| match name.as_str() {
            "pdf" => Format::Pdf,
            "svg" => Format::Svg,
            _ => Format::Png,
        };
        let width = |name: &String| if name == "one" { Width::One } else { Width::Two };
        Target {
            folder: self.out.clone(),
            formats: self.format.iter().map(format).collect(),
            width: self.width.as_ref().map(width),
            latex: self.latex,
        }
    }
}

fn make(options: &Options) -> Result<bool, PaperError> {
    let target = options.target();
    let asked = |a: &&&Artefact| options.names.is_empty() || options.names.iter().any(|name| name == a.name);
    let setup = Setup { seed: options.seed, ..Setup::default() };
    let mut cases = Vec::new();
    for ship in [ShipId::A, ShipId::B] {
        let case = Case::prepare(ship, setup)?;
        eprintln!("{}: {}", case.label(), case.fit.brief());
        cases.push(case);
    }
    for artefact in ARTEFACTS.iter().filter(asked) {
        println!("\n# {}\n\n{}", artefact.about, (artefact.make)(&cases, &target)?);
    }
    Ok(cases.iter().all(|case| case.fit.converged))
}
