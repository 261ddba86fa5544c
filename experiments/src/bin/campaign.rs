//! Runs the campaign of concealed cases, one row of results a case, and summarises them against the aims.
//! A case with a row in the results file is not run again, so that an interrupted campaign can be continued.

use std::collections::BTreeSet;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use clap::{Parser, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};
use trimtab::files::progress::Teller;
use trimtab::files::ranks::Ranks;
use trimtab::files::{Lock, write_whole};
use trimtab_experiments::conceal::campaign::arms::failed;
use trimtab_experiments::conceal::campaign::calibration::calibration;
use trimtab_experiments::conceal::campaign::figure::figure;
use trimtab_experiments::conceal::campaign::plan::{PUSH_SEED, Planned, SEED, ci_slice, plan};
use trimtab_experiments::conceal::campaign::rows::{Rows, listed, put_in_order, read, row};
use trimtab_experiments::conceal::campaign::summary::{summary, table};
use trimtab_experiments::conceal::error::ConcealError;
use trimtab_experiments::conceal::judge::score::Score;
use trimtab_experiments::conceal::runner::Runner;
use trimtab_experiments::folders::{Published, exit};

/// Makes, diagnoses and judges concealed cases, and compares the scores with the aims.
#[derive(Parser)]
struct Arguments {
    /// Folder for the table of every answer (`cases.csv`) and for each case while it runs.
    #[arg(long, default_value = "target/concealed")]
    out: PathBuf,
    /// Folder for `summary.csv`, the cases with a wrong answer (`failed.csv`) and two figures.
    #[command(flatten)]
    published: Published,
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
    /// Seed of the campaign; that of the committed one if not given, and for the cases of every push that of an earlier one.
    #[arg(long)]
    seed: Option<u64>,
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
    /// The 13 cases of every push.
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
    let whole = plan(a.seed.unwrap_or(if a.slice == Slice::Ci { PUSH_SEED } else { SEED }));
    let mut plan = if a.slice == Slice::Ci { ci_slice(&whole) } else { whole.clone() };
    plan.retain(|c| a.only.as_ref().is_none_or(|part| c.key.contains(part.as_str())));
    if a.list {
        plan.iter().filter(|_| ranks.is_first()).for_each(|c| println!("{:9} {}", c.arm, c.key));
        return Ok(());
    }
    let results = a.out.join("cases.csv");
    let mut lock = None;
    if !a.summary {
        // What the first rank finds done counts: the others may see the file later.
        let begun = if ranks.is_first() { Some(begin(&a.out, &results)?) } else { None };
        let own = begun.as_ref().map_or_else(BTreeSet::new, |(_, _, done)| done.clone());
        let done = ranks.gather(&own).swap_remove(0);
        plan.retain(|c| !done.contains(&c.key));
        // The first case of every kind, then the second: an unfinished campaign is a fair sample of the whole.
        plan.sort_by_key(|c| c.key.rsplit('/').next().and_then(|i| i.parse::<usize>().ok()));
        plan.truncate(a.most.unwrap_or(usize::MAX));
        if !plan.is_empty() {
            execute(a, ranks, &plan, begun.as_ref().map(|(_, rows, _)| rows))?;
        }
        lock = begun.map(|(lock, _, _)| lock);
    }
    if !ranks.is_first() {
        return Ok(());
    }
    // While another campaign appends rows, they are counted and left in their order.
    if lock.or_else(|| Lock::take(&a.out).ok()).is_some() {
        put_in_order(&results, &whole)?;
    }
    summarise(a, &read(&results)?)
}

/// Makes the folder of the results, which no other campaign may write into meanwhile, and finds the cases that have a row.
fn begin(folder: &Path, results: &Path) -> Result<(Lock, Rows, BTreeSet<String>), ConcealError> {
    std::fs::create_dir_all(folder).map_err(|source| ConcealError::file(folder, source))?;
    let lock = Lock::take(folder).map_err(|e| ConcealError::content(folder, &e))?;
    let (rows, done) = Rows::open(results)?;
    Ok((lock, rows, done))
}

/// Runs the cases of `plan`, dealt out to the ranks; the first rank appends a row as each case ends, wherever it ran.
fn execute(a: &Arguments, ranks: &Ranks, plan: &[Planned], rows: Option<&Rows>) -> Result<(), ConcealError> {
    let runner = Runner {
        tool: a.tool.clone(),
        limit: Duration::from_secs(a.limit),
        folder: a.out.join("cases"),
        keep: a.keep,
        baselines: !a.alone,
        sindy: a.sindy.clone(),
    };
    let own: Vec<Planned> = plan.iter().enumerate().filter(|(i, _)| ranks.takes(*i)).map(|(_, c)| c.clone()).collect();
    let Some(rows) = rows else {
        runner.all(&own, a.workers, &|score| {
            ranks.hand_in(&row(&score)?);
            Ok(())
        })?;
        ranks.hand_in("");
        return Ok(());
    };
    let bar = Bar::new(plan.len());
    let outcome = std::thread::scope(|scope| {
        let others = scope.spawn(|| receive(ranks, rows, &bar));
        let own = runner.all(&own, a.workers, &|score| {
            rows.append(&row(&score)?)?;
            bar.ended(&score.case);
            Ok(())
        });
        if let Err(error) = own {
            // The others are not waited for: their rows so far are in the file.
            return if ranks.size() > 1 { ranks.fail(&error.to_string()) } else { Err(error) };
        }
        others.join().unwrap_or_else(|_| Err(ConcealError::content(&a.out, &"the rows of other ranks were lost")))
    });
    drop(bar);
    outcome
}

/// Appends the rows that other ranks hand in, until each of them has handed in an empty one.
fn receive(ranks: &Ranks, rows: &Rows, bar: &Bar) -> Result<(), ConcealError> {
    let mut working = ranks.size() - 1;
    while working > 0 {
        match ranks.handed_in() {
            None => std::thread::sleep(Duration::from_millis(20)),
            Some(row) if row.is_empty() => working -= 1,
            Some(row) => {
                rows.append(&row)?;
                bar.ended("");
            }
        }
    }
    Ok(())
}

/// How far the campaign is, on standard error: a bar on a terminal, a line a minute elsewhere.
struct Bar {
    bar: ProgressBar,
    teller: Option<Teller>,
    ended: AtomicUsize,
    of: usize,
}

impl Bar {
    fn new(of: usize) -> Self {
        if !std::io::stderr().is_terminal() {
            let teller = Some(Teller::new("campaign", &format!("0 of {of} cases")));
            return Self { bar: ProgressBar::hidden(), teller, ended: AtomicUsize::new(0), of };
        }
        let bar = ProgressBar::new(of as u64);
        if let Ok(style) = ProgressStyle::with_template("{pos}/{len} {wide_bar} {eta} {msg}") {
            bar.set_style(style);
        }
        Self { bar, teller: None, ended: AtomicUsize::new(0), of }
    }

    /// A case has ended, and its row is written.
    fn ended(&self, case: &str) {
        let (ended, of) = (self.ended.fetch_add(1, Ordering::Relaxed) + 1, self.of);
        self.bar.set_message(case.to_owned());
        self.bar.inc(1);
        if let Some(teller) = &self.teller {
            teller.say(&format!("{ended} of {of} cases"));
            teller.part(ended, of);
        }
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

fn summarise(a: &Arguments, scores: &[Score]) -> Result<(), ConcealError> {
    let table = table(&summary(scores));
    println!("{table}");
    let folder = a.published.folder(&a.out).map_err(|source| ConcealError::file(&a.out, source))?;
    let path = folder.join("failed.csv");
    let failures = listed(scores.iter().filter(|s| failed(s)))?;
    write_whole(&path, failures.as_bytes()).map_err(|source| ConcealError::file(&path, source))?;
    let path = folder.join("summary.csv");
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(table.header()).map_err(|e| ConcealError::content(&path, &e))?;
    for row in table.rows() {
        writer.write_record(row).map_err(|e| ConcealError::content(&path, &e))?;
    }
    let text = writer.into_inner().map_err(|e| ConcealError::content(&path, &e))?;
    write_whole(&path, &text).map_err(|source| ConcealError::file(&path, source))?;
    for (name, figure) in [("concealed", figure(scores)), ("calibration", calibration(scores))] {
        let stem = folder.join(name);
        figure.save(&stem).map_err(|e| ConcealError::content(&stem, &e))?;
    }
    Ok(())
}
