//! Runs check, fit and diagnose on studies with the faults that loggers produce, a row a fault, and counts what was told and what was not.
//! Which faults there are is in `mutated::logger`.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

use clap::Parser;
use trimtab::report::Table;
use trimtab_experiments::conceal::error::ConcealError;
use trimtab_experiments::folders::exit;
use trimtab_experiments::mutated::fate::{Fate, FaultRow, Known, fate};
use trimtab_experiments::mutated::logger::faults;
use trimtab_experiments::mutated::runner::Runner;
use trimtab_experiments::rows::Rows;

/// Puts faults of loggers into a sound study, and counts which of them are refused, told, not visible or silent.
#[derive(Parser)]
struct Arguments {
    /// Folder for the results (`faults.csv`) and for each study while it is asked about.
    #[arg(long)]
    out: PathBuf,
    /// The program.
    #[arg(long, default_value = "target/release/trimtab")]
    tool: PathBuf,
    /// Only one of so many faults.
    #[arg(long, default_value_t = 1)]
    every: usize,
    /// Longest time for one command \[s\].
    #[arg(long, default_value_t = 120)]
    limit: u64,
}

fn main() -> ExitCode {
    exit("logged", run(&Arguments::parse()))
}

fn run(a: &Arguments) -> Result<(), ConcealError> {
    let studies = a.out.join("studies");
    std::fs::create_dir_all(&studies).map_err(|source| ConcealError::file(&studies, source))?;
    let results: Rows<FaultRow> = Rows::open(&a.out.join("faults.csv"))?;
    let runner = Runner::new(a.tool.clone(), Duration::from_secs(a.limit), studies.clone())?;
    let known = Known::new(&runner)?;
    known.warnings().for_each(|line| println!("of the sound study: {line}"));
    let mut rows = Vec::new();
    for (number, fault) in faults(runner.sound()).iter().enumerate().step_by(a.every.max(1)) {
        let row = fate(&runner, &known, number, fault)?;
        results.append(&row)?;
        rows.push(row);
    }
    println!("{}", table(&rows));
    let _ = std::fs::remove_dir_all(&studies);
    Ok(())
}

/// Counts by kind.
fn table(rows: &[FaultRow]) -> Table {
    let mut table = Table::new(["fault", "faults", "refused", "told", "not visible", "silent"]);
    let mut kinds: BTreeMap<&str, Vec<&FaultRow>> = BTreeMap::new();
    rows.iter().for_each(|row| kinds.entry(&row.kind).or_default().push(row));
    kinds.insert("~ all", rows.iter().collect());
    for (kind, rows) in kinds {
        let count = |fate: Fate| rows.iter().filter(|row| row.fate == fate).count().to_string();
        let counts = [Fate::Refused, Fate::Told, Fate::NotVisible, Fate::Silent].map(count);
        table.row([kind.to_owned(), rows.len().to_string()].into_iter().chain(counts));
    }
    table
}
