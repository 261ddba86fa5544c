//! The model as a file should hold it: the user's terms and those of the mechanisms that act, without neutral ones.
//! It takes values from an estimate and changes none.

use super::estimate::FreeParameter;
use crate::model::Model;
use std::collections::BTreeMap;

/// The model as a file should hold it: the user's terms and those that were found to act, nothing that is neutral.
pub fn trimmed(found: &Model, user: &Model, free: &[FreeParameter]) -> Model {
    let mut model = user.clone();
    let wanted = |name: &str| {
        let prefix = format!("{name}.");
        found.parameters.iter().enumerate().any(|(i, p)| {
            p.name.starts_with(&prefix)
                && (p.value != (p.info.default)(&found.ship)
                    || found.sessions.values().flatten().any(|(j, v)| *j == i && *v != 0.0))
        })
    };
    for term in found.term_names() {
        if wanted(term) {
            // Every term of the catalogue was added to the same ship before, so this cannot fail.
            let _ = model.add_term(term);
        }
    }
    for p in &mut model.parameters {
        if let Some(i) = found.index(&p.name) {
            p.value = found.parameters[i].value;
            p.free |= free.iter().any(|f| f.column.parameter == i && f.prior.is_none());
        }
    }
    model.sessions = BTreeMap::new();
    for (session, additions) in &found.sessions {
        let list: Vec<(usize, f64)> = additions
            .iter()
            .filter(|(_, v)| *v != 0.0)
            .filter_map(|(i, v)| model.index(&found.parameters[*i].name).map(|j| (j, *v)))
            .collect();
        if !list.is_empty() {
            model.sessions.insert(session.clone(), list);
        }
    }
    model
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::estimate::FreeParameter;
    use crate::diagnose::example::{column, model, with};

    #[test]
    fn a_file_holds_the_terms_that_act_and_those_that_differ_between_sessions_and_no_neutral_one() {
        let full = model();
        let user = full.restricted(|t| !["current", "mean_wind", "heading_bias"].contains(&t));
        let mut found = with(&[("current.north", 0.2)]);
        let bias = found.find("heading_bias.bias").unwrap();
        found.sessions.insert("a".into(), vec![(bias, 0.01)]);
        found.sessions.insert("b".into(), vec![(bias, 0.0)]);
        let free = [FreeParameter::common(column(&found, "current.north"), None)];
        let out = trimmed(&found, &user, &free);
        let names = out.term_names();
        assert!(names.contains(&"current") && names.contains(&"heading_bias") && !names.contains(&"mean_wind"));
        let north = out.find("current.north").unwrap();
        assert!(out.parameters[north].value == 0.2 && out.parameters[north].free);
        assert_eq!(out.sessions.keys().collect::<Vec<_>>(), ["a"]);
        assert_eq!(out.sessions["a"], [(out.find("heading_bias.bias").unwrap(), 0.01)]);
    }
}
