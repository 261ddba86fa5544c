//! The plan: which change of which study each case is, by class, each with a seed of its own.
//! It changes nothing.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::damage::{DAMAGES, damage};
use super::edit::{HARMLESS, MISTAKES, harmless, mistake};
use super::files::Files;

/// Seed of the committed campaign.
pub const SEED: u64 = 20_261_234;

/// Cases of the committed campaign.
pub const CASES: usize = 20_000;

/// Every so many cases are diagnosed too: a diagnosis takes ten times as long as all other commands together.
const DIAGNOSED: usize = 10;

/// What must become of a change.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Class {
    /// It must not change the answer.
    Harmless,
    /// It must be refused.
    Mistake,
    /// It may change the answer, and must then be reported.
    Damage,
}

/// One case.
#[derive(Debug, Clone, PartialEq)]
pub struct Planned {
    /// Its number, from 1.
    pub case: usize,
    /// What must become of it.
    pub class: Class,
    /// The kind of change.
    pub kind: &'static str,
    /// Its seed.
    pub seed: u64,
    /// Whether it is diagnosed too.
    pub diagnosed: bool,
}

/// The first so many cases of a campaign: the kinds of change in turn.
pub fn plan(cases: usize, seed: u64) -> Vec<Planned> {
    let of = |class: Class, kinds: &'static [&'static str]| kinds.iter().map(move |kind| (class, *kind));
    let kinds: Vec<(Class, &'static str)> = of(Class::Harmless, &HARMLESS)
        .chain(of(Class::Mistake, &MISTAKES))
        .chain(of(Class::Damage, &DAMAGES))
        .collect();
    let planned = |i: usize| {
        let (class, kind) = kinds[i % kinds.len()];
        // A kind is diagnosed in one round of ten, whatever its place in the round.
        let diagnosed = (i / kinds.len() + i).is_multiple_of(DIAGNOSED);
        Planned { case: i + 1, class, kind, seed: seed.wrapping_mul(1_000_003).wrapping_add(i as u64), diagnosed }
    };
    (0..cases).map(planned).collect()
}

impl Planned {
    /// The changed files, and what was changed where. A change that has no place where it was drawn is drawn again.
    pub fn changed(&self, sound: &Files) -> (Files, String) {
        let mut rng = ChaCha8Rng::seed_from_u64(self.seed);
        loop {
            let mut files = sound.clone();
            let what = match self.class {
                Class::Harmless => Some(harmless(&mut files, self.kind, &mut rng)),
                Class::Mistake => mistake(&mut files, self.kind, &mut rng),
                Class::Damage => damage(&mut files, self.kind, &mut rng),
            };
            if let Some(what) = what.filter(|_| files != *sound) {
                return (files, what);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn every_kind_is_planned_and_diagnosed_about_equally_often() {
        let all = plan(CASES, SEED);
        let mut counts: BTreeMap<&str, (usize, usize)> = BTreeMap::new();
        for case in &all {
            let count = counts.entry(case.kind).or_default();
            *count = (count.0 + 1, count.1 + usize::from(case.diagnosed));
        }
        assert_eq!(counts.len(), HARMLESS.len() + MISTAKES.len() + DAMAGES.len());
        assert!(counts.values().all(|(all, diagnosed)| *all > 400 && (30..60).contains(diagnosed)), "{counts:?}");
    }

    #[test]
    fn a_case_is_the_same_study_every_time() {
        let folder = tempfile::tempdir().unwrap();
        let sound = super::super::files::sound(3, folder.path()).unwrap();
        for case in plan(2 * (HARMLESS.len() + MISTAKES.len() + DAMAGES.len()), 5) {
            assert_eq!(case.changed(&sound), case.changed(&sound));
        }
    }
}
