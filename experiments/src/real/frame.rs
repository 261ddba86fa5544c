//! Questions asked of a finished diagnosis: further parameters, tested with those of the base profiled out, and proved on held-out
//! runs. It is no diagnosis: nothing is screened or named.

use nalgebra::{DMatrix, DVector};
use trimtab::diagnose::evidence::admit::followed;
use trimtab::diagnose::proof::prove::{HeldOut, prove};
use trimtab::diagnose::{Diagnosis, Settings};
use trimtab::evaluate::Judging;
use trimtab::likelihood::estimate::{Effort, FreeParameter, base_of, estimate, evidence, passes, restrictions};
use trimtab::likelihood::evidence::Test;
use trimtab::likelihood::filter::Column;
use trimtab::likelihood::noise::{Noise, NoisePrior};
use trimtab::model::{Model, Prior};
use trimtab::numbers::numerals::{fixed, sig};
use trimtab::recording::Run;
use trimtab::recording::audit::settled;
use trimtab::report::Table;
use trimtab::simulate::Integration;

use super::case::held_out_columns;
use super::error::RealError;
use super::runs::without_wind;

/// The model, parameters, priors and noise of a finished diagnosis, of which further questions are asked.
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

/// The answer to a question: the estimates of further parameters, and how much they explain.
pub struct Answer {
    /// Their amplitudes, covariance and significance with every parameter of the base profiled out, as in the screen of the
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

    /// The runs without the samples that the diagnosis leaves out (after jumps of the position, and where the model does not
    /// follow the ship), as decided without the wind.
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

    /// Asks how much further parameters explain.
    ///
    /// The test is algebra on scores and information at the base, in which parameters of the base move along; the model is
    /// for the proof, and has the further parameters fitted with the base fixed.
    pub fn ask(&self, runs: &[Run], further: &[FreeParameter]) -> Answer {
        self.ask_on(&self.model, runs, further)
    }

    /// [`Frame::ask`] from a model that already contains an answer.
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
        let effort = Effort { rounds: 6, noise_rounds: 0, noise_iterations: 0 };
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

/// A question asked of a frame: the parameters added, their gain, and its value on unseen runs.
pub struct Step {
    /// The question, in words.
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
        "mean cVDM before [%]",
        "after [%]",
        "improvement [%]",
        "95 % interval",
        "better / worse",
        "held-out log-likelihood gained",
    ]);
    for s in steps {
        let (gain, degrees, p) = s.gain;
        let h = &s.held_out;
        let start = [
            s.name.clone(),
            fixed(gain, 0),
            degrees.to_string(),
            if p < 1e-12 { "< 1e-12".into() } else { sig(p, 2) },
            h.runs.to_string(),
        ];
        table.row(start.into_iter().chain(held_out_columns(h)));
    }
    table
}
