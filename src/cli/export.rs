//! `trimtab export`: a fitted ship as coefficients for other programs.
//! The library converts; this file reads the arguments, prints and writes.

use super::shared::answer::Answer;
use super::shared::error::CliError;
use super::shared::load::read_model;
use super::shared::output::{is_new, print, print_file};
use std::path::{Path, PathBuf};
use trimtab::files::{settle, write_whole};
use trimtab::model::export::export;
use trimtab::ship::Ship;
use trimtab::study::Study;

const LONG: &str = "\
Writes the hull, propeller, rudder and resistance of a model as coefficients for other programs: the HD coefficients in SI \
    units and their primes, those of the MMG form, and the equations, axes, signs and divisors that they belong to. The \
    MATLAB script also runs in Octave and leaves the hull force as a function.

The ship is that of the study, or of --ship. Terms beyond hull, flow, resistance, propeller and rudder, and what a model adds \
    in single sessions, are left out; the file names the terms. Of a model of form `mmg` the primes are exported as the model has them.";

const AFTER: &str = "\
Examples:
  trimtab export results/fitted.toml --study study.toml --out ship.m
  trimtab export results/fitted.toml --ship ship.toml --format json";

/// Writes a fitted ship as HD and MMG coefficients for other programs
#[derive(Debug, clap::Args)]
#[command(long_about = LONG, after_long_help = AFTER)]
pub struct Args {
    /// The model file, such as the `fitted.toml` of `trimtab fit --out`.
    #[arg(value_name = "MODEL")]
    model: PathBuf,
    /// Study that names the ship.
    #[arg(long, value_name = "STUDY", required_unless_present = "ship")]
    study: Option<PathBuf>,
    /// Ship file, instead of that of a study.
    #[arg(long, value_name = "FILE", conflicts_with = "study")]
    ship: Option<PathBuf>,
    /// Form of the file; without, that of the ending of --out (.toml, .json, .m), and else TOML.
    #[arg(long, value_name = "FORMAT")]
    format: Option<Format>,
    /// File to write; without, it is printed.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// A form of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    /// TOML.
    Toml,
    /// JSON.
    Json,
    /// A MATLAB or Octave script.
    Matlab,
}

impl Format {
    /// By the ending of a file's name.
    fn by_ending(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()? {
            "toml" => Some(Self::Toml),
            "json" => Some(Self::Json),
            "m" => Some(Self::Matlab),
            _ => None,
        }
    }
}

/// Runs the command.
pub fn run(args: &Args) -> Result<Answer, CliError> {
    args.out.as_deref().map_or(Ok(()), is_new)?;
    let ship = match (&args.ship, &args.study) {
        (Some(ship), _) => ship.clone(),
        (None, Some(study)) => Study::read_without_runs(study)?.ship,
        (None, None) => return Err(CliError::Argument("give --study or --ship".into())),
    };
    settle(&args.model)?;
    settle(&ship)?;
    let exported = export(&read_model(&args.model, Ship::read(&ship)?)?);
    let by_ending = || args.out.as_deref().and_then(Format::by_ending);
    let text = match args.format.or_else(by_ending).unwrap_or(Format::Toml) {
        Format::Toml => {
            toml::to_string(&exported).map_err(|e| CliError::Format { format: "TOML", message: e.to_string() })?
        }
        Format::Json => serde_json::to_string_pretty(&exported)? + "\n",
        Format::Matlab => exported.matlab(),
    };
    match &args.out {
        None => print_file(&text)?,
        Some(path) => {
            write_whole(path, text.as_bytes()).map_err(|source| CliError::Write { path: path.clone(), source })?;
            print(&format!("Written: {}\n", path.display()))?;
        }
    }
    Ok(Answer::Yes)
}
