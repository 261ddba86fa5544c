//! The commands that follow a diagnosis, written out whole: the fit of the improved model with the ship's own hull free, and its trials.
//! What is freed is decided in [`crate::diagnose::refine`]; nothing is run here.

use crate::diagnose::Diagnosis;
use crate::diagnose::refine::to_free;
use std::path::Path;

/// The fit of the improved model that `folder` holds, and a trial with its outcome, for a study and the faults that its user accepts.
#[must_use]
pub fn next_commands(d: &Diagnosis, study: &Path, folder: &Path, accepted: &[String]) -> [String; 2] {
    let beside = |name: &str| match folder.parent().filter(|p| !p.as_os_str().is_empty()) {
        Some(parent) => parent.join(name),
        None => Path::new(name).to_owned(),
    };
    let quoted = |path: &Path| word(&path.display().to_string());
    let study = quoted(study);
    let improved = quoted(&folder.join("improved.toml"));
    let accept: String = accepted.iter().map(|fault| format!(" --accept {}", word(fault))).collect();
    let names = to_free(d.sides.as_ref(), &d.model);
    let free = if names.is_empty() { String::new() } else { format!(" --free {}", names.join(",")) };
    let refined = beside("refined");
    [
        format!("trimtab fit {study} --model {improved} --free-hull{free}{accept} --out {}", quoted(&refined)),
        format!(
            "trimtab maneuver turning {study} --model {} --out {}",
            quoted(&refined.join("fitted.toml")),
            quoted(&beside("turning"))
        ),
    ]
}

/// Why these commands, in a sentence.
#[must_use]
pub fn next_words(d: &Diagnosis) -> String {
    let names = to_free(d.sides.as_ref(), &d.model);
    let sides = if names.is_empty() {
        String::new()
    } else {
        format!(", and with it what differs between port and starboard ({})", names.join(", "))
    };
    format!(
        "Next, for the manoeuvres of the ship itself: improved.toml keeps the hull near its estimate; these commands free it{sides}, and sail the circles:"
    )
}

/// A word of a command line, quoted where a shell would take it apart.
fn word(text: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "/._-+,:=@%\\".contains(c);
    if !text.is_empty() && text.chars().all(plain) {
        text.to_owned()
    } else {
        format!("'{}'", text.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::word;

    #[test]
    fn a_path_that_a_shell_would_take_apart_is_quoted() {
        assert_eq!(word("mine/study.toml"), "mine/study.toml");
        assert_eq!(word("my ship/study.toml"), "'my ship/study.toml'");
        assert_eq!(word("it's"), r"'it'\''s'");
    }
}
