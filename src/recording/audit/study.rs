//! The audit of a study: every recording, what comes of cutting it, and what a diagnosis would leave out.
//! It makes no check of its own; the checks of a recording are in the other files of this folder.

use super::agreement::across::{Evidence, across};
use super::agreement::lone::Lone;
use super::issue::{Issue, Severity, Shared};
use super::limits::LEVER_LONGEST;
use super::record::{Audit, examined};
use super::values::receiver::settled;
use crate::recording::{Recording, RecordingError, Split, WindowSettings};
use crate::ship::Ship;
use crate::study::{Listed, Study, StudyError};
use rayon::prelude::*;
use serde::Serialize;
use std::collections::HashSet;
use std::path::PathBuf;

/// The audit of a study: every run, and what comes of cutting them.
#[derive(Clone, Debug, Serialize)]
pub struct StudyAudit {
    /// Name of the study.
    pub study: String,
    /// How the runs are split, in one sentence.
    pub split: String,
    /// One audit a run, in the order listed.
    pub recordings: Vec<Audit>,
    /// Windows to train on.
    pub train_windows: usize,
    /// Windows to test on.
    pub test_windows: usize,
    /// Doubts about the study as a whole.
    pub issues: Vec<Issue>,
    /// What is compared between runs, one entry a recording that could be read.
    #[serde(skip)]
    pub evidence: Vec<Evidence>,
}

impl StudyAudit {
    /// The gravest issue's severity, in the study or any run.
    pub fn worst(&self) -> Option<Severity> {
        let own = self.issues.iter().map(|i| i.severity).max();
        own.max(self.recordings.iter().filter_map(Audit::worst).max())
    }

    /// Weighs the doubts of each run by what the others say.
    pub fn weigh(&mut self, lone: &Lone) {
        for audit in &mut self.recordings {
            audit.issues.iter_mut().for_each(|issue| lone.weigh(&audit.run, issue));
            audit.issues.sort_by_key(|i| std::cmp::Reverse(i.severity));
        }
    }
}

/// Audits every run of a study and cuts it as the study says, for a ship. All runs are audited, whatever is wrong with one, and then
/// compared with each other.
pub fn audit_study(study: &Study, ship: &Ship) -> StudyAudit {
    let mut result = audit_each(study, ship);
    result.weigh(&Lone::of(&result.evidence));
    for Shared { runs, issue } in across(&result.evidence, ship) {
        match &runs[..] {
            [one] => {
                let Some(audit) = result.recordings.iter_mut().find(|a| a.run == *one) else { continue };
                // The audit of the run alone may have reported it, perhaps as a note.
                let same = |i: &Issue| (i.fault, i.channel) == (issue.fault, issue.channel);
                if !audit.issues.iter().any(|i| same(i) && i.severity >= issue.severity) {
                    audit.issues.retain(|i| !same(i));
                    audit.issues.push(issue);
                }
                audit.issues.sort_by_key(|i| std::cmp::Reverse(i.severity));
            }
            _ => result.issues.push(issue),
        }
    }
    result
}

/// As [`audit_study`], without comparing the runs with each other: for the part of a study that one of several processes audits.
pub fn audit_each(study: &Study, ship: &Ship) -> StudyAudit {
    let mut result = StudyAudit {
        study: study.name.clone(),
        split: study.split_in_words(),
        recordings: Vec::new(),
        train_windows: 0,
        test_windows: 0,
        issues: sides(study),
        evidence: Vec::new(),
    };
    let audited: Vec<Audited> = study.runs.par_iter().with_max_len(1).map(|run| audited(study, ship, run)).collect();
    let mut known: HashSet<(PathBuf, String)> = HashSet::new();
    for Audited { mut audit, evidence, train, test } in audited {
        result.train_windows += train;
        result.test_windows += test;
        result.evidence.extend(evidence);
        // A fault of a file is in every run that is cut from it, and is reported for the first.
        let path = audit.path.clone();
        audit
            .issues
            .retain(|i| known.insert((path.clone(), format!("{:?}{:?}{}{}", i.channel, i.lines, i.fault, i.text))));
        result.recordings.push(audit);
    }
    result
}

/// The audit of one run, and how many windows came of it.
struct Audited {
    audit: Audit,
    evidence: Option<Evidence>,
    train: usize,
    test: usize,
}

/// Reads, audits and cuts one run; nothing of its recording is kept. What the run leaves out is not audited.
fn audited(study: &Study, ship: &Ship, run: &Listed) -> Audited {
    let recording = match study.recording(run) {
        Ok(recording) => recording,
        Err(error) => return Audited { audit: unreadable(run, &error), evidence: None, train: 0, test: 0 },
    };
    let settings = study.settings(run, ship.hull.draught);
    let part = used(&recording, &settings);
    let (mut audit, responses) = examined(part.as_ref().unwrap_or(&recording));
    off_the_ship(&mut audit, ship);
    let evidence = Evidence::of(run, part.as_ref().unwrap_or(&recording), ship, responses, &audit.issues);
    let (mut train, mut test) = (0, 0);
    match recording.windows(&run.labels, &settings) {
        Ok(windows) => {
            test = windows.windows.iter().filter(|w| w.split == Split::Test).count();
            train = windows.windows.len() - test;
            audit.issues.extend(settled(windows.windows, ship.hull.lpp).1);
            for skipped in windows.skipped {
                let text = format!("{:.2} s, shorter than a window, are left out", skipped.length);
                let issue = Issue::new(Severity::Note, "too_short", text, "set a shorter `window` to use them");
                audit.issues.push(issue.at((skipped.first_line, skipped.last_line)));
            }
        }
        Err(error) => audit.issues.insert(0, failure(&error.into())),
    }
    Audited { audit, evidence: Some(evidence), train, test }
}

/// Where a lever is longer than the ship, it is none.
fn off_the_ship(audit: &mut Audit, ship: &Ship) {
    let Some(lever) = audit.kinematics.and_then(|k| k.lever) else { return };
    if lever.abs() <= LEVER_LONGEST * ship.hull.lpp {
        return;
    }
    for issue in audit.issues.iter_mut().filter(|i| i.fault == "lever") {
        issue.fault = "disagreement";
        issue.text = "in turns the track slides sideways farther than any point of the ship would".into();
        issue.next_step =
            "is the heading offset, or counted anticlockwise from east (`psi = { sign = -1, offset = 90 }`, for one in deg, in a column map)? Else check axes and units of x, y and v"
                .into();
    }
}

/// The part of a recording that the study uses; `None` where that is all of it, or nothing.
fn used(recording: &Recording, settings: &WindowSettings) -> Option<Recording> {
    let (first, last) = (recording.time().first()?, recording.time().last()?);
    let from = settings.from.unwrap_or(f64::MIN).max(first + settings.discard_start);
    let to = settings.to.unwrap_or(f64::MAX).min(last - settings.discard_end);
    if from <= *first && to >= *last {
        return None;
    }
    Some(recording.part(Some(from), Some(to))).filter(|part| part.len() > 1)
}

/// Whether there are runs on both sides of the split.
fn sides(study: &Study) -> Vec<Issue> {
    let missing = |side: Split| !study.runs.iter().any(|r| r.labels.split == side);
    let mut issues = Vec::new();
    if missing(Split::Test) {
        let next = "set `split = \"test\"` for some runs, or add [split]";
        issues.push(Issue::new(Severity::Warning, "split", "no run is kept for testing", next));
    }
    if missing(Split::Train) {
        let next = "set `split = \"train\"` for some runs";
        issues.push(Issue::new(Severity::Error, "split", "no run is left to train on", next));
    }
    issues
}

/// The audit of a run that could not be read.
fn unreadable(run: &Listed, error: &StudyError) -> Audit {
    Audit {
        run: run.labels.run.clone(),
        path: run.file.clone(),
        rows: 0,
        duration: 0.0,
        step: 0.0,
        stretches: Vec::new(),
        channels: Vec::new(),
        kinematics: None,
        issues: vec![failure(error)],
    }
}

/// An error as an issue; its text already says what to do. A setting of the study is no fault of the file that it does not suit.
fn failure(error: &StudyError) -> Issue {
    let (fault, text) = match error {
        StudyError::Recording(RecordingError::Setting { message, .. }) => ("setting", message.clone()),
        _ => ("unreadable", error.to_string()),
    };
    let (text, next_step) = text
        .rsplit_once("; ")
        .unwrap_or((&text, "correct the file, or say in a column map how to read it (`trimtab help columns`)"));
    Issue::new(Severity::Error, fault, text, next_step)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::RecordingError;

    #[test]
    fn a_setting_that_does_not_suit_is_reported_without_a_file_and_a_file_that_cannot_be_read_with_it() {
        let setting =
            |path: &str| RecordingError::Setting { path: path.into(), message: "`window` is long; cut it".into() };
        let of = |error: RecordingError| {
            let issue = failure(&error.into());
            (issue.fault, issue.text, issue.next_step)
        };
        let expected = ("setting", "`window` is long".to_owned(), "cut it".to_owned());
        assert_eq!([of(setting("a.csv")), of(setting("b.csv"))], [expected.clone(), expected]);
        let source = std::io::Error::from(std::io::ErrorKind::NotFound);
        let (fault, text, _) = of(RecordingError::Read { path: "a.csv".into(), source });
        assert!(fault == "unreadable" && text.contains("a.csv"), "{text}");
    }
}
