//! Every finding by itself: its interval, its size, and its proof on runs that no earlier step has used.
//! Which mechanisms are selected is decided in [`search`](super::search).
//!
//! | file | what |
//! |---|---|
//! | [`finding`], `describe` | what a finding contains, and how it is filled |
//! | [`influence`] | how far a finding changes what is predicted |
//! | [`unseen`], [`prove`] | a finding, and all findings, on unseen runs |
//! | `weigh`, [`grade`] | the tests of a finding, and its grade, a pure function of them |
//! | [`baseline`] | rival methods, for comparison with the diagnosis |
//! | `improved` | the model with the findings as it is written to a file |
//! | [`stability`] | whether an answer stays when the recordings are turned, mirrored, cut or thinned |

pub mod baseline;
pub(super) mod describe;
pub mod finding;
pub mod grade;
pub(super) mod improved;
pub mod influence;
pub mod prove;
pub mod stability;
pub mod unseen;
pub(super) mod weigh;
