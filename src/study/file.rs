//! The study file and its table of runs as they are written: keys, their defaults, and what serde reads them into.
//! It checks nothing beyond the shape; what the values mean is decided in `study` and `listed`.

use super::error::StudyError;
use super::split::SplitRule;
use crate::error::suggestion;
use crate::recording::{Gaps, Split};
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// The study file as written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StudyFile {
    pub(super) name: String,
    pub(super) ship: PathBuf,
    pub(super) model: PathBuf,
    #[serde(default)]
    pub(super) data: Candidates,
    pub(super) column_map: Option<PathBuf>,
    pub(super) step: Option<f64>,
    pub(super) window: Option<f64>,
    #[serde(default)]
    pub(super) window_overlap: f64,
    #[serde(default)]
    pub(super) discard_start: f64,
    #[serde(default)]
    pub(super) discard_end: f64,
    #[serde(default)]
    pub(super) initial_state: InitialKind,
    pub(super) initial_span: Option<f64>,
    #[serde(default)]
    pub(super) gaps: Gaps,
    pub(super) runs: Option<RunTable>,
    pub(super) split: Option<SplitRule>,
    #[serde(default)]
    pub(super) fit: toml::Table,
    #[serde(default)]
    pub(super) evaluate: toml::Table,
    #[serde(default)]
    pub(super) diagnose: toml::Table,
    #[serde(default)]
    pub(super) maneuver: toml::Table,
    #[serde(default)]
    pub(super) plan: toml::Table,
}

#[derive(Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum InitialKind {
    #[default]
    First,
    Smoothed,
}

/// One folder, or several of which the first that exists is used.
#[derive(Default)]
pub(super) struct Candidates(pub(super) Vec<String>);

impl<'de> Deserialize<'de> for Candidates {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct OneOrMore;
        impl<'de> serde::de::Visitor<'de> for OneOrMore {
            type Value = Candidates;
            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a folder, or a list of folders of which the first that exists is used")
            }
            fn visit_str<E: serde::de::Error>(self, folder: &str) -> Result<Candidates, E> {
                Ok(Candidates(vec![folder.to_owned()]))
            }
            fn visit_seq<A: serde::de::SeqAccess<'de>>(self, mut seq: A) -> Result<Candidates, A::Error> {
                let mut folders = Vec::new();
                while let Some(folder) = seq.next_element()? {
                    folders.push(folder);
                }
                Ok(Candidates(folders))
            }
        }
        deserializer.deserialize_any(OneOrMore)
    }
}

/// `runs = "runs.csv"`, or `[[runs]]` in the study.
pub(super) enum RunTable {
    File(PathBuf),
    Listed(Vec<toml::Spanned<RunEntry>>),
}

impl<'de> Deserialize<'de> for RunTable {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct FileOrList;
        impl<'de> serde::de::Visitor<'de> for FileOrList {
            type Value = RunTable;
            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("the name of a CSV table of runs, or [[runs]] entries")
            }
            fn visit_str<E: serde::de::Error>(self, path: &str) -> Result<RunTable, E> {
                Ok(RunTable::File(path.into()))
            }
            fn visit_seq<A: serde::de::SeqAccess<'de>>(self, mut seq: A) -> Result<RunTable, A::Error> {
                let mut runs = Vec::new();
                while let Some(run) = seq.next_element()? {
                    runs.push(run);
                }
                Ok(RunTable::Listed(runs))
            }
        }
        deserializer.deserialize_any(FileOrList)
    }
}

/// A run as listed, in the study or in a table beside it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RunEntry {
    pub(super) file: PathBuf,
    pub(super) name: Option<String>,
    pub(super) session: Option<String>,
    pub(super) manoeuvre: Option<String>,
    pub(super) split: Option<Split>,
    pub(super) from: Option<f64>,
    pub(super) to: Option<f64>,
    pub(super) column_map: Option<PathBuf>,
}

/// Reads a CSV table of runs: the keys of `[[runs]]` as columns, blank where not given.
pub(super) fn read_table(path: &Path) -> Result<Vec<(usize, RunEntry)>, StudyError> {
    let read = |source: csv::Error| {
        let line = source.position().map_or(1, |p| p.line() as usize);
        let text = source.to_string();
        let quoted: Vec<&str> = text.split('`').skip(1).step_by(2).collect();
        let hint = match quoted.split_first() {
            Some((found, known)) if text.contains("unknown ") => suggestion(found, known.iter().copied()),
            _ => String::new(),
        };
        StudyError::Parse {
            path: path.to_owned(),
            line,
            message: format!("{text}{hint}; columns are file, name, session, manoeuvre, split, from, to, column_map"),
        }
    };
    let file = std::fs::File::open(path).map_err(|source| StudyError::Read {
        path: path.to_owned(),
        what: "table of runs",
        source,
    })?;
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(file);
    let headers = reader.headers().map_err(read)?.clone();
    let mut entries = Vec::new();
    for record in reader.records() {
        let record = record.map_err(read)?;
        let line = record.position().map_or(1, |p| p.line() as usize);
        entries.push((line, record.deserialize::<RunEntry>(Some(&headers)).map_err(read)?));
    }
    Ok(entries)
}
