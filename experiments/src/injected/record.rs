//! A recording as a plain table: one column a channel, in SI units, radians and the frames of the project.
//! It shares no code with the library's recordings, so that an error there cannot hide in both.

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::ops::{Index, IndexMut};

use serde::{Deserialize, Serialize};

/// A column of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Column {
    /// Time \[s\].
    T,
    /// Position of midship to north \[m\].
    X,
    /// Position of midship to east \[m\].
    Y,
    /// Heading, clockwise from north, unwrapped \[rad\].
    Psi,
    /// Velocity over ground, forward \[m/s\].
    U,
    /// Velocity over ground, to starboard \[m/s\].
    V,
    /// Yaw rate, bow to starboard \[rad/s\].
    R,
    /// Propeller rate \[1/s\].
    N,
    /// Rudder angle, positive turns to starboard \[rad\].
    Delta,
    /// Speed of the true wind \[m/s\].
    WindSpeed,
    /// Direction from which the true wind comes, clockwise from north \[rad\].
    WindFrom,
    /// Speed of the apparent wind \[m/s\].
    ApparentSpeed,
    /// Direction from which the apparent wind comes, clockwise from the bow \[rad\].
    ApparentFrom,
}

/// Every column, in the order of [`Column`].
pub const COLUMNS: [Column; 13] = [
    Column::T,
    Column::X,
    Column::Y,
    Column::Psi,
    Column::U,
    Column::V,
    Column::R,
    Column::N,
    Column::Delta,
    Column::WindSpeed,
    Column::WindFrom,
    Column::ApparentSpeed,
    Column::ApparentFrom,
];

/// The four columns of an anemometer.
pub const WIND: [Column; 4] = [Column::WindSpeed, Column::WindFrom, Column::ApparentSpeed, Column::ApparentFrom];

/// Headers of the columns in the layout that the diagnosis reads without a column map.
const HEADERS: [&str; 13] = [
    "t [s]",
    "x [m]",
    "y [m]",
    "psi [rad]",
    "u [m/s]",
    "v [m/s]",
    "r [rad/s]",
    "n [rps]",
    "delta [rad]",
    "wind_speed [m/s]",
    "wind_direction [rad]",
    "apparent_wind_speed [m/s]",
    "apparent_wind_direction [rad]",
];

/// A recording. A column that was not recorded is empty, a value that is missing is NaN.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Record {
    columns: [Vec<f64>; 13],
}

impl Index<Column> for Record {
    type Output = Vec<f64>;
    fn index(&self, column: Column) -> &Vec<f64> {
        &self.columns[column as usize]
    }
}

impl IndexMut<Column> for Record {
    fn index_mut(&mut self, column: Column) -> &mut Vec<f64> {
        &mut self.columns[column as usize]
    }
}

impl Record {
    /// Number of rows.
    pub fn len(&self) -> usize {
        self[Column::T].len()
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Time between the first two rows \[s\]; 0 with fewer.
    pub fn period(&self) -> f64 {
        let t = &self[Column::T];
        if t.len() < 2 { 0.0 } else { (t[t.len() - 1] - t[0]) / (t.len() - 1) as f64 }
    }

    /// Keeps the rows for which this is true.
    pub fn retain(&mut self, keep: impl Fn(usize) -> bool) {
        for column in &mut self.columns {
            let mut row = 0;
            column.retain(|_| {
                row += 1;
                keep(row - 1)
            });
        }
    }

    /// Changes every value of a column.
    pub fn change(&mut self, column: Column, of: impl Fn(f64) -> f64) {
        for value in &mut self[column] {
            *value = of(*value);
        }
    }

    /// Mean wind over ground, to north and to east, over the rows in which it was recorded \[m/s\].
    pub fn mean_wind(&self) -> Option<[f64; 2]> {
        let pairs = self[Column::WindSpeed].iter().zip(&self[Column::WindFrom]);
        let known: Vec<[f64; 2]> = pairs
            .map(|(speed, from)| [-speed * from.cos(), -speed * from.sin()])
            .filter(|w| w.iter().all(|v| v.is_finite()))
            .collect();
        let count = known.len() as f64;
        (count > 0.0).then(|| [0, 1].map(|i| known.iter().map(|w| w[i]).sum::<f64>() / count))
    }

    /// The table as CSV, every value to its last bit, a missing one blank.
    pub fn csv(&self) -> String {
        let present: Vec<Column> = COLUMNS.into_iter().filter(|c| !self[*c].is_empty()).collect();
        let mut text = present.iter().map(|c| HEADERS[*c as usize]).collect::<Vec<_>>().join(",");
        text.push('\n');
        for row in 0..self.len() {
            for (i, column) in present.iter().enumerate() {
                if i > 0 {
                    text.push(',');
                }
                let value = self[*column][row];
                if value.is_finite() {
                    // Writing into a String cannot fail.
                    let _ = write!(text, "{value}");
                }
            }
            text.push('\n');
        }
        text
    }
}

/// An angle in 0 to 2 pi.
pub fn wrapped(angle: f64) -> f64 {
    angle.rem_euclid(TAU)
}

/// Removes steps of a whole turn from a series of angles; missing values stay missing.
pub fn unwrap(angles: &mut [f64]) {
    let mut last: Option<f64> = None;
    for angle in angles.iter_mut().filter(|a| a.is_finite()) {
        if let Some(before) = last {
            *angle -= TAU * ((*angle - before) / TAU).round();
        }
        last = Some(*angle);
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A ship that turns under a varying speed: every column different and smooth.
    pub(crate) fn example(rows: usize) -> Record {
        let mut record = Record::default();
        for k in 0..rows {
            let t = 0.5 * k as f64;
            let row = [
                t,
                3.0 + 0.7 * t,
                -2.0 + 0.3 * t,
                0.2 + 0.05 * t,
                1.0 + 0.01 * t,
                0.1 - 0.002 * t,
                0.05,
                10.0,
                0.2 * (0.1 * t).sin(),
                2.0,
                1.0,
                2.5,
                0.8,
            ];
            for (column, value) in COLUMNS.into_iter().zip(row) {
                record[column].push(value);
            }
        }
        record
    }

    #[test]
    fn a_missing_value_is_blank_and_an_absent_column_has_no_header() {
        let mut record = example(2);
        for column in WIND {
            record[column].clear();
        }
        record[Column::U][1] = f64::NAN;
        let text = record.csv();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "t [s],x [m],y [m],psi [rad],u [m/s],v [m/s],r [rad/s],n [rps],delta [rad]");
        assert_eq!(lines[2].split(',').nth(4), Some(""));
        assert_eq!(lines.len(), 3);
    }

    #[test]
    fn unwrapping_removes_whole_turns_and_skips_missing_values() {
        let mut angles = [3.0, f64::NAN, -3.0, -2.9];
        unwrap(&mut angles);
        assert!((angles[2] - (TAU - 3.0)).abs() < 1e-12 && (angles[3] - (TAU - 2.9)).abs() < 1e-12);
        assert!(angles[1].is_nan());
    }

    #[test]
    fn the_mean_wind_blows_to_where_it_does_not_come_from() {
        let mut record = example(3);
        record.change(Column::WindFrom, |_| 0.0);
        let [north, east] = record.mean_wind().unwrap();
        assert!((north + 2.0).abs() < 1e-12 && east.abs() < 1e-12);
    }
}
