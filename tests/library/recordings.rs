//! The project's studies of real hulls against their measured data: layouts, frames, dropouts and windows.
//! The data are not part of the project; without them every test here is skipped with a message.

use std::path::{Path, PathBuf};
use trimtab::recording::audit::{Severity, audit};
use trimtab::recording::{Channel, Recording, Split};
use trimtab::study::Study;

/// The study of that name with its data; `None`, with a message, where they are absent.
fn study(name: &str, data: &str) -> Option<Study> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let given = std::env::var_os("TRIMTAB_DATA").map(PathBuf::from);
    let folder = given.unwrap_or_else(|| root.join("../shared/data")).join(data);
    if !folder.is_dir() {
        crate::support::skipped(&format!("{} is absent; set TRIMTAB_DATA to run this test", folder.display()));
        return None;
    }
    Some(Study::read(&root.join("experiments/studies").join(name).join("study.toml")).unwrap())
}

fn esso_osaka() -> Option<Study> {
    study("esso_osaka", "esso_osaka")
}

fn kvlcc2() -> Option<Study> {
    study("kvlcc2", "kvlcc2_marin")
}

fn recordings(study: &Study) -> Vec<Recording> {
    study.runs.iter().map(|run| study.recording(run).unwrap()).collect()
}

#[test]
fn the_runs_of_esso_osaka_pass_the_audit() {
    let Some(study) = esso_osaka() else { return };
    for recording in recordings(&study) {
        let audit = audit(&recording);
        let errors: Vec<_> = audit.issues.iter().filter(|i| i.severity == Severity::Error).collect();
        assert!(errors.is_empty(), "{}: {errors:?}", recording.name);
        // The GNSS velocity lags behind the track by 0.6 to 0.9 s, which in a zigzag is centimetres a second.
        let kinematics = audit.kinematics.unwrap();
        assert!(kinematics.velocity_rms.unwrap() < 0.06, "{}: {kinematics:?}", recording.name);
        assert!(kinematics.yaw_rate_rms.unwrap() < 0.02, "{}: {kinematics:?}", recording.name);
    }
}

#[test]
fn the_frozen_position_of_a_turn_is_found() {
    let Some(study) = esso_osaka() else { return };
    let run = study.runs.iter().find(|r| r.labels.run == "turn_14-Oct-2020_14_08_51").unwrap();
    let issues = audit(&study.recording(run).unwrap()).issues;
    for channel in [Channel::X, Channel::Psi] {
        let found = issues.iter().find(|i| i.channel == Some(channel) && i.text.contains("stands still"));
        assert_eq!(found.unwrap().lines, Some((2077, 2102)), "{channel}: {issues:?}");
    }
}

#[test]
fn the_earth_fixed_velocities_of_kvlcc2_follow_the_track() {
    let Some(study) = kvlcc2() else { return };
    for recording in recordings(&study) {
        let audit = audit(&recording);
        let errors: Vec<_> = audit.issues.iter().filter(|i| i.severity == Severity::Error).collect();
        assert!(errors.is_empty(), "{}: {errors:?}", recording.name);
        // Positions are printed with three digits: metres of rounding over some seconds.
        let kinematics = audit.kinematics.unwrap();
        assert!(kinematics.velocity_rms.unwrap() < 0.6, "{}: {kinematics:?}", recording.name);
        assert!((kinematics.yaw_rate_gain.unwrap() - 1.0).abs() < 0.05, "{}: {kinematics:?}", recording.name);
        let u = recording.get(Channel::U).unwrap();
        assert!(u.iter().all(|u| (2.0..8.5).contains(u)), "surge is ahead once rotated into the ship's axes");
        assert!((recording.step() - 0.1353).abs() < 1e-9);
    }
}

#[test]
fn kvlcc2_turns_to_the_side_of_its_rudder() {
    let Some(study) = kvlcc2() else { return };
    for (run, side) in [("turning circle 35 starboard", 1.0), ("turning circle 35 port", -1.0)] {
        let run = study.runs.iter().find(|r| r.labels.run == run).unwrap();
        let recording = study.recording(run).unwrap();
        let middle = recording.len() / 2;
        let at = |c: Channel| recording.get(c).unwrap()[middle] * side;
        assert!(at(Channel::Delta) > 0.5 && at(Channel::R) > 0.005 && at(Channel::Psi) > 1.0);
    }
}

#[test]
fn the_lost_rows_of_a_zigzag_are_left_out_and_reported() {
    let Some(study) = esso_osaka() else { return };
    let run = study.runs.iter().find(|r| r.labels.run == "zigzag_31-Jul-2020_13_50_28").unwrap();
    let recording = study.recording(run).unwrap();
    assert_eq!(recording.without_time(), [(1703, 2029)]);
    let segments = recording.segments();
    assert_eq!((segments.len(), segments[0].clone()), (1, 0..1701));
    let named = audit(&recording).issues.iter().any(|i| i.lines == Some((1703, 2029)));
    assert!(named, "the audit names the lines");
}

#[test]
fn a_dropout_in_a_real_run_cuts_its_windows() {
    let Some(study) = esso_osaka() else { return };
    let run = study.runs.iter().find(|r| r.labels.run == "zigzag_31-Jul-2020_13_42_53").unwrap();
    let text = std::fs::read_to_string(&run.file).unwrap();
    let blanked = text.lines().enumerate().map(|(i, line)| {
        let time = line.split(',').next().unwrap_or_default();
        if (900..950).contains(&i) { format!("{time}{}", ",NaN".repeat(12)) } else { line.to_owned() }
    });
    let folder = tempfile::tempdir().unwrap();
    let mut run = run.clone();
    run.file = folder.path().join("holed.csv");
    std::fs::write(&run.file, blanked.collect::<Vec<_>>().join("\n")).unwrap();
    let recording = study.recording(&run).unwrap();
    assert_eq!(recording.segments(), [0..899, 949..recording.len()]);
    let windows = recording.windows(&run.labels, &study.settings(&run, 0.2)).unwrap().windows;
    for w in &windows {
        assert!(w.time(w.steps()) < 89.9 || w.start_time() > 94.8, "window from {} s", w.start_time());
    }
    assert!(windows.len() >= 2);
    let mut refusing = study.settings(&run, 0.2);
    refusing.gaps = trimtab::recording::Gaps::Refuse;
    let message = recording.windows(&run.labels, &refusing).unwrap_err().to_string();
    assert!(message.contains("holed.csv:901: ") && message.contains("950, 50 rows"), "{message}");
}

#[test]
fn both_studies_give_windows_of_their_length_on_both_sides() {
    for (study, draught) in [(esso_osaka(), 0.201), (kvlcc2(), 20.8)] {
        let Some(study) = study else { continue };
        let windows = study.windows(draught).unwrap().windows;
        for side in [Split::Train, Split::Test] {
            assert!(windows.iter().filter(|w| w.split == side).count() >= 8, "{}: {side:?}", study.name);
        }
        for w in &windows {
            assert_eq!(w.steps(), 120);
            assert_eq!(w.channels(), [true; 6]);
            assert!(w.initial.iter().all(|v| v.is_finite()));
            assert!(w.path_length() > 0.0 && w.mean_speed() > 0.0);
        }
        let whole = study.whole_runs(draught).unwrap();
        assert_eq!(whole.windows.len(), study.runs.len());
    }
}

#[test]
fn the_apparent_wind_of_esso_osaka_is_its_true_wind_seen_from_the_ship() {
    let Some(study) = esso_osaka() else { return };
    let run = &study.runs[0];
    let recording = study.recording(run).unwrap();
    let without = recording.channels().filter(|(c, _)| !matches!(c, Channel::WindSpeed | Channel::WindDirection));
    let apparent = Recording::from_channels("apparent", without.map(|(c, v)| (c, v.to_vec())).collect()).unwrap();
    let settings = trimtab::recording::WindowSettings::whole(0.201);
    let a = recording.windows(&run.labels, &settings).unwrap();
    let b = apparent.windows(&run.labels, &settings).unwrap();
    for (a, b) in a.windows[0].inputs.iter().zip(&b.windows[0].inputs) {
        for axis in 0..2 {
            assert!((a.wind[axis] - b.wind[axis]).abs() < 0.01, "{a:?} {b:?}");
        }
    }
}
