//! Where the ticks of an axis fall and how they read.
//! Pure arithmetic: the range of the axis is given, and nothing here draws.

use crate::numerals::superscript;
use crate::report::plot::axis::{Axis, Scale, drawable};

/// An axis with its ends and ticks decided.
#[derive(Clone, Debug)]
pub(in crate::report::plot) struct Ruler {
    pub lo: f64,
    pub hi: f64,
    log: bool,
    flipped: bool,
    pub ticks: Vec<(f64, String)>,
    pub minor: Vec<f64>,
    /// Power of ten the tick labels are to be multiplied by: `×10³`.
    pub factor: Option<String>,
}

impl Ruler {
    /// Where `v` falls: 0 at the low end, 1 at the high end; `None` for what cannot be drawn.
    pub fn fraction(&self, v: f64) -> Option<f64> {
        if !drawable(v) || (self.log && v <= 0.0) {
            return None;
        }
        let f = if self.log {
            (v.log10() - self.lo.log10()) / (self.hi.log10() - self.lo.log10())
        } else {
            (v - self.lo) / (self.hi - self.lo)
        };
        f.is_finite().then_some(if self.flipped { 1.0 - f } else { f })
    }

    /// As [`Self::fraction`], with infinities at the ends: for spans that are open on one side.
    pub fn fraction_or_end(&self, v: f64) -> Option<f64> {
        if v.is_nan() {
            return None;
        }
        let end = if v > 0.0 { 1.0 } else { 0.0 };
        Some(self.fraction(v).unwrap_or(if self.log && v <= 0.0 { 0.0 } else { end }))
    }
}

/// Fewest ticks of an axis of numbers.
const FEWEST: usize = 3;
/// Of the room around a label, what it can do without, px.
const SPARE: f64 = 18.0;

/// Decides the ticks of an axis `length` px long whose labels need `room(label)` px each.
pub(in crate::report::plot) fn ruler(
    axis: &Axis,
    (lo, hi): (f64, f64),
    length: f64,
    spacing: f64,
    flip: bool,
    room: impl Fn(&str) -> f64,
) -> Ruler {
    let mut ruler = Ruler { lo, hi, log: false, flipped: false, ticks: vec![], minor: vec![], factor: None };
    match &axis.scale {
        Scale::Categories(labels) => {
            ruler.flipped = flip;
            ruler.ticks = labels.iter().enumerate().map(|(i, label)| (i as f64, label.clone())).collect();
        }
        Scale::Log => {
            ruler.log = true;
            (ruler.ticks, ruler.minor) = log_ticks(lo, hi, length, &room);
        }
        Scale::Linear => {
            let mut step = match axis.every {
                // On a range that was given the step is kept, however long; on one fitted to the data only where it divides it.
                Some(step)
                    if drawable(step)
                        && step > 0.0
                        && (hi - lo) / step <= 40.0
                        && (axis.range.is_some() || (hi - lo) / step >= 2.0) =>
                {
                    step
                }
                _ => step_of(axis, (hi - lo) * (spacing / length).min(1.0)),
            };
            // Coarser until the labels stand clear of one another.
            for _ in 0..6 {
                (ruler.ticks, ruler.factor) = linear_ticks(lo, hi, step);
                let widest = ruler.ticks.iter().map(|(_, label)| room(label)).fold(0.0, f64::max);
                if ruler.ticks.len() < 3 || widest <= step / (hi - lo) * length {
                    break;
                }
                step = step_of(axis, step * 1.01);
            }
            // Two ticks hardly show a scale: finer again, if the labels then do not touch. A step beyond a range that was given asks
            // for no ticks.
            let asked = axis.range.is_none() || !axis.every.is_some_and(|every| every > hi - lo);
            for _ in 0..4 {
                if ruler.ticks.len() >= FEWEST || !asked {
                    break;
                }
                step = step_of(axis, step * 0.39);
                let (ticks, factor) = linear_ticks(lo, hi, step);
                let widest = ticks.iter().map(|(_, label)| room(label)).fold(0.0, f64::max);
                if widest - SPARE > step / (hi - lo) * length {
                    break;
                }
                (ruler.ticks, ruler.factor) = (ticks, factor);
            }
        }
    }
    ruler
}

/// The smallest of 1, 2, 5 times a power of ten that is at least `at_least`.
#[must_use]
pub fn nice_step(at_least: f64) -> f64 {
    let magnitude = 10f64.powf(at_least.log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * magnitude).find(|&s| s >= at_least * (1.0 - 1e-9)).unwrap_or(at_least)
}

/// The steps of an angle in degrees beyond 10.
const COMPASS: [f64; 6] = [15.0, 30.0, 45.0, 90.0, 180.0, 360.0];

/// The smallest step of an axis that is at least `at_least`.
fn step_of(axis: &Axis, at_least: f64) -> f64 {
    let compass = COMPASS.into_iter().find(|&s| s >= at_least * (1.0 - 1e-9));
    compass.filter(|_| axis.angle && at_least > 10.0).unwrap_or_else(|| nice_step(at_least))
}

fn linear_ticks(lo: f64, hi: f64, step: f64) -> (Vec<(f64, String)>, Option<String>) {
    let slack = 1e-9 * (hi - lo);
    let (first, last) = (((lo - slack) / step).ceil(), ((hi + slack) / step).floor());
    if !(first.abs() < 1e12 && last - first < 200.0) {
        return (vec![], None);
    }
    let values: Vec<f64> = (0..=(last - first).max(-1.0) as i64).map(|i| (first + i as f64) * step).collect();
    let largest = values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let exponent = if largest >= 1e5 || (largest > 0.0 && largest < 1e-3) {
        3 * (largest.log10() / 3.0 + 1e-12).floor() as i32
    } else {
        0
    };
    let scale = 10f64.powi(exponent);
    let decimals = decimals_of(step / scale);
    let ticks = values.into_iter().map(|v| (v, plain(v / scale, decimals))).collect();
    (ticks, (exponent != 0).then(|| format!("×10{}", superscript(exponent))))
}

/// Decimals needed to distinguish neighbouring multiples of `step` and to print them exactly.
fn decimals_of(step: f64) -> usize {
    (0..12)
        .find(|&d| {
            let scaled = step * 10f64.powi(d as i32);
            (scaled - scaled.round()).abs() < 1e-6 * scaled.max(1e-300) && scaled.round() >= 1.0
        })
        .unwrap_or(12)
}

/// A number with a true minus sign, and no minus on zero.
fn plain(v: f64, decimals: usize) -> String {
    let text = format!("{v:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| c == '0' || c == '.') => rest.to_owned(),
        Some(rest) => format!("\u{2212}{rest}"),
        None => text,
    }
}

fn log_ticks(lo: f64, hi: f64, length: f64, room: &impl Fn(&str) -> f64) -> (Vec<(f64, String)>, Vec<f64>) {
    let (first, last) = (lo.log10().floor() as i32, hi.log10().ceil() as i32);
    let inside = |v: &f64| *v >= lo * (1.0 - 1e-9) && *v <= hi * (1.0 + 1e-9);
    let decades = hi.log10() - lo.log10();
    let at = |mantissas: &[f64]| -> Vec<f64> {
        (first..=last).flat_map(|e| mantissas.iter().map(move |m| m * 10f64.powi(e))).filter(inside).collect()
    };
    if decades < 0.7 {
        let step = nice_step((hi - lo) / 5.0);
        return (linear_ticks(lo, hi, step).0, vec![]);
    }
    let short = lo >= 0.9e-3 && hi <= 1.1e4;
    let label = |v: f64| {
        let e = v.log10().floor() as i32;
        let m = (v / 10f64.powi(e)).round();
        let (m, e) = if m >= 10.0 { (1.0, e + 1) } else { (m, e) };
        match (short, m == 1.0) {
            (true, _) => plain(m * 10f64.powi(e), (-e).max(0) as usize),
            (false, true) => format!("10{}", superscript(e)),
            (false, false) => format!("{m}·10{}", superscript(e)),
        }
    };
    if decades < 2.0 {
        let values = at(&[1.0, 2.0, 5.0]);
        let ticks: Vec<_> = values.into_iter().map(|v| (v, label(v))).collect();
        let widest = ticks.iter().map(|(_, l)| room(l)).fold(0.0, f64::max);
        if widest <= 0.3 / decades * length {
            return (ticks, at(&[3.0, 4.0, 6.0, 7.0, 8.0, 9.0]));
        }
    }
    let powers = at(&[1.0]);
    let widest = powers.iter().map(|&v| room(&label(v))).fold(1.0, f64::max);
    let stride = (widest * decades / length).ceil().max(1.0) as i32;
    let ticks: Vec<(f64, String)> =
        powers.iter().filter(|v| (v.log10().round() as i32).rem_euclid(stride) == 0).map(|&v| (v, label(v))).collect();
    let minor = if decades < 6.0 { at(&[2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]) } else { vec![] };
    if ticks.len() >= FEWEST {
        return (ticks, minor);
    }
    // Powers of ten alone are too few: with steps between them, the coarsest that give three.
    let finer = [&[1.0, 3.0][..], &[1.0, 2.0, 5.0], &[1.0, 2.0, 3.0, 5.0, 7.0]].map(&at);
    let some = finer.into_iter().find(|values| values.len() >= FEWEST);
    (some.map_or(ticks, |values| values.into_iter().map(|v| (v, label(v))).collect()), minor)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::plot::axis::{Extent, limits};

    fn labels(axis: &Axis, range: (f64, f64)) -> Vec<String> {
        ruler(axis, range, 900.0, 110.0, false, |l| 14.0 * l.chars().count() as f64)
            .ticks
            .into_iter()
            .map(|(_, label)| label)
            .collect()
    }

    #[test]
    fn linear_ticks_are_one_two_five_steps_without_noise_digits() {
        assert_eq!(labels(&Axis::new("t"), (-0.31, 0.33)), ["−0.3", "−0.2", "−0.1", "0.0", "0.1", "0.2", "0.3"]);
        assert_eq!(labels(&Axis::new("t"), (0.0, 1190.0)), ["0", "200", "400", "600", "800", "1000"]);
    }

    #[test]
    fn ticks_can_be_asked_for_at_every_ninety_degrees() {
        assert_eq!(labels(&Axis::new("psi").every(90.0), (-180.0, 180.0)), ["−180", "−90", "0", "90", "180"]);
    }

    #[test]
    fn an_angle_has_ticks_at_parts_of_a_right_angle() {
        let psi = Axis::new("psi").angle();
        assert_eq!(labels(&psi, (0.0, 545.0)), ["0", "90", "180", "270", "360", "450", "540"]);
        assert_eq!(labels(&psi, (-790.0, 790.0)), ["−720", "−360", "0", "360", "720"]);
        assert_eq!(labels(&psi, (281.0, 352.0)), ["290", "300", "310", "320", "330", "340", "350"]);
    }

    #[test]
    fn large_and_small_numbers_share_one_power_of_ten() {
        let r = ruler(&Axis::new("X"), (0.0, 2.4e6), 900.0, 110.0, false, |_| 10.0);
        assert_eq!(r.factor.as_deref(), Some("×10⁶"));
        assert_eq!(r.ticks.last().map(|t| t.1.as_str()), Some("2.0"));
        let r = ruler(&Axis::new("X"), (0.0, 4e-5), 900.0, 110.0, false, |_| 10.0);
        assert_eq!(r.factor.as_deref(), Some("×10⁻⁶"));
    }

    #[test]
    fn log_ticks_are_powers_of_ten() {
        assert_eq!(labels(&Axis::new("cost").log(), (1e-8, 1e2)).first().map(String::as_str), Some("10⁻⁸"));
        assert_eq!(labels(&Axis::new("cost").log(), (1.0, 1e3)), ["1", "10", "100", "1000"]);
        assert_eq!(labels(&Axis::new("cost").log(), (1.0, 30.0)), ["1", "2", "5", "10", "20"]);
    }

    #[test]
    fn a_short_axis_has_three_ticks_and_one_that_asks_for_none_has_none() {
        let count = |axis: &Axis, range, length| {
            ruler(axis, range, length, 110.0, false, |l| 13.0 * l.chars().count() as f64 + 26.0).ticks.len()
        };
        for range in [(0.0, 1.0), (-83.0, 91.0), (0.0, 1190.0), (-0.031, 0.033), (3.2, 3.9)] {
            assert!(count(&Axis::new("t"), range, 260.0) >= 3, "{range:?}");
        }
        for range in [(2.0, 7.5), (1.5, 40.0), (0.4, 11.0), (0.2, 90.0)] {
            assert!(count(&Axis::new("t").log(), range, 500.0) >= 3, "{range:?}");
        }
        assert_eq!(count(&Axis::new("east").range(-1.4, 1.4).every(10.0), (-1.4, 1.4), 500.0), 1, "zero alone");
    }

    #[test]
    fn extreme_ranges_neither_hang_nor_panic() {
        for range in [(-9e299, 9e299), (1e300 / 2.0, 1e300 / 2.0 * 1.5), (1e9, 1e9 + 1e-5), (-1e-300, 1e-300)] {
            let r = ruler(&Axis::new(""), range, 900.0, 110.0, false, |_| 10.0);
            assert!(r.ticks.len() < 201);
        }
        let mut data = Extent::new(&Scale::Log);
        [f64::MIN_POSITIVE, 1e-280, 9e299].into_iter().for_each(|v| data.add(v));
        let (lo, hi) = limits(&Axis::new("").log(), data, 0.05);
        assert!(lo > 0.0 && lo < 1e-280 && hi > 9e299 && hi.is_finite(), "{lo} {hi}");
        let r = ruler(&Axis::new("").log(), (lo, hi), 900.0, 110.0, false, |_| 60.0);
        assert!(r.ticks.len() < 20);
    }

    #[test]
    fn categories_on_a_flipped_axis_read_from_the_top() {
        let axis = Axis::categories("", ["first", "second"]);
        let r = ruler(&axis, limits(&axis, Extent::new(&axis.scale), 0.05), 100.0, 10.0, true, |_| 0.0);
        assert_eq!(r.fraction(0.0), Some(0.75));
        assert_eq!(r.fraction(1.0), Some(0.25));
    }
}
