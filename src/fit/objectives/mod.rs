//! What a fit minimises: the weighted trajectory cost, and the likelihood with fixed gains.
//!
//! | file | what |
//! |---|---|
//! | `cost` | the weighted trajectory cost and its derivatives |
//! | `sums` | sums over samples behind the cost, its gradient and the Gauss-Newton matrix |
//! | `objective` | what a fit minimises, as its solver sees it |
//! | `evaluations` | the last evaluations of an objective, each made once |
//! | `innovations` | the likelihood with the gains of the filter fixed |

pub mod cost;
#[cfg(feature = "ipopt")]
pub(in crate::fit) mod evaluations;
pub(in crate::fit) mod innovations;
#[cfg(feature = "ipopt")]
pub(in crate::fit) mod objective;
pub(in crate::fit) mod sums;
