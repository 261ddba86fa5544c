//! Fits of craft with named actuators: gains and a lag that are known come back, and recordings of two small craft are predicted.
//! The recordings are not part of the repository: where they are missing, their tests say so and pass.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use trimtab::fit::{FitSettings, fit};
use trimtab::recording::{Run, Split, measured};
use trimtab::ship::state::Inputs;
use trimtab::{EvaluationSettings, Integration, Judging, Model, Scenario, Ship, Study, prove, simulate};

const CATAMARAN: &str = "name = \"cat\"\n[hull]\nlpp = 1.2\nbreadth = 0.9\nmass = 17.0\n\
                         [[actuator]]\nname = \"port\"\ny = -0.3\nlaw = \"thruster\"\nangle = 0\nlag = \"free\"\n\
                         [[actuator]]\nname = \"starboard\"\ny = 0.3\nlaw = \"force\"\ncomponents = [\"X\"]\n";

const TWIN_SCREW: &str = "name = \"ferry\"\n[hull]\nlpp = 6.0\nbreadth = 1.4\ndraught = 0.4\nmass = 1900.0\n\
                          [[actuator]]\nname = \"port_screw\"\nx = -2.7\ny = -0.4\nlaw = \"propeller\"\nangle = 0\ndiameter = 0.28\n\
                          [[actuator]]\nname = \"starboard_screw\"\nx = -2.7\ny = 0.4\nlaw = \"propeller\"\nangle = 0\ndiameter = 0.28\n\
                          [[actuator]]\nname = \"port_rudder\"\nx = -2.9\ny = -0.4\nlaw = \"foil\"\narea = 0.06\nbehind = \"port_screw\"\n\
                          [[actuator]]\nname = \"starboard_rudder\"\nx = -2.9\ny = 0.4\nlaw = \"foil\"\narea = 0.06\nbehind = \"starboard_screw\"\n";

#[test]
fn gains_and_a_lag_that_are_known_come_back() {
    let known = [
        ("port.gain", 0.006),
        ("port.lag", 0.8),
        ("starboard.gain_x", 0.4),
        ("general_hull.surge_linear", 4.0),
        ("general_hull.yaw_linear", 5.0),
    ];
    come_back(CATAMARAN, &known, 0.4, |t, i| vec![40.0 * (0.4 * t + i).sin(), 30.0 * (0.23 * t - i).cos()]);
}

#[test]
fn twin_screws_with_rudders_in_their_races_come_back() {
    let known = [
        ("port_rudder.slope", 2.1),
        ("starboard_rudder.slope", 2.9),
        ("port_rudder.race", 0.6),
        ("port_screw.wake", 0.2),
        ("port_screw.lost", 0.15),
        ("starboard_screw.kt0", 0.3),
        ("general_hull.surge_square", 60.0),
        ("general_hull.yaw_linear", 900.0),
    ];
    come_back(TWIN_SCREW, &known, 1.2, |t, i| {
        let [port, starboard] = [7.0 + 3.0 * (0.2 * t + i).sin(), 7.0 + 3.0 * (0.33 * t - i).cos()];
        vec![port, starboard, 0.4 * (0.5 * t + i).sin(), 0.4 * (0.37 * t - 2.0 * i).sin()]
    });
}

/// Fits parameters to a craft sailed with their known values under the commands of each time \[s\] and run, from where they begin.
fn come_back(craft: &str, known: &[(&str, f64)], speed: f64, commands: impl Fn(f64, f64) -> Vec<f64>) {
    let ship = Ship::parse(craft, Path::new("ship.toml")).unwrap();
    let free: String = known.iter().map(|(name, _)| format!("\"{name}\" = {{ free = true }}\n")).collect();
    let text = format!("name = \"m\"\nform = \"general\"\n[parameters]\n{free}");
    let model = Model::parse(&text, Path::new("model.toml"), ship).unwrap();
    let mut truth = model.clone();
    truth.set(known).unwrap();
    let run = |i: u32| {
        let at = |k: u32| {
            let t = 0.1 * f64::from(k);
            let mut inputs = Inputs::actuators(t, 0.0, 0.0);
            let now = commands(t, f64::from(i));
            inputs.commands[..now.len()].copy_from_slice(&now);
            inputs
        };
        let inputs: Vec<Inputs<f64>> = (0..300).map(at).collect();
        let initial = [0.0, 0.0, f64::from(i), speed, 0.0, 0.0];
        let scenario = Scenario { dt: 0.1, inputs: inputs.clone(), initial };
        let sailed = simulate(&truth, &truth.values(), Integration::default(), &scenario);
        Run {
            name: format!("run {i}"),
            recording: format!("run {i}"),
            session: "pond".into(),
            manoeuvre: "weaving".into(),
            split: Split::Train,
            dt: 0.1,
            recorded_dt: 0.1,
            inputs,
            measured: measured(&sailed.states),
            initial,
            disturbed: Vec::new(),
            derived: [false; 6],
        }
    };
    let runs: Vec<Run> = (0..4).map(run).collect();
    let settings = FitSettings { max_yaw_rate: 0.3, ..FitSettings::default() };
    let fitted = fit(&model, &runs, &settings, &mut |_| true).unwrap();
    for (name, value) in known {
        let found = fitted.model.parameters[fitted.model.index(name).unwrap()].value;
        assert!((found / value - 1.0).abs() < 1e-3, "{name}: {found}, not {value}");
    }
}

/// A folder of recordings, or `None` and a word about it.
fn folder(data: &str) -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let given = std::env::var_os("TRIMTAB_DATA").map(PathBuf::from);
    let folder = given.unwrap_or_else(|| root.join("../shared/data")).join(data);
    if folder.is_dir() {
        return Some(folder);
    }
    crate::support::skipped(&format!("no recordings in {}", folder.display()));
    None
}

/// Mean cVDM \[%\] of a study's test windows, before and after the fit; `train` and `test` are files of the data.
fn predicted(data: &Path, ship: &str, columns: &str, train: &[&str], test: &[&str]) -> [f64; 2] {
    let place = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(place.path().join(name), text).unwrap();
    write("ship.toml", ship);
    write("columns.toml", columns);
    write("model.toml", "name = \"general\"\nform = \"general\"\nhull = \"free\"\n");
    let mut study = format!(
        "name = \"craft\"\nship = \"ship.toml\"\nmodel = \"model.toml\"\ncolumn_map = \"columns.toml\"\ndata = {:?}\nstep = 0.1\n\
         window = 20.0\ninitial_state = \"smoothed\"\ninitial_span = 1.0\ngaps = \"split\"\n",
        std::fs::canonicalize(data).unwrap()
    );
    for (files, split) in [(train, "train"), (test, "test")] {
        for file in files {
            let _ = write!(study, "[[runs]]\nfile = \"{file}.csv\"\nsplit = \"{split}\"\n");
        }
    }
    write("study.toml", &study);
    let study = Study::read(&place.path().join("study.toml")).unwrap();
    let ship = Ship::read(&study.ship).unwrap();
    let windows = study.windows(ship.hull.draught).unwrap().windows;
    let (train, test): (Vec<Run>, Vec<Run>) = windows.into_iter().partition(|w| w.split == Split::Train);
    let model = Model::read(&study.model, ship).unwrap();
    // The largest yaw rate of the prototype that these recordings were first looked at with.
    let settings = FitSettings { max_yaw_rate: 0.2, ..FitSettings::default() };
    let fitted = fit(&model, &train, &settings, &mut |_| true).unwrap();
    let judging = Judging::new(&settings, EvaluationSettings { resamples: 0, ..EvaluationSettings::default() });
    let judged = prove(&model, &fitted.model, &test, &judging);
    let summary = judged.summary("test").unwrap();
    [summary.cvdm_baseline.unwrap().value, summary.cvdm_fitted.unwrap().value]
}

#[test]
fn a_tug_with_voith_schneider_propellers_is_predicted_from_its_orders() {
    let Some(data) = folder("cse1") else { return };
    let mut ship =
        "name = \"CSE1\"\n[hull]\nlpp = 1.105\nbreadth = 0.248\nmass = 14.1\nwater_density = 1000.0\n".to_owned();
    let mut columns = "derive = [\"u\", \"v\", \"r\"]\nbridge = 1.0\n[columns]\n".to_owned();
    let places =
        [("px", -0.425, -0.055, 0), ("py", -0.425, -0.055, 90), ("sx", -0.425, 0.055, 0), ("sy", -0.425, 0.055, 90)];
    for (i, (name, x, y, angle)) in places.into_iter().chain([("bow", 0.4, 0.0, 90)]).enumerate() {
        let _ = write!(
            ship,
            "[[actuator]]\nname = \"{name}\"\nx = {x:?}\ny = {y:?}\nangle = {angle}\nlaw = \"order\"\nlag = \"free\"\n"
        );
        let _ = writeln!(columns, "\"{name}.order\" = {{ column = \"u{}\", unit = \"-\" }}", i + 1);
    }
    let [before, after] = predicted(&data, &ship, &columns, &["random_run1", "random_run3"], &["random_run4"]);
    // Steady motion: 286 % over these windows, 326 % above 0.05 m/s; fitted 147 % and 121 %.
    assert!(after < 160.0 && after < 0.5 * before, "{before} % to {after} %");
}

#[test]
fn a_catamaran_is_predicted_from_the_forces_of_its_thrusters() {
    let Some(data) = folder("blueboat") else { return };
    // The labels of the recordings are swapped: the thruster called right is to port.
    let ship = "name = \"BlueBoat\"\n[hull]\nlpp = 1.2\nbreadth = 0.93\nmass = 17.0\nwater_density = 1000.0\n\
                [[actuator]]\nname = \"port\"\nx = -0.4\ny = -0.29\nlaw = \"force\"\ncomponents = [\"X\"]\n\
                [[actuator]]\nname = \"starboard\"\nx = -0.4\ny = 0.29\nlaw = \"force\"\ncomponents = [\"X\"]\n";
    let columns = "[columns]\nt = { column = \"original_timestamp\", unit = \"ms\" }\nx = { column = \"x_ned\", unit = \"m\" }\n\
                   y = { column = \"y_ned\", unit = \"m\" }\npsi = { column = \"yaw\", unit = \"deg\" }\n\
                   u = { column = \"surge\", unit = \"m/s\" }\nv = { column = \"sway\", unit = \"m/s\" }\n\
                   r = { column = \"yaw_rate\", unit = \"rad/s\" }\n\"port.X\" = { column = \"right_force\", unit = \"N\" }\n\
                   \"starboard.X\" = { column = \"left_force\", unit = \"N\" }\n";
    let named = |numbers: &[u32]| numbers.iter().map(|n| format!("fixed_00000{n}")).collect::<Vec<_>>();
    let (train, test) =
        (named(&[216, 221, 223, 224, 225, 228, 230, 233, 234, 239]), named(&[218, 220, 222, 226, 232, 235]));
    let [train, test] = [&train, &test].map(|names| names.iter().map(String::as_str).collect::<Vec<_>>());
    let [before, after] = predicted(&data, ship, columns, &train, &test);
    // Steady motion: 239 % over these windows; fitted 111 %.
    assert!(after < 0.5 * 239.0 && after < 0.5 * before, "{before} % to {after} %");
}
