//! The verdict in one sentence, and the trial to sail next.
//! It says what was decided and decides nothing.

use super::candidate::Candidate;
use super::decide::Verdict;
use super::diagnosis::NextTrial;
use super::finding::{Amplitude, Finding, GENERIC, PUSH};
use super::generic::SurrogateTerm;
use super::place::Place;
use super::push::Window;
use crate::numerals::sig;

/// What is missing and not in the catalogue, as far as the tests show it.
pub enum Missing<'a> {
    /// A law of state and inputs, with a surrogate for it.
    Law(Vec<SurrogateTerm>),
    /// A force in one part of the water.
    Place(&'a Place),
}

impl Missing<'_> {
    /// The verdict in one sentence.
    pub fn headline(&self) -> String {
        match self {
            Self::Law(surrogate) => {
                let terms: Vec<&str> = surrogate.iter().map(|t| t.name.as_str()).collect();
                let terms = terms.join(", ");
                format!(
                    "Something is missing that the catalogue does not hold; a surrogate for it (not physics): {terms}."
                )
            }
            Self::Place(place) => {
                let [south, north] = place.north.map(|v| v.round());
                let [west, east] = place.east.map(|v| v.round());
                let [to_north, to_east] = place.force.map(|v| sig(v, 3));
                format!(
                    "Something is missing that the catalogue does not hold, and it goes with the place: strongest from {south} to \
                     {north} m north and {west} to {east} m east, {to_north} N to north and {to_east} N to east there beyond what \
                     acts everywhere."
                )
            }
        }
    }

    /// The surrogate law; empty for a force in one part of the water.
    pub fn into_surrogate(self) -> Vec<SurrogateTerm> {
        match self {
            Self::Law(terms) => terms,
            Self::Place(_) => Vec::new(),
        }
    }

    /// The trial that shows it best.
    pub fn next_trial(&self) -> NextTrial {
        let (trial, why) = match self {
            Self::Law(_) => (
                "straight runs at several speeds on opposite headings, and turning circles to both sides",
                "they part what goes with speed, with heading and with the side",
            ),
            Self::Place(_) => (
                "straight runs through that part of the water and past it, on opposite headings",
                "they show how far it reaches and whether it turns with the ship",
            ),
        };
        NextTrial { trial: trial.into(), why: why.into() }
    }
}

/// The trial to sail next, where one would tell more.
pub fn next_trial(verdict: Verdict, findings: &[Finding], list: &[Candidate]) -> Option<NextTrial> {
    let by_name = |n: &str| list.iter().find(|c| c.mechanism.name == n).map(|c| c.mechanism);
    match verdict {
        Verdict::OneOf => {
            let set = &findings.first()?.confidence_set;
            if set.iter().any(|m| m == GENERIC) {
                return Some(NextTrial {
                    trial: "the same manoeuvre again, twice, without help from outside".into(),
                    why: "a push does not come again, the ship's own forces do".into(),
                });
            }
            let rival = by_name(set.get(1)?)?;
            Some(NextTrial {
                trial: rival.trial.into(),
                why: format!("it parts {} from {}", by_name(set.first()?)?.title, rival.title),
            })
        }
        Verdict::Named | Verdict::Sensor => {
            let m = by_name(&findings.first()?.mechanism)?;
            Some(NextTrial { trial: m.trial.into(), why: format!("it shows {} best", m.title) })
        }
        Verdict::Insufficient => Some(NextTrial {
            trial: "turning circles both ways, a zigzag and a crash stop, each on two headings, in two sessions".into(),
            why: "with fewer runs no mechanism can be told from another".into(),
        }),
        _ => None,
    }
}

/// The verdict in one sentence.
pub fn headline(verdict: Verdict, findings: &[Finding], missing: Option<&Missing>) -> String {
    let first = findings.first();
    match verdict {
        Verdict::Named => {
            let all: Vec<String> = findings.iter().map(titled).collect();
            format!("Missing physics: {}.", all.join("; and "))
        }
        Verdict::OneOf => first.map_or(String::new(), one_of),
        Verdict::Sensor => first.map_or(String::new(), |f| format!("Your sensor, not your ship: {}.", titled(f))),
        Verdict::NotInCatalogue => missing.map_or(String::new(), Missing::headline),
        Verdict::Numerics => {
            "The integration step, not the ship: these recordings are what explicit Euler makes of the \
                              model at one step a sample."
                .into()
        }
        Verdict::Random => "Force is there that the model lacks, but nothing about it repeats: gusts.".into(),
        Verdict::Insufficient => "These recordings cannot answer: too few runs.".into(),
        Verdict::NothingMissing => "Nothing is missing that these data could show.".into(),
    }
}

/// A finding with its values.
fn titled(f: &Finding) -> String {
    if f.by_session {
        return format!("{} (another in each of {} sessions)", f.title, f.sessions.len());
    }
    format!("{} ({})", f.title, values(f))
}

fn values(f: &Finding) -> String {
    let one = |p: &Amplitude| format!("{} = {} {}", p.name, sig(p.value, 3), p.unit);
    f.parameters.iter().map(one).collect::<Vec<_>>().join(", ")
}

/// A finding that has rivals.
fn one_of(f: &Finding) -> String {
    if f.mechanism != PUSH {
        return format!("Something is missing, and these data cannot tell which of: {}.", f.confidence_set.join(", "));
    }
    let one = |w: &Window| format!("{} from {:.0} to {:.0} s", w.run, w.start, w.end);
    let windows: Vec<String> = f.windows.iter().map(one).collect();
    format!(
        "Something acts for a time: {} in {}; a push, or the ship's own forces in a state that no other recording visits.",
        values(f),
        windows.join(" and ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example;
    use crate::diagnose::finding::Equations;
    use crate::physics::Kind;

    fn finding(mechanism: &str, title: &str, set: &[&str]) -> Finding {
        Finding {
            mechanism: mechanism.into(),
            title: title.into(),
            kind: Kind::Environment,
            confidence_set: set.iter().map(|s| (*s).to_owned()).collect(),
            why: String::new(),
            sessions: Vec::new(),
            by_session: false,
            statistic: 0.0,
            p: 0.0,
            equations: Equations::default(),
            windows: Vec::new(),
            region: None,
            signature: String::new(),
            parameters: vec![Amplitude::new("current.north".into(), 0.1234, "m/s", 0.01)],
            held_out: None,
        }
    }

    #[test]
    fn every_verdict_has_a_sentence_with_the_values_it_names() {
        let current = || finding("current", "steady current", &["current"]);
        let named = headline(Verdict::Named, &[current()], None);
        assert!(named.contains("steady current") && named.contains("0.123 m/s"), "{named}");
        let each = Finding { by_session: true, sessions: vec!["a".into(), "b".into()], ..current() };
        assert!(headline(Verdict::Named, &[each], None).contains("2 sessions"));
        let set = finding("current", "steady current", &["current", "mean_wind"]);
        assert!(headline(Verdict::OneOf, &[set], None).contains("current, mean_wind"));
        assert!(headline(Verdict::Sensor, &[current()], None).contains("sensor"));
        let law = Missing::Law(vec![SurrogateTerm { name: "asymmetric.N_0".into(), value: 1.0, error: 0.1 }]);
        assert!(headline(Verdict::NotInCatalogue, &[], Some(&law)).contains("asymmetric.N_0"));
        for verdict in [Verdict::Numerics, Verdict::Random, Verdict::Insufficient, Verdict::NothingMissing] {
            assert!(headline(verdict, &[], None).ends_with('.'), "{verdict:?}");
        }
    }

    #[test]
    fn the_next_trial_tells_rivals_apart_and_shows_a_name_best() {
        let model = example::model();
        let list = ["current", "mean_wind"].map(|n| example::candidate(&model, n));
        let (current, wind) = (list[0].mechanism, list[1].mechanism);
        let rivals = finding("current", "steady current", &["current", "mean_wind"]);
        let trial = |v, f: &[Finding]| next_trial(v, f, &list).map(|t| t.trial);
        assert_eq!(trial(Verdict::OneOf, &[rivals]).as_deref(), Some(wind.trial));
        let named = finding("current", "steady current", &["current"]);
        assert_eq!(trial(Verdict::Named, &[named]).as_deref(), Some(current.trial));
        let push = finding(PUSH, "a push", &[PUSH, GENERIC]);
        assert!(trial(Verdict::OneOf, &[push]).is_some() && trial(Verdict::Insufficient, &[]).is_some());
        assert!(trial(Verdict::NothingMissing, &[]).is_none());
    }
}
