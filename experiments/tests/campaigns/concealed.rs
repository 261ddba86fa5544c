//! The concealed cases of every push: 13 of the campaign's, diagnosed by the program in a process of its own, and judged.
//! The whole campaign measures the diagnosis; this test only stops a change that breaks it.

use std::sync::Mutex;
use std::time::Duration;

use crate::support::{alone, program};
use trimtab_experiments::conceal::campaign::plan::{PUSH_SEED, ci_slice, plan};
use trimtab_experiments::conceal::judge::score::Score;
use trimtab_experiments::conceal::runner::Runner;

/// Effects seen among the 4 single ones, at a signal-to-noise ratio of 12.
const FEWEST_SEEN: usize = 3;
/// Of these, with the right name first.
const FEWEST_RIGHT: usize = 3;
/// Of these, with a right name in the confidence set.
const FEWEST_IN_SET: usize = 3;

/// The number of cases with the answer yes, and the keys of those with the answer no.
fn count(scores: &[Score], of: impl Fn(&Score) -> Option<bool>) -> (usize, Vec<String>) {
    let no = scores.iter().filter(|s| of(s) == Some(false)).map(|s| format!("{} ({})", s.case, s.named));
    (scores.iter().filter(|s| of(s) == Some(true)).count(), no.collect())
}

#[test]
fn a_slice_of_concealed_cases_is_judged_well_enough() {
    let _alone = alone();
    let folder = tempfile::tempdir().unwrap();
    let runner = Runner {
        tool: program(),
        limit: Duration::from_secs(300),
        folder: folder.path().to_owned(),
        keep: false,
        baselines: false,
        sindy: None,
    };
    let cases = ci_slice(&plan(PUSH_SEED));
    let scores = Mutex::new(Vec::new());
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    runner
        .all(&cases, workers, &|score| {
            scores.lock().unwrap().push(score);
            Ok(())
        })
        .unwrap();
    let scores = scores.into_inner().unwrap();
    assert_eq!(scores.len(), 13);
    let failed: Vec<String> = scores.iter().filter(|s| !s.error.is_empty()).map(|s| s.error.clone()).collect();
    assert!(failed.is_empty(), "without a score: {failed:?}");

    let single: Vec<Score> = scores.iter().filter(|s| s.arm == "single" || s.arm == "hulls").cloned().collect();
    // Noisy recordings of explicit Euler steps look like late positions, and are called so: no recording tells one from the other.
    let measured: Vec<Score> = scores.iter().filter(|s| s.background != "euler").cloned().collect();
    let (quiet, alarms) = count(&measured, |s| s.false_alarm.map(|a| !a));
    assert_eq!(quiet + alarms.len(), 4);
    assert!(alarms.is_empty(), "false alarms: {alarms:?}");
    let (seen, missed) = count(&single, |s| s.detected);
    assert!(seen >= FEWEST_SEEN, "missed: {missed:?}");
    let (right, wrong) = count(&single, |s| s.first_right);
    assert!(right >= FEWEST_RIGHT, "misnamed: {wrong:?}");
    let (in_set, outside) = count(&single, |s| s.in_set);
    assert!(in_set >= FEWEST_IN_SET, "outside the confidence set: {outside:?}");
    let (_, named) = count(&scores, |s| s.absorbed_named.map(|n| !n));
    assert!(named.is_empty(), "absorbed effects named: {named:?}");
    let (_, wrong) = count(&scores, |s| s.wrong_confident.map(|w| !w));
    assert!(wrong.is_empty(), "wrong and confident: {wrong:?}");
    // Pairs with at least one right name and none wrong.
    let (pairs, spoilt) = count(&scores, |s| s.some_right_none_wrong);
    assert!(pairs == 1 && spoilt.is_empty(), "pairs: {spoilt:?}");
}
