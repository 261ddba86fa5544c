//! Two embedded studies of one ship, forty recordings each: an example for the library, and the trials that `trimtab demo` diagnoses.
//! The data are not made here: the binary `demo_data` of the experiments wrote them, and tests there compare them with its output.

use crate::model::{Model, ModelError};
use crate::recording::{ColumnMap, Labels, Recording, RecordingError, Run, Split, WindowSettings};
use crate::ship::{Ship, ShipError};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

/// Study, ship, models and table of runs, by file name.
const FILES: [(&str, &str); 5] = [
    ("study.toml", include_str!("demo/study.toml")),
    ("ship.toml", include_str!("demo/ship.toml")),
    ("model.toml", include_str!("demo/model.toml")),
    ("baseline.toml", include_str!("demo/baseline.toml")),
    ("runs.csv", include_str!("demo/runs.csv")),
];

/// All recordings in one file: the name of the run, then the columns of a recording.
const RECORDINGS: &str = include_str!("demo/recordings.csv");

/// What differs in the trials: ship and models are those of the example.
const TRIALS: [(&str, &str); 5] = [
    ("study.toml", include_str!("demo/trials/study.toml")),
    FILES[1],
    FILES[2],
    FILES[3],
    ("runs.csv", include_str!("demo/trials/runs.csv")),
];

/// The recordings of the trials, as [`RECORDINGS`].
const TRIAL_RECORDINGS: &str = include_str!("demo/trials/recordings.csv");

/// What the trials conceal. No file of the study repeats it.
const CONCEALED: &str = include_str!("demo/trials/concealed.toml");

/// Every file of the example study, by path relative to its folder, with its content.
pub fn files() -> Vec<(String, String)> {
    study(&FILES, RECORDINGS)
}

/// Every file of the study that `trimtab demo` diagnoses: trials with sensor noise under an effect that no file of it names.
pub fn trials() -> Vec<(String, String)> {
    study(&TRIALS, TRIAL_RECORDINGS)
}

/// The effect under which the trials were made: to be read when the diagnosis is done.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Concealed {
    /// Its name in the generator's catalogue.
    pub effect: String,
    /// Mechanisms of a diagnosis that are right.
    pub accepted: Vec<String>,
    /// The effect and its size in words.
    pub words: String,
    /// True values of parameters of a finding, by dotted name \[SI unit of the parameter\].
    pub sizes: BTreeMap<String, f64>,
}

/// What the trials conceal.
///
/// # Errors
/// The embedded file is not of the shape of [`Concealed`], which a test excludes.
pub fn concealed() -> Result<Concealed, toml::de::Error> {
    toml::from_str(CONCEALED)
}

/// The files of a study and its recordings, which come in one table.
fn study(files: &[(&str, &str)], recordings: &str) -> Vec<(String, String)> {
    let mut files: Vec<(String, String)> = files.iter().map(|(n, t)| ((*n).to_owned(), (*t).to_owned())).collect();
    let mut lines = recordings.lines().filter_map(|line| line.split_once(','));
    let header = lines.next().map_or("", |(_, columns)| columns);
    for (run, row) in lines {
        let name = format!("recordings/{run}.csv");
        match files.last_mut().filter(|(last, _)| *last == name) {
            Some((_, text)) => *text += &format!("{row}\n"),
            None => files.push((name, format!("{header}\n{row}\n"))),
        }
    }
    files
}

/// The example study in memory: what `trimtab fit`, `evaluate` and `diagnose` work on.
#[derive(Clone, Debug)]
pub struct Example {
    /// The model with the parameters from which a fit starts; the paper's eleven are free.
    pub model: Model,
    /// The model with the published parameters, against which a fitted one is judged.
    pub baseline: Model,
    /// The recordings to fit to, 32 of them.
    pub train: Vec<Run>,
    /// The recordings kept aside, 8 of them.
    pub test: Vec<Run>,
}

/// Why the example study could not be read.
#[derive(Debug, thiserror::Error)]
#[error(transparent)]
#[non_exhaustive]
pub enum ExampleError {
    /// The ship.
    Ship(#[from] ShipError),
    /// A model.
    Model(#[from] ModelError),
    /// A recording.
    Recording(#[from] RecordingError),
}

/// Reads the example study from the program itself, without any file.
///
/// # Errors
/// [`ExampleError`], as for a study of files.
pub fn example() -> Result<Example, ExampleError> {
    let files = files();
    let text = |name: &str| files.iter().find(|(n, _)| n == name).map_or("", |(_, text)| text);
    let ship = Ship::parse(text("ship.toml"), Path::new("ship.toml"))?;
    let settings = WindowSettings::whole(ship.hull.draught);
    let model = Model::parse(text("model.toml"), Path::new("model.toml"), ship.clone())?;
    let baseline = Model::parse(text("baseline.toml"), Path::new("baseline.toml"), ship)?;
    let (mut train, mut test) = (Vec::new(), Vec::new());
    for row in text("runs.csv").lines().skip(1) {
        let fields: Vec<&str> = row.split(',').collect();
        let [file, name, manoeuvre, split] = fields[..] else { continue };
        let split = if split == "test" { Split::Test } else { Split::Train };
        let labels = Labels { run: name.into(), session: "unnamed".into(), manoeuvre: manoeuvre.into(), split };
        let recording = Recording::parse(text(file), Path::new(file), &ColumnMap::default())?;
        let side = if split == Split::Test { &mut test } else { &mut train };
        side.extend(recording.windows(&labels, &settings)?.windows);
    }
    Ok(Example { model, baseline, train, test })
}

#[cfg(test)]
mod tests {
    use super::{concealed, example, files, trials};
    use crate::recording::Split;
    use crate::study::Study;

    #[test]
    fn the_example_in_memory_is_the_one_on_disk() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("recordings")).unwrap();
        for (name, text) in files() {
            std::fs::write(folder.path().join(name), text).unwrap();
        }
        let example = example().unwrap();
        let study = Study::read(&folder.path().join("study.toml")).unwrap();
        let windows = study.windows(example.model.ship.hull.draught).unwrap().windows;
        assert_eq!((example.train.len(), example.test.len()), (32, 8));
        for (side, split) in [(&example.train, Split::Train), (&example.test, Split::Test)] {
            for (memory, disk) in side.iter().zip(windows.iter().filter(|w| w.split == split)) {
                assert_eq!(
                    (&memory.recording, &memory.session, &memory.manoeuvre, memory.split),
                    (&disk.recording, &disk.session, &disk.manoeuvre, disk.split)
                );
                assert_eq!((&memory.inputs, &memory.measured), (&disk.inputs, &disk.measured));
            }
        }
    }

    #[test]
    fn no_file_of_the_trials_names_what_they_conceal() {
        let concealed = concealed().unwrap();
        let files = trials();
        assert_eq!(files.iter().filter(|(name, _)| name.starts_with("recordings/")).count(), 40);
        for (name, text) in &files {
            for word in concealed.accepted.iter().chain([&concealed.effect]) {
                assert!(!text.contains(word.as_str()), "{name} names `{word}`");
            }
        }
        assert!(!concealed.sizes.is_empty() && concealed.accepted.contains(&concealed.effect));
    }

    #[test]
    fn the_trials_are_a_study_of_30_runs_to_train_on_and_10_to_test_on_in_four_sessions() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("recordings")).unwrap();
        for (name, text) in trials() {
            std::fs::write(folder.path().join(name), text).unwrap();
        }
        let study = Study::read(&folder.path().join("study.toml")).unwrap();
        let test = study.runs.iter().filter(|r| r.labels.split == Split::Test).count();
        let sessions: std::collections::BTreeSet<&str> = study.runs.iter().map(|r| r.labels.session.as_str()).collect();
        assert_eq!((study.runs.len(), test, sessions.len()), (40, 10, 4));
    }

    #[test]
    fn every_run_listed_has_its_recording_of_121_rows() {
        let files = files();
        let runs = &files.iter().find(|(name, _)| name == "runs.csv").unwrap().1;
        let listed: Vec<&str> = runs.lines().skip(1).map(|l| l.split(',').next().unwrap()).collect();
        assert_eq!(listed.len(), 40);
        for file in listed {
            let text = &files.iter().find(|(name, _)| name == file).unwrap().1;
            assert!(text.starts_with("t [s],x [m],") && text.lines().count() == 122, "{file}");
        }
    }
}
