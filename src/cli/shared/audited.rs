//! The audit of a study's recordings before a command uses them: faults stop it, doubts are printed first.
//! The faults are the library's; this file groups them over the runs and says what was accepted.

use super::error::CliError;
use super::load::Loaded;
use super::progress::progress;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use trimtab::files::ranks::Ranks;
use trimtab::files::suggestion;
use trimtab::model::Model;
use trimtab::recording::Channel;
use trimtab::recording::audit::{Issue, Lone, Severity, across, audit_each, audit_model};

/// Arguments of the commands that compute with recordings.
#[derive(Clone, Debug, clap::Args)]
pub struct AcceptArgs {
    /// Go on in spite of this fault of the recordings, by the name in the message (such as `sign_error`); may be given several
    /// times.
    #[arg(long, value_name = "FAULT")]
    pub accept: Vec<String>,
}

impl AcceptArgs {
    /// The faults by name.
    pub fn faults(&self) -> &[String] {
        &self.accept
    }
}

/// A warning, or an error that was accepted, in so many of the runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Doubt {
    severity: Severity,
    fault: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    channel: Option<Channel>,
    /// What was found in the first of the runs.
    text: String,
    next_step: String,
    /// The runs in which it was found; none where it is about the model.
    runs: Vec<String>,
    /// Whether the user accepts it.
    accepted: bool,
}

/// What a command has to say of the recordings that it used.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Audited {
    /// Runs that were looked at.
    runs: usize,
    /// What was found, the gravest first.
    doubts: Vec<Doubt>,
}

/// Faults that can be accepted: the recordings can be read and say what they say.
const CONTRADICTIONS: [&str; 7] =
    ["unit_error", "sign_error", "axes_error", "fill_value", "heading_wrap", "shared_data", "not_recorded"];

/// Audits the recordings of a study for a command that computes with what they say.
///
/// # Errors
/// [`CliError::Faulty`] where the recordings contradict themselves and this was not accepted. A recording that cannot be read, or a
/// study without runs on one side, is left to the command, whose message says more.
pub fn audited(loaded: &Loaded, args: &AcceptArgs) -> Result<Audited, CliError> {
    audited_over(Ranks::one(), loaded, args)
}

/// As [`audited`], with the recordings divided among the ranks, each of which gets the same answer.
///
/// # Errors
/// As [`audited`], on every rank.
pub fn audited_over(ranks: &Ranks, loaded: &Loaded, args: &AcceptArgs) -> Result<Audited, CliError> {
    let audited = examined_over(ranks, loaded, args)?;
    match audited.doubts.iter().find(|d| d.refused()) {
        Some(doubt) => Err(CliError::Faulty {
            path: loaded.study.path.clone(),
            what: audited.sentence(doubt),
            fault: doubt.fault.clone(),
        }),
        None => Ok(audited),
    }
}

/// Audits the recordings of a study for a command whose own answer may be that they contradict themselves.
///
/// # Errors
/// A fault to accept that there is not.
pub fn examined(loaded: &Loaded, args: &AcceptArgs) -> Result<Audited, CliError> {
    examined_over(Ranks::one(), loaded, args)
}

fn examined_over(ranks: &Ranks, loaded: &Loaded, args: &AcceptArgs) -> Result<Audited, CliError> {
    for name in &args.accept {
        if !CONTRADICTIONS.contains(&name.as_str()) {
            let known = CONTRADICTIONS.join(", ");
            let near = suggestion(name, CONTRADICTIONS.into_iter());
            return Err(CliError::Argument(format!("there is no fault `{name}` to accept; they are {known}{near}")));
        }
    }
    let own = loaded.part(ranks, |_| true).study;
    let bar = progress(format!("auditing {} recordings", own.runs.len()));
    let mut audit = audit_each(&own, &loaded.model.ship);
    bar.finish_and_clear();
    let evidence: Vec<_> = ranks.gather(&audit.evidence).into_iter().flatten().collect();
    audit.weigh(&Lone::of(&evidence));
    let found = audit.recordings.iter().flat_map(|a| a.issues.iter().map(|i| (a.run.as_str(), i)));
    let own: Vec<Doubt> = found.filter_map(|(run, issue)| doubt_of(&[run.to_owned()], issue)).collect();
    let compared = across(&evidence, &loaded.model.ship);
    let (single, several): (Vec<_>, Vec<_>) = compared.iter().partition(|shared| shared.runs.len() == 1);
    let single = single.iter().filter_map(|shared| doubt_of(&shared.runs, &shared.issue));
    let mut doubts = grouped(ranks.gather(&own).into_iter().flatten().chain(single));
    doubts.extend(several.iter().filter_map(|shared| doubt_of(&shared.runs, &shared.issue)));
    doubts.extend(of_model(&loaded.model));
    doubts.sort_by_key(|d| std::cmp::Reverse(d.severity));
    for doubt in &mut doubts {
        doubt.accepted = args.accept.contains(&doubt.fault);
    }
    Ok(Audited { runs: loaded.study.runs.len(), doubts })
}

/// The doubts about a model, for a command that uses no recording; `None` where there are none.
pub fn model_alone(model: &Model) -> Option<Audited> {
    let doubts = of_model(model);
    (!doubts.is_empty()).then_some(Audited { runs: 0, doubts })
}

fn of_model(model: &Model) -> Vec<Doubt> {
    audit_model(model).iter().filter_map(|issue| doubt_of(&[], issue)).collect()
}

/// The doubt that an issue of some runs raises; none for a note, or for an error that the command reports itself.
fn doubt_of(runs: &[String], issue: &Issue) -> Option<Doubt> {
    let raised = match issue.severity {
        Severity::Note => false,
        Severity::Warning => true,
        Severity::Error => CONTRADICTIONS.contains(&issue.fault),
    };
    raised.then(|| Doubt {
        severity: issue.severity,
        fault: issue.fault.to_owned(),
        channel: issue.channel,
        text: issue.text.clone(),
        next_step: issue.next_step.clone(),
        runs: runs.to_vec(),
        accepted: false,
    })
}

/// Doubts of one run each by fault and channel, the gravest first, then in the order found; of a fault that is reported twice for a run,
/// the graver.
fn grouped(found: impl Iterator<Item = Doubt>) -> Vec<Doubt> {
    let mut found: Vec<Doubt> = found.collect();
    found.sort_by_key(|d| std::cmp::Reverse(d.severity));
    let mut doubts: Vec<Doubt> = Vec::new();
    for one in found {
        let graver = |d: &Doubt| {
            d.severity > one.severity
                && (&d.fault, d.channel) == (&one.fault, one.channel)
                && one.runs.iter().all(|run| d.runs.contains(run))
        };
        if doubts.iter().any(graver) {
            continue;
        }
        let same = |d: &&mut Doubt| (d.severity, &d.fault, d.channel) == (one.severity, &one.fault, one.channel);
        match doubts.iter_mut().find(same) {
            Some(doubt) => {
                let new = one.runs.into_iter().filter(|run| !doubt.runs.contains(run)).collect::<Vec<_>>();
                doubt.runs.extend(new);
            }
            None => doubts.push(one),
        }
    }
    doubts
}

impl Doubt {
    fn refused(&self) -> bool {
        self.severity == Severity::Error && !self.accepted
    }
}

impl Audited {
    /// One doubt in a sentence, with the number of runs.
    fn sentence(&self, doubt: &Doubt) -> String {
        let channel = doubt.channel.map_or(String::new(), |c| format!("{c}: "));
        let (first, count) = (doubt.runs.first().map_or("", String::as_str), doubt.runs.len());
        let (example, runs) = match count {
            0 => (String::new(), String::new()),
            1 => (String::new(), format!(": run `{first}`")),
            _ => (format!(" (as in `{first}`)"), format!(": {count} of {} runs", self.runs)),
        };
        format!("{channel}{}{example}{runs}; {}", doubt.text, doubt.next_step)
    }

    /// Whether there is an error that the user does not accept.
    pub fn refused(&self) -> bool {
        self.doubts.iter().any(Doubt::refused)
    }

    /// That an answer is of recordings with errors which the user does not accept, for a command that answers all the same; empty without any.
    pub fn caution(&self) -> String {
        let refused = self.doubts.iter().filter(|d| d.refused() && CONTRADICTIONS.contains(&d.fault.as_str()));
        let faults: BTreeSet<String> = refused.map(|d| format!(" --accept {}", d.fault)).collect();
        let accept = if faults.is_empty() {
            String::new()
        } else {
            format!(", or accept them with{}", faults.into_iter().collect::<String>())
        };
        let text = "The answer below is of recordings with the errors above and may be false: mend them first";
        if self.refused() { format!("{text}{accept}. Exit code 1.\n\n") } else { String::new() }
    }

    /// What was found, a sentence each.
    pub fn sentences(&self) -> Vec<String> {
        let line = |d: &Doubt| {
            let word = match (d.severity, d.accepted) {
                (Severity::Error, true) => "accepted error",
                (Severity::Error, false) => "error",
                _ => "warning",
            };
            format!("{word}: {}", self.sentence(d))
        };
        self.doubts.iter().map(line).collect()
    }

    /// The lines that come before the answer; empty where there is nothing to say.
    pub fn lines(&self) -> String {
        let mut text: String = self.sentences().iter().flat_map(|line| [line, "\n"]).collect();
        if self.runs > 0 && !text.is_empty() {
            text += "`trimtab check` lists all that was found in the recordings.\n\n";
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn issue(severity: Severity, fault: &'static str, channel: Channel, text: &str) -> Issue {
        Issue::new(severity, fault, text, "look at it").of(channel)
    }

    #[test]
    fn of_a_fault_that_is_reported_twice_for_a_run_the_graver_is_kept() {
        let raised =
            |run: &str, severity| doubt_of(&[run.to_owned()], &issue(severity, "not_recorded", Channel::Psi, "none"));
        let found = [("a", Severity::Warning), ("b", Severity::Warning), ("a", Severity::Error)];
        let sign = doubt_of(&["a".to_owned()], &issue(Severity::Error, "sign_error", Channel::R, "turned"));
        let doubts = grouped(found.into_iter().filter_map(|(run, severity)| raised(run, severity)).chain(sign));
        let of: Vec<(Severity, &[String])> = doubts.iter().map(|d| (d.severity, &d.runs[..])).collect();
        let [a, b] = [["a".to_owned()], ["b".to_owned()]];
        assert_eq!(of, [(Severity::Error, &a[..]), (Severity::Error, &a[..]), (Severity::Warning, &b[..])]);
    }

    #[test]
    fn a_fault_of_many_runs_is_listed_once_with_their_number_and_errors_come_first() {
        let warning = |text| issue(Severity::Warning, "frozen", Channel::Psi, text);
        let error = issue(Severity::Error, "sign_error", Channel::R, "the sign is turned");
        let note = issue(Severity::Note, "clock", Channel::R, "runs late");
        let found = [("a", warning("stands still for 3 s")), ("a", warning("stands still for 9 s")), ("b", error)];
        let more = [("b", warning("stands still for 5 s")), ("c", note)];
        let all: Vec<(&str, Issue)> = found.into_iter().chain(more).collect();
        let audited =
            Audited { runs: 3, doubts: grouped(all.iter().filter_map(|(r, i)| doubt_of(&[(*r).to_owned()], i))) };
        let lines = audited.lines();
        let lines: Vec<&str> = lines.lines().collect();
        assert!(audited.refused());
        assert_eq!(lines[0], "error: r: the sign is turned: run `b`; look at it");
        assert_eq!(lines[1], "warning: psi: stands still for 3 s (as in `a`): 2 of 3 runs; look at it");
        assert!(lines[2].starts_with("`trimtab check`") && lines.len() == 4, "{lines:?}");
        assert_eq!((Audited::default().lines(), Audited::default().caution()), (String::new(), String::new()));
        assert!(
            audited.caution().ends_with("mend them first, or accept them with --accept sign_error. Exit code 1.\n\n")
        );
    }
}
