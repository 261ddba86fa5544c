//! The example study that `trimtab demo` works on, embedded: ship, models, runs and forty recordings.
//! The data are not made here: the binary `demo_data` of the experiments wrote them, and a test there compares them with its output.

/// Study, ship, models and table of runs, by file name.
const FILES: [(&str, &str); 5] = [
    ("study.toml", include_str!("demo/study.toml")),
    ("ship.toml", include_str!("demo/ship.toml")),
    ("model.toml", include_str!("demo/model.toml")),
    ("baseline.toml", include_str!("demo/baseline.toml")),
    ("runs.csv", include_str!("demo/runs.csv")),
];

/// All recordings in one file: the name of the run, then the columns of a recording.
const RECORDINGS: &str = include_str!("demo/recordings.csv");

/// Every file of the example study, by path relative to its folder, with its content.
pub fn files() -> Vec<(String, String)> {
    let mut files: Vec<(String, String)> = FILES.iter().map(|(n, t)| ((*n).to_owned(), (*t).to_owned())).collect();
    let mut lines = RECORDINGS.lines().filter_map(|line| line.split_once(','));
    let header = lines.next().map_or("", |(_, columns)| columns);
    for (run, row) in lines {
        let name = format!("recordings/{run}.csv");
        match files.last_mut().filter(|(last, _)| *last == name) {
            Some((_, text)) => *text += &format!("{row}\n"),
            None => files.push((name, format!("{header}\n{row}\n"))),
        }
    }
    files
}

#[cfg(test)]
mod tests {
    use super::files;

    #[test]
    fn every_run_listed_has_its_recording_of_121_rows() {
        let files = files();
        let runs = &files.iter().find(|(name, _)| name == "runs.csv").unwrap().1;
        let listed: Vec<&str> = runs.lines().skip(1).map(|l| l.split(',').next().unwrap()).collect();
        assert_eq!(listed.len(), 40);
        for file in listed {
            let text = &files.iter().find(|(name, _)| name == file).unwrap().1;
            assert!(text.starts_with("t [s],x [m],") && text.lines().count() == 122, "{file}");
        }
    }
}
