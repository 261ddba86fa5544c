//! A ship with every value of its file, and from where each value is.
//! How values are estimated is in `estimate`, how they are written in `write`.

use super::sheet::Entry;
use crate::ship::Ship;

/// A ship with every value of its file, given or estimated.
#[derive(Clone, Debug, serde::Serialize)]
pub struct Estimated {
    /// The ship, as its file reads.
    #[serde(skip)]
    pub ship: Ship,
    /// Type.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// Service speed that the estimates are for \[m/s\].
    pub speed: f64,
    /// In which quantities the ship is outside the range of its type.
    pub outside: Vec<String>,
    /// The values, in the order of the file.
    pub entries: Vec<Entry>,
    /// The text of the ship file.
    #[serde(skip)]
    pub(super) text: String,
}
