//! Runs every command on thousands of changed studies, a row a command, and counts what was refused, reported and silent.
//! A case with all its rows is not run again, so that a campaign that was killed continues.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};
use trimtab::files::write_whole;
use trimtab_experiments::conceal::error::ConcealError;
use trimtab_experiments::folders::{Published, exit};
use trimtab_experiments::mutated::fate;
use trimtab_experiments::mutated::plan::{CASES, Planned, SEED, plan};
use trimtab_experiments::mutated::row::Row;
use trimtab_experiments::mutated::runner::Runner;
use trimtab_experiments::mutated::summary::table;
use trimtab_experiments::rows::Rows;

/// Damages a sound study in thousands of ways, asks every command about each, and counts the answers that changed without a warning.
#[derive(Parser)]
struct Arguments {
    /// Folder for the table of every answer (`answers.csv`) and for each study while it is asked about.
    #[arg(long)]
    out: PathBuf,
    /// Folder for `summary.csv` and the wrong answers (`failed.csv`).
    #[command(flatten)]
    published: Published,
    /// The program.
    #[arg(long, default_value = "target/release/trimtab")]
    tool: PathBuf,
    /// Asks about faults that loggers produce instead, one of so many of them, and writes them to `faults.csv` in the folder.
    #[arg(long, value_name = "EVERY")]
    faults: Option<usize>,
    /// Changed studies.
    #[arg(long, default_value_t = CASES)]
    cases: usize,
    /// Studies at a time.
    #[arg(long, default_value_t = 2)]
    workers: usize,
    /// Seed of the campaign.
    #[arg(long, default_value_t = SEED)]
    seed: u64,
    /// Longest time for one command \[s\].
    #[arg(long, default_value_t = 60)]
    limit: u64,
}

fn main() -> ExitCode {
    exit("mutated", run(&Arguments::parse()))
}

/// The cases that lack a row: each has one a command, and one more if it is diagnosed.
fn missing(rows: &[Row], cases: Vec<Planned>) -> Vec<Planned> {
    let mut counts: BTreeMap<usize, usize> = BTreeMap::new();
    rows.iter().for_each(|row| *counts.entry(row.case).or_default() += 1);
    let whole = |c: &Planned| counts.get(&c.case).copied().unwrap_or(0) >= 4 + usize::from(c.diagnosed);
    cases.into_iter().filter(|c| !whole(c)).collect()
}

fn run(a: &Arguments) -> Result<(), ConcealError> {
    if let Some(every) = a.faults {
        let runner = Runner::new(a.tool.clone(), Duration::from_secs(a.limit), a.out.join("studies"))?;
        println!("{}", fate::table(&fate::all(&runner, every, &a.out.join("faults.csv"))?));
        let _ = std::fs::remove_dir_all(a.out.join("studies"));
        return Ok(());
    }
    let path = a.out.join("answers.csv");
    let results: Rows<Row> = Rows::open(&path)?;
    let whole = plan(a.cases, a.seed);
    if let Some(row) = results.rows.iter().find(|r| whole.get(r.case - 1).is_some_and(|c| c.seed != r.seed)) {
        let message = format!("case {} is of a campaign with another seed; give another folder with --out", row.case);
        return Err(ConcealError::content(&path, &message));
    }
    let cases = missing(&results.rows, whole);
    eprintln!("seed {}: {} changed studies, {} of them without all rows", a.seed, a.cases, cases.len());
    let runner = Runner::new(a.tool.clone(), Duration::from_secs(a.limit), a.out.join("studies"))?;
    let bar = ProgressBar::new(cases.len() as u64);
    if let Ok(style) = ProgressStyle::with_template("{pos}/{len} {wide_bar} {eta}") {
        bar.set_style(style);
    }
    runner.all(&cases, a.workers, &|rows| {
        bar.inc(1);
        results.append_all(&rows)
    })?;
    bar.finish_and_clear();
    // A folder of studies that cannot be removed does no harm.
    let _ = std::fs::remove_dir_all(a.out.join("studies"));
    let folder = a.published.folder(&a.out).map_err(|source| ConcealError::file(&a.out, source))?;
    summarise(folder, &path)
}

/// Puts the rows in order, each command of a case once, counts, and lists the wrong answers.
fn summarise(folder: &Path, path: &Path) -> Result<(), ConcealError> {
    let mut rows: Vec<Row> = Rows::read(path)?;
    rows.sort_by(|a, b| (a.case, &a.command).cmp(&(b.case, &b.command)));
    rows.dedup_by(|a, b| (a.case, &a.command) == (b.case, &b.command));
    write_whole(path, Rows::table(&rows)?.as_bytes()).map_err(|source| ConcealError::file(path, source))?;
    let counts = table(&rows);
    println!("{counts}");
    let line = |cells: &[String]| cells.join(",") + "\n";
    // No name of a class or a change has a comma but the one that is quoted here.
    let quoted = |cells: &Vec<String>| cells.iter().map(|c| format!("\"{c}\"")).collect::<Vec<_>>();
    let text = line(counts.header()) + &counts.rows().iter().map(|row| line(&quoted(row))).collect::<String>();
    let failed: Vec<Row> = rows.into_iter().filter(|row| !row.right).collect();
    for (name, text) in [("summary.csv", text), ("failed.csv", Rows::table(&failed)?)] {
        let path = folder.join(name);
        write_whole(&path, text.as_bytes()).map_err(|source| ConcealError::file(&path, source))?;
    }
    Ok(())
}
