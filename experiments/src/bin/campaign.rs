//! Runs the campaign of concealed cases, one row of results a case, and summarises them against the aims.
//! A case with a row in the results file is not run again, so that an interrupted campaign can be continued.

use std::collections::BTreeSet;
use std::fs::OpenOptions;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Mutex;
use std::time::Duration;

use clap::{Parser, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};
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
    /// Cases at a time.
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
    exit("campaign", run(&Arguments::parse()))
}

fn run(a: &Arguments) -> Result<(), ConcealError> {
    let mut plan = plan(a.seed);
    if a.slice == Slice::Ci {
        plan = ci_slice(&plan);
    }
    plan.retain(|c| a.only.as_ref().is_none_or(|part| c.key.contains(part.as_str())));
    if a.list {
        plan.iter().for_each(|c| println!("{:9} {}", c.arm, c.key));
        return Ok(());
    }
    std::fs::create_dir_all(&a.out).map_err(|source| ConcealError::file(&a.out, source))?;
    let results = a.out.join("cases.csv");
    if !a.summary {
        let done: BTreeSet<String> = read(&results)?.into_iter().map(|s| s.case).collect();
        plan.retain(|c| !done.contains(&c.key));
        // The first case of every kind, then the second: an unfinished campaign is a fair sample of the whole.
        plan.sort_by_key(|c| c.key.rsplit('/').next().and_then(|i| i.parse::<usize>().ok()));
        plan.truncate(a.most.unwrap_or(usize::MAX));
        if !plan.is_empty() {
            execute(a, &plan, &results)?;
        }
    }
    summarise(a, &read(&results)?)
}

/// The rows of the results file; none without a file.
fn read(path: &Path) -> Result<Vec<Score>, ConcealError> {
    if !path.exists() {
        return Ok(Vec::new());
    }
    let mut reader = csv::Reader::from_path(path).map_err(|e| ConcealError::content(path, &e))?;
    reader.deserialize().collect::<Result<_, _>>().map_err(|e| ConcealError::content(path, &e))
}

/// Runs the cases of `plan` and appends a row for each finished case.
fn execute(a: &Arguments, plan: &[Planned], results: &Path) -> Result<(), ConcealError> {
    let header = !results.exists();
    let file = OpenOptions::new()
        .create(true)
        .append(true)
        .open(results)
        .map_err(|source| ConcealError::file(results, source))?;
    let writer = Mutex::new(csv::WriterBuilder::new().has_headers(header).from_writer(file));
    let bar = ProgressBar::new(plan.len() as u64);
    if let Ok(style) = ProgressStyle::with_template("{pos}/{len} {wide_bar} {eta} {msg}") {
        bar.set_style(style);
    }
    let runner = Runner {
        tool: a.tool.clone(),
        limit: Duration::from_secs(a.limit),
        folder: a.out.join("cases"),
        keep: a.keep,
        baselines: !a.alone,
        sindy: a.sindy.clone(),
    };
    let outcome = runner.all(plan, a.workers, &|score| {
        bar.set_message(score.case.clone());
        bar.inc(1);
        // A panic in another thread cannot leave half a row: the writer writes whole rows.
        let mut writer = writer.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        writer.serialize(&score).and_then(|()| Ok(writer.flush()?)).map_err(|e| ConcealError::content(results, &e))
    });
    bar.finish_and_clear();
    outcome
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
