//! Times of several computations measured in turn, so that other work on the machine slows all of them alike.
//! It depends on no ship and draws no conclusion: it returns the least processor time of each, and how well that repeats.

// Each program that includes this file takes a part of it.
#![allow(dead_code)]

use rustix::time::{ClockId, clock_gettime};

/// A computation to be timed, with what it is.
pub type Task<'a> = (String, Box<dyn FnMut() + 'a>);

/// Processor time of this process \[s\].
pub fn processor_time() -> f64 {
    let t = clock_gettime(ClockId::ProcessCPUTime);
    t.tv_sec as f64 + 1e-9 * t.tv_nsec as f64
}

/// What repeats of one computation took.
#[derive(Clone, Copy, Debug)]
pub struct Repeats {
    /// Least processor time \[s\].
    pub least: f64,
    /// By how much the second least is longer, as a share: what the machine adds to a time.
    pub scatter: f64,
}

impl Repeats {
    /// Of times \[s\].
    pub fn of(times: &[f64]) -> Self {
        let mut sorted = times.to_vec();
        sorted.sort_by(f64::total_cmp);
        let least = sorted.first().copied().unwrap_or(f64::NAN);
        Self { least, scatter: sorted.get(1).map_or(f64::INFINITY, |second| second / least - 1.0) }
    }
}

/// Processor times of each task over a number of rounds; in each round every task runs once.
pub fn repeats(rounds: usize, tasks: &mut [Task]) -> Vec<Repeats> {
    let mut times = vec![Vec::with_capacity(rounds); tasks.len()];
    for _ in 0..rounds {
        for ((_, task), times) in tasks.iter_mut().zip(&mut times) {
            let start = processor_time();
            task();
            times.push(processor_time() - start);
        }
    }
    times.iter().map(|times| Repeats::of(times)).collect()
}

/// The least processor time \[s\] of each task over a number of rounds.
pub fn least(rounds: usize, tasks: &mut [Task]) -> Vec<f64> {
    repeats(rounds, tasks).iter().map(|repeats| repeats.least).collect()
}
