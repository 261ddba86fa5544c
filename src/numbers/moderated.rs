//! How far scores scatter between groups of runs, against what their information says, and that ratio moderated over many directions.
//! From few groups the scatter of one direction is estimated badly, and that of all directions well. It concludes nothing.

use super::statistics::{counted, mean, quantile};
use statrs::function::gamma::digamma;

/// Variance of an estimate along one direction over that by its information, as estimated with so many degrees of freedom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ratio {
    /// The ratio.
    pub value: f64,
    /// Its degrees of freedom.
    pub degrees: f64,
}

/// The efficient score of each group of runs along one direction, and its share of the information: what is the same in all groups in
/// proportion to their information is the effect, not scatter.
#[derive(Clone, Copy)]
pub struct GroupScore {
    /// Efficient score.
    pub score: f64,
    /// Information of the group, in any unit.
    pub weight: f64,
}

/// The ratio `phi = n/(n - 1) sum_g (e_g - w_g sum e)^2 / i` of groups with efficient scores e and shares w of the information i, whose
/// number is counted as `n = 1/sum w^2`, with n - 1 degrees of freedom (Liang & Zeger 1986, Biometrika 73, p. 13; Kish 1965, section 11.7).
/// `None` where fewer than two groups count.
pub fn ratio(groups: &[GroupScore], information: f64) -> Option<Ratio> {
    let weight: f64 = groups.iter().map(|g| g.weight).sum();
    let total: f64 = groups.iter().map(|g| g.score).sum();
    let degrees = counted(groups.iter().map(|g| g.weight)) - 1.0;
    let squares: f64 = groups.iter().map(|g| (g.score - g.weight / weight * total).powi(2)).sum();
    let value = squares * (degrees + 1.0) / degrees / information;
    (degrees >= 1.0 && information > 0.0 && value.is_finite()).then_some(Ratio { value, degrees })
}

/// Ratios of several parts of the runs, each around its own effect, as one: their mean by degrees of freedom.
pub fn pooled(ratios: impl IntoIterator<Item = Ratio>) -> Option<Ratio> {
    let (sum, degrees) = ratios.into_iter().fold((0.0, 0.0), |(s, d), r| (s + r.value * r.degrees, d + r.degrees));
    (degrees > 0.0).then(|| Ratio { value: sum / degrees, degrees })
}

/// What all directions say of the ratio of any: `1/phi ~ chi-squared_d / (d s)`, with s its typical value and d the degrees of freedom that
/// this is worth (Smyth 2004, Stat. Appl. Genet. Mol. Biol. 3, article 3, section 6.2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moderation {
    /// Typical ratio.
    pub typical: f64,
    /// Degrees of freedom.
    pub degrees: f64,
}

/// Degrees of freedom beyond which a variance is as good as known: Student's t is then normal to four digits.
const KNOWN: f64 = 1e4;
/// Quantiles to which the scatter of single directions is drawn in before that of all is fitted: the defaults of the robust fit of Phipson et al.
/// 2016, Ann. Appl. Stat. 10, p. 946.
const WINSORISED: [f64; 2] = [0.05, 0.9];
/// Fewest directions that say something of another.
const FEWEST_DIRECTIONS: usize = 3;

impl Moderation {
    /// No direction says anything of another.
    const NONE: Self = Self { typical: 1.0, degrees: 0.0 };

    /// Fits s and d to the ratios of all directions by the mean and the variance of their logarithms (Smyth 2004, section 6.2), which are
    /// drawn in to their quantiles beforehand, so that a few directions in which something acts do not set them (Phipson et al. 2016, Ann.
    /// Appl. Stat. 10, p. 946, whose moments of drawn-in values are not applied: d comes out up to three times as large).
    pub fn of(ratios: &[Ratio]) -> Self {
        if ratios.len() < FEWEST_DIRECTIONS {
            return Self::NONE;
        }
        let logarithm = |r: &Ratio| {
            let half = 0.5 * r.degrees;
            r.value.max(f64::MIN_POSITIVE).ln() - digamma(half) + half.ln()
        };
        let mut sorted: Vec<f64> = ratios.iter().map(logarithm).collect();
        sorted.sort_by(f64::total_cmp);
        let [low, high] = WINSORISED.map(|share| quantile(&sorted, share));
        let (Some(low), Some(high)) = (low, high) else { return Self::NONE };
        let drawn = || sorted.iter().map(|z| z.clamp(low, high));
        let Some(centre) = mean(drawn()) else { return Self::NONE };
        let n = ratios.len() as f64;
        let scatter = drawn().map(|z| (z - centre).powi(2)).sum::<f64>() / (n - 1.0);
        let by_chance = ratios.iter().map(|r| trigamma(0.5 * r.degrees)).sum::<f64>() / n;
        let excess = scatter - by_chance;
        if excess <= trigamma(0.5 * KNOWN) {
            return Self { typical: centre.exp(), degrees: KNOWN };
        }
        let half = trigamma_inverse(excess);
        Self { typical: (centre + digamma(half) - half.ln()).exp(), degrees: 2.0 * half }
    }

    /// The ratio of one direction moderated by those of all, `(d s + n phi)/(d + n)` with d + n degrees of freedom (Smyth 2004, eq. 9), and
    /// never below 1: no estimate is better than its information says. Of a direction without a ratio it is that of all.
    pub fn moderated(&self, own: Option<Ratio>) -> Ratio {
        let own = own.unwrap_or(Ratio { value: 1.0, degrees: 0.0 });
        let degrees = self.degrees + own.degrees;
        let sum = self.degrees * self.typical + own.degrees * own.value;
        let value = if degrees > 0.0 { (sum / degrees).max(1.0) } else { 1.0 };
        Ratio { value, degrees: degrees.min(KNOWN) }
    }
}

/// The second derivative of the logarithm of the gamma function (Abramowitz & Stegun 1964, 6.4.6 and 6.4.12).
fn trigamma(x: f64) -> f64 {
    if x < 8.0 {
        return trigamma(x + 1.0) + 1.0 / (x * x);
    }
    let y = 1.0 / (x * x);
    1.0 / x + 0.5 * y + y / x * (1.0 / 6.0 - y * (1.0 / 30.0 - y * (1.0 / 42.0 - y / 30.0)))
}

/// Where the trigamma function has a value, by Newton's steps on its inverse, which is nearly linear (Smyth 2004, appendix).
fn trigamma_inverse(value: f64) -> f64 {
    let mut x = 0.5 + 1.0 / value;
    for _ in 0..50 {
        let at = trigamma(x);
        let slope = (trigamma(x * (1.0 + 1e-5)) - trigamma(x * (1.0 - 1e-5))) / (2e-5 * x);
        let step = at * (1.0 - at / value) / slope;
        x += step;
        if step.abs() < 1e-10 * x {
            break;
        }
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use std::f64::consts::PI;

    fn groups(scores: &[f64], weights: &[f64]) -> Vec<GroupScore> {
        scores.iter().zip(weights).map(|(score, weight)| GroupScore { score: *score, weight: *weight }).collect()
    }

    /// The mean of so many squared normal values, by Box and Muller.
    fn variance(generator: &mut ChaCha8Rng, degrees: usize) -> f64 {
        let mut normal = || {
            let (a, b): (f64, f64) = (generator.random(), generator.random());
            (-2.0 * (1.0 - a).ln()).sqrt() * (2.0 * PI * b).cos()
        };
        (0..degrees).map(|_| normal().powi(2)).sum::<f64>() / degrees as f64
    }

    #[test]
    fn an_effect_that_is_the_same_in_all_groups_is_no_scatter_and_what_is_left_is_counted_by_information() {
        let weights = [1.0, 2.0, 3.0, 2.0];
        let same = ratio(&groups(&weights.map(|w| 5.0 * w), &weights), 8.0).unwrap();
        assert!(same.value < 1e-25 && (same.degrees - (64.0 / 18.0 - 1.0)).abs() < 1e-12);
        // Four equal groups: 4/3 of the squared deviations over the information.
        let r = ratio(&groups(&[3.0, 1.0, -1.0, 1.0], &[1.0; 4]), 4.0).unwrap();
        assert!((r.value - 4.0 / 3.0 * 8.0 / 4.0).abs() < 1e-12 && (r.degrees - 3.0).abs() < 1e-12);
    }

    #[test]
    fn one_group_that_has_all_the_information_shows_no_scatter() {
        assert!(ratio(&groups(&[3.0, 0.1], &[1.0, 0.01]), 1.0).is_none());
        assert!(ratio(&[], 1.0).is_none() && ratio(&groups(&[1.0, 2.0], &[1.0; 2]), 0.0).is_none());
    }

    #[test]
    fn parts_count_by_their_degrees_of_freedom() {
        let both = pooled([Ratio { value: 1.0, degrees: 3.0 }, Ratio { value: 5.0, degrees: 1.0 }]).unwrap();
        assert_eq!((both.value, both.degrees), (2.0, 4.0));
        assert!(pooled([]).is_none());
    }

    #[test]
    fn the_trigamma_function_has_its_known_values_and_its_inverse() {
        for (x, value) in [(1.0, PI * PI / 6.0), (0.5, PI * PI / 2.0), (2.0, PI * PI / 6.0 - 1.0)] {
            assert!((trigamma(x) - value).abs() < 1e-10, "{x}");
        }
        for x in [0.2, 1.0, 7.0, 300.0] {
            assert!((trigamma_inverse(trigamma(x)) / x - 1.0).abs() < 1e-8, "{x}");
        }
    }

    #[test]
    fn directions_of_one_variance_make_it_known_and_of_different_variances_say_how_much_they_differ() {
        let mut generator = ChaCha8Rng::seed_from_u64(7);
        let alike: Vec<Ratio> =
            (0..400).map(|_| Ratio { value: 3.0 * variance(&mut generator, 6), degrees: 6.0 }).collect();
        let m = Moderation::of(&alike);
        assert!((m.typical / 3.0 - 1.0).abs() < 0.15 && m.degrees > 50.0, "{m:?}");
        // Each direction with a variance of its own, 3 over a mean of 8 squares; what is drawn in counts as more alike than it is.
        let own = |g: &mut ChaCha8Rng| 3.0 / variance(g, 8) * variance(g, 6);
        let different: Vec<Ratio> = (0..2000).map(|_| Ratio { value: own(&mut generator), degrees: 6.0 }).collect();
        let m = Moderation::of(&different);
        assert!((m.typical / 3.0 - 1.0).abs() < 0.25 && (8.0..40.0).contains(&m.degrees), "{m:?}");
    }

    #[test]
    fn a_moderated_ratio_lies_between_its_own_and_the_typical_one_and_never_below_one() {
        let m = Moderation { typical: 2.0, degrees: 6.0 };
        let r = m.moderated(Some(Ratio { value: 5.0, degrees: 3.0 }));
        assert_eq!((r.value, r.degrees), (3.0, 9.0));
        assert_eq!(m.moderated(None), Ratio { value: 2.0, degrees: 6.0 });
        assert_eq!(Moderation { typical: 0.4, ..m }.moderated(Some(Ratio { value: 0.1, degrees: 3.0 })).value, 1.0);
        assert_eq!(Moderation::of(&[]).moderated(None), Ratio { value: 1.0, degrees: 0.0 });
    }

    #[test]
    fn a_few_directions_in_which_something_acts_do_not_set_what_is_typical() {
        let mut generator = ChaCha8Rng::seed_from_u64(8);
        let mut all: Vec<Ratio> = (0..60).map(|_| Ratio { value: variance(&mut generator, 7), degrees: 7.0 }).collect();
        let before = Moderation::of(&all);
        all.iter_mut().take(3).for_each(|r| r.value *= 1e4);
        let after = Moderation::of(&all);
        assert!((after.typical / before.typical - 1.0).abs() < 0.2 && after.degrees > 10.0, "{before:?} {after:?}");
    }
}
