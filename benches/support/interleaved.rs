//! Times of several computations measured in turn, so that other work on the machine slows all of them alike.
//! It knows no ship and draws no conclusion: it returns the least processor time of each.

use rustix::time::{ClockId, clock_gettime};

/// A computation to be timed, with what it is.
pub type Task<'a> = (String, Box<dyn FnMut() + 'a>);

/// Processor time of this process \[s\].
pub fn processor_time() -> f64 {
    let t = clock_gettime(ClockId::ProcessCPUTime);
    t.tv_sec as f64 + 1e-9 * t.tv_nsec as f64
}

/// The least processor time \[s\] of each task over a number of rounds; in each round every task runs once.
pub fn least(rounds: usize, tasks: &mut [Task]) -> Vec<f64> {
    let mut times = vec![f64::INFINITY; tasks.len()];
    for _ in 0..rounds {
        for ((_, task), time) in tasks.iter_mut().zip(&mut times) {
            let start = processor_time();
            task();
            *time = time.min(processor_time() - start);
        }
    }
    times
}
