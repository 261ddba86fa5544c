//! The seven parts of a diagnosis in words, in the order of every report.
//! What each says is in its own file; how they are set is in `summary` and `page`.

use super::findings::model;
use super::limits::{limits, next_trial, still_open};
use super::location::location;
use super::proof::proof;
use super::verdict::verdict;
use crate::diagnose::Diagnosis;

/// A part of the report: a heading and its statements.
#[derive(Clone, Debug)]
pub struct Part {
    /// Heading.
    pub heading: &'static str,
    /// Statements, each a line of its own.
    pub lines: Vec<String>,
}

/// The seven parts of the report.
#[must_use]
pub fn parts(d: &Diagnosis) -> Vec<Part> {
    vec![
        Part { heading: "VERDICT", lines: verdict(d) },
        Part { heading: "WHERE", lines: location(d) },
        Part { heading: "MODEL", lines: model(d) },
        Part { heading: "PROOF", lines: proof(d) },
        Part { heading: "STILL OPEN", lines: still_open(d) },
        Part { heading: "LIMITS", lines: limits(d) },
        Part { heading: "NEXT TRIAL", lines: next_trial(d) },
    ]
}
