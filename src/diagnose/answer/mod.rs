//! The answer: what is named and withdrawn, the verdict, the study's error rates, and the document that contains all of it.
//! No mechanism is searched for here.
//!
//! | file | what |
//! |---|---|
//! | `analysis` | one analysis with its verdict, and its repetition on transformed recordings |
//! | [`cause`] | what acts in a recording that differs from all others |
//! | `conclude` | the verdict, a pure function of grades and tests |
//! | [`calibrate`] | error rates on simulated recordings |
//! | [`models`] | the study's own model, the base and the improved one on unseen runs, and which is written |
//! | [`sailed`] | runs as recorded and simulated, for pictures |
//! | [`diagnosis`] | the document |
//! | `summary`, `words` | its lists; the verdict in a sentence |

pub(super) mod analysis;
pub mod calibrate;
pub mod cause;
mod conclude;
pub mod diagnosis;
pub mod models;
pub mod sailed;
pub(crate) mod summary;
pub(super) mod words;
