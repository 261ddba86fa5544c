//! The dossier: its sections in their order, its numbers those of the other commands to the last digit, and nothing on the page that
//! is not in the document. Whether a diagnosis is right is tested elsewhere.

use crate::support::written::write_study;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::LazyLock;

/// Sections in the order of the procedure.
const KEYS: [&str; 9] =
    ["claim", "ship", "inputs", "model", "verification", "validation", "error_rates", "causes", "limits"];

fn trimtab(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_trimtab")).current_dir(folder).args(arguments).output().unwrap()
}

/// Runs a command that writes its results; a dossier of which a check failed ends with 1.
fn done(folder: &Path, arguments: &[&str]) {
    let output = trimtab(folder, arguments);
    let messages = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code().is_some_and(|c| c < 2), "{arguments:?}: {messages}");
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

fn json(path: &Path) -> Value {
    serde_json::from_str(&read(path)).unwrap()
}

fn fresh(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// Sixteen runs in a current, fitted and diagnosed, with the dossier of the fitted model.
static CASE: LazyLock<PathBuf> = LazyLock::new(|| {
    let folder = fresh("dossier");
    write_study(&folder, 16, [0.2, 0.1]);
    // Trials in steps of a tenth of a ship length: their numbers must agree, and need not be exact.
    let study = read(&folder.join("study.toml")) + "\n[maneuver]\nstep = 1.0\n";
    std::fs::write(folder.join("study.toml"), study).unwrap();
    done(&folder, &["fit", "study.toml", "--out", "fit"]);
    let model = ["--model", "fit/fitted.toml"];
    done(&folder, &[&["diagnose", "study.toml", "--out", "diagnosis", "--once"][..], &model].concat());
    done(&folder, &[&["evaluate", "study.toml", "--out", "evaluation"][..], &model].concat());
    done(&folder, &[&["maneuver", "turning", "study.toml", "--out", "turning"][..], &model].concat());
    done(&folder, &[&["maneuver", "zigzag", "study.toml", "--out", "zigzag"][..], &model].concat());
    done(&folder, &from_file("made", "2"));
    folder
});

/// The arguments of a dossier from the diagnosis in the folder.
fn from_file<'a>(out: &'a str, threads: &'a str) -> [&'a str; 12] {
    [
        "dossier",
        "study.toml",
        "--model",
        "fit/fitted.toml",
        "--use",
        "harbour approach in a training simulator",
        "--diagnosis",
        "diagnosis/diagnosis.json",
        "--out",
        out,
        "--threads",
        threads,
    ]
}

fn dossier() -> (Value, String) {
    let folder = CASE.join("made");
    (json(&folder.join("dossier.json"))["result"].clone(), read(&folder.join("dossier.html")))
}

#[test]
fn the_document_has_every_section_and_the_page_has_them_in_its_order() {
    let (d, page) = dossier();
    let sections = d["sections"].as_array().unwrap();
    let keys: Vec<&str> = sections.iter().map(|s| s["key"].as_str().unwrap()).collect();
    assert_eq!(keys, KEYS);
    let heads: Vec<&str> = page.split("<h2>").skip(1).map(|rest| rest.split("</h2>").next().unwrap()).collect();
    let titles: Vec<String> =
        sections.iter().enumerate().map(|(i, s)| format!("{}. {}", i + 1, s["title"].as_str().unwrap())).collect();
    assert_eq!(heads, titles);
    for key in KEYS.iter().filter(|k| **k != "error_rates") {
        assert!(!d[key].is_null(), "{key}");
    }
    // No error rates were measured, and this is said.
    assert!(d["error_rates"].is_null() && page.contains("Not measured."));
    assert!(sections[6]["missing"][0].as_str().unwrap().contains("--calibrate"), "{}", sections[6]);
    assert_eq!(d["claim"]["intended_use"], "harbour approach in a training simulator");
}

#[test]
fn errors_and_manoeuvres_are_those_of_the_other_commands_to_the_last_digit() {
    let (d, _) = dossier();
    let evaluation = &json(&CASE.join("evaluation/evaluate.json"))["result"];
    assert_eq!(d["validation"]["test"], evaluation["summaries"][0]);
    assert_eq!(d["model"]["validity"], evaluation["validity"]);
    let test = |t: &&Value| t["split"] == "test";
    let runs: Vec<&Value> = evaluation["trajectories"].as_array().unwrap().iter().filter(test).collect();
    assert_eq!(d["validation"]["runs"].as_array().unwrap().iter().collect::<Vec<_>>(), runs);
    for name in ["turning", "zigzag"] {
        let sailed = &json(&CASE.join(name).join(format!("maneuver_{name}.json")))["result"];
        assert_eq!(d["validation"]["manoeuvres"][name], sailed["trials"]);
        assert_eq!(d["validation"]["manoeuvres"]["approach"], sailed["approach"]);
        assert!(sailed["trials"][0]["intervals"].as_object().is_some_and(|i| !i.is_empty()), "no intervals to compare");
    }
}

#[test]
fn causes_are_those_of_the_diagnosis_whether_read_or_made() {
    let (d, _) = dossier();
    let diagnosis = json(&CASE.join("diagnosis/diagnosis.json"));
    assert_eq!(d["causes"]["found"], diagnosis["findings"]);
    assert_eq!(d["causes"]["found"][0]["mechanism"], "current", "{}", d["causes"]["found"]);
    assert_eq!(d["causes"]["headline"], diagnosis["headline"]);
    assert_eq!(d["ship"]["noise"], diagnosis["noise_after"]["sensors"]);
    let limits = d["limits"].to_string();
    assert!(limits.contains("names causes of error that the model does not contain: steady current"), "{limits}");
    assert!(d["causes"]["source"].as_str().unwrap().contains("made of the same files"), "{}", d["causes"]["source"]);
    done(&CASE, &["dossier", "study.toml", "--model", "fit/fitted.toml", "--once", "--out", "anew"]);
    let anew = &json(&CASE.join("anew/dossier.json"))["result"];
    let without_source = |causes: &Value| {
        let mut causes = causes.clone();
        causes["source"] = Value::Null;
        causes
    };
    assert_eq!(without_source(&anew["causes"]), without_source(&d["causes"]));
}

#[test]
fn the_checks_pass_on_a_study_that_its_own_model_made() {
    let (d, _) = dossier();
    let checks = d["verification"]["checks"].as_array().unwrap();
    let keys: Vec<&str> = checks.iter().map(|c| c["key"].as_str().unwrap()).collect();
    let all = ["step", "order", "central_differences", "num_dual", "mirror", "turn", "momentum", "energy"];
    assert_eq!(keys, all);
    for c in checks.iter().filter(|c| c["key"] != "step") {
        assert_eq!(c["passed"], true, "{c}");
    }
    for c in checks {
        let (number, limit) = (c["number"].as_f64().unwrap(), c["limit"].as_f64().unwrap());
        let kept = if c["at"] == "most" { number <= limit } else { number >= limit };
        assert_eq!(c["passed"], kept, "{c}");
    }
}

/// The value in a document at a key such as `validation.runs[0].run`.
fn at<'a>(document: &'a Value, key: &str) -> &'a Value {
    let pointer: String = key.split(['.', '[']).map(|part| format!("/{}", part.trim_end_matches(']'))).collect();
    document.pointer(&pointer).unwrap_or_else(|| panic!("{key} is on the page and not in the document"))
}

/// The page without script, style and head.
fn words(page: &str) -> String {
    let (_, body) = page.split_once("<body>").unwrap();
    let mut text = body.to_owned();
    for element in ["script", "nav"] {
        while let Some(start) = text.find(&format!("<{element}")) {
            let end = text[start..].find(&format!("</{element}>")).unwrap() + start;
            text.replace_range(start..end + element.len() + 3, "");
        }
    }
    text
}

#[test]
fn every_number_on_the_page_is_in_the_document() {
    let (d, page) = dossier();
    let text = words(&page);
    let mut free = String::new();
    let mut count = 0;
    let mut rest = text.as_str();
    while let Some((before, after)) = rest.split_once("<data") {
        free += before;
        let (tag, after) = after.split_once('>').unwrap();
        let (shown, after) = after.split_once("</data>").unwrap();
        let attribute = |name: &str| tag.split_once(&format!("{name}=\"")).unwrap().1.split_once('"').unwrap().0;
        let (key, value) = (attribute("data-key"), attribute(" value").parse::<f64>().unwrap());
        let factor: f64 = attribute("data-factor").parse().unwrap();
        assert_eq!(at(&d, key).as_f64(), Some(value), "{key}");
        if let Ok(shown) = shown.parse::<f64>() {
            let expected = value * factor;
            assert!((shown - expected).abs() <= 0.051 * expected.abs() + 0.51, "{key}: {shown} for {expected}");
        }
        (rest, count) = (after, count + 1);
    }
    free += rest;
    assert!(count > 150, "{count} numbers");
    // What is left are words; a number in them is in the document or in the words of the page itself.
    let own = [
        "7.5", "02", "06", "03", "137", "76", "137(76)", "95", "80", "100", "90", "180", "1", "2", "256", "10", "20",
        "35",
    ];
    let document = d.to_string();
    let plain: String =
        free.split('<').map(|piece| format!(" {}", piece.split_once('>').map_or(piece, |p| p.1))).collect();
    for token in plain.split(|c: char| !(c.is_ascii_digit() || c == '.')).map(|t| t.trim_matches('.')) {
        if token.is_empty() || own.contains(&token) || token.len() == 1 {
            continue;
        }
        assert!(document.contains(token), "{token} is on the page and not in the document");
    }
}

#[test]
fn the_page_needs_nothing_outside_itself_and_has_no_nan() {
    let (d, page) = dossier();
    for outside in ["http:", "https:", "src=", "<link", "@import", "url(http"] {
        assert!(!page.contains(outside), "{outside}");
    }
    for bad in ["NaN", "null", "inf "] {
        assert!(!words(&page).contains(bad), "{bad} on the page");
    }
    assert!(!d.to_string().contains("NaN"));
}

#[test]
fn the_files_are_the_same_bytes_on_one_and_on_two_threads() {
    done(&CASE, &from_file("one", "1"));
    for name in ["dossier.json", "dossier.html"] {
        assert!(read(&CASE.join("one").join(name)) == read(&CASE.join("made").join(name)), "{name}");
    }
}

#[test]
fn the_inputs_are_listed_with_their_checksums() {
    let (d, _) = dossier();
    let files = d["inputs"]["files"].as_array().unwrap();
    assert!(files.len() > 16, "{}", files.len());
    for f in files {
        let path = CASE.join(f["path"].as_str().unwrap());
        assert_eq!(f["sha256"].as_str().unwrap(), trimtab::files::sha256_of(&path).unwrap(), "{}", path.display());
    }
    assert_eq!(d["inputs"]["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(d["inputs"]["seeds"]["diagnosis"], 7);
}

#[test]
fn a_study_without_test_runs_claims_no_accuracy_and_says_what_is_missing() {
    let folder = fresh("dossier_untested");
    write_study(&folder, 4, [0.0, 0.0]);
    let listed = read(&folder.join("runs.csv")).replace(",test", ",train");
    std::fs::write(folder.join("runs.csv"), listed).unwrap();
    done(&folder, &["dossier", "study.toml", "--no-diagnosis", "--out", "made"]);
    let d = &json(&folder.join("made/dossier.json"))["result"];
    assert!(d["claim"]["statement"].as_str().unwrap().starts_with("No accuracy is claimed"), "{}", d["claim"]);
    assert!(d["validation"]["test"].is_null() && d["causes"].is_null());
    let missing = |i: usize| d["sections"][i]["missing"].to_string();
    assert!(missing(5).contains("no test runs") && missing(7).contains("no diagnosis"), "{}", d["sections"]);
    assert!(missing(0).contains("--use") && missing(5).contains("no covariance"), "{}", d["sections"]);
    let page = read(&folder.join("made/dossier.html"));
    assert!(page.contains("No accuracy is claimed") && !page.contains("Errors on the test runs"));
}

#[test]
fn a_diagnosis_of_other_files_is_refused() {
    let folder = fresh("dossier_other");
    write_study(&folder, 8, [0.2, 0.1]);
    done(&folder, &["diagnose", "study.toml", "--out", "diagnosis", "--once"]);
    let longer = read(&folder.join("model.toml")) + "\n# changed since\n";
    std::fs::write(folder.join("model.toml"), longer).unwrap();
    let output = trimtab(&folder, &["dossier", "study.toml", "--diagnosis", "diagnosis/diagnosis.json"]);
    let messages = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{messages}");
    assert!(messages.contains("made of other files") && messages.lines().count() == 1, "{messages}");
}
