//! The baselines of the diagnosis where the truth is known: refit of trajectories, information criterion on them, and oracle.
//! The campaign compares them with the diagnosis; no test here does.

use crate::support::{model, runs, truth_noise};
use trimtab::diagnose::Settings;
use trimtab::diagnose::evidence::candidate::Extent;
use trimtab::diagnose::proof::baseline::{GivenMechanism, Refitted, oracle};
use trimtab::diagnose::proof::prove::mean_cvdm;
use trimtab::likelihood::noise::Noise;
use trimtab::model::Model;
use trimtab::recording::Run;

/// The base model with a current.
fn drifting() -> Model {
    let mut truth = model();
    truth.add_term("current").unwrap();
    let i = truth.find("current.north").unwrap();
    truth.parameters[i].value = 0.15;
    truth
}

/// White sensor noise and no gusts, as least squares on trajectories assumes.
fn calm() -> Noise {
    let mut noise = truth_noise();
    noise.force = [0.0; 3];
    noise.sensors.iter_mut().for_each(|s| s.coloured = 0.0);
    noise
}

/// The model with every free parameter off by a tenth.
fn off(mut model: Model) -> Model {
    for i in model.free() {
        model.parameters[i].value *= 1.1;
    }
    model
}

fn refitted(model: &Model, runs: &[Run]) -> Refitted {
    Refitted::new(model, runs, &Settings::default()).unwrap().unwrap()
}

#[test]
fn refits_from_two_starts_end_at_one_optimum() {
    let data = runs(&model(), &calm(), 16, 11);
    let (train, held_out) = data.split_at(12);
    let (near, far) = (refitted(&model(), train), refitted(&off(model()), train));
    let misfit = |fit: &Refitted| fit.used as f64 / 6.0 * fit.variance.iter().map(|v| v.ln()).sum::<f64>();
    assert!((misfit(&far) - misfit(&near)).abs() < 1.0, "{} {}", misfit(&far), misfit(&near));
    let judging = Settings::default().judging;
    let of = |model: &Model| mean_cvdm(model, held_out, &judging).unwrap();
    let (truth, before, refit) = (of(&model()), of(&off(model())), far.held_out(held_out, &judging));
    assert!(refit < truth + 0.2 * (before - truth), "{refit} {truth} {before}");
}

#[test]
fn the_criterion_names_an_effect_in_a_calm_and_nothing_without_one() {
    let best = |truth: &Model| {
        let data = runs(truth, &calm(), 12, 5);
        refitted(&model(), &data).ranking(&data, &[]).remove(0)
    };
    let found = best(&drifting());
    assert_eq!((found.mechanism.as_str(), found.degrees, found.gain > 100.0), ("current", 2, true), "{found:?}");
    assert!(best(&model()).gain < 0.1 * found.gain);
}

#[test]
fn the_criterion_mistakes_gusts_for_physics() {
    let data = runs(&model(), &truth_noise(), 12, 5);
    let ranking = refitted(&model(), &data).ranking(&data, &[]);
    assert!(ranking[0].gain > 0.0, "residuals that are not independent are counted as if they were: {:?}", ranking[0]);
    assert!(ranking.windows(2).all(|w| w[0].gain >= w[1].gain));
    let without = refitted(&model(), &data).ranking(&data, &[ranking[0].mechanism.clone()]);
    assert_eq!(without[0], ranking[1]);
}

#[test]
fn the_oracle_improves_unseen_runs_and_gives_none_for_a_mechanism_outside_the_catalogue() {
    let data = runs(&drifting(), &truth_noise(), 16, 7);
    let of = |name: &str, extent: Extent| {
        let told = GivenMechanism { mechanism: name.into(), extent };
        oracle(&model(), &data[..12], &data[12..], &Settings::default(), &[told]).unwrap()
    };
    let everywhere = of("current", Extent::All).unwrap();
    let untold = refitted(&model(), &data[..12]).held_out(&data[12..], &Settings::default().judging);
    assert!(everywhere < 0.8 * untold, "{everywhere} {untold}");
    // A mechanism that acts only in sessions without held-out runs cannot improve them.
    let elsewhere = of("current", Extent::In(vec!["s0".into(), "s1".into(), "s2".into()])).unwrap();
    assert!(everywhere < 0.8 * elsewhere, "{everywhere} {elsewhere}");
    assert!(of("kraken", Extent::All).is_none());
}
