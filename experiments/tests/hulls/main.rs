//! The paper's figures on a part of its data, the two real hulls, and programs and measurements from outside.
//! Cases whose truth is concealed are in `campaigns`.

// A helper that cannot do its work ends the test with it.
#![allow(clippy::unwrap_used, clippy::panic)]

mod paper;
mod real;
mod validation;
