//! A recording: channels in SI units by row, with the line of each row, its stretches, gaps and dropouts.
//! How it is read from a file is in `read`, and what its channels go through before they are checked in `convert`.

use super::channel::Channel;
use super::error::RecordingError;
use super::file::lines::LineNumbers;
use super::wrap::repair;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// One run as measured. Channels are in SI units and radians, one value a row, NaN where a value is missing.
///
/// Frames: x north, y east, psi clockwise from north and unwrapped, u forward, v to starboard, r to starboard, all at
/// midship; velocities over ground; delta positive turns to starboard.
#[derive(Clone, Debug)]
pub struct Recording {
    /// Name: the file's stem.
    pub name: String,
    /// The file, for messages.
    pub path: PathBuf,
    /// Line of the header, for messages about the file as a whole.
    pub(super) header_line: usize,
    /// Line of each row.
    pub(super) lines: LineNumbers,
    /// The channels that there are.
    pub(super) data: BTreeMap<Channel, Vec<f64>>,
    /// Unit each channel was written in.
    pub(super) units: BTreeMap<Channel, String>,
    /// Channels that were not recorded but derived from others.
    pub(super) derived: Vec<Channel>,
    /// Rows left out because they have no time: first and last line of each stretch.
    pub(super) without_time: Vec<(usize, usize)>,
    /// Columns of the file that became no channel.
    pub(super) unused: Vec<String>,
    /// Values filled in across short dropouts, by channel.
    pub(super) bridged: Vec<(Channel, usize)>,
    /// Headings that lay on the wrong way round and were put right.
    pub(super) repaired: usize,
}

/// Steps longer than this many usual steps are gaps.
pub(super) const GAP_IN_STEPS: f64 = 1.5;

impl Recording {
    /// A recording without a row or channel.
    pub(super) fn empty(name: String, path: &Path, header_line: usize) -> Self {
        Self {
            name,
            path: path.to_owned(),
            header_line,
            lines: LineNumbers::default(),
            data: BTreeMap::new(),
            units: BTreeMap::new(),
            derived: Vec::new(),
            without_time: Vec::new(),
            unused: Vec::new(),
            bridged: Vec::new(),
            repaired: 0,
        }
    }

    /// Writes the recording as canonical CSV, SI units, missing values left blank. Derived channels are written too.
    ///
    /// # Errors
    /// [`RecordingError::Write`].
    pub fn write(&self, path: &Path) -> Result<(), RecordingError> {
        let fail = |source| RecordingError::Write { path: path.to_owned(), source };
        let columns: Vec<(Channel, &[f64])> = self.channels().collect();
        let mut text = String::new();
        let header = columns.iter().map(|(c, _)| format!("{} [{}]", c.name(), c.info().quantity.si()));
        text.push_str(&header.collect::<Vec<_>>().join(","));
        text.push('\n');
        for row in 0..self.len() {
            let fields =
                columns.iter().map(|(_, v)| if v[row].is_finite() { format!("{}", v[row]) } else { String::new() });
            text.push_str(&fields.collect::<Vec<_>>().join(","));
            text.push('\n');
        }
        crate::files::write_whole(path, text.as_bytes()).map_err(fail)
    }

    /// Number of rows with a time.
    pub fn len(&self) -> usize {
        self.lines.len()
    }

    /// True when there is no row; a recording that was read has some.
    pub fn is_empty(&self) -> bool {
        self.lines.len() == 0
    }

    /// A channel's values, one a row, NaN where missing; `None` when it was not recorded.
    pub fn get(&self, channel: Channel) -> Option<&[f64]> {
        self.data.get(&channel).map(Vec::as_slice)
    }

    /// True when the channel was recorded or derived.
    pub fn has(&self, channel: Channel) -> bool {
        self.get(channel).is_some()
    }

    /// The channels there are, in the order of the catalogue.
    pub fn channels(&self) -> impl Iterator<Item = (Channel, &[f64])> {
        self.data.iter().map(|(channel, values)| (*channel, values.as_slice()))
    }

    /// Time of each row \[s\].
    pub fn time(&self) -> &[f64] {
        self.get(Channel::T).unwrap_or_default()
    }

    /// Line of a row in the file.
    pub fn line(&self, row: usize) -> usize {
        self.lines.get(row).unwrap_or(self.header_line)
    }

    /// The unit the channel was written in.
    pub fn unit(&self, channel: Channel) -> &str {
        self.units.get(&channel).map(String::as_str).unwrap_or_else(|| channel.info().quantity.si())
    }

    /// Channels derived from others rather than recorded.
    pub fn derived(&self) -> &[Channel] {
        &self.derived
    }

    /// First and last line of each stretch of rows that was left out for want of a time.
    pub fn without_time(&self) -> &[(usize, usize)] {
        &self.without_time
    }

    /// Columns of the file that became no channel.
    pub fn unused(&self) -> &[String] {
        &self.unused
    }

    /// How many missing values were bridged, by channel.
    pub fn bridged(&self) -> &[(Channel, usize)] {
        &self.bridged
    }

    /// How many headings interpolated across north were put right, as the column map asks.
    pub fn repaired(&self) -> usize {
        self.repaired
    }

    /// Keeps the rows at whose time `wanted` says so.
    pub(super) fn keep(&mut self, wanted: impl Fn(f64) -> bool) {
        let kept: Vec<bool> = self.time().iter().map(|t| wanted(*t)).collect();
        if kept.iter().all(|kept| *kept) {
            return;
        }
        for values in self.data.values_mut() {
            let mut keep = kept.iter();
            values.retain(|_| keep.next().is_some_and(|k| *k));
        }
        self.lines = self.lines.parted(|row| kept[row]).0;
    }

    /// The part between two times, ends included; lines are those of the file.
    #[must_use]
    pub fn part(&self, from: Option<f64>, to: Option<f64>) -> Self {
        let mut part = self.clone();
        part.keep(|t| from.is_none_or(|from| t >= from) && to.is_none_or(|to| t <= to));
        part
    }

    /// The same with a channel's values missing in some rows.
    #[must_use]
    pub fn without(&self, channel: Channel, rows: &[usize]) -> Self {
        let mut left = self.clone();
        if let Some(values) = left.data.get_mut(&channel) {
            rows.iter().for_each(|row| values[*row] = f64::NAN);
        }
        left
    }

    /// The same with headings that were interpolated across north put right.
    #[must_use]
    pub fn with_repaired_heading(&self) -> Self {
        let mut right = self.clone();
        let t = self.time().to_vec();
        if let Some(psi) = right.data.get_mut(&Channel::Psi) {
            right.repaired = repair(&t, psi, |_, _| None);
        }
        right
    }

    /// The usual time step: the median \[s\].
    pub fn step(&self) -> f64 {
        let mut steps: Vec<f64> = self.time().windows(2).map(|t| t[1] - t[0]).collect();
        if steps.is_empty() {
            return 0.0;
        }
        let middle = steps.len() / 2;
        *steps.select_nth_unstable_by(middle, f64::total_cmp).1
    }

    /// Time from the first to the last row \[s\].
    pub fn duration(&self) -> f64 {
        let t = self.time();
        t.last().copied().unwrap_or(0.0) - t.first().copied().unwrap_or(0.0)
    }

    /// True when row `row` has every channel that a simulation needs.
    pub fn complete(&self, row: usize) -> bool {
        self.channels().all(|(c, v)| !c.interrupts() || v[row].is_finite())
    }

    /// The unbroken stretches: consecutive complete rows without a gap in time, two rows at least.
    pub fn segments(&self) -> Vec<Range<usize>> {
        let t = self.time();
        let longest = GAP_IN_STEPS * self.step();
        let mut segments = Vec::new();
        let mut start = None;
        for row in 0..=self.len() {
            let complete = row < self.len() && self.complete(row);
            let joined = complete && start.is_some() && t[row] - t[row - 1] <= longest;
            if let Some(first) = start.filter(|_| !joined) {
                if row - first >= 2 {
                    segments.push(first..row);
                }
                start = None;
            }
            if complete && start.is_none() {
                start = Some(row);
            }
        }
        segments
    }

    /// Rows after which time jumps: the row after each gap.
    pub fn gaps(&self) -> Vec<usize> {
        let t = self.time();
        let longest = GAP_IN_STEPS * self.step();
        (1..self.len()).filter(|&i| t[i] - t[i - 1] > longest).collect()
    }

    /// Stretches of rows in which a needed channel is missing.
    pub fn dropouts(&self) -> Vec<Range<usize>> {
        let mut dropouts: Vec<Range<usize>> = Vec::new();
        for row in (0..self.len()).filter(|&row| !self.complete(row)) {
            match dropouts.last_mut() {
                Some(last) if last.end == row => last.end = row + 1,
                _ => dropouts.push(row..row + 1),
            }
        }
        dropouts
    }

    /// The channels missing somewhere in `rows`.
    pub fn missing_in(&self, rows: Range<usize>) -> Vec<Channel> {
        self.channels()
            .filter(|(c, v)| c.interrupts() && v[rows.clone()].iter().any(|x| !x.is_finite()))
            .map(|(c, _)| c)
            .collect()
    }

    /// The error for an interruption, or `None` when the run is whole.
    pub fn interruption(&self) -> Option<RecordingError> {
        let dropouts = self.dropouts();
        if let Some(first) = dropouts.first() {
            let names: Vec<&str> = self.missing_in(first.clone()).iter().map(|c| c.name()).collect();
            return Some(RecordingError::Dropout {
                path: self.path.clone(),
                line: self.line(first.start),
                last_line: self.line(first.end - 1),
                what: format!("{} {}", names.join(", "), if names.len() == 1 { "is" } else { "are" }),
                rows: dropouts.iter().map(Range::len).sum(),
            });
        }
        let row = *self.gaps().first()?;
        let gap = self.time()[row] - self.time()[row - 1];
        Some(RecordingError::Gap { path: self.path.clone(), line: self.line(row), gap, step: self.step() })
    }

    /// A channel that must be there.
    pub(super) fn require(
        &self,
        channel: Channel,
        purpose: &'static str,
        next: &str,
    ) -> Result<&[f64], RecordingError> {
        self.get(channel).ok_or_else(|| RecordingError::MissingChannel {
            path: self.path.clone(),
            line: self.header_line,
            channel,
            words: channel.info().words,
            purpose,
            next: next.to_owned(),
        })
    }
}
