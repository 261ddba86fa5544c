//! The rules of the house, read from the source: arrows point down, no circle of files, no long function, no ship in `ad`, a true map.
//! Files that still break a rule are listed here by name; the list must match exactly, so that it can only become shorter.

use crate::graph::Graph;
use crate::source::{code_lines, read};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Modules of the library from the bottom up: a module uses its own line and those before it.
const LAYERS: [&[&str]; 14] = [
    &["ship", "files", "numbers"],
    &["physics"],
    &["terms"],
    &["model"],
    &["simulate"],
    &["recording", "study"],
    &["ipopt", "likelihood"],
    &["fit"],
    &["evaluate"],
    &["diagnose"],
    &["report"],
    &["guide"],
    &["cli"],
    &["main"],
];

/// Lines a function may have.
const LONGEST: usize = 80;

/// Files that still use what is above them: from, to.
const UPWARD: &[(&str, &str)] = &[];

/// Files that still use each other in circles.
const CIRCLES: &[&[&str]] = &[];

/// Functions that are still too long: file, name.
const LONG: &[(&str, &str)] = &[];

/// Files that a folder may have before it needs folders.
const FULLEST: usize = 15;

/// Folders that have more.
const FULL: &[&str] = &["python/src"];

/// Public modules at the root of the library.
const FRONT: usize = 15;

fn repository() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Files of a folder and those below it that end in `.rs`, relative to the repository.
fn sources(folder: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut open: Vec<PathBuf> = vec![repository().join(folder)];
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            let path = entry.path();
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") {
                let relative = path.strip_prefix(repository()).unwrap();
                found.push(relative.to_string_lossy().replace('\\', "/"));
            }
        }
    }
    found.sort();
    found
}

fn text(file: &str) -> String {
    std::fs::read_to_string(repository().join(file)).unwrap()
}

/// The graphs of all crates: the library, the command, the numbers and the experiments.
fn graphs() -> [Graph; 4] {
    ["src/lib.rs", "src/main.rs", "ad/src/lib.rs", "experiments/src/lib.rs"].map(|root| Graph::of(repository(), root))
}

/// Compares what was found with what is listed, and says what to do about either difference.
fn assert_listed<T: Ord + std::fmt::Debug>(rule: &str, found: BTreeSet<T>, listed: BTreeSet<T>) {
    let lines = |items: &mut dyn Iterator<Item = &T>| items.map(|i| format!("    {i:?},\n")).collect::<String>();
    let (new, mended) = (lines(&mut found.difference(&listed)), lines(&mut listed.difference(&found)));
    assert!(
        new.is_empty() && mended.is_empty(),
        "{rule}\nbroken here, to be mended:\n{new}mended, to be struck from the list in tests/house/rules.rs:\n{mended}"
    );
}

/// `src/fit/cost.rs` belongs to `fit`, `src/model/mod.rs` to `model`.
fn module_of(file: &str) -> &str {
    let inner = file.strip_prefix("src/").unwrap_or(file);
    inner.split('/').next().unwrap_or(inner).trim_end_matches(".rs")
}

fn layer_of(file: &str) -> usize {
    let module = module_of(file);
    let layer = LAYERS.iter().position(|l| l.contains(&module));
    layer.unwrap_or_else(|| panic!("{file}: `{module}` is in no layer; add it to LAYERS in tests/house/rules.rs"))
}

#[test]
fn arrows_point_down() {
    let mut found = BTreeSet::new();
    for graph in &graphs()[..2] {
        for (from, used) in graph.files.iter().zip(&graph.uses).filter(|(f, _)| *f != "src/lib.rs") {
            for to in used.iter().map(|t| &graph.files[*t]).filter(|t| layer_of(t) > layer_of(from)) {
                found.insert((from.clone(), to.clone()));
            }
        }
    }
    let listed = UPWARD.iter().map(|(a, b)| ((*a).to_owned(), (*b).to_owned())).collect();
    assert_listed("a file uses only its own layer and those below", found, listed);
}

#[test]
fn no_files_use_each_other_in_a_circle() {
    let found = graphs().iter().flat_map(Graph::circles).collect();
    let listed = CIRCLES.iter().map(|c| c.iter().map(|f| (*f).to_owned()).collect()).collect();
    assert_listed("files do not use each other in a circle", found, listed);
}

#[test]
fn terms_and_physics_do_not_know_of_fits_or_diagnoses() {
    let graph = &graphs()[0];
    let mut found = BTreeSet::new();
    for (i, file) in graph.files.iter().enumerate() {
        if ["terms", "physics"].contains(&module_of(file)) {
            let reached = graph.reachable(i).into_iter().map(|t| module_of(&graph.files[t]));
            found.extend(reached.filter(|m| ["fit", "ipopt", "evaluate", "diagnose"].contains(m)).map(|m| (file, m)));
        }
    }
    assert_eq!(found, BTreeSet::new(), "what a term is must not depend on what is done with it");
}

#[test]
fn no_function_is_too_long() {
    let mut found = BTreeSet::new();
    for file in
        ["src", "ad", "experiments", "python/src", "tests", "benches", "examples"].iter().flat_map(|f| sources(f))
    {
        for (name, lines) in read(&text(&file)).functions {
            if lines > LONGEST {
                found.insert((file.clone(), name));
            }
        }
    }
    let listed = LONG.iter().map(|(a, b)| ((*a).to_owned(), (*b).to_owned())).collect();
    assert_listed("no function has more than 80 lines", found, listed);
}

#[test]
fn no_folder_is_too_full() {
    let mut files: BTreeMap<String, usize> = BTreeMap::new();
    for file in ["src", "ad", "experiments", "python/src", "tests"].iter().flat_map(|f| sources(f)) {
        let folder = file.rsplit_once('/').map_or("", |(folder, _)| folder);
        *files.entry(folder.to_owned()).or_default() += 1;
    }
    let found = files.into_iter().filter(|(_, n)| *n > FULLEST).map(|(folder, _)| folder).collect();
    assert_listed("no folder has more than 15 files", found, FULL.iter().map(|f| (*f).to_owned()).collect());
}

#[test]
fn few_modules_are_at_the_front() {
    let front = text("src/lib.rs").lines().filter(|l| l.starts_with("pub mod ")).count();
    assert!((1..=FRONT).contains(&front), "{front} public modules at the root; put some below others");
}

#[test]
fn the_numbers_know_no_ship() {
    let manifest: toml::Table = text("ad/Cargo.toml").parse().unwrap();
    let dependencies = manifest["dependencies"].as_table().unwrap();
    assert!(!dependencies.contains_key("trimtab"), "ad must not depend on the ship");
    for file in sources("ad/src") {
        let names = read(&text(&file)).names;
        let ship: Vec<&String> = names
            .iter()
            .filter(|n| ["ship", "hull", "rudder", "propeller"].iter().any(|w| n.to_lowercase().contains(w)))
            .collect();
        assert!(ship.is_empty(), "{file} names {ship:?}");
    }
}

#[test]
fn the_size_of_the_house_is_printed() {
    for (name, folder) in
        [("src", "src"), ("experiments", "experiments/src"), ("ad", "ad/src"), ("python", "python/src")]
    {
        let mut parts: BTreeMap<String, usize> = BTreeMap::new();
        for file in sources(folder) {
            let inner = file.strip_prefix(&format!("{folder}/")).unwrap();
            *parts.entry(inner.split('/').next().unwrap().to_owned()).or_default() += code_lines(&text(&file));
        }
        let total: usize = parts.values().sum();
        assert!(total > 0, "{folder} has no code");
        println!("{name}: {total} lines of code, neither blank nor comment");
        for (part, lines) in parts {
            println!("  {part:24} {lines:6}");
        }
    }
}

/// The places in the first column of the map of the code: the text in backticks of each row of the table.
fn places(map: &str) -> Vec<&str> {
    let rows = map.lines().skip_while(|line| !line.starts_with("| place |")).skip(2);
    let first = rows.take_while(|line| line.starts_with('|')).filter_map(|line| line.split('|').nth(1));
    first.flat_map(|cell| cell.split('`').skip(1).step_by(2)).collect()
}

#[test]
fn the_map_of_the_code_names_places_that_exist_and_every_folder_of_the_source() {
    let map = text("CONTRIBUTING.md");
    let places = places(&map);
    let absent: Vec<&&str> = places
        .iter()
        .filter(|place| {
            if place.ends_with('/') { !repository().join(place).is_dir() } else { !repository().join(place).is_file() }
        })
        .collect();
    assert!(places.len() > 20 && absent.is_empty(), "in the map of CONTRIBUTING.md, but not there: {absent:?}");
    let folders = std::fs::read_dir(repository().join("src")).unwrap().map(|entry| entry.unwrap().path());
    let folders = folders.filter(|path| path.is_dir()).map(|path| path.file_name().unwrap().to_owned());
    let missing: Vec<String> = folders
        .map(|name| format!("src/{}/", name.to_string_lossy()))
        .filter(|folder| !places.contains(&folder.as_str()))
        .collect();
    assert!(missing.is_empty(), "not in the map of CONTRIBUTING.md: {missing:?}");
}
