//! Which mechanisms of a ranking may be named, alone and beside others, before any of them is refitted.
//! It compares numbers of the score tests with the settings; it estimates nothing.

use super::candidate::{Candidate, Extent};
use super::compete::Selected;
use super::screen::{Row, Screen};
use super::settings::{FURTHER_P, FURTHER_SHARE, OWN_PHYSICS_ALPHA, SECOND_OPINION_P, SMALLEST_SIZE, Settings};
use crate::physics::{Kind, Mechanism};

/// The mechanisms that may be named beside those that were selected, the most significant first. `alone` says that nothing was
/// found yet, neither a mechanism nor a push nor a coarse integration step.
pub fn eligible<'s>(
    s: &'s Screen,
    candidates: &[Candidate],
    selected: &[Selected],
    alone: bool,
    settings: &Settings,
) -> Vec<&'s Row> {
    let may = |r: &&Row| may_be_named(r, candidates, settings) && (alone || may_be_further(r, selected, candidates));
    s.rows.iter().filter(may).collect()
}

/// Whether a mechanism may be named: identifiable, significant, of possible sign and worthwhile size, and not just the ship's own
/// forces in another form.
pub fn may_be_named(r: &Row, candidates: &[Candidate], settings: &Settings) -> bool {
    let m = candidates[r.candidate].mechanism;
    r.visible
        && r.admissible
        && r.p < significance(m, settings)
        && r.size >= SMALLEST_SIZE
        && r.second_opinion < SECOND_OPINION_P
}

/// The chance of a false name that a mechanism's test is allowed. Sessions differ in what was sailed, and a ship's forces in
/// another form then differ between them: the ship's own physics must be more significant.
fn significance(m: &Mechanism, settings: &Settings) -> f64 {
    let own = m.needs_reference && m.kind == Kind::Ship;
    if own { OWN_PHYSICS_ALPHA * settings.alpha } else { settings.alpha }
}

/// Whether a further mechanism may be named beside those that were selected: it must be beyond doubt, and more than what an
/// imperfect form of an earlier one leaves behind.
pub fn may_be_further(r: &Row, selected: &[Selected], candidates: &[Candidate]) -> bool {
    let m = candidates[r.candidate].mechanism;
    let left_by = |a: &Selected| {
        let first = candidates[a.candidate].mechanism;
        // Changes of the ship's own forces between sessions: the form of the first cannot be told from a second.
        let between_sessions = a.extent != Extent::All && r.extent != Extent::All;
        (between_sessions && m.needs_reference && first.needs_reference)
            || (m.looks_like(first) && r.test.statistic < FURTHER_SHARE * a.statistic)
    };
    r.p < FURTHER_P && selected.iter().all(|a| a.candidate != r.candidate && !left_by(a))
}
