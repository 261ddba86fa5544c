//! The figures of a diagnosis in the order of its parts.
//! What each shows is in the file that makes it; nothing is computed beyond means in bins.

use super::change::{held_out, hull_budget, moves};
use super::evidence::{confusability, ranking};
use super::force::{forces, tracks};
use super::pattern::{compass, pattern, regions};
use super::picture::Picture;
use super::stages::telling;
use crate::diagnose::Diagnosis;

/// Every picture that the diagnosis gives cause to.
#[must_use]
pub fn pictures(d: &Diagnosis) -> Vec<Picture> {
    let runs = telling(d);
    let all = [
        ranking(d),
        confusability(d),
        tracks(d, &runs),
        forces(d, &runs),
        pattern(d),
        compass(d),
        regions(d),
        moves(d),
        held_out(d),
        hull_budget(d),
    ];
    all.into_iter().flatten().collect()
}
