//! What a term is and what terms share: instant, flow, inertia, mechanism. Open to terms of other crates.
//! It knows no list of terms, no model and nothing of fits or diagnoses.

pub mod flow;
pub mod inertia;
pub mod instant;
pub mod mechanism;
pub mod term;
pub mod validity;

pub use flow::{Adjust, Flow, to_body};
pub use inertia::Inertia;
pub use instant::{Form, Instant};
pub use mechanism::{Kind, Mechanism, Probe};
pub use term::{
    AnyTerm, CHUNK, Curvature, Gradient, GradientLanes, Group, Lanes, NumDual, Number, Physics, Term, TermInfo,
};
pub use validity::{Quantity, Validity, degrees, range_in_words};
