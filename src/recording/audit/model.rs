//! Doubts about a model before it is simulated: what it lacks that every ship has.
//! It runs no simulation; the fit reports what it makes of the model.

use super::issue::{Issue, Severity};
use crate::model::{BASE, Model, Parameter};
use crate::physics::TermInfo;

/// What the values of a model leave out silently.
pub fn audit_model(model: &Model) -> Vec<Issue> {
    let mut issues = Vec::new();
    if model.without_resistance() {
        let text =
            "the ship has no resistance: linear, quadratic and cubic are 0, as neither ship nor model file gives them";
        let next = "give `\"resistance.quadratic\" = ...` in [parameters] of the ship file; a fit starts from 0";
        issues.push(Issue::new(Severity::Warning, "no_resistance", text, next));
    }
    for term in idle_terms(model) {
        let count = term.parameters.len();
        let what = if count == 1 { "its parameter is".to_owned() } else { format!("its {count} parameters are") };
        let text =
            format!("the term `{}` does nothing: {what} fixed at the values at which it has no effect", term.name);
        let lines: Vec<String> = term
            .parameters
            .iter()
            .map(|p| {
                let known = (p.spread)(&model.ship).is_finite();
                let how = if known { "prior = \"default\"" } else { "free = true" };
                format!("`\"{}.{}\" = {{ {how} }}`", term.name, p.name)
            })
            .collect();
        let next = format!(
            "free it with `trimtab fit --free {}`, or in [parameters] of the model file: {}; else leave the term out",
            term.name,
            lines.join(", ")
        );
        issues.push(Issue::new(Severity::Warning, "idle_term", text, next));
    }
    issues
}

/// Terms other than the base ones that have no effect, in no session, and that no fit may change.
fn idle_terms(model: &Model) -> Vec<&'static TermInfo> {
    let added = |name: &str| model.sessions.values().flatten().any(|(i, _)| model.parameters[*i].name == name);
    let rests = |term: &&TermInfo| {
        let own = |p: &&Parameter| p.name.strip_prefix(term.name).is_some_and(|rest| rest.starts_with('.'));
        let rests = |p: &Parameter| !p.free && p.value == (p.info.default)(&model.ship) && !added(&p.name);
        !BASE.contains(&term.name) && !term.parameters.is_empty() && model.parameters.iter().filter(own).all(rests)
    };
    model.terms().filter(rests).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::demo::example;

    #[test]
    fn a_term_that_does_nothing_is_reported_with_the_lines_that_free_it() {
        let mut model = example().unwrap().model;
        model.add_term("wind").unwrap();
        let found = audit_model(&model);
        assert!(found.len() == 1 && found[0].fault == "idle_term" && found[0].text.contains("`wind`"), "{found:?}");
        let names: Vec<String> =
            model.parameters.iter().map(|p| p.name.clone()).filter(|n| n.starts_with("wind.")).collect();
        assert!(names.iter().all(|n| found[0].next_step.contains(&format!("\"{n}\" = "))), "{found:?}");
        let mut freed = model.clone();
        freed.release("wind").unwrap();
        assert_eq!(audit_model(&freed), []);
        model.set(&[(names[0].as_str(), 0.7)]).unwrap();
        assert_eq!(audit_model(&model), []);
    }

    #[test]
    fn a_ship_without_resistance_is_reported() {
        let mut model = example().unwrap().model;
        assert_eq!(audit_model(&model), []);
        for name in ["resistance.linear", "resistance.quadratic", "resistance.cubic"] {
            model.set(&[(name, 0.0)]).unwrap();
        }
        let found = audit_model(&model);
        assert!(found.len() == 1 && found[0].severity == Severity::Warning && found[0].next_step.contains("ship file"));
    }
}
