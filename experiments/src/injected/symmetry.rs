//! Changes of a recording that change nothing physical: turned, mirrored, moved, and scaled by Froude's law.
//! A verdict that changes under them is wrong in one of the two cases.

use super::record::{Column, Record, wrapped};

impl Record {
    /// Turns track, heading and wind clockwise about the origin by an angle \[rad\].
    pub fn turn(&mut self, angle: f64) {
        let (sin, cos) = angle.sin_cos();
        for row in 0..self.len() {
            let (x, y) = (self[Column::X][row], self[Column::Y][row]);
            self[Column::X][row] = x * cos - y * sin;
            self[Column::Y][row] = x * sin + y * cos;
        }
        self.change(Column::Psi, |psi| psi + angle);
        self.change(Column::WindFrom, |from| wrapped(from + angle));
    }

    /// Exchanges port and starboard.
    pub fn mirror(&mut self) {
        for column in [Column::Y, Column::Psi, Column::V, Column::R, Column::Delta] {
            self.change(column, |value| -value);
        }
        for column in [Column::WindFrom, Column::ApparentFrom] {
            self.change(column, |from| wrapped(-from));
        }
    }

    /// Moves the origin of positions \[m\].
    pub fn shift_origin(&mut self, north: f64, east: f64) {
        self.change(Column::X, |x| x + north);
        self.change(Column::Y, |y| y + east);
    }

    /// Moves the origin of time \[s\].
    pub fn shift_time(&mut self, by: f64) {
        self.change(Column::T, |t| t + by);
    }

    /// The same motion of a ship so many times as long: times and speeds grow by the square root.
    pub fn scale(&mut self, factor: f64) {
        let root = factor.sqrt();
        for column in [Column::X, Column::Y] {
            self.change(column, |v| v * factor);
        }
        for column in [Column::T, Column::U, Column::V, Column::WindSpeed, Column::ApparentSpeed] {
            self.change(column, |v| v * root);
        }
        for column in [Column::R, Column::N] {
            self.change(column, |v| v / root);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::injected::record::COLUMNS;
    use crate::injected::record::tests::example;

    fn close(a: &Record, b: &Record) {
        assert_eq!(a.len(), b.len());
        for column in COLUMNS {
            for (p, q) in a[column].iter().zip(&b[column]) {
                assert!((p - q).abs() < 1e-9, "{column:?}: {p} and {q}");
            }
        }
    }

    #[test]
    fn mirrored_twice_is_the_identity() {
        let mut record = example(50);
        record.mirror();
        assert!(record[Column::Delta][7] < 0.0 && record[Column::R][3] < 0.0);
        record.mirror();
        close(&record, &example(50));
    }

    #[test]
    fn turned_there_and_back_is_the_identity_and_keeps_distances() {
        let (mut record, before) = (example(50), example(50));
        record.turn(1.1);
        let step = |r: &Record| (r[Column::X][9] - r[Column::X][2]).hypot(r[Column::Y][9] - r[Column::Y][2]);
        assert!((step(&record) - step(&before)).abs() < 1e-12);
        assert!((record[Column::Psi][4] - before[Column::Psi][4] - 1.1).abs() < 1e-12);
        record.turn(-1.1);
        close(&record, &before);
    }

    #[test]
    fn a_turned_track_still_points_along_the_turned_heading() {
        // Straight ahead at 2 m/s on heading 0.4.
        let mut record = example(10);
        for k in 0..10 {
            let t = record[Column::T][k];
            record[Column::X][k] = 2.0 * t * 0.4_f64.cos();
            record[Column::Y][k] = 2.0 * t * 0.4_f64.sin();
            record[Column::Psi][k] = 0.4;
        }
        record.turn(2.0);
        let course = record[Column::Y][9].atan2(record[Column::X][9]);
        assert!((course - record[Column::Psi][9]).abs() < 1e-12);
    }

    #[test]
    fn a_scaled_motion_has_the_same_froude_number_and_rates_times_time() {
        let (mut record, before) = (example(20), example(20));
        record.scale(4.0);
        let froude = |r: &Record, length: f64| r[Column::U][3] / (9.81 * length).sqrt();
        assert!((froude(&record, 4.0) - froude(&before, 1.0)).abs() < 1e-12);
        let turns = |r: &Record| r[Column::R][3] * r[Column::T][3];
        assert!((turns(&record) - turns(&before)).abs() < 1e-12);
        record.scale(0.25);
        close(&record, &before);
    }

    #[test]
    fn moved_origins_move_nothing_else() {
        let (mut record, before) = (example(20), example(20));
        record.shift_origin(100.0, -50.0);
        record.shift_time(1000.0);
        assert_eq!(record[Column::X][3], before[Column::X][3] + 100.0);
        assert_eq!(record[Column::T][3], before[Column::T][3] + 1000.0);
        assert_eq!(record[Column::U], before[Column::U]);
    }
}
