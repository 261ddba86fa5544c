//! The catalogue of effects that can be concealed, in a fixed order.
//! It defines no effect.

use super::effect::Entry;
use super::{environment, hull, machinery, sensor, withheld};

/// Every effect.
pub fn catalogue() -> impl Iterator<Item = &'static Entry> {
    [environment::ENTRIES, machinery::ENTRIES, hull::ENTRIES, sensor::ENTRIES, withheld::ENTRIES].into_iter().flatten()
}

/// The effect of that name.
pub fn find(name: &str) -> Option<&'static Entry> {
    catalogue().find(|e| e.name == name)
}
