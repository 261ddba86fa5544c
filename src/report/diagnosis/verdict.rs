//! The first part of a diagnosis: the verdict, the findings with their size, and what is wrong with the recordings.
//! Where the findings act and what proves them is in other parts.

use super::names::{kind_of, title_of};
use super::phrases::{amplitude, p_value, percent};
use super::proof::gains;
use crate::diagnose::answer::calibrate::ErrorRates;
use crate::diagnose::proof::stability::Stability;
use crate::diagnose::{Diagnosis, Finding, Grade, Verdict};
use crate::numerals::{fixed, number_of, sig};
use crate::physics::Kind;
use crate::recording::audit::Issue;
use crate::report::units::Units;
use std::collections::{BTreeMap, BTreeSet};

/// Notes of one kind that are written in full.
const NOTES: usize = 2;

/// Study, recordings, base model and integration in one line.
#[must_use]
pub fn subject(d: &Diagnosis, study: &str) -> String {
    let a = &d.admission;
    let aside = if d.set_aside > 0 { " (set aside here, as none are marked)" } else { "" };
    let runs = d.held_out.as_ref().map(|h| format!("{}{aside}", number_of(h.runs, "test run")));
    let held_out = runs.unwrap_or_else(|| "no test runs".to_owned());
    format!(
        "{study} · {} in {} ({} samples), {held_out} · base model {} · {}, {} a sample",
        number_of(a.runs, "run"),
        number_of(a.sessions, "session"),
        a.samples,
        d.base.name,
        format!("{:?}", a.integration.method).to_uppercase(),
        if a.integration.substeps == 1 { "one step".to_owned() } else { format!("{} steps", a.integration.substeps) },
    )
}

/// The name of a verdict in reports.
#[must_use]
pub fn verdict_words(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::NothingMissing => "NOTHING MISSING",
        Verdict::Named => "MISSING PHYSICS, NAMED",
        Verdict::OneOf => "MISSING PHYSICS, ONE OF SEVERAL",
        Verdict::NotInCatalogue => "MISSING PHYSICS, NOT IN THE CATALOGUE",
        Verdict::Sensor => "A SENSOR ERROR, NOT MISSING PHYSICS",
        Verdict::Numerics => "THE INTEGRATION STEP, NOT MISSING PHYSICS",
        Verdict::Random => "RANDOM FORCES, NO REPEATED EFFECT",
        Verdict::Insufficient => "THESE RECORDINGS GIVE NO ANSWER",
    }
}

/// The verdict in capitals; one on suspected findings alone says so, one on a force and a sensor names both, and one on actuators alone, or on
/// several mechanisms none of which is a force, is no physics that a model lacks.
pub(super) fn title(d: &Diagnosis) -> String {
    if let (Verdict::OneOf, Some(first)) = (d.verdict, d.findings.first()) {
        let kinds: Vec<Kind> = first.confidence_set.iter().map(|name| kind_of(&d.model, name)).collect();
        return one_of_words(&kinds).to_owned();
    }
    if let (Verdict::NothingMissing, [_, ..]) = (d.verdict, &d.differing[..]) {
        let count = if d.differing.len() == 1 { "ONE RECORDING" } else { "TWO RECORDINGS" };
        return format!("NOTHING MISSING, BUT FOR {count}");
    }
    let led = matches!(d.verdict, Verdict::Named | Verdict::Sensor);
    let Some(first) = d.findings.first().filter(|_| led) else { return verdict_words(d.verdict).to_owned() };
    let kinds = || d.findings.iter().filter(|f| f.grade == first.grade).map(|f| f.kind);
    if kinds().all(|kind| kind == Kind::Actuator) {
        let words = "AN ACTUATOR OR ITS RECORD";
        return if first.grade == Grade::Confirmed { words.to_owned() } else { format!("{words}, SUSPECTED") };
    }
    let level: Vec<bool> = kinds().map(|kind| kind == Kind::Sensor).collect();
    match (level.contains(&false), level.contains(&true), first.grade == Grade::Confirmed) {
        (true, true, true) => "MISSING PHYSICS AND A SENSOR ERROR".to_owned(),
        (true, true, false) => "MISSING PHYSICS AND A SENSOR ERROR, SUSPECTED".to_owned(),
        (_, false, false) => "MISSING PHYSICS, SUSPECTED".to_owned(),
        (false, _, false) => "A SENSOR ERROR, SUSPECTED".to_owned(),
        // The findings also include forces, which are only suspected.
        (false, _, true) if d.findings.iter().any(|f| f.kind != Kind::Sensor) => "A SENSOR ERROR".to_owned(),
        (_, _, true) => verdict_words(d.verdict).to_owned(),
    }
}

/// The verdict in capitals where one of several mechanisms of these kinds is meant.
fn one_of_words(kinds: &[Kind]) -> &'static str {
    let is_force = |kind: &Kind| matches!(kind, Kind::Environment | Kind::Ship);
    if kinds.iter().all(is_force) {
        verdict_words(Verdict::OneOf)
    } else if kinds.iter().any(is_force) {
        "MISSING PHYSICS OR AN ERROR OF A RECORD, ONE OF SEVERAL"
    } else if kinds.iter().all(|kind| *kind == Kind::Sensor) {
        "A SENSOR ERROR, ONE OF SEVERAL"
    } else {
        "AN ERROR OF A RECORD OR AN ACTUATOR, ONE OF SEVERAL"
    }
}

/// What comes nearest to a finding where there is none; what is as likely by chance as not stands out from nothing.
pub(super) fn strongest(d: &Diagnosis) -> Option<String> {
    let first = d.ranking.first().filter(|r| d.findings.is_empty() && r.p < 0.5)?;
    Some(format!("strongest candidate, not named: {}, {} after correction", first.title, p_value(first.p)))
}

/// The verdict with its findings, and notes on the recordings.
pub(super) fn verdict(d: &Diagnosis) -> Vec<String> {
    let units = Units::of(&d.base.ship);
    let mut lines = vec![title(d)];
    if d.findings.is_empty() {
        lines.push(d.headline.clone());
    }
    for f in &d.findings {
        let size = size(f, units);
        let sessions = sessions(d, f);
        lines.push(format!(
            "{} {}{size}{sessions}: {} after correction for the number of mechanisms tested",
            grade_words(f.grade),
            f.title,
            p_value(f.p)
        ));
        if f.confidence_set.len() > 1 {
            let all: Vec<&str> = f.confidence_set.iter().map(|m| title_of(&d.model, m)).collect();
            lines.push(format!("not distinguishable on these data: {}; {}", all.join(", "), f.why));
        } else {
            lines.push(f.why.clone());
        }
    }
    lines.extend(strongest(d));
    lines.extend(d.withdrawn.iter().map(|f| withdrawn(f, units)));
    lines.extend(d.stability.as_ref().map(stability));
    lines.extend(d.error_rates.as_ref().map(error_rates));
    lines.extend(notes(&d.admission.issues));
    lines
}

/// How well a finding is supported, before its title.
fn grade_words(grade: Grade) -> &'static str {
    match grade {
        Grade::Confirmed => "CONFIRMED:",
        Grade::Suspected => "SUSPECTED:",
        _ => "not named:",
    }
}

/// A grade as a word, and the class of its style.
#[cfg(feature = "plot")]
pub(super) fn grade_label(grade: Grade) -> (&'static str, &'static str) {
    match grade {
        Grade::Confirmed => ("confirmed", "confirmed"),
        Grade::Suspected => ("suspected", "suspected"),
        _ => ("not named", "withdrawn"),
    }
}

/// Why a mechanism of this grade is not named.
fn withdrawn_because(f: &Finding) -> &'static str {
    match f.grade {
        Grade::Refuted => "unseen runs refute it",
        Grade::RefutedTogether => {
            "all findings together predict unseen runs significantly worse, and it improves them least"
        }
        Grade::Immaterial if f.is_unresolved() => "it is measurable, and less than half a sample period",
        Grade::Immaterial => "it is measurable, and too small to matter",
        Grade::NotIsolated => {
            "on the headings that were sailed the ship's own parameters and its sensors (a side force, trim, resistance, the zero \
             of the compass, the scale of the log) can take over nearly all of its effect; the same runs on opposite headings would distinguish them"
        }
        Grade::EulerSteps => {
            "explicit Euler steps of one sample period in the program that made the recordings, or values that stay constant until the next sample, \
             explain them as well"
        }
        Grade::Unstable => "most repetitions on transformed recordings do not find it",
        // The region of several sizes together is wider than the interval of each, and a size may move as the model is written.
        Grade::Undetermined if f.parameters.iter().any(|p| p.ci95[0] > 0.0 || p.ci95[1] < 0.0) => {
            "its size is hardly determined: the region that all its uncertain sizes share contains zero"
        }
        Grade::Undetermined => "the interval of its size contains zero",
        Grade::Confirmed | Grade::Suspected => "the model does not follow the recordings without it or with it",
    }
}

/// A mechanism that was tried and is not named, with the reason.
pub(super) fn withdrawn(f: &Finding, units: Units) -> String {
    let reason = withdrawn_because(f);
    let proof = f.held_out.as_ref().map_or(String::new(), |h| {
        format!("; on {}: {}", number_of(h.recordings, "unseen recording"), gains(h).join(", "))
    });
    let change = f
        .change
        .filter(|c| c.is_finite())
        .map_or(String::new(), |c| format!("; it changes predictions by {} of their error", percent(c)));
    format!("tried and not named: {}{}: {reason}{change}{proof}", f.title, size(f, units))
}

/// How often such studies err, by simulation.
pub(super) fn error_rates(r: &ErrorRates) -> String {
    let mut text = format!(
        "in {} simulated studies of this kind with nothing missing, {} named something ({})",
        r.false_alarms.of, r.false_alarms.hits, r.false_alarms
    );
    if let Some(found) = r.found_again {
        text += &format!("; with what was found in them, it was found again in {found}");
    }
    if let Some(covered) = r.covered {
        text += &format!(", and its 95 % intervals contained the value in {covered}");
    }
    text
}

/// Whether the answer is the same on transformed recordings.
pub(super) fn stability(s: &Stability) -> String {
    let differing = s.variants.iter().filter(|v| !v.same).map(|v| {
        let found = if v.findings.is_empty() { "nothing named".to_owned() } else { v.findings.join(", ") };
        format!("{} ({found})", v.name)
    });
    let differing: Vec<String> = differing.collect();
    let but = if differing.is_empty() { String::new() } else { format!("; otherwise: {}", differing.join("; ")) };
    let again = if s.further.is_empty() {
        "the improved model diagnosed again lacks nothing further".to_owned()
    } else {
        format!("the improved model diagnosed again names further: {}", s.further.join(", "))
    };
    format!("same answer in {} of {} repetitions on transformed recordings{but}; {again}", s.same, s.of)
}

/// What is wrong with the recordings: whatever must be corrected first, and a few notes of each kind.
pub(super) fn notes(issues: &[Issue]) -> Vec<String> {
    let mut lines = Vec::new();
    let mut noted: BTreeMap<&str, usize> = BTreeMap::new();
    for i in issues {
        let count = noted.entry(i.fault).or_default();
        *count += usize::from(!i.blocking());
        if i.blocking() || *count <= NOTES {
            let word = if i.blocking() { "correct first" } else { "note" };
            lines.push(format!("{word}: {}; {}", i.text, i.next_step));
        }
    }
    let more = noted.into_iter().filter(|(_, count)| *count > NOTES);
    lines.extend(more.map(|(what, count)| format!("note: {} more runs with `{what}`", count - NOTES)));
    lines
}

/// The size of a finding, session by session where each has its own; nothing for a mechanism without one.
pub(super) fn size(f: &Finding, units: Units) -> String {
    if !f.by_session {
        return size_of(f, None, units).map_or(String::new(), |s| format!(", {s}"));
    }
    let of = |s: &String| Some(format!("{s} {}", size_of(f, Some(s.as_str()), units)?));
    let each: Vec<String> = f.sessions.iter().filter_map(of).collect();
    if each.is_empty() { String::new() } else { format!(": {}", each.join("; ")) }
}

/// In which sessions a finding acts, named by the shorter list.
fn sessions(d: &Diagnosis, f: &Finding) -> String {
    let all: BTreeSet<&str> = d.traces.iter().map(|t| t.session.as_str()).collect();
    let with: BTreeSet<&str> = f.sessions.iter().map(String::as_str).collect();
    let without: Vec<&str> = all.difference(&with).copied().collect();
    if f.by_session || with.is_empty() || without.is_empty() {
        return String::new();
    }
    let few = |list: &[&str]| match list {
        [first, second, third, _, rest @ ..] => format!("{first}, {second}, {third} and {} more", rest.len() + 1),
        _ => list.join(", "),
    };
    if without.len() < with.len() {
        format!(", in all sessions but {}", few(&without))
    } else {
        format!(", only in {}", few(&with.into_iter().collect::<Vec<_>>()))
    }
}

/// Size and direction of a mechanism given by its components towards north and east (in one session, where each has its own),
/// in the words of its kind: a deviation `d_N cos psi + d_E sin psi` is largest on the heading that is the direction of the vector.
fn size_of(f: &Finding, session: Option<&str>, units: Units) -> Option<String> {
    let tail = session.map_or(String::new(), |s| format!(" [{s}]"));
    let part = |suffix: &str| f.parameters.iter().find(|p| p.name.ends_with(&format!("{suffix}{tail}")));
    let (Some(north), Some(east)) = (part(".north"), part(".east")) else {
        let [only] = f.parameters.as_slice() else { return None };
        return Some(amplitude(only, units));
    };
    let size = north.value.hypot(east.value);
    if size <= 0.0 || !size.is_finite() {
        return None;
    }
    // Standard errors that an interval reaches to either side.
    let reach = if north.error > 0.0 { 0.5 * (north.ci95[1] - north.ci95[0]) / north.error } else { 0.0 };
    // To first order, and as if the components were uncorrelated.
    let error = (north.value * north.error).hypot(east.value * east.error) / size;
    let swing = ((east.value * north.error).hypot(north.value * east.error) / (size * size)).to_degrees();
    let towards = east.value.atan2(north.value).to_degrees();
    let from = (towards + 180.0).rem_euclid(360.0);
    let towards = towards.rem_euclid(360.0);
    let (magnitude, error, unit, direction) = match f.mechanism.as_str() {
        "current" => (size, error, "m/s", format!("setting towards {towards:03.0} deg")),
        "mean_wind" => (size, error, "m/s", format!("from {from:03.0} deg")),
        "wave_drift" => {
            (size.sqrt(), 0.5 * error / size.sqrt(), "m significant height", format!("from {from:03.0} deg"))
        }
        "compass_deviation" => {
            let (factor, unit) = units.human(&north.unit);
            (size * factor, error * factor, unit, format!("where it is largest, on a heading of {towards:03.0} deg"))
        }
        _ => {
            let (factor, unit) = units.human(&north.unit);
            (size * factor, error * factor, unit, format!("towards {towards:03.0} deg"))
        }
    };
    let direction = if swing < 60.0 {
        format!("{direction} (+-{} deg)", fixed((reach * swing).max(1.0), 0))
    } else {
        "direction not determined".to_owned()
    };
    let low = (magnitude - reach * error).max(0.0);
    Some(format!("{} {unit} ({} to {}) {direction}", sig(magnitude, 3), sig(low, 3), sig(magnitude + reach * error, 3)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::Channel;
    use crate::recording::audit::Severity;

    #[test]
    fn several_errors_of_sensors_are_no_missing_physics() {
        let words = |kinds: &[Kind]| one_of_words(kinds);
        assert_eq!(words(&[Kind::Environment, Kind::Ship]), "MISSING PHYSICS, ONE OF SEVERAL");
        assert_eq!(words(&[]), "MISSING PHYSICS, ONE OF SEVERAL");
        assert_eq!(words(&[Kind::Sensor, Kind::Sensor]), "A SENSOR ERROR, ONE OF SEVERAL");
        assert!(words(&[Kind::Sensor, Kind::Actuator]).starts_with("AN ERROR OF A RECORD OR AN ACTUATOR"));
        assert!(words(&[Kind::Ship, Kind::Actuator]).starts_with("MISSING PHYSICS OR AN ERROR OF A RECORD"));
    }

    #[test]
    fn every_issue_to_correct_is_written_and_only_notes_beyond_two_of_a_kind_are_counted() {
        let issue = |severity, text: &str| Issue::new(severity, "jump", text, "look at it").of(Channel::R);
        let blocking: Vec<Issue> = ["a", "b", "c"].map(|text| issue(Severity::Error, text)).into();
        assert_eq!(notes(&blocking), ["a", "b", "c"].map(|t| format!("correct first: {t}; look at it")));
        let mut both = blocking;
        both.extend(["d", "e", "f", "g"].map(|text| issue(Severity::Warning, text)));
        let lines = notes(&both);
        assert_eq!(lines[3..], ["note: d; look at it", "note: e; look at it", "note: 2 more runs with `jump`"]);
    }
}
