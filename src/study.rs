//! A study: one TOML file that names ship, model and recordings, says how runs are cut into windows, and which train and which test.
//! It opens recordings and hands out windows; ship, model and the tables of the commands are read by those who use them.

use crate::error::suggestion;
use crate::recording::{
    ColumnMap, Gaps, Initial, Labels, Recording, RecordingError, Skipped, Split, WindowSettings, Windows, toml_problem,
};
use rand::SeedableRng;
use rand::seq::SliceRandom;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Why a study could not be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StudyError {
    /// A file could not be opened.
    #[error("{path}: cannot read the {what} ({source}); check the path", path = path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// `study` or `table of runs`.
        what: &'static str,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file is not of the expected shape, or a value in it cannot be.
    #[error("{path}:{line}: {message}", path = path.display())]
    Parse {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// What is wrong and what to do.
        message: String,
    },
    /// None of the data folders exists.
    #[error("{path}:{line}: no folder with the recordings: {tried}; set the variable, or correct `data`", path = path.display())]
    NoData {
        /// The study.
        path: PathBuf,
        /// Line of `data`.
        line: usize,
        /// What was tried, and what came of it.
        tried: String,
    },
    /// A recording named in the study is not there.
    #[error("{path}:{line}: recording {file} does not exist{suggestion}; correct `file`, or `data` in the study", path = path.display(), file = file.display())]
    MissingFile {
        /// The study or its table of runs.
        path: PathBuf,
        /// Line of the run.
        line: usize,
        /// The recording.
        file: PathBuf,
        /// `, did you mean ...?` or nothing.
        suggestion: String,
    },
    /// A recording or its column map has a fault.
    #[error(transparent)]
    Recording(#[from] RecordingError),
}

/// The study file as written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct StudyFile {
    name: String,
    ship: PathBuf,
    model: PathBuf,
    #[serde(default)]
    data: Candidates,
    column_map: Option<PathBuf>,
    step: Option<f64>,
    window: Option<f64>,
    #[serde(default)]
    window_overlap: f64,
    #[serde(default)]
    discard_start: f64,
    #[serde(default)]
    discard_end: f64,
    #[serde(default)]
    initial_state: InitialKind,
    initial_span: Option<f64>,
    #[serde(default)]
    gaps: Gaps,
    runs: RunTable,
    split: Option<SplitRule>,
    #[serde(default)]
    fit: toml::Table,
    #[serde(default)]
    evaluate: toml::Table,
    #[serde(default)]
    diagnose: toml::Table,
    #[serde(default)]
    maneuver: toml::Table,
}

#[derive(Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
enum InitialKind {
    #[default]
    First,
    Smoothed,
}

/// One folder, or several of which the first that exists is used.
#[derive(Default)]
struct Candidates(Vec<String>);

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
enum RunTable {
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
struct RunEntry {
    file: PathBuf,
    name: Option<String>,
    session: Option<String>,
    manoeuvre: Option<String>,
    split: Option<Split>,
    from: Option<f64>,
    to: Option<f64>,
    column_map: Option<PathBuf>,
}

/// How runs are divided where the table of runs does not say.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SplitRule {
    /// What stays together.
    pub by: SplitBy,
    /// Share of it that is kept aside for testing.
    pub test: f64,
    /// Seed of the shuffle.
    pub seed: u64,
}

/// What stays together on one side of the split.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SplitBy {
    /// Each run on its own.
    #[default]
    Run,
    /// All runs of a session: the harder test, since runs of a session share weather and loading.
    Session,
}

impl Default for SplitRule {
    fn default() -> Self {
        Self { by: SplitBy::Run, test: 0.125, seed: 1 }
    }
}

/// A run of a study.
#[derive(Clone, Debug)]
pub struct Run {
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
    pub runs: Vec<Run>,
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
        let text = std::fs::read_to_string(path).map_err(|source| StudyError::Read {
            path: path.to_owned(),
            what: "study",
            source,
        })?;
        Self::parse(&text, path)
    }

    /// Checks the text of a study file that stands, or would stand, at `path`.
    ///
    /// # Errors
    /// [`StudyError`], with file and line.
    pub fn parse(text: &str, path: &Path) -> Result<Self, StudyError> {
        let folder = path.parent().unwrap_or(Path::new(""));
        let fail = |line, message| StudyError::Parse { path: path.to_owned(), line, message };
        let file: StudyFile = toml::from_str(text).map_err(|e| {
            let (line, message) = toml_problem(text, &e);
            fail(line, message)
        })?;
        let here = |key: &str| crate::recording::key_line(text, key);
        let times = [
            ("step", file.step, true),
            ("window", file.window, true),
            ("initial_span", file.initial_span, true),
            ("window_overlap", Some(file.window_overlap), false),
            ("discard_start", Some(file.discard_start), false),
            ("discard_end", Some(file.discard_end), false),
        ];
        for (key, value, positive) in times {
            if let Some(v) = value.filter(|v| !v.is_finite() || *v < 0.0 || (positive && *v == 0.0)) {
                let what = if positive { "a positive time" } else { "a time of 0 or more" };
                return Err(fail(here(key), format!("`{key}` = {v} is not {what} in seconds; correct it")));
            }
        }
        let initial = match (file.initial_state, file.initial_span) {
            (InitialKind::First, None) => Initial::First,
            (InitialKind::First, Some(_)) => {
                let text = "`initial_span` is given, but `initial_state` is \"first\"; set it to \"smoothed\", or drop the span";
                return Err(fail(here("initial_span"), text.to_owned()));
            }
            (InitialKind::Smoothed, Some(span)) => Initial::Smoothed { span },
            (InitialKind::Smoothed, None) => {
                let text = "`initial_state = \"smoothed\"` needs `initial_span`, the seconds over which to estimate it";
                return Err(fail(here("initial_state"), text.to_owned()));
            }
        };
        if let Some(rule) = file.split.filter(|r| !(0.0..1.0).contains(&r.test)) {
            let text = format!("`test` = {} is not a share from 0 to 1; the paper's is 0.125", rule.test);
            return Err(fail(here("test"), text));
        }
        let data = data_folder(&file.data.0, folder).map_err(|tried| StudyError::NoData {
            path: path.to_owned(),
            line: here("data"),
            tried,
        })?;
        let (entries, runs_path) = match file.runs {
            RunTable::Listed(entries) => {
                let line = |e: &toml::Spanned<RunEntry>| crate::recording::line_at(text, e.span().start);
                (entries.into_iter().map(|e| (line(&e), e.into_inner())).collect(), path.to_owned())
            }
            RunTable::File(table) => {
                let table = folder.join(table);
                (read_table(&table)?, table)
            }
        };
        let shared_map = file.column_map.map(|m| folder.join(m));
        let (runs, split) = label(entries, file.split, &runs_path, &data, folder, shared_map.as_deref())?;
        Ok(Self {
            path: path.to_owned(),
            name: file.name,
            ship: folder.join(file.ship),
            model: folder.join(file.model),
            runs,
            split,
            windows: WindowSettings {
                step: file.step,
                window: file.window,
                overlap: file.window_overlap,
                discard_start: file.discard_start,
                discard_end: file.discard_end,
                from: None,
                to: None,
                initial,
                gaps: file.gaps,
                draught: f64::NAN,
            },
            fit: file.fit,
            evaluate: file.evaluate,
            diagnose: file.diagnose,
            maneuver: file.maneuver,
            runs_path,
            text: text.to_owned(),
        })
    }

    /// The column map of a run.
    ///
    /// # Errors
    /// [`StudyError::Recording`] when the map cannot be read.
    pub fn column_map(&self, run: &Run) -> Result<ColumnMap, StudyError> {
        Ok(run.column_map.as_deref().map_or_else(|| Ok(ColumnMap::default()), ColumnMap::read)?)
    }

    /// Reads the recording of a run, under the run's name.
    ///
    /// # Errors
    /// [`StudyError::MissingFile`] or [`StudyError::Recording`].
    pub fn recording(&self, run: &Run) -> Result<Recording, StudyError> {
        if !run.file.is_file() {
            return Err(StudyError::MissingFile {
                path: self.runs_path.clone(),
                line: run.line,
                file: run.file.clone(),
                suggestion: near_file(&run.file),
            });
        }
        let mut recording = Recording::read(&run.file, &self.column_map(run)?)?;
        recording.name.clone_from(&run.labels.run);
        Ok(recording)
    }

    /// The window settings of a run; `draught` \[m\] is the ship's.
    pub fn settings(&self, run: &Run, draught: f64) -> WindowSettings {
        WindowSettings { from: run.from, to: run.to, draught, ..self.windows.clone() }
    }

    /// Reads every run and cuts it into windows, in the order listed; `draught` \[m\] is the ship's.
    ///
    /// # Errors
    /// The first [`StudyError`] in the order of the runs.
    pub fn windows(&self, draught: f64) -> Result<Windows, StudyError> {
        let mut all = Windows::default();
        for run in &self.runs {
            let one = self.recording(run)?.windows(&run.labels, &self.settings(run, draught))?;
            all.windows.extend(one.windows);
            all.skipped.extend(one.skipped);
        }
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

    /// The line at which `key` of table `[table]` is set, for messages about it; the table's own line when it is not.
    pub fn line_of(&self, table: &str, key: &str) -> usize {
        let heading = format!("[{table}");
        let start = self.text.lines().position(|l| l.trim_start().starts_with(&heading));
        let Some(start) = start else { return 1 };
        let inside = self.text.lines().skip(start + 1).take_while(|l| !l.starts_with('['));
        let sets = |l: &str| l.trim_start().strip_prefix(key).is_some_and(|rest| rest.trim_start().starts_with('='));
        start + 1 + inside.enumerate().find(|(_, l)| sets(l)).map_or(0, |(i, _)| i + 1)
    }
}

/// Sentence about a stretch that gave no window.
impl std::fmt::Display for Skipped {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "{}: lines {} to {} last {:.2} s, shorter than a window, and are left out",
            self.run, self.first_line, self.last_line, self.length
        )
    }
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
                        tried.push(format!("`${variable}` is not set"));
                        continue;
                    }
                    Some(value) => Path::new(&value).join(tail),
                }
            }
        };
        if path.is_dir() {
            return Ok(path);
        }
        tried.push(format!("{} does not exist", path.display()));
    }
    Err(tried.join(", "))
}

/// Reads a CSV table of runs: the keys of `[[runs]]` as columns, blank where not given.
fn read_table(path: &Path) -> Result<Vec<(usize, RunEntry)>, StudyError> {
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

/// Gives every run a name and a side of the split.
fn label(
    entries: Vec<(usize, RunEntry)>,
    rule: Option<SplitRule>,
    path: &Path,
    data: &Path,
    folder: &Path,
    shared_map: Option<&Path>,
) -> Result<(Vec<Run>, Option<SplitRule>), StudyError> {
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
    let mut runs: Vec<Run> = Vec::new();
    for (line, e) in entries {
        let stem = e.file.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
        let name = e.name.unwrap_or(stem);
        if let Some(other) = runs.iter().find(|r| r.labels.run == name) {
            let text = format!(
                "run `{name}` is listed twice, here and at line {}; give one of them a `name` of its own",
                other.line
            );
            return Err(fail(line, text));
        }
        if let (Some(from), Some(to)) = (e.from, e.to)
            && from >= to
        {
            return Err(fail(line, format!("`from` = {from} s is not before `to` = {to} s")));
        }
        let labels = Labels {
            session: e.session.filter(|s| !s.is_empty()).unwrap_or_else(|| name.clone()),
            manoeuvre: e.manoeuvre.filter(|s| !s.is_empty()).unwrap_or_else(|| "unnamed".to_owned()),
            run: name,
            split: e.split.unwrap_or(Split::Train),
        };
        let own_map = e.column_map.map(|m| folder.join(m));
        let column_map = own_map.or_else(|| shared_map.map(Path::to_owned));
        runs.push(Run { file: data.join(e.file), labels, from: e.from, to: e.to, column_map, line });
    }
    if given > 0 {
        return Ok((runs, None));
    }
    let rule = rule.unwrap_or_default();
    draw(&mut runs, rule);
    Ok((runs, Some(rule)))
}

/// Draws the test side: groups in the order listed are shuffled by the seed and the first ones taken.
fn draw(runs: &mut [Run], rule: SplitRule) {
    let group = |r: &Run| match rule.by {
        SplitBy::Run => r.labels.run.clone(),
        SplitBy::Session => r.labels.session.clone(),
    };
    let mut groups: Vec<String> = Vec::new();
    for run in runs.iter() {
        if !groups.contains(&group(run)) {
            groups.push(group(run));
        }
    }
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(rule.seed);
    groups.shuffle(&mut rng);
    // A study with a test side has at least one group on each side, when it has two.
    let wanted = (rule.test * groups.len() as f64).round() as usize;
    let least = usize::from(rule.test > 0.0 && groups.len() > 1);
    groups.truncate(wanted.clamp(least, groups.len().saturating_sub(1).max(least)));
    for run in runs {
        run.labels.split = if groups.contains(&group(run)) { Split::Test } else { Split::Train };
    }
}

/// A file of a like name beside a missing one.
fn near_file(file: &Path) -> String {
    let (Some(folder), Some(name)) = (file.parent(), file.file_name()) else { return String::new() };
    let names: Vec<String> = std::fs::read_dir(folder)
        .into_iter()
        .flatten()
        .filter_map(|entry| entry.ok().map(|e| e.file_name().to_string_lossy().into_owned()))
        .collect();
    suggestion(&name.to_string_lossy(), names.iter().map(String::as_str))
}

/// Runs counted by manoeuvre and side, for tables: manoeuvre, train, test.
pub fn counts(study: &Study) -> Vec<(String, usize, usize)> {
    let mut counts: BTreeMap<&str, (usize, usize)> = BTreeMap::new();
    for run in &study.runs {
        let entry = counts.entry(&run.labels.manoeuvre).or_default();
        match run.labels.split {
            Split::Train => entry.0 += 1,
            Split::Test => entry.1 += 1,
        }
    }
    counts.into_iter().map(|(m, (train, test))| (m.to_owned(), train, test)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "name = \"trial\"\nship = \"ship.toml\"\nmodel = \"model.toml\"\n";

    fn parse(rest: &str) -> Result<Study, String> {
        Study::parse(&format!("{HEAD}{rest}"), Path::new("some/study.toml")).map_err(|e| e.to_string())
    }

    fn listed(runs: usize) -> String {
        (0..runs).map(|i| format!("[[runs]]\nfile = \"r{i}.csv\"\nsession = \"s{}\"\n", i / 3)).collect()
    }

    #[test]
    fn paths_are_relative_to_the_study() {
        let study = parse("column_map = \"columns.toml\"\n[[runs]]\nfile = \"a.csv\"\nsplit = \"test\"\n").unwrap();
        assert_eq!(study.ship, Path::new("some/ship.toml"));
        assert_eq!(study.runs[0].file, Path::new("some/a.csv"));
        assert_eq!(study.runs[0].column_map.as_deref(), Some(Path::new("some/columns.toml")));
        assert_eq!((study.runs[0].labels.run.as_str(), study.runs[0].labels.split), ("a", Split::Test));
        assert_eq!(study.split, None);
    }

    #[test]
    fn a_drawn_split_keeps_the_share_and_the_seed() {
        let sides = |seed: u64| {
            let study = parse(&format!("{}[split]\nseed = {seed}\n", listed(40))).unwrap();
            study.runs.iter().map(|r| r.labels.split).collect::<Vec<_>>()
        };
        assert_eq!(sides(1).iter().filter(|s| **s == Split::Test).count(), 5);
        assert_eq!(sides(1), sides(1));
        assert_ne!(sides(1), sides(2));
    }

    #[test]
    fn a_split_by_session_keeps_sessions_together() {
        let study = parse(&format!("{}[split]\nby = \"session\"\ntest = 0.3\n", listed(30))).unwrap();
        for a in &study.runs {
            for b in &study.runs {
                assert!(a.labels.session != b.labels.session || a.labels.split == b.labels.split);
            }
        }
        assert_eq!(study.runs.iter().filter(|r| r.labels.split == Split::Test).count(), 9);
    }

    #[test]
    fn both_sides_have_a_run_when_there_are_two() {
        let study = parse(&listed(2)).unwrap();
        assert_eq!(study.split_in_words(), "1 runs train, 1 test, drawn by run with seed 1");
    }

    #[test]
    fn mistakes_in_a_study_name_line_and_next_step() {
        let runs = listed(1);
        let cases = [
            (format!("windwo = 3.0\n{runs}"), ":4: ", "did you mean `window`?"),
            (format!("window = -3.0\n{runs}"), ":4: ", "positive"),
            (format!("initial_state = \"smoothed\"\n{runs}"), ":4: ", "needs `initial_span`"),
            (format!("initial_span = 2.0\n{runs}"), ":4: ", "\"first\""),
            (format!("{runs}splt = \"train\"\n"), ":7: ", "did you mean `split`?"),
            (format!("{runs}{runs}"), ":7: ", "listed twice"),
            (format!("{runs}[split]\ntest = 12.5\n"), ":8: ", "share from 0 to 1"),
            ("runs = []\n".to_owned(), ":1: ", "no run is listed"),
            (format!("data = \"$NO_SUCH_VARIABLE_HERE/x\"\n{runs}"), ":4: ", "`$NO_SUCH_VARIABLE_HERE` is not set"),
            (format!("{runs}split = \"test\"\n[[runs]]\nfile = \"b.csv\"\n"), ":8: ", "has no `split`"),
        ];
        for (text, place, hint) in cases {
            let message = parse(&text).unwrap_err();
            assert!(message.contains(&format!("study.toml{place}")) && message.contains(hint), "{text}\n{message}");
        }
    }

    #[test]
    fn runs_can_stand_in_a_table_beside_the_study() {
        let folder = tempfile::tempdir().unwrap();
        let study = folder.path().join("study.toml");
        std::fs::write(&study, format!("{HEAD}runs = \"runs.csv\"\n")).unwrap();
        let table = folder.path().join("runs.csv");
        std::fs::write(&table, "file,session,split,from\n# a comment\na.csv,day 1,train,\nb.csv,day 2,test,12.5\n")
            .unwrap();
        let runs = Study::read(&study).unwrap().runs;
        assert_eq!((runs[1].labels.session.as_str(), runs[1].from, runs[0].from), ("day 2", Some(12.5), None));
        assert_eq!(runs[1].line, 4);
        std::fs::write(&table, "file,sesion\na.csv,day 1\n").unwrap();
        let message = Study::read(&study).unwrap_err().to_string();
        assert!(message.contains("runs.csv:") && message.contains("did you mean `session`?"), "{message}");
    }

    #[test]
    fn a_missing_recording_is_told_with_the_line_that_lists_it() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("turn_1.csv"), "").unwrap();
        let path = folder.path().join("study.toml");
        let study = Study::parse(&format!("{HEAD}[[runs]]\nfile = \"turn1.csv\"\n"), &path).unwrap();
        let message = study.windows(1.0).unwrap_err().to_string();
        assert!(message.contains("study.toml:4: ") && message.contains("did you mean `turn_1.csv`?"), "{message}");
    }

    #[test]
    fn the_line_of_a_key_in_a_table_is_found() {
        let study = parse("[fit]\n\nfree = []\n[[runs]]\nfile = \"a.csv\"\n").unwrap();
        assert_eq!(study.line_of("fit", "free"), 6);
        assert_eq!(study.line_of("fit", "fixed"), 4);
    }
}
