//! Train and test by block: whole manoeuvres, or whole sessions, so that no sample to judge by is next to one that was fitted to.
//! Within a kind of manoeuvre the test blocks are spread over time, and none asks for more rudder than some block to train on has;
//! where a test share is asked for, there is a test run.

use crate::recording::Split;
use std::collections::BTreeMap;

/// What comes to one side as a whole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TestBy {
    /// A manoeuvre or a stretch between two, with all its pieces.
    #[default]
    Block,
    /// A session.
    Session,
}

/// Least and largest rudder angle of a block \[rad\].
pub type Reach = [f64; 2];

/// A rudder angle is another from this difference on \[rad\]: 2 deg.
const OTHER_ANGLE: f64 = 0.035;

/// The sides of blocks, given what each is of (a kind of manoeuvre; for sessions all are alike) and how far its rudder goes: a share
/// of each kind tests. One block at least tests and one trains, where there are two.
pub fn sides<K: Ord>(kinds: &[K], reaches: &[Reach], share: f64) -> Vec<Split> {
    let mut sides = vec![Split::Train; kinds.len()];
    if share <= 0.0 {
        return sides;
    }
    let mut by_kind: BTreeMap<&K, Vec<usize>> = BTreeMap::new();
    kinds.iter().enumerate().for_each(|(i, kind)| by_kind.entry(kind).or_default().push(i));
    for blocks in by_kind.values() {
        let least = usize::from(blocks.len() >= 3);
        let wanted = ((share * blocks.len() as f64).round() as usize).clamp(least, blocks.len() - 1);
        spread(blocks, wanted).for_each(|i| sides[i] = Split::Test);
        keep_within(blocks, reaches, &mut sides);
    }
    if kinds.len() >= 2 && !sides.contains(&Split::Test) {
        let largest = by_kind.values().max_by_key(|blocks| blocks.len());
        if let Some(last) = largest.and_then(|blocks| blocks.last()) {
            sides[*last] = Split::Test;
        }
    }
    sides
}

/// Exchanges a test block whose rudder goes further than that of all blocks to train on with the nearest block that leaves no such
/// gap, if there is one: a fit that never saw the hardest turn to port could only guess it, and the test would judge the guess.
fn keep_within(blocks: &[usize], reaches: &[Reach], sides: &mut [Split]) {
    let within = |block: usize, sides: &[Split], less: Option<usize>, more: Option<usize>| {
        let trains = |i: &usize| (sides[*i] == Split::Train && Some(*i) != less) || Some(*i) == more;
        let train = blocks.iter().copied().filter(trains).map(|i| reaches[i]);
        let [low, high] = train.fold([f64::MAX, f64::MIN], |[l, h], r| [l.min(r[0]), h.max(r[1])]);
        let [least, most] = reaches[block];
        least >= low - OTHER_ANGLE && most <= high + OTHER_ANGLE
    };
    for (place, block) in blocks.iter().copied().enumerate() {
        if sides[block] == Split::Train || within(block, sides, None, None) {
            continue;
        }
        let fits = |other: &usize| sides[*other] == Split::Train && within(*other, sides, Some(*other), Some(block));
        let near = |other: &usize| blocks.iter().position(|b| b == other).map_or(usize::MAX, |at| at.abs_diff(place));
        if let Some(other) = blocks.iter().copied().filter(fits).min_by_key(near) {
            sides.swap(block, other);
        }
    }
}

/// So many of some blocks, evenly spread.
fn spread(blocks: &[usize], wanted: usize) -> impl Iterator<Item = usize> {
    (0..wanted)
        .map(move |j| blocks[(((j as f64 + 0.6) * blocks.len() as f64 / wanted as f64) as usize).min(blocks.len() - 1)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_test_share_that_is_asked_for_is_never_empty() {
        for count in 2..40 {
            for share in [0.01, 0.125, 0.25, 0.5, 0.99] {
                let kinds: Vec<usize> = (0..count).map(|i| i % 3).collect();
                let sides = sides(&kinds, &vec![[0.0; 2]; count], share);
                assert!(sides.contains(&Split::Test) && sides.contains(&Split::Train), "{count} {share}");
            }
        }
        assert!(!sides(&[1, 1, 1], &[[0.0; 2]; 3], 0.0).contains(&Split::Test));
    }

    #[test]
    fn every_kind_with_three_blocks_is_tested() {
        let kinds = ["turn", "turn", "turn", "zigzag", "zigzag", "zigzag", "zigzag", "stop"];
        let sides = sides(&kinds, &[[0.0; 2]; 8], 0.25);
        let tested = |kind: &str| kinds.iter().zip(&sides).filter(|(k, s)| **k == kind && **s == Split::Test).count();
        assert_eq!((tested("turn"), tested("zigzag"), tested("stop")), (1, 1, 0));
    }

    #[test]
    fn no_test_block_asks_for_more_rudder_than_some_block_to_train_on_has() {
        // Turns to both sides with 10 to 35 deg, the hardest to each side once, at every place in the order.
        let angles = [-0.6_f64, -0.35, -0.3, -0.2, 0.2, 0.3, 0.35, 0.6];
        for first in 0..angles.len() {
            let reaches: Vec<Reach> =
                (0..8).map(|i| angles[(first + 3 * i) % 8]).map(|a| [a.min(0.0), a.max(0.0)]).collect();
            let sides = sides(&[0; 8], &reaches, 0.25);
            let tested = || reaches.iter().zip(&sides).filter(|(_, s)| **s == Split::Test).map(|(r, _)| *r);
            assert_eq!(tested().count(), 2);
            assert!(tested().all(|[low, high]| low > -0.5 && high < 0.5), "{reaches:?} {sides:?}");
        }
        // Where every block goes further than the others there is nothing to exchange.
        let apart = [[-0.6, -0.6], [0.6, 0.6]];
        assert!(sides(&[0, 0], &apart, 0.5).contains(&Split::Test));
    }
}
