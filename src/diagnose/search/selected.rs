//! A mechanism that was selected. How it is selected, weighed and reported is elsewhere.

use crate::diagnose::evidence::candidate::{Candidate, Extent};

/// A mechanism that was selected, with what it costs and brings.
#[derive(Clone)]
pub struct Selected {
    /// Index into the candidates.
    pub candidate: usize,
    /// Where it acts.
    pub extent: Extent,
    /// Twice the gain in log-likelihood.
    pub statistic: f64,
    /// Corrected p-value.
    pub p: f64,
    /// Candidates that the data allow in its place, itself first.
    pub set: Vec<usize>,
    /// Why the set is what it is.
    pub why: String,
    /// Whether it is not named and yet stays in the model, so that what it does is not taken for something else.
    pub carried: bool,
}

impl Selected {
    /// Adds mechanisms whose effects are alike on these manoeuvres to the set, each with the share of the gain that it can take over.
    pub fn widen(&mut self, class: Vec<(usize, f64)>, candidates: &[Candidate]) {
        let new: Vec<(usize, f64)> = class.into_iter().filter(|(i, _)| !self.set.contains(i)).collect();
        if new.is_empty() {
            return;
        }
        let text = |(i, share): &(usize, f64)| format!("{} ({:.0} %)", candidates[*i].mechanism.title, 100.0 * share);
        let alike: Vec<String> = new.iter().map(text).collect();
        self.why =
            format!("{}; on these manoeuvres this takes over so much of its gain: {}", self.why, alike.join(", "));
        self.set.extend(new.iter().map(|(i, _)| *i));
    }
}
