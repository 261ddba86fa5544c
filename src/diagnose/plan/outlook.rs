//! What the trials together show of each mechanism: whether it is identifiable, from which size on, and what takes over its gain.
//! The tests are the diagnosis' own, at measurements without error; how trials are chosen is decided elsewhere.

use crate::diagnose::answer::summary::{absorbed, detectable};
use crate::diagnose::evidence::candidate::{Candidate, Extent};
use crate::diagnose::search::screen::Screen;
use crate::diagnose::settings::{FORM_TOLERANCE, Settings};
use crate::model::Model;
use serde::Serialize;

/// Share of its gain above which a mechanism that another takes over cannot be parted from it.
pub const TOLERANCE: f64 = 1.0 - FORM_TOLERANCE;

/// What the trials show of a mechanism.
#[derive(Clone, Debug, Serialize)]
pub struct Outlook {
    /// Mechanism.
    pub mechanism: String,
    /// In plain words.
    pub title: String,
    /// Whether the trials can see it.
    pub identifiable: bool,
    /// Share of its information that is left once base parameters and nuisance coefficients are fitted too, in the least visible
    /// direction of its amplitude.
    pub retained: f64,
    /// Size that is seen in 80 % of such programmes at the chance of a false name that is allowed, in the least visible direction.
    pub size: Option<f64>,
    /// Unit of the size.
    pub unit: Option<String>,
    /// What hides it.
    pub absorbed_by: Option<String>,
    /// Whether it is seen only as a difference between sessions.
    pub between_sessions: bool,
}

/// Two mechanisms and the share of the gain of one that the other takes over.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Pair {
    /// One.
    pub a: String,
    /// The other.
    pub b: String,
    /// The share, 0 to 1.
    pub share: f64,
}

/// Which mechanisms take over each other's gain.
#[derive(Clone, Debug, Serialize)]
pub struct Isolability {
    /// The mechanisms that the trials can see with one amplitude in all sessions, without those that have no cause.
    pub mechanisms: Vec<String>,
    /// The largest share of the gain of a mechanism, over the directions of its amplitude, that another takes over, base parameters
    /// and nuisance coefficients fitted: the squared cosine of the smallest principal angle, equal both ways.
    pub share: Vec<Vec<f64>>,
    /// Share above which a pair cannot be parted.
    pub tolerance: f64,
    /// Pairs above it, the largest share first.
    pub pairs: Vec<Pair>,
    /// Mechanisms that pairs above it join, directly or by way of others.
    pub classes: Vec<Vec<String>>,
}

/// What the trials show of every mechanism, by name.
pub(super) fn outlooks(s: &Screen, list: &[Candidate], settings: &Settings, model: &Model) -> Vec<Outlook> {
    let (sizes, hidden) = (detectable(s, list, settings, model), absorbed(s, list));
    let of = |row: &crate::diagnose::search::screen::Row| {
        let mechanism = list[row.candidate].mechanism;
        let size = sizes.iter().find(|d| d.mechanism == mechanism.name);
        let hidden = hidden.iter().find(|a| a.mechanism == mechanism.name);
        Outlook {
            mechanism: mechanism.name.into(),
            title: mechanism.title.into(),
            identifiable: row.visible,
            retained: if row.visible { row.test.retained } else { row.pooled.retained },
            size: size.map(|d| d.size),
            unit: size.map(|d| d.unit.clone()),
            absorbed_by: hidden.map(|a| a.by.clone()),
            between_sessions: row.visible && row.extent != Extent::All,
        }
    };
    let mut all: Vec<Outlook> = s.rows.iter().map(of).collect();
    all.sort_by(|a, b| a.mechanism.cmp(&b.mechanism));
    all
}

/// The share of the gain of one candidate that another takes over, see [`Isolability::share`].
pub(super) fn share(s: &Screen, a: usize, b: usize) -> f64 {
    s.likeness(a, b).powi(2).clamp(0.0, 1.0)
}

impl Isolability {
    /// Of the mechanisms that a screen can see.
    pub(super) fn new(s: &Screen, list: &[Candidate]) -> Self {
        let seen = s.rows.iter().filter(|r| r.visible && r.extent == Extent::All).map(|r| r.candidate);
        let mut seen: Vec<usize> = seen.filter(|c| !list[*c].mechanism.stand_in).collect();
        seen.sort_by_key(|c| list[*c].mechanism.name);
        let count = seen.len();
        let mut shares = vec![vec![1.0; count]; count];
        let mut pairs = Vec::new();
        let name = |i: usize| list[seen[i]].mechanism.name.to_owned();
        for i in 0..count {
            for j in 0..i {
                let share = share(s, seen[j], seen[i]);
                (shares[i][j], shares[j][i]) = (share, share);
                if share > TOLERANCE {
                    pairs.push(Pair { a: name(j), b: name(i), share });
                }
            }
        }
        pairs.sort_by(|a, b| b.share.total_cmp(&a.share));
        let mechanisms: Vec<String> = (0..count).map(name).collect();
        let classes = classes(&mechanisms, &pairs);
        Self { mechanisms, share: shares, tolerance: TOLERANCE, pairs, classes }
    }
}

/// Names joined by pairs, directly or by way of others, in the order of the names.
fn classes(names: &[String], pairs: &[Pair]) -> Vec<Vec<String>> {
    let at = |name: &String| names.iter().position(|n| n == name).unwrap_or(0);
    let mut class: Vec<usize> = (0..names.len()).collect();
    for pair in pairs {
        let (from, to) = (class[at(&pair.a)], class[at(&pair.b)]);
        class.iter_mut().filter(|c| **c == from).for_each(|c| *c = to);
    }
    let members = |of: usize| names.iter().zip(&class).filter(|(_, c)| **c == of).map(|(n, _)| n.clone()).collect();
    let mut out: Vec<Vec<String>> = (0..names.len()).map(members).filter(|m: &Vec<String>| m.len() > 1).collect();
    out.sort();
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mechanisms_that_a_third_joins_are_one_class() {
        let names: Vec<String> = ["a", "b", "c", "d", "e"].map(String::from).into();
        let pair = |a: &str, b: &str| Pair { a: a.into(), b: b.into(), share: 0.95 };
        assert_eq!(classes(&names, &[pair("a", "d"), pair("c", "d")]), [["a", "c", "d"]]);
        assert_eq!(classes(&names, &[pair("a", "b"), pair("c", "e")]), [["a", "b"], ["c", "e"]]);
        assert!(classes(&names, &[]).is_empty());
    }
}
