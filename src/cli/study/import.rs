//! `trimtab import`: makes a whole study of what ships and loggers write.
//! The library reads, decides and splits; this file reads the arguments, writes the study and says what was found.

use super::split::{SplitArgs, by_kind};
use crate::cli::shared::answer::Answer;
use crate::cli::shared::error::CliError;
use crate::cli::shared::output::{Output, OutputArgs};
use crate::cli::shared::progress::progress;
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use trimtab::model::Model;
use trimtab::numbers::numerals::{fixed, sig};
use trimtab::recording::import::{
    Choices, ImportSettings, Imported, Origins, Taken, Unused, import, recording_csv, study_files,
};
use trimtab::recording::split::{Sessions, SplitError, SplitPart, SplitRun, runs_csv, shortest_run, split, whole_csv};
use trimtab::recording::{ColumnMap, Driven, Recording};
use trimtab::report::Table;
use trimtab::ship::Ship;

const LONG: &str = "\
Makes a study folder of the files that ships and loggers write, so that `trimtab check` and \
    `trimtab fit` can follow: recordings in SI units, column map, table of runs, ship, model and study.

Reads, by content and not by name:
  text        commas, semicolons, tabs, upright strokes or blanks; decimal points or commas; times as
              ISO 8601, with the name of the month, date and time apart, in six columns from year to
              second, of twelve hours, with the day of the year, seconds or milliseconds since 1970,
              days of a spreadsheet or of MATLAB, or seconds from any start (another unit by --unit
              t=ms); a zone in the name of the column, Time (UTC+2), is taken out; latitude and
              longitude in degrees, whole 1e-7 deg, radians or minutes by their unit, as dddmm.mmm or as
              51°30.25'N; two columns of one name are two columns, Heading and Heading (2); letters of the hemisphere or of the rudder's side beside the number or in a
              column of their own; fields may be empty, and each column may have its own rate; a time
              that starts again begins another recording
  NMEA 0183   RMC GGA GLL VTG HDT THS HDG HDM ROT RSA RPM VHW VBW MWV MWD VWR DPT ZDA; checksums are
              verified, a time before each sentence is used, and two talkers are two columns
  Parquet     flat columns of numbers, timestamps or text, if the program was built with
              `cargo build --release --features parquet`

The answer lists what each column is taken for, with the evidence. Of several columns for one quantity the one is \
    taken whose name says it most fully, and which agrees with the data. Units and signs are decided from the data \
    where they determine them: heading and course by the track, speed by the speed of the track, yaw rate by the \
    heading, rudder by its size and by the way the ship turns, propeller rate by its size. What stands in the place \
    of a unit and is none that is known is asked for. Of two columns of one actuator that names do not part, the one \
    that leads the other and leaps faster is the order. What the data do not determine is asked for, everything in \
    one message.

Positions become metres sailed north and east on WGS84. Without u and v these \
    are u = SOG cos(COG - heading), v = SOG sin(COG - heading), over ground at the antenna, or derived \
    from position and heading; `reference_point` in columns.toml takes them to midship.

No gap is filled, but by --bridge and from channels with the same content (the yaw rate from the heading): \
    a row without a value keeps an empty field, a gap longer than --session-gap ends a recording, and a run \
    ends at every gap; the answer says what that costs. A clock that goes forward by whole hours while the ship sails on \
    (summer time), or back by twelve (no AM and PM), is counted on, with a note. Any other clock that steps back, and a \
    second file over the same time, make a recording of their own. Channels of other rates are brought to the rows of the slower \
    of position and heading: a faster one as its mean over a step, a slower one on straight lines between \
    two successive samples.";

const AFTER: &str = "\
Examples:
  trimtab import log.csv --out study
  trimtab import day1.nmea day2.nmea --ship ship.toml --antenna=-12,0.5 --out study
  trimtab import log.csv --column delta=helm_fb --unit n=rpm --out study
  trimtab import cat.csv --ship cat.toml --actuator port=thr_left --actuator starboard=thr_right --out study

ship.toml and model.toml are written if they are not there yet; a ship file that is not complete is \
    refused by the next command with a list of what is missing.

In STUDY: study.toml, ship.toml, model.toml, columns.toml, runs.csv, recordings/, import.json.
JSON: result.study, result.files[], result.taken[] (quantity, column, unit, evidence, samples, step), \
    result.unused[], result.notes[], result.origin (latitude and longitude [deg]), result.velocity, \
    result.recordings[] (name, start, rows, step [s], duration [s], channels[]), result.runs[] and \
    result.skipped.";

/// Makes a study of logs: CSV, NMEA 0183, Parquet
#[derive(Debug, clap::Args)]
#[command(long_about = LONG, after_long_help = AFTER)]
pub struct Args {
    /// Files that ships and loggers write; parts of one log, or a run each.
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// Folder for the study. Created if absent; what was imported there before and not edited is replaced.
    #[arg(long, value_name = "STUDY")]
    out: PathBuf,
    /// Ship file; without it a form to fill in is written.
    #[arg(long, value_name = "FILE")]
    ship: Option<PathBuf>,
    /// Model file; without it the base terms are the model.
    #[arg(long, value_name = "FILE")]
    model: Option<PathBuf>,
    /// Takes a column for a quantity: a channel (`psi`, `n`, ...), lat, lon, cog, sog, v_north, v_east, or t for the time.
    #[arg(long, value_name = "QUANTITY=NAME")]
    column: Vec<String>,
    /// Takes a column for a channel of a named actuator of the ship file: `port=thr_left`, or `port.angle=azi_1`.
    #[arg(long, value_name = "ACTUATOR=NAME")]
    actuator: Vec<String>,
    /// Unit of a quantity, instead of what the file or the data say.
    #[arg(long, value_name = "QUANTITY=UNIT")]
    unit: Vec<String>,
    /// Position of the antenna, metres forward and to starboard of midship.
    #[arg(long, value_name = "X,Y", value_delimiter = ',', num_args = 1, allow_hyphen_values = true)]
    antenna: Vec<f64>,
    /// Name of the study; that of the folder if not given.
    #[arg(long)]
    name: Option<String>,
    /// A longer gap ends a recording and a session [s]; 1800 if not given.
    #[arg(long, value_name = "S")]
    session_gap: Option<f64>,
    /// Longest drop-out to bridge by straight lines [s]; none if not given.
    #[arg(long, value_name = "S")]
    bridge: Option<f64>,
    /// List each recording as one run instead of splitting it.
    #[arg(long)]
    no_split: bool,
    #[command(flatten)]
    split: SplitArgs,
    /// Print the result as one JSON object, and nothing else, to standard output.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Report<'a> {
    study: &'a Path,
    files: Vec<FileReport<'a>>,
    taken: &'a [Taken],
    unused: &'a [Unused],
    notes: &'a [String],
    origin: Option<[f64; 2]>,
    velocity: &'a str,
    recordings: Vec<RecordingReport<'a>>,
    runs: &'a [SplitRun],
    skipped: usize,
}

#[derive(Serialize)]
struct FileReport<'a> {
    path: &'a Path,
    format: &'a str,
}

#[derive(Serialize)]
struct RecordingReport<'a> {
    name: &'a str,
    start: Option<&'a str>,
    rows: usize,
    step: f64,
    duration: f64,
    channels: Vec<&'static str>,
}

/// A study that was made, before its files are put into their places.
pub struct Made {
    /// Where its files go.
    pub output: Output,
    /// What was found, in words.
    pub text: String,
    /// The same as a document.
    pub report: Value,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<Answer, CliError> {
    let Made { output, text, report } = made(args)?;
    output.finish(&text, &report)?;
    Ok(Answer::Yes)
}

/// Makes the study and prints nothing yet.
///
/// # Errors
/// What cannot be read, decided or written.
pub fn made(args: &Args) -> Result<Made, CliError> {
    let name = study_name(args);
    let mut output =
        Output::new("import", &OutputArgs { out: Some(args.out.clone()), json: args.json, tables: Vec::new() })?;
    let read: Vec<PathBuf> = args.files.iter().chain(&args.ship).chain(&args.model).cloned().collect();
    output.reads_files(&read);
    let (ship, model) = (own_file(args.ship.as_deref())?, own_file(args.model.as_deref())?);
    let mut craft = None;
    if let (Some(text), Some(path)) = (&ship, &args.ship) {
        let ship = Ship::parse(text, path)?;
        craft = Some(ship.clone());
        if let (Some(text), Some(path)) = (&model, &args.model) {
            Model::parse(text, path, ship).map_err(|error| CliError::Model { path: None, error })?;
        }
    }
    let settings = settings(args, craft.as_ref())?;
    let driven = settings.choices.driven.clone();
    let bar = progress(format!("importing {} files", args.files.len()));
    let imported = import(&args.files, &settings);
    bar.finish_and_clear();
    let mut imported = imported?;
    if let Some(longest) = args.bridge {
        imported.bridge(longest);
    }
    let antenna = antenna(args)?;
    let origins = Origins {
        name: &name,
        ship: ship.as_deref(),
        model: model.as_deref(),
        antenna: antenna.unwrap_or_default(),
        antenna_given: antenna.is_some(),
        ship_like: driven.propeller || driven.rudder,
    };
    let files = study_files(&imported, &origins);
    let map = files.iter().find(|(file, _)| *file == "columns.toml").map_or("", |(_, text)| text.as_str());
    let mut map = ColumnMap::parse(map, &args.out.join("columns.toml")).map_err(trimtab::study::StudyError::from)?;
    map.driven = driven;
    let mut recordings = Vec::new();
    for one in &imported.recordings {
        let (file, text) = (format!("recordings/{}.csv", one.name), recording_csv(one));
        output.file(&file, text.as_bytes());
        let recording =
            Recording::parse(&text, &args.out.join(&file), &map).map_err(trimtab::study::StudyError::from)?;
        recordings.push((file, recording));
    }
    let Divided { runs, skipped, lost, table } = divided(args, settings.session_gap, &imported, &recordings)?;
    imported.notes.extend(lost);
    output.file("runs.csv", table.as_bytes());
    let mut kept = Vec::new();
    for (file, text) in &files {
        let path = args.out.join(file);
        let given = [("ship.toml", args.ship.is_some()), ("model.toml", args.model.is_some())].contains(&(*file, true));
        match *file {
            // These are for the user to edit: what is there stays, but for one that is given anew.
            "ship.toml" | "model.toml" if path.exists() && !given => {
                output.leave(file);
                kept.push(*file);
            }
            // The file that is given may be the one that is there.
            "ship.toml" | "model.toml" if std::fs::read(&path).is_ok_and(|there| there == text.as_bytes()) => {
                output.leave(file);
            }
            _ => output.file(file, text.as_bytes()),
        }
    }
    let text = text(args, &imported, &runs, skipped, &kept);
    let report = serde_json::to_value(report(args, &imported, &runs, skipped))?;
    Ok(Made { output, text, report })
}

/// The study's name: as given, or that of its folder.
fn study_name(args: &Args) -> String {
    let folder = || args.out.file_name().map_or_else(|| "study".to_owned(), |n| n.to_string_lossy().into_owned());
    args.name.clone().unwrap_or_else(folder)
}

/// What the flags say of columns, units and gaps.
fn settings(args: &Args, craft: Option<&Ship>) -> Result<ImportSettings, CliError> {
    let pairs = |flag: &str, all: &[String]| {
        let pair = |text: &String| {
            let wrong = || CliError::Argument(format!("{flag} {text}: give QUANTITY=..., as in `{flag} psi=...`"));
            let (quantity, value) = text.split_once('=').ok_or_else(wrong)?;
            Ok((quantity.trim().to_owned(), value.trim().to_owned()))
        };
        all.iter().map(pair).collect::<Result<BTreeMap<String, String>, CliError>>()
    };
    if let Some(gap) = args.session_gap.filter(|g| !(g.is_finite() && *g > 0.0)) {
        return Err(CliError::Argument(format!(
            "--session-gap {gap}: give a positive number of seconds, such as 1800"
        )));
    }
    if let Some(bridge) = args.bridge.filter(|b| !(b.is_finite() && *b > 0.0)) {
        return Err(CliError::Argument(format!("--bridge {bridge}: give a positive number of seconds, such as 6")));
    }
    let mut columns = pairs("--column", &args.column)?;
    for (name, column) in pairs("--actuator", &args.actuator)? {
        columns.insert(actuator_channel(&name, craft)?, column);
    }
    let driven = craft.map_or_else(Driven::default, Driven::of);
    let choices = Choices { columns, units: pairs("--unit", &args.unit)?, driven };
    let by_sessions = match args.split.settings()?.sessions {
        Sessions::Gaps(gap) => Some(gap),
        _ => None,
    };
    if let (Some(gap), Some(other)) = (args.session_gap, by_sessions)
        && gap != other
    {
        return Err(CliError::Argument(format!(
            "--session-gap {gap} and --sessions gaps={other} say two gaps between sessions: give one of them"
        )));
    }
    Ok(ImportSettings { choices, session_gap: args.session_gap.or(by_sessions) })
}

/// The channel of an actuator that is given by its own name or by that of the actuator, which then is its first.
fn actuator_channel(name: &str, craft: Option<&Ship>) -> Result<String, CliError> {
    let fail = |why: String| Err(CliError::Argument(format!("--actuator {name}=...: {why}")));
    let Some(ship) = craft else {
        return fail("the actuators are those of the ship file; give it with --ship".to_owned());
    };
    let channels = ship.commands();
    let found = channels.iter().find(|c| *c == name || c.split_once('.').is_some_and(|(actuator, _)| actuator == name));
    match found {
        Some(channel) => Ok(channel.clone()),
        None if channels.is_empty() => fail("the ship file has no [[actuator]]; add it there".to_owned()),
        None => fail(format!("the ship file has no such channel; there are {}", channels.join(", "))),
    }
}

fn antenna(args: &Args) -> Result<Option<[f64; 2]>, CliError> {
    match args.antenna.as_slice() {
        [] => Ok(None),
        [x, y] if x.is_finite() && y.is_finite() && x.abs() < 600.0 && y.abs() < 100.0 => Ok(Some([*x, *y])),
        _ => Err(CliError::Argument(
            "--antenna takes metres forward and to starboard of midship, as in `--antenna=-12.0,0.5`".into(),
        )),
    }
}

fn own_file(path: Option<&Path>) -> Result<Option<String>, CliError> {
    let read = |path: &Path| {
        std::fs::read_to_string(path).map_err(|source| {
            CliError::Argument(format!("{}: cannot read the file ({source}); check the path", path.display()))
        })
    };
    path.map(read).transpose()
}

/// The runs of all recordings.
struct Divided {
    runs: Vec<SplitRun>,
    /// Stretches that are too short for a run.
    skipped: usize,
    /// What blanks and gaps cost.
    lost: Option<String>,
    /// The table that lists the runs.
    table: String,
}

fn divided(
    args: &Args,
    gap: Option<f64>,
    imported: &Imported,
    recordings: &[(String, Recording)],
) -> Result<Divided, CliError> {
    let mut settings = args.split.settings()?;
    // Recordings are of sessions by gaps already.
    if let Sessions::Gaps(_) = settings.sessions {
        settings.sessions = Sessions::Known;
    }
    let sessions = imported.sessions(gap);
    let known = settings.sessions == Sessions::Known;
    let mut parts = Vec::new();
    for ((file, recording), session) in recordings.iter().zip(sessions) {
        parts.push(SplitPart { file: file.clone(), session: Some(session).filter(|_| known), start: None, recording });
    }
    let failed = |error: SplitError, more: String| CliError::Argument(format!("{}: {error}{more}", args.out.display()));
    if args.no_split {
        let table = whole_csv(&parts, &settings).map_err(|error| failed(error, String::new()))?;
        return Ok(Divided { runs: Vec::new(), skipped: 0, lost: None, table });
    }
    let lost = imported.lost(shortest_run(&parts));
    match split(&parts, &settings) {
        Ok((runs, skipped)) => Ok(Divided { table: runs_csv(&runs), runs, skipped, lost }),
        Err(error) => Err(failed(error, lost.map_or_else(String::new, |lost| format!(". {lost}")))),
    }
}

fn report<'a>(args: &'a Args, imported: &'a Imported, runs: &'a [SplitRun], skipped: usize) -> Report<'a> {
    let recording = |r: &'a trimtab::recording::import::ImportedRecording| RecordingReport {
        name: &r.name,
        start: r.start.as_deref(),
        rows: r.rows.t.len(),
        step: r.rows.step,
        duration: r.rows.duration(),
        channels: r.rows.channels.iter().map(|(c, _)| c.name()).collect(),
    };
    Report {
        study: &args.out,
        files: imported.files.iter().map(|(path, format)| FileReport { path, format }).collect(),
        taken: &imported.taken,
        unused: &imported.unused,
        notes: &imported.notes,
        origin: imported.origin,
        velocity: imported.velocity.words,
        recordings: imported.recordings.iter().map(recording).collect(),
        runs,
        skipped,
    }
}

fn text(args: &Args, imported: &Imported, runs: &[SplitRun], skipped: usize, kept: &[&str]) -> String {
    let mut text = String::new();
    for (path, format) in &imported.files {
        text += &format!("{}: {format}\n", path.display());
    }
    let mut taken = Table::new(["quantity", "column", "unit", "step [s]", "evidence"]);
    for t in &imported.taken {
        taken.row([t.quantity.clone(), t.column.clone(), t.unit.clone(), sig(t.step, 3), t.evidence.clone()]);
    }
    text += &format!("\nTaken for\n{taken}\n{}.\n", imported.velocity.words);
    let mut parts = Table::new(["recording", "start (UTC)", "rows", "step [s]", "minutes", "channels"]);
    for r in &imported.recordings {
        let channels: Vec<&str> = r.rows.channels.iter().map(|(c, _)| c.name()).collect();
        let start = r.start.clone().unwrap_or_default();
        let cells = [
            r.name.clone(),
            start,
            r.rows.t.len().to_string(),
            sig(r.rows.step, 3),
            fixed(r.rows.duration() / 60.0, 1),
        ];
        parts.row(cells.into_iter().chain([channels.join(" ")]));
    }
    text += &format!("\nRecordings\n{parts}\n");
    if !runs.is_empty() {
        text += &format!("\nRuns (runs.csv)\n{}", by_kind(runs, skipped));
    }
    for note in &imported.notes {
        text += &format!("\nnote: {note}");
    }
    for unused in &imported.unused {
        text += &format!("\nnot used: column `{}`: {}", unused.column, unused.why);
    }
    if args.antenna.is_empty() {
        text += "\nnote: position and velocity are taken as those of midship; `--antenna X,Y`, or `reference_point` in columns.toml, says where the antenna is";
    }
    for file in kept {
        text += &format!("\nnote: {file} was there and is kept as it is");
    }
    let study = args.out.join("study.toml");
    let next = if args.ship.is_some() || kept.contains(&"ship.toml") {
        format!("Next: trimtab check {}", study.display())
    } else {
        let ship = args.out.join("ship.toml");
        format!("Next: fill in {} (it says what is missing), then trimtab check {}", ship.display(), study.display())
    };
    text + "\n\n" + &next
}
