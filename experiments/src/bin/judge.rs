//! Judges one diagnosis: opens the seal of a concealed case and scores a `diagnosis.json` that was written before.
//! It neither makes cases nor diagnoses them.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use trimtab_experiments::conceal::error::ConcealError;
use trimtab_experiments::conceal::judge::rules::judge;
use trimtab_experiments::conceal::judge::said::Diagnosis;
use trimtab_experiments::conceal::seal;
use trimtab_experiments::folders::exit;

/// Prints the scores of a diagnosis as one CSV row with its header.
#[derive(Parser)]
struct Arguments {
    /// Folder of the case, with `study/` and `sealed/`.
    case: PathBuf,
    /// The diagnosis.
    diagnosis: PathBuf,
}

fn main() -> ExitCode {
    exit("judge", run(&Arguments::parse()).map(|row| print!("{row}")))
}

fn run(arguments: &Arguments) -> Result<String, ConcealError> {
    let diagnosis = Diagnosis::read(&arguments.diagnosis)?;
    let score = judge(&seal::open(&arguments.case)?, &diagnosis);
    let fail = |e: &dyn std::fmt::Display| ConcealError::content(Path::new("the row"), e);
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.serialize(score).map_err(|e| fail(&e))?;
    let bytes = writer.into_inner().map_err(|e| fail(&e))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
