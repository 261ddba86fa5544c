//! A dossier in a few lines for the terminal: claim, errors on test runs, checks, causes, and what is missing.
//! The page has the rest.

use crate::numerals::{number_of, sig};
use crate::report::dossier::content::Dossier;
use crate::report::table::Table;

/// The summary.
#[must_use]
pub fn summary(d: &Dossier) -> String {
    let mut text = format!("{}: {}\n\n", d.study, d.claim.statement);
    if let Some(t) = &d.validation.test {
        let number =
            |e: Option<crate::evaluate::Estimate>, f: f64| e.map_or("not measured".into(), |e| sig(e.value * f, 3));
        let [x, y, psi, u, ..] = t.md_fitted;
        text += &format!(
            "{}: mean deviation x {} m, y {} m, heading {} deg, speed {} m/s; cVDM {} %\n",
            number_of(t.runs, "test run"),
            number(x, 1.0),
            number(y, 1.0),
            number(psi, 1f64.to_degrees()),
            number(u, 1.0),
            number(t.cvdm_fitted, 1.0)
        );
    }
    let passed = d.verification.checks.iter().filter(|c| c.passed).count();
    text += &format!("{passed} of {} checks of the verification passed", d.verification.checks.len());
    let failed: Vec<&str> = d.verification.checks.iter().filter(|c| !c.passed).map(|c| c.key).collect();
    text += &if failed.is_empty() { ".\n".to_owned() } else { format!("; failed: {}.\n", failed.join(", ")) };
    if let Some(c) = &d.causes {
        text += &format!(
            "Causes of error: {} found, {} refuted, {} not excluded.\n",
            c.found.len(),
            c.refuted.len(),
            c.not_excluded.len()
        );
    }
    let mut table = Table::new(["section", "missing"]);
    for (i, s) in d.sections.iter().enumerate().filter(|(_, s)| !s.missing.is_empty()) {
        table.row([format!("{} {}", i + 1, s.title), s.missing.join("; ")]);
    }
    if !table.rows().is_empty() {
        text += &format!("\n{}\n", table.wrapped(120));
    }
    text
}
