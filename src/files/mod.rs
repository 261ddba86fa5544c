//! Files as the project writes them: whole or not at all, under safe names, with digests, in folders that say how they came about.
//! The callers decide what is in a file, and how a failure is reported.

mod cell;
mod date;
mod digest;
mod folder;
mod lock;
mod log;
mod manifest;
mod name;
mod plain;
pub mod progress;
pub mod ranks;
mod seal;
mod suggestion;
mod whole;
pub mod written;

pub use cell::plain_cell;
pub use date::utc;
pub use digest::{sha256, sha256_of};
pub use folder::{FolderError, Kept, Origin, ResultFolder, settle};
pub use lock::{Lock, LockError};
pub use log::Log;
pub use manifest::{Entry, Input, MANIFEST, Manifest, TIMING, Timing};
pub use name::{Names, file_name};
pub use plain::{controls, plain, readable};
pub use seal::{Broken, intact, seal};
pub use suggestion::suggestion;
pub use whole::{fill_whole, write_whole};
