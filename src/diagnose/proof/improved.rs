//! The model as it is written to a file: the user's terms and those of the mechanisms that act, without neutral ones, each parameter inside
//! its bounds. It decides nothing.

use crate::likelihood::algebra::pseudo_inverse;
use crate::likelihood::estimate::{Estimate, FreeParameter};
use crate::model::Model;
use crate::recording::Run;
use crate::simulate::Integration;
use crate::uncertainty::Uncertainty;
use std::collections::BTreeMap;

/// The model as it is written to a file: the user's terms and those that were found to act, nothing that is neutral.
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

/// The covariance of the parameters of `improved`, from the filter's information and the priors at an estimate. Additions in single
/// sessions are profiled out.
pub fn uncertainty(found: &Estimate, improved: &Model, integration: Integration, runs: &[Run]) -> Option<Uncertainty> {
    let covariance = pseudo_inverse(&found.information(integration, runs));
    let name = |f: &FreeParameter| found.model.parameters[f.column.parameter].name.clone();
    let kept: Vec<usize> = (0..found.free.len())
        .filter(|i| found.free[*i].sessions.is_none() && improved.index(&name(&found.free[*i])).is_some())
        .collect();
    // What the data and the priors say nothing of has a variance of 0 in a pseudo-inverse.
    let known = |i: usize| covariance[(i, i)] > 0.0;
    let entry = |i: &usize, j: &usize| {
        let scale = found.free[*i].column.scale * found.free[*j].column.scale;
        (known(*i) && known(*j)).then(|| covariance[(*i, *j)] * scale)
    };
    let names: Vec<String> = kept.iter().map(|i| name(&found.free[*i])).collect();
    let table: Vec<Vec<Option<f64>>> = kept.iter().map(|i| kept.iter().map(|j| entry(i, j)).collect()).collect();
    Uncertainty::new("information of the filter and priors", None, &names, &table)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{column, model, with};

    #[test]
    fn a_file_contains_the_terms_that_act_and_those_that_differ_between_sessions_and_no_neutral_one() {
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
