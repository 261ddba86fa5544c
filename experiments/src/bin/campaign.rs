//! Runs the campaign of concealed cases, one row of results a case, and summarises them against the aims.
//! A case with a row in the results file is not run again, so that an interrupted campaign can be continued.

use std::collections::{BTreeSet, HashMap};
use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use clap::{Parser, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};
use trimtab::ranks::Ranks;
use trimtab_experiments::conceal::campaign::figure::figure;
use trimtab_experiments::conceal::campaign::plan::{Planned, SEED, ci_slice, plan};
use trimtab_experiments::conceal::campaign::summary::{summary, table};
use trimtab_experiments::conceal::error::ConcealError;
use trimtab_experiments::conceal::judge::score::Score;
use trimtab_experiments::conceal::runner::Runner;
use trimtab_experiments::folders::exit;

/// Makes, diagnoses and judges concealed cases, and compares the scores with the aims.
#[derive(Parser)]
struct Arguments {
    /// Folder for the results (`cases.csv`, `summary.csv`, the figure) and for each case while it runs.
    #[arg(long, default_value = "figures/concealed")]
    out: PathBuf,
    /// The program that diagnoses, called as `TOOL --threads 1 diagnose STUDY --json`.
    #[arg(long, default_value = "target/release/trimtab")]
    tool: PathBuf,
    /// Cases at a time, on each rank.
    #[arg(long, default_value_t = 2)]
    workers: usize,
    /// Part of the plan.
    #[arg(long, value_enum, default_value = "all")]
    slice: Slice,
    /// Only cases whose key contains this.
    #[arg(long)]
    only: Option<String>,
    /// At most this many cases in this call.
    #[arg(long)]
    most: Option<usize>,
    /// Seed of the campaign.
    #[arg(long, default_value_t = SEED)]
    seed: u64,
    /// Longest time for one diagnosis \[s\].
    #[arg(long, default_value_t = 300)]
    limit: u64,
    /// Keep the folders of the cases, for inspection.
    #[arg(long)]
    keep: bool,
    /// The diagnosis alone, without the baselines.
    #[arg(long)]
    alone: bool,
    /// Run sparse regression too, with this Python, which has PySINDy (see experiments/peers).
    #[arg(long, value_name = "PYTHON")]
    sindy: Option<PathBuf>,
    /// Print the plan and stop.
    #[arg(long)]
    list: bool,
    /// Only summarise the rows of the results file.
    #[arg(long)]
    summary: bool,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Slice {
    /// Every case.
    All,
    /// The 40 cases of every push.
    Ci,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let ranks = Ranks::join();
    let outcome = run(&arguments, &ranks);
    if let (Err(error), true) = (&outcome, ranks.size() > 1) {
        ranks.fail(&error.to_string());
    }
    exit("campaign", outcome)
}

fn run(a: &Arguments, ranks: &Ranks) -> Result<(), ConcealError> {
    let whole = plan(a.seed);
    let mut plan = if a.slice == Slice::Ci { ci_slice(&whole) } else { whole.clone() };
    plan.retain(|c| a.only.as_ref().is_none_or(|part| c.key.contains(part.as_str())));
    if a.list {
        plan.iter().filter(|_| ranks.is_first()).for_each(|c| println!("{:9} {}", c.arm, c.key));
        return Ok(());
    }
    let results = a.out.join("cases.csv");
    if !a.summary {
        // What the first rank finds done counts: the others may see the file later.
        let own = if ranks.is_first() { done(&a.out, &results)? } else { BTreeSet::new() };
        let done = ranks.gather(&own).swap_remove(0);
        plan.retain(|c| !done.contains(&c.key));
        // The first case of every kind, then the second: an unfinished campaign is a fair sample of the whole.
        plan.sort_by_key(|c| c.key.rsplit('/').next().and_then(|i| i.parse::<usize>().ok()));
        plan.truncate(a.most.unwrap_or(usize::MAX));
        if !plan.is_empty() {
            execute(a, ranks, &plan, &results)?;
        }
    }
    if !ranks.is_first() {
        return Ok(());
    }
    put_in_order(&results, &whole)?;
    summarise(a, &read(&results)?)
}

/// The cases that have a row; makes the folder of the results.
fn done(folder: &Path, results: &Path) -> Result<BTreeSet<String>, ConcealError> {
    std::fs::create_dir_all(folder).map_err(|source| ConcealError::file(folder, source))?;
    Ok(read(results)?.into_iter().map(|s| s.case).collect())
}

/// The rows of the results file; none without a file.
fn read(path: &Path) -> Result<Vec<Score>, ConcealError> {
    if !path.exists() {
        return Ok(Vec::new());
    }
    let mut reader = csv::Reader::from_path(path).map_err(|e| ConcealError::content(path, &e))?;
    reader.deserialize().collect::<Result<_, _>>().map_err(|e| ConcealError::content(path, &e))
}

/// Runs the cases of `plan`, dealt out to the ranks; the first rank appends a row as each case ends, wherever it ran.
fn execute(a: &Arguments, ranks: &Ranks, plan: &[Planned], results: &Path) -> Result<(), ConcealError> {
    let runner = Runner {
        tool: a.tool.clone(),
        limit: Duration::from_secs(a.limit),
        folder: a.out.join("cases"),
        keep: a.keep,
        baselines: !a.alone,
        sindy: a.sindy.clone(),
    };
    let own: Vec<Planned> = plan.iter().enumerate().filter(|(i, _)| ranks.takes(*i)).map(|(_, c)| c.clone()).collect();
    if !ranks.is_first() {
        runner.all(&own, a.workers, &|score| {
            ranks.hand_in(&row(&score, false)?);
            Ok(())
        })?;
        ranks.hand_in("");
        return Ok(());
    }
    let rows = Rows::open(results)?;
    let bar = ProgressBar::new(plan.len() as u64);
    if let Ok(style) = ProgressStyle::with_template("{pos}/{len} {wide_bar} {eta} {msg}") {
        bar.set_style(style);
    }
    let outcome = std::thread::scope(|scope| {
        let others = scope.spawn(|| receive(ranks, &rows, &bar));
        let own = runner.all(&own, a.workers, &|score| {
            bar.set_message(score.case.clone());
            bar.inc(1);
            rows.append(&row(&score, false)?)
        });
        if let Err(error) = own {
            // The others are not waited for: their rows so far are in the file.
            return if ranks.size() > 1 { ranks.fail(&error.to_string()) } else { Err(error) };
        }
        others.join().unwrap_or_else(|_| Err(ConcealError::content(results, &"the rows of other ranks were lost")))
    });
    bar.finish_and_clear();
    outcome
}

/// Appends the rows that other ranks hand in, until each of them has handed in an empty one.
fn receive(ranks: &Ranks, rows: &Rows, bar: &ProgressBar) -> Result<(), ConcealError> {
    let mut working = ranks.size() - 1;
    while working > 0 {
        match ranks.handed_in() {
            None => std::thread::sleep(Duration::from_millis(20)),
            Some(row) if row.is_empty() => working -= 1,
            Some(row) => {
                rows.append(&row)?;
                bar.inc(1);
            }
        }
    }
    Ok(())
}

/// The results file, open for further rows.
struct Rows {
    path: PathBuf,
    file: Mutex<File>,
}

impl Rows {
    fn open(path: &Path) -> Result<Self, ConcealError> {
        let fail = |source| ConcealError::file(path, source);
        let empty = std::fs::metadata(path).map_or(true, |m| m.len() == 0);
        let file = OpenOptions::new().create(true).append(true).open(path).map_err(fail)?;
        let rows = Self { path: path.to_owned(), file: Mutex::new(file) };
        if empty {
            let text = row(&Score::default(), true)?;
            rows.append(text.split_inclusive('\n').next().unwrap_or_default())?;
        }
        Ok(rows)
    }

    fn append(&self, row: &str) -> Result<(), ConcealError> {
        // A panic in another thread cannot leave half a row: a row is written whole.
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        file.write_all(row.as_bytes()).map_err(|source| ConcealError::file(&self.path, source))
    }
}

/// A score as a row of the results file, below the header if that is wanted.
fn row(score: &Score, header: bool) -> Result<String, ConcealError> {
    let fail = |e: &dyn std::fmt::Display| ConcealError::content(Path::new(&score.case), &e.to_string());
    let mut writer = csv::WriterBuilder::new().has_headers(header).from_writer(Vec::new());
    writer.serialize(score).map_err(|e| fail(&e))?;
    let bytes = writer.into_inner().map_err(|e| fail(&e))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Puts the rows of the results file in the order of the plan: they end in another order each time.
fn put_in_order(path: &Path, plan: &[Planned]) -> Result<(), ConcealError> {
    if !path.exists() {
        return Ok(());
    }
    let fail = |e: &dyn std::fmt::Display| ConcealError::content(path, &e.to_string());
    let mut reader = csv::Reader::from_path(path).map_err(|e| fail(&e))?;
    let header = reader.headers().map_err(|e| fail(&e))?.clone();
    let place: HashMap<&str, usize> = plan.iter().enumerate().map(|(i, c)| (c.key.as_str(), i)).collect();
    let case = header.iter().position(|name| name == "case").unwrap_or(0);
    let mut records: Vec<csv::StringRecord> = reader.records().collect::<Result<_, _>>().map_err(|e| fail(&e))?;
    records.sort_by_key(|r| r.get(case).and_then(|key| place.get(key)).copied().unwrap_or(usize::MAX));
    let written = path.with_extension("part");
    let mut writer = csv::Writer::from_path(&written).map_err(|e| fail(&e))?;
    writer.write_record(&header).map_err(|e| fail(&e))?;
    for record in &records {
        writer.write_record(record).map_err(|e| fail(&e))?;
    }
    writer.flush().map_err(|source| ConcealError::file(&written, source))?;
    std::fs::rename(&written, path).map_err(|source| ConcealError::file(path, source))
}

fn summarise(a: &Arguments, scores: &[Score]) -> Result<(), ConcealError> {
    let table = table(&summary(scores));
    println!("{table}");
    let path = a.out.join("summary.csv");
    let mut writer = csv::Writer::from_path(&path).map_err(|e| ConcealError::content(&path, &e))?;
    writer.write_record(table.header()).map_err(|e| ConcealError::content(&path, &e))?;
    for row in table.rows() {
        writer.write_record(row).map_err(|e| ConcealError::content(&path, &e))?;
    }
    writer.flush().map_err(|source| ConcealError::file(&path, source))?;
    let stem = a.out.join("concealed");
    figure(scores).save(&stem).map_err(|e| ConcealError::content(&stem, &e))?;
    Ok(())
}
