//! The study file and an entry of its runs as they are written: keys, their defaults, and what serde reads them into.
//! It checks nothing beyond the shape; what the values mean is decided in `study` and `listed`.

use super::split::SplitRule;
use crate::recording::{Gaps, Split};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// The study file as written.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct StudyFile {
    /// Name of the study, for headings.
    pub(super) name: String,
    /// Ship file, relative to the study.
    pub(super) ship: PathBuf,
    /// Model file, relative to the study.
    pub(super) model: PathBuf,
    /// Folder of the recordings, relative to the study, or several of which the first that exists is used; `$NAME/...` begins with an
    /// environment variable. The study's own folder when left out.
    #[serde(default)]
    #[schemars(with = "OneOrMore")]
    pub(super) data: Candidates,
    /// Column map of all recordings that have none of their own; the canonical layout when left out.
    pub(super) column_map: Option<PathBuf>,
    /// Time step to which recordings are brought \[s\]; each recording's own when left out.
    pub(super) step: Option<f64>,
    /// Length of the windows into which runs are cut \[s\], each simulated from its own start; whole runs when left out.
    pub(super) window: Option<f64>,
    /// Time by which a window overlaps the one before \[s\].
    #[serde(default)]
    pub(super) window_overlap: f64,
    /// Time left out at the start of each run \[s\].
    #[serde(default)]
    pub(super) discard_start: f64,
    /// Time left out at the end of each run \[s\].
    #[serde(default)]
    pub(super) discard_end: f64,
    /// Where the initial state of a window comes from.
    #[serde(default)]
    pub(super) initial_state: InitialKind,
    /// Time over which a smoothed initial state is estimated \[s\]; needed with `initial_state = "smoothed"`.
    pub(super) initial_span: Option<f64>,
    /// What becomes of a run with missing values or jumps in time.
    #[serde(default)]
    pub(super) gaps: Gaps,
    /// The name of a CSV table of runs, or entries `[[runs]]`. Every study needs one of the two.
    #[schemars(with = "Option<TableOrEntries>")]
    pub(super) runs: Option<RunTable>,
    /// How runs are divided into train and test where no run has a `split`.
    pub(super) split: Option<SplitRule>,
    /// Settings of `trimtab fit`.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, bool>")]
    pub(super) fit: toml::Table,
    /// Settings of `trimtab evaluate`.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, bool>")]
    pub(super) evaluate: toml::Table,
    /// Settings of `trimtab diagnose`.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, bool>")]
    pub(super) diagnose: toml::Table,
    /// Settings of `trimtab maneuver`.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, bool>")]
    pub(super) maneuver: toml::Table,
    /// Settings of `trimtab plan`.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, bool>")]
    pub(super) plan: toml::Table,
}

/// The keys of a study file and of an entry `[[runs]]` as a JSON schema. The tables that commands read are open in it: their keys are
/// those of the settings of each command.
pub fn study_schema(generator: &mut SchemaGenerator) -> Schema {
    StudyFile::json_schema(generator)
}

/// Whether a key belongs at the top of a study file.
pub(super) fn is_key_of_a_study(key: &str) -> bool {
    let file = schemars::schema_for!(StudyFile);
    file.get("properties").is_some_and(|keys| keys.get(key).is_some())
}

/// `data` as it may be written.
#[derive(JsonSchema)]
#[serde(untagged)]
#[allow(dead_code)] // a shape for the schema; `Candidates` is what is read
enum OneOrMore {
    /// One folder.
    One(String),
    /// Several.
    More(Vec<String>),
}

/// `runs` as it may be written.
#[derive(JsonSchema)]
#[serde(untagged)]
#[allow(dead_code)] // a shape for the schema; `RunTable` is what is read
enum TableOrEntries {
    /// A CSV table.
    Table(String),
    /// `[[runs]]`.
    Entries(Vec<RunEntry>),
}

/// Where the initial state of a window comes from.
#[derive(Clone, Copy, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(super) enum InitialKind {
    /// The first row as recorded.
    #[default]
    First,
    /// A uniformly accelerated motion fitted to the first `initial_span` seconds.
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
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct RunEntry {
    /// The recording, relative to `data`.
    pub(super) file: PathBuf,
    /// Name of the run; the file's name without its ending when left out.
    pub(super) name: Option<String>,
    /// What shares a hidden condition (a day, a loading): runs of one session have the same weather for a diagnosis.
    pub(super) session: Option<String>,
    /// Kind of manoeuvre, for tables.
    pub(super) manoeuvre: Option<String>,
    /// Side of the split; give it to every run or to none.
    pub(super) split: Option<Split>,
    /// First time used \[s\], on the recording's clock.
    pub(super) from: Option<f64>,
    /// Last time used \[s\].
    pub(super) to: Option<f64>,
    /// Column map of this run, relative to the study, instead of the study's.
    pub(super) column_map: Option<PathBuf>,
}
