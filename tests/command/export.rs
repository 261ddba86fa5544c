//! `trimtab export`: the coefficients that are written give the hull force of the model, in every form of the file.
//! Octave, where it is installed, evaluates the MATLAB script; elsewhere its numbers are read from it.

use crate::support::study::{Study, contains_all};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::collections::BTreeMap;
use std::path::Path;
use trimtab::model::Model;
use trimtab::model::dynamics::Dynamics;
use trimtab::model::export::{Export, export};
use trimtab::physics::Form;
use trimtab::ship::Ship;
use trimtab::ship::state::{Inputs, State};

fn model(form: Form) -> Model {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments/ships/tanker.toml");
    Model::new(Ship::read(&file).unwrap(), "tanker", form, &["crossflow"]).unwrap()
}

/// Velocities ahead, astern, turning and at large drift.
fn velocities() -> Vec<[f64; 3]> {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    (0..50).map(|_| [rng.random_range(-4.0..8.0), rng.random_range(-3.0..3.0), rng.random_range(-0.03..0.03)]).collect()
}

/// The hull force from dimensionless coefficients alone, as the document says.
fn force(document: &Export, form: Form, [u, v, r]: [f64; 3]) -> [f64; 3] {
    let particular = |name: &str| document.particulars.iter().find(|p| p.name == name).unwrap().value;
    let (rho, l, d, small) = (particular("rho"), particular("L"), particular("d"), particular("small"));
    let si = |name: &str| {
        let c = document.hull.iter().find(|c| c.name == name).unwrap();
        let power = match c.divided_by.as_deref().unwrap() {
            "L" => return c.prime.unwrap() * l,
            "1/2 rho L d" => 1,
            other => other["1/2 rho L^".len()..].split(' ').next().unwrap().parse().unwrap(),
        };
        c.prime.unwrap() * 0.5 * rho * l.powi(power) * d
    };
    let smooth = |x: f64, s: f64| x.hypot(s);
    let (speed, au, av, ar) = (u.hypot(v).hypot(small), smooth(u, small), smooth(v, small), smooth(r, small / l));
    let (even, odd) = if form == Form::Regular { (au, u) } else { (speed, speed) };
    let (m, xg) = (si("mass"), si("x_g"));
    [
        (m + si("Xvr") - si("Yvdot")) * v * r + (m * xg - si("Yrdot")) * r * r,
        si("Yv") * even * v + si("Yr") * odd * r + si("Yvv") * v * av + si("Yvr") * v * ar + si("Yrr") * r * ar
            - m * u * r,
        si("Nv") * odd * v
            + si("Nr") * even * r
            + si("Nrr") * r * ar
            + si("Nrrv") * r * r * v / speed
            + si("Nvvr") * v * v * r / speed
            - m * xg * u * r,
    ]
}

fn hull(model: &Model, [u, v, r]: [f64; 3]) -> [f64; 3] {
    let state = State::from_array([0.0, 0.0, 0.3, u, v, r]);
    let all = Dynamics::new(model, model.values()).contributions(&state, &Inputs::actuators(0.0, 1.5, 0.1));
    let f = all.iter().find(|(name, _)| *name == "hull").unwrap().1;
    [f.x, f.y, f.n]
}

fn near(a: [f64; 3], b: [f64; 3], tolerance: f64) {
    let scale = [1e5, 1e5, 1e7];
    for i in 0..3 {
        assert!((a[i] - b[i]).abs() <= tolerance * (b[i].abs() + scale[i]), "{a:?} {b:?}");
    }
}

#[test]
fn the_exported_primes_give_the_hull_force_of_the_model() {
    for form in [Form::Paper, Form::Regular] {
        let model = model(form);
        let document = export(&model);
        assert_eq!(document.left_out, ["crossflow"]);
        for velocity in velocities() {
            near(force(&document, form, velocity), hull(&model, velocity), 1e-9);
        }
    }
}

#[test]
fn the_mmg_primes_give_the_accelerations_of_the_hd_form_on_a_straight_course() {
    // At u = U, to first order in v and r, with the couplings Yrdot and Nvdot that MMG does not have set to zero.
    let mut model = model(Form::Regular);
    model.set(&[("hull.Yrdot", 0.0), ("hull.Nvdot", 0.0), ("hull.x_g", 0.0)]).unwrap();
    let document = export(&model);
    let m = |name: &str| document.mmg.iter().find(|p| p.name == name).unwrap().value;
    let (l, d, rho) = (model.ship.hull.lpp, model.ship.hull.draught, model.ship.hull.water_density);
    let (u, v, r) = (6.0, 1e-4, 1e-6);
    let [_, y, n] = hull(&model, [u, v, r]);
    let (vp, rp) = (v / u, r * l / u);
    let force = 0.5 * rho * l * d * u * u;
    // MMG: (m + m_x) u r on the left.
    let mmg_y = force * (m("Yv") * vp + m("Yr") * rp - (m("m") + m("m_x")) * rp);
    let mmg_n = force * l * (m("Nv") * vp + m("Nr") * rp);
    assert!((mmg_y / y - 1.0).abs() < 0.02 && (mmg_n / n - 1.0).abs() < 0.02, "{mmg_y} {y}, {mmg_n} {n}");
}

/// The numbers that a MATLAB script sets, by name.
fn assigned(script: &str) -> BTreeMap<String, f64> {
    let code = |line: &str| line.split('%').next().unwrap_or("").trim().to_owned();
    let set = |line: String| {
        let (name, value) = line.strip_suffix(';')?.split_once(" = ")?;
        Some((name.to_owned(), value.parse().ok()?))
    };
    script.lines().map(code).filter_map(set).collect()
}

#[test]
fn every_form_has_the_same_numbers_and_octave_finds_the_same_force() {
    let study = Study::new();
    let said = |format: &str| study.does(&["export", "model.toml", "--study", "study.toml", "--format", format]);
    let json: serde_json::Value = serde_json::from_str(&said("json")).unwrap();
    let toml: toml::Table = said("toml").parse().unwrap();
    let script = said("matlab");
    let numbers = assigned(&script);
    for c in json["hull"].as_array().unwrap() {
        let (name, value) = (c["name"].as_str().unwrap(), c["value"].as_f64().unwrap());
        assert_eq!(numbers[&format!("ship.hd.{name}")], value, "{name}");
        assert_eq!(numbers[&format!("ship.prime.{name}")], c["prime"].as_f64().unwrap(), "{name}");
        let same = toml["hull"].as_array().unwrap().iter().find(|t| t["name"].as_str() == Some(name)).unwrap();
        assert_eq!(same["value"].as_float(), Some(value));
    }
    assert_eq!(numbers["ship.resistance.linear"], 34187.03);
    assert_eq!(script.matches('(').count(), script.matches(')').count());
    study.does(&["export", "model.toml", "--ship", "ship.toml", "--out", "ship.m"]);
    assert_eq!(std::fs::read_to_string(study.path("ship.m")).unwrap(), script);
    // The ship file of the study is an input, and is still there afterwards.
    let taken = study.refuses(&["export", "model.toml", "--ship", "ship.toml", "--out", "ship.toml"]);
    contains_all(&taken, &["ship.toml is there already and is not overwritten", "another name"]);
    contains_all(&study.refuses(&["export", "absent.toml", "--ship", "ship.toml"]), &["absent.toml", "cannot read"]);

    let ship = Ship::read(&study.path("ship.toml")).unwrap();
    let model = Model::read(&study.path("model.toml"), ship).unwrap();
    let call = "run('ship.m'); f = ship.hull_force(4.0, -0.7, 0.012); printf('%.12e %.12e %.12e', f);";
    let mut octave = std::process::Command::new("octave-cli");
    match octave.args(["--eval", call]).current_dir(study.folder.path()).output() {
        Err(_) => crate::support::skipped("octave-cli is not installed; the script was read, not run"),
        Ok(output) => {
            let text = String::from_utf8_lossy(&output.stdout).into_owned();
            let f: Vec<f64> = text.split_whitespace().map(|x| x.parse().unwrap()).collect();
            near([f[0], f[1], f[2]], hull(&model, [4.0, -0.7, 0.012]), 1e-9);
        }
    }
}

const CRAFT: &str = "name = \"cat\"\n[hull]\nlpp = 1.2\nbreadth = 0.9\nmass = 17.0\n\
    [[actuator]]\nname = \"left\"\nx = -0.4\ny = -0.3\nlaw = \"thruster\"\nangle = 0\n";

#[test]
fn a_general_hull_is_exported_with_its_own_force_and_its_actuators_and_nothing_of_a_propeller() {
    let ship = Ship::parse(CRAFT, Path::new("ship.toml")).unwrap();
    let mut model = Model::new(ship, "cat", Form::General, &[]).unwrap();
    for (i, p) in model.parameters.iter_mut().enumerate() {
        if p.name.starts_with("general_hull.") {
            p.value = (0.3 + 0.1 * (i % 7) as f64) * p.scale;
        }
    }
    model.set(&[("hull.Xudot", -2.0), ("hull.Yvdot", -9.0), ("hull.Nrdot", -0.7), ("hull.x_g", 0.05)]).unwrap();
    let document = export(&model);
    let script = document.matlab();
    let n = assigned(&script);
    assert_eq!(n["ship.actuators.left.y"], -0.3);
    assert_eq!(n["ship.actuators.left.loss"], model.parameters[model.index("left.loss").unwrap()].value);
    assert!(!script.contains("ship.D ") && !script.contains("rudder.lift1") && !script.contains("mmg.Yv"), "{script}");
    assert_eq!(script.matches('(').count(), script.matches(')').count());
    // Every name in the function is set above it.
    let function = &script[script.find("% Hull force").unwrap()..];
    for (own, table) in [("h.", "ship.hd."), ("g.", "ship.general_hull.")] {
        for (at, _) in function.match_indices(own) {
            let before = function[..at].chars().last().unwrap();
            let name: String = function[at + 2..].chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
            assert!(before.is_alphanumeric() || n.contains_key(&format!("{table}{name}")), "{own}{name}");
        }
    }
    // The equations of the document, with the numbers of the script.
    let (h, g) = (|name: &str| n[&format!("ship.hd.{name}")], |name: &str| n[&format!("ship.general_hull.{name}")]);
    let (l, small) = (n["ship.L"], n["ship.small"]);
    let inputs = Inputs::actuators(0.0, 0.0, 0.0);
    for [u, v, r] in velocities().into_iter().map(|[u, v, r]| [0.2 * u, 0.2 * v, 20.0 * r]) {
        let (au, av, ar) = (u.hypot(small), v.hypot(small), r.hypot(small / l));
        let at = |place: &str, w: f64| {
            let of = |what: &str| g(&format!("{place}_{what}"));
            (of("linear") + of("square") * w.hypot(small) + of("lift") * au) * w
        };
        let (bow, mid, stern) = (at("bow", v + 0.5 * l * r), at("mid", v), at("stern", v - 0.5 * l * r));
        let surge = g("surge_linear") + g("surge_square") * au + g("surge_drift") * av + g("surge_turn") * l * ar;
        let yaw = g("yaw_linear") + g("yaw_square") * ar + g("yaw_lift") * au;
        let (m, xg) = (h("mass"), h("x_g"));
        let wanted = [
            (m - h("Yvdot") + g("turning")) * v * r + m * xg * r * r - surge * u,
            -(m - h("Xudot") + g("turning") - g("lift")) * u * r - bow - mid - stern,
            -m * xg * u * r - (h("Xudot") - h("Yvdot") + g("lift")) * u * v - 0.5 * l * (bow - stern) - yaw * r,
        ];
        let state = State::from_array([0.0, 0.0, 0.3, u, v, r]);
        let all = Dynamics::new(&model, model.values()).contributions(&state, &inputs);
        let own = all.iter().filter(|(name, _)| ["hull", "general_hull", "resistance"].contains(name));
        let found = own.fold([0.0; 3], |sum, (_, f)| [sum[0] + f.x, sum[1] + f.y, sum[2] + f.n]);
        for i in 0..3 {
            assert!((found[i] - wanted[i]).abs() < 1e-9 * (1.0 + wanted[i].abs()), "{i}: {found:?} {wanted:?}");
        }
    }
}
