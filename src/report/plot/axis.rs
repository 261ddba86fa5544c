//! Axes: what they are called, the range they cover, and equal scales for tracks.
//! Where their ticks fall is in `ticks`; nothing here draws.

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
#[must_use]
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
    /// An angle in degrees: steps beyond 10 are those of a compass, 15, 30, 45, 90, 180 and so on.
    pub angle: bool,
}

impl Axis {
    /// A linear axis fitted to the data.
    pub fn new(label: impl Into<String>) -> Self {
        Self { label: label.into(), ..Self::default() }
    }

    /// An axis with one slot for each label.
    pub fn categories<S: Into<String>>(label: impl Into<String>, labels: impl IntoIterator<Item = S>) -> Self {
        let scale = Scale::Categories(labels.into_iter().map(Into::into).collect());
        Self { label: label.into(), scale, ..Self::default() }
    }

    /// The same axis on a logarithmic scale.
    pub fn log(self) -> Self {
        Self { scale: Scale::Log, ..self }
    }

    /// The same axis from `lo` to `hi`.
    pub fn range(self, lo: f64, hi: f64) -> Self {
        Self { range: Some((lo, hi)), ..self }
    }

    /// The same axis, covering `value` whatever the data are.
    pub fn including(mut self, value: f64) -> Self {
        self.include.push(value);
        self
    }

    /// The same axis with a tick every `step`.
    pub fn every(self, step: f64) -> Self {
        Self { every: Some(step), ..self }
    }

    /// The same axis as one of an angle in degrees, with ticks at parts of a right angle.
    pub fn angle(self) -> Self {
        Self { angle: true, ..self }
    }

    pub(super) fn labels(&self) -> Option<&[String]> {
        match &self.scale {
            Scale::Categories(labels) => Some(labels),
            Scale::Linear | Scale::Log => None,
        }
    }
}

/// The smallest interval that contains a set of values.
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

#[cfg(test)]
mod tests {
    use super::*;

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
}
