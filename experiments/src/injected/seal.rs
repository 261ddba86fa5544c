//! The truth of a case, sealed: written beside the study before the diagnosis begins, and opened after it has ended.
//! A byte that changes in the manifest or in the study in between is found by its digest.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::effect::Injection;
use super::error::InjectedError;
use super::set::Set;
use crate::conceal::error::ConcealError;
use crate::conceal::seal::{digest, paths};

/// The mean wind over the recordings of a session, from the anemometer on board.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Witness {
    /// The session.
    pub session: String,
    /// Velocity to north and to east over ground \[m/s\], over its training recordings.
    pub wind: [f64; 2],
}

/// The truth of a case, as the judge reads it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// Key of the case.
    pub case: String,
    /// Kind of the case.
    pub kind: String,
    /// The set.
    pub set: Set,
    /// What was injected.
    pub injections: Vec<Injection>,
    /// Sessions in which it acts; empty for all.
    pub sessions: Vec<String>,
    /// What the anemometer says, where there was one.
    pub winds: Vec<Witness>,
    /// SHA-256 of every file of the study.
    pub files: BTreeMap<String, String>,
}

fn write(path: &Path, text: &[u8]) -> Result<(), InjectedError> {
    let fail = |source| InjectedError::file(path, source);
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(fail)?;
    }
    std::fs::write(path, text).map_err(fail)
}

fn read(path: &Path) -> Result<Vec<u8>, InjectedError> {
    std::fs::read(path).map_err(|source| InjectedError::file(path, source))
}

/// Writes `study/` with its `SEAL`, and `sealed/manifest.json`; the digests of the files are added to the manifest. Gives the
/// study file.
///
/// # Errors
/// [`InjectedError::Case`].
pub fn write_sealed(
    folder: &Path,
    files: &[(String, String)],
    mut manifest: Manifest,
) -> Result<PathBuf, InjectedError> {
    let (study, seal, sealed) = paths(folder);
    for (name, text) in files {
        write(&study.with_file_name(name), text.as_bytes())?;
        manifest.files.insert(name.clone(), digest(text.as_bytes()));
    }
    let text = serde_json::to_string_pretty(&manifest).map_err(|e| InjectedError::content(&sealed, &e))?;
    write(&sealed, text.as_bytes())?;
    write(&seal, format!("{}\n", digest(text.as_bytes())).as_bytes())?;
    Ok(study)
}

/// Opens a sealed manifest, if no byte of it and of the study has changed.
///
/// # Errors
/// [`InjectedError::Case`] when a byte has changed or a file is unreadable.
pub fn open(folder: &Path) -> Result<Manifest, InjectedError> {
    let (study, seal, sealed) = paths(folder);
    let bytes = read(&sealed)?;
    let said = String::from_utf8_lossy(&read(&seal)?).trim().to_owned();
    check(&sealed, &bytes, &said)?;
    let manifest: Manifest = serde_json::from_slice(&bytes).map_err(|e| InjectedError::content(&sealed, &e))?;
    for (name, said) in &manifest.files {
        let path = study.with_file_name(name);
        check(&path, &read(&path)?, said)?;
    }
    Ok(manifest)
}

fn check(path: &Path, bytes: &[u8], sealed: &str) -> Result<(), InjectedError> {
    let found = digest(bytes);
    if found == sealed {
        return Ok(());
    }
    Err(ConcealError::Broken { path: path.to_owned(), found, sealed: sealed.to_owned() }.into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_changed_byte_of_study_or_manifest_breaks_the_seal() {
        let folder = tempfile::tempdir().unwrap();
        let manifest = Manifest {
            case: "marin/null/001".into(),
            kind: "null".into(),
            set: Set::Marin,
            injections: Vec::new(),
            sessions: Vec::new(),
            winds: Vec::new(),
            files: BTreeMap::new(),
        };
        let files = [("study.toml".to_owned(), "name = \"case\"\n".to_owned())];
        let study = write_sealed(folder.path(), &files, manifest.clone()).unwrap();
        assert_eq!(open(folder.path()).unwrap().case, manifest.case);
        std::fs::write(&study, "name = \"Case\"\n").unwrap();
        assert!(open(folder.path()).unwrap_err().to_string().contains("has been changed"));
        write_sealed(folder.path(), &files, manifest).unwrap();
        let sealed = folder.path().join("sealed/manifest.json");
        let text = std::fs::read_to_string(&sealed).unwrap().replace("null", "pair");
        std::fs::write(&sealed, text).unwrap();
        assert!(open(folder.path()).unwrap_err().to_string().contains("has been changed"));
    }
}
