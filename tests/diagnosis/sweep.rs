//! Laws of a sweep: profiles of a fit to the model's own simulations are near their standard errors, and a pair contains its profiles.
//! `trimtab sweep` and `trimtab compare` are run end to end on the study of the demo.

use crate::support;
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};
use trimtab::evaluate::maneuver::ManeuverSettings;
use trimtab::evaluate::sweep::{SweepSettings, pair, profile, sensitivities};
use trimtab::fit::{FitSettings, fit};

#[test]
fn a_profile_is_the_standard_error_of_what_the_data_determine_and_a_pair_contains_its_profiles() {
    let mut model = support::model();
    let runs = &support::runs(&model, &support::truth_noise(), 12, 1);
    let wanted = ["resistance.quadratic", "propeller.side_force"];
    model.parameters.iter_mut().for_each(|p| p.free = wanted.contains(&p.name.as_str()));
    let found = fit(&model, runs, &FitSettings::default(), &mut |_| true).unwrap();
    let settings = SweepSettings { points: 2, span: 3.0 };
    let profiles = wanted.map(|name| profile(&found, runs, name, &settings).unwrap());
    for p in &profiles {
        assert_eq!((p.points.len(), p.better_elsewhere), (5, false), "{p:?}");
        let falls: Vec<f64> = p.points.iter().map(|q| q.fall.unwrap()).collect();
        // The least is at the estimate, and the fall grows outwards.
        assert!(falls[0] > falls[1] && falls[1] > falls[2] && falls[2] == 0.0 && falls[3] > 0.0 && falls[4] > falls[3]);
    }
    let both = pair(&found, runs, wanted, &settings).unwrap();
    assert!(both.fall[2].iter().all(Option::is_some), "{:?}", both.fall);
    for (i, row) in both.fall.iter().enumerate() {
        // The profile of the first is the least over the second, where the constraints allow both.
        let least = row.iter().flatten().copied().fold(f64::INFINITY, f64::min);
        assert!(least >= profiles[0].points[i].fall.unwrap() - 0.02, "{i}: {least} {:?}", profiles[0].points[i]);
    }
    let moved = sensitivities(&found, runs, &ManeuverSettings { speed: Some(6.0), ..ManeuverSettings::default() });
    assert_eq!(moved.len(), 2);
    assert!(moved.iter().all(|m| m.position.unwrap() > 0.0 && m.trials.len() >= 4));
    assert!(moved[0].position >= moved[1].position);
    // A fixed parameter has no profile.
    assert!(profile(&found, runs, "rudder.lift3", &settings).is_none());
}

fn trimtab(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_trimtab")).args(arguments).current_dir(folder).output().unwrap()
}

fn json(folder: &Path, arguments: &[&str]) -> Value {
    let output = trimtab(folder, arguments);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn the_commands_say_which_parameters_are_determined_and_which_model_predicts_better() {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in trimtab::study::demo::files() {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    let fitted = trimtab(folder.path(), &["fit", "study.toml", "--out", "fit"]);
    assert_eq!(fitted.status.code(), Some(0), "{}", String::from_utf8_lossy(&fitted.stderr));
    let arguments =
        ["sweep", "study.toml", "--parameter", "propeller.side_force", "--points", "2", "--out", "swept", "--json"];
    let swept = json(folder.path(), &arguments);
    let profile = &swept["result"]["profiles"][0];
    assert_eq!(
        (profile["parameter"].as_str(), profile["points"].as_array().unwrap().len()),
        (Some("propeller.side_force"), 5)
    );
    for file in ["sweep.json", "profiles.csv", "intervals.csv", "sensitivities.csv", "profile_curves.png"] {
        assert!(folder.path().join("swept").join(file).is_file(), "{file}");
    }
    let wrong = trimtab(folder.path(), &["sweep", "study.toml", "--parameter", "rudder.lfit2"]);
    let message = String::from_utf8(wrong.stderr).unwrap();
    assert!(wrong.status.code() == Some(2) && message.contains("rudder.lift2"), "{message}");

    let compared = json(folder.path(), &["compare", "study.toml", "baseline.toml", "fit/fitted.toml", "--json"]);
    let second = &compared["result"]["models"][1];
    assert!(second["difference"]["ci95"][1].as_f64().unwrap() < 0.0, "{second:#}");
    // The same number as that of an evaluation.
    let evaluated = json(folder.path(), &["evaluate", "study.toml", "--model", "fit/fitted.toml", "--json"]);
    assert_eq!(second["cvdm"]["value"], evaluated["result"]["summaries"][0]["cvdm_fitted"]["value"]);
    assert_eq!(trimtab(folder.path(), &["compare", "study.toml", "baseline.toml"]).status.code(), Some(2));
}
