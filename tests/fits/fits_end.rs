//! Fits as users type them, which once never ended: each ends within its limits, converged, at the lowest cost that is known.
//! How good the models are is not tested here.

use crate::support::study::{Study, at};
use serde_json::Value;
use std::path::PathBuf;

/// The result of a fit that converged, with what it took.
fn fitted(study: &Study, arguments: &[&str]) -> (f64, usize) {
    let value: Value = study.json(&[&["fit"], arguments].concat());
    assert_eq!(at(&value, "result.converged"), true, "{arguments:?}: {}", at(&value, "result.headline"));
    let number = |path: &str| at(&value, path).as_f64().unwrap();
    assert!(number("result.checks.0") >= 1.0, "{arguments:?}: an optimum is checked");
    (number("result.cost") + number("result.prior_cost"), number("result.counts.objective") as usize)
}

/// Makes the study at `path` minimise squares of the trajectory instead.
fn by_trajectory(study: &Study, path: &str) {
    study.edit(path, "objective = \"likelihood\"", "objective = \"trajectory\"");
}

/// cVDM of the test runs with the model of the folder `out`.
fn unseen(study: &Study, path: &str, out: &str) -> f64 {
    let value = study.json(&["evaluate", path, "--model", &format!("{out}/fitted.toml")]);
    at(&value, "result.summaries.0.cvdm_fitted.value").as_f64().unwrap()
}

#[test]
fn the_demo_is_fitted_by_likelihood_and_predicts_unseen_runs_better_for_it() {
    let study = Study::new();
    study.does(&["demo", "--out", "demo"]);
    let (_, evaluated) = fitted(&study, &["demo/study.toml", "--out", "likelihood"]);
    assert!(evaluated < 200, "{evaluated}");
    let by_likelihood = unseen(&study, "demo/study.toml", "likelihood");
    by_trajectory(&study, "demo/study.toml");
    fitted(&study, &["demo/study.toml", "--out", "trajectory"]);
    let by_squares = unseen(&study, "demo/study.toml", "trajectory");
    assert!(by_likelihood < 0.9 * by_squares, "{by_likelihood} {by_squares}");
}

#[test]
fn fits_of_the_demo_end_whatever_of_the_hull_is_free() {
    let study = Study::new();
    study.does(&["demo", "--out", "demo"]);
    by_trajectory(&study, "demo/study.toml");
    let eleven = fitted(&study, &["demo/study.toml"]);
    for free in [&["--free-hull"][..], &["--free", "hull"], &["--free", "flow"]] {
        let (cost, evaluated) = fitted(&study, &[&["demo/study.toml"], free].concat());
        assert!(cost < eleven.0 && evaluated < 3000, "{free:?}: {cost} in {evaluated}, eleven alone {}", eleven.0);
    }
    let (cost, _) = fitted(&study, &["demo/study.toml", "--free-hull"]);
    assert!(cost < 147.0, "{cost}");
}

#[test]
fn a_fit_that_may_not_go_on_says_which_limit_ended_it_and_writes_its_best_point() {
    let study = Study::new();
    study.does(&["demo", "--out", "demo"]);
    for (limit, word) in [("max_evaluations = 5", "max_evaluations"), ("max_seconds = 0.001", "max_seconds")] {
        let text = std::fs::read_to_string(study.path("demo/study.toml")).unwrap();
        study.write("demo/short.toml", &text.replace("[fit]\n", &format!("[fit]\n{limit}\n")));
        let output = study.run(&["fit", "demo/short.toml", "--out", "short", "--json"]);
        assert_eq!(output.status.code(), Some(1));
        let value: Value = serde_json::from_slice(&output.stdout).unwrap();
        let status = at(&value, "result.status").as_str().unwrap();
        assert!(status.contains(word), "{status}");
        assert!(study.path("short/fitted.toml").is_file());
    }
}

/// A ship that is known by its particulars alone, without priors: its start is far from where a fit should end.
#[test]
fn a_fit_of_a_ship_known_by_its_particulars_ends_at_the_lowest_known_cost() {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let given = std::env::var_os("TRIMTAB_DATA").map(PathBuf::from);
    let folder = given.unwrap_or_else(|| root.join("../shared/data")).join("tug");
    if !folder.is_dir() {
        crate::support::skipped(&format!("{} is absent; set TRIMTAB_DATA to run this test", folder.display()));
        return;
    }
    let file = |name: &str| folder.join(name).to_string_lossy().into_owned();
    let study = Study::new();
    for (seed, lowest) in [(77, 3242.334), (1, 3337.81)] {
        let (nav, bridge) = (file(&format!("nav_{seed}.csv")), file(&format!("bridge_{seed}.csv")));
        let out = format!("tug{seed}");
        study.does(&["import", &nav, &bridge, "--ship", &file("ship.toml"), "--out", &out]);
        let path = format!("{out}/study.toml");
        fitted(&study, &[&path, "--out", "likelihood"]);
        by_trajectory(&study, &path);
        let (cost, _) = fitted(&study, &[&path]);
        assert!(cost < 1.001 * lowest, "{seed}: {cost}");
    }
}
