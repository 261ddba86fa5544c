//! The recordings of a concealed case: ship, plans, gusts, effects and noise put together, each from a random stream of its own.
//! A case with and without its effect has the same ship, plans, gusts and noise. The size of an effect is given, not found.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::craft::{Craft, LENGTH};
use super::design::{Plan, plans};
use super::noise::{Noise, Rows};
use super::sail::{Active, Method, World, sail};
use super::track::{PERIOD, STEPS, Track};
use crate::conceal::effects::effect::{Draw, Entry, Window};
use crate::conceal::spec::{Background, Spec};

/// The recordings of a case, as they are written.
#[derive(Debug, Clone, PartialEq)]
pub struct Recorded {
    /// The plans of the runs.
    pub plans: Vec<Plan>,
    /// The tracks before noise.
    pub tracks: Vec<Track>,
    /// The noisy rows of each run.
    pub rows: Vec<Rows>,
    /// Time windows of effects of limited duration, in the runs to train on.
    pub windows: Vec<Window>,
    /// Port-starboard difference of the ship ([`Craft::asymmetry`]).
    pub asymmetry: Option<f64>,
}

/// Random streams of a case; each purpose has its own.
mod stream {
    pub const CRAFT: u64 = 0;
    pub const PLANS: u64 = 1;
    pub const SENSORS: u64 = 2;
    pub const EFFECTS: u64 = 100;
    pub const GUSTS: u64 = 1_000;
    pub const NOISE: u64 = 2_000;
}

fn rng(seed: u64, stream: u64) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(stream);
    rng
}

/// An effect at a size, which draws from a stream of its own.
pub fn activate(spec: &Spec, entry: &'static Entry, place: usize, size: f64) -> Active {
    let mut rng = rng(spec.seed, stream::EFFECTS + place as u64);
    let (runs, sessions) = spec.design.size();
    let mut draw = Draw { rng: &mut rng, runs, length: LENGTH, duration: PERIOD * STEPS as f64 };
    Active {
        entry,
        size,
        physics: (entry.build)(size, &mut draw),
        sessions: (0..sessions).map(|s| !spec.contrast || s >= sessions / 2).collect(),
    }
}

/// Simulates the runs of a case under effects at given sizes, and adds noise.
pub fn record(spec: &Spec, effects: Vec<Active>) -> Recorded {
    let mut sensors = rng(spec.seed, stream::SENSORS);
    let mut noise = Noise::ordinary(&mut sensors);
    let mut gusts = [800.0, 800.0, 24_000.0];
    let (mut hull_error, mut method) = (0.0, Method::RungeKutta);
    match spec.background {
        Background::Ordinary => {}
        Background::Gusts => gusts = [4_000.0, 4_000.0, 120_000.0],
        Background::Coloured => {
            for i in 0..2 {
                (noise.sigma[i], noise.coloured[i], noise.time[i]) = (1.5, 0.97, 30.0);
            }
        }
        Background::Hull => hull_error = 0.1,
        Background::Euler => method = Method::Euler,
        Background::Outliers => noise.outliers = 0.01,
        Background::Dropouts => noise.dropouts = 2.0,
    }
    let craft = Craft::draw(spec.family, hull_error, &mut rng(spec.seed, stream::CRAFT));
    let plans = plans(spec.design, &craft, spec.family.pace(), &mut rng(spec.seed, stream::PLANS));
    let world = World { craft, effects, gusts, method };
    let sailed = |(i, plan): (usize, &Plan)| sail(&world, plan, i, rng(spec.seed, stream::GUSTS + i as u64));
    let tracks: Vec<Track> = plans.iter().enumerate().map(sailed).collect();
    let noisy = |(i, t): (usize, &Track)| noise.apply(&t.reported, &mut rng(spec.seed, stream::NOISE + i as u64));
    let rows = tracks.iter().enumerate().map(noisy).collect();
    let windows = world.effects.iter().flat_map(|e| e.windows(&plans)).collect();
    Recorded { plans, tracks, rows, windows, asymmetry: world.craft.asymmetry() }
}
