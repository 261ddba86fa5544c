//! Axes: the range an axis covers, where its ticks fall, how they read, and equal scales for tracks.
//! Pure arithmetic: nothing here draws.

use crate::numerals::superscript;

/// Values at or beyond this size are treated as missing: their differences would overflow.
const LARGEST: f64 = 1e300;
/// Values at or below this size have no place on a logarithmic axis.
const SMALLEST: f64 = 1e-290;

/// Whether a value can be drawn.
pub(super) fn drawable(v: f64) -> bool {
    v.abs() < LARGEST
}

/// How an axis turns values into lengths.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Scale {
    /// Equal differences are equal lengths.
    #[default]
    Linear,
    /// Equal ratios are equal lengths; values that are not positive are not drawn.
    Log,
    /// One slot for each label; the values are 0, 1, 2 ... On a y axis the first label is at the top.
    Categories(Vec<String>),
}

/// One axis of a panel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    /// What is plotted, with its unit: `yaw rate r [deg/s]`.
    pub label: String,
    /// How values become lengths.
    pub scale: Scale,
    /// The ends of the axis; `None` fits them to the data.
    pub range: Option<(f64, f64)>,
    /// Values an axis fitted to the data must cover too.
    pub include: Vec<f64>,
    /// Distance between ticks on a linear axis (90 for a heading in degrees); `None` chooses a 1-2-5 step.
    pub every: Option<f64>,
}

impl Axis {
    /// A linear axis fitted to the data.
    #[must_use]
    pub fn new(label: impl Into<String>) -> Self {
        Self { label: label.into(), ..Self::default() }
    }

    /// An axis with one slot for each label.
    #[must_use]
    pub fn categories<S: Into<String>>(label: impl Into<String>, labels: impl IntoIterator<Item = S>) -> Self {
        let scale = Scale::Categories(labels.into_iter().map(Into::into).collect());
        Self { label: label.into(), scale, ..Self::default() }
    }

    /// The same axis on a logarithmic scale.
    #[must_use]
    pub fn log(self) -> Self {
        Self { scale: Scale::Log, ..self }
    }

    /// The same axis from `lo` to `hi`.
    #[must_use]
    pub fn range(self, lo: f64, hi: f64) -> Self {
        Self { range: Some((lo, hi)), ..self }
    }

    /// The same axis, covering `value` whatever the data are.
    #[must_use]
    pub fn including(mut self, value: f64) -> Self {
        self.include.push(value);
        self
    }

    /// The same axis with a tick every `step`.
    #[must_use]
    pub fn every(self, step: f64) -> Self {
        Self { every: Some(step), ..self }
    }

    pub(super) fn labels(&self) -> Option<&[String]> {
        match &self.scale {
            Scale::Categories(labels) => Some(labels),
            Scale::Linear | Scale::Log => None,
        }
    }
}

/// The smallest interval that holds a set of values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Extent {
    pub lo: f64,
    pub hi: f64,
    /// Only positive values count.
    positive: bool,
    /// Zero is the foot of bars: the axis ends there, without padding.
    pub foot: bool,
}

impl Extent {
    pub fn new(scale: &Scale) -> Self {
        Self { lo: f64::INFINITY, hi: f64::NEG_INFINITY, positive: *scale == Scale::Log, foot: false }
    }

    pub fn add(&mut self, v: f64) {
        if drawable(v) && (!self.positive || v > SMALLEST) {
            self.lo = self.lo.min(v);
            self.hi = self.hi.max(v);
        }
    }

    pub fn add_foot(&mut self) {
        if !self.positive {
            self.add(0.0);
            self.foot = true;
        }
    }

    pub fn is_empty(&self) -> bool {
        self.lo > self.hi
    }
}

/// The ends of an axis: as fixed, or the data with some air around it.
pub(super) fn limits(axis: &Axis, data: Extent, padding: f64) -> (f64, f64) {
    if let Scale::Categories(labels) = &axis.scale {
        return (-0.5, labels.len().max(1) as f64 - 0.5);
    }
    let log = axis.scale == Scale::Log;
    if let Some((a, b)) = axis.range {
        let (lo, hi) = if a <= b { (a, b) } else { (b, a) };
        if drawable(lo) && drawable(hi) && lo < hi && (!log || lo > 0.0) {
            return (lo, hi);
        }
    }
    let mut data = data;
    axis.include.iter().for_each(|&v| data.add(v));
    if data.is_empty() {
        return if log { (0.1, 10.0) } else { (0.0, 1.0) };
    }
    if log {
        let (lo, hi) = (data.lo.log10(), data.hi.log10());
        let air = if hi - lo < 1e-9 { 0.5 } else { padding * (hi - lo) };
        return (10f64.powf((lo - air).max(-300.0)), 10f64.powf((hi + air).min(300.0)));
    }
    let span = data.hi - data.lo;
    // A constant series shows its value in the middle of a range that says nothing about its noise.
    if span <= 1e-12 * data.hi.abs().max(data.lo.abs()) || span == 0.0 {
        let air = if data.hi == 0.0 { 1.0 } else { 0.1 * data.hi.abs() };
        return (data.lo - air, data.hi + air);
    }
    let air = padding * span;
    let lo = if data.foot && data.lo == 0.0 { 0.0 } else { data.lo - air };
    let hi = if data.foot && data.hi == 0.0 { 0.0 } else { data.hi + air };
    (lo, hi)
}

/// Extends the shorter of two ranges about its middle, so that one unit is as long on both axes.
///
/// `width` and `height` are the lengths the ranges are drawn on, in any common unit. Neither range ever shrinks.
#[must_use]
pub fn equal_aspect(x: (f64, f64), y: (f64, f64), width: f64, height: f64) -> ((f64, f64), (f64, f64)) {
    let per_length = ((x.1 - x.0) / width).max((y.1 - y.0) / height);
    let widen = |(lo, hi): (f64, f64), length: f64| {
        let missing = (per_length * length - (hi - lo)).max(0.0);
        (lo - 0.5 * missing, hi + 0.5 * missing)
    };
    (widen(x, width), widen(y, height))
}

/// An axis with its ends and ticks decided.
#[derive(Clone, Debug)]
pub(super) struct Ruler {
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

/// Decides the ticks of an axis `length` px long whose labels need `room(label)` px each.
pub(super) fn ruler(
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
                Some(step) if drawable(step) && step > 0.0 && (hi - lo) / step <= 40.0 => step,
                _ => nice_step((hi - lo) * (spacing / length).min(1.0)),
            };
            // Coarser until the labels stand clear of one another.
            for _ in 0..6 {
                (ruler.ticks, ruler.factor) = linear_ticks(lo, hi, step);
                let widest = ruler.ticks.iter().map(|(_, label)| room(label)).fold(0.0, f64::max);
                if ruler.ticks.len() < 3 || widest <= step / (hi - lo) * length {
                    break;
                }
                step = nice_step(step * 1.01);
            }
        }
    }
    ruler
}

/// The smallest of 1, 2, 5 times a power of ten that is at least `at_least`.
fn nice_step(at_least: f64) -> f64 {
    let magnitude = 10f64.powf(at_least.log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * magnitude).find(|&s| s >= at_least * (1.0 - 1e-9)).unwrap_or(at_least)
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

/// Decimals needed to tell neighbouring multiples of `step` apart and to print them exactly.
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
    let ticks =
        powers.iter().filter(|v| (v.log10().round() as i32).rem_euclid(stride) == 0).map(|&v| (v, label(v))).collect();
    let minor = if decades < 6.0 { at(&[2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]) } else { vec![] };
    (ticks, minor)
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn a_constant_series_gets_a_range_around_its_value() {
        for v in [0.0, 5.0, -3e-9, 1e12] {
            let mut data = Extent::new(&Scale::Linear);
            data.add(v);
            let (lo, hi) = limits(&Axis::new(""), data, 0.05);
            assert!(lo < v && v < hi, "{lo} {v} {hi}");
        }
    }

    #[test]
    fn a_range_ignores_what_cannot_be_drawn() {
        let mut data = Extent::new(&Scale::Log);
        [f64::NAN, f64::INFINITY, 0.0, -4.0, 2.0, 200.0].into_iter().for_each(|v| data.add(v));
        assert_eq!((data.lo, data.hi), (2.0, 200.0));
    }

    #[test]
    fn bars_stand_on_the_end_of_the_axis() {
        let mut data = Extent::new(&Scale::Linear);
        data.add_foot();
        data.add(3.0);
        assert_eq!(limits(&Axis::new(""), data, 0.05).0, 0.0);
    }

    #[test]
    fn equal_aspect_gives_one_unit_the_same_length_on_both_axes_and_never_shrinks() {
        for (x, y, w, h) in [
            ((0.0, 100.0), (0.0, 10.0), 900.0, 600.0),
            ((-5.0, 5.0), (100.0, 900.0), 900.0, 600.0),
            ((0.0, 3.0), (0.0, 2.0), 900.0, 600.0),
        ] {
            let (ex, ey) = equal_aspect(x, y, w, h);
            let (px, py) = ((ex.1 - ex.0) / w, (ey.1 - ey.0) / h);
            assert!((px - py).abs() < 1e-12 * px);
            assert!(ex.0 <= x.0 && ex.1 >= x.1 && ey.0 <= y.0 && ey.1 >= y.1);
            assert!(((ex.0 + ex.1) - (x.0 + x.1)).abs() < 1e-9 && ((ey.0 + ey.1) - (y.0 + y.1)).abs() < 1e-9);
        }
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
