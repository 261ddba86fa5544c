//! How the study file says that recordings are cut into windows, checked.
//! The settings of fit, evaluation, diagnosis and trials are read by those who use them.

use super::error::StudyError;
use super::file::{InitialKind, StudyFile};
use crate::recording::{Initial, WindowSettings, key_line};
use std::path::Path;

/// The window settings of a study file, for every run; `from`, `to` and `draught` are set run by run.
pub(super) fn window_settings(file: &StudyFile, text: &str, path: &Path) -> Result<WindowSettings, StudyError> {
    let fail = |key: &str, message| StudyError::Parse { path: path.to_owned(), line: key_line(text, key), message };
    let times = [
        ("step", file.step, true),
        ("window", file.window, true),
        ("initial_span", file.initial_span, true),
        ("window_overlap", Some(file.window_overlap), false),
        ("discard_start", Some(file.discard_start), false),
        ("discard_end", Some(file.discard_end), false),
    ];
    for (key, value, positive) in times {
        if let Some(v) = value.filter(|v| !v.is_finite() || *v < 0.0 || (positive && *v == 0.0)) {
            let what = if positive { "a positive time" } else { "a time of 0 or more" };
            return Err(fail(key, format!("`{key}` = {v} is not {what} in seconds; correct it")));
        }
    }
    let initial = match (file.initial_state, file.initial_span) {
        (InitialKind::First, None) => Initial::First,
        (InitialKind::First, Some(_)) => {
            let text =
                "`initial_span` is given, but `initial_state` is \"first\"; set it to \"smoothed\", or drop the span";
            return Err(fail("initial_span", text.to_owned()));
        }
        (InitialKind::Smoothed, Some(span)) => Initial::Smoothed { span },
        (InitialKind::Smoothed, None) => {
            let text = "`initial_state = \"smoothed\"` needs `initial_span`, the seconds over which to estimate it";
            return Err(fail("initial_state", text.to_owned()));
        }
    };
    Ok(WindowSettings {
        step: file.step,
        window: file.window,
        overlap: file.window_overlap,
        discard_start: file.discard_start,
        discard_end: file.discard_end,
        from: None,
        to: None,
        initial,
        gaps: file.gaps,
        draught: f64::NAN,
    })
}
