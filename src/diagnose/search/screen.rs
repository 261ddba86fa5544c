//! The score test of every mechanism of the catalogue, with parameters, nuisance coefficients, initial states and noise profiled
//! out. It ranks and corrects for multiplicity; it does not refit and does not conclude.

use crate::diagnose::evidence::candidate::{Candidate, Extent, append};
use crate::diagnose::evidence::generic::{GenericLaw, widen};
use crate::diagnose::settings::{
    DIVIDED_SESSIONS, EQUAL_STATISTICS, IDENTIFIABLE_SHARE, INDISTINGUISHABLE, PARAMETER_PRICE,
};
use crate::likelihood::algebra::{pick, pseudo_inverse};
use crate::likelihood::estimate::{Estimate, Sums, base_of, restrictions};
use crate::likelihood::evidence::{Base, Evidence, Test, are_references};
use crate::likelihood::filter::{Column, Filter};
use crate::model::Model;
use crate::numbers::moderated::Ratio;
use crate::physics::{Kind, Mechanism};
use crate::recording::Run;
use crate::simulate::Integration;
use crate::statistics::scattered_p;
use crate::terms::propulsion::actuator::ActuatorTerm;
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

/// One mechanism's row in the ranking.
#[derive(Clone, Debug)]
pub struct Row {
    /// Index into the candidates.
    pub candidate: usize,
    /// Test with one amplitude in all sessions.
    pub pooled: Test,
    /// Where it acts in the test that counts.
    pub extent: Extent,
    /// The test that counts.
    pub test: Test,
    /// Corrected p-value of the test that counts.
    pub p: f64,
    /// Whether the amplitude's sign is physically possible.
    pub admissible: bool,
    /// Whether the data can see it at all.
    pub visible: bool,
    /// p-value (uncorrected) once a generic mirror-symmetric discrepancy of the ship's own forces may compete; for a sensor,
    /// once any generic force may.
    pub second_opinion: f64,
}

/// The outcome of one sensitivity pass.
pub struct Screen {
    /// All columns: free parameters, candidates, symmetric basis, asymmetric basis.
    pub evidence: Evidence,
    /// The fitted block.
    pub base: Base,
    /// The base with the mirror-symmetric basis beside it, as far as the data ask for one: for where the form of the ship's own
    /// forces is unknown.
    pub widened: Base,
    /// Columns of each candidate.
    groups: Vec<Vec<usize>>,
    /// The generic force law.
    pub law: GenericLaw,
    /// Rows in order of significance.
    pub rows: Vec<Row>,
    /// Test of the symmetric basis.
    pub symmetric_test: Test,
    /// Test of the asymmetric basis.
    pub asymmetric_test: Test,
}

impl Screen {
    /// What a smooth force law of state and heading gains more than by chance: statistic less degrees of freedom.
    pub fn asymmetric_gain(&self) -> f64 {
        self.asymmetric_test.statistic - self.asymmetric_test.degrees as f64
    }

    /// Columns of a candidate.
    pub fn columns(&self, index: usize) -> &[usize] {
        &self.groups[index]
    }

    /// Columns of all mechanisms, each once.
    pub fn mechanism_columns(&self) -> Vec<usize> {
        self.groups.iter().flatten().copied().collect::<BTreeSet<_>>().into_iter().collect()
    }

    /// The ratio of the scatter of a candidate's score between recordings to what its information says, moderated over all mechanisms
    /// ([`Evidence::moderated`]), around its own effect in each part of the runs in which it is taken to act apart.
    pub fn moderated(&self, index: usize, extent: &Extent, runs: &[Run]) -> Ratio {
        let recordings: Vec<&str> = runs.iter().map(|r| r.recording.as_str()).collect();
        let part = |run: usize| {
            let place = extent.sessions().iter().position(|s| *s == runs[run].session);
            place.map_or(0, |i| if matches!(extent, Extent::Each(_)) { i + 1 } else { 1 })
        };
        self.evidence.moderated(&self.base, self.columns(index), &recordings, &self.mechanism_columns(), part)
    }

    /// Chance of a statistic of so many parameters of a candidate by the moderated scatter of its score between recordings
    /// ([`Screen::moderated`]): the tail of Fisher's F, times the number of mechanisms that the data can see.
    pub fn by_chance(&self, index: usize, extent: &Extent, statistic: f64, parameters: usize, runs: &[Run]) -> f64 {
        let Ratio { value, degrees } = self.moderated(index, extent, runs);
        let visible = self.rows.iter().filter(|r| r.visible).count().max(1) as f64;
        (scattered_p(statistic / value, parameters, degrees) * visible).min(1.0)
    }

    /// How the base moves, in units of its columns, when a group of columns takes these amplitudes.
    pub fn base_shift(&self, columns: &[usize], extent: &Extent, amplitude: &DVector<f64>) -> DVector<f64> {
        let k = columns.len();
        let mut pull = DVector::zeros(self.base.columns.len());
        if self.evidence.sessions.is_empty() {
            pull += pick(&self.evidence.total.information, &self.base.columns, columns) * amplitude;
        }
        for (i, part) in extent.parts().iter().enumerate() {
            for (name, e) in &self.evidence.sessions {
                if part.as_ref().is_none_or(|s| s.contains(name)) {
                    pull += pick(&e.information, &self.base.columns, columns) * amplitude.rows(i * k, k);
                }
            }
        }
        -(&self.base.inverse * pull)
    }

    /// Tests a candidate where it is taken to act, the base profiled out.
    pub fn test(&self, index: usize, extent: &Extent) -> Test {
        self.test_beside(&self.base, index, extent)
    }

    /// Share of a candidate's information that neither the base nor any zero, scale, lever or clock of a sensor can take over, in the worst
    /// direction. An error that itself turns with the heading is a rival, which is tested, and no such number.
    pub fn isolated(&self, index: usize, extent: &Extent, candidates: &[Candidate]) -> f64 {
        let is_sensor = |i: &usize| {
            let m = candidates[*i].mechanism;
            m.kind == Kind::Sensor && !m.is_vector() && *i != index
        };
        let errors: Vec<usize> =
            (0..candidates.len()).filter(is_sensor).flat_map(|i| self.columns(i)).copied().collect();
        self.test_beside(&self.evidence.extend(&self.base, &errors), index, extent).retained
    }

    /// Tests a smooth force law of these sessions, beside the same law in all sessions.
    pub fn law_of_its_own(&self, sessions: &[String]) -> Test {
        let law = self.law.columns();
        self.evidence.test_in(&self.evidence.extend(&self.base, &law), &law, &named(sessions))
    }

    fn test_beside(&self, base: &Base, index: usize, extent: &Extent) -> Test {
        let columns = self.columns(index);
        match extent {
            Extent::All => self.evidence.test(base, columns),
            Extent::In(sessions) => self.evidence.test_in(base, columns, &named(sessions)),
            Extent::Each(_) => self.evidence.test_each(base, columns),
        }
    }

    /// Information of two groups of columns once the base is projected out.
    fn reduced(&self, rows: &[usize], columns: &[usize]) -> DMatrix<f64> {
        let (h, base) = (&self.evidence.total.information, &self.base.columns);
        pick(h, rows, columns) - pick(h, rows, base) * &self.base.inverse * pick(h, base, columns)
    }

    /// Share of the gain of candidate `a` with these amplitudes, in units of its columns, that candidate `b` can take over, 0 to 1.
    pub fn share_taken(&self, a: usize, amplitude: &DVector<f64>, b: usize) -> f64 {
        let (ca, cb) = (self.columns(a), self.columns(b));
        if amplitude.len() != ca.len() {
            return 0.0;
        }
        let pull = self.reduced(cb, ca) * amplitude;
        let taken = (pull.transpose() * pseudo_inverse(&self.reduced(cb, cb)) * &pull)[(0, 0)];
        let own = (amplitude.transpose() * self.reduced(ca, ca) * amplitude)[(0, 0)];
        if own > 0.0 && taken.is_finite() { (taken / own).clamp(0.0, 1.0) } else { 0.0 }
    }

    /// Cosine of the smallest principal angle between two candidates once the base is projected out: 1 when the data
    /// cannot distinguish them.
    pub fn likeness(&self, a: usize, b: usize) -> f64 {
        let (ca, cb) = (self.columns(a), self.columns(b));
        let (aa, bb, ab) = (self.reduced(ca, ca), self.reduced(cb, cb), self.reduced(ca, cb));
        let white = |m: &DMatrix<f64>| {
            let e = SymmetricEigen::new((m + m.transpose()) * 0.5);
            let top = e.eigenvalues.max();
            let kept: Vec<usize> = (0..m.nrows()).filter(|i| e.eigenvalues[*i] > 1e-6 * top.max(1e-300)).collect();
            DMatrix::from_fn(m.nrows(), kept.len(), |i, j| e.eigenvectors[(i, kept[j])] / e.eigenvalues[kept[j]].sqrt())
        };
        let (wa, wb) = (white(&aa), white(&bb));
        if wa.ncols() == 0 || wb.ncols() == 0 {
            return 0.0;
        }
        (wa.transpose() * ab * wb).svd(false, false).singular_values.max().min(1.0)
    }
}

fn named(sessions: &[String]) -> Vec<&str> {
    sessions.iter().map(String::as_str).collect()
}

/// Runs one sensitivity pass over everything and tests every candidate.
pub fn screen(found: &Estimate, integration: Integration, runs: &[Run], candidates: &[Candidate]) -> Screen {
    // No test distinguishes sessions that are no reference for each other.
    let sessions: BTreeSet<&str> = runs.iter().map(|r| r.session.as_str()).collect();
    screen_by_session(found, integration, runs, candidates, are_references(sessions.len(), runs.len()))
}

/// As [`screen`]; the evidence of every session is kept by itself where they are to be `apart`.
pub fn screen_by_session(
    found: &Estimate,
    integration: Integration,
    runs: &[Run],
    candidates: &[Candidate],
    apart: bool,
) -> Screen {
    let model = &found.model;
    let mut columns: Vec<Column> = found.free.iter().map(|f| f.column).collect();
    let groups = append(&mut columns, candidates);
    let law = GenericLaw::append(&mut columns, model);
    let filter = Filter::new(model, integration, &columns);
    let evidence = Sums::of(&filter, runs, &found.noise, &restrictions(&found.free), apart).evidence;
    let base = base_of(&evidence, model, &found.free);
    let widened = widen(&evidence, &base, &law.symmetric);
    let sessions: Vec<String> = evidence.sessions.keys().cloned().collect();
    let recordings = recordings(runs);
    // The rival of a sensor is a force law with all columns: what any force law can explain is no evidence for a sensor.
    let loosest = widen(&evidence, &base, &law.columns());
    let mut rows: Vec<Row> = (0..candidates.len())
        .into_par_iter()
        .map(|i| {
            let wide = if candidates[i].mechanism.kind == Kind::Sensor { &loosest } else { &widened };
            CandidateTests {
                evidence: &evidence,
                base: &base,
                widened: wide,
                model,
                candidate: &candidates[i],
                columns: &groups[i],
                sessions: &sessions,
                recordings: &recordings,
            }
            .row(i)
        })
        .collect();
    let tested = rows.iter().filter(|r| r.visible).count().max(1) as f64;
    for r in &mut rows {
        r.p = (r.p * tested).min(1.0);
    }
    rows.sort_by(|a, b| {
        let key = |r: &Row| (r.test.statistic - r.test.degrees as f64) * f64::from(u8::from(r.visible && r.admissible));
        key(b).total_cmp(&key(a))
    });
    let symmetric_test = evidence.test(&base, &law.symmetric);
    let asymmetric_test = evidence.test(&widened, &law.asymmetric);
    Screen { evidence, base, widened, groups, law, rows, symmetric_test, asymmetric_test }
}

/// The test of a candidate in some sessions, and its p-value with a generic force law as rival.
struct Tested {
    extent: Extent,
    test: Test,
    second_opinion: f64,
    /// Whether the amplitudes are physically possible.
    possible: bool,
}

/// What the tests of one candidate share.
struct CandidateTests<'a> {
    evidence: &'a Evidence,
    base: &'a Base,
    /// The base with a generic force law beside it.
    widened: &'a Base,
    model: &'a Model,
    candidate: &'a Candidate,
    columns: &'a [usize],
    sessions: &'a [String],
    /// Recordings in each session.
    recordings: &'a BTreeMap<&'a str, usize>,
}

impl CandidateTests<'_> {
    /// The candidate's row in the ranking.
    fn row(&self, index: usize) -> Row {
        let pooled = self.evidence.test(self.base, self.columns);
        let options = self.options(&pooled);
        let (count, divisions) = (options.len(), divisions(self.sessions.len()));
        let none = || self.tested(Extent::All, pooled.clone(), 1.0);
        let Tested { extent, test, second_opinion, possible } = choose(options, divisions).unwrap_or_else(none);
        let visible = test.degrees > 0 && test.retained > IDENTIFIABLE_SHARE;
        let mechanism = self.candidate.mechanism;
        Row {
            candidate: index,
            p: if visible { corrected(test.p, &extent, count, mechanism.by_session, divisions) } else { 1.0 },
            admissible: possible,
            visible: visible && (extent != Extent::All || !mechanism.needs_reference),
            extent,
            pooled,
            test,
            second_opinion,
        }
    }

    fn tested(&self, extent: Extent, test: Test, second_opinion: f64) -> Tested {
        let possible = self.candidate.admissible(self.model, &test);
        Tested { extent, test, second_opinion, possible }
    }

    /// The tests of every extent that counts: all sessions alike, a group of them, each with an amplitude of its own.
    fn options(&self, pooled: &Test) -> Vec<Tested> {
        let mechanism = self.candidate.mechanism;
        let mut out = Vec::new();
        if !mechanism.needs_reference {
            let opinion = self.evidence.test(self.widened, self.columns).p;
            out.push(self.tested(Extent::All, pooled.clone(), opinion));
        }
        let Some(contrast) = self.evidence.contrast(self.base, self.columns) else { return out };
        out.extend(self.best_group(&contrast));
        if mechanism.by_session {
            let opinion = self.evidence.test_each(self.widened, self.columns).p;
            let test = self.evidence.test_each(self.base, self.columns);
            out.push(self.tested(Extent::Each(self.sessions.to_vec()), test, opinion));
        }
        out
    }

    /// Whether a group of sessions can be compared with the rest. The ship is the same in all of them, and its own forces in another form
    /// make each recording differ: so many parameters fit the differences of as many recordings, whatever they are.
    fn is_comparable_with_the_rest(&self, group: &[String]) -> bool {
        let Mechanism { needs_reference, kind, .. } = self.candidate.mechanism;
        let of = |session: &str| self.recordings.get(session).copied().unwrap_or(0);
        let (all, own): (usize, usize) = (self.recordings.values().sum(), group.iter().map(|s| of(s)).sum());
        !(*needs_reference && *kind == Kind::Ship) || own.min(all - own) > self.columns.len()
    }

    /// Whether a group of sessions has more than half of the recordings.
    fn is_most(&self, group: &[String]) -> bool {
        let own: usize = group.iter().filter_map(|s| self.recordings.get(s.as_str())).sum();
        2 * own > self.recordings.values().sum()
    }

    /// The group of sessions in which the candidate explains most.
    fn best_group(&self, contrast: &Test) -> Option<Tested> {
        // What is common to all sessions is projected out of a mechanism that needs some of them as a reference.
        let against = |base: &Base| {
            if self.candidate.mechanism.needs_reference {
                self.evidence.extend(base, self.columns)
            } else {
                base.clone()
            }
        };
        let reference = against(self.base);
        let mut parts = groups(contrast, self.sessions, self.columns.len());
        parts.retain(|part| self.is_comparable_with_the_rest(part));
        // Where nothing else decides, what differs is what changed since the first recording.
        let since = |part: &Vec<String>| self.evidence.runs.first().is_some_and(|r| part.contains(&r.session));
        parts.sort_by_key(since);
        // An actuator or its record fails for a while: where that has no side, what most recordings show of it is sound, and a loss is none
        // where it is negative.
        let is_loss = self.candidate.names.first().is_some_and(|name| ActuatorTerm::is_loss(name));
        if self.candidate.mechanism.kind == Kind::Actuator && !is_loss {
            parts.retain(|part| !self.is_most(part));
        }
        let in_group = |group: Vec<String>| {
            let test = self.evidence.test_in(&reference, self.columns, &named(&group));
            self.tested(Extent::In(group), test, 1.0)
        };
        let rank = |t: &Tested| (t.possible, !is_loss || t.test.amplitude.iter().all(|a| *a >= 0.0));
        let better = |best: Tested, next: Tested| {
            let by_rank = rank(&next).cmp(&rank(&best));
            let more = next.test.statistic > best.test.statistic + EQUAL_STATISTICS;
            if by_rank.is_gt() || (by_rank.is_eq() && more) { next } else { best }
        };
        let best = parts.into_iter().map(in_group).reduce(better)?;
        let second_opinion =
            self.evidence.test_in(&against(self.widened), self.columns, &named(best.extent.sessions())).p;
        Some(Tested { second_opinion, ..best })
    }
}

/// Recordings in each session that runs are parts of: windows of one recording are no independent evidence.
fn recordings(runs: &[Run]) -> BTreeMap<&str, usize> {
    let distinct: BTreeSet<(&str, &str)> = runs.iter().map(|r| (r.session.as_str(), r.recording.as_str())).collect();
    let mut count = BTreeMap::new();
    distinct.into_iter().for_each(|(session, _)| *count.entry(session).or_default() += 1);
    count
}

/// Ways to divide so many sessions into two groups, one of which may be empty of the effect.
fn divisions(sessions: usize) -> f64 {
    f64::max(2f64.powi(sessions.saturating_sub(1).min(60) as i32) - 1.0, 1.0)
}

/// A p-value corrected for the extents that were tested; a group of sessions was chosen as the best one, and is corrected for
/// every way to divide them.
fn corrected(p: f64, extent: &Extent, options: usize, by_session: bool, divisions: f64) -> f64 {
    let kinds = match options {
        0 | 1 => 1.0,
        _ if by_session => 3.0,
        _ => 2.0,
    };
    (p * kinds * if matches!(extent, Extent::In(_)) { divisions } else { 1.0 }).min(1.0)
}

/// The extent that counts: the common amplitude unless a group of sessions explains clearly more, and either unless the sessions
/// differ beyond doubt; what is possible comes before what is not.
fn choose(options: Vec<Tested>, divisions: f64) -> Option<Tested> {
    let price = |extent: &Extent, more: usize| match extent {
        Extent::All | Extent::In(_) => 2.0 * (INDISTINGUISHABLE + divisions.ln()),
        Extent::Each(_) => 2.0 * INDISTINGUISHABLE + PARAMETER_PRICE * more as f64,
    };
    let gain = |t: &Tested| t.test.statistic - t.test.degrees as f64;
    options.into_iter().reduce(|best, next| {
        let price = price(&next.extent, next.test.degrees.saturating_sub(best.test.degrees));
        let more = gain(&next) > gain(&best) + price && (next.possible || !best.possible);
        if (next.possible && !best.possible && gain(&next) > 0.0) || more { next } else { best }
    })
}

/// Ways to divide the sessions: all of them, or where there are too many the two groups where an amplitude differs most, at the largest
/// gap along the direction of greatest change.
fn groups(contrast: &Test, sessions: &[String], k: usize) -> Vec<Vec<String>> {
    let n = sessions.len();
    if contrast.degrees == 0 {
        return Vec::new();
    }
    if n <= DIVIDED_SESSIONS {
        let chosen = |mask: usize| (0..n).filter(|i| mask >> i & 1 == 1).map(|i| sessions[i].clone()).collect();
        return (1..(1 << n) - 1).map(chosen).collect();
    }
    let by_session: Vec<DVector<f64>> = (0..n).map(|s| contrast.amplitude.rows(s * k, k).into_owned()).collect();
    let mean = by_session.iter().fold(DVector::zeros(k), |a, b| a + b) / n as f64;
    let mut spread = DMatrix::zeros(k, k);
    for a in &by_session {
        let d = a - &mean;
        spread += &d * d.transpose();
    }
    let eigen = SymmetricEigen::new(spread);
    let axis = eigen.eigenvectors.column(eigen.eigenvalues.imax()).into_owned();
    let mut order: Vec<(f64, usize)> = by_session.iter().enumerate().map(|(i, a)| (axis.dot(a), i)).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    let cut = (1..n).max_by(|a, b| (order[*a].0 - order[*a - 1].0).total_cmp(&(order[*b].0 - order[*b - 1].0)));
    let Some(cut) = cut else { return Vec::new() };
    let named = |part: &[(f64, usize)]| part.iter().map(|(_, i)| sessions[*i].clone()).collect::<Vec<_>>();
    vec![named(&order[..cut]), named(&order[cut..])]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example;

    fn test(statistic: f64, degrees: usize) -> Test {
        Test {
            statistic,
            degrees,
            p: 0.5,
            amplitude: DVector::zeros(degrees),
            covariance: DMatrix::identity(degrees, degrees),
            retained: 1.0,
        }
    }

    fn option(extent: Extent, statistic: f64, degrees: usize, possible: bool) -> Tested {
        Tested { extent, test: test(statistic, degrees), second_opinion: 0.0, possible }
    }

    fn sessions(names: &[&str]) -> Vec<String> {
        names.iter().map(|s| (*s).to_owned()).collect()
    }

    #[test]
    fn a_current_is_isolated_on_headings_all_round_and_hardly_from_a_log_and_a_compass_on_one() {
        let model = example::model();
        let list = crate::diagnose::evidence::candidate::candidates(&model, &[]);
        let current = list.iter().position(|c| c.mechanism.name == "current").unwrap();
        let share = |runs: &[Run]| {
            let s = screen(&example::at(&model), example::RK4, runs, &list);
            let (isolated, beside_the_ship) =
                (s.isolated(current, &Extent::All, &list), s.test(current, &Extent::All).retained);
            assert!(isolated < beside_the_ship, "{isolated} {beside_the_ship}");
            isolated
        };
        let mut runs = example::runs(&model, 12);
        let all_round = share(&runs);
        for r in &mut runs {
            let (sin, cos) = r.initial[2].sin_cos();
            for m in &mut r.measured {
                let [x, y, psi, ..] = m.map(Option::unwrap);
                (m[0], m[1], m[2]) = (Some(x * cos + y * sin), Some(y * cos - x * sin), Some(psi - r.initial[2]));
            }
            r.initial[2] = 0.0;
        }
        let one = share(&runs);
        assert!(one < 0.5 * all_round && all_round > 0.1, "{one} {all_round}");
    }

    #[test]
    fn the_chance_of_a_statistic_is_the_tail_of_fishers_f_for_every_mechanism_that_can_be_seen() {
        let (model, runs) = (example::model(), example::runs(&example::model(), 12));
        let list = crate::diagnose::evidence::candidate::candidates(&model, &[]);
        let current = list.iter().position(|c| c.mechanism.name == "current").unwrap();
        let s = screen(&example::at(&model), example::RK4, &runs, &list);
        let chance = |statistic: f64| s.by_chance(current, &Extent::All, statistic, 2, &runs);
        let Ratio { value, degrees } = s.moderated(current, &Extent::All, &runs);
        // The tail of F with 2 and n degrees of freedom has a closed form: (1 + 2 F / n)^(-n / 2), F = T / (2 phi).
        let tail = (1.0 + 60.0 / value / degrees).powf(-0.5 * degrees);
        let visible = s.rows.iter().filter(|r| r.visible).count() as f64;
        assert!((chance(60.0) / (tail * visible) - 1.0).abs() < 1e-6, "{} {}", chance(60.0), tail * visible);
        assert!(visible > 5.0 && chance(0.0) == 1.0 && chance(80.0) < chance(60.0));
    }

    #[test]
    fn a_difference_of_the_ships_own_forces_is_seen_in_more_recordings_than_it_has_parameters() {
        let model = example::model();
        let list = crate::diagnose::evidence::candidate::candidates(&model, &[]);
        let visible = |name: &str, runs: &[Run]| {
            let s = screen(&example::at(&model), example::RK4, runs, &list);
            s.rows.iter().any(|r| list[r.candidate].mechanism.name == name && r.visible)
        };
        // Six and eight recordings in each of two sessions, for six parameters.
        let [six, eight] = [12, 16].map(|count| example::runs(&model, count));
        assert_eq!(["hull_nonlinear", "crossflow", "time_skew"].map(|n| visible(n, &six)), [false, true, true]);
        assert!(visible("hull_nonlinear", &eight));
        // Windows of one recording are no independent evidence.
        let mut cut = eight;
        cut.iter_mut().for_each(|r| r.recording = r.session.clone());
        assert_eq!(["hull_nonlinear", "crossflow", "time_skew"].map(|n| visible(n, &cut)), [false, false, true]);
    }

    #[test]
    fn four_sessions_can_be_divided_in_seven_ways() {
        assert_eq!([1, 2, 4].map(divisions), [1.0, 1.0, 7.0]);
    }

    #[test]
    fn a_p_value_pays_for_every_extent_that_was_tested_and_a_group_for_every_division() {
        let group = Extent::In(sessions(&["a"]));
        assert_eq!(corrected(0.001, &Extent::All, 1, false, 7.0), 0.001);
        assert_eq!(corrected(0.001, &Extent::All, 2, false, 7.0), 0.002);
        assert!((corrected(0.001, &group, 3, true, 7.0) - 0.021).abs() < 1e-15);
        assert_eq!(corrected(0.4, &group, 2, false, 7.0), 1.0);
    }

    #[test]
    fn a_group_of_sessions_must_explain_clearly_more_than_all_of_them() {
        let group = || Extent::In(sessions(&["a", "b"]));
        // 6 + 2 ln 7 = 9.89 more in statistic less degrees.
        let of =
            |more: f64| choose(vec![option(Extent::All, 50.0, 2, true), option(group(), 50.0 + more, 2, true)], 7.0);
        assert_eq!(of(9.8).map(|t| t.extent), Some(Extent::All));
        assert_eq!(of(10.0).map(|t| t.extent), Some(group()));
    }

    #[test]
    fn amplitudes_of_their_own_pay_for_each_that_is_more() {
        let each = || Extent::Each(sessions(&["a", "b", "c"]));
        // Four more: 6 + 2 * 4 and their four degrees.
        let of =
            |more: f64| choose(vec![option(Extent::All, 50.0, 2, true), option(each(), 50.0 + more, 6, true)], 3.0);
        assert_eq!(of(17.9).map(|t| t.extent), Some(Extent::All));
        assert_eq!(of(18.1).map(|t| t.extent), Some(each()));
    }

    #[test]
    fn a_possible_amplitude_comes_before_one_beyond_its_bounds() {
        let group = Extent::In(sessions(&["a"]));
        let impossible = || option(Extent::All, 500.0, 2, false);
        let chosen = choose(vec![impossible(), option(group.clone(), 10.0, 2, true)], 1.0);
        assert_eq!(chosen.map(|t| t.extent), Some(group.clone()));
        let chosen = choose(vec![impossible(), option(group, 1.0, 2, true)], 1.0);
        assert_eq!(chosen.map(|t| t.extent), Some(Extent::All));
        assert!(choose(Vec::new(), 1.0).is_none());
    }

    #[test]
    fn few_sessions_are_divided_in_every_way_and_many_at_the_largest_gap() {
        let three = sessions(&["a", "b", "c"]);
        assert_eq!(groups(&test(1.0, 3), &three, 1).len(), 6);
        let seven: Vec<String> = (0..7).map(|i| i.to_string()).collect();
        let amplitude = DVector::from_column_slice(&[0.1, 5.0, 0.0, 5.2, 0.2, -0.1, 0.05]);
        let contrast = Test { amplitude, ..test(1.0, 7) };
        let mut parts = groups(&contrast, &seven, 1);
        parts.sort_by_key(Vec::len);
        parts[0].sort();
        assert_eq!((parts.len(), parts[0].clone()), (2, sessions(&["1", "3"])));
        assert!(groups(&test(1.0, 0), &three, 1).is_empty());
    }
}
