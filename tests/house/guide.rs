//! The guide: its lists are those of the types that read the files, and what it shows can be read.
//! With `TRIMTAB_WRITE_GUIDE=1` the first test writes the lists instead of comparing them.

use serde::de::DeserializeOwned;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use trimtab::diagnose::plan::PlanSettings;
use trimtab::evaluate::maneuver::ManeuverSettings;
use trimtab::guide::CHAPTERS;
use trimtab::guide::reference::{Table, listing, tables};
use trimtab::model::ModelFile;
use trimtab::{ColumnMap, EvaluationSettings, FitSettings, Model, Settings, Ship, Study};

const BEGIN: &str = "<!-- generated: TRIMTAB_WRITE_GUIDE=1 cargo test --test house guide -->\n";
const END: &str = "<!-- end -->";

fn file(chapter: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src/guide").join(format!("{chapter}.md"))
}

#[test]
fn the_lists_of_keys_in_the_chapters_are_those_of_the_types_that_read_them() {
    for chapter in CHAPTERS {
        let listing = listing(chapter.name);
        let text = std::fs::read_to_string(file(chapter.name)).unwrap();
        let Some((before, rest)) = text.split_once(BEGIN) else {
            assert!(listing.is_empty(), "{} has no place for its list", chapter.name);
            continue;
        };
        let (present, after) = rest.split_once(END).unwrap();
        if std::env::var_os("TRIMTAB_WRITE_GUIDE").is_some() {
            std::fs::write(file(chapter.name), format!("{before}{BEGIN}\n{listing}\n{END}{after}")).unwrap();
        } else {
            assert!(
                present == format!("\n{listing}\n"),
                "{}.md differs; write it with TRIMTAB_WRITE_GUIDE=1 cargo test --test house guide",
                chapter.name
            );
        }
    }
    assert!(["study", "columns", "ship", "model"].iter().all(|c| !tables(c).is_empty()));
}

/// What a reader says of a text.
fn error<T: DeserializeOwned>(text: &str) -> String {
    toml::from_str::<T>(text).err().map_or(String::new(), |e| e.message().to_owned())
}

/// The keys that the reader of a chapter's file takes in a table, as it lists them when it finds a key that it does not know.
fn taken(chapter: &str, table: &Table, path: &str) -> BTreeSet<String> {
    let place = path.replace("CHANNEL", "n").replace("NAME", "rudder.lift1");
    let (command, rest) = match place.split_once('.') {
        Some((first, rest)) => (first, rest.to_owned()),
        None => (place.as_str(), String::new()),
    };
    let of = |path: &str| match (path, table.listed) {
        ("", _) => "unheard_of = 1\n".to_owned(),
        (path, true) => format!("[[{path}]]\nunheard_of = 1\n"),
        (path, false) => format!("[{path}]\nunheard_of = 1\n"),
    };
    let at = Path::new("file.toml");
    let message = match (chapter, command) {
        ("study", "fit") => error::<FitSettings>(&of(&rest)),
        ("study", "evaluate") => error::<EvaluationSettings>(&of(&rest)),
        ("study", "diagnose") => error::<Settings>(&of(&rest)),
        ("study", "maneuver") => error::<ManeuverSettings>(&of(&rest)),
        ("study", "plan") => error::<PlanSettings>(&of(&rest)),
        ("study", _) => Study::parse(&of(&place), at).unwrap_err().to_string(),
        ("ship", _) => Ship::parse(&of(&place), at).unwrap_err().to_string(),
        ("model", _) => error::<ModelFile>(&of(&place)),
        _ => ColumnMap::parse(&of(&place), at).unwrap_err().to_string(),
    };
    assert!(message.contains("`unheard_of`"), "{chapter} {path}: {message}");
    let line = message.lines().find(|line| line.contains("`unheard_of`")).unwrap_or_default();
    let listed = line.split_once("the keys here are ").or_else(|| line.split_once("expected"));
    let (_, expected) = listed.unwrap_or_else(|| panic!("{chapter} {path}: {message}"));
    // A sentence may follow that says where keys of other tables stand.
    let expected = expected.split(';').next().unwrap_or_default();
    expected.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

#[test]
fn the_reference_has_the_keys_that_the_readers_take_and_no_other() {
    for chapter in ["study", "ship", "model", "columns"] {
        let tables = tables(chapter);
        assert!(tables.len() > 2, "{chapter}");
        for table in &tables {
            let listed: BTreeSet<String> = table.keys.iter().map(|key| key.name.clone()).collect();
            for path in &table.paths {
                assert_eq!(listed, taken(chapter, table, path), "{chapter} [{path}]");
            }
        }
    }
    // The cells of a table of runs are the keys of an entry.
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("runs.csv"), "file,unheard_of\na.csv,1\n").unwrap();
    let text = "name = \"a\"\nship = \"s\"\nmodel = \"m\"\nruns = \"runs.csv\"\n";
    let message = Study::parse(text, &folder.path().join("study.toml")).unwrap_err().to_string();
    let (_, columns) = message.rsplit_once("columns are ").unwrap();
    let columns: BTreeSet<String> = columns.split(", ").map(str::to_owned).collect();
    let runs = tables("study").into_iter().find(|t| t.paths == ["runs"]).unwrap();
    assert_eq!(columns, runs.keys.into_iter().map(|key| key.name).collect());
}

/// The blocks of a language in a chapter.
fn blocks<'a>(text: &'a str, language: &str) -> Vec<&'a str> {
    let begin = format!("```{language}\n");
    text.split(begin.as_str()).skip(1).map(|rest| rest.split("```").next().unwrap()).collect()
}

#[test]
fn every_file_shown_in_the_guide_can_be_read() {
    let ship = trimtab::study::demo::example().unwrap().model.ship;
    let (at, mut read) = (Path::new("file.toml"), 0);
    for chapter in CHAPTERS {
        for block in blocks(chapter.text, "toml") {
            read += 1;
            let name = chapter.name;
            if block.contains("[hull]") {
                Ship::parse(block, at).unwrap_or_else(|e| panic!("{name}: {e}"));
            } else if block.contains("ship =") {
                let study = Study::parse(block, at).unwrap_or_else(|e| panic!("{name}: {e}"));
                assert!(!study.runs.is_empty());
            } else if block.contains("name =") {
                Model::parse(block, at, ship.clone()).unwrap_or_else(|e| panic!("{name}: {e}"));
            } else {
                ColumnMap::parse(block, at).unwrap_or_else(|e| panic!("{name}: {e}"));
            }
        }
    }
    assert!(read >= 6, "{read}");
}

/// The intervals of a text, each with the number before it: `63 % [51, 74]`.
fn intervals(text: &str) -> BTreeSet<String> {
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let is_number = |s: &str| s.trim().parse::<f64>().is_ok();
    let of = |(at, _): (usize, &str)| {
        let inside = words[at + 1..].split_once(']')?.0;
        let ends: Vec<&str> = inside.split(',').collect();
        let value = words[..at].trim_end().rsplit(' ').take(2).collect::<Vec<_>>();
        let value = value.into_iter().rev().collect::<Vec<_>>().join(" ");
        (ends.len() == 2 && ends.into_iter().all(is_number)).then(|| format!("{value} [{inside}]"))
    };
    words.match_indices('[').filter_map(of).collect()
}

#[test]
fn every_interval_of_the_front_page_stands_in_the_whole_tables() {
    let read = |name: &str| std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(name)).unwrap();
    let (front, whole) = (intervals(&read("README.md")), intervals(&read("figures/README.md")));
    let stale: Vec<&String> = front.difference(&whole).collect();
    assert!(front.len() > 10 && stale.is_empty(), "not in figures/README.md: {stale:?}");
}
