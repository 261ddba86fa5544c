//! The runs of a study as listed: file, labels and times, each with a name of its own.
//! It opens no recording.

use super::error::StudyError;
use super::file::RunEntry;
use super::split::{SplitRule, UNNAMED, draw};
use crate::files::plain;
use crate::files::written::{Mistake, joined};
use crate::recording::{Labels, Split};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// A run of a study, as listed.
#[derive(Clone, Debug)]
pub struct Listed {
    /// The recording.
    pub file: PathBuf,
    /// Name, session, manoeuvre and split.
    pub labels: Labels,
    /// First time used \[s\].
    pub from: Option<f64>,
    /// Last time used \[s\].
    pub to: Option<f64>,
    /// Column map of this run; the canonical layout when absent.
    pub column_map: Option<PathBuf>,
    /// Line at which the run is listed.
    pub line: usize,
}

/// Gives every run a name and a side of the split.
pub(super) fn label(
    entries: Vec<(usize, RunEntry)>,
    rule: Option<SplitRule>,
    path: &Path,
    data: &Path,
    folder: &Path,
    shared_map: Option<&Path>,
) -> Result<(Vec<Listed>, Option<SplitRule>), StudyError> {
    let fail = |mistakes| {
        let (line, message) = joined(mistakes, path);
        StudyError::Parse { path: path.to_owned(), line, message }
    };
    let mistakes = mistakes(&entries, rule);
    if !mistakes.is_empty() {
        return Err(fail(mistakes));
    }
    let given = entries.iter().filter(|(_, e)| e.split.is_some()).count();
    let mut runs: Vec<Listed> = Vec::new();
    for (line, e) in entries {
        let name = name_of(&e);
        let labels = Labels {
            // Without a word that days differ, one hull under one sky: a session is what may differ in something hidden.
            session: shown(e.session),
            manoeuvre: shown(e.manoeuvre),
            run: name,
            split: e.split.unwrap_or(Split::Train),
        };
        let own_map = e.column_map.map(|m| folder.join(m));
        let column_map = own_map.or_else(|| shared_map.map(Path::to_owned));
        runs.push(Listed { file: data.join(e.file), labels, from: e.from, to: e.to, column_map, line });
    }
    if given > 0 {
        return Ok((runs, None));
    }
    let rule = rule.unwrap_or_default();
    draw(runs.iter_mut().map(|r| &mut r.labels), rule);
    Ok((runs, Some(rule)))
}

/// The name of a run: its own, or that of its file without the ending.
fn name_of(entry: &RunEntry) -> String {
    let stem = || entry.file.file_stem().map(|s| s.to_string_lossy().into_owned());
    plain(&entry.name.clone().or_else(stem).unwrap_or_default()).into_owned()
}

/// A session or a kind of manoeuvre as given.
fn shown(given: Option<String>) -> String {
    given.filter(|s| !s.is_empty()).map_or_else(|| UNNAMED.to_owned(), |s| plain(&s).into_owned())
}

/// What is wrong with the runs as they are listed.
fn mistakes(entries: &[(usize, RunEntry)], rule: Option<SplitRule>) -> Vec<Mistake> {
    let mut found = Vec::new();
    let Some((first, _)) = entries.first() else {
        return vec![Mistake::new(1, "no run is listed; add [[runs]] with `file`, or rows to the table of runs")];
    };
    let given = entries.iter().any(|(_, e)| e.split.is_some());
    if given && rule.is_some() {
        found.push(Mistake::new(*first, "runs have a `split` and the study a [split] rule; drop one of the two"));
    }
    let mut named: HashMap<String, usize> = HashMap::new();
    for (line, e) in entries {
        let mut wrong = |text: String| found.push(Mistake::new(*line, text));
        if given && e.split.is_none() {
            let file = e.file.display();
            wrong(format!("run {file} has no `split`, though others have; give every run one, or none"));
        }
        let name = name_of(e);
        if let Some(other) = named.insert(name.clone(), *line) {
            wrong(format!(
                "run `{name}` is listed twice, here and at line {other}; give one of them a `name` of its own"
            ));
        }
        for (key, time) in [("from", e.from), ("to", e.to)] {
            if let Some(time) = time.filter(|t| !t.is_finite()) {
                wrong(format!("`{key}` = {time} is not a time in seconds; correct it, or leave it out"));
            }
        }
        if let (Some(from), Some(to)) = (e.from, e.to)
            && from >= to
        {
            wrong(format!("`from` = {from} s is not before `to` = {to} s; correct one of them"));
        }
    }
    found
}
