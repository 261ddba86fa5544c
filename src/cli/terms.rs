//! `trimtab terms`: the catalogue of physical effects, with equation, source and parameters.
//! The catalogue and its listing are in the library; this file prints them.

use super::shared::answer::Answer;
use super::shared::error::CliError;
use super::shared::output::{Output, OutputArgs, csv_text};
use serde::Serialize;
use std::path::PathBuf;
use trimtab::files::suggestion;
use trimtab::report::terms::{Entry, listing, summary};
use trimtab::ship::Ship;
use trimtab::ship::parameter::ParameterInfo;
use trimtab::terms::CATALOGUE;

const LONG: &str = "\
Lists every physical effect (term) that a model can be made of: what it is, its equation and source, the recorded channels \
    it needs, and its parameters with unit, bounds and meaning. Every model has the terms flow, hull, resistance, propeller and \
    rudder; any other is added by naming it under `terms` in a model file. Parameters are set there by their dotted name, as \
    in `\"rudder.lift1\" = { value = 2.7, free = true }`.";

const AFTER: &str = "\
Examples:
  trimtab terms                        all terms, one line each
  trimtab terms rudder wind            two of them in full
  trimtab terms hull --ship ship.toml  with the values that a ship's particulars imply

With --out: terms.json, parameters.csv.
JSON: result.terms[] with name, title, group, base (every model has it), equation, source, needs[], validity (ranges[] with \
    quantity, range, words; widens[], source), and parameters[] with \
    name, symbol, unit, about, lower, upper (absent: no bound), one_sided (makes port and starboard differ), and with --ship \
    default, scale (size of a relevant change), spread (prior standard deviation; absent: no prior).";

/// Lists the physical effects a model can be made of
#[derive(Debug, clap::Args)]
#[command(long_about = LONG, after_long_help = AFTER)]
pub struct Args {
    /// Terms to show in full.
    #[arg(value_name = "TERM")]
    names: Vec<String>,
    /// Ship file, for values that depend on the ship.
    #[arg(long, value_name = "FILE")]
    ship: Option<PathBuf>,
    #[command(flatten)]
    output: OutputArgs,
}

#[derive(Serialize)]
struct Listing {
    terms: Vec<Entry>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<Answer, CliError> {
    let mut output = Output::new("terms", &args.output)?;
    let ship = args.ship.as_deref().map(Ship::read).transpose()?;
    output.reads_files(args.ship.as_slice());
    let known = || CATALOGUE.iter().map(|t| t.info().name);
    let unknown: Vec<String> =
        args.names.iter().filter(|n| !known().any(|k| k == **n)).map(|name| unknown(name)).collect();
    if !unknown.is_empty() {
        return Err(CliError::Argument(unknown.join("\n")));
    }
    let mut terms = listing(None, ship.as_ref());
    terms.retain(|t| args.names.is_empty() || args.names.iter().any(|n| n == t.name));
    let text = if args.names.is_empty() && ship.is_none() {
        format!("{}\n\n`trimtab terms NAME` shows equation, source and parameters of one.", summary(&terms))
    } else {
        terms.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n\n")
    };
    output.table("parameters.csv", &parameters(&terms)?);
    output.finish(&text, &Listing { terms })?;
    Ok(Answer::Yes)
}

/// A name that no term has: that of a parameter, by name or symbol, or one that is spelt like a term.
fn unknown(name: &str) -> String {
    let owner = CATALOGUE.iter().map(|term| term.info()).find(|info| {
        let of = |p: &ParameterInfo| p.symbol == name || p.name == name || format!("{}.{}", info.name, p.name) == name;
        info.parameters.iter().any(of)
    });
    match owner {
        Some(info) => format!("`{name}` is no term but a parameter of one: `trimtab terms {}` shows it", info.name),
        None => format!("unknown term `{name}`{}; `trimtab terms` lists them", near_term(name)),
    }
}

/// `, did you mean ...?` with the term whose name is spelt alike, or is made of the same words in another order.
fn near_term(name: &str) -> String {
    let sorted = |name: &str| {
        let mut words: Vec<String> = name.to_lowercase().split(['_', '-', ' ']).map(str::to_owned).collect();
        words.sort();
        words.join("_")
    };
    let names: Vec<&str> = CATALOGUE.iter().map(|t| t.info().name).collect();
    let direct = suggestion(name, names.iter().copied());
    if !direct.is_empty() {
        return direct;
    }
    let by_words: Vec<String> = names.iter().map(|n| sorted(n)).collect();
    let near = suggestion(&sorted(name), by_words.iter().map(String::as_str));
    let found = by_words.iter().position(|words| near.contains(&format!("`{words}`")));
    found.map_or(String::new(), |i| format!(", did you mean `{}`?", names[i]))
}

fn parameters(terms: &[Entry]) -> Result<Vec<u8>, CliError> {
    let number = |x: Option<f64>| x.map_or(String::new(), |x| x.to_string());
    let rows = terms.iter().flat_map(|t| &t.parameters).map(|p| {
        let values = [p.default, p.lower, p.upper].map(number);
        [p.name.clone(), p.symbol.into(), p.unit.into()].into_iter().chain(values).chain([p.about.to_owned()])
    });
    csv_text(&["parameter", "symbol", "unit", "default", "lower", "upper", "about"], rows)
}
