//! A number of the page that is a number of the document: its text, beside the key and the value it stands for.
//! A program reads the page by these, and a test compares both.

use maud::{Markup, html};

/// A number of `diagnosis.json` in words: `text` is `value` times `factor`, rounded, with its unit.
pub(super) fn quantity(key: &str, value: f64, factor: f64, text: &str) -> Markup {
    html! { data value=(value) data-key=(key) data-factor=(factor) { (text) } }
}

/// A count of `diagnosis.json`.
pub(super) fn count(key: &str, value: usize) -> Markup {
    quantity(key, value as f64, 1.0, &value.to_string())
}
