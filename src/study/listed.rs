//! The runs of a study as listed: file, labels and times, each with a name of its own.
//! It opens no recording.

use super::error::StudyError;
use super::file::RunEntry;
use super::split::{SplitRule, UNNAMED, draw};
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
    let fail = |line, message| StudyError::Parse { path: path.to_owned(), line, message };
    if entries.is_empty() {
        return Err(fail(1, "no run is listed; add [[runs]] with `file`, or rows to the table of runs".to_owned()));
    }
    let given = entries.iter().filter(|(_, e)| e.split.is_some()).count();
    if let Some((line, e)) = entries.iter().find(|(_, e)| e.split.is_none()).filter(|_| given > 0) {
        let text = format!("run {} has no `split`, though others have; give every run one, or none", e.file.display());
        return Err(fail(*line, text));
    }
    if given > 0 && rule.is_some() {
        return Err(fail(
            entries[0].0,
            "runs have a `split` and the study a [split] rule; drop one of the two".to_owned(),
        ));
    }
    let mut runs: Vec<Listed> = Vec::new();
    let mut named: HashMap<String, usize> = HashMap::new();
    for (line, e) in entries {
        let stem = e.file.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
        let name = e.name.unwrap_or(stem);
        if let Some(other) = named.insert(name.clone(), line) {
            let text =
                format!("run `{name}` is listed twice, here and at line {other}; give one of them a `name` of its own");
            return Err(fail(line, text));
        }
        if let (Some(from), Some(to)) = (e.from, e.to)
            && from >= to
        {
            return Err(fail(line, format!("`from` = {from} s is not before `to` = {to} s")));
        }
        let labels = Labels {
            // Without a word that days differ, one hull under one sky: a session is what may differ in something hidden.
            session: e.session.filter(|s| !s.is_empty()).unwrap_or_else(|| UNNAMED.to_owned()),
            manoeuvre: e.manoeuvre.filter(|s| !s.is_empty()).unwrap_or_else(|| UNNAMED.to_owned()),
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
