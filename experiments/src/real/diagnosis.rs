//! What the diagnosis experiments on real hulls share: runs with channels withheld, questions asked of a fitted frame, and tables.
//! The diagnosis itself is the library's; a witness that it never saw is compared here.

use super::{Hull, RealError};
use nalgebra::{DMatrix, DVector, Matrix2, Vector2};
use trimtab::audit::settled;
use trimtab::diagnose::admit::followed;
use trimtab::diagnose::conclude::Amplitude;
use trimtab::diagnose::estimate::{Effort, FreeParameter, base_of, estimate, evidence, passes, restrictions};
use trimtab::diagnose::evidence::Test;
use trimtab::diagnose::filter::Column;
use trimtab::diagnose::noise::{Noise, NoisePrior};
use trimtab::diagnose::prove::{HeldOut, prove};
use trimtab::diagnose::{Diagnosis, Settings, diagnose};
use trimtab::evaluate::Judging;
use trimtab::model::{Model, Prior};
use trimtab::recording::{Run, Split};
use trimtab::report::{Table, fixed, sig};
use trimtab::simulate::Integration;

/// The windows of one split as runs of the diagnosis.
///
/// # Errors
/// [`RealError::Study`].
pub fn runs(hull: &Hull, split: Split) -> Result<Vec<Run>, RealError> {
    hull.windows(split)
}

/// The runs as if no wind had been recorded.
pub fn without_wind(runs: &[Run]) -> Vec<Run> {
    let mut out = runs.to_vec();
    out.iter_mut().flat_map(|r| &mut r.inputs).for_each(|i| i.wind = [0.0; 2]);
    out
}

/// The model as if it had never had a term.
///
/// # Errors
/// [`RealError::Model`].
pub fn without_term(model: &Model, term: &str) -> Result<Model, RealError> {
    let mut file = model.to_file();
    file.terms.retain(|t| t != term);
    file.parameters.retain(|name, _| !name.starts_with(&format!("{term}.")));
    Ok(Model::from_file(&file, model.ship.clone())?)
}

/// One diagnosis and what was given to it.
pub struct Case {
    /// In words.
    pub name: String,
    /// What came of it.
    pub diagnosis: Diagnosis,
}

impl Case {
    /// Diagnoses.
    ///
    /// # Errors
    /// [`RealError::Model`].
    pub fn new(
        name: &str,
        model: &Model,
        train: &[Run],
        held_out: &[Run],
        settings: &Settings,
    ) -> Result<Self, RealError> {
        let progress = |step: &str| eprintln!("{name}: {step}");
        Ok(Self { name: name.into(), diagnosis: diagnose(model, train, held_out, settings, &progress)? })
    }
}

/// A row a finding, with what it did on held-out runs.
pub fn findings_table(cases: &[Case]) -> Table {
    let mut table = Table::new([
        "case",
        "verdict",
        "finding",
        "confidence set",
        "sessions",
        "statistic",
        "parameters (95 % interval)",
        "held-out cVDM before [%]",
        "after [%]",
        "improvement [%]",
        "95 % interval",
        "better / worse",
        "held-out log-likelihood gained",
    ]);
    for c in cases {
        let d = &c.diagnosis;
        let verdict = format!("{:?}", d.verdict);
        let held = d.held_out.as_ref().map_or_else(
            || vec![String::new(); 6],
            |h| {
                vec![
                    percent(h.before, 1.0),
                    percent(h.after, 1.0),
                    percent(h.improvement, 100.0),
                    interval(h.ci95),
                    format!("{} / {}", h.better, h.worse),
                    fixed(h.log_likelihood_gain, 0),
                ]
            },
        );
        let rows = d.findings.iter().map(|f| {
            let parameters: Vec<String> = f
                .parameters
                .iter()
                .map(|p| {
                    format!(
                        "{} {} ({} to {}) {}",
                        p.name,
                        sig(p.value, 3),
                        sig(p.ci95[0], 3),
                        sig(p.ci95[1], 3),
                        p.unit
                    )
                })
                .collect();
            [
                f.mechanism.clone(),
                f.confidence_set.join(" or "),
                if f.sessions.is_empty() { "all".into() } else { f.sessions.join(" and ") },
                fixed(f.statistic, 0),
                parameters.join("; "),
            ]
        });
        let rows: Vec<[String; 5]> = rows.collect();
        let none = [const { String::new() }; 5];
        for (i, row) in if rows.is_empty() { vec![none] } else { rows }.into_iter().enumerate() {
            let mut cells = vec![c.name.clone(), verdict.clone()];
            cells.extend(row);
            cells.extend(if i == 0 { held.clone() } else { vec![String::new(); 6] });
            table.row(cells);
        }
    }
    table
}

/// A row a case: whether the ship's own two sides differ, and by what.
pub fn sides_table(cases: &[Case]) -> Table {
    let mut table = Table::new([
        "case",
        "statistic",
        "degrees of freedom",
        "p",
        "parameters that differ between the sides (95 % interval)",
    ]);
    for c in cases {
        let Some(sides) = &c.diagnosis.sides else { continue };
        let one = |a: &Amplitude| {
            format!("{} {} ({} to {}) {}", a.name, sig(a.value, 2), sig(a.ci95[0], 2), sig(a.ci95[1], 2), a.unit)
        };
        table.row([
            c.name.clone(),
            fixed(sides.statistic, 1),
            sides.degrees.to_string(),
            sig(sides.p, 2),
            sides.parameters.iter().map(one).collect::<Vec<_>>().join("; "),
        ]);
    }
    table
}

/// A model with parameters, priors and noise as a diagnosis left them, for questions of one's own.
pub struct Frame {
    /// The refitted base model, with every term of the catalogue at its neutral values.
    pub model: Model,
    /// The base parameters and the nuisances with their priors.
    pub free: Vec<FreeParameter>,
    /// Noise under the base model.
    pub noise: Noise,
    /// Integration.
    pub integration: Integration,
}

/// A question asked of a frame: what further parameters come to, and how much they explain.
pub struct Answer {
    /// Their amplitudes, covariance and significance once every parameter of the base has had its say, as in the screen of the
    /// diagnosis; in the parameters' units.
    pub test: Test,
    /// The model with them fitted on top of the base.
    pub model: Model,
}

impl Frame {
    /// The frame of a diagnosis.
    ///
    /// # Errors
    /// [`RealError::Model`].
    pub fn new(diagnosis: &Diagnosis) -> Result<Self, RealError> {
        let model = diagnosis.base.complete()?;
        let mut frame = Self {
            free: Vec::new(),
            noise: diagnosis.noise_before,
            integration: diagnosis.admission.integration,
            model,
        };
        for i in frame.model.free() {
            frame.free.push(FreeParameter::common(frame.column(i), frame.model.parameters[i].prior));
        }
        for b in &diagnosis.hull_budget {
            if let Some(i) = frame.model.index(&b.name).filter(|i| !frame.model.parameters[*i].free) {
                frame.free.push(FreeParameter::common(frame.column(i), Some(Prior { mean: b.prior, sd: b.sd })));
            }
        }
        Ok(frame)
    }

    fn column(&self, parameter: usize) -> Column {
        Column::tangent(&self.model, parameter)
    }

    /// Free parameters of these names, in all runs or with a value of its own in each session.
    ///
    /// # Errors
    /// [`RealError::Model`] when the model has no such parameter.
    pub fn parameters(&self, names: &[&str], sessions: Option<&[String]>) -> Result<Vec<FreeParameter>, RealError> {
        let mut out = Vec::new();
        for session in sessions.map_or_else(|| vec![None], |s| s.iter().map(|s| Some(vec![s.clone()])).collect()) {
            for name in names {
                let column = self.column(self.model.find(name)?);
                out.push(FreeParameter { column, sessions: session.clone(), prior: None });
            }
        }
        Ok(out)
    }

    /// The runs without what the diagnosis leaves out, judged without the wind: jumps of the position, and stretches in which
    /// the model loses the ship.
    pub fn followed(&self, runs: &[Run]) -> Vec<Run> {
        let (mut out, _) = settled(runs, self.model.ship.hull.lpp);
        loop {
            let at = passes(&self.model, self.integration, &[], &without_wind(&out), &self.noise, false);
            match followed(&out, &at) {
                (Some(kept), _) => out = kept,
                (None, _) => return out,
            }
        }
    }

    /// Asks what further parameters explain.
    ///
    /// The test is algebra on scores and information at the base, in which parameters of the base move along; the model is
    /// for the proof, and has the further parameters fitted with the base held.
    pub fn ask(&self, runs: &[Run], further: &[FreeParameter]) -> Answer {
        self.ask_on(&self.model, runs, further)
    }

    /// The same, starting from a model that already holds an answer.
    pub fn ask_on(&self, model: &Model, runs: &[Run], further: &[FreeParameter]) -> Answer {
        let free = [self.free.clone(), further.to_vec()].concat();
        let columns: Vec<Column> = free.iter().map(|f| f.column).collect();
        let passes = passes(model, self.integration, &columns, runs, &self.noise, false);
        let evidence = evidence(runs, &passes, &restrictions(&free));
        let asked: Vec<usize> = (self.free.len()..free.len()).collect();
        let mut test = evidence.test(&base_of(&evidence, model, &self.free), &asked);
        let scale = |i: usize| further[i].column.scale;
        test.amplitude = DVector::from_fn(further.len(), |i, _| test.amplitude[i] * scale(i));
        test.covariance =
            DMatrix::from_fn(further.len(), further.len(), |i, j| test.covariance[(i, j)] * scale(i) * scale(j));
        let effort = Effort { rounds: 6, noise_rounds: 0, noise_iterations: 0, noise_runs: 1 };
        let prior = NoisePrior::around(&self.noise);
        let found = estimate(model, self.integration, runs, further, &self.noise, &prior, effort);
        Answer { test, model: found.model }
    }

    /// One model against another on held-out runs.
    pub fn prove(&self, before: &Model, after: &Model, held_out: &[Run]) -> HeldOut {
        let judging = Judging { integration: self.integration, ..Settings::default().judging };
        prove((before, &self.noise), (after, &self.noise), None, self.integration, held_out, &judging)
    }

    /// A question with its proof.
    pub fn step(&self, name: &str, before: &Model, answer: &Answer, held_out: &[Run]) -> Step {
        let t = &answer.test;
        Step {
            name: name.into(),
            gain: (t.statistic, t.degrees, t.p),
            held_out: self.prove(before, &answer.model, held_out),
        }
    }
}

impl Answer {
    /// Value and standard error of the first parameter asked for.
    pub fn first(&self) -> (f64, f64) {
        (self.test.amplitude[0], self.test.covariance[(0, 0)].max(0.0).sqrt())
    }
}

/// A number of a proof, times a factor; blank where there is none.
fn percent(value: Option<f64>, factor: f64) -> String {
    value.map_or_else(String::new, |v| fixed(factor * v, 1))
}

/// The interval of a share, in per cent.
fn interval(ci95: Option<[f64; 2]>) -> String {
    ci95.map_or_else(String::new, |[low, high]| format!("[{}, {}]", fixed(100.0 * low, 1), fixed(100.0 * high, 1)))
}

/// Sessions of runs, in their order.
pub fn sessions(runs: &[Run]) -> Vec<String> {
    let mut out: Vec<String> = Vec::new();
    for r in runs {
        if !out.contains(&r.session) {
            out.push(r.session.clone());
        }
    }
    out
}

/// The runs with each recording a session of its own.
pub fn by_recording(runs: &[Run]) -> Vec<Run> {
    runs.iter().map(|r| Run { session: r.recording.clone(), ..r.clone() }).collect()
}

/// An earth-fixed force in one session, beside what the anemometer recorded.
#[derive(Clone, Debug)]
pub struct Pull {
    /// The session.
    pub session: String,
    /// What was sailed in it.
    pub manoeuvre: String,
    /// Force towards north and east \[N\].
    pub force: [f64; 2],
    /// Its covariance \[N2\].
    pub covariance: Matrix2<f64>,
    /// Mean of the recorded wind, (north, east) of where it blows to \[m/s\].
    pub wind: [f64; 2],
}

impl Pull {
    /// Direction it acts to \[rad\], clockwise from north, with the half width of its 95 % interval.
    pub fn direction(&self) -> (f64, f64) {
        let f = Vector2::from(self.force);
        let size = f.norm().max(f64::MIN_POSITIVE);
        let across = Vector2::new(-f.y, f.x) / size;
        let sd = (across.transpose() * self.covariance * across)[(0, 0)].max(0.0).sqrt();
        (f.y.atan2(f.x), (1.96 * sd).atan2(size))
    }

    /// Size of the force with its standard error \[N\].
    pub fn size(&self) -> (f64, f64) {
        let f = Vector2::from(self.force);
        let along = f / f.norm().max(f64::MIN_POSITIVE);
        (f.norm(), (along.transpose() * self.covariance * along)[(0, 0)].max(0.0).sqrt())
    }

    /// Direction to which the wind blew \[rad\] and the size of its mean \[m/s\].
    pub fn wind_direction(&self) -> (f64, f64) {
        (self.wind[1].atan2(self.wind[0]), self.wind[0].hypot(self.wind[1]))
    }

    /// Direction of the force less that of the wind \[rad\], in (-pi, pi].
    pub fn turned(&self) -> f64 {
        let d = self.direction().0 - self.wind_direction().0;
        d.sin().atan2(d.cos())
    }
}

/// The forces of an answer about `earth_force.north` and `.east` of each session of the runs. `witness` are those runs with the
/// wind as recorded, from which nothing but the comparison is taken.
pub fn pulls(answer: &Answer, witness: &[Run]) -> Vec<Pull> {
    let names = sessions(witness);
    let (value, covariance) = (&answer.test.amplitude, &answer.test.covariance);
    names
        .into_iter()
        .enumerate()
        .map(|(s, session)| {
            let i = 2 * s;
            let of = || witness.iter().filter(|r| r.session == session);
            let winds = || of().flat_map(|r| &r.inputs);
            let count = winds().count().max(1) as f64;
            let mut manoeuvres: Vec<&str> = of().map(|r| r.manoeuvre.as_str()).collect();
            manoeuvres.sort_unstable();
            manoeuvres.dedup();
            Pull {
                manoeuvre: manoeuvres.join(" and "),
                force: [value[i], value[i + 1]],
                covariance: covariance.fixed_view::<2, 2>(i, i).into_owned(),
                wind: [0, 1].map(|c| winds().map(|w| w.wind[c]).sum::<f64>() / count),
                session,
            }
        })
        .collect()
}

/// A row a session.
pub fn pulls_table(pulls: &[Pull]) -> Table {
    let mut table = Table::new([
        "session",
        "manoeuvre",
        "force [N]",
        "standard error [N]",
        "towards [deg]",
        "95 % interval, half width [deg]",
        "mean wind [m/s]",
        "blowing to [deg]",
        "difference [deg]",
    ]);
    for p in pulls {
        let ((to, half), (size, error), (blows, speed)) = (p.direction(), p.size(), p.wind_direction());
        table.row([
            p.session.clone(),
            p.manoeuvre.clone(),
            fixed(size, 3),
            fixed(error, 3),
            fixed(to.to_degrees(), 0),
            fixed(half.to_degrees(), 0),
            fixed(speed, 2),
            fixed(blows.to_degrees(), 0),
            fixed(p.turned().to_degrees(), 0),
        ]);
    }
    table
}

/// One question asked of a frame: what was added to what, what it gained, and what that is worth on unseen runs.
pub struct Step {
    /// In words.
    pub name: String,
    /// Twice the gain in log-likelihood that the scores promise, degrees of freedom, p.
    pub gain: (f64, usize, f64),
    /// On held-out runs.
    pub held_out: HeldOut,
}

/// A row a step.
pub fn steps_table(steps: &[Step]) -> Table {
    let mut table = Table::new([
        "step",
        "statistic (twice the gain in log-likelihood)",
        "degrees of freedom",
        "p",
        "held-out runs",
        "median cVDM before [%]",
        "after [%]",
        "improvement [%]",
        "95 % interval",
        "better / worse",
        "held-out log-likelihood gained",
    ]);
    for s in steps {
        let (gain, degrees, p) = s.gain;
        let h = &s.held_out;
        table.row([
            s.name.clone(),
            fixed(gain, 0),
            degrees.to_string(),
            if p < 1e-12 { "< 1e-12".into() } else { sig(p, 2) },
            h.runs.to_string(),
            percent(h.before, 1.0),
            percent(h.after, 1.0),
            percent(h.improvement, 100.0),
            interval(h.ci95),
            format!("{} / {}", h.better, h.worse),
            fixed(h.log_likelihood_gain, 0),
        ]);
    }
    table
}
