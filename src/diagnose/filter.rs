//! An extended Kalman filter whose innovations carry exact, predictable sensitivities to any number of parameters.
//! It knows nothing of mechanisms or verdicts: it turns a run into a log-likelihood, a score vector and an information matrix.
//!
//! State: `[x y psi u v r | w_X w_Y w_N | e_1 .. e_6]`, the ship, an unknown force as three Ornstein-Uhlenbeck processes, and
//! the coloured part of six sensors. The sensitivities follow the filter with its gains held fixed,
//! `d_k = H D_k + dh/dp`, `D_{k+1} = F_k (D_k - G_k d_k) + df/dp`, so that `d_k` depends on the past alone and
//! `g = sum d_k' S_k^-1 e_k` is a martingale: unbiased at the truth whatever is left out of `d_k`.

use super::covariance::{Discrete, Z, initial, predict};
use super::noise::Noise;
use crate::dynamics::Dynamics;
use crate::model::{BASE, Model};
use crate::physics::{FEW, Flow, Group, Probe, Reach};
use crate::recording::Run;
use crate::sensitivity::{Columns, Local, Plain, columns};
use crate::simulate::{Integration, Method, driven, step};
use crate::state::{Force, Inputs, STATES, State};
use nalgebra::{DMatrix, DVector};
use trimtab_ad::Along;

/// Factor on the variance of the unknown force at a sample: where a known event pushed the ship, the force may be anything.
pub fn boost(run: &Run, sample: usize) -> f64 {
    if run.disturbed_at(sample) { 1e4 } else { 1.0 }
}

/// A direction in parameter space along which sensitivities are carried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Column {
    /// Index of the parameter in the model.
    pub parameter: usize,
    /// Unit of the column: the sensitivity is to `parameter / scale`.
    pub scale: f64,
    /// How the derivative is taken.
    pub probe: Probe,
}

impl Column {
    /// The column without its probe.
    fn exact(&self) -> columns::Column {
        columns::Column { parameter: self.parameter, scale: self.scale }
    }

    /// The exact derivative with respect to a parameter, in units of its scale.
    pub fn tangent(model: &Model, parameter: usize) -> Self {
        Self { parameter, scale: model.parameters[parameter].scale, probe: Probe::Tangent }
    }
}

/// Forces on the body axes as functions of the state, added as further columns after the parameters.
pub type ForceBasis<'a> = &'a (dyn Fn(usize, &State<f64>, &Inputs<f64>, &mut Vec<[f64; 3]>) + Sync);

/// What one pass over one run gives.
#[derive(Clone, Debug)]
pub struct Pass {
    /// Log-likelihood of the run.
    pub log_likelihood: f64,
    /// Number of scalar measurements used.
    pub used: usize,
    /// Number of scalar measurements set aside as outliers.
    pub outliers: usize,
    /// Score by column.
    pub score: DVector<f64>,
    /// Information by pairs of columns.
    pub information: DMatrix<f64>,
    /// Standardised innovations by sample and channel; NaN where there was no measurement.
    pub innovations: Vec<[f64; STATES]>,
    /// Filtered state by sample.
    pub filtered: Vec<[f64; Z]>,
    /// Standard deviation of the filtered unknown force in X, Y \[N\], N \[N m\] by sample.
    pub force_sd: Vec<[f64; 3]>,
    /// The linearisation, where asked for.
    pub tangent: Option<Tangent>,
    /// The gains, where asked for.
    pub gains: Option<Gains>,
}

/// The step maps of a run, linearised along its filtered path.
#[derive(Clone, Debug, Default)]
pub struct Tangent {
    /// Point of linearisation by sample.
    pub state: Vec<[f64; STATES]>,
    /// Its image one sample later without unknown force.
    pub image: Vec<[f64; STATES]>,
    /// State Jacobian.
    pub a: Vec<[[f64; STATES]; STATES]>,
    /// Force Jacobian.
    pub gamma: Vec<[[f64; 3]; STATES]>,
    /// What the sensors report at the point of linearisation, less the state.
    pub offset: Vec<[f64; STATES]>,
}

/// The gains of a filter along one run: with them held fixed, the innovations are a smooth function of the parameters whose
/// derivative is exactly what the sensitivities say.
#[derive(Clone, Debug, Default)]
pub struct Gains {
    /// Innovation variance by sample and channel; NaN where the channel was not used.
    pub variance: Vec<[f64; STATES]>,
    /// Gain by sample and channel.
    pub gain: Vec<[[f64; Z]; STATES]>,
}

/// What a pass is asked for beyond scores.
#[derive(Clone, Copy, Default)]
pub struct Wanted<'a> {
    /// Forces added as further columns: how many, and their values.
    pub basis: Option<(usize, ForceBasis<'a>)>,
    /// Store the linearised step maps.
    pub tangent: bool,
    /// Store the gains.
    pub gains: bool,
    /// Use these gains instead of computing them.
    pub frozen: Option<&'a Gains>,
    /// Differentiate the parameters through every stage of the step, instead of by the trapezoidal rule over it.
    pub exact: bool,
}

/// A number with derivatives by a few parameters.
type Few = <f64 as Plain>::Few;

/// A model prepared for passes over many runs with the same columns.
pub struct Filter<'a> {
    model: &'a Model,
    /// Integration of the step map.
    pub integration: Integration,
    columns: Vec<Column>,
    /// Columns that act by the force of their own term, and which of all columns they are.
    by_force: (Columns, Vec<usize>),
    groups: Vec<Together>,
    base: Model,
    senses: bool,
}

/// Up to [`FEW`] columns that are differentiated together through the whole dynamics, or by finite amplitudes.
struct Together {
    /// The active terms and those that own the columns.
    view: Model,
    columns: Vec<usize>,
    /// Whether they change what the sensors report and nothing else.
    sensors: bool,
}

/// Innovations larger than this many standard deviations are set aside as outliers.
pub const GATE: f64 = 6.0;

impl<'a> Filter<'a> {
    /// Prepares passes with these columns; terms at neutral values that no column needs are left out.
    pub fn new(model: &'a Model, integration: Integration, columns: &[Column]) -> Self {
        let neutral = |term: &str| {
            let prefix = format!("{term}.");
            model.parameters.iter().enumerate().filter(|(_, p)| p.name.starts_with(&prefix)).all(|(i, p)| {
                p.value == (p.info.default)(&model.ship)
                    && !model.sessions.values().flatten().any(|(j, addition)| *j == i && *addition != 0.0)
            })
        };
        let active: Vec<&str> = model.term_names().into_iter().filter(|t| BASE.contains(t) || !neutral(t)).collect();
        let base = model.restricted(|t| active.contains(&t));
        let placed = model.placed();
        let owner = |c: usize| placed.iter().find(|t| (t.offset..t.offset + t.len).contains(&columns[c].parameter));
        let of_sensor = |c: usize| owner(c).is_some_and(|t| t.term.info().group == Group::Sensor);
        let forced = |c: usize| {
            let by_force = |t: &crate::model::Placed| t.term.reach(columns[c].parameter - t.offset) != Reach::Anything;
            columns[c].probe == Probe::Tangent && !of_sensor(c) && owner(c).is_some_and(by_force)
        };
        let (own, mut rest): (Vec<usize>, Vec<usize>) = (0..columns.len()).partition(|c| forced(*c));
        let plain: Vec<columns::Column> = own.iter().map(|c| columns[*c].exact()).collect();
        // Sensors together, the columns of one term side by side.
        rest.sort_by_key(|c| (of_sensor(*c), columns[*c].parameter, *c));
        let together = |group: &[usize]| {
            let owners: Vec<&str> = group.iter().filter_map(|c| owner(*c)).map(|t| t.term.info().name).collect();
            Together {
                view: model.restricted(|t| active.contains(&t) || owners.contains(&t)),
                columns: group.to_vec(),
                sensors: of_sensor(group[0]),
            }
        };
        let alike = |a: &usize, b: &usize| of_sensor(*a) == of_sensor(*b);
        let groups = rest.chunk_by(alike).flat_map(|alike| alike.chunks(FEW)).map(together).collect();
        let senses = base.placed().iter().any(|t| t.term.info().group == Group::Sensor);
        let by_force = (Columns::new(model, &plain), own);
        Self { model, integration, columns: columns.to_vec(), by_force, groups, base, senses }
    }

    /// Passes over one run.
    pub fn pass(&self, run: &Run, noise: &Noise, wanted: Wanted) -> Pass {
        let basis = wanted.basis;
        let parameters = self.columns.len();
        let extra = basis.map_or(0, |(n, _)| n);
        let width = parameters + extra;
        let theta = self.model.values_in(&run.session);
        let dynamics = Dynamics::new(&self.base, theta.clone());
        let series = driven(&dynamics, self.integration, run.dt, &run.inputs);
        let instants = self.integration.instants();
        let seeded: Vec<Seeded> = self.groups.iter().map(|g| self.seeded(g, &theta, run)).collect();

        let mut z = [0.0; Z];
        z[..STATES].copy_from_slice(&run.initial);
        let noise = Discrete::new(noise, run.dt);
        let mut p = initial(&noise, self.model);
        let mut d = vec![0.0; Z * width];
        let mut pass = Pass {
            log_likelihood: 0.0,
            used: 0,
            outliers: 0,
            score: DVector::zeros(width),
            information: DMatrix::zeros(width, width),
            innovations: Vec::with_capacity(run.measured.len()),
            filtered: Vec::with_capacity(run.measured.len()),
            force_sd: Vec::with_capacity(run.measured.len()),
            tangent: wanted.tangent.then(Tangent::default),
            gains: wanted.gains.then(Gains::default),
        };
        let mut rows = vec![0.0; STATES * width];
        let mut forces = Vec::with_capacity(extra);
        let mut weighted: Vec<f64> = Vec::new();
        let mut rates_now = vec![0.0; 3 * width];
        let mut rates_next = vec![0.0; 3 * width];
        if parameters > 0 && !wanted.exact {
            let local = f64::linearise(&dynamics, &run.initial, &series[0], &Force::zero());
            self.rate_columns(&dynamics, &local, &seeded, &series, 0, &run.initial, &[0.0; 3], width, &mut rates_now);
        }
        // The accelerations' Jacobian at both ends of a step carries the linearisation over it.
        let smooth = self.integration == Integration { method: Method::Rk4, substeps: 1 } && !wanted.exact;
        let mut slope =
            if smooth { slope_at(&dynamics, &run.initial, &[0.0; 3], &series[0]).0 } else { Slope::default() };
        for k in 0..run.measured.len() {
            let now = &series[k * instants];
            let state: [f64; STATES] = std::array::from_fn(|j| z[j]);
            // What the sensors report, and how that changes with state and parameters.
            let (report, h) = self.report(&dynamics, &state, now);
            let sensing = self.sensing_columns(&dynamics, &seeded, &state, now);
            if let Some(t) = &mut pass.tangent {
                t.offset.push(std::array::from_fn(|j| report[j] - state[j]));
            }
            let mut innovation = [f64::NAN; STATES];
            let mut kept = ([f64::NAN; STATES], [[0.0; Z]; STATES]);
            let reference = z;
            for j in 0..STATES {
                let Some(y) = run.measured[k][j] else { continue };
                // Measurement row: the state through h, and this channel's coloured noise.
                let mut predicted = report[j] + z[9 + j];
                for i in 0..STATES {
                    predicted += h[j][i] * (z[i] - reference[i]);
                }
                let mut e = y - predicted;
                if j == 2 {
                    e = trimtab_ad::smooth::wrap_angle(e);
                }
                let ph: [f64; Z] = std::array::from_fn(|i| {
                    let mut sum = p[i][9 + j];
                    for l in 0..STATES {
                        sum += p[i][l] * h[j][l];
                    }
                    sum
                });
                let mut s = noise.white[j] + ph[9 + j];
                for l in 0..STATES {
                    s += h[j][l] * ph[l];
                }
                if let Some(frozen) = wanted.frozen {
                    s = frozen.variance[k][j];
                    if !s.is_finite() {
                        continue;
                    }
                }
                let sigma = s.sqrt();
                innovation[j] = e / sigma;
                if wanted.frozen.is_none() && e.abs() > GATE * sigma {
                    pass.outliers += 1;
                    pass.log_likelihood -= 0.5 * GATE * GATE + sigma.ln() + 0.5 * (2.0 * std::f64::consts::PI).ln();
                    continue;
                }
                pass.used += 1;
                pass.log_likelihood -= 0.5 * (e * e / s + s.ln() + (2.0 * std::f64::consts::PI).ln());
                if width > 0 {
                    let row = &mut rows[j * width..(j + 1) * width];
                    row.copy_from_slice(&d[(9 + j) * width..(10 + j) * width]);
                    for l in 0..STATES {
                        if h[j][l] != 0.0 {
                            axpy(row, h[j][l], &d[l * width..(l + 1) * width]);
                        }
                    }
                    for (columns, report) in &sensing {
                        for (c, value) in columns.iter().zip(&report[j]) {
                            row[*c] += value;
                        }
                    }
                    let inverse = 1.0 / s;
                    axpy(pass.score.as_mut_slice(), e * inverse, row);
                    let root = inverse.sqrt();
                    weighted.extend(row.iter().map(|v| v * root));
                }
                kept.0[j] = s;
                for i in 0..Z {
                    let gain = wanted.frozen.map_or(ph[i] / s, |f| f.gain[k][j][i]);
                    kept.1[j][i] = gain;
                    z[i] += gain * e;
                    if width > 0 && gain != 0.0 {
                        axpy(&mut d[i * width..(i + 1) * width], -gain, &rows[j * width..(j + 1) * width]);
                    }
                    if wanted.frozen.is_none() {
                        for l in 0..=i {
                            p[i][l] -= gain * ph[l];
                            p[l][i] = p[i][l];
                        }
                    }
                }
            }
            // Information is added in blocks of samples: one matrix product instead of many rank-one updates.
            if width > 0 && (weighted.len() > 64 * width || k + 1 == run.measured.len()) {
                let rows = weighted.len() / width;
                let block = DMatrix::from_column_slice(width, rows, &weighted);
                pass.information.gemm(1.0, &block, &block.transpose(), 1.0);
                weighted.clear();
            }
            if let Some(g) = &mut pass.gains {
                g.variance.push(kept.0);
                g.gain.push(kept.1);
            }
            pass.innovations.push(innovation);
            pass.filtered.push(z);
            pass.force_sd.push(std::array::from_fn(|e| p[6 + e][6 + e].max(0.0).sqrt()));
            if k + 1 == run.measured.len() {
                break;
            }
            // Prediction.
            let state: [f64; STATES] = std::array::from_fn(|j| z[j]);
            let push = [z[6], z[7], z[8]];
            let later = (k + 1) * instants;
            let force = Force { x: push[0], y: push[1], n: push[2] };
            let image = step(&dynamics, self.integration, run.dt, &state, &series[k * instants..], &force);
            let mut exact = Variation::default();
            let mut next = None;
            let (a, gamma) = if wanted.frozen.is_some() && width == 0 && !wanted.tangent {
                Default::default()
            } else if smooth {
                let (end, local) = slope_at(&dynamics, &image, &push, &series[later]);
                next = Some(local);
                let carried = carry(&slope, &end, run.dt);
                slope = end;
                carried
            } else {
                exact = self.variation(
                    wanted.exact,
                    &seeded,
                    &dynamics,
                    &series,
                    k * instants,
                    run.dt,
                    &state,
                    &push,
                    width,
                );
                exact.jacobians()
            };
            forces.clear();
            if let Some((_, f)) = basis {
                f(k, &State::from_array(state), now, &mut forces);
            }
            let mut moved = vec![0.0; Z * width];
            if width > 0 {
                for i in 0..STATES {
                    let row = &mut moved[i * width..(i + 1) * width];
                    for l in 0..STATES {
                        axpy(row, a[i][l], &d[l * width..(l + 1) * width]);
                    }
                    for l in 0..3 {
                        axpy(row, gamma[i][l], &d[(6 + l) * width..(7 + l) * width]);
                    }
                    for (c, f) in forces.iter().enumerate() {
                        row[parameters + c] += gamma[i][0] * f[0] + gamma[i][1] * f[1] + gamma[i][2] * f[2];
                    }
                }
                for i in 0..3 {
                    axpy(
                        &mut moved[(6 + i) * width..(7 + i) * width],
                        noise.fade,
                        &d[(6 + i) * width..(7 + i) * width],
                    );
                }
                for i in 0..STATES {
                    axpy(
                        &mut moved[(9 + i) * width..(10 + i) * width],
                        noise.rho[i],
                        &d[(9 + i) * width..(10 + i) * width],
                    );
                }
                if wanted.exact {
                    (0..STATES).for_each(|i| axpy(&mut moved[i * width..(i + 1) * width], 1.0, exact.parameters(i)));
                } else {
                    // The parameters act through the accelerations: the trapezoidal rule carries them over the step. Any
                    // predictable sensitivity leaves the score unbiased, so that this costs no more than a little power.
                    let faded = push.map(|w| w * noise.fade);
                    let local =
                        next.unwrap_or_else(|| f64::linearise(&dynamics, &image, &series[later], &Force::zero()));
                    self.rate_columns(
                        &dynamics,
                        &local,
                        &seeded,
                        &series,
                        later,
                        &image,
                        &faded,
                        width,
                        &mut rates_next,
                    );
                    let half = 0.5 * run.dt;
                    for i in 0..STATES {
                        let row = &mut moved[i * width..i * width + parameters];
                        for l in 0..3 {
                            axpy(row, half * a[i][3 + l], &rates_now[l * width..l * width + parameters]);
                        }
                        if i >= 3 {
                            axpy(row, half, &rates_next[(i - 3) * width..(i - 3) * width + parameters]);
                        }
                    }
                    std::mem::swap(&mut rates_now, &mut rates_next);
                }
            }
            d = moved;
            if let Some(t) = &mut pass.tangent {
                let free: [f64; STATES] = std::array::from_fn(|i| {
                    image[i] - gamma[i][0] * push[0] - gamma[i][1] * push[1] - gamma[i][2] * push[2]
                });
                t.state.push(state);
                t.image.push(free);
                t.a.push(a);
                t.gamma.push(gamma);
            }
            z[..STATES].copy_from_slice(&image);
            for i in 0..3 {
                z[6 + i] *= noise.fade;
            }
            for i in 0..STATES {
                z[9 + i] *= noise.rho[i];
            }
            if wanted.frozen.is_none() {
                predict(&mut p, &a, &gamma, &noise, boost(run, k));
            }
        }
        pass
    }

    /// The exact derivatives of the step map with respect to state, force and (where any are seeded) parameters: every stage of
    /// the method carries the variational equation along.
    fn variation(
        &self,
        through: bool,
        seeded: &[Seeded],
        dynamics: &Dynamics<f64>,
        series: &[Inputs<f64>],
        from: usize,
        dt: f64,
        state: &[f64; STATES],
        push: &[f64; 3],
        width: usize,
    ) -> Variation {
        let width = if through { width } else { 0 };
        let count = self.integration.substeps.max(1);
        let h = dt / count as f64;
        let mut columns = vec![0.0; 3 * width];
        // Rates of the state and of its derivatives, where both have reached `at` and `v` some instants later.
        let mut rates = |at: &[f64; STATES], v: &Variation, later: usize| {
            let inputs = &series[from + later];
            let (slope, local) = slope_at(dynamics, at, push, inputs);
            if width > 0 {
                self.rate_columns(dynamics, &local, seeded, series, from + later, at, push, width, &mut columns);
            }
            (local.0.rates, v.rate(&slope, &columns))
        };
        let mut x = *state;
        let mut v = Variation::start(width);
        for i in 0..count {
            match self.integration.method {
                Method::Euler => {
                    let (k1, v1) = rates(&x, &v, i);
                    x = moved(&x, h, &k1);
                    v = v.moved(h, &v1);
                }
                Method::Rk4 => {
                    let (k1, v1) = rates(&x, &v, 2 * i);
                    let (k2, v2) = rates(&moved(&x, 0.5 * h, &k1), &v.moved(0.5 * h, &v1), 2 * i + 1);
                    let (k3, v3) = rates(&moved(&x, 0.5 * h, &k2), &v.moved(0.5 * h, &v2), 2 * i + 1);
                    let (k4, v4) = rates(&moved(&x, h, &k3), &v.moved(h, &v3), 2 * i + 2);
                    for (weight, k, w) in [(1.0, &k1, &v1), (2.0, &k2, &v2), (2.0, &k3, &v3), (1.0, &k4, &v4)] {
                        x = moved(&x, weight * h / 6.0, k);
                        v = v.moved(weight * h / 6.0, w);
                    }
                }
            }
        }
        v
    }

    /// Derivatives of the accelerations (u', v', r') with respect to the parameters, row by row, at an instant.
    fn rate_columns(
        &self,
        dynamics: &Dynamics<f64>,
        local: &(Local<f64>, Flow<f64>),
        seeded: &[Seeded],
        series: &[Inputs<f64>],
        when: usize,
        state: &[f64; STATES],
        push: &[f64; 3],
        width: usize,
        out: &mut [f64],
    ) {
        let mut set = |c: usize, rates: [f64; 3]| (0..3).for_each(|i| out[i * width + c] = rates[i]);
        let (columns, own) = &self.by_force;
        let mut rates = vec![[0.0; 3]; own.len()];
        columns.by_force(dynamics, &columns.constants(dynamics), &local.0, &local.1, state, &series[when], &mut rates);
        own.iter().zip(rates).for_each(|(c, rates)| set(*c, rates));
        let [fx, fy, fn_] = *push;
        for (group, seed) in self.groups.iter().zip(seeded).filter(|(group, _)| !group.sensors) {
            if seed.tangents {
                let x = State::from_array(state.map(f64::few));
                let force = Force { x: fx.few(), y: fy.few(), n: fn_.few() };
                let rates = seed.dynamics.rates(&x, &seed.instant(when), &force).0;
                for (lane, c) in group.columns.iter().enumerate() {
                    if self.columns[*c].probe == Probe::Tangent {
                        set(*c, std::array::from_fn(|i| f64::parts(&rates[3 + i]).1[lane]));
                    }
                }
            }
            for probe in &seed.probes {
                let force = Force { x: fx, y: fy, n: fn_ };
                let x = State::from_array(*state);
                let f = |side: &Side| side.dynamics.rates(&x, &side.series[when], &force).0;
                let (high, low) = (f(&probe.high), f(&probe.low));
                set(probe.column, std::array::from_fn(|i| (high[3 + i] - low[3 + i]) * probe.weight));
            }
        }
    }

    /// The parameters of a group with their seeds, for one run.
    fn seeded<'s>(&self, group: &'s Together, theta: &[f64], run: &Run) -> Seeded<'s> {
        let mut dual: Vec<Few> = theta.iter().map(|t| t.few()).collect();
        let mut probes = Vec::new();
        let mut tangents = false;
        let samples = if group.sensors { &[] } else { run.inputs.as_slice() };
        for (lane, c) in group.columns.iter().enumerate() {
            let Column { parameter, scale, probe } = self.columns[*c];
            let side = |amount: f64| {
                let mut theta = theta.to_vec();
                theta[parameter] += amount;
                let dynamics = Dynamics::new(&group.view, theta);
                let series = driven(&dynamics, self.integration, run.dt, samples).into_owned();
                Side { dynamics, series }
            };
            match probe {
                Probe::Tangent => {
                    tangents = true;
                    let (value, mut slopes) = f64::parts(&dual[parameter]);
                    slopes[lane] = scale;
                    dual[parameter] = value.few_with(slopes);
                }
                Probe::Odd => probes.push(Probed { column: *c, high: side(scale), low: side(-scale), weight: 0.5 }),
                Probe::Forward => probes.push(Probed { column: *c, high: side(scale), low: side(0.0), weight: 1.0 }),
            }
        }
        let dynamics = Dynamics::new(&group.view, dual);
        let lifted: Vec<Inputs<Few>> = samples.iter().map(|i| i.map(f64::few)).collect();
        let series =
            if tangents { driven(&dynamics, self.integration, run.dt, &lifted).into_owned() } else { Vec::new() };
        Seeded { dynamics, series, tangents, probes }
    }

    /// What the sensors report at a state, and the derivative with respect to the state.
    fn report(
        &self,
        dynamics: &Dynamics<f64>,
        state: &[f64; STATES],
        inputs: &Inputs<f64>,
    ) -> ([f64; STATES], [[f64; STATES]; STATES]) {
        let identity = std::array::from_fn(|i| std::array::from_fn(|j| if i == j { 1.0 } else { 0.0 }));
        if !self.senses {
            return (*state, identity);
        }
        let x: [Along<f64, 4>; STATES] =
            std::array::from_fn(|j| if j < 2 { Along::constant(state[j]) } else { Along::variable(state[j], j - 2) });
        let y = dynamics.report(&x, inputs);
        // No sensor's error depends on where the ship is.
        let row = |i: usize| std::array::from_fn(|j| if j < 2 { identity[i][j] } else { y[i].eps[j - 2] });
        (y.map(|v| v.re), std::array::from_fn(row))
    }

    /// Derivatives of the report with respect to the sensor parameters, by group: its columns, and the report by channel.
    fn sensing_columns<'s>(
        &'s self,
        dynamics: &Dynamics<f64>,
        seeded: &[Seeded],
        state: &[f64; STATES],
        inputs: &Inputs<f64>,
    ) -> Vec<(&'s [usize], [[f64; FEW]; STATES])> {
        if self.groups.iter().all(|g| !g.sensors) {
            return Vec::new();
        }
        let (rates, flow) = dynamics.rates(&State::from_array(*state), inputs, &Force::zero());
        let (rates, flow) = (rates.map(f64::few), flow.map(f64::few, f64::few));
        let (x, inputs) = (State::from_array(state.map(f64::few)), inputs.map(f64::few));
        let report = |(group, seed): (&'s Together, &Seeded)| {
            let y = seed.dynamics.measure(&x, &inputs, &rates, &flow);
            (group.columns.as_slice(), y.map(|v| f64::parts(&v).1))
        };
        self.groups.iter().zip(seeded).filter(|(g, _)| g.sensors).map(report).collect()
    }
}

/// The Jacobian of the state's rates with respect to state and force, and the rates behind it.
fn slope_at(
    dynamics: &Dynamics<f64>,
    state: &[f64; STATES],
    push: &[f64; 3],
    inputs: &Inputs<f64>,
) -> (Slope, (Local<f64>, Flow<f64>)) {
    let force = Force { x: push[0], y: push[1], n: push[2] };
    let (local, flow) = f64::linearise(dynamics, state, inputs, &force);
    let [sin, cos] = local.heading;
    let mobility = dynamics.mobility(&flow);
    let mut slope = [[0.0; STATES + 3]; STATES];
    (slope[0][2], slope[0][3], slope[0][4]) = (-local.rates[1], cos, -sin);
    (slope[1][2], slope[1][3], slope[1][4]) = (local.rates[0], sin, cos);
    slope[2][5] = 1.0;
    for i in 0..3 {
        slope[3 + i][2..STATES].copy_from_slice(&local.jacobian[i]);
    }
    slope[3][6] = mobility.surge;
    (slope[4][7], slope[4][8]) = (mobility.sway, mobility.sway_yaw);
    (slope[5][7], slope[5][8]) = (mobility.yaw_sway, mobility.yaw);
    (slope, (local, flow))
}

/// `x + h k`.
fn moved(x: &[f64; STATES], h: f64, k: &[f64; STATES]) -> [f64; STATES] {
    std::array::from_fn(|j| x[j] + h * k[j])
}

/// Derivatives of the state at some instant with respect to where the step began: state, force, then parameters, row by row.
#[derive(Clone, Debug, Default)]
struct Variation {
    width: usize,
    rows: Vec<f64>,
}

impl Variation {
    /// What stands before the parameters.
    const FIXED: usize = STATES + 3;

    /// At the start of a step.
    fn start(parameters: usize) -> Self {
        let width = Self::FIXED + parameters;
        let mut rows = vec![0.0; STATES * width];
        (0..STATES).for_each(|i| rows[i * width + i] = 1.0);
        Self { width, rows }
    }

    fn row(&self, i: usize) -> &[f64] {
        &self.rows[i * self.width..(i + 1) * self.width]
    }

    /// Its rate, from the Jacobian of the rates and the parameters' own part in the accelerations.
    fn rate(&self, slope: &Slope, columns: &[f64]) -> Self {
        let width = self.width;
        let parameters = width - Self::FIXED;
        let mut rows = vec![0.0; STATES * width];
        for (i, row) in rows.chunks_exact_mut(width).enumerate() {
            for l in 0..STATES {
                axpy(row, slope[i][l], self.row(l));
            }
            for l in STATES..Self::FIXED {
                row[l] += slope[i][l];
            }
            if i >= 3 {
                axpy(&mut row[Self::FIXED..], 1.0, &columns[(i - 3) * parameters..(i - 2) * parameters]);
            }
        }
        Self { width, rows }
    }

    /// After moving for `h` \[s\] at a rate.
    fn moved(&self, h: f64, rate: &Self) -> Self {
        let mut out = self.clone();
        axpy(&mut out.rows, h, &rate.rows);
        out
    }

    /// With respect to the state and to the force.
    fn jacobians(&self) -> ([[f64; STATES]; STATES], [[f64; 3]; STATES]) {
        (
            std::array::from_fn(|i| std::array::from_fn(|j| self.row(i)[j])),
            std::array::from_fn(|i| std::array::from_fn(|j| self.row(i)[STATES + j])),
        )
    }

    /// Row `i` with respect to the parameters.
    fn parameters(&self, i: usize) -> &[f64] {
        &self.row(i)[Self::FIXED..]
    }
}

/// Jacobian of the six rates with respect to the six states and the three forces.
type Slope = [[f64; STATES + 3]; STATES];

/// The Jacobians of a step from those of the rates at its ends: RK4 on the variational equation, whose slope in the middle is
/// the mean of the ends'.
fn carry(start: &Slope, end: &Slope, h: f64) -> ([[f64; STATES]; STATES], [[f64; 3]; STATES]) {
    const W: usize = STATES + 3;
    let middle: Slope = std::array::from_fn(|i| std::array::from_fn(|j| 0.5 * (start[i][j] + end[i][j])));
    // The rate of [d state / d state, d state / d force] where it has reached `at`.
    let rate = |j: &Slope, at: &Slope| -> Slope {
        std::array::from_fn(|i| {
            let mut row = [0.0; W];
            for l in 0..STATES {
                for c in 0..W {
                    row[c] += j[i][l] * at[l][c];
                }
            }
            for c in 0..3 {
                row[STATES + c] += j[i][STATES + c];
            }
            row
        })
    };
    let mut identity = [[0.0; W]; STATES];
    (0..STATES).for_each(|i| identity[i][i] = 1.0);
    let moved =
        |k: &Slope, h: f64| -> Slope { std::array::from_fn(|i| std::array::from_fn(|c| identity[i][c] + h * k[i][c])) };
    let k1 = rate(start, &identity);
    let k2 = rate(&middle, &moved(&k1, 0.5 * h));
    let k3 = rate(&middle, &moved(&k2, 0.5 * h));
    let k4 = rate(end, &moved(&k3, h));
    let at = |i: usize, c: usize| identity[i][c] + h / 6.0 * (k1[i][c] + 2.0 * (k2[i][c] + k3[i][c]) + k4[i][c]);
    (
        std::array::from_fn(|i| std::array::from_fn(|c| at(i, c))),
        std::array::from_fn(|i| std::array::from_fn(|c| at(i, STATES + c))),
    )
}

/// The parameters of a group with their seeds, for one run.
struct Seeded<'s> {
    dynamics: Dynamics<'s, Few>,
    series: Vec<Inputs<Few>>,
    tangents: bool,
    probes: Vec<Probed<'s>>,
}

struct Side<'s> {
    dynamics: Dynamics<'s, f64>,
    series: Vec<Inputs<f64>>,
}

struct Probed<'s> {
    column: usize,
    high: Side<'s>,
    low: Side<'s>,
    weight: f64,
}

impl Seeded<'_> {
    fn instant(&self, when: usize) -> Inputs<Few> {
        self.series[when]
    }
}

/// `y += a x`.
#[inline]
fn axpy(y: &mut [f64], a: f64, x: &[f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += a * x;
    }
}
