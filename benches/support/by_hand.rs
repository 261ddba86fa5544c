//! The rollout of ship A written by hand over `Lanes`, for its model alone: the cost that the library is timed against.
//! It has no terms, no modifiers and no derivatives, and reads from the library the parameter values and recordings only.
//!
//! Equations as in `flow`, `hull` (paper form), `resistance`, `propeller` and `rudder`, with every constant multiplied out
//! beforehand. What this model does not have is left out: current, loss of wake with drift, stall of the rudder.

use std::f64::consts::{PI, TAU};
use trimtab::fit::objectives::cost::weights;
use trimtab::model::Model;
use trimtab::recording::Run;
use trimtab::terms::steering::rudder::{CURVE_LIMIT, PLATE_LIMIT, PLATE_NORMAL};
use trimtab_ad::{Lanes, Scalar};

type State = [Lanes; 6];

/// Rows of the equations of motion: surge and sway force \[N\], yaw moment \[N m\].
type Force = [Lanes; 3];

/// Constants of thrust and rudder inflow.
struct Inflow {
    tiny: f64,
    /// `1e-2 small^2` and `1e-2 small^4`.
    round: [f64; 2],
    tenth: f64,
    wake: f64,
    deduction: f64,
    /// Thrust per `n|n|`, per `|n| V_A` and per `V_A |V_A|`: for a propeller turning ahead, and astern.
    ahead: [f64; 3],
    astern: [f64; 2],
    load: f64,
    race: [f64; 2],
    /// `eta` and `1 - eta`.
    share: [f64; 2],
    wake_ratio: f64,
    lever: f64,
    straightening: f64,
    asymmetry: f64,
}

/// Constants of the hull: coefficients of surge, sway and yaw in the order of the products in `force`.
struct Hull {
    tiny: f64,
    turn: f64,
    surge: [f64; 2],
    sway: [f64; 6],
    yaw: [f64; 6],
    resistance: [f64; 3],
}

/// Constants of propeller force and rudder force.
struct Stern {
    side: f64,
    side_moment: f64,
    pressure: f64,
    lift: [f64; 4],
    drag: [f64; 3],
    rudder_x: f64,
}

/// Ship A with its parameter values.
pub struct ByHand {
    inflow: Inflow,
    hull: Hull,
    stern: Stern,
    /// Inverse mass matrix: surge; sway by force and moment; yaw by force and moment.
    mobility: [f64; 5],
    blocks: Vec<Block>,
    runs: f64,
}

/// Runs side by side; a lane without a run has weight 0.
struct Block {
    dt: f64,
    /// Propeller rate and rudder angle.
    inputs: Vec<[Lanes; 2]>,
    initial: State,
    measured: Vec<State>,
    root: State,
}

impl ByHand {
    /// For a model of ship A in the paper's form without further terms, and runs of equal length measured throughout.
    pub fn new(model: &Model, runs: &[Run]) -> Self {
        let get = |name: &str| {
            let found = model.parameters.iter().find(|p| p.name == name);
            found.unwrap_or_else(|| unreachable!("no parameter {name}")).value
        };
        Self {
            inflow: Inflow::new(model, &get),
            hull: Hull::new(model, &get),
            stern: Stern::new(model, &get),
            mobility: mobility(&get),
            blocks: runs.chunks(Lanes::LANES).map(|runs| Block::new(model, runs)).collect(),
            runs: runs.len() as f64,
        }
    }

    /// The cost.
    pub fn value(&self) -> f64 {
        self.blocks.iter().map(|block| self.squares(block).sum()).sum::<f64>() / self.runs
    }

    fn squares(&self, block: &Block) -> Lanes {
        let mut sum = Lanes::zero();
        let mut state = block.initial;
        for (k, measured) in block.measured.iter().enumerate() {
            if k > 0 {
                self.step(block.dt, &mut state, block.inputs[k - 1]);
            }
            for c in 0..6 {
                let mut difference = measured[c] - state[c];
                if c == 2 {
                    difference -= (difference * (1.0 / TAU)).nearest() * TAU;
                }
                let residual = difference * block.root[c];
                sum = residual.mul_add(residual, sum);
            }
        }
        sum
    }

    /// One step of Euler's method.
    #[inline(always)]
    fn step(&self, dt: f64, state: &mut State, [n, delta]: [Lanes; 2]) {
        let [_, _, psi, u, v, r] = *state;
        let (propulsion, [rudder_u, rudder_v]) = self.inflow.at([u, v, r], n);
        let hull = self.hull.force([u, v, r]);
        let stern = self.stern.force(propulsion, [rudder_u, rudder_v], delta);
        let [x, y, m] = [hull[0] + stern[0], hull[1] + stern[1], hull[2] + stern[2]];
        let [surge, sway, sway_yaw, yaw_sway, yaw] = self.mobility;
        let (sin, cos) = psi.sin_cos();
        let rates =
            [u * cos - v * sin, u * sin + v * cos, r, x * surge, y * sway + m * sway_yaw, y * yaw_sway + m * yaw];
        for (s, rate) in state.iter_mut().zip(rates) {
            *s += rate * dt;
        }
    }
}

impl Block {
    fn new(model: &Model, runs: &[Run]) -> Self {
        let steps = runs[0].inputs.len();
        let run = |lane: usize| &runs[lane.min(runs.len() - 1)];
        let all: Vec<_> = runs.iter().map(|run| weights(&model.ship, run, 0.0314)).collect();
        let root = |lane: usize, c: usize| all.get(lane).map_or(0.0, |w| w[c].sqrt());
        Self {
            dt: runs[0].dt,
            inputs: (0..steps)
                .map(|k| [Lanes::from_fn(|l| run(l).inputs[k].n), Lanes::from_fn(|l| run(l).inputs[k].delta)])
                .collect(),
            initial: std::array::from_fn(|c| Lanes::from_fn(|l| run(l).initial[c])),
            measured: (0..steps)
                .map(|k| std::array::from_fn(|c| Lanes::from_fn(|l| run(l).measured[k][c].unwrap_or_default())))
                .collect(),
            root: std::array::from_fn(|c| Lanes::from_fn(|l| root(l, c))),
        }
    }
}

impl Inflow {
    fn new(model: &Model, get: &dyn Fn(&str) -> f64) -> Self {
        let ship = &model.ship;
        let (small, rho, d) = (ship.small_speed(), ship.hull.water_density, ship.propeller.diameter);
        let k = [get("flow.kt0") * d.powi(4), get("flow.kt1") * d.powi(3), get("flow.kt2") * d.powi(2)];
        let eta = (d / ship.rudder.span).min(1.0);
        Self {
            tiny: small * small,
            round: [1e-2 * small * small, 1e-2 * small.powi(4)],
            tenth: 0.1 * small,
            wake: 0.5 * get("flow.wake"),
            deduction: 1.0 - get("flow.thrust_deduction"),
            ahead: k.map(|k| rho * k),
            astern: [rho * k[0] * get("flow.astern"), rho * k[1] * 0.3],
            load: 8.0 / (PI * rho * d * d),
            race: [get("flow.race"), get("flow.race_astern")],
            share: [eta, 1.0 - eta],
            wake_ratio: get("flow.wake_ratio"),
            lever: get("flow.lever") * ship.hull.lpp,
            straightening: get("flow.straightening"),
            asymmetry: get("flow.asymmetry"),
        }
    }

    /// Net propeller force \[N\] and the rudder's inflow \[m/s\].
    #[inline(always)]
    fn at(&self, [u, v, r]: [Lanes; 3], n: Lanes) -> (Lanes, [Lanes; 2]) {
        let zero = Lanes::zero();
        let abs_u = (u * u + self.tiny).sqrt();
        let advance = u - (u / abs_u + 1.0) * u * self.wake;
        let square = advance * advance + self.round[0];
        let pace = square.sqrt();
        let reverse = n.less(zero);
        let pick = |a: f64, b: f64| Lanes::select(reverse, Lanes::from_f64(a), Lanes::from_f64(b));
        let rate = n.abs();
        let (k0, k1) = (pick(self.astern[0], self.ahead[0]), pick(self.astern[1], self.ahead[1]));
        let thrust = advance * (k1 * rate + pace * self.ahead[2]) + k0 * n * rate;
        let positive = zero.less(thrust);
        let propulsion = Lanes::select(positive, thrust * self.deduction, thrust);

        let c = thrust * self.load;
        let (c_ahead, c_astern) = (Lanes::select(positive, c, zero), Lanes::select(positive, zero, -c));
        let race = ((square + c_ahead).sqrt() - advance.abs()) * self.race[0]
            - ((c_astern + self.round[0]).sqrt() - self.tenth) * self.race[1];
        let a = advance + race;
        let square = a * a.abs() * self.share[0] + advance * advance.abs() * self.share[1];
        let rudder_u = square * self.wake_ratio / (square * square + self.round[1]).sqrt().sqrt();
        let lateral = v + r * self.lever;
        let bend = lateral * self.asymmetry / (lateral * lateral + self.tiny).sqrt();
        (propulsion, [rudder_u, -lateral * (bend + self.straightening)])
    }
}

impl Hull {
    fn new(model: &Model, get: &dyn Fn(&str) -> f64) -> Self {
        let small = model.ship.small_speed();
        let h = |name: &str| get(&format!("hull.{name}"));
        let moment = h("mass") * h("x_g");
        Self {
            tiny: small * small,
            turn: (small / model.ship.hull.lpp).powi(2),
            surge: [h("mass") + h("Xvr") - h("Yvdot"), moment - h("Yrdot")],
            sway: [h("Yv"), h("Yr"), h("Yvv"), h("Yvr"), h("Yrr"), h("mass")],
            yaw: [h("Nv"), h("Nr"), h("Nrr"), h("Nrrv"), h("Nvvr"), moment],
            resistance: [get("resistance.linear"), get("resistance.quadratic"), get("resistance.cubic")],
        }
    }

    /// Hull force and resistance.
    #[inline(always)]
    fn force(&self, [u, v, r]: [Lanes; 3]) -> Force {
        let speed = (u * u + v * v + self.tiny).sqrt();
        let (abs_v, abs_r) = ((v * v + self.tiny).sqrt(), (r * r + self.turn).sqrt());
        let (vr, ur, rr) = (v * r, u * r, r * abs_r);
        let slow = vr / speed;
        let ([a, b], s, n, p) = (self.surge, &self.sway, &self.yaw, &self.resistance);
        [
            vr * a + r * r * b - u * (u * (u * p[2] + p[1]) + p[0]),
            (v * s[0] + r * s[1]) * speed + v * (abs_v * s[2] + abs_r * s[3]) + rr * s[4] - ur * s[5],
            (v * n[0] + r * n[1]) * speed + rr * n[2] + slow * (r * n[3] + v * n[4]) - ur * n[5],
        ]
    }
}

impl Stern {
    fn new(model: &Model, get: &dyn Fn(&str) -> f64) -> Self {
        let ship = &model.ship;
        let side = get("propeller.side_force");
        Self {
            side,
            side_moment: side * ship.propeller_x(),
            pressure: 0.5 * ship.hull.water_density * ship.rudder.area,
            lift: [0, 1, 2, 3].map(|i| get(&format!("rudder.lift{i}"))),
            drag: [0, 1, 2].map(|i| get(&format!("rudder.drag{i}"))),
            rudder_x: ship.rudder_x(),
        }
    }

    /// Propeller and rudder force.
    #[inline(always)]
    fn force(&self, propulsion: Lanes, [u, v]: [Lanes; 2], delta: Lanes) -> Force {
        let angle = delta - v.atan2(u);
        let angle = angle - (angle * (1.0 / TAU)).nearest() * TAU;
        let a = angle.clamp(-PLATE_LIMIT, PLATE_LIMIT);
        let t = ((angle.abs() - CURVE_LIMIT) * (1.0 / (PLATE_LIMIT - CURVE_LIMIT))).clamp(0.0, 1.0);
        let plate = t * t * t * ((t * 6.0 - 15.0) * t + 10.0);
        let curve = -plate + 1.0;
        let (sin, cos) = angle.sin_cos();
        let normal = sin * plate * PLATE_NORMAL;
        let ([l0, l1, l2, l3], [d0, d1, d2]) = (self.lift, self.drag);
        let lift = curve * (a * (a * (a * l3 + l2) + l1) + l0) + normal * cos;
        let drag = curve * (a * (a * d2 + d1) + d0) + normal * sin;
        let speed = (u * u + v * v + 1e-12).sqrt() * self.pressure;
        let side = (v * drag - u * lift) * speed;
        [
            propulsion - (v * lift + u * drag) * speed,
            propulsion * self.side + side,
            propulsion * self.side_moment + side * self.rudder_x,
        ]
    }
}

/// The inverse mass matrix.
fn mobility(get: &dyn Fn(&str) -> f64) -> [f64; 5] {
    let h = |name: &str| get(&format!("hull.{name}"));
    let moment = h("mass") * h("x_g");
    let (sway, yaw) = (h("mass") - h("Yvdot"), h("inertia") - h("Nrdot"));
    let (sway_yaw, yaw_sway) = (moment - h("Yrdot"), moment - h("Nvdot"));
    let inverse = 1.0 / (sway * yaw - sway_yaw * yaw_sway);
    [1.0 / (h("mass") - h("Xudot")), yaw * inverse, -sway_yaw * inverse, -yaw_sway * inverse, sway * inverse]
}
