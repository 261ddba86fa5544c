//! The rules of the house and the guide, both read from the source.
//! Nothing is computed here.

// A helper that cannot do its work ends the test with it.
#![allow(clippy::unwrap_used, clippy::panic)]

mod graph;
mod guide;
mod rules;
mod source;
