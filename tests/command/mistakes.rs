//! The natural mistakes of a new user, one table of them all: each is reported with its place and with what mends it, and what the message
//! says is done here word for word, after which the command succeeds. Faults of single modules have tests of their own.

use crate::support::study::{Study, text};
use std::path::PathBuf;

const KNOT: f64 = 1852.0 / 3600.0;
const CHECK: &[&str] = &["check", "study.toml"];
const SIMULATE: &[&str] = &["simulate", "study.toml"];
const IMPORT: &[&str] = &["import", "log.csv", "--out", "own"];

/// A mistake, what is said of it, and its mend.
struct Mistake {
    name: &'static str,
    make: fn(&Study),
    /// The command that reports it.
    asked: &'static [&'static str],
    /// The place, and then the words that mend it.
    says: &'static [&'static str],
    mend: fn(&Study),
    /// The command that then succeeds.
    then: &'static [&'static str],
}

/// A mistake that is mended in a file.
fn in_file(
    name: &'static str,
    make: fn(&Study),
    asked: &'static [&'static str],
    says: &'static [&'static str],
    mend: fn(&Study),
) -> Mistake {
    Mistake { name, make, asked, says, mend, then: asked }
}

/// A mistake that is mended by another command line.
fn in_command(
    name: &'static str,
    make: fn(&Study),
    asked: &'static [&'static str],
    says: &'static [&'static str],
    then: &'static [&'static str],
) -> Mistake {
    Mistake { name, make, asked, says, mend: nothing, then }
}

fn nothing(_: &Study) {}

fn recordings(study: &Study) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(study.path("recordings")).unwrap().map(|e| e.unwrap().path()).collect();
    files.sort();
    files
}

/// Changes every recording.
fn each(study: &Study, change: impl Fn(String) -> String) {
    for path in recordings(study) {
        std::fs::write(&path, change(std::fs::read_to_string(&path).unwrap())).unwrap();
    }
}

/// Changes the lines of the second recording, which is one to train on.
fn second(study: &Study, change: impl Fn(&mut Vec<String>)) {
    let path = &recordings(study)[1];
    let mut lines: Vec<String> = std::fs::read_to_string(path).unwrap().lines().map(str::to_owned).collect();
    change(&mut lines);
    std::fs::write(path, lines.join("\n") + "\n").unwrap();
}

/// Gives a column of every recording a header and other values, from the row and its numbers.
fn column(study: &Study, at: usize, header: &str, value: impl Fn(usize, &[f64]) -> String) {
    each(study, |text| {
        let changed = |(row, line): (usize, &str)| {
            let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
            let numbers: Vec<f64> = cells.iter().filter_map(|c| c.parse().ok()).collect();
            cells[at] = if row == 0 { header.to_owned() } else { value(row - 1, &numbers) };
            cells.join(",") + "\n"
        };
        text.lines().enumerate().map(changed).collect()
    });
}

/// A column of every recording times a factor, under the header that it has.
fn scaled(study: &Study, at: usize, factor: f64) {
    let header = ["t [s]", "x [m]", "y [m]", "psi [rad]", "u [m/s]", "v [m/s]", "r [rad/s]", "n [rps]", "delta [rad]"];
    column(study, at, header[at], |_, row| (factor * row[at]).to_string());
}

fn renamed(study: &Study, from: &str, to: &str) {
    each(study, |text| text.replace(from, to));
}

/// Gives the study a column map.
fn map(study: &Study, text: &str) {
    study.write("columns.toml", text);
    study.edit("study.toml", "runs = \"runs.csv\"", "column_map = \"columns.toml\"\nruns = \"runs.csv\"");
}

/// A column map of one line below `[columns]`.
fn columns(study: &Study, line: &str) {
    map(study, &format!("[columns]\n{line}\n"));
}

/// A key at the top of the study.
fn top(study: &Study, line: &str) {
    study.edit("study.toml", "runs = \"runs.csv\"", &format!("{line}\nruns = \"runs.csv\""));
}

/// How files are laid out.
fn layouts() -> Vec<Mistake> {
    vec![
        in_file(
            "semicolons",
            |s| renamed(s, ",", ";"),
            SIMULATE,
            &["ship_a_001.csv:1:", "separated by `;`", "`delimiter = \"semicolon\"`"],
            |s| map(s, "delimiter = \"semicolon\"\n"),
        ),
        in_file(
            "tabulators",
            |s| renamed(s, ",", "\t"),
            SIMULATE,
            &["ship_a_001.csv:1:", "`delimiter = \"tab\"`"],
            |s| map(s, "delimiter = \"tab\"\n"),
        ),
        in_file(
            "decimal commas",
            |s| {
                each(s, |t| t.replace(',', ";").replace('.', ","));
                map(s, "delimiter = \"semicolon\"\n");
            },
            SIMULATE,
            &["ship_a_001.csv:2: column `x [m]` contains `120,16`", "`decimal = \"comma\"`"],
            |s| s.write("columns.toml", "delimiter = \"semicolon\"\ndecimal = \"comma\"\n"),
        ),
        in_command(
            "ISO times",
            |s| {
                column(s, 0, "t [s]", |i, _| format!("2024-05-01T12:{:02}:{:02}Z", 2 * i / 60, 2 * i % 60));
                std::fs::copy(&recordings(s)[6], s.path("log.csv")).unwrap();
            },
            SIMULATE,
            &["ship_a_001.csv:2: column `t [s]` contains `2024-05-01T12:00:00Z`", "`trimtab import`"],
            IMPORT,
        ),
        in_file(
            "an empty recording",
            |s| second(s, Vec::clear),
            SIMULATE,
            &["ship_a_002.csv:1: the recording is empty", "leave the run out of the study"],
            |s| s.edit("runs.csv", "recordings/ship_a_002.csv,ship_a_002,approach,train\n", ""),
        ),
        in_file(
            "a row cut short",
            |s| second(s, |lines| lines[41].truncate(12)),
            SIMULATE,
            &["ship_a_002.csv:42: 3 fields where 9 are expected", "is the row cut short"],
            |s| second(s, |lines| lines.truncate(41)),
        ),
        in_file(
            "text among numbers",
            |s| second(s, |lines| lines[41] = lines[41].replacen("80,", "end,", 1)),
            SIMULATE,
            &["ship_a_002.csv:42: column `t [s]` contains `end`", "correct it"],
            |s| second(s, |lines| lines[41] = lines[41].replacen("end,", "80,", 1)),
        ),
    ]
}

/// What columns are called.
fn names() -> Vec<Mistake> {
    vec![
        in_file(
            "`rudder` for delta",
            |s| renamed(s, "delta [rad]", "rudder [rad]"),
            SIMULATE,
            &["ship_a_001.csv:1: no column `delta`", "did you mean `rudder`?", "[columns] delta ="],
            |s| columns(s, "delta = \"rudder\""),
        ),
        in_file(
            "`rpm` for n",
            |s| column(s, 7, "rpm [rpm]", |_, row| (60.0 * row[7]).to_string()),
            SIMULATE,
            &["ship_a_001.csv:1: no column `n`", "did you mean `rpm`?", "[columns] n ="],
            |s| columns(s, "n = \"rpm\""),
        ),
        in_file(
            "`heading` for psi",
            |s| renamed(s, "psi [rad]", "heading [rad]"),
            CHECK,
            &["8 of 8 runs, as ship_a_001 (channel psi): heading was not recorded", "name its column in a column map"],
            |s| columns(s, "psi = \"heading\""),
        ),
        in_file(
            "no unit",
            |s| renamed(s, "delta [rad]", "delta"),
            SIMULATE,
            &["ship_a_001.csv:1: column `delta` has no unit", "as in `delta [rad]`"],
            |s| renamed(s, "delta", "delta [rad]"),
        ),
        in_file(
            "a misspelt unit",
            |s| renamed(s, "n [rps]", "n [rsp]"),
            SIMULATE,
            &["ship_a_001.csv:1: column `n` has the unit `rsp`", "expected one of rps, rpm", "`n [rps]`"],
            |s| renamed(s, "n [rsp]", "n [rps]"),
        ),
    ]
}

/// Units that are not those that were declared.
fn units() -> Vec<Mistake> {
    vec![
        in_file(
            "knots as m/s",
            |s| {
                scaled(s, 4, 1.0 / KNOT);
                scaled(s, 5, 1.0 / KNOT);
            },
            CHECK,
            &["8 of 8 runs", "the column is in knots and was declared m/s", "correct `unit` of u and v"],
            |s| columns(s, "u = { unit = \"kn\" }\nv = { unit = \"kn\" }"),
        ),
        in_file(
            "a heading in degrees as radians",
            |s| scaled(s, 3, 1f64.to_degrees()),
            CHECK,
            &["(channel r)", "or the heading in deg and declared rad", "correct `unit`"],
            |s| columns(s, "psi = { unit = \"deg\" }"),
        ),
        in_file(
            "a rudder in degrees as radians",
            |s| scaled(s, 8, 1f64.to_degrees()),
            SIMULATE,
            &["ship_a_001.csv:2: rudder angle -30", "is the column in degrees?"],
            |s| columns(s, "delta = { unit = \"deg\" }"),
        ),
        in_file(
            "a rudder in radians as degrees",
            |s| renamed(s, "delta [rad]", "delta [deg]"),
            CHECK,
            &["(channel delta): rudder angle never exceeds", "is the column in rad? set `unit` for `delta`"],
            |s| columns(s, "delta = { unit = \"rad\" }"),
        ),
        in_file(
            "a yaw rate in deg/s as rad/s",
            |s| scaled(s, 6, 1f64.to_degrees()),
            CHECK,
            &["(channel r)", "the yaw rate is in deg/s and was declared rad/s", "correct `unit`"],
            |s| columns(s, "r = { unit = \"deg/s\" }"),
        ),
        in_file(
            "a yaw rate in deg/min as deg/s",
            |s| column(s, 6, "r [deg/s]", |_, row| (60.0 * row[6].to_degrees()).to_string()),
            CHECK,
            &["(channel r)", "the yaw rate is in deg/min and was declared deg/s", "correct `unit`"],
            |s| columns(s, "r = { unit = \"deg/min\" }"),
        ),
        in_file(
            "rpm as rps",
            |s| scaled(s, 7, 60.0),
            SIMULATE,
            &["ship_a_001.csv:2: propeller rate 120", "is the column in rpm?"],
            |s| columns(s, "n = { unit = \"rpm\" }"),
        ),
        in_file(
            "rps as rpm",
            |s| renamed(s, "n [rps]", "n [rpm]"),
            CHECK,
            &["(channel n)", "the column is in rps and was declared rpm", "scale = 60", "check the unit of n"],
            |s| columns(s, "n = { unit = \"rps\" }"),
        ),
        in_file(
            "times in ms as s",
            |s| scaled(s, 0, 1000.0),
            CHECK,
            &["8 of 8 runs", "the time is in ms and was declared s", "correct `unit`"],
            |s| columns(s, "t = { unit = \"ms\" }"),
        ),
    ]
}

/// Signs, axes and places.
fn signs_and_axes() -> Vec<Mistake> {
    vec![
        in_file(
            "a rudder positive to port",
            |s| scaled(s, 8, -1.0),
            CHECK,
            &["(channel delta): the ship turns against its rudder", "set `sign = -1` for `delta`"],
            |s| columns(s, "delta = { sign = -1 }"),
        ),
        in_file(
            "a yaw rate positive to port",
            |s| scaled(s, 6, -1.0),
            CHECK,
            &["(channel r)", "the sign is turned", "correct `unit` or `sign` of `r`"],
            |s| columns(s, "r = { sign = -1 }"),
        ),
        in_file(
            "a heading counted anticlockwise",
            |s| scaled(s, 3, -1.0),
            CHECK,
            &["(channel psi)", "or heading counted anticlockwise?", "set `sign = -1`"],
            |s| columns(s, "psi = { sign = -1 }"),
        ),
        in_file(
            "sway positive to port",
            |s| scaled(s, 5, -1.0),
            CHECK,
            &["(channel v)", "is v positive to port?", "set `sign = -1` for `v`"],
            |s| columns(s, "v = { sign = -1 }"),
        ),
        in_file(
            "east as x and north as y",
            |s| each(s, |t| t.replacen("x [m],y [m]", "y [m],x [m]", 1)),
            CHECK,
            &["(channel psi)", "are x and y exchanged", "exchange them"],
            |s| columns(s, "x = \"y\"\ny = \"x\""),
        ),
        in_file(
            "velocities along north and east",
            |s| {
                each(s, |text| {
                    let turned = |line: &str| {
                        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
                        let c: Vec<f64> = cells.iter().filter_map(|c| c.parse().ok()).collect();
                        if c.len() == 9 {
                            cells[4] = (c[4] * c[3].cos() - c[5] * c[3].sin()).to_string();
                            cells[5] = (c[4] * c[3].sin() + c[5] * c[3].cos()).to_string();
                        }
                        cells.join(",") + "\n"
                    };
                    text.lines().map(turned).collect()
                });
            },
            CHECK,
            &["(channel u): u and v follow the track along the earth's axes", "`velocity_frame = \"earth\"`"],
            |s| map(s, "velocity_frame = \"earth\"\n"),
        ),
        in_file(
            "a heading that is 11 degrees off",
            |s| column(s, 3, "psi [rad]", |_, row| (row[3] + 0.2).to_string()),
            CHECK,
            &["(channel psi): the track runs -11.5 deg clockwise of heading", "`offset` in a column map"],
            |s| columns(s, "psi = { offset = -0.2 }"),
        ),
    ]
}

/// Rows and times.
fn rows_and_gaps() -> Vec<Mistake> {
    vec![
        in_file(
            "rows lost",
            |s| second(s, |lines| drop(lines.drain(30..35))),
            SIMULATE,
            &["ship_a_002.csv:31: 12.000 s pass since the row before", "`gaps = \"split\"` in the study"],
            |s| top(s, "gaps = \"split\""),
        ),
        in_file(
            "one channel slower than the others",
            |s| {
                column(s, 6, "r [rad/s]", |i, row| if i % 2 == 0 { row[6].to_string() } else { String::new() });
            },
            SIMULATE,
            &["ship_a_001.csv:2: no two consecutive rows", "`r` is missing in 20 of 41 rows", "`bridge`"],
            |s| map(s, "bridge = 4.0\n"),
        ),
        in_file(
            "a fill value in the position",
            |s| fill(s, 1),
            CHECK,
            &["ship_a_002 (channel x, lines 9-10): -9999 m in 2 rows", "`blank = -9999` for `x`"],
            |s| map(s, "bridge = 8.0\n[columns]\nx = { blank = -9999 }\n"),
        ),
        in_file(
            "a fill value in the rudder",
            |s| fill(s, 8),
            SIMULATE,
            &["ship_a_002.csv:9: rudder angle -9999 rad", "`blank = -9999` in a column map"],
            |s| map(s, "bridge = 8.0\nblank = -9999\n"),
        ),
        in_file(
            "a row twice",
            |s| second(s, |lines| lines.insert(9, lines[8].clone())),
            SIMULATE,
            &["ship_a_002.csv:10: time 14 s repeats 14 s of line 9", "remove it"],
            |s| second(s, |lines| drop(lines.remove(9))),
        ),
        in_file(
            "rows out of order",
            |s| second(s, |lines| lines.swap(9, 10)),
            SIMULATE,
            &["ship_a_002.csv:11: time 16 s goes back from 18 s of line 10", "sort the rows by time"],
            |s| second(s, |lines| lines.swap(9, 10)),
        ),
        in_file(
            "a clock rounded to 5 s",
            |s| column(s, 0, "t [s]", |i, _| (2 * i / 5 * 5).to_string()),
            SIMULATE,
            &["ship_a_001.csv:3: time 0 s repeats 0 s of line 2", "set `dt` in a column map"],
            |s| map(s, "dt = 2.0\n"),
        ),
        in_file(
            "a window longer than the runs",
            |s| top(s, "window = 600.0"),
            SIMULATE,
            &["ship_a_001.csv:2: the longest unbroken stretch lasts 80.00 s", "set a shorter `window`"],
            |s| s.edit("study.toml", "window = 600.0", "window = 60.0"),
        ),
    ]
}

/// Two rows of a channel that say -9999.
fn fill(study: &Study, at: usize) {
    second(study, |lines| {
        for line in &mut lines[8..10] {
            let mut cells: Vec<&str> = line.split(',').collect();
            cells[at] = "-9999";
            *line = cells.join(",");
        }
    });
}

/// The table of runs.
fn tables_of_runs() -> Vec<Mistake> {
    vec![
        in_file(
            "a misspelt recording",
            |s| s.edit("runs.csv", "ship_a_002.csv", "ship_a_02.csv"),
            SIMULATE,
            &["runs.csv:3: recording", "ship_a_02.csv does not exist", "correct `file`"],
            |s| s.edit("runs.csv", "ship_a_02.csv", "ship_a_002.csv"),
        ),
        in_file(
            "a misspelt column of the runs",
            |s| s.edit("runs.csv", ",split", ",spilt"),
            SIMULATE,
            &["runs.csv:1: unknown column `spilt`", "did you mean `split`?"],
            |s| s.edit("runs.csv", ",spilt", ",split"),
        ),
        in_file(
            "a misspelt side",
            |s| s.edit("runs.csv", ",test", ",tset"),
            SIMULATE,
            &["runs.csv:2: unknown word `tset`", "did you mean `test`?"],
            |s| s.edit("runs.csv", ",tset", ",test"),
        ),
        in_file(
            "no run to test on",
            |s| s.edit("runs.csv", ",test", ",train"),
            &["evaluate", "study.toml"],
            &["study.toml: there is no run to judge by", "mark one with `split = \"test\"`"],
            |s| s.edit("runs.csv", "ship_a_004,approach,train", "ship_a_004,approach,test"),
        ),
        in_file(
            "the same data to train and to test on",
            |s| s.edit("runs.csv", "recordings/ship_a_002.csv", "recordings/ship_a_001.csv"),
            CHECK,
            &["run ship_a_002 to train on and run ship_a_001 to test on share", "keep both on one side of the split"],
            |s| s.edit("runs.csv", "ship_a_002,approach,train", "ship_a_002,approach,test"),
        ),
    ]
}

/// The study.
fn studies() -> Vec<Mistake> {
    vec![
        in_file(
            "a misspelt key",
            |s| s.edit("study.toml", "ship = ", "shpi = "),
            SIMULATE,
            &["study.toml:3: unknown key `shpi`", "did you mean `ship`?"],
            |s| s.edit("study.toml", "shpi = ", "ship = "),
        ),
        in_file(
            "a key in the wrong table",
            |s| s.edit("study.toml", "[evaluate]", "[evaluate]\nwindow = 60.0"),
            SIMULATE,
            &["study.toml:19: [evaluate] `window`", "it stands at the top, before the first [table]"],
            |s| {
                s.edit("study.toml", "[evaluate]\nwindow = 60.0", "[evaluate]");
                top(s, "window = 60.0");
            },
        ),
        in_file(
            "a name without quotes",
            |s| s.edit("study.toml", "\"ship.toml\"", "ship.toml"),
            SIMULATE,
            &["study.toml:3:", "a text stands in quotes"],
            |s| s.edit("study.toml", "= ship.toml", "= \"ship.toml\""),
        ),
        in_file(
            "a number in quotes",
            |s| s.edit("study.toml", "speed = 6.0", "speed = \"6.0\""),
            SIMULATE,
            &["study.toml:22: [maneuver] `speed`", "a number, without quotes"],
            |s| s.edit("study.toml", "\"6.0\"", "6.0"),
        ),
        in_file(
            "a mechanism that does not exist, withheld",
            |s| s.append("study.toml", "\n[diagnose]\nalpha = 0.01\nwithhold = [\"curent\"]\n"),
            CHECK,
            &["study.toml:26: [diagnose] there is no mechanism `curent`", "did you mean `current`?"],
            |s| s.edit("study.toml", "curent", "current"),
        ),
        in_file(
            "the largest yaw rate in deg/s",
            |s| s.edit("study.toml", "max_yaw_rate = 0.0314", "max_yaw_rate = 1.8"),
            &["fit", "study.toml"],
            &[
                "study.toml:13: [fit] `max_yaw_rate` = 1.80 rad/s",
                "times the largest yaw rate recorded",
                "write 0.0314",
            ],
            |s| s.edit("study.toml", "max_yaw_rate = 1.8", "max_yaw_rate = 0.0314"),
        ),
        in_file(
            "a column map that says it of no channel",
            |s| columns(s, "rudder = \"delta\""),
            SIMULATE,
            &["columns.toml:2: unknown channel `rudder`", "did you mean `delta`"],
            |s| s.write("columns.toml", "[columns]\ndelta = \"delta\"\n"),
        ),
    ]
}

/// The ship.
fn ships() -> Vec<Mistake> {
    vec![
        Mistake {
            name: "only L, B and d known",
            make: |s| {
                s.write("ship.toml", "name = \"own\"\n[hull]\nlpp = 85.0\nbreadth = 13.5\ndraught = 4.2\n");
            },
            asked: SIMULATE,
            says: &["ship.toml: a value is missing: hull.mass [kg]", "trimtab new --from ship.toml --type TYPE --out"],
            mend: |s| drop(s.does(&["new", "--from", "ship.toml", "--type", "coaster", "--out", "ship_complete.toml"])),
            then: &["new", "--from", "ship_complete.toml", "--type", "coaster"],
        },
        in_file(
            "a mass in tonnes",
            |s| s.edit("ship.toml", "3.359e6", "3359.0"),
            SIMULATE,
            &["ship.toml:9: hull.mass = 3359 kg", "is the mass in kg?"],
            |s| s.edit("ship.toml", "3359.0", "3359000.0"),
        ),
        in_file(
            "a draught in centimetres",
            |s| s.edit("ship.toml", "draught = 4.2", "draught = 420.0"),
            SIMULATE,
            &["ship.toml:8: hull.draught = 420", "the draught in m"],
            |s| s.edit("ship.toml", "draught = 420.0", "draught = 4.2"),
        ),
        in_file(
            "a wake fraction in per cent",
            |s| s.edit("ship.toml", "wake = 0.28", "wake = 28.0"),
            SIMULATE,
            &["ship.toml:17: propeller.wake = 28", "a share of the ship's speed"],
            |s| s.edit("ship.toml", "wake = 28.0", "wake = 0.28"),
        ),
        in_file(
            "a radius of gyration in metres",
            |s| s.edit("ship.toml", "gyration = 0.25", "gyration = 21.25"),
            SIMULATE,
            &["ship.toml:12: hull.gyration = 21.25", "divide a radius in m by L"],
            |s| s.edit("ship.toml", "gyration = 21.25", "gyration = 0.25"),
        ),
        in_file(
            "a density in t/m3",
            |s| s.edit("ship.toml", "1025.0", "1.025"),
            SIMULATE,
            &["ship.toml:13: hull.water_density = 1.025", "kg/m3, 1025 in the sea"],
            |s| s.edit("ship.toml", "1.025", "1025.0"),
        ),
        in_file(
            "`draft`",
            |s| s.edit("ship.toml", "draught = ", "draft = "),
            SIMULATE,
            &["ship.toml:8: unknown key `draft`", "did you mean `draught`?"],
            |s| s.edit("ship.toml", "draft = ", "draught = "),
        ),
        in_file(
            "a decimal comma",
            |s| s.edit("ship.toml", "breadth = 13.5", "breadth = 13,5"),
            SIMULATE,
            &["ship.toml:7:", "a number has a decimal point, not a comma"],
            |s| s.edit("ship.toml", "13,5", "13.5"),
        ),
    ]
}

/// The model.
fn models() -> Vec<Mistake> {
    vec![
        in_file(
            "a misspelt parameter",
            |s| s.edit("model.toml", "rudder.lift1", "rudder.lft1"),
            SIMULATE,
            &["model.toml:13: unknown parameter `rudder.lft1`", "did you mean `rudder.lift1`?"],
            |s| s.edit("model.toml", "lft1", "lift1"),
        ),
        in_file(
            "a misspelt term",
            |s| s.edit("model.toml", "form = \"paper\"", "form = \"paper\"\nterms = [\"curent\"]"),
            SIMULATE,
            &["model.toml:6: unknown term `curent`", "did you mean `current`?"],
            |s| s.edit("model.toml", "curent", "current"),
        ),
        in_file(
            "an added mass of the wrong sign",
            |s| s.append("model.toml", "\"hull.Yvdot\" = { value = 3.0e6 }\n"),
            SIMULATE,
            &["model.toml:19: parameter `hull.Yvdot` = 3000000", "must be at most 0 kg"],
            |s| s.edit("model.toml", "3.0e6", "-3.0e6"),
        ),
    ]
}

/// Arguments.
fn arguments() -> Vec<Mistake> {
    vec![
        in_command(
            "a misspelt study",
            nothing,
            &["check", "stduy.toml"],
            &["stduy.toml: cannot read the study", "did you mean `study.toml`?"],
            CHECK,
        ),
        in_command(
            "the folder for the study",
            nothing,
            &["check", "."],
            &[".: cannot read the study", "name a file in it, such as `./study.toml`"],
            &["check", "./study.toml"],
        ),
        in_command(
            "the ship as the model",
            nothing,
            &["simulate", "study.toml", "--model", "ship.toml"],
            &["ship.toml:1: this is a ship file, not a model file", "`model` in the study"],
            &["simulate", "study.toml", "--model", "model.toml"],
        ),
        in_command(
            "a speed in knots",
            nothing,
            &["maneuver", "turning", "study.toml", "--speed", "60"],
            &["`speed` = 60", "an approach speed in m/s", "is it in knots?"],
            &["maneuver", "turning", "study.toml", "--speed", "6.2"],
        ),
        in_command(
            "a number with its unit",
            nothing,
            &["new", "--lpp", "50m", "--breadth", "9", "--draught", "3", "--type", "tug"],
            &["'50m' for '--lpp", "a number, without a unit"],
            &["new", "--lpp", "50", "--breadth", "9", "--draught", "3", "--type", "tug"],
        ),
    ]
}

/// Options.
fn options() -> Vec<Mistake> {
    vec![
        in_command(
            "a type of ship that is not listed",
            nothing,
            &["new", "--lpp", "85", "--breadth", "13.5", "--draught", "4.2", "--type", "coastr"],
            &["unknown type `coastr`", "did you mean `coaster`?"],
            &["new", "--lpp", "85", "--breadth", "13.5", "--draught", "4.2", "--type", "coaster"],
        ),
        in_command(
            "a file for the folder of results",
            nothing,
            &["fit", "study.toml", "--out", "ship.toml"],
            &["ship.toml: cannot write into it", "choose another folder (--out)"],
            &["fit", "study.toml", "--out", "results"],
        ),
        in_command(
            "a picture format that there is not",
            nothing,
            &["fit", "study.toml", "--format", "jpg", "--out", "results"],
            &["'jpg' for '--format", "png, svg, pdf"],
            &["fit", "study.toml", "--format", "png", "--out", "results"],
        ),
        in_command(
            "a share in per cent",
            nothing,
            &["split", "study.toml", "--test", "25"],
            &["study.toml: --test 25", "such as 0.25"],
            &["split", "study.toml", "--test", "0.25"],
        ),
        in_command(
            "a mechanism that does not exist",
            nothing,
            &["diagnose", "study.toml", "--withhold", "curent"],
            &["--withhold: there is no mechanism `curent`", "did you mean `current`?"],
            &["check", "study.toml"],
        ),
        in_command(
            "a misspelt chapter",
            nothing,
            &["help", "colums"],
            &["no topic or command `colums`", "did you mean `columns`?"],
            &["help", "columns"],
        ),
    ]
}

/// A log with times, places and usual units, of which the last two columns are named so.
fn log(study: &Study, last: &str, rate: impl Fn(f64) -> f64, time: impl Fn(f64) -> String) {
    let mut text = format!("time,lat,lon,SOG [kn],COG [deg],HDG [deg],ROT [deg/min],{last}\n");
    for line in std::fs::read_to_string(&recordings(study)[6]).unwrap().lines().skip(1) {
        let c: Vec<f64> = line.split(',').map(|c| c.parse().unwrap()).collect();
        let (north, east) = (c[4] * c[3].cos() - c[5] * c[3].sin(), c[4] * c[3].sin() + c[5] * c[3].cos());
        let place = [54.0 + c[1] / 111_120.0, 10.0 + c[2] / 111_120.0 / 54f64.to_radians().cos()];
        let course = east.atan2(north).to_degrees().rem_euclid(360.0);
        let (rot, rudder) = (60.0 * c[6].to_degrees(), c[8].to_degrees());
        let (t, lat, lon, sog) = (time(c[0]), place[0], place[1], north.hypot(east) / KNOT);
        let (heading, n) = (c[3].to_degrees().rem_euclid(360.0), rate(c[7]));
        text += &format!("{t},{lat:.7},{lon:.7},{sog:.3},{course:.2},{heading:.2},{rot:.2},{rudder:.2},{n:.2}\n");
    }
    study.write("log.csv", &text);
}

fn iso(t: f64) -> String {
    format!("2024-05-01T12:{:02}:{:02}Z", t as u32 / 60, t as u32 % 60)
}

/// Logs to import.
fn logs() -> Vec<Mistake> {
    fn usual(study: &Study) {
        log(study, "Rudder [deg],RPM", |n| 60.0 * n, iso);
    }
    vec![
        in_command(
            "a misspelt log",
            usual,
            &["import", "lgo.csv", "--out", "own"],
            &["lgo.csv: cannot read the file", "did you mean `log.csv`?"],
            IMPORT,
        ),
        in_command(
            "columns with names of their own",
            |s| log(s, "fb1,fb2", |n| 60.0 * n, iso),
            IMPORT,
            &["no column is the rudder angle", "`--column delta=NAME`", "`--column n=NAME`", "fb1, fb2"],
            &["import", "log.csv", "--out", "own", "--column", "delta=fb1", "--column", "n=fb2"],
        ),
        in_command(
            "a misspelt channel",
            usual,
            &["import", "log.csv", "--out", "own", "--column", "psy=HDG"],
            &["--column psy=", "did you mean `psi`?"],
            &["import", "log.csv", "--out", "own", "--column", "psi=HDG"],
        ),
        in_command(
            "a misspelt column of a log",
            usual,
            &["import", "log.csv", "--out", "own", "--column", "psi=HDX"],
            &["--column psi=HDX", "did you mean `HDG`?"],
            &["import", "log.csv", "--out", "own", "--column", "psi=HDG"],
        ),
        in_command(
            "a misspelt unit of a log",
            usual,
            &["import", "log.csv", "--out", "own", "--unit", "n=rpn"],
            &["--unit n=rpn", "none of rps, rpm"],
            &["import", "log.csv", "--out", "own", "--unit", "n=rpm"],
        ),
        in_command(
            "half a place of the antenna",
            usual,
            &["import", "log.csv", "--out", "own", "--antenna", "3"],
            &["--antenna takes metres forward and to starboard of midship", "`--antenna=-12.0,0.5`"],
            &["import", "log.csv", "--out", "own", "--antenna=3.0,0.0"],
        ),
        in_command(
            "a propeller at fifteen of something",
            |s| log(s, "Rudder [deg],propeller", |_| 15.0, iso),
            &["import", "log.csv", "--out", "own", "--column", "n=propeller"],
            &["the unit of column `propeller`", "`--unit n=rpm or rps`"],
            &["import", "log.csv", "--out", "own", "--column", "n=propeller", "--unit", "n=rps"],
        ),
        in_command(
            "times in ms that no header names",
            |s| log(s, "Rudder [deg],RPM", |n| 60.0 * n, |t| (1000.0 * t).to_string()),
            IMPORT,
            &["the track is sailed 0.00100 times as fast as column `SOG`", "`--unit t=ms`"],
            &["import", "log.csv", "--out", "own", "--unit", "t=ms"],
        ),
        in_file(
            "a workbook",
            |s| s.write("log.csv", "PK\u{3}\u{4}xl/workbook.xml"),
            IMPORT,
            &["log.csv: is a workbook (Excel)", "save the sheet as CSV"],
            usual,
        ),
    ]
}

#[test]
fn every_natural_mistake_is_reported_with_its_place_and_mended_from_the_message_alone() {
    let recorded = [layouts(), names(), units(), signs_and_axes(), rows_and_gaps(), logs()];
    let written = [tables_of_runs(), studies(), ships(), models(), arguments(), options()];
    let all: Vec<Mistake> = recorded.into_iter().chain(written).flatten().collect();
    assert!(all.len() >= 42, "{}", all.len());
    let mut wrong = Vec::new();
    for mistake in &all {
        let study = Study::new();
        (mistake.make)(&study);
        let said = study.run(mistake.asked);
        let printed = text(&said.stderr) + &text(&said.stdout);
        let missing: Vec<&&str> = mistake.says.iter().filter(|part| !printed.contains(**part)).collect();
        if !missing.is_empty() || printed.contains("panicked") || printed.contains("NaN") {
            wrong.push(format!("{}: {missing:?} is not in: {printed}", mistake.name));
            continue;
        }
        (mistake.mend)(&study);
        let mended = study.run(mistake.then);
        let after = text(&mended.stderr) + &text(&mended.stdout);
        if mended.status.code() != Some(0) || after.contains(mistake.says[0]) {
            wrong.push(format!("{}: not mended by what it says: {after}", mistake.name));
        }
    }
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), all.len(), wrong.join("\n"));
}
