//! What is reported beside the findings: a law for what is not in the catalogue, and whether port and starboard differ.
//! Neither is a finding: they name no cause.
//!
//! | file | what |
//! |---|---|
//! | `monomial` | a monomial in SI units |
//! | `sparse` | the few monomials that the data ask for |
//! | `fitted` | the law: chosen, refitted, proved on unseen runs |
//! | [`sides`] | whether port and starboard differ |

mod fitted;
mod monomial;
pub mod sides;
pub(super) mod sparse;

pub use fitted::{Law, LawTerm, Visited};
