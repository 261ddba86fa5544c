//! The text of a file: decoded, or the reason why there is none with the next step.
//! What the text says is not looked at.

use crate::files::suggestion;
use std::io::{Error, ErrorKind};
use std::path::Path;

/// Names of files that a message lists.
const LISTED: usize = 3;

/// The text of a file, without a byte order mark.
///
/// # Errors
/// Those of the file system and of text that is not UTF-8, worded for whoever wrote the path or the file.
pub fn read_text(path: &Path) -> Result<String, Error> {
    let bytes = bytes_of(path)?;
    if [[0xff, 0xfe], [0xfe, 0xff]].iter().any(|mark| bytes.starts_with(mark)) {
        return Err(Error::new(ErrorKind::InvalidData, "its text is UTF-16; save it as UTF-8"));
    }
    let text = String::from_utf8(bytes).map_err(|wrong| {
        let before = &wrong.as_bytes()[..wrong.utf8_error().valid_up_to()];
        let line = 1 + before.iter().filter(|b| **b == b'\n').count();
        Error::new(ErrorKind::InvalidData, format!("line {line} is not UTF-8 text; save the file as UTF-8"))
    })?;
    Ok(match text.strip_prefix('\u{feff}') {
        Some(rest) => rest.to_owned(),
        None => text,
    })
}

/// The bytes of a file.
///
/// # Errors
/// Those of the file system, worded for whoever wrote the path.
pub fn bytes_of(path: &Path) -> Result<Vec<u8>, Error> {
    // A device or a pipe may have no end, or no beginning.
    if std::fs::metadata(path).is_ok_and(|about| !about.is_file() && !about.is_dir()) {
        let words = "it is a pipe or a device and no file; write what it gives to a file, and name that";
        return Err(Error::new(ErrorKind::InvalidInput, words));
    }
    std::fs::read(path).map_err(|source| explained(path, source))
}

/// What the system says of a path, in words that lead on.
fn explained(path: &Path, source: Error) -> Error {
    if path.is_dir() {
        let mut files: Vec<String> = names(path).into_iter().filter(|n| n.ends_with(".toml")).collect();
        files.sort_by_key(|name| name != "study.toml");
        files.truncate(LISTED);
        let such: Vec<String> = files.iter().map(|n| format!("`{}`", path.join(n).display())).collect();
        let list = if such.is_empty() { String::new() } else { format!(", such as {}", such.join(" or ")) };
        return Error::new(source.kind(), format!("it is a folder; name a file in it{list}"));
    }
    if source.kind() != ErrorKind::NotFound {
        return source;
    }
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty());
    match folder.filter(|folder| !folder.is_dir()) {
        Some(folder) => Error::new(source.kind(), format!("there is no folder {}", folder.display())),
        None => Error::new(source.kind(), format!("there is no such file{}", near_file(path))),
    }
}

/// `, did you mean ...?` with a file of a like name where a missing file should be, of the same name in a folder beside it, or of the
/// same name but for upper and lower case; nothing where there is none.
pub fn near_file(file: &Path) -> String {
    let written = file.to_string_lossy();
    if cfg!(not(windows)) && written.contains('\\') {
        return ", write `/` instead of `\\` between folders and files".to_owned();
    }
    let Some(name) = file.file_name().map(|n| n.to_string_lossy().into_owned()) else { return String::new() };
    let folder = file.parent().unwrap_or(Path::new(""));
    let beside = names(folder);
    let near = suggestion(&name, beside.iter().map(String::as_str));
    if !near.is_empty() {
        return near;
    }
    // The folder itself may be another: the nearest above it that is there, or one in that.
    let base = file.ancestors().skip(1).find(|folder| folder.as_os_str().is_empty() || folder.is_dir());
    let base = base.unwrap_or(Path::new(""));
    let inner = names(base).into_iter().map(|n| base.join(n)).filter(|p| p.is_dir());
    for place in std::iter::once(base.to_owned()).chain(inner) {
        if let Some(same) = names(&place).into_iter().find(|n| n.eq_ignore_ascii_case(&name)) {
            return format!(", did you mean `{}`?", place.join(same).display());
        }
    }
    String::new()
}

/// Names of the files and folders in a folder, in order.
fn names(folder: &Path) -> Vec<String> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let entries = std::fs::read_dir(folder).into_iter().flatten();
    let mut names: Vec<String> =
        entries.filter_map(|e| e.ok().map(|e| e.file_name().to_string_lossy().into_owned())).collect();
    names.sort();
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    fn why(path: &Path) -> String {
        read_text(path).unwrap_err().to_string()
    }

    #[test]
    fn a_text_that_cannot_be_read_says_what_to_do() -> Result<(), Error> {
        let folder = tempfile::tempdir()?;
        let at = |name: &str| folder.path().join(name);
        std::fs::write(at("study.toml"), "\u{feff}name = 1\r\n")?;
        assert_eq!(read_text(&at("study.toml"))?, "name = 1\r\n");
        assert!(why(&at("stduy.toml")).contains("did you mean `study.toml`?"));
        assert!(why(folder.path()).contains("it is a folder; name a file in it, such as"));
        assert!(why(&at("nowhere/study.toml")).starts_with("there is no folder"));
        std::fs::write(at("latin.toml"), b"a = 1\nname = \"\xdcberfahrt\"\n")?;
        assert_eq!(why(&at("latin.toml")), "line 2 is not UTF-8 text; save the file as UTF-8");
        std::fs::write(at("wide.toml"), b"\xff\xfen\0")?;
        assert_eq!(why(&at("wide.toml")), "its text is UTF-16; save it as UTF-8");
        Ok(())
    }

    #[test]
    fn a_file_in_another_folder_or_case_is_found() -> Result<(), Error> {
        let folder = tempfile::tempdir()?;
        let at = |name: &str| folder.path().join(name);
        std::fs::create_dir(at("recordings"))?;
        std::fs::write(at("recordings/turn_1.csv"), "")?;
        for wrong in
            ["recordings/turn1.csv", "turn_1.csv", "data/turn_1.csv", "a/b/turn_1.csv", "Recordings/TURN_1.CSV"]
        {
            assert!(near_file(&at(wrong)).contains("turn_1.csv`?"), "{wrong}");
        }
        assert!(near_file(Path::new(r"recordings\turn_1.csv")).contains("write `/`"));
        assert_eq!(near_file(&at("zzz.csv")), "");
        Ok(())
    }
}
