//! The progress of a long work, printed a line a minute where no terminal shows it, with an estimate of the time left.
//! It does no work, and nothing depends on what it prints.

use std::io::Write;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Time between two lines.
const PERIOD: Duration = Duration::from_secs(60);

/// What is being done, and how much of it is done.
#[derive(Debug, Default)]
struct State {
    doing: String,
    done: usize,
    of: usize,
    ended: bool,
}

type Shared = Arc<(Mutex<State>, Condvar)>;

/// Prints how far a work is, once in a while, until it is dropped.
#[derive(Debug)]
pub struct Teller {
    shared: Shared,
    began: Instant,
    thread: Option<JoinHandle<()>>,
}

impl Teller {
    /// Prints a line a minute on standard error, each beginning with `name`; the first after a minute.
    pub fn new(name: &str, doing: &str) -> Self {
        let name = name.to_owned();
        // Without a reader there is nothing to do about it.
        Self::with(PERIOD, doing, move |line| drop(writeln!(std::io::stderr().lock(), "{name}: {line}")))
    }

    /// As [`Self::new`], with another period and another place.
    pub fn with(period: Duration, doing: &str, tell: impl Fn(&str) + Send + 'static) -> Self {
        let state = State { doing: doing.to_owned(), ..State::default() };
        let shared: Shared = Arc::new((Mutex::new(state), Condvar::new()));
        let (own, began) = (Arc::clone(&shared), Instant::now());
        let thread = std::thread::spawn(move || {
            let mut state = locked(&own);
            loop {
                let (next, waited) =
                    own.1.wait_timeout_while(state, period, |s| !s.ended).unwrap_or_else(PoisonError::into_inner);
                state = next;
                if !waited.timed_out() {
                    return;
                }
                tell(&line(&state, began.elapsed()));
            }
        });
        Self { shared, began, thread: Some(thread) }
    }

    /// Says what is being done now.
    pub fn say(&self, doing: &str) {
        doing.clone_into(&mut locked(&self.shared).doing);
    }

    /// Says how many parts of how many are done, of equal size as far as anyone knows.
    pub fn part(&self, done: usize, of: usize) {
        let mut state = locked(&self.shared);
        (state.done, state.of) = (done, of);
    }

    /// Time since it began.
    pub fn elapsed(&self) -> Duration {
        self.began.elapsed()
    }
}

impl Drop for Teller {
    fn drop(&mut self) {
        locked(&self.shared).ended = true;
        self.shared.1.notify_all();
        if let Some(thread) = self.thread.take() {
            // It prints and nothing else; a failure there is no failure of the work.
            let _ = thread.join();
        }
    }
}

fn locked(shared: &Shared) -> MutexGuard<'_, State> {
    shared.0.lock().unwrap_or_else(PoisonError::into_inner)
}

fn line(state: &State, elapsed: Duration) -> String {
    let left =
        left(elapsed, state.done, state.of).map_or(String::new(), |left| format!(", about {} left", words(left)));
    format!("{} ({} so far{left})", state.doing, words(elapsed))
}

/// The time that is left when `done` parts of `of` took so long; `None` before the first part.
pub fn left(elapsed: Duration, done: usize, of: usize) -> Option<Duration> {
    let share = of.saturating_sub(done) as f64 / done as f64;
    (done > 0).then(|| Duration::try_from_secs_f64(elapsed.as_secs_f64() * share).ok()).flatten()
}

/// A time as people say it: `40 s`, `12 min`, `3 h 5 min`.
pub fn words(time: Duration) -> String {
    let seconds = time.as_secs();
    match (seconds / 60 + u64::from(seconds % 60 >= 30), seconds) {
        (_, 0..100) => format!("{seconds} s"),
        (minutes, 100..7200) => format!("{minutes} min"),
        (minutes, _) => format!("{} h {} min", minutes / 60, minutes % 60),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use std::sync::mpsc;

    #[test]
    fn lines_come_while_the_work_lasts_and_say_what_is_left() {
        let (send, lines) = mpsc::channel();
        let tell = move |line: &str| send.send(line.to_owned()).unwrap();
        let teller = Teller::with(Duration::from_millis(5), "reading", tell);
        assert_eq!(lines.recv().unwrap(), "reading (0 s so far)");
        teller.say("fitting from 4 starts");
        teller.part(1, 4);
        assert!(lines.iter().any(|line| line == "fitting from 4 starts (0 s so far, about 0 s left)"));
        drop(teller);
        // The teller ended, and with it the sender.
        assert!(lines.iter().count() < usize::MAX);
    }

    #[test]
    fn what_is_left_is_in_proportion_to_what_is_done() {
        let minute = Duration::from_secs(60);
        assert_eq!(left(minute, 0, 4), None);
        assert_eq!(left(minute, 1, 4), Some(3 * minute));
        assert_eq!(left(minute, 4, 4), Some(Duration::ZERO));
        assert_eq!(left(Duration::MAX, 1, usize::MAX), None);
        let said = [0, 99, 100, 150, 7199, 7200, 11_100].map(|s| words(Duration::from_secs(s)));
        assert_eq!(said, ["0 s", "99 s", "2 min", "3 min", "120 min", "2 h 0 min", "3 h 5 min"]);
    }
}
