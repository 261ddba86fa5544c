//! Runs and models of the diagnosis experiments on real hulls: selections, and copies with a channel or a term withheld.
//! It diagnoses nothing.

use trimtab::model::Model;
use trimtab::recording::{Run, Split};

use super::error::RealError;
use super::hull::Hull;

/// The windows of one split as runs of the diagnosis.
///
/// # Errors
/// [`RealError::Study`].
pub fn runs(hull: &Hull, split: Split) -> Result<Vec<Run>, RealError> {
    hull.windows(split)
}

/// The runs as if no wind had been recorded.
pub fn without_wind(runs: &[Run]) -> Vec<Run> {
    let mut out = runs.to_vec();
    out.iter_mut().flat_map(|r| &mut r.inputs).for_each(|i| i.wind = [0.0; 2]);
    out
}

/// The model as if it had never had a term.
///
/// # Errors
/// [`RealError::Model`].
pub fn without_term(model: &Model, term: &str) -> Result<Model, RealError> {
    let mut file = model.to_file();
    file.terms.retain(|t| t != term);
    file.parameters.retain(|name, _| !name.starts_with(&format!("{term}.")));
    Ok(Model::from_file(&file, model.ship.clone())?)
}

/// Sessions of runs, in their order.
pub fn sessions(runs: &[Run]) -> Vec<String> {
    let mut out: Vec<String> = Vec::new();
    for r in runs {
        if !out.contains(&r.session) {
            out.push(r.session.clone());
        }
    }
    out
}

/// The runs with each recording a session of its own.
pub fn by_recording(runs: &[Run]) -> Vec<Run> {
    runs.iter().map(|r| Run { session: r.recording.clone(), ..r.clone() }).collect()
}
