//! Types of ships: what a type says of a ship beyond its length, breadth and draught, and the range over which it says so.
//! Nothing is estimated here.

use super::screw::Screw;

/// A type of ship.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kind {
    /// Name, as `--type` takes it.
    pub name: &'static str,
    /// Other names for it.
    pub aliases: &'static [&'static str],
    /// What ships it covers.
    pub title: &'static str,
    /// Froude number of the service speed where no speed is given \[-\].
    pub froude: f64,
    /// Range of the length between perpendiculars \[m\].
    pub length: [f64; 2],
    /// Range of L/B \[-\].
    pub slenderness: [f64; 2],
    /// Range of B/d \[-\].
    pub beam: [f64; 2],
    /// Block coefficient, where the line over the Froude number is not valid \[-\].
    pub block: Option<f64>,
    /// Standard deviation of the block coefficient \[-\].
    pub block_spread: f64,
    /// Whether the centre of buoyancy is that of tankers and bulk carriers.
    pub full: bool,
    /// Propeller diameter D = a d + b: a \[-\] and b \[m\].
    pub diameter: [f64; 2],
    /// Where that is from.
    pub diameter_source: &'static str,
    /// The propeller whose thrust curve is taken.
    pub screw: Screw,
    /// Frontal area over B^2 and lateral area over L B, above the water \[-\].
    pub above_water: [f64; 2],
}

const DESMO: &str = "Kristensen & Lutzen 2012, Prediction of Resistance and Propulsion Power of Ships (DTU 2010-56-04), propeller diameter";
const SMALL_CRAFT: &str = "engineering estimate for small craft, no published regression";

/// The types, from large and slow to small and fast.
pub const KINDS: [Kind; 8] = [
    Kind {
        name: "coaster",
        aliases: &["general_cargo", "cargo"],
        title: "coasters and general cargo ships",
        froude: 0.22,
        length: [40.0, 160.0],
        slenderness: [5.0, 7.8],
        beam: [2.0, 3.8],
        block: None,
        block_spread: 0.04,
        full: false,
        diameter: [0.395, 1.30],
        diameter_source: DESMO,
        screw: Screw { blades: 4, area: 0.70, pitch: 0.80 },
        above_water: [0.95, 0.55],
    },
    Kind {
        name: "container",
        aliases: &["containership", "container_ship"],
        title: "container ships",
        froude: 0.24,
        length: [80.0, 400.0],
        slenderness: [5.5, 8.5],
        beam: [2.2, 4.2],
        block: None,
        block_spread: 0.04,
        full: false,
        diameter: [0.623, -0.16],
        diameter_source: DESMO,
        screw: Screw { blades: 4, area: 0.70, pitch: 0.80 },
        above_water: [0.95, 0.70],
    },
    Kind {
        name: "tanker",
        aliases: &[],
        title: "tankers",
        froude: 0.16,
        length: [60.0, 380.0],
        slenderness: [5.0, 7.2],
        beam: [2.1, 3.6],
        block: None,
        block_spread: 0.04,
        full: true,
        diameter: [0.395, 1.30],
        diameter_source: DESMO,
        screw: Screw { blades: 4, area: 0.45, pitch: 0.72 },
        above_water: [0.70, 0.45],
    },
    Kind {
        name: "bulk_carrier",
        aliases: &["bulk", "bulker"],
        title: "bulk carriers",
        froude: 0.17,
        length: [80.0, 340.0],
        slenderness: [5.2, 7.2],
        beam: [2.0, 3.4],
        block: None,
        block_spread: 0.04,
        full: true,
        diameter: [0.395, 1.30],
        diameter_source: DESMO,
        screw: Screw { blades: 4, area: 0.45, pitch: 0.72 },
        above_water: [0.70, 0.45],
    },
    Kind {
        name: "ferry",
        aliases: &["ro_ro", "roro", "ro-ro", "ropax"],
        title: "ferries and ro-ro ships",
        froude: 0.26,
        length: [40.0, 240.0],
        slenderness: [4.0, 7.8],
        beam: [2.8, 5.2],
        block: None,
        block_spread: 0.05,
        full: false,
        diameter: [0.713, -0.08],
        diameter_source: DESMO,
        screw: Screw { blades: 4, area: 0.70, pitch: 1.00 },
        above_water: [1.00, 0.85],
    },
    Kind {
        name: "tug",
        aliases: &[],
        title: "tugs",
        froude: 0.32,
        length: [15.0, 60.0],
        slenderness: [2.2, 4.5],
        beam: [2.0, 4.0],
        block: None,
        block_spread: 0.06,
        full: false,
        diameter: [0.65, 0.0],
        diameter_source: SMALL_CRAFT,
        screw: Screw { blades: 4, area: 0.70, pitch: 0.80 },
        above_water: [0.80, 0.45],
    },
    Kind {
        name: "fishing",
        aliases: &["fishing_vessel", "trawler"],
        title: "fishing vessels",
        froude: 0.30,
        length: [10.0, 110.0],
        slenderness: [2.6, 6.2],
        beam: [1.9, 3.6],
        block: None,
        block_spread: 0.06,
        full: false,
        diameter: [0.60, 0.0],
        diameter_source: SMALL_CRAFT,
        screw: Screw { blades: 4, area: 0.55, pitch: 0.80 },
        above_water: [0.90, 0.50],
    },
    Kind {
        name: "yacht",
        aliases: &["usv", "boat"],
        title: "motor yachts and uncrewed surface vessels at displacement speed",
        froude: 0.32,
        length: [1.0, 80.0],
        slenderness: [2.2, 7.0],
        beam: [2.2, 6.5],
        block: Some(0.42),
        block_spread: 0.07,
        full: false,
        diameter: [0.55, 0.0],
        diameter_source: SMALL_CRAFT,
        screw: Screw { blades: 4, area: 0.70, pitch: 0.90 },
        above_water: [0.80, 0.35],
    },
];

impl Kind {
    /// The type of that name or other name; `-`, blanks and capitals do not matter.
    pub fn find(name: &str) -> Option<&'static Self> {
        let plain = |text: &str| text.trim().to_lowercase().replace(['-', ' '], "_");
        let wanted = plain(name);
        KINDS.iter().find(|k| k.name == wanted || k.aliases.iter().any(|alias| plain(alias) == wanted))
    }

    /// In which quantities a ship is outside the range of its type, each as a sentence; `froude` is that of its service speed.
    pub fn outside(&self, [length, breadth, draught]: [f64; 3], froude: f64) -> Vec<String> {
        // Watson's line is drawn over this range of Froude numbers.
        let speeds = [0.14, 0.34];
        [
            ("L", "m", length, self.length),
            ("L/B", "", length / breadth, self.slenderness),
            ("B/d", "", breadth / draught, self.beam),
            ("the Froude number", "", froude, speeds),
        ]
        .iter()
        .filter(|(_, _, value, [low, high])| value < low || value > high)
        .map(|(what, unit, value, [low, high])| {
            let value = crate::numerals::sig(*value, 3);
            let text = format!("{what} = {value} {unit}, outside {low} to {high} {unit}, the range of {}", self.title);
            text.replace(" ,", ",")
        })
        .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_other_names_find_one_type_each() {
        for kind in &KINDS {
            for name in kind.aliases.iter().chain([&kind.name]) {
                assert_eq!(Kind::find(&name.to_uppercase().replace('_', "-")).map(|k| k.name), Some(kind.name));
            }
        }
        assert_eq!(Kind::find("submarine"), None);
    }

    #[test]
    fn a_ship_outside_the_range_of_its_type_is_reported() {
        let tanker = Kind::find("tanker").unwrap();
        assert!(tanker.outside([320.0, 58.0, 20.8], 0.15).is_empty());
        let said = tanker.outside([20.0, 8.0, 3.0], 0.15);
        assert_eq!(said.len(), 2);
        assert!(
            said[0].starts_with("L = 20.0 m, outside 60 to 380 m") && said[1].starts_with("L/B = 2.50,"),
            "{said:?}"
        );
    }
}
