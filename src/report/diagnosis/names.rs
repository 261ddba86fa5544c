//! The names of mechanisms and parameters, and the plain words for them.
//! The catalogue holds both; only what it does not hold is worded here.

use crate::diagnose::finding::{GENERIC, PUSH, PUSH_TITLE};
use crate::physics::Mechanism;
use crate::terms::CATALOGUE;

/// The names of all mechanisms that can be named or withheld.
pub fn mechanism_names() -> impl Iterator<Item = &'static str> {
    mechanisms().map(|m| m.name).chain([PUSH])
}

fn mechanisms() -> impl Iterator<Item = &'static Mechanism> {
    CATALOGUE.iter().flat_map(|t| t.info().mechanisms)
}

/// The plain words for a mechanism; its name when the catalogue does not hold it.
#[must_use]
pub fn title_of(name: &str) -> &str {
    match name {
        PUSH => PUSH_TITLE,
        GENERIC => "something that the catalogue does not hold",
        _ => mechanisms().find(|m| m.name == name).map_or(name, |m| m.title),
    }
}

/// The plain words for a parameter.
pub(super) fn about(name: &str) -> Option<&'static str> {
    let (term, parameter) = name.split_once(" [").map_or(name, |(name, _)| name).split_once('.')?;
    let info = CATALOGUE.iter().map(|t| t.info()).find(|i| i.name == term)?;
    info.parameters.iter().find(|p| p.name == parameter).map(|p| p.about)
}
