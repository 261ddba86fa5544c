//! Train and test by block: whole manoeuvres, or whole sessions, so that no sample to judge by is next to one that was fitted to.
//! Within a kind of manoeuvre the test blocks are spread over time; where a test share is asked for, there is a test run.

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

/// The sides of blocks, given what each is of (a kind of manoeuvre; for sessions all are alike): a share of each kind tests. One
/// block at least tests and one trains, where there are two.
pub fn sides<K: Ord>(kinds: &[K], share: f64) -> Vec<Split> {
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
    }
    if kinds.len() >= 2 && !sides.contains(&Split::Test) {
        let largest = by_kind.values().max_by_key(|blocks| blocks.len());
        if let Some(last) = largest.and_then(|blocks| blocks.last()) {
            sides[*last] = Split::Test;
        }
    }
    sides
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
                let sides = sides(&kinds, share);
                assert!(sides.contains(&Split::Test) && sides.contains(&Split::Train), "{count} {share}");
            }
        }
        assert!(!sides(&[1, 1, 1], 0.0).contains(&Split::Test));
    }

    #[test]
    fn every_kind_with_three_blocks_is_tested() {
        let kinds = ["turn", "turn", "turn", "zigzag", "zigzag", "zigzag", "zigzag", "stop"];
        let sides = sides(&kinds, 0.25);
        let tested = |kind: &str| kinds.iter().zip(&sides).filter(|(k, s)| **k == kind && **s == Split::Test).count();
        assert_eq!((tested("turn"), tested("zigzag"), tested("stop")), (1, 1, 0));
    }
}
