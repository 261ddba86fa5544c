//! Model files: bounds that are checked when a file is read, and the short ways to free coefficients.
//! A file that was written is read to the same model.

use std::path::Path;
use trimtab::Form;
use trimtab::model::{Model, Prior};
use trimtab::ship::{COEFFICIENTS, Ship};

fn ship() -> Ship {
    Ship::read(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/experiments/ships/a.toml"))).unwrap()
}

fn read(text: &str) -> Result<Model, String> {
    Model::parse(text, Path::new("model.toml"), ship()).map_err(|e| e.to_string())
}

fn again(model: &Model) -> (String, Model) {
    let text = toml::to_string(&model.to_file()).unwrap();
    let model = read(&text).unwrap();
    (text, model)
}

#[test]
fn a_value_outside_its_bounds_is_refused_with_the_bound_and_its_reason() {
    for (name, value, words) in [
        ("hull.Yv", "1000.0", ["linear sway damping", "at most 0"]),
        ("hull.Nrdot", "1.0", ["yaw added inertia", "at most 0"]),
        ("hull.Nrr", "5.0", ["quadratic yaw damping", "at most 0"]),
        ("rudder.drag0", "-0.157", ["drag coefficient at zero angle", "at least 0"]),
        ("flow.kt1", "0.2", ["slope of the thrust coefficient", "at most 0"]),
    ] {
        let error = read(&format!("name = \"m\"\n[parameters]\n\"{name}\" = {{ value = {value} }}\n")).unwrap_err();
        assert!(error.contains("model.toml:3") && error.contains(name), "{error}");
        assert!(words.iter().all(|w| error.contains(w)), "{error}");
    }
}

#[test]
fn a_bound_that_the_file_moves_applies_instead_of_the_terms() {
    let model = read("name = \"m\"\n[parameters]\n\"hull.Yv\" = { value = 1.0, upper = 2.0 }\n").unwrap();
    let i = model.index("hull.Yv").unwrap();
    assert_eq!((model.parameters[i].value, model.parameters[i].upper), (1.0, 2.0));
    let (text, again) = again(&model);
    assert_eq!(again.parameters[i].upper, 2.0, "{text}");
}

#[test]
fn a_default_prior_frees_a_coefficient_with_the_spread_that_its_term_knows() {
    let model = read("name = \"m\"\n[parameters]\n\"hull.Yv\" = { prior = \"default\" }\n").unwrap();
    let i = model.index("hull.Yv").unwrap();
    let p = &model.parameters[i];
    assert!(p.free);
    let ship = ship();
    assert_eq!(p.prior, Some(Prior { mean: ship.coefficient("Yv"), sd: (p.info.spread)(&ship) }));
    let (text, again) = again(&model);
    assert!(text.contains("prior = \"default\"") && !text.contains("sd ="), "{text}");
    assert_eq!(again.parameters[i].prior, p.prior);
    assert!(again.parameters[i].free);
    // A prior may be given for a coefficient that stays fixed.
    let fixed = read("name = \"m\"\n[parameters]\n\"hull.Yv\" = { free = false, prior = \"default\" }\n").unwrap();
    assert!(!fixed.parameters[i].free && fixed.parameters[i].prior.is_some());
}

#[test]
fn a_parameter_of_which_nothing_is_known_has_no_default_prior() {
    let error = read("name = \"m\"\n[parameters]\n\"resistance.linear\" = { prior = \"default\" }\n").unwrap_err();
    assert!(error.contains("model.toml:3") && error.contains("no default prior"), "{error}");
    let error = read("name = \"m\"\n[parameters]\n\"hull.Yv\" = { prior = \"usual\" }\n").unwrap_err();
    assert!(error.contains("default"), "{error}");
}

#[test]
fn hull_free_frees_every_coefficient_and_is_written_back_as_one_line() {
    let model = read("name = \"m\"\nhull = \"free\"\n").unwrap();
    for (name, _) in COEFFICIENTS {
        let p = &model.parameters[model.index(&format!("hull.{name}")).unwrap()];
        assert!(p.free && p.prior.is_some_and(|prior| prior.sd > 0.0 && prior.sd.is_finite()), "{name}");
    }
    for name in ["hull.mass", "hull.inertia", "hull.x_g"] {
        assert!(!model.parameters[model.index(name).unwrap()].free, "{name}");
    }
    let mut fitted = model.clone();
    let i = fitted.index("hull.Yv").unwrap();
    fitted.parameters[i].value *= 1.1;
    let (text, again) = again(&fitted);
    assert!(text.contains("hull = \"free\"") && !text.contains("prior"), "{text}");
    assert_eq!(again.values(), fitted.values());
    assert_eq!(again.free(), fitted.free());
    assert_eq!(again.parameters[i].prior, model.parameters[i].prior);
}

#[test]
fn a_coefficient_may_be_fixed_where_the_hull_is_free() {
    let model = read("name = \"m\"\nhull = \"free\"\n[parameters]\n\"hull.Nrrv\" = { free = false }\n").unwrap();
    let i = model.index("hull.Nrrv").unwrap();
    assert!(!model.parameters[i].free && model.parameters[i + 1].free);
    let (text, again) = again(&model);
    assert_eq!(again.free(), model.free(), "{text}");
    let error = read("name = \"m\"\nhull = \"loose\"\n").unwrap_err();
    assert!(error.contains("model.toml:2") && error.contains("free"), "{error}");
}

#[test]
fn published_coefficients_and_estimates_are_within_the_bounds() {
    // Published sets (L-d normalisation): KVLCC2 and KCS (Yoshimura & Ueno), S175, Esso Osaka; Yv, Nr, and the added masses
    // -m'x, -m'y, -J'z.
    let published = [
        ("KVLCC2", [-0.315, -0.049, -0.022, -0.223, -0.011]),
        ("KCS", [-0.2252, -0.0465, -0.00627, -0.1552, -0.00927]),
        ("S175", [-0.239, -0.046, -0.0049, -0.1451, -0.0086]),
        ("Esso Osaka", [-0.373, -0.048, -0.02, -0.2, -0.011]),
    ];
    let model = Model::new(ship(), "m", trimtab::physics::Form::Regular, &[]).unwrap();
    for (ship, values) in published {
        for (name, value) in ["Yv", "Nr", "Xudot", "Yvdot", "Nrdot"].iter().zip(values) {
            let p = &model.parameters[model.index(&format!("hull.{name}")).unwrap()];
            assert!((p.lower..=p.upper).contains(&value), "{name} of {ship}");
        }
    }
    // Every ship file of the experiments, and forms from slender to full.
    for file in ["a", "b", "flap", "tanker"] {
        let path = format!("{}/experiments/ships/{file}.toml", env!("CARGO_MANIFEST_DIR"));
        let ship = Ship::read(Path::new(&path)).unwrap();
        Model::new(ship, file, trimtab::physics::Form::Regular, &[]).unwrap();
    }
    for (length_to_breadth, breadth_to_draught, block) in
        [(5.0, 2.2, 0.85), (5.0, 4.0, 0.8), (6.5, 2.5, 0.7), (7.5, 3.0, 0.55), (8.0, 2.4, 0.6), (5.5, 2.8, 0.81)]
    {
        let mut ship = ship();
        ship.coefficients.clear();
        ship.coefficients_prime.clear();
        ship.hull.breadth = ship.hull.lpp / length_to_breadth;
        ship.hull.draught = ship.hull.breadth / breadth_to_draught;
        ship.hull.block_coefficient = block;
        let h = &ship.hull;
        ship.hull.mass = h.water_density * h.lpp * h.breadth * h.draught * block;
        let model = Model::new(ship, "m", trimtab::physics::Form::Regular, &[]).unwrap();
        for name in ["Xudot", "Yvdot", "Nrdot", "Yv", "Nr", "Yvv", "Nrr"] {
            let p = &model.parameters[model.index(&format!("hull.{name}")).unwrap()];
            assert!(p.value <= 0.0 && p.upper == 0.0, "{name} of L/B {length_to_breadth}, C_b {block}: {}", p.value);
        }
    }
}

#[test]
fn every_prefix_of_a_written_model_is_refused_or_means_the_same() {
    let mut model = read("name = \"m\"\nhull = \"free\"\nterms = [\"current\"]\n").unwrap();
    model.set(&[("rudder.lift1", 2.5), ("current.north", 0.25)]).unwrap();
    model.sessions.insert("day 1".into(), vec![(model.index("current.east").unwrap(), 0.1)]);
    let body = toml::to_string(&model.to_file()).unwrap();
    let text = trimtab::files::seal("use it with --model.", &body);
    let whole = read(&text).unwrap();
    assert_eq!((whole.values(), whole.free(), &whole.sessions), (model.values(), model.free(), &model.sessions));
    let mut read_as_whole = 0;
    for end in (0..text.len()).filter(|end| text.is_char_boundary(*end)) {
        match read(&text[..end]) {
            Err(message) => assert!(message.starts_with("model.toml:"), "{message}"),
            Ok(cut) => {
                assert_eq!(
                    (cut.values(), cut.free(), cut.sessions),
                    (model.values(), model.free(), model.sessions.clone())
                );
                read_as_whole += 1;
            }
        }
    }
    // All that may be missing is the end of the last line.
    assert_eq!(read_as_whole, 1);
    // The same model without a checksum, as written by hand, has prefixes that are read as another model: that is why.
    let others = (0..body.len()).filter(|end| read(&body[..*end]).is_ok_and(|cut| cut.values() != model.values()));
    assert!(others.count() > 0);
}

#[test]
fn a_written_model_is_read_with_the_ends_of_lines_of_another_system() {
    let text = trimtab::files::seal("use it with --model.", "name = \"m\"\n[parameters]\np5 = { value = 2.5 }\n");
    let model = read(&text.replace('\n', "\r\n")).unwrap();
    assert_eq!(model.eleven()[5], 2.5);
    let error = read(&text.replace("2.5", "2.6")).unwrap_err();
    assert!(error.contains("its checksum differs") && error.starts_with("model.toml:5: "), "{error}");
}

#[test]
fn what_a_model_cannot_compute_with_is_refused_with_line_and_near_name() {
    let cases = [
        ("[parameters]\n\"rudder.lfit1\" = { value = 2.0 }\n", ":3", "did you mean `rudder.lift1`?"),
        ("[parameters]\n\"rudder.lift1\" = { valeu = 2.0 }\n", ":3", "did you mean `value`?"),
        ("[parameters]\n\"rudder.lift1\" = { value = nan }\n", ":3", "must be finite"),
        ("[parameters]\n\"rudder.lift1\" = { lower = nan }\n", ":3", "its `lower` must be a number"),
        ("[sessions.a]\n\"rudder.lift1\" = inf\n", ":3", "must be finite"),
        ("trems = [\"wind\"]\n", ":2", "did you mean `terms`?"),
    ];
    for (text, line, words) in cases {
        let error = read(&format!("name = \"m\"\n{text}")).unwrap_err();
        assert!(error.contains(&format!("model.toml{line}")) && error.contains(words), "{text}{error}");
    }
}

#[test]
fn a_misspelt_parameter_of_the_ship_is_refused_with_the_nearest_name() {
    for (name, near) in
        [("rudder.lfit1", "rudder.lift1"), ("wnid.drag", "wind."), ("resistance.qubic", "resistance.cubic")]
    {
        let mut misspelt = ship();
        misspelt.parameters.insert(name.into(), 1.0);
        let error = Model::new(misspelt, "m", Form::default(), &[]).unwrap_err().to_string();
        assert!(error.contains(name) && error.contains(&format!("did you mean `{near}")), "{error}");
    }
    // A parameter of a term that the model does not use is no mistake.
    let mut other = ship();
    other.parameters.insert("wind.side".into(), 0.8);
    assert!(Model::new(other, "m", Form::default(), &[]).is_ok());
}

#[test]
fn a_model_without_resistance_says_so() {
    let mut bare = ship();
    assert!(!Model::new(bare.clone(), "m", Form::default(), &[]).unwrap().without_resistance());
    bare.parameters.clear();
    assert!(Model::new(bare, "m", Form::default(), &[]).unwrap().without_resistance());
}

#[test]
fn a_parameter_of_a_term_that_the_model_lacks_is_reported_with_the_term() {
    let error = read("name = \"m\"\n[parameters]\n\"current.north\" = { value = 0.1 }\n").unwrap_err();
    assert!(error.contains("model.toml:3") && error.contains("add it: terms = [\"current\"]"), "{error}");
    let error = read("name = \"m\"\n[parameters]\n\"side_force\" = { value = 0.1 }\n").unwrap_err();
    assert!(error.contains("did you mean `propeller.side_force`?"), "{error}");
}

#[test]
fn what_contradicts_itself_in_a_setting_is_refused_in_words() {
    for (setting, words) in [
        ("\"rudder.lift1\" = { value = 1.0 }\np5 = { value = 2.0 }", "set twice, by its name and by its symbol"),
        ("\"rudder.lift1\" = { lower = 3.0, upper = 2.0 }", "its `lower` (3) must be at most its `upper` (2)"),
        ("\"rudder.lift1\" = { prior = { mean = 1.0, sd = 0.0 } }", "the sd 0, where"),
        (
            "\"rudder.lift1\" = { lower = 0.0, upper = 3.0, prior = { mean = 9.0, sd = 0.1 } }",
            "lies outside its bounds",
        ),
        ("rudder.lift1 = { value = 1.0 }", "write the name in quotes"),
        ("\"rudder.lift1\" = { value = \"1.0\" }", "found the text"),
    ] {
        let error = read(&format!("name = \"m\"\n[parameters]\n{setting}\n")).unwrap_err();
        assert!(error.starts_with("model.toml:") && error.contains(words), "{setting}\n{error}");
    }
    // A number alone is the value.
    let plain = read("name = \"m\"\n[parameters]\n\"rudder.lift1\" = 1.0\n").unwrap();
    assert_eq!(plain.parameters[plain.find("rudder.lift1").unwrap()].value, 1.0);
    // A prior beyond a bound by less than its own width is knowledge that the bound cuts.
    assert!(
        read("name = \"m\"\n[parameters]\n\"rudder.lift1\" = { lower = 0.0, prior = { mean = -0.1, sd = 0.5 } }\n")
            .is_ok()
    );
}

#[test]
fn every_mistake_of_a_model_file_is_reported_at_once() {
    let text = "name = \"m\"\n[parameters]\n\"rudder.lfit1\" = { value = 1.0 }\n\"rudder.drag0\" = { value = nan }\n[sessions.a]\n\"wnid.side\" = 1.0\n";
    let error = read(text).unwrap_err();
    let lines: Vec<&str> = error.lines().collect();
    assert_eq!(lines.len(), 3, "{error}");
    for (place, words) in [(":3:", "rudder.lift1"), (":4:", "must be finite"), (":6:", "wnid.side")] {
        assert!(lines.iter().any(|line| line.contains(place) && line.contains(words)), "{error}");
    }
}

#[test]
fn a_model_that_was_fitted_to_another_ship_is_refused() {
    let text = toml::to_string(&read("name = \"m\"\n").unwrap().to_file()).unwrap();
    assert!(text.contains("[fitted_ship]") && read(&text).is_ok(), "{text}");
    let mut other = ship();
    other.hull.lpp *= 1.2;
    let parse = |ship: Ship, text: &str| Model::parse(text, Path::new("fitted.toml"), ship).map_err(|e| e.to_string());
    let error = parse(other.clone(), &text).unwrap_err();
    assert!(
        error.contains("L = 85 m") && error.contains("L = 102 m") && error.contains("fit the model to this ship"),
        "{error}"
    );
    // A file without the table, as written by hand or before there was one, may serve any ship.
    assert!(parse(other, "name = \"m\"\n").is_ok());
}
