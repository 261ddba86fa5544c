//! The split: which runs train and which test, drawn by a rule where the table of runs does not say.
//! It uses the names and sessions of runs alone.

use crate::recording::{Labels, Split};
use rand::SeedableRng;
use rand::seq::SliceRandom;
use serde::{Deserialize, Serialize};
use std::collections::HashSet;

/// Session and manoeuvre of a run for which none is given.
pub(super) const UNNAMED: &str = "unnamed";

/// How runs are divided where the table of runs does not say.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SplitRule {
    /// What stays together.
    pub by: SplitBy,
    /// Share of it that is kept aside for testing.
    pub test: f64,
    /// Seed of the shuffle.
    pub seed: u64,
}

/// What stays together on one side of the split.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum SplitBy {
    /// Each run on its own.
    #[default]
    Run,
    /// All runs of a session: the harder test, since runs of a session share weather and loading.
    Session,
}

impl Default for SplitRule {
    fn default() -> Self {
        Self { by: SplitBy::Run, test: 0.125, seed: 1 }
    }
}

/// Draws the test side: groups in the order listed are shuffled by the seed and the first ones taken.
pub(super) fn draw<'a>(labels: impl Iterator<Item = &'a mut Labels>, rule: SplitRule) {
    let mut labels: Vec<&mut Labels> = labels.collect();
    let group = |l: &Labels| match rule.by {
        SplitBy::Run => l.run.clone(),
        // Runs without a session are groups of their own.
        SplitBy::Session if l.session == UNNAMED => l.run.clone(),
        SplitBy::Session => l.session.clone(),
    };
    let mut seen = HashSet::new();
    let mut groups: Vec<String> = labels.iter().map(|l| group(l)).filter(|g| seen.insert(g.clone())).collect();
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(rule.seed);
    groups.shuffle(&mut rng);
    // A study with a test side has at least one group on each side, when it has two.
    let wanted = (rule.test * groups.len() as f64).round() as usize;
    let least = usize::from(rule.test > 0.0 && groups.len() > 1);
    groups.truncate(wanted.clamp(least, groups.len().saturating_sub(1).max(least)));
    let test: HashSet<String> = groups.into_iter().collect();
    for label in &mut labels {
        label.split = if test.contains(&group(label)) { Split::Test } else { Split::Train };
    }
}
