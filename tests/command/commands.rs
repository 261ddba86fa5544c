//! The command line: output, files, exit codes and messages of each command.
//! The numbers themselves are tested where they are computed.

use crate::support::study::{Study, at, contains_all, text};
use serde_json::Value;
use std::process::Command;

const COMMANDS: [&[&str]; 11] = [
    &["import"],
    &["split"],
    &["check"],
    &["simulate"],
    &["fit"],
    &["evaluate"],
    &["maneuver", "turning"],
    &["maneuver", "zigzag"],
    &["maneuver", "stopping"],
    &["terms"],
    &["demo"],
];

#[test]
fn every_command_has_help_with_an_example() {
    let study = Study::new();
    let overview = study.does(&["--help"]);
    for command in COMMANDS {
        assert!(overview.contains(command[0]), "{command:?}");
        let help = study.does(&[command, &["--help"]].concat());
        contains_all(&help, &["Example", &format!("trimtab {}", command.join(" ")), "JSON", "--json"]);
        assert!(help.lines().all(|l| l.chars().count() <= 100), "{help}");
        assert!(!study.does(&[command, &["-h"]].concat()).is_empty());
    }
    assert!(study.does(&["--version"]).starts_with("trimtab "));
}

#[test]
fn every_command_writes_its_files() {
    let study = Study::new();
    let expected: [(&[&str], &[&str]); 8] = [
        (&["check", "study.toml"], &["check.json", "channels.csv", "issues.csv"]),
        (&["simulate", "study.toml"], &["simulate.json", "tracks.png", "trajectories/ship_a_001.csv"]),
        (&["fit", "study.toml"], &["fit.json", "fitted.toml", "fit.txt", "parameters.csv", "curves.png", "curves.csv"]),
        (
            &["evaluate", "study.toml"],
            &["evaluate.json", "trajectories.csv", "summary.csv", "improvement.png", "tracks.png"],
        ),
        (&["maneuver", "turning", "study.toml"], &["maneuver_turning.json", "turning.png", "turning_measures.csv"]),
        (&["maneuver", "zigzag", "study.toml"], &["maneuver_zigzag.json", "zigzag.png", "zigzag.csv"]),
        (&["maneuver", "stopping", "study.toml"], &["maneuver_stopping.json", "stopping.png"]),
        (&["terms"], &["terms.json", "parameters.csv"]),
    ];
    for (arguments, files) in expected {
        let out = study.does(&[arguments, &["--out", "results/deep"]].concat());
        assert!(!out.contains("NaN") && !out.contains("inf "), "{out}");
        for file in files {
            let path = study.path("results/deep").join(file);
            assert!(path.metadata().is_ok_and(|m| m.len() > 20), "{arguments:?} did not write {file}");
        }
    }
    // Every other command takes the fitted model.
    for command in [&["simulate"][..], &["evaluate"], &["fit"], &["maneuver", "turning"]] {
        study.does(&[command, &["study.toml", "--model", "results/deep/fitted.toml"]].concat());
    }
}

#[test]
fn a_simulated_trajectory_reads_as_a_recording() {
    let study = Study::new();
    study.does(&["simulate", "study.toml", "--out", "simulated"]);
    let files: Vec<String> = std::fs::read_dir(study.path("simulated/trajectories"))
        .unwrap()
        .map(|f| f.unwrap().file_name().into_string().unwrap())
        .collect();
    assert_eq!(files.len(), 8);
    for file in files {
        std::fs::copy(study.path("simulated/trajectories").join(&file), study.path("recordings").join(&file)).unwrap();
    }
    // The model fits its own simulation without any deviation.
    let value = study.json(&["evaluate", "study.toml", "--baseline", "baseline.toml"]);
    let test = at(&value, "result.summaries.0");
    assert!(at(test, "cvdm_fitted.value").as_f64().unwrap() < 1e-6);
    assert_eq!(at(test, "better"), 4);
}

#[test]
fn every_report_says_how_much_of_the_data_lies_outside_the_terms_ranges() {
    let study = Study::new();
    for command in [
        &["fit", "study.toml"][..],
        &["evaluate", "study.toml"],
        &["simulate", "study.toml"],
        &["maneuver", "turning", "study.toml", "--draws", "0"],
    ] {
        let text = study.does(command);
        assert!(text.lines().any(|l| l.starts_with("Validity: ")), "{command:?}: {text}");
        let value = study.json(command);
        let share = value["result"]["validity"]["share_outside"].as_f64().unwrap();
        assert!((0.0..=1.0).contains(&share), "{command:?}: {share}");
        assert!(value["result"]["validity"]["outside"].is_array());
    }
    // A crash stop turns the propeller astern, where a side force proportional to thrust is not valid.
    let value = study.json(&["maneuver", "stopping", "study.toml", "--draws", "0"]);
    let outside = value["result"]["validity"]["outside"].as_array().unwrap();
    assert!(outside.iter().any(|o| o["term"] == "propeller" && o["quantity"] == "rate"), "{outside:?}");
    contains_all(&study.does(&["terms", "hull"]), &["valid for: Froude number 0 to 0.25, drift angle 0 to 20 deg"]);
}

#[test]
fn json_output_is_one_object_with_the_documented_keys() {
    let study = Study::new();
    let value = study.json(&["fit", "study.toml", "--out", "results"]);
    assert_eq!(at(&value, "command"), "fit");
    for key in ["converged", "status", "estimates.0.name", "estimates.0.value", "cost", "active", "runs", "iterations"]
    {
        at(&value, &format!("result.{key}"));
    }
    assert_eq!(at(&value, "result.estimates").as_array().unwrap().len(), 11);
    assert!(at(&value, "files").as_array().unwrap().len() >= 5);

    let value = study.json(&["evaluate", "study.toml", "--model", "results/fitted.toml"]);
    assert_eq!(
        (at(&value, "result.baseline"), at(&value, "result.fitted")),
        (&"published baseline".into(), &"ship A, fitted".into())
    );
    for key in [
        "cvdm_baseline.value",
        "cvdm_improvement.ci95.1",
        "mari.value",
        "consistency.value",
        "md_fitted.psi.value",
        "worst.run",
    ] {
        at(&value, &format!("result.summaries.0.{key}"));
    }
    assert_eq!(at(&value, "result.trajectories").as_array().unwrap().len(), 8);
    at(&value, "result.trajectories.0.fitted.cvdm");

    let value = study.json(&["check", "study.toml"]);
    assert_eq!(at(&value, "result.recordings").as_array().unwrap().len(), 8);
    let value = study.json(&["simulate", "study.toml"]);
    at(&value, "result.runs.0.md.psi");
    let value = study.json(&["maneuver", "turning", "study.toml"]);
    for key in
        ["approach.n", "trials.0.measures.advance", "trials.1.measures.steady.drift", "trials.0.criteria.0.verdict"]
    {
        at(&value, &format!("result.{key}"));
    }
    let value = study.json(&["maneuver", "zigzag", "study.toml"]);
    assert_eq!(at(&value, "result.trials").as_array().unwrap().len(), 4);
    at(&value, "result.trials.0.measures.overshoots.1");
    let value = study.json(&["maneuver", "stopping", "study.toml"]);
    at(&value, "result.trials.0.measures.track_reach");
    let value = study.json(&["terms", "rudder", "--ship", "ship.toml"]);
    assert_eq!(at(&value, "result.terms.0.parameters.1.name"), "rudder.lift1");
}

#[test]
fn one_thread_and_two_give_the_same_bits() {
    let study = Study::new();
    let runs = ["1", "2"].map(|threads| {
        let out = format!("threads_{threads}");
        study.does(&["fit", "study.toml", "--out", &out, "--threads", threads]);
        let model = format!("{out}/fitted.toml");
        let evaluation = study.does(&["evaluate", "study.toml", "--model", &model, "--json", "--threads", threads]);
        let fitted = std::fs::read_to_string(study.path(&model)).unwrap();
        let curves = std::fs::read_to_string(study.path(&out).join("parameters.csv")).unwrap();
        (evaluation, fitted, curves)
    });
    assert_eq!(runs[0], runs[1]);
}

#[test]
fn a_fit_that_does_not_converge_has_exit_code_1() {
    let study = Study::new();
    study.edit("study.toml", "[fit]", "[fit]\nmax_iterations = 1");
    let output = study.run(&["fit", "study.toml", "--out", "results", "--json"]);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    let value: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(at(&value, "result.converged"), false);
    assert!(study.path("results/fitted.toml").is_file());
}

#[test]
fn a_recording_with_a_fault_fails_the_check_with_exit_code_1() {
    let study = Study::new();
    study.append("recordings/ship_a_002.csv", "80,1,1,1,1,1,1,1,1\n");
    let output = study.run(&["check", "study.toml"]);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    let message = study.refuses(&["fit", "study.toml"]);
    contains_all(&message, &["ship_a_002.csv:43", "time 80 s"]);
}

#[test]
fn a_missing_study_is_named() {
    let study = Study::new();
    for command in ["check", "simulate", "fit", "evaluate"] {
        let message = study.refuses(&[command, "nowhere.toml"]);
        contains_all(&message, &["nowhere.toml", "cannot read the study", "check the path"]);
    }
    study.refuses(&["maneuver", "turning", "nowhere.toml"]);
}

#[test]
fn unknown_keys_are_named_with_line_and_a_near_name() {
    let study = Study::new();
    study.edit("study.toml", "[fit]", "[fit]\ntolerence = 1e-6");
    let message = study.refuses(&["fit", "study.toml"]);
    contains_all(&message, &["study.toml:13", "[fit]", "`tolerence`", "did you mean `tolerance`?"]);
    let study = Study::new();
    study.edit("study.toml", "ship = ", "shipp = ");
    contains_all(&study.refuses(&["check", "study.toml"]), &["study.toml:3", "`shipp`", "did you mean `ship`?"]);
    let study = Study::new();
    study.edit("study.toml", "speed = 6.0", "speed = \"fast\"");
    contains_all(&study.refuses(&["maneuver", "turning", "study.toml"]), &["study.toml:", "[maneuver]"]);
}

#[test]
fn recordings_that_contradict_themselves_stop_a_command_unless_that_is_accepted() {
    let study = Study::new();
    for entry in std::fs::read_dir(study.path("recordings")).unwrap() {
        let path = entry.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap();
        let turned = text.lines().map(|line| {
            let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
            if let Ok(r) = cells[6].parse::<f64>() {
                cells[6] = (-r).to_string();
            }
            cells.join(",") + "\n"
        });
        std::fs::write(&path, turned.collect::<String>()).unwrap();
    }
    for command in ["fit", "simulate", "evaluate"] {
        let message = study.refuses(&[command, "study.toml"]);
        contains_all(&message, &["study.toml: r: ", "the sign is turned", "8 runs", "`--accept sign_error`"]);
        let out = study.does(&[command, "study.toml", "--accept", "sign_error"]);
        let first = out.lines().next().unwrap();
        assert!(first.starts_with("accepted error: r: heading turns") && first.contains("8 of 8 runs"), "{first}");
        let value = study.json(&[command, "study.toml", "--accept", "sign_error"]);
        assert_eq!(at(&value, "recordings.doubts.0.fault"), "sign_error");
        assert_eq!(at(&value, "recordings.doubts.0.runs").as_array().unwrap().len(), 8);
    }
    let message = study.refuses(&["fit", "study.toml", "--accept", "sign"]);
    contains_all(&message, &["no fault `sign`", "did you mean `sign_error`?"]);
}

#[test]
fn settings_outside_their_range_are_named_with_line_and_range() {
    let cases: [(&str, &str, &str, &[&str]); 9] = [
        ("[fit]", "difference_step = nan", "fit", &["`difference_step` = NaN", "between"]),
        ("[fit]", "max_iterations = 0", "fit", &["`max_iterations` = 0", "between 1 and"]),
        ("[fit.constraints]", "drag = { lower = nan }", "fit", &["`drag` = NaN", "finite"]),
        ("[fit.constraints]", "drag = { from = -30, to = 30, step = 1e-9 }", "fit", &["`drag`", "10000 samples"]),
        ("[fit.integration]", "substeps = 1000000000", "fit", &["`substeps` = 1000000000", "between 1 and 1000"]),
        ("[evaluate]", "resamples = 1000000000000", "evaluate", &["`resamples`", "between 0 and 100000"]),
        ("[diagnose]", "alpha = nan", "diagnose", &["`alpha` = NaN", "nothing is missing"]),
        ("[diagnose]", "most = 0", "check", &["`most` = 0", "between 1 and 20"]),
        ("[diagnose]", "substeps = 0", "diagnose", &["`substeps` = 0", "sample period"]),
    ];
    for (table, line, command, expected) in cases {
        let study = Study::new();
        let text = std::fs::read_to_string(study.path("study.toml")).unwrap();
        // A table that the study has gets the key; a table that it has not is added.
        if text.contains(&format!("{table}\n")) {
            study.edit("study.toml", &format!("{table}\n"), &format!("{table}\n{line}\n"));
        } else {
            study.append("study.toml", &format!("\n{table}\n{line}\n"));
        }
        let message = study.refuses(&[command, "study.toml"]);
        contains_all(&message, &["study.toml:"]);
        contains_all(&message, expected);
    }
    let study = Study::new();
    study.edit("study.toml", "[maneuver]\n", "[maneuver]\nstep = 1e-300\n");
    contains_all(
        &study.refuses(&["maneuver", "turning", "study.toml"]),
        &["`step` = ", "while the ship sails its length"],
    );
    let output = study.run(&["--threads", "65535", "check", "study.toml"]);
    assert_eq!(output.status.code(), Some(2));
    contains_all(&text(&output.stderr), &["65535", "1..=1024"]);
    study.edit("study.toml", "name = ", "step = 1e-9\nname = ");
    contains_all(&study.refuses(&["fit", "study.toml"]), &["`step` = 1.00e-9 s is less than"]);
}

#[test]
fn faults_of_the_ship_file_are_named() {
    let study = Study::new();
    std::fs::remove_file(study.path("ship.toml")).unwrap();
    contains_all(&study.refuses(&["fit", "study.toml"]), &["ship.toml", "cannot read the ship file", "check the path"]);
    for (mass, expected) in [("-3.359e6", "must be a positive number"), ("3359", "is the mass in kg?")] {
        let study = Study::new();
        study.edit("ship.toml", "mass = 3.359e6", &format!("mass = {mass}"));
        contains_all(&study.refuses(&["fit", "study.toml"]), &["ship.toml:9", "hull.mass", expected]);
    }
    let study = Study::new();
    study.edit("ship.toml", "mass = 3.359e6\n", "");
    contains_all(
        &study.refuses(&["fit", "study.toml"]),
        &["ship.toml: a value is missing", "hull.mass [kg]", "trimtab new --from"],
    );
}

#[test]
fn faults_of_the_model_file_are_named() {
    let study = Study::new();
    study.edit("model.toml", "\"rudder.lift1\"", "\"rudder.lft1\"");
    let message = study.refuses(&["fit", "study.toml"]);
    contains_all(
        &message,
        &["model.toml:13", "unknown parameter `rudder.lft1`", "did you mean `rudder.lift1`?", "trimtab terms"],
    );
    let study = Study::new();
    study.append("model.toml", "\"hull.Yvdot\" = { value = 3.359e6 }\n");
    contains_all(&study.refuses(&["fit", "study.toml"]), &["model.toml", "must be at most 0 kg", "hull.Yvdot"]);
    let study = Study::new();
    study.edit("model.toml", "form = \"paper\"", "form = \"paper\"\nterms = [\"curent\"]");
    contains_all(&study.refuses(&["fit", "study.toml"]), &["model.toml:", "unknown term `curent`", "`current`?"]);
    contains_all(
        &study.refuses(&["fit", "study.toml", "--model", "none.toml"]),
        &["none.toml", "cannot read the model file"],
    );
}

#[test]
fn constraints_that_contradict_each_other_are_named() {
    let study = Study::new();
    study.append("study.toml", "\n[fit.constraints.drag]\nupper = 0.01\n\n[fit.constraints.drag_zero]\nlower = 0.04\n");
    contains_all(&study.refuses(&["fit", "study.toml"]), &["study.toml", "contradict each other", "drag", "relax"]);
}

#[test]
fn a_simulation_that_diverges_is_named() {
    let study = Study::new();
    study.edit("model.toml", "value = 34187.03", "value = -1e9");
    contains_all(&study.refuses(&["fit", "study.toml"]), &["study.toml", "diverges", "start from parameters"]);
    let output = study.run(&["simulate", "study.toml"]);
    assert_eq!(output.status.code(), Some(2));
    contains_all(&text(&output.stderr), &["run `ship_a_001`", "diverged", "substeps"]);
    contains_all(&text(&output.stdout), &["diverged after"]);
    // For an evaluation it is a result: the model is worse, and no number is spoiled.
    let value = study.json(&["evaluate", "study.toml"]);
    assert_eq!(at(&value, "result.summaries.0.diverged_fitted"), 4);
    assert_eq!(at(&value, "result.summaries.0.worse"), 4);
    contains_all(&study.does(&["evaluate", "study.toml"]), &["diverged on 4 of 4"]);
}

#[test]
fn a_study_without_test_runs_cannot_be_evaluated() {
    let study = Study::new();
    study.edit("runs.csv", ",test", ",train");
    contains_all(
        &study.refuses(&["evaluate", "study.toml"]),
        &["study.toml", "no run to judge by", "split = \"test\""],
    );
}

#[test]
fn a_trial_without_an_approach_gives_the_reason() {
    let study = Study::new();
    let message = study.refuses(&["maneuver", "turning", "study.toml", "--speed", "-3"]);
    contains_all(&message, &["speed", "positive"]);
    study.edit("study.toml", "[maneuver]", "[maneuver]\nastern_rpm = 90.0");
    contains_all(&study.refuses(&["maneuver", "stopping", "study.toml"]), &["astern_rpm", "must be negative"]);
}

#[test]
fn an_unknown_term_is_refused_with_a_near_name() {
    let study = Study::new();
    contains_all(&study.refuses(&["terms", "ruder"]), &["unknown term `ruder`", "`rudder`?"]);
}

#[test]
fn a_folder_that_cannot_be_made_is_named() {
    let study = Study::new();
    contains_all(&study.refuses(&["terms", "--out", "study.toml"]), &["study.toml", "cannot write", "--out"]);
}

#[test]
fn wrong_usage_has_exit_code_2() {
    let study = Study::new();
    for arguments in [&[][..], &["fti", "study.toml"], &["fit"], &["fit", "study.toml", "--threads", "0"]] {
        let output = study.run(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(!output.stderr.is_empty());
    }
}

#[test]
fn the_demo_finds_and_confirms_what_is_concealed_in_its_study() {
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| {
        Command::new(env!("CARGO_BIN_EXE_trimtab")).args(arguments).current_dir(folder.path()).output().unwrap()
    };
    let output = run(&["demo", "--json", "--format", "svg,pdf"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let value: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((at(&value, "result.check.runs"), at(&value, "result.check.errors")), (&40.into(), &0.into()));
    let test = at(&value, "result.evaluation.summaries.0");
    assert_eq!(at(test, "runs"), 10);
    assert!(at(test, "cvdm_improvement.ci95.0").as_f64().unwrap() > 0.3, "{test:#}");
    let concealed = at(&value, "result.concealed");
    assert_eq!((at(concealed, "found"), at(concealed, "confirmed")), (&true.into(), &true.into()));
    for size in at(concealed, "sizes").as_array().unwrap() {
        let number = |path: &str| at(size, path).as_f64().unwrap();
        assert!((number("ci95.0")..=number("ci95.1")).contains(&number("concealed")), "{size:#}");
    }
    assert_eq!(at(&value, "result.diagnosis.findings").as_array().unwrap().len(), 1);
    let proof = at(&value, "result.diagnosis.held_out");
    assert!(at(proof, "after").as_f64().unwrap() < 0.5 * at(proof, "before").as_f64().unwrap(), "{proof:#}");
    let demo = folder.path().join("trimtab-demo");
    for file in [
        "study.toml",
        "results/tracks.svg",
        "results/figures/tracks.pdf",
        "results/report.html",
        "results/improved.toml",
    ] {
        assert!(demo.join(file).is_file(), "{file}");
    }
    // The study alone, checked as its own: it has no column map, so that each unit was read from a header.
    let output = run(&["check", "trimtab-demo/study.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stdout));
    assert_eq!(demo.join("recordings").read_dir().unwrap().count(), 40);
    // It is made again, and not where a file of it was edited.
    let again = run(&["demo"]);
    assert_eq!(again.status.code(), Some(0), "{}", text(&again.stderr));
    let study = demo.join("study.toml");
    let edited = std::fs::read_to_string(&study).unwrap() + "# mine\n";
    std::fs::write(&study, &edited).unwrap();
    let refused = run(&["demo"]);
    assert_eq!(refused.status.code(), Some(2));
    contains_all(&text(&refused.stderr), &["trimtab-demo/study.toml", "was changed after trimtab wrote it"]);
    assert_eq!(std::fs::read_to_string(&study).unwrap(), edited);
}

#[test]
fn the_option_frees_the_hull_as_the_model_file_does() {
    let study = Study::new();
    let estimates = |arguments: &[&str]| {
        let output = study.run(&[&["fit", "study.toml", "--json"], arguments].concat());
        assert!(output.status.code() < Some(2), "{}", text(&output.stderr));
        let value: Value = serde_json::from_slice(&output.stdout).unwrap();
        at(&value, "result.estimates").clone()
    };
    let (fixed, option) = (estimates(&[]), estimates(&["--free-hull"]));
    study.edit("model.toml", "form = \"paper\"", "form = \"paper\"\nhull = \"free\"");
    assert_eq!(option, estimates(&[]));
    assert!(option.as_array().unwrap().len() > fixed.as_array().unwrap().len() + 10);
}

#[test]
fn an_option_frees_a_parameter_or_a_term_as_the_model_file_does_and_reports_a_misspelt_one() {
    let study = Study::new();
    let names = |arguments: &[&str]| {
        let output = study.run(&[&["fit", "study.toml", "--json"], arguments].concat());
        assert!(output.status.code() < Some(2), "{}", text(&output.stderr));
        let value: Value = serde_json::from_slice(&output.stdout).unwrap();
        let estimates = at(&value, "result.estimates").as_array().unwrap().clone();
        estimates.iter().map(|e| e["name"].as_str().unwrap().to_owned()).collect::<Vec<_>>()
    };
    let freed = names(&["--free", "wake_drift,flow.asymmetry"]);
    for name in ["wake_drift.relief", "wake_drift.asymmetry", "flow.asymmetry"] {
        assert!(freed.iter().any(|f| f == name), "{freed:?}");
    }
    contains_all(
        &study.refuses(&["fit", "study.toml", "--free", "flow.asymetry"]),
        &["did you mean `flow.asymmetry`?"],
    );
    contains_all(&study.refuses(&["fit", "study.toml", "--free", "wake_drit"]), &["did you mean `wake_drift`?"]);
}

#[test]
fn mistakes_in_several_files_are_reported_in_one_go() {
    let study = Study::new();
    study.edit("study.toml", "[evaluate]", "[evaluate]\nwindow = 60.0");
    study.edit("study.toml", "speed = 6.0", "sped = 6.0");
    study.edit("ship.toml", "wake = 0.28", "wake = 28.0");
    study.edit("model.toml", "form = \"paper\"", "from = \"paper\"");
    for command in [&["fit", "study.toml"][..], &["check", "study.toml"], &["maneuver", "turning", "study.toml"]] {
        let message = study.refuses(command);
        contains_all(
            &message,
            &[
                "`window` is a key of the whole study",
                "did you mean `speed`?",
                "propeller.wake = 28",
                "did you mean `form`?",
            ],
        );
    }
}

#[test]
fn a_file_in_the_place_of_another_is_named_for_what_it_is() {
    let study = Study::new();
    for (arguments, words) in [
        (&["check", "ship.toml"][..], "ship.toml:1: this is a ship file, not a study"),
        (&["fit", "model.toml"], "this is a model file, not a study"),
        (&["fit", "runs.csv"], "this is a table of values (CSV), not a study"),
        (&["simulate", "study.toml", "--model", "ship.toml"], "this is a ship file, not a model file"),
        (&["simulate", "study.toml", "--model", "study.toml"], "this is a study, not a model file"),
        (&["new", "--from", "model.toml", "--type", "coaster"], "this is a model file, not a ship file"),
        (&["check", "."], "it is a folder; name a file in it, such as `./study.toml`"),
        (&["check", "stduy.toml"], "did you mean `study.toml`?"),
        (&["fit", "study.toml", "--out", "ship.toml"], "this is a file, not a folder"),
    ] {
        contains_all(&study.refuses(arguments), &[words]);
    }
}

#[test]
fn a_fitted_model_is_refused_with_another_ship() {
    let study = Study::new();
    study.does(&["fit", "study.toml", "--out", "results"]);
    study.edit("ship.toml", "lpp = 85.0", "lpp = 100.0");
    study.edit("ship.toml", "mass = 3.359e6", "mass = 3.952e6");
    for command in [&["simulate", "study.toml", "--model"][..], &["export", "--study", "study.toml"]] {
        let message = study.refuses(&[command, &["results/fitted.toml"]].concat());
        contains_all(&message, &["results/fitted.toml", "L = 85 m", "L = 100 m", "fit the model to this ship"]);
    }
}

#[test]
fn what_a_model_says_of_nothing_in_the_study_is_reported() {
    let study = Study::new();
    study.edit("model.toml", "form = \"paper\"", "form = \"paper\"\nterms = [\"wind\"]");
    study.append("model.toml", "[sessions.\"day 9\"]\n\"rudder.lift1\" = 0.1\n");
    let output = study.run(&["simulate", "study.toml"]);
    assert_eq!(output.status.code(), Some(0));
    contains_all(
        &text(&output.stderr),
        &["the term `wind` has no effect in", "`wind_speed`", "session `day 9` is used in no run"],
    );
}

#[test]
fn arguments_that_cannot_be_are_reported_in_words() {
    let study = Study::new();
    for (arguments, words) in [
        (&["compare", "study.toml", "model.toml", "model.toml"][..], "model.toml is given twice"),
        (&["terms", "p5"], "`trimtab terms rudder` shows it"),
        (&["terms", "ruder_late"], "did you mean"),
        (&["maneuver", "turning", "study.toml", "--speed", "60"], "is it in knots?"),
        (&["new", "--lpp", "-5", "--breadth", "2", "--draught", "1", "--type", "tug"], "a positive number in m"),
    ] {
        contains_all(&study.refuses(arguments), &[words]);
    }
    for (arguments, words) in [
        (&["maneuver", "turning", "study.toml", "--draws", "-3"][..], "a whole number of 0 or more"),
        (&["new", "--lpp", "50m", "--breadth", "9", "--draught", "3", "--type", "tug"], "without a unit"),
        (&["fit", "study.toml", "--ouput", "o"], "unexpected argument '--ouput'"),
    ] {
        let output = study.run(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let message = text(&output.stderr);
        assert!(message.contains(words) && !message.contains("to pass"), "{message}");
    }
    assert!(study.does(&["help", "runs"]).starts_with("The study file"));
    study.does(&["manoeuvre", "turning", "study.toml"]);
    study.edit("study.toml", "speed = 6.0", "speed = 6.0\nturning_deg = 0.61");
    contains_all(&study.refuses(&["maneuver", "turning", "study.toml"]), &["degrees, not in radians"]);
}
