//! `trimtab diagnose` on a study on disk: verdict, documents, pictures, and their agreement with each other.
//! The verdicts themselves are tested on the library; here one concealed current is diagnosed and the output is read.

use crate::support::written::write_study;
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::LazyLock;
use trimtab::report::diagnosis::keys;

/// Runs the command in a folder.
fn trimtab(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_trimtab")).current_dir(folder).args(arguments).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// The study and the output of `diagnose --out results`, computed once for all tests.
struct Case {
    folder: PathBuf,
    output: Output,
    document: Value,
}

static CASE: LazyLock<Case> = LazyLock::new(|| {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("diagnose");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    write_study(&folder, 24, [0.2, 0.1]);
    let output = trimtab(&folder, &["diagnose", "study.toml", "--repeat", "--out", "results"]);
    assert!(output.status.success(), "{}{}", text(&output.stdout), text(&output.stderr));
    let document = std::fs::read_to_string(folder.join("results/diagnosis.json")).unwrap();
    Case { folder, output, document: serde_json::from_str(&document).unwrap() }
});

/// Every path of a document, with list entries as `[]`; entries of a list of names or numbers are no paths.
fn paths(value: &Value, at: &str, out: &mut BTreeSet<String>) {
    match value {
        Value::Object(members) => {
            for (key, v) in members {
                let path = if at.is_empty() { key.clone() } else { format!("{at}.{key}") };
                paths(v, &path, out);
            }
        }
        Value::Array(entries) if entries.iter().any(Value::is_object) => {
            entries.iter().for_each(|e| paths(e, &format!("{at}[]"), out));
        }
        _ => {
            out.insert(at.to_owned());
        }
    }
}

#[test]
fn a_concealed_current_is_named_with_its_size_and_proven_on_unseen_runs() {
    let d = &CASE.document;
    assert_eq!(d["verdict"], "named", "{}", d["headline"]);
    let finding = &d["findings"][0];
    assert_eq!(finding["mechanism"], "current");
    let parameters = finding["parameters"].as_array().unwrap();
    for (p, (name, truth)) in parameters.iter().zip([("current.north", 0.2), ("current.east", 0.1)]) {
        assert_eq!(p["name"], name);
        assert!((p["value"].as_f64().unwrap() - truth).abs() < 4.0 * p["error"].as_f64().unwrap(), "{p}");
    }
    let proof = &d["held_out"];
    assert_eq!(proof["runs"], 6);
    assert!(proof["after"].as_f64() < proof["before"].as_f64(), "{proof}");
}

#[test]
fn every_key_of_the_document_is_explained_and_none_is_null() {
    let mut found = BTreeSet::new();
    paths(&CASE.document, "", &mut found);
    // An explained object or list covers its members where those are explained elsewhere.
    let elsewhere = ["settings", "noise_after", "location_after", "adequacy_after", "admission.integration"];
    let lists = [
        "findings[].held_out",
        "findings[].equations",
        "findings[].windows[]",
        "held_out.runs_after[]",
        "location.push.windows[]",
        "sides.parameters[]",
    ];
    let explained = |path: &str| {
        keys().any(|(k, _)| k == path || k.strip_suffix("[]") == Some(path))
            || elsewhere.iter().chain(&lists).any(|k| path.starts_with(k))
    };
    let missing: Vec<&String> = found.iter().filter(|p| !explained(p)).collect();
    assert!(missing.is_empty(), "not in keys.txt: {missing:?}");
    assert!(!CASE.document.to_string().contains("null"));
}

#[test]
fn no_key_is_explained_that_the_document_cannot_have() {
    let mut found = BTreeSet::new();
    paths(&CASE.document, "", &mut found);
    // Keys that do not occur in this case.
    let absent = [
        "law",
        "admission.issues[]",
        "recordings.doubts[]",
        "location.windows[]",
        "findings[].windows[]",
        "absorbed[]",
        "next_trial",
        "findings[].held_out.agreement",
        "findings[].region",
        "ranking[].sessions",
        "withdrawn[]",
        "differing[]",
        "causes[]",
        "error_rates",
    ];
    for (key, _) in keys() {
        let bare = key.trim_end_matches("[]");
        let there =
            found.iter().any(|p| p == bare || p.starts_with(&format!("{key}.")) || p.starts_with(&format!("{bare}.")));
        assert!(there || absent.iter().any(|a| key.starts_with(a)), "{key} is explained but not there");
    }
}

#[test]
fn the_summary_has_seven_parts_in_order_and_no_missing_number() {
    let summary = text(&CASE.output.stdout);
    let headings = ["VERDICT", "WHERE", "MODEL", "PROOF", "STILL OPEN", "LIMITS", "NEXT TRIAL"];
    let places: Vec<usize> =
        headings.iter().enumerate().map(|(i, h)| summary.find(&format!(" {} {h}", i + 1)).unwrap()).collect();
    assert!(places.is_sorted(), "{summary}");
    assert!(summary.contains("steady current") && summary.contains("setting towards"), "{summary}");
    assert!(summary.contains("port and starboard of the ship itself"), "{summary}");
    assert!(!summary.contains("NaN") && !summary.contains("inf "), "{summary}");
    // What the audit says before it is not divided into lines.
    let own = summary.lines().skip_while(|l| !l.starts_with("DIAGNOSIS"));
    assert!(own.clone().count() > 20 && own.clone().all(|l| l.chars().count() <= 104), "{summary}");
}

#[test]
fn the_answer_ends_with_the_commands_to_run_next_and_they_run() {
    let printed = text(&CASE.output.stdout).replace(" \\\n      ", " ");
    let commands = CASE.document["next_commands"].as_array().unwrap();
    assert_eq!(commands.len(), 2);
    for command in commands.iter().map(|c| c.as_str().unwrap()) {
        assert!(printed.contains(&format!("\n  {command}\n")), "{command}\n{printed}");
        let arguments: Vec<&str> = command.split(' ').skip(1).collect();
        let output = trimtab(&CASE.folder, &arguments);
        assert!(output.status.success(), "{command}: {}", text(&output.stderr));
    }
    assert!(commands[0].as_str().unwrap().contains("--model results/improved.toml --baseline results/base.toml"));
    let page = std::fs::read_to_string(CASE.folder.join("results/report.html")).unwrap();
    assert!(page.contains("Commands to run next") && page.contains(commands[0].as_str().unwrap()));
}

#[test]
fn other_commands_take_the_improved_model_and_it_is_better_than_the_base() {
    let evaluate = |model: &str| {
        let arguments = ["evaluate", "study.toml", "--model", model, "--baseline", "results/base.toml", "--json"];
        let output = trimtab(&CASE.folder, &arguments);
        assert!(output.status.success(), "{}", text(&output.stderr));
        serde_json::from_slice::<Value>(&output.stdout).unwrap()
    };
    let improved = evaluate("results/improved.toml");
    let main = &improved["result"]["summaries"][0];
    assert!(main["cvdm_fitted"]["value"].as_f64() < main["cvdm_baseline"]["value"].as_f64(), "{main}");
}

#[test]
fn a_diagnosis_and_an_evaluation_give_the_same_proof_to_the_last_digit() {
    let pair = ["evaluate", "study.toml", "--model", "results/improved.toml", "--baseline", "results/base.toml"];
    let output = trimtab(&CASE.folder, &[&pair[..], &["--json"]].concat());
    let evaluation: Value = serde_json::from_slice(&output.stdout).unwrap();
    let (evaluation, proof) = (&evaluation["result"], &CASE.document["held_out"]);
    let main = evaluation["summaries"].as_array().unwrap().iter().find(|s| s["group"] == "test").unwrap();
    let same = [
        ("before", &main["cvdm_baseline"]["value"]),
        ("after", &main["cvdm_fitted"]["value"]),
        ("improvement", &main["cvdm_improvement"]["value"]),
        ("ci95", &main["cvdm_improvement"]["ci95"]),
        ("better", &main["better"]),
        ("worse", &main["worse"]),
        ("runs", &main["trajectories"]),
    ];
    for (key, value) in same {
        assert!(!value.is_null() && &proof[key] == value, "{key}: {} {value}", proof[key]);
    }
    let test = evaluation["trajectories"].as_array().unwrap().iter().filter(|t| t["split"] == "test");
    let (before, after) = (proof["runs_before"].as_array().unwrap(), proof["runs_after"].as_array().unwrap());
    assert_eq!(before.len(), 6);
    for ((t, before), after) in test.zip(before).zip(after) {
        assert_eq!((&t["baseline"]["cvdm"], &t["fitted"]["cvdm"]), (&before["cvdm"], &after["cvdm"]));
    }
    // The interval of the improvement is that of a ratio over the six recordings, and ends at an exact prediction.
    let of = |scores: &[Value]| scores.iter().map(|s| s["cvdm"].as_f64().unwrap()).collect::<Vec<f64>>();
    let clusters: Vec<(f64, f64)> = of(after).into_iter().zip(of(before)).collect();
    let [low, high] = trimtab::numbers::statistics::interval_of_ratio(&clusters).unwrap();
    for (end, own) in [1.0 - high, (1.0 - low).min(1.0)].into_iter().enumerate() {
        assert!((proof["ci95"][end].as_f64().unwrap() - own).abs() < 1e-5, "{} {own}", proof["ci95"]);
    }
    // And as printed.
    let (table, summary) = (trimtab(&CASE.folder, &pair), text(&CASE.output.stdout));
    let row = text(&table.stdout).lines().find(|l| l.contains("cVDM [%]")).unwrap().to_owned();
    let words: Vec<&str> = summary.split_whitespace().collect();
    let at = words.windows(3).position(|w| w[0] == "cVDM" && w[2] == "%").unwrap();
    assert!(row.contains(words[at + 1]) && row.contains(words[at + 4]), "{row}: {:?}", &words[at..at + 6]);
}

#[test]
fn every_figure_is_a_file_with_its_numbers() {
    for stem in ["ranking", "tracks", "forces", "pattern", "compass", "regions", "moves", "held_out", "hull_budget"] {
        for extension in ["png", "csv"] {
            let file = CASE.folder.join(format!("results/figures/{stem}.{extension}"));
            assert!(file.is_file(), "{}", file.display());
        }
    }
}

#[test]
fn a_mechanism_that_does_not_exist_cannot_be_withheld() {
    let output = trimtab(&CASE.folder, &["diagnose", "study.toml", "--withhold", "curent"]);
    assert_eq!(output.status.code(), Some(2));
    let message = text(&output.stderr);
    assert!(message.contains("did you mean `current`?") && output.stdout.is_empty(), "{message}");
}

#[test]
fn too_few_runs_give_exit_code_1_and_advice_on_what_to_record() {
    let folder = tempfile::tempdir().unwrap();
    write_study(folder.path(), 2, [0.0, 0.0]);
    let output = trimtab(folder.path(), &["diagnose", "study.toml", "--json"]);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    let d: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(d["verdict"], "insufficient");
    assert!(d["next_trial"]["trial"].as_str().unwrap().contains("turning circles"));
}
