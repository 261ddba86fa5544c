//! The dossier as one document: its sections in the order of the procedure, and what is missing in each.
//! It only lists them; the parts are made in the other files.

use super::causes::Causes;
use super::claim::Claim;
use super::particulars::ShipPart;
use super::structure::Structure;
use super::validation::Validation;
use super::verification::Verification;
use serde::Serialize;
use serde_json::Value;

/// The procedure whose order the dossier follows.
pub const PROCEDURE: &str = "ITTC Recommended Procedure 7.5-02-06-03, Validation of Manoeuvring Simulation Models";

/// Key and title of each section, in the order of the procedure.
pub const SECTIONS: [(&str, &str); 9] = [
    ("claim", "Claim and intended use"),
    ("ship", "Ship, sensors and clocks"),
    ("inputs", "Inputs, version and build"),
    ("model", "Model structure and ranges of validity"),
    ("verification", "Verification"),
    ("validation", "Validation on unseen runs and standard manoeuvres"),
    ("error_rates", "Error rates of this study"),
    ("causes", "Causes of error"),
    ("limits", "Known limits"),
];

/// A section with what is missing in it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Heading {
    /// Member of the document.
    pub key: &'static str,
    /// Title.
    pub title: &'static str,
    /// What was not computed or not stated, and how to get it; empty for a section that is complete.
    pub missing: Vec<String>,
}

/// Everything that a dossier says.
#[derive(Clone, Debug, Serialize)]
pub struct Dossier {
    /// Layout of this document.
    pub schema: &'static str,
    /// The procedure whose order it follows.
    pub procedure: &'static str,
    /// Name of the study.
    pub study: String,
    /// The sections in their order.
    pub sections: Vec<Heading>,
    /// Claim and intended use.
    pub claim: Claim,
    /// Ship, sensors and clocks.
    pub ship: ShipPart,
    /// Files with checksums, version, build, seeds: as the caller knows them.
    pub inputs: Value,
    /// Terms, ranges and parameters.
    pub model: Structure,
    /// Checks of the program on this study.
    pub verification: Verification,
    /// Errors on test runs, and standard manoeuvres.
    pub validation: Validation,
    /// Error rates of this study, as `diagnosis.json` has them; absent where not measured.
    pub error_rates: Option<Value>,
    /// What the diagnosis found, refuted and could not exclude; absent without a diagnosis.
    pub causes: Option<Causes>,
    /// Known limits, a sentence each.
    pub limits: Vec<String>,
}
