//! From raw channels to the project's frames: range and time checks, unwrapped heading, body velocities at midship, derived channels.
//! Nothing is smoothed here and nothing invented: a channel that is derived is derived because the column map asks for it.

use super::channel::Channel;
use super::error::RecordingError;
use super::file::blank::usual_fill;
use super::file::lines::LineNumbers;
use super::file::map::{ColumnMap, Derived, VelocityFrame};
use super::file::unit::Quantity;
use super::local::slope;
use super::record::{GAP_IN_STEPS, Recording};
use super::wrap::{repair, unwrap};
use std::f64::consts::TAU;
use std::path::Path;

/// Rows over which a channel is derived when the map gives no span.
pub(super) const DERIVE_ROWS: f64 = 8.0;

/// Velocity pairs that change frame and reference point together.
const VELOCITIES: [[Channel; 2]; 2] = [[Channel::U, Channel::V], [Channel::UWater, Channel::VWater]];

/// Channels that mean nothing without each other.
const PAIRS: [[Channel; 2]; 5] = [
    [Channel::WindSpeed, Channel::WindDirection],
    [Channel::ApparentWindSpeed, Channel::ApparentWindDirection],
    [Channel::CurrentSpeed, Channel::CurrentDirection],
    [Channel::WaveHeight, Channel::WaveDirection],
    [Channel::X, Channel::Y],
];

impl Recording {
    /// A recording from arrays already in SI units and the project's frames; `t` must be among them.
    ///
    /// # Errors
    /// [`RecordingError`] as for a file; messages name row `i` as line `i + 2`, its line in a written file.
    pub fn from_channels(name: &str, channels: Vec<(Channel, Vec<f64>)>) -> Result<Self, RecordingError> {
        let rows = channels.iter().find(|(c, _)| *c == Channel::T).map_or(0, |(_, t)| t.len());
        let mut recording = Self::empty(name.to_owned(), Path::new(name), 1);
        recording.lines = LineNumbers::from(2, rows);
        for (channel, values) in channels {
            if values.len() != rows {
                return Err(RecordingError::Lengths {
                    name: name.to_owned(),
                    channel,
                    expected: rows,
                    found: values.len(),
                });
            }
            recording.units.insert(channel, channel.info().quantity.si().to_owned());
            recording.data.insert(channel, values);
        }
        recording.finish(&ColumnMap::default(), "")?;
        Ok(recording)
    }

    /// Checks raw channels and brings them to the project's frames; `session` picks the delays of the map.
    pub(super) fn finish(&mut self, map: &ColumnMap, session: &str) -> Result<(), RecordingError> {
        self.require(Channel::T, "for every run", "give a time column, or `dt` in a column map")?;
        for [a, b] in PAIRS {
            for (one, other) in [(a, b), (b, a)] {
                if self.has(one) {
                    self.require(other, "together with its partner", &format!("record it, or leave `{one}` out"))?;
                }
            }
        }
        self.check_ranges()?;
        self.check_time()?;
        if let Some(longest) = map.bridge {
            self.bridge(longest);
        }
        let t = self.time().to_vec();
        for (_, angle) in self.data.iter_mut().filter(|(c, _)| c.turns()) {
            unwrap(angle);
        }
        if let Some(psi) = self.data.get_mut(&Channel::Psi).filter(|_| map.wrap_repair) {
            self.repaired = repair(&t, psi, |_, _| None);
        }
        self.shift(&map.delays(session))?;
        let span = map.derive_span.unwrap_or(DERIVE_ROWS * self.step());
        if map.derive.contains(&Derived::R) {
            self.derive_yaw_rate(span)?;
        }
        if map.velocity_frame == VelocityFrame::Earth {
            self.rotate_velocities()?;
        }
        self.move_to_midship(map.reference_point, map.velocity_point.unwrap_or(map.reference_point))?;
        if map.derive.contains(&Derived::U) || map.derive.contains(&Derived::V) {
            self.derive_velocity(&map.derive, span)?;
        }
        self.ground_from_water()?;
        if self.segments().is_empty() {
            let counts = self.channels().filter(|(c, _)| c.interrupts()).filter_map(|(c, v)| {
                let missing = v.iter().filter(|x| !x.is_finite()).count();
                (missing > 0).then(|| format!("`{c}` is missing in {missing} of {} rows", v.len()))
            });
            let what = counts.collect::<Vec<_>>().join(", ");
            let what = if what.is_empty() { "there is only one row".to_owned() } else { what };
            return Err(RecordingError::NothingUsable { path: self.path.clone(), line: self.line(0), what });
        }
        Ok(())
    }

    /// Refuses values no ship reaches: the unit is then most likely another.
    fn check_ranges(&self) -> Result<(), RecordingError> {
        for (channel, values) in self.channels() {
            let info = channel.info();
            let outside = |v: &f64| v.is_finite() && !(info.limits.0..=info.limits.1).contains(v);
            let Some(row) = values.iter().position(outside) else { continue };
            let count = values.iter().filter(|v| outside(v)).count();
            let unit = self.unit(info.channel);
            let factor = info.quantity.factor(unit).unwrap_or(1.0);
            let rows = match count {
                1 => format!("one row of {}", values.len()),
                _ => format!("{count} rows of {}", values.len()),
            };
            let hint = match info.quantity.likelier_unit(unit, values[row], info.limits) {
                // A usual fill value is none in another unit either, though one of the units may have room for it.
                _ if usual_fill(values[row] / factor) => {
                    format!(
                        "take it for missing with `blank = {}` in a column map ({rows})",
                        as_written(values[row] / factor)
                    )
                }
                Some("deg") => format!("is the column in degrees? ({rows})"),
                Some(unit) => format!("is the column in {unit}? ({rows})"),
                None => format!("correct the value, or take it for missing with `blank` in a column map ({rows})"),
            };
            return Err(RecordingError::OutOfRange {
                path: self.path.clone(),
                line: self.line(row),
                channel: info.channel,
                found: round(values[row] / factor),
                unit: unit.to_owned(),
                limits: limits_text(info.limits, factor),
                hint,
            });
        }
        Ok(())
    }

    /// Refuses time that stands still or goes back.
    fn check_time(&self) -> Result<(), RecordingError> {
        let t = self.time();
        let Some(row) = (1..t.len()).find(|&i| t[i] <= t[i - 1]) else { return Ok(()) };
        Err(RecordingError::Time {
            path: self.path.clone(),
            line: self.line(row),
            found: t[row],
            problem: if t[row] == t[row - 1] { "repeats" } else { "goes back from" },
            previous: t[row - 1],
            previous_line: self.line(row - 1),
            next: self.after_repeat(row),
        })
    }

    /// What to do about a row whose time is not later than that of the row before: a row that is there twice needs another remedy than
    /// a clock that was rounded.
    fn after_repeat(&self, row: usize) -> String {
        let t = self.time();
        let bits = |values: &[f64], row: usize| values[row].to_bits();
        let same = |row: &usize| self.channels().all(|(_, values)| bits(values, *row) == bits(values, *row - 1));
        let repeats: Vec<usize> = (1..t.len()).filter(|&i| t[i] == t[i - 1]).collect();
        if t[row] < t[row - 1] {
            "sort the rows by time, and remove what is there twice".to_owned()
        } else if same(&row) {
            let times = repeats.iter().filter(|row| same(row)).count();
            let all =
                if times > 1 { format!(", and {} others that are there twice", times - 1) } else { String::new() };
            format!("the whole row is there twice: remove it{all}")
        } else {
            "the rows differ: set `dt` in a column map if the time column was rounded, and remove the row otherwise"
                .to_owned()
        }
    }

    /// Fills dropouts no longer than `longest` seconds by straight lines, channel by channel.
    fn bridge(&mut self, longest: f64) {
        let t = self.time().to_vec();
        for (channel, values) in &mut self.data {
            let wrapped = channel.info().quantity == Quantity::Angle;
            let mut filled = 0;
            let mut last: Option<usize> = None;
            for row in 0..values.len() {
                if !values[row].is_finite() {
                    continue;
                }
                if let Some(from) = last.filter(|&from| row > from + 1 && t[row] - t[from] <= longest) {
                    let (start, mut change) = (values[from], values[row] - values[from]);
                    if wrapped {
                        change = nearest(change);
                    }
                    for i in from + 1..row {
                        values[i] = start + change * (t[i] - t[from]) / (t[row] - t[from]);
                        filled += 1;
                    }
                }
                last = Some(row);
            }
            if filled > 0 {
                self.bridged.push((*channel, filled));
            }
        }
    }

    /// Shifts delayed channels back to the time of the measurement, by straight lines between rows, and drops the rows at either end for
    /// which one of them has no value any more.
    fn shift(&mut self, delays: &[(Channel, f64)]) -> Result<(), RecordingError> {
        let t = self.time().to_vec();
        let (Some(&first), Some(&last), false) = (t.first(), t.last(), delays.is_empty()) else { return Ok(()) };
        let (mut from, mut to) = (first, last);
        for &(channel, delay) in delays {
            let slot = match channel {
                Channel::U if !self.has(channel) => Channel::UWater,
                Channel::V if !self.has(channel) => Channel::VWater,
                _ => channel,
            };
            if let Some(values) = self.data.get_mut(&slot) {
                *values = t.iter().map(|at| interpolated(&t, values, at + delay)).collect();
                (from, to) = (from.max(first - delay), to.min(last - delay));
            }
        }
        if to - from < 2.0 * self.step() {
            let next = "correct `delay` in the column map";
            let message =
                format!("after the delays {:.2} s of {:.2} s are left; {next}", (to - from).max(0.0), last - first);
            return Err(RecordingError::Setting { path: self.path.clone(), message });
        }
        let slack = 1e-9 * (last - first);
        self.keep(|at| at >= from - slack && at <= to + slack);
        Ok(())
    }

    /// Yaw rate as the slope of heading.
    fn derive_yaw_rate(&mut self, span: f64) -> Result<(), RecordingError> {
        if self.has(Channel::R) {
            return Ok(());
        }
        let psi = self.require(Channel::Psi, "to derive the yaw rate", "record it, or take `r` out of `derive`")?;
        let r = self.slopes(psi, span);
        self.put_derived(Channel::R, r);
        Ok(())
    }

    /// Body velocities over ground from position and heading:
    /// `u = x' cos psi + y' sin psi`, `v = -x' sin psi + y' cos psi`.
    fn derive_velocity(&mut self, wanted: &[Derived], span: f64) -> Result<(), RecordingError> {
        let next = "record it, or take `u` and `v` out of `derive`";
        let purpose = "to derive velocity";
        let psi = self.require(Channel::Psi, purpose, next)?;
        let dx = self.slopes(self.require(Channel::X, purpose, next)?, span);
        let dy = self.slopes(self.require(Channel::Y, purpose, next)?, span);
        let body: Vec<[f64; 2]> =
            psi.iter().zip(dx.iter().zip(&dy)).map(|(psi, (dx, dy))| to_body(*psi, [*dx, *dy])).collect();
        for (asked, channel, axis) in [(Derived::U, Channel::U, 0), (Derived::V, Channel::V, 1)] {
            if wanted.contains(&asked) && !self.has(channel) {
                self.put_derived(channel, body.iter().map(|b| b[axis]).collect());
            }
        }
        Ok(())
    }

    /// Slope at every row, from the unbroken stretch the row lies in; NaN in dropouts.
    fn slopes(&self, values: &[f64], span: f64) -> Vec<f64> {
        let t = self.time();
        let longest = GAP_IN_STEPS * self.step();
        let mut slopes = vec![f64::NAN; values.len()];
        let mut start = 0;
        for row in 1..=values.len() {
            let joined = row < values.len()
                && values[row].is_finite()
                && values[row - 1].is_finite()
                && t[row] - t[row - 1] <= longest;
            if !joined {
                if row - start >= 3 {
                    slopes[start..row].copy_from_slice(&slope(t, values, start..row, span));
                }
                start = row;
            }
        }
        slopes
    }

    fn put_derived(&mut self, channel: Channel, values: Vec<f64>) {
        self.data.insert(channel, values);
        self.derived.push(channel);
    }

    /// Velocities along north and east to velocities along the ship.
    fn rotate_velocities(&mut self) -> Result<(), RecordingError> {
        for [forward, starboard] in VELOCITIES {
            if !self.has(forward) && !self.has(starboard) {
                continue;
            }
            let next = "record it, or set `velocity_frame = \"body\"`";
            let purpose = "to rotate earth-fixed velocities";
            let psi = self.require(Channel::Psi, purpose, next)?.to_vec();
            let north = self.require(forward, purpose, next)?.to_vec();
            let east = self.require(starboard, purpose, next)?.to_vec();
            let body = psi.iter().zip(north.iter().zip(&east)).map(|(psi, (n, e))| to_body(*psi, [*n, *e]));
            let (u, v) = body.map(|b| (b[0], b[1])).unzip();
            self.data.insert(forward, u);
            self.data.insert(starboard, v);
        }
        Ok(())
    }

    /// Position and velocity of another point P = (x_P, y_P) of the ship to those of midship:
    /// `x = x_rec - (x_P cos psi - y_P sin psi)`, `y = y_rec - (x_P sin psi + y_P cos psi)`,
    /// `u = u_rec + r y_P`, `v = v_rec - r x_P`.
    fn move_to_midship(&mut self, position: [f64; 2], velocity: [f64; 2]) -> Result<(), RecordingError> {
        if position != [0.0; 2] && self.has(Channel::X) {
            let next = "record it, or give positions of midship";
            let psi = self.require(Channel::Psi, "to move positions to midship", next)?.to_vec();
            for (axis, channel) in [Channel::X, Channel::Y].into_iter().enumerate() {
                if let Some(values) = self.data.get_mut(&channel) {
                    for (value, psi) in values.iter_mut().zip(&psi) {
                        *value -= to_earth(*psi, position)[axis];
                    }
                }
            }
        }
        if velocity != [0.0; 2] && VELOCITIES.iter().flatten().any(|c| self.has(*c)) {
            let next = "record it, set `derive = [\"r\"]`, or give velocities of midship";
            let r = self.require(Channel::R, "to move velocities to midship", next)?.to_vec();
            for (channel, lever) in VELOCITIES.iter().flat_map(|[u, v]| [(*u, velocity[1]), (*v, -velocity[0])]) {
                if let Some(values) = self.data.get_mut(&channel) {
                    for (value, r) in values.iter_mut().zip(&r) {
                        *value += r * lever;
                    }
                }
            }
        }
        Ok(())
    }

    /// Velocity over ground from velocity through water and a recorded current, where only those were recorded.
    fn ground_from_water(&mut self) -> Result<(), RecordingError> {
        let (Some(speed), Some(direction)) = (self.get(Channel::CurrentSpeed), self.get(Channel::CurrentDirection))
        else {
            return Ok(());
        };
        let current: Vec<[f64; 2]> = speed.iter().zip(direction).map(|(s, d)| [s * d.cos(), s * d.sin()]).collect();
        for (axis, [ground, water]) in
            [[Channel::U, Channel::UWater], [Channel::V, Channel::VWater]].into_iter().enumerate()
        {
            let Some(log) = self.get(water).filter(|_| !self.has(ground)) else { continue };
            let next = "record it, or give velocities over ground";
            let psi = self.require(Channel::Psi, "to add the current to velocities through water", next)?;
            let rows = log.iter().zip(psi.iter().zip(&current));
            let values = rows.map(|(log, (psi, current))| log + to_body(*psi, *current)[axis]).collect();
            self.put_derived(ground, values);
        }
        Ok(())
    }
}

/// The value at a time between rows; NaN outside them and next to a missing one.
fn interpolated(t: &[f64], values: &[f64], at: f64) -> f64 {
    let after = t.partition_point(|t| *t < at);
    match (after.checked_sub(1).map(|i| t[i]), t.get(after)) {
        (_, Some(time)) if *time == at => values[after],
        (Some(before), Some(time)) => {
            let share = (at - before) / (time - before);
            // Rounding of times must not ask for a neighbour that is missing.
            if share < 1e-6 {
                values[after - 1]
            } else if share > 1.0 - 1e-6 {
                values[after]
            } else {
                values[after - 1] + share * (values[after] - values[after - 1])
            }
        }
        (Some(before), None) if at - before < 1e-6 => values[after - 1],
        (None, Some(time)) if time - at < 1e-6 => values[after],
        _ => f64::NAN,
    }
}

/// A vector along (north, east) in (forward, starboard) components.
pub(super) fn to_body(psi: f64, [north, east]: [f64; 2]) -> [f64; 2] {
    let (s, c) = psi.sin_cos();
    [north * c + east * s, east * c - north * s]
}

/// A vector along (forward, starboard) in (north, east) components.
pub(super) fn to_earth(psi: f64, [forward, starboard]: [f64; 2]) -> [f64; 2] {
    let (s, c) = psi.sin_cos();
    [forward * c - starboard * s, forward * s + starboard * c]
}

/// The change of an angle taken the short way round.
fn nearest(change: f64) -> f64 {
    change - TAU * (change / TAU).round()
}

/// A range in the declared unit: `+-1.6` or `0..30`.
fn limits_text((low, high): (f64, f64), factor: f64) -> String {
    let (low, high) = (round(low / factor), round(high / factor));
    if low == -high { format!("+-{high}") } else { format!("{low}..{high}") }
}

/// Four significant digits, for messages.
fn round(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// A value without the digits that a change of unit leaves.
fn as_written(value: f64) -> f64 {
    format!("{value:.9e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A circle at constant speed and drift, recorded at a point of the ship, in body or earth axes.
    fn circle(point: [f64; 2], earth: bool) -> Vec<(Channel, Vec<f64>)> {
        let (u, v, r) = (2.0, -0.3, 0.05);
        let t: Vec<f64> = (0..200).map(|i| 0.5 * f64::from(i)).collect();
        let psi: Vec<f64> = t.iter().map(|t| r * t).collect();
        // Exact integral of the rotated velocity.
        let midship =
            psi.iter().map(|p| [(u * p.sin() + v * (p.cos() - 1.0)) / r, (u * (1.0 - p.cos()) + v * p.sin()) / r]);
        let position: Vec<[f64; 2]> = midship
            .zip(&psi)
            .map(|(m, p)| {
                let lever = to_earth(*p, point);
                [m[0] + lever[0], m[1] + lever[1]]
            })
            .collect();
        let at_point = [u - r * point[1], v + r * point[0]];
        let velocity: Vec<[f64; 2]> =
            psi.iter().map(|p| if earth { to_earth(*p, at_point) } else { at_point }).collect();
        let column = |pairs: &[[f64; 2]], axis: usize| pairs.iter().map(|p| p[axis]).collect::<Vec<_>>();
        let rows = t.len();
        vec![
            (Channel::T, t),
            (Channel::X, column(&position, 0)),
            (Channel::Y, column(&position, 1)),
            (Channel::Psi, psi.iter().map(|p| p.rem_euclid(TAU)).collect()),
            (Channel::U, column(&velocity, 0)),
            (Channel::V, column(&velocity, 1)),
            (Channel::R, vec![r; rows]),
            (Channel::N, vec![1.0; rows]),
            (Channel::Delta, vec![0.1; rows]),
        ]
    }

    /// Writes raw channels as CSV and reads them by a map.
    fn through_file(channels: &[(Channel, Vec<f64>)], map: &str) -> Result<Recording, RecordingError> {
        let mut text =
            channels.iter().map(|(c, _)| format!("{c} [{}]", c.info().quantity.si())).collect::<Vec<_>>().join(",");
        for row in 0..channels[0].1.len() {
            text.push('\n');
            text.push_str(&channels.iter().map(|(_, v)| v[row].to_string()).collect::<Vec<_>>().join(","));
        }
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("run.csv");
        std::fs::write(&file, text).unwrap();
        Recording::read(&file, &ColumnMap::parse(map, Path::new("columns.toml")).unwrap())
    }

    fn assert_alike(a: &Recording, b: &Recording, tolerance: f64) {
        for (channel, values) in a.channels() {
            for (x, y) in values.iter().zip(b.get(channel).unwrap()) {
                assert!((x - y).abs() < tolerance, "{channel}: {x} {y}");
            }
        }
    }

    #[test]
    fn a_recording_of_another_point_becomes_that_of_midship() {
        let midship = through_file(&circle([0.0, 0.0], false), "").unwrap();
        let bow = through_file(&circle([30.0, -4.0], false), "reference_point = [30.0, -4.0]").unwrap();
        assert_alike(&midship, &bow, 1e-9);
    }

    #[test]
    fn earth_fixed_velocities_become_body_velocities() {
        let body = through_file(&circle([0.0, 0.0], false), "").unwrap();
        let earth =
            through_file(&circle([12.0, 3.0], true), "velocity_frame = \"earth\"\nreference_point = [12.0, 3.0]")
                .unwrap();
        assert_alike(&body, &earth, 1e-9);
    }

    #[test]
    fn velocities_and_yaw_rate_are_derived_when_asked_for() {
        let full = through_file(&circle([0.0, 0.0], false), "").unwrap();
        let without: Vec<_> = circle([0.0, 0.0], false)
            .into_iter()
            .filter(|(c, _)| !matches!(c, Channel::U | Channel::V | Channel::R))
            .collect();
        let bare = through_file(&without, "").unwrap();
        assert!(!bare.has(Channel::R) && !bare.has(Channel::U));
        let derived = through_file(&without, "derive = [\"u\", \"v\", \"r\"]").unwrap();
        assert_eq!(derived.derived(), [Channel::R, Channel::U, Channel::V]);
        assert_alike(&full, &derived, 1e-2);
    }

    #[test]
    fn speed_through_water_and_current_give_speed_over_ground() {
        let mut raw = circle([0.0, 0.0], false);
        let rows = raw[0].1.len();
        raw.push((Channel::CurrentSpeed, vec![0.5; rows]));
        raw.push((Channel::CurrentDirection, vec![1.0; rows]));
        let r = through_file(&raw, "speed = \"through water\"").unwrap();
        assert_eq!(r.derived(), [Channel::U, Channel::V]);
        for row in 0..rows {
            let psi = r.get(Channel::Psi).unwrap()[row];
            let water = [r.get(Channel::UWater).unwrap()[row], r.get(Channel::VWater).unwrap()[row]];
            let ground = [r.get(Channel::U).unwrap()[row], r.get(Channel::V).unwrap()[row]];
            let difference = to_earth(psi, [ground[0] - water[0], ground[1] - water[1]]);
            assert!(
                (difference[0] - 0.5 * 1_f64.cos()).abs() < 1e-12 && (difference[1] - 0.5 * 1_f64.sin()).abs() < 1e-12
            );
        }
    }

    #[test]
    fn short_dropouts_are_bridged_and_long_ones_are_not() {
        let mut raw = circle([0.0, 0.0], false);
        raw[1].1[10..12].fill(f64::NAN);
        raw[1].1[50..70].fill(f64::NAN);
        let split = through_file(&raw, "").unwrap();
        assert_eq!(split.segments(), [0..10, 12..50, 70..200]);
        let bridged = through_file(&raw, "bridge = 2.0").unwrap();
        assert_eq!(bridged.segments(), [0..50, 70..200]);
        assert_eq!(bridged.bridged(), [(Channel::X, 2)]);
    }

    proptest! {
        #![proptest_config(crate::recording::seeded())]
        #[test]
        fn unwrapping_undoes_wrapping(steps in prop::collection::vec(-3.0..3.0f64, 2..60)) {
            let mut sum = 0.5;
            let truth: Vec<f64> = steps.iter().map(|s| { sum += s; sum }).collect();
            let mut wrapped: Vec<f64> = truth.iter().map(|p| p.rem_euclid(TAU)).collect();
            let offset = truth[0] - wrapped[0];
            unwrap(&mut wrapped);
            for (w, p) in wrapped.iter().zip(&truth) {
                prop_assert!((w + offset - p).abs() < 1e-9);
            }
        }

        #[test]
        fn body_and_earth_axes_undo_each_other(psi in -10.0..10.0f64, a in -9.0..9.0f64, b in -9.0..9.0f64) {
            let back = to_earth(psi, to_body(psi, [a, b]));
            prop_assert!((back[0] - a).abs() < 1e-12 && (back[1] - b).abs() < 1e-12);
        }
    }
}
