//! How the study file says that recordings are cut into windows, checked.
//! The settings of fit, evaluation, diagnosis and trials are read by those who use them.

use super::file::{InitialKind, StudyFile};
use crate::files::written::Mistake;
use crate::recording::{Driven, Initial, WindowSettings, key_line};

/// The window settings of a study file, for every run; `from`, `to` and `draught` are set run by run.
///
/// # Errors
/// Every value that cannot be.
pub(super) fn window_settings(file: &StudyFile, text: &str) -> Result<WindowSettings, Vec<Mistake>> {
    let mut mistakes = Vec::new();
    let mut fail = |key: &str, message: String| mistakes.push(Mistake::new(key_line(text, key), message));
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
            fail(key, format!("`{key}` = {v} is not {what} in seconds; correct it"));
        }
    }
    match file.window {
        None if file.window_overlap > 0.0 => {
            fail(
                "window_overlap",
                "`window_overlap` has no effect without `window`; set the length of the windows, or drop it".into(),
            );
        }
        Some(window) if file.window_overlap >= window && window > 0.0 => {
            let overlap = file.window_overlap;
            let text = format!(
                "`window_overlap` = {overlap} s must be shorter than `window` = {window} s; correct one of them"
            );
            fail("window_overlap", text);
        }
        Some(window) if file.step.is_some_and(|step| step >= window && window > 0.0) => {
            let step = file.step.unwrap_or_default();
            fail("step", format!("`step` = {step} s must be shorter than `window` = {window} s; correct one of them"));
        }
        _ => {}
    }
    let initial = match (file.initial_state, file.initial_span) {
        (InitialKind::Smoothed, Some(span)) => Initial::Smoothed { span },
        (InitialKind::Smoothed, None) => {
            let text = "`initial_state = \"smoothed\"` needs `initial_span`, the seconds over which to estimate it";
            fail("initial_state", text.to_owned());
            Initial::First
        }
        (InitialKind::First, None) => Initial::First,
        (InitialKind::First, Some(_)) => {
            let text =
                "`initial_span` is given, but `initial_state` is \"first\"; set it to \"smoothed\", or drop the span";
            fail("initial_span", text.to_owned());
            Initial::First
        }
    };
    if !mistakes.is_empty() {
        return Err(mistakes);
    }
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
        driven: Driven::default(),
    })
}
