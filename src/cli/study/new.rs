//! `trimtab new`: a ship file from length, breadth, draught and type, or from a ship file with values missing.
//! The library estimates; this file reads the arguments, prints and writes.

use crate::cli::shared::answer::Answer;
use crate::cli::shared::error::CliError;
use crate::cli::shared::output::{is_new, print, print_file, print_json};
use crate::cli::shared::terminal::tell;
use std::path::{Path, PathBuf};
use toml::{Table, Value};
use trimtab::files::suggestion;
use trimtab::files::written::{Kind as Written, joined, read_tables, read_text};
use trimtab::files::{plain_cell, write_whole};
use trimtab::numbers::numerals::sig;
use trimtab::report::Table as Listing;
use trimtab::ship::particulars::{Entry, Estimated, KINDS, Kind, Origin, estimate};

const LONG: &str = "\
Writes a ship file with every value that you do not give estimated by the published regressions of the field, each with its \
    source and its spread as a comment. What you give is kept: by --from (a ship file with values missing), by the options \
    below, or by --set for any key of a ship file.

With --model also a model file for the ship, with the spreads as priors.

An estimate is where a fit starts, not what the ship is: the spread of a mass is 6 %, of a rudder area 25 %. Put what you \
    know in its place.";

const AFTER: &str = "\
Examples:
  trimtab new --lpp 85 --breadth 13.5 --draught 4.2 --type coaster --out ship.toml --model model.toml
  trimtab new --from ship.toml --type tanker --out ship_complete.toml
  trimtab new --lpp 85 --breadth 13.5 --draught 4.2 --type coaster --set hull.mass=3.4e6 --set rudder.area=8

Types, with the range of L [m], L/B, B/d and of the Froude number of the service speed (0.14 to 0.34) over which they are valid:
  coaster        40 to 160, 5.0 to 7.8, 2.0 to 3.8   coasters and general cargo ships
  container      80 to 400, 5.5 to 8.5, 2.2 to 4.2
  tanker         60 to 380, 5.0 to 7.2, 2.1 to 3.6
  bulk_carrier   80 to 340, 5.2 to 7.2, 2.0 to 3.4
  ferry          40 to 240, 4.0 to 7.8, 2.8 to 5.2   also ro_ro
  tug            15 to 60,  2.2 to 4.5, 2.0 to 4.0
  fishing        10 to 110, 2.6 to 6.2, 1.9 to 3.6
  yacht          1 to 80,   2.2 to 7.0, 2.2 to 6.5   also usv; at displacement speed

JSON: result.type, result.speed [m/s], result.outside[] (in which quantities the ship is outside the range of its type), \
    result.entries[] (key, value, origin given or estimated, source, spread).";

/// Writes a ship file, with every value that is not given estimated
#[derive(Debug, clap::Args)]
#[command(long_about = LONG, after_long_help = AFTER)]
pub struct Args {
    /// Ship file with values missing; what it has is kept.
    #[arg(long, value_name = "FILE")]
    from: Option<PathBuf>,
    /// Length between perpendiculars [m].
    #[arg(long, value_name = "M", required_unless_present = "from")]
    lpp: Option<f64>,
    /// Breadth [m].
    #[arg(long, value_name = "M", required_unless_present = "from")]
    breadth: Option<f64>,
    /// Draught [m].
    #[arg(long, value_name = "M", required_unless_present = "from")]
    draught: Option<f64>,
    /// Type of ship, see below.
    #[arg(long = "type", value_name = "TYPE")]
    kind: String,
    /// Service speed [m/s]; that of the type's usual Froude number if not given.
    #[arg(long, value_name = "M/S")]
    speed: Option<f64>,
    /// Name of the ship.
    #[arg(long)]
    name: Option<String>,
    /// Mass [kg].
    #[arg(long, value_name = "KG")]
    mass: Option<f64>,
    /// Block coefficient C_b.
    #[arg(long, value_name = "C_B")]
    block_coefficient: Option<f64>,
    /// Propeller diameter [m].
    #[arg(long, value_name = "M")]
    propeller_diameter: Option<f64>,
    /// Rudder area [m2].
    #[arg(long, value_name = "M2")]
    rudder_area: Option<f64>,
    /// Any value of a ship file, in SI units.
    #[arg(long, value_name = "TABLE.KEY=VALUE")]
    set: Vec<String>,
    /// Ship file to write; without, it is printed. A file that is there is never overwritten.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Model file to write, with the spreads as priors; a file that is there is never overwritten.
    #[arg(long, value_name = "FILE")]
    model: Option<PathBuf>,
    /// Print the estimates as one JSON object, and nothing else, to standard output.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<Answer, CliError> {
    let kind = Kind::find(&args.kind).ok_or_else(|| {
        let names: Vec<&str> = KINDS.iter().flat_map(|k| k.aliases.iter().chain([&k.name])).copied().collect();
        let near = suggestion(&args.kind, names.iter().copied());
        let types: Vec<&str> = KINDS.iter().map(|k| k.name).collect();
        CliError::Argument(format!("unknown type `{}`{near}; the types are {}", args.kind, types.join(", ")))
    })?;
    if let Some(speed) = args.speed.filter(|s| !(s.is_finite() && *s > 0.0)) {
        return Err(CliError::Argument(format!("--speed {speed} must be a positive number, in m/s")));
    }
    [&args.out, &args.model].into_iter().flatten().try_for_each(|path| is_new(path))?;
    let given = given(args)?;
    let estimated = estimate(kind, &given, args.speed).map_err(|e| CliError::Argument(in_arguments(&e.to_string())))?;
    for sentence in &estimated.outside {
        tell(&format!("warning: {sentence}: the estimates are less sure than their spreads say"));
    }
    for (path, text) in [(&args.out, estimated.ship_file()), (&args.model, &estimated.model_file())] {
        if let Some(path) = path {
            write_whole(path, text.as_bytes()).map_err(|source| CliError::Write { path: path.clone(), source })?;
        }
    }
    if args.json {
        print_json(&serde_json::json!({"command": "new", "result": estimated, "version": env!("CARGO_PKG_VERSION")}))?;
    } else if args.out.is_none() {
        print_file(estimated.ship_file())?;
    } else {
        print(&summary(&estimated, args))?;
    }
    Ok(Answer::Yes)
}

/// A message of the library with the option that gives a main dimension.
fn in_arguments(message: &str) -> String {
    message
        .replacen("hull.lpp must", "hull.lpp (--lpp) must", 1)
        .replacen("hull.breadth must", "hull.breadth (--breadth) must", 1)
        .replacen("hull.draught must", "hull.draught (--draught) must", 1)
}

/// What is given, in the layout of a ship file: options and --set over the file of --from.
fn given(args: &Args) -> Result<Table, CliError> {
    let mut table = match &args.from {
        None => Table::new(),
        Some(path) => read(path)?,
    };
    let numbers = [
        ("hull.lpp", args.lpp),
        ("hull.breadth", args.breadth),
        ("hull.draught", args.draught),
        ("hull.mass", args.mass),
        ("hull.block_coefficient", args.block_coefficient),
        ("propeller.diameter", args.propeller_diameter),
        ("rudder.area", args.rudder_area),
    ];
    for (key, value) in numbers {
        if let Some(value) = value {
            put(&mut table, key, Value::Float(value))?;
        }
    }
    if let Some(name) = &args.name {
        put(&mut table, "name", Value::String(name.clone()))?;
    }
    for set in &args.set {
        let wrong = || CliError::Argument(format!("--set {set}: expected TABLE.KEY=VALUE, such as hull.mass=3.4e6"));
        let (key, value) = set.split_once('=').ok_or_else(wrong)?;
        let parsed: Table = format!("value = {}", value.trim()).parse().map_err(|_| wrong())?;
        put(&mut table, key.trim(), parsed.get("value").cloned().ok_or_else(wrong)?)?;
    }
    Ok(table)
}

/// The tables of a ship file, of which not all need be there.
fn read(path: &Path) -> Result<Table, CliError> {
    let text = read_text(path).map_err(|source| {
        CliError::Argument(format!(
            "{}: cannot read the ship file ({source}); check the path of --from",
            path.display()
        ))
    })?;
    read_tables(&text, Written::Ship).map_err(|mistakes| {
        let (line, message) = joined(mistakes, path);
        CliError::Argument(format!("{}:{line}: {message}", path.display()))
    })
}

/// Sets a dotted key; names in [parameters] have a dot of their own.
fn put(table: &mut Table, key: &str, value: Value) -> Result<(), CliError> {
    let Some((name, rest)) = key.split_once('.') else {
        table.insert(key.to_owned(), value);
        return Ok(());
    };
    let inner = table.entry(name.to_owned()).or_insert_with(|| Value::Table(Table::new()));
    let Some(inner) = inner.as_table_mut() else {
        return Err(CliError::Argument(format!("`{name}` is a value and not a table, so that it has no `{rest}`")));
    };
    inner.insert(rest.to_owned(), value);
    Ok(())
}

/// The estimates as a table, and what to do next.
fn summary(estimated: &Estimated, args: &Args) -> String {
    let mut table = Listing::new(["estimated", "value", "spread", "source"]);
    let mut given = Vec::new();
    for Entry { key, value, origin } in estimated.entries.iter().filter(|e| e.key.contains('.')) {
        match origin {
            Origin::Given => given.push(key.as_str()),
            Origin::Estimated { source, spread } => {
                let spread = spread.map_or(String::new(), |s| sig(s, 2));
                table.row([key.clone(), plain_cell(&value.to_string()).into_owned(), spread, source.clone()]);
            }
        }
    }
    let files: Vec<String> = [&args.out, &args.model].into_iter().flatten().map(|p| p.display().to_string()).collect();
    format!(
        "{}, type {}, service speed {} m/s\nGiven: {}\n\n{}\n\nWritten: {}. Put what you know in place of the estimates.\n",
        estimated.ship.name,
        estimated.kind,
        sig(estimated.speed, 3),
        given.join(", "),
        table,
        files.join(", ")
    )
}
