//! A sheet of particulars that fills up line by line: each value is the given one, or an estimate with its source and spread.
//! It contains no formula and no ship.

use toml::{Table, Value};

/// Where a value is from.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[serde(rename_all = "snake_case", tag = "origin")]
pub enum Origin {
    /// The user gave it.
    Given,
    /// It was estimated.
    Estimated {
        /// Formula and source.
        source: String,
        /// Standard deviation of what is estimated, in its unit; absent where none is known.
        #[serde(skip_serializing_if = "Option::is_none")]
        spread: Option<f64>,
    },
}

/// One value of a ship file.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Entry {
    /// Dotted key: `hull.mass`, `parameters.resistance.quadratic`.
    pub key: String,
    /// Value.
    pub value: Value,
    /// Where it is from.
    #[serde(flatten)]
    pub origin: Origin,
}

/// The sheet.
pub(super) struct Sheet<'a> {
    given: &'a Table,
    pub entries: Vec<Entry>,
}

/// The value at a dotted key; names in `[parameters]` have a dot of their own.
pub(super) fn at<'t>(table: &'t Table, key: &str) -> Option<&'t Value> {
    match key.split_once('.') {
        Some((name, rest)) => table.get(name)?.as_table()?.get(rest),
        None => table.get(key),
    }
}

/// A number that TOML has as an integer or with a point.
pub(super) fn number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|i| i as f64))
}

/// A number with that many significant digits, so that a file reads well.
pub(super) fn rounded(x: f64, digits: usize) -> f64 {
    format!("{x:.*e}", digits.saturating_sub(1)).parse().unwrap_or(x)
}

impl<'a> Sheet<'a> {
    pub fn new(given: &'a Table) -> Self {
        Self { given, entries: Vec::new() }
    }

    /// Whether a key is given.
    pub fn has(&self, key: &str) -> bool {
        at(self.given, key).is_some()
    }

    /// The number given at a key.
    pub fn given_number(&self, key: &str) -> Option<f64> {
        at(self.given, key).and_then(number)
    }

    /// Takes a key as it is given; says whether it is.
    pub fn keep(&mut self, key: &str) -> bool {
        let Some(value) = at(self.given, key) else { return false };
        self.entries.push(Entry { key: key.into(), value: value.clone(), origin: Origin::Given });
        true
    }

    /// The number given at a key, or the estimate.
    pub fn take(&mut self, key: &str, estimate: f64, spread: impl Into<Option<f64>>, source: &str) -> f64 {
        if self.keep(key) {
            // What is no number is refused when the whole file is read.
            return self.given_number(key).unwrap_or(estimate);
        }
        let digits = if key == "hull.mass" { 6 } else { 4 };
        let value = rounded(estimate, digits);
        let spread = spread.into().map(|s| rounded(s, 2));
        self.put(key, Value::Float(value), spread, source);
        value
    }

    /// Adds an estimate.
    pub fn put(&mut self, key: &str, value: Value, spread: Option<f64>, source: &str) {
        self.entries.push(Entry {
            key: key.into(),
            value,
            origin: Origin::Estimated { source: source.into(), spread },
        });
    }

    /// Adds every given key that is not on the sheet yet, so that nothing given is lost.
    pub fn keep_rest(&mut self) {
        let mut keys = Vec::new();
        for (name, value) in self.given {
            match value.as_table() {
                Some(table) => keys.extend(table.keys().map(|key| format!("{name}.{key}"))),
                None => keys.push(name.clone()),
            }
        }
        for key in keys {
            if !self.entries.iter().any(|e| e.key == key) {
                self.keep(&key);
            }
        }
    }
}
