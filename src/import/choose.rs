//! Which column is taken for what: as the user says, as the format says, as its name says.
//! Of several columns for one quantity one is taken and the others are told.

use super::error::ImportError;
use super::log::{Column, Log, Meaning};
use super::names::{is_second_choice, is_shaft, is_unit, meaning};
use crate::error::suggestion;
use crate::recording::{CHANNELS, Channel, Quantity};
use std::collections::BTreeMap;

/// What a column of revolutions is.
const SHAFT: Meaning = Meaning::Channel(Channel::N);

/// What the user says of the columns.
#[derive(Clone, Debug, Default)]
pub struct Choices {
    /// Column name by quantity (`psi`, `lat`, ...); `t` for the time.
    pub columns: BTreeMap<String, String>,
    /// Unit by quantity.
    pub units: BTreeMap<String, String>,
}

impl Choices {
    /// Checks that each quantity there is, and each unit of it.
    ///
    /// # Errors
    /// [`ImportError::Choice`].
    pub fn check(&self) -> Result<(), ImportError> {
        let known = || {
            let beside = super::log::BESIDE_CHANNELS.iter().map(|(name, ..)| *name);
            CHANNELS.iter().map(|c| c.name).chain(beside)
        };
        let all = self.columns.keys().map(|k| ("--column", k)).chain(self.units.keys().map(|k| ("--unit", k)));
        for (flag, name) in all {
            if !known().any(|k| k == name) {
                let near = suggestion(name, known());
                let list = known().collect::<Vec<_>>().join(", ");
                return Err(ImportError::Choice(format!(
                    "{flag} {name}=...: there is no `{name}`{near}; there are {list}"
                )));
            }
        }
        for (name, unit) in &self.units {
            let quantity = Meaning::from_name(name).map_or(Quantity::Time, Meaning::quantity);
            if quantity.factor(unit).is_none() {
                let choices = quantity.choices();
                return Err(ImportError::Choice(format!(
                    "--unit {name}={unit}: `{unit}` is none of {choices}; pass one of them"
                )));
            }
        }
        Ok(())
    }
}

/// A column that was not used.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Unused {
    /// Its name.
    pub column: String,
    /// Why, and the flag to use it.
    pub why: String,
}

/// The columns of one quantity: one name, in one file or several.
pub type Chosen<'a> = BTreeMap<Meaning, Vec<&'a Column>>;

/// The columns that are taken, by what they are, and those that are not.
///
/// # Errors
/// [`ImportError::Choice`] for a column that no file has.
pub fn choose<'a>(logs: &'a [Log], choices: &Choices) -> Result<(Chosen<'a>, Vec<Unused>), ImportError> {
    let all = || logs.iter().flat_map(|log| &log.columns);
    let mut forced: BTreeMap<String, Meaning> = BTreeMap::new();
    for (name, column) in &choices.columns {
        let Some(meaning) = Meaning::from_name(name) else { continue };
        let Some(found) = all().find(|c| c.name.eq_ignore_ascii_case(column)) else {
            let names = distinct(all().map(|c| c.name.as_str()));
            let near = suggestion(column, names.iter().copied());
            let list = names.join(", ");
            return Err(ImportError::Choice(format!(
                "--column {name}={column}: no file has a column `{column}`{near}; there are {list}"
            )));
        };
        forced.insert(found.name.clone(), meaning);
    }
    let mut candidates: BTreeMap<Meaning, Vec<&str>> = BTreeMap::new();
    let mut unused = Vec::new();
    for name in distinct(all().map(|c| c.name.as_str())) {
        let first = all().find(|c| c.name == name);
        let unit = first.and_then(|c| c.unit.as_deref());
        let shaft =
            || (is_shaft(name) && unit.is_some_and(|u| Quantity::Rotation.factor(u).is_some())).then_some(SHAFT);
        let by_name = meaning(name).filter(|meaning| unit.is_none_or(|unit| fits(*meaning, unit))).or_else(shaft);
        match forced.get(name).copied().or(first.and_then(|c| c.meaning)).or(by_name) {
            Some(meaning) => candidates.entry(meaning).or_default().push(name),
            None => unused.push(Unused { column: name.to_owned(), why: "nothing here uses it".to_owned() }),
        }
    }
    let mut chosen = Chosen::new();
    for (meaning, names) in candidates {
        let samples = |name: &str| all().filter(|c| c.name == name).map(|c| c.v.len()).sum::<usize>();
        let most = names.iter().map(|n| samples(n)).max().unwrap_or(0);
        let rank = |name: &&str| {
            let wanted = forced.get(*name) == Some(&meaning);
            let moves = all().filter(|c| c.name == **name).any(|c| c.v.iter().any(|v| *v != c.v[0]));
            (wanted, 5 * samples(name) > most, moves, !is_second_choice(name))
        };
        // The first of the best.
        let Some(best) = names.iter().rev().copied().max_by_key(rank) else { continue };
        for name in names.iter().filter(|n| **n != best) {
            let why = format!(
                "`{best}` is taken for {}; the other with `--column {}={name}`",
                meaning.words(),
                meaning.name()
            );
            unused.push(Unused { column: (*name).to_owned(), why });
        }
        chosen.insert(meaning, all().filter(|c| c.name == best).collect());
    }
    Ok((chosen, unused))
}

/// Whether a quantity may be measured in a unit: a rudder in deg/s is no rudder angle. A spelling that is no unit says nothing, nor does
/// `ms`, which is written for m/s too.
fn fits(meaning: Meaning, unit: &str) -> bool {
    meaning.quantity().factor(unit).is_some() || !is_unit(unit) || Quantity::Time.factor(unit).is_some()
}

fn distinct<'a>(names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut found: Vec<&str> = Vec::new();
    for name in names {
        if !found.contains(&name) {
            found.push(name);
        }
    }
    found
}
