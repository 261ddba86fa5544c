//! The trials that `trimtab maneuver` sails: in calm water whatever a model has found around the ship, with intervals from a covariance.
//! The measures themselves are tested in `src/evaluate/maneuver/tests.rs` and against recordings in `tests/library/trials.rs`.

use crate::support::study::{Study, at, contains_all};
use std::path::Path;
use trimtab::evaluate::maneuver::imo::Verdict;
use trimtab::evaluate::maneuver::{
    Approach, Known, ManeuverSettings, Measured, Side, Trial, Turning, calm_water, drawn, drawn_from, set_intervals,
    set_intervals_from, stopping_trial, turning_trial, zigzag_trial,
};
use trimtab::model::Model;
use trimtab::numbers::uncertainty::Uncertainty;
use trimtab::physics::Form;
use trimtab::ship::Ship;

fn model(terms: &[&str], values: &[(&str, f64)]) -> Model {
    let ship = Ship::read(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/experiments/ships/b.toml"))).unwrap();
    let mut model = Model::new(ship, "b", Form::Regular, terms).unwrap();
    let star = [-0.027, 5669.0, -1127.0, 538.0, 0.012, 2.42, 0.0, -3.2, 0.047, 0.0, 1.5];
    model.set_eleven(&star);
    model.set(values).unwrap();
    model
}

fn settings() -> ManeuverSettings {
    ManeuverSettings { speed: Some(6.0), ..ManeuverSettings::default() }
}

fn circles(model: &Model, approach: &Approach, theta: &[f64]) -> Vec<Trial<Turning>> {
    Side::BOTH.map(|side| turning_trial(model, theta, approach, side, 0.61)).to_vec()
}

#[test]
fn a_model_with_a_current_sails_the_circles_of_one_without() {
    let still = model(&[], &[]);
    let terms = ["current", "mean_wind", "heading_bias", "push", "thruster", "fouling", "time_skew", "shallow"];
    let found = model(&terms, &[("current.north", 0.171), ("current.east", 0.470), ("heading_bias.bias", 0.02)]);
    let (calm, left_out) = calm_water(&found);
    assert_eq!(left_out, ["current", "mean_wind", "heading_bias", "push", "time_skew", "shallow"]);
    let approach = |m: &Model| settings().approach(m, &m.values()).unwrap();
    assert_eq!(approach(&calm), approach(&still));
    let measures = |m: &Model| {
        let (theta, a) = (m.values(), approach(m));
        let turns: Vec<Turning> = circles(m, &a, &theta).into_iter().map(|t| t.measures).collect();
        let zigzag = zigzag_trial(m, &theta, &a, Side::Port, [0.35, 0.35]).measures;
        (turns, zigzag, stopping_trial(m, &theta, &a).measures)
    };
    assert_eq!(measures(&calm), measures(&still));
    let (moved, _, _) = measures(&found);
    let diameter = |m: &Turning| m.tactical_diameter.unwrap() / 123.0;
    assert!((diameter(&moved[0]) - diameter(&measures(&still).0[0])).abs() > 0.1, "the current must matter as found");
}

/// A covariance of three parameters of which two are correlated.
fn covariance(scale: f64) -> Uncertainty {
    let names = ["resistance.quadratic", "rudder.lift1", "hull.Nr"].map(str::to_owned);
    let sd = [200.0, 0.08, 2.0e8].map(|s| s * scale);
    let r = [[1.0, 0.3, 0.0], [0.3, 1.0, -0.6], [0.0, -0.6, 1.0]];
    let table: Vec<Vec<Option<f64>>> =
        (0..3).map(|i| (0..3).map(|j| Some(r[i][j] * sd[i] * sd[j])).collect()).collect();
    Uncertainty::new("test", None, &names, &table).unwrap()
}

#[test]
fn intervals_are_those_of_linear_propagation_where_the_spread_is_small() {
    let model = model(&[], &[]);
    let settings = settings();
    let sail = |theta: &[f64]| Some(circles(&model, &settings.approach(&model, theta).ok()?, theta));
    let u = covariance(0.3);
    let mut trials = sail(&model.values()).unwrap();
    set_intervals(&mut trials, &drawn(&model, &u, 1000, 3), sail);
    for name in ["advance", "transfer", "tactical_diameter", "steady_diameter", "time_90"] {
        let slope = |parameter: &String| {
            let i = model.index(parameter).unwrap();
            let h = 0.1
                * u.matrix[u.parameters.iter().position(|p| p == parameter).unwrap()]
                    [u.parameters.iter().position(|p| p == parameter).unwrap()]
                .sqrt();
            let at = |step: f64| {
                let mut theta = model.values();
                theta[i] += step;
                sail(&theta).unwrap()[0].measures.quantity(name).unwrap()
            };
            (at(h) - at(-h)) / (2.0 * h)
        };
        let g: Vec<f64> = u.parameters.iter().map(slope).collect();
        let variance: f64 =
            (0..3).flat_map(|i| (0..3).map(move |j| (i, j))).map(|(i, j)| g[i] * u.matrix[i][j] * g[j]).sum();
        let [low, high] = trials[0].intervals[name];
        let (width, linear) = (high - low, 2.0 * 1.96 * variance.sqrt());
        assert!((width / linear - 1.0).abs() < 0.15, "{name}: {width} instead of {linear}");
        let value = trials[0].measures.quantity(name).unwrap();
        assert!(low < value && value < high, "{name}: {value} in [{low}, {high}]");
    }
}

#[test]
fn a_measure_that_draws_do_not_reach_has_no_interval() {
    let model = model(&[], &[]);
    let approach = settings().approach(&model, &model.values()).unwrap();
    let mut trials = circles(&model, &approach, &model.values());
    let draws = drawn(&model, &covariance(1.0), 20, 1);
    set_intervals(&mut trials, &draws, |theta| (theta[0] > f64::INFINITY).then(|| circles(&model, &approach, theta)));
    assert!(trials.iter().all(|t| t.intervals.is_empty()));
    set_intervals(&mut trials, &draws, |theta| Some(circles(&model, &approach, theta)));
    assert!(trials.iter().all(|t| t.intervals.len() == Turning::QUANTITIES.len()), "{:?}", trials[0].intervals);
}

#[test]
fn a_fitted_model_file_contains_its_covariance_and_the_trials_report_it() {
    let study = Study::new();
    let fit = study.json(&["fit", "study.toml", "--out", "results"]);
    let turning = ["maneuver", "turning", "study.toml", "--model", "results/fitted.toml", "--draws", "60"];
    let said = study.does(&turning);
    contains_all(&said, &["95 % intervals in brackets: 60 draws", "results/fitted.toml", "seed 1", "advance [L]"]);
    assert!(!said.contains("Calm water"), "nothing is left out of a model without such terms: {said}");
    let line = said.lines().find(|l| l.contains("tactical diameter [L]")).unwrap();
    assert!(line.contains('[') && line.matches(", ").count() >= 2, "an interval a side: {line}");
    let json = study.json(&turning);
    assert_eq!(at(&json, "result.draws.count"), 60);
    let ends = at(&json, "result.trials.0.intervals.advance");
    let advance = at(&json, "result.trials.0.measures.advance").as_f64().unwrap();
    assert!(ends[0].as_f64().unwrap() < advance && advance < ends[1].as_f64().unwrap());
    assert_eq!(study.does(&turning), said, "equal seeds give equal intervals");
    assert_ne!(study.does(&[&turning[..], &["--seed", "2"]].concat()), said);
    let before = study.does(&["maneuver", "turning", "study.toml", "--draws", "20"]);
    contains_all(&before, &["20 draws of the priors of ", "model.toml (spreads before any data"]);

    let error = at(&fit, "result.estimates.1.standard_error").as_f64().unwrap();
    let variance = at(&fit, "result.covariance.1.1").as_f64().unwrap();
    assert!((variance.sqrt() / error - 1.0).abs() < 1e-9 || error == 0.0);
    study.edit("results/fitted.toml", "\"rudder.lift1\"", "\"rudder.lift9\"");
    let text = std::fs::read_to_string(study.path("results/fitted.toml")).unwrap();
    let body: Vec<&str> = text.lines().filter(|l| !l.starts_with('#')).collect();
    study.write("edited.toml", &body.join("\n"));
    study.refuses(&["maneuver", "turning", "study.toml", "--model", "edited.toml"]);
}

#[test]
fn what_is_left_out_is_said_and_kept_on_request() {
    let study = Study::new();
    study.edit("model.toml", "form = \"paper\"", "form = \"paper\"\nterms = [\"current\", \"yaw_rate_bias\"]");
    study.append("model.toml", "\"current.east\" = { value = 0.5 }\n");
    let calm = study.does(&["maneuver", "turning", "study.toml", "--draws", "0"]);
    contains_all(&calm, &["Calm water: current, yaw_rate_bias left out (`--as-found` keeps them)."]);
    let found = study.does(&["maneuver", "turning", "study.toml", "--as-found", "--draws", "0"]);
    contains_all(&found, &["As found, not in calm water: current, yaw_rate_bias kept."]);
    let json = study.json(&["maneuver", "turning", "study.toml", "--out", "turning", "--draws", "0"]);
    assert_eq!(at(&json, "result.left_out").as_array().unwrap().len(), 2);
    let table = std::fs::read_to_string(study.path("turning/turning_measures.csv")).unwrap();
    assert!(table.starts_with("trial,side,measure,unit,value,low95,high95\n"), "{table}");
    assert_eq!(table.lines().count(), 1 + 2 * Turning::QUANTITIES.len());
}

#[test]
fn pull_outs_and_a_spiral_are_sailed_and_say_whether_the_ship_is_stable_on_its_course() {
    let study = Study::new();
    let said = study.does(&["maneuver", "pullout", "study.toml", "--draws", "20", "--out", "pulled"]);
    contains_all(&said, &["yaw rate left [deg/s]", "time to 1/e [s]", "on its course."]);
    assert!(!said.contains("MSC.137"), "there is no criterion for it: {said}");
    let json = study.json(&[
        "maneuver",
        "spiral",
        "study.toml",
        "--angle",
        "15",
        "--depth",
        "20",
        "--draws",
        "20",
        "--out",
        "spiral",
    ]);
    assert!(at(&json, "result.trials.0.measures.points").as_array().unwrap().len() > 15);
    let said = study.does(&["maneuver", "spiral", "study.toml", "--depth", "20", "--draws", "0"]);
    contains_all(&said, &["width of the loop [deg]", "Water of 20"]);
    study.refuses(&["maneuver", "turning", "study.toml", "--depth", "1"]);
}

#[test]
fn recordings_without_a_trial_are_said_to_have_none() {
    let study = Study::new();
    let said = study.does(&["maneuver", "measure", "study.toml", "--out", "measured"]);
    contains_all(&said, &["no turning circle and no zigzag in 8 recordings"]);
    let table = std::fs::read_to_string(study.path("measured/measured.csv")).unwrap();
    assert!(table.starts_with("run,trial,side,at,measure,unit,over_ground,through_water,model"), "{table}");
    assert_eq!(at(&study.json(&["maneuver", "measure", "study.toml"]), "result.trials").as_array().unwrap().len(), 0);
}

#[test]
fn a_trial_needs_no_recording_and_says_where_speed_and_rudder_rate_are_from() {
    let study = Study::new();
    study.edit("study.toml", "speed = 6.0 ", "# ");
    let trial = |more: &[&str]| study.does(&[&["maneuver", "turning", "study.toml", "--draws", "0"], more].concat());
    contains_all(&trial(&[]), &["m/s (of the recordings; "]);
    contains_all(&trial(&["--speed", "4"]), &["approach 4.000 m/s (as set; "]);
    contains_all(&trial(&["--rpm", "100"]), &["(held by the propeller rate; "]);
    let text = std::fs::read_to_string(study.path("study.toml")).unwrap();
    let alone: String = text.lines().filter(|l| !l.starts_with("runs")).map(|l| format!("{l}\n")).collect();
    study.write("study.toml", &alone);
    contains_all(&trial(&[]), &["(usual for its length; ", "deg/s (usual for its length)"]);
    study.edit("ship.toml", "[propeller]", "service_speed = 5.25\n[propeller]");
    study.edit("ship.toml", "[rudder]", "[rudder]\nrate_deg_s = 3.5");
    contains_all(&trial(&[]), &["approach 5.250 m/s (of the ship file; ", "rudder rate 3.50 deg/s (of the ship file)"]);
    let by_ship = ["--ship", "ship.toml", "--model", "model.toml", "--draws", "0"];
    assert_eq!(study.does(&[&["maneuver", "turning"][..], &by_ship].concat()), trial(&[]));
    study.edit("ship.toml", "service_speed = 5.25", "service_speed = 525");
    contains_all(&study.refuses(&["maneuver", "turning", "study.toml"]), &["ship.toml:", "hull.service_speed"]);
}

#[test]
fn a_criterion_inside_the_interval_of_its_measure_is_open() {
    let model = model(&[], &[]);
    let settings = settings();
    let sail = |theta: &[f64]| Some(circles(&model, &settings.approach(&model, theta).ok()?, theta));
    let verdicts = |known, scale| {
        let mut trials = sail(&model.values()).unwrap();
        let advance = trials[0].measures.advance.unwrap() / 123.0;
        // A limit just above what is measured.
        trials[0].criteria[0].limit = Some(advance + 0.01);
        let draws = drawn_from(known, &model, &covariance(scale), 40, 3);
        set_intervals_from(known, &mut trials, &draws, sail);
        let ends = trials[0].criteria[0].interval.unwrap();
        assert!(ends[0] <= advance && advance <= ends[1], "{ends:?} {advance}");
        trials[0].criteria[0].verdict
    };
    for known in [Known::ByFit, Known::Before] {
        assert_eq!((verdicts(known, 1.0), verdicts(known, 1e-4)), (Verdict::Open, Verdict::Met), "{known:?}");
    }
}
