//! `trimtab help`, `completions` and `man`, and every pointer to them: what a message names is there.
//! The text of the guide is tested in `tests/house/guide.rs`.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use trimtab::guide::CHAPTERS;

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_trimtab")).args(arguments).output().unwrap()
}

fn does(arguments: &[&str]) -> String {
    let output = run(arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn every_topic_is_shown_and_listed() {
    let listed = does(&["help"]);
    for chapter in CHAPTERS {
        let text = does(&["help", chapter.name]);
        assert!(text.contains("====") && text.len() > 800, "{}", chapter.name);
        assert!(!text.contains("```") && !text.contains("<!--") && !text.contains("\\["), "{}", chapter.name);
        assert!(listed.contains(&format!("  {}", chapter.name)) && does(&["--help"]).contains(chapter.name));
    }
}

#[test]
fn help_of_a_command_is_that_of_its_option() {
    for command in [&["fit"][..], &["check"], &["maneuver", "turning"], &["help"], &["completions"], &["man"]] {
        assert_eq!(does(&[&["help"], command].concat()), does(&[command, &["--help"]].concat()));
    }
    let output = run(&["help", "colums"]);
    assert_eq!(output.status.code(), Some(2));
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(message.contains("did you mean `columns`?") && message.contains("`trimtab help` lists them"), "{message}");
}

#[test]
fn schemas_are_printed_for_files_and_for_nothing_else() {
    for (topic, key) in [("study", "window"), ("ship", "hull"), ("model", "terms"), ("columns", "blank")] {
        let schema: serde_json::Value = serde_json::from_str(&does(&["help", topic, "--schema"])).unwrap();
        assert_eq!(schema["$schema"], "http://json-schema.org/draft-07/schema#");
        assert!(schema["properties"][key].is_object(), "{topic}");
        assert_eq!(schema["additionalProperties"], false, "{topic}");
    }
    assert_eq!(run(&["help", "theory", "--schema"]).status.code(), Some(2));
}

#[test]
fn completions_of_every_shell_know_the_commands() {
    for shell in ["bash", "zsh", "fish", "powershell"] {
        let script = does(&["completions", shell]);
        for word in ["diagnose", "evaluate", "maneuver", "completions", "accept"] {
            assert!(script.contains(word), "{shell} lacks {word}");
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let script = folder.path().join("trimtab.bash");
    std::fs::write(&script, does(&["completions", "bash"])).unwrap();
    let line = format!(
        "source {}; COMP_WORDS=(trimtab dia); COMP_CWORD=1; _trimtab trimtab dia trimtab; echo ${{COMPREPLY[@]}}",
        script.display()
    );
    let Ok(output) = Command::new("bash").args(["-c", &line]).output() else { return };
    assert_eq!(
        String::from_utf8_lossy(&output.stdout).trim(),
        "diagnose",
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
}

#[test]
fn every_command_gets_a_manual_page() {
    let folder = tempfile::tempdir().unwrap();
    does(&["man", "--out", folder.path().to_str().unwrap()]);
    for (page, words) in [
        ("trimtab", ["SUBCOMMANDS", "trimtab\\-diagnose"]),
        ("trimtab-fit", ["\\-\\-starts", "95 % interval"]),
        ("trimtab-maneuver-turning", ["\\-\\-model", "turning"]),
    ] {
        let text = std::fs::read_to_string(folder.path().join(format!("{page}.1"))).unwrap();
        assert!(text.contains(".TH ") && text.contains("NAME"), "{page}");
        assert!(words.iter().all(|w| text.contains(w)), "{page} lacks one of {words:?}: {text}");
    }
    let own = folder.path().join("trimtab.1");
    std::fs::write(&own, "mine").unwrap();
    assert_eq!(run(&["man", "--out", folder.path().to_str().unwrap()]).status.code(), Some(2));
    assert_eq!(std::fs::read_to_string(own).unwrap(), "mine");
}

fn files(folder: &Path, ends: &[&str], found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap().flatten() {
        let path = entry.path();
        if path.is_dir() {
            files(&path, ends, found);
        } else if path.extension().is_some_and(|e| ends.iter().any(|end| e == *end)) {
            found.push(path);
        }
    }
}

/// Every text in backticks that begins with the program's name, in sources, guide and front pages.
fn pointers() -> BTreeSet<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut sources = vec![root.join("README.md")];
    files(&root.join("src"), &["rs", "md", "toml", "txt"], &mut sources);
    let mut found = BTreeSet::new();
    for source in sources {
        let text = std::fs::read_to_string(source).unwrap();
        for part in text.split("`trimtab ").skip(1) {
            let pointer = part.split('`').next().unwrap_or_default();
            if !pointer.contains(['{', '\n']) {
                found.insert(pointer.to_owned());
            }
        }
    }
    found
}

#[test]
fn every_pointer_to_a_command_a_topic_or_an_option_points_to_something() {
    let pointers = pointers();
    assert!(pointers.len() > 20 && pointers.contains("help columns"), "{pointers:?}");
    for pointer in pointers {
        let words: Vec<&str> = pointer.split_whitespace().collect();
        // A word in capitals stands for what a user puts there.
        let named: Vec<&str> =
            words.iter().copied().filter(|w| w.chars().all(|c| c.is_ascii_lowercase() || c == '_')).collect();
        let command = match &named[..] {
            ["help", rest @ ..] => {
                does(&[&["help"], rest].concat());
                continue;
            }
            ["maneuver", trial, ..]
                if ["turning", "zigzag", "stopping", "pullout", "spiral", "measure"].contains(trial) =>
            {
                vec!["help", "maneuver", trial]
            }
            [first, ..] => vec!["help", first],
            [] => continue,
        };
        let help = does(&command);
        for option in words.iter().filter(|w| w.starts_with("--")) {
            let option = option.split('=').next().unwrap_or_default();
            assert!(help.contains(option), "`trimtab {pointer}`: the help has no {option}");
        }
    }
}
