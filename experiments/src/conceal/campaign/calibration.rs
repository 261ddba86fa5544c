//! The figure of calibration over many studies: nominal levels against the rates that were measured on concealed cases.
//! It only counts and draws.

use trimtab::numbers::statistics::{Share, normal_quantile};
use trimtab::report::plot::{Axis, BLUE, Figure, GREEN, LIMIT, Layer, ORANGE, PURPLE, Panel, SKY};

use super::arms::{nulls, reached};
use crate::conceal::judge::score::Score;

/// Nominal levels of a test.
const LEVELS: [f64; 13] = [1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 2e-2, 5e-2, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9];
/// Nominal levels of an interval.
const INTERVALS: [f64; 11] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99];

/// A rate with its 95 % interval over a nominal level.
type Point = (f64, f64, f64, f64);

/// Measured rates over nominal levels; levels without a case are left out.
fn rates(levels: &[f64], rate: impl Fn(f64) -> Option<Share>) -> Vec<Point> {
    levels.iter().filter_map(|level| rate(*level).map(|s| (*level, s.value(), s.low, s.high))).collect()
}

/// Share of the cases without an effect in which some mechanism is significant at a level.
fn alarms(scores: &[Score], family: &str, level: f64) -> Option<Share> {
    let cases = nulls(scores, family).filter(|s| s.background != "euler");
    Share::of(cases.map(|s| s.lead_p.map(|p| p <= level)))
}

/// Share of the single effects whose true size lies in the interval of a level, as if estimates were normal.
fn coverage(scores: &[Score], snr: f64, level: f64) -> Option<Share> {
    let reach = normal_quantile(0.5 + 0.5 * level);
    let cases = scores.iter().filter(|s| s.arm == "single" && reached(s) && s.snr_asked == Some(snr));
    Share::of(cases.map(|s| s.size_errors.map(|e| e.abs() <= reach)))
}

/// Tests on the left, intervals on the right.
pub fn calibration(scores: &[Score]) -> Figure {
    let mut tests = Panel::new(
        "cases without an effect",
        Axis::new("nominal level of the test").log().range(8e-5, 1.0),
        Axis::new("share with a significant mechanism").range(0.0, 1.0),
    )
    .with(Layer::line("as nominal", LIMIT, LEVELS.map(|level| (level, level))));
    for (name, color, family) in [("HD truth, as the model", BLUE, "hd"), ("MMG truth, of another form", ORANGE, "mmg")]
    {
        tests = tests.with_all(Layer::line_with_intervals(
            name,
            color,
            rates(&LEVELS, |level| alarms(scores, family, level)),
        ));
    }
    let mut intervals = Panel::new(
        "single effects, right name",
        Axis::new("nominal level of the interval").range(0.0, 1.0),
        Axis::new("share with the true size inside").range(0.0, 1.0),
    )
    .with(Layer::line("as nominal", LIMIT, [(0.0, 0.0), (1.0, 1.0)]));
    for (name, color, snr) in [("SNR 6", SKY, 6.0), ("SNR 12", GREEN, 12.0), ("SNR 24", PURPLE, 24.0)] {
        intervals = intervals.with_all(Layer::line_with_intervals(
            name,
            color,
            rates(&INTERVALS, |l| coverage(scores, snr, l)),
        ));
    }
    Figure::new("Nominal and measured rates of the diagnosis").columns(2).with(tests).with(intervals)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_counted_over_the_cases_that_have_the_number() {
        let null = |family: &str, p: Option<f64>| Score {
            arm: "null".into(),
            family: family.into(),
            lead_p: p,
            ..Score::default()
        };
        let nulls = [null("hd", Some(0.5)), null("hd", Some(0.01)), null("hd", None), null("mmg", Some(0.0))];
        let share = |level: f64| alarms(&nulls, "hd", level).unwrap();
        assert_eq!((share(0.1).value(), share(0.6).value(), share(1e-3).value()), (0.5, 1.0, 0.0));
        let single = |errors: f64| Score {
            arm: "single".into(),
            snr_asked: Some(12.0),
            size_errors: Some(errors),
            ..Score::default()
        };
        let singles = [single(-0.5), single(1.8)];
        let covered = |level: f64| coverage(&singles, 12.0, level).unwrap().value();
        assert_eq!((covered(0.3), covered(0.9), covered(0.95)), (0.0, 0.5, 1.0));
        assert!(coverage(&singles, 6.0, 0.9).is_none());
    }
}
