//! Runs the campaign of exact injections into real recordings, one row of results a case, and summarises it against the aims.
//! A case with a row is not run again, so that a campaign that was killed continues. The recordings are not part of the project.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;
use trimtab::report::Table;
use trimtab_experiments::folders::{Published, exit};
use trimtab_experiments::injected::answers::failure::failures;
use trimtab_experiments::injected::answers::figure::figure;
use trimtab_experiments::injected::answers::results::{Results, in_order, missing};
use trimtab_experiments::injected::answers::row::Row;
use trimtab_experiments::injected::answers::summary::{by_strength, scored, summary, table};
use trimtab_experiments::injected::error::InjectedError;
use trimtab_experiments::injected::plan::{Planned, SEED, ci_slice, plan, sample};
use trimtab_experiments::injected::runner::Runner;

/// Injects known effects into recordings of real ships, diagnoses them, and compares the answers with the truth.
#[derive(Parser)]
struct Arguments {
    /// Folder for the tables of every answer (`cases.csv`) and its scores (`scores.csv`), and for each case while it runs.
    #[arg(long)]
    out: PathBuf,
    /// Folder for `summary.csv`, `strengths.csv`, the cases with a wrong answer (`failed.csv`) and the figure.
    #[command(flatten)]
    published: Published,
    /// The program that diagnoses, called as `TOOL --threads 1 diagnose STUDY --json`.
    #[arg(long, default_value = "target/release/trimtab")]
    tool: PathBuf,
    /// Cases at a time.
    #[arg(long, default_value_t = 2)]
    workers: usize,
    /// Only cases whose key contains this, such as `marin/null` or `/single/current/x1/`.
    #[arg(long)]
    only: Option<String>,
    /// Only so many cases, drawn by the seed from every set and kind.
    #[arg(long)]
    sample: Option<usize>,
    /// The 12 short cases of every push.
    #[arg(long)]
    slice: bool,
    /// With --only or --sample: the partners of the chosen cases too, so that sizes can be compared as differences.
    #[arg(long)]
    partners: bool,
    /// Seed of the campaign; the published one is used once.
    #[arg(long, default_value_t = SEED)]
    seed: u64,
    /// Longest time for one diagnosis \[s\].
    #[arg(long, default_value_t = 300)]
    limit: u64,
    /// Keep the folders of the cases, for inspection; they contain copies of recordings.
    #[arg(long)]
    keep: bool,
    /// Ask the rivals too, where nothing or one effect of full strength is injected: a refit with the Bayesian information criterion.
    #[arg(long)]
    rivals: bool,
    /// With --rivals: sparse regression too, with this Python, which has `PySINDy` (see experiments/peers).
    #[arg(long, requires = "rivals")]
    sindy: Option<PathBuf>,
    /// Print the plan and stop.
    #[arg(long)]
    list: bool,
    /// Only summarise the rows of the results.
    #[arg(long)]
    summary: bool,
}

fn main() -> ExitCode {
    exit("injected", run(&Arguments::parse()))
}

/// The cases that were asked for.
fn chosen(a: &Arguments, whole: &[Planned]) -> Vec<Planned> {
    let mut cases: Vec<Planned> = if a.slice { ci_slice(whole, a.seed) } else { whole.to_vec() };
    cases.retain(|c| a.only.as_ref().is_none_or(|part| c.key.contains(part.as_str())));
    if let Some(count) = a.sample {
        cases = sample(&cases, count, a.seed);
    }
    if a.partners {
        let wanted: Vec<&String> = cases.iter().filter_map(|c| c.partner.as_ref()).collect();
        let missing = |c: &&Planned| wanted.contains(&&c.key) && !cases.iter().any(|d| d.key == c.key);
        let partners: Vec<Planned> = whole.iter().filter(missing).cloned().collect();
        cases.extend(partners);
    }
    cases
}

fn run(a: &Arguments) -> Result<(), InjectedError> {
    let whole = plan(a.seed)?;
    let cases = chosen(a, &whole);
    if a.list {
        cases.iter().for_each(|c| println!("{:34} {}", c.key, c.configuration.words()));
        println!("{}", counted(&cases));
        return Ok(());
    }
    let path = a.out.join("cases.csv");
    if !a.summary {
        let results = Results::open(&path)?;
        let mut left = missing(&results, &cases)?;
        eprintln!("seed {}: {} cases, {} of them without a row", a.seed, cases.len(), left.len());
        // Drawn order: an unfinished campaign is a fair sample of the whole.
        left.sort_by_key(|c| c.seed);
        execute(a, &left, &results)?;
    }
    let folder = a.published.folder(&a.out).map_err(|source| InjectedError::file(&a.out, source))?;
    summarise(&a.out, folder, &in_order(&path, &whole)?)
}

/// Number of cases by kind and set.
fn counted(cases: &[Planned]) -> Table {
    let mut counts: BTreeMap<(&str, &str), usize> = BTreeMap::new();
    for case in cases {
        for set in [case.configuration.set.name(), "all"] {
            *counts.entry((case.kind.name(), set)).or_default() += 1;
            *counts.entry(("all", set)).or_default() += 1;
        }
    }
    let mut kinds: Vec<&str> = cases.iter().map(|c| c.kind.name()).collect();
    kinds.dedup();
    let mut seen = Vec::new();
    kinds.retain(|k| {
        !seen.contains(k) && {
            seen.push(k);
            true
        }
    });
    let mut table = Table::new(["kind", "marin", "hsva", "esso", "all"]);
    for kind in kinds.into_iter().chain(["all"]) {
        let count = |set: &str| counts.get(&(kind, set)).copied().unwrap_or(0).to_string();
        table.row([kind.to_owned(), count("marin"), count("hsva"), count("esso"), count("all")]);
    }
    table
}

fn execute(a: &Arguments, cases: &[Planned], results: &Results) -> Result<(), InjectedError> {
    let runner = Runner {
        tool: a.tool.clone(),
        limit: Duration::from_secs(a.limit),
        folder: a.out.join("cases"),
        keep: a.keep,
        rivals: a.rivals,
        sindy: a.sindy.clone(),
    };
    let bar = ProgressBar::new(cases.len() as u64);
    if let Ok(style) = ProgressStyle::with_template("{pos}/{len} {wide_bar} {eta} {msg}") {
        bar.set_style(style);
    }
    let outcome = runner.all(cases, a.workers, &|row| {
        bar.set_message(row.case.clone());
        bar.inc(1);
        Ok(results.append(&row)?)
    });
    bar.finish_and_clear();
    outcome
}

fn write(path: &Path, table: &Table) -> Result<(), InjectedError> {
    let mut writer = csv::Writer::from_path(path).map_err(|e| InjectedError::content(path, &e))?;
    writer.write_record(table.header()).map_err(|e| InjectedError::content(path, &e))?;
    for row in table.rows() {
        writer.write_record(row).map_err(|e| InjectedError::content(path, &e))?;
    }
    writer.flush().map_err(|source| InjectedError::file(path, source))
}

/// Writes rows with a header.
fn list<T: Serialize>(path: &Path, rows: &[T]) -> Result<(), InjectedError> {
    let mut writer = csv::Writer::from_path(path).map_err(|e| InjectedError::content(path, &e))?;
    rows.iter().try_for_each(|row| writer.serialize(row)).map_err(|e| InjectedError::content(path, &e))?;
    writer.flush().map_err(|source| InjectedError::file(path, source))
}

fn summarise(out: &Path, folder: &Path, rows: &[Row]) -> Result<(), InjectedError> {
    let (aims, strengths) = (table(&summary(rows)), by_strength(rows));
    println!("{aims}\n{strengths}");
    write(&folder.join("summary.csv"), &aims)?;
    write(&folder.join("strengths.csv"), &strengths)?;
    let scored = scored(rows);
    list(&out.join("scores.csv"), &scored.iter().map(|(_, score)| score).collect::<Vec<_>>())?;
    list(&folder.join("failed.csv"), &failures(&scored))?;
    let stem = folder.join("injected");
    figure(rows).save(&stem).map_err(|e| InjectedError::content(&stem, &e))?;
    Ok(())
}
