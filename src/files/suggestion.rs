//! Help for error messages that every boundary shares: what a mistyped name was probably meant to be.
//! The error types themselves stand with the code that returns them.

/// Bytes of the longest name that may be a misspelt one: comparing takes the product of the lengths.
const LONGEST: usize = 200;

/// `", did you mean `x`?"` for the nearest known name, or nothing when none is near.
pub fn suggestion<'a>(found: &str, known: impl Iterator<Item = &'a str>) -> String {
    if found.len() > LONGEST {
        return String::new();
    }
    known
        .map(|k| (strsim::jaro_winkler(&found.to_lowercase(), &k.to_lowercase()), k))
        .filter(|(score, _)| *score > 0.75)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map_or(String::new(), |(_, k)| format!(", did you mean `{k}`?"))
}
