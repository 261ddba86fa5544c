//! The line on standard error that says what a long computation is doing.
//! Results and messages are in `output` and `error`.

use indicatif::{ProgressBar, ProgressStyle};
use std::time::Duration;

/// A progress line on standard error while a computation runs; nothing if standard error is not a terminal.
pub fn progress(doing: impl Into<String>) -> ProgressBar {
    let bar = ProgressBar::new_spinner();
    if let Ok(style) = ProgressStyle::with_template("{spinner} {msg} ({elapsed})") {
        bar.set_style(style);
    }
    bar.set_message(doing.into());
    bar.enable_steady_tick(Duration::from_millis(120));
    bar
}
