//! The data of `trimtab demo`: part of the data set of ship A, rounded and in one file, with the table of its runs.
//! The library embeds the files that this module writes; it cannot make them itself, since it never sees a truth simulator.

use crate::truth::dataset::{SEED, Split, dataset};
use crate::truth::ships::ShipId;
use std::fmt::Write;

/// Training runs taken, the first of the data set.
pub const TRAIN: usize = 32;
/// Test runs taken, the first of the data set.
pub const TEST: usize = 8;

/// The files: name within the library's `src/study/demo`, and content.
pub fn files() -> [(&'static str, String); 3] {
    let mut runs = String::from("file,name,manoeuvre,split\n");
    let mut rows = String::from("run,t [s],x [m],y [m],psi [rad],u [m/s],v [m/s],r [rad/s],n [rps],delta [rad]\n");
    let (mut train, mut test) = (0, 0);
    for run in dataset(ShipId::A, SEED) {
        let (taken, limit, word) = match run.split {
            Split::Train => (&mut train, TRAIN, "train"),
            Split::Test => (&mut test, TEST, "test"),
        };
        if *taken == limit {
            continue;
        }
        *taken += 1;
        // Writing to a string cannot fail.
        let _ = writeln!(runs, "recordings/{0}.csv,{0},{1},{word}", run.name, run.manoeuvre);
        for i in 0..run.t.len() {
            let [x, y, psi, u, v, r] = run.state[i];
            let _ = write!(rows, "{},{}", run.name, run.t[i]);
            let columns = [(x, 3), (y, 3), (psi, 5), (u, 4), (v, 4), (r, 6), (run.n[i], 4), (run.delta[i], 5)];
            for (value, decimals) in columns {
                let _ = write!(rows, ",{}", rounded(value, decimals));
            }
            rows.push('\n');
        }
    }
    [("runs.csv", runs), ("recordings.csv", rows), ("ship.toml", include_str!("../ships/a.toml").to_owned())]
}

/// A number to so many decimals, without trailing zeros and without minus zero.
fn rounded(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn the_embedded_files_are_those_that_are_generated() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../src/study/demo");
        for (name, text) in files() {
            let embedded = std::fs::read_to_string(folder.join(name)).expect("the file is committed");
            assert!(
                embedded == text,
                "{name} differs; run `cargo run --release -p trimtab-experiments --bin demo_data`"
            );
        }
    }

    #[test]
    fn rounding_keeps_decimals_and_drops_zeros() {
        assert_eq!(rounded(1.23456, 3), "1.235");
        assert_eq!(rounded(120.0, 3), "120");
        assert_eq!(rounded(-0.00001, 3), "0");
        assert_eq!(rounded(2.5, 4), "2.5");
    }
}
