//! One run against all others: whether a rudder, a propeller rate or a sway velocity is in another unit, or of another sign.
//! It uses the coefficients of the other runs; lags are in `pooled`, and contradictions within a run in `units`.

use crate::numerals::sig;
use crate::recording::Channel;
use crate::recording::audit::issue::{Issue, Severity, Shared};
use crate::recording::audit::limits::{
    POOLED_UNUSUAL, SCALE_COHERENCE, SCALE_EVIDENCE, SCALE_LEAVES, SCALE_SAME, SCALE_SIZE,
};
use crate::recording::audit::motion::pooled::Pool;
use crate::recording::audit::motion::response::Curve;
use crate::recording::audit::motion::sources::Sources;
use crate::recording::audit::motion::sums::Sums;
use crate::recording::audit::record::Responses;

/// A channel that may be a multiple of what it is in the other runs.
struct Asked {
    channel: Channel,
    of: fn(&Responses) -> Option<&Curve>,
    /// Whether it is what the coefficients explain, and not what they belong to.
    explained: bool,
    /// By what it may be too large.
    factors: &'static [f64],
    /// What it does, up to `than in the other runs`.
    turned: &'static str,
}

const DEGREES: f64 = 57.295_779_5;

const ASKED: [Asked; 3] = [
    Asked {
        channel: Channel::Delta,
        of: |r| r.rudder.as_ref(),
        explained: false,
        // Its sign is checked in `pooled`. A rudder in degrees that is read as radians is not sought: every large factor fits a run in which it does nothing.
        factors: &[1.0 / DEGREES],
        turned: "acts on the yaw of the ship to the other side",
    },
    Asked {
        channel: Channel::N,
        of: |r| r.propeller.as_ref(),
        explained: false,
        factors: &[-1.0],
        turned: "acts on the surge of the ship to the other side",
    },
    Asked {
        channel: Channel::V,
        of: |r| r.sway.as_ref(),
        explained: true,
        factors: &[-1.0, 3.6, 1.0 / 3.6],
        turned: "answers yaw rate and rudder to the other side",
    },
];

impl Asked {
    /// Squares left by coefficients of other runs, if the channel is so many times what it is in them. With a channel `c` recorded as
    /// `f c`: `|y - X_c b_c / f - X b|^2` where it acts, `|y / f - X b|^2` where it is what is explained.
    fn left(&self, curve: &Curve, sums: &Sums, others: &[f64], factor: f64) -> f64 {
        if self.explained {
            let response = sums.response.iter().map(|b| b / factor).collect();
            let squares = sums.squares / (factor * factor);
            return Sums { columns: sums.columns.clone(), response, squares }.left(others);
        }
        let mut own = others.to_vec();
        own[..curve.own].iter_mut().for_each(|c| *c /= factor);
        sums.left(&own)
    }

    /// The factor of each run, in their order; `None` where its channel is as in the other runs, or where that cannot be determined.
    fn factors(&self, curves: &[Option<&Curve>], sources: &Sources) -> Vec<Option<f64>> {
        let none = || vec![None; curves.len()];
        let size = |c: &Curve| {
            let sums = c.at_zero();
            let size = if self.explained { sums.squares } else { sums.columns.first().copied().unwrap_or(0.0) };
            size / c.rows
        };
        let Some(pool) = Pool::new(curves, size, SCALE_SIZE) else { return none() };
        let Some(usual) = pool.usual() else { return none() };
        let alike = |run: usize| curves[run].filter(|c| pool.is_alike(c));
        let judged = |run: usize| {
            let curve = alike(run)?;
            let others = pool.others(curve)?;
            let factor = self.judged(curve, &others, usual)?;
            let losses = |c: &Curve| [1.0, factor].map(|f| self.left(c, c.at_zero(), &others, f));
            sources.agree(run, |other| alike(other).map(losses)).then_some(factor)
        };
        (0..curves.len()).map(judged).collect()
    }

    /// The factor of one run, given the coefficients of the others and the mean square that these usually leave.
    fn judged(&self, curve: &Curve, others: &[f64], usual: f64) -> Option<f64> {
        let sums = curve.at_zero();
        let left = |factor: f64| self.left(curve, sums, others, factor) / curve.rows;
        let as_it_is = left(1.0);
        let evidence = |factor: f64| {
            // Whatever is divided is smaller: the density of what was recorded is that of what is explained over the factor.
            let divided = if self.explained { 2.0 * factor.abs().ln() } else { 0.0 };
            curve.samples * ((as_it_is - left(factor)) / left(factor).max(usual) - divided)
        };
        let best = self.factors.iter().copied().max_by(|a, b| evidence(*a).total_cmp(&evidence(*b)))?;
        let unusual = as_it_is > POOLED_UNUSUAL * usual && left(best) < POOLED_UNUSUAL * usual;
        let convincing = unusual && left(best) < SCALE_LEAVES * as_it_is && evidence(best) > SCALE_EVIDENCE;
        (convincing && (!self.explained || proportional(sums, others, best))).then_some(best)
    }

    fn issue(&self, factor: f64) -> Issue {
        let map = format!("for `{}` in a column map of this run", self.channel);
        let (fault, text, next) = if factor < 0.0 {
            let text = format!("{} than in the other runs", self.turned);
            ("sign_error", text, format!("is its sign that of the other runs? set `sign = -1` {map}"))
        } else {
            let text = format!("fits the other runs only if it is recorded {} times too large", sig(factor, 3));
            ("unit_error", text, format!("is its unit that of the other runs? set `unit`, or `scale`, {map}"))
        };
        Issue::new(Severity::Warning, fault, text, next).of(self.channel)
    }
}

/// Whether what is explained is so many times what coefficients of other runs say: `y . p / p . p` is the factor, and the cosine of the
/// two, `p = X b`, is large.
fn proportional(sums: &Sums, others: &[f64], factor: f64) -> bool {
    let both: f64 = others.iter().zip(&sums.response).map(|(c, b)| c * b).sum();
    // |y - p|^2 = |y|^2 - 2 y.p + |p|^2
    let said = sums.left(others) - sums.squares + 2.0 * both;
    let gain = both / said;
    (gain / factor - 1.0).abs() < SCALE_SAME && both.abs() > SCALE_COHERENCE * (said * sums.squares).sqrt()
}

/// The channels of single runs that are in another unit, or of another sign, than in the other runs.
pub fn scales(runs: &[(&str, &Responses)], sources: &Sources) -> Vec<Shared> {
    let mut found = Vec::new();
    for asked in &ASKED {
        let curves: Vec<Option<&Curve>> = runs.iter().map(|(_, r)| (asked.of)(r)).collect();
        for ((run, _), factor) in runs.iter().zip(asked.factors(&curves, sources)) {
            found.extend(factor.map(|f| Shared { runs: vec![(*run).to_owned()], issue: asked.issue(f) }));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::Recording;
    use crate::recording::audit::example::noise;
    use crate::recording::audit::motion::series::Series;

    /// A run in which the rudder swings: yaw and sway answer it as they do in every run, with noise; `factors` are those of v and of the
    /// rudder as recorded.
    fn run(seed: u32, [sway, rudder]: [f64; 2]) -> Responses {
        let mut unit = noise(seed);
        let mut noise = |size: f64| size * unit();
        let mut columns: [Vec<f64>; 6] = Default::default();
        let (mut r, mut v) = (0.0, 0.0);
        for i in 0..160 {
            let delta = 0.3 * (f64::from(i) * (0.06 + 0.01 * f64::from(seed))).sin().signum();
            let row = [4.0 + noise(0.02), sway * (v + noise(0.02)), r + noise(1e-3), 2.0, rudder * delta, f64::from(i)];
            columns.iter_mut().zip(row).for_each(|(c, value)| c.push(value));
            r += (0.05 * delta - r) / 8.0;
            v += (-8.0 * r - v) / 4.0;
        }
        let names = [Channel::U, Channel::V, Channel::R, Channel::N, Channel::Delta, Channel::T];
        let recording = Recording::from_channels("run", names.into_iter().zip(columns).collect()).unwrap();
        Responses::of(&Series::from(&recording))
    }

    /// The doubts about eight runs, the first of which is recorded with these factors.
    fn study(factors: [f64; 2]) -> Vec<Shared> {
        let runs: Vec<(String, Responses)> =
            (0..8).map(|i| (format!("r{i}"), run(i + 1, if i == 0 { factors } else { [1.0; 2] }))).collect();
        scales(&runs.iter().map(|(name, r)| (name.as_str(), r)).collect::<Vec<_>>(), &Sources::of(0..8))
    }

    #[test]
    fn a_sound_study_raises_no_doubt() {
        assert_eq!(study([1.0, 1.0]), []);
    }

    #[test]
    fn another_unit_and_another_sign_in_one_run_are_reported() {
        let cases = [
            ([-1.0, 1.0], Channel::V, "sign_error"),
            ([3.6, 1.0], Channel::V, "unit_error"),
            ([1.0, 1.0 / DEGREES], Channel::Delta, "unit_error"),
        ];
        for (factors, channel, fault) in cases {
            let found = study(factors);
            let right = |s: &Shared| s.runs == ["r0"] && (s.issue.channel, s.issue.fault) == (Some(channel), fault);
            assert!(found.iter().any(right) && found.iter().all(|s| s.runs == ["r0"]), "{factors:?}: {found:?}");
        }
    }
}
