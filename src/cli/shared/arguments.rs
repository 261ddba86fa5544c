//! The arguments of the command that runs, without the name of the program: those of the process, or what another program gives.
//! It reads no meaning into them.

use std::ffi::OsString;
use std::sync::{Mutex, PoisonError};

static GIVEN: Mutex<Vec<OsString>> = Mutex::new(Vec::new());

/// Keeps the arguments of the command that begins.
pub fn keep(given: &[OsString]) {
    *GIVEN.lock().unwrap_or_else(PoisonError::into_inner) = given.to_vec();
}

/// Those arguments as text.
pub fn given() -> Vec<String> {
    let given = GIVEN.lock().unwrap_or_else(PoisonError::into_inner);
    given.iter().map(|a| a.to_string_lossy().into_owned()).collect()
}
