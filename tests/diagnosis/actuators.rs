//! Faults of named actuators, unknown to the diagnosis, in simulated recordings of a catamaran.
//! What real craft show is no part of it.

use crate::support::{catamaran, catamaran_runs};
use trimtab::diagnose::{Diagnosis, Settings, Verdict, diagnose};
use trimtab::model::Model;
use trimtab::physics::Kind;

/// A diagnosis of recordings whose truth has some faults, in one session or in all, after what was done to the recorded orders.
fn case(faults: &[(&str, f64)], session: Option<&str>, spoil: fn([f64; 2]) -> [f64; 2]) -> Diagnosis {
    let base = catamaran();
    let mut truth = sound();
    for (name, value) in faults {
        let i = truth.find(name).unwrap();
        match session {
            None => truth.parameters[i].value = *value,
            Some(session) => truth.sessions.entry(session.into()).or_default().push((i, *value)),
        }
    }
    let mut data = catamaran_runs(&truth, 20, 5);
    for inputs in data.iter_mut().flat_map(|run| &mut run.inputs) {
        [inputs.commands[0], inputs.commands[1]] = spoil([inputs.commands[0], inputs.commands[1]]);
    }
    diagnose(&base, &data[..16], &data[16..], &Settings::default(), &|_| ()).unwrap()
}

/// The craft as it is: its thrusters differ a little from each other and from what was assumed.
fn sound() -> Model {
    let mut truth = catamaran();
    truth.set(&[("left.gain", 0.0062), ("right.gain", 0.0058), ("general_hull.surge_square", 1.7)]).unwrap();
    truth
}

/// That one fault of an actuator is named alone, with its size within a tolerance and the sessions in which it acts.
fn assert_named(d: &Diagnosis, fault: &str, size: f64, tolerance: f64, sessions: &[&str]) {
    let names: Vec<&str> = d.findings.iter().map(|f| f.mechanism.as_str()).collect();
    assert_eq!((d.verdict, names), (Verdict::Named, vec![fault]), "{}", d.headline);
    let found = &d.findings[0];
    assert_eq!(
        (found.kind, found.sessions.as_slice()),
        (Kind::Actuator, &sessions.iter().map(ToString::to_string).collect::<Vec<_>>()[..])
    );
    let (name, _) = fault.split_once('.').unwrap();
    assert!(found.title.contains(name) && d.headline.contains(&found.title[1..]), "{}", d.headline);
    assert!((found.parameters[0].value - size).abs() < tolerance, "{:?}", found.parameters);
}

#[test]
fn a_sound_catamaran_lacks_nothing() {
    let d = case(&[], None, |orders| orders);
    assert!(d.findings.is_empty() && d.verdict == Verdict::NothingMissing, "{}", d.headline);
}

#[test]
fn recordings_of_two_thrusters_that_were_exchanged_are_reported_by_the_names_of_both() {
    let d = case(&[], None, |[left, right]| [right, left]);
    assert_named(&d, "left.swap", 1.0, 0.05, &[]);
    assert!(d.headline.contains("left") && d.headline.contains("right"), "{}", d.headline);
}

#[test]
fn a_thruster_that_is_dead_in_one_session_is_named_with_it() {
    assert_named(&case(&[("right.lost", 1.0)], Some("s1"), |orders| orders), "right.lost", 1.0, 0.1, &["s1"]);
}

#[test]
fn a_thruster_that_is_late_is_named() {
    assert_named(&case(&[("left.lag", 0.8)], None, |orders| orders), "left.lag", 0.8, 0.15, &[]);
}

#[test]
fn a_thruster_that_points_aside_is_named() {
    assert_named(&case(&[("right.zero", 0.2)], None, |orders| orders), "right.zero", 0.2, 0.04, &[]);
}
