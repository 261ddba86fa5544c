//! Which scores of a campaign are compared with each other: selections of cases, rival methods and models, families and colours.
//! It counts nothing.

use trimtab::report::plot::{BASELINE, BLUE, Color, FITTED, GREY, ORACLE, ORANGE, PURPLE, SKY};

use super::plan::OTHER_HULLS;
use crate::conceal::family::Family;
use crate::conceal::judge::score::Score;

/// A question about a case; `None` where it does not apply.
pub type Question = fn(&Score) -> Option<bool>;

/// The cases of an arm.
pub fn arm<'a>(scores: &'a [Score], arm: &'a str) -> impl Iterator<Item = &'a Score> + Clone {
    scores.iter().filter(move |s| s.arm == arm)
}

/// The nulls of a family.
pub fn nulls<'a>(scores: &'a [Score], family: &'a str) -> impl Iterator<Item = &'a Score> + Clone {
    arm(scores, "null").filter(move |s| s.family == family)
}

/// Single effects at one signal-to-noise ratio in the standard design, of a family or of both.
pub fn single<'a>(scores: &'a [Score], family: Option<&'a str>, snr: f64) -> impl Iterator<Item = &'a Score> + Clone {
    arm(scores, "single")
        .filter(move |s| s.snr_asked == Some(snr) && family.is_none_or(|f| s.family == f) && reached(s))
}

/// The cases on another hull.
pub fn other_hull(scores: &[Score], family: Family) -> impl Iterator<Item = &Score> + Clone {
    arm(scores, OTHER_HULLS).filter(move |s| s.family == family.name() && reached(s))
}

/// Whether a case has the strength asked for; an effect limited by its largest size has not.
pub fn reached(score: &Score) -> bool {
    match (score.snr_asked, score.snr) {
        (Some(asked), Some(snr)) => snr > 0.7 * asked,
        _ => true,
    }
}

/// Weakest signal-to-noise ratio at which a detection has an aim.
const WEAKEST: f64 = 6.0;

/// Whether some answer about a case is wrong, or the case has no score. That an effect weaker than any with an aim is not detected is
/// no failure.
pub fn failed(score: &Score) -> bool {
    let s = score;
    let aimed = s.snr_asked.is_none_or(|snr| snr >= WEAKEST);
    let false_claim = [s.false_alarm, s.wrong_confident, s.absorbed_named].contains(&Some(true));
    let missed = [s.first_right, s.in_set, s.right_equation, s.covered, s.some_right_none_wrong];
    !s.error.is_empty() || false_claim || missed.contains(&Some(false)) || (aimed && s.detected == Some(false))
}

/// Families in which the flow straightening at the rudder differs between port and starboard by one known number.
pub const LOPSIDED: [Family; 3] = [Family::Mmg, Family::Tanker, Family::Flap];

/// Their cases with a known asymmetry: nulls, and every case of the other hulls.
pub fn lopsided(scores: &[Score], family: Family) -> impl Iterator<Item = &Score> + Clone {
    let arms = ["null", OTHER_HULLS];
    scores.iter().filter(move |s| s.family == family.name() && arms.contains(&s.arm.as_str()) && s.asymmetry.is_some())
}

/// Whether the asymmetry of the flow has its true sign, where the diagnosis reported that the sides differ.
pub fn right_side(score: &Score) -> Option<bool> {
    let product = score.asymmetry_found? * score.asymmetry?;
    (score.sides_differ?).then_some(product > 0.0)
}

/// The families as figures show them.
pub const SHOWN: [(&str, Color, Family); 4] = [
    ("HD truth", BLUE, Family::Hd),
    ("MMG truth", ORANGE, Family::Mmg),
    ("tanker", SKY, Family::Tanker),
    ("flapped rudder", BASELINE, Family::Flap),
];

/// A method that names the missing mechanism.
pub struct Way {
    /// Name.
    pub name: &'static str,
    /// Colour.
    pub color: Color,
    /// Whether it named the effect, or nothing on a null; unknown where the method was not run.
    pub right: Question,
}

/// Name of the diagnosis among the methods.
pub const DIAGNOSIS: &str = "diagnosis";

/// The diagnosis first, then its rivals.
pub const WAYS: [Way; 3] = [
    Way { name: DIAGNOSIS, color: FITTED, right: named_right },
    Way { name: "iid BIC", color: PURPLE, right: |s| s.bic_right },
    Way { name: "sparse regression", color: GREY, right: |s| s.sindy_right },
];

/// A model that predicts unseen runs.
pub struct Predictor {
    /// Name.
    pub name: &'static str,
    /// Its part in the comparison.
    pub target: &'static str,
    /// Colour.
    pub color: Color,
    /// Its held-out score \[%\].
    pub score: fn(&Score) -> Option<f64>,
}

/// From the paper's method to the oracle, which bounds what can be reached.
pub const MODELS: [Predictor; 4] = [
    Predictor {
        name: "refit only, the paper's method",
        target: "(baseline)",
        color: BASELINE,
        score: |s| s.refit_held_out,
    },
    Predictor { name: "base model of the diagnosis", target: "-", color: SKY, score: |s| s.base_held_out },
    Predictor { name: "with the mechanisms named", target: "-", color: FITTED, score: |s| s.named_held_out },
    Predictor { name: "oracle", target: "(bound)", color: ORACLE, score: |s| s.oracle_held_out },
];

/// Whether the diagnosis named the effect first, detected or not; on a null, whether it raised no alarm.
pub fn named_right(score: &Score) -> Option<bool> {
    match (score.false_alarm, score.detected) {
        (Some(alarm), _) => Some(!alarm),
        (None, Some(false)) => Some(false),
        (None, _) => score.first_right,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_case_fails_by_a_wrong_answer_and_not_by_a_weak_effect_that_is_not_detected() {
        let found = Score { snr_asked: Some(6.0), detected: Some(true), first_right: Some(true), ..Score::default() };
        assert!(!failed(&found) && failed(&Score { covered: Some(false), ..found.clone() }));
        let missed = Score { snr_asked: Some(6.0), detected: Some(false), ..Score::default() };
        assert!(failed(&missed) && !failed(&Score { snr_asked: Some(3.0), ..missed }));
        assert!(failed(&Score { false_alarm: Some(true), ..Score::default() }));
        assert!(failed(&Score { error: "stopped".into(), ..found }));
    }
}
