//! Results are read by other programs: every table is one tidy CSV with units, and `examples/read_results.py` makes DataFrames of them.
//! The numbers are tested where they are computed. Without python3 and pandas the last test is skipped with a message.

use crate::support::study::{Study, contains_all, text};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Columns of numbers that have no unit.
const COUNTS: [&str; 4] = ["steps", "missing", "iterations", "start"];

/// A study with the results of fit and evaluate in one folder, and those of other commands in theirs.
fn results() -> Study {
    let study = Study::new();
    study.does(&["fit", "study.toml", "--out", "results", "--tables", "latex,markdown"]);
    study.does(&["evaluate", "study.toml", "--model", "results/fitted.toml", "--out", "results"]);
    study.does(&["maneuver", "turning", "study.toml", "--out", "turning", "--tables", "latex"]);
    study.does(&["simulate", "study.toml", "--out", "simulated"]);
    study.run(&["check", "study.toml", "--out", "checked"]);
    study
}

/// Whether a table is tidy: every row as long as the header, no name twice, and a unit for every column of numbers.
fn assert_tidy(path: &Path) {
    let mut reader = csv::ReaderBuilder::new().flexible(true).from_path(path).unwrap();
    let header: Vec<String> = reader.headers().unwrap().iter().map(str::to_owned).collect();
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    let name = path.display();
    let mut names = header.clone();
    names.sort();
    names.dedup();
    assert!(names.len() == header.len() && !header.iter().any(String::is_empty), "{name}: {header:?}");
    assert!(rows.iter().all(|row| row.len() == header.len()), "{name}: a row is not as long as the header");
    for (i, column) in header.iter().enumerate() {
        let cells: Vec<&str> = rows.iter().map(|row| &row[i]).filter(|cell| !cell.is_empty()).collect();
        let numbers = cells.iter().filter(|cell| cell.parse::<f64>().is_ok()).count();
        assert!(numbers == 0 || numbers == cells.len(), "{name}: `{column}` mixes numbers and words: {cells:?}");
        let has_unit = column.contains('[') || header.iter().any(|h| h == "unit") || COUNTS.contains(&column.as_str());
        assert!(numbers == 0 || has_unit, "{name}: `{column}` has no unit");
    }
}

#[test]
fn every_table_is_tidy_and_has_units() {
    let study = results();
    let tables: [PathBuf; 7] = [
        "results/parameters.csv",
        "results/summary.csv",
        "results/trajectories.csv",
        "turning/turning_measures.csv",
        "simulated/simulations.csv",
        "checked/channels.csv",
        "checked/issues.csv",
    ]
    .map(|name| study.path(name));
    tables.iter().for_each(|path| assert_tidy(path));
    let latex = std::fs::read_to_string(study.path("results/parameters.tex")).unwrap();
    contains_all(&latex, &["\\begin{tabular}", "\\toprule", "resistance.linear", "\\bottomrule"]);
    let markdown = std::fs::read_to_string(study.path("results/parameters.md")).unwrap();
    assert_eq!(markdown.lines().count(), 2 + 11);
    assert!(study.path("turning/turning_measures.tex").exists() && !study.path("turning/turning_measures.md").exists());
    let manifest = std::fs::read_to_string(study.path("results/manifest.json")).unwrap();
    contains_all(&manifest, &["parameters.tex", "parameters.md"]);
}

#[test]
fn the_terminal_is_as_wide_as_columns_says_and_files_do_not_depend_on_it() {
    let study = Study::new();
    let shown = |columns: &str, arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_trimtab"));
        let output = command.args(arguments).env("COLUMNS", columns).current_dir(study.folder.path()).output().unwrap();
        text(&output.stdout)
    };
    for arguments in [
        &["simulate", "study.toml"][..],
        &["fit", "study.toml"],
        &["evaluate", "study.toml"],
        &["maneuver", "zigzag", "study.toml"],
        &["check", "study.toml"],
        &["terms"],
        &["terms", "rudder", "hull"],
    ] {
        for columns in ["60", "80", "120"] {
            let said = shown(columns, arguments);
            let width: usize = columns.parse().unwrap();
            let long: Vec<&str> = said.lines().filter(|l| l.chars().count() > width).collect();
            assert!(!said.is_empty() && long.is_empty(), "{arguments:?} at {columns}:\n{}", long.join("\n"));
        }
    }
    shown("60", &["fit", "study.toml", "--out", "narrow"]);
    shown("140", &["fit", "study.toml", "--out", "wide"]);
    let file = |folder: &str| std::fs::read_to_string(study.path(&format!("{folder}/fit.txt"))).unwrap();
    assert_eq!(file("narrow"), file("wide"));
}

#[test]
fn colours_are_for_terminals_and_no_color_turns_them_off() {
    let study = Study::new();
    let said = |variables: &[(&str, &str)]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_trimtab"));
        command.args(["maneuver", "turning", "study.toml", "--draws", "0"]).envs(variables.iter().copied());
        text(&command.current_dir(study.folder.path()).output().unwrap().stdout)
    };
    assert!(!said(&[]).contains('\u{1b}'));
    assert!(said(&[("CLICOLOR_FORCE", "1")]).contains("\u{1b}[32m met\u{1b}[0m"));
    assert!(!said(&[("CLICOLOR_FORCE", "1"), ("NO_COLOR", "1")]).contains('\u{1b}'));
}

#[test]
fn python_reads_the_results_as_data_frames() {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/read_results.py");
    let has_pandas = Command::new("python3").args(["-c", "import pandas"]).output();
    if !has_pandas.is_ok_and(|o| o.status.success()) {
        crate::support::skipped("python3 with pandas is not installed");
        return;
    }
    let study = results();
    let json = r#"{"findings": [{"mechanism": "current", "grade": "confirmed"}], "withdrawn": [], "ranking": [{"mechanism": "current"}]}"#;
    study.write("results/diagnosis.json", json);
    let output = Command::new("python3").arg(&script).arg(study.path("results")).output().unwrap();
    let said = text(&output.stdout);
    assert!(output.status.success(), "{}", text(&output.stderr));
    contains_all(&said, &["parameters: 11 rows", "summary: ", "trajectories: ", "'cvdm [%]'", "findings: 1 rows"]);
}
