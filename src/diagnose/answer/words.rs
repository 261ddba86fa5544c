//! The verdict in one sentence, and the trial to sail next.
//! It says what was decided and decides nothing.

use super::cause::Cause;
use super::diagnosis::{Budget, NextTrial};
use crate::diagnose::evidence::candidate::Candidate;
use crate::diagnose::evidence::place::Place;
use crate::diagnose::evidence::push::Window;
use crate::diagnose::law::Law;
use crate::diagnose::proof::finding::{Amplitude, Finding, GENERIC, PUSH};
use crate::diagnose::proof::grade::{Grade, LawGrade};
use crate::diagnose::proof::influence::Following;
use crate::diagnose::proof::prove::HeldOut;
use crate::diagnose::proof::unseen::FindingProof;
use crate::diagnose::search::decide::Verdict;
use crate::diagnose::settings::{BENT, BEYOND_DOUBT, FEWEST_RECORDINGS, GUST_SHARE};
use crate::numerals::{number_of, sig};
use crate::physics::Kind;
use std::collections::BTreeSet;

/// What is missing and not in the catalogue, as far as the tests show it.
pub enum Missing<'a> {
    /// A law of state and inputs, as far as one was found.
    Law(Option<&'a Law>),
    /// A force in one part of the water.
    Place(&'a Place),
}

impl Missing<'_> {
    /// The verdict in one sentence.
    pub fn headline(&self) -> String {
        match self {
            Self::Law(law) => format!("Something is missing that is not in the catalogue{}.", law_words(*law)),
            Self::Place(place) => {
                let [south, north] = place.north.map(|v| v.round());
                let [west, east] = place.east.map(|v| v.round());
                let [to_north, to_east] = place.force.map(|v| sig(v, 3));
                format!(
                    "Something is missing that is not in the catalogue: a force that differs from place to place, strongest from \
                     {south} to {north} m north and {west} to {east} m east, where {to_north} N to north and {to_east} N to east \
                     are added to the force that acts everywhere."
                )
            }
        }
    }

    /// The trial that shows it best.
    pub fn next_trial(&self) -> NextTrial {
        let (trial, why) = match self {
            Self::Law(_) => (
                "straight runs at several speeds on opposite headings, and turning circles to both sides",
                "they separate forces that depend on speed, on heading and on the side of the turn",
            ),
            Self::Place(_) => (
                "straight runs through that part of the water and past it, on opposite headings",
                "they show how far the force reaches and whether it is fixed on the earth",
            ),
        };
        NextTrial { trial: trial.into(), why: why.into() }
    }
}

/// The law for what is missing, with its grade; a law that unseen runs refute is not repeated.
fn law_words(law: Option<&Law>) -> String {
    let Some(law) = law else {
        return ": a force to one side or fixed on the earth, for which no law of few terms is significant".into();
    };
    let proof = law.held_out.as_ref().map_or(String::new(), on_unseen);
    let equation = law.equation.join("; ");
    match law.grade {
        LawGrade::Confirmed => format!(". A law that describes it is confirmed on unseen runs{proof}: {equation}"),
        LawGrade::Exploratory => {
            format!(". A candidate law, exploratory and not confirmed on unseen runs{proof}: {equation}")
        }
        LawGrade::Refuted => format!(". The law that fits the training runs best is refuted by unseen runs{proof}"),
    }
}

/// The trial to sail next, where one would show more.
pub fn next_trial(verdict: Verdict, findings: &[Finding], list: &[Candidate]) -> Option<NextTrial> {
    let by_name = |n: &str| list.iter().find(|c| c.mechanism.name == n).map(|c| c.mechanism);
    match verdict {
        Verdict::OneOf => {
            let set = &findings.first()?.confidence_set;
            if set.iter().any(|m| m == GENERIC) {
                return Some(NextTrial {
                    trial: "the same manoeuvre twice more, without tugs, thrusters or lines".into(),
                    why: "the ship's own forces act again in the same manoeuvre, a push does not".into(),
                });
            }
            let rival = by_name(set.get(1)?)?;
            Some(NextTrial {
                trial: rival.trial.into(),
                why: format!("it distinguishes {} from {}", by_name(set.first()?)?.title, rival.title),
            })
        }
        Verdict::Named | Verdict::Sensor => {
            let m = by_name(&findings.first()?.mechanism)?;
            Some(NextTrial { trial: m.trial.into(), why: format!("it shows {} most clearly", m.title) })
        }
        Verdict::Insufficient => Some(NextTrial {
            trial: "turning circles both ways, a zigzag and a crash stop, each on two headings, in two sessions".into(),
            why: "with so few runs no mechanism can be distinguished from another".into(),
        }),
        _ => None,
    }
}

/// What a headline is made of, beside the verdict.
#[derive(Clone, Copy)]
pub struct Said<'a> {
    /// What is named.
    pub findings: &'a [Finding],
    /// What was tried and withdrawn.
    pub withdrawn: &'a [Finding],
    /// How the model follows the recordings.
    pub following: &'a Following,
    /// Whether it follows them well enough.
    pub holds: bool,
    /// Whether the ship's own forces have the form that the model gives them.
    pub form_holds: bool,
    /// What is missing and not in the catalogue.
    pub missing: Option<&'a Missing<'a>>,
    /// Unseen runs without the findings and with all of them, where they predict these runs worse.
    pub worse: Option<Worse>,
    /// The ship's own coefficients beside what is known of such coefficients.
    pub hull: &'a [Budget],
    /// Windows with a force that the base model does not have.
    pub windows: &'a [Window],
    /// Those of the recordings that differ from all others, see [`differing`].
    pub differing: &'a [&'a str],
    /// What explains them, where something does.
    pub causes: &'a [Cause],
    /// Recordings that were looked at.
    pub recordings: usize,
}

/// The verdict in a sentence or two.
pub fn headline(verdict: Verdict, said: &Said) -> String {
    let first = said.findings.first();
    let withdrawn = |grade: Grade| said.withdrawn.iter().find(|f| f.grade == grade);
    match verdict {
        Verdict::Named | Verdict::Sensor => named(said.findings) + &together(said.worse),
        Verdict::OneOf => first.map_or(String::new(), one_of),
        Verdict::NotInCatalogue => match (said.missing, withdrawn(Grade::Refuted).or(withdrawn(Grade::RefutedTogether))) {
            (Some(missing), None) => missing.headline(),
            (Some(missing), Some(tried)) => {
                format!("{} {} was tried, and unseen runs refute it{}.", missing.headline(), sentence(&tried.title), refuted(tried))
            }
            (None, Some(tried)) => format!(
                "Something is missing, and it is no law of the catalogue: {} fits the training runs best, and unseen runs refute it{}.",
                tried.title,
                refuted(tried)
            ),
            (None, None) => "Something is missing, and it is no law of the catalogue.".into(),
        },
        Verdict::Numerics => {
            "The integration step, not the ship: explicit Euler steps of one sample period reproduce the recordings to rounding."
                .into()
        }
        Verdict::Random => {
            let what = if said.form_holds {
                "An unknown force acts, but nothing about it repeats: gusts."
            } else {
                "An unknown force is left in which nothing repeats: the ship's own forces have another form than the model gives them, or \
                 gusts act beside them."
            };
            what.to_owned() + &but_for(said)
        }
        Verdict::Insufficient if !said.holds => not_followed(said.following),
        Verdict::Insufficient => withdrawn(Grade::NotIsolated)
            .map_or_else(|| "These recordings cannot answer: too few runs.".into(), not_isolated),
        Verdict::NothingMissing => {
            nothing(said) + &but_for(said) + &of_another_form(said.form_holds) + &bent(said.hull)
        }
    }
}

/// The recordings that differ from all others: forces act in them, where chance does not make them, that the model does not have. None where
/// they are not few, as the others, most of them, must speak for the model.
pub fn differing(windows: &[Window], recordings: usize) -> Vec<&str> {
    let surely = windows.iter().filter(|w| w.p < BEYOND_DOUBT);
    let names: BTreeSet<&str> = surely.map(|w| w.run.as_str()).collect();
    let few = names.len() < FEWEST_RECORDINGS && 2 * names.len() < recordings;
    names.into_iter().filter(|_| few).collect()
}

/// That a few recordings differ from the others, with when.
fn but_for(said: &Said) -> String {
    let names = said.differing;
    if names.is_empty() {
        return String::new();
    }
    let when = |name: &&str| {
        let own = || said.windows.iter().filter(|w| w.run == *name && w.p < BEYOND_DOUBT);
        let from = own().map(|w| w.start).fold(f64::INFINITY, f64::min);
        let to = own().map(|w| w.end).fold(f64::NEG_INFINITY, f64::max);
        format!("`{name}` (between {} and {} s)", sig(from, 3), sig(to, 3))
    };
    let named = names.iter().map(when).collect::<Vec<_>>().join(" and ");
    let (verb, log, its) =
        if names.len() == 1 { ("differs", "that log", "its") } else { ("differ", "those logs", "their") };
    let because: String = names.iter().map(|name| because(name, said.causes)).collect();
    format!(
        " But {named} {verb}: forces act there that the model does not have and the other {} do not show (p < {BEYOND_DOUBT:e}).{because} Look at {log}: \
         {its} rudder angle, propeller rate or clock may not be what acted, or something touched the ship; leave it out and compare.",
        number_of(said.recordings - names.len(), "recording")
    )
}

/// What explains a recording that differs from the others.
fn because(recording: &str, causes: &[Cause]) -> String {
    let Some(c) = causes.iter().find(|c| c.recording == recording) else {
        return format!(" Nothing of the catalogue explains `{recording}` better than constant forces in it.");
    };
    let size = values(c.mechanism, &c.parameters);
    let alike = if c.alike.is_empty() { String::new() } else { format!(", and {} as well", c.alike.join(", ")) };
    format!(" In `{recording}` alone, {} ({size}) explains it best{alike}.", c.title)
}

/// That the fit needs a coefficient of the ship that no such ship has: what acts the same in all recordings may be in it.
fn bent(hull: &[Budget]) -> String {
    let furthest = hull.iter().filter(|b| b.used.is_finite()).max_by(|a, b| a.used.abs().total_cmp(&b.used.abs()));
    furthest.filter(|b| b.used.abs() > BENT).map_or(String::new(), |b| {
        format!(
            " But the fit needs {} = {}, where {} +- {} is usual: what acts alike in all recordings may be in it, such as a wrong particular of \
             the ship file (mass, centre of gravity, diameter of the propeller) or a lever of the antenna.",
            b.name,
            sig(b.value, 3),
            sig(b.prior, 3),
            sig(b.sd, 2)
        )
    })
}

/// That weather cannot be distinguished from the ship itself.
fn not_isolated(f: &Finding) -> String {
    format!(
        "These recordings do not decide: {} is significant, but on the headings that were sailed the ship's own parameters and its sensors \
         (a side force, trim, resistance, the zero of the compass, the scale of the log) can take over nearly all of its effect; \
         the same runs on opposite headings would part them.",
        f.title
    )
}

/// That nothing is named, and what was nearest to it.
fn nothing(said: &Said) -> String {
    let withdrawn = |grade: Grade| said.withdrawn.iter().find(|f| f.grade == grade);
    if let Some(f) = withdrawn(Grade::NotIsolated) {
        return format!("Nothing is missing that can be named. {}", not_isolated(f));
    }
    if let Some(f) = withdrawn(Grade::Immaterial) {
        let why = if f.is_unresolved() {
            "is measurable, and is less than half a sample period".to_owned()
        } else {
            let change = 100.0 * f.change.unwrap_or(0.0);
            format!("is measurable, and changes predictions by {} % of their error", sig(change, 2))
        };
        return format!(
            "Nothing is missing that matters: {} ({}) {why}.",
            f.title,
            values(&f.mechanism, &f.parameters)
        );
    }
    if let Some(f) = withdrawn(Grade::EulerSteps) {
        return format!(
            "Nothing is missing that can be named: {} ({}) would explain the recordings, and so would explicit Euler steps of one sample \
             period in the program that made them, or values held until the next sample.",
            f.title,
            values(&f.mechanism, &f.parameters)
        );
    }
    "Nothing is missing that these data could show.".into()
}

/// That the ship's own forces have another form than the model's, where they are too small to be called unknown forces.
fn of_another_form(form_holds: bool) -> String {
    let text = || {
        format!(
            " The ship's own forces have another form than the model gives them, by less than {} % of the force that turns it.",
            sig(100.0 * GUST_SHARE, 2)
        )
    };
    if form_holds { String::new() } else { text() }
}

/// Words at the start of a sentence.
fn sentence(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

/// That the model does not follow the recordings, and what to do.
fn not_followed(f: &Following) -> String {
    let cvdm = match (f.cvdm, f.steady) {
        (Some(own), Some(steady)) => format!(" (mean cVDM {} % against {} %)", sig(own, 3), sig(steady, 3)),
        _ => String::new(),
    };
    format!(
        "These recordings cannot answer, because the model does not follow them: it simulates {} of {} runs better than motion that \
         stays as it was at the start, and these do not outweigh the others{cvdm}. Check units, signs and the inputs that act on the ship, divide the recordings into \
         shorter windows, or free the hull coefficients where the model file leaves them fixed (hull = \"free\").",
        f.better_than_steady, f.runs
    )
}

/// A finding with its values, grade and proof.
fn titled(f: &Finding) -> String {
    let size = match f.sessions.as_slice() {
        all if f.by_session => format!("a different value in each of {} sessions", all.len()),
        [] => values(&f.mechanism, &f.parameters),
        [one] => format!("{}, only in {one}", values(&f.mechanism, &f.parameters)),
        some => format!("{}, only in {} sessions", values(&f.mechanism, &f.parameters), some.len()),
    };
    let grade = match f.grade {
        Grade::Confirmed if f.held_out.is_none() => "shown by the recordings themselves",
        Grade::Confirmed => "confirmed on unseen runs",
        _ => "suspected",
    };
    format!("{} ({size}), {grade}{}", f.title, proof(f))
}

/// What a finding does on unseen runs, in brackets.
fn proof(f: &Finding) -> String {
    f.held_out.as_ref().map_or(String::new(), on_unseen)
}

/// Errors on unseen runs without and with a finding or a law, in brackets.
fn on_unseen(h: &FindingProof) -> String {
    let mut parts = Vec::new();
    if h.is_shown() {
        parts.push("their sensors show it themselves".to_owned());
    } else if h.agreement().is_some_and(|g| g.is_below_zero()) {
        parts.push("their sensors contradict it".to_owned());
    }
    if let Some([before, after]) = h.position {
        parts.push(format!("position error {} m to {} m", sig(before, 3), sig(after, 3)));
    }
    if let (Some(before), Some(after)) = (h.before, h.after) {
        parts.push(format!("cVDM {} % to {} %", sig(before, 3), sig(after, 3)));
    }
    parts.push(number_of(h.recordings, "unseen recording"));
    format!(" ({})", parts.join(", "))
}

/// What unseen runs say against a finding.
fn refuted(f: &Finding) -> String {
    match f.grade {
        Grade::RefutedTogether => " together with what else was found".into(),
        _ => proof(f),
    }
}

/// The parameters of a finding; a vector fixed on the earth by its size and direction.
fn values(mechanism: &str, parameters: &[Amplitude]) -> String {
    if let [north, east] = parameters
        && north.name.ends_with(".north")
        && east.name.ends_with(".east")
    {
        let towards = east.value.atan2(north.value).to_degrees().rem_euclid(360.0);
        let (word, angle) = match mechanism {
            "mean_wind" | "wave_drift" => ("from", (towards + 180.0).rem_euclid(360.0)),
            "compass_deviation" => ("on a heading of", towards),
            _ => ("toward", towards),
        };
        return format!("{} {} {word} {angle:03.0} deg", sig(north.value.hypot(east.value), 3), north.unit);
    }
    // A parameter without a unit has `-` in its place.
    let unit = |p: &Amplitude| if p.unit == "-" { String::new() } else { format!(" {}", p.unit) };
    let one = |p: &Amplitude| format!("{} = {}{}", p.name, sig(p.value, 3), unit(p));
    let undetermined = |p: &Amplitude| p.ci95[0] <= 0.0 && p.ci95[1] >= 0.0;
    let all = parameters.iter().map(one).collect::<Vec<_>>().join(", ");
    if parameters.iter().all(undetermined) { format!("{all}, which the recordings do not determine") } else { all }
}

/// What is named, forces of the ship and errors of sensors each for themselves, the leading kind first.
fn named(findings: &[Finding]) -> String {
    let (sensors, others): (Vec<&Finding>, Vec<&Finding>) = findings.iter().partition(|f| f.kind == Kind::Sensor);
    let (actuators, forces): (Vec<&Finding>, Vec<&Finding>) =
        others.into_iter().partition(|f| f.kind == Kind::Actuator);
    let confirmed = |of: &[&Finding]| of.iter().any(|f| f.grade == Grade::Confirmed);
    let said = |lead: &str, of: &[&Finding]| {
        let doubt = if confirmed(of) { "" } else { ", suspected and not confirmed" };
        let all: Vec<String> = of.iter().map(|f| titled(f)).collect();
        format!("{lead}{doubt}: {}.", all.join("; and "))
    };
    let alone = forces.is_empty() && actuators.is_empty();
    let sensor = if alone { "A sensor, not the ship" } else { "A sensor error" };
    let mut parts = [(&forces, "Missing physics"), (&actuators, "An actuator or its record"), (&sensors, sensor)];
    // What is found first leads.
    parts.sort_by_key(|(of, _)| {
        findings.iter().position(|f| of.first().is_some_and(|first| first.mechanism == f.mechanism))
    });
    let sentences: Vec<String> =
        parts.iter().filter(|(of, _)| !of.is_empty()).map(|(of, lead)| said(lead, of)).collect();
    sentences.join(" ")
}

/// Unseen runs simulated by two models.
#[derive(Clone, Copy)]
pub struct Worse {
    /// Runs on which each diverges.
    pub diverged: [usize; 2],
    /// cVDM \[%\] of each, where there are runs on which neither diverges.
    pub cvdm: Option<[f64; 2]>,
}

impl From<&HeldOut> for Worse {
    fn from(proof: &HeldOut) -> Self {
        let cvdm = proof.before.zip(proof.after).map(|(before, after)| [before, after]);
        Self { diverged: proof.diverged(), cvdm }
    }
}

/// That all findings together predict unseen runs worse, where they do.
fn together(worse: Option<Worse>) -> String {
    worse.map_or(String::new(), |Worse { diverged: [without, with], cvdm }| {
        let cvdm = cvdm.map(|both| both.map(|cvdm| sig(cvdm, 3)));
        let than = match cvdm {
            _ if with > without => {
                format!(
                    "worse than the base model (the simulation diverges on {with} of them, without the findings on {without})"
                )
            }
            Some([before, after]) if before != after => {
                format!("worse than the base model (cVDM {before} % to {after} %)")
            }
            Some([before, _]) => format!("no better than the base model (cVDM {before} %)"),
            None => "worse than the base model".to_owned(),
        };
        format!(" Together they predict unseen runs {than}, so that none of them is in the improved model.")
    })
}

/// A finding that has rivals.
fn one_of(f: &Finding) -> String {
    if f.mechanism != PUSH {
        return format!(
            "{}, and these data do not decide which of: {}{}.",
            if f.kind == Kind::Sensor { "A sensor errs or something is missing" } else { "Something is missing" },
            f.confidence_set.join(", "),
            proof(f)
        );
    }
    let one = |w: &Window| format!("{} from {:.0} to {:.0} s", w.run, w.start, w.end);
    let windows: Vec<String> = f.windows.iter().map(one).collect();
    format!(
        "A force acts for a limited time: {} in {}; it is a push, or the ship's own forces in a state that no other recording visits.",
        values(&f.mechanism, &f.parameters),
        windows.join(" and ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{self, finding};

    #[test]
    fn every_verdict_has_a_sentence_with_the_values_it_names() {
        let current = || finding("current", "steady current", &["current"]);
        let following =
            Following { runs: 4, better_than_steady: 1, cvdm: Some(40.0), steady: Some(21.0), rank_share: 0.2 };
        let said = |verdict, findings: &[Finding], withdrawn: &[Finding], missing: Option<&Missing>| {
            headline(
                verdict,
                &Said {
                    findings,
                    withdrawn,
                    following: &following,
                    holds: verdict != Verdict::Insufficient,
                    form_holds: true,
                    missing,
                    worse: None,
                    hull: &[],
                    windows: &[],
                    differing: &[],
                    causes: &[],
                    recordings: 9,
                },
            )
        };
        let headline = |verdict, findings: &[Finding], missing: Option<&Missing>| said(verdict, findings, &[], missing);
        let named = headline(Verdict::Named, &[current()], None);
        assert!(named.contains("steady current") && named.contains("0.123 m/s"), "{named}");
        let each = Finding { by_session: true, sessions: vec!["a".into(), "b".into()], ..current() };
        assert!(headline(Verdict::Named, &[each], None).contains("2 sessions"));
        let set = finding("current", "steady current", &["current", "mean_wind"]);
        assert!(headline(Verdict::OneOf, &[set], None).contains("current, mean_wind"));
        let clocks = || Finding { kind: Kind::Sensor, ..finding("time_skew", "differing clocks", &["time_skew"]) };
        let sensor = headline(Verdict::Sensor, &[clocks()], None);
        assert!(
            sensor.starts_with("A sensor, not the ship, suspected and not confirmed: differing clocks"),
            "{sensor}"
        );
        let confirmed = Finding { grade: Grade::Confirmed, ..current() };
        let both = headline(Verdict::Named, &[confirmed, clocks()], None);
        assert!(both.starts_with("Missing physics: steady current"), "{both}");
        assert!(both.contains(". A sensor error, suspected and not confirmed: differing clocks"), "{both}");
        let both = headline(Verdict::Sensor, &[clocks(), current()], None);
        assert!(
            both.starts_with("A sensor error, suspected") && both.contains(". Missing physics, suspected"),
            "{both}"
        );
        let worse = |diverged, cvdm| together(Some(Worse { diverged, cvdm }));
        assert!(worse([0; 2], Some([76.5, 89.4])).contains("worse than the base model (cVDM 76.5 % to 89.4 %)"));
        assert!(worse([0; 2], Some([3.301, 3.302])).contains("no better than the base model (cVDM 3.30 %)"));
        assert!(worse([1, 16], None).contains("diverges on 16 of them, without the findings on 1)"));
        assert_eq!(together(None), "");
        let with = |grade| Finding { grade, change: Some(0.02), ..current() };
        let refuted = said(Verdict::NotInCatalogue, &[], &[with(Grade::Refuted)], None);
        assert!(refuted.contains("steady current") && refuted.contains("refute"), "{refuted}");
        assert!(said(Verdict::NotInCatalogue, &[], &[], None).contains("it is no law of the catalogue"));
        let small = said(Verdict::NothingMissing, &[], &[with(Grade::Immaterial)], None);
        assert!(small.contains("steady current") && small.contains("2.0 % of their error"), "{small}");
        let times = vec![Amplitude::new("time_skew.position".into(), 0.2, "s", 0.01)];
        let clock = Finding { kind: Kind::Sensor, parameters: times, ..with(Grade::Immaterial) };
        let clock = said(Verdict::NothingMissing, &[], &[clock], None);
        assert!(clock.contains("less than half a sample period") && !clock.contains("of their error"), "{clock}");
        let bound = said(Verdict::NothingMissing, &[], &[with(Grade::NotIsolated)], None);
        assert!(bound.contains("opposite headings"), "{bound}");
        let lost = headline(Verdict::Insufficient, &[], None);
        assert!(lost.contains("1 of 4 runs") && lost.contains("40.0 %"), "{lost}");
        let confirmed = headline(Verdict::Named, &[with(Grade::Confirmed)], None);
        assert!(named.contains("suspected") && !confirmed.contains("suspected"), "{named} {confirmed}");
        assert_eq!(of_another_form(true), "");
        assert!(of_another_form(false).contains("less than 2.0 % of the force that turns it"));
        let hull =
            |used: f64| [Budget { name: "hull.Yrdot".into(), prior: -1.0, sd: 2.0, value: -1.0 + 2.0 * used, used }];
        assert_eq!(bent(&hull(7.9)), "");
        assert!(
            bent(&hull(-12.0)).contains("hull.Yrdot = -25.0, where -1.00 +- 2.0 is usual"),
            "{}",
            bent(&hull(-12.0))
        );
        for verdict in [Verdict::Numerics, Verdict::Random, Verdict::Insufficient, Verdict::NothingMissing] {
            assert!(headline(verdict, &[], None).ends_with('.'), "{verdict:?}");
        }
    }

    #[test]
    fn a_recording_that_differs_from_all_others_is_named_where_nothing_is_missing() {
        let window = |run: &str, start: f64, p: f64| Window {
            run: run.into(),
            session: String::new(),
            start,
            end: start + 10.0,
            force: [0.0; 3],
            error: [1.0; 3],
            statistic: 90.0,
            p,
            index: 0,
            samples: (0, 1),
        };
        let one = [window("turn 6", 63.0, 1e-14), window("turn 6", 313.0, 1e-9), window("turn 7", 5.0, 1e-3)];
        assert_eq!(differing(&one, 24), ["turn 6"]);
        // Of two recordings either may differ from the other, and what many recordings have is no matter of a few.
        assert!(differing(&one, 2).is_empty());
        let many: Vec<Window> = ["a", "b", "c"].iter().map(|run| window(run, 0.0, 1e-14)).collect();
        assert_eq!((differing(&many, 24).len(), differing(&many[..2], 24).len()), (0, 2));
        let following = Following { runs: 24, better_than_steady: 24, cvdm: None, steady: None, rank_share: 0.2 };
        let said = Said {
            findings: &[],
            withdrawn: &[],
            following: &following,
            holds: true,
            form_holds: true,
            missing: None,
            worse: None,
            hull: &[],
            windows: &one,
            differing: &differing(&one, 24),
            causes: &[],
            recordings: 24,
        };
        for verdict in [Verdict::NothingMissing, Verdict::Random] {
            let said = headline(verdict, &said);
            assert!(said.contains("`turn 6` (between 63.0 and 323 s) differs") && said.contains("other 23"), "{said}");
            assert!(said.contains("Nothing of the catalogue explains `turn 6`"), "{said}");
        }
        let explained = |alike| {
            let parameters = vec![Amplitude::new("rate_gain.gain".into(), 0.07, "-", 0.01)];
            let (mechanism, title) = ("rate_gain", "gain of the recorded propeller rate");
            let causes = [Cause { recording: "turn 6".into(), mechanism, title, gain: 90.0, parameters, alike }];
            headline(Verdict::NothingMissing, &Said { causes: &causes, ..said })
        };
        let (one, two) = (explained(Vec::new()), explained(vec!["loss of thrust"]));
        let own = "In `turn 6` alone, gain of the recorded propeller rate (rate_gain.gain = 0.0700";
        assert!(one.contains(own) && one.contains("explains it best. Look at that log"), "{one}");
        assert!(two.contains("explains it best, and loss of thrust as well."), "{two}");
    }

    #[test]
    fn a_law_is_reported_with_its_grade_and_a_refuted_one_without_its_equation() {
        let of = |grade| Law {
            grade,
            equation: vec!["N [N m] = 3.00e5".into(), "Y [N] = 12 v|v|".into()],
            terms: Vec::new(),
            range: Vec::new(),
            held_out: None,
            estimate: example::at(&example::model()),
        };
        let said = |grade| Missing::Law(Some(&of(grade))).headline();
        let (confirmed, candidate) = (said(LawGrade::Confirmed), said(LawGrade::Exploratory));
        assert!(confirmed.contains("confirmed on unseen runs: N [N m] = 3.00e5; Y [N] = 12 v|v|."), "{confirmed}");
        assert!(candidate.contains("exploratory and not confirmed") && candidate.contains("= 3.00e5"), "{candidate}");
        let refuted = said(LawGrade::Refuted);
        assert!(refuted.ends_with("refuted by unseen runs.") && !refuted.contains('='), "{refuted}");
        assert!(Missing::Law(None).headline().ends_with("no law of few terms is significant."));
    }

    #[test]
    fn the_next_trial_is_that_of_the_rival_or_of_the_named_mechanism() {
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
