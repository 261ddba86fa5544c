//! What was answered to the cases: rows, scores, summary and figure.
//! No case is made or run here.

pub mod failure;
pub mod figure;
pub mod results;
pub mod row;
pub mod said;
pub mod score;
pub mod summary;
