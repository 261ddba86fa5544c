//! A monomial of the generic force law in SI units: its symbol, the unit of its coefficient, and the coefficient of its parameter.
//! It reads the monomial as the catalogue prints it, and evaluates no force.

use crate::model::Parameter;
use crate::ship::Ship;
use crate::terms::size;

/// What monomials are made of: symbol, powers of metre and second in its unit. Longer symbols come before those that they begin with.
const SYMBOLS: [(&str, [i32; 2]); 15] = [
    ("cos psi", [0, 0]),
    ("sin psi", [0, 0]),
    ("delta", [0, 0]),
    ("U_0", [1, -1]),
    ("|u|", [1, -1]),
    ("|v|", [1, -1]),
    ("|r|", [0, -1]),
    ("|n|", [0, -1]),
    ("u", [1, -1]),
    ("v", [1, -1]),
    ("r", [0, -1]),
    ("n", [0, -1]),
    ("W", [2, -2]),
    ("L", [1, 0]),
    ("D", [1, 0]),
];

/// A force or moment per unit of a monomial.
#[derive(Clone, Debug, PartialEq)]
pub struct Monomial {
    /// The equation it is in: `X`, `Y` or `N`.
    pub axis: char,
    /// Its symbol, `v|v|`; empty for a constant.
    pub symbol: String,
    /// Unit of its coefficient, `N s^2/m^2`; angles are in radians and count as numbers.
    pub unit: String,
    /// Its coefficient where the parameter is 1.
    pub factor: f64,
}

impl Monomial {
    /// Reads the monomial of a parameter of the generic force law; `None` for another parameter. By the convention of that law (the
    /// equations of the terms `symmetric` and `asymmetric`) a parameter without a unit multiplies its monomial times rho D^2 where n is in
    /// it, else 1/2 rho A_R where delta is, else 1/2 rho L d; and times L in N.
    pub fn new(parameter: &Parameter, ship: &Ship) -> Option<Self> {
        let axis = parameter.name.split_once('.')?.1.chars().next().filter(|c| "XYN".contains(*c))?;
        let parts = parts(parameter.info.about)?;
        let has = |symbol: &str| parts.iter().any(|(s, _)| s.trim_matches('|') == symbol);
        let (rho, d) = (ship.hull.water_density, ship.propeller.diameter);
        let mut factor = match parameter.info.unit {
            "-" if has("n") => rho * d * d,
            "-" if has("delta") => 0.5 * rho * ship.rudder.area,
            "-" => size::pressure(ship),
            _ => 1.0,
        };
        if axis == 'N' && parameter.info.unit == "-" {
            factor *= ship.hull.lpp;
        }
        let (mut symbol, mut powers) = (String::new(), [i32::from(axis == 'N'), 0]);
        for (part, power) in parts {
            let size = match part {
                "L" => ship.hull.lpp,
                "D" => d,
                "U_0" => 0.2 * size::speed(ship),
                _ => {
                    push(&mut symbol, part, power);
                    let (_, unit) = SYMBOLS.iter().find(|(s, _)| *s == part)?;
                    (0..2).for_each(|i| powers[i] -= unit[i] * power);
                    continue;
                }
            };
            factor *= size.powi(power);
        }
        Some(Self { axis, symbol, unit: unit(powers), factor })
    }
}

/// The symbols of a monomial with their powers; `None` where it has others.
fn parts(text: &str) -> Option<Vec<(&'static str, i32)>> {
    let mut rest = if text == "constant" { "" } else { text };
    let mut parts = Vec::new();
    while !rest.is_empty() {
        let (symbol, after) = SYMBOLS.iter().find_map(|(s, _)| Some((*s, rest.strip_prefix(s)?)))?;
        let (power, after) = match after.strip_prefix('^') {
            Some(after) => (after.get(..1)?.parse().ok()?, &after[1..]),
            None => (1, after),
        };
        parts.push((symbol, power));
        rest = after.trim_start();
    }
    Some(parts)
}

/// Adds a symbol to a product: `v|v|`, `v r`, `delta^2 W`.
fn push(product: &mut String, symbol: &str, power: i32) {
    if !product.is_empty() && !symbol.starts_with('|') {
        product.push(' ');
    }
    product.push_str(symbol);
    if power != 1 {
        product.push_str(&format!("^{power}"));
    }
}

/// The unit N times powers of metre and second.
fn unit(powers: [i32; 2]) -> String {
    let (mut above, mut below) = ("N".to_owned(), String::new());
    for (power, name) in powers.into_iter().zip(["m", "s"]) {
        let (text, mark) = if power > 0 { (&mut above, ' ') } else { (&mut below, '/') };
        match power.abs() {
            0 => {}
            1 => *text += &format!("{mark}{name}"),
            p => *text += &format!("{mark}{name}^{p}"),
        }
    }
    above + &below
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{model, with};
    use crate::dynamics::Dynamics;
    use crate::state::{Force, Inputs, State};

    fn monomial(name: &str) -> Monomial {
        let model = model();
        Monomial::new(&model.parameters[model.find(name).unwrap()], &model.ship).unwrap()
    }

    #[test]
    fn coefficients_have_the_units_that_make_forces_of_speeds_and_rates() {
        for (name, axis, symbol, unit) in [
            ("symmetric.Y_v_absv", 'Y', "v|v|", "N s^2/m^2"),
            ("symmetric.N_v_absv", 'N', "v|v|", "N s^2/m"),
            ("symmetric.X_u", 'X', "u", "N s/m"),
            ("symmetric.N_absv_r", 'N', "|v| r", "N s^2"),
            ("symmetric.N_r_absr", 'N', "r|r|", "N m s^2"),
            ("symmetric.X_deltadelta", 'X', "delta^2 W", "N s^2/m^2"),
            ("symmetric.Y_delta_n", 'Y', "delta n|n|", "N s^2"),
            ("asymmetric.N_0", 'N', "", "N m"),
            ("asymmetric.X_sin", 'X', "sin psi", "N"),
            ("asymmetric.N_n_absn", 'N', "n|n|", "N m s^2"),
        ] {
            let m = monomial(name);
            assert_eq!((m.axis, m.symbol.as_str(), m.unit.as_str()), (axis, symbol, unit), "{name}");
        }
        let model = model();
        assert!(Monomial::new(&model.parameters[model.find("rudder.lift1").unwrap()], &model.ship).is_none());
    }

    /// A monomial by its symbol alone.
    fn value(symbol: &str, [u, v, r, n, delta, psi, race]: [f64; 7]) -> f64 {
        let of = |(part, power): (&str, i32)| {
            let one = match part.trim_matches('|') {
                "u" => u,
                "v" => v,
                "r" => r,
                "n" => n,
                "delta" => delta,
                "W" => race,
                "cos psi" => psi.cos(),
                "sin psi" => psi.sin(),
                other => panic!("{other} is no motion"),
            };
            if part.starts_with('|') { one.abs().powi(power) } else { one.powi(power) }
        };
        parts(symbol).unwrap().into_iter().map(of).product()
    }

    #[test]
    fn the_equation_gives_the_force_that_the_term_gives_for_every_monomial() {
        let base = model();
        let generic = |p: &&Parameter| p.name.starts_with("symmetric.") || p.name.starts_with("asymmetric.");
        let mut seen = 0;
        for p in base.parameters.iter().filter(generic) {
            let m = Monomial::new(p, &base.ship).unwrap();
            let term = p.name.split('.').next().unwrap();
            for (u, v, r, n, delta, psi) in [(40.0, -7.0, 0.13, 21.0, -0.2, 0.8), (-20.0, 5.0, -0.2, -14.0, 0.35, -2.1)]
            {
                let one = with(&[(p.name.as_str(), 1.0)]);
                let dynamics = Dynamics::new(&one, one.values_in(""));
                let (state, inputs) = (State::from_array([0.0, 0.0, psi, u, v, r]), Inputs::actuators(0.0, n, delta));
                let race = dynamics.flow(&dynamics.instant(&state, &inputs)).rudder_u;
                let all = dynamics.contributions(&state, &inputs);
                let Force { x, y, n: moment } = all.iter().find(|(name, _)| *name == term).unwrap().1;
                let expected = m.factor * value(&m.symbol, [u, v, r, n, delta, psi, race * race.abs()]);
                let force = match m.axis {
                    'X' => x,
                    'Y' => y,
                    _ => moment,
                };
                // Speeds at which it does not matter that the term rounds |.| at small ones.
                assert!((force / expected - 1.0).abs() < 2e-3, "{}: {force} {expected}", p.name);
                assert!([x, y, moment].iter().filter(|f| **f != 0.0).count() == 1, "{}", p.name);
            }
            seen += 1;
        }
        assert_eq!(seen, 49);
    }
}
