//! A folder that one process at a time writes into: a file in it that the system locks, and unlocks when the process ends.
//! Whatever ends the process (a signal, a crash) ends the lock, so that none is ever left behind.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Error, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// The file that is locked; it contains the number of the process.
const NAME: &str = ".trimtab-lock";

/// A locked folder, until it is dropped.
#[derive(Debug)]
pub struct Lock {
    file: File,
    path: PathBuf,
}

/// Why a folder could not be locked.
#[derive(Debug, thiserror::Error)]
pub enum LockError {
    /// Another process has it.
    #[error("another process{} is writing into this folder; wait for it, or choose another folder", .process.map_or(String::new(), |p| format!(" (number {p})")))]
    Taken {
        /// Its number, where it could be read.
        process: Option<u32>,
    },
    /// The file of the lock could not be made or locked.
    #[error("cannot lock the folder ({0}); check that it is writable and on a file system that can lock files")]
    Io(#[from] Error),
}

impl Lock {
    /// Locks a folder that exists.
    ///
    /// # Errors
    /// [`LockError::Taken`] while another process, or another lock of this one, has it.
    pub fn take(folder: &Path) -> Result<Self, LockError> {
        let path = folder.join(NAME);
        loop {
            let mut file = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(&path)?;
            match file.try_lock() {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => {
                    let mut text = String::new();
                    let process = file.read_to_string(&mut text).ok().and_then(|_| text.trim().parse().ok());
                    return Err(LockError::Taken { process });
                }
                Err(TryLockError::Error(source)) => return Err(source.into()),
            }
            // Who had the lock before may have removed the file after this process opened it: then the lock is on nothing.
            if same_file(&file, &path)? {
                file.set_len(0)?;
                file.seek(SeekFrom::Start(0))?;
                write!(file, "{}", std::process::id())?;
                return Ok(Self { file, path });
            }
        }
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        // Removed while it is locked; a file that stays behind locks nobody out.
        let _ = std::fs::remove_file(&self.path);
        let _ = self.file.unlock();
    }
}

/// Whether the file at `path` is still the one that was opened.
#[cfg(unix)]
fn same_file(file: &File, path: &Path) -> Result<bool, Error> {
    use std::os::unix::fs::MetadataExt;
    let own = file.metadata()?;
    match std::fs::metadata(path) {
        Ok(there) => Ok((own.dev(), own.ino()) == (there.dev(), there.ino())),
        Err(e) if e.kind() == ErrorKind::NotFound => Ok(false),
        Err(e) => Err(e),
    }
}

/// Whether there is a file at `path`: elsewhere a file that is open cannot give way to another of its name.
#[cfg(not(unix))]
fn same_file(_file: &File, path: &Path) -> Result<bool, Error> {
    match std::fs::metadata(path) {
        Ok(_) => Ok(true),
        Err(e) if e.kind() == ErrorKind::NotFound => Ok(false),
        Err(e) => Err(e),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[test]
    fn a_locked_folder_is_refused_with_the_number_of_the_process_and_free_again_afterwards() {
        let folder = tempfile::tempdir().unwrap();
        let lock = Lock::take(folder.path()).unwrap();
        let error = Lock::take(folder.path()).unwrap_err();
        assert!(error.to_string().contains(&format!("(number {})", std::process::id())), "{error}");
        drop(lock);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
        // A file that a killed process left behind locks nobody out.
        std::fs::write(folder.path().join(NAME), "4242").unwrap();
        drop(Lock::take(folder.path()).unwrap());
    }

    #[test]
    fn of_many_who_want_the_lock_one_has_it_at_a_time() {
        let folder = tempfile::tempdir().unwrap();
        let (inside, taken) = (AtomicUsize::new(0), AtomicUsize::new(0));
        std::thread::scope(|scope| {
            for _ in 0..8 {
                scope.spawn(|| {
                    for _ in 0..200 {
                        let Ok(lock) = Lock::take(folder.path()) else { continue };
                        assert_eq!(inside.fetch_add(1, Ordering::SeqCst), 0);
                        taken.fetch_add(1, Ordering::SeqCst);
                        inside.fetch_sub(1, Ordering::SeqCst);
                        drop(lock);
                    }
                });
            }
        });
        assert!(taken.into_inner() > 0);
    }
}
