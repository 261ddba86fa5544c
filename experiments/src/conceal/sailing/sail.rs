//! The simulation of a concealed run: Runge-Kutta at a fine step, orders linear between rows, gusts, and the effects.
//! It adds no sensor noise; `noise` does that to its tracks.

use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use super::craft::Craft;
use super::design::Plan;
use super::helm::Helmsman;
use super::track::{Fine, INNER, PERIOD, STEPS, Track};
use super::tweak::Tweak;
use crate::conceal::effects::effect::{Entry, Instant, Physics, Window};
use crate::truth::integrate::{moved, runge_kutta};
use crate::truth::motion::{Inputs, State};

/// Correlation time of gusts \[s\].
pub const GUST_TIME: f64 = 20.0;

/// An effect in a case.
pub struct Active {
    /// Its entry in the catalogue.
    pub entry: &'static Entry,
    /// Its size.
    pub size: f64,
    /// Its action.
    pub physics: Box<dyn Physics>,
    /// For every session, whether it acts there.
    pub sessions: Vec<bool>,
}

impl Active {
    /// Whether it acts in a session.
    pub fn acts_in(&self, session: usize) -> bool {
        self.sessions.get(session).copied().unwrap_or(false)
    }

    /// Its time windows in the runs that a diagnosis is given, where its time is limited.
    pub fn windows(&self, plans: &[Plan]) -> Vec<Window> {
        let given = |w: &Window| plans.get(w.0).is_some_and(|p| !p.test && self.acts_in(p.session));
        self.physics.windows().into_iter().filter(given).collect()
    }
}

/// How the truth is integrated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Runge-Kutta 4 at 0.25 s.
    RungeKutta,
    /// Explicit Euler at the row interval: data of a coarse simulator.
    Euler,
}

impl Method {
    /// Inner steps in one row interval.
    fn steps(self) -> usize {
        match self {
            Self::RungeKutta => INNER,
            Self::Euler => 1,
        }
    }
}

/// The ship and what acts on it.
pub struct World {
    /// The ship.
    pub craft: Craft,
    /// Effects.
    pub effects: Vec<Active>,
    /// Standard deviation of the background gusts: X, Y \[N\], N \[N m\].
    pub gusts: [f64; 3],
    /// Integrator.
    pub method: Method,
}

/// Unit-variance Ornstein-Uhlenbeck processes.
struct Gusts {
    rng: ChaCha8Rng,
    values: [f64; 5],
    keep: f64,
}

impl Gusts {
    fn new(mut rng: ChaCha8Rng, h: f64) -> Self {
        let values = std::array::from_fn(|_| StandardNormal.sample(&mut rng));
        Self { rng, values, keep: (-h / GUST_TIME).exp() }
    }

    fn advance(&mut self) {
        let fresh = (1.0 - self.keep * self.keep).sqrt();
        for v in &mut self.values {
            let z: f64 = StandardNormal.sample(&mut self.rng);
            *v = self.keep * *v + fresh * z;
        }
    }
}

/// One inner step: gusts and the memory of the effects are constant over it.
struct Step<'a> {
    world: &'a World,
    plan: &'a Plan,
    index: usize,
    gust: [f64; 5],
    memory: &'a [[f64; 2]],
}

impl Step<'_> {
    fn acting(&self) -> impl Iterator<Item = (usize, &Active)> {
        let session = self.plan.session;
        self.world.effects.iter().enumerate().filter(move |(_, e)| e.acts_in(session))
    }

    fn instant(&self, t: f64, state: &State, inputs: &Inputs, water: [f64; 3], effect: usize) -> Instant<'_> {
        Instant {
            run: self.index,
            t,
            clock: self.plan.clock + t,
            state: *state,
            water,
            inputs: *inputs,
            course: self.plan.heading,
            gust: [self.gust[3], self.gust[4]],
            memory: self.memory.get(effect).copied().unwrap_or_default(),
            craft: &self.world.craft,
        }
    }

    /// Velocity through the water, and the current on the body axes.
    fn water(&self, t: f64, state: &State, without: Option<usize>) -> ([f64; 3], [f64; 2]) {
        let mut current = [0.0; 2];
        for (i, e) in self.acting() {
            if Some(i) != without {
                let [north, east] = e.physics.current(self.plan.clock + t);
                current = [current[0] + north, current[1] + east];
            }
        }
        let (sin, cos) = state.psi.sin_cos();
        let on_body = [current[0] * cos + current[1] * sin, -current[0] * sin + current[1] * cos];
        ([state.u - on_body[0], state.v - on_body[1], state.r], on_body)
    }

    /// Rates of `[x, y, psi, u, v, r]`, with all effects but `without`.
    fn rates(&self, t: f64, state: &State, inputs: &Inputs, without: Option<usize>) -> [f64; 6] {
        let (water, current) = self.water(t, state, without);
        let mut tweak = Tweak::NEUTRAL;
        let sigma = self.world.gusts;
        let mut force: [f64; 3] = std::array::from_fn(|i| sigma[i] * self.gust[i]);
        for (i, e) in self.acting() {
            if Some(i) != without {
                let at = self.instant(t, state, inputs, water, i);
                e.physics.alter(&at, &mut tweak);
                let own = e.physics.force(&at);
                for (sum, f) in force.iter_mut().zip(own) {
                    *sum += f;
                }
            }
        }
        let [du, dv, dr] = self.world.craft.accelerations(water, inputs, &tweak, force);
        let (sin, cos) = state.psi.sin_cos();
        let (u, v, r) = (state.u, state.v, state.r);
        [u * cos - v * sin, u * sin + v * cos, r, du + current[1] * r, dv - current[0] * r, dr]
    }

    fn advance(&self, t: f64, state: &State, [from, to]: [Inputs; 2], h: f64) -> State {
        if self.world.method == Method::Euler {
            return moved(state, h, &self.rates(t, state, &from, None));
        }
        let middle = Inputs { n: 0.5 * (from.n + to.n), delta: 0.5 * (from.delta + to.delta) };
        runge_kutta(state, h, |fraction, s| {
            let inputs = match fraction {
                0.0 => &from,
                1.0 => &to,
                _ => &middle,
            };
            self.rates(t + fraction * h, s, inputs, None)
        })
    }

    /// Actuators at the end of an inner step.
    fn actuators(&self, h: f64, orders: [Inputs; 2], at: &Inputs, state: &State) -> Inputs {
        let mut actual = orders[1];
        for (_, e) in self.acting() {
            e.physics.actuate(h, orders, at, state, &mut actual);
        }
        actual
    }

    /// The memory of the effects after an inner step.
    fn remembered(&self, t: f64, h: f64, state: &State, inputs: &Inputs) -> Vec<[f64; 2]> {
        let (water, _) = self.water(t, state, None);
        let mut memory = self.memory.to_vec();
        for (j, e) in self.acting() {
            let at = self.instant(t, state, inputs, water, j);
            if let Some(m) = memory.get_mut(j) {
                e.physics.remember(h, &at, m);
            }
        }
        memory
    }

    /// Adds the square of each effect's force at a row: its change of the accelerations times the ship's own inertia.
    fn add_energy(&self, t: f64, state: &State, order: &Inputs, actual: &Inputs, energy: &mut [[f64; 3]]) {
        let all = self.rates(t, state, actual, None);
        for (i, e) in self.acting() {
            let inputs = if e.entry.moves_actuators { order } else { actual };
            let less = self.rates(t, state, inputs, Some(i));
            let force = self.world.craft.inertial_force(std::array::from_fn(|j| all[3 + j] - less[3 + j]));
            if let Some(sum) = energy.get_mut(i) {
                for (s, f) in sum.iter_mut().zip(force) {
                    *s += f * f / (STEPS + 1) as f64;
                }
            }
        }
    }

    /// Adds the value of each environment channel at a row; channels are in the order of the effects.
    fn add_channels(&self, t: f64, state: &State, actual: &Inputs, channels: &mut [(String, Vec<f64>)]) {
        let (water, _) = self.water(t, state, None);
        let mut columns = channels.iter_mut();
        for (i, e) in self.world.effects.iter().enumerate() {
            let at = self.instant(t, state, actual, water, i);
            for (c, (_, values)) in e.physics.channels().iter().zip(&mut columns) {
                values.push((c.value)(&at));
            }
        }
    }
}

/// A run under way: ship, actuators, gusts and the memory of the effects.
struct Voyage<'a> {
    world: &'a World,
    plan: &'a Plan,
    index: usize,
    gusts: Gusts,
    memory: Vec<[f64; 2]>,
    state: State,
    order: Inputs,
    actual: Inputs,
}

impl Voyage<'_> {
    fn step(&self) -> Step<'_> {
        let Self { world, plan, index, gusts, memory, .. } = self;
        Step { world, plan, index: *index, gust: gusts.values, memory }
    }

    /// Adds the present row to the track.
    fn record(&self, t: f64, track: &mut Track) {
        let step = self.step();
        step.add_energy(t, &self.state, &self.order, &self.actual, &mut track.energy);
        step.add_channels(t, &self.state, &self.actual, &mut track.channels);
        track.truth.push(self.state);
        track.orders.push(self.order);
    }

    /// Simulates one row interval in which the orders run linearly to `next`; adds the state before each inner step to `fine`.
    fn advance(&mut self, t: f64, next: Inputs, fine: &mut Vec<State>) {
        let steps = self.world.method.steps();
        let h = PERIOD / steps as f64;
        for i in 0..steps {
            let part = |i: usize| Inputs::between(&self.order, &next, i as f64 / steps as f64);
            let orders = [part(i), part(i + 1)];
            let now = t + i as f64 * h;
            fine.push(self.state);
            let step = self.step();
            let reached = step.actuators(h, orders, &self.actual, &self.state);
            let memory = step.remembered(now, h, &self.state, &self.actual);
            let state = step.advance(now, &self.state, [self.actual, reached], h);
            (self.state, self.memory, self.actual) = (state, memory, reached);
            self.gusts.advance();
        }
        self.order = next;
    }
}

/// Simulates one plan; `index` is its place among the plans, `rng` drives its gusts.
pub fn sail(world: &World, plan: &Plan, index: usize, rng: ChaCha8Rng) -> Track {
    let order = Inputs { n: world.craft.trimmed_rate(plan.speed, 4.15), delta: 0.0 };
    let mut voyage = Voyage {
        world,
        plan,
        index,
        gusts: Gusts::new(rng, PERIOD / world.method.steps() as f64),
        memory: vec![[0.0; 2]; world.effects.len()],
        state: State { x: plan.start[0], y: plan.start[1], psi: plan.heading, u: plan.speed, v: 0.0, r: 0.0 },
        order,
        actual: order,
    };
    let mut helmsman = Helmsman::new(&plan.orders, plan.heading, world.craft.particulars().length);
    let headers = world.effects.iter().flat_map(|e| e.physics.channels());
    let mut track = Track {
        truth: Vec::with_capacity(STEPS + 1),
        reported: Vec::with_capacity(STEPS + 1),
        orders: Vec::with_capacity(STEPS + 1),
        channels: headers.map(|c| (format!("{} [{}]", c.name, c.unit), Vec::with_capacity(STEPS + 1))).collect(),
        energy: vec![[0.0; 3]; world.effects.len()],
    };
    let mut fine = Vec::with_capacity(STEPS * INNER + 1);
    for row in 0..=STEPS {
        let t = row as f64 * PERIOD;
        voyage.record(t, &mut track);
        let next = helmsman.next(t, &voyage.state, &voyage.order);
        voyage.advance(t, next, &mut fine);
    }
    let fine = match world.method {
        Method::RungeKutta => Fine::new(fine),
        Method::Euler => Fine::between_rows(&track.truth),
    };
    track.reported = report(world, plan, &track.truth, &fine);
    track
}

/// The states as the sensors report them, with the concealed defects and without noise.
fn report(world: &World, plan: &Plan, truth: &[State], fine: &Fine) -> Vec<[f64; 6]> {
    let row = |(row, state): (usize, &State)| {
        let mut y = state.to_array();
        for e in world.effects.iter().filter(|e| e.acts_in(plan.session)) {
            e.physics.measure(plan.clock + row as f64 * PERIOD, row, fine, &mut y);
        }
        y
    };
    truth.iter().enumerate().map(row).collect()
}
