//! Findings with everything that is said of them: parameters with intervals, force, signature, windows.
//! Which findings there are is decided elsewhere.

use super::finding::{Amplitude, Equations, Finding, GENERIC, PUSH, PUSH_TITLE};
use super::grade::Grade;
use crate::diagnose::evidence::admit::Admission;
use crate::diagnose::evidence::candidate::{Candidate, Extent};
use crate::diagnose::evidence::forces::forces_of;
use crate::diagnose::evidence::locate::{EquationShare, Location};
use crate::diagnose::evidence::push::Push;
use crate::diagnose::evidence::region::RegionTest;
use crate::diagnose::evidence::wald::Wald;
use crate::diagnose::search::decide::PushTest;
use crate::diagnose::search::screen::Screen;
use crate::diagnose::search::select::Selection;
use crate::diagnose::search::selected::Selected;
use crate::diagnose::settings::{SCATTER_GROUPS, UNUSUAL};
use crate::likelihood::estimate::Estimate;
use crate::likelihood::evidence::Scatter;
use crate::likelihood::filter::Column;
use crate::model::Model;
use crate::numerals::sig;
use crate::physics::Kind;
use crate::recording::audit::Issue;
use crate::recording::{Channel, Run};
use std::collections::BTreeSet;

/// What was sailed in each run: the manoeuvre, or the recording where there are few manoeuvres or no names for them.
pub fn kinds(runs: &[Run]) -> Vec<&str> {
    let manoeuvres: BTreeSet<&str> = runs.iter().map(|r| r.manoeuvre.as_str()).collect();
    let by_manoeuvre = manoeuvres.len() >= SCATTER_GROUPS;
    runs.iter().map(|r| if by_manoeuvre { r.manoeuvre.as_str() } else { r.recording.as_str() }).collect()
}

/// The uncertainty of every free parameter of an estimate: the ship's own forces may have another form, and manoeuvres of a kind
/// may pull a parameter their way.
pub(in crate::diagnose) struct Intervals {
    wald: Wald,
    scatter: Scatter,
}

impl Intervals {
    pub(in crate::diagnose) fn new(found: &Estimate, runs: &[Run], s: &Screen) -> Self {
        let n = found.free.len();
        let wald = Wald::of(found, s.widened.inverse.view((0, 0), (n, n)).into_owned());
        Self { wald, scatter: s.evidence.scatter(&s.widened, &kinds(runs), &s.mechanism_columns()) }
    }

    /// Whether the joint 95 % region of a candidate's parameters excludes zero, by the same variance as their single intervals: of one
    /// parameter its interval, of several Hotelling's region, which is wider where few groups determine the scatter of many parameters.
    /// Where each session has a size of its own, the region of a single session may exclude it too.
    pub(in crate::diagnose) fn excludes_zero(&self, found: &Estimate, c: &Candidate, extent: &Extent) -> bool {
        let places = c.positions(&found.free, extent);
        let mut part = self.wald.part(&places).less(&c.held(extent));
        for (i, at) in places.iter().enumerate() {
            let factor = self.scatter.factors[*at];
            part.covariance.row_mut(i).scale_mut(factor);
            part.covariance.column_mut(i).scale_mut(factor);
        }
        match extent {
            Extent::All | Extent::In(_) => self.scatter.excludes(part.statistic(), &places),
            Extent::Each(sessions) => {
                let parameters = c.columns.len();
                let of = |i: usize| part.part(&(i * parameters..(i + 1) * parameters).collect::<Vec<_>>()).statistic();
                let one_by_one: Vec<f64> = (0..sessions.len()).map(of).collect();
                self.scatter.excludes_in_some(part.statistic(), &one_by_one, &places)
            }
        }
    }

    /// A candidate's parameters beyond what the model already had of them, with their intervals, session by session where each has its own.
    pub(in crate::diagnose) fn amplitudes(&self, found: &Estimate, c: &Candidate, extent: &Extent) -> Vec<Amplitude> {
        let places = c.positions(&found.free, extent);
        let Wald { value, covariance } = self.wald.part(&places).less(&c.held(extent));
        let k = c.columns.len();
        let amplitude = |i: usize| {
            let col = &c.columns[i % k];
            let name = match extent {
                Extent::Each(sessions) => format!("{} [{}]", c.names[i % k], sessions[i / k]),
                Extent::All | Extent::In(_) => c.names[i % k].clone(),
            };
            let error = covariance[(i, i)].max(0.0).sqrt() * self.scatter.factors[places[i]] * col.scale;
            let unit = found.model.parameters[col.parameter].info.unit;
            Amplitude::within(name, value[i] * col.scale, unit, error, self.scatter.reach(places[i]))
        };
        (0..value.len()).map(amplitude).collect()
    }
}

/// A mechanism with its parameters and what is said of it, not yet graded.
pub(in crate::diagnose) fn mechanism_finding(
    a: &Selected,
    Selection { tests, estimate, .. }: &Selection,
    intervals: &Intervals,
) -> Finding {
    let c = &tests.candidates[a.candidate];
    Finding {
        mechanism: c.mechanism.name.into(),
        title: c.mechanism.title.into(),
        grade: Grade::Suspected,
        kind: c.mechanism.kind,
        confidence_set: a.set.iter().map(|i| tests.candidates[*i].mechanism.name.to_string()).collect(),
        why: [a.why.as_str(), &beyond(c, &a.extent, &estimate.model), &unusual(c, estimate)].concat(),
        sessions: a.extent.sessions().to_vec(),
        by_session: matches!(a.extent, Extent::Each(_)),
        statistic: a.statistic,
        p: a.p,
        equations: force_shares(c, estimate, &tests.fit.runs, &tests.location),
        windows: Vec::new(),
        region: strongest_region(&tests.location.regions),
        signature: signature(c, &tests.screen),
        parameters: intervals.amplitudes(estimate, c, &a.extent),
        change: None,
        held_out: None,
    }
}

/// The selected mechanism that a finding names; `None` for what is no mechanism.
fn selected<'a>(finding: &Finding, mechanisms: &'a [Selected], candidates: &[Candidate]) -> Option<&'a Selected> {
    mechanisms.iter().find(|m| candidates[m.candidate].mechanism.name == finding.mechanism)
}

/// Gives the findings of a selection the sizes in the estimate that is written to the file, with the uncertainty as it is.
/// Returns those that unseen runs do not prove, and whose intervals excluded zero before and all include it then.
pub(in crate::diagnose) fn sized(
    findings: &mut [Finding],
    Selection { mechanisms, tests, .. }: &Selection,
    written: &Estimate,
) -> Vec<String> {
    let excludes_zero = |finding: &Finding| finding.parameters.iter().any(|p| p.ci95[0] > 0.0 || p.ci95[1] < 0.0);
    let mut lost = Vec::new();
    for finding in findings {
        let Some(own) = selected(finding, mechanisms, &tests.candidates) else { continue };
        let c = &tests.candidates[own.candidate];
        let of = |(i, held): (usize, &f64)| {
            let f = &written.free[i];
            f.value(&written.model) - held * f.column.scale
        };
        let held = c.held(&own.extent);
        let values = c.positions(&written.free, &own.extent).into_iter().zip(held.iter()).map(of);
        let before = excludes_zero(finding);
        finding.parameters.iter_mut().zip(values).for_each(|(parameter, value)| parameter.moved_to(value));
        if before && !excludes_zero(finding) && finding.grade != Grade::Confirmed {
            lost.push(finding.mechanism.clone());
        }
    }
    lost
}

/// The intervals of sizes of one sign that unseen runs confirm, on the scale of their logarithm: `value exp(+- reach error / value)`. What is in
/// proportion to a coefficient (fouling to the resistance) is as uncertain as that coefficient, and yet neither zero nor of the other sign.
pub(in crate::diagnose) fn confirmed_of_one_sign(
    findings: &mut [Finding],
    Selection { mechanisms, tests, estimate, .. }: &Selection,
) {
    for finding in findings.iter_mut().filter(|f| f.grade == Grade::Confirmed) {
        let Some(own) = selected(finding, mechanisms, &tests.candidates) else { continue };
        let c = &tests.candidates[own.candidate];
        let held = c.held(&own.extent);
        for (i, size) in finding.parameters.iter_mut().enumerate() {
            let p = &estimate.model.parameters[c.columns[i % c.columns.len()].parameter];
            let one_sign = held[i] == 0.0 && (p.lower == 0.0 && size.value > 0.0 || p.upper == 0.0 && size.value < 0.0);
            if one_sign {
                size.of_one_sign();
            }
        }
    }
}

/// What the model already had of a mechanism that is found again, in words; blank if nothing.
fn beyond(c: &Candidate, extent: &Extent, model: &Model) -> String {
    let held = c.held(extent);
    let mut own = c.names.iter().zip(&c.columns).cycle().zip(held.iter()).filter(|(_, a)| **a != 0.0).peekable();
    if own.peek().is_none() {
        return String::new();
    }
    let one = |((name, column), a): ((&String, &Column), &f64)| {
        let unit = model.parameters[column.parameter].info.unit;
        format!("{name} = {} {unit}", sig(a * column.scale, 3))
    };
    let list: Vec<String> = own.map(one).collect();
    format!(" The model already had {}; what is found comes on top of it.", list.join(", "))
}

/// Coefficients of a mechanism that are far from what is known of such coefficients, in words; blank if none.
fn unusual(c: &Candidate, found: &Estimate) -> String {
    let companions = c.companions(&found.model);
    let own = found.free.iter().filter(|f| companions.contains(&f.column.parameter));
    let far = own.filter_map(|f| Some((f, f.prior?))).filter_map(|(f, prior)| {
        let value = f.value(&found.model);
        let away = (value - prior.mean) / prior.sd;
        let name = &found.model.parameters[f.column.parameter].name;
        (away.abs() > UNUSUAL).then(|| {
            format!("{name} = {} where {} +- {} is usual", sig(value, 3), sig(prior.mean, 3), sig(prior.sd, 2))
        })
    });
    let list: Vec<String> = far.collect();
    if list.is_empty() { String::new() } else { format!(" Unusual for it: {}.", list.join(", ")) }
}

/// Mean square force that a mechanism brings, by equation: with it less without it, at the filtered states, in units in which
/// the equations compare.
fn force_shares(c: &Candidate, found: &Estimate, runs: &[Run], location: &Location) -> Equations {
    if c.mechanism.kind == Kind::Sensor {
        return location.equations.into();
    }
    let own: Vec<usize> = c.columns.iter().map(|col| col.parameter).collect();
    let forces = forces_of(&found.model, &own, runs);
    let mut sums = [0.0; 3];
    for f in &forces {
        for e in 0..3 {
            sums[e] += f[e] * f[e];
        }
    }
    let count = forces.len() as f64;
    let l = found.model.ship.hull.lpp;
    let rms: [f64; 3] = std::array::from_fn(|e| (sums[e] / count.max(1.0)).sqrt());
    // A moment counts by the force pair at a quarter of the length.
    let weight = [rms[0].powi(2), rms[1].powi(2), (rms[2] / (0.25 * l)).powi(2)];
    let total = weight.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    let share = |e: usize| EquationShare { share: weight[e] / total, rms: rms[e], sigma: location.equations[e].sigma };
    Equations { x: share(0), y: share(1), n: share(2) }
}

/// The region in which the unexplained force is most significant.
fn strongest_region(regions: &[RegionTest]) -> Option<String> {
    regions.first().filter(|r| r.p < 0.01).map(|r| r.region.clone())
}

/// How a mechanism behaves, in words.
fn signature(c: &Candidate, s: &Screen) -> String {
    let mut words = match c.mechanism.kind {
        Kind::Environment => "fixed on the earth: on the ship's axes it turns with the heading".to_string(),
        Kind::Ship => "fixed to the ship: it follows from the ship's own motion".to_string(),
        Kind::Actuator => "it follows from the history of the actuator".to_string(),
        Kind::Sensor => "no force: what the sensors report does not agree".to_string(),
    };
    if s.asymmetric_test.p < 1e-3 {
        words.push_str("; it breaks port-starboard symmetry or depends on heading");
    }
    words
}

/// A blocking fault of a channel in words.
fn title_of_fault(issue: &Issue) -> String {
    let what = match issue.fault {
        "sign_error" => "the sign",
        "axes_error" => "the axes",
        _ => "the unit",
    };
    format!("{what} of `{}`", issue.channel.map_or("the recordings", Channel::name))
}

/// What the audit of the recordings already shows to be wrong: a unit or a sign.
pub(in crate::diagnose) fn sensor_findings(admission: &Admission) -> Vec<Finding> {
    admission
        .issues
        .iter()
        .filter(|i| i.blocking())
        .map(|i| Finding {
            mechanism: i.fault.into(),
            title: title_of_fault(i),
            // The channels of a recording contradict one another: no further run could refute that.
            grade: Grade::Confirmed,
            kind: Kind::Sensor,
            confidence_set: vec![i.fault.into()],
            why: i.text.clone(),
            sessions: Vec::new(),
            by_session: false,
            statistic: 0.0,
            p: 0.0,
            equations: Equations::default(),
            windows: Vec::new(),
            region: None,
            signature: "no force: channels contradict each other by a factor that units or signs explain".into(),
            parameters: Vec::new(),
            change: None,
            held_out: None,
        })
        .collect()
}

/// A push with its windows; in few recordings one of two.
pub(in crate::diagnose) fn push_finding(push: &Push, location: &Location) -> Finding {
    let names = [("push.x", "N"), ("push.y", "N"), ("push.n", "N m")];
    let mut confidence_set = vec![PUSH.to_owned()];
    let mut why = "the same force acts in windows of time and not outside them, and no smooth law of the ship's state explains it"
        .to_owned();
    if PushTest::from(push).in_few_recordings() {
        confidence_set.push(GENERIC.into());
        why.push_str(
            "; in so few recordings it may also be the ship's own forces in a state that no other recording visits",
        );
    }
    Finding {
        mechanism: PUSH.into(),
        title: PUSH_TITLE.into(),
        // Other recordings, in which it does not act, can say nothing of it.
        grade: Grade::Suspected,
        kind: Kind::Environment,
        confidence_set,
        why,
        sessions: Vec::new(),
        by_session: false,
        statistic: push.statistic,
        p: push.windows.iter().map(|w| w.p).fold(1.0, f64::min),
        equations: location.equations.into(),
        windows: push.windows.clone(),
        region: None,
        signature: "limited in time".into(),
        parameters: (0..3)
            .map(|e| Amplitude::new(names[e].0.into(), push.force[e], names[e].1, push.error[e]))
            .collect(),
        change: None,
        held_out: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::evidence::locate::locate;
    use crate::diagnose::evidence::push::Window;
    use crate::diagnose::example::{RK4, at, candidate, model, noise, runs, with};

    #[test]
    fn runs_are_grouped_by_manoeuvre_where_there_are_enough_and_else_by_recording() {
        let mut runs = runs(&model(), 6);
        assert_eq!(kinds(&runs)[4], "run 4");
        for (r, name) in runs.iter_mut().zip(["turn", "zigzag", "stop", "pull-out", "spiral", "turn"]) {
            r.manoeuvre = name.into();
        }
        assert_eq!(kinds(&runs), ["turn", "zigzag", "stop", "pull-out", "spiral", "turn"]);
    }

    #[test]
    fn the_shares_of_a_force_weigh_the_moment_as_a_force_pair_at_a_quarter_of_the_length() {
        let found = at(&with(&[("earth_force.north", 3000.0), ("earth_force.east", 0.0)]));
        let runs = runs(&model(), 6);
        let location = locate(&found, RK4, &runs);
        let shares = force_shares(&candidate(&found.model, "earth_force"), &found, &runs, &location);
        assert!((shares.x.share + shares.y.share + shares.n.share - 1.0).abs() < 1e-12);
        // Turned with the heading, it is as large as it is.
        assert!((shares.x.rms.hypot(shares.y.rms) / 3000.0 - 1.0).abs() < 1e-6 && shares.n.share < 1e-9);
        assert_eq!(shares.y.sigma, noise().force[1]);
    }

    #[test]
    fn a_push_in_two_recordings_may_be_something_that_is_not_in_the_catalogue() {
        let location = locate(&at(&model()), RK4, &runs(&model(), 2));
        let window = |i: usize| Window {
            run: format!("run {i}"),
            session: "a".into(),
            start: 0.0,
            end: 30.0,
            force: [0.0; 3],
            error: [1.0; 3],
            statistic: 50.0,
            p: 0.1f64.powi(i as i32),
            index: i,
            samples: (0, 10),
        };
        let push = |count: usize| Push {
            force: [0.0, 1e4, 0.0],
            error: [1e2; 3],
            statistic: 300.0,
            sideways: 0.9,
            mirrored: 0.0,
            windows: (0..count).map(window).collect(),
        };
        let (two, three) = (push_finding(&push(2), &location), push_finding(&push(3), &location));
        assert_eq!(
            (two.confidence_set.as_slice(), three.confidence_set.len()),
            ([PUSH, GENERIC].map(String::from).as_slice(), 1)
        );
        assert!((three.p - 0.01).abs() < 1e-15 && three.parameters[1].ci95[1] > 1e4);
    }
}
