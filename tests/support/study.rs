//! A small study on disk and the command run on it, for the tests of the command line.
//! What the command answers is tested where this is used.

#![allow(dead_code)]

use serde_json::Value;
use std::path::PathBuf;
use std::process::{Command, Output};
use tempfile::TempDir;

/// A small study in a folder of its own: four runs of the demo, cut to 40 steps.
pub struct Study {
    pub folder: TempDir,
}

impl Study {
    pub fn new() -> Self {
        let study = Self { folder: tempfile::tempdir().unwrap() };
        let files = trimtab::study::demo::files();
        let runs = &files.iter().find(|(name, _)| name == "runs.csv").unwrap().1;
        let (mut listed, mut test, mut train) = (String::from("file,name,manoeuvre,split\n"), 0, 0);
        for line in runs.lines().skip(1) {
            let count = if line.ends_with("test") { &mut test } else { &mut train };
            if *count < 4 {
                *count += 1;
                listed += &format!("{line}\n");
            }
        }
        for (name, text) in &files {
            if name == "runs.csv" {
                study.write(name, &listed);
            } else if !name.starts_with("recordings/") {
                study.write(name, text);
            } else if listed.contains(name.as_str()) {
                study.write(name, &text.lines().take(42).map(|l| format!("{l}\n")).collect::<String>());
            }
        }
        study
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn write(&self, name: &str, text: &str) {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }

    pub fn edit(&self, name: &str, from: &str, to: &str) {
        let text = std::fs::read_to_string(self.path(name)).unwrap();
        assert!(text.contains(from), "{from} is not in {name}");
        self.write(name, &text.replace(from, to));
    }

    pub fn append(&self, name: &str, text: &str) {
        let before = std::fs::read_to_string(self.path(name)).unwrap();
        self.write(name, &format!("{before}{text}"));
    }

    /// Runs trimtab in the folder.
    pub fn run(&self, arguments: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_trimtab")).args(arguments).current_dir(self.folder.path()).output().unwrap()
    }

    /// Runs trimtab, which must succeed; gives standard output.
    pub fn does(&self, arguments: &[&str]) -> String {
        let output = self.run(arguments);
        let (out, err) = (text(&output.stdout), text(&output.stderr));
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {err}");
        // A busy machine makes any work long, and long work says that it goes on.
        let said: Vec<&str> = err.lines().filter(|line| !line.ends_with("s so far)")).collect();
        assert!(said.is_empty(), "{arguments:?}: {err}");
        out
    }

    /// Runs trimtab with `--json`.
    pub fn json(&self, arguments: &[&str]) -> Value {
        let out = self.does(&[arguments, &["--json"]].concat());
        let value: Value = serde_json::from_str(&out).unwrap();
        no_empty_members(&value, &arguments.join(" "));
        value
    }

    /// Runs trimtab, which must fail with one message and exit code 2; gives the message. Of several mistakes it has a line each, which
    /// begins with its place.
    pub fn refuses(&self, arguments: &[&str]) -> String {
        let output = self.run(arguments);
        let err = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {err}");
        assert_eq!(text(&output.stdout), "", "{arguments:?}");
        let placed = |line: &str| {
            line.split_once(": ").is_some_and(|(place, _)| place.contains(".toml") || place.contains(".csv"))
        };
        assert!(err.starts_with("trimtab: ") && err.lines().skip(1).all(placed), "{err}");
        err
    }
}

pub fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// No member of an object is null: a value that does not exist is absent.
pub fn no_empty_members(value: &Value, place: &str) {
    match value {
        Value::Object(members) => members.iter().for_each(|(k, v)| {
            assert!(!v.is_null(), "{place}.{k} is null");
            no_empty_members(v, &format!("{place}.{k}"));
        }),
        Value::Array(entries) => entries.iter().for_each(|v| no_empty_members(v, place)),
        _ => {}
    }
}

/// The value at a path of members and indices.
pub fn at<'a>(value: &'a Value, path: &str) -> &'a Value {
    let pointer = format!("/{}", path.replace('.', "/"));
    value.pointer(&pointer).unwrap_or_else(|| panic!("no {path} in {value:#}"))
}

pub fn contains_all(message: &str, parts: &[&str]) {
    for part in parts {
        assert!(message.contains(part), "`{part}` is not in: {message}");
    }
}
