//! The message for a faulty recording: one line, with file and line number, that says what to do next.
//! Ship files, models and the command line have their own tests.

use std::path::Path;
use trimtab::recording::{ColumnMap, Gaps, Labels, Recording, Split, WindowSettings};

const HEADER: &str = "t [s],x [m],y [m],psi [deg],u [m/s],v [m/s],r [deg/s],n [rpm],delta [deg]";

/// A row of a ship going north at 2 m/s.
fn row(t: f64) -> String {
    format!("{t},{},0,0,2,0,0,60,5", 2.0 * t)
}

/// The header and ten good rows.
fn good() -> Vec<String> {
    std::iter::once(HEADER.to_owned()).chain((0..10).map(|i| row(f64::from(i)))).collect()
}

/// Reads the text as `run.csv` with a column map, cuts it with a window of 5 s, and returns the message, if any.
fn message(text: &str, map: &str) -> Option<String> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("run.csv");
    std::fs::write(&file, text).unwrap();
    let labels = Labels { run: "run".into(), session: "a".into(), manoeuvre: "b".into(), split: Split::Train };
    let settings = WindowSettings { window: Some(5.0), gaps: Gaps::Refuse, ..WindowSettings::whole(5.0) };
    let read = ColumnMap::parse(map, Path::new("columns.toml")).and_then(|map| Recording::read(&file, &map));
    let error = read.and_then(|r| r.windows(&labels, &settings)).err()?;
    Some(error.to_string().replace(&format!("{}/", folder.path().display()), ""))
}

/// The good rows with line `line` (counted from 1) replaced.
fn with_line(line: usize, text: &str) -> String {
    let mut lines = good();
    lines[line - 1] = text.to_owned();
    lines.join("\n")
}

#[test]
fn a_good_recording_gives_no_message() {
    assert_eq!(message(&good().join("\n"), ""), None);
}

/// A fault: name, text of the recording, text of the column map, begin of the message, and a part of its rest.
type Fault = (&'static str, String, &'static str, &'static str, &'static str);

/// Faults of the file and its header.
fn headers() -> Vec<Fault> {
    let header = |from: &str, to: &str| with_line(1, &HEADER.replace(from, to));
    let faults = [
        ("empty file", String::new(), "run.csv:1: the recording is empty", "export it again"),
        ("header only", HEADER.to_owned(), "run.csv:1: the recording is empty", "no row of data"),
        ("blank rows only", format!("{HEADER}\n,,,,,,,,\n"), "run.csv:1: the recording is empty", "no row of data"),
        ("no rudder", header("delta [deg]", "ruder [deg]"), "run.csv:1: no column `delta`", "name it in a column map"),
        (
            "misspelt rudder",
            header("delta [deg]", "dleta [deg]"),
            "run.csv:1: no column `delta`",
            "did you mean `dleta`?",
        ),
        (
            "rudder by its usual name",
            header("delta [deg]", "Rudder angle [deg]"),
            "run.csv:1: no column `delta`",
            "did you mean `Rudder angle`?",
        ),
        ("rate by its unit", header("n [rpm]", "rpm"), "run.csv:1: no column `n`", "did you mean `rpm`?"),
        (
            "semicolons",
            good().join("\n").replace(',', ";"),
            "run.csv:1: the columns are separated by `;`",
            "delimiter = \"semicolon\"",
        ),
        (
            "a spreadsheet",
            "PK\u{3}\u{4}\u{14}\0\u{6}\0".to_owned(),
            "run.csv: this is no plain text",
            "export it as CSV",
        ),
        ("no unit", header("delta [deg]", "delta"), "run.csv:1: column `delta` has no unit", "`delta [rad]`"),
        (
            "unknown unit",
            header("n [rpm]", "n [rpn]"),
            "run.csv:1: column `n` has the unit `rpn`",
            "did you mean `rpm`?",
        ),
        ("repeated column", header("x [m]", "u [m/s]"), "run.csv:1: column `u` appears twice", "index"),
        ("x without y", header("y [m]", "yy [m]"), "run.csv:1: channel `y`", "record it, or leave `x` out"),
    ];
    faults.map(|(name, text, start, rest)| (name, text, "", start, rest)).into()
}

/// Faults of rows and values.
fn values() -> Vec<Fault> {
    let header = |from: &str, to: &str| with_line(1, &HEADER.replace(from, to));
    let faults = [
        ("short row", with_line(5, "3,6,0"), "run.csv:5: 3 fields where 9 are expected", "cut short"),
        ("long row", with_line(5, &(row(3.0) + ",1")), "run.csv:5: 10 fields where 9 are expected", "delimiter"),
        (
            "text in a row",
            with_line(6, "4,8,0,0,fast,0,0,60,5"),
            "run.csv:6: column `u [m/s]` contains `fast`",
            "leave the field empty",
        ),
        (
            "duplicate time",
            with_line(6, &row(3.0)),
            "run.csv:6: time 3 s repeats 3 s of line 5",
            "the whole row is there twice: remove it",
        ),
        (
            "rounded clock",
            with_line(6, "3,8,0,0,2,0,0,60,5"),
            "run.csv:6: time 3 s repeats 3 s of line 5",
            "`dt` in a column map",
        ),
        (
            "time goes back",
            with_line(6, &row(2.5)),
            "run.csv:6: time 2.5 s goes back from 3 s of line 5",
            "sort the rows",
        ),
        (
            "rudder of 212 rad",
            with_line(8, "6,12,0,0,2,0,0,60,212").replace("delta [deg]", "delta [rad]").replace(",60,5", ",60,0.1"),
            "run.csv:8: rudder angle 212 rad is outside +-1.6",
            "one row of 10",
        ),
        (
            "rudder in degrees",
            header("delta [deg]", "delta [rad]"),
            "run.csv:2: rudder angle 5 rad is outside +-1.6",
            "is the column in degrees?",
        ),
        (
            "shaft in rpm",
            header("n [rpm]", "n [rps]").replace(",60,5", ",91,5"),
            "run.csv:2: propeller rate 91 rps is outside +-60",
            "is the column in rpm?",
        ),
    ];
    faults.map(|(name, text, start, rest)| (name, text, "", start, rest)).into()
}

/// Faults of gaps and lengths.
fn gaps() -> Vec<Fault> {
    let faults = [
        (
            "NaN row",
            with_line(6, "4,NaN,NaN,NaN,NaN,NaN,NaN,NaN,NaN"),
            "run.csv:6: x, y, psi, u, v, r, n, delta are missing",
            "gaps = \"split\"",
        ),
        (
            "NaN in one channel",
            with_line(6, "4,8,0,0,2,0,nan,60,5"),
            "run.csv:6: r is missing",
            "from line 6 to 6, 1 rows",
        ),
        (
            "gap",
            good()
                .into_iter()
                .enumerate()
                .filter(|(i, _)| !(4..7).contains(i))
                .map(|(_, l)| l)
                .collect::<Vec<_>>()
                .join("\n"),
            "run.csv:5: 4.000 s pass",
            "gaps = \"split\"",
        ),
        (
            "all NaN in a channel",
            good().join("\n").replace(",60,5", ",,5"),
            "run.csv:2: no two consecutive rows",
            "`n` is missing in 10 of 10 rows",
        ),
        (
            "shorter than a window",
            good()[..4].join("\n"),
            "run.csv:2: the longest unbroken stretch lasts 2.00 s",
            "window of 5.00 s",
        ),
        ("one row", good()[..2].join("\n"), "run.csv:2: no two consecutive rows", "only one row"),
    ];
    faults.map(|(name, text, start, rest)| (name, text, "", start, rest)).into()
}

/// Faults of the column map, on good rows.
fn maps() -> Vec<Fault> {
    let faults = [
        (
            "map names a missing column",
            "[columns]\nt = \"t\"\nn = \"n\"\ndelta = \"rudder\"\n",
            "run.csv:1: no column `rudder`",
            "channel `delta`",
        ),
        (
            "map leaves out the rudder",
            "leave_out = [\"delta\"]\n[columns]\nt = \"t\"\nn = \"n\"\n",
            "columns.toml:1: [columns] has no entry for channel `delta`",
            "every run needs",
        ),
        (
            "map with a column too far",
            "[columns]\nt = \"t\"\nn = \"n\"\ndelta = { index = 12 }\n",
            "columns.toml:4: channel `delta` is column 12",
            "9 columns",
        ),
        (
            "map with a wrong unit",
            "[columns]\nt = \"t\"\nn = \"n\"\ndelta = { column = \"delta\", unit = \"dgr\" }\n",
            "columns.toml:4: column `delta` has the unit `dgr`",
            "did you mean `deg",
        ),
        (
            "map with a wrong key",
            "delimiter = \"coma\"\n",
            "columns.toml:1: `delimiter`: unknown word `coma`",
            "did you mean `comma`?",
        ),
        ("no header, no indices", "header = false\n", "columns.toml:1: a file without a header", "`index`"),
        (
            "velocity derived without heading",
            "derive = [\"u\"]\nleave_out = [\"psi\", \"u\", \"v\"]\n",
            "run.csv:1: channel `psi` (heading) is needed to derive velocity",
            "`derive`",
        ),
        (
            "no velocity and no heading",
            "leave_out = [\"psi\", \"u\", \"v\"]\n",
            "run.csv:1: channel `u` (surge velocity) is needed to simulate",
            "derive",
        ),
    ];
    faults.map(|(name, map, start, rest)| (name, good().join("\n"), map, start, rest)).into()
}

#[test]
fn every_fault_of_a_recording_is_one_message_with_place_and_next_step() {
    for (name, text, map, start, rest) in [headers(), values(), gaps(), maps()].concat() {
        let message = message(&text, map).unwrap_or_else(|| panic!("{name}: no message"));
        assert!(
            message.starts_with(start) && message.contains(rest),
            "{name}:\n{message}\nshould start {start}\nand contain {rest}"
        );
        assert!(!message.contains('\n') && !message.contains("NaN is"), "{name}: one line\n{message}");
    }
}

#[test]
fn times_that_leave_nothing_are_reported_with_those_of_the_recording() {
    let recording = Recording::parse(&good().join("\n"), Path::new("run.csv"), &ColumnMap::default()).unwrap();
    let labels = Labels { run: "run".into(), session: "a".into(), manoeuvre: "b".into(), split: Split::Train };
    let whole = WindowSettings::whole(5.0);
    for (settings, words) in [
        (
            WindowSettings { from: Some(100.0), ..whole.clone() },
            "lasts from 0 s to 9 s, of which `from` = 100 s leaves nothing",
        ),
        (WindowSettings { to: Some(-5.0), ..whole.clone() }, "`to` = -5 s leaves nothing"),
        (
            WindowSettings { discard_start: 5.0, discard_end: 5.0, ..whole.clone() },
            "`discard_start` = 5 s, `discard_end` = 5 s leave nothing",
        ),
        (WindowSettings { step: Some(60.0), ..whole.clone() }, "`step` = 60 s is too long for a recording of 9 s"),
        (WindowSettings { window: Some(1.0), ..whole }, "`window` = 1 s is 1 steps of 1 s"),
    ] {
        let message = recording.windows(&labels, &settings).err().map_or(String::new(), |e| e.to_string());
        assert!(message.starts_with("run.csv: ") && message.contains(words), "{message}");
    }
}

#[test]
fn the_message_of_a_missing_file_has_its_path() {
    let error = Recording::read(Path::new("nowhere/run.csv"), &ColumnMap::default()).unwrap_err().to_string();
    assert!(error.starts_with("nowhere/run.csv: cannot read the recording"), "{error}");
}

#[test]
fn harmless_variants_of_the_csv_format_are_read() {
    // A byte order mark, Windows line ends, quotes, blank lines and trailing delimiters are no faults.
    let quoted = HEADER.split(',').map(|h| format!("\"{h}\"")).collect::<Vec<_>>().join(",");
    let rows = good()[1..].iter().map(|r| format!("{r},")).collect::<Vec<_>>().join("\r\n");
    assert_eq!(message(&format!("\u{feff}{quoted}\r\n\r\n{rows}\r\n,,,,,,,,\r\n"), ""), None);
}
