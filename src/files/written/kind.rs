//! The kind of a file written by hand, found from its keys: for a file that stands where another belongs.
//! Whether the file is valid is decided by its reader.

use toml::de::DeTable;

/// A kind of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A study.
    Study,
    /// A ship.
    Ship,
    /// A model.
    Model,
    /// A column map.
    Columns,
}

impl Kind {
    /// The kind in words.
    fn words(self) -> &'static str {
        match self {
            Self::Study => "a study",
            Self::Ship => "a ship file",
            Self::Model => "a model file",
            Self::Columns => "a column map",
        }
    }

    /// Where a file of this kind is named.
    fn place(self) -> &'static str {
        match self {
            Self::Study => {
                "the study is the file that names ship, model and recordings; `trimtab help study` shows one"
            }
            Self::Ship => "the ship file is named by `ship` in the study; `trimtab help ship` shows one",
            Self::Model => {
                "a model file is named by `model` in the study, or by --model; `trimtab fit --out` writes one, fitted.toml"
            }
            Self::Columns => "the column map is named by `column_map` in the study; `trimtab help columns` shows one",
        }
    }

    /// The kind of a file with these keys, where they determine it.
    fn of(root: &DeTable<'_>) -> Option<Self> {
        let has = |key: &str| root.contains_key(key);
        let table = |key: &str| root.get(key).is_some_and(|v| v.get_ref().is_table());
        let text = |key: &str| root.get(key).is_some_and(|v| v.get_ref().is_str());
        if has("runs") || (text("ship") && text("model")) {
            Some(Self::Study)
        } else if table("hull") || (table("propeller") && table("rudder")) {
            Some(Self::Ship)
        } else if table("columns") || ["delimiter", "decimal", "derive"].into_iter().any(has) {
            Some(Self::Columns)
        } else if ["parameters", "covariance"].into_iter().any(table) || has("terms") {
            Some(Self::Model)
        } else {
            None
        }
    }

    /// Why a text cannot be a file of this kind, where it is one of another.
    pub(super) fn instead(self, text: &str, root: &DeTable<'_>) -> Option<String> {
        let found = match Self::of(root).filter(|_| !is_csv(text)) {
            Some(kind) => kind.words(),
            None if text.trim_start().starts_with('{') => "a JSON file",
            None if is_csv(text) => "a table of values (CSV)",
            None => return None,
        };
        (found != self.words()).then(|| format!("this is {found}, not {}: {}", self.words(), self.place()))
    }
}

/// Whether the first line is a line of a table: fields between separators, and nothing that is set.
fn is_csv(text: &str) -> bool {
    let first = text.lines().find(|line| !line.trim().is_empty() && !line.starts_with('#')).unwrap_or_default();
    !first.contains('=') && [',', ';', '\t'].iter().any(|separator| first.matches(*separator).count() >= 2)
}
