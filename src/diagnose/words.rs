//! The verdict in one sentence, and the trial to sail next.
//! It says what was decided and decides nothing.

use super::admit::Admission;
use super::candidate::Candidate;
use super::decide::Verdict;
use super::diagnosis::NextTrial;
use super::finding::{Amplitude, Finding, GENERIC, PUSH};
use super::generic::SurrogateTerm;
use super::place::Place;
use super::push::Window;
use crate::report::sig;

/// What is missing and not in the catalogue, as far as it can be told.
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

    /// The trial that tells most of it.
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
pub fn headline(verdict: Verdict, findings: &[Finding], admission: &Admission, unlisted: Option<&Missing>) -> String {
    let values = |f: &Finding| {
        let one = |p: &Amplitude| format!("{} = {} {}", p.name, sig(p.value, 3), p.unit);
        f.parameters.iter().map(one).collect::<Vec<_>>().join(", ")
    };
    let list = |f: &Finding| {
        if f.by_session {
            return format!("{} (another in each of {} sessions)", f.title, f.sessions.len());
        }
        format!("{} ({})", f.title, values(f))
    };
    match verdict {
        Verdict::Named => {
            let all: Vec<String> = findings.iter().map(list).collect();
            format!("Missing physics: {}.", all.join("; and "))
        }
        Verdict::OneOf => findings.first().map_or(String::new(), |f| {
            if f.mechanism == PUSH {
                let one = |w: &Window| format!("{} from {:.0} to {:.0} s", w.run, w.start, w.end);
                let windows: Vec<String> = f.windows.iter().map(one).collect();
                return format!(
                    "Something acts for a time: {} in {}; a push, or the ship's own forces in a state that no other recording visits.",
                    values(f),
                    windows.join(" and ")
                );
            }
            format!("Something is missing, and these data cannot tell which of: {}.", f.confidence_set.join(", "))
        }),
        Verdict::Sensor => findings.first().map_or_else(
            || {
                let first = admission.issues.iter().find(|i| i.blocking);
                format!("Your sensor, not your ship: {}.", first.map_or("", |i| i.text.as_str()))
            },
            |f| format!("Your sensor, not your ship: {}.", list(f)),
        ),
        Verdict::Numerics => {
            "The integration step, not the ship: these recordings are what explicit Euler makes of the \
                              model at one step a sample."
                .into()
        }
        Verdict::NotInCatalogue => unlisted.map_or(String::new(), Missing::headline),
        Verdict::Random => "Force is there that the model lacks, but nothing about it repeats: gusts.".into(),
        Verdict::Insufficient => "These recordings cannot answer: too few runs.".into(),
        Verdict::NothingMissing => "Nothing is missing that these data could show.".into(),
    }
}
