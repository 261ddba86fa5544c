//! The plan of the campaign: which concealed cases are made, by arms, each with a key and a seed of its own.
//! It makes no case.

use crate::conceal::effects::catalogue::{catalogue, find};
use crate::conceal::effects::effect::{Class, Entry};
use crate::conceal::family::Family;
use crate::conceal::sailing::design::Design;
use crate::conceal::seal::digest;
use crate::conceal::spec::{Background, Spec, Strength};

/// Seed of the committed campaign, fixed before any of its cases was diagnosed.
pub const SEED: u64 = 20_261_251;
/// Seed of the forty cases of every push: that of an earlier campaign, which changes may be judged on.
pub const PUSH_SEED: u64 = 20_250_226;

/// One case of the plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Planned {
    /// Key in the results, unique: `hd/current/snr12/1`.
    pub key: String,
    /// Part of the campaign: `null`, `single`, `pooled`, `contrast`, `withheld`, `absorbed`, `compound`, `design`,
    /// `hulls`.
    pub arm: &'static str,
    /// The case.
    pub spec: Spec,
}

/// Pairs and triples that look alike or hide each other.
const COMPOUNDS: [&[&str]; 11] = [
    &["current", "walk_astern"],
    &["mean_wind", "wave_drift"],
    &["current", "mean_wind"],
    &["rudder_lag", "heading_bias"],
    &["current", "time_skew"],
    &["mean_wind", "yaw_rate_bias"],
    &["log_scale", "engine_lag"],
    &["thruster", "wave_drift"],
    &["current", "walk_astern", "rudder_lag"],
    &["mean_wind", "log_scale", "thruster"],
    &["wave_drift", "heading_bias", "push"],
];

/// Effects for the designs with poor excitation: more or other data would distinguish them from their look-alikes.
const AMBIGUOUS: [&str; 6] = ["current", "mean_wind", "heading_bias", "log_scale", "shallow", "crossflow"];

/// Effects that a reference session makes visible.
const CONTRASTED: [&str; 12] = [
    "current",
    "mean_wind",
    "walk_astern",
    "rudder_lag",
    "heading_bias",
    "wave_drift",
    "engine_lag",
    "wind",
    "fouling",
    "thrust_loss",
    "rudder_offset",
    "race",
];

/// The arm of the campaign with other hulls than the one that thresholds were set on.
pub const OTHER_HULLS: &str = "hulls";

/// The hulls in it.
pub const OTHERS: [Family; 2] = [Family::Tanker, Family::Flap];

/// Seed of a case: from the campaign's seed and the key, so that no seed changes when a case is added.
fn seed(campaign: u64, key: &str) -> u64 {
    let hex = digest(format!("{campaign} {key}").as_bytes());
    // 48 bits: exact as a number in every JSON reader.
    u64::from_str_radix(&hex[..12], 16).unwrap_or(campaign)
}

struct Planner {
    campaign: u64,
    cases: Vec<Planned>,
}

/// One effect at one strength in the standard design.
fn one(family: Family, name: &str, strength: Strength, seed: u64) -> Spec {
    Spec { effects: vec![(name.to_owned(), strength)], ..Spec::null(family, seed) }
}

/// A wrong sign or unit: it is there or not, and found before any ship is looked at.
fn all_or_nothing(e: &Entry) -> bool {
    e.name == "sign_error" || e.name == "unit_error"
}

/// The forces and sensor defects of the catalogue that a family can have.
fn visible(family: Family) -> impl Iterator<Item = &'static Entry> {
    let force_or_sensor = |e: &&'static Entry| matches!(e.class, Class::Force | Class::Sensor);
    catalogue().filter(force_or_sensor).filter(move |e| family == Family::Hd || e.in_mmg)
}

impl Planner {
    fn add(&mut self, arm: &'static str, name: &str, count: usize, spec: impl Fn(u64) -> Spec) {
        for i in 1..=count {
            let key = format!("{name}/{i}");
            let spec = spec(seed(self.campaign, &key));
            self.cases.push(Planned { key, arm, spec });
        }
    }

    fn nulls(&mut self, arm: &'static str, family: Family, backgrounds: &[(Background, usize)]) {
        for &(background, count) in backgrounds {
            let key = format!("{}/null/{}", family.name(), background.name());
            self.add(arm, &key, count, |seed| Spec { background, ..Spec::null(family, seed) });
        }
    }

    /// Single effects by strength, and those that need a reference without one.
    fn singles(&mut self, family: Family) {
        let f = family.name();
        for e in visible(family) {
            let at = |strength: Strength| move |seed: u64| one(family, e.name, strength, seed);
            if all_or_nothing(e) {
                self.add("single", &format!("{f}/{}", e.name), 2, at(Strength::Times(1.0)));
                continue;
            }
            for snr in [3.0, 6.0, 12.0, 24.0] {
                let count = if family == Family::Hd && snr > 3.0 && snr < 24.0 { 3 } else { 2 };
                // An effect that unknown hull coefficients can mimic has reference sessions without it.
                self.add("single", &format!("{f}/{}/snr{snr}", e.name), count, |seed| Spec {
                    contrast: e.reference,
                    ..at(Strength::Snr(snr))(seed)
                });
            }
            if e.reference {
                self.add("pooled", &format!("{f}/pooled/{}", e.name), 2, at(Strength::Times(1.0)));
            }
        }
    }

    /// Effects of a class that have no ratio of their own, by size.
    fn graded(&mut self, arm: &'static str, family: Family, class: Class, sizes: &[f64]) {
        for e in catalogue().filter(|e| e.class == class) {
            for times in sizes {
                let key = format!("{}/{}/x{times}", family.name(), e.name);
                self.add(arm, &key, 2, |seed| one(family, e.name, Strength::Times(*times), seed));
            }
        }
    }

    fn compounds(&mut self, family: Family) {
        for names in COMPOUNDS {
            self.add("compound", &format!("{}/{}/snr16", family.name(), names.join("+")), 3, |seed| Spec {
                effects: names.iter().map(|n| ((*n).to_owned(), Strength::Snr(16.0))).collect(),
                ..Spec::null(family, seed)
            });
        }
    }

    fn contrasts(&mut self, family: Family) {
        for name in CONTRASTED {
            // An absorbed effect has no ratio of its own without a reference: it is graded by size.
            let absorbed = find(name).is_some_and(|e| e.class == Class::Absorbed);
            let strength = if absorbed { Strength::Times(1.5) } else { Strength::Snr(12.0) };
            self.add("contrast", &format!("{}/contrast/{name}", family.name()), 2, |seed| Spec {
                contrast: true,
                ..one(family, name, strength, seed)
            });
        }
    }

    fn designs(&mut self, family: Family) {
        for design in [Design::OneHeading, Design::Straight, Design::Few] {
            for name in AMBIGUOUS {
                self.add("design", &format!("{}/{}/{name}", family.name(), design.name()), 2, |seed| Spec {
                    design,
                    ..one(family, name, Strength::Times(1.5), seed)
                });
            }
        }
    }
}

/// Every case, in a fixed order: over 1000.
pub fn plan(campaign: u64) -> Vec<Planned> {
    use Background::{Coloured, Dropouts, Euler, Gusts, Hull, Ordinary, Outliers};
    let mut p = Planner { campaign, cases: Vec::new() };
    let all = [(Ordinary, 30), (Gusts, 20), (Coloured, 15), (Hull, 20), (Euler, 10), (Outliers, 10), (Dropouts, 10)];
    for family in [Family::Hd, Family::Mmg] {
        p.nulls("null", family, &all);
        p.singles(family);
        p.graded("withheld", family, Class::Withheld, &[0.5, 1.0, 2.0]);
        p.graded("absorbed", family, Class::Absorbed, &[1.0, 2.0]);
        p.compounds(family);
        p.contrasts(family);
        p.designs(family);
    }
    for family in OTHERS {
        p.nulls(OTHER_HULLS, family, &[(Ordinary, 10), (Gusts, 5), (Coloured, 5)]);
        for e in visible(family).filter(|e| !all_or_nothing(e)) {
            p.add(OTHER_HULLS, &format!("{}/{}/snr12", family.name(), e.name), 2, |seed| Spec {
                contrast: e.reference,
                ..one(family, e.name, Strength::Snr(12.0), seed)
            });
        }
    }
    p.cases
}

/// A slice of the plan small enough for every push: 13 cases, from all arms in proportion but never none.
pub fn ci_slice(plan: &[Planned]) -> Vec<Planned> {
    let quotas = [
        ("null", 3),
        ("single", 3),
        ("pooled", 1),
        ("withheld", 1),
        ("absorbed", 1),
        ("compound", 1),
        ("contrast", 1),
        ("design", 1),
        (OTHER_HULLS, 1),
    ];
    let mut chosen = Vec::new();
    for (arm, quota) in quotas {
        let of_arm: Vec<&Planned> = plan
            .iter()
            .filter(|c| c.arm == arm)
            // Of the graded cases SNR 12 alone: weaker effects are often missed, and stronger ones never.
            .filter(|c| ["snr3/", "snr6/", "snr24/"].iter().all(|s| !c.key.contains(s)))
            .collect();
        let step = of_arm.len() as f64 / quota as f64;
        chosen.extend((0..quota).filter_map(|i| of_arm.get(((i as f64 + 0.5) * step) as usize)).map(|c| (*c).clone()));
    }
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn the_plan_has_over_800_cases_with_keys_and_seeds_of_their_own() {
        let all = plan(SEED);
        assert!(all.len() >= 800, "{}", all.len());
        let keys: BTreeSet<&str> = all.iter().map(|c| c.key.as_str()).collect();
        let seeds: BTreeSet<u64> = all.iter().map(|c| c.spec.seed).collect();
        assert_eq!((keys.len(), seeds.len()), (all.len(), all.len()));
        let mmg = all.iter().filter(|c| c.spec.family != Family::Hd).count() as f64 / all.len() as f64;
        assert!((0.4..0.6).contains(&mmg), "half the cases are of the other family: {mmg}");
        assert!(all.iter().all(|c| c.spec.entries().is_ok()));
    }

    #[test]
    fn the_slice_for_every_push_has_13_cases_of_all_arms() {
        let slice = ci_slice(&plan(SEED));
        let arms: BTreeSet<&str> = slice.iter().map(|c| c.arm).collect();
        let keys: BTreeSet<&str> = slice.iter().map(|c| c.key.as_str()).collect();
        assert_eq!((slice.len(), keys.len(), arms.len()), (13, 13, 9));
    }

    #[test]
    fn another_campaign_has_the_same_cases_with_other_seeds() {
        let (a, b) = (plan(1), plan(2));
        assert!(a.iter().zip(&b).all(|(a, b)| a.key == b.key && a.spec.seed != b.spec.seed));
    }
}
