//! Files as ships and loggers write them: text, NMEA 0183, Parquet, each read to columns with times.
//! What a column stands for is decided elsewhere.

pub(super) mod clock;
mod foreign;
mod header;
mod jumps;
mod layout;
mod marks;
pub mod nmea;
#[cfg(feature = "parquet")]
mod parquet;
pub(super) mod passes;
pub(super) mod read;
mod text;
