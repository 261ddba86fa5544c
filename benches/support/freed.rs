//! Ship A with more parameters free than the paper's eleven.
//! It times nothing; the bench of the engine asks what further parameters cost.

use crate::case::ship_a;
use trimtab::model::Model;

/// Free values where a model starts.
pub fn start(model: &Model) -> Vec<f64> {
    model.free().iter().map(|i| model.parameters[*i].value).collect()
}

/// Ship A with `count` parameters free: the paper's eleven, then those of hull (mass and yaw inertia stay fixed), flow, and of the
/// term `symmetric` where the model has it.
pub fn freed(count: usize, symmetric: bool) -> Model {
    let mut model = ship_a();
    if symmetric {
        model.add_term("symmetric").unwrap_or_else(|e| unreachable!("{e}"));
    }
    let mut left = count - model.free().len();
    for term in ["hull.", "flow.", "symmetric."] {
        for p in model.parameters.iter_mut().filter(|p| p.name.starts_with(term)) {
            if left > 0 && !["hull.mass", "hull.inertia"].contains(&p.name.as_str()) {
                p.free = true;
                left -= 1;
            }
        }
    }
    assert_eq!(model.free().len(), count);
    model
}
