//! Jobs of several ranks under `mpirun`: the same bytes for any number of ranks and threads, and an end where one rank ends.
//! What the ranks compute is tested elsewhere; this asks only that dividing it changes nothing.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

const TRIMTAB: &str = env!("CARGO_BIN_EXE_trimtab");

/// The study of the demo with so many of its training runs, in a folder of its own.
fn study(train: usize) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in trimtab::study::demo::files() {
        let mut met = 0;
        let keeps = |line: &&str| {
            met += usize::from(line.ends_with("train"));
            !line.ends_with("train") || met <= train
        };
        let text = if name == "runs.csv" {
            text.lines().filter(keeps).map(|line| format!("{line}\n")).collect()
        } else {
            text
        };
        let path = folder.path().join(&name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    folder
}

/// `mpirun` with so many ranks on this machine, ended after three minutes.
fn job(folder: &Path, ranks: usize) -> Command {
    let mut command = Command::new("timeout");
    command.args(["180", "mpirun", "--oversubscribe", "--allow-run-as-root", "--bind-to", "none", "-n"]);
    command.arg(ranks.to_string()).current_dir(folder);
    command
}

fn messages(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Runs trimtab on so many ranks with so many threads each; gives standard output.
fn does(folder: &Path, ranks: usize, threads: usize, arguments: &[&str]) -> String {
    let threads = threads.to_string();
    let output = job(folder, ranks).args([TRIMTAB, "--threads", &threads]).args(arguments).output().unwrap();
    assert!(output.status.success(), "{ranks} ranks, {arguments:?}: {}", messages(&output));
    String::from_utf8(output.stdout).unwrap()
}

/// The files of a folder by name, without the one that lists the time taken.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path());
    let entries = entries.filter(|path| !path.ends_with(trimtab::files::TIMING));
    let named = |path: PathBuf| {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        (name, std::fs::read(path).unwrap())
    };
    entries.map(named).collect()
}

/// Runs a command on several numbers of ranks and threads, and compares the files it writes.
fn same_bytes(folder: &Path, arguments: &[&str], jobs: &[(usize, usize)], expected: &[&str]) {
    let mut first: Option<BTreeMap<String, Vec<u8>>> = None;
    for (ranks, threads) in jobs {
        let out = format!("out-{ranks}-{threads}");
        does(folder, *ranks, *threads, &[arguments, &["--out", &out]].concat());
        let found = files(&folder.join(&out));
        expected.iter().for_each(|name| assert!(found.contains_key(*name), "{name}: {:?}", found.keys()));
        assert!(!found.contains_key("best.toml"), "the copy of a fit that has ended is left");
        let first = first.get_or_insert_with(|| found.clone());
        assert_eq!(first.keys().collect::<Vec<_>>(), found.keys().collect::<Vec<_>>());
        for (name, bytes) in &found {
            assert!(&first[name] == bytes, "{name} differs on {ranks} ranks with {threads} threads each");
        }
        std::fs::remove_dir_all(folder.join(&out)).unwrap();
    }
}

#[test]
fn a_fit_has_the_same_bytes_for_any_number_of_ranks_and_threads() {
    let folder = study(32);
    let jobs = [(1, 1), (1, 2), (2, 1), (2, 2), (4, 1)];
    same_bytes(folder.path(), &["fit", "study.toml"], &jobs, &["fit.json", "fit.txt", "fitted.toml", "parameters.csv"]);
}

#[test]
fn a_rank_without_runs_changes_nothing() {
    let folder = study(3);
    same_bytes(folder.path(), &["fit", "study.toml"], &[(1, 1), (4, 1)], &["fitted.toml"]);
}

#[test]
fn a_fit_from_many_starts_has_the_same_bytes_for_any_number_of_ranks() {
    let folder = study(6);
    let arguments = ["fit", "study.toml", "--starts", "5"];
    same_bytes(folder.path(), &arguments, &[(1, 2), (2, 1), (4, 1)], &["starts.csv", "fitted.toml"]);
}

#[test]
fn an_evaluation_has_the_same_bytes_for_any_number_of_ranks() {
    let folder = study(6);
    same_bytes(folder.path(), &["evaluate", "study.toml"], &[(1, 2), (2, 1), (4, 1)], &["evaluate.json"]);
}

#[test]
fn commands_that_are_not_divided_print_once() {
    let folder = study(3);
    let alone = Command::new(TRIMTAB).arg("terms").output().unwrap();
    assert_eq!(does(folder.path(), 2, 1, &["terms"]).into_bytes(), alone.stdout);
}

#[test]
fn a_rank_that_cannot_read_its_recording_ends_the_job_with_the_reason() {
    let folder = study(4);
    let runs = std::fs::read_to_string(folder.path().join("runs.csv")).unwrap();
    let last = runs.lines().rfind(|line| line.ends_with("train")).unwrap().split(',').next().unwrap().to_owned();
    std::fs::write(folder.path().join(&last), "t,x\nnothing\n").unwrap();
    let output = job(folder.path(), 2).args([TRIMTAB, "fit", "study.toml"]).output().unwrap();
    assert!(output.status.code() == Some(2), "{:?} {}", output.status, messages(&output));
    assert!(messages(&output).contains("rank 1 of 2: ") && messages(&output).contains(&last), "{}", messages(&output));
}

#[test]
fn a_rank_that_dies_ends_the_job_and_leaves_the_best_point() {
    let folder = study(32);
    let path = folder.path().join("study.toml");
    // Steps so fine that the fit is still running when its first point has been written.
    let text = std::fs::read_to_string(&path).unwrap();
    let fine = "integration = { method = \"rk4\", substeps = 100 }\n";
    assert!(text.contains("\n[fit]\n"));
    std::fs::write(&path, text.replace("\n[fit]\n", &format!("\n[fit]\n{fine}"))).unwrap();
    let script = format!("echo $$ > pid-$OMPI_COMM_WORLD_RANK; exec {TRIMTAB} --threads 1 fit study.toml --out out");
    let mut command = job(folder.path(), 2);
    let running = command.args(["sh", "-c", &script]).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let best = folder.path().join("out/best.toml");
    let began = Instant::now();
    while !best.exists() && began.elapsed() < Duration::from_secs(120) {
        std::thread::sleep(Duration::from_millis(20));
    }
    let pid = std::fs::read_to_string(folder.path().join("pid-1")).unwrap();
    assert!(Command::new("kill").args(["-9", pid.trim()]).status().unwrap().success());
    let output = running.wait_with_output().unwrap();
    let said = messages(&output) + &String::from_utf8_lossy(&output.stdout);
    assert!(!output.status.success() && output.status.code() != Some(124), "{:?} {said}", output.status);
    assert!(said.contains("rank 1") && said.contains("signal 9"), "{said}");
    assert!(!folder.path().join("out/fitted.toml").exists(), "the fit had ended before the rank was killed");
    // What was left is a model that the next command takes.
    let arguments = ["evaluate", "study.toml", "--model", "out/best.toml"];
    let next = Command::new(TRIMTAB).args(arguments).current_dir(folder.path()).output().unwrap();
    assert!(next.status.success(), "{}", messages(&next));
}
