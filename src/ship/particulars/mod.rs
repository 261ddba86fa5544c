//! A whole ship file from length, breadth, draught and type: every value that is not given, by the published regressions of the field.
//! It replaces no measurement: each estimate has its source and its spread, and a value that is given is kept as it is.

mod estimate;
mod estimated;
mod kind;
mod resistance;
mod screw;
mod sheet;
mod write;

pub use estimate::{EstimateError, estimate};
pub use estimated::Estimated;
pub use kind::{KINDS, Kind};
pub use screw::{Screw, thrust_coefficient};
pub use sheet::{Entry, Origin};
