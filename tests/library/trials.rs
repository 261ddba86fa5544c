//! The measures of standard trials read from measured runs of KVLCC2, against values read from those runs by hand.
//! The data are not part of the project; without them every test here is skipped with a message.

use std::path::{Path, PathBuf};
use trimtab::evaluate::maneuver::{Track, turning, turning_execute, zigzag, zigzag_executes};
use trimtab::study::Study;

/// Length between perpendiculars \[m\].
const LENGTH: f64 = 320.0;

/// The measured tracks of the runs whose name contains a word, with the name; `None` where the data are absent.
fn tracks(word: &str) -> Option<Vec<(String, Track)>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let given = std::env::var_os("TRIMTAB_DATA").map(PathBuf::from);
    let folder = given.unwrap_or_else(|| root.join("../shared/data")).join("kvlcc2_marin");
    if !folder.is_dir() {
        println!("skipped: {} is absent; set TRIMTAB_DATA to run this test", folder.display());
        return None;
    }
    let mut study = Study::read(&root.join("experiments/studies/kvlcc2/study.toml")).unwrap();
    study.windows.step = None;
    let windows = study.whole_runs(20.8).unwrap().windows;
    let chosen = windows.iter().filter(|w| w.recording.contains(word));
    Some(chosen.map(|w| (w.recording.clone(), Track::recorded(w))).collect())
}

#[test]
fn val_kvlcc2_marin_measured_turning_circles_give_their_published_measures() {
    let Some(tracks) = tracks("turning") else { return };
    assert_eq!(tracks.len(), 2);
    for (name, track) in tracks {
        let m = turning(&track, turning_execute(&track).unwrap());
        let expected = if name.contains("port") { [3.01, 1.23, 3.08] } else { [3.09, 1.37, 3.34] };
        let found = [m.advance, m.transfer, m.tactical_diameter].map(|x| x.unwrap() / LENGTH);
        for (f, e) in found.iter().zip(expected) {
            assert!((f - e).abs() < 0.03, "{name}: {found:?} instead of {expected:?}");
        }
        assert_eq!(m.rudder > 0.0, name.contains("starboard"), "{name}: {}", m.rudder);
        let steady = m.steady.unwrap();
        assert!((steady.yaw_rate.abs().to_degrees() - 0.42).abs() < 0.03, "{name}: {steady:?}");
        assert!((0.60..0.67).contains(&steady.speed_loss), "{name}: {steady:?}");
    }
}

#[test]
fn val_kvlcc2_marin_measured_zigzags_give_their_published_overshoots() {
    let expected = [
        ("10/10 starboard", [8.2, 21.9]),
        ("10/10 port", [9.5, 15.0]),
        ("20/20 starboard", [13.7, 14.9]),
        ("20/20 port", [15.1, 13.3]),
    ];
    for (name, overshoots) in expected {
        let Some(tracks) = tracks(name) else { return };
        let (_, track) = &tracks[0];
        let angle: f64 = if name.starts_with("10") { 10.0 } else { 20.0 };
        let m = zigzag(track, &zigzag_executes(track), angle.to_radians());
        assert_eq!(m.rudder > 0.0, name.contains("starboard"), "{name}: {m:?}");
        for (found, expected) in m.overshoots.iter().zip(overshoots) {
            let found = found.to_degrees();
            assert!((found - expected).abs() < 0.5, "{name}: {found:.1} deg instead of {expected}");
        }
    }
}
