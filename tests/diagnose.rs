//! The diagnosis on recordings whose truth is known here and hidden from it.

#![allow(clippy::unwrap_used)]

mod support;

use support::{model, runs, truth_noise};
use trimtab::diagnose::{Diagnosis, Settings, diagnose};

fn run_case(set: &[(&str, f64)], sessions: &[&str], seed: u64) -> Diagnosis {
    let base = model();
    let mut truth = base.clone();
    for (name, value) in set {
        truth.add_term(name.split('.').next().unwrap()).unwrap();
        let i = truth.find(name).unwrap();
        if sessions.is_empty() {
            truth.parameters[i].value = *value;
        } else {
            for s in sessions {
                truth.sessions.entry(s.to_string()).or_default().push((i, *value));
            }
        }
    }
    let noise = truth_noise();
    let data = runs(&truth, &noise, 40, seed);
    let clock = std::time::Instant::now();
    let d =
        diagnose(&base, &data[..30], &data[30..], &Settings::default(), &|w| println!("{:.2?} {w}", clock.elapsed()))
            .unwrap();
    println!("--- {set:?} {sessions:?}: {:?} in {:.2?}: {}", d.verdict, clock.elapsed(), d.headline);
    for r in d.ranking.iter().take(9) {
        println!(
            "    {} LM {:.1}/{} p {:.1e} size {:.2} adm {} kept {:.3} second {:.1e} {:?}",
            r.mechanism, r.statistic, r.degrees, r.p, r.size, r.admissible, r.retained, r.second_opinion, r.sessions
        );
    }
    for f in &d.findings {
        println!("    finding {} set {:?} why {}", f.mechanism, f.confidence_set, f.why);
    }
    if let Some(h) = &d.held_out {
        println!(
            "    held-out {:.2} -> {:.2} (generic {:?}) better {}/{}",
            h.before, h.after, h.generic, h.better, h.runs
        );
    }
    println!(
        "    adequacy {:?} -> {:?}; euler {:.1} windows {}",
        d.adequacy_before,
        d.adequacy_after,
        d.admission.euler_gain,
        d.location.windows.len()
    );
    d
}

#[test]
fn explore() {
    run_case(&[("antenna.x", 5.0)], &[], 8);
    run_case(&[("current.north", 0.1)], &[], 1);
}
