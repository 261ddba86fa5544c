//! Ship A with more parameters free than the paper's eleven.
//! It times nothing; the bench of the engine asks what further parameters cost.

use crate::case::ship_a;
use crate::free_more::free_more;
use trimtab::model::Model;

/// Free values where a model starts.
pub fn start(model: &Model) -> Vec<f64> {
    model.free().iter().map(|i| model.parameters[*i].value).collect()
}

/// Ship A with `count` parameters free: the paper's eleven, then those of hull and flow, and of the term `symmetric` where the model has it.
pub fn freed(count: usize, symmetric: bool) -> Model {
    let mut model = ship_a();
    if symmetric {
        model.add_term("symmetric").unwrap_or_else(|e| unreachable!("{e}"));
    }
    free_more(&mut model, count).unwrap_or_else(|e| unreachable!("{e}"));
    assert_eq!(model.free().len(), count);
    model
}
