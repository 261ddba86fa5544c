//! `trimtab split`: one long log, or the recordings of a study, into runs.
//! The library finds manoeuvres, sessions and sides; this file reads the arguments, prints and writes the table.

use crate::cli::shared::answer::Answer;
use crate::cli::shared::error::CliError;
use crate::cli::shared::output::{Output, OutputArgs};
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use trimtab::numbers::numerals::fixed;
use trimtab::recording::import::moment;
use trimtab::recording::split::{Kind, Sessions, SplitPart, SplitRun, SplitSettings, TestBy, runs_csv, split};
use trimtab::recording::{ColumnMap, Recording, Split};
use trimtab::report::Table;
use trimtab::study::{Study, StudyError};

const LONG: &str = "\
Splits recordings into runs by what is done with rudder and propeller and how the ship turns:
  straight  rudder amidships, speed steady
  approach  rudder amidships, speed changing by more than 8 %
  turn      rudder beyond 6 deg to one side while the heading changes by more than 80 deg
  zigzag    rudder put over at least three times, from side to side
  stop      propeller stopped or astern while the ship moves
  free      anything else

A run ends at every gap and missing value, and begins shortly before the rudder moves. Long runs are \
    cut into pieces. Train and test are drawn by block: a manoeuvre with all its pieces comes to one \
    side, and the test blocks of each kind are spread over time. If a test share is asked for, there is \
    a test run.";

const AFTER: &str = "\
Examples:
  trimtab split study/study.toml
  trimtab split study/study.toml --test 0.3 --sessions dates --out study
  trimtab split recordings/log.csv --longest 240 --out runs

For STUDY the recordings that it lists are split anew, each whole, with its column map. With --out: \
    runs.csv, to be named as `runs` in the study, and split.json.
JSON: result.runs[] with file, name, session, manoeuvre, split, from, to [s] and seen; result.skipped, \
    the stretches between gaps that are too short for a run.";

/// How recordings are split.
#[derive(Clone, Debug, clap::Args)]
pub struct SplitArgs {
    /// Share of the blocks to test on, 0 for none.
    #[arg(long, value_name = "SHARE", default_value_t = 0.25)]
    test: f64,
    /// What comes to one side as a whole: block (a manoeuvre) or session.
    #[arg(long, value_name = "WHAT", default_value = "block", value_parser = ["block", "session"])]
    by: String,
    /// How sessions are separated: gaps, gaps=SECONDS, dates, files, or a pattern of file names with `{}` for the session.
    #[arg(long, value_name = "HOW")]
    sessions: Option<String>,
    /// Longest run [s]; forty times the time in which the ship turns ten degrees if not given.
    #[arg(long, value_name = "S")]
    longest: Option<f64>,
}

impl SplitArgs {
    /// The settings.
    pub fn settings(&self) -> Result<SplitSettings, CliError> {
        let sessions =
            self.sessions.as_deref().map_or(Ok(Sessions::Known), Sessions::parse).map_err(CliError::Argument)?;
        let by = if self.by == "session" { TestBy::Session } else { TestBy::Block };
        Ok(SplitSettings { test: self.test, by, sessions, longest: self.longest })
    }
}

/// Splits a long log into runs: straight, turn, zigzag, stop, approach, free
#[derive(Debug, clap::Args)]
#[command(long_about = LONG, after_long_help = AFTER)]
pub struct Args {
    /// A study (TOML), or a recording (CSV in the project's own form).
    #[arg(value_name = "STUDY-or-RECORDING")]
    input: PathBuf,
    /// Column map of the recording.
    #[arg(long, value_name = "FILE")]
    column_map: Option<PathBuf>,
    #[command(flatten)]
    split: SplitArgs,
    #[command(flatten)]
    output: OutputArgs,
}

#[derive(Serialize)]
struct Report<'a> {
    runs: &'a [SplitRun],
    skipped: usize,
}

/// A recording with its file as the table names it.
struct Part {
    file: String,
    session: Option<String>,
    start: Option<f64>,
    recording: Recording,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<Answer, CliError> {
    let mut output = Output::new("split", &args.output)?;
    let settings = args.split.settings()?;
    let is_study = args.input.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"));
    let parts = if is_study { of_study(args, &mut output)? } else { vec![of_recording(args, &mut output)?] };
    let borrowed: Vec<SplitPart<'_>> = parts
        .iter()
        .map(|p| SplitPart {
            file: p.file.clone(),
            session: p.session.clone(),
            start: p.start,
            recording: &p.recording,
        })
        .collect();
    let (runs, skipped) = split(&borrowed, &settings)
        .map_err(|error| CliError::Argument(format!("{}: {error}", args.input.display())))?;
    output.file("runs.csv", runs_csv(&runs).as_bytes());
    let mut table = Table::new(["run", "session", "split", "from [s]", "to [s]", "seen"]);
    for run in &runs {
        let side = if run.split == Split::Test { "test" } else { "train" };
        let times = [run.from, run.to].map(|t| fixed(t, 1));
        let [from, to] = times;
        table.row([run.name.clone(), run.session.clone(), side.to_owned(), from, to, run.seen.clone()]);
    }
    let next = match (&args.output.out, is_study) {
        (None, _) => "\nWith --out FOLDER the table is written as runs.csv.".to_owned(),
        (Some(folder), true) if Some(folder.as_path()) != args.input.parent() => {
            format!("\nSet `runs = \"{}\"` in {}.", absolute(&folder.join("runs.csv")).display(), args.input.display())
        }
        _ => String::new(),
    };
    output.finish(&format!("{table}\n\n{}{next}", by_kind(&runs, skipped)), &Report { runs: &runs, skipped })?;
    Ok(Answer::Yes)
}

/// The recordings that a study lists, each once and whole.
fn of_study(args: &Args, output: &mut Output) -> Result<Vec<Part>, CliError> {
    let study = Study::read(&args.input)?;
    output.reads_files(&study.files());
    // A file in the table is looked for in the folders of `data`, where the study has these.
    let data = std::fs::read_to_string(&args.input).ok().and_then(|text| text.parse::<toml::Table>().ok());
    let has_data = data.is_some_and(|table| table.contains_key("data"));
    let folder = args.input.parent().unwrap_or(Path::new(""));
    let starts = starts(folder, output);
    let mut parts: Vec<Part> = Vec::new();
    let mut seen: Vec<PathBuf> = Vec::new();
    for listed in &study.runs {
        if seen.contains(&listed.file) {
            continue;
        }
        seen.push(listed.file.clone());
        let own = |other: &&trimtab::study::Listed| other.file == listed.file;
        let mut sessions: Vec<&String> = study.runs.iter().filter(own).map(|l| &l.labels.session).collect();
        sessions.dedup();
        let session = Some(listed.labels.session.clone()).filter(|s| sessions.len() == 1 && s != "unnamed");
        let relative = listed.file.strip_prefix(folder).ok().filter(|_| !has_data);
        let file = relative.map_or_else(|| absolute(&listed.file), Path::to_owned).to_string_lossy().replace('\\', "/");
        let start = listed.file.file_stem().and_then(|stem| starts.get(&*stem.to_string_lossy())).copied();
        parts.push(Part { file, session, start, recording: study.recording(listed)? });
    }
    output.reads_files(&seen);
    // Gaps are between those that follow one another in time.
    if parts.iter().all(|p| p.start.is_some()) {
        parts.sort_by(|a, b| a.start.unwrap_or(0.0).total_cmp(&b.start.unwrap_or(0.0)));
    }
    Ok(parts)
}

/// When the recordings of a study began \[s\], by their names, as its import wrote it beside the study.
fn starts(folder: &Path, output: &mut Output) -> BTreeMap<String, f64> {
    let path = folder.join("import.json");
    let Some(report) = std::fs::read(&path).ok().and_then(|bytes| serde_json::from_slice::<Value>(&bytes).ok()) else {
        return BTreeMap::new();
    };
    output.reads_files(&[path]);
    let start = |recording: &Value| {
        let seconds = moment(recording.get("start")?.as_str()?)?;
        Some((recording.get("name")?.as_str()?.to_owned(), seconds))
    };
    report["result"]["recordings"].as_array().into_iter().flatten().filter_map(start).collect()
}

fn of_recording(args: &Args, output: &mut Output) -> Result<Part, CliError> {
    output.reads_files(std::slice::from_ref(&args.input));
    let map = args.column_map.as_deref().map_or_else(|| Ok(ColumnMap::default()), ColumnMap::read);
    let recording = map.and_then(|map| Recording::read(&args.input, &map)).map_err(StudyError::from)?;
    let file = absolute(&args.input).to_string_lossy().replace('\\', "/");
    Ok(Part { file, session: None, start: None, recording })
}

fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

/// Counts and minutes of the kinds of runs on either side, as a table, and what was left out.
pub fn by_kind(runs: &[SplitRun], skipped: usize) -> String {
    let mut kinds: BTreeMap<Kind, [(usize, f64); 2]> = BTreeMap::new();
    for run in runs {
        let (count, seconds) = &mut kinds.entry(run.manoeuvre).or_default()[usize::from(run.split == Split::Test)];
        *count += 1;
        *seconds += run.to - run.from;
    }
    let mut table = Table::new(["manoeuvre", "train runs", "minutes", "test runs", "minutes"]);
    for (kind, [train, test]) in &kinds {
        let minutes = |s: f64| fixed(s / 60.0, 1);
        table.row([kind.word().to_owned(), train.0.to_string(), minutes(train.1), test.0.to_string(), minutes(test.1)]);
    }
    let mut sessions: Vec<&str> = runs.iter().map(|r| r.session.as_str()).collect();
    sessions.sort_unstable();
    sessions.dedup();
    let short =
        if skipped > 0 { format!("; stretches between gaps too short for a run: {skipped}") } else { String::new() };
    let test = runs.iter().filter(|r| r.split == Split::Test).count();
    let sides =
        format!("Runs to train on: {}, to test on: {test}; sessions: {}{short}.", runs.len() - test, sessions.len());
    format!("{table}\n{sides}\n")
}
