//! Numbers as text: significant digits, fixed decimals, intervals and exponents, none of which ever prints NaN.
//! It decides how a value reads, not which values are worth reporting, and imports nothing of the project.

/// Written where there is no value.
pub const DASH: &str = "–";

/// `x` with `digits` significant digits; a dash when it is not finite.
///
/// Plain decimals from 1e-4 up to 1e6, scientific notation (`1.23e-7`) outside.
#[must_use]
pub fn sig(x: f64, digits: usize) -> String {
    if !x.is_finite() {
        return DASH.to_owned();
    }
    if x == 0.0 {
        return "0".to_owned();
    }
    let digits = digits.clamp(1, 17);
    // Rounding first decides the exponent: 9.96 with two digits is 10, not 10.0.
    let scientific = format!("{x:.*e}", digits - 1);
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if !(-4..6).contains(&exponent) {
        return format!("{mantissa}e{exponent}");
    }
    let decimals = digits as i32 - 1 - exponent;
    if decimals >= 0 {
        format!("{x:.*}", decimals as usize)
    } else {
        let unit = 10f64.powi(-decimals);
        format!("{:.0}", (x / unit).round() * unit)
    }
}

/// As [`sig`], with 0 for what is smaller than `floor`: what rounding leaves of nothing.
#[must_use]
pub fn sig_above(x: f64, digits: usize, floor: f64) -> String {
    sig(if x.abs() < floor { 0.0 } else { x }, digits)
}

/// `x` with `decimals` digits after the point; a dash when it is not finite, and no minus sign on zero.
#[must_use]
pub fn fixed(x: f64, decimals: usize) -> String {
    if !x.is_finite() {
        return DASH.to_owned();
    }
    let text = format!("{x:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| matches!(c, '0' | '.')) => rest.to_owned(),
        _ => text,
    }
}

/// `[lo, hi]` with `digits` significant digits; a dash for an end that is not finite.
#[must_use]
pub fn interval(lo: f64, hi: f64, digits: usize) -> String {
    format!("[{}, {}]", sig(lo, digits), sig(hi, digits))
}

/// `1 window`, `3 windows`: a number with its noun, which has a regular plural.
#[must_use]
pub fn number_of(count: usize, noun: &str) -> String {
    format!("{count} {}", plural(count, noun))
}

/// `window` for one and `windows` for any other number of them.
#[must_use]
pub fn plural(count: usize, noun: &str) -> String {
    format!("{noun}{}", if count == 1 { "" } else { "s" })
}

/// `3` as `³`, `-6` as `⁻⁶`.
#[must_use]
pub fn superscript(n: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    n.to_string().chars().map(|c| c.to_digit(10).map_or('⁻', |d| DIGITS[d as usize])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sig_keeps_the_digits_that_count() {
        for (x, digits, text) in [
            (34187.03, 5, "34187"),
            (34187.03, 3, "34200"),
            (0.0123456, 3, "0.0123"),
            (1.2, 3, "1.20"),
            (9.96, 2, "10"),
            (-0.0469, 2, "-0.047"),
            (1.234e-7, 3, "1.23e-7"),
            (2.5e9, 2, "2.5e9"),
            (999_999.9, 3, "1.00e6"),
            (0.0, 3, "0"),
            (-0.0, 3, "0"),
        ] {
            assert_eq!(sig(x, digits), text, "sig({x}, {digits})");
        }
    }

    #[test]
    fn numbers_that_are_not_finite_print_as_a_dash() {
        for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(sig(x, 3), DASH);
            assert_eq!(fixed(x, 2), DASH);
        }
        assert_eq!(interval(f64::NEG_INFINITY, 1.5, 2), "[–, 1.5]");
    }

    #[test]
    fn sig_is_within_half_a_unit_of_the_last_digit() {
        let mut x = 1.7e-9;
        while x < 1e9 {
            for digits in 1..8 {
                let read: f64 = sig(x, digits).parse().unwrap();
                assert!((read / x - 1.0).abs() <= 0.5001 * 10f64.powi(1 - digits as i32), "{x} {digits} {read}");
            }
            x *= 3.9;
        }
    }

    #[test]
    fn a_noun_is_in_the_plural_but_for_one() {
        assert_eq!([0, 1, 2].map(|n| number_of(n, "run")), ["0 runs", "1 run", "2 runs"]);
    }

    #[test]
    fn fixed_never_prints_minus_zero() {
        assert_eq!(fixed(-0.001, 1), "0.0");
        assert_eq!(fixed(-0.06, 1), "-0.1");
    }
}
