//! Exact injections into recordings of real ships: the truth is known and the ship, its structure and its noise are real.
//! The injector shares no code with model or diagnosis; it handles recordings as plain tables, and only damaged copies leave it.
//!
//! A [`plan::Planned`] case is a [`configuration::Configuration`] (which recordings, how cut, turned and modelled) with what is
//! injected. [`case`] writes `study/`, all that the diagnosis may see, and `sealed/manifest.json`, which the judge opens
//! after the diagnosis has ended. Most cases name a partner: the same configuration with nothing injected, so that what is
//! found with it less what is found without it is what was injected.

pub mod answers;
pub mod case;
pub mod configuration;
pub mod effect;
pub mod error;
pub mod operation;
pub mod plan;
pub mod record;
pub mod runner;
pub mod seal;
pub mod set;
pub mod symmetry;
