//! Files that are there whole or not at all: written aside, then renamed.
//! The callers decide what is in a file, and how a failure is reported.

use std::io::{BufWriter, Error, Write};
use std::path::Path;

/// Writes a file whole: into a file of another name in the same folder, which takes the place of `path` once everything is in it.
/// Whoever reads `path` meanwhile finds what was there before.
///
/// # Errors
/// Those of the file system; what was at `path` before is then still there.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    fill_whole(path, |file| file.write_all(bytes))
}

/// As [`write_whole`], with what `fill` writes piece by piece.
///
/// # Errors
/// Those of the file system and of `fill`; what was at `path` before is then still there.
pub fn fill_whole(path: &Path, fill: impl FnOnce(&mut dyn Write) -> Result<(), Error>) -> Result<(), Error> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    builder.prefix(".unfinished-");
    #[cfg(unix)]
    builder.permissions(usual());
    let mut aside = BufWriter::new(builder.tempfile_in(folder)?);
    fill(&mut aside)?;
    aside.into_inner()?.persist(path)?;
    Ok(())
}

/// The permissions of a file that is made in the usual way; the user's mask takes its part away.
#[cfg(unix)]
fn usual() -> std::fs::Permissions {
    use std::os::unix::fs::PermissionsExt;
    std::fs::Permissions::from_mode(0o666)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_takes_the_place_of_the_one_before_and_leaves_nothing_beside_it() -> Result<(), Error> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("result.csv");
        for text in ["first, and longer", "second"] {
            write_whole(&path, text.as_bytes())?;
            assert_eq!(std::fs::read_to_string(&path)?, text);
        }
        assert_eq!(std::fs::read_dir(folder.path())?.count(), 1);
        Ok(())
    }

    #[test]
    fn what_cannot_be_written_leaves_the_file_before_and_nothing_beside_it() -> Result<(), Error> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("taken");
        std::fs::create_dir(&path)?;
        assert!(write_whole(&path, b"text").is_err());
        assert!(path.is_dir() && std::fs::read_dir(folder.path())?.count() == 1);
        Ok(())
    }
}
