//! What columns stand for: names, units, signs and senses, each decided with its evidence, and signals in SI units.
//! How files are laid out is read elsewhere.

pub(super) mod actuators;
mod agree;
pub(super) mod choose;
mod evidence;
pub(super) mod names;
mod orders;
mod scale;
mod sides;
pub(super) mod take;
mod vocabulary;
