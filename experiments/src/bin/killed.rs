//! Kills commands at random instants while they write over earlier results, a row a kill, and counts what was lost or mixed.
//! A kill that has a row is not done again, so that a campaign that was itself killed continues.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use trimtab::report::Table;
use trimtab_experiments::conceal::error::ConcealError;
use trimtab_experiments::folders::exit;
use trimtab_experiments::killed::{COMMANDS, Killer, Left, Row, done, instants};
use trimtab_experiments::rows::Rows;

/// Kills commands at random instants and judges the folders that they leave.
#[derive(Parser)]
struct Arguments {
    /// Folder for the results (`kills.csv`) and for the studies meanwhile.
    #[arg(long)]
    out: PathBuf,
    /// The program.
    #[arg(long, default_value = "target/release/trimtab")]
    tool: PathBuf,
    /// Kills, divided among the commands.
    #[arg(long, default_value_t = 300)]
    kills: usize,
    /// Seed of the instants.
    #[arg(long, default_value_t = 20_261_125)]
    seed: u64,
}

fn main() -> ExitCode {
    exit("killed", run(&Arguments::parse()))
}

fn run(a: &Arguments) -> Result<(), ConcealError> {
    let studies = a.out.join("studies");
    std::fs::create_dir_all(&studies).map_err(|source| ConcealError::file(&studies, source))?;
    let path = a.out.join("kills.csv");
    let results: Rows<Row> = Rows::open(&path)?;
    let count = a.kills.div_ceil(COMMANDS.len());
    eprintln!("seed {}: {} kills of {} commands, {} done", a.seed, a.kills, COMMANDS.len(), results.rows.len());
    let killer = Killer::new(a.tool.clone(), studies.clone())?;
    for (i, command) in COMMANDS.into_iter().enumerate() {
        let instants = instants(a.seed + i as u64, count);
        let Some(done) = done(&results.rows, command.0, &instants) else {
            let message = "its kills are those of another seed, or more; give another folder with --out";
            return Err(ConcealError::content(&path, &message));
        };
        killer.all(command, &instants, done, &mut |row| results.append(&row))?;
    }
    let rows: Vec<Row> = Rows::read(&path)?;
    println!("{}", table(&rows));
    // Studies that cannot be removed do no harm.
    let _ = std::fs::remove_dir_all(&studies);
    Ok(())
}

/// Counts by command.
fn table(rows: &[Row]) -> Table {
    let mut table = Table::new([
        "command",
        "kills",
        "still running",
        "between renames",
        "earlier results",
        "new results",
        "no list",
        "mixed",
        "edit lost",
        "not mended",
    ]);
    let mut by_command: BTreeMap<&str, Vec<&Row>> = BTreeMap::new();
    rows.iter().for_each(|row| by_command.entry(&row.command).or_default().push(row));
    by_command.insert("all", rows.iter().collect());
    for (command, rows) in by_command {
        let count = |of: &dyn Fn(&Row) -> bool| rows.iter().filter(|row| of(row)).count().to_string();
        table.row([
            command.to_owned(),
            rows.len().to_string(),
            count(&|row| row.running),
            count(&|row| row.placing),
            count(&|row| row.left == Left::Earlier),
            count(&|row| row.left == Left::New),
            count(&|row| row.left == Left::Unlisted),
            count(&|row| row.left == Left::Mixed),
            count(&|row| !row.edit_kept),
            count(&|row| !row.mended),
        ]);
    }
    table
}
