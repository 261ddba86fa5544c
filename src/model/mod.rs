//! A model: a ship, a list of terms, and one vector of parameters; from these the equations of motion.
//! It contains no recording and no cost: it only gives the accelerations of the ship.

mod by_name;
pub mod dynamics;
pub mod export;

use crate::files::intact;
use crate::files::suggestion;
use crate::files::written::{Kind, joined, line_at, read_text, read_toml};
use crate::parameter::{ParameterInfo, Start};
use crate::physics::{Adjust, AnyTerm, Catalogue, Form, Group, Inertia, Number, TermInfo};
use crate::ship::{COEFFICIENTS, Ship};
use crate::state::Inputs;
use crate::terms;
use crate::terms::propulsion::actuator::ActuatorTerm;
use crate::uncertainty::Uncertainty;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Terms that every model has, in this order.
pub const BASE: [&str; 5] = ["flow", "hull", "resistance", "propeller", "rudder"];

/// Terms that a model of form `mmg` has beyond those, in this order.
pub const MMG: [&str; 3] = ["mmg_hull", "mmg_wake", "mmg_rudder"];

/// Terms that a model of form `general` has beyond those.
pub const GENERAL: [&str; 1] = ["general_hull"];

/// Dotted names of the paper's eleven parameters, p0 to p10.
pub const ELEVEN: [&str; 11] = [
    "propeller.side_force",
    "resistance.linear",
    "resistance.quadratic",
    "resistance.cubic",
    "rudder.lift0",
    "rudder.lift1",
    "rudder.lift2",
    "rudder.lift3",
    "rudder.drag0",
    "rudder.drag1",
    "rudder.drag2",
];

/// Largest value of a parameter as a multiple of its scale, the size of a relevant change: no ship's is near it.
const LARGEST_VALUE: f64 = 1e9;

/// Why a model could not be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ModelError {
    /// The file could not be opened.
    #[error(
        "{path}: cannot read the model file ({source}); check the path: --model, or `model` or `baseline` in the study"
    )]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The file is not TOML of the expected shape.
    #[error("{path}:{line}: {message}")]
    Parse {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// What is wrong.
        message: String,
    },
    /// A term that is not in the catalogue.
    #[error("unknown term `{name}`{suggestion}; `trimtab terms` lists them")]
    UnknownTerm {
        /// The name found.
        name: String,
        /// A near name, as part of a sentence.
        suggestion: String,
    },
    /// A parameter that no term of the model has.
    #[error("unknown parameter `{name}`{suggestion}; `trimtab terms` lists the parameters of each term")]
    UnknownParameter {
        /// The name found.
        name: String,
        /// A near name, as part of a sentence.
        suggestion: String,
    },
    /// A parameter of a term that the model does not have.
    #[error(
        "parameter `{name}` belongs to the term `{term}`, which the model does not have; add it: terms = [\"{term}\"]"
    )]
    AbsentTerm {
        /// The name found.
        name: String,
        /// The term.
        term: String,
    },
    /// A parameter that is set twice, by its name and by its symbol.
    #[error("parameter `{name}` is set twice, by its name and by its symbol; keep one of them")]
    SetTwice {
        /// Dotted name.
        name: String,
    },
    /// The parameters of another ship.
    #[error("{0}")]
    OtherShip(OtherShip),
    /// Several of these.
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
    Several(Vec<ModelError>),
    /// A parameter in the ship file that no term of the catalogue has.
    #[error(
        "the ship file sets `{name}`, which no term has{suggestion}; `trimtab terms` lists the parameters of each term"
    )]
    ShipParameter {
        /// The name found.
        name: String,
        /// A near name, as part of a sentence.
        suggestion: String,
    },
    /// An impossible value of a parameter.
    #[error("parameter `{name}` = {value}: {expected}")]
    BadValue {
        /// Dotted name.
        name: String,
        /// Value found.
        value: f64,
        /// What it should be.
        expected: String,
    },
    /// A covariance that does not belong to the model.
    #[error("{0}; fit the model again, or remove the table")]
    Covariance(String),
    /// An actuator with the name of a term.
    #[error(
        "the actuator `{name}` of the ship file has the name of a term of trimtab, and their parameters would have the same names; give it another name"
    )]
    ActuatorName {
        /// The name.
        name: String,
    },
    /// The sway-yaw mass matrix cannot be inverted.
    #[error(
        "the sway-yaw mass matrix is singular or negative (determinant {determinant:.3e}); check hull.mass, hull.inertia, hull.x_g and the added masses hull.Yvdot, hull.Yrdot, hull.Nvdot, hull.Nrdot (negative values)"
    )]
    SingularMass {
        /// Its determinant.
        determinant: f64,
    },
}

/// A model that was fitted to another ship than that with which it is to be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "the parameters are those of {}, L = {} m, and the ship here, {}, has L = {} m; use the ship file of the fit, or fit the model to this ship",
    fitted.name, fitted.lpp, here.name, here.lpp
)]
pub struct OtherShip {
    /// The ship of the parameters.
    pub fitted: FittedShip,
    /// The ship with which they are to be used.
    pub here: FittedShip,
}

/// The ship to which the parameters of a model file belong: what distinguishes it from another.
#[derive(Clone, Debug, Serialize, Deserialize, PartialEq, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FittedShip {
    /// Its name, for messages.
    pub name: String,
    /// Its length between perpendiculars \[m\].
    pub lpp: f64,
}

impl FittedShip {
    /// Share by which two lengths of one ship may differ: they are written with three digits or more.
    const SAME: f64 = 2e-3;

    fn of(ship: &Ship) -> Self {
        Self { name: ship.name.clone(), lpp: ship.hull.lpp }
    }

    /// Whether this is the ship, by its length.
    fn is(&self, ship: &Ship) -> bool {
        (self.lpp - ship.hull.lpp).abs() <= Self::SAME * ship.hull.lpp
    }
}

/// A prior on a parameter: what is known of it before the data.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, PartialEq, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Prior {
    /// Mean \[unit of the parameter\].
    pub mean: f64,
    /// Standard deviation \[unit of the parameter\].
    pub sd: f64,
}

/// One parameter of a model: its description, its value, and whether a fit may change it.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Dotted name, `term.parameter`.
    pub name: String,
    /// Its description in the catalogue.
    pub info: &'static ParameterInfo,
    /// Its value.
    pub value: f64,
    /// Whether a fit may change it.
    pub free: bool,
    /// Lower bound for the fit.
    pub lower: f64,
    /// Upper bound for the fit.
    pub upper: f64,
    /// Prior for the fit.
    pub prior: Option<Prior>,
    /// Size of a relevant change: the solver's unit for it.
    pub scale: f64,
}

impl Parameter {
    /// A value, an error or an end of an interval of this parameter as it is reported: what is a billionth of its scale or less, the
    /// rounding that an active constraint leaves, is zero.
    pub fn reported(&self, value: f64) -> f64 {
        if value.abs() <= 1e-9 * self.scale { 0.0 } else { value }
    }
}

/// A term and the part of the parameter vector that belongs to it.
#[derive(Clone, Copy)]
pub struct Placed {
    /// The term.
    pub term: &'static dyn AnyTerm,
    /// Index of its first parameter.
    pub offset: usize,
    /// How many parameters it has.
    pub len: usize,
    /// How many parameters before its own it reads ([`Term::before`](crate::physics::Term::before)).
    pub before: usize,
}

impl Placed {
    /// What the term reads of a parameter vector: its own part, behind what it reads of the terms before it.
    #[inline]
    pub fn part<'a, C>(&self, theta: &'a [C]) -> &'a [C] {
        &theta[self.offset - self.before..self.offset + self.len]
    }
}

/// A manoeuvring model of one ship.
#[derive(Clone)]
pub struct Model {
    /// Name, for headings.
    pub name: String,
    /// The ship.
    pub ship: Ship,
    /// Low-speed form of hull and resistance.
    pub form: Form,
    /// The parameters, in the order of the terms.
    pub parameters: Vec<Parameter>,
    /// Values added to parameters in runs of one session: session name to (parameter index, addition).
    pub sessions: BTreeMap<String, Vec<(usize, f64)>>,
    catalogue: Catalogue,
    terms: Vec<Placed>,
}

impl std::fmt::Debug for Model {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Model").field("name", &self.name).field("terms", &self.term_names()).finish_non_exhaustive()
    }
}

/// A model file: terms and parameter settings; every other value comes from the terms and the ship.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModelFile {
    /// Name, for headings.
    pub name: String,
    /// Form of the hull: `paper` or `regular`, which differ at low speed and astern, or `mmg`, the standard MMG method with published
    /// primes (`mmg_hull.Y_v`), which has the terms `mmg_hull`, `mmg_wake` and `mmg_rudder` and no parameter that is free unless said, or `general`, for a craft of which only mass,
    /// length and breadth are known, which has the term `general_hull`; `hull = "free"` then frees it with the added masses.
    #[serde(default)]
    pub form: Form,
    /// Terms beyond the base terms (flow, hull, resistance, propeller, rudder).
    #[serde(default)]
    pub terms: Vec<String>,
    /// `hull = "free"` frees every hydrodynamic coefficient of the hull ([`COEFFICIENTS`]) as `prior = "default"` does; mass,
    /// inertia and centre of gravity stay as the ship file has them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hull: Option<HullSetting>,
    /// Settings by dotted parameter name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub parameters: BTreeMap<String, Setting>,
    /// Additions by session and dotted parameter name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub sessions: BTreeMap<String, BTreeMap<String, f64>>,
    /// The ship to which the parameters belong, as a fit writes it: with a ship of another length the model is refused.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fitted_ship: Option<FittedShip>,
    /// Covariance of the estimates, as a fit writes it; a model that is changed has none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub covariance: Option<Uncertainty>,
}

/// What a model file may say of one parameter, `"rudder.lift1" = { value = 0.9, free = false }`; a key left out takes the term's value. A
/// plain number is a value, `"rudder.lift1" = 0.9`.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Setting {
    /// Value, and start of a fit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub value: Option<f64>,
    /// Whether a fit may change it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub free: Option<bool>,
    /// Lower bound.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lower: Option<f64>,
    /// Upper bound.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub upper: Option<f64>,
    /// Prior.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub prior: Option<PriorSetting>,
}

/// What a model file may say of one parameter; a key left out takes the term's value, and a plain number is a value.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct SettingTable {
    /// Value, and start of a fit.
    #[serde(default)]
    value: Option<f64>,
    /// Whether a fit may change it.
    #[serde(default)]
    free: Option<bool>,
    /// Lower bound.
    #[serde(default)]
    lower: Option<f64>,
    /// Upper bound.
    #[serde(default)]
    upper: Option<f64>,
    /// Prior.
    #[serde(default)]
    prior: Option<PriorSetting>,
}

impl JsonSchema for Setting {
    fn schema_name() -> Cow<'static, str> {
        "Setting".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let table = SettingTable::json_schema(generator);
        json_schema!({ "anyOf": [{ "type": "number", "description": "Its value." }, table] })
    }
}

impl<'de> Deserialize<'de> for Setting {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NumberOrTable;
        impl<'de> serde::de::Visitor<'de> for NumberOrTable {
            type Value = Setting;
            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a number or a table { value = ... }")
            }
            fn visit_f64<E: serde::de::Error>(self, value: f64) -> Result<Setting, E> {
                Ok(Setting { value: Some(value), ..Setting::default() })
            }
            fn visit_i64<E: serde::de::Error>(self, value: i64) -> Result<Setting, E> {
                self.visit_f64(value as f64)
            }
            fn visit_u64<E: serde::de::Error>(self, value: u64) -> Result<Setting, E> {
                self.visit_f64(value as f64)
            }
            fn visit_map<A: serde::de::MapAccess<'de>>(self, map: A) -> Result<Setting, A::Error> {
                let table = SettingTable::deserialize(serde::de::value::MapAccessDeserializer::new(map))?;
                let SettingTable { value, free, lower, upper, prior } = table;
                Ok(Setting { value, free, lower, upper, prior })
            }
        }
        deserializer.deserialize_any(NumberOrTable)
    }
}

/// What a model file may say of the hull as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum HullSetting {
    /// Every hydrodynamic coefficient is free, with its default prior.
    Free,
}

/// A prior as a model file gives it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PriorSetting {
    /// `prior = "default"`: frees the parameter, with the value that the ship gives it as mean and the spread that its term
    /// knows ([`ParameterInfo::spread`]) as standard deviation.
    Default,
    /// `prior = { mean = ..., sd = ... }`.
    Given(Prior),
}

impl Serialize for PriorSetting {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Default => serializer.serialize_str("default"),
            Self::Given(prior) => prior.serialize(serializer),
        }
    }
}

impl JsonSchema for PriorSetting {
    fn schema_name() -> Cow<'static, str> {
        "PriorSetting".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let table = Prior::json_schema(generator);
        json_schema!({ "anyOf": [{ "const": "default" }, table] })
    }
}

impl<'de> Deserialize<'de> for PriorSetting {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct WordOrTable;
        impl<'de> serde::de::Visitor<'de> for WordOrTable {
            type Value = PriorSetting;
            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("\"default\" or a table { mean = ..., sd = ... }")
            }
            fn visit_str<E: serde::de::Error>(self, word: &str) -> Result<PriorSetting, E> {
                match word {
                    "default" => Ok(PriorSetting::Default),
                    other => Err(E::invalid_value(serde::de::Unexpected::Str(other), &self)),
                }
            }
            fn visit_map<A: serde::de::MapAccess<'de>>(self, map: A) -> Result<PriorSetting, A::Error> {
                Prior::deserialize(serde::de::value::MapAccessDeserializer::new(map)).map(PriorSetting::Given)
            }
        }
        deserializer.deserialize_any(WordOrTable)
    }
}

impl Model {
    /// A model of the base terms and those named in `extra`, with default parameters; the paper's eleven are free.
    ///
    /// # Errors
    /// A term or a ship's parameter that is not known, or a mass matrix that is not positive.
    pub fn new(ship: Ship, name: &str, form: Form, extra: &[&str]) -> Result<Self, ModelError> {
        Self::with_catalogue(terms::standard().clone(), ship, name, form, extra)
    }

    /// As [`Model::new`], with terms from any catalogue: the project's own and those of other crates.
    ///
    /// # Errors
    /// Those of [`Model::new`].
    pub fn with_catalogue(
        catalogue: Catalogue,
        ship: Ship,
        name: &str,
        form: Form,
        extra: &[&str],
    ) -> Result<Self, ModelError> {
        let actuators = terms::propulsion::actuator::terms(&ship);
        if let Some(taken) = ship.actuators.iter().find(|a| catalogue.find(&a.name).is_some()) {
            return Err(ModelError::ActuatorName { name: taken.name.clone() });
        }
        let catalogue = actuators.iter().fold(catalogue, |all, term| all.with(*term));
        let mut model = Self {
            name: name.into(),
            ship,
            form,
            parameters: Vec::new(),
            sessions: BTreeMap::new(),
            catalogue,
            terms: Vec::new(),
        };
        let named = actuators.iter().map(|term| &term.info().name);
        for term in BASE.iter().chain(model.of_form()).chain(named).chain(extra) {
            model.add_term(term)?;
        }
        for i in 0..model.parameters.len() {
            model.parameters[i].free = model.free_at_first(&model.parameters[i].name);
        }
        let from_ship = model.ship.given_parameters();
        for (name, value) in &from_ship {
            // A ship file may give parameters of terms that this model does not use.
            if let Some(i) = model.index(name) {
                if !model.replaced(model.parameters[i].info) {
                    model.parameters[i].value = *value;
                }
            } else if !model.catalogued().any(|known| known == *name) {
                let near = match model.find(name) {
                    Ok(i) => format!(", did you mean `{}`?", model.parameters[i].name),
                    Err(_) => {
                        let known: Vec<String> = model.catalogued().collect();
                        suggestion(name, known.iter().map(String::as_str))
                    }
                };
                return Err(ModelError::ShipParameter { name: name.clone(), suggestion: near });
            }
        }
        model.check_bounds()?;
        model.check()?;
        Ok(model)
    }

    /// The model with every term of the catalogue; added terms have their default parameters.
    ///
    /// # Errors
    /// Those of [`Model::add_term`].
    pub fn complete(&self) -> Result<Self, ModelError> {
        let mut model = self.clone();
        for term in self.catalogue.iter() {
            model.add_term(term.info().name)?;
        }
        Ok(model)
    }

    /// Adds a term with its default parameters, all fixed; adding a term twice changes nothing.
    pub fn add_term(&mut self, name: &str) -> Result<(), ModelError> {
        if self.terms.iter().any(|t| t.term.info().name == name) {
            return Ok(());
        }
        let term = self.catalogue.find(name).ok_or_else(|| ModelError::UnknownTerm {
            name: name.into(),
            suggestion: suggestion(name, self.catalogue.iter().map(|t| t.info().name)),
        })?;
        let info = term.info();
        let (offset, len) = (self.parameters.len(), info.parameters.len());
        self.terms.push(Placed { term, offset, len, before: term.before() });
        for parameter in info.parameters {
            let value = self.start(parameter);
            let (lower, upper) = self.default_bounds(info.name, parameter);
            self.parameters.push(Parameter {
                name: format!("{}.{}", info.name, parameter.name),
                info: parameter,
                value,
                free: false,
                lower,
                upper,
                prior: None,
                scale: self.scale(parameter),
            });
        }
        Ok(())
    }

    /// The terms that the model's form has beyond the base.
    pub(crate) fn of_form(&self) -> &'static [&'static str] {
        match self.form {
            Form::Mmg => &MMG,
            Form::General => &GENERAL,
            Form::Paper | Form::Regular => &[],
        }
    }

    /// What the model's form says of where a parameter begins.
    fn form_start(&self, parameter: &ParameterInfo) -> Start {
        match self.form {
            Form::Mmg => parameter.mmg,
            Form::General => parameter.general,
            Form::Paper | Form::Regular => Start::Same,
        }
    }

    /// Where a parameter begins in the model's form, before the ship file's own values.
    fn start(&self, parameter: &ParameterInfo) -> f64 {
        match self.form_start(parameter) {
            Start::Own(value) | Start::Known(value, _) => value(&self.ship),
            Start::Replaced => 0.0,
            Start::Same => (parameter.default)(&self.ship),
        }
    }

    /// Size of a relevant change of a parameter in the model's form.
    fn scale(&self, parameter: &ParameterInfo) -> f64 {
        match self.form_start(parameter) {
            Start::Known(_, spread) => 0.5 * spread(&self.ship),
            Start::Own(_) | Start::Replaced | Start::Same => (parameter.scale)(&self.ship),
        }
    }

    /// Prior standard deviation of a parameter in the model's form.
    fn spread(&self, parameter: &ParameterInfo) -> f64 {
        match self.form_start(parameter) {
            Start::Known(_, spread) => spread(&self.ship),
            Start::Own(_) | Start::Replaced | Start::Same => (parameter.spread)(&self.ship),
        }
    }

    /// Whether another term of the model's form takes the place of a parameter.
    pub(crate) fn replaced(&self, parameter: &ParameterInfo) -> bool {
        matches!(self.form_start(parameter), Start::Replaced)
    }

    /// Whether a term is of something that the craft does not have: the propeller of `n`, or the rudder of `delta`.
    pub fn lacks(&self, term: &TermInfo) -> bool {
        let named = self.ship.actuator(term.name).is_some();
        match term.group {
            Group::Propulsion => !self.ship.has_propeller() && !named,
            Group::Rudder => !self.ship.has_rudder() && !named,
            Group::Hull | Group::Environment | Group::External | Group::Sensor => false,
        }
    }

    /// Whether the term of a parameter, by its dotted name, is of something that the craft does not have.
    pub(crate) fn lacks_owner(&self, name: &str) -> bool {
        let owner = name.split_once('.').map(|(term, _)| term);
        self.terms().any(|info| Some(info.name) == owner && self.lacks(info))
    }

    /// Whether a parameter is free in a model that says nothing of it: the paper's eleven where the form and the craft have them, and what
    /// no particulars say of a named actuator.
    fn free_at_first(&self, name: &str) -> bool {
        let Some((term, parameter)) = name.split_once('.') else { return false };
        if let Some(actuator) = self.ship.actuator(term) {
            return ActuatorTerm::free_at_first(actuator, parameter);
        }
        ELEVEN.contains(&name) && matches!(self.form, Form::Paper | Form::Regular) && !self.lacks_owner(name)
    }

    /// The terms that can be added to the model.
    pub fn catalogue(&self) -> &Catalogue {
        &self.catalogue
    }

    /// Reads a model file.
    pub fn read(path: &Path, ship: Ship) -> Result<Self, ModelError> {
        let text = read_text(path).map_err(|source| ModelError::Read { path: path.to_path_buf(), source })?;
        Self::parse(&text, path, ship)
    }

    /// Reads the text of a model file; `path` is used in messages.
    ///
    /// # Errors
    /// [`ModelError`]; for a file that trimtab wrote with its checksum ([`crate::files::seal`]) also where it was cut or changed.
    pub fn parse(text: &str, path: &Path, ship: Ship) -> Result<Self, ModelError> {
        intact(text).map_err(|broken| ModelError::Parse {
            path: path.to_path_buf(),
            line: text.lines().count().max(1),
            message: broken.to_string(),
        })?;
        Self::from_file(&model_file(text, path)?, ship).map_err(|error| placed(error, text, path))
    }

    /// A model from the content of a model file.
    ///
    /// # Errors
    /// Those of [`Model::new`], and settings that are not possible.
    pub fn from_file(file: &ModelFile, ship: Ship) -> Result<Self, ModelError> {
        Self::from_file_with(terms::standard().clone(), file, ship)
    }

    /// As [`Model::from_file`], with terms from any catalogue.
    ///
    /// # Errors
    /// Those of [`Model::from_file`].
    pub fn from_file_with(catalogue: Catalogue, file: &ModelFile, ship: Ship) -> Result<Self, ModelError> {
        let extra: Vec<&str> = file.terms.iter().map(String::as_str).collect();
        if let Some(fitted) = file.fitted_ship.as_ref().filter(|fitted| !fitted.is(&ship)) {
            return Err(ModelError::OtherShip(OtherShip { fitted: fitted.clone(), here: FittedShip::of(&ship) }));
        }
        let mut model = Self::with_catalogue(catalogue, ship, &file.name, file.form, &extra)?;
        if file.hull == Some(HullSetting::Free) {
            model.free_hull();
        }
        let (mut errors, mut set) = (Vec::new(), Vec::new());
        for (name, setting) in &file.parameters {
            match model.find(name) {
                Err(unknown) => errors.push(unknown),
                Ok(i) if set.contains(&i) => {
                    errors.push(ModelError::SetTwice { name: model.parameters[i].name.clone() })
                }
                Ok(i) => {
                    set.push(i);
                    errors.extend(model.apply(i, name, setting));
                }
            }
        }
        for (session, additions) in &file.sessions {
            let mut list = Vec::new();
            for (name, value) in additions {
                if !value.is_finite() {
                    let expected = format!("the addition in session `{session}` must be finite");
                    errors.push(ModelError::BadValue { name: name.clone(), value: *value, expected });
                }
                match model.find(name) {
                    Ok(i) => list.push((i, *value)),
                    Err(unknown) => errors.push(unknown),
                }
            }
            model.sessions.insert(session.clone(), list);
        }
        // A name that is wrong there as well is wrong for the same reason.
        if errors.is_empty()
            && let Some(fault) = file.covariance.as_ref().and_then(|c| c.fault(|name| model.index(name).is_some()))
        {
            errors.push(ModelError::Covariance(fault));
        }
        match errors.len() {
            0 => {}
            1 => return Err(errors.remove(0)),
            _ => return Err(ModelError::Several(errors)),
        }
        model.check_bounds()?;
        model.check()?;
        Ok(model)
    }

    /// Applies what a model file says of a parameter, and says what of it is not possible.
    fn apply(&mut self, parameter: usize, name: &str, setting: &Setting) -> Option<ModelError> {
        let default = self.default_prior(parameter);
        let p = &mut self.parameters[parameter];
        p.value = setting.value.unwrap_or(p.value);
        p.free = setting.free.unwrap_or(p.free || setting.prior == Some(PriorSetting::Default));
        p.lower = setting.lower.unwrap_or(p.lower);
        p.upper = setting.upper.unwrap_or(p.upper);
        match setting.prior {
            Some(PriorSetting::Default) => p.prior = Some(default),
            Some(PriorSetting::Given(prior)) => p.prior = Some(prior),
            None => {}
        }
        let wrong = |value, expected: String| Some(ModelError::BadValue { name: name.into(), value, expected });
        for (key, bound) in [("lower", p.lower), ("upper", p.upper)] {
            if bound.is_nan() {
                return wrong(bound, format!("its `{key}` must be a number; correct it, or leave it out"));
            }
        }
        if p.lower > p.upper {
            let (lower, upper) = (p.lower, p.upper);
            return wrong(
                p.value,
                format!("its `lower` ({lower}) must be at most its `upper` ({upper}); swap or correct them"),
            );
        }
        if !p.value.is_finite() {
            return wrong(p.value, "its `value` must be finite; correct it, or leave it out".to_owned());
        }
        let most = LARGEST_VALUE * p.scale.abs().max((p.info.default)(&self.ship).abs()).max(1.0);
        if p.value.abs() > most {
            return wrong(
                p.value,
                format!("its `value` is beyond {most:.0e}, where nothing can be computed with; correct it"),
            );
        }
        let prior = p.prior?;
        let known = prior.sd > 0.0 && prior.sd.is_finite() && prior.mean.is_finite();
        match setting.prior {
            Some(PriorSetting::Default) if !known => wrong(
                p.value,
                "nothing is known of it beforehand, so that it has no default prior; give prior = { mean = ..., sd = ... }".into(),
            ),
            _ if !known => wrong(
                p.value,
                format!(
                    "its prior has the mean {} and the sd {}, where a finite mean and a positive, finite sd are needed; correct them",
                    prior.mean, prior.sd
                ),
            ),
            // Three standard deviations: what the bounds leave is then refused by the prior.
            Some(PriorSetting::Given(_)) if prior.mean + 3.0 * prior.sd < p.lower || prior.mean - 3.0 * prior.sd > p.upper => {
                let Prior { mean, sd } = prior;
                wrong(p.value, format!("its prior ({mean} with sd {sd}) lies outside its bounds ({} to {}); correct one of them", p.lower, p.upper))
            }
            _ => None,
        }
    }

    /// The covariance in a model file, if it has one.
    ///
    /// # Errors
    /// The file cannot be read, or is no model file.
    pub fn read_uncertainty(path: &Path) -> Result<Option<Uncertainty>, ModelError> {
        let text = read_text(path).map_err(|source| ModelError::Read { path: path.to_path_buf(), source })?;
        Ok(model_file(&text, path)?.covariance)
    }

    /// Frees every hydrodynamic coefficient of the hull with its default prior: what `hull = "free"` in a model file does.
    pub fn free_hull(&mut self) {
        for i in self.hull_coefficients() {
            let prior = self.default_prior(i);
            let p = &mut self.parameters[i];
            (p.free, p.prior) = (true, Some(prior));
        }
    }

    /// Frees a parameter (`flow.asymmetry`), or all of a term (`wake_drift`), each with its default prior: what `prior = "default"` in a
    /// model file does. A term that the model lacks is added; of the hull the hydrodynamic coefficients are freed.
    ///
    /// # Errors
    /// No term or no parameter has this name.
    pub fn release(&mut self, name: &str) -> Result<(), ModelError> {
        if name == "hull" {
            self.free_hull();
            return Ok(());
        }
        if self.find(name).is_err() {
            match name.split_once('.') {
                None => self.add_term(name)?,
                Some((term, _)) if self.catalogue.find(term).is_some() => self.add_term(term)?,
                Some(_) => {}
            }
        }
        let all = |p: &Parameter| p.name.split_once('.').is_some_and(|(term, _)| term == name);
        let mut freed: Vec<usize> = (0..self.parameters.len()).filter(|i| all(&self.parameters[*i])).collect();
        if freed.is_empty() {
            freed.push(self.find(name)?);
        }
        for i in freed {
            let prior = self.default_prior(i);
            let p = &mut self.parameters[i];
            (p.free, p.prior) = (true, prior.sd.is_finite().then_some(prior));
        }
        Ok(())
    }

    /// Indices of the hydrodynamic coefficients of the hull: in form `mmg` m_x, m_y, J_z and those of `mmg_hull`, in form `general` these
    /// masses, the centre of gravity and those of `general_hull`.
    fn hull_coefficients(&self) -> Vec<usize> {
        let base = COEFFICIENTS.iter().filter_map(|(name, _)| self.index(&format!("hull.{name}")));
        let own = |i: &usize| {
            let name = self.parameters[*i].name.as_str();
            match self.form {
                Form::Mmg => name.starts_with("mmg_hull."),
                Form::General => name.starts_with("general_hull.") || name == "hull.x_g",
                Form::Paper | Form::Regular => false,
            }
        };
        base.filter(|i| !self.replaced(self.parameters[*i].info))
            .chain((0..self.parameters.len()).filter(own))
            .collect()
    }

    /// The prior that `prior = "default"` stands for: the ship's value and the term's spread, which is infinite where the term
    /// has none.
    pub fn default_prior(&self, parameter: usize) -> Prior {
        let p = &self.parameters[parameter];
        let given = self.ship.given_parameters().get(&p.name).copied().filter(|_| !self.replaced(p.info));
        let mean = given.unwrap_or_else(|| self.start(p.info));
        Prior { mean, sd: self.spread(p.info) }
    }

    /// The bounds of a parameter that no model file has changed: those of its term, widened where the estimate of a hull
    /// coefficient that the ship file does not give lies outside (a regression far from the ships it was made of).
    fn default_bounds(&self, term: &str, info: &ParameterInfo) -> (f64, f64) {
        let given = |table: &BTreeMap<String, f64>| table.contains_key(info.name);
        if term != "hull" || given(&self.ship.coefficients) || given(&self.ship.coefficients_prime) {
            return (info.lower, info.upper);
        }
        let estimate = self.start(info);
        (info.lower.min(estimate), info.upper.max(estimate))
    }

    /// The model as the content of a model file: every value that differs from its default, every setting of a fit.
    pub fn to_file(&self) -> ModelFile {
        let as_default = |i: usize| self.parameters[i].prior == Some(self.default_prior(i));
        let hull = self.hull_coefficients();
        let hull_is_free = !hull.is_empty() && hull.iter().all(|i| self.parameters[*i].free && as_default(*i));
        let mut parameters = BTreeMap::new();
        let from_ship = self.ship.given_parameters();
        for (i, p) in self.parameters.iter().enumerate() {
            // What a reader begins with: the ship file's own value, or that of the form.
            let given = from_ship.get(&p.name).copied().filter(|_| !self.replaced(p.info));
            let default = given.unwrap_or_else(|| self.start(p.info));
            let with_hull = hull_is_free && hull.contains(&i);
            let prior_frees = as_default(i) || with_hull;
            let free_by_default = self.free_at_first(&p.name) || prior_frees;
            let (term, _) = p.name.split_once('.').unwrap_or((&p.name, ""));
            let (lower, upper) = self.default_bounds(term, p.info);
            let prior =
                p.prior.map(|prior| if as_default(i) { PriorSetting::Default } else { PriorSetting::Given(prior) });
            let setting = Setting {
                value: (p.value != default || p.free).then_some(p.value),
                free: (p.free != free_by_default).then_some(p.free),
                lower: (p.lower != lower).then_some(p.lower),
                upper: (p.upper != upper).then_some(p.upper),
                prior: prior.filter(|_| !with_hull),
            };
            if setting != Setting::default() {
                parameters.insert(p.name.clone(), setting);
            }
        }
        let name_of = |(i, v): &(usize, f64)| (self.parameters[*i].name.clone(), *v);
        ModelFile {
            name: self.name.clone(),
            form: self.form,
            hull: hull_is_free.then_some(HullSetting::Free),
            terms: self.further_terms().iter().map(ToString::to_string).collect(),
            parameters,
            sessions: self.sessions.iter().map(|(s, list)| (s.clone(), list.iter().map(name_of).collect())).collect(),
            fitted_ship: Some(FittedShip::of(&self.ship)),
            covariance: None,
        }
    }

    /// This model with its whole parameter vector, but evaluating only the terms for which `keep` is true.
    ///
    /// Leaving out terms at their neutral parameters changes no result, only the time it takes.
    pub fn restricted(&self, keep: impl Fn(&str) -> bool) -> Self {
        let mut view = self.clone();
        view.terms.retain(|t| keep(t.term.info().name));
        view
    }

    /// This model with the named actuators of its ship on the other side, each at its mirror place in its mirrored direction. Parameters stay.
    #[must_use]
    pub(crate) fn with_sides_exchanged(&self) -> Self {
        let mut out = self.clone();
        for a in &mut out.ship.actuators {
            (a.y, a.angle) = (-a.y, a.angle.map(|angle| -angle));
        }
        for term in terms::propulsion::actuator::terms(&out.ship) {
            out.catalogue = out.catalogue.with(term);
            let own = out.terms.iter_mut().filter(|t| t.term.info().name == term.info().name);
            own.for_each(|placed| placed.term = term);
        }
        out
    }

    /// What is known of the model's terms, in order.
    pub fn terms(&self) -> impl Iterator<Item = &'static TermInfo> + '_ {
        self.terms.iter().map(|t| t.term.info())
    }

    /// Names of the model's terms, in order.
    pub fn term_names(&self) -> Vec<&'static str> {
        self.terms.iter().map(|t| t.term.info().name).collect()
    }

    /// Names of the terms beyond those that every model of this form and this craft has, in order.
    pub fn further_terms(&self) -> Vec<&'static str> {
        let named = |name: &str| self.ship.actuator(name).is_some();
        let own = |name: &&str| !BASE.contains(name) && !self.of_form().contains(name) && !named(name);
        self.term_names().into_iter().filter(own).collect()
    }

    /// Index of a parameter by dotted name.
    pub fn index(&self, name: &str) -> Option<usize> {
        self.parameters.iter().position(|p| p.name == name)
    }

    /// Index of a parameter by dotted name, or by the symbol of the paper (`p5`).
    pub fn find(&self, name: &str) -> Result<usize, ModelError> {
        self.index(name)
            .or_else(|| self.parameters.iter().position(|p| p.info.symbol == name && ELEVEN.contains(&p.name.as_str())))
            .ok_or_else(|| self.unknown(name))
    }

    /// Dotted names of the parameters of every term that there is.
    fn catalogued(&self) -> impl Iterator<Item = String> + '_ {
        let names =
            |t: &TermInfo| -> Vec<String> { t.parameters.iter().map(|p| format!("{}.{}", t.name, p.name)).collect() };
        self.catalogue.iter().flat_map(move |t| names(t.info()))
    }

    /// Whether the surge resistance is 0 at every speed: then a ship without other drag never stops.
    pub fn without_resistance(&self) -> bool {
        let of_curve = |p: &&Parameter| {
            p.name.starts_with("resistance.") || p.name == "mmg_hull.R_0" || p.name.starts_with("general_hull.surge")
        };
        let mut curve = self.parameters.iter().filter(of_curve);
        curve.all(|p| p.value == 0.0)
    }

    /// The error of a name that no parameter of the model has.
    fn unknown(&self, name: &str) -> ModelError {
        if let Some((term, _)) = name.split_once('.').filter(|_| self.catalogued().any(|known| known == name)) {
            return ModelError::AbsentTerm { name: name.into(), term: term.into() };
        }
        // The second half of a name means that parameter, whatever else is spelt like it.
        let half = |p: &&Parameter| p.info.name == name;
        let suggestion = match self.parameters.iter().find(half) {
            Some(meant) => format!(", did you mean `{}`?", meant.name),
            None => suggestion(name, self.parameters.iter().map(|p| p.name.as_str())),
        };
        ModelError::UnknownParameter { name: name.into(), suggestion }
    }

    /// Sets parameters by dotted name or symbol.
    pub fn set(&mut self, values: &[(&str, f64)]) -> Result<(), ModelError> {
        for (name, value) in values {
            let i = self.find(name)?;
            self.parameters[i].value = *value;
        }
        self.check()
    }

    /// The paper's eleven parameters p0 to p10 at their values.
    pub fn eleven(&self) -> [f64; 11] {
        ELEVEN.map(|n| self.index(n).map_or(0.0, |i| self.parameters[i].value))
    }

    /// Sets the paper's eleven parameters p0 to p10.
    pub fn set_eleven(&mut self, p: &[f64; 11]) {
        for (name, value) in ELEVEN.iter().zip(p) {
            if let Some(i) = self.index(name) {
                self.parameters[i].value = *value;
            }
        }
    }

    /// Indices of the free parameters.
    pub fn free(&self) -> Vec<usize> {
        (0..self.parameters.len()).filter(|i| self.parameters[*i].free).collect()
    }

    /// The parameter values.
    pub fn values(&self) -> Vec<f64> {
        self.parameters.iter().map(|p| p.value).collect()
    }

    /// The parameter values for runs of a session: the values plus the session's additions.
    pub fn values_in(&self, session: &str) -> Vec<f64> {
        let mut values = self.values();
        for (i, addition) in self.sessions.get(session).into_iter().flatten() {
            values[*i] += addition;
        }
        values
    }

    /// The part of a parameter vector that belongs to a term, empty when the model does not have the term.
    pub fn part<'a, S>(&self, term: &str, theta: &'a [S]) -> &'a [S] {
        // The base terms come first, so that this search is short.
        self.terms.iter().find(|t| t.term.info().name == term).map_or(&[], |t| &theta[t.offset..t.offset + t.len])
    }

    /// The mass matrix of the ship at rest, added mass included, at parameter values `theta`.
    pub fn inertia_at_rest(&self, theta: &[f64]) -> Inertia<f64> {
        let mut adjust = Adjust::neutral();
        for t in &self.terms {
            f64::physics(t.term).adjust(t.part(theta), &self.ship, &Inputs::actuators(0.0, 0.0, 0.0), &mut adjust);
        }
        Inertia::new(self.part("hull", theta), &adjust)
    }

    /// Whether every value is within its bounds.
    fn check_bounds(&self) -> Result<(), ModelError> {
        let Some(p) = self.parameters.iter().find(|p| p.value < p.lower || p.value > p.upper) else { return Ok(()) };
        let (side, limit, key) =
            if p.value < p.lower { ("least", p.lower, "lower") } else { ("most", p.upper, "upper") };
        Err(ModelError::BadValue {
            name: p.name.clone(),
            value: p.value,
            expected: format!(
                "the {} must be at {side} {limit} {}; correct the value, or give the parameter another `{key}` in the model file",
                p.info.about, p.info.unit
            )
            .replace(" -;", ";"),
        })
    }

    fn check(&self) -> Result<(), ModelError> {
        let inertia = self.inertia_at_rest(&self.values());
        if inertia.is_positive() {
            Ok(())
        } else {
            Err(ModelError::SingularMass { determinant: inertia.determinant() })
        }
    }

    /// The model's terms with their places in the parameter vector: the base terms first, in the order of [`BASE`].
    pub fn placed(&self) -> &[Placed] {
        &self.terms
    }
}

/// The content of a model file.
fn model_file(text: &str, path: &Path) -> Result<ModelFile, ModelError> {
    read_toml(text, Kind::Model).map_err(|mistakes| {
        let (line, message) = joined(mistakes, path);
        ModelError::Parse { path: path.to_path_buf(), line, message }
    })
}

/// An error about a name in a model file, with the line on which it stands.
fn placed(error: ModelError, text: &str, path: &Path) -> ModelError {
    let (ModelError::UnknownTerm { name, .. }
    | ModelError::UnknownParameter { name, .. }
    | ModelError::AbsentTerm { name, .. }
    | ModelError::SetTwice { name }
    | ModelError::BadValue { name, .. }) = &error
    else {
        return match error {
            ModelError::Several(errors) => {
                ModelError::Several(errors.into_iter().map(|error| placed(error, text, path)).collect())
            }
            other => other,
        };
    };
    let line = text.find(name.as_str()).map_or(1, |at| line_at(text, at));
    ModelError::Parse { path: path.to_path_buf(), line, message: error.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::Form;

    #[test]
    fn rounding_that_a_constraint_leaves_is_reported_as_zero() {
        let ship = Ship::read(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/experiments/ships/a.toml"))).unwrap();
        let model = Model::new(ship, "HD", Form::Regular, &[]).unwrap();
        let lift = &model.parameters[model.index("rudder.lift0").unwrap()];
        assert_eq!([1.5e-16, -1.5e-16, 0.01, -3.0].map(|v| lift.reported(v)), [0.0, 0.0, 0.01, -3.0]);
        assert!(lift.reported(f64::NAN).is_nan());
    }
}
