//! A fitted ship in the notation of other programs: its HD coefficients, their primes, and those of the MMG form, with definitions.
//! It converts and simulates nothing: what a term computes is in [`crate::terms`].

mod general;
mod matlab;
mod mmg;

use crate::model::{Model, Parameter};
use crate::physics::Form;
use crate::ship::actuator::Actuator;
use crate::ship::{COEFFICIENTS, Ship};
use serde::Serialize;

/// A coefficient with its definition.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Coefficient {
    /// Name: `Yv`, `mass`, `x_g`.
    pub name: String,
    /// Value in SI units.
    pub value: f64,
    /// SI unit.
    pub unit: String,
    /// What the value is divided by to give the prime, as a formula; absent where it has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub divided_by: Option<String>,
    /// Dimensionless value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub prime: Option<f64>,
    /// Meaning.
    pub about: String,
}

/// A dimensionless coefficient of the MMG form.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Prime {
    /// Name: `m_y`, `Yv`, `Nvvr`.
    pub name: &'static str,
    /// Value.
    pub value: f64,
    /// How it follows from the HD coefficients.
    pub definition: &'static str,
}

/// A number of the ship that the coefficients need.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Particular {
    /// Name: `L`, `rho`.
    pub name: &'static str,
    /// Value in SI units.
    pub value: f64,
    /// SI unit.
    pub unit: &'static str,
    /// Meaning.
    pub about: &'static str,
}

/// A ship in the notation of other programs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Export {
    /// Layout of this document.
    pub schema: &'static str,
    /// Name of the ship.
    pub ship: String,
    /// Name of the model.
    pub model: String,
    /// Axes and signs.
    pub frame: &'static str,
    /// The equations that the HD coefficients belong to.
    pub equations: [&'static str; 4],
    /// How primes are made.
    pub normalisation: &'static str,
    /// How the MMG coefficients differ from the HD ones.
    pub mmg_note: &'static str,
    /// Terms of the model that are not exported.
    pub left_out: Vec<String>,
    /// Ship.
    pub particulars: Vec<Particular>,
    /// Mass, inertia and hydrodynamic coefficients of the hull.
    pub hull: Vec<Coefficient>,
    /// Hull in the MMG form.
    pub mmg: Vec<Prime>,
    /// Resistance, propeller, rudder, and the flow at them, by dotted name; in form `general` the hull's damping.
    pub others: Vec<Coefficient>,
    /// The named actuators of the craft.
    pub actuators: Vec<ExportedActuator>,
}

/// A named actuator of the craft.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExportedActuator {
    /// Its name.
    pub name: String,
    /// Place \[m\], forward of midship.
    pub x: f64,
    /// Place \[m\], to starboard of the centre line.
    pub y: f64,
    /// Direction in which it pushes \[deg\], clockwise from the bow; absent where that is a channel, and where it has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub angle: Option<f64>,
    /// Its force.
    pub equation: &'static str,
    /// Its parameters.
    pub parameters: Vec<Coefficient>,
}

impl Coefficient {
    /// A parameter that has no prime, under a name.
    fn of(p: &Parameter, name: &str) -> Self {
        let (unit, about) = (p.info.unit.to_owned(), p.info.about.to_owned());
        Self { name: name.to_owned(), value: p.value, unit, divided_by: None, prime: None, about }
    }
}

const FRAME: &str = "Origin midship; x forward, y to starboard, psi clockwise from north, r > 0 bow to starboard, rudder angle delta > 0 turns the ship to starboard; SI units and radians.";

const NORMALISATION: &str = "prime = value / (1/2 rho L^a d) for forces over velocities (v' = v/U, r' = r L/U): force 1/2 rho L d U^2, moment 1/2 rho L^2 d U^2; mass 1/2 rho L^2 d, inertia 1/2 rho L^4 d.";

const MMG_NOTE: &str = "MMG form of Yasukawa & Yoshimura 2015 at midship: (m + m_x) u' - (m + m_y) v r - x_G m r^2 = X; (m + m_y) v' + (m + m_x) u r + x_G m r' = Y; (I_z + J_z) r' + x_G m (v' + u r) = N, with I_z about midship. Its Y_r is that of the HD form plus m_x, where u = U; it has no Y_rdot and N_vdot, which are left out; its quadratic coefficients are those of v|v|, v|r|, r|r| and not the cubic ones of that paper.";

/// The equations of motion with U in the linear terms.
fn equations(form: Form) -> [&'static str; 4] {
    let [y, n] = match form {
        Form::Mmg => return mmg::EQUATIONS,
        Form::General => return general::EQUATIONS,
        Form::Paper => [
            "Y = Yv U v + Yr U r + Yvv v|v| + Yvr v|r| + Yrr r|r| - m u r",
            "N = Nv U v + Nr U r + Nrr r|r| + Nrrv r^2 v/U + Nvvr v^2 r/U - m x_g u r",
        ],
        Form::Regular => [
            "Y = Yv |u| v + Yr u r + Yvv v|v| + Yvr v|r| + Yrr r|r| - m u r",
            "N = Nv u v + Nr |u| r + Nrr r|r| + Nrrv r^2 v/U + Nvvr v^2 r/U - m x_g u r",
        ],
    };
    [
        "(m - Xudot) u' = X; (m - Yvdot) v' + (m x_g - Yrdot) r' = Y; (m x_g - Nvdot) v' + (inertia - Nrdot) r' = N; the forces of propeller, rudder and resistance are added to the right",
        "X = (m + Xvr - Yvdot) v r + (m x_g - Yrdot) r^2",
        y,
        n,
    ]
}

/// The hull, propeller, rudder and resistance of a model at its values. Additions in single sessions and terms beyond the base are left out.
#[must_use]
pub fn export(model: &Model) -> Export {
    let ship = &model.ship;
    let h = &ship.hull;
    let unit = |power: i32| 0.5 * h.water_density * h.lpp.powi(power) * h.draught;
    let mut hull = Vec::new();
    // Form `mmg` has other terms in place of some; where these are set all the same, they are named as left out.
    let exported = |p: &&Parameter| !model.replaced(p.info);
    for p in model.parameters.iter().filter(|p| p.name.starts_with("hull.")).filter(exported) {
        let power = match p.info.name {
            "mass" => Some(2),
            "inertia" => Some(4),
            name => COEFFICIENTS.iter().find(|(n, _)| *n == name).map(|(_, power)| *power),
        };
        let (divided_by, prime) = match power {
            Some(1) => (Some("1/2 rho L d".to_owned()), Some(p.value / unit(1))),
            Some(power) => (Some(format!("1/2 rho L^{power} d")), Some(p.value / unit(power))),
            None => (Some("L".to_owned()), Some(p.value / h.lpp)),
        };
        let (name, about) = (p.info.name.to_owned(), p.info.about.to_owned());
        hull.push(Coefficient { name, value: p.value, unit: p.info.unit.to_owned(), divided_by, prime, about });
    }
    let prime = |name: &str| hull.iter().find(|c| c.name == name).and_then(|c| c.prime).unwrap_or(0.0);
    let mut primes = converted(&prime);
    if matches!(model.form, Form::Mmg | Form::General) {
        primes.truncate(MASSES);
    }
    if model.form == Form::Mmg {
        primes.extend(mmg::primes(model).map(|(name, value, definition)| Prime { name, value, definition }));
    }
    let with = ["resistance.", "propeller.", "rudder.", "flow.", "mmg_wake.", "mmg_rudder.", "general_hull."];
    let base = |p: &&Parameter| with.iter().any(|t| p.name.starts_with(t));
    let unnamed = |p: &&Parameter| !exported(p) && p.value != 0.0 && !model.lacks_owner(&p.name);
    let fitted = |p: &&Parameter| !model.lacks_owner(&p.name);
    let others =
        model.parameters.iter().filter(base).filter(exported).filter(fitted).map(|p| Coefficient::of(p, &p.name));
    Export {
        schema: "trimtab-export/1",
        ship: ship.name.clone(),
        model: model.name.clone(),
        frame: FRAME,
        equations: equations(model.form),
        normalisation: NORMALISATION,
        mmg_note: match model.form {
            Form::Mmg => mmg::NOTE,
            Form::General => general::NOTE,
            Form::Paper | Form::Regular => MMG_NOTE,
        },
        left_out: {
            let set = model.parameters.iter().filter(unnamed).map(|p| p.name.clone());
            model.further_terms().iter().map(ToString::to_string).chain(set).collect()
        },
        particulars: particulars(ship),
        mmg: primes,
        others: others.collect(),
        actuators: actuators(model),
        hull,
    }
}

/// The named actuators of the craft with their parameters.
fn actuators(model: &Model) -> Vec<ExportedActuator> {
    let of = |a: &Actuator| {
        let own = format!("{}.", a.name);
        let parameters = model.parameters.iter().filter(|p| p.name.starts_with(&own));
        let equation = model.catalogue().find(&a.name).map_or("", |term| term.info().equation);
        ExportedActuator {
            name: a.name.clone(),
            x: a.x,
            y: a.y,
            angle: a.angle,
            equation,
            parameters: parameters.map(|p| Coefficient::of(p, p.info.name)).collect(),
        }
    };
    model.ship.actuators.iter().map(of).collect()
}

/// What the coefficients need of the ship.
fn particulars(ship: &Ship) -> Vec<Particular> {
    let h = &ship.hull;
    let particular = |name, value, unit, about| Particular { name, value, unit, about };
    let mut all = vec![
        particular("L", h.lpp, "m", "length between perpendiculars"),
        particular("B", h.breadth, "m", "breadth"),
        particular("d", h.draught, "m", "draught"),
        particular("Cb", h.block_coefficient, "-", "block coefficient"),
        particular("rho", h.water_density, "kg/m3", "water density"),
    ];
    if ship.has_propeller() {
        all.push(particular("D", ship.propeller.diameter, "m", "propeller diameter"));
        all.push(particular("x_P", ship.propeller_x(), "m", "propeller, forward of midship"));
    }
    if ship.has_rudder() {
        all.push(particular("A_R", ship.rudder.area, "m2", "rudder area"));
        all.push(particular("H_R", ship.rudder.span, "m", "rudder span"));
        all.push(particular("x_R", ship.rudder_x(), "m", "rudder, forward of midship"));
    }
    let about =
        "in |u|, |v|, U = sqrt(... + small^2) and |r| = sqrt(r^2 + (small/L)^2), so that they are smooth at rest";
    all.push(particular("small", ship.small_speed(), "m/s", about));
    all
}

/// How many of the MMG primes are masses, inertias and their centre: those that every form has, first in the list.
const MASSES: usize = 6;

/// The MMG primes from those of the HD form.
fn converted(prime: &dyn Fn(&str) -> f64) -> Vec<Prime> {
    let same = |name: &'static str, definition: &'static str| Prime { name, value: prime(name), definition };
    vec![
        Prime { name: "m", value: prime("mass"), definition: "m / (1/2 rho L^2 d)" },
        Prime { name: "m_x", value: -prime("Xudot"), definition: "-Xudot / (1/2 rho L^2 d)" },
        Prime { name: "m_y", value: -prime("Yvdot"), definition: "-Yvdot / (1/2 rho L^2 d)" },
        Prime { name: "J_z", value: -prime("Nrdot"), definition: "-Nrdot / (1/2 rho L^4 d)" },
        Prime { name: "I_z", value: prime("inertia"), definition: "inertia about midship / (1/2 rho L^4 d)" },
        Prime { name: "x_G", value: prime("x_g"), definition: "x_g / L" },
        same("Xvr", "Xvr / (1/2 rho L^2 d)"),
        Prime { name: "Xrr", value: -prime("Yrdot"), definition: "-Yrdot / (1/2 rho L^3 d)" },
        same("Yv", "Yv / (1/2 rho L d)"),
        Prime {
            name: "Yr",
            value: prime("Yr") - prime("Xudot"),
            definition: "(Yr - Xudot) / (1/2 rho L^2 d), where u = U",
        },
        same("Nv", "Nv / (1/2 rho L^2 d)"),
        same("Nr", "Nr / (1/2 rho L^3 d)"),
        same("Yvv", "of v'|v'|: Yvv / (1/2 rho L d)"),
        same("Yvr", "of v'|r'|: Yvr / (1/2 rho L^2 d)"),
        same("Yrr", "of r'|r'|: Yrr / (1/2 rho L^3 d)"),
        same("Nrr", "of r'|r'|: Nrr / (1/2 rho L^4 d)"),
        Prime { name: "Nvrr", value: prime("Nrrv"), definition: "of v' r'^2: Nrrv / (1/2 rho L^4 d)" },
        same("Nvvr", "of v'^2 r': Nvvr / (1/2 rho L^3 d)"),
    ]
}
