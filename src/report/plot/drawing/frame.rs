//! The plot of a panel: its rectangle on the sheet, its two axes, and where a point falls.
//! It draws nothing.

use super::extent::extents;
use super::style::TICK;
use super::ticks::{Ruler, ruler};
use crate::report::plot::axis::{Scale, equal_aspect, limits};
use crate::report::plot::figure::Panel;
use crate::report::plot::sheet::font::text_width;
use crate::report::plot::sheet::geometry::{Px, Rect};

/// The axes of a panel on its plot rectangle.
pub(in crate::report::plot) struct Frame {
    pub plot: Rect,
    pub x: Ruler,
    pub y: Ruler,
}

impl Frame {
    /// The axes of a panel, their ranges fitted to its layers where they are not given.
    pub fn new(panel: &Panel, plot: Rect) -> Self {
        let (ex, ey) = extents(panel);
        let (mut x, mut y) = (limits(&panel.x, ex, 0.02), limits(&panel.y, ey, 0.05));
        let (w, h) = (f64::from(plot.width()), f64::from(plot.height()));
        if panel.equal_aspect && panel.x.scale == Scale::Linear && panel.y.scale == Scale::Linear {
            (x, y) = equal_aspect(x, y, w, h);
        }
        let wide = |label: &str| f64::from(text_width(label, TICK, false)) + 26.0;
        Self {
            plot,
            x: ruler(&panel.x, x, w, 110.0, false, wide),
            y: ruler(&panel.y, y, h, 48.0, true, |_| f64::from(TICK) * 1.7),
        }
    }

    /// Where a point falls on the sheet, perhaps outside the plot.
    pub fn at(&self, x: f64, y: f64) -> Option<Px> {
        Some((self.x_at(x)?, self.y_at(y)?))
    }

    /// Where a value of the x axis falls, px from the left of the sheet.
    pub fn x_at(&self, v: f64) -> Option<f32> {
        self.x.fraction(v).map(|f| self.px(f))
    }

    /// Where a value of the y axis falls, px from the top of the sheet.
    pub fn y_at(&self, v: f64) -> Option<f32> {
        self.y.fraction(v).map(|f| self.py(f))
    }

    /// Px from the left of the sheet, at a fraction of the x axis.
    pub fn px(&self, fraction: f64) -> f32 {
        (f64::from(self.plot.left) + fraction * f64::from(self.plot.width())).clamp(-1e6, 1e6) as f32
    }

    /// Px from the top of the sheet, at a fraction of the y axis.
    pub fn py(&self, fraction: f64) -> f32 {
        (f64::from(self.plot.bottom) - fraction * f64::from(self.plot.height())).clamp(-1e6, 1e6) as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::plot::layer::Layer;
    use crate::report::plot::palette;

    #[test]
    fn tracks_have_the_same_metres_per_pixel_on_both_axes() {
        let panel = Panel::track("").with(Layer::line("a", palette::TRUTH, [(0.0, 0.0), (1000.0, 40.0)]));
        let frame = Frame::new(&panel, Rect { left: 100.0, top: 20.0, right: 880.0, bottom: 520.0 });
        let (Some(a), Some(b), Some(c)) = (frame.at(0.0, 0.0), frame.at(500.0, 0.0), frame.at(0.0, 500.0)) else {
            panic!("finite points have a place");
        };
        assert!(((b.0 - a.0) - (a.1 - c.1)).abs() < 0.01, "{} {}", b.0 - a.0, a.1 - c.1);
    }
}
