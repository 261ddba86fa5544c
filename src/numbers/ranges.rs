//! Ranges of settings: which setting has a value that cannot be used, and what it must be.
//! What a setting does, and its default, are with those who use it.

use std::ops::RangeInclusive;

/// A setting with a value that cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("`{key}` = {value} must be {expected}")]
pub struct OutOfRange {
    /// Key of the setting.
    pub key: &'static str,
    /// The value found.
    pub value: f64,
    /// What it must be, and why.
    pub expected: String,
}

/// Settings that know which values can be used.
pub trait Limited {
    /// Whether every value can be used.
    ///
    /// # Errors
    /// The first setting, in the order in which they are documented, whose value cannot be used.
    fn limits(&self) -> Result<(), OutOfRange>;
}

/// Whether a setting lies in a range; NaN does not. `meaning` says what is set, or why there is a limit.
///
/// # Errors
/// [`OutOfRange`].
pub fn within(key: &'static str, value: f64, range: &RangeInclusive<f64>, meaning: &str) -> Result<(), OutOfRange> {
    if range.contains(&value) {
        return Ok(());
    }
    let [low, high] = [range.start(), range.end()];
    Err(OutOfRange { key, value, expected: format!("between {low} and {high}: {meaning}") })
}

/// [`within`] for a number of things.
///
/// # Errors
/// [`OutOfRange`].
pub fn counted(
    key: &'static str,
    value: usize,
    range: &RangeInclusive<usize>,
    meaning: &str,
) -> Result<(), OutOfRange> {
    within(key, value as f64, &(*range.start() as f64..=*range.end() as f64), meaning)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_outside_and_nan_are_refused_with_the_range_and_the_reason() {
        assert_eq!(within("alpha", 0.01, &(0.0..=0.5), "a chance"), Ok(()));
        for value in [-0.1, 0.6, f64::NAN, f64::INFINITY] {
            let error = within("alpha", value, &(0.0..=0.5), "a chance").unwrap_err();
            assert_eq!(error.to_string(), format!("`alpha` = {value} must be between 0 and 0.5: a chance"));
        }
        assert!(counted("most", 3, &(1..=20), "mechanisms").is_ok());
        assert!(counted("most", 0, &(1..=20), "mechanisms").is_err());
    }
}
