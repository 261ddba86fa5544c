//! The cheapest set of trials that parts two mechanisms, by greedy choice with removal.
//! It is not proved to be the cheapest of all sets; the information of each trial is computed once.

use super::outlook::{Pair, TOLERANCE, share};
use super::sail::Sailed;
use crate::diagnose::evidence::candidate::{Candidate, Extent, append};
use crate::diagnose::search::screen::{Screen, screen};
use crate::diagnose::settings::IDENTIFIABLE_SHARE;
use crate::likelihood::estimate::{Estimate, base_of, restrictions, run_evidence};
use crate::likelihood::evidence::{Evidence, RunEvidence};
use crate::likelihood::filter::{Column, Filter, Wanted};
use crate::recording::Run;
use crate::simulate::Integration;
use serde::Serialize;

/// Most trials in a set.
const MOST: usize = 12;
/// Gain below which a further trial is not worth adding.
const WORTH: f64 = 1e-3;

/// Which trials part a pair of mechanisms.
#[derive(Clone, Debug, Serialize)]
pub struct Parting {
    /// The pair, and the share of the gain that one takes over from the other in the set of trials; 1 where the set does not
    /// identify both.
    pub pair: Pair,
    /// Whether the share is within the tolerance and both are identifiable.
    pub parted: bool,
    /// Share above which a pair cannot be parted.
    pub tolerance: f64,
    /// Mechanisms of the pair that the set does not identify.
    pub unidentifiable: Vec<String>,
    /// The set; the best that was found where none parts them.
    pub trials: Vec<String>,
    /// Sum of the durations \[min\], approaches not counted.
    pub minutes: f64,
    /// Trials that the set was chosen from.
    pub of: usize,
}

/// The information of each trial of a catalogue about a pair.
struct Search<'a> {
    found: &'a Estimate,
    trials: &'a [Sailed],
    information: Vec<RunEvidence>,
    /// Tests of the pair, its evidence replaced by that of the set in question.
    screen: Screen,
}

/// How far a set is from parting the pair: the share that is taken over; from 1 to 2 where not both are identifiable, the less the
/// more information is left.
type Distance = f64;

impl Search<'_> {
    /// Shares of information left of both, and the distance of a set of trials; of none nothing is identifiable.
    fn at(&mut self, set: &[usize]) -> ([f64; 2], Distance) {
        if set.is_empty() {
            return ([0.0; 2], 2.0);
        }
        let mut evidence = Evidence::default();
        set.iter().for_each(|i| evidence.add(self.information[*i].clone(), false));
        self.screen.base = base_of(&evidence, &self.found.model, &self.found.free);
        self.screen.evidence = evidence;
        let retained = [0, 1].map(|i| {
            let test = self.screen.test(i, &Extent::All);
            if test.degrees > 0 { test.retained } else { 0.0 }
        });
        let least = retained[0].min(retained[1]);
        (retained, if least > IDENTIFIABLE_SHARE { share(&self.screen, 0, 1) } else { 2.0 - least })
    }

    fn minutes(&self, set: &[usize]) -> f64 {
        set.iter().map(|i| self.trials[*i].minutes).sum()
    }

    /// Adds trials until the pair is parted, or none brings it closer: the cheapest that parts it, else the one that brings most for
    /// its duration.
    fn grown(&mut self, mut set: Vec<usize>) -> (Vec<usize>, Distance) {
        let mut distance = self.at(&set).1;
        while distance > TOLERANCE && set.len() < MOST {
            let mut best: Option<(f64, usize, Distance)> = None;
            for next in 0..self.trials.len() {
                let with: Vec<usize> = set.iter().copied().chain([next]).collect();
                let reached = self.at(&with).1;
                let minutes = self.trials[next].minutes.max(1e-9);
                // What parts them comes before what does not, then the cheapest.
                let parts = reached <= TOLERANCE;
                let worth = if parts { 1e6 / minutes } else { (distance - reached) / minutes };
                let counts = !set.contains(&next) && (parts || distance - reached > WORTH);
                if counts && best.is_none_or(|(most, _, _)| worth > most) {
                    best = Some((worth, next, reached));
                }
            }
            let Some((_, next, reached)) = best else { break };
            set.push(next);
            distance = reached;
        }
        (set, distance)
    }

    /// Removes trials that the set does not need, the longest first.
    fn reduced(&mut self, mut set: Vec<usize>) -> Vec<usize> {
        let mut order = set.clone();
        order.sort_by(|a, b| self.trials[*b].minutes.total_cmp(&self.trials[*a].minutes).then(a.cmp(b)));
        for out in order {
            let without: Vec<usize> = set.iter().copied().filter(|i| *i != out).collect();
            if !without.is_empty() && self.at(&without).1 <= TOLERANCE {
                set = without;
            }
        }
        set
    }

    /// The cheapest of the sets that are grown from nothing and from each of the trials that alone come closest.
    fn cheapest(&mut self) -> Vec<usize> {
        let mut alone: Vec<(Distance, usize)> = (0..self.trials.len()).map(|i| (self.at(&[i]).1, i)).collect();
        alone.sort_by(|a, b| a.0.total_cmp(&b.0));
        let starts = alone.iter().take(STARTS).map(|(_, i)| vec![*i]);
        let mut best: Option<(bool, f64, Vec<usize>)> = None;
        for start in std::iter::once(Vec::new()).chain(starts) {
            let (set, distance) = self.grown(start);
            let parted = distance <= TOLERANCE;
            let set = if parted { self.reduced(set) } else { set };
            let cost = if parted { self.minutes(&set) } else { distance };
            let better = |(p, c, _): &(bool, f64, Vec<usize>)| (parted && !p) || (parted == *p && cost < *c);
            if best.as_ref().is_none_or(better) {
                best = Some((parted, cost, set));
            }
        }
        best.map(|(_, _, mut set)| {
            set.sort_unstable();
            set
        })
        .unwrap_or_default()
    }
}

/// Trials from which a set is grown, beside none.
const STARTS: usize = 3;

/// The cheapest set found among the trials of a catalogue that parts two mechanisms.
pub(super) fn part(found: &Estimate, integration: Integration, trials: &[Sailed], pair: &[Candidate; 2]) -> Parting {
    let runs: Vec<Run> = trials.iter().map(|t| t.run.clone()).collect();
    let mut columns: Vec<Column> = found.free.iter().map(|f| f.column).collect();
    append(&mut columns, pair);
    let filter = Filter::new(&found.model, integration, &columns);
    let only = restrictions(&found.free);
    let mut information = Vec::with_capacity(runs.len());
    let work =
        |run: &Run, pass: crate::likelihood::filter::Pass| run_evidence(run, pass.score, pass.information, &only);
    filter.each(&runs, &found.noise, Wanted::default(), work, |one| information.push(one));
    let screen = screen(found, integration, &runs[..1], pair);
    let mut search = Search { found, trials, information, screen };
    let set = search.cheapest();
    let (retained, distance) = search.at(&set);
    let hidden = pair.iter().zip(retained).filter(|(_, left)| *left <= IDENTIFIABLE_SHARE);
    let [a, b] = [&pair[0], &pair[1]].map(|c| c.mechanism.name.to_owned());
    Parting {
        pair: Pair { a, b, share: distance.min(1.0) },
        parted: distance <= TOLERANCE,
        tolerance: TOLERANCE,
        unidentifiable: hidden.map(|(c, _)| c.mechanism.name.into()).collect(),
        minutes: search.minutes(&set),
        trials: set.iter().map(|i| trials[*i].name.clone()).collect(),
        of: trials.len(),
    }
}
