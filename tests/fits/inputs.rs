//! What a fit says of a rudder or a propeller rate that one recording or one day records in another way than the others.

use crate::support::study::{Study, at};

/// The demo in two days, with a column of the recordings that `of` chooses multiplied.
fn demo(column: usize, factor: f64, of: impl Fn(usize, &str) -> bool) -> Study {
    let study = Study::new();
    study.does(&["demo", "--out", "demo"]);
    let runs = std::fs::read_to_string(study.path("demo/runs.csv")).unwrap();
    let mut listed = String::from("file,name,session,manoeuvre,split\n");
    for (i, line) in runs.lines().skip(1).enumerate() {
        let cells: Vec<&str> = line.split(',').collect();
        let (file, name, [manoeuvre, split]) = (cells[0], cells[1], [cells[cells.len() - 2], cells[cells.len() - 1]]);
        listed += &format!("{file},{name},day {},{manoeuvre},{split}\n", 1 + i / 20);
        if of(i, name) {
            let path = format!("demo/{file}");
            let text = std::fs::read_to_string(study.path(&path)).unwrap();
            let scaled = |(k, line): (usize, &str)| {
                let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
                if k > 0 {
                    cells[column] = format!("{}", factor * cells[column].parse::<f64>().unwrap());
                }
                cells.join(",") + "\n"
            };
            study.write(&path, &text.lines().enumerate().map(scaled).collect::<String>());
        }
    }
    study.write("demo/runs.csv", &listed);
    study
}

fn input_error(study: &Study) -> serde_json::Value {
    let fit = study.json(&["fit", "demo/study.toml", "--out", "fit"]);
    let error = at(&fit, "result")["input_error"].clone();
    let doubts: Vec<&str> =
        at(&fit, "result.doubts").as_array().unwrap().iter().filter_map(|d| d["kind"].as_str()).collect();
    assert_eq!(doubts.contains(&"input"), !error.is_null(), "{doubts:?}");
    error
}

#[test]
fn recordings_whose_inputs_are_alike_have_no_input_error() {
    assert!(input_error(&demo(8, 1.0, |_, _| false)).is_null());
}

#[test]
fn a_rudder_that_reads_a_fifth_too_little_in_one_recording_is_named_with_its_gain() {
    let error = input_error(&demo(8, 0.8, |_, name| name == "trial_10"));
    let size = error["value"].as_f64().unwrap();
    assert_eq!([&error["input"], &error["kind"], &error["name"]], ["rudder angle", "gain", "trial_10"], "{error}");
    assert!(!error["is_session"].as_bool().unwrap() && (size - 0.25).abs() < 0.08, "{error}");
}

#[test]
fn a_propeller_rate_that_reads_too_much_on_one_day_is_named_with_that_day() {
    let error = input_error(&demo(7, 1.3, |i, _| i >= 20));
    let size = error["value"].as_f64().unwrap();
    // Two days differ: which of them reads as the ship file has it cannot be seen.
    assert_eq!([&error["input"], &error["kind"]], ["propeller rate", "gain"], "{error}");
    assert!(error["is_session"].as_bool().unwrap() && (0.05..0.35).contains(&size.abs()), "{error}");
}
