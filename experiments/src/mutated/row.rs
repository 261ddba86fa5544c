//! One row of the results: a command on a changed study, what it did, and whether that was right.
//! Rows alone are summarised.

use serde::{Deserialize, Serialize};

use super::answer::Answer;
use super::plan::{Class, Planned};
use crate::process::Ended;

/// An answer has moved if a number of it has by more than this many of its standard errors.
const MOVED: f64 = 1.0;

/// A harmless edit leaves every number within this share of its standard error: what rounding makes of other text.
const ROUNDING: f64 = 1e-3;

impl Class {
    /// By how many standard errors an answer may differ from the sound one without having moved.
    pub fn limit(self) -> f64 {
        if self == Self::Harmless { ROUNDING } else { MOVED }
    }
}

/// What a command did.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// It ended by a panic or a signal.
    #[default]
    Panicked,
    /// It did not end in time.
    Hung,
    /// It refused the study with a message.
    Refused,
    /// It refused without a message, or has an exit code that it does not state.
    Unclear,
    /// Its answer is that of the sound study.
    Same,
    /// Its answer has moved, and it reported a doubt that the sound study does not raise.
    Told,
    /// Its answer has moved without a word.
    Silent,
}

/// A row of the results.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Number of the case.
    pub case: usize,
    /// Its seed.
    pub seed: u64,
    /// `harmless`, `mistake` or `damage`.
    pub class: String,
    /// The kind of change.
    pub kind: String,
    /// What was changed where.
    pub what: String,
    /// The command.
    pub command: String,
    /// What it did.
    pub outcome: Outcome,
    /// Whether that is right.
    pub right: bool,
    /// By how many standard errors the number that moved most has moved; blank where there is no such number.
    pub moved: Option<f64>,
    /// Exit code; blank if a signal ended it.
    pub code: Option<i32>,
    /// Last line of standard error.
    pub message: String,
}

impl Row {
    /// The row of a command that has ended; `answer` is what it answered, if it did.
    pub fn new(
        planned: &Planned,
        what: &str,
        command: &str,
        ended: &Ended,
        answer: Option<&Answer>,
        sound: &Answer,
    ) -> Self {
        let moved = answer.map(|answer| answer.moved(sound));
        let panicked = ended.code.is_none() || ended.code == Some(101) || ended.messages.contains("panicked at");
        let limit = planned.class.limit();
        let outcome = match (ended.code, answer, moved) {
            _ if ended.stopped => Outcome::Hung,
            _ if panicked => Outcome::Panicked,
            (Some(2), _, _) if !ended.messages.trim().is_empty() => Outcome::Refused,
            (Some(0 | 1), Some(_), Some(moved)) if moved <= limit => Outcome::Same,
            (Some(0 | 1), Some(answer), _) if answer.tells(sound) => Outcome::Told,
            (Some(0 | 1), Some(_), _) => Outcome::Silent,
            _ => Outcome::Unclear,
        };
        let message = ended.messages.lines().last().unwrap_or_default().chars().take(300).collect();
        Self {
            case: planned.case,
            seed: planned.seed,
            class: format!("{:?}", planned.class).to_lowercase(),
            kind: planned.kind.to_owned(),
            what: what.to_owned(),
            command: command.to_owned(),
            outcome,
            right: right(planned.class, outcome),
            moved: moved.filter(|m| m.is_finite()),
            code: ended.code,
            message,
        }
    }
}

/// Whether an outcome is right for a class of changes. A mistake in what a command does not read cannot be refused by it: then the
/// answer must be the same.
fn right(class: Class, outcome: Outcome) -> bool {
    match class {
        Class::Harmless => outcome == Outcome::Same,
        Class::Mistake => matches!(outcome, Outcome::Refused | Outcome::Same),
        Class::Damage => matches!(outcome, Outcome::Refused | Outcome::Same | Outcome::Told),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mutated::answer::told;
    use crate::mutated::plan::plan;
    use serde_json::json;

    #[test]
    fn outcomes_follow_from_code_answer_and_messages() {
        let planned = |class: Class| plan(60, 1).into_iter().find(|p| p.class == class).unwrap();
        let answer = |advance: f64, text: &str| {
            let json = json!({ "result": { "trials": [{ "name": "a", "measures": { "advance": advance } }] } });
            Answer { told: told(text), ..Answer::new("maneuver", &json) }
        };
        let ended = |code: Option<i32>, messages: &str, stopped: bool| Ended {
            code,
            stopped,
            output: String::new(),
            messages: messages.to_owned(),
            seconds: 0.1,
        };
        let sound = answer(100.0, "");
        let of = |class: Class, ended: Ended, answer: Option<Answer>| {
            let row = Row::new(&planned(class), "", "maneuver", &ended, answer.as_ref(), &sound);
            (row.outcome, row.right)
        };
        let done = || ended(Some(0), "", false);
        assert_eq!(of(Class::Damage, done(), Some(answer(100.5, ""))), (Outcome::Same, true));
        assert_eq!(of(Class::Harmless, done(), Some(answer(100.5, ""))), (Outcome::Silent, false));
        assert_eq!(of(Class::Damage, done(), Some(answer(120.0, ""))), (Outcome::Silent, false));
        assert_eq!(of(Class::Damage, done(), Some(answer(120.0, "warning: x"))), (Outcome::Told, true));
        assert_eq!(of(Class::Mistake, done(), Some(answer(120.0, "warning: x"))), (Outcome::Told, false));
        assert_eq!(of(Class::Mistake, ended(Some(2), "trimtab: no", false), None), (Outcome::Refused, true));
        assert_eq!(of(Class::Mistake, ended(Some(2), "", false), None), (Outcome::Unclear, false));
        assert_eq!(of(Class::Damage, ended(Some(101), "thread panicked at", false), None), (Outcome::Panicked, false));
        assert_eq!(of(Class::Damage, ended(None, "", true), None), (Outcome::Hung, false));
    }
}
