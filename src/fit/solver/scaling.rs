//! The units that a fit is solved in: scales of the parameters and sizes of the constraint rows.
//! It chooses none of them.

use super::constraints::Row;

/// The units that a program is solved in.
#[derive(Clone)]
pub(in crate::fit) struct Scaling {
    /// One unit of each variable, in the parameter's own unit.
    pub scales: Vec<f64>,
    /// Size of each constraint row over a change of one unit in every variable.
    pub sizes: Vec<f64>,
}

impl Scaling {
    /// The scaling by these units.
    pub fn of(scales: Vec<f64>, rows: &[Row]) -> Self {
        Self { sizes: rows.iter().map(|row| row.size(&scales)).collect(), scales }
    }
}
