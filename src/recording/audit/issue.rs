//! A doubt about recordings: what it is, how much it weighs, what was seen and what to do next.
//! It finds no fault itself; the checks of recordings are in the other files of this folder.

use crate::recording::Channel;
use serde::{Deserialize, Serialize};

/// How much an issue weighs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// Worth knowing.
    Note,
    /// Results may suffer: look before fitting.
    Warning,
    /// The recording contradicts itself, or cannot be used.
    Error,
}

/// A doubt about a recording.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Issue {
    /// How much it weighs.
    pub severity: Severity,
    /// What kind of fault it is, in a word or two: `sign_error`, `gap`.
    pub fault: &'static str,
    /// The channel it is about, if one.
    pub channel: Option<Channel>,
    /// First and last line it is about, if some.
    pub lines: Option<(usize, usize)>,
    /// What was found.
    pub text: String,
    /// What to do next.
    pub next_step: String,
}

/// A doubt about some runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Shared {
    /// The runs, by name.
    pub runs: Vec<String>,
    /// The doubt; its text names the runs where they are several.
    pub issue: Issue,
}

impl Issue {
    /// An issue about recordings as a whole.
    pub fn new(severity: Severity, fault: &'static str, text: impl Into<String>, next_step: impl Into<String>) -> Self {
        Self { severity, fault, channel: None, lines: None, text: text.into(), next_step: next_step.into() }
    }

    /// The same about one channel.
    #[must_use]
    pub fn of(mut self, channel: Channel) -> Self {
        self.channel = Some(channel);
        self
    }

    /// The same about some lines of the file, first and last, where they are known.
    #[must_use]
    pub fn at(mut self, lines: impl Into<Option<(usize, usize)>>) -> Self {
        self.lines = lines.into();
        self
    }

    /// True when it must be mended before anything is concluded.
    pub fn blocking(&self) -> bool {
        self.severity == Severity::Error
    }
}
