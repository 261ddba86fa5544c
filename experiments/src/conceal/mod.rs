//! Concealed cases: recordings of a ship under an effect concealed from the diagnosis, and a sealed manifest that only the judge reads.
//! The generator shares no term, integrator or coefficient with the library's model; only judge and campaign read its output.
//!
//! A case is a [`spec::Spec`]: a truth family, effects with their strength, a background, a design and a seed.
//! [`case::Case::make`] simulates it; [`case::Case::write`] writes `study/` (all that the diagnosis may see) and
//! `sealed/manifest.json` (what the judge opens afterwards). Random streams are split by purpose, so that a case with and without
//! its effect has the same ship, plans, gusts and noise.

pub mod baselines;
pub mod campaign;
pub mod case;
pub mod effects;
pub mod error;
pub mod family;
pub mod judge;
pub mod meter;
pub mod runner;
pub mod sailing;
pub mod seal;
pub mod signal;
pub mod spec;
pub mod strength;

#[cfg(test)]
mod tests;
