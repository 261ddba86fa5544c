//! The directions in parameter space along which a filter carries sensitivities, and their part in accelerations and reports.
//! It carries nothing through time: the filter does.

use super::pass::Column;
use crate::dynamics::Dynamics;
use crate::model::{BASE, Model, Placed};
use crate::physics::{FEW, Flow, Group, Probe};
use crate::sensitivity::columns::{self, Columns, Constants};
use crate::sensitivity::{Local, Plain};
use crate::simulate::{Integration, driven};
use crate::state::{Force, Inputs, STATES, State};

/// A model prepared for passes over many runs with the same columns.
pub struct Directions<'a> {
    pub(super) model: &'a Model,
    /// Integration of the step map.
    pub(super) integration: Integration,
    columns: Vec<Column>,
    /// Columns that act by what they reach, and which of all columns they are.
    by_reach: (Columns, Vec<usize>),
    groups: Vec<Together>,
    base: Model,
    /// Whether a term changes what the sensors report.
    pub(super) senses: bool,
}

/// Up to [`FEW`] columns that are differentiated together through the whole dynamics, or by finite amplitudes.
struct Together {
    /// The active terms and those that own the columns.
    view: Model,
    columns: Vec<usize>,
    /// Whether they change what the sensors report and nothing else.
    sensors: bool,
}

/// The directions at the parameter values and inputs of a few runs.
pub(super) struct Prepared<'s, P: Plain> {
    directions: &'s Directions<'s>,
    /// The equations of motion without the terms that do nothing.
    pub(super) dynamics: Dynamics<'s, P>,
    constants: Constants<P>,
    /// Inputs at every instant at which a simulation looks at them.
    pub(super) series: Vec<Inputs<P>>,
    seeded: Vec<Seeded<'s, P>>,
}

/// The parameters of a group with their seeds.
struct Seeded<'s, P: Plain> {
    group: &'s Together,
    dynamics: Dynamics<'s, P::Few>,
    series: Vec<Inputs<P::Few>>,
    tangents: bool,
    probes: Vec<Probed<'s, P>>,
}

/// A model a finite amplitude away.
struct Side<'s, P> {
    dynamics: Dynamics<'s, P>,
    series: Vec<Inputs<P>>,
}

/// A column by finite amplitudes: the difference of two sides times a weight.
struct Probed<'s, P> {
    column: usize,
    high: Side<'s, P>,
    low: Side<'s, P>,
    weight: f64,
}

impl<'a> Directions<'a> {
    /// Prepares the columns; terms at neutral values that no column needs are left out.
    pub(super) fn new(model: &'a Model, integration: Integration, columns: &[Column]) -> Self {
        // A named actuator pushes at its defaults too.
        let acts = |t: &&str| BASE.contains(t) || model.ship.actuator(t).is_some() || !neutral(model, t);
        let active: Vec<&str> = model.term_names().into_iter().filter(acts).collect();
        let base = model.restricted(|t| active.contains(&t));
        let placed = model.placed();
        let owner = |c: usize| placed.iter().find(|t| (t.offset..t.offset + t.len).contains(&columns[c].parameter));
        let of_sensor = |c: usize| owner(c).is_some_and(|t| t.term.info().group == Group::Sensor);
        let reached = |c: usize| Columns::new(model, &[columns[c].exact()]).anything().is_empty();
        let direct = |c: usize| columns[c].probe == Probe::Tangent && !of_sensor(c) && reached(c);
        let (own, mut rest): (Vec<usize>, Vec<usize>) = (0..columns.len()).partition(|c| direct(*c));
        let plain: Vec<columns::Column> = own.iter().map(|c| columns[*c].exact()).collect();
        // Sensors together, the columns of one term side by side.
        rest.sort_by_key(|c| (of_sensor(*c), columns[*c].parameter, *c));
        let together = |group: &[usize]| {
            let name = |t: &Placed| t.term.info().name;
            let owners: Vec<&str> = group.iter().filter_map(|c| owner(*c)).map(name).collect();
            Together {
                view: model.restricted(|t| active.contains(&t) || owners.contains(&t)),
                columns: group.to_vec(),
                sensors: of_sensor(group[0]),
            }
        };
        let alike = |a: &usize, b: &usize| of_sensor(*a) == of_sensor(*b);
        let groups = rest.chunk_by(alike).flat_map(|alike| alike.chunks(FEW)).map(together).collect();
        let senses = base.placed().iter().any(|t| t.term.info().group == Group::Sensor);
        let by_reach = (Columns::new(model, &plain), own);
        Self { model, integration, columns: columns.to_vec(), by_reach, groups, base, senses }
    }

    /// How many columns there are.
    pub(super) fn len(&self) -> usize {
        self.columns.len()
    }

    /// The directions at parameter values, for inputs at the samples of a few runs of sample period `dt` \[s\].
    pub(super) fn at<P: Plain>(&self, theta: &[P], samples: &[Inputs<P>], dt: f64) -> Prepared<'_, P> {
        let dynamics = Dynamics::new(&self.base, theta.to_vec());
        Prepared {
            directions: self,
            constants: self.by_reach.0.constants(&dynamics),
            series: driven(&dynamics, self.integration, dt, samples).into_owned(),
            seeded: self.groups.iter().map(|group| self.seeded(group, theta, samples, dt)).collect(),
            dynamics,
        }
    }

    /// The parameters of a group with their seeds.
    fn seeded<'s, P: Plain>(
        &'s self,
        group: &'s Together,
        theta: &[P],
        samples: &[Inputs<P>],
        dt: f64,
    ) -> Seeded<'s, P> {
        let mut dual: Vec<P::Few> = theta.iter().map(|t| t.few()).collect();
        let mut probes = Vec::new();
        let mut tangents = false;
        let samples = if group.sensors { &[] } else { samples };
        for (lane, c) in group.columns.iter().enumerate() {
            let Column { parameter, scale, probe } = self.columns[*c];
            let side = |amount: f64| {
                let mut theta = theta.to_vec();
                theta[parameter] = theta[parameter] + amount;
                let dynamics = Dynamics::new(&group.view, theta);
                let series = driven(&dynamics, self.integration, dt, samples).into_owned();
                Side { dynamics, series }
            };
            match probe {
                Probe::Tangent => {
                    tangents = true;
                    let (value, mut slopes) = P::parts(&dual[parameter]);
                    slopes[lane] = P::from_f64(scale);
                    dual[parameter] = value.few_with(slopes);
                }
                Probe::Odd => probes.push(Probed { column: *c, high: side(scale), low: side(-scale), weight: 0.5 }),
                Probe::Forward | Probe::Whole => {
                    probes.push(Probed { column: *c, high: side(scale), low: side(0.0), weight: 1.0 });
                }
            }
        }
        let dynamics = Dynamics::new(&group.view, dual);
        let lifted: Vec<Inputs<P::Few>> = samples.iter().map(|i| i.map(P::few)).collect();
        let series = if tangents { driven(&dynamics, self.integration, dt, &lifted).into_owned() } else { Vec::new() };
        Seeded { group, dynamics, series, tangents, probes }
    }
}

/// Whether all parameters of a term have the values at which it does nothing, in every session.
fn neutral(model: &Model, term: &str) -> bool {
    let prefix = format!("{term}.");
    model.parameters.iter().enumerate().filter(|(_, p)| p.name.starts_with(&prefix)).all(|(i, p)| {
        p.value == (p.info.default)(&model.ship)
            && !model.sessions.values().flatten().any(|(j, addition)| *j == i && *addition != 0.0)
    })
}

impl<P: Plain> Prepared<'_, P> {
    /// Derivatives of the accelerations (u', v', r') by the columns at an instant, into `out`. `room` is overwritten.
    pub(super) fn rates(
        &self,
        (local, flow): &(Local<P>, Flow<P>),
        when: usize,
        state: &[P; STATES],
        push: &[P; 3],
        room: &mut Vec<[P; 3]>,
        out: &mut [[P; 3]],
    ) {
        let (columns, own) = &self.directions.by_reach;
        room.resize(own.len(), [P::zero(); 3]);
        columns.by_force(&self.dynamics, &self.constants, local, flow, state, &self.series[when], room);
        own.iter().zip(room.iter()).for_each(|(c, rates)| out[*c] = *rates);
        let [x, y, n] = *push;
        for seed in self.seeded.iter().filter(|seed| !seed.group.sensors) {
            if seed.tangents {
                let force = Force { x: x.few(), y: y.few(), n: n.few() };
                let state = State::from_array(state.map(P::few));
                let rates = seed.dynamics.rates(&state, &seed.series[when], &force).0;
                let slopes: [[P; FEW]; 3] = std::array::from_fn(|i| P::parts(&rates[3 + i]).1);
                for (lane, c) in seed.group.columns.iter().enumerate() {
                    if self.directions.columns[*c].probe == Probe::Tangent {
                        out[*c] = std::array::from_fn(|i| slopes[i][lane]);
                    }
                }
            }
            for probe in &seed.probes {
                let (force, state) = (Force { x, y, n }, State::from_array(*state));
                let rates = |side: &Side<P>| side.dynamics.rates(&state, &side.series[when], &force).0;
                let (high, low) = (rates(&probe.high), rates(&probe.low));
                out[probe.column] = std::array::from_fn(|i| (high[3 + i] - low[3 + i]) * probe.weight);
            }
        }
    }

    /// What the sensors report at a state, and the derivative with respect to the state. Without terms of sensors that is the state.
    pub(super) fn report(&self, state: &[P; STATES], when: usize) -> ([P; STATES], [[P; STATES]; STATES]) {
        P::reported(&self.dynamics, state, &self.series[when])
    }

    /// Derivatives of the report by the columns of sensors: which column, and the report by channel.
    pub(super) fn sensed(&self, state: &[P; STATES], when: usize) -> Vec<(usize, [P; STATES])> {
        if self.seeded.iter().all(|s| !s.group.sensors) {
            return Vec::new();
        }
        let inputs = &self.series[when];
        let (rates, flow) = self.dynamics.rates(&State::from_array(*state), inputs, &Force::zero());
        let (rates, flow) = (rates.map(P::few), flow.map(P::few, P::few));
        let (x, inputs) = (State::from_array(state.map(P::few)), inputs.map(P::few));
        let mut out = Vec::new();
        for seed in self.seeded.iter().filter(|s| s.group.sensors) {
            let slopes = seed.dynamics.measure(&x, &inputs, &rates, &flow).map(|y| P::parts(&y).1);
            let column = |(lane, c): (usize, &usize)| (*c, std::array::from_fn(|j| slopes[j][lane]));
            out.extend(seed.group.columns.iter().enumerate().map(column));
        }
        out
    }
}
