//! Doubts about an actuator that one run shows and most others deny: a logger has one sign and one unit in all runs.
//! What the doubts are is decided where a run is audited; a comparison with the coefficients of the others may still confirm one.

use super::across::Evidence;
use crate::recording::Channel;
use crate::recording::audit::issue::{Issue, Severity};
use crate::recording::audit::limits::POOLED_EVIDENCE;
use crate::recording::audit::record::Responses;

/// Doubts of runs that are few of those that say anything: run, fault and channel.
#[derive(Clone, Debug, Default)]
pub struct Lone(Vec<(String, &'static str, Channel)>);

impl Lone {
    /// Those of some runs. A rudder or a propeller of the wrong sign, and a rudder too small for its unit, are faults of a log and not of one
    /// trial in it: a crash stop sails on ahead with its propeller astern, and a ship that is steered straight needs next to no rudder.
    pub fn of(runs: &[Evidence]) -> Self {
        let mut found = Vec::new();
        for (fault, channel) in [
            ("sign_error", Channel::Delta),
            ("sign_error", Channel::N),
            ("unit_error", Channel::Delta),
            ("unit_error", Channel::N),
        ] {
            let shown: Vec<&Evidence> = runs.iter().filter(|run| run.shows(fault, channel)).collect();
            let denied =
                runs.iter().filter(|run| !run.shows(fault, channel) && denies(run.responses(), fault, channel));
            if shown.len() < denied.count() {
                found.extend(shown.iter().map(|run| (run.name().to_owned(), fault, channel)));
            }
        }
        Self(found)
    }

    /// Makes the issue of a run a note where it is one of these, and a warning where the ship turns against its rudder: no trial makes it.
    pub fn weigh(&self, run: &str, issue: &mut Issue) {
        let is = |(of, fault, channel): &(String, &'static str, Channel)| {
            of == run && *fault == issue.fault && Some(*channel) == issue.channel
        };
        let turned = (issue.fault, issue.channel) == ("sign_error", Some(Channel::Delta));
        let severity = if turned { Severity::Warning } else { Severity::Note };
        if issue.severity > severity && self.0.iter().any(is) {
            issue.severity = severity;
            issue.text += ", but few of the runs show it, and the others do not";
        }
    }
}

/// Whether a run without the doubt is evidence against it: a sign where the motion answers to the side to which it must, a unit where the
/// motion answers at all. A propeller has no run that proves its sign; one that sails is enough.
fn denies(responses: &Responses, fault: &str, channel: Channel) -> bool {
    match (fault, channel) {
        ("sign_error", Channel::Delta) => responses.rudder.as_ref().is_some_and(|curve| curve.side() > POOLED_EVIDENCE),
        _ => true,
    }
}
