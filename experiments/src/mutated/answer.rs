//! What a command answered: numbers with their standard errors, words, and the warnings in its first ten lines.
//! Whether a change was right is judged in `row`.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value;

/// Lines in which a warning must be.
const FIRST: usize = 10;

/// A share of a number by which it may differ without having moved, where it has no standard error.
const SHARE: f64 = 0.01;

/// What a command answered.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Answer {
    /// Numbers by name, each with its standard error, or 1 % of it.
    pub numbers: BTreeMap<String, (f64, f64)>,
    /// Names and verdicts.
    pub words: BTreeSet<String>,
    /// Warnings in the first ten lines.
    pub told: BTreeSet<String>,
}

/// Warnings in the first lines of a text: of doubts that concern several runs each is another as soon as it concerns others.
pub fn told(text: &str) -> BTreeSet<String> {
    let doubts = ["warning", "error", "IN DOUBT", "NOT CONVERGED", "SENSOR", "INSUFFICIENT", "diverge"];
    let lines = text.lines().filter(|line| !line.trim().is_empty()).take(FIRST);
    lines.filter(|line| doubts.iter().any(|d| line.contains(d))).map(|line| line.trim().to_owned()).collect()
}

fn list<'v>(of: &'v Value, key: &str) -> impl Iterator<Item = &'v Value> {
    of[key].as_array().into_iter().flatten()
}

impl Answer {
    /// Reads the numbers and words of a command's answer from its JSON.
    pub fn new(command: &str, json: &Value) -> Self {
        let mut answer = Self::default();
        let result = &json["result"];
        match command {
            "fit" => list(result, "estimates").for_each(|e| {
                answer.number(e["name"].as_str(), &e["value"], e["standard_error"].as_f64());
            }),
            "simulate" => {
                let mut windows: BTreeMap<&str, usize> = BTreeMap::new();
                for run in list(result, "runs") {
                    let name = run["run"].as_str().unwrap_or_default();
                    let window = windows.entry(name).or_default();
                    *window += 1;
                    let error = run["cvdm_standard_error"].as_f64();
                    answer.number(Some(&format!("{name}, window {window}")), &run["cvdm"], error);
                }
            }
            "evaluate" => list(result, "summaries").for_each(|group| {
                let measure = &group["cvdm_fitted"];
                let ends = [0, 1].map(|i| measure["ci95"][i].as_f64());
                let error = ends[0].zip(ends[1]).map(|(low, high)| (high - low) / 3.92);
                answer.number(group["group"].as_str(), &measure["value"], error);
            }),
            "maneuver" => list(result, "trials").for_each(|trial| {
                answer.number(trial["name"].as_str(), &trial["measures"]["advance"], None);
            }),
            _ => {
                answer.words.extend(json["verdict"].as_str().map(str::to_owned));
                let names = list(json, "findings").filter_map(|f| f["mechanism"].as_str());
                answer.words.extend(names.map(str::to_owned));
            }
        }
        answer
    }

    fn number(&mut self, name: Option<&str>, value: &Value, error: Option<f64>) {
        let value = value.as_f64().unwrap_or(f64::NAN);
        // A parameter that constraints fix has no standard error.
        let error = error.filter(|e| e.is_finite() && *e > 0.0).unwrap_or(SHARE * value.abs());
        self.numbers.insert(name.unwrap_or_default().to_owned(), (value, error));
    }

    /// By how many of its standard errors the number that moved most has moved from a sound answer; infinite where a name is another.
    pub fn moved(&self, sound: &Self) -> f64 {
        let same = self.words == sound.words && self.numbers.keys().eq(sound.numbers.keys());
        let by = |(name, (value, error)): (&String, &(f64, f64))| match self.numbers.get(name) {
            Some((now, _)) if (now - value).abs() <= f64::EPSILON => 0.0,
            Some((now, _)) => (now - value).abs() / error,
            None => f64::INFINITY,
        };
        let most = sound.numbers.iter().map(by).fold(0.0, |most: f64, m| if m > most || m.is_nan() { m } else { most });
        if same && most.is_finite() { most } else { f64::INFINITY }
    }

    /// Whether it has a warning that the sound answer does not have.
    pub fn tells(&self, sound: &Self) -> bool {
        !self.told.is_subset(&sound.told)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn an_answer_has_moved_by_its_standard_errors_and_another_verdict_is_another_answer() {
        let fit = |a: f64| {
            json!({ "result": { "estimates": [
            { "name": "a", "value": a, "standard_error": 0.5 }, { "name": "fixed", "value": 1.0, "standard_error": null }
        ] } })
        };
        let said = |answer: Answer, text: &str| Answer { told: told(text), ..answer };
        let sound = said(Answer::new("fit", &fit(1.0)), "Converged\n");
        let moved = said(Answer::new("fit", &fit(2.0)), "warning: r01\nConverged, but IN DOUBT: ...\n");
        assert_eq!((moved.moved(&sound), sound.moved(&sound)), (2.0, 0.0));
        assert!(moved.tells(&sound) && !sound.tells(&moved) && moved.told.len() == 2);
        let verdict = |name: &str| Answer::new("diagnose", &json!({ "verdict": name, "findings": [] }));
        assert!(verdict("named").moved(&verdict("nothing_missing")).is_infinite());
        assert_eq!(verdict("named").moved(&verdict("named")), 0.0);
        let late = "\n".repeat(30) + &"a line\n".repeat(10) + "warning: too late\n";
        assert!(told(&late).is_empty());
    }
}
