//! Text files that say at their head that trimtab wrote them and carry a checksum at their end, so that a cut one is recognised.
//! Both are comments of TOML; a file with neither is one that somebody wrote by hand, and is not judged here.

use super::digest::sha256;

/// How the first line of a written file begins.
const HEAD: &str = "# Written by trimtab";

/// How its last line begins; the digest of all lines before follows.
const FOOT: &str = "# SHA-256 of the lines above: ";

/// Why a text is not what was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Broken {
    /// It ends too early.
    #[error(
        "the file is cut: its first line says that trimtab wrote it, and its last line is not the checksum that trimtab writes; write or copy it again. If you edited it and meant to drop the checksum, delete the first line (`# Written by trimtab ...`) too"
    )]
    Cut,
    /// Its lines have changed.
    #[error(
        "the file is not as trimtab wrote it (its checksum differs): it is damaged, or was edited. If you edited it, delete its first line (`# Written by trimtab ...`) and its last (`# SHA-256 ...`), and it is read as your own; otherwise write or copy it again"
    )]
    Changed,
}

/// A text with a first line that says who wrote it, and a last line with its checksum. `use_it` ends the first line.
pub fn seal(use_it: &str, text: &str) -> String {
    let body = format!("{HEAD} {}; {use_it}\n{}\n", env!("CARGO_PKG_VERSION"), text.trim_end_matches('\n'));
    let digest = sha256(body.as_bytes());
    format!("{body}{FOOT}{digest}\n")
}

/// Whether a text is as it was written: `Ok(true)`, or by hand: `Ok(false)`. Ends of lines may have been changed to those of
/// another system.
///
/// # Errors
/// [`Broken`], where head or checksum are there and do not agree with the rest.
pub fn intact(text: &str) -> Result<bool, Broken> {
    let text = text.replace("\r\n", "\n");
    let (body, last) = match text.trim_end_matches('\n').rsplit_once('\n') {
        Some((body, last)) => (format!("{body}\n"), last),
        None => (String::new(), text.as_str()),
    };
    match (text.starts_with(HEAD), last.strip_prefix(FOOT)) {
        (false, None) => Ok(false),
        (true, Some(digest)) if digest.len() < 64 => Err(Broken::Cut),
        (_, Some(digest)) if digest.trim_end() == sha256(body.as_bytes()) => Ok(true),
        (true, None) => Err(Broken::Cut),
        _ => Err(Broken::Changed),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sealed_text_is_intact_on_every_system_and_a_written_one_is_not_judged() {
        let sealed = seal("use it", "a = 1\nb = 2\n");
        assert!(sealed.contains("; use it\na = 1\nb = 2\n# SHA-256 of the lines above: "), "{sealed}");
        for text in [sealed.clone(), sealed.replace('\n', "\r\n"), sealed.trim_end().to_owned(), sealed + "\n"] {
            assert_eq!(intact(&text), Ok(true), "{text}");
        }
        assert_eq!(intact("# my own\na = 1\n"), Ok(false));
        assert_eq!(intact(""), Ok(false));
    }

    #[test]
    fn a_text_that_was_cut_at_either_end_or_changed_is_reported() {
        let sealed = seal("use it", "a = 1\nb = 2\n");
        for end in HEAD.len()..sealed.len() - 1 {
            assert_eq!(intact(&sealed[..end]), Err(Broken::Cut), "{}", &sealed[..end]);
        }
        assert_eq!(intact(&sealed.replace("a = 1", "a = 2")), Err(Broken::Changed));
        for start in 1..sealed.find(FOOT).unwrap_or(0) {
            assert_eq!(intact(&sealed[start..]), Err(Broken::Changed), "{}", &sealed[start..]);
        }
    }
}
