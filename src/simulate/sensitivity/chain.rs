//! Carries a simulation and its derivatives by parameters through every step: `S' = A S + B` at each stage of the method, so
//! that the result is the exact derivative of the discrete simulation. What is done with it is decided by the caller.

use super::columns::{Columns, Constants};
use super::local::{Local, Plain};
use crate::dynamics::Dynamics;
use crate::physics::FEW;
use crate::simulate::{Integration, Method, driven, start};
use crate::state::{Force, Inputs, STATES, State};
use std::borrow::Cow;

/// Derivatives of the state `[x, y, psi, u, v, r]` by one column.
pub type StateSlope<P> = [P; STATES];

/// Columns that are differentiated together through the whole dynamics.
struct Group<'m, P: Plain> {
    columns: Vec<usize>,
    dynamics: Dynamics<'m, P::Few>,
}

/// A model at parameter values, ready to be simulated together with its derivatives by some columns.
pub struct Sensitivity<'m, P: Plain> {
    dynamics: Dynamics<'m, P>,
    columns: &'m Columns,
    constants: Constants<P>,
    anything: Vec<Group<'m, P>>,
    /// All columns in groups, where a term changes what sensors report.
    reported: Vec<Group<'m, P>>,
}

/// The inputs of one run: as recorded, as the ship has them, and with derivatives by the groups of columns.
pub struct Drive<'a, P: Plain> {
    /// Inputs at every instant at which a simulation looks at them.
    pub series: Cow<'a, [Inputs<P>]>,
    anything: Vec<Vec<Inputs<P::Few>>>,
    reported: Vec<Vec<Inputs<P::Few>>>,
}

/// Room for the parameters' own part in the accelerations at each stage of a step.
#[derive(Clone, Debug, Default)]
pub struct Stages<P>([Vec<[P; 3]>; 4]);

impl<P: Plain> Stages<P> {
    /// Room for a number of columns.
    pub fn new(columns: usize) -> Self {
        Self(std::array::from_fn(|_| vec![[P::zero(); 3]; columns]))
    }
}

impl<'m, P: Plain> Sensitivity<'m, P> {
    /// Sensitivities to `columns` at the parameter values of `dynamics`. `sensed` says whether a term of the model changes what
    /// sensors report.
    pub fn new(dynamics: Dynamics<'m, P>, columns: &'m Columns, sensed: bool) -> Self {
        let group = |group: &[usize]| {
            let theta = columns.seeded(dynamics.theta(), group);
            let few = Dynamics::new(dynamics.model(), theta).in_still_water(dynamics.is_still());
            Group { columns: group.to_vec(), dynamics: few }
        };
        let anything = columns.anything().iter().map(|g| group(g)).collect();
        let all: Vec<usize> = if sensed { (0..columns.len()).collect() } else { Vec::new() };
        let reported = all.chunks(FEW).map(group).collect();
        let constants = columns.constants(&dynamics);
        Self { dynamics, columns, constants, anything, reported }
    }

    /// The equations of motion behind it.
    pub fn dynamics(&self) -> &Dynamics<'m, P> {
        &self.dynamics
    }

    /// The inputs of a run from those at its samples.
    pub fn drive<'a>(&self, integration: Integration, dt: f64, samples: &'a [Inputs<P>]) -> Drive<'a, P> {
        let drives = !self.dynamics.extras().is_empty();
        let lifted = |groups: &[Group<P>]| -> Vec<Vec<Inputs<P::Few>>> {
            if !drives || groups.is_empty() {
                return Vec::new();
            }
            let samples: Vec<Inputs<P::Few>> = samples.iter().map(|i| i.map(P::few)).collect();
            groups.iter().map(|g| driven(&g.dynamics, integration, dt, &samples).into_owned()).collect()
        };
        Drive {
            series: driven(&self.dynamics, integration, dt, samples),
            anything: lifted(&self.anything),
            reported: lifted(&self.reported),
        }
    }

    /// The rates at an instant with their Jacobian, and into `out` the accelerations' derivatives by the columns.
    #[inline]
    pub fn stage(
        &self,
        drive: &Drive<P>,
        when: usize,
        state: &[P; STATES],
        push: &Force<P>,
        out: &mut [[P; 3]],
    ) -> Local<P> {
        let inputs = &drive.series[when];
        let (local, flow) = P::linearise(&self.dynamics, state, inputs, push);
        self.columns.by_force(&self.dynamics, &self.constants, &local, &flow, state, inputs, out);
        if !self.anything.is_empty() {
            let lifted = State::from_array(state.map(P::few));
            let push = Force { x: push.x.few(), y: push.y.few(), n: push.n.few() };
            for (g, group) in self.anything.iter().enumerate() {
                let inputs = drive.anything.get(g).map_or_else(|| inputs.map(P::few), |series| series[when]);
                let rates = group.dynamics.rates(&lifted, &inputs, &push).0;
                let slopes: [[P; FEW]; 3] = std::array::from_fn(|i| P::parts(&rates[3 + i]).1);
                for (lane, c) in group.columns.iter().enumerate() {
                    out[*c] = std::array::from_fn(|i| slopes[i][lane]);
                }
            }
        }
        local
    }

    /// Advances a state and its derivatives over one sample period that begins at instant `from` of the run.
    pub fn step(
        &self,
        integration: Integration,
        dt: f64,
        drive: &Drive<P>,
        from: usize,
        state: &mut [P; STATES],
        slopes: &mut [StateSlope<P>],
        stages: &mut Stages<P>,
    ) {
        let count = integration.substeps.max(1);
        let h = dt / count as f64;
        let calm = Force::zero();
        for i in 0..count {
            match integration.method {
                Method::Euler => {
                    let local = self.stage(drive, from + i, state, &calm, &mut stages.0[0]);
                    if self.dynamics.is_still() {
                        euler::<P, false>(&local, h, slopes, &stages.0[0]);
                    } else {
                        euler::<P, true>(&local, h, slopes, &stages.0[0]);
                    }
                    *state = moved(state, h, &local.rates);
                }
                Method::Rk4 => {
                    let at = from + 2 * i;
                    let [b1, b2, b3, b4] = &mut stages.0;
                    let one = self.stage(drive, at, state, &calm, b1);
                    let two = self.stage(drive, at + 1, &moved(state, 0.5 * h, &one.rates), &calm, b2);
                    let three = self.stage(drive, at + 1, &moved(state, 0.5 * h, &two.rates), &calm, b3);
                    let four = self.stage(drive, at + 2, &moved(state, h, &three.rates), &calm, b4);
                    let locals = [one, two, three, four];
                    for (c, slope) in slopes.iter_mut().enumerate() {
                        let own: [[P; 3]; 4] = std::array::from_fn(|s| stages.0[s][c]);
                        *slope = runge_kutta(&locals, h, slope, &own);
                    }
                    let k: [[P; STATES]; 4] = std::array::from_fn(|s| locals[s].rates);
                    *state =
                        std::array::from_fn(|j| state[j] + (k[0][j] + (k[1][j] + k[2][j]) * 2.0 + k[3][j]) * (h / 6.0));
                }
            }
        }
    }

    /// Simulates a run of `samples` samples and hands what its sensors report, with the derivatives by the columns, to `sink`.
    ///
    /// `initial` is what the sensors report at the start in the channels that are `measured` (1, or 0), see [`start`].
    pub fn rollout(
        &self,
        integration: Integration,
        dt: f64,
        samples: &[Inputs<P>],
        initial: &[P; STATES],
        measured: &[P; STATES],
        mut sink: impl FnMut(usize, &[P; STATES], &[StateSlope<P>]),
    ) {
        let drive = self.drive(integration, dt, samples);
        let mut stages = Stages::new(self.columns.len());
        let mut slopes = vec![[P::zero(); STATES]; self.columns.len()];
        let mut reports = slopes.clone();
        let mut state = *initial;
        for (g, group) in self.reported.iter().enumerate() {
            let inputs = drive.reported.get(g).map_or_else(|| drive.series[0].map(P::few), |series| series[0]);
            let begun = start(&group.dynamics, &inputs, &initial.map(P::few), &measured.map(P::few));
            state = spread(&group.columns, &begun, &mut slopes);
        }
        if !self.reported.is_empty() && self.columns.is_empty() {
            state = start(&self.dynamics, &drive.series[0], initial, measured);
        }
        for k in 0..samples.len() {
            let at = k * integration.instants();
            if self.reported.is_empty() {
                sink(k, &state, &slopes);
            } else {
                let report = self.report(&drive, at, &state, &slopes, &mut reports);
                sink(k, &report, &reports);
            }
            if k + 1 < samples.len() {
                self.step(integration, dt, &drive, at, &mut state, &mut slopes, &mut stages);
            }
        }
    }

    /// What the sensors report of a state, and into `reports` its derivatives by the columns.
    fn report(
        &self,
        drive: &Drive<P>,
        when: usize,
        state: &[P; STATES],
        slopes: &[StateSlope<P>],
        reports: &mut [StateSlope<P>],
    ) -> [P; STATES] {
        let mut report = *state;
        for (g, group) in self.reported.iter().enumerate() {
            let inputs = drive.reported.get(g).map_or_else(|| drive.series[when].map(P::few), |series| series[when]);
            let lifted: [P::Few; STATES] = std::array::from_fn(|j| {
                let mut few = [P::zero(); FEW];
                for (few, c) in few.iter_mut().zip(&group.columns) {
                    *few = slopes[*c][j];
                }
                state[j].few_with(few)
            });
            report = spread(&group.columns, &group.dynamics.report(&lifted, &inputs), reports);
        }
        report
    }
}

/// The values of numbers with derivatives; the derivatives go to their columns.
fn spread<P: Plain>(columns: &[usize], x: &[P::Few; STATES], slopes: &mut [StateSlope<P>]) -> [P; STATES] {
    std::array::from_fn(|j| {
        let (value, few) = P::parts(&x[j]);
        for (c, slope) in columns.iter().zip(few) {
            slopes[*c][j] = slope;
        }
        value
    })
}

/// `x + h k`.
#[inline(always)]
fn moved<P: Plain>(x: &[P; STATES], h: f64, k: &[P; STATES]) -> [P; STATES] {
    std::array::from_fn(|j| x[j] + k[j] * h)
}

/// The rate of a column: the Jacobian of the rates times the column, and the parameter's own part in the accelerations.
///
/// Positions follow kinematics: `d(x')/d psi = -y'`, `d(y')/d psi = x'`. Without `HEADING` no acceleration depends on psi.
#[inline(always)]
fn rate<P: Plain, const HEADING: bool>(local: &Local<P>, s: &StateSlope<P>, own: &[P; 3]) -> StateSlope<P> {
    let [sin, cos] = local.heading;
    let [_, _, psi, u, v, r] = *s;
    let acceleration = |i: usize| {
        let row = &local.jacobian[i];
        let sum = row[3].mul_add(r, row[2].mul_add(v, row[1].mul_add(u, own[i])));
        if HEADING { row[0].mul_add(psi, sum) } else { sum }
    };
    [
        cos.mul_add(u, -(sin.mul_add(v, local.rates[1] * psi))),
        sin.mul_add(u, cos.mul_add(v, local.rates[0] * psi)),
        r,
        acceleration(0),
        acceleration(1),
        acceleration(2),
    ]
}

/// Columns after one step of Euler's method, from the Jacobian at its start. Without `HEADING` no acceleration depends on psi.
#[inline(always)]
pub fn euler<P: Plain, const HEADING: bool>(local: &Local<P>, h: f64, slopes: &mut [StateSlope<P>], own: &[[P; 3]]) {
    let h = P::from_f64(h);
    for (slope, own) in slopes.iter_mut().zip(own) {
        let k = rate::<P, HEADING>(local, slope, own);
        *slope = std::array::from_fn(|j| k[j].mul_add(h, slope[j]));
    }
}

/// A column after one step of the classical Runge-Kutta method, from the Jacobians at its four stages.
#[inline]
pub fn runge_kutta<P: Plain>(
    locals: &[Local<P>; 4],
    h: f64,
    slope: &StateSlope<P>,
    own: &[[P; 3]; 4],
) -> StateSlope<P> {
    let k1 = rate::<P, true>(&locals[0], slope, &own[0]);
    let k2 = rate::<P, true>(&locals[1], &moved(slope, 0.5 * h, &k1), &own[1]);
    let k3 = rate::<P, true>(&locals[2], &moved(slope, 0.5 * h, &k2), &own[2]);
    let k4 = rate::<P, true>(&locals[3], &moved(slope, h, &k3), &own[3]);
    std::array::from_fn(|j| slope[j] + (k1[j] + (k2[j] + k3[j]) * 2.0 + k4[j]) * (h / 6.0))
}

#[cfg(test)]
mod tests {
    use super::super::columns::Column;
    use super::*;
    use crate::model::Model;
    use crate::physics::{Form, Lanes};
    use crate::ship::Ship;
    use std::path::Path;

    /// Ship A with terms, every parameter off its default inside its bounds.
    fn model(form: Form, terms: &[&str]) -> Model {
        let path = format!("{}/experiments/ships/a.toml", env!("CARGO_MANIFEST_DIR"));
        let mut model = Model::new(Ship::read(Path::new(&path)).unwrap(), "A", form, terms).unwrap();
        for (i, p) in model.parameters.iter_mut().enumerate() {
            let step = p.scale * [0.2, -0.15, 0.1, -0.25, 0.3][i % 5];
            let inside = (p.lower..=p.upper).contains(&(p.value + step));
            p.value += if inside { step } else { -step };
        }
        model
    }

    /// A weaving course with propeller reversals, in wind, current, waves and changing depth; another in each lane.
    fn inputs<P: Plain>(samples: usize) -> Vec<Inputs<P>> {
        let number = |f: &dyn Fn(f64) -> f64| P::gather(|lane| f(lane as f64));
        (0..samples)
            .map(|k| {
                let t = 3.0 * k as f64;
                Inputs {
                    t: number(&|_| t),
                    n: number(&|lane| 2.0 * (0.05 * t + lane).cos()),
                    delta: number(&|lane| 0.4 * (0.07 * t + 2.0 * lane).sin()),
                    wind: [number(&|lane| 6.0 - lane), number(&|_| -3.5)],
                    current: [number(&|_| 0.3), number(&|lane| 0.1 * lane)],
                    waves: [number(&|_| 0.7), number(&|_| 0.4)],
                    draught_to_depth: number(&|_| 0.4 + 1e-3 * t),
                    bank: number(&|_| 4e-3),
                    thruster: number(&|_| 0.6),
                    commands: std::array::from_fn(|slot| {
                        number(&|lane| 0.3 + 0.2 * (0.06 * t + lane + slot as f64).sin())
                    }),
                }
            })
            .collect()
    }

    /// States and slopes at every sample of a simulation.
    fn rolled<P: Plain>(
        model: &Model,
        columns: &Columns,
        integration: Integration,
        still: bool,
    ) -> Vec<([P; STATES], Vec<StateSlope<P>>)> {
        let mut samples = inputs::<P>(40);
        if still {
            samples.iter_mut().for_each(|i| i.current = [P::zero(); 2]);
        }
        let theta = model.values().into_iter().map(P::from_f64).collect();
        let dynamics = Dynamics::new(model, theta).in_still_water(still);
        let initial = [0.0, 0.0, 0.4, 4.0, -0.3, 0.004].map(P::from_f64);
        let mut out = Vec::new();
        let sensitivity = Sensitivity::new(dynamics, columns, false);
        sensitivity.rollout(integration, 3.0, &samples, &initial, &[P::one(); STATES], |_, x, slopes| {
            out.push((*x, slopes.to_vec()));
        });
        out
    }

    fn assert_same<P: Plain>(model: &Model, integration: Integration, still: bool) {
        let column = |parameter: usize| Column { parameter, scale: model.parameters[parameter].scale };
        let all: Vec<Column> = (0..model.parameters.len()).map(column).collect();
        let (by_reach, general) = (Columns::new(model, &all), Columns::through_everything(&all));
        assert!(by_reach.anything().len() < general.anything().len());
        let ours = rolled::<P>(model, &by_reach, integration, still);
        let theirs = rolled::<P>(model, &general, integration, still);
        for lane in 0..P::WIDTH {
            for (c, p) in model.parameters.iter().enumerate() {
                for j in 0..STATES {
                    let size = theirs.iter().map(|(_, s)| s[c][j].in_lane(lane).abs()).fold(1e-9, f64::max);
                    for (k, ((x, ours), (y, theirs))) in ours.iter().zip(&theirs).enumerate() {
                        let off = (ours[c][j].in_lane(lane) - theirs[c][j].in_lane(lane)).abs();
                        assert!(off < 1e-12 * size, "{} channel {j} sample {k}: {off:e} of {size:e}", p.name);
                        assert_eq!(x[j].in_lane(lane), y[j].in_lane(lane));
                    }
                }
            }
        }
    }

    #[test]
    fn slopes_by_what_a_parameter_reaches_are_those_through_the_whole_dynamics() {
        let (euler, rk4) = (Integration::default(), Integration { method: Method::Rk4, substeps: 2 });
        assert_same::<Lanes>(&model(Form::Paper, &[]), euler, true);
        assert_same::<Lanes>(&model(Form::Regular, &[]), euler, false);
        assert_same::<Lanes>(&model(Form::Paper, &["symmetric", "asymmetric", "hull_nonlinear"]), euler, false);
        assert_same::<f64>(&model(Form::Regular, &["wind", "current", "roll", "loading", "shallow"]), rk4, false);
        assert_same::<Lanes>(&model(Form::Paper, &["thrust_loss", "race", "wake_drift", "rudder_lag"]), rk4, false);
    }
}
