//! A folder of results that is whole or as it was before: files are written aside, and take their places together at the end.
//! What is in the files is with those who write them; what the folder says of itself is in `manifest`.

use super::date::utc;
use super::digest::{sha256, sha256_of};
use super::lock::{Lock, LockError};
use super::manifest::{Entry, Input, MANIFEST, Manifest, TIMING, Timing, json, timings};
use super::seal::intact;
use super::whole::{fill_whole, write_whole};
use rayon::prelude::*;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::io::{Error, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

/// Folder in the folder of results for what is not in its place yet.
const ASIDE: &str = ".trimtab-unfinished";

/// File there with the files of an earlier result that are to be removed.
const STALE: &str = "stale.json";

/// File there with the manifest before: a file that does not agree with it was edited.
const BEFORE: &str = "before.json";

/// How often, and how long each time, a reader waits for another process that is putting a result into its places.
const WAITS: (usize, Duration) = (100, Duration::from_millis(20));

/// Folder there with the files of the result.
const FILES: &str = "files";

/// Why a folder could not be used for results.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FolderError {
    /// There is a file where the folder should be.
    #[error("{}: cannot write into it: this is a file, not a folder; choose another folder", path.display())]
    NoFolder {
        /// The file.
        path: PathBuf,
    },
    /// A file or folder could not be read or written.
    #[error("{}: cannot write ({source}); check that the folder is writable and the disk not full", path.display())]
    Write {
        /// Where.
        path: PathBuf,
        /// What the system said.
        source: Error,
    },
    /// Another process writes into it, or it cannot be locked.
    #[error("{}: {source}", path.display())]
    Lock {
        /// The folder.
        path: PathBuf,
        /// What is wrong.
        source: LockError,
    },
    /// A file of the name of the manifest or of the times is something else.
    #[error("{}: {message}; move it away, or choose another folder", path.display())]
    Manifest {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        message: String,
    },
    /// A file would be overwritten that no manifest lists.
    #[error(
        "{}: `{command}` would overwrite this file, and no {MANIFEST} beside it says that trimtab wrote it; move it away, or choose another folder{}", path.display(), kept.as_ref().map_or(String::new(), |k| format!(" (the new files are kept in {})", k.display()))
    )]
    Foreign {
        /// The file.
        path: PathBuf,
        /// The command.
        command: String,
        /// Where the new files are.
        kept: Option<PathBuf>,
    },
    /// A file would be overwritten that was edited.
    #[error(
        "{}: `{command}` would overwrite this file, which was changed after trimtab wrote it; rename or remove it, or choose another folder{}", path.display(), kept.as_ref().map_or(String::new(), |k| format!(" (the new files are kept in {})", k.display()))
    )]
    Edited {
        /// The file.
        path: PathBuf,
        /// The command.
        command: String,
        /// Where the new files are.
        kept: Option<PathBuf>,
    },
    /// A file that was read has changed since.
    #[error("{}: the file changed while the command read it, so that the result is of no known input; run the command again", path.display())]
    InputChanged {
        /// The file.
        path: PathBuf,
    },
}

/// How a result came about, beside its inputs.
#[derive(Clone, Debug, Default)]
pub struct Origin {
    /// Arguments that a result depends on.
    pub arguments: Vec<String>,
    /// Settings by table.
    pub settings: BTreeMap<String, Value>,
}

/// A folder that a command writes its result into. Until [`ResultFolder::complete`] it contains the result before; what is dropped
/// earlier leaves nothing.
#[derive(Debug)]
pub struct ResultFolder {
    folder: PathBuf,
    command: String,
    before: Manifest,
    inputs: Vec<Seen>,
    files: BTreeMap<String, String>,
    left: BTreeSet<String>,
    began: (SystemTime, Instant),
    // Dropped last: what is aside is removed under the lock.
    aside: Aside,
    _lock: Lock,
}

/// An input as it was when it was read.
#[derive(Debug)]
struct Seen {
    path: PathBuf,
    sha256: Option<String>,
    stamp: Option<(u64, SystemTime)>,
}

/// The folder of what is not in its place yet; removed when dropped, unless it has been given up.
#[derive(Debug)]
struct Aside(Option<PathBuf>);

impl Drop for Aside {
    fn drop(&mut self) {
        if let Some(path) = &self.0 {
            let _ = std::fs::remove_dir_all(path);
        }
    }
}

/// A file that is rewritten again and again while a command runs, whole each time; it is no part of the result.
#[derive(Clone, Debug)]
pub struct Kept {
    aside: PathBuf,
    path: PathBuf,
}

impl Kept {
    /// Writes it.
    ///
    /// # Errors
    /// Those of the file system; what was there before is then still there.
    pub fn write(&self, bytes: &[u8]) -> Result<(), Error> {
        write_whole(&self.aside, bytes)?;
        std::fs::rename(&self.aside, &self.path)
    }

    /// Removes it, if it is there.
    pub fn remove(&self) {
        let _ = std::fs::remove_file(&self.path);
    }
}

impl ResultFolder {
    /// Makes a folder ready for the result of a command: created, locked, writable. `expected` are names of files that the
    /// command writes whatever its input is; what could not be overwritten at the end is reported now.
    ///
    /// # Errors
    /// Every [`FolderError`] but [`FolderError::InputChanged`].
    pub fn open(folder: &Path, command: &str, expected: &[&str]) -> Result<Self, FolderError> {
        Self::open_with(folder, command, expected, &[])
    }

    /// As [`Self::open`]; the files `edited` are there for the user to edit, and are looked at only where the command writes them anew.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub fn open_with(folder: &Path, command: &str, expected: &[&str], edited: &[&str]) -> Result<Self, FolderError> {
        if folder.is_file() {
            return Err(FolderError::NoFolder { path: folder.to_owned() });
        }
        std::fs::create_dir_all(folder).map_err(write_error(folder))?;
        let lock = Lock::take(folder).map_err(|source| FolderError::Lock { path: folder.to_owned(), source })?;
        let path = folder.join(ASIDE);
        if path.join(MANIFEST).is_file() {
            // A process was stopped while it put a whole result into its places.
            place(folder, &path)?;
        }
        match std::fs::remove_dir_all(&path) {
            Err(e) if e.kind() != ErrorKind::NotFound => return Err(write_error(&path)(e)),
            _ => {}
        }
        let before = Manifest::read(folder).map_err(manifest_error(folder.join(MANIFEST)))?;
        timings(folder).map_err(manifest_error(folder.join(TIMING)))?;
        let aside = Aside(Some(path.clone()));
        std::fs::create_dir_all(path.join(FILES)).map_err(write_error(&path))?;
        let opened = Self {
            folder: folder.to_owned(),
            command: command.to_owned(),
            before,
            inputs: Vec::new(),
            files: BTreeMap::new(),
            left: BTreeSet::new(),
            began: (SystemTime::now(), Instant::now()),
            aside,
            _lock: lock,
        };
        let own = opened.before.results.get(command).into_iter().flat_map(|entry| entry.files.keys());
        let names: BTreeSet<&str> = own.map(String::as_str).chain(expected.iter().copied()).collect();
        names.iter().filter(|name| !edited.contains(name)).try_for_each(|name| opened.may_take(name))?;
        Ok(opened)
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.folder
    }

    /// Notes the files that the command reads, with their digests; one that cannot be read is noted without, since the command
    /// has more to say of it.
    pub fn reads(&mut self, files: &[PathBuf]) {
        // A pipe can be read once only, by the command.
        let digest = |path: &PathBuf| path.is_file().then(|| sha256_of(path).ok()).flatten();
        let seen = |path: &PathBuf| Seen { path: path.clone(), stamp: stamp(path), sha256: digest(path) };
        self.inputs.par_extend(files.par_iter().map(seen));
    }

    /// The inputs that were noted: path, digest, and the time of the last change.
    pub fn inputs(&self) -> impl Iterator<Item = (&Path, Option<&str>, Option<SystemTime>)> {
        self.inputs
            .iter()
            .map(|seen| (seen.path.as_path(), seen.sha256.as_deref(), seen.stamp.map(|(_, changed)| changed)))
    }

    /// One digest of all inputs that were noted, whatever they are called.
    pub fn inputs_digest(&self) -> String {
        let mut digests: Vec<&str> = self.inputs.iter().map(|seen| seen.sha256.as_deref().unwrap_or("none")).collect();
        digests.sort_unstable();
        sha256(digests.join(" ").as_bytes())
    }

    /// Writes a file of the result; `name` may have folders of its own.
    ///
    /// # Errors
    /// [`FolderError::Write`].
    pub fn write(&mut self, name: impl AsRef<Path>, bytes: &[u8]) -> Result<(), FolderError> {
        let path = self.staged(&name)?;
        write_whole(&path, bytes).map_err(write_error(&self.folder.join(&name)))?;
        self.files.insert(slashed(name.as_ref()), sha256(bytes));
        Ok(())
    }

    /// As [`Self::write`], with what `fill` writes piece by piece.
    ///
    /// # Errors
    /// [`FolderError::Write`].
    pub fn fill(
        &mut self,
        name: impl AsRef<Path>,
        fill: impl FnOnce(&mut dyn Write) -> Result<(), Error>,
    ) -> Result<(), FolderError> {
        let path = self.staged(&name)?;
        fill_whole(&path, fill).map_err(write_error(&self.folder.join(&name)))?;
        self.written(name)
    }

    /// Where a file of the result is to be written, for those who write it themselves and then say [`Self::written`].
    ///
    /// # Errors
    /// [`FolderError::Write`], where its folder cannot be made.
    pub fn staged(&self, name: impl AsRef<Path>) -> Result<PathBuf, FolderError> {
        let path = self.aside().join(FILES).join(name);
        if let Some(parent) = path.parent() {
            std::fs::create_dir_all(parent).map_err(write_error(parent))?;
        }
        Ok(path)
    }

    /// Takes a file that was written where [`Self::staged`] said.
    ///
    /// # Errors
    /// [`FolderError::Write`], where it cannot be read.
    pub fn written(&mut self, name: impl AsRef<Path>) -> Result<(), FolderError> {
        let digest = sha256_of(&self.staged(&name)?).map_err(write_error(&self.folder.join(&name)))?;
        self.files.insert(slashed(name.as_ref()), digest);
        Ok(())
    }

    /// Leaves a file of the result before as it is: it is not removed, and is one of this result too where nobody has changed it.
    pub fn leave(&mut self, name: &str) {
        self.left.insert(name.to_owned());
    }

    /// A file in the folder that can be seen while the command runs.
    pub fn kept(&self, name: &str) -> Kept {
        Kept { aside: self.aside().join(name), path: self.folder.join(name) }
    }

    /// Puts the result into its places: removes what the command's result before had and this one has not, and writes the
    /// manifest last. Gives the paths of the files, in the order of their names.
    ///
    /// # Errors
    /// [`FolderError`]; where a file is in the way, the result is kept in a folder that the error names.
    pub fn complete(mut self, origin: Origin) -> Result<Vec<PathBuf>, FolderError> {
        if let Some(changed) = self.inputs.iter().find(|seen| seen.changed()) {
            return Err(FolderError::InputChanged { path: changed.path.clone() });
        }
        if let Err(error) = self.files.keys().try_for_each(|name| self.may_take(name)) {
            let kept = self.give_up();
            return Err(match error {
                FolderError::Foreign { path, command, .. } => FolderError::Foreign { path, command, kept },
                FolderError::Edited { path, command, .. } => FolderError::Edited { path, command, kept },
                other => other,
            });
        }
        self.stage(origin)?;
        let aside = self.aside().to_owned();
        self.aside.0 = None;
        place(&self.folder, &aside)?;
        Ok(self.files.keys().map(|name| self.folder.join(name)).collect())
    }

    /// Writes beside the files what [`place`] needs, the manifest last: with it the result is whole, and whoever opens the
    /// folder next puts it into its places.
    fn stage(&self, origin: Origin) -> Result<(), FolderError> {
        let mut stale = self.before.results.get(&self.command).map(|e| e.files.clone()).unwrap_or_default();
        stale.retain(|name, _| !self.files.contains_key(name) && !self.left.contains(name));
        let mut times = timings(&self.folder).map_err(manifest_error(self.folder.join(TIMING)))?;
        let (began, clock) = self.began;
        let timing = Timing {
            began: utc(began),
            completed: utc(SystemTime::now()),
            seconds: (clock.elapsed().as_secs_f64() * 1e3).round() / 1e3,
        };
        times.insert(self.command.clone(), timing);
        let (aside, fail) = (self.aside(), write_error(&self.folder));
        json(&stale).and_then(|text| write_whole(&aside.join(STALE), &text)).map_err(&fail)?;
        json(&self.before).and_then(|text| write_whole(&aside.join(BEFORE), &text)).map_err(&fail)?;
        json(&times).and_then(|text| write_whole(&aside.join(TIMING), &text)).map_err(&fail)?;
        json(&self.manifest(origin)).and_then(|text| write_whole(&aside.join(MANIFEST), &text)).map_err(&fail)
    }

    fn aside(&self) -> &Path {
        self.aside.0.as_deref().unwrap_or(&self.folder)
    }

    /// The manifest with this result in it.
    fn manifest(&self, origin: Origin) -> Manifest {
        let mut manifest = self.before.clone();
        for entry in manifest.results.values_mut() {
            for name in self.files.keys().filter(|name| entry.files.contains_key(*name)).cloned().collect::<Vec<_>>() {
                entry.files.remove(&name);
                entry.replaced.insert(name, self.command.clone());
            }
        }
        let mut inputs: Vec<Input> = self.inputs.iter().map(Seen::input).collect();
        inputs.sort();
        inputs.dedup();
        let entry = Entry {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            arguments: origin.arguments,
            settings: origin.settings,
            inputs,
            files: self.files.clone().into_iter().chain(self.unchanged()).collect(),
            replaced: BTreeMap::new(),
        };
        manifest.results.insert(self.command.clone(), entry);
        manifest
    }

    /// The files of this command's result before that are left and that nobody has changed, with their digests.
    fn unchanged(&self) -> Vec<(String, String)> {
        let own = self.before.results.get(&self.command).map(|entry| &entry.files);
        let left = self.left.iter().filter_map(|name| Some((name.clone(), own?.get(name)?.clone())));
        left.filter(|(name, digest)| sha256_of(&self.folder.join(name)).is_ok_and(|found| found == *digest)).collect()
    }

    /// Whether a file of this name may be written: none is there, or one that a manifest lists and nobody has changed, or a
    /// model file as trimtab wrote it.
    fn may_take(&self, name: &str) -> Result<(), FolderError> {
        let (path, command) = (self.folder.join(name), self.command.clone());
        if std::fs::symlink_metadata(&path).is_err_and(|e| e.kind() == ErrorKind::NotFound) {
            return Ok(());
        }
        match self.before.digest(name) {
            Some(listed) if is_own(&path, listed) => Ok(()),
            Some(_) => Err(FolderError::Edited { path, command, kept: None }),
            None if is_model(&path) => Ok(()),
            None => Err(FolderError::Foreign { path, command, kept: None }),
        }
    }

    /// Keeps what is aside under a name of its own; `None` where that cannot be done, and it is removed.
    fn give_up(&mut self) -> Option<PathBuf> {
        let files = self.aside().join(FILES);
        let mut names = (1..).map(|i| self.folder.join(format!("not-placed-{i}")));
        let kept = names.find(|path| !path.exists())?;
        std::fs::rename(files, &kept).ok()?;
        Some(kept)
    }
}

impl Seen {
    /// Whether the file is another one than when it was read.
    fn changed(&self) -> bool {
        self.sha256.is_some() && stamp(&self.path) != self.stamp && sha256_of(&self.path).ok() != self.sha256
    }

    fn input(&self) -> Input {
        Input { path: self.path.to_string_lossy().replace('\\', "/"), sha256: self.sha256.clone() }
    }
}

/// Size and time of the last change.
fn stamp(path: &Path) -> Option<(u64, SystemTime)> {
    let about = std::fs::metadata(path).ok()?;
    Some((about.len(), about.modified().ok()?))
}

/// Puts a result into its places that a process was stopped with, in the folder of `path` or one above it: whoever reads a file there
/// has the result before or the new one, and no mixture.
///
/// # Errors
/// [`FolderError`]; where another process is at it and does not come to its end, [`FolderError::Lock`].
pub fn settle(path: &Path) -> Result<(), FolderError> {
    let Ok(here) = std::path::absolute(".") else { return Ok(()) };
    let path = here.join(path);
    for folder in path.ancestors() {
        let aside = folder.join(ASIDE);
        let unfinished = || aside.join(MANIFEST).is_file();
        for wait in 0.. {
            if !unfinished() {
                break;
            }
            match Lock::take(folder) {
                Ok(_lock) if unfinished() => place(folder, &aside)?,
                Ok(_) => {}
                Err(_) if wait < WAITS.0 => std::thread::sleep(WAITS.1),
                Err(source) => return Err(FolderError::Lock { path: folder.to_owned(), source }),
            }
        }
    }
    Ok(())
}

/// Whether a file is as it was written.
fn is_own(path: &Path, listed: &str) -> bool {
    sha256_of(path).is_ok_and(|digest| digest == listed)
}

/// Whether a file is a model file as trimtab wrote it.
fn is_model(path: &Path) -> bool {
    std::fs::read_to_string(path).is_ok_and(|text| intact(&text) == Ok(true))
}

/// Whether a file that is in the place of one that is aside may be replaced: the user may have edited it since the process was stopped.
fn check_edited(folder: &Path, aside: &Path) -> Result<(), FolderError> {
    // Who wrote no list of the files before was stopped by an earlier version.
    let Ok(text) = std::fs::read(aside.join(BEFORE)) else { return Ok(()) };
    let before: Manifest = serde_json::from_slice(&text).unwrap_or_default();
    let new = std::fs::read(aside.join(MANIFEST)).unwrap_or_default();
    let new: Manifest = serde_json::from_slice(&new).unwrap_or_default();
    let files = aside.join(FILES);
    for name in listed(&files).map_err(write_error(&files))? {
        let (path, name) = (folder.join(&name), slashed(&name));
        let known = [&before, &new].iter().any(|manifest| manifest.digest(&name).is_some_and(|d| is_own(&path, d)));
        if !known && !is_model(&path) && std::fs::symlink_metadata(&path).is_ok() {
            let command = new.results.iter().find(|(_, entry)| entry.files.contains_key(&name));
            let command = command.map_or_else(|| "trimtab".to_owned(), |(command, _)| command.clone());
            return Err(FolderError::Edited { path, command, kept: Some(files) });
        }
    }
    Ok(())
}

/// Puts what is aside, of which the manifest is there, into its places. Done in part, it can be done again.
fn place(folder: &Path, aside: &Path) -> Result<(), FolderError> {
    check_edited(folder, aside)?;
    // Without a manifest the folder does not pass for whole meanwhile.
    remove(&folder.join(MANIFEST))?;
    let stale = std::fs::read(aside.join(STALE)).unwrap_or_default();
    let stale: BTreeMap<String, String> = serde_json::from_slice(&stale).unwrap_or_default();
    for (name, digest) in &stale {
        let path = folder.join(name);
        if sha256_of(&path).is_ok_and(|found| found == *digest) {
            remove(&path)?;
            // The folder goes with its last file.
            let above = path.ancestors().skip(1).take_while(|above| *above != folder);
            above.take_while(|above| std::fs::remove_dir(above).is_ok()).for_each(drop);
        }
    }
    let files = aside.join(FILES);
    for name in listed(&files).map_err(write_error(&files))? {
        let path = folder.join(&name);
        if let Some(parent) = path.parent() {
            std::fs::create_dir_all(parent).map_err(write_error(parent))?;
        }
        moved(&files.join(&name), &path).map_err(write_error(&path))?;
    }
    for name in [TIMING, MANIFEST] {
        let (from, to) = (aside.join(name), folder.join(name));
        if from.is_file() {
            moved(&from, &to).map_err(write_error(&to))?;
        }
    }
    std::fs::remove_dir_all(aside).map_err(write_error(aside))
}

/// Renames a file, or copies it where its new place is on another file system.
fn moved(from: &Path, to: &Path) -> Result<(), Error> {
    match std::fs::rename(from, to) {
        Err(e) if e.kind() == ErrorKind::CrossesDevices => {
            let mut file = std::fs::File::open(from)?;
            fill_whole(to, |out| std::io::copy(&mut file, out).map(drop))?;
            std::fs::remove_file(from)
        }
        other => other,
    }
}

fn remove(path: &Path) -> Result<(), FolderError> {
    match std::fs::remove_file(path) {
        Err(e) if e.kind() != ErrorKind::NotFound => Err(write_error(path)(e)),
        _ => Ok(()),
    }
}

/// The files in a folder and those below it, relative to it, in the order of their names.
fn listed(folder: &Path) -> Result<BTreeSet<PathBuf>, Error> {
    let (mut found, mut open) = (BTreeSet::new(), vec![folder.to_owned()]);
    while let Some(next) = open.pop() {
        for entry in std::fs::read_dir(next)? {
            let path = entry?.path();
            if path.is_dir() {
                open.push(path);
            } else if let Ok(name) = path.strip_prefix(folder) {
                found.insert(name.to_owned());
            }
        }
    }
    Ok(found)
}

/// A relative path as text that is the same on every system.
fn slashed(name: &Path) -> String {
    name.iter().map(|part| part.to_string_lossy()).collect::<Vec<_>>().join("/")
}

fn write_error(path: &Path) -> impl Fn(Error) -> FolderError + use<> {
    let path = path.to_owned();
    move |source| FolderError::Write { path: path.clone(), source }
}

fn manifest_error(path: PathBuf) -> impl FnOnce(Error) -> FolderError {
    move |source| match source.kind() {
        ErrorKind::InvalidData => FolderError::Manifest { path, message: source.to_string() },
        _ => FolderError::Write { path, source },
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use std::fs;

    /// Writes a result of these files, name and content alike.
    fn result(folder: &Path, command: &str, names: &[&str]) -> Result<Vec<PathBuf>, FolderError> {
        let mut open = ResultFolder::open(folder, command, &names[..1])?;
        names.iter().try_for_each(|name| open.write(name, name.as_bytes()))?;
        open.complete(Origin::default())
    }

    /// What is in the folder, without the files about the result.
    fn there(folder: &Path) -> Vec<String> {
        let names = listed(folder).unwrap().into_iter().map(|name| slashed(&name));
        names.filter(|name| name != TIMING && name != MANIFEST).collect()
    }

    fn entry(folder: &Path, command: &str) -> Entry {
        Manifest::read(folder).unwrap().results.remove(command).unwrap()
    }

    /// The files of every command in the manifest are there with their digests.
    fn assert_whole(folder: &Path) {
        for (name, digest) in Manifest::read(folder).unwrap().results.values().flat_map(|entry| &entry.files) {
            assert_eq!(sha256_of(&folder.join(name)).unwrap(), *digest, "{name}");
        }
        assert!(folder.join(MANIFEST).is_file() && !folder.join(ASIDE).exists());
    }

    #[test]
    fn a_repeated_command_leaves_no_file_of_its_result_before_and_the_same_manifest() {
        let folder = tempfile::tempdir().unwrap();
        result(folder.path(), "fit", &["a", "runs/1", "runs/2"]).unwrap();
        let first = fs::read(folder.path().join(MANIFEST)).unwrap();
        fs::write(folder.path().join("own notes"), "kept").unwrap();
        assert_eq!(result(folder.path(), "fit", &["a"]).unwrap(), [folder.path().join("a")]);
        assert_eq!(there(folder.path()), ["a", "own notes"]);
        assert!(!folder.path().join("runs").exists());
        result(folder.path(), "fit", &["a", "runs/1", "runs/2"]).unwrap();
        assert_eq!(fs::read(folder.path().join(MANIFEST)).unwrap(), first);
        assert_whole(folder.path());
        let times = timings(folder.path()).unwrap();
        assert!(times["fit"].seconds >= 0.0 && times["fit"].began <= times["fit"].completed);
    }

    #[test]
    fn the_manifest_has_inputs_settings_and_what_another_command_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let (out, input) = (folder.path().join("out"), folder.path().join("study.toml"));
        fs::write(&input, "abc").unwrap();
        let mut open = ResultFolder::open(&out, "fit", &[]).unwrap();
        open.reads(&[input.clone(), folder.path().join("missing")]);
        open.write("a", b"1").unwrap();
        open.write("tracks.png", b"1").unwrap();
        let settings = BTreeMap::from([("fit".to_owned(), serde_json::json!({"step": 0.1}))]);
        open.complete(Origin { arguments: vec!["study.toml".to_owned()], settings }).unwrap();
        let manifest = entry(&out, "fit");
        assert_eq!(
            (manifest.version.as_str(), manifest.arguments.as_slice()),
            (env!("CARGO_PKG_VERSION"), &["study.toml".to_owned()][..])
        );
        assert_eq!(manifest.settings["fit"]["step"], 0.1);
        assert_eq!(manifest.inputs[0].sha256, None);
        assert_eq!(manifest.inputs[1], Input { path: input.display().to_string(), sha256: Some(sha256(b"abc")) });
        result(&out, "evaluate", &["tracks.png"]).unwrap();
        let manifest = entry(&out, "fit");
        assert_eq!(manifest.files.keys().collect::<Vec<_>>(), ["a"]);
        assert_eq!(manifest.replaced["tracks.png"], "evaluate");
        assert_whole(&out);
    }

    #[test]
    fn of_two_results_at_a_time_the_second_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let first = ResultFolder::open(folder.path(), "fit", &[]).unwrap();
        let error = ResultFolder::open(folder.path(), "evaluate", &[]).unwrap_err().to_string();
        assert!(error.contains("another process (number"), "{error}");
        first.complete(Origin::default()).unwrap();
        result(folder.path(), "evaluate", &["a"]).unwrap();
    }

    #[test]
    fn files_of_the_user_are_reported_before_the_work_and_stay() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("a"), "of the user").unwrap();
        let error = result(folder.path(), "fit", &["a"]).unwrap_err();
        assert!(matches!(error, FolderError::Foreign { kept: None, .. }), "{error}");
        assert_eq!(fs::read_to_string(folder.path().join("a")).unwrap(), "of the user");
        fs::remove_file(folder.path().join("a")).unwrap();
        result(folder.path(), "fit", &["a", "b"]).unwrap();
        fs::write(folder.path().join("b"), "edited").unwrap();
        let error = result(folder.path(), "fit", &["a", "b"]).unwrap_err();
        assert!(matches!(&error, FolderError::Edited { path, .. } if path.ends_with("b")), "{error}");
        assert_eq!(there(folder.path()), ["a", "b"]);
        // One that was removed, or renamed, is in nobody's way.
        fs::rename(folder.path().join("b"), folder.path().join("c")).unwrap();
        result(folder.path(), "fit", &["a", "b"]).unwrap();
        assert_eq!(there(folder.path()), ["a", "b", "c"]);
        fs::write(folder.path().join(MANIFEST), "{\"name\": \"web app\"}").unwrap();
        let error = result(folder.path(), "fit", &["a"]).unwrap_err();
        assert!(matches!(error, FolderError::Manifest { .. }), "{error}");
    }

    #[test]
    fn a_manifest_that_lists_files_elsewhere_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let entry = Entry { files: BTreeMap::from([("../own".to_owned(), sha256(b"own"))]), ..Entry::default() };
        let manifest = Manifest { results: BTreeMap::from([("fit".to_owned(), entry)]) };
        fs::write(folder.path().join(MANIFEST), json(&manifest).unwrap()).unwrap();
        let error = result(folder.path(), "fit", &["a"]).unwrap_err().to_string();
        assert!(error.contains("`../own`, which is not in the folder"), "{error}");
    }

    #[test]
    fn a_result_with_a_file_in_its_way_is_kept_beside() {
        let folder = tempfile::tempdir().unwrap();
        let mut open = ResultFolder::open(folder.path(), "fit", &[]).unwrap();
        open.write("runs/1", b"new").unwrap();
        fs::create_dir(folder.path().join("runs")).unwrap();
        fs::write(folder.path().join("runs/1"), "of the user").unwrap();
        let error = open.complete(Origin::default()).unwrap_err().to_string();
        assert!(error.contains("kept in") && error.contains("not-placed-1"), "{error}");
        assert_eq!(there(folder.path()), ["not-placed-1/runs/1", "runs/1"]);
        assert_eq!(fs::read_to_string(folder.path().join("not-placed-1/runs/1")).unwrap(), "new");
    }

    #[test]
    fn what_is_not_completed_leaves_the_result_before() {
        let folder = tempfile::tempdir().unwrap();
        result(folder.path(), "fit", &["a", "b"]).unwrap();
        let mut open = ResultFolder::open(folder.path(), "fit", &[]).unwrap();
        open.write("a", b"other").unwrap();
        drop(open);
        assert_whole(folder.path());
        assert_eq!(there(folder.path()), ["a", "b"]);
        // So does a process that was killed: its files are aside, and go when the folder is opened next.
        fs::create_dir_all(folder.path().join(ASIDE).join(FILES)).unwrap();
        fs::write(folder.path().join(ASIDE).join(FILES).join("a"), "half").unwrap();
        result(folder.path(), "evaluate", &["c"]).unwrap();
        assert_whole(folder.path());
    }

    #[test]
    fn a_result_whose_placing_was_stopped_anywhere_is_whole_when_the_folder_is_opened_next() {
        for steps in 0..=6 {
            let folder = tempfile::tempdir().unwrap();
            let at = |name: &str| folder.path().join(name);
            result(folder.path(), "fit", &["a", "stale"]).unwrap();
            let mut open = ResultFolder::open(folder.path(), "fit", &[]).unwrap();
            open.write("a", b"new").unwrap();
            open.write("runs/1", b"new").unwrap();
            open.stage(Origin::default()).unwrap();
            open.aside.0 = None;
            drop(open);
            // The steps of `place`, as far as it came.
            let aside = at(ASIDE);
            let mv = |name: &str, from: PathBuf| {
                fs::create_dir_all(at("runs")).unwrap();
                fs::rename(from, at(name)).unwrap();
            };
            let all: [&dyn Fn(); 6] = [
                &|| fs::remove_file(at(MANIFEST)).unwrap(),
                &|| fs::remove_file(at("stale")).unwrap(),
                &|| mv("a", aside.join(FILES).join("a")),
                &|| mv("runs/1", aside.join(FILES).join("runs/1")),
                &|| mv(TIMING, aside.join(TIMING)),
                &|| mv(MANIFEST, aside.join(MANIFEST)),
            ];
            all[..steps].iter().for_each(|step| step());
            // Who writes into the folder next makes it whole, and so does who reads a file of it.
            match steps % 2 {
                0 => drop(ResultFolder::open(folder.path(), "evaluate", &[]).unwrap()),
                _ => settle(&at("runs/1")).unwrap(),
            }
            assert_whole(folder.path());
            assert_eq!(there(folder.path()), ["a", "runs/1"], "after {steps} steps");
            assert_eq!(fs::read_to_string(at("a")).unwrap(), "new");
        }
    }

    #[test]
    fn a_file_that_is_edited_after_its_placing_was_stopped_stays() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        result(folder.path(), "fit", &["a", "b"]).unwrap();
        let mut open = ResultFolder::open(folder.path(), "fit", &[]).unwrap();
        open.write("a", b"new a").unwrap();
        open.write("b", b"new b").unwrap();
        open.stage(Origin::default()).unwrap();
        open.aside.0 = None;
        drop(open);
        fs::remove_file(at(MANIFEST)).unwrap();
        fs::rename(at(ASIDE).join(FILES).join("a"), at("a")).unwrap();
        fs::write(at("b"), "edited").unwrap();
        for _ in 0..2 {
            let error = ResultFolder::open(folder.path(), "evaluate", &[]).unwrap_err();
            assert!(matches!(&error, FolderError::Edited { path, .. } if path.ends_with("b")), "{error}");
            assert!(settle(&at("a")).is_err());
            assert_eq!(fs::read_to_string(at("b")).unwrap(), "edited");
        }
        fs::rename(at("b"), at("c")).unwrap();
        settle(&at("a")).unwrap();
        assert_whole(folder.path());
        assert_eq!(["a", "b", "c"].map(|name| fs::read_to_string(at(name)).unwrap()), ["new a", "new b", "edited"]);
    }

    #[test]
    fn a_file_that_is_left_stays_and_is_listed_while_nobody_changes_it() {
        let folder = tempfile::tempdir().unwrap();
        result(folder.path(), "import", &["runs.csv", "ship.toml"]).unwrap();
        let again = || {
            let edited = &["ship.toml"];
            let mut open = ResultFolder::open_with(folder.path(), "import", &["runs.csv"], edited).unwrap();
            open.write("runs.csv", b"more").unwrap();
            open.leave("ship.toml");
            open.complete(Origin::default()).unwrap();
            assert_whole(folder.path());
            entry(folder.path(), "import").files.contains_key("ship.toml")
        };
        assert!(again());
        fs::write(folder.path().join("ship.toml"), "edited").unwrap();
        assert!(!again());
        assert_eq!(fs::read_to_string(folder.path().join("ship.toml")).unwrap(), "edited");
    }

    #[test]
    fn an_input_that_changes_while_it_is_used_is_reported() {
        let folder = tempfile::tempdir().unwrap();
        let input = folder.path().join("run.csv");
        fs::write(&input, "1").unwrap();
        let open = || {
            let mut open = ResultFolder::open(&folder.path().join("out"), "fit", &[]).unwrap();
            open.reads(std::slice::from_ref(&input));
            open
        };
        let opened = open();
        fs::write(&input, "22").unwrap();
        let error = opened.complete(Origin::default()).unwrap_err();
        assert!(matches!(error, FolderError::InputChanged { .. }), "{error}");
        // The same bytes written once more are no change.
        let opened = open();
        fs::write(&input, "22").unwrap();
        opened.complete(Origin::default()).unwrap();
    }

    #[test]
    fn a_kept_file_is_seen_while_the_command_runs_and_may_be_replaced_when_it_is_a_model_of_trimtab() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("best.toml");
        let open = ResultFolder::open(folder.path(), "fit", &["best.toml"]).unwrap();
        let kept = open.kept("best.toml");
        kept.write(crate::files::seal("use it", "a = 1").as_bytes()).unwrap();
        assert!(path.is_file());
        drop(open);
        drop(ResultFolder::open(folder.path(), "fit", &["best.toml"]).unwrap());
        fs::write(&path, "a = 1").unwrap();
        assert!(matches!(ResultFolder::open(folder.path(), "fit", &["best.toml"]), Err(FolderError::Foreign { .. })));
        kept.remove();
        assert!(!path.exists());
    }

    #[test]
    fn a_file_is_no_folder_for_results() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("ship.toml");
        fs::write(&path, "a = 1").unwrap();
        let error = ResultFolder::open(&path, "fit", &[]).err().unwrap().to_string();
        assert!(error.ends_with("this is a file, not a folder; choose another folder"), "{error}");
        assert_eq!(fs::read_to_string(&path).unwrap(), "a = 1");
    }
}
