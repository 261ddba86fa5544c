//! JSON schemas (draft 7) of the files that a user writes: study, ship, model and column map, for editors and for the reference.
//! They are those of the types that read the files; ranges of numbers are checked by the readers and are not in them.

use crate::diagnose::Settings;
use crate::diagnose::plan::PlanSettings;
use crate::evaluate::EvaluationSettings;
use crate::evaluate::maneuver::ManeuverSettings;
use crate::fit::FitSettings;
use crate::model::ModelFile;
use crate::recording::{CHANNELS, ColumnMap};
use crate::ship::actuator::Drive;
use crate::ship::{COEFFICIENTS, Ship};
use crate::study::study_schema;
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, SchemaGenerator};
use serde_json::{Map, Value, json};

/// Chapters whose file has a schema.
pub const WITH_SCHEMA: [&str; 4] = ["study", "ship", "model", "columns"];

/// The schema of the file that a chapter is about; nothing for a chapter that is about no file.
pub fn schema(chapter: &str) -> Option<Value> {
    let mut settings = SchemaSettings::draft07();
    settings.inline_subschemas = true;
    let mut generator = settings.into_generator();
    let mut schema = match chapter {
        "study" => study(&mut generator),
        "ship" => ship(&mut generator),
        "model" => of::<ModelFile>(&mut generator),
        "columns" => columns(&mut generator),
        _ => return None,
    };
    schema["$schema"] = "http://json-schema.org/draft-07/schema#".into();
    schema["title"] = format!("trimtab: {chapter} file").into();
    Some(tidy(schema))
}

fn of<T: JsonSchema>(generator: &mut SchemaGenerator) -> Value {
    T::json_schema(generator).to_value()
}

/// The study with the tables that the commands read.
fn study(generator: &mut SchemaGenerator) -> Value {
    let mut schema = study_schema(generator).to_value();
    let tables = [
        ("fit", of::<FitSettings>(generator)),
        ("evaluate", of::<EvaluationSettings>(generator)),
        ("diagnose", of::<Settings>(generator)),
        ("maneuver", of::<ManeuverSettings>(generator)),
        ("plan", of::<PlanSettings>(generator)),
    ];
    for (name, mut table) in tables {
        table["description"] = schema["properties"][name]["description"].take();
        schema["properties"][name] = table;
    }
    schema
}

/// The ship, with the names that its tables of coefficients may have.
fn ship(generator: &mut SchemaGenerator) -> Value {
    let mut schema = of::<Ship>(generator);
    let names: Map<String, Value> =
        COEFFICIENTS.iter().map(|(name, _)| ((*name).to_owned(), json!({ "type": "number" }))).collect();
    for table in ["coefficients", "coefficients_prime"] {
        schema["properties"][table]["properties"] = names.clone().into();
        schema["properties"][table]["additionalProperties"] = false.into();
    }
    schema
}

/// The column map, with the channels that `[columns]` may have.
fn columns(generator: &mut SchemaGenerator) -> Value {
    let mut schema = of::<ColumnMap>(generator);
    let column = schema["properties"]["columns"]["additionalProperties"].take();
    let entry = |c: &crate::recording::ChannelInfo| {
        let mut column = column.clone();
        column["description"] = c.doc.into();
        (c.name.to_owned(), column)
    };
    schema["properties"]["columns"]["properties"] = CHANNELS.iter().map(entry).collect::<Map<_, _>>().into();
    let suffixes = Drive::ALL.map(Drive::suffix).join("|");
    let mut command = column;
    command["description"] = "A channel of the actuator NAME of the ship file.".into();
    schema["properties"]["columns"]["patternProperties"] =
        json!({ (format!("^[A-Za-z][A-Za-z0-9_]*\\.({suffixes})$")): command });
    schema["properties"]["columns"]["additionalProperties"] = false.into();
    schema
}

/// A schema without what TOML has not (null), and with descriptions as plain text.
fn tidy(value: Value) -> Value {
    match value {
        Value::Object(members) => {
            let kept = members.into_iter().filter(|(key, v)| !(key == "default" && v.is_null()));
            let mut tidied: Map<String, Value> = kept.map(|(k, v)| (k, tidy(v))).collect();
            if let Some(Value::String(text)) = tidied.get_mut("description") {
                *text = plain(text);
            }
            if let Some(Value::Array(types)) = tidied.get_mut("type") {
                types.retain(|t| t != "null");
                if let [only] = &types[..] {
                    let only = only.clone();
                    tidied.insert("type".to_owned(), only);
                }
            }
            if let Some(Value::Array(any)) = tidied.get_mut("anyOf") {
                any.retain(|one| one["type"] != "null");
                if let [Value::Object(only)] = &any[..] {
                    let only = only.clone();
                    tidied.remove("anyOf");
                    for (key, value) in only {
                        tidied.entry(key).or_insert(value);
                    }
                }
            }
            Value::Object(tidied)
        }
        Value::Array(items) => Value::Array(items.into_iter().map(tidy).collect()),
        other => other,
    }
}

/// A doc comment as plain text: a line, no links of rustdoc, no escapes of Markdown.
fn plain(doc: &str) -> String {
    let words: Vec<&str> = doc.split_whitespace().collect();
    let text = words.join(" ").replace("\\[", "[").replace("\\]", "]");
    text.replace("([`COEFFICIENTS`])", "").replace("[`", "`").replace("`]", "`").replace(" ,", ",").replace("  ", " ")
}

#[cfg(test)]
mod tests {
    use super::{WITH_SCHEMA, schema};
    use serde_json::Value;

    #[test]
    fn every_key_of_every_schema_has_a_description_and_no_null() {
        fn walk(place: &str, value: &Value) {
            let Some(members) = value.as_object() else { return };
            assert!(value["type"] != "null", "{place}");
            if let Some(properties) = members.get("properties").and_then(Value::as_object) {
                for (key, property) in properties {
                    let place = format!("{place}.{key}");
                    let named = place.contains(".coefficients");
                    assert!(named || property["description"].as_str().is_some_and(|d| d.len() > 4), "{place}");
                    walk(&place, property);
                }
            }
            for part in ["items", "additionalProperties"] {
                members.get(part).into_iter().for_each(|inner| walk(place, inner));
            }
            for one in members.get("anyOf").and_then(Value::as_array).into_iter().flatten() {
                walk(place, one);
            }
        }
        for chapter in WITH_SCHEMA {
            walk(chapter, &schema(chapter).unwrap());
        }
    }
}
