//! The runs that recordings are split into, each with its session, manoeuvre, side and times, and the table that lists them.
//! What is done in a stretch is determined in `blocks`, which side it comes to in `sides`.

use super::blocks::stretches;
use super::controls::{Controls, time_scale};
use super::session::{Sessions, USUAL_GAP};
use super::sides::{Reach, TestBy, sides};
use super::stretch::{Kind, Stretch};
use crate::files::plain_cell;
use crate::recording::{Recording, Split};
use crate::statistics::quantile;
use serde::Serialize;
use std::collections::BTreeMap;

/// How recordings are split.
#[derive(Clone, Debug)]
pub struct SplitSettings {
    /// Share of the blocks to test on, 0 to below 1.
    pub test: f64,
    /// What comes to one side as a whole.
    pub by: TestBy,
    /// How sessions are distinguished.
    pub sessions: Sessions,
    /// Longer runs are cut into equal pieces \[s\]; forty times the time in which the ship turns ten degrees when not given.
    pub longest: Option<f64>,
}

impl Default for SplitSettings {
    fn default() -> Self {
        Self { test: 0.25, by: TestBy::Block, sessions: Sessions::Known, longest: None }
    }
}

/// A recording to be split.
#[derive(Clone, Debug)]
pub struct SplitPart<'a> {
    /// The file as the table is to name it.
    pub file: String,
    /// Its session, where that is known.
    pub session: Option<String>,
    /// When its time 0 was, on a clock that it shares with the other recordings, where that is known \[s\].
    pub start: Option<f64>,
    /// The recording.
    pub recording: &'a Recording,
}

/// A run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SplitRun {
    /// The recording's file.
    pub file: String,
    /// Name.
    pub name: String,
    /// Session.
    pub session: String,
    /// What is done.
    pub manoeuvre: Kind,
    /// Train or test.
    pub split: Split,
    /// Time of its first row \[s\].
    pub from: f64,
    /// Time of its last row \[s\].
    pub to: f64,
    /// What was seen.
    pub seen: String,
    /// Runs of one block come to one side.
    #[serde(skip)]
    block: usize,
    /// How far the ship is steered in the block.
    #[serde(skip)]
    reach: Reach,
}

/// Why recordings could not be split.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct SplitError(pub String);

/// Times the time scale: a shorter stretch between two gaps is no run.
const SHORTEST: f64 = 2.0;
/// Times the time scale: the longest run.
const LONGEST: f64 = 40.0;
/// Rows of a run, at least.
const FEWEST: usize = 10;

/// Splits recordings into runs; also says how many stretches between gaps are too short for one.
///
/// # Errors
/// [`SplitError`]: a setting that cannot be, names that give no session, nothing to test on.
pub fn split(parts: &[SplitPart<'_>], settings: &SplitSettings) -> Result<(Vec<SplitRun>, usize), SplitError> {
    if !(0.0..1.0).contains(&settings.test) {
        return Err(SplitError(format!("--test {}: give a share from 0 to below 1, such as 0.25", settings.test)));
    }
    if let Some(longest) = settings.longest.filter(|l| !(l.is_finite() && *l > 0.0)) {
        return Err(SplitError(format!("--longest {longest}: give a positive number of seconds, such as 300")));
    }
    let controls: Vec<Vec<Controls>> = parts.iter().map(|p| Controls::of(p.recording)).collect();
    let scale = time_scale(&controls.iter().flatten().cloned().collect::<Vec<_>>());
    let longest = settings.longest.unwrap_or(LONGEST * scale);
    let (mut runs, mut skipped) = (Vec::new(), 0);
    let mut numbers = Numbers { session: 1, ..Numbers::default() };
    let mut before: Option<f64> = None;
    for (i, (part, segments)) in parts.iter().zip(&controls).enumerate() {
        let own = session_of(part, &settings.sessions)?;
        let mut last_end = before.zip(part.start).map(|(end, start)| end - start);
        // Where nothing says when recordings began, each is a session of those by gaps, and otherwise they share one.
        numbers.session += usize::from(i > 0 && last_end.is_none() && matches!(settings.sessions, Sessions::Gaps(_)));
        for c in segments {
            let (Some(first), Some(last)) = (c.t.first(), c.t.last()) else { continue };
            if let Sessions::Known | Sessions::Gaps(_) = settings.sessions {
                let gap = if let Sessions::Gaps(gap) = settings.sessions { gap } else { USUAL_GAP };
                numbers.session += usize::from(own.is_none() && last_end.is_some_and(|end| first - end > gap));
            }
            last_end = Some(*last);
            before = part.start.map(|start| start + last);
            if last - first < SHORTEST * scale || c.len() < FEWEST {
                skipped += 1;
                continue;
            }
            let session = own.clone().unwrap_or_else(|| format!("session {}", numbers.session));
            for stretch in stretches(c, scale) {
                numbers.add(&part.file, &session, c, &stretch, longest, &mut runs);
            }
        }
    }
    if runs.is_empty() {
        return Err(SplitError(format!(
            "no stretch without a gap lasts {:.0} s, so that there is no run; bridge short drop-outs (`trimtab import --bridge`, or `bridge` in a column map)",
            SHORTEST * scale
        )));
    }
    assign(&mut runs, settings)?;
    Ok((runs, skipped))
}

/// A table of runs with each recording as one, in its session.
///
/// # Errors
/// [`SplitError`]: names that give no session.
pub fn whole_csv(parts: &[SplitPart<'_>], settings: &SplitSettings) -> Result<String, SplitError> {
    let mut text = String::from("file,session\n");
    for part in parts {
        let session = session_of(part, &settings.sessions)?.unwrap_or_default();
        text += &format!("{},{}\n", csv_cell(&part.file), csv_cell(&session));
    }
    Ok(text)
}

/// The shortest stretch without a gap that is a run of these recordings \[s\].
pub fn shortest_run(parts: &[SplitPart<'_>]) -> f64 {
    let controls: Vec<Controls> = parts.iter().flat_map(|p| Controls::of(p.recording)).collect();
    SHORTEST * time_scale(&controls)
}

fn session_of(part: &SplitPart<'_>, sessions: &Sessions) -> Result<Option<String>, SplitError> {
    let stem =
        std::path::Path::new(&part.file).file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    let named = sessions.of_file(&stem).map_err(SplitError)?;
    Ok(named.or_else(|| part.session.clone().filter(|_| *sessions == Sessions::Known)))
}

/// Numbers for names.
#[derive(Default)]
struct Numbers {
    session: usize,
    kinds: BTreeMap<Kind, usize>,
    block: usize,
}

impl Numbers {
    /// Adds a stretch as one run, or as pieces.
    fn add(
        &mut self,
        file: &str,
        session: &str,
        c: &Controls,
        stretch: &Stretch,
        longest: f64,
        runs: &mut Vec<SplitRun>,
    ) {
        let number = self.kinds.entry(stretch.kind).or_default();
        *number += 1;
        self.block += 1;
        let rows = stretch.rows.clone();
        let reach = reach(&c.steering[rows.clone()]);
        let lasts = c.t[rows.end - 1] - c.t[rows.start];
        let most = rows.len() / FEWEST;
        // A manoeuvre that is a little longer stays whole.
        let pieces = if lasts > 1.5 * longest { ((lasts / longest).ceil() as usize).min(most).max(1) } else { 1 };
        for piece in 0..pieces {
            let cut = |k: usize| rows.start + rows.len() * k / pieces;
            let (from, to) = (c.t[cut(piece)], c.t[cut(piece + 1) - 1]);
            let suffix = if pieces > 1 { format!(" piece {}", piece + 1) } else { String::new() };
            runs.push(SplitRun {
                file: file.to_owned(),
                name: format!("{} {:02}{suffix}", stretch.kind.word(), *number),
                session: session.to_owned(),
                manoeuvre: stretch.kind,
                split: Split::Train,
                from,
                to,
                seen: stretch.why.clone(),
                block: self.block,
                reach,
            });
        }
    }
}

/// The rudder angles, or yaw rates, that are exceeded to either side for a twentieth of the time: a single sample is no evidence.
fn reach(delta: &[f64]) -> Reach {
    let mut angles: Vec<f64> = delta.iter().copied().filter(|d| d.is_finite()).collect();
    angles.sort_unstable_by(f64::total_cmp);
    [0.05, 0.95].map(|share| quantile(&angles, share).unwrap_or(0.0))
}

/// Gives every run its side.
fn assign(runs: &mut Vec<SplitRun>, settings: &SplitSettings) -> Result<(), SplitError> {
    if settings.test <= 0.0 {
        return Ok(());
    }
    if settings.by == TestBy::Session {
        let mut names: Vec<String> = runs.iter().map(|r| r.session.clone()).collect();
        names.dedup();
        names.sort_unstable();
        names.dedup();
        if names.len() < 2 {
            let text = "--by session: there is only one session, so that nothing would be left to test on; use --by block, or distinguish sessions with --sessions";
            return Err(SplitError(text.to_owned()));
        }
        let sides = sides(&vec![0; names.len()], &vec![[0.0; 2]; names.len()], settings.test);
        for run in runs.iter_mut() {
            let at = names.binary_search(&run.session).unwrap_or(0);
            run.split = sides[at];
        }
        return Ok(());
    }
    let mut blocks: BTreeMap<usize, (Kind, Reach)> = BTreeMap::new();
    blocks.extend(runs.iter().map(|r| (r.block, (r.manoeuvre, r.reach))));
    if blocks.len() == 1 {
        last_tests(runs, settings.test);
        return Ok(());
    }
    let (kinds, reaches): (Vec<Kind>, Vec<Reach>) = blocks.values().copied().unzip();
    let sides = sides(&kinds, &reaches, settings.test);
    let of: BTreeMap<usize, Split> = blocks.keys().copied().zip(sides).collect();
    runs.iter_mut().for_each(|r| r.split = of.get(&r.block).copied().unwrap_or(Split::Train));
    Ok(())
}

/// Of a single block the last part tests: its last pieces, or the end of the only one.
fn last_tests(runs: &mut Vec<SplitRun>, share: f64) {
    if let [only] = runs.as_slice() {
        let at = only.from + (1.0 - share) * (only.to - only.from);
        let (mut first, mut second) = (only.clone(), only.clone());
        (first.to, second.from) = (at, at);
        first.name += " piece 1";
        second.name += " piece 2";
        *runs = vec![first, second];
    }
    let count = ((share * runs.len() as f64).round() as usize).clamp(1, runs.len() - 1);
    runs.iter_mut().rev().take(count).for_each(|r| r.split = Split::Test);
}

/// A cell of a table, in quotes where it needs them.
fn csv_cell(text: &str) -> String {
    let cell = plain_cell(text);
    if cell.contains([',', '"', '\n', '\r']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell.into_owned() }
}

/// The table of runs of a study.
pub fn runs_csv(runs: &[SplitRun]) -> String {
    let mut text = String::from("file,name,session,manoeuvre,split,from,to\n");
    for run in runs {
        let split = if run.split == Split::Test { "test" } else { "train" };
        let cells = [
            csv_cell(&run.file),
            csv_cell(&run.name),
            csv_cell(&run.session),
            run.manoeuvre.word().to_owned(),
            split.to_owned(),
            run.from.to_string(),
            run.to.to_string(),
        ];
        text += &(cells.join(",") + "\n");
    }
    text
}
