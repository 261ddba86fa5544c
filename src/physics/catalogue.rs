//! A list of terms that models can be made of. The project's own list is in `terms`; a term of another crate is added with
//! [`Catalogue::with`]. It has no parameter values.

use super::term::AnyTerm;
use std::sync::Arc;

/// The terms that a model file may name and a diagnosis may add, in the order in which their forces are added up.
#[derive(Clone)]
pub struct Catalogue(Arc<[&'static dyn AnyTerm]>);

impl Catalogue {
    /// A catalogue of these terms.
    pub fn new(terms: &[&'static dyn AnyTerm]) -> Self {
        Self(terms.into())
    }

    /// This catalogue and one more term; a term of the same name is replaced.
    pub fn with(&self, term: &'static dyn AnyTerm) -> Self {
        let others = self.iter().filter(|t| t.info().name != term.info().name);
        Self(others.chain([term]).collect())
    }

    /// The terms, in order.
    pub fn iter(&self) -> impl Iterator<Item = &'static dyn AnyTerm> + '_ {
        self.0.iter().copied()
    }

    /// The term of that name.
    pub fn find(&self, name: &str) -> Option<&'static dyn AnyTerm> {
        self.iter().find(|t| t.info().name == name)
    }
}
