//! One recording that is shorter than all others, which have one length: its file may have been cut.
//! Runs of several lengths are not compared.

use crate::numerals::sig;
use crate::recording::Recording;
use crate::recording::audit::issue::{Issue, Severity, Shared};
use crate::recording::audit::limits::LENGTH_RUNS;
use serde::{Deserialize, Serialize};

/// Length of a recording that a study uses whole.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Length {
    /// From first to last row \[s\].
    duration: f64,
    /// Usual step \[s\].
    step: f64,
    /// Last line.
    line: usize,
}

impl Length {
    /// That of a recording; `None` without rows.
    pub fn of(recording: &Recording) -> Option<Self> {
        let (first, last) = (recording.time().first()?, recording.time().last()?);
        Some(Self { duration: last - first, step: recording.step(), line: recording.line(recording.len() - 1) })
    }
}

/// The one recording that ends before all others, which are of one length to a step. `None` in the list: used in part.
pub fn shorter(runs: &[(&str, Option<Length>)]) -> Option<Shared> {
    let known: Vec<(&str, Length)> = runs.iter().filter_map(|(run, length)| Some((*run, (*length)?))).collect();
    let (run, short) = known.iter().min_by(|a, b| a.1.duration.total_cmp(&b.1.duration))?;
    let others = || known.iter().filter(|(other, _)| other != run).map(|(_, length)| length.duration);
    let (least, most) = others().fold((f64::INFINITY, 0.0), |(l, m): (f64, f64), d| (l.min(d), m.max(d)));
    let alike = most - least <= short.step && least - short.duration > short.step;
    if known.len() < LENGTH_RUNS || !alike {
        return None;
    }
    let text = format!(
        "the recording ends after {} s (line {}), where the {} others have {} s each",
        sig(short.duration, 4),
        short.line,
        known.len() - 1,
        sig(most, 4)
    );
    let next = "is the file whole? If the run was shorter, nothing is to be done";
    let issue = Issue::new(Severity::Warning, "shorter", text, next).at((short.line, short.line));
    Some(Shared { runs: vec![(*run).to_owned()], issue })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(durations: &[f64]) -> Option<Vec<String>> {
        let names: Vec<String> = (0..durations.len()).map(|i| format!("r{i}")).collect();
        let length = |duration: &f64| Some(Length { duration: *duration, step: 2.0, line: 9 });
        let runs: Vec<(&str, Option<Length>)> =
            names.iter().map(String::as_str).zip(durations.iter().map(length)).collect();
        shorter(&runs).map(|shared| shared.runs)
    }

    #[test]
    fn one_recording_that_ends_before_all_others_is_reported() {
        assert_eq!(found(&[240.0, 240.0, 240.0, 130.0, 240.0, 242.0, 240.0, 240.0]), Some(vec!["r3".to_owned()]));
    }

    #[test]
    fn recordings_of_several_lengths_a_step_and_a_longer_one_are_no_doubt() {
        assert_eq!(found(&[240.0; 8]), None);
        assert_eq!(found(&[240.0, 240.0, 240.0, 238.0, 240.0, 240.0, 240.0, 240.0]), None);
        assert_eq!(found(&[240.0, 240.0, 240.0, 400.0, 240.0, 240.0, 240.0, 240.0]), None);
        assert_eq!(found(&[240.0, 200.0, 240.0, 130.0, 240.0, 240.0, 240.0, 240.0]), None);
        assert_eq!(found(&[240.0, 130.0, 240.0]), None);
        assert_eq!(shorter(&[]), None);
    }
}
