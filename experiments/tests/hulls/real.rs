//! The two real hulls: predictions of trials and windows that no fit has used, against measured ones.
//! The recordings are not part of the project; without them these tests are skipped with a message.

use std::path::Path;
use trimtab::diagnose::Grade;
use trimtab::fit::MultiStart;
use trimtab::recording::Split;
use trimtab_experiments::real::agreement::Agreement;
use trimtab_experiments::real::error::{RealError, is_absent};
use trimtab_experiments::real::hull::Hull;
use trimtab_experiments::real::hulls::craft;
use trimtab_experiments::real::hulls::esso_osaka::{self, BASELINES};
use trimtab_experiments::real::hulls::kvlcc2;
use trimtab_experiments::real::hulls::kvlcc2_diagnosed::{self, ONE_SIDED, PUT_BACK};
use trimtab_experiments::real::hulls::kvlcc2_hsva::{self, STARTS};
use trimtab_experiments::real::hulls::published::PublishedMmg;

/// The value, or none after saying that the recordings are absent.
fn present<T>(result: Result<T, RealError>) -> Option<T> {
    match result {
        Ok(value) => Some(value),
        Err(error) if is_absent(&error) => {
            drop(std::io::Write::write_fmt(&mut std::io::stderr(), format_args!("skipped: {error}\n")));
            None
        }
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn val_kvlcc2_marin_zigzags_predict_its_turning_circles() {
    let Some(outcome) = present(kvlcc2::run()) else { return };
    assert!(outcome.fits.iter().all(|f| f.converged));
    let [empirical, freed] = [0, 2];
    for side in ["starboard", "port"] {
        for (what, within) in [("advance", 0.04), ("transfer", 0.07), ("tactical diameter", 0.07)] {
            let measure = outcome.measure(&format!("35 deg to {side}: {what} [L]")).unwrap();
            let error = measure.error(freed).unwrap().abs();
            assert!(error < within, "{}: {error:.3}", measure.what);
            assert!(error < 0.5 * measure.error(empirical).unwrap().abs(), "{}: {error:.3}", measure.what);
        }
    }
    // The screw turns one way only: the starboard circle is the wider one.
    let diameter = |side: &str| outcome.measure(&format!("35 deg to {side}: tactical diameter [L]")).unwrap();
    let (starboard, port) = (diameter("starboard"), diameter("port"));
    assert!(starboard.measured > port.measured);
    assert!(starboard.predicted[freed].unwrap() > port.predicted[freed].unwrap());
}

#[test]
fn val_craft_with_actuators_of_their_own_are_predicted_on_recordings_that_the_fit_has_not_seen() {
    for (study, most) in craft::STUDIES.into_iter().zip([0.5, 0.4]) {
        let Some(judged) = present(craft::run(study)) else { return };
        let [steady, fitted] = judged.cvdm(Split::Test).unwrap();
        assert!(judged.fit.converged && fitted < most * steady, "{}: {fitted:.1} %, {steady:.1} %", study.1);
    }
}

#[test]
fn val_kvlcc2_hsva_a_freed_hull_predicts_zigzags_that_it_has_not_seen() {
    let Some(predicted) = present(kvlcc2_hsva::run()) else { return };
    let [empirical, freed] = [0, 2];
    assert!(predicted.trials.fits.iter().all(|f| f.converged && f.cost < f.start_cost));
    assert!(predicted.test_cvdm(freed) <= 5.0, "{:.2} %", predicted.test_cvdm(freed));
    // Two overshoots of each of the four zigzags, as close to the measured ones as those of repeated tests are to each other.
    assert_eq!(predicted.trials.measures.len(), 8);
    for m in &predicted.trials.measures {
        assert!(!m.seen);
        let error = |model: usize| (m.predicted[model].unwrap() - m.measured).abs();
        assert!(error(freed) < 2.0, "{}: {:.1} deg", m.what, error(freed));
        assert!(error(freed) < 0.5 * error(empirical), "{}: {:.1} deg", m.what, error(freed));
    }
    // The first line says that the cost is not noise.
    assert!(predicted.trials.fits[1].headline.contains("IN DOUBT"));
}

#[test]
fn the_freed_hull_of_kvlcc2_has_one_optimum() {
    let starts = MultiStart { count: 2, ..STARTS };
    let Some(repeats) = present(kvlcc2_hsva::repeat(&[Some(60.0), None], starts, |_| {})) else { return };
    assert_eq!(repeats.len(), 6);
    for r in &repeats {
        let name = format!("limit {:?}, start {:?}", r.limit, r.start);
        assert!(r.outcome.as_ref().is_ok_and(|fit| fit.converged), "{name}");
        assert!((r.total() / repeats[0].total() - 1.0).abs() < 1e-3, "{name}: {}", r.total());
        assert!(r.cvdm <= 5.0, "{name}: {:.2} %", r.cvdm);
    }
}

#[test]
fn esso_osaka_fitted_to_a_few_windows_beats_both_baselines_on_unseen_runs() {
    // Every fourth training window and the fourteen parameters: the full set is the experiment's.
    let Some(judged) = present(esso_osaka::run(&["wind.toml"], 4)) else { return };
    assert!(judged.fits[0].converged);
    for baseline in 0..BASELINES {
        let gain = judged.against(baseline, BASELINES, None).cvdm_improvement.unwrap().value;
        assert!(gain > 0.1, "{}: {gain:.3}", judged.candidates[baseline].name);
    }
}

#[test]
fn published_simulator_reaches_the_recorded_speeds_and_turns_the_right_way() {
    let Some(hull) = present(Hull::open("esso_osaka")) else { return };
    let published = PublishedMmg::read(hull.study.runs[0].file.ancestors().nth(2).unwrap()).unwrap();
    let mut window = hull.windows(Split::Test).unwrap().remove(0);
    window.initial = [0.0, 0.0, 0.0, 0.05, 0.0, 0.0];
    // Straight ahead at the rate of the faster turns, for as long as it takes.
    let first = window.inputs[0];
    window.inputs = vec![trimtab::ship::state::Inputs { n: 10.0, delta: 0.0, ..first }; 600];
    let straight = published.simulate(&window);
    let [_, _, psi, u, v, _] = *straight.states.last().unwrap();
    assert!(straight.diverged_at.is_none() && (0.3..0.5).contains(&u), "{u}");
    assert!(psi.abs() < 1e-9 && v.abs() < 1e-9, "no force to one side");
    for side in [1.0, -1.0] {
        window.inputs.iter_mut().for_each(|i| i.delta = 0.3 * side);
        let turned = published.simulate(&window);
        let [_, _, _, u, v, r] = *turned.states.last().unwrap();
        assert!(r * side > 0.01 && v * side < 0.0 && u > 0.0, "{u} {v} {r}");
    }
}

#[test]
fn no_weather_is_named_in_a_calm_basin_and_a_late_gyro_is_found() {
    let Some((case, kinematics)) = present(kvlcc2_diagnosed::as_recorded()) else { return };
    let (findings, withdrawn) = (&case.diagnosis.findings, &case.diagnosis.withdrawn);
    for f in findings.iter().chain(withdrawn) {
        assert!(!kvlcc2_diagnosed::NOT_IN_A_BASIN.contains(&f.mechanism.as_str()), "{}", f.mechanism);
    }
    // The heading leads the yaw rate in every recording, the turning circles among them, which were not diagnosed.
    // By two samples of the recordings, of which the analysis takes every fifteenth.
    let clocks = findings.iter().find(|f| f.mechanism == "time_skew").unwrap();
    assert_eq!(clocks.grade, Grade::Suspected);
    let lead = clocks.parameters.iter().find(|p| p.name == "time_skew.heading").unwrap();
    assert_eq!(kinematics.len(), 6);
    for a in &kinematics {
        assert!((-lead.value - a.rate_delay).abs() < 0.1, "{}: {:.3} and {:.3} s", a.run, -lead.value, a.rate_delay);
    }
}

#[test]
fn the_sides_of_a_ship_with_one_screw_differ_and_a_sensor_error_left_out_is_named() {
    let Some(hull) = present(Hull::open("kvlcc2")) else { return };
    let best = kvlcc2_diagnosed::freed(&hull).unwrap();
    let cases = kvlcc2_diagnosed::left_out(&hull, &best).unwrap();
    let sides = cases[0].diagnosis.sides.as_ref().unwrap();
    assert!(sides.p < 1e-6, "{sides:?}");
    // A difference of the ship, not of the gyro, which has a bias.
    assert!(sides.parameters.iter().all(|p| ONE_SIDED.contains(&p.name.as_str())), "{sides:?}");
    let propeller = sides.parameters.iter().find(|p| p.name == "propeller.side_force").unwrap();
    assert!(propeller.value > 2.0 * propeller.error, "{propeller:?}");
    // With the difference removed from the model it is reported again, and no weather is named for it.
    let alike =
        kvlcc2_diagnosed::sides_made_alike(&hull, &best, &Agreement::of_study(&hull, kvlcc2_diagnosed::SPAN).unwrap())
            .unwrap();
    let again = alike.diagnosis.sides.unwrap();
    // 1e-4 is what the diagnosis itself asks for before it says that the sides differ.
    // A model whose sides are alike is wrong, and what is suspected of it may be: not weather, and nothing that unseen runs confirm.
    for f in &alike.diagnosis.findings {
        let is_weather = kvlcc2_diagnosed::NOT_IN_A_BASIN.contains(&f.mechanism.as_str());
        assert!(!is_weather && f.grade == Grade::Suspected, "{f:?}");
    }
    assert!(again.p < 1e-4, "{again:?}");
    for p in &again.parameters {
        let before = sides.parameters.iter().find(|q| q.name == p.name).unwrap();
        assert!((p.value - before.value).abs() < before.ci95[1] - before.value, "{p:?} {before:?}");
    }
    for (case, term) in cases[1..].iter().zip(PUT_BACK) {
        let found = case.diagnosis.findings.iter().chain(&case.diagnosis.withdrawn);
        let found: Vec<&str> = found.map(|f| f.mechanism.as_str()).collect();
        assert_eq!(found.iter().filter(|f| **f == term).count(), 1, "{}", case.diagnosis.headline);
        assert!(found.iter().all(|f| PUT_BACK.contains(f)), "{found:?}");
    }
}

#[test]
fn velocities_of_esso_osaka_lag_its_positions_by_one_delay_in_every_recording() {
    let Some(hull) = present(Hull::open("esso_osaka")) else { return };
    let agreements = Agreement::of_study(&hull, 20.0).unwrap();
    assert_eq!(agreements.len(), hull.study.runs.len());
    for a in &agreements {
        assert!((0.9..1.0).contains(&a.velocity_delay), "{}: {:.3} s", a.run, a.velocity_delay);
    }
}

#[test]
fn missing_parameters_are_named_with_their_file() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("principal_particulars.csv"), "parameter,value\nlpp, 3.0\n").unwrap();
    std::fs::write(folder.path().join("MMG_params.csv"), "parameter,params_init\n").unwrap();
    let error = PublishedMmg::read(folder.path()).unwrap_err().to_string();
    assert!(error.contains("principal_particulars.csv") && error.contains("`draft`"), "{error}");
    let error = PublishedMmg::read(Path::new("no/such/folder")).unwrap_err().to_string();
    assert!(error.contains("cannot read the published parameters"), "{error}");
}
