//! Laws of named actuators: mirror symmetry, moving water, derivatives, lags, a craft without any, and files that name them.
//! What a fit finds with them is tested with recordings of real craft where these are at hand.

use std::path::Path;
use trimtab::model::dynamics::Dynamics;
use trimtab::model::{Model, ModelFile};
use trimtab::physics::Form;
use trimtab::recording::{Channel, ColumnMap, Recording};
use trimtab::ship::Ship;
use trimtab::ship::parameter::Parity;
use trimtab::ship::state::{COMMANDS, Inputs, STATES, State};
use trimtab::simulate::sensitivity::{Column, Columns, Sensitivity};
use trimtab::{Integration, Scenario, simulate};

const CRAFT: &str = "name = \"ferry\"\n[hull]\nlpp = 5.0\nbreadth = 2.8\nmass = 1250.0\n";

/// Two azimuths abreast forward, a tunnel across aft, a throttle and a logged force: nine channels.
const ACTUATORS: &str = "
[[actuator]]
name = \"port\"
x = 1.8
y = -0.9
law = \"thruster\"
astern = 0.6
[[actuator]]
name = \"starboard\"
x = 1.8
y = 0.9
law = \"thruster\"
astern = 0.6
[[actuator]]
name = \"tunnel\"
x = -2.0
angle = 90
law = \"order\"
lag = 0.7
[[actuator]]
name = \"pump\"
x = -2.4
law = \"order\"
[[actuator]]
name = \"tau\"
x = 0.3
law = \"force\"
lag = \"free\"
";

/// Twin screws with a rudder behind each, and a rudder in the stream between them: five channels.
const TWIN: &str = "
[[actuator]]
name = \"port_screw\"
x = -2.2
y = -0.6
angle = 0
law = \"propeller\"
diameter = 0.4
thrust_coefficients = [0.34, -0.24, -0.19]
[[actuator]]
name = \"starboard_screw\"
x = -2.2
y = 0.6
angle = 0
law = \"propeller\"
diameter = 0.4
thrust_coefficients = [0.34, -0.24, -0.19]
lag = 0.3
[[actuator]]
name = \"port_rudder\"
x = -2.4
y = -0.6
law = \"foil\"
area = 0.12
behind = \"port_screw\"
[[actuator]]
name = \"starboard_rudder\"
x = -2.4
y = 0.6
law = \"foil\"
area = 0.12
behind = \"starboard_screw\"
lag = \"free\"
[[actuator]]
name = \"skeg\"
x = -2.4
law = \"foil\"
area = 0.1
span = 0.5
";

const TURNED: [f64; 10] = [5.0, 6.0, 0.3, 0.2, -0.25, 0.0, 0.0, 0.0, 0.0, 0.0];

fn ship(actuators: &str) -> Ship {
    Ship::parse(&format!("{CRAFT}{actuators}"), Path::new("ship.toml")).unwrap()
}

fn model(actuators: &str, form: Form) -> Model {
    Model::new(ship(actuators), "m", form, &[]).unwrap()
}

/// Every parameter off its default, inside its bounds.
fn moved(mut model: Model) -> Model {
    for (i, p) in model.parameters.iter_mut().enumerate() {
        let step = p.scale * [0.2, -0.15, 0.1, -0.25, 0.3][i % 5];
        p.value += if (p.lower..=p.upper).contains(&(p.value + step)) { step } else { -step };
    }
    model
}

/// Port rate and angle, starboard rate and angle, tunnel, pump and its angle, X, Y and N.
fn commanded(commands: [f64; 10]) -> Inputs<f64> {
    let mut inputs = Inputs::actuators(0.0, 0.0, 0.0);
    inputs.commands[..10].copy_from_slice(&commands);
    inputs
}

const COMMANDED: [f64; 10] = [9.0, 0.6, -7.0, -1.1, 0.4, 0.8, 0.3, 120.0, -40.0, 75.0];

fn rates(model: &Model, state: [f64; STATES], inputs: &Inputs<f64>) -> [f64; STATES] {
    let dynamics = Dynamics::new(model, model.values());
    dynamics.rates(&State::from_array(state), inputs, &trimtab::Force::zero()).0
}

#[test]
fn a_mirrored_craft_under_mirrored_commands_has_the_mirrored_rates() {
    let mut model = moved(model(ACTUATORS, Form::General));
    // What makes the sides of a ship differ is not asked here.
    for p in model.parameters.iter_mut().filter(|p| p.info.parity == Parity::Odd) {
        p.value = 0.0;
    }
    // The pair is alike but for its side, and an angle's zero is of one side.
    for name in ["gain", "loss", "astern", "lag", "lost"] {
        let port = model.parameters[model.index(&format!("port.{name}")).unwrap()].value;
        let starboard = model.index(&format!("starboard.{name}")).unwrap();
        model.parameters[starboard].value = port;
    }
    for name in ["port.zero", "starboard.zero", "pump.zero"] {
        let i = model.index(name).unwrap();
        model.parameters[i].value = if name == "starboard.zero" {
            -0.1
        } else if name == "port.zero" {
            0.1
        } else {
            0.0
        };
    }
    let [n1, a1, n2, a2, tunnel, pump, turned, x, y, n] = COMMANDED;
    let mirrored = [n2, -a2, n1, -a1, -tunnel, pump, -turned, x, -y, -n];
    let there = rates(&model, [3.0, 4.0, 0.4, 1.1, -0.3, 0.2], &commanded(COMMANDED));
    let back = rates(&model, [3.0, -4.0, -0.4, 1.1, 0.3, -0.2], &commanded(mirrored));
    for (i, sign) in [1.0, -1.0, -1.0, 1.0, -1.0, -1.0].into_iter().enumerate() {
        assert!((there[i] - sign * back[i]).abs() < 1e-12 * (1.0 + there[i].abs()), "{i}: {there:?} {back:?}");
    }
    // Not because nothing acts.
    let idle = rates(&model, [3.0, 4.0, 0.4, 1.1, -0.3, 0.2], &commanded([0.0; 10]));
    assert!((there[5] - idle[5]).abs() > 1e-3 && (there[4] - idle[4]).abs() > 1e-3, "{there:?} {idle:?}");
}

#[test]
fn an_actuator_pushes_at_its_place_along_its_direction() {
    let of = |text: &str, command: f64| {
        let model = model(text, Form::General);
        let dynamics = Dynamics::new(&model, model.values());
        let mut inputs = Inputs::actuators(0.0, 0.0, 0.0);
        inputs.commands[0] = command;
        let state = State::from_array([0.0; STATES]);
        let all = dynamics.contributions(&state, &inputs);
        all.into_iter().find(|(name, _)| *name == "a").unwrap().1.to_array()
    };
    let order = |more: &str| format!("[[actuator]]\nname = \"a\"\nlaw = \"order\"\ngain = 10\n{more}");
    let near = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
    assert!(near(of(&order("angle = 0\ny = -0.9"), 2.0), [20.0, 0.0, 18.0]));
    assert!(near(of(&order("angle = 90\nx = 2.0"), 2.0), [0.0, 20.0, 40.0]));
    assert!(near(of(&order("angle = 180\ny = 0.5"), 1.0), [-10.0, 0.0, 5.0]));
    let thruster = "[[actuator]]\nname = \"a\"\nlaw = \"thruster\"\ngain = 0.5\nastern = 0.6\nangle = 0\n";
    assert!(near(of(thruster, 4.0), [8.0, 0.0, 0.0]) && near(of(thruster, -4.0), [-4.8, 0.0, 0.0]));
    let force = "[[actuator]]\nname = \"a\"\nlaw = \"force\"\nx = 2.0\ncomponents = [\"Y\"]\n";
    assert!(near(of(force, 3.0), [0.0, 3.0, 6.0]));
}

#[test]
fn in_moving_water_the_track_is_that_of_still_water_and_the_drift() {
    let series: Vec<Inputs<f64>> = (0..200)
        .map(|k| {
            let wave = f64::from(k) * 0.05;
            let [n1, a1, n2, a2, tunnel, pump, turned, x, y, n] = COMMANDED;
            commanded([n1 * wave.cos(), a1, n2, a2 + wave, tunnel, pump * wave.sin(), turned, x, y * wave.cos(), n])
        })
        .collect();
    let model = moved(model(ACTUATORS, Form::General));
    let (north, east) = (0.4, -0.25);
    let psi: f64 = 0.7;
    let drift = [north * psi.cos() + east * psi.sin(), east * psi.cos() - north * psi.sin()];
    let calm = [0.0, 0.0, psi, 0.9, 0.1, 0.02];
    let moving = [0.0, 0.0, psi, 0.9 + drift[0], 0.1 + drift[1], 0.02];
    let integration = Integration { method: trimtab::Method::Rk4, substeps: 4 };
    let run = |initial, current: [f64; 2]| {
        let inputs = series.iter().map(|i| Inputs { current, ..*i }).collect();
        simulate(&model, &model.values(), integration, &Scenario { dt: 0.1, inputs, initial }).states
    };
    let (still, carried) = (run(calm, [0.0, 0.0]), run(moving, [north, east]));
    for (k, (a, b)) in still.iter().zip(&carried).enumerate() {
        let t = 0.1 * k as f64;
        let off = (b[0] - a[0] - north * t).hypot(b[1] - a[1] - east * t);
        assert!(off < 1e-6 && (a[2] - b[2]).abs() < 1e-7, "{t} s: {off:e} m");
    }
    assert_eq!(still.len(), 200);
}

#[test]
fn derivatives_by_every_parameter_are_those_of_differences() {
    assert!(slopes_seen(ACTUATORS, COMMANDED, "port.") > 10);
    assert!(slopes_seen(TWIN, TURNED, "port_screw.") > 20 && slopes_seen(TWIN, TURNED, "port_rudder.") > 20);
}

/// How many derivatives by parameters of that name are not 0; all are those of differences.
fn slopes_seen(actuators: &str, commands: [f64; 10], of: &str) -> usize {
    let model = moved(model(actuators, Form::General));
    let columns: Vec<Column> = (0..model.parameters.len()).map(|parameter| Column { parameter, scale: 1.0 }).collect();
    let series: Vec<Inputs<f64>> =
        (0..60).map(|k| commanded(commands.map(|c| c * (0.3 + f64::from(k) * 0.11).cos()))).collect();
    let initial = [0.0, 0.0, 0.4, 0.8, -0.1, 0.05];
    let dynamics = Dynamics::new(&model, model.values());
    let grouped = Columns::new(&model, &columns);
    let mut slopes = Vec::new();
    let sensitivity = Sensitivity::new(dynamics, &grouped, false);
    sensitivity.rollout(Integration::default(), 0.1, &series, &initial, &[0.0; STATES], |_, _, s| slopes = s.to_vec());
    let end = |values: &[f64]| {
        let scenario = Scenario { dt: 0.1, inputs: series.clone(), initial };
        *simulate(&model, values, Integration::default(), &scenario).states.last().unwrap()
    };
    let mut seen = 0;
    for (i, p) in model.parameters.iter().enumerate() {
        let step = 1e-4 * p.scale;
        let at = |sign: f64| {
            let mut values = model.values();
            values[i] += sign * step;
            end(&values)
        };
        let (up, down) = (at(1.0), at(-1.0));
        for j in 0..STATES {
            let by_difference = (up[j] - down[j]) / (2.0 * step);
            let off = (slopes[i][j] - by_difference).abs() * p.scale;
            assert!(off < 1e-6 * (1.0 + (by_difference * p.scale).abs()), "{} of state {j}: {off:e}", p.name);
            seen += usize::from(by_difference != 0.0 && p.name.contains(of));
        }
    }
    seen
}

#[test]
fn a_propeller_with_a_rudder_behind_it_is_that_of_the_standard_method() {
    let hull = "lpp = 5.0\nbreadth = 2.8\ndraught = 0.5\nblock_coefficient = 0.6\nmass = 4300.0\n";
    let single = format!(
        "name = \"a\"\n[hull]\n{hull}x_g = 0.1\n[propeller]\ndiameter = 0.4\nx = -2.2\nwake = 0.25\nthrust_deduction = 0.15\n\
         thrust_coefficients = [0.34, -0.24, -0.19]\n[rudder]\narea = 0.12\nspan = 0.45\nx = -2.4\nstraightening = 0.45\n\
         lever = -0.816\nwake_ratio = 1.05\nrace = 0.5\n"
    );
    let named = format!(
        "name = \"a\"\n[hull]\n{hull}[[actuator]]\nname = \"screw\"\nx = -2.2\nangle = 0\nlaw = \"propeller\"\ndiameter = 0.4\n\
         wake = 0.25\nthrust_deduction = 0.15\nthrust_coefficients = [0.34, -0.24, -0.19]\n[[actuator]]\nname = \"blade\"\nx = -2.4\n\
         law = \"foil\"\narea = 0.12\nspan = 0.45\nbehind = \"screw\"\n"
    );
    let parse = |text: &str, form| {
        let ship = Ship::parse(text, Path::new("ship.toml")).unwrap();
        Model::new(ship, "m", form, &[]).unwrap()
    };
    let (mut single, named) = (parse(&single, Form::Mmg), parse(&named, Form::General));
    single.set(&[("mmg_wake.C_1", 0.0)]).unwrap();
    let mut compared = 0;
    // Attached flow: the standard method has no flat plate beyond it.
    for u in [-0.8, 0.0, 0.5, 1.4] {
        for (n, delta, r) in [(6.0, 0.3, 0.05), (-5.0, -0.4, 0.0), (0.0, 0.5, 0.0), (3.0, 0.0, 0.02)] {
            if (u, n) == (0.0, 0.0) || n * u < 0.0 {
                continue;
            }
            let state = State::from_array([0.0, 0.0, 0.0, u, 0.0, r]);
            let mut inputs = Inputs::actuators(0.0, n, delta);
            inputs.commands[..2].copy_from_slice(&[n, delta]);
            let of = |model: &Model, name: &str| {
                let all = Dynamics::new(model, model.values()).contributions(&state, &inputs);
                all.into_iter().find(|(own, _)| *own == name).unwrap().1.to_array()
            };
            for (a, b) in [("propeller", "screw"), ("mmg_rudder", "blade")] {
                let (wanted, found) = (of(&single, a), of(&named, b));
                for (wanted, found) in wanted.iter().zip(found) {
                    assert!((wanted - found).abs() < 1e-9 * (1.0 + wanted.abs()), "{b} {u} {n}: {wanted} {found}");
                    compared += usize::from(*wanted != 0.0);
                }
            }
        }
    }
    assert!(compared > 40, "{compared}");
}

#[test]
fn a_dead_propeller_leaves_its_rudder_the_stream_alone() {
    let mut model = model(TWIN, Form::General);
    let state = State::from_array([0.0, 0.0, 0.0, 1.2, 0.0, 0.0]);
    let rudder = |model: &Model| {
        let all = Dynamics::new(model, model.values()).contributions(&state, &commanded(TURNED));
        all.into_iter().find(|(own, _)| *own == "port_rudder").unwrap().1.to_array()
    };
    let raced = rudder(&model);
    model.set(&[("port_screw.lost", 1.0)]).unwrap();
    let dead = rudder(&model);
    // Turned to starboard, aft: to port, and the bow to starboard.
    assert!(raced[1] < 1.5 * dead[1] && dead[1] < 0.0 && raced[2] > 0.0, "{raced:?} {dead:?}");
}

#[test]
fn a_lag_follows_its_channel_and_leaves_the_angle_alone() {
    let mut model = model(ACTUATORS, Form::General);
    model.set(&[("port.lag", 2.0), ("tunnel.lag", 0.0)]).unwrap();
    let dynamics = Dynamics::new(&model, model.values());
    let mut series = vec![commanded([0.0; 10]); 200];
    series[1..].fill(commanded(COMMANDED));
    dynamics.drive(0.1, &mut series);
    // A unit ramp over the first sample, then constant: what is left after t is exp(-(t - dt/2)/tau) to second order.
    for k in [5, 20, 60] {
        let left = 1.0 - series[k].commands[0] / COMMANDED[0];
        let expected = (-(0.1 * k as f64 - 0.05) / 2.0).exp();
        assert!((left - expected).abs() < 1e-3, "{left} {expected}");
        assert_eq!((series[k].commands[1], series[k].commands[4]), (COMMANDED[1], COMMANDED[4]));
    }
}

#[test]
fn what_a_model_says_of_an_actuator_is_written_and_read_again() {
    let text = "name = \"m\"\nform = \"general\"\nhull = \"free\"\nterms = [\"current\"]\n[parameters]\n\
                \"port.gain\" = { value = 0.7, prior = { mean = 0.5, sd = 0.2 } }\n\"tau.gain_n\" = { free = false }\n\
                \"port.loss\" = { prior = \"default\" }\n";
    let model = Model::parse(text, Path::new("model.toml"), ship(ACTUATORS)).unwrap();
    let free: Vec<&str> = model.free().into_iter().map(|i| model.parameters[i].name.as_str()).collect();
    for (name, wanted) in [
        ("port.gain", true),
        ("port.loss", true),
        ("starboard.loss", false),
        ("tau.gain_x", true),
        ("tau.gain_n", false),
        ("tau.lag", true),
        ("tunnel.lag", false),
        ("hull.Yvdot", true),
        ("hull.mass", false),
        ("general_hull.bow_square", true),
        ("rudder.lift1", false),
    ] {
        assert_eq!(free.contains(&name), wanted, "{name}");
    }
    assert_eq!(model.parameters[model.index("tunnel.lag").unwrap()].value, 0.7);
    assert_eq!(model.parameters[model.index("port.astern").unwrap()].value, 0.6);
    assert_eq!(model.further_terms(), ["current"]);
    let written = toml::to_string(&model.to_file()).unwrap();
    let again = Model::from_file(&toml::from_str::<ModelFile>(&written).unwrap(), ship(ACTUATORS)).unwrap();
    assert_eq!(format!("{:?}", model.parameters), format!("{:?}", again.parameters));
    let taken = ship("[[actuator]]\nname = \"rudder\"\nlaw = \"order\"\n");
    let error = Model::new(taken, "m", Form::General, &[]).unwrap_err().to_string();
    assert!(error.contains("`rudder`") && error.contains("another name"), "{error}");
}

#[test]
fn a_value_that_the_ship_file_gives_otherwise_is_written_though_it_is_a_default() {
    let mut model = Model::new(ship(ACTUATORS), "m", Form::General, &[]).unwrap();
    let astern = model.index("port.astern").unwrap();
    assert_eq!(model.parameters[astern].value, 0.6);
    // As without a ship file's value: a reader would take the file's.
    model.parameters[astern].value = 1.0;
    let again = Model::from_file(&model.to_file(), ship(ACTUATORS)).unwrap();
    assert_eq!(again.parameters[astern].value, 1.0);
}

#[test]
fn a_recording_has_the_channels_of_its_actuators_by_name_and_a_simulation_in_the_order_of_the_ship() {
    let text =
        "t [s],x [m],y [m],psi [deg],left [rpm],a,tau.X [kN]\n0,0,0,0,60,350,1\n1,0,0,0,120,10,2\n2,0,0,0,120,20,2\n";
    let map = "[columns]\n\"port.rate\" = \"left\"\n\"port.angle\" = { column = \"a\", unit = \"deg\" }\n";
    let craft = ship(
        "[[actuator]]\nname = \"tau\"\nlaw = \"force\"\ncomponents = [\"X\"]\n[[actuator]]\nname = \"port\"\nlaw = \"thruster\"\n",
    );
    let mut map = ColumnMap::parse(map, Path::new("columns.toml")).unwrap();
    map.driven = trimtab::recording::Driven::of(&craft);
    let recording = Recording::parse(text, Path::new("run.csv"), &map).unwrap();
    let of = |name: &str| recording.get(Channel::from_name(name).unwrap()).unwrap().to_vec();
    assert_eq!((of("port.rate"), of("tau.X")), (vec![1.0, 2.0, 2.0], vec![1e3, 2e3, 2e3]));
    assert!((of("port.angle")[1] - 370_f64.to_radians()).abs() < 1e-12, "an angle is unwrapped");
    let mut settings = trimtab::WindowSettings::whole(craft.hull.draught);
    settings.driven = map.driven.clone();
    let labels =
        trimtab::Labels { run: "run".into(), session: "s".into(), manoeuvre: "m".into(), split: trimtab::Split::Train };
    let run = recording.windows(&labels, &settings).unwrap().windows.remove(0);
    let mut expected = [0.0; COMMANDS];
    (expected[0], expected[1], expected[2]) = (2e3, 2.0, 370_f64.to_radians());
    assert_eq!(run.inputs[1].commands, expected);
    // What was ordered stands for what was not fed back, and beside it is kept and drives nothing.
    let ordered = text.replace("left [rpm]", "port.rate_order [rpm]");
    let both = text
        .replace("t [s]", "t [s],port.rate_order [rpm]")
        .replace("\n0,", "\n0,6,")
        .replace("\n1,", "\n1,6,")
        .replace("\n2,", "\n2,6,");
    for (text, drops) in [(ordered, true), (both, false)] {
        let mut map = map.clone();
        if drops {
            map = ColumnMap::parse(
                "[columns]\n\"port.angle\" = { column = \"a\", unit = \"deg\" }\n",
                Path::new("columns.toml"),
            )
            .unwrap();
            map.driven = trimtab::recording::Driven::of(&craft);
        }
        let recording = Recording::parse(&text, Path::new("run.csv"), &map).unwrap();
        assert!(recording.get(Channel::from_name("port.rate_order").unwrap()).is_some());
        let run = recording.windows(&labels, &settings).unwrap().windows.remove(0);
        assert_eq!(run.inputs[1].commands, expected);
    }
    let absent = Recording::parse("t [s],x [m]\n0,0\n1,0\n", Path::new("run.csv"), &map).unwrap_err().to_string();
    assert!(absent.contains("[columns] \"port.angle\" = "), "{absent}");
}

#[test]
fn a_craft_without_actuators_is_simulated_in_current_and_still_water() {
    let model = Model::new(ship(""), "drifter", Form::General, &["current"]).unwrap();
    let inputs = vec![Inputs { current: [0.3, 0.2], ..Inputs::actuators(0.0, 0.0, 0.0) }; 3000];
    let scenario = Scenario { dt: 0.2, inputs, initial: [0.0; STATES] };
    let run = simulate(&model, &model.values(), Integration::default(), &scenario);
    let [_, _, psi, u, v, _] = *run.states.last().unwrap();
    let over_ground = [u * psi.cos() - v * psi.sin(), u * psi.sin() + v * psi.cos()];
    assert!((over_ground[0] - 0.3).abs() < 0.02 && (over_ground[1] - 0.2).abs() < 0.02, "{over_ground:?}");
}
