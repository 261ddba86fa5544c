//! The integrator of the concealed cases: Runge-Kutta at a fine step, orders linear between rows, gusts, and the effects let in.
//! It adds no sensor noise; that is done to its tracks by `noise`.

use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use super::craft::{Craft, Tweak};
use super::design::{Helmsman, PERIOD, Plan, STEPS};
use super::effects::{Entry, Instant, Physics, Window};
use crate::truth::{Inputs, State};

/// Inner steps in one row interval: 0.25 s each.
pub const INNER: usize = 8;
/// Correlation time of gusts \[s\].
pub const GUST_TIME: f64 = 20.0;

/// An effect at work.
pub struct Active {
    /// What is known of it.
    pub entry: &'static Entry,
    /// Its size.
    pub size: f64,
    /// What it does.
    pub physics: Box<dyn Physics>,
    /// For every session, whether it acts there.
    pub sessions: Vec<bool>,
}

impl Active {
    /// Whether it acts in a session.
    pub fn acts_in(&self, session: usize) -> bool {
        self.sessions.get(session).copied().unwrap_or(false)
    }

    /// When it acts in the runs that a diagnosis is given, where its time is limited.
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
    /// Explicit Euler at the row interval: data as a careless simulator makes them.
    Euler,
}

/// Everything around the ship.
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

/// The states between rows, for sensors that look at another time.
pub struct Fine<'a> {
    nodes: &'a [State],
}

impl Fine<'_> {
    /// The state `shift` seconds from row `row`, linear between inner steps and beyond the ends of the run.
    pub fn at(&self, row: usize, shift: f64) -> State {
        let h = PERIOD / INNER as f64;
        let place = (row * INNER) as f64 + shift / h;
        let low = (place.floor().max(0.0) as usize).min(self.nodes.len().saturating_sub(2));
        let (Some(a), Some(b)) = (self.nodes.get(low), self.nodes.get(low + 1)) else { return State::default() };
        let fraction = place - low as f64;
        let (a, b) = (a.to_array(), b.to_array());
        State::from_array(std::array::from_fn(|i| a[i] + fraction * (b[i] - a[i])))
    }
}

/// A run as it really went, and as perfect sensors with the concealed defects would report it.
#[derive(Debug, Clone, PartialEq)]
pub struct Track {
    /// True states at the rows.
    pub truth: Vec<State>,
    /// Reported states `[x, y, psi, u, v, r]`, before noise.
    pub reported: Vec<[f64; 6]>,
    /// Recorded inputs: the orders.
    pub orders: Vec<Inputs>,
    /// Environment channels: header with unit, values.
    pub channels: Vec<(String, Vec<f64>)>,
    /// For every effect, the mean square of its force: X, Y \[N\], N \[N m\].
    pub energy: Vec<[f64; 3]>,
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

/// What holds during one inner step.
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

    fn advance(&self, t: f64, state: &State, inputs: [Inputs; 2], h: f64) -> State {
        let plus = |k: &[f64; 6], h: f64| {
            let s = state.to_array();
            State::from_array(std::array::from_fn(|i| s[i] + h * k[i]))
        };
        let [from, to] = inputs;
        let k1 = self.rates(t, state, &from, None);
        if self.world.method == Method::Euler {
            return plus(&k1, h);
        }
        let middle = Inputs { n: 0.5 * (from.n + to.n), delta: 0.5 * (from.delta + to.delta) };
        let k2 = self.rates(t + 0.5 * h, &plus(&k1, 0.5 * h), &middle, None);
        let k3 = self.rates(t + 0.5 * h, &plus(&k2, 0.5 * h), &middle, None);
        let k4 = self.rates(t + h, &plus(&k3, h), &to, None);
        let slope: [f64; 6] = std::array::from_fn(|i| (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]) / 6.0);
        plus(&slope, h)
    }

    /// Actuators at the end of an inner step.
    fn actuators(&self, h: f64, orders: [Inputs; 2], at: &Inputs, state: &State) -> Inputs {
        let mut actual = orders[1];
        for (_, e) in self.acting() {
            e.physics.actuate(h, orders, at, state, &mut actual);
        }
        actual
    }

    /// Adds the square of each effect's force at a row: what it changes in the accelerations, through the ship's own inertia.
    fn add_energy(&self, t: f64, state: &State, order: &Inputs, actual: &Inputs, energy: &mut [[f64; 3]]) {
        let all = self.rates(t, state, actual, None);
        for (i, e) in self.acting() {
            let inputs = if e.physics.moves_actuators() { order } else { actual };
            let less = self.rates(t, state, inputs, Some(i));
            let force = self.world.craft.inertial_force(std::array::from_fn(|j| all[3 + j] - less[3 + j]));
            if let Some(sum) = energy.get_mut(i) {
                for (s, f) in sum.iter_mut().zip(force) {
                    *s += f * f / (STEPS + 1) as f64;
                }
            }
        }
    }
}

/// Sails one plan; `index` is its place among the plans, `rng` drives its gusts.
pub fn sail(world: &World, plan: &Plan, index: usize, rng: ChaCha8Rng) -> Track {
    let inner = if world.method == Method::Euler { 1 } else { INNER };
    let h = PERIOD / inner as f64;
    let mut gusts = Gusts::new(rng, h);
    let mut state = State { x: plan.start[0], y: plan.start[1], psi: plan.heading, u: plan.speed, v: 0.0, r: 0.0 };
    let mut order = Inputs { n: world.craft.trimmed_rate(plan.speed, 4.15), delta: 0.0 };
    let mut actual = order;
    let mut helmsman = Helmsman::new(plan, world.craft.particulars().length);
    let mut memory = vec![[0.0; 2]; world.effects.len()];
    let mut track = Track {
        truth: Vec::with_capacity(STEPS + 1),
        reported: Vec::with_capacity(STEPS + 1),
        orders: Vec::with_capacity(STEPS + 1),
        channels: Vec::new(),
        energy: vec![[0.0; 3]; world.effects.len()],
    };
    // Where the effects' channels stand among the track's.
    for e in &world.effects {
        for c in e.physics.channels() {
            track.channels.push((format!("{} [{}]", c.name, c.unit), Vec::with_capacity(STEPS + 1)));
        }
    }
    let mut fine = Vec::with_capacity(STEPS * INNER + 1);
    for row in 0..=STEPS {
        let t = row as f64 * PERIOD;
        {
            let step = Step { world, plan, index, gust: gusts.values, memory: &memory };
            step.add_energy(t, &state, &order, &actual, &mut track.energy);
            let (water, _) = step.water(t, &state, None);
            let mut column = track.channels.iter_mut();
            for (i, e) in world.effects.iter().enumerate() {
                let at = step.instant(t, &state, &actual, water, i);
                for c in e.physics.channels() {
                    if let Some((_, values)) = column.next() {
                        values.push((c.value)(&at));
                    }
                }
            }
        }
        track.truth.push(state);
        track.orders.push(order);
        let next = helmsman.next(t, &state, &order);
        for i in 0..inner {
            let part = |f: f64| Inputs {
                n: order.n + f * (next.n - order.n),
                delta: order.delta + f * (next.delta - order.delta),
            };
            let orders = [part(i as f64 / inner as f64), part((i + 1) as f64 / inner as f64)];
            let now = t + i as f64 * h;
            let step = Step { world, plan, index, gust: gusts.values, memory: &memory };
            let reached = step.actuators(h, orders, &actual, &state);
            fine.push(state);
            let (water, _) = step.water(now, &state, None);
            let mut remembered = memory.clone();
            for (j, e) in step.acting() {
                let at = step.instant(now, &state, &actual, water, j);
                if let Some(m) = remembered.get_mut(j) {
                    e.physics.remember(h, &at, m);
                }
            }
            state = step.advance(now, &state, [actual, reached], h);
            memory = remembered;
            actual = reached;
            gusts.advance();
        }
        order = next;
    }
    if inner == INNER {
        report(world, plan, &mut track, &Fine { nodes: &fine });
    } else {
        // Between the rows of an Euler track the ship moves in straight lines.
        let pairs = track.truth.windows(2).flat_map(|w| {
            let (a, b) = (w[0].to_array(), w[1].to_array());
            (0..INNER).map(move |i| {
                State::from_array(std::array::from_fn(|j| a[j] + i as f64 / INNER as f64 * (b[j] - a[j])))
            })
        });
        let mut nodes: Vec<State> = pairs.collect();
        nodes.extend(track.truth.last());
        report(world, plan, &mut track, &Fine { nodes: &nodes });
    }
    track
}

fn report(world: &World, plan: &Plan, track: &mut Track, fine: &Fine<'_>) {
    for (row, state) in track.truth.iter().enumerate() {
        let mut y = state.to_array();
        for e in world.effects.iter().filter(|e| e.acts_in(plan.session)) {
            e.physics.measure(plan.clock + row as f64 * PERIOD, row, fine, &mut y);
        }
        track.reported.push(y);
    }
}
