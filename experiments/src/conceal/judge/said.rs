//! A `diagnosis.json` as the judge reads it: the documented keys that are judged, and no other.
//! It judges nothing, and it shares no type with the program that writes the file.

use std::path::Path;

use serde::Deserialize;

use crate::conceal::error::ConcealError;

/// A name, alone or with other keys beside it.
#[derive(Debug, Clone, Deserialize)]
#[serde(untagged)]
pub(crate) enum Name {
    Plain(String),
    Keyed { mechanism: String },
}

impl Name {
    pub(crate) fn get(&self) -> &str {
        match self {
            Self::Plain(name) | Self::Keyed { mechanism: name } => name,
        }
    }
}

/// A number, alone or as the `value`, `share` or `held_out` of an object.
#[derive(Debug, Clone, Deserialize)]
#[serde(untagged)]
pub(crate) enum Number {
    Plain(f64),
    Share { share: f64 },
    HeldOut { held_out: f64 },
    Value { value: f64 },
    Other(serde::de::IgnoredAny),
}

impl Number {
    pub(crate) fn get(&self) -> Option<f64> {
        match self {
            Self::Plain(v) | Self::Share { share: v } | Self::HeldOut { held_out: v } | Self::Value { value: v } => {
                Some(*v)
            }
            Self::Other(_) => None,
        }
    }
}

/// Share of a finding's force by equation.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Equations {
    #[serde(rename = "X")]
    pub(crate) x: Number,
    #[serde(rename = "Y")]
    pub(crate) y: Number,
    #[serde(rename = "N")]
    pub(crate) n: Number,
}

/// A time window of a finding, on the recordings' clock \[s\].
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct FoundWindow {
    pub(crate) run: Option<String>,
    pub(crate) start: f64,
    pub(crate) end: f64,
}

impl FoundWindow {
    /// The run, without the time that a diagnosis appends where it cuts runs in pieces (`r02 120 s`).
    pub(crate) fn run(&self) -> Option<&str> {
        self.run.as_deref().and_then(|r| r.split_whitespace().next())
    }
}

/// A parameter of a finding with its 95 % interval.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct FoundParameter {
    pub(crate) name: String,
    pub(crate) value: f64,
    pub(crate) ci95: Option<[f64; 2]>,
}

/// Error on held-out runs \[%\].
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct HeldOut {
    pub(crate) before: Option<Number>,
    pub(crate) after: Option<Number>,
}

/// One finding.
#[derive(Debug, Clone, Default, Deserialize)]
pub(crate) struct Finding {
    pub(crate) mechanism: String,
    #[serde(default)]
    pub(crate) confidence_set: Vec<Name>,
    pub(crate) equations: Option<Equations>,
    #[serde(default)]
    pub(crate) windows: Vec<FoundWindow>,
    #[serde(default)]
    pub(crate) parameters: Vec<FoundParameter>,
    pub(crate) held_out: Option<HeldOut>,
}

/// A diagnosis, as far as it is judged.
#[derive(Debug, Clone, Deserialize)]
pub struct Diagnosis {
    pub(crate) verdict: String,
    #[serde(default)]
    pub(crate) findings: Vec<Finding>,
    #[serde(default)]
    pub(crate) ranking: Vec<Ranked>,
    #[serde(default)]
    pub(crate) windows: Vec<FoundWindow>,
    pub(crate) held_out: Option<HeldOut>,
    #[serde(default)]
    pub(crate) admission: Admission,
    pub(crate) sides: Option<Sides>,
}

/// A mechanism against the base model.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Ranked {
    pub(crate) p: f64,
}

/// Whether port and starboard of the ship differ.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Sides {
    pub(crate) p: f64,
    #[serde(default)]
    pub(crate) parameters: Vec<FoundParameter>,
}

/// The audit of the recordings.
#[derive(Debug, Clone, Default, Deserialize)]
pub(crate) struct Admission {
    #[serde(default)]
    pub(crate) issues: Vec<Issue>,
}

/// One fault of the recordings.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Issue {
    #[serde(default)]
    pub(crate) blocking: bool,
}

impl Diagnosis {
    /// Reads a `diagnosis.json`.
    ///
    /// # Errors
    /// [`ConcealError::File`] or [`ConcealError::Content`].
    pub fn read(path: &Path) -> Result<Self, ConcealError> {
        let text = std::fs::read(path).map_err(|source| ConcealError::file(path, source))?;
        serde_json::from_slice(&text).map_err(|e| {
            let message =
                format!("not a diagnosis: {e}; it needs at least `verdict` and `findings[]` with `mechanism`");
            ConcealError::content(path, &message)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conceal::judge::rules::judge;
    use crate::conceal::{case::Case, family::Family, sailing::design::Design, spec::Spec, strength::ForceMeter};
    use proptest::prelude::*;
    use std::sync::LazyLock;

    const SAID: &str = r#"{"verdict": "named", "findings": [{"mechanism": "current", "parameters": [{"name": "current.north",
        "value": 0.2, "error": 0.01, "interval": [0.1, 0.3]}], "equations": {"X": 0.1, "Y": {"share": 0.7}, "N": 0.2},
        "windows": [{"run": "a", "start": 0.0, "end": 1e3}], "set": ["current", {"mechanism": "wind"}]}],
        "held_out": {"value": 1.0}, "absorbed": [{"name": "hull.Yv", "change": -1.5}]}"#;

    static MANIFEST: LazyLock<crate::conceal::seal::Manifest> = LazyLock::new(|| {
        let case =
            Case::make(&Spec { design: Design::Few, ..Spec::null(Family::Hd, 7) }, &ForceMeter::default()).unwrap();
        case.manifest(&case.study_files())
    });

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(2000) })]

        #[test]
        fn a_damaged_diagnosis_is_refused_or_judged(
            damages in prop::collection::vec((0.0..1.0_f64, 0..12_usize, "[-0-9eE.\",:{}\\[\\] a-z]{0,6}|null|nan|1e999"), 1..4),
        ) {
            let mut bytes = SAID.as_bytes().to_vec();
            for (place, length, text) in &damages {
                let from = (place * bytes.len() as f64) as usize;
                let to = (from + length).min(bytes.len());
                drop(bytes.splice(from..to, text.bytes()));
            }
            if let Ok(said) = serde_json::from_slice::<Diagnosis>(&bytes) {
                let _ = judge(&MANIFEST, &said);
            }
        }
    }
}
