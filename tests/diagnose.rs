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
    let which: u64 = std::env::var("CASE").ok().and_then(|c| c.parse().ok()).unwrap_or(0);
    let size: f64 = std::env::var("SIZE").ok().and_then(|c| c.parse().ok()).unwrap_or(1.0);
    let seed: u64 = std::env::var("SEED").ok().and_then(|c| c.parse().ok()).unwrap_or(1);
    match which {
        0 => run_case(&[], &[], seed),
        1 => run_case(&[("current.north", 0.1 * size)], &[], seed),
        2 => run_case(&[("mean_wind.north", 6.0 * size), ("mean_wind.east", -5.0 * size)], &[], seed),
        3 => run_case(&[("heading_bias.bias", 0.0175 * size)], &[], seed),
        4 => run_case(&[("rudder_lag.time", 2.0 * size)], &[], seed),
        5 => run_case(&[("propeller_walk.astern", -0.04 * size)], &[], seed),
        6 => run_case(&[("shallow.ratio", 0.5 * size)], &["s2", "s3"], seed),
        7 => run_case(&[("current.east", 0.1 * size), ("heading_bias.bias", 0.01 * size)], &[], seed),
        8 => run_case(&[("antenna.x", 5.0 * size)], &[], seed),
        9 => run_case(&[("rudder_offset.offset", 0.03 * size)], &[], seed),
        10 => run_case(&[("log_scale.error", 0.03 * size)], &[], seed),
        11 => run_case(&[("time_skew.position", 1.0 * size)], &[], seed),
        12 => run_case(&[("crossflow.drag", 0.5 * size)], &[], seed),
        _ => run_case(&[("engine_lag.time", 8.0 * size)], &[], seed),
    };
}
