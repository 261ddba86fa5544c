//! `trimtab check`: audits the recordings of a study before a fit or a diagnosis uses them.
//! The library's `check` defines the audit; this file prints it.

use super::answer::Answer;
use super::error::CliError;
use super::load::{Loaded, StudyArgs};
use super::output::{Output, OutputArgs, csv_text};
use super::progress::progress;
use trimtab::audit::{Audit, Issue, Severity, StudyAudit, audit_model, audit_study};
use trimtab::numerals::{fixed, sig};
use trimtab::report::Table;

const LONG: &str = "\
Audits the recordings of a study before anything is concluded from them: units and signs, gaps and missing values, fill values, \
    frozen channels, damaged samples, jumps of position, clocks, and whether position, velocity, heading and yaw rate agree with \
    one another and with rudder and propeller. Runs are compared with each other: clocks of sessions, units, and the same data to \
    train and to test on. Of a run that is cut with `from` and `to` that part is audited. Ship, model and settings are read and \
    checked as well. Every run is looked at, whatever is wrong with one.

Exit code 1 if anything is an error: a recording that cannot be used or contradicts itself. Warnings do not fail.";

const AFTER: &str = "\
Example:
  trimtab check study.toml

What a message advises is done in a column map (`column_map = \"columns.toml\"` in the study, or of one run): `trimtab help columns` \
    shows one with every key.

With --out: check.json, channels.csv (range of every channel of every run), issues.csv.
JSON: result.study, result.split, result.train_windows, result.test_windows, result.issues[], result.recordings[] with \
    run, path, rows, duration [s], step [s], stretches[], channels[] (min, mean, max in SI units, missing), kinematics, and \
    issues[] with severity (note, warning, error), fault, channel, lines, text, next_step.";

/// Looks for faults in the recordings of a study
#[derive(Debug, clap::Args)]
#[command(long_about = LONG, after_long_help = AFTER)]
pub struct Args {
    #[command(flatten)]
    study: StudyArgs,
    #[command(flatten)]
    output: OutputArgs,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<Answer, CliError> {
    let mut output = Output::new("check", &args.output)?;
    let loaded = Loaded::new(&args.study)?;
    output.reads(&loaded, true);
    loaded.fit_settings()?;
    loaded.evaluation_settings()?;
    loaded.diagnose_settings()?;
    loaded.maneuver_settings()?;
    let bar = progress(format!("auditing {} recordings", loaded.study.runs.len()));
    let mut audit = audit_study(&loaded.study, &loaded.model.ship);
    audit.issues.extend(audit_model(&loaded.model));
    bar.finish_and_clear();

    let issues = rows(&audit);
    output.table("channels.csv", &channels(&audit)?);
    output.table(
        "issues.csv",
        &csv_text(&["run", "severity", "channel", "lines", "issue", "next_step"], issues.clone())?,
    );
    output.finish(&text(&audit, &issues), &audit)?;
    Ok(if audit.worst() == Some(Severity::Error) { Answer::No } else { Answer::Yes })
}

fn text(audit: &StudyAudit, issues: &[[String; 6]]) -> String {
    let mut runs = Table::new(["run", "rows", "duration [s]", "step [s]", "stretches", "channels", "verdict"]);
    for a in &audit.recordings {
        runs.row([
            a.run.clone(),
            a.rows.to_string(),
            fixed(a.duration, 1),
            sig(a.step, 3),
            a.stretches.len().to_string(),
            a.channels.len().to_string(),
            verdict(a),
        ]);
    }
    let windows = format!("{} windows to train on, {} to test on", audit.train_windows, audit.test_windows);
    let mut text = format!("{}: {}; {windows}.\n\n{runs}\n", audit.study, audit.split);
    // Notes are many and rarely needed; the file and the JSON have them.
    let shown: Vec<&[String; 6]> = issues.iter().filter(|i| i[1] != "note").collect();
    for [run, severity, channel, lines, what, next] in &shown {
        let place = [channel, lines].into_iter().filter(|s| !s.is_empty()).cloned().collect::<Vec<_>>().join(", ");
        let place = if place.is_empty() { String::new() } else { format!(" ({place})") };
        text += &format!("\n{severity}: {run}{place}: {what}; {next}");
    }
    let notes = issues.len() - shown.len();
    let tail = if notes > 0 { format!(" and {notes} notes (in --out and --json)") } else { String::new() };
    text + &match (shown.len(), notes) {
        (0, 0) => "\nNothing found.".to_owned(),
        (0, _) => format!("\nNo error and no warning{}.", tail.replace(" and", ",")),
        (n, _) => format!("\n\n{n} errors and warnings{tail}."),
    }
}

fn verdict(audit: &Audit) -> String {
    let count = |s: Severity| audit.issues.iter().filter(|i| i.severity == s).count();
    match (count(Severity::Error), count(Severity::Warning)) {
        (0, 0) => "ok".into(),
        (0, w) => format!("{w} warnings"),
        (e, w) => format!("{e} errors, {w} warnings"),
    }
}

fn rows(audit: &StudyAudit) -> Vec<[String; 6]> {
    let row = |run: &str, i: &Issue| {
        let severity = match i.severity {
            Severity::Note => "note",
            Severity::Warning => "warning",
            Severity::Error => "error",
        };
        let channel = i.channel.map_or(String::new(), |c| format!("channel {}", c.name()));
        let lines =
            i.lines.map_or(String::new(), |(a, b)| if a == b { format!("line {a}") } else { format!("lines {a}-{b}") });
        [run.to_owned(), severity.into(), channel, lines, i.text.clone(), i.next_step.clone()]
    };
    let own = audit.issues.iter().map(|i| row("study", i));
    own.chain(audit.recordings.iter().flat_map(|a| a.issues.iter().map(|i| row(&a.run, i)))).collect()
}

fn channels(audit: &StudyAudit) -> Result<Vec<u8>, CliError> {
    let number = |x: Option<f64>| x.map_or(String::new(), |x| x.to_string());
    let rows = audit.recordings.iter().flat_map(|a| {
        a.channels.iter().map(|c| {
            [
                a.run.clone(),
                c.channel.name().to_owned(),
                c.unit.to_owned(),
                c.recorded_in.clone(),
                number(c.min),
                number(c.mean),
                number(c.max),
                c.missing.to_string(),
                c.derived.to_string(),
            ]
        })
    });
    csv_text(&["run", "channel", "unit", "recorded_in", "min", "mean", "max", "missing", "derived"], rows)
}
