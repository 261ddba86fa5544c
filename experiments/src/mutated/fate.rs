//! What becomes of a logger's fault: refused, reported, not visible in the estimates, or silent although they moved.
//! How commands are run is in `runner`, which faults there are in `logger`.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use serde::{Deserialize, Serialize};
use trimtab::report::Table;

use super::answer::told;
use super::files::write;
use super::logger::{Fault, faults};
use super::runner::Runner;
use crate::conceal::error::ConcealError;
use crate::rows::Rows;

/// The commands that are asked, in the order in which a user asks them.
const ASKED: [&str; 3] = ["check", "fit", "diagnose"];

/// What becomes of a fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, Default)]
#[serde(rename_all = "snake_case")]
pub enum Fate {
    /// A command refuses the study.
    Refused,
    /// A command says in its first lines what it does not say of the sound study.
    Told,
    /// No estimate moves by more than a standard error.
    NotVisible,
    /// An estimate moves, without a word.
    #[default]
    Silent,
}

/// A row of the results.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct FaultRow {
    /// The kind of fault.
    pub kind: String,
    /// What was done.
    pub what: String,
    /// What became of it.
    pub fate: Fate,
    /// The first command that refuses or reports it.
    pub by: String,
    /// By how many standard errors the estimate that moved most moved; absent where there is no fit.
    pub moved: Option<f64>,
    /// The first line that reports it.
    pub line: String,
}

/// A line without its numbers: the same doubt of a sound study has others.
fn without_numbers(line: &str) -> String {
    line.chars().filter(|c| !c.is_ascii_digit() && !".+-".contains(*c)).collect()
}

/// What commands say of the sound study, by command.
pub struct Known(BTreeMap<&'static str, BTreeSet<String>>);

impl Known {
    /// Asks every command about the sound study.
    ///
    /// # Errors
    /// A program that cannot be started.
    pub fn new(runner: &Runner) -> Result<Self, ConcealError> {
        let said = |command: &'static str| {
            let (_, text) = runner.text(&runner.sound_folder(), command)?;
            Ok((command, told(&text).iter().map(|line| without_numbers(line)).collect()))
        };
        Ok(Self(ASKED.into_iter().map(said).collect::<Result<_, ConcealError>>()?))
    }
}

/// What becomes of a fault.
///
/// # Errors
/// A folder that cannot be written, or a program that cannot be started.
pub fn fate(runner: &Runner, known: &Known, number: usize, fault: &Fault) -> Result<FaultRow, ConcealError> {
    let folder = runner.folder_of(&format!("fault {number}"));
    write(&fault.files, &folder).map_err(|source| ConcealError::file(&folder, source))?;
    let (mut refused, mut said) = (None, None);
    for command in ASKED {
        let (ended, text) = runner.text(&folder, command)?;
        let new = told(&text).into_iter().find(|line| !known.0[command].contains(&without_numbers(line)));
        if !matches!(ended.code, Some(0 | 1)) {
            refused = refused.or(Some((command, text.lines().next().unwrap_or_default().to_owned())));
        } else if let Some(line) = new {
            said = said.or(Some((command, line)));
        }
    }
    let moved = runner.fit_moved(&folder)?;
    let silent = if moved.is_some_and(|m| m <= 1.0) { Fate::NotVisible } else { Fate::Silent };
    let (fate, (by, line)) = match (refused, said) {
        (Some(refused), _) => (Fate::Refused, refused),
        (None, Some(said)) => (Fate::Told, said),
        (None, None) => (silent, ("", String::new())),
    };
    let _ = std::fs::remove_dir_all(&folder);
    Ok(FaultRow { kind: fault.kind.to_owned(), what: fault.what.clone(), fate, by: by.to_owned(), moved, line })
}

/// Asks about every fault, or one of so many, and writes a row of each to a file.
///
/// # Errors
/// As [`fate`], and a file that cannot be written.
pub fn all(runner: &Runner, every: usize, path: &Path) -> Result<Vec<FaultRow>, ConcealError> {
    let results: Rows<FaultRow> = Rows::open(path)?;
    let known = Known::new(runner)?;
    let mut rows = Vec::new();
    for (number, fault) in faults(runner.sound()).iter().enumerate().step_by(every.max(1)) {
        let row = fate(runner, &known, number, fault)?;
        results.append(&row)?;
        rows.push(row);
    }
    Ok(rows)
}

/// Counts by kind.
pub fn table(rows: &[FaultRow]) -> Table {
    let mut table = Table::new(["fault", "faults", "refused", "told", "not visible", "silent"]);
    let mut kinds: BTreeMap<&str, Vec<&FaultRow>> = BTreeMap::new();
    rows.iter().for_each(|row| kinds.entry(&row.kind).or_default().push(row));
    kinds.insert("~ all", rows.iter().collect());
    for (kind, rows) in kinds {
        let count = |fate: Fate| rows.iter().filter(|row| row.fate == fate).count().to_string();
        let counts = [Fate::Refused, Fate::Told, Fate::NotVisible, Fate::Silent].map(count);
        table.row([kind.to_owned(), rows.len().to_string()].into_iter().chain(counts));
    }
    table
}
