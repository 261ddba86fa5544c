//! Laws of the plan: what trials on one course and on four can part, that more trials show more, and that threads change nothing.
//! The command is run end to end on the study of the demo, without its recordings.

use serde_json::Value;
use statrs::distribution::{ContinuousCDF, Normal};
use std::path::Path;
use std::process::{Command, Output};
use trimtab::Settings;
use trimtab::diagnose::plan::{Kind, Outlook, Plan, PlanSettings, PlannedTrial, Question, plan};
use trimtab::evaluate::maneuver::ManeuverSettings;
use trimtab::model::Model;

fn model() -> Model {
    trimtab::study::demo::example().unwrap().model
}

/// A plan of these trials with sparse samples.
fn planned(trials: Vec<PlannedTrial>, pair: Option<[&str; 2]>) -> Plan {
    let mut settings = PlanSettings { trials, ..PlanSettings::default() };
    settings.sensors.step = Some(3.0);
    let (maneuver, diagnose) =
        (ManeuverSettings { speed: Some(6.0), ..ManeuverSettings::default() }, Settings::default());
    let model = model();
    let question = Question { model: &model, plan: &settings, maneuver: &maneuver, diagnose: &diagnose };
    plan(&question, pair, &|_| ()).unwrap()
}

fn of<'p>(plan: &'p Plan, name: &str) -> &'p Outlook {
    plan.mechanisms.iter().find(|m| m.mechanism == name).unwrap()
}

/// Whether both mechanisms are identifiable and neither takes over more than the tolerance of the other's gain.
fn are_parted(plan: &Plan, a: &str, b: &str) -> bool {
    let joined = plan.isolability.pairs.iter().any(|p| [&p.a, &p.b].contains(&&a.to_owned()) && (p.a == b || p.b == b));
    of(plan, a).identifiable && of(plan, b).identifiable && !joined
}

/// Straight runs at 6 m/s and so slowly that a wind drives the ship across: a current carries it along at any speed.
fn straight(courses: &[f64]) -> Vec<PlannedTrial> {
    let run = |speed, duration| PlannedTrial { speed: Some(speed), duration, ..PlannedTrial::new(Kind::Straight) };
    [run(6.0, None), run(1.8, Some(600.0))].map(|t| t.on(courses)).into()
}

const ROUND: [f64; 4] = [0.0, 90.0, 180.0, 270.0];

#[test]
fn straight_runs_part_a_current_from_a_wind_on_four_courses_and_not_on_one() {
    assert!(!are_parted(&planned(straight(&[0.0]), None), "current", "mean_wind"));
    assert!(are_parted(&planned(straight(&ROUND), None), "current", "mean_wind"));
}

#[test]
fn more_trials_never_raise_the_smallest_size_and_a_rudder_offset_is_absorbed() {
    let turns = |courses: &[f64]| {
        let mut trials = straight(courses);
        trials.push(PlannedTrial { rudder_deg: Some(20.0), ..PlannedTrial::new(Kind::Zigzag) }.on(courses));
        planned(trials, None)
    };
    let (few, many) = (turns(&ROUND[..2]), turns(&ROUND));
    // The chance of a false name is shared by all mechanisms that are identifiable: the standard errors behind the sizes.
    let normal = Normal::new(0.0, 1.0).unwrap();
    let needed = |p: &Plan| {
        let visible = p.mechanisms.iter().filter(|m| m.identifiable).count();
        normal.inverse_cdf(1.0 - 0.5 * p.alpha / visible as f64) + normal.inverse_cdf(0.8)
    };
    let more = (needed(&many) / needed(&few)).max(1.0);
    let mut compared = 0;
    for a in &few.mechanisms {
        let b = of(&many, &a.mechanism);
        if let (Some(before), Some(after)) = (a.size, b.size) {
            assert!(after <= before * more * (1.0 + 1e-6), "{}: {before} {after}", a.mechanism);
            compared += 1;
        }
        assert!((0.0..=1.0).contains(&a.retained));
    }
    assert!(compared > 10, "{compared}");
    for p in [&few, &many] {
        let offset = of(p, "rudder_offset");
        assert!(!offset.identifiable && offset.size.is_none() && offset.absorbed_by.is_some(), "{offset:?}");
    }
}

#[test]
fn the_matrix_is_symmetric_and_the_set_that_parts_a_pair_is_no_dearer_than_all_trials() {
    let p = planned(straight(&[0.0]), Some(["current", "mean_wind"]));
    let share = &p.isolability.share;
    for (i, row) in share.iter().enumerate() {
        assert!(row.iter().enumerate().all(|(j, s)| *s == share[j][i] && (0.0..=1.0).contains(s)) && row[i] == 1.0);
    }
    let parting = p.parting.unwrap();
    assert!(parting.parted && parting.pair.share <= parting.tolerance && parting.minutes > 0.0, "{parting:?}");
    assert!(!parting.trials.is_empty() && parting.trials.len() < parting.of, "{parting:?}");
}

#[test]
fn the_bits_do_not_depend_on_the_number_of_threads() {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let p = pool.install(|| planned(straight(&ROUND), Some(["current", "rudder_stall"])));
        serde_json::to_string(&p).unwrap()
    };
    assert_eq!(on(1), on(2));
}

fn trimtab(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_trimtab")).current_dir(folder).args(arguments).output().unwrap()
}

/// Ship, model and a study whose recordings do not exist.
fn study(plan: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in
        trimtab::study::demo::files().iter().filter(|(n, _)| ["ship.toml", "model.toml"].contains(&n.as_str()))
    {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let text = format!(
        "name = \"planned\"\nship = \"ship.toml\"\nmodel = \"model.toml\"\ndata = \"nowhere\"\n[maneuver]\nspeed = 6.0\n{plan}"
    );
    std::fs::write(folder.path().join("study.toml"), text).unwrap();
    folder
}

const FEW: &str = "[plan.sensors]\nstep = 3.0\n[[plan.trials]]\nkind = \"turning\"\nrudder_deg = -35\nheading_deg = [0, 90]\n\
                   [[plan.trials]]\nkind = \"acceleration\"\nrepeat = 2\n";

#[test]
fn the_command_needs_no_recordings_and_writes_what_it_says() {
    let folder = study(FEW);
    let output = trimtab(folder.path(), &["plan", "study.toml", "--out", "planned"]);
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(0), "{text}{}", String::from_utf8_lossy(&output.stderr));
    assert!(text.contains("SMALLEST SIZES") && text.contains("turning 35 deg port"), "{text}");
    let wide = text.lines().find(|l| l.chars().count() > 100 && !l.starts_with("Written to"));
    assert_eq!(wide, None, "{text}");
    for name in ["plan.json", "trials.csv", "detectable.csv", "isolability.csv", "isolability_map.png"] {
        assert!(folder.path().join("planned").join(name).is_file(), "{name}");
    }
    let json: Value =
        serde_json::from_str(&std::fs::read_to_string(folder.path().join("planned/plan.json")).unwrap()).unwrap();
    let result = &json["result"]["plan"];
    assert_eq!(result["trials"].as_array().unwrap().len(), 4);
    let rows = std::fs::read_to_string(folder.path().join("planned/detectable.csv")).unwrap().lines().count();
    assert_eq!(rows, 1 + result["mechanisms"].as_array().unwrap().len());
    // What only a session without it shows is distinguished by no trial, and the exit code says so.
    let hidden = trimtab(folder.path(), &["plan", "study.toml", "--part", "current,rudder_offset"]);
    let text = String::from_utf8(hidden.stdout).unwrap();
    assert!(hidden.status.code() == Some(1) && text.contains("rudder_offset"), "{text}");
    let bare = trimtab(folder.path(), &["plan", "--ship", "ship.toml", "--model", "absent.toml"]);
    assert_eq!(bare.status.code(), Some(2));
}

#[test]
fn bad_input_is_refused_with_a_hint_and_a_range() {
    let refused = |plan: &str, arguments: &[&str]| {
        let folder = study(plan);
        let output = trimtab(folder.path(), &[&["plan", "study.toml"], arguments].concat());
        assert_eq!(output.status.code(), Some(2));
        String::from_utf8(output.stderr).unwrap()
    };
    let message = refused(FEW, &["--part", "curent,mean_wind"]);
    assert!(message.contains("did you mean `current`?"), "{message}");
    assert!(refused(FEW, &["--part", "current"]).contains("two mechanisms"));
    assert!(refused(FEW, &["--part", "current,current"]).contains("from itself"));
    let message = refused("[[plan.trials]]\nkind = \"zigzag\"\nheading_change_deg = 0\n", &[]);
    assert!(message.contains("study.toml:9:") && message.contains("between 1 and 90"), "{message}");
    let message = refused("[plan.sensors]\npositon = 1.0\n", &[]);
    assert!(message.contains("study.toml:8:") && message.contains("did you mean `position`?"), "{message}");
}
