//! Changed studies of every push: every fourth kind of change, through every command, and judged.
//! The whole campaign counts; this test only stops a change that lets something through.

use std::sync::Mutex;
use std::time::Duration;

use crate::support::{alone, program};
use trimtab_experiments::mutated::damage::DAMAGES;
use trimtab_experiments::mutated::edit::{HARMLESS, MISTAKES};
use trimtab_experiments::mutated::plan::plan;
use trimtab_experiments::mutated::row::{Outcome, Row};
use trimtab_experiments::mutated::runner::Runner;

/// A seed for development: the published one is used once, by the campaign.
const SEED: u64 = 31;

#[test]
fn changed_studies_are_refused_or_told_and_harmless_edits_change_nothing() {
    let _alone = alone();
    let folder = tempfile::tempdir().unwrap();
    let runner = Runner::new(program(), Duration::from_secs(60), folder.path().to_owned()).unwrap();
    let all = plan(HARMLESS.len() + MISTAKES.len() + DAMAGES.len(), SEED);
    let cases: Vec<_> = all.into_iter().step_by(4).collect();
    let rows: Mutex<Vec<Row>> = Mutex::new(Vec::new());
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    runner
        .all(&cases, workers, &|new| {
            rows.lock().unwrap().extend(new);
            Ok(())
        })
        .unwrap();
    let rows = rows.into_inner().unwrap();
    let diagnosed = cases.iter().filter(|c| c.diagnosed).count();
    assert_eq!(rows.len(), 4 * cases.len() + diagnosed);
    let wrong: Vec<String> = rows
        .iter()
        .filter(|r| !r.right)
        .map(|r| format!("{} ({}): {} {:?}, moved {:?}: {}", r.kind, r.what, r.command, r.outcome, r.moved, r.message))
        .collect();
    let broken = rows.iter().any(|r| matches!(r.outcome, Outcome::Panicked | Outcome::Hung | Outcome::Unclear));
    let unsound = rows.iter().any(|r| r.class != "damage" && !r.right);
    assert!(!broken && !unsound, "{wrong:#?}");
    // What is left of silent damage is counted by the campaign.
    let damaged = rows.iter().filter(|r| r.class == "damage").count();
    assert!(damaged > 0 && 10 * wrong.len() <= damaged, "{} of {damaged} answers: {wrong:#?}", wrong.len());
}
