//! The tables and figures of the paper, one file each.
//! What they are made of is prepared elsewhere.

pub mod curves;
pub mod distributions;
pub mod limits;
pub mod performance;
pub mod scenarios;
pub mod table1;
pub mod table2;
