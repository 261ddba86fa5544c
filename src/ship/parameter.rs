//! What is known of a parameter before any fit: name, symbol, unit, default, bounds, prior and mirror parity.
//! Values are not here: a model has them in one vector, in the order of its terms.

use crate::ship::Ship;

/// How a parameter behaves when the ship is mirrored port to starboard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parity {
    /// Unchanged: the same value describes the mirrored ship.
    Even,
    /// Changes sign: a value other than zero makes port and starboard differ.
    Odd,
}

/// Where a parameter begins in a model of another form than the paper's.
#[derive(Clone, Copy)]
pub enum Start {
    /// At its default.
    Same,
    /// At this value of the ship.
    Own(fn(&Ship) -> f64),
    /// At the first value, known to the second: prior standard deviation, and twice the scale.
    Known(fn(&Ship) -> f64, fn(&Ship) -> f64),
    /// At 0, whatever the ship file sets: another term of that form takes its place.
    Replaced,
}

/// One parameter of a term.
#[derive(Clone, Copy)]
pub struct ParameterInfo {
    /// Name within its term, e.g. `lift1`; the dotted name is `rudder.lift1`.
    pub name: &'static str,
    /// Symbol as in the source, e.g. `p5`.
    pub symbol: &'static str,
    /// SI unit, `-` for none.
    pub unit: &'static str,
    /// Meaning, in one line of plain words.
    pub about: &'static str,
    /// Default for a ship.
    pub default: fn(&Ship) -> f64,
    /// Where it begins in form `mmg`.
    pub mmg: Start,
    /// Where it begins in form `general`.
    pub general: Start,
    /// Size of a relevant change \[same unit\]: the solver's scale, and the size at which a nonlinear effect is probed.
    pub scale: fn(&Ship) -> f64,
    /// Prior standard deviation \[same unit\]; infinite for no prior.
    pub spread: fn(&Ship) -> f64,
    /// Lower bound.
    pub lower: f64,
    /// Upper bound.
    pub upper: f64,
    /// Mirror parity.
    pub parity: Parity,
}

impl ParameterInfo {
    /// A free parameter with default 0, scale 1, no prior, no bounds, even parity.
    pub const fn new(name: &'static str, symbol: &'static str, unit: &'static str, about: &'static str) -> Self {
        Self {
            name,
            symbol,
            unit,
            about,
            default: |_| 0.0,
            mmg: Start::Same,
            general: Start::Same,
            scale: |_| 1.0,
            spread: |_| f64::INFINITY,
            lower: f64::NEG_INFINITY,
            upper: f64::INFINITY,
            parity: Parity::Even,
        }
    }
    /// Sets the default.
    pub const fn default(mut self, default: fn(&Ship) -> f64) -> Self {
        self.default = default;
        self
    }
    /// Sets where it begins in form `mmg`.
    pub const fn in_mmg(mut self, start: Start) -> Self {
        self.mmg = start;
        self
    }
    /// Sets where it begins in form `general`.
    pub const fn in_general(mut self, start: Start) -> Self {
        self.general = start;
        self
    }
    /// Sets the scale.
    pub const fn scale(mut self, scale: fn(&Ship) -> f64) -> Self {
        self.scale = scale;
        self
    }
    /// Sets the prior standard deviation.
    pub const fn spread(mut self, spread: fn(&Ship) -> f64) -> Self {
        self.spread = spread;
        self
    }
    /// Sets the bounds.
    pub const fn bounds(mut self, lower: f64, upper: f64) -> Self {
        self.lower = lower;
        self.upper = upper;
        self
    }
    /// Marks the parameter as breaking mirror symmetry.
    pub const fn odd(mut self) -> Self {
        self.parity = Parity::Odd;
        self
    }
}

impl std::fmt::Debug for ParameterInfo {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ParameterInfo").field("name", &self.name).field("unit", &self.unit).finish_non_exhaustive()
    }
}
