//! Laws of the motion as a whole: order of the integrators, uniform current, energy, and signs known from seamanship.
//! Laws of single terms are asserted over the catalogue in `catalogue.rs`.

use std::f64::consts::PI;
use std::path::Path;
use trimtab::model::dynamics::Dynamics;
use trimtab::model::{Model, ModelError};
use trimtab::physics::{Form, Gradient};
use trimtab::ship::Ship;
use trimtab::ship::state::{Force, Inputs, STATES, State};
use trimtab::simulate::{Integration, Method, Scenario, simulate};
use trimtab::terms::hydrodynamics::crossflow::strip_integrals;

fn ship(letter: &str) -> Ship {
    let path = format!("{}/experiments/ships/{letter}.toml", env!("CARGO_MANIFEST_DIR"));
    Ship::read(Path::new(&path)).unwrap()
}

/// A model of ship A with extra terms and parameter values.
fn model(form: Form, terms: &[&str], values: &[(&str, f64)]) -> Model {
    let mut model = Model::new(ship("a"), "laws", form, terms).unwrap();
    model.set(values).unwrap();
    model
}

fn rates(model: &Model, state: [f64; STATES], inputs: &Inputs<f64>) -> [f64; STATES] {
    Dynamics::new(model, model.values()).rates(&State::from_array(state), inputs, &Force::zero()).0
}

/// The force of one term at a state.
fn force_of(model: &Model, term: &str, state: [f64; STATES], inputs: &Inputs<f64>) -> Force<f64> {
    let all = Dynamics::new(model, model.values()).contributions(&State::from_array(state), inputs);
    all.iter().find(|(name, _)| *name == term).unwrap().1
}

/// A turn to starboard with changing rudder and rpm, linear between samples. Drift keeps its sign: where it crosses zero,
/// the rounded |v| is sharper than any step here.
fn manoeuvre() -> Scenario {
    let inputs = (0..=20)
        .map(|k| {
            let t = 6.0 * f64::from(k);
            Inputs::actuators(t, 3.0 + 0.4 * (0.05 * t).sin(), 0.25 + 0.1 * (0.04 * t).sin())
        })
        .collect();
    Scenario { dt: 6.0, inputs, initial: [0.0, 0.0, 0.4, 6.0, -0.4, 0.006] }
}

fn end(model: &Model, method: Method, substeps: usize, scenario: &Scenario) -> [f64; STATES] {
    let t = simulate(model, &model.values(), Integration { method, substeps }, scenario);
    assert!(t.diverged_at.is_none());
    t.states[t.states.len() - 1]
}

fn distance(a: &[f64; STATES], b: &[f64; STATES]) -> f64 {
    let sizes = [100.0, 100.0, 1.0, 1.0, 1.0, 0.01];
    (0..STATES).map(|i| ((a[i] - b[i]) / sizes[i]).powi(2)).sum::<f64>().sqrt()
}

#[test]
fn euler_converges_with_order_one_and_rk4_with_order_four() {
    let terms = ["current", "wind", "crossflow", "roll"];
    let values =
        [("current.north", 0.4), ("wind.side", 0.8), ("crossflow.drag", 0.3), ("roll.yaw", 0.2), ("rudder.lift1", 2.0)];
    // Rudder and engine with a lag move between samples, and not linearly.
    let lags = [("rudder_lag.time", 3.0), ("engine_lag.time", 8.0)];
    let prompt = model(Form::Paper, &terms, &values);
    let late =
        model(Form::Paper, &[&terms[..], &["rudder_lag", "engine_lag"]].concat(), &[&values[..], &lags].concat());
    let scenario = manoeuvre();
    for m in [prompt, late] {
        let exact = end(&m, Method::Rk4, 256, &scenario);
        for (method, counts, order) in [(Method::Euler, [32, 64, 128], 1.0), (Method::Rk4, [8, 16, 32], 4.0)] {
            let errors = counts.map(|n| distance(&end(&m, method, n, &scenario), &exact));
            for pair in errors.windows(2) {
                let found = (pair[0] / pair[1]).log2();
                println!("{method:?}: error {:.2e} -> {:.2e}, order {found:.2}", pair[0], pair[1]);
                assert!((found - order).abs() < 0.3, "{method:?}: order {found} (errors {errors:?})");
            }
        }
    }
}

#[test]
fn a_uniform_current_adds_only_its_own_turning_in_body_axes() {
    let calm = model(Form::Paper, &[], &[]);
    let set = [("current.north", 0.7), ("current.east", -0.4)];
    let moving = model(Form::Paper, &["current"], &set);
    let inputs = Inputs::actuators(0.0, 2.5, 0.3);
    for psi in [0.0, 1.0, 2.5, -2.0] {
        for (u, v, r) in [(5.0, 0.7, -0.02), (-1.0, 0.3, 0.01), (0.0, 0.0, 0.0)] {
            let (sin, cos) = f64::sin_cos(psi);
            let (along, across) = (0.7 * cos - 0.4 * sin, -0.4 * cos - 0.7 * sin);
            let still = rates(&calm, [0.0, 0.0, psi, u, v, r], &inputs);
            let found = rates(&moving, [0.0, 0.0, psi, u + along, v + across, r], &inputs);
            let recorded = Inputs { current: [0.7, -0.4], ..inputs };
            let expected = [still[0] + 0.7, still[1] - 0.4, r, still[3] + across * r, still[4] - along * r, still[5]];
            for i in 0..STATES {
                assert!((found[i] - expected[i]).abs() < 1e-14, "rate {i}: {} {}", found[i], expected[i]);
            }
            // A recorded current acts alike.
            assert_eq!(rates(&calm, [0.0, 0.0, psi, u + along, v + across, r], &recorded), found);
        }
    }
}

#[test]
fn a_trajectory_in_a_uniform_current_is_the_calm_one_seen_from_a_drifting_frame() {
    let calm = model(Form::Paper, &[], &[("rudder.lift1", 2.0)]);
    let set = [("current.north", 0.5), ("current.east", 0.8), ("rudder.lift1", 2.0)];
    let moving = model(Form::Paper, &["current"], &set);
    let scenario = manoeuvre();
    let mut carried = scenario.clone();
    let (sin, cos) = scenario.initial[2].sin_cos();
    carried.initial[3] += 0.5 * cos + 0.8 * sin;
    carried.initial[4] += 0.8 * cos - 0.5 * sin;
    let still = end(&calm, Method::Rk4, 64, &scenario);
    let found = end(&moving, Method::Rk4, 64, &carried);
    let (sin, cos) = still[2].sin_cos();
    let expected = [
        still[0] + 0.5 * 120.0,
        still[1] + 0.8 * 120.0,
        still[2],
        still[3] + 0.5 * cos + 0.8 * sin,
        still[4] + 0.8 * cos - 0.5 * sin,
        still[5],
    ];
    let apart = distance(&found, &expected);
    assert!(apart < 1e-9, "{apart:e} apart: {found:?} {expected:?}");
}

#[test]
fn hull_and_resistance_take_energy_out_of_every_motion() {
    for (letter, form) in [("a", Form::Paper), ("b", Form::Paper), ("a", Form::Regular), ("b", Form::Regular)] {
        let m = Model::new(ship(letter), "energy", form, &[]).unwrap();
        let inputs = Inputs::actuators(0.0, 0.0, 0.0);
        for speed in [0.5, 2.0, 6.0] {
            for drift in (-170..=180).step_by(10) {
                for turn in [-0.6, -0.3, -0.1, 0.0, 0.1, 0.3, 0.6] {
                    let (sin, cos) = f64::from(drift).to_radians().sin_cos();
                    let (u, v, r) = (speed * cos, -speed * sin, turn * speed / m.ship.hull.lpp);
                    let state = [0.0, 0.0, 0.0, u, v, r];
                    let power = |term| {
                        let f = force_of(&m, term, state, &inputs);
                        f.x * u + f.y * v + f.n * r
                    };
                    let what = format!("ship {letter}, {form:?}, U {speed}, drift {drift} deg, r' {turn}");
                    if sin.abs() > 0.01 || turn != 0.0 {
                        assert!(power("hull") < 0.0, "{what}: {:e} W", power("hull"));
                    }
                    assert!(power("resistance") < 0.0, "{what}: {:e} W", power("resistance"));
                }
            }
        }
    }
}

#[test]
fn both_forms_agree_ahead_at_small_drift_and_the_sternway_term_leads_from_one_to_the_other() {
    let paper = model(Form::Paper, &["sternway"], &[]);
    let regular = model(Form::Regular, &["sternway"], &[]);
    let all = model(Form::Paper, &["sternway"], &[("sternway.share", 1.0)]);
    let inputs = Inputs::actuators(0.0, 2.5, 0.1);
    for u in [3.0, 6.0] {
        let variables = [0.0, 0.0, 0.0, u, 0.0, 0.0].map(Gradient::constant);
        let variables: [Gradient; STATES] =
            std::array::from_fn(|i| if i > 2 { Gradient::variable(variables[i].re, i) } else { variables[i] });
        let of = |m: &Model| {
            let theta: Vec<Gradient> = m.values().iter().map(|x| Gradient::constant(*x)).collect();
            Dynamics::new(m, theta).rates(&State::from_array(variables), &Inputs::constant(&inputs), &Force::zero()).0
        };
        let (a, b) = (of(&paper), of(&regular));
        for i in 3..STATES {
            assert_eq!(a[i].re, b[i].re, "rate {i} at u = {u}");
            for j in 3..STATES {
                // The only difference is U = sqrt(u^2 + small^2) for u.
                let close = 1e-3 * (a[i].eps[j].abs() + b[i].eps[j].abs());
                assert!((a[i].eps[j] - b[i].eps[j]).abs() <= close, "d rate {i} / d {j} at u = {u}");
            }
        }
    }
    for state in [[0.0, 0.0, 0.0, -3.0, 0.5, 0.01], [0.0, 0.0, 0.0, 0.2, -1.5, 0.02]] {
        assert_ne!(rates(&paper, state, &inputs), rates(&regular, state, &inputs));
        assert_eq!(rates(&all, state, &inputs), rates(&regular, state, &inputs));
    }
}

#[test]
fn the_regular_form_is_fore_aft_symmetric_without_yaw_rate() {
    let m = model(Form::Regular, &[], &[]);
    let inputs = Inputs::actuators(0.0, 0.0, 0.0);
    for (u, v) in [(2.0, 0.0), (2.0, 0.4), (0.5, -1.0)] {
        let ahead = [
            force_of(&m, "hull", [0.0, 0.0, 0.0, u, v, 0.0], &inputs),
            force_of(&m, "resistance", [0.0, 0.0, 0.0, u, v, 0.0], &inputs),
        ];
        let astern = [
            force_of(&m, "hull", [0.0, 0.0, 0.0, -u, v, 0.0], &inputs),
            force_of(&m, "resistance", [0.0, 0.0, 0.0, -u, v, 0.0], &inputs),
        ];
        assert!(ahead[1].x < 0.0 && astern[1].x == -ahead[1].x, "resistance opposes the motion");
        let same = |a: f64, b: f64| (a - b).abs() <= 1e-14 * a.abs();
        assert!(same(ahead[0].y, astern[0].y), "damping of drift does not care which way the ship moves along");
        assert!(same(ahead[0].n, -astern[0].n), "the Munk-type moment turns with the direction of motion");
    }
}

#[test]
fn a_mass_matrix_that_cannot_be_inverted_is_refused_with_advice() {
    let mut m = model(Form::Paper, &["loading"], &[]);
    let found = m.set(&[("hull.Nrdot", 1e12)]);
    let Err(error @ ModelError::SingularMass { .. }) = found else { panic!("{found:?}") };
    assert!(error.to_string().contains("Nrdot"), "{error}");
    let mut m = model(Form::Paper, &[], &[]);
    assert!(matches!(m.set(&[("hull.Yrdot", 1e9), ("hull.Nvdot", 1e9)]), Err(ModelError::SingularMass { .. })));
    let mut m = model(Form::Paper, &[], &[]);
    assert!(matches!(m.set(&[("hull.Xudot", 1e9)]), Err(ModelError::SingularMass { .. })));
}

#[test]
fn strip_integrals_are_those_of_a_fine_quadrature() {
    for (a, b) in [(1.0, 0.3), (-1.0, 0.3), (0.3, 1.0), (0.3, -1.0), (-0.3, -1.0), (0.5, 0.5), (0.0, 2.0), (2.0, 0.0)] {
        let count = 20_000;
        let mut sums = [0.0, 0.0];
        for i in 0..count {
            let s = -1.0 + (2.0 * f64::from(i) + 1.0) / f64::from(count);
            let w = a + b * s;
            sums[0] += w.abs() * w * 2.0 / f64::from(count);
            sums[1] += w.abs() * w * s * 2.0 / f64::from(count);
        }
        let found = strip_integrals(a, b);
        for i in 0..2 {
            assert!((found[i] - sums[i]).abs() < 1e-7, "a {a}, b {b}: {found:?}, quadrature {sums:?}");
        }
    }
}

#[test]
fn cross_flow_drag_weighs_the_yaw_rate_separately_in_force_and_moment() {
    let of = |turn: [f64; 2], r: f64| {
        let set = [("crossflow.drag", 1.0), ("crossflow.turn_force", turn[0]), ("crossflow.turn_moment", turn[1])];
        let m = model(Form::Paper, &["crossflow"], &set);
        force_of(&m, "crossflow", [0.0, 0.0, 0.0, 5.0, -0.6, r], &Inputs::actuators(0.0, 2.0, 0.0))
    };
    // The weights that were measured on Esso Osaka: each is the plain drag at a yaw rate of its own.
    let found = of([2.217, 0.8097], 0.01);
    let (force, moment) = (of([1.0, 1.0], 0.02217).y, of([1.0, 1.0], 0.008097).n);
    assert!(force.abs() > 1.0 && (found.y / force - 1.0).abs() < 1e-12, "{} {force}", found.y);
    assert!(moment.abs() > 1.0 && (found.n / moment - 1.0).abs() < 1e-12, "{} {moment}", found.n);
    assert_eq!(found.x, 0.0);
}

fn driven(m: &Model, dt: f64, orders: &[f64]) -> Vec<f64> {
    let mut series: Vec<Inputs<f64>> =
        orders.iter().enumerate().map(|(k, d)| Inputs::actuators(dt * k as f64, 0.0, *d)).collect();
    Dynamics::new(m, m.values()).drive(dt, &mut series);
    series.iter().map(|i| i.delta).collect()
}

#[test]
fn a_first_order_lag_is_exact_for_ramps_at_any_sample_period() {
    let tau = 2.5;
    let m = model(Form::Paper, &["rudder_lag"], &[("rudder_lag.time", tau)]);
    for dt in [0.5, 2.0, 8.0] {
        let slope = 0.01;
        let orders: Vec<f64> = (0..30).map(|k| slope * dt * f64::from(k)).collect();
        for (k, found) in driven(&m, dt, &orders).iter().enumerate() {
            let t = dt * k as f64;
            let exact = slope * (t - tau * (1.0 - (-t / tau).exp()));
            assert!((found - exact).abs() < 1e-14, "dt {dt}, t {t}: {found} {exact}");
        }
    }
}

#[test]
fn a_rate_limited_rudder_never_exceeds_its_rate_and_arrives() {
    let rate = 0.04;
    let m = model(Form::Paper, &["rudder_rate"], &[("rudder_rate.inverse", 1.0 / rate)]);
    let mut orders = vec![0.0];
    orders.extend([0.6; 30]);
    orders.extend([-0.6; 45]);
    let angles = driven(&m, 1.0, &orders);
    assert!(angles.windows(2).all(|w| (w[1] - w[0]).abs() <= rate * (1.0 + 1e-12)));
    assert!((angles[5] - 5.0 * rate).abs() < 1e-3, "{angles:?}");
    assert!((angles[30] - 0.6).abs() < 1e-6 && (angles[75] + 0.6).abs() < 1e-6, "{angles:?}");
}

#[test]
fn wind_pushes_to_leeward_and_measured_and_unmeasured_wind_have_equal_loads() {
    let m = model(Form::Paper, &["wind"], &[("wind.drag", 0.7), ("wind.side", 0.8), ("wind.yaw", 0.1)]);
    let guess =
        |north, east| model(Form::Paper, &["mean_wind"], &[("mean_wind.north", north), ("mean_wind.east", east)]);
    let blowing = |north, east| Inputs { wind: [north, east], ..Inputs::actuators(0.0, 0.0, 0.0) };
    let at_rest = [0.0; STATES];
    assert!(force_of(&m, "wind", at_rest, &blowing(-8.0, 0.0)).x < 0.0, "a head wind pushes astern");
    let beam = force_of(&m, "wind", at_rest, &blowing(0.0, 8.0));
    assert!(beam.y > 0.0 && beam.n.abs() < 1.0, "a beam wind from port pushes to starboard: {beam:?}");
    // 1/2 1.225 64 0.8 780 N.
    assert!((beam.y - 24_461.0).abs() < 20.0, "{beam:?}");
    // Off the port bow, the wind turns the bow away from it: to starboard.
    assert!(force_of(&m, "wind", at_rest, &blowing(-6.0, 6.0)).n > 0.0);
    for state in [at_rest, [0.0, 0.0, 1.2, 5.0, -0.4, 0.01]] {
        let calm = Inputs::actuators(0.0, 0.0, 0.0);
        let expected = force_of(&m, "wind", state, &blowing(5.0, -7.0));
        assert_eq!(force_of(&guess(5.0, -7.0), "mean_wind", state, &calm), expected);
        assert_eq!(force_of(&m, "wind", state, &calm), Force::zero(), "still air is part of the resistance");
    }
}

#[test]
fn forces_have_the_signs_known_from_seamanship() {
    let rest = [0.0; STATES];
    let ahead = [0.0, 0.0, 0.0, 5.0, 0.0, 0.0];
    let astern_rpm = Inputs::actuators(0.0, -2.0, 0.0);
    // A right-handed propeller turning astern pulls the stern to port and the bow to starboard.
    let m = model(Form::Paper, &["propeller_walk"], &[("propeller_walk.astern", -0.03)]);
    let walk = force_of(&m, "propeller_walk", rest, &astern_rpm);
    assert!(walk.y < 0.0 && walk.n > 0.0, "{walk:?}");
    assert_eq!(force_of(&m, "propeller_walk", rest, &Inputs::actuators(0.0, 2.0, 0.0)), Force::zero());
    // Near a bank to starboard the ship is drawn to it and its bow turns away.
    let m = model(Form::Paper, &["bank"], &[("bank.suction", 0.1), ("bank.moment", 0.03)]);
    let near = Inputs { bank: 1.0 / 20.0 - 1.0 / 60.0, ..Inputs::actuators(0.0, 2.0, 0.0) };
    let bank = force_of(&m, "bank", ahead, &near);
    assert!(bank.y > 0.0 && bank.n < 0.0, "{bank:?}");
    // A bow thruster to starboard turns the bow to starboard, less so with speed.
    let m = model(Form::Paper, &["thruster"], &[("thruster.gain", 1.0)]);
    let full = Inputs { thruster: 1.0, ..Inputs::actuators(0.0, 0.0, 0.0) };
    let (still, moving) = (force_of(&m, "thruster", rest, &full), force_of(&m, "thruster", ahead, &full));
    assert!(still.y > 0.0 && still.n > 0.0 && moving.n < 0.2 * still.n, "{still:?} {moving:?}");
    // Waves travelling north push a ship that heads east to its port side.
    let m = model(Form::Paper, &["waves"], &[("waves.side", 0.8)]);
    let sea = Inputs { waves: [1.0, 0.0], ..Inputs::actuators(0.0, 0.0, 0.0) };
    assert!(force_of(&m, "waves", [0.0, 0.0, 0.5 * PI, 0.0, 0.0, 0.0], &sea).y < 0.0);
    // Shallow water makes the ship turn wider: more yaw damping than deep water, and more resistance.
    let deep = model(Form::Paper, &[], &[]);
    let shallow = model(Form::Paper, &["shallow"], &[("shallow.ratio", 1.0)]);
    let n = |m: &Model| force_of(m, "hull", [0.0, 0.0, 0.0, 1e-6, 0.0, 0.02], &astern_rpm).n;
    assert!(n(&shallow) < n(&deep) && n(&deep) < 0.0);
    let x = |m: &Model| force_of(m, "resistance", ahead, &astern_rpm).x;
    assert!((x(&shallow) / x(&deep) - 1.15).abs() < 1e-12);
    // A recorded depth of twice the draught is a ratio of one.
    let recorded = model(Form::Paper, &["shallow"], &[("shallow.strength", 1.0)]);
    let half = Inputs { draught_to_depth: 0.5, ..astern_rpm };
    assert_eq!(rates(&recorded, ahead, &half), rates(&shallow, ahead, &astern_rpm));
}

#[test]
fn a_lagged_heel_follows_the_yaw_rate_of_some_seconds_before() {
    // With r' given, Y and N = c U^3 (r - tau r') moved to the side of the inertia must give back r'.
    let values = [("roll.yaw", 0.3), ("roll.lag", 4.0)];
    let with = model(Form::Paper, &["roll"], &values);
    let without = model(Form::Paper, &[], &[]);
    let inputs = Inputs::actuators(0.0, 3.0, 0.2);
    let state = [0.0, 0.0, 0.0, 6.0, -0.3, 0.01];
    let rate = rates(&with, state, &inputs);
    let cause = force_of(&with, "roll", state, &inputs);
    assert!((cause.y / cause.n * with.ship.hull.lpp - 0.44).abs() < 1e-12);
    let lagged = 1.0 - 4.0 * rate[5] / state[5];
    let push = Force { x: 0.0, y: cause.y * lagged, n: cause.n * lagged };
    let expected = Dynamics::new(&without, without.values()).rates(&State::from_array(state), &inputs, &push).0;
    for i in 3..STATES {
        assert!((rate[i] - expected[i]).abs() < 1e-12, "rate {i}: {} {}", rate[i], expected[i]);
    }
}

#[test]
fn a_late_channel_reports_an_earlier_time_to_third_order_in_the_delay_for_positions_and_heading_and_second_order_for_rates()
 {
    let late = model(Form::Paper, &["time_skew", "current"], &[("current.north", 0.3), ("current.east", -0.2)]);
    let scenario = Scenario {
        dt: 1.0,
        inputs: (0..=60).map(|k| Inputs::actuators(f64::from(k), 3.0, 0.3)).collect(),
        initial: [0.0, 0.0, 0.4, 6.0, -0.4, 0.006],
    };
    let sailed = simulate(&late, &late.values(), Integration { method: Method::Rk4, substeps: 4 }, &scenario).states;
    let error = |delay: usize| {
        let mut late = late.clone();
        let delays = ["position", "heading", "velocity", "yaw_rate"].map(|c| (format!("time_skew.{c}"), delay as f64));
        late.set(&delays.each_ref().map(|(name, d)| (name.as_str(), *d))).unwrap();
        let reported = Dynamics::new(&late, late.values()).report(&sailed[40], &scenario.inputs[40]);
        std::array::from_fn::<f64, STATES, _>(|i| (reported[i] - sailed[40 - delay][i]).abs())
    };
    let (long, short) = (error(8), error(4));
    for (i, order) in [3, 3, 3, 2, 2, 2].into_iter().enumerate() {
        let measured = (long[i] / short[i]).log2();
        assert!((measured - f64::from(order)).abs() < 0.5, "{i}: {measured}");
    }
}
