//! Nothing lost on the command line: folders that say how they came about, runs at the same time, kills, full disks, odd names.
//! Folders, names and checksums themselves are tested in `src/files`.

use crate::support::study::{Study, at, contains_all, text};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;
use trimtab::files::{MANIFEST, Manifest, TIMING, sha256_of};

const TRIMTAB: &str = env!("CARGO_BIN_EXE_trimtab");

/// Every file of a folder and those below it, by name.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let (mut found, mut open) = (BTreeMap::new(), vec![folder.to_owned()]);
    while let Some(next) = open.pop() {
        for entry in std::fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else {
                let name = path.strip_prefix(folder).unwrap().to_string_lossy().into_owned();
                found.insert(name, std::fs::read(path).unwrap());
            }
        }
    }
    found
}

/// The manifest of a folder, of which every listed file is there with its digest, and no other file.
fn whole(folder: &Path) -> Manifest {
    let manifest = Manifest::read(folder).unwrap();
    let mut listed: Vec<&String> = Vec::new();
    for entry in manifest.results.values() {
        for (name, digest) in &entry.files {
            assert_eq!(sha256_of(&folder.join(name)).unwrap(), *digest, "{name}");
            listed.push(name);
        }
    }
    listed.sort();
    let found: Vec<String> = files(folder).into_keys().filter(|n| n != MANIFEST && n != TIMING).collect();
    assert_eq!(found.iter().collect::<Vec<_>>(), listed);
    manifest
}

#[test]
fn a_folder_says_which_command_version_inputs_and_settings_made_it() {
    let study = Study::new();
    study.does(&["fit", "study.toml", "--out", "results", "--threads", "1"]);
    let manifest = whole(&study.path("results"));
    let entry = &manifest.results["fit"];
    assert_eq!(entry.version, env!("CARGO_PKG_VERSION"));
    assert_eq!(entry.arguments, ["fit", "study.toml"]);
    assert!(entry.settings["fit"]["max_iterations"].is_u64(), "{:?}", entry.settings);
    let inputs: BTreeMap<&str, &Option<String>> = entry.inputs.iter().map(|i| (i.path.as_str(), &i.sha256)).collect();
    for name in ["study.toml", "runs.csv", "ship.toml", "model.toml", "recordings/ship_a_001.csv"] {
        let digest = sha256_of(&study.path(name)).unwrap();
        assert_eq!(inputs.get(name), Some(&&Some(digest)), "{name}: {inputs:?}");
    }
    assert_eq!(inputs.len(), 4 + 8, "{inputs:?}");
    let times: Value = serde_json::from_slice(&std::fs::read(study.path("results").join(TIMING)).unwrap()).unwrap();
    assert!(at(&times, "fit.seconds").as_f64().unwrap() > 0.0 && at(&times, "fit.completed").is_string());
    // A trial reads no recording.
    study.does(&["maneuver", "turning", "study.toml", "--model", "results/fitted.toml", "--out", "trial"]);
    let inputs = &whole(&study.path("trial")).results["maneuver turning"].inputs;
    let names: Vec<&str> = inputs.iter().map(|i| i.path.as_str()).collect();
    assert_eq!(names, ["results/fitted.toml", "runs.csv", "ship.toml", "study.toml"]);
}

#[test]
fn equal_runs_write_equal_bytes_and_times_are_in_a_file_of_their_own() {
    let study = Study::new();
    let commands: [&[&str]; 5] = [
        &["check", "study.toml"],
        &["fit", "study.toml", "--starts", "2"],
        &["simulate", "study.toml"],
        &["evaluate", "study.toml"],
        &["maneuver", "zigzag", "study.toml"],
    ];
    for command in commands {
        let folders = ["one", "two"].map(|out| {
            study.does(&[command, &["--out", out]].concat());
            let mut files = files(&study.path(out));
            assert!(files.remove(TIMING).is_some());
            files
        });
        for (name, bytes) in &folders[0] {
            assert!(folders[1].get(name) == Some(bytes), "{command:?}: {name} differs");
            let text = String::from_utf8_lossy(bytes);
            assert!(!text.contains("\"seconds\"") && !text.contains("elapsed"), "{command:?}: {name} has a time taken");
        }
        assert_eq!(folders[0].len(), folders[1].len());
    }
}

#[test]
fn a_repeated_command_replaces_its_files_and_leaves_none_of_those_before() {
    let study = Study::new();
    study.does(&["simulate", "study.toml", "--out", "results"]);
    let before = files(&study.path("results"));
    std::fs::write(study.path("runs.csv"), {
        let runs = std::fs::read_to_string(study.path("runs.csv")).unwrap();
        runs.lines().filter(|l| !l.contains("ship_a_001")).map(|l| format!("{l}\n")).collect::<String>()
    })
    .unwrap();
    study.does(&["simulate", "study.toml", "--out", "results"]);
    assert!(before.contains_key("trajectories/ship_a_001.csv"));
    assert!(!study.path("results/trajectories/ship_a_001.csv").exists());
    assert_eq!(files(&study.path("results")).len(), before.len() - 1);
    whole(&study.path("results"));
    // What was edited is neither overwritten nor removed.
    study.append("results/simulations.csv", "a remark\n");
    let message = study.refuses(&["simulate", "study.toml", "--out", "results"]);
    contains_all(
        &message,
        &["results/simulations.csv", "was changed after trimtab wrote it", "rename or remove it", "--out"],
    );
    assert!(text(&files(&study.path("results"))["simulations.csv"]).ends_with("a remark\n"));
    // Nor is what trimtab did not write.
    study.write("own/fit.json", "{}");
    let message = study.refuses(&["fit", "study.toml", "--out", "own"]);
    contains_all(&message, &["own/fit.json", "no manifest.json beside it", "move it away"]);
    assert_eq!(files(&study.path("own")).len(), 1);
}

#[test]
fn several_commands_share_a_folder_and_each_keeps_its_entry() {
    let study = Study::new();
    for command in ["simulate", "evaluate", "fit"] {
        study.does(&[command, "study.toml", "--out", "results"]);
    }
    let manifest = whole(&study.path("results"));
    assert_eq!(manifest.results.keys().collect::<Vec<_>>(), ["evaluate", "fit", "simulate"]);
    assert_eq!(manifest.results["simulate"].replaced["tracks.png"], "evaluate");
    assert!(manifest.results["evaluate"].files.contains_key("tracks.png"));
}

#[test]
fn the_second_of_two_runs_into_a_folder_is_refused() {
    let study = Study::new();
    let folder = study.path("results");
    let first = trimtab::files::ResultFolder::open(&folder, "fit", &[]).unwrap();
    let message = study.refuses(&["terms", "--out", "results"]);
    let process = format!("(number {})", std::process::id());
    contains_all(&message, &["results: another process", &process, "choose another folder (--out)"]);
    drop(first);
    study.does(&["terms", "--out", "results"]);
}

#[test]
fn a_run_that_is_killed_at_any_instant_leaves_a_folder_that_is_whole_after_the_next() {
    let study = Study::new();
    let folder = study.path("results");
    study.does(&["simulate", "study.toml", "--out", "results"]);
    let expected = files(&folder);
    let mut killed = 0;
    for round in 0..60_u64 {
        let mut child = Command::new(TRIMTAB)
            .args(["simulate", "study.toml", "--out", "results", "--threads", "1"])
            .current_dir(study.folder.path())
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_millis(1 + 2 * round));
        killed += u32::from(child.try_wait().unwrap().is_none());
        let _ = child.kill();
        child.wait().unwrap();
        // Whoever finds a manifest finds what it lists, now; and nothing is left over after the next run.
        if folder.join(MANIFEST).is_file() {
            let manifest = Manifest::read(&folder).unwrap();
            for (name, digest) in manifest.results.values().flat_map(|e| &e.files) {
                assert_eq!(sha256_of(&folder.join(name)).unwrap(), *digest, "{name}");
            }
        }
        if round % 10 == 9 {
            study.does(&["simulate", "study.toml", "--out", "results"]);
            whole(&folder);
            for (name, bytes) in files(&folder).iter().filter(|(name, _)| *name != TIMING) {
                assert!(expected.get(name) == Some(bytes), "{name} differs after {killed} kills");
            }
        }
    }
    assert!(killed > 3, "{killed} of 60 were killed before their end");
}

/// Every command whose folder cannot be written says so before it reads anything.
#[test]
fn a_folder_that_cannot_be_written_is_reported_before_the_work() {
    let study = Study::new();
    study.write("taken", "a file");
    for command in [&["fit", "nowhere.toml"][..], &["check", "nowhere.toml"], &["terms"], &["demo"]] {
        let message = study.refuses(&[command, &["--out", "taken"]].concat());
        contains_all(&message, &["taken", "cannot write"]);
    }
}

#[test]
fn an_answer_is_printed_though_its_files_cannot_be_written() {
    let study = Study::new();
    // A run whose file would be in the way of one of the user's.
    study.write("results/trajectories/ship_a_001.csv", "of the user");
    for json in [false, true] {
        let arguments = ["simulate", "study.toml", "--out", "results", "--json"];
        let output = study.run(&arguments[..4 + usize::from(json)]);
        let (out, err) = (text(&output.stdout), text(&output.stderr));
        assert_eq!(output.status.code(), Some(2), "{err}");
        contains_all(&err, &["trajectories/ship_a_001.csv", "the new files are kept in results/not-placed-"]);
        if json {
            let value: Value = serde_json::from_str(&out).unwrap();
            assert_eq!(at(&value, "result.runs").as_array().unwrap().len(), 8);
            assert!(value.get("files").is_none());
        } else {
            assert!(out.contains("ship_a_001") && !out.contains("Written to"), "{out}");
        }
    }
    assert_eq!(std::fs::read_to_string(study.path("results/trajectories/ship_a_001.csv")).unwrap(), "of the user");
    assert!(study.path("results/not-placed-1/simulations.csv").is_file());
    assert!(!study.path("results/simulations.csv").exists());
}

/// Under a limit on the size of files, as on a full disk, each write fails.
#[cfg(unix)]
#[test]
fn an_answer_is_printed_though_the_disk_is_full() {
    let study = Study::new();
    let script = format!("trap '' XFSZ; ulimit -f 1; exec {TRIMTAB} simulate study.toml --out results");
    let limited = |more: &str| {
        let script = format!("{script}{more}");
        Command::new("sh").args(["-c", &script]).current_dir(study.folder.path()).output().unwrap()
    };
    // Through pipes, which have no size.
    let output = limited("");
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
    contains_all(&text(&output.stderr), &["results/", "cannot write"]);
    let out = text(&output.stdout);
    assert!(out.contains("ship_a_001") && out.contains("Validity: ") && !out.contains("Written to"), "{out}");
    let value: Value = serde_json::from_slice(&limited(" --json").stdout).unwrap();
    assert_eq!(at(&value, "result.runs").as_array().unwrap().len(), 8);
    assert!(files(&study.path("results")).is_empty(), "{:?}", files(&study.path("results")).keys());
    study.does(&["simulate", "study.toml", "--out", "results"]);
    whole(&study.path("results"));
}

#[test]
fn a_fit_from_many_starts_that_was_killed_goes_on_with_the_starts_that_are_left() {
    let study = Study::new();
    study.edit("study.toml", "[fit]\n", "[fit]\nintegration = { method = \"rk4\", substeps = 40 }\n");
    let command = ["fit", "study.toml", "--starts", "5", "--out"];
    study.does(&[&command[..], &["expected"]].concat());
    let expected = files(&study.path("expected"));
    let log = study.path("results/.trimtab-starts");
    let lines = || std::fs::read_to_string(&log).map_or(0, |text| text.lines().count());
    let mut child = Command::new(TRIMTAB)
        .args([&command[..], &["results"]].concat())
        .current_dir(study.folder.path())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    while lines() < 3 && child.try_wait().unwrap().is_none() {
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    // Key and two starts at least; a mark in the second shows that it is not fitted again.
    let text_of_log = std::fs::read_to_string(&log).unwrap();
    let second = text_of_log.lines().nth(2).unwrap();
    assert!(second.starts_with("[1,"), "{second}");
    let (before, after) = second.split_once("\"ended\":\"").unwrap();
    let marked = format!("{before}\"ended\":\"from the log: {after}");
    std::fs::write(&log, text_of_log.replace(second, &marked)).unwrap();
    study.does(&[&command[..], &["results"]].concat());
    assert!(!log.exists());
    for (name, bytes) in files(&study.path("results")).iter().filter(|(n, _)| *n != TIMING && *n != MANIFEST) {
        let unmarked = text_or(bytes).map_or_else(|| bytes.clone(), |t| t.replace("from the log: ", "").into_bytes());
        assert!(expected.get(name) == Some(&unmarked), "{name} differs");
    }
    let starts = std::fs::read_to_string(study.path("results/starts.csv")).unwrap();
    assert_eq!(starts.matches("from the log: ").count(), 1, "{starts}");
}

fn text_or(bytes: &[u8]) -> Option<String> {
    String::from_utf8(bytes.to_vec()).ok()
}

/// `/dev/full` takes nothing, as a full disk does.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_under_standard_output_is_reported() {
    let full = || Stdio::from(std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap());
    let output = Command::new(TRIMTAB).arg("terms").stdout(full()).stderr(Stdio::piped()).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    contains_all(&text(&output.stderr), &["cannot write to standard output"]);
    // A message that cannot be printed is no panic either.
    let status = Command::new(TRIMTAB).args(["check", "nowhere.toml"]).stderr(full()).status().unwrap();
    assert_eq!(status.code(), Some(2));
}

#[test]
fn a_closed_standard_output_changes_no_exit_code() {
    let study = Study::new();
    study.append("recordings/ship_a_002.csv", "80,1,1,1,1,1,1,1,1\n");
    for (arguments, code) in
        [(&["check", "study.toml"][..], 1), (&["check", "study.toml", "--json"], 1), (&["terms", "--json"], 0)]
    {
        let mut child = Command::new(TRIMTAB)
            .args(arguments)
            .current_dir(study.folder.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!((output.status.code(), text(&output.stderr).as_str()), (Some(code), ""), "{arguments:?}");
    }
}

#[test]
fn names_that_collide_as_file_names_get_files_of_their_own() {
    let study = Study::new();
    let names = ["a/b", "a b", "A_B", "nul", "../x", "=cmd"];
    let runs = std::fs::read_to_string(study.path("runs.csv")).unwrap();
    let (header, rows) = runs.split_once('\n').unwrap();
    assert!(header.starts_with("file,name,"));
    let renamed = rows.lines().zip(names).map(|(row, name)| {
        let mut cells: Vec<&str> = row.split(',').collect();
        cells[1] = name;
        cells.join(",") + "\n"
    });
    study.write("runs.csv", &format!("{header}\n{}", renamed.collect::<String>()));
    study.does(&["simulate", "study.toml", "--out", "results"]);
    let mut found: Vec<String> = files(&study.path("results/trajectories")).into_keys().collect();
    found.sort();
    assert_eq!(found, ["A_B_3.csv", "_.._x.csv", "_cmd.csv", "_nul.csv", "a_b.csv", "a_b_2.csv"].map(str::to_owned));
    let table = std::fs::read_to_string(study.path("results/simulations.csv")).unwrap();
    contains_all(&table, &["\na b,", ",trajectories/a_b_2.csv\n", "\n'=cmd,"]);
    // Windows shorter than a second begin in the same one.
    let study = Study::new();
    study.edit("study.toml", "name = ", "window = 0.5\nname = ");
    let step = std::fs::read_to_string(study.path("recordings/ship_a_001.csv")).unwrap();
    let times: Vec<f64> = step.lines().skip(1).filter_map(|l| l.split(',').next()?.parse().ok()).collect();
    if times[1] - times[0] > 0.25 {
        // The demo's recordings have a longer period: the clock runs faster here.
        for entry in std::fs::read_dir(study.path("recordings")).unwrap() {
            let path = entry.unwrap().path();
            let rows = std::fs::read_to_string(&path).unwrap();
            let fast = rows.lines().map(|row| match row.split_once(',') {
                Some((t, rest)) => t.parse::<f64>().map_or(format!("{row}\n"), |t| format!("{},{rest}\n", t * 0.05)),
                None => format!("{row}\n"),
            });
            std::fs::write(&path, fast.collect::<String>()).unwrap();
        }
    }
    let accepted = ["--accept", "unit_error", "--accept", "axes_error", "--accept", "sign_error"];
    let output = study.run(&[&["simulate", "study.toml", "--out", "results", "--json"][..], &accepted].concat());
    let value: Value = serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{}", text(&output.stderr)));
    let windows = at(&value, "result.runs").as_array().unwrap().len();
    assert!(windows > 8);
    assert_eq!(files(&study.path("results/trajectories")).len(), windows);
}

#[test]
fn nothing_that_controls_a_terminal_is_printed() {
    let study = Study::new();
    let runs = std::fs::read_to_string(study.path("runs.csv")).unwrap();
    let odd = runs.replacen("ship_a_001,", "\u{1b}]0;title\u{7}\u{9b}31m\u{202e}run,", 2);
    assert_ne!(odd, runs);
    study.write("runs.csv", &odd);
    study.edit("study.toml", "name = \"", "name = \"\\u001b[2J\\u009b");
    study.edit("ship.toml", "name = \"", "name = \"\\u001b[2J");
    let bad = |bytes: &[u8]| text(bytes).chars().any(|c| (c.is_control() && c != '\n') || c == '\u{202e}');
    for command in [&["check"][..], &["simulate"], &["evaluate"], &["fit"], &["maneuver", "turning"]] {
        for json in [&[][..], &["--json"]] {
            let output = study.run(&[command, &["study.toml"], json].concat());
            assert!(!output.stdout.is_empty(), "{command:?}: {}", text(&output.stderr));
            assert!(!bad(&output.stdout) && !bad(&output.stderr), "{command:?}{json:?}: {}", text(&output.stdout));
            if !json.is_empty() {
                serde_json::from_slice::<Value>(&output.stdout).unwrap();
            }
        }
    }
    let simulated = study.json(&["simulate", "study.toml"]);
    let first = at(&simulated, "result.runs.0.run").as_str().unwrap().to_owned();
    assert_eq!(first, "\\u{1b}]0;title\\u{7}\\u{9b}31m\\u{202e}run", "a name is made plain where it is read");
    study.does(&["check", "study.toml", "--out", "checked", "--tables", "latex,markdown"]);
    let written = files(&study.path("checked"));
    for (name, bytes) in written.iter().filter(|(name, _)| !name.ends_with("manifest.json")) {
        assert!(!bytes.contains(&0x1b), "{name}");
    }
    let message = study.refuses(&["check", "\u{1b}[31mnowhere.toml"]);
    contains_all(&message, &["\\u{1b}[31mnowhere.toml"]);
}

#[test]
fn a_model_that_was_cut_anywhere_is_refused() {
    let study = Study::new();
    study.does(&["fit", "study.toml", "--out", "results"]);
    let whole = std::fs::read_to_string(study.path("results/fitted.toml")).unwrap();
    let lines: Vec<usize> = whole.match_indices('\n').map(|(at, _)| at + 1).filter(|at| *at < whole.len()).collect();
    for end in [lines[0] - 1, lines[0], lines[lines.len() / 2], *lines.last().unwrap(), whole.len() - 10] {
        study.write("cut.toml", &whole[..end]);
        let message = study.refuses(&["maneuver", "turning", "study.toml", "--model", "cut.toml"]);
        contains_all(&message, &["cut.toml:", "the file is cut"]);
    }
    study.write("edited.toml", &whole.replacen("value = ", "value = 1", 1));
    let message = study.refuses(&["maneuver", "turning", "study.toml", "--model", "edited.toml"]);
    contains_all(&message, &["edited.toml:", "its checksum differs", "delete its first line"]);
    let own: String = whole.lines().filter(|l| !l.starts_with('#')).map(|l| format!("{l}\n")).collect();
    study.write("own.toml", &own);
    study.does(&["maneuver", "turning", "study.toml", "--model", "own.toml"]);
}
