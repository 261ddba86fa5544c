//! Parts of a long work, a line each as they are done, so that a work that was killed goes on where it was.
//! What a part is, and when the work is done, is with those who write it.

use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fs::{File, OpenOptions};
use std::io::{Error, Write};
use std::path::{Path, PathBuf};

/// A file of parts done, which belongs to one work, known by its key.
#[derive(Debug)]
pub struct Log {
    path: PathBuf,
    file: File,
}

impl Log {
    /// Opens the log of a work and gives the parts that are done. A part that was torn when the work was killed is dropped; so are
    /// the parts of a work with another key.
    ///
    /// # Errors
    /// Those of the file system.
    pub fn open<T: DeserializeOwned>(path: &Path, key: &str) -> Result<(Self, Vec<T>), Error> {
        let text = std::fs::read(path).unwrap_or_default();
        let head = format!("{key}\n");
        let file = OpenOptions::new().create(true).append(true).open(path)?;
        let mut log = Self { path: path.to_owned(), file };
        let (mut whole, mut parts) = (0, Vec::new());
        if text.starts_with(head.as_bytes()) {
            whole = head.len();
            for line in text[whole..].split_inclusive(|byte| *byte == b'\n').filter(|line| line.ends_with(b"\n")) {
                let Ok(part) = serde_json::from_slice(line) else { break };
                parts.push(part);
                whole += line.len();
            }
        }
        log.file.set_len(whole as u64)?;
        if whole == 0 {
            log.file.write_all(head.as_bytes())?;
        }
        Ok((log, parts))
    }

    /// Appends a part that is done.
    ///
    /// # Errors
    /// Those of the file system.
    pub fn append(&mut self, part: &impl Serialize) -> Result<(), Error> {
        let mut line = serde_json::to_vec(part)?;
        line.push(b'\n');
        self.file.write_all(&line)
    }

    /// Removes the log of a work that is done.
    pub fn remove(self) {
        let _ = std::fs::remove_file(&self.path);
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// What a work does with its parts: those that are not in the log are done, and appended.
    fn go_on(path: &Path, key: &str, parts: &[(usize, f64, String)]) -> usize {
        let (mut log, done) = Log::open::<(usize, f64, String)>(path, key).unwrap();
        assert_eq!(done, parts[..done.len()]);
        parts[done.len()..].iter().for_each(|part| log.append(part).unwrap());
        parts.len() - done.len()
    }

    #[test]
    fn a_work_killed_at_any_byte_goes_on_with_no_part_lost_or_doubled() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log");
        let parts =
            [(0, 0.1 + 0.2, "a\nb".to_owned()), (1, -1e-300, "ü \"quoted\"".to_owned()), (2, 3.0, String::new())];
        assert_eq!(go_on(&path, "key", &parts), 3);
        let whole = std::fs::read(&path).unwrap();
        for end in 0..whole.len() {
            std::fs::write(&path, &whole[..end]).unwrap();
            assert!(go_on(&path, "key", &parts) >= 1);
            assert!(std::fs::read(&path).unwrap() == whole, "cut at byte {end}");
        }
        assert_eq!(go_on(&path, "key", &parts), 0);
        // Another work begins anew.
        assert_eq!(go_on(&path, "other key", &parts), 3);
        assert_eq!(go_on(&path, "other key", &parts), 0);
        Log::open::<(usize, f64, String)>(&path, "other key").unwrap().0.remove();
        assert!(!path.exists());
    }
}
