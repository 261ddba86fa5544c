//! Parts of a page read from a JSON document: every number carries its key and its value in the document.
//! Which of them are shown, and where, is decided by the page.

use crate::numerals::{DASH, fixed, sig};
use maud::{Markup, html};
use serde_json::Value;

/// A document, or a part of it with its key.
#[derive(Clone)]
pub(super) struct Reader<'a> {
    key: String,
    value: &'a Value,
}

/// How a number is written.
#[derive(Clone, Copy)]
pub(super) enum Digits {
    /// So many significant digits.
    Significant(usize),
    /// So many decimals.
    Decimals(usize),
}

impl<'a> Reader<'a> {
    /// A whole document.
    pub(super) fn new(value: &'a Value) -> Self {
        Self { key: String::new(), value }
    }

    /// A member.
    pub(super) fn at(&self, name: &str) -> Self {
        let key = if self.key.is_empty() { name.to_owned() } else { format!("{}.{name}", self.key) };
        Self { key, value: &self.value[name] }
    }

    /// A member of a member.
    pub(super) fn path(&self, names: &[&str]) -> Self {
        names.iter().fold(self.clone(), |at, name| at.at(name))
    }

    /// The entries of a list; none where there is no list.
    pub(super) fn entries(&self) -> Vec<Self> {
        let entry = |(i, value)| Self { key: format!("{}[{i}]", self.key), value };
        self.value.as_array().map_or_else(Vec::new, |list| list.iter().enumerate().map(entry).collect())
    }

    /// Whether there is a value.
    pub(super) fn is_there(&self) -> bool {
        !self.value.is_null()
    }

    /// Whether the value is `true`.
    pub(super) fn holds(&self) -> bool {
        self.value == &Value::Bool(true)
    }

    /// The value as text; empty where it is none.
    pub(super) fn text(&self) -> &'a str {
        self.value.as_str().unwrap_or("")
    }

    /// The value as a number.
    pub(super) fn float(&self) -> Option<f64> {
        self.value.as_f64()
    }

    /// A number in the unit that people read, which is `factor` times its own; a dash where there is none.
    pub(super) fn number(&self, factor: f64, digits: Digits) -> Markup {
        let Some(value) = self.float() else { return html! { (DASH) } };
        let text = match digits {
            Digits::Significant(n) => sig(value * factor, n),
            Digits::Decimals(n) => fixed(value * factor, n),
        };
        html! { data value=(value) data-key=(self.key) data-factor=(factor) { (text) } }
    }

    /// A count, written in full.
    pub(super) fn count(&self) -> Markup {
        self.number(1.0, Digits::Decimals(0))
    }

    /// A pair of numbers as an interval in brackets; nothing where there is none.
    pub(super) fn interval(&self, factor: f64, digits: Digits) -> Markup {
        match self.entries().as_slice() {
            [low, high] => html! { "[" (low.number(factor, digits)) ", " (high.number(factor, digits)) "]" },
            _ => html! {},
        }
    }

    /// An estimate with `value` and `ci95`.
    pub(super) fn estimate(&self, factor: f64, digits: Digits) -> Markup {
        html! { (self.at("value").number(factor, digits)) " " (self.at("ci95").interval(factor, digits)) }
    }
}

/// Factor and name of the unit in which people read an SI unit: degrees for radians, tonnes for kg.
pub(super) fn human(unit: &str) -> (f64, &str) {
    const DEGREES: f64 = 180.0 / std::f64::consts::PI;
    match unit {
        "rad" => (DEGREES, "deg"),
        "rad/s" => (DEGREES, "deg/s"),
        "-" => (1.0, ""),
        other => (1.0, other),
    }
}

/// A table of cells; columns from `numbers` on are set to the right.
pub(super) fn table(caption: &str, header: &[&str], numbers: usize, rows: Vec<Vec<Markup>>) -> Markup {
    let class = |i: usize| (i >= numbers).then_some("number");
    html! {
        div.scroll { table {
            @if !caption.is_empty() { caption { (caption) } }
            thead { tr { @for (i, cell) in header.iter().enumerate() { th class=[class(i)] { (cell) } } } }
            tbody { @for row in rows { tr { @for (i, cell) in row.iter().enumerate() { td class=[class(i)] { (cell) } } } } }
        } }
    }
}
