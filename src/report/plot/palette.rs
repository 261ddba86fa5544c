//! The colours of every figure: the colour-blind-safe palette of Okabe and Ito, with meanings that never change.
//! It is not a theme: a colour that means "baseline" in one figure means it in all of them.

/// An sRGB colour with opacity.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Color {
    /// Red, 0 to 255.
    pub r: u8,
    /// Green, 0 to 255.
    pub g: u8,
    /// Blue, 0 to 255.
    pub b: u8,
    /// Opacity, 0 (invisible) to 1 (solid).
    pub alpha: f32,
}

impl Color {
    /// A solid colour.
    pub const fn rgb(r: u8, g: u8, b: u8) -> Self {
        Self { r, g, b, alpha: 1.0 }
    }

    /// The same colour, `alpha` times as opaque.
    pub fn faded(self, alpha: f32) -> Self {
        Self { alpha: (self.alpha * alpha).clamp(0.0, 1.0), ..self }
    }

    /// The colour at `t` in [0, 1] on the way from `self` to `other`.
    pub fn mix(self, other: Self, t: f64) -> Self {
        let t = t.clamp(0.0, 1.0);
        let channel = |a: u8, b: u8| (f64::from(a) + (f64::from(b) - f64::from(a)) * t).round() as u8;
        Self {
            r: channel(self.r, other.r),
            g: channel(self.g, other.g),
            b: channel(self.b, other.b),
            alpha: self.alpha,
        }
    }

    /// Relative luminance, 0 (black) to 1 (white): decides whether text on this colour is black or white.
    #[must_use]
    pub fn luminance(self) -> f64 {
        let linear = |c: u8| (f64::from(c) / 255.0).powf(2.2);
        0.2126 * linear(self.r) + 0.7152 * linear(self.g) + 0.0722 * linear(self.b)
    }
}

/// Okabe-Ito blue.
pub const BLUE: Color = Color::rgb(0, 114, 178);
/// Okabe-Ito vermillion.
pub const VERMILLION: Color = Color::rgb(213, 94, 0);
/// Okabe-Ito bluish green.
pub const GREEN: Color = Color::rgb(0, 158, 115);
/// Okabe-Ito reddish purple.
pub const PURPLE: Color = Color::rgb(204, 121, 167);
/// Okabe-Ito orange.
pub const ORANGE: Color = Color::rgb(230, 159, 0);
/// Okabe-Ito sky blue.
pub const SKY: Color = Color::rgb(86, 180, 233);
/// A neutral grey for references and for what is left aside.
pub const GREY: Color = Color::rgb(120, 120, 120);

/// What really happened, when the truth is known (a truth simulator).
pub const TRUTH: Color = Color::rgb(0, 0, 0);
/// What was measured.
pub const RECORDED: Color = TRUTH;
/// The model before the fit, or before a mechanism was added.
pub const BASELINE: Color = VERMILLION;
/// The model after the fit, or with the mechanism added.
pub const FITTED: Color = BLUE;
/// A fit that was given the true mechanisms: the best that could be reached.
pub const ORACLE: Color = GREEN;
/// Constraint bands, bounds and criteria.
pub const LIMIT: Color = GREY;

/// Colours for series without a fixed meaning, in the order to use them.
const CYCLE: [Color; 7] = [BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY, GREY];

/// The `i`-th colour for series without a fixed meaning; repeats after the seventh.
pub fn cycle(i: usize) -> Color {
    CYCLE[i % CYCLE.len()]
}

/// Light to dark blue (ColorBrewer "Blues"), `t` from 0 to 1: for quantities that start at zero.
pub(super) fn sequential(t: f64) -> Color {
    ramp(
        &[
            Color::rgb(247, 251, 255),
            Color::rgb(198, 219, 239),
            Color::rgb(107, 174, 214),
            Color::rgb(33, 113, 181),
            Color::rgb(8, 48, 107),
        ],
        t,
    )
}

/// Vermillion through white to blue (ColorBrewer "RdBu"), `t` from 0 to 1: for signed quantities, zero at 0.5.
pub(super) fn diverging(t: f64) -> Color {
    ramp(
        &[
            Color::rgb(178, 24, 43),
            Color::rgb(244, 165, 130),
            Color::rgb(247, 247, 247),
            Color::rgb(146, 197, 222),
            Color::rgb(33, 102, 172),
        ],
        t,
    )
}

fn ramp(stops: &[Color; 5], t: f64) -> Color {
    let position = t.clamp(0.0, 1.0) * (stops.len() - 1) as f64;
    let i = (position as usize).min(stops.len() - 2);
    stops[i].mix(stops[i + 1], position - i as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ramps_start_and_end_at_their_outer_colours_and_accept_any_number() {
        assert_eq!(sequential(0.0), Color::rgb(247, 251, 255));
        assert_eq!(sequential(1.0), Color::rgb(8, 48, 107));
        assert_eq!(diverging(0.5), Color::rgb(247, 247, 247));
        assert_eq!(diverging(-3.0), diverging(0.0));
        assert_eq!(sequential(7.0), sequential(1.0));
    }

    #[test]
    fn colours_with_a_meaning_are_all_different() {
        let meanings = [TRUTH, BASELINE, FITTED, ORACLE, LIMIT];
        for (i, a) in meanings.iter().enumerate() {
            for b in &meanings[i + 1..] {
                assert_ne!(a, b);
            }
        }
    }
}
