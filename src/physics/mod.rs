//! What a term is and what terms share: instant, flow, inertia, mechanism. Open to terms of other crates.
//! It depends on no list of terms, no model, no fit and no diagnosis.

pub mod catalogue;
pub mod flow;
pub mod inertia;
pub mod instant;
pub mod mechanism;
pub mod term;
pub mod validity;

pub use catalogue::Catalogue;
pub use flow::{Adjust, Flow, Inflow};
pub use inertia::{Inertia, Mobility};
pub use instant::{Form, Instant};
pub use mechanism::{Kind, Mechanism, Probe};
pub use term::{
    AnyTerm, CHUNK, Curvature, FEW, Gradient, Group, Lanes, MOST_PARAMETERS, NumDual, Number, Physics, Reach, Term,
    TermInfo,
};
pub use validity::{Quantity, Validity, degrees, range_in_words};
