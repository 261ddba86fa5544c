//! Laws of the generator as a whole: seeds, seals, and that every effect acts, but not at size 0.
//! Its parts are tested in their own files.

use std::collections::BTreeSet;

use super::case::Case;
use super::effects::catalogue::catalogue;
use super::effects::effect::Class;
use super::error::ConcealError;
use super::family::Family;
use super::sailing::design::Design;
use super::seal;
use super::spec::{Background, Spec, Strength};
use super::strength::ForceMeter;

fn spec(effect: &str, strength: Strength) -> Spec {
    let effects = vec![(effect.to_owned(), strength)];
    Spec { effects, design: Design::Few, ..Spec::null(Family::Hd, 7) }
}

fn make(spec: &Spec) -> Case {
    Case::make(spec, &ForceMeter::default()).unwrap()
}

#[test]
fn one_seed_gives_the_same_bytes_and_another_gives_others() {
    let files = |seed| make(&Spec { seed, ..spec("current", Strength::Times(1.0)) }).study_files();
    assert_eq!(files(7), files(7));
    assert_ne!(files(7), files(8));
}

#[test]
fn every_effect_changes_the_reported_states_and_vanishes_at_size_zero() {
    for family in [Family::Hd, Family::Mmg] {
        let null = make(&Spec { design: Design::Few, ..Spec::null(family, 7) });
        for entry in catalogue().filter(|e| family == Family::Hd || e.in_mmg) {
            let at = |s| make(&Spec { family, ..spec(entry.name, s) });
            let (none, some) = (at(Strength::Size(0.0)), at(Strength::Times(1.0)));
            assert!(none.recorded.rows == null.recorded.rows, "{} acts at size 0", entry.name);
            assert!(some.recorded.rows != null.recorded.rows, "{} does nothing", entry.name);
            let finite = some.recorded.tracks.iter().flat_map(|t| &t.reported).all(|y| y.iter().all(|v| v.is_finite()));
            assert!(finite, "{} gives a state that is not finite", entry.name);
        }
    }
}

#[test]
fn forces_change_the_motion_and_sensor_defects_do_not() {
    let null = make(&Spec { design: Design::Few, ..Spec::null(Family::Hd, 7) });
    for entry in catalogue().filter(|e| e.name != "water_log") {
        let case = make(&spec(entry.name, Strength::Times(1.0)));
        let same = case.recorded.tracks.iter().zip(&null.recorded.tracks).all(|(a, b)| a.truth == b.truth);
        assert_eq!(same, entry.class == Class::Sensor, "{}", entry.name);
        let force: f64 = case.recorded.tracks.iter().flat_map(|t| &t.energy).flatten().sum();
        assert_eq!(force > 0.0, entry.class != Class::Sensor, "{}", entry.name);
    }
}

#[test]
fn contrast_leaves_the_reference_sessions_as_they_were() {
    let null = make(&Spec { design: Design::Few, ..Spec::null(Family::Hd, 7) });
    let case = make(&Spec { contrast: true, ..spec("mean_wind", Strength::Times(1.0)) });
    for ((plan, rows), reference) in case.recorded.plans.iter().zip(&case.recorded.rows).zip(&null.recorded.rows) {
        assert_eq!(rows == reference, plan.session == 0, "session {}", plan.session);
    }
}

#[test]
fn names_in_the_study_do_not_depend_on_what_is_concealed() {
    let names = |case: &Case| case.study_files().into_iter().map(|(name, _)| name).collect::<BTreeSet<_>>();
    let listing = |case: &Case| case.study_files().pop().unwrap().1;
    let null = make(&Spec { design: Design::Few, ..Spec::null(Family::Hd, 7) });
    for entry in catalogue() {
        let case = make(&spec(entry.name, Strength::Times(1.0)));
        assert_eq!(names(&case), names(&null));
        assert_eq!(listing(&case), listing(&null));
        for (name, text) in case.study_files().iter().filter(|(name, _)| !name.ends_with(".csv")) {
            let bare = text.contains(entry.name) && !null.study_files().contains(&(name.clone(), text.clone()));
            assert!(!bare, "{name} reveals {}", entry.name);
        }
    }
}

#[test]
fn a_seal_breaks_when_one_byte_changes() {
    let folder = tempfile::tempdir().unwrap();
    let case = make(&spec("heading_bias", Strength::Times(1.0)));
    case.write(folder.path()).unwrap();
    let manifest = seal::open(folder.path()).unwrap();
    assert_eq!(manifest.answers[0].effect, "heading_bias");
    let (study, _, sealed) = seal::paths(folder.path());
    for path in [study.with_file_name("r03.csv"), sealed] {
        let whole = std::fs::read(&path).unwrap();
        let mut changed = whole.clone();
        let middle = changed.len() / 2;
        changed[middle] ^= 1;
        std::fs::write(&path, &changed).unwrap();
        assert!(matches!(seal::open(folder.path()), Err(ConcealError::Broken { .. })), "{}", path.display());
        std::fs::write(&path, &whole).unwrap();
    }
    assert_eq!(seal::open(folder.path()).unwrap(), manifest);
}

#[test]
fn the_library_reads_what_the_concealer_writes() {
    let folder = tempfile::tempdir().unwrap();
    let study = make(&spec("thruster", Strength::Times(1.0))).write(folder.path()).unwrap();
    let ship = trimtab::ship::Ship::read(&study.with_file_name("ship.toml")).unwrap();
    trimtab::model::Model::read(&study.with_file_name("model.toml"), ship).unwrap();
    let columns = trimtab::recording::ColumnMap::read(&study.with_file_name("columns.toml")).unwrap();
    let recording = trimtab::recording::Recording::read(&study.with_file_name("r01.csv"), &columns).unwrap();
    assert!(recording.has(trimtab::recording::Channel::Thruster));
}

#[test]
fn each_background_changes_the_data_and_has_its_right_verdict() {
    let of = |background| make(&Spec { background, design: Design::Few, ..Spec::null(Family::Hd, 7) });
    let ordinary = of(Background::Ordinary);
    for (background, expected) in [
        (Background::Gusts, "RANDOM"),
        (Background::Coloured, "NOTHING MISSING"),
        (Background::Hull, "NOTHING MISSING"),
        (Background::Euler, "NUMERICS"),
        (Background::Outliers, "NOTHING MISSING"),
        (Background::Dropouts, "NOTHING MISSING"),
    ] {
        let case = of(background);
        assert!(case.recorded.rows != ordinary.recorded.rows, "{background:?}");
        assert_eq!(case.expected(), expected);
    }
}

#[test]
fn the_manifest_of_a_push_has_its_windows_and_its_equation() {
    let case = make(&Spec { design: Design::Standard, ..spec("push", Strength::Times(1.0)) });
    let answer = &case.manifest(&[]).answers[0];
    assert!(answer.windows.len() >= 3 && answer.windows.iter().all(|w| (20.0..=240.0).contains(&(w.2 - w.1))));
    let [x, y, _] = answer.equations.unwrap();
    assert!(y > x);
}

#[test]
fn strength_by_signal_to_noise_is_reached() {
    let case = make(&spec("current", Strength::Snr(12.0)));
    assert!((case.snr[0].unwrap() / 12.0 - 1.0).abs() < 0.1, "{:?}", case.snr);
}
