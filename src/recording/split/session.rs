//! Sessions: what runs have in common that may share a hidden condition (a day, a voyage, a loading).
//! They are identified by gaps, by dates or by a pattern in the names of files.

/// How sessions are distinguished.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Sessions {
    /// As the study has them, else by gaps of half an hour.
    #[default]
    Known,
    /// By gaps in time of more than so many seconds, also from one recording to the next; each is one where nothing says when it began.
    Gaps(f64),
    /// By the date in the name of the file.
    Dates,
    /// Each file is one.
    Files,
    /// By the part of the file's name where the pattern has `{}`; `*` is anything.
    Pattern(String),
}

/// A longer gap begins another session, where nothing else is said \[s\].
pub const USUAL_GAP: f64 = 1800.0;

impl Sessions {
    /// From the value of a flag: `gaps`, `gaps=600`, `dates`, `files`, or a pattern with `{}`.
    ///
    /// # Errors
    /// What is wrong and what to give.
    pub fn parse(text: &str) -> Result<Self, String> {
        match text {
            "gaps" => return Ok(Self::Gaps(USUAL_GAP)),
            "dates" => return Ok(Self::Dates),
            "files" => return Ok(Self::Files),
            _ => {}
        }
        if let Some(seconds) = text.strip_prefix("gaps=") {
            let seconds: Option<f64> = seconds.parse().ok().filter(|s: &f64| s.is_finite() && *s > 0.0);
            return seconds
                .map(Self::Gaps)
                .ok_or_else(|| format!("--sessions {text}: give a positive number of seconds, as in gaps=600"));
        }
        if text.matches("{}").count() == 1 {
            return Ok(Self::Pattern(text.to_owned()));
        }
        Err(format!(
            "--sessions {text}: give gaps, gaps=SECONDS, dates, files, or a pattern of file names with one {{}} for the session, as in `trial_{{}}_*`"
        ))
    }

    /// The session that the name of a file gives; `None` where names do not give one.
    ///
    /// # Errors
    /// What is wrong and what to do.
    pub fn of_file(&self, stem: &str) -> Result<Option<String>, String> {
        match self {
            Self::Known | Self::Gaps(_) => Ok(None),
            Self::Files => Ok(Some(stem.to_owned())),
            Self::Dates => date(stem).map(Some).ok_or_else(|| {
                format!("--sessions dates: the name `{stem}` has no date such as 2024-05-01 or 20240501; use gaps, files or a pattern")
            }),
            Self::Pattern(pattern) => captured(pattern, stem).map(Some).ok_or_else(|| {
                format!("--sessions {pattern}: the name `{stem}` is not of that pattern; `*` is anything, `{{}}` the session")
            }),
        }
    }
}

/// The first date in a name, as `2024-05-01`.
pub fn date(stem: &str) -> Option<String> {
    let bytes = stem.as_bytes();
    (0..bytes.len()).find_map(|i| {
        let digits = |from: usize, count: usize| {
            let text = stem.get(i + from..i + from + count)?;
            text.bytes().all(|b| b.is_ascii_digit()).then_some(text)
        };
        let dash = |at: usize| stem.get(i + at..=i + at).is_some_and(|c| c == "-" || c == "_");
        let (year, month, day) = if dash(4) && dash(7) {
            (digits(0, 4)?, digits(5, 2)?, digits(8, 2)?)
        } else {
            (digits(0, 4)?, digits(4, 2)?, digits(6, 2)?)
        };
        let within = |text: &str, low: u32, high: u32| text.parse().is_ok_and(|v: u32| (low..=high).contains(&v));
        (within(year, 1950, 2150) && within(month, 1, 12) && within(day, 1, 31))
            .then(|| format!("{year}-{month}-{day}"))
    })
}

/// The part of a name where a pattern has `{}`.
fn captured(pattern: &str, name: &str) -> Option<String> {
    let (before, after) = pattern.split_once("{}")?;
    // The shortest part that fits, from the first place that fits.
    let ends: Vec<usize> = name.char_indices().map(|(i, _)| i).chain([name.len()]).collect();
    for start in &ends {
        for end in ends.iter().filter(|e| *e > start) {
            if fits(before, &name[..*start]) && fits(after, &name[*end..]) {
                return Some(name[*start..*end].to_owned());
            }
        }
    }
    None
}

/// Whether a name is of a pattern in which `*` is anything.
fn fits(pattern: &str, name: &str) -> bool {
    let mut parts = pattern.split('*');
    let Some(mut rest) = parts.next().and_then(|first| name.strip_prefix(first)) else { return false };
    let mut parts: Vec<&str> = parts.collect();
    let Some(last) = parts.pop() else { return rest.is_empty() };
    for part in parts {
        let Some(at) = rest.find(part) else { return false };
        rest = &rest[at + part.len()..];
    }
    rest.ends_with(last)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_files_give_sessions() {
        assert_eq!(date("trial_20240501_run3").as_deref(), Some("2024-05-01"));
        assert_eq!(date("2024-05-01_100000").as_deref(), Some("2024-05-01"));
        assert_eq!(date("run_99887766"), None);
        let session = |pattern: &str, stem| Sessions::parse(pattern).unwrap().of_file(stem).unwrap_or(None);
        assert_eq!(session("trial_{}_*", "trial_day2_run_5").as_deref(), Some("day2"));
        assert_eq!(session("*-{}", "a-b-3").as_deref(), Some("b-3"));
        assert_eq!(session("files", "a"), Some("a".to_owned()));
        assert_eq!(session("trial_{}_*", "other"), None);
        assert!(Sessions::parse("weeks").is_err() && Sessions::parse("gaps=-1").is_err());
        assert_eq!(Sessions::parse("gaps=60"), Ok(Sessions::Gaps(60.0)));
    }
}
