//! `trimtab check`: audits the recordings of a study before a fit or a diagnosis uses them.
//! The library's `check` defines the audit; this file prints it.

use crate::cli::shared::answer::Answer;
use crate::cli::shared::error::CliError;
use crate::cli::shared::load::{Loaded, StudyArgs};
use crate::cli::shared::output::{Output, OutputArgs, csv_text};
use crate::cli::shared::progress::progress;
use trimtab::numbers::numerals::{fixed, number_of, sig};
use trimtab::recording::audit::{Audit, Issue, Severity, StudyAudit, audit_model, audit_study};
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

    output.table("channels.csv", &channels(&audit)?);
    output
        .table("issues.csv", &csv_text(&["run", "severity", "channel", "lines", "issue", "next_step"], rows(&audit))?);
    output.finish(&text(&audit), &audit)?;
    Ok(if audit.worst() == Some(Severity::Error) { Answer::No } else { Answer::Yes })
}

fn text(audit: &StudyAudit) -> String {
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
    let windows =
        format!("{} to train on, {} to test on", number_of(audit.train_windows, "window"), audit.test_windows);
    let mut text = format!("{}: {}; {windows}.\n\n{runs}\n", audit.study, audit.split);
    // Notes are many and rarely needed; the file and the JSON have them.
    let issues = grouped(audit);
    for (runs, issue) in &issues {
        text +=
            &format!("\n{}: {}{}: {}; {}", word(issue), who(runs, audit), place(issue), issue.text, issue.next_step);
    }
    let found = || audit.issues.iter().chain(audit.recordings.iter().flat_map(|a| &a.issues));
    let notes = found().filter(|i| i.severity == Severity::Note).count();
    let noted = number_of(notes, "note");
    text + &match (issues.is_empty(), notes) {
        (true, 0) => "\nNothing found.".to_owned(),
        (true, _) => format!("\nNo error and no warning, {noted} (in --out and --json)."),
        (false, 0) => format!("\n\n{}.", graver(found())),
        (false, _) => format!("\n\n{}, {noted} (notes in --out and --json).", graver(found())),
    }
}

/// Errors and warnings: `2 errors, 1 warning`.
fn graver<'a>(issues: impl Iterator<Item = &'a Issue> + Clone) -> String {
    let count = |s: Severity| issues.clone().filter(|i| i.severity == s).count();
    let named = [(count(Severity::Error), "error"), (count(Severity::Warning), "warning")];
    let parts: Vec<String> = named.iter().filter(|(n, _)| *n > 0).map(|(n, noun)| number_of(*n, noun)).collect();
    parts.join(", ")
}

/// Errors and warnings with the runs that have them: a fault of a run from beginning to end is listed once for all runs.
fn grouped(audit: &StudyAudit) -> Vec<(Vec<&str>, &Issue)> {
    let mut issues: Vec<(Vec<&str>, &Issue)> = audit.issues.iter().map(|issue| (Vec::new(), issue)).collect();
    for (run, issue) in audit.recordings.iter().flat_map(|a| a.issues.iter().map(|i| (a.run.as_str(), i))) {
        let whole = |i: &Issue| i.lines.is_none() && i.fault != "unreadable";
        let same = |i: &Issue| (i.severity, i.fault, i.channel) == (issue.severity, issue.fault, issue.channel);
        match issues.iter_mut().find(|(runs, i)| !runs.is_empty() && whole(i) && whole(issue) && same(i)) {
            // A run may have it more than once.
            Some((runs, _)) if runs.contains(&run) => {}
            Some((runs, _)) => runs.push(run),
            None => issues.push((vec![run], issue)),
        }
    }
    issues.retain(|(_, issue)| issue.severity != Severity::Note);
    issues.sort_by_key(|(_, issue)| std::cmp::Reverse(issue.severity));
    issues
}

/// The runs of an issue: one by its name, several by their number and the first.
fn who(runs: &[&str], audit: &StudyAudit) -> String {
    match runs {
        [] => "study".to_owned(),
        [one] => (*one).to_owned(),
        [first, ..] => format!("{} of {} runs, as {first}", runs.len(), audit.recordings.len()),
    }
}

fn word(issue: &Issue) -> &'static str {
    match issue.severity {
        Severity::Note => "note",
        Severity::Warning => "warning",
        Severity::Error => "error",
    }
}

fn channel(issue: &Issue) -> String {
    issue.channel.map_or(String::new(), |c| format!("channel {}", c.name()))
}

fn lines(issue: &Issue) -> String {
    issue.lines.map_or(String::new(), |(a, b)| if a == b { format!("line {a}") } else { format!("lines {a}-{b}") })
}

/// ` (channel r, lines 3-9)`, or nothing.
fn place(issue: &Issue) -> String {
    let known: Vec<String> = [channel(issue), lines(issue)].into_iter().filter(|s| !s.is_empty()).collect();
    if known.is_empty() { String::new() } else { format!(" ({})", known.join(", ")) }
}

fn verdict(audit: &Audit) -> String {
    let found = graver(audit.issues.iter());
    if found.is_empty() { "ok".to_owned() } else { found }
}

fn rows(audit: &StudyAudit) -> Vec<[String; 6]> {
    let row = |run: &str, i: &Issue| {
        [run.to_owned(), word(i).to_owned(), channel(i), lines(i), i.text.clone(), i.next_step.clone()]
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

#[cfg(test)]
mod tests {
    use super::*;
    use trimtab::recording::Channel;

    fn recording(run: &str, issues: Vec<Issue>) -> Audit {
        let path = format!("{run}.csv").into();
        let (run, stretches, channels) = (run.to_owned(), Vec::new(), Vec::new());
        Audit { run, path, rows: 9, duration: 8.0, step: 1.0, stretches, channels, kinematics: None, issues }
    }

    fn printed(recordings: Vec<Audit>) -> String {
        let (issues, evidence) = (Vec::new(), Vec::new());
        let (study, split) = ("study".to_owned(), "as listed".to_owned());
        text(&StudyAudit { study, split, recordings, train_windows: 1, test_windows: 2, issues, evidence })
    }

    #[test]
    fn a_fault_of_whole_runs_is_listed_once_and_one_of_some_lines_for_each_run() {
        let sign = || Issue::new(Severity::Error, "sign_error", "turned", "turn it").of(Channel::R);
        let jump = |line| Issue::new(Severity::Warning, "jump", "far", "blank it").of(Channel::U).at((line, line));
        let note = Issue::new(Severity::Note, "clock", "late", "look");
        let span = || Issue::new(Severity::Error, "setting", "too short", "set it longer");
        let runs = vec![
            recording("a", vec![jump(3), note, span()]),
            recording("b", vec![sign(), jump(4)]),
            recording("c", vec![span(), sign(), span()]),
        ];
        let text = printed(runs);
        let lines: Vec<&str> = text.lines().filter(|l| l.starts_with("error") || l.starts_with("warning")).collect();
        assert_eq!(
            lines,
            [
                "error: 2 of 3 runs, as a: too short; set it longer",
                "error: 2 of 3 runs, as b (channel r): turned; turn it",
                "warning: a (channel u, line 3): far; blank it",
                "warning: b (channel u, line 4): far; blank it"
            ]
        );
        assert!(text.contains(": as listed; 1 window to train on, 2 to test on."), "{text}");
        assert!(text.ends_with("\n\n5 errors, 2 warnings, 1 note (notes in --out and --json)."), "{text}");
        assert!(text.contains("1 error, 1 warning"), "{text}");
    }

    #[test]
    fn sound_recordings_say_so() {
        assert!(printed(vec![recording("a", Vec::new())]).ends_with("\nNothing found."));
    }
}
