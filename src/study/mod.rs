//! A study: one TOML file that names ship, model and recordings, says how runs are cut into windows, and which train and which test.
//! It opens recordings and hands out windows; ship, model and the tables of the commands are read by those who use them.

pub mod demo;
mod error;
mod file;
mod listed;
mod open;
mod settings;
mod split;
mod table;

pub use error::StudyError;
pub use file::study_schema;
pub use listed::Listed;
pub use open::Study;
pub use split::{SplitBy, SplitRule};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::Split;
    use std::path::Path;

    const HEAD: &str = "name = \"trial\"\nship = \"ship.toml\"\nmodel = \"model.toml\"\n";

    fn parse(rest: &str) -> Result<Study, String> {
        Study::parse(&format!("{HEAD}{rest}"), Path::new("some/study.toml")).map_err(|e| e.to_string())
    }

    fn listed(runs: usize) -> String {
        (0..runs).map(|i| format!("[[runs]]\nfile = \"r{i}.csv\"\nsession = \"s{}\"\n", i / 3)).collect()
    }

    #[test]
    fn paths_are_relative_to_the_study() {
        let study = parse("column_map = \"columns.toml\"\n[[runs]]\nfile = \"a.csv\"\nsplit = \"test\"\n").unwrap();
        assert_eq!(study.ship, Path::new("some/ship.toml"));
        assert_eq!(study.runs[0].file, Path::new("some/a.csv"));
        assert_eq!(study.runs[0].column_map.as_deref(), Some(Path::new("some/columns.toml")));
        assert_eq!((study.runs[0].labels.run.as_str(), study.runs[0].labels.split), ("a", Split::Test));
        assert_eq!(study.split, None);
    }

    #[test]
    fn a_drawn_split_keeps_the_share_and_the_seed() {
        let sides = |seed: u64| {
            let study = parse(&format!("{}[split]\nseed = {seed}\n", listed(40))).unwrap();
            study.runs.iter().map(|r| r.labels.split).collect::<Vec<_>>()
        };
        assert_eq!(sides(1).iter().filter(|s| **s == Split::Test).count(), 5);
        assert_eq!(sides(1), sides(1));
        assert_ne!(sides(1), sides(2));
    }

    #[test]
    fn a_split_by_session_keeps_sessions_together() {
        let study = parse(&format!("{}[split]\nby = \"session\"\ntest = 0.3\n", listed(30))).unwrap();
        for a in &study.runs {
            for b in &study.runs {
                assert!(a.labels.session != b.labels.session || a.labels.split == b.labels.split);
            }
        }
        assert_eq!(study.runs.iter().filter(|r| r.labels.split == Split::Test).count(), 9);
    }

    #[test]
    fn runs_without_a_session_share_one_and_are_split_run_by_run() {
        let text = "[[runs]]\nfile = \"a.csv\"\n[[runs]]\nfile = \"b.csv\"\n[split]\nby = \"session\"\ntest = 0.5\n";
        let study = parse(text).unwrap();
        assert_eq!(study.runs[0].labels.session, study.runs[1].labels.session);
        assert_ne!(study.runs[0].labels.split, study.runs[1].labels.split);
    }

    #[test]
    fn both_sides_have_a_run_when_there_are_two() {
        let study = parse(&listed(2)).unwrap();
        assert_eq!(study.split_in_words(), "1 runs train, 1 test, drawn by run with seed 1");
    }

    #[test]
    fn mistakes_in_a_study_name_line_and_next_step() {
        let runs = listed(1);
        let cases = [
            (format!("windwo = 3.0\n{runs}"), ":4: ", "did you mean `window`?"),
            (format!("window = -3.0\n{runs}"), ":4: ", "positive"),
            (format!("initial_state = \"smoothed\"\n{runs}"), ":4: ", "needs `initial_span`"),
            (format!("initial_span = 2.0\n{runs}"), ":4: ", "\"first\""),
            (format!("{runs}splt = \"train\"\n"), ":7: ", "did you mean `split`?"),
            (format!("{runs}{runs}"), ":7: ", "listed twice"),
            (format!("{runs}[split]\ntest = 12.5\n"), ":8: ", "share from 0 to below 1"),
            ("runs = []\n".to_owned(), ":1: ", "no run is listed"),
            (format!("data = \"$NO_SUCH_VARIABLE_HERE/x\"\n{runs}"), ":4: ", "`$NO_SUCH_VARIABLE_HERE` is not set"),
            (format!("{runs}window = 60.0\n"), ":7: ", "stands at the top"),
            (format!("tolerance = 60.0\n{runs}"), ":4: ", "below the heading of its table"),
            (format!("window_overlap = 60.0\n{runs}"), ":4: ", "no effect without `window`"),
            (format!("window = 60.0\nwindow_overlap = 60.0\n{runs}"), ":5: ", "shorter than `window`"),
            (format!("{runs}from = nan\n"), ":4: ", "not a time in seconds"),
            (format!("{runs}{runs}windw = 1\n"), ":10: ", "unknown key `windw`"),
            (format!("window = -3.0\nstep = 0.0\n{runs}"), ":4: ", "study.toml:5: `step` = 0"),
            (format!("{runs}split = \"test\"\n[[runs]]\nfile = \"b.csv\"\n"), ":8: ", "has no `split`"),
        ];
        for (text, place, hint) in cases {
            let message = parse(&text).unwrap_err();
            assert!(message.contains(&format!("study.toml{place}")) && message.contains(hint), "{text}\n{message}");
        }
    }

    #[test]
    fn a_key_of_the_study_in_the_table_of_a_command_is_reported_with_its_place() {
        #[derive(Debug, serde::Deserialize)]
        #[serde(deny_unknown_fields, default)]
        #[derive(Default)]
        struct Settings {
            steps: usize,
        }
        let study = parse(&format!("[fit]\nsteps = 3\nwindow = 3.0\n{}", listed(1))).unwrap();
        let mistakes = study.section::<Settings>("fit").unwrap_err();
        assert!(mistakes[0].line == 6 && mistakes[0].message.contains("stands at the top"), "{mistakes:?}");
        assert_eq!(study.section::<Settings>("plan").unwrap().steps, 0);
    }

    #[test]
    fn runs_can_stand_in_a_table_beside_the_study() {
        let folder = tempfile::tempdir().unwrap();
        let study = folder.path().join("study.toml");
        std::fs::write(&study, format!("{HEAD}runs = \"runs.csv\"\n")).unwrap();
        let table = folder.path().join("runs.csv");
        std::fs::write(&table, "file,session,split,from\n# a comment\na.csv,day 1,train,\nb.csv,day 2,test,12.5\n")
            .unwrap();
        let runs = Study::read(&study).unwrap().runs;
        assert_eq!((runs[1].labels.session.as_str(), runs[1].from, runs[0].from), ("day 2", Some(12.5), None));
        assert_eq!(runs[1].line, 4);
        std::fs::write(&table, "file,sesion\na.csv,day 1\n").unwrap();
        let message = Study::read(&study).unwrap_err().to_string();
        assert!(message.contains("runs.csv:") && message.contains("did you mean `session`?"), "{message}");
    }

    #[test]
    fn a_missing_recording_is_reported_with_the_line_that_lists_it() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("turn_1.csv"), "").unwrap();
        let path = folder.path().join("study.toml");
        let study = Study::parse(&format!("{HEAD}[[runs]]\nfile = \"turn1.csv\"\n"), &path).unwrap();
        let message = study.windows(1.0).unwrap_err().to_string();
        assert!(message.contains("study.toml:4: ") && message.contains("did you mean `turn_1.csv`?"), "{message}");
    }

    #[test]
    fn the_line_of_a_key_in_a_table_is_found() {
        let study = parse("[fit]\n\nfree = []\n[[runs]]\nfile = \"a.csv\"\n").unwrap();
        assert_eq!(study.line_of("fit", "free"), 6);
        assert_eq!(study.line_of("fit", "fixed"), 4);
    }
}
