//! Tests of the trials: tracks of known shape, mirror symmetry, step size and the IMO limits.
//! No recording is read here; recorded trials are tested in `experiments`.

use super::*;
use crate::model::Model;
use crate::physics::Form;
use crate::ship::Ship;
use crate::uncertainty::Uncertainty;
use std::f64::consts::PI;
use std::path::Path;

fn ship(name: &str) -> Ship {
    Ship::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("experiments/ships/{name}.toml"))).unwrap()
}

fn model(form: Form) -> Model {
    let mut model = Model::new(ship("a"), "A", form, &[]).unwrap();
    // The published p* of ship A.
    model.set_eleven(&[-0.017, 34187.0, -12568.0, 1594.0, -0.039, 3.193, 0.205, -4.882, 0.048, 0.0746, 1.370]);
    model
}

/// A ship that sails straight for 10 s, then on a circle of `radius` at 2 m/s.
fn circle(radius: f64, side: f64) -> Track {
    let mut track = Track::default();
    let speed = 2.0;
    for k in 0..=(10.0 + 14.0 * radius / speed) as usize * 10 {
        let t = k as f64 * 0.1;
        let angle = speed * (t - 10.0).max(0.0) / radius;
        let ahead = speed * t.min(10.0) + radius * angle.sin();
        let rate = if t > 10.0 { side * speed / radius } else { 0.0 };
        track.t.push(t);
        track.states.push([ahead, side * radius * (1.0 - angle.cos()), side * angle, speed, 0.0, rate]);
        track.delta.push(if t > 10.0 { side * 0.6 } else { 0.0 });
        track.n.push(1.0);
    }
    track
}

/// Turns a track about the origin.
fn rotated(track: &Track, by: f64) -> Track {
    let (sin, cos) = by.sin_cos();
    let mut track = track.clone();
    for s in &mut track.states {
        (s[0], s[1], s[2]) = (s[0] * cos - s[1] * sin, s[0] * sin + s[1] * cos, s[2] + by);
    }
    track
}

#[test]
fn a_geometric_circle_is_measured_exactly_on_any_course_and_side() {
    for side in [1.0, -1.0] {
        for course in [0.0, 2.5, -40.0] {
            let track = rotated(&circle(50.0, side), course);
            let execute = turning_execute(&track).unwrap();
            assert_eq!(execute, 100);
            let m = turning(&track, execute);
            for (found, expected, what) in [
                (m.advance.unwrap(), 50.0, "advance"),
                (m.transfer.unwrap(), 50.0, "transfer"),
                (m.tactical_diameter.unwrap(), 100.0, "tactical diameter"),
                (m.steady.unwrap().diameter, 100.0, "steady diameter"),
                (m.time_90.unwrap(), 25.0 * 0.5 * PI, "time to 90 deg"),
                (m.rudder, side * 0.6, "rudder"),
            ] {
                assert!((found - expected).abs() < 0.02, "{what}: {found} instead of {expected}");
            }
            assert!(m.steady.unwrap().speed_loss.abs() < 1e-12);
        }
    }
}

#[test]
fn a_measure_that_the_track_does_not_reach_is_absent() {
    let mut track = circle(50.0, 1.0);
    for column in [&mut track.t, &mut track.delta, &mut track.n] {
        column.truncate(300);
    }
    track.states.truncate(300);
    let m = turning(&track, 100);
    assert_eq!((m.advance, m.tactical_diameter, m.steady), (None, None, None));
    let text = serde_json::to_string(&m).unwrap();
    assert!(!text.contains("null") && !text.contains("advance"), "{text}");
}

#[test]
fn a_zigzag_of_known_heading_gives_its_overshoots_and_period() {
    // Heading 10 sin with overshoots of 4 deg: 14 deg amplitude, rudder put over at 10 deg.
    let amplitude = 14.0_f64.to_radians();
    let heading = 10.0_f64.to_radians();
    let mut track = Track::default();
    let (mut side, mut executes) = (1.0, vec![0]);
    for k in 0..6000 {
        let t = k as f64 * 0.1;
        let psi = amplitude * (2.0 * PI * t / 200.0).sin();
        if side * psi >= heading {
            side = -side;
            executes.push(k);
        }
        track.t.push(t);
        track.states.push([2.0 * t, 0.0, psi, 2.0, 0.0, 0.0]);
        track.delta.push(if k == 0 { 0.0 } else { side * heading });
        track.n.push(1.0);
    }
    let found = zigzag_executes(&track);
    assert_eq!(found.len(), executes.len());
    assert!(found.iter().zip(&executes).all(|(f, e)| f.abs_diff(*e) <= 1), "{found:?} {executes:?}");
    let m = zigzag(&track, &executes, heading);
    for o in &m.overshoots[..4] {
        // A parabola is not quite the top of a sine.
        assert!((o.to_degrees() - 4.0).abs() < 2e-3, "{o}");
    }
    assert!((m.period.unwrap() - 200.0).abs() < 0.2);
    assert!((m.reach.unwrap() - 100.0).abs() < 0.1);
    assert!((m.initial_turning.unwrap() - 2.0 * m.initial_turning_time.unwrap()).abs() < 1e-6);
}

#[test]
fn overshoots_do_not_depend_on_the_step_within_which_the_rudder_is_put_over() {
    let model = model(Form::Regular);
    let theta = model.values();
    let overshoots = |share: f64| {
        let settings = ManeuverSettings::default();
        let step = share * settings.approach(&model, &theta).unwrap().step;
        let approach = ManeuverSettings { step: Some(step), ..settings }.approach(&model, &theta).unwrap();
        zigzag_trial(&model, &theta, &approach, Side::Starboard, [0.35, 0.35]).measures.overshoots
    };
    let (coarse, fine) = (overshoots(1.0), overshoots(0.1));
    assert!(coarse.len() > 2 && coarse.len() == fine.len(), "{coarse:?}");
    for (a, b) in coarse.iter().zip(&fine) {
        assert!((a - b).abs().to_degrees() < 0.03, "{coarse:?} {fine:?}");
    }
}

#[test]
fn a_noisy_zigzag_of_one_row_a_second_gives_its_overshoots_whatever_rows_the_rudder_is_put_over_at() {
    use rand::SeedableRng;
    use rand_distr::{Distribution, Normal};
    let (amplitude, heading) = (14.0_f64.to_radians(), 10.0_f64.to_radians());
    let noise = Normal::new(0.0, 0.15_f64.to_radians()).unwrap();
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(5);
    for phase in 0..10 {
        // 30 s of approach, and up to 1.5 deg from row to row at the executes; a row may be missing.
        let mut track = Track::default();
        let (mut side, mut executes) = (1.0, vec![30]);
        for k in 0..240 {
            let t = k as f64 - 30.0 + if k < 30 { 0.0 } else { 0.1 * phase as f64 };
            let psi = if k < 30 { 0.0 } else { amplitude * (2.0 * PI * t / 60.0).sin() };
            if side * psi >= heading {
                side = -side;
                executes.push(k);
            }
            let recorded = if k % 50 == 49 { f64::NAN } else { psi + noise.sample(&mut rng) };
            track.t.push(k as f64);
            track.states.push([2.0 * t, 0.0, recorded, 2.0, 0.0, 0.0]);
            track.delta.push(if k <= 30 { 0.0 } else { side * heading });
            track.n.push(1.0);
        }
        let m = zigzag(&track, &executes, heading);
        assert!(m.overshoots.len() > 4, "{m:?}");
        for o in &m.overshoots[..4] {
            assert!((o.to_degrees() - 4.0).abs() < 0.3, "{phase}: {:?}", m.overshoots);
        }
    }
}

#[test]
fn the_approach_is_balanced_whichever_of_speed_and_rate_is_given() {
    let model = model(Form::Regular);
    let theta = model.values();
    let by_speed = ManeuverSettings { speed: Some(5.0), ..Default::default() }.approach(&model, &theta).unwrap();
    let rpm = by_speed.n * 60.0;
    let by_rate = ManeuverSettings { n_rpm: Some(rpm), ..Default::default() }.approach(&model, &theta).unwrap();
    assert!((by_rate.speed - 5.0).abs() < 1e-6, "{}", by_rate.speed);
    let state = crate::state::State::from_array([0.0, 0.0, 0.0, 5.0, 0.0, 0.0]);
    let inputs = crate::state::Inputs::actuators(0.0, by_speed.n, 0.0);
    let (rates, _) =
        crate::dynamics::Dynamics::new(&model, theta.clone()).rates(&state, &inputs, &crate::state::Force::zero());
    assert!(rates[3].abs() < 1e-6, "{rates:?}");
}

#[test]
fn an_impossible_setting_is_refused_by_name() {
    let model = model(Form::Regular);
    let theta = model.values();
    let bad = [
        (ManeuverSettings { speed: Some(-1.0), ..Default::default() }, "speed"),
        (ManeuverSettings { astern_rpm: Some(100.0), ..Default::default() }, "astern_rpm"),
        (ManeuverSettings { zigzag_deg: Some(vec![[10.0, -10.0]]), ..Default::default() }, "zigzag_deg"),
        (ManeuverSettings { turning_deg: Some(f64::NAN), ..Default::default() }, "turning_deg"),
    ];
    for (settings, name) in bad {
        match settings.approach(&model, &theta) {
            Err(ManeuverError::Setting(outside)) => assert_eq!(outside.key, name),
            other => panic!("{name}: {other:?}"),
        }
    }
}

#[test]
fn a_mirror_symmetric_ship_turns_alike_to_both_sides() {
    let mut model = model(Form::Regular);
    for name in ["propeller.side_force", "rudder.lift0", "rudder.lift2", "rudder.drag1"] {
        model.set(&[(name, 0.0)]).unwrap();
    }
    let theta = model.values();
    let settings = ManeuverSettings::default();
    let approach = settings.approach(&model, &theta).unwrap();
    let [right, left] = Side::BOTH.map(|s| turning_trial(&model, &theta, &approach, s, settings.turning_angle()));
    assert_eq!(right.ended, Ended::Complete);
    let near = |a: Option<f64>, b: Option<f64>| (a.unwrap() - b.unwrap()).abs() < 1e-9 * a.unwrap();
    assert!(near(right.measures.advance, left.measures.advance));
    assert!(near(right.measures.tactical_diameter, left.measures.tactical_diameter));
    let [right, left] =
        Side::BOTH.map(|s| zigzag_trial(&model, &theta, &approach, s, [10.0_f64.to_radians(); 2]).measures);
    assert_eq!(right.overshoots.len(), 3);
    assert!(right.overshoots.iter().zip(&left.overshoots).all(|(a, b)| (a - b).abs() < 1e-9));
}

#[test]
fn ship_a_with_the_published_parameters_turns_as_in_an_independent_simulation() {
    // An independent RK4 simulation at 200 rpm gave advance 3.55 L, tactical diameter 3.60 L and 3.66 L, r 0.025 rad/s.
    // It used a Fourier propeller where the model has a quadratic one: 8 %, 10 % of r.
    let model = model(Form::Paper);
    let theta = model.values();
    let settings = ManeuverSettings { n_rpm: Some(200.0), ..Default::default() };
    let approach = settings.approach(&model, &theta).unwrap();
    for (side, diameter) in [(Side::Starboard, 3.60), (Side::Port, 3.66)] {
        let trial = turning_trial(&model, &theta, &approach, side, settings.turning_angle());
        let m = trial.measures;
        let (advance, td) = (m.advance.unwrap() / 85.0, m.tactical_diameter.unwrap() / 85.0);
        assert!((advance / 3.55 - 1.0).abs() < 0.08, "advance {advance}");
        assert!((td / diameter - 1.0).abs() < 0.08, "tactical diameter {td}");
        let rate = m.steady.unwrap().yaw_rate.abs();
        assert!((rate / 0.025 - 1.0).abs() < 0.1, "yaw rate {rate}, {m:?}");
    }
}

#[test]
fn a_crash_stop_ends_with_no_way_ahead_and_its_reaches_agree() {
    let model = model(Form::Regular);
    let theta = model.values();
    let approach = ManeuverSettings::default().approach(&model, &theta).unwrap();
    let trial = stopping_trial(&model, &theta, &approach);
    assert_eq!(trial.ended, Ended::Complete);
    let m = trial.measures;
    let (track, head, side) = (m.track_reach.unwrap(), m.head_reach.unwrap(), m.lateral_deviation.unwrap());
    assert!(track >= head.hypot(side) - 1e-9, "{m:?}");
    assert!(trial.track.states.last().unwrap()[3].abs() < 0.05);
    assert!(m.time.unwrap() > 0.0);
}

#[test]
fn a_finer_step_does_not_move_the_measures() {
    let model = model(Form::Regular);
    let theta = model.values();
    let at = |step| {
        let settings = ManeuverSettings { step: Some(step), speed: Some(5.0), ..Default::default() };
        let approach = settings.approach(&model, &theta).unwrap();
        turning_trial(&model, &theta, &approach, Side::Starboard, settings.turning_angle()).measures
    };
    let (coarse, fine) = (at(0.34), at(0.085));
    assert!((coarse.advance.unwrap() - fine.advance.unwrap()).abs() < 0.01);
    assert!((coarse.tactical_diameter.unwrap() - fine.tactical_diameter.unwrap()).abs() < 0.01);
}

#[test]
fn imo_limits_follow_length_over_speed_and_bind_from_100_m() {
    let limits = |length: f64, speed: f64| {
        let mut ship = ship("b");
        ship.hull.lpp = length;
        let angle = 10.0_f64.to_radians();
        let m = Zigzag { rudder: -angle, heading: angle, approach_speed: speed, ..Default::default() };
        imo::zigzag(&ship, &m).iter().map(|c| (c.limit, c.binding)).collect::<Vec<_>>()
    };
    assert_eq!(limits(90.0, 10.0), [(Some(2.5), false), (Some(10.0), false), (Some(25.0), false)]);
    assert_eq!(limits(120.0, 6.0), [(Some(2.5), true), (Some(15.0), true), (Some(32.5), true)]);
    assert_eq!(limits(300.0, 6.0), [(Some(2.5), true), (Some(20.0), true), (Some(40.0), true)]);
    let verdict = |degrees: f64| {
        let m = Turning { rudder: degrees.to_radians(), advance: Some(4.0 * 123.0), ..Default::default() };
        imo::turning(&ship("b"), &m).iter().map(|c| c.verdict).collect::<Vec<_>>()
    };
    assert_eq!(verdict(-35.0), [imo::Verdict::Met, imo::Verdict::NotApplicable]);
    assert_eq!(verdict(20.0), [imo::Verdict::NotApplicable; 2]);
}

#[test]
fn an_interval_has_its_value_in_the_middle_where_recordings_determine_a_product_and_not_its_factors() {
    // Opposite relative errors of 20 % of the lift slope and of the wake: (1 + a)(1 - a) is below one for every draw.
    let model = model(Form::Regular);
    let at = |name: &str| model.index(name).unwrap();
    let [lift, wake] = [at("rudder.lift1"), at("flow.wake")].map(|i| model.parameters[i].value);
    let matrix = vec![vec![0.04 * lift * lift, -0.04 * lift * wake], vec![-0.04 * lift * wake, 0.04 * wake * wake]];
    let uncertainty = Uncertainty {
        kind: "test".to_owned(),
        freedom: None,
        parameters: vec!["rudder.lift1".to_owned(), "flow.wake".to_owned()],
        undetermined: Vec::new(),
        doubt: None,
        matrix,
    };
    let settings = ManeuverSettings { speed: Some(5.0), ..Default::default() };
    let approach = settings.approach(&model, &model.values()).unwrap();
    let sail = |theta: &[f64]| vec![turning_trial(&model, theta, &approach, Side::Starboard, settings.turning_angle())];
    let mut trials = sail(&model.values());
    set_intervals(&mut trials, &drawn(&model, &uncertainty, 100, 3), |theta| Some(sail(theta)));
    let trial = &trials[0];
    for (name, [low, high]) in &trial.intervals {
        let value = trial.measures.quantity(name).unwrap();
        assert!((0.5 * (low + high) - value).abs() < 1e-9 * value.abs(), "{name}: {low} {value} {high}");
        assert!(high > low, "{name}");
    }
    assert!(trial.intervals.len() > 5, "{:?}", trial.intervals);
    // To first order: a tenth of the covariance has intervals sqrt(10) times as narrow.
    let small = Uncertainty {
        matrix: uncertainty.matrix.iter().map(|r| r.iter().map(|x| 0.1 * x).collect()).collect(),
        ..uncertainty
    };
    let mut again = sail(&model.values());
    set_intervals(&mut again, &drawn(&model, &small, 100, 3), |theta| Some(sail(theta)));
    let width = |t: &Trial<Turning>| t.intervals["advance"][1] - t.intervals["advance"][0];
    let ratio = width(trial) / width(&again[0]);
    assert!((ratio / 10f64.sqrt() - 1.0).abs() < 0.05, "{ratio}");
}

#[test]
fn a_circle_in_a_current_is_the_same_circle_through_the_water() {
    let still = rotated(&circle(50.0, 1.0), 0.7);
    let [north, east] = [0.31, -0.22];
    let mut carried = still.clone();
    for (t, s) in carried.t.iter().zip(&mut carried.states) {
        let (sin, cos) = s[2].sin_cos();
        (s[0], s[1]) = (s[0] + north * t, s[1] + east * t);
        (s[3], s[4]) = (s[3] + north * cos + east * sin, s[4] + east * cos - north * sin);
    }
    let current = vec![[north, east]; carried.len()];
    let (water, expected) = (turning(&carried.through_water(&current), 100), turning(&still, 100));
    for (name, read) in Turning::QUANTITIES {
        let (a, b) = (read(&water), read(&expected));
        assert!(a.zip(b).is_some_and(|(a, b)| (a - b).abs() < 1e-9 * b.abs().max(1.0)), "{name}: {a:?} {b:?}");
    }
    let ground = turning(&carried, 100).tactical_diameter.unwrap();
    assert!((ground - expected.tactical_diameter.unwrap()).abs() > 5.0, "the current must matter over ground");
}

#[test]
fn the_pull_out_and_the_spiral_agree_on_whether_a_ship_is_stable_on_its_course() {
    let settings = ManeuverSettings { speed: Some(5.0), ..Default::default() };
    for (scale, expected) in [(4.0, true), (0.1, false)] {
        let mut model = model(Form::Regular);
        let names = ["propeller.side_force", "rudder.lift0", "rudder.lift2", "rudder.drag1"];
        names.iter().for_each(|name| model.set(&[(*name, 0.0)]).unwrap());
        // More yaw damping makes a ship stable, less makes it unstable.
        let i = model.index("hull.Nr").unwrap();
        let value = model.parameters[i].value;
        model.set(&[("hull.Nr", scale * value)]).unwrap();
        let theta = model.values();
        let approach = settings.approach(&model, &theta).unwrap();
        let angle = 20f64.to_radians();
        let pulled = Side::BOTH.map(|side| pull_out_trial(&model, &theta, &approach, side, angle));
        assert_eq!(course_stable(&pulled), Some(expected), "{:?}", pulled.map(|t| t.measures));
        // An interval of what is left of the rate that contains both answers leaves it open.
        let turning = pulled[0].measures.turning_rate;
        let left = |ends: [f64; 2]| {
            let mut trials = pulled.clone();
            trials[0].intervals.insert("residual_rate", ends.map(|end| end * turning));
            is_stability_open(&trials)
        };
        assert!(!is_stability_open(&pulled) && left([0.0, 0.5]) && left([-0.3, 0.2]));
        assert!(!left([-1e-4, 1e-4]) && !left([0.2, 0.5]));
        let m = spiral_trial(&model, &theta, &approach, angle).measures;
        let (width, height) = (m.loop_width.unwrap().to_degrees(), m.loop_height.unwrap());
        let residual = pulled[0].measures.residual_rate.unwrap();
        // The loop of a ship that is hardly unstable is narrower than the angles are apart; its height shows that.
        assert_eq!(height < 0.02 * m.points[0][1], expected, "{m:?}");
        assert!(!expected || width < 0.1, "{m:?}");
        // Amidships the two passes are the rates that the pull-outs leave.
        assert!((height - 2.0 * residual.abs()).abs() < 0.05 * residual.abs() + 1e-4, "{height} {residual}");
        assert!(m.neutral.unwrap().abs() < 0.2f64.to_radians(), "{m:?}");
    }
}

#[test]
fn the_angles_of_a_spiral_go_from_one_side_to_the_other_and_back() {
    let angles: Vec<f64> = spiral_angles(20f64.to_radians()).iter().map(|a| a.to_degrees().round()).collect();
    let half = angles.len() / 2;
    assert_eq!((angles[0], angles[half], *angles.last().unwrap()), (20.0, -20.0, 20.0));
    assert!(angles[..=half].windows(2).all(|w| w[1] < w[0]) && angles[half..].windows(2).all(|w| w[1] > w[0]));
    assert!(angles[half..].iter().eq(angles[..=half].iter().rev()));
}

#[test]
fn shallow_water_widens_the_circle_and_a_depth_that_is_less_than_the_ship_needs_is_refused() {
    let model = model(Form::Regular);
    let at = |depth: Option<f64>| {
        let (model, left_out) = calm_water_of_depth(&model, depth).unwrap();
        assert!(!left_out.contains(&"shallow"));
        let settings = ManeuverSettings { speed: Some(5.0), ..Default::default() };
        let theta = model.values();
        let approach = settings.approach(&model, &theta).unwrap();
        let m = turning_trial(&model, &theta, &approach, Side::Starboard, settings.turning_angle()).measures;
        (m.tactical_diameter.unwrap(), approach.n)
    };
    let draught = model.ship.hull.draught;
    let [deep, ocean, shallow] = [None, Some(5e3), Some(1.6 * draught)].map(at);
    assert!((ocean.0 / deep.0 - 1.0).abs() < 0.01, "{ocean:?} {deep:?}");
    assert!(shallow.0 > 1.02 * deep.0 && shallow.1 > deep.1, "{shallow:?} {deep:?}");
    let refused = calm_water_of_depth(&model, Some(1.05 * draught)).unwrap_err();
    assert!(refused.key == "depth" && refused.to_string().contains("1.2 times the draught"), "{refused}");
}

#[test]
fn a_craft_without_anything_to_steer_with_sails_no_trial_and_the_error_says_what_it_lacks() {
    let text = "name = \"cat\"\n[hull]\nlpp = 1.2\nbreadth = 0.9\nmass = 17.0\n[[actuator]]\nname = \"left\"\nx = -0.4\ny = -0.3\nangle = 0\n\
                law = \"thruster\"\n";
    let model = Model::new(Ship::parse(text, Path::new("ship.toml")).unwrap(), "cat", Form::General, &[]).unwrap();
    let error = ManeuverSettings::default().approach(&model, &model.values()).unwrap_err();
    assert_eq!(error, ManeuverError::NoDrive { missing: "rudder" });
}

#[test]
fn twin_screws_with_rudders_and_an_outboard_turn_to_the_side_of_the_order() {
    let hull = "name = \"boat\"\n[hull]\nlpp = 5.0\nbreadth = 1.8\nmass = 900.0\n";
    let twin = [("port", -0.5), ("starboard", 0.5)].map(|(side, y)| {
        format!(
            "[[actuator]]\nname = \"{side}_screw\"\nx = -2.2\ny = {y}\nangle = 0\nlaw = \"propeller\"\ndiameter = 0.3\n\
             [[actuator]]\nname = \"{side}_rudder\"\nx = -2.4\ny = {y}\nlaw = \"foil\"\narea = 0.05\nbehind = \"{side}_screw\"\n"
        )
    });
    let outboard = "[[actuator]]\nname = \"outboard\"\nx = -2.4\nlaw = \"thruster\"\n".to_owned();
    for actuators in [twin.concat(), outboard] {
        let ship = Ship::parse(&format!("{hull}{actuators}"), Path::new("ship.toml")).unwrap();
        let model = Model::new(ship, "boat", Form::General, &[]).unwrap();
        let settings = ManeuverSettings { speed: Some(1.5), ..Default::default() };
        let approach = settings.approach(&model, &model.values()).unwrap();
        for (side, sign) in [(Side::Starboard, 1.0), (Side::Port, -1.0)] {
            let turn = turning_trial(&model, &model.values(), &approach, side, 0.4);
            let end = turn.track.states.last().unwrap();
            assert!(end[2] * sign > 3.0 && turn.measures.tactical_diameter.unwrap() > 0.0, "{actuators} {end:?}");
        }
    }
}

/// Ships whose trials are published: type, L, B and d \[m\], approach speed \[m/s\], tactical diameter at 35 deg over L, first overshoot of the
/// zigzag 10/10 \[deg\]. KVLCC2, KCS, S175 and the 3 m Esso Osaka: free-running models (SIMMAN 2008; Kim, Tezdogan et al. 2021; ITTC 1984; Osaka
/// University, circles of its recordings); Esso 190 000 dwt: the model of van Berlekom & Goddard 1972, made from full-scale trials.
const TRIED: [(&str, [f64; 3], f64, f64, Option<f64>); 5] = [
    ("tanker", [320.0, 58.0, 20.8], 7.97, 3.20, Some(9.8)),
    ("container", [230.0, 32.2, 10.8], 7.46, 3.16, None),
    ("tanker", [304.8, 47.17, 18.46], 8.0, 3.08, Some(6.9)),
    ("container", [175.0, 25.4, 9.5], 6.2, 4.12, None),
    ("tanker", [3.0, 0.489, 0.201], 0.4, 2.60, None),
];

#[test]
fn trials_of_ships_that_are_known_by_their_dimensions_are_near_those_sailed() {
    let errors = |prime: bool| {
        let (mut circles, mut overshoots) = (Vec::new(), Vec::new());
        for (kind, dimensions, speed, diameter, overshoot) in TRIED {
            let kind = crate::ship::particulars::Kind::find(kind).unwrap();
            let [l, b, d] = dimensions;
            let given =
                format!("name = \"a\"\n[hull]\nlpp = {l:?}\nbreadth = {b:?}\ndraught = {d:?}\n").parse().unwrap();
            let mut ship = crate::ship::particulars::estimate(kind, &given, None).unwrap().ship;
            if !prime {
                ship.coefficients_prime.clear();
            }
            let model = Model::new(ship, "a", Form::Regular, &[]).unwrap();
            let settings = ManeuverSettings { speed: Some(speed), ..Default::default() };
            let theta = model.values();
            let approach = settings.approach(&model, &theta).unwrap();
            let turn = turning_trial(&model, &theta, &approach, Side::Starboard, settings.turning_angle());
            circles.push((turn.measures.tactical_diameter.unwrap() / l / diameter - 1.0).abs());
            if let Some(overshoot) = overshoot {
                let angles = [10_f64.to_radians(); 2];
                let zigzag = zigzag_trial(&model, &theta, &approach, Side::Starboard, angles);
                overshoots.push((zigzag.measures.overshoots[0].to_degrees() / overshoot - 1.0).abs());
            }
        }
        [circles, overshoots].map(|mut errors| {
            errors.sort_by(f64::total_cmp);
            errors[errors.len() / 2]
        })
    };
    let (ours, clarke) = (errors(true), errors(false));
    assert!(ours[0] < 0.2 && ours[1] < 0.45, "median errors {ours:?}");
    assert!(ours[0] < 0.6 * clarke[0] && ours[1] < clarke[1], "{ours:?}, with Clarke's derivatives {clarke:?}");
}
