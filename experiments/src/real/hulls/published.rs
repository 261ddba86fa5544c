//! The low-speed MMG simulator published with the Esso Osaka data, in calm water: a baseline for the fitted model.
//! Its numbers are read from the data set's own files at each use; none of them is kept here, and nothing is fitted.
//!
//! Sources: Miyauchi et al. 2022 (doi 10.1007/s00773-022-00889-3) and Wakita et al. 2022 (doi 10.1007/s00773-021-00867-1),
//! with the options that their files select: hull after Yoshimura 2009, propeller astern after Hachii, normal force after Fujii,
//! rudder inflow after Yoshimura ahead and Kitagawa astern. Axes as everywhere: x forward, y to starboard, origin midship,
//! rudder positive to starboard. Wind is left out.

use crate::truth::laws::crossflow::integrals;
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::path::{Path, PathBuf};
use trimtab::recording::Run;
use trimtab::ship::state::STATES;
use trimtab::simulate::Trajectory;

/// Why the published parameters could not be read.
#[derive(Debug, thiserror::Error)]
pub enum PublishedError {
    /// A file is missing or no CSV.
    #[error("{path}: cannot read the published parameters ({source}); they belong to the data set, put its CSV files there", path = path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The reader's error.
        source: csv::Error,
    },
    /// A value is missing or no number.
    #[error("{path}: no number for `{name}`; use the file as published", path = path.display())]
    Missing {
        /// The file.
        path: PathBuf,
        /// Name of the parameter.
        name: String,
    },
}

/// A file of names and numbers.
struct Values {
    path: PathBuf,
    values: BTreeMap<String, f64>,
}

impl Values {
    /// Reads the first two columns of a CSV file with a header.
    fn read(path: &Path) -> Result<Self, PublishedError> {
        let fail = |source| PublishedError::Read { path: path.to_owned(), source };
        let mut values = BTreeMap::new();
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_path(path).map_err(fail)?;
        for record in reader.records() {
            let record = record.map_err(fail)?;
            if let (Some(name), Some(Ok(value))) = (record.get(0), record.get(1).map(str::parse)) {
                values.insert(name.to_owned(), value);
            }
        }
        Ok(Self { path: path.to_owned(), values })
    }

    fn get(&self, name: &str) -> Result<f64, PublishedError> {
        let missing = || PublishedError::Missing { path: self.path.clone(), name: name.to_owned() };
        self.values.get(name).copied().filter(|v: &f64| v.is_finite()).ok_or_else(missing)
    }

    /// The values `stem0`, `stem1`, ...
    fn series<const N: usize>(&self, stem: &str) -> Result<[f64; N], PublishedError> {
        let mut values = [0.0; N];
        for (i, value) in values.iter_mut().enumerate() {
            *value = self.get(&format!("{stem}{i}"))?;
        }
        Ok(values)
    }
}

/// A side force or turning moment of the propeller: coefficients of the set and J_s to a dimensionless force.
type SideForce = fn(&[f64; 8], f64) -> f64;

/// The published simulator. Coefficients are dimensionless with 1/2 rho L d, lengths in metres.
#[derive(Clone, Debug)]
pub struct PublishedMmg {
    length: f64,
    draught: f64,
    density: f64,
    mass: f64,
    mass_x: f64,
    mass_y: f64,
    inertia: f64,
    x_g: f64,
    surge_ahead: f64,
    surge_astern: f64,
    xvr: f64,
    yv: f64,
    yr: f64,
    nv: f64,
    nr: f64,
    drag: f64,
    drag_turn_y: f64,
    drag_turn_n: f64,
    diameter: f64,
    pitch: f64,
    thrust: [f64; 3],
    thrust_deduction: f64,
    wake: f64,
    wake_linear: f64,
    wake_square: f64,
    propeller_x: f64,
    side: [f64; 8],
    turn: [f64; 8],
    astern: [f64; 4],
    rudder_area: f64,
    aspect: f64,
    rudder_x: f64,
    rudder_drag: f64,
    hull_share: f64,
    hull_x: f64,
    lever: f64,
    race: f64,
    race_astern: f64,
    wake_ratio: f64,
    astern_correction: f64,
    straightening_starboard: f64,
    straightening_port: f64,
}

impl PublishedMmg {
    /// Reads `principal_particulars.csv` and `MMG_params.csv` (initial values) from the folder of the data set.
    ///
    /// # Errors
    /// [`PublishedError`], with file and name.
    pub fn read(folder: &Path) -> Result<Self, PublishedError> {
        let ship = Values::read(&folder.join("principal_particulars.csv"))?;
        let p = Values::read(&folder.join("MMG_params.csv"))?;
        Ok(Self {
            length: ship.get("lpp")?,
            draught: ship.get("draft")?,
            density: ship.get("rho_fresh")?,
            mass: ship.get("mass_nd")?,
            mass_x: p.get("massx_nd")?,
            mass_y: p.get("massy_nd")?,
            inertia: p.get("IzzJzz_nd")?,
            x_g: ship.get("x_lcg")?,
            surge_ahead: p.get("xuu_nd")?,
            surge_astern: p.get("coeff_drag_aft")?,
            xvr: p.get("xvr_nd")?,
            yv: p.get("yv_nd")?,
            yr: p.get("yr_nd")?,
            nv: p.get("nv_nd")?,
            nr: p.get("nr_nd")?,
            drag: p.get("coeff_drag_sway")?,
            drag_turn_y: p.get("cry_cross_flow")?,
            drag_turn_n: p.get("crn_cross_flow")?,
            diameter: ship.get("dia_prop")?,
            pitch: ship.get("pitchr")? * ship.get("dia_prop")?,
            thrust: p.series("kt_coeff")?,
            thrust_deduction: p.get("t_prop")?,
            wake: p.get("w_prop_zero")?,
            wake_linear: p.get("tau_prop")?,
            wake_square: p.get("coeff_cp_prop")?,
            propeller_x: p.get("xp_prop_nd")?,
            side: p.series("ai_coeff_prop")?,
            turn: p.series("bi_coeff_prop")?,
            astern: p.series("ci_coeff_prop")?,
            rudder_area: ship.get("area_rudder")?,
            aspect: ship.get("lambda_rudder")?,
            rudder_x: ship.get("x_location_rudder")?,
            rudder_drag: p.get("t_rudder")?,
            hull_share: p.get("ah_rudder")?,
            hull_x: p.get("xh_rudder_nd")?,
            lever: p.get("lr_rudder_nd")?,
            race: p.get("kx_rudder")?,
            race_astern: p.get("kx_rudder_reverse")?,
            wake_ratio: p.get("epsilon_rudder")?,
            astern_correction: p.get("cpr_rudder")?,
            straightening_starboard: p.get("gammaN_rudder")?,
            straightening_port: p.get("gammaP_rudder")?,
        })
    }

    /// Hull force (X, Y, N) \[N, N m\] after Yoshimura, U |beta| and cross-flow strips included:
    /// `X = 1/2 rho L d ((X0F + (X0A - X0F) |beta|/pi) u U + Xvr v r L)`,
    /// `Y = 1/2 rho L d (Yv |u| v + Yr u r L - C_D/L int |v + C_rY r x| (v + C_rY r x) dx)`,
    /// `N = 1/2 rho L^2 d (Nv u v + Nr |u| r L - C_D/L^2 int |v + C_rN r x| (v + C_rN r x) x dx)`.
    fn hull(&self, u: f64, v: f64, r: f64) -> [f64; 3] {
        let l = self.length;
        let pressure = 0.5 * self.density * l * self.draught;
        let beta = v.atan2(u).abs();
        let surge = self.surge_ahead + (self.surge_astern - self.surge_ahead) * beta / PI;
        let (sway, _) = integrals(v, self.drag_turn_y * r, l);
        let (_, yaw) = integrals(v, self.drag_turn_n * r, l);
        [
            pressure * (surge * u * u.hypot(v) + self.xvr * v * r * l),
            pressure * (self.yv * u.abs() * v + self.yr * u * r * l - self.drag / l * sway),
            pressure * l * (self.nv * u * v + self.nr * u.abs() * r * l - self.drag / (l * l) * yaw),
        ]
    }

    /// 1 - w_P: `w = w0 - tau |s| - C_P s^2` with `s = v/U + x_P' r L/U`, ahead only, within (0, 1].
    fn wake_factor(&self, u: f64, v: f64, r: f64) -> f64 {
        if u <= 0.0 {
            return 1.0;
        }
        let s = (v + self.propeller_x * r * self.length) / u.hypot(v).max(1e-7);
        (1.0 - self.wake + self.wake_linear * s.abs() + self.wake_square * s * s).clamp(f64::EPSILON, 1.0)
    }

    /// Propeller force (X, Y, N) \[N, N m\]: `(1-t) K_T(J)` ahead, Hachii's measurements astern; the side force is Ueno's
    /// for n > 0 with sternway, Hachii's for n < 0, and none ahead.
    fn propeller(&self, u: f64, n: f64, wake_factor: f64) -> [f64; 3] {
        if n == 0.0 {
            return [0.0; 3];
        }
        let (l, d) = (self.length, self.diameter);
        let slip = u / (d * n);
        let unit = self.density * d.powi(4) * n * n;
        let pressure = 0.5 * self.density * l * self.draught;
        let [k0, k1, k2] = self.thrust;
        let (x, tip, coefficient): (f64, f64, SideForce) = if n > 0.0 {
            let j = slip * if u >= 0.0 { wake_factor } else { 1.0 };
            let x = unit * (1.0 - self.thrust_deduction) * (k0 + k1 * j + k2 * j * j);
            let side: SideForce = if u >= 0.0 { |_, _| 0.0 } else { |c, j| c[5] * j * j + c[6] * j + c[7] };
            (x, n * self.pitch, side)
        } else {
            let [low, c1, c2, limit] = self.astern;
            let x = unit * if slip >= limit { c1 + c2 * slip } else { low };
            let side: SideForce = if slip < -0.35 {
                |c, j| c[2] + c[3] * j
            } else if slip > -0.06 {
                |c, _| c[4]
            } else {
                |c, j| c[0] + c[1] * j
            };
            (x, n * d, side)
        };
        let side = pressure * tip * tip;
        [x, side * coefficient(&self.side, slip), side * l * coefficient(&self.turn, slip)]
    }

    /// Axial rudder inflow u_R \[m/s\]: the propeller race after Yoshimura where the propeller pushes ahead, Kitagawa's with
    /// the propeller astern, and u with sternway.
    fn rudder_inflow(&self, u: f64, n: f64, wake_factor: f64, propulsion: f64) -> f64 {
        let d = self.diameter;
        let eta = d / (self.rudder_area * self.aspect).sqrt();
        let share = if n > 0.0 { 1.0 - self.thrust_deduction } else { 1.0 };
        let kt = if n == 0.0 { 0.0 } else { propulsion / (self.density * d.powi(4) * n * n * share) };
        let advance = u * wake_factor;
        if n >= 0.0 && kt > 0.0 {
            let kappa = self.race / self.wake_ratio;
            let race = (advance * advance + 8.0 * kt * n * n * d * d / PI).sqrt() - advance;
            let accelerated = advance + kappa * race;
            self.wake_ratio * (eta * accelerated * accelerated + (1.0 - eta) * advance * advance).sqrt()
        } else if u >= 0.0 {
            let outside = advance * self.wake_ratio;
            let inside = outside + n * d * self.race_astern * (8.0 * kt.abs() / PI).sqrt();
            let square = eta * inside * inside.abs() + (1.0 - eta) * outside * outside + self.astern_correction * u * u;
            square.signum() * square.abs().sqrt()
        } else {
            u
        }
    }

    /// Rudder force (X, Y, N) \[N, N m\]: `F_N = 1/2 rho A_R U_R^2 f_alpha sin(alpha_R)`, `f_alpha = 6.13 A/(A + 2.25)`.
    fn rudder(&self, v: f64, r: f64, inflow: f64, delta: f64) -> [f64; 3] {
        let gamma = if v + self.rudder_x * r >= 0.0 { self.straightening_port } else { self.straightening_starboard };
        let lateral = -gamma * (v + self.lever * self.length * r);
        let slope = 6.13 * self.aspect / (self.aspect + 2.25);
        let attack = delta - lateral.atan2(inflow);
        let square = inflow * inflow + lateral * lateral;
        let normal = 0.5 * self.density * self.rudder_area * square * slope * attack.sin();
        let (sin, cos) = delta.sin_cos();
        [
            -(1.0 - self.rudder_drag) * normal * sin,
            -(1.0 + self.hull_share) * normal * cos,
            -(self.rudder_x + self.hull_share * self.hull_x * self.length) * normal * cos,
        ]
    }

    /// Time derivative of `[x, y, psi, u, v, r]` under propeller rate `n` \[rps\] and rudder `delta` \[rad\]:
    /// `(m+mx) u' - (m+my) v r - m xG r^2 = X`, `(m+my) v' + (m+mx) u r + m xG r' = Y`,
    /// `(Iz+Jz+m xG^2) r' + m xG (v' + u r) = N`.
    pub fn rates(&self, state: &[f64; STATES], n: f64, delta: f64) -> [f64; STATES] {
        let [_, _, psi, u, v, r] = *state;
        let l = self.length;
        let unit = 0.5 * self.density * l * l * self.draught;
        let (m, m_x, m_y) = (unit * self.mass, unit * self.mass_x, unit * self.mass_y);
        let x_g = self.x_g * l;
        let wake_factor = self.wake_factor(u, v, r);
        let propeller = self.propeller(u, n, wake_factor);
        let inflow = self.rudder_inflow(u, n, wake_factor, propeller[0]);
        let parts = [self.hull(u, v, r), propeller, self.rudder(v, r, inflow, delta)];
        let [x, y, n] = std::array::from_fn(|i| parts.iter().map(|f| f[i]).sum::<f64>());
        let (sway, coupling, yaw) = (m + m_y, m * x_g, unit * l * l * self.inertia + m * x_g * x_g);
        let y = y - (m + m_x) * u * r;
        let n = n - coupling * u * r;
        let determinant = sway * yaw - coupling * coupling;
        let (sin, cos) = psi.sin_cos();
        [
            u * cos - v * sin,
            u * sin + v * cos,
            r,
            (x + (m + m_y) * v * r + coupling * r * r) / (m + m_x),
            (y * yaw - n * coupling) / determinant,
            (n * sway - y * coupling) / determinant,
        ]
    }

    /// Simulates a window from its initial state: RK4 at 0.1 s or finer, inputs linear between samples.
    pub fn simulate(&self, window: &Run) -> Trajectory {
        let substeps = (window.dt / 0.1).ceil().max(1.0) as usize;
        let h = window.dt / substeps as f64;
        let mut state = window.initial;
        let mut trajectory = Trajectory { dt: window.dt, states: vec![state], diverged_at: None };
        for (k, pair) in window.inputs.windows(2).enumerate() {
            for i in 0..substeps {
                let rates = |s: &[f64; STATES], share: f64| {
                    let at = (i as f64 + share) / substeps as f64;
                    let between = |a: f64, b: f64| a + (b - a) * at;
                    self.rates(s, between(pair[0].n, pair[1].n), between(pair[0].delta, pair[1].delta))
                };
                let moved = |k: &[f64; STATES], h: f64| std::array::from_fn::<f64, STATES, _>(|j| state[j] + h * k[j]);
                let k1 = rates(&state, 0.0);
                let k2 = rates(&moved(&k1, 0.5 * h), 0.5);
                let k3 = rates(&moved(&k2, 0.5 * h), 0.5);
                let k4 = rates(&moved(&k3, h), 1.0);
                state = std::array::from_fn(|j| state[j] + h / 6.0 * (k1[j] + 2.0 * (k2[j] + k3[j]) + k4[j]));
            }
            if !state.iter().all(|s| s.is_finite() && s.abs() < 1e6) {
                trajectory.diverged_at = Some(k + 1);
                return trajectory;
            }
            trajectory.states.push(state);
        }
        trajectory
    }
}
