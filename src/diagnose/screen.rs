//! The test of every mechanism of the catalogue by its sensitivities, after parameters, nuisances, initial states and noise
//! have had their say. It ranks and corrects for multiplicity; it does not refit and does not conclude.

use super::candidate::{Candidate, Extent, append};
use super::estimate::{Estimate, base_of, evidence, restrictions};
use super::evidence::{Base, Evidence, Test, UNSEEN, pick};
use super::filter::{Column, Filter, Pass, Wanted};
use crate::model::Model;
use crate::physics::Kind;
use crate::recording::Run;
use crate::simulate::Integration;
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rayon::prelude::*;

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
    /// Size of the amplitude over the floor below which it is not worth naming.
    pub size: f64,
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
    /// The same with the mirror-symmetric basis beside it, as far as the data ask for one: what is known when the form of the
    /// ship's own forces is not.
    pub widened: Base,
    /// Columns of each candidate.
    groups: Vec<Vec<usize>>,
    /// Columns of the mirror-symmetric basis.
    pub symmetric: Vec<usize>,
    /// Columns of the mirror-breaking and earth-fixed basis.
    pub asymmetric: Vec<usize>,
    /// Dotted names of the basis columns, symmetric then asymmetric.
    pub basis_names: Vec<String>,
    /// Rows in order of significance.
    pub rows: Vec<Row>,
    /// Test of the symmetric basis.
    pub symmetric_test: Test,
    /// Test of the asymmetric basis.
    pub asymmetric_test: Test,
    /// The passes behind it.
    pub passes: Vec<Pass>,
}

impl Screen {
    /// Columns of a candidate.
    pub fn columns(&self, index: usize) -> &[usize] {
        &self.groups[index]
    }

    /// How the base moves, in units of its columns, when a group of columns takes these amplitudes.
    pub fn base_shift(&self, columns: &[usize], extent: &Extent, amplitude: &DVector<f64>) -> DVector<f64> {
        let k = columns.len();
        let mut pull = DVector::zeros(self.base.columns.len());
        for (i, part) in extent.parts().iter().enumerate() {
            for (name, e) in &self.evidence.sessions {
                if part.as_ref().is_none_or(|s| s.contains(name)) {
                    pull += pick(&e.information, &self.base.columns, columns) * amplitude.rows(i * k, k);
                }
            }
        }
        -(&self.base.inverse * pull)
    }

    /// Tests a candidate where it is taken to act, after the base has had its say.
    pub fn test(&self, index: usize, extent: &Extent) -> Test {
        let columns = self.columns(index);
        match extent {
            Extent::All => self.evidence.test(&self.base, columns),
            Extent::In(sessions) => self.evidence.test_in(&self.base, columns, &named(sessions)),
            Extent::Each(_) => self.evidence.test_each(&self.base, columns),
        }
    }

    /// Cosine of the smallest principal angle between two candidates once the base is projected out: 1 when the data
    /// cannot tell them apart.
    pub fn likeness(&self, a: usize, b: usize) -> f64 {
        let (ca, cb) = (self.columns(a), self.columns(b));
        let h = &self.evidence.total.information;
        let reduced = |r: &[usize], c: &[usize]| {
            pick(h, r, c) - pick(h, r, &self.base.columns) * &self.base.inverse * pick(h, &self.base.columns, c)
        };
        let (aa, bb, ab) = (reduced(ca, ca), reduced(cb, cb), reduced(ca, cb));
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

pub(super) fn basis_columns(model: &Model, term: &str) -> Vec<(String, Column)> {
    let prefix = format!("{term}.");
    model
        .parameters
        .iter()
        .enumerate()
        .filter(|(_, p)| p.name.starts_with(&prefix))
        .map(|(parameter, p)| (p.name.clone(), Column::tangent(model, parameter)))
        .collect()
}

/// Runs one sensitivity pass over everything and tests every candidate.
pub fn screen(found: &Estimate, integration: Integration, runs: &[Run], candidates: &[Candidate]) -> Screen {
    let model = &found.model;
    let mut columns: Vec<Column> = found.free.iter().map(|f| f.column).collect();
    let groups = append(&mut columns, candidates);
    let mut names = Vec::new();
    let mut block = |term: &str| {
        let start = columns.len();
        for (name, column) in basis_columns(model, term) {
            names.push(name);
            columns.push(column);
        }
        (start..columns.len()).collect::<Vec<usize>>()
    };
    let symmetric = block("symmetric");
    let asymmetric = block("asymmetric");
    let filter = Filter::new(model, integration, &columns);
    let passes: Vec<Pass> = runs.par_iter().map(|r| filter.pass(r, &found.noise, Wanted::default())).collect();
    let evidence = evidence(runs, &passes, &restrictions(&found.free));
    let base = base_of(&evidence, model, &found.free);
    let widened = widen(&evidence, &base, &symmetric);
    let sessions: Vec<String> = evidence.sessions.keys().cloned().collect();
    // A sensor is judged by what no force law whatever can bring.
    let anything: Vec<usize> = symmetric.iter().chain(&asymmetric).copied().collect();
    let loosest = widen(&evidence, &base, &anything);
    let mut rows: Vec<Row> = (0..candidates.len())
        .into_par_iter()
        .map(|i| {
            let wide = if candidates[i].mechanism.kind == Kind::Sensor { &loosest } else { &widened };
            row(&evidence, &base, wide, model, &candidates[i], i, &groups[i], &sessions)
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
    let symmetric_test = evidence.test(&base, &symmetric);
    let asymmetric_test = evidence.test(&widened, &asymmetric);
    Screen {
        evidence,
        base,
        widened,
        groups,
        symmetric,
        asymmetric,
        basis_names: names,
        rows,
        symmetric_test,
        asymmetric_test,
        passes,
    }
}

/// The base widened by the symmetric basis under a shrinkage prior, whose common variance is chosen by its marginal
/// likelihood: nothing when the data do not ask for it.
pub(super) fn widen(evidence: &Evidence, base: &Base, symmetric: &[usize]) -> Base {
    let h = &evidence.total.information;
    let cross = pick(h, symmetric, &base.columns);
    let own = pick(h, symmetric, symmetric) - &cross * &base.inverse * cross.transpose();
    let score = DVector::from_fn(symmetric.len(), |i, _| evidence.total.score[symmetric[i]]) - &cross * base.step();
    let eigen = SymmetricEigen::new((&own + own.transpose()) * 0.5);
    let z = eigen.eigenvectors.transpose() * &score;
    // log p(data | v) with amplitudes ~ N(0, v): sum of -0.5 ln(1 + v l) + 0.5 z^2 v / (1 + v l).
    let log_marginal = |v: f64| -> f64 {
        eigen
            .eigenvalues
            .iter()
            .zip(z.iter())
            .map(|(l, z)| {
                let d = 1.0 + v * l.max(0.0);
                -0.5 * d.ln() + 0.5 * z * z * v / d
            })
            .sum()
    };
    let (mut best, mut variance) = (0.0, 0.0);
    for i in 0..=40 {
        let v = 10f64.powf(-8.0 + 0.25 * f64::from(i));
        let value = log_marginal(v);
        if value > best + 2.0 {
            (best, variance) = (value, v);
        }
    }
    if variance == 0.0 {
        return base.clone();
    }
    let mut shrunk = evidence.clone();
    for c in symmetric {
        shrunk.total.information[(*c, *c)] += 1.0 / variance;
    }
    let mut widened = shrunk.extend(base, symmetric);
    widened.columns.truncate(base.columns.len() + symmetric.len());
    widened
}

/// Statistics closer than this are the same.
const EQUAL: f64 = 0.01;
/// Beyond so many sessions not every way to part them is tried.
const MANY_SESSIONS: usize = 6;
/// What a group of sessions, or amplitudes of their own, must explain more than what is simpler.
const CLEARLY: f64 = 6.0;
/// The same for every further amplitude, beyond what it would explain by chance.
const OWN_AMPLITUDE: f64 = 2.0;

fn row(
    evidence: &Evidence,
    base: &Base,
    widened: &Base,
    model: &Model,
    candidate: &Candidate,
    index: usize,
    columns: &[usize],
    sessions: &[String],
) -> Row {
    let pooled = evidence.test(base, columns);
    let mut tests: Vec<(Extent, Test, f64)> = Vec::new();
    if !candidate.mechanism.needs_reference {
        let opinion = evidence.test(widened, columns).p;
        tests.push((Extent::All, pooled.clone(), opinion));
    }
    let possible = |t: &Test| candidate.admissible(model, t);
    if let Some(contrast) = evidence.contrast(base, columns) {
        let against = |base: &Base| {
            if candidate.mechanism.needs_reference { evidence.extend(base, columns) } else { base.clone() }
        };
        let reference = against(base);
        let in_group = |group: Vec<String>| {
            let test = evidence.test_in(&reference, columns, &named(&group));
            (group, test)
        };
        let mut parts = groups(&contrast, sessions, columns.len());
        // Where nothing else decides, what differs is what changed since the first recording.
        parts.sort_by_key(|part| evidence.runs.first().is_some_and(|r| part.contains(&r.session)));
        let chosen = parts.into_iter().map(in_group).reduce(|best, next| {
            let by_rank = possible(&next.1).cmp(&possible(&best.1));
            if by_rank.is_gt() || (by_rank.is_eq() && next.1.statistic > best.1.statistic + EQUAL) {
                next
            } else {
                best
            }
        });
        if let Some((group, test)) = chosen {
            let opinion = evidence.test_in(&against(widened), columns, &named(&group)).p;
            tests.push((Extent::In(group), test, opinion));
        }
        if candidate.mechanism.is_weather() {
            let opinion = evidence.test_each(widened, columns).p;
            tests.push((Extent::Each(sessions.to_vec()), evidence.test_each(base, columns), opinion));
        }
    }
    // A group of sessions was chosen to look best: it pays for every way to part them.
    let partings = f64::max(2f64.powi(sessions.len().saturating_sub(1).min(60) as i32) - 1.0, 1.0);
    let kinds = match tests.len() {
        0 | 1 => 1.0,
        _ if candidate.mechanism.is_weather() => 3.0,
        _ => 2.0,
    };
    // The common amplitude unless a group of sessions explains clearly more, and either unless they differ beyond doubt.
    let price = |extent: &Extent, more: usize| match extent {
        Extent::All | Extent::In(_) => CLEARLY + 2.0 * partings.ln(),
        Extent::Each(_) => CLEARLY + OWN_AMPLITUDE * more as f64,
    };
    let mut best: Option<(Extent, Test, f64)> = None;
    for t in tests {
        let better = best.as_ref().is_none_or(|b| {
            let (new, old) = (t.1.statistic - t.1.degrees as f64, b.1.statistic - b.1.degrees as f64);
            let price = price(&t.0, t.1.degrees.saturating_sub(b.1.degrees));
            (possible(&t.1) && !possible(&b.1) && new > 0.0)
                || (new > old + price && (possible(&t.1) || !possible(&b.1)))
        });
        if better {
            best = Some(t);
        }
    }
    let (chosen, test, second_opinion) = best.unwrap_or((Extent::All, pooled.clone(), 1.0));
    let visible = test.degrees > 0 && test.retained > UNSEEN;
    let amplitude: Vec<f64> = test.amplitude.iter().copied().collect();
    Row {
        candidate: index,
        p: if visible {
            (test.p * kinds * if matches!(chosen, Extent::In(_)) { partings } else { 1.0 }).min(1.0)
        } else {
            1.0
        },
        size: candidate.size(&amplitude),
        admissible: possible(&test),
        visible: visible && (chosen != Extent::All || !candidate.mechanism.needs_reference),
        extent: chosen,
        pooled,
        test,
        second_opinion,
    }
}

/// Ways to part the sessions: all of them, or where there are too many the two where an amplitude differs most, at the largest
/// gap along the direction of greatest change.
fn groups(contrast: &Test, sessions: &[String], k: usize) -> Vec<Vec<String>> {
    let n = sessions.len();
    if contrast.degrees == 0 {
        return Vec::new();
    }
    if n <= MANY_SESSIONS {
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
