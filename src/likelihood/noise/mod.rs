//! The noise: what it consists of, its prior, and its estimate on linearised runs.

mod adjoint;
pub mod fit;
mod levels;
mod linearised;

pub use levels::{GROUP_OF, GROUPS, NOISE_PARAMETERS, Noise, NoisePrior, NoiseScore, SensorNoise};
