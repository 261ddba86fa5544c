//! The audit of a study: every recording, what comes of cutting it, and what a diagnosis would leave out.
//! It asks nothing of its own of a recording; the questions are in the files beside it.

use super::issue::{Issue, Severity};
use super::propeller::advance;
use super::receiver::settled;
use super::record::{Audit, audit};
use crate::recording::Split;
use crate::ship::Ship;
use crate::study::{Listed, Study, StudyError};
use rayon::prelude::*;
use serde::Serialize;

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
}

impl StudyAudit {
    /// The gravest issue's severity, in the study or any run.
    pub fn worst(&self) -> Option<Severity> {
        let own = self.issues.iter().map(|i| i.severity).max();
        own.max(self.recordings.iter().filter_map(Audit::worst).max())
    }
}

/// Audits every run of a study and cuts it as the study says, for a ship. All runs are audited, whatever is wrong with one.
pub fn audit_study(study: &Study, ship: &Ship) -> StudyAudit {
    let mut result = StudyAudit {
        study: study.name.clone(),
        split: study.split_in_words(),
        recordings: Vec::new(),
        train_windows: 0,
        test_windows: 0,
        issues: sides(study),
    };
    let audited: Vec<Audited> = study.runs.par_iter().with_max_len(1).map(|run| audited(study, ship, run)).collect();
    for Audited { audit, train, test } in audited {
        result.train_windows += train;
        result.test_windows += test;
        result.recordings.push(audit);
    }
    result
}

/// The audit of one run, and how many windows came of it.
struct Audited {
    audit: Audit,
    train: usize,
    test: usize,
}

/// Reads, audits and cuts one run; nothing of its recording is kept.
fn audited(study: &Study, ship: &Ship, run: &Listed) -> Audited {
    let recording = match study.recording(run) {
        Ok(recording) => recording,
        Err(error) => return Audited { audit: unreadable(run, &error), train: 0, test: 0 },
    };
    let mut audit = audit(&recording);
    advance(&recording, ship, &mut audit.issues);
    let (mut train, mut test) = (0, 0);
    match recording.windows(&run.labels, &study.settings(run, ship.hull.draught)) {
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
    Audited { audit, train, test }
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

/// An error as an issue; its text already says what to do.
fn failure(error: &StudyError) -> Issue {
    let text = error.to_string();
    let (text, next_step) = text.rsplit_once("; ").unwrap_or((&text, "see the message"));
    Issue::new(Severity::Error, "unreadable", text, next_step)
}
