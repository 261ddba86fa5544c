//! The commands that follow a diagnosis, written out whole: the improved model against the base on every run, and its trials.
//! Both are of models that the diagnosis compared on unseen runs; nothing is run here.

use std::path::Path;

/// The comparison of the two models in `folder`, and a trial with the improved one, for a study and the faults that its
/// user accepts.
#[must_use]
pub fn next_commands(study: &Path, folder: &Path, accepted: &[String]) -> [String; 2] {
    let beside = |name: &str| match folder.parent().filter(|p| !p.as_os_str().is_empty()) {
        Some(parent) => parent.join(name),
        None => Path::new(name).to_owned(),
    };
    let quoted = |path: &Path| word(&path.display().to_string());
    let study = quoted(study);
    let accept: String = accepted.iter().map(|fault| format!(" --accept {}", word(fault))).collect();
    let improved = quoted(&folder.join("improved.toml"));
    [
        format!(
            "trimtab evaluate {study} --model {improved} --baseline {}{accept} --out {}",
            quoted(&folder.join("base.toml")),
            quoted(&beside("compared"))
        ),
        format!("trimtab maneuver turning {study} --model {improved} --out {}", quoted(&beside("turning"))),
    ]
}

/// Why these commands, in a sentence.
pub const NEXT_WORDS: &str = "Next: what the improved model is worth, run by run, and its turning circles:";

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
    use super::{next_commands, word};
    use std::path::Path;

    #[test]
    fn the_commands_name_the_files_of_the_folder_and_write_beside_it() {
        let [compare, turning] =
            next_commands(Path::new("my ship/study.toml"), Path::new("my ship/results"), &["rudder:sign".into()]);
        assert_eq!(
            compare,
            "trimtab evaluate 'my ship/study.toml' --model 'my ship/results/improved.toml' --baseline 'my ship/results/base.toml' \
             --accept rudder:sign --out 'my ship/compared'"
        );
        assert_eq!(
            turning,
            "trimtab maneuver turning 'my ship/study.toml' --model 'my ship/results/improved.toml' --out 'my ship/turning'"
        );
    }

    #[test]
    fn a_path_that_a_shell_would_take_apart_is_quoted() {
        assert_eq!(word("mine/study.toml"), "mine/study.toml");
        assert_eq!(word("my ship/study.toml"), "'my ship/study.toml'");
        assert_eq!(word("it's"), r"'it'\''s'");
    }
}
