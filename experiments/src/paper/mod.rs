//! The paper's evaluation made anew: data sets of the truth simulators, fits, and every table and figure.
//! It adds no physics and no method; those are the library's.
//!
//! Each table or figure is an [`artefact::Artefact`] in a file of its own; the binary `paper` makes all of them, or those named.
//! Each prints our numbers beside the paper's and writes pictures and the CSV behind them. One seed gives the same bits.

pub mod artefact;
pub mod captive_baseline;
pub mod case;
pub mod coverage;
pub mod error;
pub mod gradient;
pub mod list;
pub mod pictures;
pub mod published;
pub mod run;
pub mod sheet;
pub mod target;
