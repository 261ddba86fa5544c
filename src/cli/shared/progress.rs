//! The line on standard error that says what a long computation is doing: a moving one on a terminal, one a minute elsewhere.
//! Results and messages are in `output` and `error`.

use super::terminal::plain;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use trimtab::files::progress::{Teller, left, words};

/// Says what a computation is doing, until it is finished or dropped.
pub struct Progress {
    bar: ProgressBar,
    teller: Option<Teller>,
}

/// Whether progress is printed: by the command alone, and not where another program calls its parts.
static SHOWN: AtomicBool = AtomicBool::new(false);

/// Prints progress from now on.
pub fn tell_progress() {
    SHOWN.store(true, Ordering::Relaxed);
}

/// A progress line while a computation runs. Where standard error is no terminal, the first line comes after a minute.
pub fn progress(doing: impl Into<String>) -> Progress {
    let doing = doing.into();
    if !SHOWN.load(Ordering::Relaxed) {
        return Progress { bar: ProgressBar::hidden(), teller: None };
    }
    let bar = ProgressBar::new_spinner();
    if !std::io::stderr().is_terminal() {
        return Progress { bar: ProgressBar::hidden(), teller: Some(Teller::new("trimtab", &plain(&doing))) };
    }
    if let Ok(style) = ProgressStyle::with_template("{spinner} {msg} ({elapsed})") {
        bar.set_style(style);
    }
    bar.set_message(plain(&doing).into_owned());
    bar.enable_steady_tick(Duration::from_millis(120));
    Progress { bar, teller: None }
}

impl Progress {
    /// Says what is being done now.
    pub fn set_message(&self, doing: impl Into<String>) {
        let doing = plain(&doing.into()).into_owned();
        if let Some(teller) = &self.teller {
            teller.say(&doing);
        }
        self.bar.set_message(doing);
    }

    /// Says what is being done now, and how many parts of how many are done.
    pub fn part(&self, doing: impl Into<String>, done: usize, of: usize) {
        let doing = doing.into();
        if let Some(teller) = &self.teller {
            teller.part(done, of);
            self.set_message(doing);
        } else {
            let left =
                left(self.bar.elapsed(), done, of).map_or(String::new(), |t| format!(", about {} left", words(t)));
            self.set_message(doing + &left);
        }
    }

    /// Ends the line.
    pub fn finish_and_clear(self) {
        self.bar.finish_and_clear();
    }
}
