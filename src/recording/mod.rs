//! Recordings: one run of a ship, as measured; files in, checked channels out in SI units, radians and the project's frames.
//! It neither simulates nor judges: doubts about a readable recording are raised by `check`, forces belong to the terms.

pub mod audit;
mod channel;
mod convert;
mod driven;
mod error;
mod file;
pub mod import;
mod local;
mod record;
mod run;
pub mod split;
mod store;
pub mod validity;
mod window;
mod wrap;

pub use channel::{CHANNELS, Channel, ChannelInfo, Command, STATE_CHANNELS};
pub use driven::Driven;
pub use error::RecordingError;
pub use file::blank::Blank;
pub(crate) use file::blank::usual_fill;
pub(crate) use file::map::key_line;
pub use file::map::{Column, ColumnMap, Decimal, Delay, Delimiter, Derived, Header, SpeedReference, VelocityFrame};
pub use file::unit::{Quantity, UNITS, Unit};
pub(crate) use local::{local, slope};
pub use record::Recording;
pub use run::{Measured, Run, Split, measured, or_nan};
pub use store::{HELD_SAMPLES, RunStore, Runs};
pub use window::{Gaps, Initial, Labels, Skipped, WindowSettings, Windows};
pub(crate) use wrap::across_the_wrap;

/// How property tests of this module draw: the same cases every time.
#[cfg(test)]
fn seeded() -> proptest::test_runner::Config {
    use proptest::test_runner::{Config, RngSeed};
    Config { rng_seed: RngSeed::Fixed(20250226), failure_persistence: None, ..Config::default() }
}
