//! Runs that only prove: those that the user marked, or a part of the recordings that is set aside where none is marked.
//! It divides and orders recordings and looks at no value in them.

use crate::diagnose::settings::{FEWEST_RECORDINGS, FEWEST_RUNS};
use crate::recording::Run;
use std::borrow::Cow;

/// Runs to find with, and runs to prove with.
pub struct Divided<'r> {
    /// To locate, name and model with.
    pub training: Cow<'r, [Run]>,
    /// To prove with.
    pub held_out: Cow<'r, [Run]>,
    /// Recordings that were set aside here; 0 where the user marked some.
    pub set_aside: usize,
}

/// Runs in the order of their sessions, recordings and names: the order in which a user lists them is no part of an answer.
fn ordered(mut runs: Cow<[Run]>) -> Cow<[Run]> {
    fn key(run: &Run) -> (&str, &str, &str) {
        (&run.session, &run.recording, &run.name)
    }
    if !runs.is_sorted_by_key(key) {
        runs.to_mut().sort_by(|a, b| key(a).cmp(&key(b)));
    }
    runs
}

impl<'r> Divided<'r> {
    /// Keeps the user's division; without held-out runs every fourth recording, and at least three, are set aside, where there are enough. Recordings stay
    /// whole: runs of one share what is unknown.
    pub fn new(training: Cow<'r, [Run]>, held_out: &'r [Run]) -> Self {
        let training = ordered(training);
        if !held_out.is_empty() {
            return Self { training, held_out: Cow::Borrowed(held_out), set_aside: 0 };
        }
        let mut recordings: Vec<&str> = Vec::new();
        for run in training.iter() {
            if !recordings.contains(&run.recording.as_str()) {
                recordings.push(&run.recording);
            }
        }
        if recordings.len() < 2 * FEWEST_RUNS {
            return Self { training, held_out: Cow::Owned(Vec::new()), set_aside: 0 };
        }
        let count = FEWEST_RECORDINGS.max(recordings.len() / FEWEST_RUNS);
        let aside: Vec<String> = (1..=count).map(|i| recordings[i * recordings.len() / count - 1].to_owned()).collect();
        let (held_out, kept): (Vec<Run>, Vec<Run>) =
            training.into_owned().into_iter().partition(|r| aside.contains(&r.recording));
        Self { training: Cow::Owned(kept), held_out: Cow::Owned(held_out), set_aside: aside.len() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{model, runs};

    #[test]
    fn marked_runs_are_kept_and_else_every_fourth_recording_is_set_aside_whole() {
        let mut all = runs(&model(), 16);
        let marked = Divided::new(Cow::Borrowed(&all[..12]), &all[12..]);
        assert_eq!((marked.training.len(), marked.held_out.len(), marked.set_aside), (12, 4, 0));
        // Windows of one recording go together.
        for (i, r) in all.iter_mut().enumerate() {
            r.recording = format!("recording {}", i / 2);
            r.session = "a".into();
        }
        let divided = Divided::new(Cow::Borrowed(&all), &[]);
        assert_eq!((divided.training.len(), divided.held_out.len(), divided.set_aside), (10, 6, 3));
        let of = |runs: &[Run]| -> Vec<String> { runs.iter().map(|r| r.recording.clone()).collect() };
        assert_eq!(of(&divided.held_out)[0], "recording 1");
        assert!(of(&divided.training).iter().all(|r| !of(&divided.held_out).contains(r)));
    }

    #[test]
    fn the_order_in_which_runs_are_listed_is_no_part_of_the_division() {
        let all = runs(&model(), 16);
        let mut turned = all.clone();
        turned.reverse();
        turned.swap(3, 11);
        let names = |runs: &[Run]| -> Vec<String> { runs.iter().map(|r| r.name.clone()).collect() };
        for held_out in [0, 4] {
            let of = |all: &[Run], some: &[Run]| {
                let Divided { training, held_out, set_aside } = Divided::new(Cow::Borrowed(all), some);
                (names(&training), names(&held_out), set_aside)
            };
            let some = &all[..held_out];
            assert_eq!(of(&turned, some), of(&all, some));
        }
    }

    #[test]
    fn few_recordings_all_train() {
        let all = runs(&model(), 7);
        let divided = Divided::new(Cow::Owned(all), &[]);
        assert_eq!((divided.training.len(), divided.held_out.len(), divided.set_aside), (7, 0, 0));
        let more = Divided::new(Cow::Owned(runs(&model(), 8)), &[]);
        assert_eq!((more.training.len(), more.held_out.len(), more.set_aside), (5, 3, 3));
    }
}
