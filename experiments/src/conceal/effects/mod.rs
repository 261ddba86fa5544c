//! The effects that can be concealed: each a physical law of published form, none of them the fitter's own form.
//! An effect changes the ship, the actuators or the sensors; it neither integrates nor writes anything.
//!
//! # Adding an effect
//! Write a struct that implements [`effect::Physics`] in the file of its group and one [`effect::Entry`] in that file's list; the
//! generator, the campaign, the judge and the tests over the whole catalogue read it from there. At size 0 it must have no effect.

pub mod catalogue;
pub mod effect;
pub mod environment;
pub mod hull;
pub mod machinery;
pub mod sensor;
pub mod withheld;
