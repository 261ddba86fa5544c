//! The figures of a diagnosis in the order of its parts.
//! What each shows is in the file that draws it; nothing is computed beyond means in bins.

use super::change::{held_out, hull_budget, moves};
use super::evidence::{confusability, ranking};
use super::force::{forces, tracks};
use super::pattern::{compass, pattern, regions};
use super::picture::Picture;
use super::stages::telling;
use crate::diagnose::Diagnosis;
use crate::plot::FigureError;
use rayon::prelude::*;

/// Every picture that the diagnosis gives cause to.
///
/// # Errors
/// When a figure cannot be drawn.
pub fn pictures(d: &Diagnosis) -> Result<Vec<Picture>, FigureError> {
    let runs = telling(d);
    let sketches = [
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
    sketches.into_par_iter().flatten().map(|sketch| sketch.drawn()).collect()
}
