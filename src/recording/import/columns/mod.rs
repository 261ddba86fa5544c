//! What columns stand for: names, units, signs and senses, each decided with its evidence, and signals in SI units.
//! How files are laid out is read elsewhere.

pub(super) mod actuators;
mod agree;
pub(super) mod choose;
mod evidence;
pub(super) mod fills;
pub(super) mod geodesy;
pub(super) mod log;
pub(super) mod motion;
pub(super) mod names;
mod orders;
pub(super) mod place;
mod scale;
pub(super) mod signal;
pub(super) mod take;
mod vocabulary;
