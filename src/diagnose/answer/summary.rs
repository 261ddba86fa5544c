//! The lists of a diagnosis beside its findings: ranking, absorbed and detectable mechanisms, moved parameters.
//! They are read off the tests of the base model and the estimates; nothing is tested or decided here.

use super::diagnosis::{Absorbed, Adequacy, Budget, Detectable, Likeness, Move, Ranked, Trace};
use crate::diagnose::evidence::candidate::{Candidate, Extent};
use crate::diagnose::evidence::wald::Wald;
use crate::diagnose::search::screen::{Row, Screen};
use crate::diagnose::settings::{RESOLVED_SAMPLES, Settings};
use crate::likelihood::covariance::Z;
use crate::likelihood::estimate::Estimate;
use crate::likelihood::filter::{Filter, Pass, Wanted};
use crate::model::Model;
use crate::physics::Probe;
use crate::recording::Run;
use crate::simulate::Integration;
use rayon::prelude::*;
use statrs::distribution::{ContinuousCDF, Normal};

/// Likeness above which a pair of mechanisms is listed.
const ALIKE: f64 = 0.7;

/// Power at which a mechanism counts as detectable.
const POWER: f64 = 0.8;

/// The p-values of the generic force laws.
pub fn adequacy(s: &Screen) -> Adequacy {
    Adequacy { symmetric: s.symmetric_test.p, asymmetric: s.asymmetric_test.p }
}

/// The ranking of all mechanisms, the most significant first.
pub fn ranking(s: &Screen, list: &[Candidate]) -> Vec<Ranked> {
    s.rows.iter().map(|r| ranked(r, list)).collect()
}

fn ranked(r: &Row, list: &[Candidate]) -> Ranked {
    let c = &list[r.candidate];
    Ranked {
        mechanism: c.mechanism.name.into(),
        title: c.mechanism.title.into(),
        statistic: r.test.statistic,
        degrees: r.test.degrees,
        p: r.p,
        amplitude: r.test.amplitude.iter().zip(c.columns.iter().cycle()).map(|(a, col)| a * col.scale).collect(),
        admissible: r.admissible,
        retained: r.test.retained,
        second_opinion: r.second_opinion,
        sessions: r.extent.sessions().to_vec(),
        by_session: matches!(r.extent, Extent::Each(_)),
    }
}

/// The mechanisms that these data cannot see, by name.
pub fn absorbed(s: &Screen, list: &[Candidate]) -> Vec<Absorbed> {
    let mut out: Vec<Absorbed> = s
        .rows
        .iter()
        .filter(|r| !r.visible)
        .map(|r| {
            let c = &list[r.candidate];
            let by = if c.mechanism.needs_reference {
                "the ship's own hull, propeller and rudder coefficients, which are not known well enough; \
                 a session without it would show it"
            } else {
                "the model's own parameters, or nothing in these data depends on it"
            };
            Absorbed { mechanism: c.mechanism.name.into(), retained: r.pooled.retained, by: by.into() }
        })
        .collect();
    out.sort_by(|a, b| a.mechanism.cmp(&b.mechanism));
    out
}

/// Sizes of which a clock or a lag is at least what is named: [`RESOLVED_SAMPLES`] of the longest sample period of the runs.
pub fn resolved(mut sizes: Vec<Detectable>, runs: &[Run]) -> Vec<Detectable> {
    let least = RESOLVED_SAMPLES * runs.iter().map(|r| r.dt).fold(0.0, f64::max);
    sizes.iter_mut().filter(|d| d.unit == "s").for_each(|d| d.size = d.size.max(least));
    sizes
}

/// The size of every identifiable mechanism that is seen in 80 % of such data sets at the chance of a false name that is allowed.
pub fn detectable(s: &Screen, list: &[Candidate], settings: &Settings, model: &Model) -> Vec<Detectable> {
    let Ok(normal) = Normal::new(0.0, 1.0) else { return Vec::new() };
    let visible: Vec<&Row> = s.rows.iter().filter(|r| r.visible).collect();
    let quantile = normal.inverse_cdf(1.0 - 0.5 * settings.alpha / visible.len().max(1) as f64);
    let needed = quantile + normal.inverse_cdf(POWER);
    let mut out: Vec<Detectable> = visible
        .iter()
        .map(|r| {
            let c = &list[r.candidate];
            let k = c.columns.len();
            // The least visible direction decides; quadratic effects grow with the square root.
            let test = if matches!(r.extent, Extent::Each(_)) { &r.pooled } else { &r.test };
            let mut sd = (0..k).map(|i| test.covariance[(i, i)].max(0.0).sqrt()).fold(0.0, f64::max) * needed;
            if c.mechanism.probe == Probe::Odd {
                sd = sd.sqrt();
            }
            let p = &model.parameters[c.columns[0].parameter];
            let size = sd * c.columns[0].scale;
            Detectable {
                mechanism: c.mechanism.name.into(),
                size,
                unit: p.info.unit.into(),
                of_change: c.mechanism.needs_reference && r.extent != Extent::All,
            }
        })
        .collect();
    out.sort_by(|a, b| a.mechanism.cmp(&b.mechanism));
    out
}

/// Pairs of mechanisms that look alike on these data, the likest first.
pub fn confusable(s: &Screen, list: &[Candidate]) -> Vec<Likeness> {
    let shown: Vec<usize> = s.rows.iter().filter(|r| r.visible).map(|r| r.candidate).collect();
    let mut out = Vec::new();
    for (i, a) in shown.iter().enumerate() {
        for b in &shown[i + 1..] {
            let cosine = s.likeness(*a, *b);
            if cosine > ALIKE {
                out.push(Likeness { a: list[*a].mechanism.name.into(), b: list[*b].mechanism.name.into(), cosine });
            }
        }
    }
    out.sort_by(|a, b| b.cosine.total_cmp(&a.cosine));
    out
}

/// How far the free parameters of the user's model moved from one model that is written to the other.
pub fn moves(null: &Estimate, found: &Estimate, integration: Integration, runs: &[Run], user: &Model) -> Vec<Move> {
    let Wald { covariance, .. } = Wald::at(found, integration, runs);
    null.free
        .iter()
        .enumerate()
        .filter(|(_, f)| user.parameters.get(f.column.parameter).is_some_and(|p| p.free))
        .map(|(i, f)| {
            let (before, after) = (f.value(&null.model), f.value(&found.model));
            let error = covariance[(i, i)].max(0.0).sqrt() * f.column.scale;
            Move {
                name: found.model.parameters[f.column.parameter].name.clone(),
                before,
                after,
                error,
                moved: if error > 0.0 { (after - before) / error } else { 0.0 },
            }
        })
        .collect()
}

/// How far each coefficient with a prior is from the mean of it.
pub fn budget(found: &Estimate) -> Vec<Budget> {
    found
        .free
        .iter()
        .filter_map(|f| {
            let prior = f.prior?;
            let value = f.value(&found.model);
            Some(Budget {
                name: found.model.parameters[f.column.parameter].name.clone(),
                prior: prior.mean,
                sd: prior.sd,
                value,
                used: (value - prior.mean) / prior.sd,
            })
        })
        .collect()
}

/// The filtered states and unknown forces along every run, at the base model and with the findings.
pub fn traces(runs: &[Run], integration: Integration, before: &Estimate, after: Option<&Estimate>) -> Vec<Trace> {
    let filter = Filter::new(&before.model, integration, &[]);
    let last = after.map(|found| (Filter::new(&found.model, integration, &[]), &found.noise));
    let force = |z: &[f64; Z]| [z[6], z[7], z[8]];
    let of = |(index, r): (usize, &Run)| {
        let Pass { filtered, force_sd, .. } = filter.pass(r, &before.noise, Wanted::default());
        let forces: Vec<[f64; 3]> = filtered.iter().map(force).collect();
        let after = last.as_ref().map(|(filter, noise)| filter.pass(r, noise, Wanted::default()).filtered);
        Trace {
            index,
            run: r.name.clone(),
            session: r.session.clone(),
            time: r.inputs.iter().map(|i| i.t).collect(),
            state: filtered.iter().map(|z| [z[0], z[1], z[2], z[3], z[4], z[5]]).collect(),
            inputs: r.inputs.iter().map(|i| [i.n, i.delta]).collect(),
            after: after.map_or_else(|| forces.clone(), |filtered| filtered.iter().map(force).collect()),
            before: forces,
            sd: force_sd,
        }
    };
    runs.par_iter().enumerate().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::evidence::candidate::candidates;
    use crate::diagnose::example::{RK4, at, model, runs};
    use crate::diagnose::search::screen::screen;

    #[test]
    fn a_mechanism_is_either_detectable_or_absorbed_and_more_runs_detect_smaller_sizes() {
        let model = model();
        let list = candidates(&model, &[]);
        let of = |count: usize| screen(&at(&model), RK4, &runs(&model, count), &list);
        let (few, many) = (of(4), of(12));
        let settings = Settings::default();
        let size = |s: &Screen| {
            let all = detectable(s, &list, &settings, &model);
            all.iter().find(|d| d.mechanism == "current").map(|d| d.size)
        };
        assert!(size(&many) < size(&few) && size(&many) > Some(0.0), "{:?} {:?}", size(&few), size(&many));
        let hidden = absorbed(&many, &list);
        let seen = detectable(&many, &list, &settings, &model);
        assert_eq!(hidden.len() + seen.len(), list.len());
        // No clock is named that is off by less than half a sample of 1 s.
        let clock = |all: &[Detectable]| all.iter().find(|d| d.mechanism == "time_skew").map(|d| d.size);
        let data = runs(&model, 1);
        let found = resolved(seen.clone(), &data);
        assert_eq!(clock(&found), clock(&seen).map(|size| size.max(0.5 * data[0].dt)));
        assert!(seen.iter().all(|d| hidden.iter().all(|a| a.mechanism != d.mechanism)));
    }

    #[test]
    fn an_unmoved_estimate_moves_nothing_and_a_prior_is_used_by_its_standard_deviations() {
        let model = model();
        let mut found = at(&model);
        let runs = runs(&model, 4);
        let all = moves(&found, &found, RK4, &runs, &model);
        assert!(all.len() == 11 && all.iter().all(|m| m.moved == 0.0 && m.error > 0.0));
        found.free = crate::likelihood::parameters::base_parameters(&model, true);
        let f = found.free.last().unwrap().clone();
        let (mean, sd) = f.prior.map(|p| (p.mean, p.sd)).unwrap();
        f.set(&mut found.model, mean + 0.5 * sd);
        let used: Vec<f64> = budget(&found).iter().map(|b| b.used).collect();
        assert!((used[used.len() - 1] - 0.5).abs() < 1e-12 && used[..used.len() - 1].iter().all(|u| *u == 0.0));
    }
}
