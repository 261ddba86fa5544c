//! Doubts about a model before it is simulated: what it lacks that every ship has.
//! It runs no simulation; what a fit makes of the model is told by the fit.

use super::issue::{Issue, Severity};
use crate::model::Model;

/// What the values of a model leave out without a word.
pub fn audit_model(model: &Model) -> Vec<Issue> {
    let mut issues = Vec::new();
    if model.without_resistance() {
        let text =
            "the ship has no resistance: linear, quadratic and cubic are 0, as neither ship nor model file gives them";
        let next = "give `\"resistance.quadratic\" = ...` in [parameters] of the ship file; a fit starts from 0";
        issues.push(Issue::new(Severity::Warning, "no_resistance", text, next));
    }
    issues
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::demo::example;

    #[test]
    fn a_ship_without_resistance_is_told() {
        let mut model = example().unwrap().model;
        assert_eq!(audit_model(&model), []);
        for name in ["resistance.linear", "resistance.quadratic", "resistance.cubic"] {
            model.set(&[(name, 0.0)]).unwrap();
        }
        let told = audit_model(&model);
        assert!(told.len() == 1 && told[0].severity == Severity::Warning && told[0].next_step.contains("ship file"));
    }
}
