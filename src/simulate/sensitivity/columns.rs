//! The parameters that sensitivities are carried to, grouped by what they can change, and their own part in the accelerations.
//! How that part is carried through time is in `chain`.

use super::local::{Local, Plain};
use crate::dynamics::Dynamics;
use crate::model::{BASE, Model, Placed};
use crate::physics::{
    Adjust, FEW, Flow, Group, Inflow, Instant, MOST_PARAMETERS, Mobility, Number, Physics, Reach, Term,
};
use crate::state::{Force, Inputs, STATES, State};
use crate::terms::hydrodynamics::hull::{DAMPING, Hull, MassSlope};
use crate::terms::hydrodynamics::resistance::Resistance;
use crate::terms::propulsion::propeller::Propeller;
use crate::terms::steering::rudder::Rudder;

/// A parameter that sensitivities are carried to, in units of `scale`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Column {
    /// Index of the parameter in the model.
    pub parameter: usize,
    /// Unit: the sensitivity is to `parameter / scale`.
    pub scale: f64,
}

/// A column of one term: index of the parameter in the term, index of the column, unit.
type Own = (usize, usize, f64);

/// The columns of one term that act by its own force.
#[derive(Clone)]
struct Owned {
    term: Placed,
    columns: Vec<Own>,
}

/// Places of the terms `flow` and `hull` in a model.
const FLOW: usize = 0;
const HULL: usize = 1;

/// What the columns of a model at given parameter values have in common over a whole simulation.
#[derive(Clone, Debug)]
pub struct Constants<P> {
    /// What the masses change, where no term changes the mass matrix.
    masses: Option<[MassSlope<P>; DAMPING]>,
}

/// What the masses change in a flow.
#[inline(always)]
fn masses<P: Plain>(dynamics: &Dynamics<P>, flow: &Flow<P>) -> [MassSlope<P>; DAMPING] {
    MassSlope::all(dynamics.model().placed()[HULL].part(dynamics.theta()), &flow.adjust, dynamics.model().form)
}

/// Columns grouped by what their parameters can change.
#[derive(Clone, Default)]
pub struct Columns {
    /// All of them, in the order in which results are given.
    all: Vec<Column>,
    /// Linear in the force of hull, resistance, propeller and rudder.
    base: [Vec<Own>; 4],
    /// In the inflow of propeller and rudder.
    flow: Vec<Own>,
    /// In the mass matrix and the force of the hull.
    inertia: Vec<Own>,
    /// Linear in the force of another term.
    linear: Vec<Owned>,
    /// In the force of their own term, at most [`FEW`] each.
    force: Vec<Owned>,
    /// What may change anything, at most [`FEW`] together.
    anything: Vec<Vec<usize>>,
    /// What changes the reports of sensors alone.
    sensors: Vec<usize>,
}

impl Columns {
    /// Groups the columns for a model.
    pub fn new(model: &Model, columns: &[Column]) -> Self {
        let mut out = Self { all: columns.to_vec(), ..Self::default() };
        let mut anything = Vec::new();
        for (place, term) in model.placed().iter().enumerate() {
            let inside = |p: usize| (term.offset..term.offset + term.len).contains(&p);
            let (mut linear, mut force) = (Vec::new(), Vec::new());
            for (c, column) in columns.iter().enumerate().filter(|(_, c)| inside(c.parameter)) {
                let own = (column.parameter - term.offset, c, column.scale);
                match term.term.reach(own.0) {
                    _ if term.term.info().group == Group::Sensor => out.sensors.push(c),
                    Reach::LinearForce => linear.push(own),
                    Reach::Force => force.push(own),
                    Reach::Flow if place == FLOW => out.flow.push(own),
                    Reach::Inertia if place == HULL => out.inertia.push(own),
                    Reach::Flow | Reach::Inertia | Reach::Anything => anything.push(c),
                }
            }
            if (1..BASE.len()).contains(&place) {
                out.base[place - 1] = linear;
            } else if !linear.is_empty() {
                out.linear.push(Owned { term: *term, columns: linear });
            }
            out.force.extend(force.chunks(FEW).map(|columns| Owned { term: *term, columns: columns.to_vec() }));
        }
        out.anything = anything.chunks(FEW).map(<[usize]>::to_vec).collect();
        out
    }

    /// All columns differentiated through the whole dynamics, whatever they reach: the path that the others are tested against.
    #[cfg(test)]
    pub(super) fn through_everything(columns: &[Column]) -> Self {
        let all: Vec<usize> = (0..columns.len()).collect();
        let anything = all.chunks(FEW).map(<[usize]>::to_vec).collect();
        Self { all: columns.to_vec(), anything, ..Self::default() }
    }

    /// What stays as it is over a simulation.
    pub fn constants<P: Plain>(&self, dynamics: &Dynamics<P>) -> Constants<P> {
        let hull = dynamics.model().placed()[HULL].part(dynamics.theta());
        let constant = !self.inertia.is_empty() && dynamics.extras().is_empty();
        Constants { masses: constant.then(|| MassSlope::all(hull, &Adjust::neutral(), dynamics.model().form)) }
    }

    /// How many columns there are.
    pub fn len(&self) -> usize {
        self.all.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// The columns, in order.
    pub fn all(&self) -> &[Column] {
        &self.all
    }

    /// The columns that may change anything, in the groups in which they are differentiated.
    pub fn anything(&self) -> &[Vec<usize>] {
        &self.anything
    }

    /// The columns that change the reports of sensors alone.
    pub fn sensors(&self) -> &[usize] {
        &self.sensors
    }

    /// Parameter values with the derivatives of a group of columns.
    pub fn seeded<P: Plain>(&self, theta: &[P], group: &[usize]) -> Vec<P::Few> {
        let mut seeded: Vec<P::Few> = theta.iter().map(|x| x.few()).collect();
        for (lane, c) in group.iter().enumerate() {
            let Column { parameter, scale } = self.all[*c];
            let (value, mut slopes) = P::parts(&seeded[parameter]);
            slopes[lane] = P::from_f64(scale);
            seeded[parameter] = value.few_with(slopes);
        }
        seeded
    }

    /// Derivatives of the accelerations (u', v', r') into `out` by all columns but those that may change anything and those that
    /// change the reports of sensors.
    #[inline(always)]
    pub fn by_force<P: Plain>(
        &self,
        dynamics: &Dynamics<P>,
        constants: &Constants<P>,
        local: &Local<P>,
        flow: &Flow<P>,
        state: &[P; STATES],
        inputs: &Inputs<P>,
        out: &mut [[P; 3]],
    ) {
        let state = State::from_array(*state);
        let model = dynamics.model();
        let at = &Instant {
            ship: &model.ship,
            small: model.ship.small_speed(),
            form: model.form,
            state: &state,
            heading: local.heading,
            inputs,
        };
        let mobility = dynamics.mobility(flow);
        own::<P, Hull, 19>(&Hull, &self.base[0], at, flow, &mobility, out);
        own::<P, Resistance, 3>(&Resistance, &self.base[1], at, flow, &mobility, out);
        own::<P, Propeller, 1>(&Propeller, &self.base[2], at, flow, &mobility, out);
        if self.flow.is_empty() {
            own::<P, Rudder, 7>(&Rudder, &self.base[3], at, flow, &mobility, out);
        } else {
            self.by_inflow(dynamics, at, flow, &mobility, out);
        }
        if !self.inertia.is_empty() {
            let [du, dv, dr] = [local.rates[3], local.rates[4], local.rates[5]];
            let [ahead, aside] = flow.current;
            let through_water = [du - aside * state.r, dv + ahead * state.r, dr];
            let changing = constants.masses.is_none().then(|| masses(dynamics, flow));
            for slopes in constants.masses.iter().chain(&changing) {
                let forces = slopes.map(|slope| slope.force(flow, &through_water));
                write(&self.inertia, &forces, &mobility, out);
            }
        }
        if self.linear.is_empty() && self.force.is_empty() {
            return;
        }
        for owned in &self.linear {
            if owned.term.len <= FEW_PARAMETERS {
                linear::<P, FEW_PARAMETERS>(owned, at, flow, &mobility, out);
            } else {
                linear::<P, MOST_PARAMETERS>(owned, at, flow, &mobility, out);
            }
        }
        for owned in &self.force {
            nonlinear(dynamics, owned, at, flow, &mobility, out);
        }
    }

    /// The columns that act by the inflow of propeller and rudder: the force's derivatives by the inflow, times the inflow's by them.
    /// With them come those of the rudder, whose law is evaluated for both.
    #[inline(always)]
    fn by_inflow<P: Plain>(
        &self,
        dynamics: &Dynamics<P>,
        at: &Instant<P>,
        flow: &Flow<P>,
        mobility: &Mobility<P>,
        out: &mut [[P; 3]],
    ) {
        let mut rudder = [Force::zero(); 7];
        let forces = P::by_inflow(dynamics, at, flow, &mut rudder);
        write(&self.base[3], &rudder, mobility, out);
        let slopes = flow.slopes(dynamics.model().placed()[FLOW].part(dynamics.theta()), at);
        for (j, c, scale) in &self.flow {
            let Inflow { advance, thrust, propulsion, rudder_u, rudder_v } = slopes[*j];
            let mut force = forces.propulsion * propulsion + forces.rudder_u * rudder_u + forces.rudder_v * rudder_v;
            if !dynamics.extras().is_empty() {
                force += forces.advance * advance + forces.thrust * thrust;
            }
            out[*c] = mobility.accelerations(&force).map(|rate| rate * *scale);
        }
    }
}

/// Forces per unit parameter as accelerations per unit column.
#[inline(always)]
fn write<P: Plain>(columns: &[Own], forces: &[Force<P>], mobility: &Mobility<P>, out: &mut [[P; 3]]) {
    for (j, c, scale) in columns {
        let rates = mobility.accelerations(&forces[*j]);
        out[*c] = if *scale == 1.0 { rates } else { rates.map(|rate| rate * *scale) };
    }
}

/// The columns of a base term with `L` parameters, all linear in its force.
#[inline(always)]
fn own<P: Plain, T: Physics<P> + Term, const L: usize>(
    term: &T,
    columns: &[Own],
    at: &Instant<P>,
    flow: &Flow<P>,
    mobility: &Mobility<P>,
    out: &mut [[P; 3]],
) {
    if columns.is_empty() {
        return;
    }
    let mut forces = [Force::zero(); L];
    term.slopes(&mut [P::zero(); L], at, flow, &mut forces);
    write(columns, &forces, mobility, out);
}

/// Number of parameters that most terms do not exceed: room for more takes longer to clear than their forces to compute.
const FEW_PARAMETERS: usize = 16;

/// Columns that are linear in the force of a term beyond the base, with at most `L` parameters.
fn linear<P: Plain, const L: usize>(
    owned: &Owned,
    at: &Instant<P>,
    flow: &Flow<P>,
    mobility: &Mobility<P>,
    out: &mut [[P; 3]],
) {
    let len = owned.term.len;
    let mut forces = [Force::zero(); L];
    let mut room = [P::zero(); L];
    P::physics(owned.term.term).slopes(&mut room[..len], at, flow, &mut forces[..len]);
    write(&owned.columns, &forces[..len], mobility, out);
}

/// Columns that are not linear in their own term's force: by dual numbers through that term alone.
fn nonlinear<P: Plain>(
    dynamics: &Dynamics<P>,
    owned: &Owned,
    at: &Instant<P>,
    flow: &Flow<P>,
    mobility: &Mobility<P>,
    out: &mut [[P; 3]],
) {
    let mut p = [P::zero().few(); MOST_PARAMETERS];
    let read = owned.term.part(dynamics.theta());
    let p = &mut p[..read.len()];
    for (p, value) in p.iter_mut().zip(read) {
        *p = value.few();
    }
    let own = &mut p[owned.term.before..];
    for (lane, (j, _, scale)) in owned.columns.iter().enumerate() {
        // A parameter may have more than one column: each has a lane of its own.
        let (value, mut slopes) = P::parts(&own[*j]);
        slopes[lane] = P::from_f64(*scale);
        own[*j] = value.few_with(slopes);
    }
    let state = State::from_array(at.state.to_array().map(P::few));
    let inputs = at.inputs.map(P::few);
    let lifted = Instant {
        ship: at.ship,
        small: at.small,
        form: at.form,
        state: &state,
        heading: at.heading.map(P::few),
        inputs: &inputs,
    };
    let force = <P::Few as Number>::physics(owned.term.term).force(p, &lifted, &flow.map(P::few, P::few));
    let parts = [force.x, force.y, force.n].map(|f| P::parts(&f).1);
    for (lane, (_, c, _)) in owned.columns.iter().enumerate() {
        out[*c] = mobility.accelerations(&Force { x: parts[0][lane], y: parts[1][lane], n: parts[2][lane] });
    }
}
