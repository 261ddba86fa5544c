//! How surely the ratio and the angle of track and velocity are known: the track against dead reckoning, with the noise of both.
//! What they say of units, currents and headings is decided in `signs`.

use super::response::integral;
use super::series::Series;
use nalgebra::Complex;

/// Sums over rows of the track `z = x + i y` and of dead reckoning `d`, the integral of the velocity along the earth's axes, each less its mean
/// in a stretch: `z = g d + e`, where `|g|` is how many times as fast as the velocity the track is, and `arg g` its angle \[rad\].
#[derive(Clone, Copy, Debug, Default)]
pub struct Course {
    /// Of products of a row with itself, and with the next: of z with z, of d with z, of d with d.
    own: Products,
    next: Products,
    /// Rows less the means that were taken out.
    freedom: f64,
}

/// Sums of products of two rows, the mean of either order.
#[derive(Clone, Copy, Debug, Default)]
struct Products {
    track: f64,
    both: Complex<f64>,
    reckoned: f64,
}

impl Products {
    fn add(&mut self, [z, d]: [Complex<f64>; 2], [other_z, other_d]: [Complex<f64>; 2]) {
        self.track += (z.conj() * other_z).re;
        self.both += 0.5 * (d.conj() * other_z + other_d.conj() * z);
        self.reckoned += (d.conj() * other_d).re;
    }

    /// Products of what a gain leaves.
    fn left(&self, gain: Complex<f64>) -> f64 {
        self.track - 2.0 * (gain.conj() * self.both).re + gain.norm_sqr() * self.reckoned
    }
}

impl Course {
    /// Adds what the track of some rows says, given the velocity to the north and to the east \[m/s\].
    pub fn add(&mut self, series: &Series<'_>, [x, y]: [&[f64]; 2], [north, east]: [&[f64]; 2]) {
        let reckoned = [integral(&series.t, |i| north[i]), integral(&series.t, |i| east[i])];
        for stretch in &series.stretches {
            let row = |i: usize| [Complex::new(x[i], y[i]), Complex::new(reckoned[0][i], reckoned[1][i])];
            let rows: Vec<[Complex<f64>; 2]> = stretch
                .clone()
                .filter(|i| [x[*i], y[*i], north[*i], east[*i]].iter().all(|v| v.is_finite()))
                .map(row)
                .collect();
            let count = rows.len() as f64;
            let sum = rows.iter().fold([Complex::default(); 2], |[z, d], row| [z + row[0], d + row[1]]);
            let centred: Vec<[Complex<f64>; 2]> =
                rows.iter().map(|[z, d]| [z - sum[0] / count, d - sum[1] / count]).collect();
            centred.iter().for_each(|row| self.own.add(*row, *row));
            centred.windows(2).for_each(|pair| self.next.add(pair[0], pair[1]));
            self.freedom += (count - 1.0).max(0.0);
        }
    }

    /// Ratio and angle \[rad\], each with its standard error: the two parts of g are known alike, so that the angle is known to that share of
    /// `|g|`. Successive residuals are alike by a correlation r, and worth `(1 - r)/(1 + r)` of their number. `None` where nothing moves.
    pub fn ratio_and_angle(&self) -> Option<[(f64, f64); 2]> {
        let freedom = self.freedom - 1.0;
        if self.own.reckoned <= 0.0 || freedom <= 0.0 {
            return None;
        }
        let gain = self.own.both / self.own.reckoned;
        let left = self.own.left(gain).max(0.0);
        let likeness = if left > 0.0 { (self.next.left(gain) / left).clamp(0.0, 0.99) } else { 0.0 };
        let square = 0.5 * left / freedom / self.own.reckoned * (1.0 + likeness) / (1.0 - likeness);
        let (ratio, error) = (gain.norm(), square.sqrt());
        let all = [(ratio, error), (gain.arg(), error / ratio)];
        all.iter().all(|(value, error)| value.is_finite() && error.is_finite()).then_some(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::audit::example::noise;
    use crate::recording::{Channel, Recording};
    use crate::statistics::variance;

    /// Ratio and angle of a ship at 4 m/s on a course for so many seconds, whose fixes err by so many metres, with their errors.
    fn sailed(seed: u32, rows: usize, metres: f64) -> ([f64; 2], [f64; 2]) {
        let mut noise = noise(seed);
        // Uniform noise of variance 1.
        let mut white = || 12.0_f64.sqrt() * noise();
        let t: Vec<f64> = (0..rows).map(|i| i as f64).collect();
        let x: Vec<f64> = t.iter().map(|t| 4.0 * t + metres * white()).collect();
        let y: Vec<f64> = t.iter().map(|_| metres * white()).collect();
        let recording =
            Recording::from_channels("run", vec![(Channel::T, t), (Channel::X, x.clone()), (Channel::Y, y.clone())]);
        let recording = recording.unwrap();
        let mut course = Course::default();
        course.add(&Series::from(&recording), [&x, &y], [&vec![4.0; rows], &vec![0.0; rows]]);
        let [(ratio, ratio_error), (angle, angle_error)] = course.ratio_and_angle().unwrap();
        ([ratio, angle], [ratio_error, angle_error])
    }

    #[test]
    fn ratio_and_angle_of_noisy_fixes_scatter_by_their_standard_errors() {
        for (rows, metres) in [(13, 1.0), (60, 1.0), (60, 10.0)] {
            let all: Vec<([f64; 2], [f64; 2])> = (1..200).map(|seed| sailed(seed, rows, metres)).collect();
            for i in 0..2 {
                let scatter = variance(&all.iter().map(|(value, _)| value[i]).collect::<Vec<_>>()).unwrap().sqrt();
                let reported = all.iter().map(|(_, error)| error[i]).sum::<f64>() / all.len() as f64;
                assert!((0.8..1.4).contains(&(reported / scatter)), "{rows} {metres} {i}: {reported} {scatter}");
            }
        }
    }
}
