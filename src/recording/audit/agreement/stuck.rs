//! A rudder or a propeller whose log stood still: over a stretch in which it keeps one value the motion is unlike that of the other runs at
//! this value, while the rest of the run is like theirs. Channels of the motion that stand still are in `frozen` and `held`.

use crate::recording::audit::limits::{EXPLAINS, STUCK_UNLIKE};
use crate::recording::audit::motion::plateau::Plateau;
use crate::recording::audit::motion::pooled::Pool;
use crate::recording::audit::motion::response::Curve;

/// The plateau of each run over which the channel is stuck, the one that the motion contradicts most.
pub(in crate::recording::audit) fn stuck<'c>(
    curves: &[Option<&'c Curve>],
    pool: &Pool<'_>,
) -> Vec<Option<&'c Plateau>> {
    let usual = pool.usual();
    let most = |curve: &Option<&'c Curve>| {
        let (share, plateau) = unlike((*curve)?, pool, usual?)?;
        (share > STUCK_UNLIKE).then_some(plateau)
    };
    curves.iter().map(most).collect()
}

/// The plateau of a run that is least like the other runs, of those whose constant value explains nothing, and the mean square that the
/// other runs' coefficients leave there, as a multiple of what they leave usually or outside it, whichever is larger.
fn unlike<'c>(curve: &'c Curve, pool: &Pool<'_>, usual: f64) -> Option<(f64, &'c Plateau)> {
    let others = pool.others(curve).filter(|_| pool.is_alike(curve))?;
    let share = |plateau: &'c Plateau| {
        let mut with_constant = others.clone();
        with_constant.push(plateau.beside.constant(&others));
        let [left, beside] = [&plateau.inside, &plateau.beside].map(|part| part.left(&with_constant));
        // In a hard turn the other runs' coefficients leave much, and the rudder explains far more.
        let nothing = plateau.inside.left_without(curve.own, &with_constant);
        (left > EXPLAINS * nothing).then_some((left / usual.max(beside), plateau))
    };
    curve.plateaus.iter().filter_map(share).max_by(|a, b| a.0.total_cmp(&b.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::audit::example::noise;
    use crate::recording::audit::motion::pooled::actuated;
    use crate::recording::audit::motion::response::rudder;
    use crate::recording::audit::motion::series::Series;
    use crate::recording::{Channel, Recording};
    use std::ops::Range;

    /// A ship that turns with its rudder, which keeps an angle for 40 s at a time, and whose log stands still over some rows.
    fn turning(seed: u32, still: Range<usize>) -> Curve {
        let mut noise = noise(seed);
        let mut angles: Vec<f64> = (0..200).map(|i| 0.3 * f64::from(noise_of(seed, i / 20))).collect();
        let (mut r, mut rates) = (0.0_f64, Vec::new());
        for delta in &angles {
            rates.push(r + 0.002 * noise());
            r += 2.0 * (0.02 * delta - 0.05 * r - 0.3 * r * r.abs());
        }
        let value = angles[still.start];
        angles[still].fill(value);
        let t = (0..200).map(|i| 2.0 * f64::from(i)).collect();
        let columns = vec![(Channel::T, t), (Channel::R, rates), (Channel::Delta, angles)];
        rudder(&Series::from(&Recording::from_channels("run", columns).unwrap())).unwrap()
    }

    /// One of three angles.
    fn noise_of(seed: u32, place: u32) -> i32 {
        (seed.wrapping_mul(7919) + place.wrapping_mul(104_729)).rotate_left(7) as i32 % 3 - 1
    }

    #[test]
    fn a_rudder_whose_log_stands_still_while_the_ship_turns_is_reported_with_its_lines_and_a_steady_rudder_is_not() {
        let of = |still: Range<usize>| -> Vec<Option<(usize, usize)>> {
            let curves: Vec<Curve> = (0..8).map(|i| turning(i, if i == 3 { still.clone() } else { 0..1 })).collect();
            let all: Vec<Option<&Curve>> = curves.iter().map(Some).collect();
            stuck(&all, &actuated(&all).unwrap()).into_iter().map(|s| s.and_then(|s| s.lines)).collect()
        };
        assert_eq!(of(0..1), [None; 8]);
        let found = of(60..130);
        assert!(found.iter().enumerate().all(|(run, lines)| lines.is_some() == (run == 3)), "{found:?}");
        let lines = found[3].unwrap();
        assert!(lines.0 <= 62 && lines.1 >= 131, "{lines:?}");
    }
}
