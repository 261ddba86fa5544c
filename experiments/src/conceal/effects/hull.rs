//! Effects of the hull and forces from outside: cross-flow, v^3, sternway, loading, fouling, roll, thruster, pushes.
//! No form here is the fitter's: strips with Yoshimura's weights, plain cubic, second-order roll, a thruster with a cut-off.

use super::effect::{ChannelOf, Class, Compare, Draw, Entry, FORCE, Instant, Physics, Window, ramp};
use crate::conceal::sailing::tweak::Tweak;
use crate::truth::laws::crossflow;

const GRAVITY: f64 = 9.806_65;

/// Cross-flow drag in strips, with Yoshimura's weights of the yaw rate (Esso Osaka) in force and moment.
struct CrossFlow {
    drag: f64,
}

impl Physics for CrossFlow {
    /// Y = -1/2 rho d C_D int |v + 2.217 r x| (v + 2.217 r x) dx, N alike with 0.8097 and the lever x.
    fn force(&self, at: &Instant<'_>) -> [f64; 3] {
        let [_, v, r] = at.water;
        let p = at.craft.particulars();
        let (force, _) = crossflow::integrals(v, 2.217 * r, p.length);
        let (_, moment) = crossflow::integrals(v, 0.8097 * r, p.length);
        let size = -0.5 * p.rho * p.draught * self.drag;
        [0.0, size * force, size * moment]
    }
}

/// Y = -1/2 rho L d c v^3 / U_0, U_0 = 3 m/s, acting 0.05 L ahead of midship: cubic in sway alone.
struct Cubic(f64);

impl Physics for Cubic {
    fn force(&self, at: &Instant<'_>) -> [f64; 3] {
        let p = at.craft.particulars();
        let y = -self.0 * p.force_scale() * at.water[1].powi(3) / 3.0;
        [0.0, y, 0.05 * p.length * y]
    }
}

/// Linear hull terms that change sign with u where they must, and half as much resistance again astern.
struct Sternway(f64);

impl Physics for Sternway {
    fn alter(&self, at: &Instant<'_>, tweak: &mut Tweak) {
        tweak.sternway += self.0;
        tweak.resistance *= 1.0 + 0.5 * self.0 * ramp(-at.water[0], 0.0, 0.5);
    }
}

/// Another loading than the ship file's: mass and yaw inertia up by a share, the centre of gravity moved.
struct Loading {
    share: f64,
    xg: f64,
}

impl Physics for Loading {
    fn alter(&self, _at: &Instant<'_>, tweak: &mut Tweak) {
        tweak.mass *= 1.0 + self.share;
        tweak.xg += self.xg;
    }
}

/// Fouling: X = -1/2 rho S u|u| dC_F over the wetted surface S = L (2 d + B) sqrt(Cb) (about); the fitter scales all of R.
struct Fouling(f64);

impl Physics for Fouling {
    fn force(&self, at: &Instant<'_>) -> [f64; 3] {
        let p = at.craft.particulars();
        let wetted = p.length * (2.0 * p.draught + p.breadth) * p.block().sqrt();
        let u = at.water[0];
        [-0.5 * p.rho * wetted * u * u.abs() * self.0, 0.0, 0.0]
    }
}

/// Roll as a damped oscillator driven by U r; its angle feeds sway and yaw (4 degrees of freedom after Son & Nomoto).
struct Roll {
    yaw: f64,
    omega: f64,
    damping: f64,
}

impl Physics for Roll {
    /// phi'' + 2 zeta w phi' + w^2 phi = w^2 U r/g; N = s 1/2 rho L^2 d U^2 phi, Y = s 1/4 rho L d U^2 phi.
    fn force(&self, at: &Instant<'_>) -> [f64; 3] {
        let p = at.craft.particulars();
        let [u, v, _] = at.water;
        let pressure = self.yaw * p.force_scale() * (u * u + v * v) * at.memory[0];
        [0.0, 0.5 * pressure, p.length * pressure]
    }

    fn remember(&self, h: f64, at: &Instant<'_>, memory: &mut [f64; 2]) {
        let [u, v, r] = at.water;
        let heel = u.hypot(v) * r / GRAVITY;
        let w = self.omega;
        // Velocity first, then angle: stable for w h < 2; here w h < 0.2.
        memory[1] += h * (w * w * (heel - memory[0]) - 2.0 * self.damping * w * memory[1]);
        memory[0] += h * memory[1];
    }
}

fn roll(size: f64, d: &mut Draw<'_>) -> Box<dyn Physics> {
    let (period, damping) = (d.between(8.0, 13.0), d.between(0.1, 0.25));
    Box::new(Roll { yaw: size, omega: 2.0 * std::f64::consts::PI / period, damping })
}

/// A bow thruster with a recorded command. The size is its full thrust \[N\].
struct Thruster {
    thrust: f64,
    /// For every run two bursts: start, length \[s\] and command.
    bursts: Vec<[[f64; 3]; 2]>,
}

/// The full thrust in the ship file \[N\], and its position \[m\].
pub const THRUSTER: [f64; 2] = [40_000.0, 34.0];

impl Thruster {
    fn command(&self, run: usize, t: f64) -> f64 {
        let bursts = self.bursts.get(run).into_iter().flatten();
        let ordered: f64 = bursts
            .map(|[start, length, c]| {
                c * ramp(t, *start, start + 4.0) * (1.0 - ramp(t, start + length, start + length + 4.0))
            })
            .sum();
        // Bursts may overlap; the command is at most full.
        ordered.clamp(-1.0, 1.0)
    }
}

impl Physics for Thruster {
    /// k = 1 + a Fn + b Fn^2, fading out between 3 and 4 m/s; the moment loses less (side-thruster model of the Osaka kind).
    fn force(&self, at: &Instant<'_>) -> [f64; 3] {
        let u = at.water[0].abs();
        let froude = u / (GRAVITY * at.craft.particulars().length).sqrt();
        let fade = 1.0 - ramp(u, 3.0, 4.0);
        let side = (1.0 - 7.0 * froude + 14.0 * froude * froude) * fade;
        let turn = (1.0 - 4.0 * froude + 8.0 * froude * froude) * fade;
        let force = self.thrust * self.command(at.run, at.t);
        [0.0, force * side, force * turn * THRUSTER[1]]
    }

    fn channels(&self) -> Vec<ChannelOf<'_>> {
        vec![ChannelOf { name: "thruster", unit: "-", value: Box::new(|at| self.command(at.run, at.t)) }]
    }

    fn truth(&self) -> Vec<(&'static str, f64, &'static str)> {
        vec![("gain", self.thrust / THRUSTER[0], "-")]
    }
}

fn thruster(size: f64, d: &mut Draw<'_>) -> Box<dyn Physics> {
    let last = d.duration;
    let bursts = (0..d.runs)
        .map(|_| {
            [[0.05, 0.4], [0.5, 0.85]].map(|[from, to]| {
                let start = d.between(from * last, to * last);
                [start, d.between(20.0, 50.0), d.side() * d.between(0.5, 0.96)]
            })
        })
        .collect();
    Box::new(Thruster { thrust: size, bursts })
}

/// A tug or a line that pushes for a while in some runs. The size is the sway force \[N\].
struct Push {
    force: f64,
    along: f64,
    lever: f64,
    windows: Vec<Window>,
}

impl Physics for Push {
    fn force(&self, at: &Instant<'_>) -> [f64; 3] {
        let on = |w: &&Window| w.0 == at.run && at.t > w.1 - 1.0 && at.t < w.2 + 1.0;
        let Some((_, start, end)) = self.windows.iter().find(on) else { return [0.0; 3] };
        // On and off within 2 s, piecewise polynomial; the fitter's edges are hyperbolic tangents.
        let y = self.force * ramp(at.t, start - 1.0, start + 1.0) * (1.0 - ramp(at.t, end - 1.0, end + 1.0));
        [self.along * y, y, self.lever * y]
    }

    fn windows(&self) -> Vec<Window> {
        self.windows.clone()
    }
}

fn push(size: f64, d: &mut Draw<'_>) -> Box<dyn Physics> {
    let side = d.side();
    let along = d.between(-0.3, 0.3);
    let lever = d.side() * d.between(0.15, 0.4) * d.length;
    let duration = d.duration;
    let windows = d.some_runs(0.25).into_iter().enumerate().filter(|(_, chosen)| *chosen).map(|(run, _)| {
        let start = d.between(0.15, 0.6) * duration;
        (run, start, start + d.between(40.0, 80.0).min(0.95 * duration - start))
    });
    Box::new(Push { force: side * size, along, lever, windows: windows.collect() })
}

/// The effects of this file.
pub const ENTRIES: &[Entry] = &[
    Entry {
        name: "crossflow",
        accepted: &["crossflow", "hull_nonlinear"],
        near: &["munk", "symmetric"],
        size: 0.4,
        most: 4.0,
        reference: true,
        law: "strips with weighted yaw rate (Yoshimura)",
        build: |size, _| Box::new(CrossFlow { drag: size }),
        ..FORCE
    },
    Entry {
        name: "hull_cubic",
        accepted: &["hull_nonlinear", "crossflow"],
        near: &["munk", "symmetric"],
        size: 0.6,
        most: 10.0,
        reference: true,
        law: "cubic in sway velocity alone",
        build: |size, _| Box::new(Cubic(size)),
        ..FORCE
    },
    Entry {
        name: "sternway",
        accepted: &["sternway"],
        near: &["symmetric"],
        size: 1.0,
        most: 1.5,
        in_mmg: false,
        reference: true,
        law: "low-speed form of the linear terms, with half as much resistance again astern (Yoshimura)",
        build: |size, _| Box::new(Sternway(size)),
        ..FORCE
    },
    Entry {
        name: "loading",
        accepted: &["loading"],
        near: &["symmetric"],
        size: 0.15,
        most: 0.8,
        compare: Compare::Size("mass"),
        reference: true,
        law: "mass and yaw inertia up by a share, centre of gravity moved by up to 2 % of the length",
        build: |size, d| {
            let shift = d.between(-0.02, 0.02);
            Box::new(Loading { share: size, xg: shift * d.length * (size / 0.15) })
        },
        ..FORCE
    },
    Entry {
        name: "fouling",
        class: Class::Absorbed,
        accepted: &["fouling"],
        near: &["thrust_loss"],
        unit: "dC_F",
        size: 1e-3,
        most: 1e-2,
        reference: true,
        law: "more frictional resistance, quadratic: the parameters p1 to p3 can mimic it",
        build: |size, _| Box::new(Fouling(size)),
        ..FORCE
    },
    Entry {
        name: "roll",
        accepted: &["roll"],
        near: &["hull_nonlinear", "symmetric"],
        size: 0.1,
        most: 1.5,
        reference: true,
        law: "second-order roll driven by U r (Son & Nomoto structure)",
        build: roll,
        ..FORCE
    },
    Entry {
        name: "thruster",
        accepted: &["thruster"],
        unit: "N",
        size: 20_000.0,
        most: 200_000.0,
        compare: Compare::Truth,
        law: "quadratic in the Froude number with a cut-off, command recorded",
        build: thruster,
        ..FORCE
    },
    Entry {
        name: "push",
        accepted: &["push"],
        unit: "N",
        size: 16_000.0,
        most: 300_000.0,
        law: "tug or line in a time window of some runs",
        build: push,
        ..FORCE
    },
];
