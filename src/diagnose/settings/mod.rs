//! Every number of the diagnosis: those with which tests are compared, those by which tests are made, and the settings that a user may
//! change; each with its name, value, meaning, and how it was set.

mod estimation;
mod user;
mod verdict;

pub use crate::likelihood::settings::{
    Effort, FIRST, GATE, IDENTIFIABLE_SHARE, LEFT_TO_GAIN, LIKELIHOOD, Number, REFIT, SCATTER_GROUPS, SETTLE,
    STEP_GAIN, TOGETHER,
};
pub use estimation::*;
pub use user::Settings;
pub use verdict::*;

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_number_has_a_name_of_its_own_a_meaning_and_an_origin() {
        let numbers = || VERDICT.iter().chain(ESTIMATION).chain(LIKELIHOOD);
        let names: BTreeSet<&str> = numbers().map(|n| n.name).collect();
        assert_eq!(names.len(), numbers().count());
        assert!(numbers().all(|n| n.value > 0.0 && n.meaning.len() > 20 && !n.origin.is_empty()));
        assert!(VERDICT.len() <= 20, "{}", VERDICT.len());
    }

    #[test]
    fn no_other_file_of_the_diagnosis_hides_a_number_behind_a_name() {
        // How an answer is listed and drawn, how a search ends, and rival methods.
        let own = ["baseline.rs", "summary.rs", "push.rs", "sailed.rs", "example.rs"];
        let mut found = Vec::new();
        let mut folders = vec![std::path::PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/src/diagnose"))];
        while let Some(folder) = folders.pop() {
            for entry in std::fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                let name = path.file_name().unwrap().to_string_lossy().into_owned();
                if path.is_dir() {
                    // Plans are made before there are recordings, and turn no verdict.
                    folders.extend((!["settings", "plan"].contains(&name.as_str())).then_some(path));
                    continue;
                }
                let text = std::fs::read_to_string(&path).unwrap();
                let code = text.split("#[cfg(test)]").next().unwrap_or_default();
                let is_number = |l: &&str| l.contains("const ") && (l.contains(": f64 =") || l.contains(": usize ="));
                let kept = code.lines().filter(|l| !own.contains(&name.as_str()) && is_number(l));
                found.extend(kept.map(|l| format!("{name}: {l}")));
            }
        }
        // Sizes of arrays are no thresholds.
        found.retain(|l| {
            ![
                "NOISE_PARAMETERS",
                "const N:",
                "const W:",
                "const FIXED:",
                "const Z:",
                "BLOCKS:",
                "PARTS:",
                "NUDGE:",
                "COMPONENTS:",
                "WIDE:",
            ]
            .iter()
            .any(|n| l.contains(n))
        });
        assert!(found.is_empty(), "{found:#?}");
    }
}
