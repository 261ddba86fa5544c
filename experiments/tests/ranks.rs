//! The campaign on several ranks: the same rows for any number of them, and those of the other ranks kept when one ends.
//! A script takes the place of the diagnosis, whose answers are tested elsewhere.

// Helpers of tests may unwrap.
#![allow(clippy::unwrap_used)]
#![cfg(feature = "mpi")]

use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A program that takes the place of the diagnosis, and fails if it sees that it was started from a rank.
fn tool(folder: &Path) -> PathBuf {
    let path = folder.join("tool");
    let script = "#!/bin/sh\nif env | grep -q '^OMPI_\\|^PMIX_'; then exit 3; fi\necho '{\"verdict\": \"adequate\", \"findings\": []}'\n";
    std::fs::write(&path, script).unwrap();
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
    path
}

/// The rows of a campaign of six cases on so many ranks, without the time each took.
fn rows(folder: &Path, ranks: usize, workers: usize) -> Vec<Vec<String>> {
    let out = folder.join(format!("out-{ranks}-{workers}"));
    let tool = tool(folder);
    let status = Command::new("timeout")
        .args([
            "180",
            "mpirun",
            "--oversubscribe",
            "--allow-run-as-root",
            "--bind-to",
            "none",
            "-n",
            &ranks.to_string(),
        ])
        .arg(env!("CARGO_BIN_EXE_campaign"))
        .args(["--most", "6", "--alone", "--only", "/1", "--workers", &workers.to_string(), "--tool"])
        .arg(&tool)
        .arg("--out")
        .arg(&out)
        .output()
        .unwrap();
    assert!(status.status.success(), "{}", String::from_utf8_lossy(&status.stderr));
    let mut reader = csv::Reader::from_path(out.join("cases.csv")).unwrap();
    let header = reader.headers().unwrap().clone();
    let column = |name: &str| header.iter().position(|found| found == name).unwrap();
    let (timed, error) = (column("seconds"), column("error"));
    let timeless = |record: csv::StringRecord| {
        assert_eq!(&record[error], "");
        record.iter().enumerate().filter(|(i, _)| *i != timed).map(|(_, field)| field.to_owned()).collect()
    };
    reader.records().map(|record| timeless(record.unwrap())).collect()
}

#[test]
fn a_campaign_has_the_same_rows_for_any_number_of_ranks() {
    let folder = tempfile::tempdir().unwrap();
    let alone = rows(folder.path(), 1, 1);
    assert_eq!(alone.len(), 6);
    for (ranks, workers) in [(1, 2), (2, 1), (4, 1)] {
        assert!(rows(folder.path(), ranks, workers) == alone, "{ranks} ranks with {workers} workers each");
    }
}
