//! Faults that loggers produce and that leave every file readable: clipped, exchanged, scaled and shifted inputs, copies, a wrong ship.
//! Which of them a command reports is judged from its answers, in [`super::runner`].

use super::files::{Files, Table, recordings};

/// One fault, and the study that has it.
#[derive(Debug, Clone, PartialEq)]
pub struct Fault {
    /// The kind.
    pub kind: &'static str,
    /// What was done.
    pub what: String,
    /// The study.
    pub files: Files,
}

/// A run as the study lists it.
struct Listed {
    file: String,
    session: String,
    test: bool,
}

fn listed(files: &Files) -> Vec<Listed> {
    let study = files.get("study.toml").map(|bytes| String::from_utf8_lossy(bytes).into_owned()).unwrap_or_default();
    let parsed: toml::Table = study.parse().unwrap_or_default();
    let text = |run: &toml::Value, key: &str| run.get(key).and_then(|v| v.as_str()).unwrap_or_default().to_owned();
    let runs = parsed.get("runs").and_then(|runs| runs.as_array()).into_iter().flatten();
    runs.map(|run| Listed {
        file: text(run, "file"),
        session: text(run, "session"),
        test: text(run, "split") == "test",
    })
    .collect()
}

/// A study with every value of a channel changed in some recordings.
fn changed(files: &Files, chosen: &[&str], channel: &str, change: impl Fn(f64) -> f64) -> Files {
    let mut files = files.clone();
    for name in chosen {
        if let Some(bytes) = files.get_mut(*name) {
            let mut table = Table::read(bytes);
            if let Some(column) = table.at(channel) {
                table.each(column, |_, value| change(value));
            }
            *bytes = table.text();
        }
    }
    files
}

/// A study in which two recordings have each other's values of some channels, as far as both go.
fn exchanged(files: &Files, [a, b]: [&str; 2], channels: &[&str]) -> Files {
    let mut files = files.clone();
    let [mut one, mut other] = [a, b].map(|name| Table::read(files.get(name).map_or(&[], |bytes| bytes)));
    for channel in channels {
        let (Some(i), Some(j)) = (one.at(channel), other.at(channel)) else { continue };
        let (ours, theirs) = (one.values(i), other.values(j));
        one.each(i, |row, value| theirs.get(row).copied().unwrap_or(value));
        other.each(j, |row, value| ours.get(row).copied().unwrap_or(value));
    }
    files.insert(a.to_owned(), one.text());
    files.insert(b.to_owned(), other.text());
    files
}

/// A recording with its numbers rounded to so many significant digits, but for the time.
fn rounded(bytes: &[u8], digits: i32) -> Vec<u8> {
    let mut table = Table::read(bytes);
    for column in 1..table.header.len() {
        table.each(column, |_, value| {
            let unit = 10f64.powi(digits - 1 - value.abs().max(1e-3).log10().floor() as i32);
            (value * unit).round() / unit
        });
    }
    table.text()
}

/// The ship file with a number multiplied.
fn other_ship(files: &Files, key: &str, factor: f64) -> Files {
    let mut files = files.clone();
    if let Some(bytes) = files.get_mut("ship.toml") {
        let line = |line: &str| match line.split_once('=').filter(|(name, _)| name.trim() == key) {
            Some((name, value)) => {
                let number = value.split('#').next().and_then(|v| v.trim().parse::<f64>().ok()).unwrap_or(0.0);
                format!("{name}= {:?}\n", number * factor)
            }
            None => format!("{line}\n"),
        };
        *bytes = String::from_utf8_lossy(bytes).lines().map(line).collect::<String>().into_bytes();
    }
    files
}

/// The faults of a sound study, the same each time: about eighty.
pub fn faults(files: &Files) -> Vec<Fault> {
    let runs = listed(files);
    let all = recordings(files);
    let every: Vec<&str> = all.iter().map(String::as_str).collect();
    let train: Vec<&str> = runs.iter().filter(|run| !run.test).map(|run| run.file.as_str()).collect();
    let mut found = Vec::new();
    let mut add = |kind: &'static str, what: String, files: Files| found.push(Fault { kind, what, files });
    let degree = 1f64.to_radians();
    for limit in [5.0, 10.0, 15.0, 20.0, 25.0] {
        let clip = |value: f64| value.clamp(-limit * degree, limit * degree);
        add("rudder clipped, all runs", format!("{limit} deg"), changed(files, &every, "delta", clip));
        let one = train[limit as usize % train.len()];
        add("rudder clipped, one run", format!("{one} at {limit} deg"), changed(files, &[one], "delta", clip));
    }
    for pair in train.windows(2).step_by(2).take(4).map(|pair| [pair[0], pair[1]]) {
        for channels in [&["delta"][..], &["n"], &["delta", "n"]] {
            let what = format!("{} of {} and {}", channels.join(" and "), pair[0], pair[1]);
            add("inputs of two runs exchanged", what, exchanged(files, pair, channels));
        }
    }
    for one in train.iter().take(6) {
        add("propeller stopped in one run", (*one).to_owned(), changed(files, &[one], "n", |_| 0.0));
    }
    let gains = [0.7, 0.9, 1.1, 1.3];
    for (i, channel) in ["delta", "n", "u", "r"].into_iter().enumerate() {
        for (k, gain) in gains.into_iter().enumerate() {
            let one = train[(4 * i + k) % train.len()];
            let what = format!("{channel} of {one} times {gain}");
            add("gain of one run", what, changed(files, &[one], channel, |value| value * gain));
        }
    }
    let zeros =
        [("delta", 2.0 * degree), ("delta", 5.0 * degree), ("psi", 3.0 * degree), ("r", 0.1 * degree), ("u", 0.3)];
    for (i, (channel, zero)) in zeros.into_iter().enumerate() {
        let one = train[(3 * i + 1) % train.len()];
        let what = format!("{channel} of {one} plus {zero:.4}");
        add("zero of one run", what, changed(files, &[one], channel, |value| value + zero));
    }
    let first = runs.first().map_or("", |run| run.session.as_str());
    let day: Vec<&str> = runs.iter().filter(|run| run.session == first).map(|run| run.file.as_str()).collect();
    for (channel, gain, zero) in [
        ("delta", 0.8, 0.0),
        ("delta", 1.2, 0.0),
        ("delta", 1.0, 3.0 * degree),
        ("u", 0.9, 0.0),
        ("r", 1.15, 0.0),
        ("psi", 1.0, 3.0 * degree),
        ("n", 0.9, 0.0),
    ] {
        let what = format!("{channel} of session {first} times {gain} plus {zero:.3}");
        add("gain or zero of one day", what, changed(files, &day, channel, |value| value * gain + zero));
    }
    for (test, one) in runs.iter().filter(|run| run.test).zip(&train).take(2) {
        for digits in 2..=5 {
            let mut copy = files.clone();
            copy.insert((*one).to_owned(), rounded(&files[&test.file], digits));
            add("test run copied into training", format!("{one} is {} to {digits} digits", test.file), copy);
        }
    }
    for key in ["mass", "draught", "diameter"] {
        for factor in [0.7, 0.85, 1.15, 1.3] {
            add("another ship", format!("{key} times {factor}"), other_ship(files, key, factor));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::super::files::sound;
    use super::*;

    #[test]
    fn there_are_about_eighty_faults_and_each_changes_the_study() {
        let folder = tempfile::tempdir().unwrap();
        let files = sound(3, folder.path()).unwrap();
        let faults = faults(&files);
        assert!((75..=90).contains(&faults.len()), "{}", faults.len());
        let same: Vec<&str> = faults.iter().filter(|f| f.files == files).map(|f| f.what.as_str()).collect();
        // A rudder that is never put over as far is not clipped.
        assert!(same.iter().all(|what| what.contains("deg")), "{same:?}");
    }
}
