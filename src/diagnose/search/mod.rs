//! Which mechanisms are selected: fit of the base model, score tests, forward selection, and the tests of what it leaves.
//! What a selected mechanism is worth by itself is in [`proof`](super::proof).
//!
//! | file | what |
//! |---|---|
//! | `problem` | what every refit shares |
//! | [`base`] | the base model, fitted to audited recordings |
//! | [`screen`] | the score test of every mechanism |
//! | `event` | the tests of the base model, and an event in time before any mechanism |
//! | `present`, `eligible` | what the model has already, and what may be named |
//! | `together` | errors of sensors that their consistency shows |
//! | `saturated` | errors of sensors that are hidden in the base and its noise |
//! | `compete` | refits of a leader and its rivals |
//! | `select`, `selected` | forward selection with removal and replacement |
//! | `alike`, `residual` | mechanisms with like effects, and the tests of what is left |
//! | [`decide`] | the decision, a pure function of the table of tests |

pub(super) mod alike;
pub mod base;
pub(super) mod compete;
pub mod decide;
pub(super) mod eligible;
pub(super) mod event;
pub(super) mod present;
pub(super) mod problem;
pub(super) mod residual;
pub(super) mod saturated;
pub mod screen;
pub(super) mod select;
pub(super) mod selected;
pub(super) mod together;
