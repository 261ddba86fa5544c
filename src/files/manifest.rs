//! What a folder of results says of itself: `manifest.json` (command, version, inputs, settings, files) and `timing.json` (when).
//! It reads and writes these two; which files are placed and removed is decided in `folder`.

use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::io::{Error, ErrorKind};
use std::path::{Component, Path};

/// Name of the manifest.
pub const MANIFEST: &str = "manifest.json";

/// Name of the file with times, which two equal runs do not have in common.
pub const TIMING: &str = "timing.json";

/// How the results in a folder came about, an entry for each command that wrote into it. Equal runs have equal manifests.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    /// The last result of each command, by its name.
    pub results: BTreeMap<String, Entry>,
}

/// How one result came about.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// Version of trimtab.
    pub version: String,
    /// Arguments, without those that a result does not depend on (`--out`, `--json`, `--threads`).
    pub arguments: Vec<String>,
    /// Settings by table, with every default.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub settings: BTreeMap<String, Value>,
    /// The files that were read, as the command named them.
    pub inputs: Vec<Input>,
    /// SHA-256 of each file of the result, by name in the folder.
    pub files: BTreeMap<String, String>,
    /// Files of the result that another command has replaced since: file, command.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub replaced: BTreeMap<String, String>,
}

/// A file that was read.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Input {
    /// Its path.
    pub path: String,
    /// Its SHA-256; absent where it could not be read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sha256: Option<String>,
}

/// When a result was made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Timing {
    /// Date and time of the begin, UTC.
    pub began: String,
    /// Date and time at which the result was complete, UTC.
    pub completed: String,
    /// Time taken \[s\].
    pub seconds: f64,
}

impl Manifest {
    /// The manifest of a folder; an empty one where there is none.
    ///
    /// # Errors
    /// Those of the file system, and [`ErrorKind::InvalidData`] for a file of that name that is something else.
    pub fn read(folder: &Path) -> Result<Self, Error> {
        let manifest: Self = read(&folder.join(MANIFEST), "a manifest of trimtab")?;
        let outside = |name: &&String| !Path::new(name).components().all(|c| matches!(c, Component::Normal(_)));
        match manifest.results.values().flat_map(|entry| entry.files.keys()).find(outside) {
            Some(name) => {
                Err(Error::new(ErrorKind::InvalidData, format!("it lists `{name}`, which is not in the folder")))
            }
            None => Ok(manifest),
        }
    }

    /// The digest with which a file was written, by whichever command.
    pub fn digest(&self, name: &str) -> Option<&str> {
        self.results.values().find_map(|entry| entry.files.get(name)).map(String::as_str)
    }
}

/// The times of a folder; none where there is no such file.
///
/// # Errors
/// As [`Manifest::read`].
pub fn timings(folder: &Path) -> Result<BTreeMap<String, Timing>, Error> {
    read(&folder.join(TIMING), "a file of times of trimtab")
}

fn read<T: Default + serde::de::DeserializeOwned>(path: &Path, what: &str) -> Result<T, Error> {
    let text = match std::fs::read(path) {
        Ok(text) => text,
        Err(e) if e.kind() == ErrorKind::NotFound => return Ok(T::default()),
        Err(e) => return Err(e),
    };
    serde_json::from_slice(&text).map_err(|e| Error::new(ErrorKind::InvalidData, format!("it is not {what}: {e}")))
}

/// A value as the text of a JSON file.
///
/// # Errors
/// [`ErrorKind::InvalidData`] for a value that JSON cannot express.
pub fn json(value: &impl Serialize) -> Result<Vec<u8>, Error> {
    let mut text = serde_json::to_vec_pretty(value)?;
    text.push(b'\n');
    Ok(text)
}
