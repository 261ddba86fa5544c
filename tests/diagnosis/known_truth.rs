//! The diagnosis on recordings whose truth the test knows and the diagnosis does not.

use crate::support::{STAR, add, commanded, model, runs, truth_noise};
use trimtab::diagnose::proof::grade::LawGrade;
use trimtab::diagnose::{Diagnosis, Settings, Verdict, diagnose};
use trimtab::model::Model;
use trimtab::physics::Form;
use trimtab::recording::{Channel, Labels, Measured, Recording, Run, WindowSettings};
use trimtab::ship::parameter::Parity;
use trimtab::ship::state::Inputs;

/// Thirty training runs and ten test runs of a ship with physics that the base model lacks, analysed once.
fn case(set: &[(&str, f64)], sessions: &[&str], seed: u64) -> Diagnosis {
    case_by(&Settings::default(), set, sessions, seed)
}

/// As [`case`], by these settings.
fn case_by(settings: &Settings, set: &[(&str, f64)], sessions: &[&str], seed: u64) -> Diagnosis {
    let base = model();
    let mut truth = base.clone();
    for (name, value) in set {
        truth.add_term(name.split('.').next().unwrap()).unwrap();
        let i = truth.find(name).unwrap();
        if sessions.is_empty() {
            truth.parameters[i].value = *value;
        }
        for s in sessions {
            truth.sessions.entry((*s).to_string()).or_default().push((i, *value));
        }
    }
    let data = runs(&truth, &truth_noise(), 40, seed);
    diagnose(&base, &data[..30], &data[30..], settings, &|_| ()).unwrap()
}

fn value(d: &Diagnosis, name: &str) -> f64 {
    d.findings.iter().flat_map(|f| &f.parameters).find(|p| p.name == name).map_or(f64::NAN, |p| p.value)
}

#[test]
fn no_mechanism_is_named_where_nothing_is_missing() {
    let d = case(&[], &[], 101);
    assert_eq!(d.verdict, Verdict::NothingMissing, "{}", d.headline);
    assert!(d.law.is_none() && d.improved_is_base);
    assert!(d.detectable.iter().any(|m| m.mechanism == "current" && m.size > 0.0 && m.size < 0.1));
}

/// The run as it is read back from a recording without columns for u and v.
fn without_velocity(run: &Run) -> Run {
    let column = |c: usize| run.measured.iter().map(|m| m[c].unwrap()).collect::<Vec<f64>>();
    let input = |f: fn(&Inputs<f64>) -> f64| run.inputs.iter().map(f).collect::<Vec<f64>>();
    let channels = vec![
        (Channel::T, input(|i| i.t)),
        (Channel::X, column(0)),
        (Channel::Y, column(1)),
        (Channel::Psi, column(2)),
        (Channel::R, column(5)),
        (Channel::N, input(|i| i.n)),
        (Channel::Delta, input(|i| i.delta)),
    ];
    let (name, session, manoeuvre) = (run.recording.clone(), run.session.clone(), run.manoeuvre.clone());
    let labels = Labels { run: name, session, manoeuvre, split: run.split };
    let recording = Recording::from_channels(&run.recording, channels).unwrap();
    recording.windows(&labels, &WindowSettings::whole(model().ship.hull.draught)).unwrap().windows.remove(0)
}

#[test]
fn velocities_that_were_not_measured_are_not_taken_for_gusts() {
    let whole = runs(&model(), &truth_noise(), 24, 101);
    let data: Vec<Run> = whole.iter().map(without_velocity).collect();
    for run in &data {
        assert_eq!(run.channels(), [true, true, true, false, false, true]);
        assert!((run.mean_speed() - run.path_length() / run.duration()).abs() < 1e-9 && run.mean_speed() > 0.5);
    }
    let d = diagnose(&model(), &data[..18], &data[18..], &Settings::default(), &|_| ()).unwrap();
    assert_eq!((d.verdict, d.findings.len()), (Verdict::NothingMissing, 0), "{}", d.headline);
}

/// Recordings of which the diagnosis must say first what is wrong with them, each with the fault, and the channel.
type Fault = (&'static str, &'static str, fn(&mut Run));

#[test]
fn a_wrong_unit_or_sign_is_reported_before_any_physics() {
    let faults: [Fault; 4] = [
        ("sign_error", "r", |run| run.measured.iter_mut().for_each(|m| m[5] = m[5].map(|r| -r))),
        ("unit_error", "u", |run| run.measured.iter_mut().for_each(|m| m[3] = m[3].map(|u| u / 0.514_444))),
        ("unit_error", "u", |run| {
            run.measured.iter_mut().for_each(|m| (m[3], m[4]) = (m[3].map(|u| 3.6 * u), None));
        }),
        ("sign_error", "delta", |run| run.inputs.iter_mut().for_each(|i| i.delta = -i.delta)),
    ];
    for (fault, channel, spoil) in faults {
        let mut data = runs(&model(), &truth_noise(), 12, 101);
        data.iter_mut().for_each(spoil);
        let d = diagnose(&model(), &data[..9], &data[9..], &Settings::default(), &|_| ()).unwrap();
        assert_eq!(d.verdict, Verdict::Sensor, "{fault} of {channel}: {}", d.headline);
        let first = d.admission.issues.iter().find(|i| i.blocking()).unwrap();
        assert_eq!((first.fault, first.channel.unwrap().name()), (fault, channel), "{first:?}");
    }
}

#[test]
fn a_current_is_named_with_its_set_and_improves_unseen_runs() {
    let d = case_by(&Settings { repeat: true, ..Settings::default() }, &[("current.north", 0.1)], &[], 3);
    assert!(d.stability.as_ref().is_some_and(|s| s.same == s.of), "{:?}", d.stability);
    assert_eq!(d.verdict, Verdict::Named, "{}", d.headline);
    assert_eq!(d.findings[0].mechanism, "current");
    assert!((value(&d, "current.north") - 0.1).abs() < 0.02 && value(&d, "current.east").abs() < 0.02);
    let proof = d.held_out.unwrap();
    assert!(proof.after < proof.before && proof.log_likelihood_gain > 20.0, "{proof:?}");
    assert!(d.model.term_names().contains(&"current"));
}

#[test]
fn a_wind_is_named_a_wind_beside_a_current() {
    // Tested without the wind, a force fixed on the earth has a steeper slope at zero than a wind of 14 m/s, whose law is quadratic.
    let d = case(&[("current.north", 0.1), ("mean_wind.east", 14.0)], &[], 2);
    let sets: Vec<&[String]> = d.findings.iter().map(|f| f.confidence_set.as_slice()).collect();
    assert_eq!(sets, [["mean_wind"], ["current"]], "{}", d.headline);
    assert!((value(&d, "mean_wind.east") - 14.0).abs() < 1.4 && (value(&d, "current.north") - 0.1).abs() < 0.02);
}

/// The run of a similar ship, lengths times `k`, at an equal Froude number.
fn scaled(run: &Run, k: f64) -> Run {
    let time = k.sqrt();
    let units = [k, k, 1.0, time, time, 1.0 / time];
    let state = |s: &Measured| std::array::from_fn(|i| s[i].map(|v| v * units[i]));
    Run {
        dt: run.dt * time,
        recorded_dt: run.recorded_dt * time,
        inputs: run.inputs.iter().map(|i| Inputs::actuators(i.t * time, i.n / time, i.delta)).collect(),
        measured: run.measured.iter().map(state).collect(),
        initial: std::array::from_fn(|i| run.initial[i] * units[i]),
        ..run.clone()
    }
}

#[test]
fn a_model_of_three_metres_and_its_similar_ship_have_equal_diagnoses() {
    let base = model();
    let mut truth = base.clone();
    truth.add_term("current").unwrap();
    let north = truth.find("current.north").unwrap();
    truth.parameters[north].value = 0.1;
    let data = runs(&truth, &truth_noise(), 24, 3);
    let k: f64 = 3.0 / 85.0;
    let (speed, force) = (k.sqrt(), k.powi(3));
    let mut ship = base.ship.clone();
    for length in [
        &mut ship.hull.lpp,
        &mut ship.hull.breadth,
        &mut ship.hull.draught,
        &mut ship.propeller.diameter,
        &mut ship.rudder.span,
    ] {
        *length *= k;
    }
    ship.hull.mass *= force;
    ship.rudder.area *= k * k;
    ship.parameters.clear();
    let mut small = Model::new(ship, "HD", Form::Regular, &[]).unwrap();
    let resistance = |i: usize| if (1..=3).contains(&i) { force / speed.powi(i as i32) } else { 1.0 };
    small.set_eleven(&std::array::from_fn(|i| STAR[i] * resistance(i)));
    let of = |model: &Model, data: &[Run], rate: f64| {
        let mut settings = Settings::default();
        settings.judging.max_yaw_rate *= rate;
        diagnose(model, &data[..18], &data[18..], &settings, &|_| ()).unwrap()
    };
    let similar: Vec<Run> = data.iter().map(|r| scaled(r, k)).collect();
    let (large, small) = (of(&base, &data, 1.0), of(&small, &similar, 1.0 / k.sqrt()));
    assert_eq!((large.verdict, small.verdict), (Verdict::Named, Verdict::Named), "{}", small.headline);
    assert_eq!(small.findings[0].mechanism, "current");
    let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-3;
    assert!(near(small.findings[0].statistic, large.findings[0].statistic));
    assert!(near(value(&small, "current.north"), speed * value(&large, "current.north")));
    let cvdm = |d: &Diagnosis| d.held_out.as_ref().and_then(|h| h.after).unwrap();
    assert!(near(cvdm(&small), cvdm(&large)));
}

#[test]
fn a_biased_compass_is_named_as_a_sensor_error() {
    let d = case(&[("heading_bias.bias", 0.0175)], &[], 3);
    assert_eq!(d.verdict, Verdict::Sensor, "{}", d.headline);
    assert!((value(&d, "heading_bias.bias") - 0.0175).abs() < 0.003);
}

#[test]
fn a_deviation_of_the_compass_is_neither_a_current_nor_a_bias() {
    let d = case(&[("compass_deviation.north", 0.03), ("compass_deviation.east", -0.04)], &[], 31);
    assert_eq!(d.verdict, Verdict::Sensor, "{}", d.headline);
    assert_eq!(d.findings.len(), 1, "{}", d.headline);
    for (name, truth) in [("compass_deviation.north", 0.03), ("compass_deviation.east", -0.04)] {
        assert!((value(&d, name) - truth).abs() < 0.003, "{name} {}", value(&d, name));
    }
    // Largest where it is 2.9 deg, on the heading of the vector.
    assert!(d.headline.contains("307 deg"), "{}", d.headline);
}

#[test]
fn a_rudder_offset_in_every_session_is_not_named() {
    let d = case(&[("rudder_offset.offset", 0.03)], &[], 9);
    assert_eq!(d.verdict, Verdict::NothingMissing, "{}", d.headline);
    // A mechanism that the model's own parameters absorb is not named either.
    assert!(d.findings.is_empty());
}

/// As `case`, with a current of its own in each session: north and east \[m/s\].
fn another_each_session(currents: &[(&str, [f64; 2])], seed: u64) -> Diagnosis {
    let base = model();
    let mut truth = base.clone();
    truth.add_term("current").unwrap();
    for (session, current) in currents {
        let list = truth.sessions.entry((*session).to_string()).or_default();
        for (name, value) in ["current.north", "current.east"].iter().zip(current) {
            list.push((truth.parameters.iter().position(|p| p.name == *name).unwrap(), *value));
        }
    }
    let data = runs(&truth, &truth_noise(), 40, seed);
    diagnose(&base, &data[..30], &data[30..], &Settings::default(), &|_| ()).unwrap()
}

#[test]
fn currents_that_differ_between_sessions_are_found_by_session() {
    let currents = [("s0", [0.12, 0.0]), ("s1", [0.0, 0.12]), ("s2", [-0.12, 0.03]), ("s3", [0.03, -0.12])];
    let d = another_each_session(&currents, 11);
    let found = &d.findings[0];
    assert!(found.mechanism == "current" && found.by_session, "{}", d.headline);
    assert_eq!(found.sessions, ["s0", "s1", "s2", "s3"]);
    for (session, current) in currents {
        for (part, truth) in ["north", "east"].iter().zip(current) {
            let estimate = value(&d, &format!("current.{part} [{session}]"));
            assert!((estimate - truth).abs() < 0.03, "{part} in {session}: {estimate} for {truth}");
        }
    }
    let proof = d.held_out.unwrap();
    assert!(proof.after < proof.before && proof.log_likelihood_gain > 20.0, "{proof:?}");
    // The improved model has a current for each session.
    assert_eq!(d.model.sessions.len(), 4);
}

#[test]
fn a_current_that_is_equal_in_all_sessions_is_not_split() {
    let same = ["s0", "s1", "s2", "s3"].map(|s| (s, [0.08, -0.06]));
    let d = another_each_session(&same, 12);
    let found = &d.findings[0];
    assert!(found.mechanism == "current" && !found.by_session && found.sessions.is_empty(), "{}", d.headline);
    assert!((value(&d, "current.north") - 0.08).abs() < 0.02 && (value(&d, "current.east") + 0.06).abs() < 0.02);
}

#[test]
fn a_jump_of_the_receiver_is_not_named_a_push() {
    let mut data = runs(&model(), &truth_noise(), 30, 101);
    for (i, run) in data.iter_mut().enumerate().filter(|(i, _)| i % 3 == 0) {
        let (psi, at) = (run.measured[60][2].unwrap(), 50 + i);
        // Ahead, as by a clock that slips; a push from astern would move the ship alike.
        for m in &mut run.measured[at..] {
            add(m, 0, 12.0 * psi.cos());
            add(m, 1, 12.0 * psi.sin());
        }
    }
    let d = diagnose(&model(), &data, &spare(), &Settings::default(), &|_| ()).unwrap();
    assert!(d.findings.is_empty(), "{}", d.headline);
    let jumped = d.admission.issues.iter().filter(|i| i.fault == "jump" && !i.blocking());
    assert_eq!(jumped.count(), 10);
    assert_eq!(d.admission.runs, 40);
}

/// Three more runs for the proof, so that none is set aside.
fn spare() -> Vec<Run> {
    runs(&model(), &truth_noise(), 3, 99)
}

/// Runs in some of which the compass slips by a radian half way.
fn slipped(every: usize) -> (Diagnosis, Vec<String>) {
    let mut data = runs(&model(), &truth_noise(), 30, 101);
    for run in data.iter_mut().skip(1).step_by(every) {
        run.measured[60..].iter_mut().for_each(|m| add(m, 2, 1.0));
    }
    let d = diagnose(&model(), &data, &spare(), &Settings::default(), &|_| ()).unwrap();
    let lost = d.admission.issues.iter().filter(|i| i.fault == "lost" && !i.blocking());
    let texts = lost.map(|i| i.text.clone()).collect();
    (d, texts)
}

#[test]
fn runs_that_the_model_cannot_follow_are_reported() {
    let name = |i: usize| runs(&model(), &truth_noise(), 30, 101)[i].name.clone();
    let (d, texts) = slipped(40);
    assert!(texts.len() == 1 && texts[0].starts_with(&name(1)), "{texts:?}");
    assert!((30 * 121 - 61..30 * 121 - 30).contains(&d.admission.samples), "{}", d.admission.samples);
    let (d, texts) = slipped(4);
    assert!(texts.len() == 1 && texts[0].contains("of 30 runs"), "{texts:?}");
    assert_eq!(d.admission.samples, 30 * 121);
    assert!(case(&[], &[], 11).admission.issues.iter().all(|i| i.fault != "lost"));
}

#[test]
fn inputs_missing_for_a_while_are_reported_and_not_taken_for_physics() {
    let mut data = runs(&model(), &truth_noise(), 30, 106);
    data[13].inputs[60..100].iter_mut().for_each(|i| (i.n, i.delta) = (-3.0, -0.6));
    let d = diagnose(&model(), &data, &spare(), &Settings::default(), &|_| ()).unwrap();
    assert!(d.findings.is_empty(), "{}", d.headline);
    let lost = d.admission.issues.iter().filter(|i| i.fault == "lost").map(|i| i.text.as_str());
    assert!(
        lost.clone().count() >= 1 && lost.clone().all(|t| t.starts_with("run 13")),
        "{:?}",
        lost.collect::<Vec<_>>()
    );
    let clean = case(&[], &[], 106);
    for (found, truth) in d.noise_before.force.iter().zip(clean.noise_before.force) {
        assert!(*found < 1.5 * truth, "{found} for {truth}");
    }
}

/// First and last second of a push that does not fill the time blocks of the search.
const WITHIN: [f64; 2] = [84.0, 146.0];

/// Thirty runs, in some of which a force of their own acts from 80 to 140 s.
fn pushed(forces: &[([f64; 3], fn(usize) -> bool)]) -> Diagnosis {
    pushed_for(forces, [80.0, 140.0])
}

/// As above, between other seconds.
fn pushed_for(forces: &[([f64; 3], fn(usize) -> bool)], [start, end]: [f64; 2]) -> Diagnosis {
    let mut data = runs(&model(), &truth_noise(), 30, 101);
    for ([x, y, n], acts_in) in forces {
        let mut truth = model();
        truth.add_term("push").unwrap();
        for (name, value) in ["x", "y", "n", "start", "end"].into_iter().zip([*x, *y, *n, start, end]) {
            let i = truth.find(&format!("push.{name}")).unwrap();
            truth.parameters[i].value = value;
        }
        let with = runs(&truth, &truth_noise(), 30, 101);
        (0..30).filter(|i| acts_in(*i)).for_each(|i| data[i].clone_from(&with[i]));
    }
    for run in &mut data {
        run.name = format!("{} 0 s", run.recording);
    }
    diagnose(&model(), &data, &spare(), &Settings::default(), &|_| ()).unwrap()
}

/// One force in every fourth run.
fn pushed_often(force: [f64; 3]) -> Diagnosis {
    pushed(&[(force, |i| i % 4 == 1)])
}

#[test]
fn a_push_is_named_with_its_windows_by_recording() {
    let d = pushed_for(&[([0.0, 5e4, 1e6], |i| i % 4 == 1)], WITHIN);
    assert_eq!(d.findings.first().map(|f| f.mechanism.as_str()), Some("push"), "{}", d.headline);
    let windows = &d.findings[0].windows;
    let right = |w: &&trimtab::diagnose::evidence::push::Window| {
        let number: usize = w.run.trim_start_matches("run ").parse().unwrap();
        number % 4 == 1 && (w.start - WITHIN[0]).abs() <= 20.0 && (w.end - WITHIN[1]).abs() <= 20.0
    };
    let found: Vec<_> = windows.iter().filter(right).collect();
    assert!(windows.len() >= 6 && found.len() + 1 >= windows.len(), "{windows:?}");
    // To the sample of two seconds, not to the time block of the search.
    let off = |w: &&&trimtab::diagnose::evidence::push::Window| {
        0.5 * ((w.start - WITHIN[0]).abs() + (w.end - WITHIN[1]).abs())
    };
    let mean = found.iter().map(|w| off(&w)).sum::<f64>() / found.len() as f64;
    assert!(mean < 2.5, "edges off by {mean} s: {windows:?}");
}

#[test]
fn the_share_of_a_push_across_the_keel_is_reported() {
    let share = |force: [f64; 3]| pushed_often(force).location.push.unwrap().sideways;
    let (across, along) = (share([0.0, 3e4, 6e5]), share([-4e4, 0.0, 0.0]));
    assert!(across > 0.9 && along < 0.1, "{across} {along}");
}

#[test]
fn a_force_that_acts_to_both_sides_is_no_push() {
    let d = pushed(&[([0.0, 5e4, 1e6], |i| i % 4 == 1), ([0.0, -5e4, -1e6], |i| i % 4 == 3)]);
    let candidate = d.location.push.as_ref().unwrap();
    assert!(candidate.statistic > 150.0 && candidate.mirrored > 0.5, "{candidate:?}");
    assert!(d.findings.iter().all(|f| f.mechanism != "push"), "{}", d.headline);
}

#[test]
fn a_force_in_one_recording_alone_is_a_push_or_the_ship_in_a_state_of_its_own() {
    let d = pushed_for(&[([0.0, 2e5, 4e6], |i| i == 5)], WITHIN);
    assert_eq!((d.verdict, d.findings.len()), (Verdict::OneOf, 1), "{}", d.headline);
    assert_eq!(d.findings[0].confidence_set, ["push", "generic"]);
    assert!(d.headline.contains("run 5 from "), "{}", d.headline);
    assert!(d.next_trial.is_some_and(|t| t.trial.contains("twice more")));
    let [window] = d.findings[0].windows.as_slice() else { panic!("{:?}", d.findings) };
    assert!((window.start - WITHIN[0]).abs() <= 4.0 && (window.end - WITHIN[1]).abs() <= 4.0, "{window:?}");
}

#[test]
fn a_moment_outside_the_catalogue_is_not_named_a_sensor_error() {
    let d = case(&[("asymmetric.N_0", 3e5)], &[], 3);
    assert_eq!((d.verdict, d.findings.len()), (Verdict::NotInCatalogue, 0), "{}", d.headline);
}

#[test]
fn a_law_that_unseen_runs_refute_is_not_in_the_headline_and_not_in_the_improved_model() {
    let base = model();
    let to_one_side = |moment: f64, count: usize, seed: u64| {
        let mut truth = base.clone();
        truth.add_term("asymmetric").unwrap();
        let i = truth.find("asymmetric.N_0").unwrap();
        truth.parameters[i].value = moment;
        runs(&truth, &truth_noise(), count, seed)
    };
    // The moment turns before the test runs are sailed.
    let (train, test) = (to_one_side(3e5, 30, 3), to_one_side(-3e5, 10, 4));
    let d = diagnose(&base, &train, &test, &Settings::default(), &|_| ()).unwrap();
    let law = d.law.as_ref().unwrap();
    assert_eq!((d.verdict, law.grade), (Verdict::NotInCatalogue, LawGrade::Refuted), "{}", d.headline);
    assert!(d.headline.contains("refuted by unseen runs") && !d.headline.contains("] ="), "{}", d.headline);
    assert!(d.improved_is_base && d.model.find("asymmetric.N_0").is_err());
    // Two recordings give no interval.
    let d = diagnose(&base, &train, &test[..2], &Settings::default(), &|_| ()).unwrap();
    assert_eq!(d.law.map(|l| l.grade), Some(LawGrade::Exploratory));
    assert!(
        d.headline.contains("exploratory") && d.headline.contains("N [N m] = ") && d.improved_is_base,
        "{}",
        d.headline
    );
}

#[test]
fn a_force_outside_the_catalogue_is_written_as_a_law_that_unseen_runs_confirm_and_that_leaves_nothing_to_name() {
    let base = model();
    let mut truth = base.clone();
    truth.add_term("asymmetric").unwrap();
    let side = truth.find("asymmetric.Y_u_absu").unwrap();
    truth.parameters[side].value = 0.01;
    let data = runs(&truth, &truth_noise(), 40, 3);
    let (train, test) = data.split_at(30);
    let d = diagnose(&base, train, test, &Settings::default(), &|_| ()).unwrap();
    let law = d.law.as_ref().unwrap();
    assert_eq!((d.verdict, law.grade), (Verdict::NotInCatalogue, LawGrade::Confirmed), "{}", d.headline);
    let [term] = law.terms.as_slice() else { panic!("{:?}", law.terms) };
    assert_eq!((term.name.as_str(), term.symbol.as_str(), term.mirror), ("asymmetric.Y_u_absu", "u|u|", "odd"));
    // In SI units: 1/2 rho L d times the coefficient.
    let hull = &base.ship.hull;
    let true_value = 0.01 * 0.5 * hull.water_density * hull.lpp * hull.draught;
    assert!(term.ci95[0] < true_value && true_value < term.ci95[1], "{true_value} {term:?}");
    assert!(d.headline.contains("confirmed on unseen runs") && d.headline.contains(&law.equation[0]), "{}", d.headline);
    let range = &law.range[0];
    assert!(range.symbol == "u" && range.low < range.high && range.high < 12.0, "{range:?}");
    assert!(d.adequacy_before.asymmetric < 1e-8 && d.adequacy_after.asymmetric > 0.01, "{:?}", d.adequacy_after);
    // The improved model has it, and lacks nothing.
    assert!(!d.improved_is_base && d.held_out.as_ref().is_some_and(|h| h.improvement > Some(0.2)), "{:?}", d.held_out);
    let written = d.model.parameters[d.model.find("asymmetric.Y_u_absu").unwrap()].value;
    assert!((written / 0.01 - 1.0).abs() < 0.2, "{written}");
    let again = diagnose(&d.model, train, test, &Settings::default(), &|_| ()).unwrap();
    assert_eq!((again.verdict, again.law.is_none()), (Verdict::NothingMissing, true), "{}", again.headline);
}

#[test]
fn a_force_in_one_part_of_the_water_is_not_named_weather() {
    let mut truth = model();
    truth.add_term("earth_force").unwrap();
    let north = truth.find("earth_force.north").unwrap();
    truth.parameters[north].value = 3e4;
    let (with, mut data) = (runs(&truth, &truth_noise(), 30, 7), runs(&model(), &truth_noise(), 30, 7));
    for (i, run) in data.iter_mut().enumerate().filter(|(i, _)| i % 3 == 1) {
        run.clone_from(&with[i]);
        // Sailed elsewhere: 3 km to the east.
        run.initial[1] += 3000.0;
        run.measured.iter_mut().for_each(|m| add(m, 1, 3000.0));
    }
    let d = diagnose(&model(), &data, &spare(), &Settings::default(), &|_| ()).unwrap();
    assert_eq!((d.verdict, d.findings.len()), (Verdict::NotInCatalogue, 0), "{}", d.headline);
    let place = d.location.place.as_ref().unwrap();
    assert!(place.p < 1e-10 && place.east[1] > 2000.0 && place.force[0] > 1e4, "{place:?}");
    assert!(d.headline.contains("differs from place to place"), "{}", d.headline);
}

#[test]
fn an_error_of_the_log_is_named_before_a_thruster_that_leads_the_ranking() {
    let base = model();
    let mut truth = base.clone();
    for term in ["thruster", "log_scale"] {
        truth.add_term(term).unwrap();
    }
    // A thruster loses force with speed: a force that follows the command without this loss has another cause.
    truth.set(&[("thruster.gain", 1.0), ("thruster.half_speed", 15.0), ("log_scale.error", 0.01)]).unwrap();
    let command = |i: usize, t: f64| {
        let side = if i.is_multiple_of(2) { 1.0 } else { -1.0 };
        if i.is_multiple_of(3) && (40.0..120.0).contains(&t) { side } else { 0.0 }
    };
    let data = commanded(&truth, &truth_noise(), 30, 17, &command);
    let d = diagnose(&base, &data, &[], &Settings::default(), &|_| ()).unwrap();
    assert_eq!(d.ranking[0].mechanism, "thruster");
    let named: Vec<&str> = d.findings.iter().map(|f| f.mechanism.as_str()).collect();
    assert_eq!(named.first(), Some(&"log_scale"), "{}", d.headline);
    assert!((value(&d, "log_scale.error") - 0.01).abs() < 0.003);
}

#[test]
fn a_ship_with_unlike_sides_is_distinguished_from_a_symmetric_one() {
    let mut alike = model();
    for p in alike.parameters.iter_mut().filter(|p| p.info.parity == Parity::Odd) {
        (p.value, p.free) = (0.0, false);
    }
    // A one-sided sensor error of the model is no difference between the ship's sides.
    alike.add_term("yaw_rate_bias").unwrap();
    let bias = alike.find("yaw_rate_bias.bias").unwrap();
    alike.parameters[bias].free = true;
    let of = |asymmetry: f64| {
        let mut truth = alike.clone();
        let i = truth.find("flow.asymmetry").unwrap();
        truth.parameters[i].value = asymmetry;
        let data = runs(&truth, &truth_noise(), 30, 13);
        diagnose(&alike, &data, &[], &Settings::default(), &|_| ()).unwrap()
    };
    let (single, twin) = (of(-0.12), of(0.0));
    // The difference belongs to the ship; no physics is missing for it.
    assert!(single.findings.is_empty() && twin.findings.is_empty(), "{} {}", single.headline, twin.headline);
    let (single, twin) = (single.sides.unwrap(), twin.sides.unwrap());
    assert!(single.p < 1e-6 && twin.p > 1e-3, "{single:?} {twin:?}");
    let [flow] = single.parameters.as_slice() else { panic!("{single:?}") };
    assert!(flow.name == "flow.asymmetry" && (flow.value + 0.12).abs() < 3.5 * flow.error, "{flow:?}");
}

#[test]
fn one_thread_and_two_give_the_same_bits() {
    let of = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| case(&[("log_scale.error", 0.03)], &[], 5))
    };
    let (one, two) = (of(1), of(2));
    assert_eq!(one.findings[0].mechanism, "log_scale");
    let bits = |d: &Diagnosis| d.model.values().iter().map(|v| v.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&one), bits(&two));
}
