//! More parameters free than the paper's eleven: those of hull and flow, and of the term `symmetric` beyond these.
//! Nothing is fitted or timed here; benches include this file, so that they and the figures free the same.

// Each program that includes this file takes a part of it.
#![allow(dead_code)]

use trimtab::model::{Model, ModelError};

/// Frees further parameters without priors until `count` are free: those of the hull (mass and yaw inertia stay fixed), of the flow, and
/// then of the term `symmetric`, which is added for them.
///
/// # Errors
/// A term that cannot be added.
pub fn free_more(model: &mut Model, count: usize) -> Result<(), ModelError> {
    for term in ["hull.", "flow.", "symmetric."] {
        let left = count.saturating_sub(model.free().len());
        if left > 0 && term == "symmetric." && !model.term_names().contains(&"symmetric") {
            model.add_term("symmetric")?;
        }
        let fixed = |name: &str| ["hull.mass", "hull.inertia"].contains(&name);
        let own = model.parameters.iter_mut().filter(|p| p.name.starts_with(term) && !p.free && !fixed(&p.name));
        own.take(left).for_each(|p| p.free = true);
    }
    Ok(())
}
