//! A law for what is not in the catalogue: a few monomials of speeds, rates, inputs and heading, refitted, and proved on unseen runs.
//! It describes a force where it was recorded and is no physics: it names no cause.

use super::monomial::Monomial;
use super::sparse::select;
use crate::diagnose::proof::grade::LawGrade;
use crate::diagnose::proof::unseen::FindingProof;
use crate::diagnose::search::base::Question;
use crate::diagnose::search::event::BaseTests;
use crate::diagnose::settings::SETTLE;
use crate::likelihood::estimate::{Estimate, FreeParameter, Sums, base_of, restrictions};
use crate::likelihood::filter::{Column, Filter};
use crate::numerals::sig;
use crate::parameter::Parity;
use crate::recording::Run;
use crate::statistics::{corrected, student_p};
use serde::Serialize;

/// One monomial of a law with its coefficient.
#[derive(Clone, Debug, Serialize)]
pub struct LawTerm {
    /// Dotted name of its parameter, as in model files.
    pub name: String,
    /// The equation it is in: `X`, `Y` or `N`.
    pub axis: char,
    /// The monomial, `v|v|`; `1` for a constant.
    pub symbol: String,
    /// Coefficient.
    pub value: f64,
    /// Its SI unit.
    pub unit: String,
    /// Standard error, by the scatter between recordings where that is larger than the information says.
    pub error: f64,
    /// 95 % interval, by Student's t.
    pub ci95: [f64; 2],
    /// p-value by the same error and t, corrected for the size of the library.
    pub p: f64,
    /// `even` for a force that is mirrored with the motion, `odd` for one that is not.
    pub mirror: &'static str,
}

impl LawTerm {
    /// Whether the interval excludes zero.
    fn excludes_zero(&self) -> bool {
        self.ci95[0] > 0.0 || self.ci95[1] < 0.0
    }
}

/// The values of a state or an input in the recordings that a law was fitted to.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Visited {
    /// Its symbol.
    pub symbol: &'static str,
    /// SI unit.
    pub unit: &'static str,
    /// Least value.
    pub low: f64,
    /// Greatest value.
    pub high: f64,
}

/// A force law for what is not in the catalogue.
#[derive(Clone, Debug, Serialize)]
pub struct Law {
    /// How well it is supported.
    pub grade: LawGrade,
    /// One line a force or moment.
    pub equation: Vec<String>,
    /// Its monomials.
    pub terms: Vec<LawTerm>,
    /// Where the recordings were: the law is valid there and nowhere else.
    pub range: Vec<Visited>,
    /// The base model without it (before) and with it (after), each refitted, on unseen runs.
    pub held_out: Option<FindingProof>,
    /// The base model with it, refitted.
    #[serde(skip)]
    pub estimate: Estimate,
}

impl Law {
    /// The law that the base model lacks, of the monomials of the generic force law; `None` where no monomial is worth its price. The
    /// base model is refitted with the coefficients free, and one whose interval then contains zero is left out again.
    pub fn new(question: &Question, tests: &BaseTests, held_out: &[Run]) -> Option<Self> {
        (question.progress)("seeking a law for what is not in the catalogue");
        let (fit, screen) = (&tests.fit, &tests.screen);
        let library = screen.law.columns();
        let chosen = select(&screen.evidence, &screen.base, &library, &recordings(&fit.runs));
        let mut names: Vec<&str> = chosen.iter().filter_map(|c| screen.law.name(*c)).collect();
        let (estimate, terms) = loop {
            if names.is_empty() {
                return None;
            }
            let base = &fit.estimate;
            let column = |name: &&str| Some(Column::tangent(&base.model, base.model.index(name)?));
            let law = names.iter().filter_map(column).map(|c| FreeParameter::common(c, None));
            let free: Vec<FreeParameter> = base.free.iter().cloned().chain(law).collect();
            let found = tests.problem(question.settings).estimate(&base.model, &free, &base.noise, SETTLE);
            let terms = terms(&found, base.free.len(), library.len(), tests);
            let doubtful = terms.iter().enumerate().filter(|(_, t)| !t.excludes_zero());
            let Some((weakest, _)) = doubtful.max_by(|a, b| a.1.p.total_cmp(&b.1.p)) else { break (found, terms) };
            names.remove(weakest);
        };
        let proof = (!held_out.is_empty()).then(|| {
            let (before, after) = (&fit.estimate.model, &estimate.model);
            let judging = &question.settings.judging;
            FindingProof::new(before, after, &estimate.noise, fit.integration, held_out, judging)
        });
        let gains =
            (proof.as_ref().and_then(FindingProof::likelihood), proof.as_ref().and_then(FindingProof::prediction));
        let grade = LawGrade::new(gains.0, gains.1);
        Some(Self { grade, equation: equation(&terms), terms, range: Vec::new(), held_out: proof, estimate })
    }

    /// Whether a quantity is in one of its monomials.
    pub fn uses(&self, symbol: &str) -> bool {
        self.terms.iter().any(|t| t.symbol.split([' ', '|', '^']).any(|s| s == symbol))
    }

    /// Whether unseen runs confirm it, so that it may enter the improved model.
    pub fn is_confirmed(&self) -> bool {
        self.grade == LawGrade::Confirmed
    }

    /// The law with the values of states and inputs in the recordings: states `[x, y, psi, u, v, r]`, and propeller rate and rudder angle.
    pub fn over<'a>(self, samples: impl Iterator<Item = (&'a [f64; 6], &'a [f64; 2])> + Clone) -> Self {
        let quantities: [(&'static str, &'static str, fn(&[f64; 6], &[f64; 2]) -> f64); 5] = [
            ("u", "m/s", |s, _| s[3]),
            ("v", "m/s", |s, _| s[4]),
            ("r", "rad/s", |s, _| s[5]),
            ("n", "1/s", |_, i| i[0]),
            ("delta", "rad", |_, i| i[1]),
        ];
        let visited = |(symbol, unit, of): (&'static str, &'static str, fn(&[f64; 6], &[f64; 2]) -> f64)| {
            let values = samples.clone().map(|(state, inputs)| of(state, inputs)).filter(|v| v.is_finite());
            let (low, high) =
                values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
            (low <= high).then_some(Visited { symbol, unit, low, high })
        };
        let range = quantities.into_iter().filter_map(visited).collect();
        Self { range, ..self }
    }
}

/// The recording of each run. Scores may scatter more between recordings than their information says; gains on unseen runs are weighed over
/// recordings too.
fn recordings(runs: &[Run]) -> Vec<&str> {
    runs.iter().map(|r| r.recording.as_str()).collect()
}

/// The monomials of a refitted law, the free parameters after the first `base`, chosen of so many.
fn terms(found: &Estimate, base: usize, library: usize, tests: &BaseTests) -> Vec<LawTerm> {
    let runs = &tests.fit.runs;
    let columns: Vec<Column> = found.free.iter().map(|f| f.column).collect();
    let filter = Filter::new(&found.model, tests.fit.integration, &columns);
    let evidence = Sums::of(&filter, runs, &found.noise, &restrictions(&found.free), false).evidence;
    let fitted = base_of(&evidence, &found.model, &found.free);
    let scatter = evidence.scatter(&fitted, &recordings(runs), &[]);
    let term = |i: usize| {
        let parameter = &found.model.parameters[columns[i].parameter];
        let monomial = Monomial::new(parameter, &found.model.ship)?;
        let error = fitted.inverse[(i, i)].max(0.0).sqrt() * scatter.factors[i] * columns[i].scale * monomial.factor;
        let value = parameter.value * monomial.factor;
        let reach = scatter.reach(i) * error;
        Some(LawTerm {
            name: parameter.name.clone(),
            axis: monomial.axis,
            symbol: if monomial.symbol.is_empty() { "1".into() } else { monomial.symbol },
            value,
            unit: monomial.unit,
            error,
            ci95: [value - reach, value + reach],
            p: corrected(student_p(value / error, scatter.degrees[i]), library as f64),
            mirror: if parameter.info.parity == Parity::Odd { "odd" } else { "even" },
        })
    };
    (base..found.free.len()).filter_map(term).collect()
}

/// A line a force or moment, with three digits a coefficient: `Y [N] = 3230 v|v| - 12000 sin psi`.
fn equation(terms: &[LawTerm]) -> Vec<String> {
    let line = |(axis, unit): (char, &str)| {
        let mut sum = String::new();
        for t in terms.iter().filter(|t| t.axis == axis) {
            sum += match (sum.is_empty(), t.value < 0.0) {
                (true, false) => "",
                (true, true) => "-",
                (false, false) => " + ",
                (false, true) => " - ",
            };
            sum += &sig(t.value.abs(), 3);
            if t.symbol != "1" {
                sum += &format!(" {}", t.symbol);
            }
        }
        (!sum.is_empty()).then(|| format!("{axis} [{unit}] = {sum}"))
    };
    [('X', "N"), ('Y', "N"), ('N', "N m")].into_iter().filter_map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example;

    fn term(axis: char, symbol: &str, value: f64) -> LawTerm {
        LawTerm {
            name: format!("symmetric.{axis}"),
            axis,
            symbol: symbol.into(),
            value,
            unit: "N".into(),
            error: 1.0,
            ci95: [value - 2.0, value + 2.0],
            p: 1e-9,
            mirror: "even",
        }
    }

    fn law(terms: Vec<LawTerm>) -> Law {
        let estimate = example::at(&example::model());
        Law {
            grade: LawGrade::Exploratory,
            equation: equation(&terms),
            terms,
            range: Vec::new(),
            held_out: None,
            estimate,
        }
    }

    #[test]
    fn a_law_is_one_line_a_force_with_signs_between_its_monomials() {
        let terms = vec![
            term('Y', "v|v|", 3234.0),
            term('Y', "sin psi", -12_345.0),
            term('N', "1", -3.0e7),
            term('Y', "1", 7.0),
        ];
        assert_eq!(law(terms).equation, ["Y [N] = 3230 v|v| - 12300 sin psi + 7.00", "N [N m] = -3.00e7"]);
        assert!(equation(&[]).is_empty());
    }

    #[test]
    fn the_range_of_a_law_is_that_of_the_recordings() {
        let states =
            [[0.0, 0.0, 1.0, 4.0, -0.5, 0.01], [9.0, 9.0, 2.0, 5.0, f64::NAN, 0.02], [0.0, 0.0, 1.0, -1.0, 0.7, 0.0]];
        let inputs = [[2.0, 0.1], [2.5, -0.3], [1.0, 0.2]];
        let law = law(vec![term('Y', "|v| r", 1.0), term('N', "delta^2 W", 2.0)]).over(states.iter().zip(&inputs));
        let range = |symbol, unit, low, high| Visited { symbol, unit, low, high };
        assert_eq!(
            law.range,
            [
                range("u", "m/s", -1.0, 5.0),
                range("v", "m/s", -0.5, 0.7),
                range("r", "rad/s", 0.0, 0.02),
                range("n", "1/s", 1.0, 2.5),
                range("delta", "rad", -0.3, 0.2)
            ]
        );
        assert!(law.uses("v") && law.uses("delta") && !law.uses("u") && !law.uses("n"));
        assert!(term('X', "1", 3.0).excludes_zero() && !term('X', "1", -1.0).excludes_zero());
    }
}
