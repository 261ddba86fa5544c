//! The diagnosis on recordings whose truth is known here and hidden from it.

#![allow(clippy::unwrap_used)]

mod support;

use support::{model, runs, truth_noise};
use trimtab::diagnose::{Diagnosis, Settings, Verdict, diagnose};

/// Thirty runs to learn from and ten to prove on, of a ship that has what the base model lacks.
fn case(set: &[(&str, f64)], sessions: &[&str], seed: u64) -> Diagnosis {
    let base = model();
    let mut truth = base.clone();
    for (name, value) in set {
        truth.add_term(name.split('.').next().unwrap()).unwrap();
        let i = truth.find(name).unwrap();
        if sessions.is_empty() {
            truth.parameters[i].value = *value;
        }
        for s in sessions {
            truth.sessions.entry((*s).to_string()).or_default().push((i, *value));
        }
    }
    let data = runs(&truth, &truth_noise(), 40, seed);
    diagnose(&base, &data[..30], &data[30..], &Settings::default(), &|_| ()).unwrap()
}

fn value(d: &Diagnosis, name: &str) -> f64 {
    d.findings.iter().flat_map(|f| &f.parameters).find(|p| p.name == name).map_or(f64::NAN, |p| p.value)
}

#[test]
fn nothing_is_found_where_nothing_is_missing() {
    let d = case(&[], &[], 101);
    assert_eq!(d.verdict, Verdict::NothingMissing, "{}", d.headline);
    assert!(d.detectable.iter().any(|m| m.mechanism == "current" && m.size > 0.0 && m.size < 0.1));
}

#[test]
fn a_current_is_named_with_its_set_and_improves_unseen_runs() {
    let d = case(&[("current.north", 0.1)], &[], 3);
    assert_eq!(d.verdict, Verdict::Named, "{}", d.headline);
    assert_eq!(d.findings[0].mechanism, "current");
    assert!((value(&d, "current.north") - 0.1).abs() < 0.02 && value(&d, "current.east").abs() < 0.02);
    let proof = d.held_out.unwrap();
    assert!(proof.after < proof.before && proof.log_likelihood_gain > 20.0, "{proof:?}");
    assert!(d.model.term_names().contains(&"current"));
}

#[test]
fn a_biased_compass_is_a_sensor_and_not_the_ship() {
    let d = case(&[("heading_bias.bias", 0.0175)], &[], 3);
    assert_eq!(d.verdict, Verdict::Sensor, "{}", d.headline);
    assert!((value(&d, "heading_bias.bias") - 0.0175).abs() < 0.003);
}

#[test]
fn a_rudder_offset_in_every_session_cannot_be_seen() {
    let d = case(&[("rudder_offset.offset", 0.03)], &[], 9);
    assert_eq!(d.verdict, Verdict::NothingMissing, "{}", d.headline);
    // Neither is a mechanism that hides behind the model's own parameters ever claimed.
    assert!(d.findings.is_empty());
}

#[test]
fn one_thread_and_two_give_the_same_bits() {
    let of = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| case(&[("log_scale.error", 0.03)], &[], 5))
    };
    let (one, two) = (of(1), of(2));
    assert_eq!(one.findings[0].mechanism, "log_scale");
    let bits = |d: &Diagnosis| d.model.values().iter().map(|v| v.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&one), bits(&two));
}
