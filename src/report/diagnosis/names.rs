//! The names of mechanisms and parameters, and the plain words for them.
//! Both are in the catalogue; only what is not in it is worded here.

use crate::diagnose::proof::finding::{GENERIC, PUSH, PUSH_TITLE};
use crate::model::Model;
use crate::physics::{Catalogue, Kind, Mechanism};

/// The names of all mechanisms that can be named or withheld in a model of these terms.
pub fn mechanism_names(catalogue: &Catalogue) -> impl Iterator<Item = &'static str> {
    catalogue.iter().flat_map(|t| t.info().mechanisms).map(|m| m.name).chain([PUSH])
}

/// The plain words for a mechanism; its name when it is not in the catalogue of the model.
pub(super) fn title_of<'a>(model: &Model, name: &'a str) -> &'a str {
    match name {
        PUSH => PUSH_TITLE,
        GENERIC => "something that is not in the catalogue",
        _ => mechanism(model, name).map_or(name, |m| m.title),
    }
}

/// What kind of thing a mechanism is; a force where it is not in the catalogue of the model.
pub(super) fn kind_of(model: &Model, name: &str) -> Kind {
    mechanism(model, name).map_or(Kind::Ship, |m| m.kind)
}

fn mechanism(model: &Model, name: &str) -> Option<&'static Mechanism> {
    model.catalogue().iter().flat_map(|t| t.info().mechanisms).find(|m| m.name == name)
}

/// The plain words for a parameter, in the catalogue of the model.
pub(super) fn about(model: &Model, name: &str) -> Option<&'static str> {
    let (term, parameter) = name.split_once(" [").map_or(name, |(name, _)| name).split_once('.')?;
    let info = model.catalogue().find(term)?.info();
    info.parameters.iter().find(|p| p.name == parameter).map(|p| p.about)
}
