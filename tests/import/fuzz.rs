//! Readers of users' files on damaged input: no panic and no hang, whatever is in a file.
//! What the messages say is tested in `tests/library/bad_input.rs`. `PROPTEST_CASES=200000 cargo test --release --test import fuzz` goes on for an hour.

use proptest::prelude::*;
use proptest::test_runner::{RngSeed, TestCaseError};
use std::collections::HashMap;
use std::panic::UnwindSafe;
use std::path::Path;
use std::sync::{LazyLock, Mutex};
use std::thread::ThreadId;
use std::time::{Duration, Instant};
use trimtab::files::Manifest;
use trimtab::model::Model;
use trimtab::recording::audit::audit_study;
use trimtab::recording::import::{ImportSettings, import, recording_csv};
use trimtab::recording::split::{SplitPart, SplitSettings, split};
use trimtab::recording::{ColumnMap, Gaps, Labels, Recording, Split, WindowSettings};
use trimtab::ship::Ship;
use trimtab::study::Study;

/// What files of users have in wrong places.
const TOKENS: [&str; 44] = [
    "nan",
    "NaN",
    "inf",
    "-inf",
    "1e309",
    "1e-320",
    "-0",
    "0",
    "9e36",
    "-1",
    "1e9",
    "1e17",
    "18446744073709551616",
    "0x1F",
    "\"",
    "\"\"",
    "'",
    ",",
    ";",
    "\t",
    "\r",
    "\r\n",
    "\n",
    "\n\n",
    "\0",
    "\u{feff}",
    "é",
    "\u{202e}",
    "\u{1b}[2J",
    "=",
    "[[",
    "]]",
    "[",
    "]",
    "{",
    "}",
    "#",
    "true",
    "[parameters]\n",
    "[[runs]]\n",
    "step",
    " ",
    "1970-01-01T00:00:00Z",
    "..",
];

/// One damage: where, from 0 to 1, over how much, and what.
#[derive(Clone, Debug)]
enum Damage {
    Cut(f64),
    CutBegin(f64),
    Insert(f64, usize),
    /// A number, or a word, becomes a token.
    Replace(f64, usize),
    Delete(f64, usize),
    Repeat(f64, usize, usize),
    /// A line comes to another place.
    Line(f64, f64),
    Byte(f64, u8),
}

fn damage() -> impl Strategy<Value = Damage> {
    let at = || 0.0..1.0_f64;
    let token = || 0..TOKENS.len();
    prop_oneof![
        1 => at().prop_map(Damage::Cut),
        1 => at().prop_map(Damage::CutBegin),
        4 => (at(), token()).prop_map(|(a, t)| Damage::Insert(a, t)),
        8 => (at(), token()).prop_map(|(a, t)| Damage::Replace(a, t)),
        2 => (at(), 1..40_usize).prop_map(|(a, n)| Damage::Delete(a, n)),
        2 => (at(), 1..60_usize, 1..400_usize).prop_map(|(a, n, times)| Damage::Repeat(a, n, times)),
        2 => (at(), at()).prop_map(|(a, b)| Damage::Line(a, b)),
        3 => (at(), any::<u8>()).prop_map(|(a, b)| Damage::Byte(a, b)),
    ]
}

/// Whether a byte is part of a number or a word.
fn wordy(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || b"+-._".contains(&byte)
}

fn damaged(text: &[u8], damages: &[Damage]) -> Vec<u8> {
    let mut bytes = text.to_vec();
    for one in damages {
        let place = |share: f64| (share * bytes.len() as f64) as usize;
        match *one {
            Damage::Cut(a) => bytes.truncate(place(a)),
            Damage::CutBegin(a) => drop(bytes.drain(..place(a))),
            Damage::Insert(a, token) => drop(bytes.splice(place(a)..place(a), TOKENS[token].bytes())),
            Damage::Replace(a, token) => {
                let middle = place(a);
                let begin = (0..middle).rev().take_while(|i| wordy(bytes[*i])).last().unwrap_or(middle);
                let end = (middle..bytes.len()).find(|i| !wordy(bytes[*i])).unwrap_or(bytes.len());
                drop(bytes.splice(begin..end, TOKENS[token].bytes()));
            }
            Damage::Delete(a, n) => drop(bytes.drain(place(a)..(place(a) + n).min(bytes.len()))),
            Damage::Repeat(a, n, times) => {
                let (from, to) = (place(a), (place(a) + n).min(bytes.len()));
                let again = bytes[from..to].repeat(times);
                drop(bytes.splice(from..from, again));
            }
            Damage::Line(a, b) => {
                let mut lines: Vec<&[u8]> = bytes.split_inclusive(|byte| *byte == b'\n').collect();
                let (from, to) = ((a * lines.len() as f64) as usize, (b * lines.len() as f64) as usize);
                if from < lines.len() {
                    let line = lines.remove(from);
                    lines.insert(to.min(lines.len()), line);
                    bytes = lines.concat();
                }
            }
            Damage::Byte(a, byte) => {
                let place = place(a);
                if let Some(at) = bytes.get_mut(place) {
                    *at = byte;
                }
            }
        }
    }
    bytes
}

/// The inputs that are being read, since when.
static READING: LazyLock<Mutex<HashMap<ThreadId, (Instant, Vec<u8>)>>> = LazyLock::new(Mutex::default);

/// Ends the test, and prints the input, when a reader gives no answer in half a minute.
static WATCH: LazyLock<()> = LazyLock::new(|| {
    std::thread::spawn(|| {
        loop {
            std::thread::sleep(Duration::from_secs(1));
            let reading = READING.lock().unwrap();
            if let Some((_, bytes)) = reading.values().find(|(since, _)| since.elapsed() > Duration::from_secs(30)) {
                eprintln!("does not end on\n{}", shown(bytes));
                std::process::exit(101);
            }
        }
    });
});

fn shown(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).chars().take(2000).collect()
}

/// Runs `read`, which must not panic and not take half a minute.
fn ends(bytes: Vec<u8>, read: impl FnOnce(Vec<u8>) + UnwindSafe) -> Result<(), TestCaseError> {
    LazyLock::force(&WATCH);
    let this = std::thread::current().id();
    READING.lock().unwrap().insert(this, (Instant::now(), bytes.clone()));
    let outcome = std::panic::catch_unwind({
        let bytes = bytes.clone();
        move || read(bytes)
    });
    READING.lock().unwrap().remove(&this);
    outcome.map_err(|_| TestCaseError::fail(format!("panics on\n{}", shown(&bytes))))
}

/// The same cases every time, unless the environment asks for more or for others.
fn config() -> ProptestConfig {
    let default = ProptestConfig { failure_persistence: None, max_shrink_iters: 2000, ..ProptestConfig::default() };
    let asked = |name: &str| std::env::var_os(name).is_some();
    ProptestConfig {
        cases: if asked("PROPTEST_CASES") { default.cases } else { 600 },
        rng_seed: if asked("PROPTEST_RNG_SEED") { default.rng_seed } else { RngSeed::Fixed(17) },
        ..default
    }
}

/// A file of the example study; a recording cut to its first rows.
fn example(name: &str) -> Vec<u8> {
    let text = &FILES.iter().find(|(n, _)| n == name).unwrap().1;
    text.split_inclusive('\n').take(60).collect::<String>().into_bytes()
}

static FILES: LazyLock<Vec<(String, String)>> = LazyLock::new(trimtab::study::demo::files);

static SHIP: LazyLock<Ship> = LazyLock::new(|| ship(&example("ship.toml")).unwrap());

fn ship(bytes: &[u8]) -> Option<Ship> {
    Ship::parse(&String::from_utf8_lossy(bytes), Path::new("ship.toml")).ok()
}

const MAP: &str = "delimiter = \"comma\"\nbridge = 8.0\nderive = [\"u\", \"v\", \"r\"]\ndt = 0.5\n\n[columns]\nt = { column = \"t\", unit = \"s\" }\nx = \"x\"\n\
                   y = { index = 3, unit = \"m\" }\npsi = { column = \"psi\", unit = \"deg\" }\nn = \"n\"\ndelta = \"delta\"\n";

/// Reads a recording through a map and cuts it into windows.
fn recording(text: &[u8], map: &ColumnMap) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.csv");
    std::fs::write(&path, text).unwrap();
    let Ok(recording) = Recording::read(&path, map) else { return };
    let labels = Labels { run: "run".into(), session: "a".into(), manoeuvre: "b".into(), split: Split::Train };
    for gaps in [Gaps::Refuse, Gaps::Split] {
        let _ = recording.windows(&labels, &WindowSettings { window: Some(20.0), gaps, ..WindowSettings::whole(5.0) });
    }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn a_damaged_recording_neither_panics_nor_hangs(damages in prop::collection::vec(damage(), 1..5)) {
        let bytes = damaged(&example("recordings/ship_a_001.csv"), &damages);
        ends(bytes, |bytes| recording(&bytes, &ColumnMap::default()))?;
    }

    #[test]
    fn a_damaged_column_map_neither_panics_nor_hangs(damages in prop::collection::vec(damage(), 1..4)) {
        ends(damaged(MAP.as_bytes(), &damages), |bytes| {
            if let Ok(map) = ColumnMap::parse(&String::from_utf8_lossy(&bytes), Path::new("columns.toml")) {
                recording(&example("recordings/ship_a_001.csv"), &map);
            }
        })?;
    }

    #[test]
    fn a_damaged_study_or_table_of_runs_neither_panics_nor_hangs(
        damages in prop::collection::vec(damage(), 1..4),
        table in any::<bool>(),
    ) {
        let name = if table { "runs.csv" } else { "study.toml" };
        ends(damaged(&example(name), &damages), move |bytes| {
            let folder = tempfile::tempdir().unwrap();
            for name in ["study.toml", "runs.csv"] {
                std::fs::write(folder.path().join(name), example(name)).unwrap();
            }
            std::fs::create_dir(folder.path().join("recordings")).unwrap();
            std::fs::write(folder.path().join("recordings/ship_a_001.csv"), example("recordings/ship_a_001.csv")).unwrap();
            std::fs::write(folder.path().join(name), bytes).unwrap();
            if let Ok(mut study) = Study::read(&folder.path().join("study.toml")) {
                study.runs.truncate(2);
                let _ = study.windows(4.0);
                let _ = audit_study(&study, &SHIP);
            }
        })?;
    }

    #[test]
    fn a_damaged_ship_file_neither_panics_nor_hangs(damages in prop::collection::vec(damage(), 1..4)) {
        ends(damaged(&example("ship.toml"), &damages), |bytes| {
            if let Some(ship) = ship(&bytes) {
                let _ = Model::parse(&String::from_utf8_lossy(&example("model.toml")), Path::new("model.toml"), ship);
            }
        })?;
    }

    #[test]
    fn a_damaged_model_file_neither_panics_nor_hangs(
        damages in prop::collection::vec(damage(), 1..4),
        sealed in any::<bool>(),
    ) {
        let whole = String::from_utf8(example("model.toml")).unwrap();
        let whole = if sealed { trimtab::files::seal("use it with --model.", &whole) } else { whole };
        ends(damaged(whole.as_bytes(), &damages), |bytes| {
            let read = Model::parse(&String::from_utf8_lossy(&bytes), Path::new("model.toml"), SHIP.clone());
            if let Ok(model) = read {
                toml::to_string(&model.to_file()).unwrap();
            }
        })?;
    }

    #[test]
    fn a_damaged_log_neither_panics_nor_hangs(damages in prop::collection::vec(damage(), 1..5), which in 0..LOGS.len()) {
        ends(damaged(&log(which), &damages), move |bytes| {
            log_is_imported(LOGS[which], &bytes);
        })?;
    }

    #[test]
    fn a_damaged_manifest_neither_panics_nor_hangs(damages in prop::collection::vec(damage(), 1..4)) {
        let whole = "{\"results\": {\"fit\": {\"version\": \"0.1.0\", \"arguments\": [\"fit\"], \"settings\": {\"fit\": {\"step\": 0.1}}, \
                     \"inputs\": [{\"path\": \"a\", \"sha256\": \"00\"}], \"files\": {\"fit.json\": \"00\"}, \"replaced\": {\"a\": \"b\"}}}}";
        ends(damaged(whole.as_bytes(), &damages), |bytes| {
            let folder = tempfile::tempdir().unwrap();
            std::fs::write(folder.path().join("manifest.json"), bytes).unwrap();
            let _ = Manifest::read(folder.path());
            let _ = trimtab::files::ResultFolder::open(folder.path(), "fit", &["fit.json"]);
        })?;
    }
}

/// Logs that loggers and other programs wrote: NMEA 0183, the example as text, and Parquet of two programs.
#[cfg(feature = "parquet")]
const LOGS: [&str; 4] = ["logger.nmea", "log.csv", "pyarrow.parquet", "polars.parquet"];
/// Logs that loggers and other programs wrote: NMEA 0183, and the example as text.
#[cfg(not(feature = "parquet"))]
const LOGS: [&str; 2] = ["logger.nmea", "log.csv"];

fn log(which: usize) -> Vec<u8> {
    let fixture = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures").join(LOGS[which]);
    std::fs::read(fixture).unwrap_or_else(|_| example("recordings/ship_a_001.csv"))
}

/// Imports a log, and splits what comes of it.
fn log_is_imported(name: &str, bytes: &[u8]) -> bool {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    let Ok(imported) = import(&[path], &ImportSettings::default()) else { return false };
    for recording in &imported.recordings {
        let text = recording_csv(recording);
        let Ok(recording) = Recording::parse(&text, Path::new("log.csv"), &ColumnMap::default()) else { continue };
        let part = SplitPart { file: "log.csv".into(), session: None, start: None, recording: &recording };
        let _ = split(&[part], &SplitSettings::default());
    }
    true
}

/// The example is read as it is: the damage is what makes the readers refuse.
#[test]
fn the_undamaged_files_are_read() {
    (0..LOGS.len()).for_each(|which| assert!(log_is_imported(LOGS[which], &log(which)), "{}", LOGS[which]));
    recording(&example("recordings/ship_a_001.csv"), &ColumnMap::default());
    ColumnMap::parse(MAP, Path::new("columns.toml")).unwrap();
    let model = String::from_utf8(example("model.toml")).unwrap();
    Model::parse(&trimtab::files::seal("use it.", &model), Path::new("model.toml"), SHIP.clone()).unwrap();
}
