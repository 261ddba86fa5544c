//! Runs the campaign of concealed cases: conceal, diagnose in a process of its own, judge, one row a case; then the summary.
//! Finished cases are in the results file and are not run again, so that an interrupted campaign goes on where it stopped.

use std::collections::BTreeSet;
use std::fs::OpenOptions;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use clap::{Parser, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};
use trimtab_experiments::conceal::campaign::{self, Planned, SEED};
use trimtab_experiments::conceal::judge::{Diagnosis, Score, baseline_right, judge};
use trimtab_experiments::conceal::meter::DiagnosisMeter;
use trimtab_experiments::conceal::strength::Meter;
use trimtab_experiments::conceal::{Case, ConcealError, Strength, seal};

/// Makes, diagnoses and judges concealed cases, and compares the scores with the targets.
#[derive(Parser)]
struct Arguments {
    /// Folder for the results (`cases.csv`, `summary.csv`, the figure) and for cases while they run.
    #[arg(long, default_value = "figures/concealed")]
    out: PathBuf,
    /// The program that diagnoses, called as `TOOL diagnose STUDY --out DIR`.
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
    /// Keep the folders of the cases, for the baselines in `experiments/peers` and for looking.
    #[arg(long)]
    keep: bool,
    /// Also ask sparse regression: this Python has PySINDy (see experiments/peers).
    #[arg(long, value_name = "PYTHON")]
    sindy: Option<PathBuf>,
    /// Print the plan and stop.
    #[arg(long)]
    list: bool,
    /// Only summarise the results there are.
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
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("campaign: {e}");
            ExitCode::from(2)
        }
    }
}

fn content(path: &Path, e: &dyn std::fmt::Display) -> ConcealError {
    ConcealError::Content { path: path.to_owned(), message: e.to_string() }
}

fn run(a: &Arguments) -> Result<(), ConcealError> {
    let mut plan = campaign::plan(a.seed);
    if a.slice == Slice::Ci {
        plan = campaign::ci_slice(&plan);
    }
    plan.retain(|c| a.only.as_ref().is_none_or(|part| c.key.contains(part.as_str())));
    if a.list {
        plan.iter().for_each(|c| println!("{:9} {}", c.arm, c.key));
        return Ok(());
    }
    std::fs::create_dir_all(&a.out).map_err(|source| ConcealError::File { path: a.out.clone(), source })?;
    let results = a.out.join("cases.csv");
    if !a.summary {
        let done: BTreeSet<String> = read(&results)?.into_iter().map(|s| s.case).collect();
        plan.retain(|c| !done.contains(&c.key));
        plan.truncate(a.most.unwrap_or(usize::MAX));
        if !plan.is_empty() {
            sail(a, &plan, &results)?;
        }
    }
    summarise(a, &read(&results)?)
}

/// The rows so far; none when there is no file yet.
fn read(path: &Path) -> Result<Vec<Score>, ConcealError> {
    if !path.exists() {
        return Ok(Vec::new());
    }
    let mut reader = csv::Reader::from_path(path).map_err(|e| content(path, &e))?;
    reader.deserialize().collect::<Result<_, _>>().map_err(|e| content(path, &e))
}

/// Runs the cases of `plan` and appends a row for each as it is finished.
fn sail(a: &Arguments, plan: &[Planned], results: &Path) -> Result<(), ConcealError> {
    if !a.tool.is_file() {
        let message = "the program that diagnoses is not there; `cargo build --release`, or give --tool";
        return Err(content(&a.tool, &message));
    }
    let header = !results.exists();
    let file = OpenOptions::new()
        .create(true)
        .append(true)
        .open(results)
        .map_err(|source| ConcealError::File { path: results.to_owned(), source })?;
    let writer = Mutex::new(csv::WriterBuilder::new().has_headers(header).from_writer(file));
    let failed = Mutex::new(None);
    let next = AtomicUsize::new(0);
    let bar = ProgressBar::new(plan.len() as u64);
    if let Ok(style) = ProgressStyle::with_template("{pos}/{len} {wide_bar} {eta} {msg}") {
        bar.set_style(style);
    }
    std::thread::scope(|scope| {
        for _ in 0..a.workers.max(1) {
            scope.spawn(|| {
                // A meter of its own: it keeps what it fitted last, and two cases at a time would take turns.
                let meter = match DiagnosisMeter::new() {
                    Ok(meter) => meter,
                    Err(e) => {
                        if let Ok(mut slot) = failed.lock() {
                            *slot = Some(e);
                        }
                        return;
                    }
                };
                while let Some(case) = plan.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let score = one(a, case, &meter);
                    bar.set_message(case.key.clone());
                    bar.inc(1);
                    let written = writer.lock().map(|mut w| w.serialize(&score).and_then(|()| Ok(w.flush()?)));
                    if let (Ok(Err(e)), Ok(mut slot)) = (written, failed.lock()) {
                        *slot = Some(content(results, &e));
                        return;
                    }
                }
            });
        }
    });
    bar.finish_and_clear();
    match failed.into_inner() {
        Ok(Some(e)) => Err(e),
        _ => Ok(()),
    }
}

/// One case from start to score; what goes wrong becomes the row's error.
fn one(a: &Arguments, planned: &Planned, meter: &dyn Meter) -> Score {
    let folder = a.out.join("cases").join(planned.key.replace('/', "_"));
    let outcome = attempt(a, planned, meter, &folder);
    if !a.keep {
        // Left behind only when the system refuses; the next call writes over it.
        let _ = std::fs::remove_dir_all(&folder);
    }
    let mut score = outcome.unwrap_or_else(|e| Score {
        family: planned.spec.family.name().to_owned(),
        effects: planned.spec.effects.iter().map(|e| e.0.as_str()).collect::<Vec<_>>().join("+"),
        background: planned.spec.background.name().to_owned(),
        design: planned.spec.design.name().to_owned(),
        contrast: planned.spec.contrast,
        seed: planned.spec.seed,
        error: e.to_string(),
        ..Score::default()
    });
    score.case.clone_from(&planned.key);
    score.arm = planned.arm.to_owned();
    score.snr_asked = planned.spec.effects.iter().find_map(|(_, s)| match s {
        Strength::Snr(snr) => Some(*snr),
        _ => None,
    });
    score
}

fn attempt(a: &Arguments, planned: &Planned, meter: &dyn Meter, folder: &Path) -> Result<Score, ConcealError> {
    let study = Case::make(&planned.spec, meter)?.write(folder)?;
    let answer = folder.join("answer");
    let began = Instant::now();
    let mut command = Command::new(&a.tool);
    command.arg("--threads").arg("1").arg("diagnose").arg(&study).arg("--out").arg(&answer);
    finish(command, &a.tool, Duration::from_secs(a.limit))?;
    let seconds = began.elapsed().as_secs_f64();
    let diagnosis = Diagnosis::read(&answer.join("diagnosis.json"))?;
    let manifest = seal::open(folder)?;
    let mut score = judge(&manifest, &diagnosis);
    score.seconds = Some(seconds);
    if let Some(python) = &a.sindy {
        let mut command = Command::new(python);
        command.arg("experiments/peers/sindy.py").arg(folder);
        let said = finish(command, python, Duration::from_secs(a.limit))?;
        score.sindy_named = said.lines().last().unwrap_or_default().trim().to_owned();
        score.sindy_right = Some(baseline_right(&manifest, &score.sindy_named));
    }
    Ok(score)
}

/// Runs a command to its end, at most `limit`; gives what it printed. Exit code 1 is an answer, not a failure.
fn finish(mut command: Command, program: &Path, limit: Duration) -> Result<String, ConcealError> {
    let file = |source| ConcealError::File { path: program.to_owned(), source };
    // Output goes through files: a pipe that nobody reads would stop a talkative program.
    let temporary = || tempfile::tempfile().map_err(file);
    let (mut out, mut err) = (temporary()?, temporary()?);
    let copy = |f: &std::fs::File| f.try_clone().map(Stdio::from).map_err(file);
    let mut child = command.stdin(Stdio::null()).stdout(copy(&out)?).stderr(copy(&err)?).spawn().map_err(file)?;
    let began = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().map_err(file)? {
            break status;
        }
        if began.elapsed() > limit {
            child.kill().map_err(file)?;
            child.wait().map_err(file)?;
            return Err(content(program, &format!("stopped after {} s", limit.as_secs())));
        }
        std::thread::sleep(Duration::from_millis(10));
    };
    let text = |f: &mut std::fs::File| -> Result<String, ConcealError> {
        use std::io::{Read, Seek, SeekFrom};
        let mut text = String::new();
        f.seek(SeekFrom::Start(0)).map_err(file)?;
        f.read_to_string(&mut text).map_err(file)?;
        Ok(text)
    };
    if matches!(status.code(), Some(0 | 1)) {
        return text(&mut out);
    }
    let last = text(&mut err)?;
    Err(content(program, &format!("{status}: {}", last.lines().last().unwrap_or_default())))
}

fn summarise(a: &Arguments, scores: &[Score]) -> Result<(), ConcealError> {
    let lines = campaign::summary(scores);
    let table = campaign::table(&lines);
    println!("{table}");
    let path = a.out.join("summary.csv");
    let mut writer = csv::Writer::from_path(&path).map_err(|e| content(&path, &e))?;
    writer.write_record(table.header()).map_err(|e| content(&path, &e))?;
    for row in table.rows() {
        writer.write_record(row).map_err(|e| content(&path, &e))?;
    }
    writer.flush().map_err(|source| ConcealError::File { path, source })?;
    let stem = a.out.join("concealed");
    campaign::figure(scores).save(&stem).map_err(|e| content(&stem, &e))?;
    Ok(())
}
