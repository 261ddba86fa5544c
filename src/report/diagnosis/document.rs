//! A diagnosis as a JSON document, and what its keys mean.
//! It repeats the diagnosis and leaves out what has no value; the meanings are in `keys.txt`.

use crate::diagnose::Diagnosis;
use serde_json::{Map, Value};

/// Every key of the document with its meaning; `[]` in a key means any entry of a list.
pub fn keys() -> impl Iterator<Item = (&'static str, &'static str)> {
    include_str!("keys.txt").lines().filter_map(|line| line.split_once(": "))
}

/// The keys of the document as text, one line each.
#[must_use]
pub fn keys_listing() -> String {
    keys().map(|(key, meaning)| format!("  {key}: {meaning}\n")).collect()
}

/// The diagnosis as a JSON document, see [`keys`].
///
/// Numbers that are not finite, lists that contain one, and members without a value are left out, so that no `null` is in it.
///
/// # Errors
/// When a member cannot be turned into JSON, which no diagnosis gives cause to.
pub fn document(diagnosis: &Diagnosis, study: &str) -> Result<Value, serde_json::Error> {
    let mut members = Map::new();
    if let Some(Value::Object(all)) = pruned(serde_json::to_value(diagnosis)?) {
        members = all;
    }
    members.insert("study".into(), study.into());
    members.insert("version".into(), env!("CARGO_PKG_VERSION").into());
    Ok(Value::Object(members))
}

/// A value without nulls; nothing at all for a list with a hole, whose other entries would change places.
fn pruned(value: Value) -> Option<Value> {
    match value {
        Value::Null => None,
        Value::Object(members) => {
            Some(Value::Object(members.into_iter().filter_map(|(k, v)| Some((k, pruned(v)?))).collect()))
        }
        Value::Array(entries) => entries.into_iter().map(pruned).collect::<Option<Vec<Value>>>().map(Value::Array),
        other => Some(other),
    }
}
