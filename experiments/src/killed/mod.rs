//! Commands that are killed while they write over the results of an earlier run: what is left, and what the next run makes of it.
//! It judges folders of results by their files alone; what the results say is judged elsewhere.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};
use trimtab::files::{MANIFEST, Manifest, TIMING, settle, sha256_of};

use crate::conceal::error::ConcealError;
use crate::mutated::files::{Files, sound, write};
use crate::process;

/// The commands that are killed, with what they are asked beside the study and the folder.
pub const COMMANDS: [(&str, &[&str]); 5] = [
    ("simulate", &[]),
    ("fit", &[]),
    ("evaluate", &["--model", "fitted.toml"]),
    ("maneuver", &["turning", "--model", "fitted.toml"]),
    ("diagnose", &["--once"]),
];

/// Kills fall within this many times the time that the command takes.
const SPREAD: f64 = 1.05;
/// Every so many kills the command is killed while it puts its files into their places, which a kill at random hardly ever meets.
const BETWEEN: usize = 2;
/// Longest time from where that begins to the kill: on a disk it takes a fraction of a millisecond a file.
const PLACING: Duration = Duration::from_millis(3);
/// What a user writes into a file of results.
const EDITED: &[u8] = b"edited by hand\n";
/// The folder of what is not in its place yet, in that of results, and the file in it that says that all is there.
const MARK: &str = ".trimtab-unfinished/manifest.json";
/// Seed of the two studies.
const STUDY: u64 = 7;
/// Longest time for a command that is not killed.
const LIMIT: Duration = Duration::from_secs(300);
/// The folder of results, below that of a study.
const OUT: &str = "results";

/// What is in a folder after a kill.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, Default)]
#[serde(rename_all = "snake_case")]
pub enum Left {
    /// The results of the earlier run, every file as it was listed.
    #[default]
    Earlier,
    /// The results of the killed run, complete.
    New,
    /// Files without a list: no one takes them for results.
    Unlisted,
    /// A list that a file does not agree with, or files of both runs under one list.
    Mixed,
}

/// A row of the results.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Number of the kill.
    pub kill: usize,
    /// The command.
    pub command: String,
    /// Instant of the kill as a share of the time that the command takes.
    pub at: f64,
    /// Whether the command was still running.
    pub running: bool,
    /// Whether it was putting its files into their places.
    pub placing: bool,
    /// What it left, as one who reads a file of it finds it.
    pub left: Left,
    /// Whether a file that a user edited before the next command, while files were not in their places yet, was still as edited after it;
    /// true where none was edited.
    pub edit_kept: bool,
    /// Whether the next run of the command made the folder as it is without a kill, with nothing left over.
    pub mended: bool,
}

/// What a command makes of one of the studies.
struct Expected {
    /// Its files.
    files: BTreeMap<String, Vec<u8>>,
    /// Those that are the same whenever they are made: times and dates are not.
    same: BTreeSet<String>,
    /// How long it takes.
    time: Duration,
}

/// Kills commands, one at a time: instants count, and two at a time would disturb each other.
pub struct Killer {
    tool: PathBuf,
    folder: PathBuf,
}

impl Killer {
    /// Makes two sound studies in a folder, which differ by one run, and fits them.
    ///
    /// # Errors
    /// [`ConcealError`] if they cannot be made or fitted.
    pub fn new(tool: PathBuf, folder: PathBuf) -> Result<Self, ConcealError> {
        process::is_there(&tool)?;
        let tool = tool.canonicalize().map_err(|source| ConcealError::file(&tool, source))?;
        let all = sound(STUDY, &folder.join("case"))?;
        let killer = Self { tool, folder };
        for (name, files) in [("one", all.clone()), ("other", without_last(&all))] {
            let study = killer.folder.join(name);
            write(&files, &study).map_err(|source| ConcealError::file(&study, source))?;
            killer.run(name, ("fit", &[]))?;
            let fitted = study.join("fitted.toml");
            std::fs::copy(study.join(OUT).join("fitted.toml"), &fitted)
                .and_then(|_| std::fs::remove_dir_all(study.join(OUT)))
                .map_err(|source| ConcealError::file(&fitted, source))?;
        }
        Ok(killer)
    }

    /// A command on a study, with its results in a folder beside it.
    fn command(&self, study: &str, (command, arguments): (&str, &[&str])) -> Command {
        let mut asked = Command::new(&self.tool);
        asked.args(["--threads", "1", command]);
        // The name of a trial comes before the study.
        let before = usize::from(command == "maneuver");
        asked.args(&arguments[..before]).arg("study.toml").args(&arguments[before..]).args(["--out", OUT]);
        asked.current_dir(self.folder.join(study));
        asked
    }

    fn results(&self, study: &str) -> PathBuf {
        self.folder.join(study).join(OUT)
    }

    /// Runs a command to its end, and gives its time.
    fn run(&self, study: &str, command: (&str, &[&str])) -> Result<Duration, ConcealError> {
        let ended = process::run(self.command(study, command), LIMIT);
        let ended = ended.map_err(|source| ConcealError::file(&self.tool, source))?;
        // 1 says that the answer is no, which is an answer.
        if !matches!(ended.code, Some(0 | 1)) {
            let message = format!("`{}` on a sound study fails: {}", command.0, ended.messages.trim());
            return Err(ConcealError::content(&self.results(study), &message));
        }
        Ok(Duration::from_secs_f64(ended.seconds))
    }

    /// What a command makes of a study whose results are empty.
    fn expected(&self, study: &str, command: (&str, &[&str])) -> Result<Expected, ConcealError> {
        let results = self.results(study);
        let made = || {
            empty(&results)?;
            let time = self.run(study, command)?;
            Ok::<_, ConcealError>((read(&results)?, time))
        };
        let ((first, slow), (files, time)) = (made()?, made()?);
        Ok(Expected { same: same(&first, &files), time: time.min(slow), files })
    }

    /// Kills a command at each of some [`instants`] after the first `done`, each time over the results that it made of the other study.
    ///
    /// # Errors
    /// A folder that cannot be written, or a command that fails without a kill.
    pub fn all(
        &self,
        command: (&str, &[&str]),
        instants: &[f64],
        done: usize,
        each: &mut dyn FnMut(Row) -> Result<(), ConcealError>,
    ) -> Result<(), ConcealError> {
        if done >= instants.len() {
            return Ok(());
        }
        let [one, other] = [self.expected("one", command)?, self.expected("other", command)?];
        let results = self.results("one");
        for (kill, at) in (1_usize..).zip(instants.iter().copied()).skip(done) {
            empty(&results)?;
            write(&other.files, &results).map_err(|source| ConcealError::file(&results, source))?;
            let fail = |source| ConcealError::file(&self.tool, source);
            let mut asked = self.command("one", command);
            asked.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
            let mut child = asked.spawn().map_err(fail)?;
            let begun = Instant::now();
            let mark = results.join(MARK);
            if kill.is_multiple_of(BETWEEN) {
                while !mark.is_file() && child.try_wait().map_err(fail)?.is_none() {
                    std::hint::spin_loop();
                }
                std::thread::sleep(PLACING.mul_f64(at / SPREAD));
            } else {
                std::thread::sleep(one.time.mul_f64(at).saturating_sub(begun.elapsed()));
            }
            let running = child.try_wait().map_err(fail)?.is_none();
            // A command that has ended cannot be killed.
            let _ = child.kill();
            child.wait().map_err(fail)?;
            let placing = mark.is_file();
            let edit_kept = !placing || self.keeps_an_edit(&results, command)?;
            settle(&results).map_err(|e| ConcealError::content(&results, &e.to_string()))?;
            let left = left(&results, &other, &one)?;
            let again = self.run("one", command).is_ok();
            let mended = again && agrees(&read(&results)?, &one) && listed(&results);
            each(Row { kill, command: command.0.to_owned(), at, running, placing, left, edit_kept, mended })?;
        }
        Ok(())
    }

    /// Whether a file of the earlier result that a user edits now, of which the new one is not in its place yet, is as edited after the
    /// command is run again. The file is then put aside, as the command asks.
    fn keeps_an_edit(&self, results: &Path, command: (&str, &[&str])) -> Result<bool, ConcealError> {
        let waiting = results.join(MARK).with_file_name("files");
        let fail = |source| ConcealError::file(results, source);
        let staged = read(&waiting)?;
        let Some(name) = staged.keys().find(|name| !name.ends_with(".toml") && results.join(name).is_file()) else {
            return Ok(true);
        };
        let path = results.join(name);
        std::fs::write(&path, EDITED).map_err(fail)?;
        let refused = self.run("one", command).is_err();
        let kept = std::fs::read(&path).map_err(fail)? == EDITED;
        std::fs::remove_file(&path).map_err(fail)?;
        Ok(refused && kept)
    }
}

/// The files that are the same in two runs of a command. Its times are so by chance, where both ran within a second.
fn same(first: &BTreeMap<String, Vec<u8>>, second: &BTreeMap<String, Vec<u8>>) -> BTreeSet<String> {
    let alike = second.iter().filter(|(name, bytes)| *name != TIMING && first.get(*name) == Some(bytes));
    alike.map(|(name, _)| name.clone()).collect()
}

/// Instants of so many kills, drawn with a seed: shares of the time that a command takes.
pub fn instants(seed: u64, count: usize) -> Vec<f64> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    (0..count).map(|_| SPREAD * random.random::<f64>()).collect()
}

/// How many of a command's kills are done: those in the rows, which must be its first ones at these instants. `None` where they are of
/// another campaign.
pub fn done(rows: &[Row], command: &str, instants: &[f64]) -> Option<usize> {
    let of_command: Vec<&Row> = rows.iter().filter(|row| row.command == command).collect();
    let fits = |(i, row): (usize, &&Row)| row.kill == i + 1 && instants.get(i) == Some(&row.at);
    of_command.iter().enumerate().all(fits).then_some(of_command.len())
}

/// The same study without its last run; the settings, which stand behind it, are kept.
fn without_last(files: &Files) -> Files {
    let mut files = files.clone();
    if let Some(bytes) = files.get_mut("study.toml") {
        let text = String::from_utf8_lossy(bytes).into_owned();
        let (head, last) = text.rsplit_once("[[runs]]").unwrap_or((&text, ""));
        let settings = last.find("[evaluate]").map_or("", |i| &last[i..]);
        *bytes = format!("{head}{settings}").into_bytes();
    }
    files
}

/// Removes all that is in a folder of results.
fn empty(folder: &Path) -> Result<(), ConcealError> {
    match std::fs::remove_dir_all(folder) {
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => Err(ConcealError::file(folder, e)),
        _ => Ok(()),
    }
}

/// The files of a folder by their path in it; none where there is no folder.
fn read(folder: &Path) -> Result<BTreeMap<String, Vec<u8>>, ConcealError> {
    let fail = |source| ConcealError::file(folder, source);
    let mut files = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(here) = folders.pop().filter(|here| here.is_dir()) {
        for entry in std::fs::read_dir(&here).map_err(fail)? {
            let path = entry.map_err(fail)?.path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let name = path.strip_prefix(folder).unwrap_or(&path).to_string_lossy().into_owned();
            files.insert(name, std::fs::read(&path).map_err(fail)?);
        }
    }
    Ok(files)
}

/// Whether a folder lists its files and every file is as it is listed.
fn listed(folder: &Path) -> bool {
    let Ok(manifest) = Manifest::read(folder) else { return false };
    let mut files = manifest.results.values().flat_map(|entry| &entry.files);
    !manifest.results.is_empty()
        && files.all(|(name, digest)| sha256_of(&folder.join(name)).is_ok_and(|found| found == *digest))
}

/// Whether files are those that are expected, with nothing beside them.
fn agrees(files: &BTreeMap<String, Vec<u8>>, expected: &Expected) -> bool {
    let names = |files: &BTreeMap<String, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
    names(files) == names(&expected.files)
        && expected.same.iter().all(|name| files.get(name) == expected.files.get(name))
}

/// What a kill left of the earlier results and of the new ones.
fn left(folder: &Path, earlier: &Expected, new: &Expected) -> Result<Left, ConcealError> {
    let files = read(folder)?;
    if !folder.join(MANIFEST).is_file() {
        return Ok(Left::Unlisted);
    }
    let lists = listed(folder);
    let of =
        |expected: &Expected| lists && expected.same.iter().all(|name| files.get(name) == expected.files.get(name));
    Ok(match (of(earlier), of(new)) {
        (true, _) => Left::Earlier,
        (_, true) => Left::New,
        _ => Left::Mixed,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use trimtab::files::Entry;

    #[test]
    fn a_study_without_its_last_run_keeps_its_settings() {
        let folder = tempfile::tempdir().unwrap();
        let all = sound(STUDY, folder.path()).unwrap();
        let count = |files: &Files| String::from_utf8_lossy(&files["study.toml"]).matches("[[runs]]").count();
        let fewer = without_last(&all);
        assert_eq!(count(&fewer) + 1, count(&all));
        assert!(String::from_utf8_lossy(&fewer["study.toml"]).contains("[fit]"));
    }

    #[test]
    fn times_that_are_alike_by_chance_are_no_files_that_are_always_the_same() {
        let files = |fit: &str| -> BTreeMap<String, Vec<u8>> {
            [("fit.json", fit), ("tracks.csv", "x"), (TIMING, "0.07 s")].map(|(n, t)| (n.to_owned(), t.into())).into()
        };
        assert_eq!(same(&files("a"), &files("b")), BTreeSet::from(["tracks.csv".to_owned()]));
    }

    #[test]
    fn kills_go_on_after_those_that_are_done_and_not_after_those_of_another_seed() {
        let (these, others) = (instants(3, 6), instants(4, 6));
        let rows = |at: &[f64]| -> Vec<Row> {
            let row = |(i, at): (usize, &f64)| Row { kill: i + 1, command: "fit".into(), at: *at, ..Row::default() };
            at.iter().enumerate().map(row).collect()
        };
        assert_eq!(done(&rows(&these[..4]), "fit", &these), Some(4));
        assert_eq!(done(&rows(&these[..4]), "simulate", &these), Some(0));
        assert_eq!(done(&rows(&others[..4]), "fit", &these), None);
        assert_eq!(done(&rows(&these), "fit", &these[..5]), None);
    }

    #[test]
    fn a_folder_with_files_of_two_runs_is_mixed_and_one_without_a_list_is_unlisted() {
        let folder = tempfile::tempdir().unwrap();
        let of = |text: &str| {
            let files = [("a.csv".to_owned(), trimtab::files::sha256(text.as_bytes()))].into();
            let results = [("fit".to_owned(), Entry { files, ..Entry::default() })].into();
            (text.as_bytes().to_vec(), serde_json::to_vec(&Manifest { results }).unwrap())
        };
        let expected = |text: &str| Expected {
            files: [("a.csv".to_owned(), of(text).0)].into(),
            same: ["a.csv".to_owned()].into(),
            time: Duration::ZERO,
        };
        let judged = |text: &str, list: Option<&str>| {
            std::fs::write(folder.path().join("a.csv"), text).unwrap();
            let manifest = folder.path().join(MANIFEST);
            match list {
                Some(list) => std::fs::write(&manifest, of(list).1).unwrap(),
                None => drop(std::fs::remove_file(&manifest)),
            }
            left(folder.path(), &expected("old"), &expected("new")).unwrap()
        };
        let found = [("old", Some("old")), ("new", Some("new")), ("new", Some("old")), ("new", None)];
        let found = found.map(|(text, list)| judged(text, list));
        assert_eq!(found, [Left::Earlier, Left::New, Left::Mixed, Left::Unlisted]);
    }
}
