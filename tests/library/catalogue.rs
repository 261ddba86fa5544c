//! Laws of every term, asserted over the whole catalogue: a new term is tested as soon as it is listed.
//! Laws of the motion as a whole are in `laws.rs`; published numbers are in `reference.rs`.

use std::collections::BTreeSet;
use std::path::Path;
use trimtab::model::dynamics::Dynamics;
use trimtab::report::terms::{listing, summary};
use trimtab::simulate::sensitivity::{Column, Columns, Plain};
type Seeded = trimtab_ad::Dual<Lanes, FEW>;
use trimtab::model::{BASE, MMG, Model};
use trimtab::physics::{CHUNK, Curvature, FEW, Form, Gradient, Lanes, NumDual, Number, Reach};
use trimtab::ship::Ship;
use trimtab::ship::parameter::Parity;
use trimtab::ship::state::{Force, Inputs, STATES, State};
use trimtab::terms::CATALOGUE;
use trimtab_ad::Scalar;

fn ship() -> Ship {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/experiments/ships/a.toml");
    Ship::read(Path::new(path)).unwrap()
}

fn names() -> Vec<&'static str> {
    CATALOGUE.iter().map(|t| t.info().name).collect()
}

fn extras() -> Vec<&'static str> {
    names().into_iter().filter(|n| !BASE.contains(n)).collect()
}

/// The base model, in form `mmg` for a term of that form, and one term, every parameter of both moved off its default inside its bounds.
fn probed(term: &str) -> Model {
    let form = if MMG.contains(&term) { Form::Mmg } else { Form::Paper };
    let mut model = Model::new(ship(), "probe", form, &[term]).unwrap();
    for (i, p) in model.parameters.iter_mut().enumerate() {
        let step = p.scale * [0.6, -0.4, 0.9, -0.7, 0.5][i % 5];
        let moved = if (p.lower..=p.upper).contains(&(p.value + step)) { p.value + step } else { p.value - step };
        p.value = moved.clamp(p.lower, p.upper);
    }
    model
}

/// Entries of a point before the parameters: the state, then `t, n, delta, wind, current, waves, d/h, bank, thruster`.
const POINT: usize = STATES + 12;

/// Sizes of the entries of a point.
const SIZES: [f64; POINT] =
    [10.0, 10.0, 0.3, 1.0, 1.0, 0.01, 1.0, 1.0, 0.1, 5.0, 5.0, 0.3, 0.3, 0.5, 0.5, 0.1, 3e-3, 0.3];

/// A point in an environment where every channel differs from neutral.
fn point(u: f64, v: f64, r: f64, n: f64, delta: f64, psi: f64) -> [f64; POINT] {
    [120.0, -40.0, psi, u, v, r, 9.3, n, delta, 6.0, -3.5, 0.31, -0.22, 0.7, 0.4, 0.45, 4e-3, 0.6]
}

fn inputs_of<S: Scalar>(x: &[S]) -> Inputs<S> {
    let [t, n, delta, w0, w1, c0, c1, h0, h1, draught_to_depth, bank, thruster] =
        std::array::from_fn(|i| x[STATES + i]);
    let (wind, current, waves, neutral) = ([w0, w1], [c0, c1], [h0, h1], Inputs::actuators(0.0, 0.0, 0.0));
    Inputs { t, n, delta, wind, current, waves, draught_to_depth, bank, thruster, ..neutral }
}

/// All quantities a term can change: rates, sensor report and actuators, at a point `x` followed by the parameters. Actuators
/// reach the point through a short history, so that lags act, and go on after it.
const OUTPUTS: usize = 2 * STATES + 2;
fn outputs<S: Number<Coefficient = S>>(model: &Model, x: &[S]) -> [S; OUTPUTS] {
    let dynamics = Dynamics::new(model, x[POINT..].to_vec());
    let state = State::from_array(std::array::from_fn(|i| x[i]));
    let now = inputs_of(x);
    let shape = [0.2, -0.5, 0.4, 1.3, 0.8, 1.0, 0.7];
    let mut series: Vec<Inputs<S>> =
        shape.iter().map(|k| Inputs { n: now.n * *k, delta: now.delta * *k, ..now }).collect();
    dynamics.drive(2.0, &mut series);
    let driven = series[shape.len() - 2];
    let (rates, flow) = dynamics.rates(&state, &driven, &Force::zero());
    let reported = dynamics.measure(&state, &driven, &rates, &flow);
    std::array::from_fn(|i| match i {
        0..STATES => rates[i],
        STATES..12 => reported[i - STATES],
        12 => driven.n,
        _ => driven.delta,
    })
}

fn with_parameters(model: &Model, point: &[f64; POINT]) -> Vec<f64> {
    point.iter().copied().chain(model.values()).collect()
}

/// Moving at every drift angle in all four quadrants of speed and rpm, and at rest in every sense.
fn everywhere() -> Vec<[f64; POINT]> {
    let mut points = vec![[0.0; POINT]];
    for n in [-2.5, 0.0, 3.0] {
        for delta in [-0.6, 0.0, 0.6] {
            points.push(point(0.0, 0.0, 0.0, n, delta, 0.0));
            points.push(point(0.0, 0.0, 0.01, n, delta, 1.0));
            points.push(point(1e-9, -1e-9, 1e-12, n, delta, 1.0));
            for degrees in (0..=360).step_by(15) {
                let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
                points.push(point(4.0 * cos, -4.0 * sin, 0.02 * sin, n, delta, 0.1 * f64::from(degrees)));
            }
        }
    }
    // Also in a neutral environment, where inputs of zero must not be special.
    let calm = points.iter().map(|p| {
        let mut p = *p;
        p[STATES + 3..].fill(0.0);
        p
    });
    calm.chain(points.iter().copied()).collect()
}

/// Points away from the corners of the physics, in every quadrant of speed and rpm, at different times.
fn generic() -> [[f64; POINT]; 8] {
    let mut points = [
        point(5.0, 0.8, -0.01, 3.0, 0.2, 0.6),
        point(2.0, -1.5, 0.015, 2.0, -0.5, 2.1),
        point(-1.5, 0.6, 0.008, -2.0, 0.3, -1.0),
        point(3.0, -0.5, 0.004, -2.5, 0.1, 4.0),
        point(-1.0, 0.4, -0.006, 2.0, -0.2, 5.0),
        point(0.8, 1.7, 0.011, 1.0, -0.6, 1.2),
        point(6.5, -0.4, 0.02, 3.5, 0.55, -2.6),
        point(0.5, 0.35, -0.02, 2.5, 0.6, 0.2),
    ];
    for (k, p) in points.iter_mut().enumerate() {
        p[STATES] += 8.0 * k as f64;
    }
    points
}

fn gradient_variables(x: &[f64], first: usize) -> Vec<Gradient> {
    let variable = |(i, x): (usize, &f64)| match i.checked_sub(first) {
        Some(j) if j < CHUNK => Gradient::variable(*x, j),
        _ => Gradient::constant(*x),
    };
    x.iter().enumerate().map(variable).collect()
}

#[test]
fn names_are_unique_and_every_parameter_is_described() {
    let plain = |s: &str| {
        s.starts_with(|c: char| c.is_ascii_alphabetic())
            && s.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
            && !s.ends_with('_')
            && !s.contains("__")
    };
    let ship = ship();
    let mut seen = BTreeSet::new();
    for term in CATALOGUE {
        let info = term.info();
        assert!(plain(info.name) && info.name == info.name.to_lowercase(), "{} is not snake_case", info.name);
        assert!(seen.insert(info.name), "{} is listed twice", info.name);
        assert!(!info.title.is_empty() && !info.equation.is_empty() && !info.source.is_empty(), "{}", info.name);
        let mut parameters = BTreeSet::new();
        for p in info.parameters {
            let name = format!("{}.{}", info.name, p.name);
            assert!(plain(p.name), "{name}");
            assert!(parameters.insert(p.name), "{name} is listed twice");
            assert!(!p.unit.is_empty() && !p.about.is_empty() && !p.symbol.is_empty(), "{name} lacks words");
            let (default, scale, spread) = ((p.default)(&ship), (p.scale)(&ship), (p.spread)(&ship));
            assert!(default.is_finite(), "{name} has default {default}");
            assert!(p.lower <= default && default <= p.upper, "{name} = {default} is outside {}..{}", p.lower, p.upper);
            assert!(p.lower < p.upper, "{name}");
            assert!(scale.is_finite() && scale > 0.0, "{name} has scale {scale}");
            assert!(spread > 0.0, "{name} has prior sd {spread}");
            // The ship file gives the sense of rotation of the screw, and so the side of its side force.
            let handed = name == "propeller_walk.astern";
            if p.parity == Parity::Odd && !handed {
                assert_eq!(p.lower, -p.upper, "{name} is one-sided, so that its bounds must mirror");
            }
        }
    }
    assert!(BASE.iter().all(|b| seen.contains(b)));
}

#[test]
fn a_term_at_its_defaults_changes_no_bit() {
    let base = Model::new(ship(), "base", Form::Paper, &[]).unwrap();
    for term in extras() {
        let with = Model::new(ship(), "with", Form::Paper, &[term]).unwrap();
        assert!(with.values().len() > base.values().len(), "{term} has no parameters");
        for at in everywhere().iter().chain(&generic()) {
            let expected = outputs(&base, &with_parameters(&base, at));
            let found = outputs(&with, &with_parameters(&with, at));
            // Equal bits except for the sign of zero.
            assert_eq!(found, expected, "{term} at its defaults acts at {at:?}");
        }
    }
}

#[test]
fn every_parameter_has_an_effect_somewhere() {
    for term in names() {
        let model = probed(term);
        for (i, p) in model.parameters.iter().enumerate().filter(|(_, p)| p.name.starts_with(&format!("{term}."))) {
            let moved = |at: &[f64; POINT]| {
                let x = with_parameters(&model, at);
                let mut y = x.clone();
                y[POINT + i] += 1e-3 * p.scale;
                outputs(&model, &x) != outputs(&model, &y)
            };
            assert!(generic().iter().chain(&everywhere()).any(moved), "{} does nothing", p.name);
        }
    }
}

#[test]
fn every_term_is_finite_with_finite_derivatives_everywhere() {
    for term in names() {
        // At the probed values, and at the defaults, where a fit begins.
        let model = probed(term);
        let neutral = Model::new(ship(), "neutral", Form::Paper, &[term]).unwrap();
        let own: Vec<usize> = (0..model.parameters.len())
            .filter(|i| model.parameters[*i].name.starts_with(&format!("{term}.")))
            .collect();
        let starts = (0..POINT).chain(own.iter().map(|i| i + POINT)).step_by(CHUNK);
        for first in starts.collect::<Vec<_>>() {
            for at in everywhere() {
                for m in [&model, &neutral] {
                    let y = outputs(m, &gradient_variables(&with_parameters(m, &at), first));
                    for (i, y) in y.iter().enumerate() {
                        assert!(
                            y.re.is_finite() && y.eps.iter().all(|e| e.is_finite()),
                            "{term}: output {i} at {at:?} is {y:?}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn a_parameter_changes_rates_by_what_it_reaches_and_nothing_else() {
    let mut seen = BTreeSet::new();
    for term in names() {
        let model = probed(term);
        for (i, p) in model.parameters.iter().enumerate() {
            let (owner, _) = p.name.split_once('.').unwrap();
            let first = model.parameters.iter().position(|q| q.name.split('.').next() == Some(owner)).unwrap();
            if owner != term || trimtab::terms::find(term).unwrap().reach(i - first) == Reach::Anything {
                continue;
            }
            seen.insert(term);
            for at in generic() {
                let x = with_parameters(&model, &at);
                let y = outputs(&model, &gradient_variables(&x, POINT + i));
                // The same derivative by the term's own force, the masses or the inflow alone.
                let state: [f64; STATES] = std::array::from_fn(|j| at[j]);
                let inputs = inputs_of(&at);
                let dynamics = Dynamics::new(&model, x[POINT..].to_vec());
                let (local, flow) = f64::linearise(&dynamics, &state, &inputs, &Force::zero());
                let columns = Columns::new(&model, &[Column { parameter: i, scale: 1.0 }]);
                let mut rates = [[0.0; 3]];
                columns.by_force(&dynamics, &columns.constants(&dynamics), &local, &flow, &state, &inputs, &mut rates);
                let [rates] = rates;
                let expected = |o: usize| if (3..6).contains(&o) { rates[o - 3] } else { 0.0 };
                for (o, y) in y.iter().enumerate().filter(|(o, _)| !(STATES..12).contains(o)) {
                    let scale = y.eps[0].abs().max(expected(o).abs()).max(1e-12);
                    assert!((y.eps[0] - expected(o)).abs() < 1e-9 * scale, "{}: output {o} at {at:?}", p.name);
                }
            }
        }
    }
    assert!(seen.len() > 15 && seen.contains("hull") && seen.contains("flow") && !seen.contains("current"), "{seen:?}");
}

#[test]
fn derivatives_are_those_of_central_differences_and_of_num_dual() {
    for term in names() {
        let model = probed(term);
        for at in generic() {
            let x = with_parameters(&model, &at);
            let size = |i: usize| if i < POINT { SIZES[i] } else { model.parameters[i - POINT].scale };
            let value = outputs(&model, &x);
            for first in (0..x.len()).step_by(CHUNK) {
                let duals = outputs(&model, &gradient_variables(&x, first));
                let oracle: Vec<NumDual> = x
                    .iter()
                    .enumerate()
                    .map(|(i, x)| match i.checked_sub(first) {
                        Some(j) if j < CHUNK => NumDual::from_re(*x).derivative(j),
                        _ => NumDual::from_re(*x),
                    })
                    .collect();
                let oracle = outputs(&model, &oracle);
                for j in 0..CHUNK.min(x.len() - first) {
                    let i = first + j;
                    let h = 1e-3 * size(i);
                    let shifted = |k: f64| {
                        let mut x = x.clone();
                        x[i] += k * h;
                        outputs(&model, &x)
                    };
                    let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(shifted);
                    for o in 0..OUTPUTS {
                        let what = || {
                            let name =
                                if i < POINT { format!("input {i}") } else { model.parameters[i - POINT].name.clone() };
                            format!("{term}: d output {o} / d {name} at {at:?}")
                        };
                        let theirs = oracle[o].eps.0.map_or(0.0, |m| m[(j, 0)]);
                        let ours = duals[o].eps[j];
                        assert!((duals[o].re - value[o]).abs() <= 1e-13 * value[o].abs(), "{}", what());
                        let close = 1e-10 * (ours.abs() + value[o].abs() / size(i)) + 1e-18 / size(i);
                        assert!((ours - theirs).abs() <= close, "{}: {ours:e}, num-dual {theirs:e}", what());
                        let difference = (a[o] - d[o] + 8.0 * (c[o] - b[o])) / (12.0 * h);
                        let close = 1e-6 * ours.abs() + 1e-9 * (value[o].abs() + 1e-3) / size(i);
                        assert!(
                            (ours - difference).abs() <= close,
                            "{}: {ours:e}, central difference {difference:e}",
                            what()
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn eight_lanes_and_nested_duals_give_the_same_numbers() {
    let close = |a: f64, b: f64, size: f64| (a - b).abs() <= 1e-11 * (size + b.abs()) + 1e-15;
    for term in names() {
        let model = probed(term);
        let points = generic().map(|at| with_parameters(&model, &at));
        let lanes: Vec<Lanes> = (0..points[0].len()).map(|i| Lanes::from_fn(|lane| points[lane][i])).collect();
        let values = outputs(&model, &lanes);
        for first in (0..lanes.len()).step_by(FEW) {
            let variables: Vec<Seeded> = lanes
                .iter()
                .enumerate()
                .map(|(i, x)| match i.checked_sub(first) {
                    Some(j) if j < FEW => Seeded::variable(*x, j),
                    _ => Seeded::constant(*x),
                })
                .collect();
            let found = outputs(&model, &variables);
            for (lane, x) in points.iter().enumerate().take(Lanes::LANES) {
                let expected = outputs(&model, &gradient_variables(x, first));
                for o in 0..OUTPUTS {
                    let scale = expected[o].re.abs();
                    let what = format!("{term}: output {o}, lane {lane}");
                    assert!(close(values[o].lane(lane), expected[o].re, 0.0), "{what}");
                    assert!(close(found[o].re.lane(lane), expected[o].re, 0.0), "{what}");
                    for j in 0..FEW {
                        let i = (first + j).min(x.len() - 1);
                        let size = if i < POINT { SIZES[i] } else { model.parameters[i - POINT].scale };
                        let (a, b) = (found[o].eps[j].lane(lane) * size, expected[o].eps[j] * size);
                        assert!(close(a, b, scale), "{what}, derivative {i}: {a:e}, {b:e}");
                    }
                }
            }
        }
        // Second derivatives: rates of the first along one variable more.
        let x = &points[0];
        let own = model.parameters.iter().position(|p| p.name.starts_with(&format!("{term}."))).unwrap();
        for (i, j) in [(3, 4), (4, 5), (4, POINT + own)] {
            let nested: Vec<Curvature> = x
                .iter()
                .enumerate()
                .map(|(k, x)| {
                    let inner = |x: f64| trimtab_ad::Dual {
                        re: x,
                        eps: std::array::from_fn(|e| if e == 0 && k == i { 1.0 } else { 0.0 }),
                    };
                    let mut outer = Curvature::constant(inner(*x));
                    if k == j {
                        outer.eps[0] = trimtab_ad::Dual::constant(1.0);
                    }
                    outer
                })
                .collect();
            let found = outputs(&model, &nested);
            let size = if j < POINT { SIZES[j] } else { model.parameters[j - POINT].scale };
            let h = 1e-3 * size;
            let first_at = |k: f64| {
                let mut x = x.clone();
                x[j] += k * h;
                outputs(&model, &gradient_variables(&x, i)).map(|y| y.eps[0])
            };
            let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(first_at);
            for o in 0..OUTPUTS {
                let difference = (a[o] - d[o] + 8.0 * (c[o] - b[o])) / (12.0 * h);
                let second = found[o].eps[0].eps[0];
                let close = 1e-5 * second.abs() + 1e-8 * (found[o].re.eps[0].abs() + 1e-3) / size;
                assert!(
                    (second - difference).abs() <= close,
                    "{term}: d2 output {o} / d {i} d {j}: {second:e} {difference:e}"
                );
            }
        }
    }
}

/// The mirror image of a point: port and starboard swapped.
fn mirrored(x: &[f64], model: &Model) -> Vec<f64> {
    let odd = [1, 2, 4, 5, STATES + 2, STATES + 4, STATES + 6, STATES + 8, STATES + 10, STATES + 11];
    x.iter()
        .enumerate()
        .map(|(i, x)| {
            let turns =
                if i < POINT { odd.contains(&i) } else { model.parameters[i - POINT].info.parity == Parity::Odd };
            if turns { -x } else { *x }
        })
        .collect()
}

#[test]
fn mirrored_state_mirrors_the_force() {
    let odd_output = |o: usize| [1, 2, 4, 5].contains(&(o % STATES)) && o < 12 || o == 13;
    for term in names() {
        let model = probed(term);
        for at in everywhere().iter().chain(&generic()) {
            let x = with_parameters(&model, at);
            let expected = outputs(&model, &x);
            let found = outputs(&model, &mirrored(&x, &model));
            for o in 0..OUTPUTS {
                let mirror = if odd_output(o) { -expected[o] } else { expected[o] };
                let close = 1e-12 * (expected[o].abs() + 1e-3);
                assert!((found[o] - mirror).abs() <= close, "{term}: output {o} at {at:?}: {} {mirror}", found[o]);
            }
        }
    }
}

/// Index of the parameter that is the east (or sine) part of the earth-fixed vector whose north (or cosine) part is `name`.
fn east_of(name: &str, model: &Model) -> Option<usize> {
    let partner = if name.contains("north") {
        name.replace("north", "east")
    } else if !name.contains("east") && name.ends_with("_cos") {
        name.replace("_cos", "_sin")
    } else {
        return None;
    };
    Some(model.index(&partner).unwrap_or_else(|| panic!("{name} has no partner {partner}")))
}

/// The point with every direction on the earth turned by `angle`.
fn turned(x: &[f64], model: &Model, angle: f64) -> Vec<f64> {
    let (sin, cos) = angle.sin_cos();
    let mut y = x.to_vec();
    let mut pairs: Vec<(usize, usize)> = [0, STATES + 3, STATES + 5, STATES + 7].iter().map(|i| (*i, *i + 1)).collect();
    for (i, p) in model.parameters.iter().enumerate() {
        pairs.extend(east_of(&p.name, model).map(|j| (POINT + i, POINT + j)));
    }
    for (i, j) in pairs {
        (y[i], y[j]) = (x[i] * cos - x[j] * sin, x[i] * sin + x[j] * cos);
    }
    y[2] += angle;
    y
}

#[test]
fn turning_the_earth_frame_leaves_the_body_force_unchanged() {
    for term in names() {
        let model = probed(term);
        for angle in [0.7, -2.9] {
            let (sin, cos) = f64::sin_cos(angle);
            for at in everywhere().iter().chain(&generic()) {
                let x = with_parameters(&model, at);
                let mut expected = outputs(&model, &x);
                for i in [0, STATES] {
                    (expected[i], expected[i + 1]) =
                        (expected[i] * cos - expected[i + 1] * sin, expected[i] * sin + expected[i + 1] * cos);
                }
                expected[STATES + 2] += angle;
                let found = outputs(&model, &turned(&x, &model, angle));
                for o in 0..OUTPUTS {
                    // Where the rudder inflow is reversed, the angle of attack loses digits to a whole turn.
                    let close = 1e-10 * (expected[o].abs() + 1e-3);
                    assert!(
                        (found[o] - expected[o]).abs() <= close,
                        "{term}: output {o} at {at:?}: {} {}",
                        found[o],
                        expected[o]
                    );
                }
            }
        }
    }
}

#[test]
fn the_listing_shows_every_term_and_parameter() {
    let ship = ship();
    let entries = listing(None, Some(&ship));
    assert_eq!(entries.iter().map(|e| e.name).collect::<Vec<_>>(), names());
    let overview = summary(&entries).to_string();
    let json = serde_json::to_value(&entries).unwrap();
    for (i, e) in entries.iter().enumerate() {
        assert!(overview.contains(e.name));
        let text = e.to_string();
        assert!(text.contains(e.equation) && text.contains(e.source));
        assert_eq!(json[i]["equation"], e.equation);
        assert_eq!(e.base, BASE.contains(&e.name));
        for (j, p) in e.parameters.iter().enumerate() {
            assert!(text.contains(&p.name), "{text}");
            assert_eq!(json[i]["parameters"][j]["name"], p.name);
            assert!(json[i]["parameters"][j]["default"].is_number());
        }
        assert!(!text.split_whitespace().any(|w| ["NaN", "inf", "-inf"].contains(&w)), "{text}");
    }
    let one = listing(Some("current"), None);
    assert_eq!(one.len(), 1);
    assert!(serde_json::to_value(&one).unwrap()[0]["parameters"][0]["default"].is_null());
    assert!(listing(Some("no_such_term"), None).is_empty());
}
