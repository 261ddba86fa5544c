//! The lists of keys in the guide, written from the schemas of the files, the channels, the units and the keys of a diagnosis.
//! A test compares them with the chapters, and can write them there; the readers themselves are elsewhere.

use super::schema::schema;
use crate::diagnose::settings::{Number, VERDICT};
use crate::recording::{CHANNELS, ChannelInfo, Quantity, UNITS};
use crate::report::diagnosis::keys;
use serde_json::{Map, Value};
use std::fmt::Write;

/// A table of a file: its keys in the order of the list, those that it must have first.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Dotted paths in the file at which it may be, one empty for the top level: `fit.constraints`, `columns.CHANNEL`,
    /// `parameters."NAME"`.
    pub paths: Vec<String>,
    /// Whether it is an entry of a list, written `[[path]]`.
    pub listed: bool,
    /// What the table is for.
    pub about: String,
    /// Its keys.
    pub keys: Vec<Key>,
}

/// A key of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Key {
    /// Its name.
    pub name: String,
    /// What values it takes.
    pub kind: String,
    /// Whether a file must have it.
    pub required: bool,
    /// Its value where it is left out, if that is a value.
    pub default: Option<String>,
    /// What it means.
    pub about: String,
}

/// The tables of the file that a chapter is about; none for a chapter without a file.
pub fn tables(chapter: &str) -> Vec<Table> {
    let mut tables = Vec::new();
    if let Some(schema) = schema(chapter) {
        collect("", &schema, false, &mut tables);
    }
    tables
}

/// The generated part of a chapter in Markdown; empty where it has none.
pub fn listing(chapter: &str) -> String {
    match chapter {
        "channels" => channels(),
        "answer" => {
            let keys: String = keys().map(|(key, meaning)| format!("- `{key}`: {}\n", escaped(meaning))).collect();
            format!("{keys}\n## The numbers on which a verdict turns\n\n{}", numbers())
        }
        _ => tables(chapter).iter().map(markdown).collect::<Vec<_>>().join("\n"),
    }
}

/// The numbers with which a diagnosis compares its tests: value, meaning, and how each was set.
fn numbers() -> String {
    let line = |n: &Number| format!("- `{}` = {}: {} Set by: {}.\n", n.name, plain(n.value), n.meaning, n.origin);
    VERDICT.iter().map(line).collect()
}

/// A number as it is written in the source: small ones with an exponent.
fn plain(value: f64) -> String {
    if value < 1e-3 { format!("{value:e}") } else { value.to_string() }
}

/// Adds the table that a schema describes, and those inside it.
fn collect(path: &str, schema: &Value, listed: bool, tables: &mut Vec<Table>) {
    let below = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
    let Some(properties) = schema["properties"].as_object() else { return };
    if path == "columns" {
        // One for all channels.
        let column = properties.values().next().map_or(Vec::new(), inner);
        return column.into_iter().for_each(|(one, _)| collect("columns.CHANNEL", one, false, tables));
    }
    // The coefficients of a ship are names, without meanings of their own.
    if properties.values().any(|p| p.get("description").is_some()) {
        let found = table(path, schema, properties, listed);
        match tables.iter_mut().find(|t| t.keys == found.keys) {
            Some(same) => same.paths.extend(found.paths),
            None => tables.push(found),
        }
    }
    for (key, property) in properties {
        for (one, listed) in inner(property) {
            collect(&below(key), one, listed, tables);
        }
        if let Some(each) = property.get("additionalProperties").filter(|v| v.is_object()) {
            let name = format!("{}.\"NAME\"", below(key));
            inner(each).into_iter().for_each(|(one, _)| collect(&name, one, false, tables));
        }
    }
}

/// What may contain a table, and whether it is an entry of a list: the value itself, one of its forms, or an entry of either.
fn inner(schema: &Value) -> Vec<(&Value, bool)> {
    let forms = schema["anyOf"].as_array().into_iter().flatten();
    let mut found: Vec<(&Value, bool)> = std::iter::once(schema).chain(forms).map(|one| (one, false)).collect();
    let items: Vec<(&Value, bool)> = found.iter().filter_map(|(one, _)| Some((one.get("items")?, true))).collect();
    found.extend(items);
    found
}

fn table(path: &str, schema: &Value, properties: &Map<String, Value>, listed: bool) -> Table {
    let required = |name: &str| schema["required"].as_array().is_some_and(|r| r.iter().any(|n| n == name));
    let key = |(name, property): (&String, &Value)| Key {
        name: name.clone(),
        kind: kind(property),
        required: required(name),
        default: property.get("default").and_then(default),
        about: meaning(property),
    };
    let mut keys: Vec<Key> = properties.iter().map(key).collect();
    keys.sort_by_key(|k| !k.required);
    Table { paths: vec![path.to_owned()], listed, about: words_of(schema).to_owned(), keys }
}

fn words_of(schema: &Value) -> &str {
    schema["description"].as_str().unwrap_or_default()
}

/// What a key means, and each word that it may be set to.
fn meaning(schema: &Value) -> String {
    let mut text = words_of(schema).to_owned();
    for word in schema["oneOf"].as_array().into_iter().flatten() {
        if let Some(value) = word["const"].as_str().filter(|_| !words_of(word).is_empty()) {
            text += &format!(" `\"{value}\"`: {}", words_of(word));
        }
    }
    text
}

/// What values a key takes, in words.
fn kind(schema: &Value) -> String {
    let words = |list: &Value| -> Vec<String> { list.as_array().into_iter().flatten().map(kind).collect() };
    if let Some(word) = schema.get("const") {
        return word.to_string();
    }
    for choice in ["oneOf", "anyOf"] {
        let mut choices = words(&schema[choice]);
        choices.dedup();
        if !choices.is_empty() {
            return choices.join(" or ");
        }
    }
    if let Some(values) = schema["enum"].as_array() {
        return values.iter().map(Value::to_string).collect::<Vec<_>>().join(" or ");
    }
    match schema["type"].as_str() {
        Some("number") => "number".to_owned(),
        Some("integer") => "whole number".to_owned(),
        Some("boolean") => "true or false".to_owned(),
        Some("string") => "text".to_owned(),
        Some("object") => "table".to_owned(),
        Some("array") => match (&schema["items"], schema["maxItems"].as_u64()) {
            (items, Some(count)) if items.is_object() => format!("list of {count} of {}", kind(items)),
            (items, _) if items["type"] == "object" => "list of tables".to_owned(),
            (items, _) => format!("list of {}", kind(items)),
        },
        _ => "value".to_owned(),
    }
}

/// A default in words; nothing where it is an empty list, table or text, which says no more than that the key may be left out.
fn default(value: &Value) -> Option<String> {
    match value {
        Value::Array(items) if items.is_empty() => None,
        Value::Object(_) | Value::Null => None,
        Value::String(text) if text.is_empty() => None,
        Value::Number(number) => Some(number.as_f64().map_or_else(|| number.to_string(), |n| n.to_string())),
        other => Some(other.to_string()),
    }
}

fn markdown(table: &Table) -> String {
    let [open, close] = if table.listed { ["[[", "]]"] } else { ["[", "]"] };
    let mut headings = table.paths.iter().map(|path| match path.as_str() {
        "" => "At the top of the file".to_owned(),
        path => format!("`{open}{path}{close}`"),
    });
    let mut text = format!("### {}\n\n", headings.next().unwrap_or_default());
    if !table.about.is_empty() && table.paths.iter().all(|p| !p.is_empty()) {
        text += &format!("{}\n\n", escaped(&table.about));
    }
    let alike: Vec<String> = headings.collect();
    if !alike.is_empty() {
        text += &format!("The same keys: {}.\n\n", alike.join(", "));
    }
    for key in &table.keys {
        let needed = match (&key.default, key.required) {
            (_, true) => ", required".to_owned(),
            (Some(value), _) => format!("; {value} when left out"),
            (None, _) => String::new(),
        };
        // Writing to a string cannot fail.
        let _ = writeln!(text, "- `{}` ({}{needed}): {}", key.name, key.kind, escaped(&key.about));
    }
    text
}

/// Text in which rustdoc sees no links; what is in backticks is not touched.
fn escaped(text: &str) -> String {
    let part = |(i, part): (usize, &str)| {
        if i % 2 == 1 { part.to_owned() } else { part.replace('[', "\\[").replace(']', "\\]").replace('<', "\\<") }
    };
    text.split('`').enumerate().map(part).collect::<Vec<_>>().join("`")
}

fn channels() -> String {
    let mut text = String::from("### Channels\n\n");
    for ChannelInfo { name, quantity, limits: (low, high), doc, .. } in CHANNELS {
        let range = if *low == f64::MIN { String::new() } else { format!(", {low} to {high}") };
        let _ = writeln!(text, "- `{name}` ({}{range}): {doc}.", escaped(quantity.si()));
    }
    text += "\n### Units\n\n";
    let mut listed: Vec<Quantity> = Vec::new();
    for quantity in UNITS.iter().map(|u| u.quantity) {
        if listed.contains(&quantity) {
            continue;
        }
        listed.push(quantity);
        let spellings = quantity.units().map(|u| {
            let written: Vec<String> = u.spellings.iter().filter(|s| !s.is_empty()).map(|s| format!("`{s}`")).collect();
            written.join(", ")
        });
        let name = format!("{quantity:?}")
            .to_lowercase()
            .replace("angularrate", "rate of turn")
            .replace("rotation", "shaft speed");
        let _ = writeln!(text, "- {name}: {}.", spellings.collect::<Vec<_>>().join("; "));
    }
    text
}
