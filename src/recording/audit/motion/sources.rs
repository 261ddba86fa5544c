//! Recordings from which several runs are cut: what is wrong with a channel of a file is wrong in all of its runs.
//! It compares what is found in one of them with the others; the caller decides what is looked for.

use crate::statistics::median;
use std::collections::HashMap;
use std::hash::Hash;

/// For every run the place of the first one that is cut from the same recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Sources(Vec<usize>);

impl Sources {
    /// From a key a run that identifies its recording and how it is read.
    pub fn of<K: Hash + Eq>(keys: impl Iterator<Item = K>) -> Self {
        let mut first: HashMap<K, usize> = HashMap::new();
        Self(keys.enumerate().map(|(i, key)| *first.entry(key).or_insert(i)).collect())
    }

    /// The places of all runs of the recording of one.
    pub fn beside(&self, run: usize) -> impl Iterator<Item = usize> {
        (0..self.0.len()).filter(move |other| self.0[*other] == self.0[run])
    }

    /// Whether all runs of the recording of one are explained better by what was found in it. `losses` gives what is left of a run as
    /// it is, and with what was found; `None` where that cannot be determined.
    pub fn agree(&self, run: usize, losses: impl Fn(usize) -> Option<[f64; 2]>) -> bool {
        let sum = |[a, b]: [f64; 2], [c, d]: [f64; 2]| [a + c, b + d];
        self.beside(run).filter_map(losses).reduce(sum).is_none_or(|[before, after]| after < before)
    }

    /// For every run the median of what the runs of its recording have.
    pub fn medians(&self, values: &[Option<f64>]) -> Vec<Option<f64>> {
        let of = |run: usize| values[run].and(median(self.beside(run).filter_map(|other| values[other])));
        (0..values.len()).map(of).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_of_one_run_is_compared_with_the_others_of_its_recording() {
        let sources = Sources::of(["a", "b", "a", "a", "c"].into_iter());
        assert_eq!(sources.beside(2).collect::<Vec<_>>(), [0, 2, 3]);
        // Run 2 alone is explained better; with its sister runs it is not, and run 4 has none.
        let losses = |run: usize| Some(if [2, 4].contains(&run) { [4.0, 1.0] } else { [1.0, 4.0] });
        assert_eq!(
            (0..5).map(|run| sources.agree(run, losses)).collect::<Vec<_>>(),
            [false, false, false, false, true]
        );
        let medians = sources.medians(&[Some(1.0), Some(9.0), Some(5.0), None, None]);
        assert_eq!(medians, [Some(3.0), Some(9.0), Some(3.0), None, None]);
    }
}
