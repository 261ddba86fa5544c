//! What blanks and gaps cost an import: the minutes in stretches that are long enough for a run, and the bridge that keeps more.
//! Nothing is filled here: a bridge is drawn where the recordings are read, as their column map says.

use super::whole::{Imported, ImportedRecording};
use crate::numerals::{fixed, sig};
use crate::recording::Channel;

/// Steps longer than this many usual ones are gaps, as in a recording.
const GAP_IN_STEPS: f64 = 1.5;
/// Share of what the longest bridge keeps that a shorter one must keep to be enough.
const ENOUGH: f64 = 0.9;
/// A bridge is suggested where it keeps this many times what is kept without.
const MORE: f64 = 1.1;

impl Imported {
    /// Bridges drop-outs no longer than `longest` seconds: the column map states it, and missing rows are inserted blank.
    pub fn bridge(&mut self, longest: f64) {
        self.bridge = Some(longest);
        for recording in &mut self.recordings {
            let rows = &mut recording.rows;
            let (step, mut from) = (rows.step, 0);
            let mut t: Vec<f64> = Vec::with_capacity(rows.t.len());
            let mut origin: Vec<Option<usize>> = Vec::with_capacity(rows.t.len());
            for (i, now) in rows.t.iter().enumerate() {
                let gap = now - rows.t[from];
                if gap > GAP_IN_STEPS * step && gap <= longest {
                    let missing = ((gap / step).round() as usize).max(2);
                    let even = gap / missing as f64;
                    for k in 1..missing {
                        t.push(rows.t[from] + k as f64 * even);
                        origin.push(None);
                    }
                }
                t.push(*now);
                origin.push(Some(i));
                from = i;
            }
            for (_, values) in &mut rows.channels {
                *values = origin.iter().map(|at| at.map_or(f64::NAN, |i| values[i])).collect();
            }
            rows.t = t;
        }
    }

    /// Seconds in unbroken stretches of at least `shortest` seconds, with drop-outs up to `bridge` seconds bridged.
    fn kept(&self, shortest: f64, bridge: f64) -> f64 {
        self.recordings.iter().flat_map(|r| self.stretches(r, bridge)).filter(|lasts| *lasts >= shortest).sum()
    }

    /// Lengths of the unbroken stretches of a recording \[s\].
    fn stretches(&self, recording: &ImportedRecording, bridge: f64) -> Vec<f64> {
        let rows = &recording.rows;
        let needed = || rows.channels.iter().filter(|(c, _)| self.cuts(*c)).map(|(_, v)| v);
        let (mut found, mut begun, mut last) = (Vec::new(), None::<f64>, None::<f64>);
        for (i, t) in rows.t.iter().enumerate().filter(|(i, _)| needed().all(|v| v[*i].is_finite())) {
            let blank = last.map_or(0.0, |last| t - last);
            if last.is_some() && blank > (GAP_IN_STEPS * rows.step).max(bridge + 1e-6) {
                found.extend(last.zip(begun).map(|(last, begun)| last - begun));
                begun = None;
            }
            begun = begun.or(Some(rows.t[i]));
            last = Some(*t);
        }
        found.extend(last.zip(begun).map(|(last, begun)| last - begun));
        found
    }

    /// Whether a blank in a channel ends a run.
    fn cuts(&self, channel: Channel) -> bool {
        channel.interrupts() && !self.leave_out.contains(&channel)
    }

    /// What blanks and gaps cost, and the bridge that keeps more: for stretches of at least `shortest` seconds. `None` where next to
    /// nothing is lost.
    pub fn lost(&self, shortest: f64) -> Option<String> {
        let total: f64 = self.recordings.iter().map(|r| r.rows.duration()).sum();
        let now = self.kept(shortest, self.bridge.unwrap_or(0.0));
        if now >= ENOUGH * total {
            return None;
        }
        let minutes = |seconds: f64| fixed(seconds / 60.0, 1);
        let mut text = format!(
            "of {} recorded minutes {} are in stretches without a blank or a gap that are long enough for a run ({} s); blanks: {}",
            minutes(total),
            minutes(now),
            sig(shortest, 2),
            self.blanks()
        );
        // Half of the shortest run: the time in which the ship turns ten degrees, over which a straight line still describes its motion.
        let most = 0.5 * shortest;
        let mut lengths: Vec<f64> =
            self.recordings.iter().flat_map(|r| self.drop_outs(r)).filter(|l| *l <= most).collect();
        lengths.sort_by(f64::total_cmp);
        lengths.dedup_by(|b, a| *b - *a < 1e-6);
        let best = lengths.last().map_or(0.0, |longest| self.kept(shortest, *longest));
        let enough =
            lengths.into_iter().map(|l| (l * 10.0).ceil() / 10.0).find(|l| self.kept(shortest, *l) >= ENOUGH * best);
        text += &match enough.filter(|_| best > MORE * now) {
            Some(bridge) => format!(
                ". `--bridge {bridge}` keeps {} minutes by straight lines over drop-outs of up to {bridge} s (`bridge = {bridge:?}` in columns.toml)",
                minutes(self.kept(shortest, bridge))
            ),
            None => format!(
                ". They last too long for a straight line ({} s): leave the channel out with `leave_out` in columns.toml where another gives it, or take another column with `--column`",
                sig(most, 2)
            ),
        };
        Some(text)
    }

    /// Lengths of the drop-outs of a recording, from the last row before to the first after \[s\].
    fn drop_outs(&self, recording: &ImportedRecording) -> Vec<f64> {
        let rows = &recording.rows;
        let mut found = Vec::new();
        for (_, values) in rows.channels.iter().filter(|(c, _)| self.cuts(*c)) {
            let times: Vec<f64> = rows.t.iter().zip(values).filter(|(_, v)| v.is_finite()).map(|(t, _)| *t).collect();
            found.extend(times.windows(2).map(|t| t[1] - t[0]).filter(|l| *l > GAP_IN_STEPS * rows.step));
        }
        found
    }

    /// How many values are blank, by channel.
    fn blanks(&self) -> String {
        let mut counts: Vec<(Channel, usize)> = Vec::new();
        let mut rows = 0;
        for recording in &self.recordings {
            rows += recording.rows.t.len();
            for (channel, values) in recording.rows.channels.iter().filter(|(c, _)| self.cuts(*c)) {
                let blank = values.iter().filter(|v| !v.is_finite()).count();
                match counts.iter_mut().find(|(c, _)| c == channel) {
                    Some((_, count)) => *count += blank,
                    None => counts.push((*channel, blank)),
                }
            }
        }
        counts.retain(|(_, count)| *count > 0);
        counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        let list: Vec<String> = counts.iter().map(|(channel, count)| format!("{} {count}", channel.name())).collect();
        let none = "none, but times without any row".to_owned();
        if list.is_empty() { none } else { format!("{} of {rows} rows", list.join(", ")) }
    }
}
