//! Split: long recordings into runs by what is done with rudder and propeller, runs into sessions, and blocks of runs into train
//! and test. It reads no file and changes no value: a run is a name and two times.

mod blocks;
mod controls;
mod runs;
mod session;
mod sides;
mod stretch;

pub use runs::{SplitError, SplitPart, SplitRun, SplitSettings, runs_csv, shortest_run, split, whole_csv};
pub use session::Sessions;
pub use sides::TestBy;
pub use stretch::Kind;
