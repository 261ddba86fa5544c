//! Causes of error as a diagnosis has them: found, refuted, tried and not named, excluded from a size on, and not excluded.
//! Its numbers are those of `diagnosis.json`, repeated; no test is made here.

use crate::diagnose::proof::finding::{GENERIC, PUSH, PUSH_TITLE};
use crate::model::Model;
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeSet;

/// A cause that these recordings do not exclude.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Open {
    /// Name in the catalogue.
    pub mechanism: String,
    /// Plain words.
    pub title: String,
    /// Why it is not excluded.
    pub why: String,
}

/// A cause that would have been seen from a size on.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Excluded {
    /// Name in the catalogue.
    pub mechanism: String,
    /// Plain words.
    pub title: String,
    /// Size that is seen in 80 % of such recordings.
    pub size: f64,
    /// Its unit.
    pub unit: String,
}

/// What the diagnosis says of causes of error.
#[derive(Clone, Debug, Serialize)]
pub struct Causes {
    /// Where the diagnosis is from.
    pub source: String,
    /// Its verdict.
    pub verdict: Value,
    /// Its verdict in a sentence.
    pub headline: Value,
    /// Chance of naming anything when nothing is missing, and seed.
    pub settings: Value,
    /// What it names, as `findings` of `diagnosis.json`.
    pub found: Vec<Value>,
    /// What was selected on training runs and test runs refute.
    pub refuted: Vec<Value>,
    /// What was selected and is not named for another reason, which its `grade` says.
    pub not_named: Vec<Value>,
    /// What would have been seen from a size on, and was not.
    pub excluded: Vec<Excluded>,
    /// What these recordings do not exclude.
    pub not_excluded: Vec<Open>,
    /// p-values of forces of other forms that are left: with and without port-starboard symmetry.
    pub left: Value,
    /// Repetitions of the analysis, where there were any.
    #[serde(skip_serializing_if = "Value::is_null")]
    pub stability: Value,
    /// The findings together on test runs, where there were any.
    #[serde(skip_serializing_if = "Value::is_null")]
    pub held_out: Value,
}

impl Causes {
    /// What a document of a diagnosis says, see [`crate::report`] for its keys; `source` names its origin.
    pub fn new(model: &Model, document: &Value, source: String) -> Self {
        let list = |key: &str| document[key].as_array().cloned().unwrap_or_default();
        let (found, withdrawn) = (list("findings"), list("withdrawn"));
        let (refuted, not_named) = withdrawn
            .into_iter()
            .partition::<Vec<Value>, _>(|f| f["grade"] == "refuted" || f["grade"] == "refuted_together");
        let settled: BTreeSet<String> =
            found.iter().chain(&refuted).filter_map(|f| f["mechanism"].as_str().map(str::to_owned)).collect();
        let named = |entry: &Value| entry["mechanism"].as_str().unwrap_or("").to_owned();
        let detectable = list("detectable");
        let excluded = detectable.iter().filter_map(|d| {
            let mechanism = named(d);
            let tried = not_named.iter().any(|f| f["mechanism"] == d["mechanism"]);
            (!tried && !settled.contains(&mechanism)).then_some(Excluded {
                title: title(model, &mechanism),
                size: d["size"].as_f64().filter(|s| s.is_finite())?,
                unit: d["unit"].as_str().unwrap_or("").to_owned(),
                mechanism,
            })
        });
        Self {
            excluded: excluded.collect(),
            not_excluded: open(model, &list("absorbed"), &found, &not_named, &settled),
            source,
            verdict: document["verdict"].clone(),
            headline: document["headline"].clone(),
            settings: serde_json::json!({"alpha": document["settings"]["alpha"], "seed": document["settings"]["seed"]}),
            left: document["adequacy_after"].clone(),
            stability: document["stability"].clone(),
            held_out: document["held_out"].clone(),
            found,
            refuted,
            not_named,
        }
    }
}

/// What is not excluded: what cannot be distinguished from a finding, what was tried and is not named, and what other parameters absorb.
fn open(
    model: &Model,
    absorbed: &[Value],
    found: &[Value],
    not_named: &[Value],
    settled: &BTreeSet<String>,
) -> Vec<Open> {
    let text = |v: &Value| v.as_str().unwrap_or("").to_owned();
    let alike = found.iter().flat_map(|f| {
        let others = f["confidence_set"].as_array().into_iter().flatten().skip(1);
        others.map(move |m| (text(m), format!("not distinguishable from the finding `{}`", text(&f["title"]))))
    });
    let tried =
        not_named.iter().map(|f| (text(&f["mechanism"]), format!("selected, and not named: {}", text(&f["grade"]))));
    let hidden =
        absorbed.iter().map(|a| (text(&a["mechanism"]), format!("not identifiable: absorbed by {}", text(&a["by"]))));
    let mut seen = settled.clone();
    let all = alike.chain(tried).chain(hidden).filter(|(m, _)| seen.insert(m.clone()));
    all.map(|(mechanism, why)| Open { title: title(model, &mechanism), mechanism, why }).collect()
}

/// The plain words for a mechanism; its name when it is not in the catalogue of the model.
fn title(model: &Model, name: &str) -> String {
    match name {
        PUSH => PUSH_TITLE.to_owned(),
        GENERIC => "something that is not in the catalogue".to_owned(),
        _ => {
            let mut mechanisms = model.catalogue().iter().flat_map(|t| t.info().mechanisms);
            mechanisms.find(|m| m.name == name).map_or(name, |m| m.title).to_owned()
        }
    }
}
