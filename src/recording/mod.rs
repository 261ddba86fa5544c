//! Recordings: one run of a ship, as measured; files in, checked channels out in SI units, radians and the project's frames.
//! It neither simulates nor judges: doubts about a readable recording are raised by `check`, forces belong to the terms.

mod blank;
mod channel;
mod convert;
mod error;
mod lines;
mod local;
mod map;
mod meant;
mod read;
mod record;
mod run;
mod store;
mod unit;
mod window;
mod wrap;

pub use blank::Blank;
pub(crate) use blank::usual_fill;
pub use channel::{CHANNELS, Channel, ChannelInfo, STATE_CHANNELS};
pub use error::RecordingError;
pub(crate) use local::{local, slope};
pub(crate) use map::key_line;
pub use map::{Column, ColumnMap, Decimal, Delay, Delimiter, Derived, Header, SpeedReference, VelocityFrame};
pub use record::Recording;
pub use run::{Measured, Run, Split, measured, or_nan};
pub use store::{HELD_SAMPLES, RunStore, Runs};
pub use unit::{Quantity, UNITS, Unit};
pub use window::{Gaps, Initial, Labels, Skipped, WindowSettings, Windows};
pub(crate) use wrap::across_the_wrap;

/// How property tests of this module draw: the same cases every time.
#[cfg(test)]
fn seeded() -> proptest::test_runner::Config {
    use proptest::test_runner::{Config, RngSeed};
    Config { rng_seed: RngSeed::Fixed(20250226), failure_persistence: None, ..Config::default() }
}
