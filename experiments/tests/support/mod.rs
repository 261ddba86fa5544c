//! What several tests of the experiments need: the program, built from the source as it is.
//! No test is here.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;

/// Held while a campaign runs: each takes all processors, and its limits of time suppose that no other one does.
pub fn alone() -> MutexGuard<'static, ()> {
    static CAMPAIGN: Mutex<()> = Mutex::new(());
    CAMPAIGN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The program, built if it is missing or older than its source: `cargo test --workspace` has built it.
pub fn program() -> PathBuf {
    // target/release/deps/concealed-...: two up.
    let test = std::env::current_exe().unwrap();
    let folder = test.ancestors().nth(2).unwrap();
    let program = folder.join(format!("trimtab{}", std::env::consts::EXE_SUFFIX));
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let source = ["src", "ad/src", "Cargo.toml", "Cargo.lock"].map(|part| newest(&repository.join(part)));
    let built = program.metadata().and_then(|of| of.modified());
    if built.is_ok_and(|built| source.iter().all(|changed| *changed <= built)) {
        return program;
    }
    let release: &[&str] = if folder.ends_with("debug") { &[] } else { &["--release"] };
    let built = Command::new(env!("CARGO"))
        .args(["build", "--quiet", "--workspace", "--bin", "trimtab", "--target-dir"])
        .arg(folder.parent().unwrap())
        .args(release)
        .current_dir(repository)
        .status()
        .unwrap();
    assert!(built.success(), "the program could not be built: {built}");
    program
}

/// When a file, or the newest file of a folder, was changed.
fn newest(path: &Path) -> SystemTime {
    if path.is_dir() {
        let files = std::fs::read_dir(path).unwrap();
        return files.map(|file| newest(&file.unwrap().path())).max().unwrap_or(SystemTime::UNIX_EPOCH);
    }
    path.metadata().unwrap().modified().unwrap()
}
