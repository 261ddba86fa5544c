//! The experiments: truth simulators with ships and data, the paper's evaluation, concealed cases, and two real hulls.
//! They are not part of the product: the library never uses them, and they use the library through its public API alone.

pub mod conceal;
pub mod demo;
pub mod demo_concealed;
pub mod drawn_fits;
pub mod folders;
pub mod freed;
pub mod injected;
pub mod interleaved;
pub mod killed;
pub mod mutated;
pub mod paper;
pub mod process;
pub mod real;
pub mod rivals;
pub mod rows;
pub mod truth;
pub mod workers;
