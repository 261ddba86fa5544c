//! The study: paths, runs and settings, checked; recordings are read and cut into windows by it.
//! Ship, model and the tables of the commands are read by those who use them.

use super::error::StudyError;
use super::file::{RunEntry, RunTable, StudyFile, is_key_of_a_study};
use super::listed::{Listed, label};
use super::settings::window_settings;
use super::split::{SplitBy, SplitRule};
use super::table::read_table;
use crate::files::written::{Kind, Mistake, joined, line_at, near_file, read_text, read_toml, section};
use crate::recording::{Channel, ColumnMap, Driven, Recording, Split, WindowSettings, Windows, key_line};
use crate::ship::{Ship, ShipError};
use rayon::prelude::*;
use serde::de::DeserializeOwned;
use std::collections::BTreeSet;
use std::mem::take;
use std::path::{Path, PathBuf};

/// Runs that are read for each thread before what became of them is taken in order.
const AHEAD: usize = 4;

/// A study, with every path resolved against the folder of its file.
#[derive(Clone, Debug)]
pub struct Study {
    /// The study file.
    pub path: PathBuf,
    /// Name, for headings.
    pub name: String,
    /// Ship file.
    pub ship: PathBuf,
    /// Model file.
    pub model: PathBuf,
    /// Runs, in the order listed.
    pub runs: Vec<Listed>,
    /// The rule that split the runs; `None` when the table of runs says.
    pub split: Option<SplitRule>,
    /// How runs are cut into windows; `from`, `to` and `draught` are set for each run by [`Study::settings`].
    pub windows: WindowSettings,
    /// Table `[fit]`.
    pub fit: toml::Table,
    /// Table `[evaluate]`.
    pub evaluate: toml::Table,
    /// Table `[diagnose]`.
    pub diagnose: toml::Table,
    /// Table `[maneuver]`.
    pub maneuver: toml::Table,
    /// Table `[plan]`.
    pub plan: toml::Table,
    /// The file that lists the runs.
    runs_path: PathBuf,
    text: String,
}

impl Study {
    /// Reads and checks a study file and its table of runs; recordings are not opened yet.
    ///
    /// # Errors
    /// [`StudyError`], with file and line.
    pub fn read(path: &Path) -> Result<Self, StudyError> {
        Self::parse(&text_of(path)?, path)
    }

    /// Reads a study file without its recordings, which need not exist: no run is listed.
    ///
    /// # Errors
    /// [`StudyError`], with file and line.
    pub fn read_without_runs(path: &Path) -> Result<Self, StudyError> {
        Ok(Self::without_runs(&text_of(path)?, path)?.0)
    }

    /// Reads a study file with its recordings where they can be listed, else without them: for what needs none.
    ///
    /// # Errors
    /// [`StudyError`], with file and line.
    pub fn read_with_any_runs(path: &Path) -> Result<Self, StudyError> {
        Self::read(path).or_else(|_| Self::read_without_runs(path))
    }

    /// A study of a ship and a model alone, with the settings that are used where a study has none.
    ///
    /// # Errors
    /// None that a file can cause.
    pub fn of_ship(ship: &Path, model: &Path) -> Result<Self, StudyError> {
        let bare = Self::without_runs("name = \"\"\nship = \"\"\nmodel = \"\"\n", ship)?.0;
        let driven = Ship::read(ship).map_or_else(|_| Driven::default(), |ship| Driven::of(&ship));
        let windows = WindowSettings { driven, ..bare.windows };
        Ok(Self { ship: ship.to_owned(), model: model.to_owned(), windows, ..bare })
    }

    /// Checks the text of a study file that stands, or would stand, at `path`.
    ///
    /// # Errors
    /// [`StudyError`], with file and line.
    pub fn parse(text: &str, path: &Path) -> Result<Self, StudyError> {
        let folder = path.parent().unwrap_or(Path::new(""));
        let (study, file) = Self::without_runs(text, path)?;
        let data = data_folder(&file.data.0, folder).map_err(|tried| StudyError::NoData {
            path: path.to_owned(),
            line: key_line(text, "data"),
            tried,
        })?;
        let (entries, runs_path) = match file.runs {
            None => {
                let message =
                    "no run is listed; add [[runs]] with `file`, or name a table of runs as `runs`".to_owned();
                return Err(StudyError::Parse { path: path.to_owned(), line: 1, message });
            }
            Some(RunTable::Listed(entries)) => {
                let line = |e: &toml::Spanned<RunEntry>| line_at(text, e.span().start);
                (entries.into_iter().map(|e| (line(&e), e.into_inner())).collect(), path.to_owned())
            }
            Some(RunTable::File(table)) => {
                let table = folder.join(table);
                (read_table(&table)?, table)
            }
        };
        let shared_map = file.column_map.map(|m| folder.join(m));
        let (runs, split) = label(entries, file.split, &runs_path, &data, folder, shared_map.as_deref())?;
        Ok(Self { runs, split, runs_path, ..study })
    }

    /// The study but for its runs, and what the file says of these.
    fn without_runs(text: &str, path: &Path) -> Result<(Self, StudyFile), StudyError> {
        let folder = path.parent().unwrap_or(Path::new(""));
        let fail = |mistakes: Vec<Mistake>| {
            let (line, message) = joined(mistakes, path);
            StudyError::Parse { path: path.to_owned(), line, message }
        };
        let mut file: StudyFile =
            read_toml(text, Kind::Study).map_err(|m| fail(m.into_iter().map(in_a_table).collect()))?;
        let windows = window_settings(&file, text);
        let rule = file.split.filter(|r| !(0.0..1.0).contains(&r.test)).map(|rule| {
            let message = format!("`test` = {} is not a share from 0 to below 1; the paper's is 0.125", rule.test);
            Mistake::new(key_line(text, "test"), message)
        });
        let windows = match (windows, rule) {
            (Ok(windows), None) => windows,
            (windows, rule) => return Err(fail(windows.err().into_iter().flatten().chain(rule).collect())),
        };
        // What is wrong with the ship file is said by those who read it for themselves.
        let ship = folder.join(&file.ship);
        let driven = Ship::read(&ship).map_or_else(|_| Driven::default(), |ship| Driven::of(&ship));
        let windows = WindowSettings { driven, ..windows };
        let study = Self {
            path: path.to_owned(),
            name: take(&mut file.name),
            ship,
            model: folder.join(&file.model),
            runs: Vec::new(),
            split: None,
            windows,
            fit: take(&mut file.fit),
            evaluate: take(&mut file.evaluate),
            diagnose: take(&mut file.diagnose),
            maneuver: take(&mut file.maneuver),
            plan: take(&mut file.plan),
            runs_path: path.to_owned(),
            text: text.to_owned(),
        };
        Ok((study, file))
    }

    /// The files that say what the study is: its own, the table of runs, and the ship's; neither models nor recordings.
    pub fn files(&self) -> Vec<PathBuf> {
        let mut files = vec![self.path.clone(), self.runs_path.clone(), self.ship.clone()];
        files.dedup();
        files
    }

    /// Reads the ship of the study; what the column maps of its recordings say of the velocities comes along.
    ///
    /// # Errors
    /// [`ShipError`]; a column map that cannot be read is reported when its recording is read.
    pub fn read_ship(&self) -> Result<Ship, ShipError> {
        let mut ship = Ship::read(&self.ship)?;
        let turns = |path: &Path| ColumnMap::read(path).is_ok_and(|map| map.turns_with_heading());
        ship.velocity_by_heading = self.column_maps().into_iter().any(turns);
        Ok(ship)
    }

    /// The files of the column maps that runs name, each once.
    pub fn column_maps(&self) -> BTreeSet<&Path> {
        self.runs.iter().filter_map(|run| run.column_map.as_deref()).collect()
    }

    /// The column map of a run.
    ///
    /// # Errors
    /// [`StudyError::Recording`] when the map cannot be read.
    pub fn column_map(&self, run: &Listed) -> Result<ColumnMap, StudyError> {
        let mut map = run.column_map.as_deref().map_or_else(|| Ok(ColumnMap::default()), ColumnMap::read)?;
        map.driven = self.windows.driven.clone();
        Ok(map)
    }

    /// Reads the recording of a run, under the run's name.
    ///
    /// # Errors
    /// [`StudyError::MissingFile`] or [`StudyError::Recording`].
    pub fn recording(&self, run: &Listed) -> Result<Recording, StudyError> {
        if !run.file.is_file() {
            return Err(StudyError::MissingFile {
                path: self.runs_path.clone(),
                line: run.line,
                file: run.file.clone(),
                suggestion: if run.file.is_dir() { " as a file: it is a folder".into() } else { near_file(&run.file) },
            });
        }
        let mut recording = Recording::read_in(&run.file, &self.column_map(run)?, &run.labels.session)?;
        recording.name.clone_from(&run.labels.run);
        Ok(recording)
    }

    /// The channels that a run has, by the first lines of its recording.
    ///
    /// # Errors
    /// [`StudyError::Recording`].
    pub fn channels(&self, run: &Listed) -> Result<Vec<Channel>, StudyError> {
        Ok(Recording::channels_in(&run.file, &self.column_map(run)?)?)
    }

    /// The window settings of a run; `draught` \[m\] is the ship's.
    pub fn settings(&self, run: &Listed, draught: f64) -> WindowSettings {
        WindowSettings { from: run.from, to: run.to, draught, ..self.windows.clone() }
    }

    /// Reads one run and cuts it into windows; `draught` \[m\] is the ship's.
    ///
    /// # Errors
    /// A [`StudyError`] about this run.
    pub fn cut(&self, run: &Listed, draught: f64) -> Result<Windows, StudyError> {
        Ok(self.recording(run)?.windows(&run.labels, &self.settings(run, draught))?)
    }

    /// Reads the runs for which `wanted` says so, cuts each into windows, and hands these to `work`; what that makes of them goes
    /// to `take` in the order listed. No more recordings are kept in memory than there are threads. `draught` \[m\] is the ship's.
    ///
    /// # Errors
    /// The first [`StudyError`] in the order of the runs, or what `take` fails with.
    pub fn each<T: Send, E: From<StudyError>>(
        &self,
        draught: f64,
        wanted: impl Fn(&Listed) -> bool,
        work: impl Fn(Windows) -> T + Sync,
        mut take: impl FnMut(T) -> Result<(), E>,
    ) -> Result<(), E> {
        let runs: Vec<&Listed> = self.runs.iter().filter(|run| wanted(run)).collect();
        for some in runs.chunks(AHEAD * rayon::current_num_threads()) {
            let done: Vec<Result<T, StudyError>> =
                some.par_iter().with_max_len(1).map(|run| Ok(work(self.cut(run, draught)?))).collect();
            for one in done {
                take(one?)?;
            }
        }
        Ok(())
    }

    /// Reads every run and cuts it into windows, in the order listed; `draught` \[m\] is the ship's.
    ///
    /// # Errors
    /// The first [`StudyError`] in the order of the runs.
    pub fn windows(&self, draught: f64) -> Result<Windows, StudyError> {
        let mut all = Windows::default();
        self.each(
            draught,
            |_| true,
            |one| one,
            |one| {
                all.windows.extend(one.windows);
                all.skipped.extend(one.skipped);
                Ok::<(), StudyError>(())
            },
        )?;
        Ok(all)
    }

    /// Every run as one window, start to end: for trials that must be simulated whole. `draught` \[m\] is the ship's.
    ///
    /// # Errors
    /// The first [`StudyError`] in the order of the runs.
    pub fn whole_runs(&self, draught: f64) -> Result<Windows, StudyError> {
        let mut study = self.clone();
        study.windows = WindowSettings { window: None, overlap: 0.0, ..study.windows };
        study.windows(draught)
    }

    /// How the runs were split, in one sentence.
    pub fn split_in_words(&self) -> String {
        let test = self.runs.iter().filter(|r| r.labels.split == Split::Test).count();
        let counts = format!("{} runs train, {test} test", self.runs.len() - test);
        match self.split {
            None => format!("{counts}, as listed"),
            Some(rule) => {
                let by = match rule.by {
                    SplitBy::Run => "run",
                    SplitBy::Session => "session",
                };
                format!("{counts}, drawn by {by} with seed {}", rule.seed)
            }
        }
    }

    /// A table of the study, such as `[fit]`, as settings; those of a table that is not there are the defaults.
    ///
    /// # Errors
    /// Every mistake in it, with lines of the study.
    pub fn section<T: DeserializeOwned>(&self, table: &str) -> Result<T, Vec<Mistake>> {
        let at_the_top = |mistake: Mistake| match mistake.unknown.as_deref().filter(|key| is_key_of_a_study(key)) {
            Some(key) => out_of_place(mistake.line, key),
            None => mistake,
        };
        section(&self.text, table).map_err(|mistakes| mistakes.into_iter().map(at_the_top).collect())
    }

    /// The line at which `key` of table `[table]`, or of a table inside it, is set, for messages about it; the first of their
    /// headings when it is not.
    pub fn line_of(&self, table: &str, key: &str) -> usize {
        let heading = |l: &str| l.trim_start().strip_prefix('[').map(|l| l.trim_start_matches('[').starts_with(table));
        let sets = |l: &str| l.trim_start().strip_prefix(key).is_some_and(|rest| rest.trim_start().starts_with('='));
        let (mut inside, mut first) = (false, None);
        for (i, line) in self.text.lines().enumerate() {
            if let Some(own) = heading(line) {
                inside = own;
                first = first.or(own.then_some(i + 1));
            } else if inside && sets(line) {
                return i + 1;
            }
        }
        first.unwrap_or(1)
    }
}

fn text_of(path: &Path) -> Result<String, StudyError> {
    let read = |source| StudyError::Read { path: path.to_owned(), what: "study", source };
    read_text(path).map_err(read)
}

/// An unknown key of a study, which may stand in the wrong one of its tables.
fn in_a_table(mistake: Mistake) -> Mistake {
    let Some(key) = &mistake.unknown else { return mistake };
    if is_key_of_a_study(key) {
        return out_of_place(mistake.line, key);
    }
    // Only for the keys at the top does the message list those of the windows.
    if mistake.message.contains("`initial_state`") && !mistake.message.contains("did you mean") {
        let below =
            "; the settings of a command stand below the heading of its table, such as [fit] (`trimtab help study`)";
        return Mistake { message: mistake.message.clone() + below, ..mistake };
    }
    mistake
}

/// A key of the study that stands in one of its tables.
fn out_of_place(line: usize, key: &str) -> Mistake {
    Mistake::new(line, format!("`{key}` is a key of the whole study: it stands at the top, before the first [table]"))
}

/// The first of the candidate folders that exists; the study's own folder without candidates.
///
/// `$NAME` at the start of a candidate is an environment variable; a relative candidate is relative to the study.
fn data_folder(candidates: &[String], folder: &Path) -> Result<PathBuf, String> {
    if candidates.is_empty() {
        return Ok(folder.to_owned());
    }
    let mut tried = Vec::new();
    for candidate in candidates {
        let path = match candidate.strip_prefix('$') {
            None => folder.join(candidate),
            Some(rest) => {
                let (variable, tail) = rest.split_once('/').unwrap_or((rest, ""));
                match std::env::var_os(variable) {
                    None => {
                        tried.push(format!("the environment variable `${variable}` is not set"));
                        continue;
                    }
                    Some(value) => Path::new(&value).join(tail),
                }
            }
        };
        if path.is_dir() {
            return Ok(path);
        }
        let what = if path.exists() { "is a file, not a folder" } else { "does not exist" };
        tried.push(format!(
            "{} {what}{}",
            path.display(),
            if path.exists() { String::new() } else { near_file(&path) }
        ));
    }
    Err(tried.join(", "))
}
