//! TOML read into a type: all mistakes of a file in one go, each with its line.
//! After a mistake the entry is set aside and the rest is read again, so that the next one is found.

use super::kind::Kind;
use super::mistake::{Mistake, line_at};
use super::place::{Step, entry_at, take, value_at};
use super::{syntax, words};
use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Deserializer};

/// Most mistakes that are reported at once.
const MOST: usize = 20;

/// Reads a file of this kind.
///
/// # Errors
/// Every mistake, or the one that the file is of another kind.
pub fn read_toml<T: DeserializeOwned>(text: &str, kind: Kind) -> Result<T, Vec<Mistake>> {
    let (root, errors) = DeTable::parse_recoverable(text);
    let wrong = match errors.as_slice() {
        [] => match read_all(text, root.clone()) {
            Ok(value) => return Ok(value),
            Err(mistakes) => mistakes,
        },
        errors => syntax::mistakes(text, errors),
    };
    Err(kind.instead(text, root.get_ref()).map_or(wrong, |instead| vec![Mistake::new(1, instead)]))
}

/// Reads the tables of a file of this kind that may be incomplete: what is in them is not looked at.
///
/// # Errors
/// It is no TOML, or of another kind.
pub fn read_tables(text: &str, kind: Kind) -> Result<toml::Table, Vec<Mistake>> {
    let tables = read_toml(text, kind)?;
    let (root, _) = DeTable::parse_recoverable(text);
    kind.instead(text, root.get_ref()).map_or(Ok(tables), |instead| Err(vec![Mistake::new(1, instead)]))
}

/// Reads the table of this name at the top of a file; one that is not there is empty.
///
/// # Errors
/// Every mistake in it.
pub fn section<T: DeserializeOwned>(text: &str, name: &str) -> Result<T, Vec<Mistake>> {
    let (mut root, errors) = DeTable::parse_recoverable(text);
    if !errors.is_empty() {
        return Err(syntax::mistakes(text, &errors));
    }
    let whole = root.span();
    let value = root.get_mut().remove(name).unwrap_or_else(|| Spanned::new(whole, DeValue::Table(DeTable::new())));
    let span = value.span();
    match value.into_inner() {
        DeValue::Table(table) => read_all(text, Spanned::new(span, table)),
        _ => Err(vec![Mistake::new(line_at(text, span.start), format!("`{name}` must be a table, [{name}]"))]),
    }
}

/// Reads a table, setting aside what is wrong until nothing more is found.
fn read_all<T: DeserializeOwned>(text: &str, root: Spanned<DeTable<'_>>) -> Result<T, Vec<Mistake>> {
    let span = root.span();
    let mut rest = DeValue::Table(root.into_inner());
    let (mut mistakes, mut aside): (Vec<Mistake>, Vec<Vec<Step>>) = (Vec::new(), Vec::new());
    while mistakes.len() < MOST {
        let DeValue::Table(table) = rest.clone() else { break };
        let error = match T::deserialize(Deserializer::from(Spanned::new(span.clone(), table.clone()))) {
            Ok(value) if mistakes.is_empty() => return Ok(value),
            Ok(_) => break,
            Err(error) => error,
        };
        let message = error.message().trim().replace('\n', " ");
        let place = error.span().unwrap_or(span.clone());
        let way = if place == span { Vec::new() } else { entry_at(&table, &place) };
        if let Some(key) = words::missing(&message) {
            // What was set aside is missing for that reason alone.
            let known = aside.iter().any(|taken| {
                taken.split_last().is_some_and(|(last, before)| before == way && *last == Step::Key(key.into()))
            });
            if !known {
                mistakes.push(missing(line_at(text, place.start), key, &way));
            }
            // A text in its place, to see whether more is missing.
            if !stand_in(&mut rest, &way, key) {
                break;
            }
            continue;
        }
        // An error of a text that stands in for a missing value is none of the file.
        if place.is_empty() && place.start == usize::MAX {
            break;
        }
        mistakes.push(mistake(line_at(text, place.start), &message, &way));
        let taken = take(&mut rest, &way);
        aside.push(way);
        if !taken {
            break;
        }
    }
    let misspelt: Vec<String> = mistakes.iter().filter_map(|m| meant(&m.message)).collect();
    // A key that is misspelt is missing for that reason alone.
    mistakes.retain(|m| words::missing_told(&m.message).is_none_or(|key| !misspelt.iter().any(|meant| meant == key)));
    mistakes.sort_by_key(|m| m.line);
    Err(mistakes)
}

/// The name that a message takes another for.
fn meant(message: &str) -> Option<String> {
    let (_, rest) = message.split_once("did you mean `")?;
    Some(rest.split('`').next()?.to_owned())
}

/// Puts a text where a value is missing.
fn stand_in(root: &mut DeValue<'_>, way: &[Step], key: &str) -> bool {
    let Some(DeValue::Table(table)) = value_at(root, way) else { return false };
    let nowhere = usize::MAX..usize::MAX;
    let name = Spanned::new(nowhere.clone(), std::borrow::Cow::Owned(key.to_owned()));
    table.insert(name, Spanned::new(nowhere, DeValue::String(std::borrow::Cow::Owned(String::new())))).is_none()
}

/// The mistake of a key that is not there.
fn missing(line: usize, key: &str, way: &[Step]) -> Mistake {
    let place = dotted(way).map_or(String::new(), |table| format!(" in `{table}`"));
    Mistake::new(line, words::missing_key(key, &place))
}

/// The mistake of an entry.
fn mistake(line: usize, message: &str, way: &[Step]) -> Mistake {
    let key = dotted(way);
    match words::unknown(message) {
        Some(unknown) if unknown.is_key => {
            Mistake { line, message: unquoted(&unknown, way), unknown: Some(unknown.found.to_owned()) }
        }
        Some(unknown) => {
            let of = key.map_or(String::new(), |key| format!("`{key}`: "));
            Mistake::new(line, of + &unknown.joined())
        }
        None => Mistake::new(line, words::plain(message, key.as_deref()) + quotes(message, way)),
    }
}

/// An unknown key; below a table of dotted names it is the second half of a name without its quotes.
fn unquoted(unknown: &words::Unknown<'_>, way: &[Step]) -> String {
    match way {
        [Step::Key(table), Step::Key(first), Step::Key(second)] if table == "parameters" && !first.contains('.') => {
            format!("write the name in quotes, as in \"{first}.{second}\" = ..., for it has a point in it")
        }
        _ => unknown.joined(),
    }
}

/// The same where a number was expected and the half of a name was found.
fn quotes(message: &str, way: &[Step]) -> &'static str {
    let named = matches!(way, [Step::Key(table), Step::Key(name)] if table == "parameters" && !name.contains('.'));
    if named && message.contains("map, expected f64") {
        "; a name with a point in it stands in quotes, as in \"rudder.lift1\" = 0.9"
    } else {
        ""
    }
}

/// The keys on the way, joined by points; nothing at the root.
fn dotted(way: &[Step]) -> Option<String> {
    let keys = way.iter().filter_map(|step| match step {
        Step::Key(key) => Some(key.as_str()),
        Step::Index(_) => None,
    });
    Some(keys.collect::<Vec<_>>().join(".")).filter(|keys| !keys.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::Deserialize;
    use std::collections::BTreeMap;

    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    #[allow(dead_code)]
    struct File {
        name: String,
        ship: String,
        step: Option<f64>,
        #[serde(default)]
        fit: Fit,
        #[serde(default)]
        runs: Vec<Run>,
        #[serde(default)]
        parameters: BTreeMap<String, f64>,
    }

    #[derive(Default, Deserialize)]
    #[serde(deny_unknown_fields, default)]
    #[allow(dead_code)]
    struct Fit {
        steps: usize,
    }

    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    #[allow(dead_code)]
    struct Run {
        file: String,
        from: Option<f64>,
    }

    fn wrong(text: &str) -> Vec<(usize, String)> {
        let mistakes = read_toml::<File>(text, Kind::Study).err().unwrap_or_default();
        mistakes.into_iter().map(|m| (m.line, m.message)).collect()
    }

    #[test]
    fn every_mistake_of_a_file_is_found_at_once() {
        let text = "name = \"a\"\nship = \"b\"\nstep = \"1 s\"\nstpe = 2\n[fit]\nsteps = -1\nstesp = 3\n[[runs]]\nfile = \"a\"\nfrom = \"b\"\n[[runs]]\nfrom = 1\n";
        let found = wrong(text);
        let lines: Vec<usize> = found.iter().map(|(line, _)| *line).collect();
        assert_eq!(lines, [3, 4, 6, 7, 10, 11], "{found:?}");
        for ((_, message), words) in found.iter().zip([
            "`step`: found the text \"1 s\"",
            "unknown key `stpe`, did you mean `step`?",
            "`fit.steps`: found the number `-1`",
            "did you mean `steps`?",
            "`runs.from`: found the text",
            "the key `file` is missing in `runs`",
        ]) {
            assert!(message.contains(words), "{message}\n{words}");
        }
        assert!(wrong("name = \"a\"\nship = \"b\"\n[[runs]]\nfile = \"a\"\n").is_empty());
    }

    #[test]
    fn all_that_is_missing_is_found_and_a_wrong_value_is_not_missing() {
        let messages = |text: &str| wrong(text).into_iter().map(|(_, m)| m).collect::<Vec<_>>();
        assert_eq!(
            messages("step = 1.0\n"),
            ["the key `name` is missing; add it", "the key `ship` is missing; add it"]
        );
        let found = messages("name = 3\nship = \"b\"\n");
        assert!(found.len() == 1 && found[0].starts_with("`name`: found the number `3`"), "{found:?}");
        let found = messages("name = \"a\"\nshp = \"b\"\n");
        assert!(found.len() == 1 && found[0].contains("did you mean `ship`?"), "{found:?}");
    }

    #[test]
    fn a_file_of_another_kind_is_reported_as_such() {
        for (text, words) in [
            ("[hull]\nlpp = 1\n", "this is a ship file, not a study"),
            ("terms = [\"wind\"]\n", "this is a model file, not a study"),
            ("t [s],x [m],y [m]\n0,1,2\n", "this is a table of values (CSV), not a study"),
            ("{\"a\": 1}\n", "this is a JSON file, not a study"),
            ("[columns]\nn = 1\n", "this is a column map, not a study"),
        ] {
            let found = wrong(text);
            assert!(found.len() == 1 && found[0].1.contains(words), "{found:?}");
        }
    }

    #[test]
    fn an_incomplete_file_is_read_and_one_of_another_kind_is_not() {
        assert!(read_tables("name = \"a\"\n", Kind::Ship).is_ok_and(|tables| tables.len() == 1));
        let wrong = read_tables("terms = []\n", Kind::Ship).err().map(|m| m[0].message.clone());
        assert!(wrong.is_some_and(|message| message.contains("this is a model file, not a ship file")));
    }

    #[test]
    fn a_dotted_name_without_quotes_is_reported() {
        let text = "name = \"a\"\nship = \"b\"\n[parameters]\nrudder.lift1 = 2.0\n";
        let found = read_toml::<File>(text, Kind::Model).err().unwrap_or_default();
        assert!(found.len() == 1 && found[0].message.contains("stands in quotes"), "{found:?}");
    }

    #[test]
    fn a_section_is_read_with_the_lines_of_its_file() {
        let text = "name = \"a\"\n[fit]\nsteps = 1\n[other]\nsteps = -3\n";
        assert_eq!(section::<Fit>(text, "fit").map(|f| f.steps).ok(), Some(1));
        assert_eq!(section::<Fit>(text, "none").map(|f| f.steps).ok(), Some(0));
        assert_eq!(section::<Fit>(text, "other").err().map(|m| m[0].line), Some(5));
    }
}
