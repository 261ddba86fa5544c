//! The catalogue as text and as data: what `trimtab terms` prints.
//! It reads the terms' own `TermInfo` and adds nothing to it; values that depend on a ship are shown only for a given ship.

use super::table::Table;
use crate::numerals::{DASH, sig};
use crate::parameter::{ParameterInfo, Parity};
use crate::physics::{Group, Quantity, TermInfo, Validity, range_in_words};
use crate::ship::Ship;
use crate::terms::CATALOGUE;
use serde::Serialize;
use std::fmt;

/// A term of the catalogue, for printing and for JSON.
#[derive(Clone, Debug, Serialize)]
pub struct Entry {
    /// Name.
    pub name: &'static str,
    /// What it is in plain words.
    pub title: &'static str,
    /// Part of the simulator.
    pub group: Group,
    /// Whether every model has it.
    pub base: bool,
    /// The equation, in plain text.
    pub equation: &'static str,
    /// Source.
    pub source: &'static str,
    /// Recorded channels it needs.
    pub needs: &'static [&'static str],
    /// Where its law is valid.
    pub validity: ValidityEntry,
    /// Its parameters.
    pub parameters: Vec<ParameterEntry>,
}

/// Where the law of a term is valid, for printing and for JSON.
#[derive(Clone, Debug, Serialize)]
pub struct ValidityEntry {
    /// Its ranges; empty where it is valid anywhere.
    pub ranges: Vec<RangeEntry>,
    /// Terms whose range it widens to its own.
    pub widens: &'static [&'static str],
    /// Where the ranges come from.
    pub source: &'static str,
}

/// One range, absent (`null` in JSON) where it is open.
#[derive(Clone, Debug, Serialize)]
pub struct RangeEntry {
    /// The quantity.
    pub quantity: Quantity,
    /// Lowest and highest value \[SI\].
    pub range: [Option<f64>; 2],
    /// The range in words.
    pub words: String,
}

impl ValidityEntry {
    fn new(validity: &'static Validity) -> Self {
        let open = |x: f64| x.is_finite().then_some(x);
        let entry = |(quantity, range): (Quantity, [f64; 2])| RangeEntry {
            quantity,
            range: range.map(open),
            words: range_in_words(quantity, range),
        };
        Self { ranges: validity.limits().map(entry).collect(), widens: validity.widens, source: validity.source }
    }

    fn in_words(&self) -> String {
        let ranges: Vec<String> = self.ranges.iter().map(|r| format!("{} {}", r.quantity.words(), r.words)).collect();
        let ranges = if ranges.is_empty() { "anywhere".to_owned() } else { ranges.join(", ") };
        let widens = match self.widens {
            [] => String::new(),
            terms => format!("; widens the range of {} to its own", terms.join(" and ")),
        };
        format!("valid for: {ranges}{widens} ({})", self.source)
    }
}

/// A parameter of a term. A bound or value that does not exist is absent (`null` in JSON).
#[derive(Clone, Debug, Serialize)]
pub struct ParameterEntry {
    /// Dotted name, as in a model file.
    pub name: String,
    /// Symbol as in the source.
    pub symbol: &'static str,
    /// Unit, `-` for none.
    pub unit: &'static str,
    /// Meaning in plain words.
    pub about: &'static str,
    /// Default for the ship.
    pub default: Option<f64>,
    /// Size of a relevant change, for the ship.
    pub scale: Option<f64>,
    /// Prior standard deviation for the ship.
    pub spread: Option<f64>,
    /// Lower bound.
    pub lower: Option<f64>,
    /// Upper bound.
    pub upper: Option<f64>,
    /// Whether it makes port and starboard differ.
    pub one_sided: bool,
}

impl ParameterEntry {
    fn new(term: &str, p: &'static ParameterInfo, ship: Option<&Ship>) -> Self {
        let finite = |x: f64| x.is_finite().then_some(x);
        let of_ship = |f: fn(&Ship) -> f64| ship.map(f).and_then(finite);
        Self {
            name: format!("{term}.{}", p.name),
            symbol: p.symbol,
            unit: p.unit,
            about: p.about,
            default: of_ship(p.default),
            scale: of_ship(p.scale),
            spread: of_ship(p.spread),
            lower: finite(p.lower),
            upper: finite(p.upper),
            one_sided: p.parity == Parity::Odd,
        }
    }

    fn bounds(&self) -> String {
        match (self.lower, self.upper) {
            (None, None) => DASH.into(),
            (Some(lower), None) => format!("≥ {}", sig(lower, 3)),
            (None, Some(upper)) => format!("≤ {}", sig(upper, 3)),
            (Some(lower), Some(upper)) => format!("{} to {}", sig(lower, 3), sig(upper, 3)),
        }
    }
}

impl Entry {
    fn new(info: &'static TermInfo, ship: Option<&Ship>) -> Self {
        Self {
            name: info.name,
            title: info.title,
            group: info.group,
            base: crate::model::BASE.contains(&info.name),
            equation: info.equation,
            source: info.source,
            needs: info.needs,
            validity: ValidityEntry::new(&info.validity),
            parameters: info.parameters.iter().map(|p| ParameterEntry::new(info.name, p, ship)).collect(),
        }
    }
}

/// All terms in catalogue order, or the one called `name`; defaults, scales and priors where a ship is given.
pub fn listing(name: Option<&str>, ship: Option<&Ship>) -> Vec<Entry> {
    CATALOGUE
        .iter()
        .map(|t| t.info())
        .filter(|info| name.is_none_or(|name| info.name == name))
        .map(|info| Entry::new(info, ship))
        .collect()
}

/// One line a term: name, group, needed channels and title.
pub fn summary(entries: &[Entry]) -> Table {
    let mut table = Table::new(["term", "group", "needs", "what it is"]);
    for e in entries {
        let group = if e.base { format!("{} (base)", e.group) } else { e.group.to_string() };
        table.row([e.name, &group, &e.needs.join(", "), e.title]);
    }
    table
}

impl fmt::Display for Entry {
    /// The term in full: equation, source and a table of its parameters.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}: {} ({})", self.name, self.title, self.group)?;
        writeln!(f, "  {}", self.equation)?;
        writeln!(f, "  source: {}", self.source)?;
        if !self.needs.is_empty() {
            writeln!(f, "  needs the recorded channel {}", self.needs.join(", "))?;
        }
        writeln!(f, "  {}", self.validity.in_words())?;
        let value = |x: Option<f64>| x.map_or(DASH.into(), |x| sig(x, 4));
        let with_ship = self.parameters.iter().any(|p| p.default.is_some());
        let mut header = vec!["parameter", "symbol", "unit", "bounds"];
        if with_ship {
            header.extend(["default", "scale", "prior sd"]);
        }
        header.push("what it is");
        let mut table = Table::new(header);
        for p in &self.parameters {
            let mut row = vec![p.name.clone(), p.symbol.into(), p.unit.into(), p.bounds()];
            if with_ship {
                row.extend([value(p.default), value(p.scale), value(p.spread)]);
            }
            row.push(p.about.into());
            table.row(row);
        }
        write!(f, "{}", table.wrapped(120))
    }
}

impl fmt::Display for Group {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Hull => "hull",
            Self::Propulsion => "propulsion",
            Self::Rudder => "rudder",
            Self::Environment => "environment",
            Self::External => "external",
            Self::Sensor => "sensor",
        })
    }
}
