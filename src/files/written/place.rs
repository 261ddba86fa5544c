//! Where in a TOML document an error is: the way from its root to the entry with that place in the text.
//! What is wrong there is said elsewhere.

use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// One step on the way to an entry.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Step {
    /// Into a table.
    Key(String),
    /// Into a list.
    Index(usize),
}

/// The entry whose key or value has this place in the text, or else the innermost one around it; the root has no steps.
pub(super) fn entry_at(root: &DeTable<'_>, span: &Range<usize>) -> Vec<Step> {
    let mut found = Search { span, exact: None, around: Vec::new(), way: Vec::new() };
    found.table(root);
    found.exact.unwrap_or(found.around)
}

struct Search<'a> {
    span: &'a Range<usize>,
    exact: Option<Vec<Step>>,
    around: Vec<Step>,
    way: Vec<Step>,
}

impl Search<'_> {
    fn table(&mut self, table: &DeTable<'_>) {
        for (key, value) in table.iter() {
            self.way.push(Step::Key(key.get_ref().to_string()));
            if key.span() == *self.span && self.exact.is_none() {
                self.exact = Some(self.way.clone());
            }
            self.value(value);
            self.way.pop();
        }
    }

    fn value(&mut self, value: &Spanned<DeValue<'_>>) {
        let own = value.span();
        if own == *self.span && self.exact.is_none() {
            self.exact = Some(self.way.clone());
        }
        if own.start <= self.span.start && self.span.end <= own.end && self.way.len() > self.around.len() {
            self.around.clone_from(&self.way);
        }
        match value.get_ref() {
            DeValue::Table(table) => self.table(table),
            DeValue::Array(list) => {
                for (i, item) in list.iter().enumerate() {
                    self.way.push(Step::Index(i));
                    self.value(item);
                    self.way.pop();
                }
            }
            _ => {}
        }
    }
}

/// A step down from a value.
fn down<'a, 'i>(value: &'a mut DeValue<'i>, step: &Step) -> Option<&'a mut DeValue<'i>> {
    match (value, step) {
        (DeValue::Table(table), Step::Key(key)) => table.get_mut(key.as_str()).map(Spanned::get_mut),
        (DeValue::Array(list), Step::Index(index)) => list.get_mut(*index).map(Spanned::get_mut),
        _ => None,
    }
}

/// The value at the end of a way.
pub(super) fn value_at<'a, 'i>(root: &'a mut DeValue<'i>, way: &[Step]) -> Option<&'a mut DeValue<'i>> {
    way.iter().try_fold(root, down)
}

/// Takes an entry out; `false` where there is nothing to take, as at the root.
pub(super) fn take(root: &mut DeValue<'_>, way: &[Step]) -> bool {
    let Some((last, before)) = way.split_last() else { return false };
    match (value_at(root, before), last) {
        (Some(DeValue::Table(table)), Step::Key(key)) => table.remove(key.as_str()).is_some(),
        (Some(DeValue::Array(list)), Step::Index(index)) if *index < list.len() => {
            *list = list.iter().enumerate().filter(|(i, _)| i != index).map(|(_, item)| item.clone()).collect();
            true
        }
        _ => false,
    }
}
