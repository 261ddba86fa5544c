//! What a model or a column map says that no run of the study reaches: sessions that are not there, terms without their channel.
//! None of it stops a command, for a model may serve several studies; it is printed before the answer.

use std::collections::BTreeSet;
use std::path::Path;
use trimtab::model::Model;
use trimtab::recording::{Channel, ColumnMap, Delay};
use trimtab::study::Study;

/// Channels that give a term what it needs, any one of each.
const GIVING: [(&str, &[Channel]); 4] = [
    ("wind", &[Channel::WindSpeed, Channel::ApparentWindSpeed]),
    ("waves", &[Channel::WaveHeight]),
    ("bank", &[Channel::BankStarboard, Channel::BankPort]),
    ("thruster", &[Channel::Thruster]),
];

/// The warnings, each with the next step; a recording that cannot be read is left to those who read it whole.
pub fn unreached(study: &Study, model: &Model, model_path: &Path) -> Vec<String> {
    let sessions: BTreeSet<&str> = study.runs.iter().map(|run| run.labels.session.as_str()).collect();
    let known = || sessions.iter().map(|s| format!("`{s}`")).collect::<Vec<_>>().join(", ");
    let mut warnings: Vec<String> = model
        .sessions
        .keys()
        .filter(|session| !sessions.contains(session.as_str()))
        .map(|session| {
            format!(
                "{}: what the model adds in session `{session}` is used in no run; the sessions of the study are {}",
                model_path.display(),
                known()
            )
        })
        .collect();
    for (map, column, session) in delays(study) {
        if !sessions.contains(session.as_str()) {
            warnings.push(format!(
                "{map}: the delay of `{column}` in session `{session}` is used in no run; the sessions of the study are {}",
                known()
            ));
        }
    }
    warnings.extend(without_channel(study, model, model_path));
    warnings
}

/// Map, column and session of every delay that is given by session.
fn delays(study: &Study) -> BTreeSet<(String, String, String)> {
    let mut found = BTreeSet::new();
    for path in study.column_maps() {
        let Ok(map) = ColumnMap::read(path) else { continue };
        for (name, column) in map.columns.iter().flatten() {
            if let Some(Delay::Sessions(sessions)) = &column.delay {
                found.extend(sessions.keys().map(|s| (path.display().to_string(), name.clone(), s.clone())));
            }
        }
    }
    found
}

/// Terms that need a channel that runs do not have: there it counts as 0, and the term has no effect.
fn without_channel(study: &Study, model: &Model, model_path: &Path) -> Vec<String> {
    let needing: Vec<(&str, &str)> =
        model.terms().flat_map(|term| term.needs.iter().map(|need| (term.name, *need))).collect();
    if needing.is_empty() {
        return Vec::new();
    }
    let recorded: Vec<Vec<Channel>> = study.runs.iter().filter_map(|run| study.channels(run).ok()).collect();
    let mut warnings = Vec::new();
    for (term, need) in needing {
        let Some((_, giving)) = GIVING.iter().find(|(name, _)| *name == need) else { continue };
        let without = recorded.iter().filter(|channels| !giving.iter().any(|c| channels.contains(c))).count();
        if without > 0 {
            let names: Vec<String> = giving.iter().map(|c| format!("`{c}`")).collect();
            warnings.push(format!(
                "{}: the term `{term}` has no effect in {without} of {} runs, which have no channel {}; record it, name its column in a \
                 column map or give it a `value` there, or leave the term out",
                model_path.display(),
                recorded.len(),
                names.join(" or ")
            ));
        }
    }
    warnings
}

#[cfg(test)]
mod tests {
    use super::*;
    use trimtab::terms::CATALOGUE;

    #[test]
    fn every_need_of_a_term_has_its_channels() {
        for need in CATALOGUE.iter().flat_map(|term| term.info().needs) {
            assert!(GIVING.iter().any(|(name, _)| name == need), "{need}");
        }
    }
}
