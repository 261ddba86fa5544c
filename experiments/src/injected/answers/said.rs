//! What a diagnosis says, as far as it is scored: the documented keys of its JSON, absent ones tolerated.
//! It shares no type with the program that writes them.

use serde::Deserialize;

/// A diagnosis.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub struct Said {
    /// The verdict.
    pub verdict: String,
    /// The verdict in a sentence.
    pub headline: String,
    /// What is named.
    pub findings: Vec<Finding>,
    /// Whether the improved model is the base model, as unseen runs are simulated worse with what was found.
    pub improved_is_base: bool,
    /// What was tried and is not named.
    pub withdrawn: Vec<Withdrawn>,
    /// The proof of all findings together.
    pub held_out: Option<HeldOut>,
    /// How many repetitions of the analysis agree.
    pub stability: Option<Stability>,
    /// The audit.
    pub admission: Admission,
    /// The audit of the files.
    pub recordings: Recordings,
    /// Every mechanism that was tested.
    pub ranking: Vec<Ranked>,
}

/// The audit of the files of the recordings.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub struct Recordings {
    /// Its doubts.
    pub doubts: Vec<Doubt>,
}

/// One doubt.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub struct Doubt {
    /// `warning` or `error`; an error stops the diagnosis.
    pub severity: String,
    /// Its kind.
    pub fault: String,
    /// Whether the user accepts it.
    pub accepted: bool,
}

/// One finding.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub struct Finding {
    /// Name of the mechanism.
    pub mechanism: String,
    /// `environment`, `ship`, `actuator` or `sensor`.
    pub kind: String,
    /// Every mechanism that the data allow in its place.
    pub confidence_set: Vec<String>,
    /// `confirmed` or `suspected`; empty in diagnoses without grades.
    pub grade: String,
    /// Sessions in which it acts; empty for all.
    pub sessions: Vec<String>,
    /// Its parameters.
    pub parameters: Vec<Parameter>,
    /// Its own proof.
    pub held_out: Option<HeldOut>,
}

/// A parameter with its interval.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub struct Parameter {
    /// Dotted name, with the session in brackets where each has its own.
    pub name: String,
    /// Estimate.
    pub value: Option<f64>,
    /// Its 95 % interval.
    pub ci95: Interval,
    /// Unit.
    pub unit: String,
}

/// A mechanism that was tried and is not named.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub struct Withdrawn {
    /// Name.
    pub mechanism: String,
    /// `refuted`, `immaterial` or `undetermined`.
    pub grade: String,
    /// Its parameters.
    pub parameters: Vec<Parameter>,
}

/// A proof on unseen recordings.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub struct HeldOut {
    /// Gain in log-likelihood.
    pub log_likelihood_gain: Option<f64>,
    /// Its 95 % interval.
    pub log_likelihood_ci95: Interval,
    /// Relative improvement in free simulation.
    pub improvement: Option<f64>,
    /// Its 95 % interval, in the proof of a finding.
    pub improvement_ci95: Interval,
    /// The same in the proof of all findings together.
    pub ci95: Interval,
    /// Mean cVDM of the base model \[%\], in the proof of all findings together.
    pub before: Option<f64>,
    /// The same with the findings.
    pub after: Option<f64>,
}

/// The ends of an interval; one that is not finite is absent.
pub type Interval = Option<[Option<f64>; 2]>;

/// How many repetitions of the analysis agree.
#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(default)]
pub struct Stability {
    /// Those with the same answer.
    pub same: usize,
    /// All.
    pub of: usize,
}

/// The audit.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub struct Admission {
    /// Its issues.
    pub issues: Vec<Issue>,
}

/// One issue.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub struct Issue {
    /// Its kind.
    pub mechanism: String,
    /// Whether it stops the diagnosis.
    pub blocking: bool,
}

/// One row of the ranking.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub struct Ranked {
    /// Name.
    pub mechanism: String,
    /// Estimate of its parameters under the base model.
    pub amplitude: Vec<Option<f64>>,
    /// Whether each session has its own.
    pub by_session: bool,
    /// Sessions in which it acts; empty for all.
    pub sessions: Vec<String>,
}

impl Said {
    /// Reads the JSON of a diagnosis.
    ///
    /// # Errors
    /// The message of the reader; a diagnosis needs at least a verdict.
    pub fn read(text: &str) -> Result<Self, String> {
        let said: Self = serde_json::from_str(text).map_err(|e| format!("no diagnosis: {e}"))?;
        if said.verdict.is_empty() { Err("no diagnosis: it has no verdict".to_owned()) } else { Ok(said) }
    }

    /// Kinds of the issues that stop the diagnosis.
    pub fn faults(&self) -> Vec<&str> {
        let blocking = self.admission.issues.iter().filter(|i| i.blocking).map(|i| i.mechanism.as_str());
        let errors = self.recordings.doubts.iter().filter(|d| d.severity == "error" && !d.accepted);
        let mut kinds: Vec<&str> = blocking.chain(errors.map(|d| d.fault.as_str())).collect();
        kinds.sort_unstable();
        kinds.dedup();
        kinds
    }
}

impl Finding {
    /// Its confidence set, its own name included.
    pub fn set(&self) -> Vec<&str> {
        let mut names: Vec<&str> = self.confidence_set.iter().map(String::as_str).collect();
        if !names.contains(&self.mechanism.as_str()) {
            names.insert(0, &self.mechanism);
        }
        names
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_diagnosis_of_an_older_program_has_no_grades_and_one_of_a_newer_has() {
        let old = r#"{"verdict": "named", "findings": [{"mechanism": "current", "confidence_set": ["current", "tide"],
            "parameters": [{"name": "current.north", "value": 0.1, "unit": "m/s"}]}],
            "held_out": {"runs": 3, "improvement": 0.2, "ci95": [0.1, 0.3], "log_likelihood_gain": 12.0}, "moves": []}"#;
        let said = Said::read(old).unwrap();
        assert_eq!((said.findings[0].grade.as_str(), said.findings[0].set()), ("", vec!["current", "tide"]));
        assert_eq!(said.held_out.unwrap().ci95, Some([Some(0.1), Some(0.3)]));
        let new = r#"{"verdict": "named", "findings": [{"mechanism": "current", "grade": "confirmed",
            "held_out": {"recordings": 3, "log_likelihood_ci95": [2.0, 9.0], "improvement_ci95": [0.1, null], "ci95": [0.1, 0.3]}}],
            "withdrawn": [{"mechanism": "tide", "grade": "refuted", "reason": "worse"}], "stability": {"same": 5, "of": 6},
            "admission": {"issues": [{"mechanism": "sign_error", "blocking": true}, {"mechanism": "held"}]},
            "recordings": {"doubts": [{"severity": "error", "fault": "unit_error"}, {"severity": "warning", "fault": "held"}]}}"#;
        let said = Said::read(new).unwrap();
        assert_eq!((said.findings[0].grade.as_str(), said.withdrawn[0].grade.as_str()), ("confirmed", "refuted"));
        assert_eq!((said.stability.unwrap().same, said.faults()), (5, vec!["sign_error", "unit_error"]));
        assert!(Said::read("{}").is_err() && Said::read("error").is_err());
    }
}
