//! The cases with a wrong answer: what was injected, what was said, and which questions about it are answered wrongly.
//! It scores nothing.

use serde::Serialize;

use super::score::Score;
use super::summary::{Scored, strong};

/// A case with a wrong answer.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Failure<'a> {
    /// Key of the case.
    pub case: &'a str,
    /// The questions that are answered wrongly, by their columns among the scores, joined by `+`; `error` without an answer.
    pub failed: String,
    /// How the set was given, in words.
    pub configuration: &'a str,
    /// Effects injected.
    pub injected: &'a str,
    /// Size of the first effect.
    pub size: Option<f64>,
    /// Its unit.
    pub unit: &'a str,
    /// Sessions in which the effects act; empty for all.
    pub sessions: &'a str,
    /// The verdict.
    pub verdict: &'a str,
    /// Mechanisms named.
    pub named: &'a str,
    /// Their grades.
    pub grades: &'a str,
    /// Mechanisms withdrawn, with their grades.
    pub withdrawn: &'a str,
    /// Found with it less found without it, along the truth, over the truth.
    pub ratio: Option<f64>,
    /// Why there is no diagnosis.
    pub error: &'a str,
}

/// The questions that are answered wrongly. A single effect of strength below 1 need not be named.
fn questions(score: &Score, aimed: bool) -> Vec<&'static str> {
    let s = score;
    let no = |answer: Option<bool>| answer.map(|a| !a);
    let of = [
        ("alarm", s.alarm),
        ("weather", s.weather),
        ("contradicted", s.contradicted),
        ("same", no(s.same)),
        ("fixed", no(s.fixed)),
        ("right", no(s.right).filter(|_| aimed)),
        ("wrong", s.wrong),
        ("miscalled", s.miscalled),
        ("sessions", no(s.sessions)),
        ("refused", no(s.refused)),
        ("covered", no(s.covered).filter(|_| aimed)),
        ("windy", no(s.windy)),
    ];
    of.into_iter().filter(|(_, fails)| *fails == Some(true)).map(|(name, _)| name).collect()
}

/// The cases with a wrong answer, in the order of the rows.
pub fn failures<'a>(all: &[Scored<'a>]) -> Vec<Failure<'a>> {
    let one = |(row, score): &Scored<'a>| {
        let mut failed = questions(score, row.kind != "single" || strong(row));
        if !row.answered() && score.refused != Some(true) {
            failed.push("error");
        }
        (!failed.is_empty()).then(|| Failure {
            case: &row.case,
            failed: failed.join("+"),
            configuration: &row.configuration,
            injected: &row.injected,
            size: row.size,
            unit: &row.unit,
            sessions: &row.sessions,
            verdict: &row.verdict,
            named: &row.named,
            grades: &row.grades,
            withdrawn: &row.withdrawn,
            ratio: score.ratio,
            error: &row.error,
        })
    };
    all.iter().filter_map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::injected::answers::row::Row;

    #[test]
    fn a_case_is_listed_with_its_wrong_answers_and_a_weak_effect_need_not_be_named() {
        let row = |case: &str, strength: f64| Row {
            case: case.into(),
            kind: "single".into(),
            strength: Some(strength),
            verdict: "nothing_missing".into(),
            ..Row::default()
        };
        let rows =
            [row("strong", 1.0), row("weak", 0.5), row("right", 2.0), Row { error: "x".into(), ..row("none", 1.0) }];
        let missed = Score { right: Some(false), wrong: Some(false), ..Score::default() };
        let right = Score { right: Some(true), wrong: Some(false), ..Score::default() };
        let all: Vec<Scored> = rows.iter().zip([missed.clone(), missed, right, Score::default()]).collect();
        let listed: Vec<(&str, String)> = failures(&all).into_iter().map(|f| (f.case, f.failed)).collect();
        assert_eq!(listed, [("strong", "right".to_owned()), ("none", "error".to_owned())]);
    }
}
