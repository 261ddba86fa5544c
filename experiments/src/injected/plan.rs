//! The plan of the campaign on real recordings: which cases are made, by set and kind, each with a key and a seed of its own.
//! It makes no case.

use std::collections::{BTreeMap, BTreeSet};

use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::configuration::{Configuration, Sessions, Turned, Wind};
use super::effect::{EFFECTS, Effect, Expected, Injection, MISTAKES, effect, mistake};
use super::error::InjectedError;
use super::set::{SETS, Set};
use crate::conceal::seal::digest;

/// Seed of the published campaign, fixed before any case was diagnosed; other seeds are for development.
pub const SEED: u64 = 20_261_240;

/// What a case asks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// Nothing injected.
    Null,
    /// Nothing injected, and one change that changes nothing physical: the partner's answer is expected.
    Same,
    /// One effect in all sessions.
    Single,
    /// One fault of instrument or logger for which nothing may be named.
    Logger,
    /// One effect in some sessions.
    Some,
    /// Two effects.
    Pair,
    /// A user's mistake in one session.
    Mistake,
    /// A wind that an anemometer on board measured and the diagnosis is not given.
    Wind,
    /// A measured wind that the diagnosis is given and the model has no load for.
    Load,
    /// The improved model is diagnosed again.
    Again,
}

/// Every kind.
pub const KINDS: [Kind; 10] = [
    Kind::Null,
    Kind::Same,
    Kind::Single,
    Kind::Logger,
    Kind::Some,
    Kind::Pair,
    Kind::Mistake,
    Kind::Wind,
    Kind::Load,
    Kind::Again,
];

impl Kind {
    /// Name in keys.
    pub fn name(self) -> &'static str {
        match self {
            Self::Null => "null",
            Self::Same => "same",
            Self::Single => "single",
            Self::Logger => "logger",
            Self::Some => "some",
            Self::Pair => "pair",
            Self::Mistake => "mistake",
            Self::Wind => "wind",
            Self::Load => "load",
            Self::Again => "again",
        }
    }
}

/// One case of the plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Planned {
    /// Key in the results, unique: `marin/single/current/x1/3`.
    pub key: String,
    /// What it asks.
    pub kind: Kind,
    /// How the set is given.
    pub configuration: Configuration,
    /// What is injected.
    pub injections: Vec<Injection>,
    /// Strength, as a part of the reference size; absent for nulls.
    pub strength: Option<f64>,
    /// Whether the injection acts in half of the sessions only.
    pub partial: bool,
    /// The case with the same configuration and nothing injected.
    pub partner: Option<String>,
    /// Seed of the case.
    pub seed: u64,
}

/// Whether a strength is that of a current of a tenth of the speed, or more.
pub fn is_strong(strength: Option<f64>) -> bool {
    strength.is_some_and(|s| s >= 1.0)
}

impl Planned {
    /// Whether rivals are asked: nothing is injected, or one effect that is strong enough that a user would look for it.
    pub fn suits_rivals(&self) -> bool {
        match self.kind {
            Kind::Null => true,
            Kind::Single => is_strong(self.strength),
            _ => false,
        }
    }
}

/// Nulls of each set; the other cases take their configurations from the first ones.
const NULLS: usize = 130;
/// Of these, how many configurations the injected cases use.
const SHARED: usize = 60;
/// Strengths of the effects.
const STRENGTHS: [f64; 4] = [0.25, 0.5, 1.0, 2.0];
/// Effects that can be in some sessions only.
const PARTIAL: [&str; 7] =
    ["current", "heading_zero", "clock_heading", "rate_bias", "log_scale", "rudder_zero", "propeller_scale"];
/// Pairs that look alike or hide each other.
const PAIRS: [[&str; 2]; 8] = [
    ["current", "log_scale"],
    ["current", "heading_zero"],
    ["current", "clock_position"],
    ["heading_zero", "sway_bias"],
    ["clock_heading", "rate_bias"],
    ["lever", "clock_position"],
    ["log_scale", "drop_out"],
    ["current", "jitter"],
];

/// Changes that change nothing physical.
const SAME: [&str; 13] = [
    "turned_each",
    "turned",
    "mirrored",
    "origin",
    "time",
    "backwards",
    "halves",
    "scaled",
    "threads",
    "step",
    "window",
    "start",
    "span",
];

/// Seed from the campaign's seed and a key, so that no seed changes when a case is added. 48 bits: exact in every JSON reader.
fn seed(campaign: u64, key: &str) -> u64 {
    let hex = digest(format!("{campaign} injected {key}").as_bytes());
    u64::from_str_radix(&hex[..12], 16).unwrap_or(campaign)
}

struct Planner {
    campaign: u64,
    cases: Vec<Planned>,
}

/// Whether a configuration has two sessions to train on.
fn several_sessions(c: &Configuration) -> bool {
    c.sessions != Sessions::One && !(c.set == Set::Esso && c.sessions == Sessions::Recorded)
}

impl Planner {
    /// Key of the null of a shared configuration.
    fn null(set: Set, index: usize) -> String {
        format!("{}/null/{:03}", set.name(), index + 1)
    }

    fn configuration(&self, set: Set, index: usize) -> Result<Configuration, InjectedError> {
        Configuration::draw(set, seed(self.campaign, &format!("{}/configuration/{index}", set.name())))
    }

    /// A shared configuration for which this is true, drawn from a key.
    fn shared(
        &self,
        set: Set,
        key: &str,
        holds: impl Fn(&Configuration) -> bool,
    ) -> Result<(Configuration, String), InjectedError> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed(self.campaign, &format!("{key} configuration")));
        let mut order: Vec<usize> = (0..SHARED).collect();
        order.shuffle(&mut rng);
        for index in order {
            let configuration = self.configuration(set, index)?;
            if holds(&configuration) {
                return Ok((configuration, Self::null(set, index)));
            }
        }
        Ok((self.configuration(set, 0)?, Self::null(set, 0)))
    }

    fn push(&mut self, key: String, kind: Kind, configuration: Configuration) -> &mut Planned {
        let seed = seed(self.campaign, &key);
        let case = Planned {
            key,
            kind,
            configuration,
            injections: Vec::new(),
            strength: None,
            partial: false,
            partner: None,
            seed,
        };
        self.cases.push(case);
        let last = self.cases.len() - 1;
        &mut self.cases[last]
    }

    fn nulls(&mut self, set: Set) -> Result<(), InjectedError> {
        for index in 0..NULLS {
            let configuration = self.configuration(set, index)?;
            self.push(Self::null(set, index), Kind::Null, configuration);
        }
        Ok(())
    }

    fn same(&mut self, set: Set) -> Result<(), InjectedError> {
        for what in SAME {
            for index in 0..10 {
                let base = self.configuration(set, index)?;
                if let Some(changed) = changed(&base, what)? {
                    let case = self.push(format!("{}/same/{what}/{}", set.name(), index + 1), Kind::Same, changed);
                    case.partner = Some(Self::null(set, index));
                }
            }
        }
        Ok(())
    }

    /// Some effects at a strength, in one configuration after the other.
    fn injected(
        &mut self,
        set: Set,
        kind: Kind,
        names: &[&str],
        strength: f64,
        count: usize,
    ) -> Result<(), InjectedError> {
        let effects: Vec<&Effect> = names.iter().filter_map(|name| effect(name)).collect();
        for i in 1..=count {
            let key = format!("{}/{}/{}/x{strength}/{i}", set.name(), kind.name(), names.join("+"));
            let partial = kind == Kind::Some;
            // Between drop-outs a recording may have no stretch as long as a window.
            let parted = names.contains(&"drop_out");
            let holds = |c: &Configuration| (!partial || several_sessions(c)) && (!parted || c.window.is_none());
            let (configuration, partner) = self.shared(set, &key, holds)?;
            let case = self.push(key, kind, configuration);
            let mut rng = ChaCha8Rng::seed_from_u64(case.seed);
            case.injections = effects.iter().map(|e| e.at(set, strength, &mut rng)).collect();
            case.injections.sort_by_key(|i| i.operation.rank());
            if partial {
                // What a ship's own coefficients absorb in all sessions they cannot absorb in some.
                for injection in case.injections.iter_mut().filter(|i| !i.accepted.is_empty()) {
                    injection.expected = Expected::Named;
                }
            }
            (case.strength, case.partial, case.partner) = (Some(strength), partial, Some(partner));
        }
        Ok(())
    }

    fn effects(&mut self, set: Set) -> Result<(), InjectedError> {
        for effect in EFFECTS.iter().filter(|e| e.name != "rudder_lag" || set.facts().rudder_measured) {
            for strength in STRENGTHS {
                if effect.expected == Expected::Silent {
                    if strength > 0.25 {
                        self.injected(set, Kind::Logger, &[effect.name], strength, 4)?;
                    }
                } else {
                    self.injected(set, Kind::Single, &[effect.name], strength, 4)?;
                }
            }
        }
        for name in PARTIAL {
            for strength in [1.0, 2.0] {
                self.injected(set, Kind::Some, &[name], strength, 4)?;
            }
        }
        for pair in PAIRS {
            self.injected(set, Kind::Pair, &pair, 1.0, 5)?;
        }
        Ok(())
    }

    fn mistakes(&mut self, set: Set) -> Result<(), InjectedError> {
        for name in MISTAKES {
            for i in 1..=3 {
                let key = format!("{}/mistake/{name}/{i}", set.name());
                let (configuration, partner) = self.shared(set, &key, several_sessions)?;
                let case = self.push(key, Kind::Mistake, configuration);
                (case.injections, case.partial, case.partner) = (vec![mistake(name)], true, Some(partner));
            }
        }
        Ok(())
    }

    /// The wind on the pond: withheld from the diagnosis, or given without a load in the model.
    fn winds(&mut self) -> Result<(), InjectedError> {
        let set = Set::Esso;
        for (kind, wind, count) in [(Kind::Wind, Wind::Withheld, 60), (Kind::Load, Wind::Given, 20)] {
            for i in 1..=count {
                let key = format!("{}/{}/{i}", set.name(), kind.name());
                let mut configuration = Configuration::draw(set, seed(self.campaign, &key))?;
                (configuration.wind, configuration.sessions) = (wind, Sessions::Recorded);
                if configuration.turned == Turned::Each {
                    configuration.turned = Turned::Together;
                }
                self.push(key, kind, configuration);
            }
        }
        Ok(())
    }

    /// Nulls and plain effects whose improved model is diagnosed again.
    fn again(&mut self, set: Set) -> Result<(), InjectedError> {
        let named: Vec<&str> = EFFECTS.iter().filter(|e| e.expected == Expected::Named).map(|e| e.name).collect();
        for i in 1..=10 {
            let key = format!("{}/again/null/{i}", set.name());
            let (configuration, _) = self.shared(set, &key, |_| true)?;
            self.push(key, Kind::Again, configuration);
            let key = format!("{}/again/injected/{i}", set.name());
            let (configuration, _) = self.shared(set, &key, |_| true)?;
            let case = self.push(key, Kind::Again, configuration);
            let mut rng = ChaCha8Rng::seed_from_u64(case.seed);
            let name = named[rng.random_range(0..named.len())];
            let lagged = name == "rudder_lag" && !set.facts().rudder_measured;
            let chosen = effect(if lagged { "current" } else { name });
            case.injections = chosen.into_iter().map(|e| e.at(set, 1.0, &mut rng)).collect();
            case.strength = Some(1.0);
        }
        Ok(())
    }
}

/// A configuration with one change that changes nothing physical; `None` where the change is none.
fn changed(base: &Configuration, what: &str) -> Result<Option<Configuration>, InjectedError> {
    let mut c = base.clone();
    match what {
        // One wind blows over a session: recordings that are turned apart share none.
        "turned_each" if c.turned == Turned::No && (c.set.facts().calm || c.sessions == Sessions::None) => {
            c.turned = Turned::Each;
        }
        "turned" if c.turned == Turned::No => c.turned = Turned::Together,
        "mirrored" => c.mirrored = !c.mirrored,
        "origin" => c.moved[0] = true,
        "time" => c.moved[1] = true,
        "backwards" => c.reversed = true,
        "halves" if c.window.is_none() => c.cut = true,
        // Priors of a freed hull have dimensions.
        "scaled" if !c.freed => c.scale = if c.set == Set::Marin { 0.25 } else { 4.0 },
        "threads" => c.threads = 2,
        "step" => c.step *= if c.step > c.set.facts().steps[1] { 0.5 } else { 2.0 },
        "window" => {
            let studied = c.set.window()?;
            c.window = Some(if c.window == Some(studied) { 0.5 * studied } else { studied });
        }
        "start" => c.start = if c.start == 1.0 { 0.5 } else { 1.0 },
        "span" if c.span == [0.0, 1.0] => c.span = [0.0, 0.9],
        _ => return Ok(None),
    }
    Ok(Some(c))
}

/// Every case, in a fixed order: over 2000.
///
/// # Errors
/// [`InjectedError::Case`] if a committed study is not as expected.
pub fn plan(campaign: u64) -> Result<Vec<Planned>, InjectedError> {
    let mut p = Planner { campaign, cases: Vec::new() };
    for set in SETS {
        p.nulls(set)?;
        p.same(set)?;
        p.effects(set)?;
        p.mistakes(set)?;
        p.again(set)?;
    }
    p.winds()?;
    Ok(p.cases)
}

/// So many cases of the plan, drawn by the seed: as many of each set and kind as their shares, but at least one.
pub fn sample(plan: &[Planned], count: usize, campaign: u64) -> Vec<Planned> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed(campaign, "sample"));
    let strata: BTreeSet<(Kind, &str)> = plan.iter().map(|c| (c.kind, c.configuration.set.name())).collect();
    let mut shuffled: Vec<(f64, usize)> = Vec::new();
    for (kind, set) in strata {
        let mut of: Vec<usize> =
            (0..plan.len()).filter(|i| plan[*i].kind == kind && plan[*i].configuration.set.name() == set).collect();
        of.shuffle(&mut rng);
        // The first of every stratum comes before the second of any, the rest in proportion.
        let share = of.len() as f64;
        let place = |i: usize| if i == 0 { rng_order(kind, set) } else { 1.0 + (i as f64 + 0.5) / share };
        shuffled.extend(of.into_iter().enumerate().map(|(i, case)| (place(i), case)));
    }
    shuffled.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut chosen: Vec<usize> = shuffled.into_iter().take(count).map(|(_, case)| case).collect();
    chosen.sort_unstable();
    chosen.into_iter().map(|i| plan[i].clone()).collect()
}

/// Order of the first cases of the strata: every kind once, from another set each time, before any kind again.
fn rng_order(kind: Kind, set: &str) -> f64 {
    let kinds = KINDS.len();
    let at = KINDS.iter().position(|k| *k == kind).unwrap_or(0);
    let place = SETS.iter().position(|s| s.name() == set).unwrap_or(0);
    let only = matches!(kind, Kind::Wind | Kind::Load);
    let turn = if only { 0 } else { (place + SETS.len() - at % SETS.len()) % SETS.len() };
    (turn * kinds + at) as f64 / (SETS.len() * kinds) as f64
}

/// How many cases every push has.
pub const SLICE: usize = 12;

/// The cases of every push: short ones of every kind, with a partner where there is room.
pub fn ci_slice(plan: &[Planned], campaign: u64) -> Vec<Planned> {
    // Six recordings, or as few as there are of a kind.
    let least = |kind: Kind| {
        let of = plan.iter().filter(|c| c.kind == kind && is_short(&c.configuration));
        of.map(|c| c.configuration.runs.len()).min().unwrap_or(0).max(6)
    };
    let most: BTreeMap<Kind, usize> = KINDS.into_iter().map(|kind| (kind, least(kind))).collect();
    let few = |c: &&Planned| most.get(&c.kind).is_some_and(|most| c.configuration.runs.len() <= *most);
    let short: Vec<Planned> = plan.iter().filter(|c| is_short(&c.configuration)).filter(few).cloned().collect();
    let mut chosen = sample(&short, SLICE - 1, campaign);
    let mut keys: BTreeSet<String> = chosen.iter().map(|c| c.key.clone()).collect();
    let partners: Vec<String> = chosen.iter().filter_map(|c| c.partner.clone()).collect();
    for key in partners {
        if chosen.len() < SLICE && keys.insert(key.clone()) {
            chosen.extend(plan.iter().find(|c| c.key == key).cloned());
        }
    }
    for case in short {
        if chosen.len() < SLICE && keys.insert(case.key.clone()) {
            chosen.push(case);
        }
    }
    chosen
}

/// Whether a diagnosis takes little time.
fn is_short(c: &Configuration) -> bool {
    let steps = c.set.facts().steps;
    !c.freed && c.step >= steps[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_plan_has_over_2000_cases_with_keys_and_seeds_of_their_own() {
        let all = plan(31).unwrap();
        assert!(all.len() >= 2000, "{}", all.len());
        let keys: BTreeSet<&str> = all.iter().map(|c| c.key.as_str()).collect();
        let seeds: BTreeSet<u64> = all.iter().map(|c| c.seed).collect();
        assert_eq!((keys.len(), seeds.len()), (all.len(), all.len()));
        for kind in KINDS {
            assert!(all.iter().filter(|c| c.kind == kind).count() >= 20, "{}", kind.name());
        }
        assert!(all.iter().all(|c| c.partner.as_ref().is_none_or(|p| keys.contains(p.as_str()))));
        assert_eq!(all, plan(31).unwrap());
    }

    #[test]
    fn a_partner_has_the_same_configuration_and_nothing_injected() {
        let all = plan(31).unwrap();
        for case in all.iter().filter(|c| c.kind != Kind::Same) {
            let Some(key) = &case.partner else { continue };
            let partner = all.iter().find(|c| &c.key == key).unwrap();
            assert_eq!(partner.configuration, case.configuration, "{}", case.key);
            assert!(partner.injections.is_empty() && !case.injections.is_empty());
        }
        for case in all.iter().filter(|c| c.kind == Kind::Same) {
            let partner = all.iter().find(|c| Some(&c.key) == case.partner.as_ref()).unwrap();
            assert!(case.injections.is_empty() && partner.configuration != case.configuration, "{}", case.key);
        }
    }

    #[test]
    fn another_seed_plans_the_same_keys_with_other_cases() {
        let (a, b) = (plan(31).unwrap(), plan(32).unwrap());
        let singles =
            |p: &[Planned]| p.iter().filter(|c| c.kind == Kind::Single).map(|c| c.key.clone()).collect::<Vec<_>>();
        assert_eq!(singles(&a), singles(&b));
        assert!(a.iter().zip(&b).filter(|(x, y)| x.key == y.key).all(|(x, y)| x.seed != y.seed));
    }

    #[test]
    fn a_sample_has_every_kind_and_so_has_the_slice_of_every_push() {
        let all = plan(31).unwrap();
        let kinds = |cases: &[Planned]| cases.iter().map(|c| c.kind).collect::<BTreeSet<_>>().len();
        let small = sample(&all, 20, 31);
        assert_eq!((small.len(), kinds(&small)), (20, KINDS.len()));
        assert_eq!(small, sample(&all, 20, 31));
        assert!(sample(&all, 20, 32) != small);
        let slice = ci_slice(&all, 31);
        let keys: BTreeSet<&str> = slice.iter().map(|c| c.key.as_str()).collect();
        assert_eq!((slice.len(), keys.len(), kinds(&slice)), (SLICE, SLICE, KINDS.len()));
    }
}
