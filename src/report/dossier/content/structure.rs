//! The structure of a model: its terms with equation, source and range of validity beside what the recordings visit, and its parameters.
//! How far a range is left is counted in `validity`; nothing is concluded from it here.

use crate::model::Model;
use crate::physics::{Form, Group};
use crate::recording::Run;
use crate::uncertainty::Uncertainty;
use crate::validity::{Count, Coverage, Visit, samples};
use serde::Serialize;

/// A term of the model.
#[derive(Clone, Debug, Serialize)]
pub struct TermPart {
    /// Name.
    pub name: &'static str,
    /// Plain words.
    pub title: &'static str,
    /// The part of the simulator it belongs to.
    pub group: Group,
    /// Its equation.
    pub equation: &'static str,
    /// Its source.
    pub source: &'static str,
    /// Its ranges beside what the recordings visit; empty for a law without one.
    pub ranges: Vec<Visit>,
    /// Where the ranges are from, or why there are none.
    pub range_source: &'static str,
}

/// A parameter that a fit or a diagnosis may move, or that is unlike the term's default.
#[derive(Clone, Debug, Serialize)]
pub struct Parameter {
    /// Dotted name.
    pub name: String,
    /// Value.
    pub value: f64,
    /// SI unit; `-` for none.
    pub unit: &'static str,
    /// Standard error; absent where the model file has no covariance for it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<f64>,
    /// Whether it is free.
    pub free: bool,
}

/// Structure of the model.
#[derive(Clone, Debug, Serialize)]
pub struct Structure {
    /// Name of the model.
    pub name: String,
    /// Form of hull and resistance.
    pub form: Form,
    /// The terms.
    pub terms: Vec<TermPart>,
    /// The free parameters, and those with a standard error.
    pub parameters: Vec<Parameter>,
    /// What the covariance is, in words; absent without one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub covariance: Option<String>,
    /// Free parameters that the data do not determine.
    pub undetermined: Vec<String>,
    /// How much of the recordings lies outside a range.
    pub validity: Coverage,
}

impl Structure {
    /// The structure of a model beside the recordings of a study.
    pub(super) fn new(model: &Model, uncertainty: Option<&Uncertainty>, runs: &[Run]) -> Self {
        let mut count = Count::new(model);
        count.add(runs.iter().flat_map(samples));
        let visits = count.visits();
        let term = |info: &'static crate::physics::TermInfo| TermPart {
            name: info.name,
            title: info.title,
            group: info.group,
            equation: info.equation,
            source: info.source,
            ranges: visits.iter().filter(|v| v.term == info.name).cloned().collect(),
            range_source: info.validity.source,
        };
        let error = |name: &str| {
            let u = uncertainty?;
            let i = u.parameters.iter().position(|p| p == name)?;
            Some(u.matrix[i][i].sqrt()).filter(|e| e.is_finite())
        };
        let parameter = |p: &crate::model::Parameter| Parameter {
            name: p.name.clone(),
            value: p.reported(p.value),
            unit: p.info.unit,
            error: error(&p.name),
            free: p.free,
        };
        Self {
            name: model.name.clone(),
            form: model.form,
            terms: model.terms().map(term).collect(),
            parameters: model.parameters.iter().map(parameter).filter(|p| p.free || p.error.is_some()).collect(),
            covariance: uncertainty.map(|u| u.kind.clone()),
            undetermined: uncertainty.map_or_else(Vec::new, |u| u.undetermined.clone()),
            validity: count.coverage(),
        }
    }
}
