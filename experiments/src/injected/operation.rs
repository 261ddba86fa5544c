//! Exact injections into a recording: what would be recorded if the ship, its instruments or its logger had been so.
//! It uses tables and kinematics, no model, no mechanism and no diagnosis.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::record::{Column, Record, WIND, wrapped};

/// Columns that one instrument gives.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Instrument {
    /// Positions.
    Position,
    /// Heading.
    Heading,
    /// Velocities over ground.
    Velocity,
    /// Yaw rate.
    YawRate,
}

impl Instrument {
    /// Its columns.
    pub fn columns(self) -> &'static [Column] {
        match self {
            Self::Position => &[Column::X, Column::Y],
            Self::Heading => &[Column::Psi],
            Self::Velocity => &[Column::U, Column::V],
            Self::YawRate => &[Column::R],
        }
    }

    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Position => "position",
            Self::Heading => "heading",
            Self::Velocity => "velocity",
            Self::YawRate => "yaw_rate",
        }
    }
}

/// One injection, with its size.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Operation {
    /// Water and air move on together by a constant velocity \[m/s\]. Exact: through water and air nothing changes.
    Current {
        /// To north.
        north: f64,
        /// To east.
        east: f64,
    },
    /// An instrument is late.
    Clock {
        /// The instrument.
        instrument: Instrument,
        /// Delay \[s\]; exact for whole rows, by straight lines between rows otherwise.
        delay: f64,
    },
    /// The compass reads too much \[rad\].
    HeadingZero(f64),
    /// The rate gyro reads too much \[rad/s\].
    RateBias(f64),
    /// Relative error of the reported speeds \[-\].
    LogScale(f64),
    /// The sway velocity is reported too large, to starboard \[m/s\].
    SwayBias(f64),
    /// The antenna is away from midship \[m\].
    Lever {
        /// Forward.
        forward: f64,
        /// To starboard.
        starboard: f64,
        /// Whether the velocities are those of the antenna too.
        velocities: bool,
    },
    /// Values are rounded to a multiple of a step \[SI\].
    Quantise {
        /// The instrument.
        instrument: Instrument,
        /// The step.
        step: f64,
    },
    /// An instrument gives a new value only so often \[s\].
    Hold {
        /// The instrument.
        instrument: Instrument,
        /// Time between new values.
        period: f64,
    },
    /// Rows are missing for a time \[s\], so many times in each recording.
    DropOut {
        /// Number.
        gaps: usize,
        /// Length of each.
        length: f64,
        /// Where.
        seed: u64,
    },
    /// The receiver jumps once in each recording and stays there \[m\].
    Jump {
        /// To north.
        north: f64,
        /// To east.
        east: f64,
        /// When.
        seed: u64,
    },
    /// Each position is of another time than its stamp says, by up to so much \[s\], in whole rows.
    Jitter {
        /// Largest difference.
        most: f64,
        /// Which.
        seed: u64,
    },
    /// The rudder angle is recorded too large \[rad\].
    RudderZero(f64),
    /// The rudder angle is replaced by the order that a lag of first order \[s\] turns into it.
    RudderLag(f64),
    /// Relative error of the recorded propeller rate \[-\].
    PropellerScale(f64),
    /// Columns in another unit than the header says: a factor.
    Unit {
        /// Columns.
        columns: Vec<Column>,
        /// Factor.
        factor: f64,
    },
    /// Two columns are exchanged.
    Swap(Column, Column),
}

impl Operation {
    /// Changes a recording. `run` makes what is drawn differ from recording to recording.
    pub fn apply(&self, record: &mut Record, run: usize) {
        let drawn = |seed: u64| ChaCha8Rng::seed_from_u64(seed.wrapping_add(run as u64));
        match *self {
            Self::Current { north, east } => current(record, north, east),
            Self::Clock { instrument, delay } => clock(record, instrument, delay),
            Self::HeadingZero(bias) => record.change(Column::Psi, |psi| psi + bias),
            Self::RateBias(bias) => record.change(Column::R, |r| r + bias),
            Self::LogScale(error) => {
                record.change(Column::U, |u| (1.0 + error) * u);
                record.change(Column::V, |v| (1.0 + error) * v);
            }
            Self::SwayBias(bias) => record.change(Column::V, |v| v + bias),
            Self::Lever { forward, starboard, velocities } => lever(record, [forward, starboard], velocities),
            Self::Quantise { instrument, step } => {
                for column in instrument.columns() {
                    record.change(*column, |v| (v / step).round() * step);
                }
            }
            Self::Hold { instrument, period } => hold(record, instrument, period),
            Self::DropOut { gaps, length, seed } => drop_out(record, gaps, length, &mut drawn(seed)),
            Self::Jump { north, east, seed } => jump(record, [north, east], &mut drawn(seed)),
            Self::Jitter { most, seed } => jitter(record, most, &mut drawn(seed)),
            Self::RudderZero(offset) => record.change(Column::Delta, |delta| delta + offset),
            Self::RudderLag(time) => order_before_lag(record, time),
            Self::PropellerScale(error) => record.change(Column::N, |n| (1.0 + error) * n),
            Self::Unit { ref columns, factor } => {
                for column in columns {
                    record.change(*column, |v| factor * v);
                }
            }
            Self::Swap(a, b) => {
                let first = std::mem::take(&mut record[a]);
                record[a] = std::mem::replace(&mut record[b], first);
            }
        }
    }

    /// Place among several: the motion itself, then what its instruments make of it, then what the logger does.
    pub fn rank(&self) -> usize {
        match self {
            Self::Current { .. } => 0,
            Self::RudderLag(_) | Self::RudderZero(_) | Self::PropellerScale(_) => 1,
            Self::Lever { .. } => 2,
            Self::HeadingZero(_) | Self::RateBias(_) | Self::LogScale(_) | Self::SwayBias(_) => 3,
            Self::Clock { .. } | Self::Jitter { .. } | Self::Hold { .. } | Self::Quantise { .. } => 4,
            Self::Jump { .. } | Self::DropOut { .. } => 5,
            Self::Unit { .. } | Self::Swap(..) => 6,
        }
    }
}

/// Positions move on by V t from the first row; V in body axes is added to the velocities and, over ground, to the wind, so
/// that the apparent wind is the same.
fn current(record: &mut Record, north: f64, east: f64) {
    let start = record[Column::T].first().copied().unwrap_or(0.0);
    for row in 0..record.len() {
        let t = record[Column::T][row] - start;
        record[Column::X][row] += north * t;
        record[Column::Y][row] += east * t;
        let (sin, cos) = record[Column::Psi][row].sin_cos();
        record[Column::U][row] += north * cos + east * sin;
        record[Column::V][row] += east * cos - north * sin;
        if let (Some(&speed), Some(&from)) = (record[Column::WindSpeed].get(row), record[Column::WindFrom].get(row)) {
            let to = [north - speed * from.cos(), east - speed * from.sin()];
            record[Column::WindSpeed][row] = to[0].hypot(to[1]);
            record[Column::WindFrom][row] = wrapped((-to[1]).atan2(-to[0]));
        }
    }
}

/// The value of a column so many rows (with a fraction) after the first, by a straight line; NaN outside.
fn between(values: &[f64], place: f64) -> f64 {
    // A whole number of rows that was divided and multiplied is a whole number still.
    let near = place.round();
    let place = if (place - near).abs() < 1e-6 { near } else { place };
    let (before, share) = (place.floor(), place - place.floor());
    let value = |i: f64| if i < 0.0 { f64::NAN } else { values.get(i as usize).copied().unwrap_or(f64::NAN) };
    if share == 0.0 { value(before) } else { (1.0 - share) * value(before) + share * value(before + 1.0) }
}

/// Gives an instrument its values of an earlier time, and leaves out the rows for which there are none.
fn clock(record: &mut Record, instrument: Instrument, delay: f64) {
    let period = record.period();
    if period <= 0.0 {
        return;
    }
    let rows = delay / period;
    for column in instrument.columns() {
        let before = record[*column].clone();
        record[*column] = (0..before.len()).map(|k| between(&before, k as f64 - rows)).collect();
    }
    let (count, lost) = (record.len(), (rows.abs() - 1e-6).ceil().max(0.0) as usize);
    if rows > 0.0 {
        record.retain(|k| k >= lost);
    } else {
        record.retain(|k| k + lost < count);
    }
}

/// Position, and if asked velocity, of a point fixed to the ship.
fn lever(record: &mut Record, [forward, starboard]: [f64; 2], velocities: bool) {
    for row in 0..record.len() {
        let (sin, cos) = record[Column::Psi][row].sin_cos();
        record[Column::X][row] += cos * forward - sin * starboard;
        record[Column::Y][row] += sin * forward + cos * starboard;
        if velocities {
            let r = record[Column::R][row];
            record[Column::U][row] -= r * starboard;
            record[Column::V][row] += r * forward;
        }
    }
}

fn hold(record: &mut Record, instrument: Instrument, period: f64) {
    let every = (period / record.period()).round();
    if !every.is_finite() || every < 2.0 {
        return;
    }
    for column in instrument.columns() {
        for row in 0..record.len() {
            record[*column][row] = record[*column][row - row % every as usize];
        }
    }
}

fn drop_out(record: &mut Record, gaps: usize, length: f64, rng: &mut ChaCha8Rng) {
    let Some((&first, &last)) = record[Column::T].first().zip(record[Column::T].last()) else { return };
    let room = (last - first - length).max(0.0);
    let starts: Vec<f64> = (0..gaps).map(|_| first + rng.random_range(0.1..0.9) * room).collect();
    let t = record[Column::T].clone();
    record.retain(|row| starts.iter().all(|s| t[row] < *s || t[row] > s + length));
}

fn jump(record: &mut Record, by: [f64; 2], rng: &mut ChaCha8Rng) {
    let from = (rng.random_range(0.2..0.8) * record.len() as f64) as usize;
    for (column, by) in [(Column::X, by[0]), (Column::Y, by[1])] {
        record[column].iter_mut().skip(from).for_each(|v| *v += by);
    }
}

fn jitter(record: &mut Record, most: f64, rng: &mut ChaCha8Rng) {
    let reach = (most / record.period()).round();
    if !reach.is_finite() || reach < 1.0 || record.is_empty() {
        return;
    }
    let (reach, last) = (reach as i64, record.len() as i64 - 1);
    let rows: Vec<usize> = (0..=last).map(|k| (k + rng.random_range(-reach..=reach)).clamp(0, last) as usize).collect();
    for column in [Column::X, Column::Y] {
        let before = record[column].clone();
        record[column] = rows.iter().map(|row| before[*row]).collect();
    }
}

/// Replaces the rudder angle by the order from which `time delta' = order - delta` makes it, the order constant from row to row:
/// `order_k = (delta_k+1 - e delta_k)/(1 - e)`, `e = exp(-dt/time)`. The last row has no order and is left out.
fn order_before_lag(record: &mut Record, time: f64) {
    let e = (-record.period() / time).exp();
    let last = record.len().saturating_sub(1);
    for row in 0..last {
        let (now, next) = (record[Column::Delta][row], record[Column::Delta][row + 1]);
        record[Column::Delta][row] = (next - e * now) / (1.0 - e);
    }
    record.retain(|row| row < last);
}

/// Leaves out the wind columns.
pub fn without_wind(record: &mut Record) {
    for column in WIND {
        record[column].clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::injected::record::COLUMNS;
    use crate::injected::record::tests::example;

    fn injected(operation: &Operation) -> (Record, Record) {
        let before = example(40);
        let mut after = before.clone();
        operation.apply(&mut after, 0);
        (before, after)
    }

    /// Columns that differ in any row.
    fn changed(before: &Record, after: &Record) -> Vec<Column> {
        COLUMNS.into_iter().filter(|c| before[*c] != after[*c]).collect()
    }

    #[test]
    fn a_current_adds_its_velocity_to_positions_and_velocities_and_leaves_the_apparent_wind() {
        let (before, after) = injected(&Operation::Current { north: 0.3, east: -0.2 });
        use Column::{U, V, WindFrom, WindSpeed, X, Y};
        assert_eq!(changed(&before, &after), [X, Y, U, V, WindSpeed, WindFrom]);
        for k in 0..after.len() {
            let t = before[Column::T][k];
            assert!((after[X][k] - before[X][k] - 0.3 * t).abs() < 1e-12);
            assert!((after[Y][k] - before[Y][k] + 0.2 * t).abs() < 1e-12);
            let (sin, cos) = before[Column::Psi][k].sin_cos();
            let (du, dv) = (after[U][k] - before[U][k], after[V][k] - before[V][k]);
            assert!((cos * du - sin * dv - 0.3).abs() < 1e-12 && (sin * du + cos * dv + 0.2).abs() < 1e-12);
        }
        let (old, new) = (before.mean_wind().unwrap(), after.mean_wind().unwrap());
        assert!((new[0] - old[0] - 0.3).abs() < 1e-12 && (new[1] - old[1] + 0.2).abs() < 1e-12);
    }

    #[test]
    fn a_current_and_its_opposite_are_the_identity() {
        let (before, mut after) = injected(&Operation::Current { north: 0.3, east: -0.2 });
        Operation::Current { north: -0.3, east: 0.2 }.apply(&mut after, 0);
        for column in COLUMNS {
            assert!(before[column].iter().zip(&after[column]).all(|(a, b)| (a - b).abs() < 1e-12), "{column:?}");
        }
    }

    #[test]
    fn a_late_linear_signal_is_less_by_its_slope_times_the_delay() {
        // Heading grows by 0.05 rad/s, rows are 0.5 s apart: whole rows, then a part of one.
        for delay in [1.5, 0.7, -1.0, -0.2] {
            let operation = Operation::Clock { instrument: Instrument::Heading, delay };
            let (before, after) = injected(&operation);
            let lost = (f64::abs(delay) / 0.5).ceil() as usize;
            assert_eq!(after.len(), before.len() - lost);
            for k in 0..after.len() {
                let expected = 0.2 + 0.05 * (after[Column::T][k] - delay);
                assert!((after[Column::Psi][k] - expected).abs() < 1e-12, "{delay}");
            }
            let first = if delay > 0.0 { lost } else { 0 };
            assert_eq!(
                after[Column::U][..],
                before[Column::U][first..first + after.len()],
                "other channels are on time"
            );
        }
    }

    #[test]
    fn a_delay_of_whole_rows_copies_values_to_the_last_bit_beside_missing_ones() {
        let mut record = example(20);
        record[Column::X][7] = f64::NAN;
        let before = record.clone();
        Operation::Clock { instrument: Instrument::Position, delay: 1.0 }.apply(&mut record, 0);
        assert_eq!(record[Column::X][4], before[Column::X][4]);
        assert!(record[Column::X][7].is_nan() && record[Column::X][6] == before[Column::X][6]);
    }

    #[test]
    fn errors_of_one_instrument_change_its_columns_alone_and_by_their_size() {
        let cases: [(Operation, &[Column], f64); 6] = [
            (Operation::HeadingZero(0.03), &[Column::Psi], 0.03),
            (Operation::RateBias(-0.01), &[Column::R], -0.01),
            (Operation::SwayBias(0.02), &[Column::V], 0.02),
            (Operation::RudderZero(0.04), &[Column::Delta], 0.04),
            (Operation::LogScale(0.1), &[Column::U, Column::V], 0.1),
            (Operation::PropellerScale(0.1), &[Column::N], 1.0),
        ];
        for (operation, columns, size) in cases {
            let (before, after) = injected(&operation);
            assert_eq!(changed(&before, &after), columns, "{operation:?}");
            assert!((after[columns[0]][0] - before[columns[0]][0] - size).abs() < 1e-12, "{operation:?}");
        }
    }

    #[test]
    fn a_lever_moves_positions_by_its_length_and_velocities_by_its_rotation() {
        let (before, after) = injected(&Operation::Lever { forward: 3.0, starboard: 4.0, velocities: true });
        for k in 0..after.len() {
            let by = [Column::X, Column::Y].map(|c| after[c][k] - before[c][k]);
            assert!((by[0].hypot(by[1]) - 5.0).abs() < 1e-9);
            // The yaw rate of the example is 0.05 rad/s.
            assert!((after[Column::U][k] - before[Column::U][k] + 0.2).abs() < 1e-12);
            assert!((after[Column::V][k] - before[Column::V][k] - 0.15).abs() < 1e-12);
        }
        let (before, after) = injected(&Operation::Lever { forward: 3.0, starboard: 4.0, velocities: false });
        assert_eq!(changed(&before, &after), [Column::X, Column::Y]);
    }

    #[test]
    fn an_order_passed_through_its_lag_is_the_rudder_angle_again() {
        let (before, after) = injected(&Operation::RudderLag(2.0));
        let e = (-0.5_f64 / 2.0).exp();
        let mut delta = before[Column::Delta][0];
        for k in 0..after.len() {
            assert!((delta - before[Column::Delta][k]).abs() < 1e-12);
            delta = e * delta + (1.0 - e) * after[Column::Delta][k];
        }
        assert_eq!(after.len(), before.len() - 1);
    }

    #[test]
    fn rounded_and_held_values_are_multiples_and_repeats() {
        let (_, after) = injected(&Operation::Quantise { instrument: Instrument::Heading, step: 0.1 });
        assert!(after[Column::Psi].iter().all(|v| (v / 0.1 - (v / 0.1).round()).abs() < 1e-9));
        let (before, after) = injected(&Operation::Hold { instrument: Instrument::Position, period: 1.5 });
        assert_eq!(after[Column::X][8], before[Column::X][6]);
        assert_eq!(after[Column::X][9], before[Column::X][9]);
    }

    #[test]
    fn drop_outs_jumps_and_jitter_are_the_same_each_time_and_differ_between_recordings() {
        let cases = [
            Operation::DropOut { gaps: 2, length: 2.0, seed: 3 },
            Operation::Jump { north: 2.0, east: 0.0, seed: 3 },
            Operation::Jitter { most: 1.0, seed: 3 },
        ];
        for operation in cases {
            let of = |run: usize| {
                let mut record = example(200);
                operation.apply(&mut record, run);
                record
            };
            assert_eq!(of(0), of(0));
            assert!((1..5).any(|run| of(run) != of(0)), "{operation:?}");
        }
        let (before, after) = injected(&Operation::DropOut { gaps: 1, length: 2.0, seed: 3 });
        assert!(after.len() < before.len() && after.len() >= before.len() - 5);
        let (before, after) = injected(&Operation::Jump { north: 2.0, east: -1.0, seed: 3 });
        assert_eq!((after[Column::X][0], after[Column::X][39]), (before[Column::X][0], before[Column::X][39] + 2.0));
        let (before, after) = injected(&Operation::Jitter { most: 1.0, seed: 3 });
        let late =
            (0..40).map(|k| (after[Column::X][k] - before[Column::X][k]) / 0.7).fold(0.0, |m: f64, d| m.max(d.abs()));
        assert!(late > 0.4 && late < 1.0 + 1e-9, "{late}");
    }

    #[test]
    fn errors_of_a_user_scale_turn_over_or_exchange_columns() {
        let (before, after) = injected(&Operation::Unit { columns: vec![Column::N], factor: 60.0 });
        assert_eq!(after[Column::N][2], 60.0 * before[Column::N][2]);
        let (before, after) = injected(&Operation::Swap(Column::X, Column::Y));
        assert_eq!((&after[Column::X], &after[Column::Y]), (&before[Column::Y], &before[Column::X]));
        let mut record = example(5);
        without_wind(&mut record);
        assert!(!record.csv().contains("wind"));
    }
}
